//! What the auxiliary channels of a film show of the first surface that a path meets.

use etendue_math::Normal3;
use etendue_scene::Scene;
use etendue_scene::bsdf::Bsdf;
use etendue_scene::film::{AovSpace, Features, FilmKind};
use etendue_scene::scene::Surface;
use etendue_spectrum::Wavelengths;

/// Features of a surface for the auxiliary channels.
#[must_use]
pub fn describe(scene: &Scene, surface: &Surface, bsdf: &Bsdf, lambda: &Wavelengths) -> Features {
    let point = &surface.point;
    let camera_from_world = scene.camera.transform_at(surface.time).inverse();
    let p_camera = camera_from_world.point(point.p);
    let to_array = |n: Normal3| n.as_vector().try_normalized().map_or([0.0; 3], |n| [n.x, n.y, n.z]);
    let (position, normal, shading_normal) = match scene.film.kind {
        FilmKind::GBuffer(AovSpace::World) => (point.p, point.ng, bsdf.ns()),
        _ => (p_camera, camera_from_world.normal(point.ng), camera_from_world.normal(bsdf.ns())),
    };
    Features {
        albedo: scene.film.white_rgb(bsdf.albedo(surface.wo), lambda),
        position: [position.x, position.y, position.z],
        normal: to_array(normal),
        shading_normal: to_array(shading_normal),
        uv: [point.uv.x, point.uv.y],
        depth: p_camera.z,
    }
}
