//! What paths start in. Media that absorb are known by their boundaries alone, so that rays look for those.

use etendue_math::{Point2, Ray, Rng, warp};
use etendue_scene::Scene;
use etendue_scene::medium::MediumId;

/// Rays by which the camera looks for what it stands in.
const N_PROBES: u32 = 32;

/// Of those, how many must meet a boundary: else the camera just sees a thing from afar.
const LEAST_FOUND: usize = 6;

/// Surfaces that a ray passes at most.
const MAX_PASSED: u32 = 64;

/// What the camera stands in: what most of the rays that leave it in all directions find on their side of the first boundary, past
/// whatever else is in their way. A function of the scene alone; costs nothing where there are no media.
#[must_use]
pub fn camera_medium(scene: &Scene) -> Option<MediumId> {
    if scene.materials.media().is_empty() {
        return None;
    }
    let [width, height] = scene.film.resolution.map(|n| n as f32);
    let mut rng = Rng::new(0x3ed2, 1);
    let found: Vec<Option<MediumId>> = (0..N_PROBES)
        .filter_map(|_| {
            let (film, lens, direction) = (rng.next_point2(), rng.next_point2(), rng.next_point2());
            let p_film = Point2::new(film.x * width, film.y * height);
            let start = scene.camera.sample_ray(p_film, lens, rng.next_f32())?;
            medium_along(scene, Ray { direction: warp::sample_uniform_sphere(direction), ..start.ray })
        })
        .collect();
    if found.len() < LEAST_FOUND { None } else { most_frequent(found) }
}

/// The medium that is named most often.
#[must_use]
pub fn most_frequent(media: impl IntoIterator<Item = Option<MediumId>>) -> Option<MediumId> {
    let mut votes: Vec<(Option<MediumId>, u32)> = Vec::new();
    for medium in media {
        match votes.iter_mut().find(|(voted, _)| *voted == medium) {
            Some((_, n)) => *n += 1,
            None => votes.push((medium, 1)),
        }
    }
    votes.into_iter().max_by_key(|(_, n)| *n).and_then(|(medium, _)| medium)
}

/// What a ray starts in, as the first boundary on its way tells; `None` if there is no boundary.
#[must_use]
pub fn medium_along(scene: &Scene, mut ray: Ray) -> Option<Option<MediumId>> {
    for _ in 0..MAX_PASSED {
        let hit = scene.intersect(&ray, f32::INFINITY)?;
        let surface = scene.surface(&ray, &hit);
        if let Some(interface) = scene.materials.interface(surface.material) {
            return Some(interface.towards(surface.point.ng.dot_vector(surface.wo)));
        }
        ray = surface.spawn_ray(ray.direction);
    }
    None
}
