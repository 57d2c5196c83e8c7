//! The rays that a path tracer sends into a model.

use etendue_geometry::{Geometry, TraversalWork};
use etendue_math::{Frame, Point2, Point3, Ray, Rng, Vector3, offset_ray_origin, warp};

use super::model::Model;

/// What kind of rays.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum RayKind {
    /// Camera rays through the centres of pixels, line by line: coherent.
    Primary,
    /// From anywhere in the bounds of the model in any direction.
    Random,
    /// From what a camera ray hits, distributed by the cosine law: incoherent.
    Bounce,
    /// From what a camera ray hits to a random point of the lamp, where it is above the surface: any hit will do.
    Shadow,
}

impl RayKind {
    /// Name for tables.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Primary => "primary",
            Self::Random => "random",
            Self::Bounce => "bounce",
            Self::Shadow => "shadow",
        }
    }
}

/// Rays of one kind.
#[derive(Clone, Debug)]
pub struct RaySet {
    /// Which.
    pub kind: RayKind,
    /// The rays.
    pub rays: Vec<Ray>,
    /// Where they end.
    pub t_max: f32,
}

impl RaySet {
    /// Traces some of the rays, and tells how many hit something.
    #[must_use]
    pub fn count_hits(&self, geometry: &Geometry, range: std::ops::Range<usize>) -> usize {
        let rays = self.rays[range].iter();
        if self.kind == RayKind::Shadow {
            return rays.filter(|ray| geometry.occluded(ray, self.t_max, &|_| true)).count();
        }
        rays.filter(|ray| geometry.intersect(ray, self.t_max, &|_| true).is_some()).count()
    }

    /// The steps that all of them take.
    #[must_use]
    pub fn work(&self, geometry: &Geometry) -> TraversalWork {
        match self.kind {
            RayKind::Shadow => geometry.work_to_occlude(&self.rays, self.t_max),
            _ => geometry.work_to_intersect(&self.rays, self.t_max),
        }
    }
}

/// Shadow rays end just before the lamp: their t runs from 0 to 1.
const BEFORE_LAMP: f32 = 0.999;

/// A ray of each kind for each pixel of a picture; bounces and shadows only where the camera sees something.
#[must_use]
pub fn ray_sets(model: &Model, geometry: &Geometry, resolution: [u32; 2]) -> [RaySet; 4] {
    let primary = camera_rays(model, resolution);
    let bounds = geometry.bounds();
    let mut rng = Rng::new(1, 0);
    let mut random = Vec::with_capacity(primary.len());
    let (mut bounce, mut shadow) = (Vec::new(), Vec::new());
    for ray in &primary {
        let d = bounds.diagonal();
        let shares = Vector3::new(rng.next_f32() * d.x, rng.next_f32() * d.y, rng.next_f32() * d.z);
        random.push(Ray::new(bounds.min + shares, warp::sample_uniform_sphere(rng.next_point2())));
        let (u_bounce, u_lamp) = (rng.next_point2(), rng.next_point2());
        let Some(hit) = geometry.intersect(ray, f32::INFINITY, &|_| true) else { continue };
        let point = geometry.surface_point(ray, &hit);
        let ng = point.ng.facing(-ray.direction);
        let spawn = |w: Vector3| Ray::new(offset_ray_origin(point.p, point.p_error, ng, w), w);
        let up = Frame::from_z(ng.as_vector());
        bounce.push(spawn(up.to_world(warp::sample_cosine_hemisphere(u_bounce))));
        let to_lamp = lamp_point(model, u_lamp) - point.p;
        if ng.dot_vector(to_lamp) > 0.0 {
            shadow.push(spawn(to_lamp));
        }
    }
    let endless = |kind, rays| RaySet { kind, rays, t_max: f32::INFINITY };
    [
        endless(RayKind::Primary, primary),
        endless(RayKind::Random, random),
        endless(RayKind::Bounce, bounce),
        RaySet { kind: RayKind::Shadow, rays: shadow, t_max: BEFORE_LAMP },
    ]
}

fn lamp_point(model: &Model, u: Point2) -> Point3 {
    model.lamp.corner + model.lamp.edges[0] * u.x + model.lamp.edges[1] * u.y
}

fn camera_rays(model: &Model, [width, height]: [u32; 2]) -> Vec<Ray> {
    let ahead = (model.target - model.eye).normalized();
    let right = ahead.cross(Vector3::new(0.0, 1.0, 0.0)).normalized();
    let up = right.cross(ahead);
    let scale = 2.0 * (0.5 * model.fov_rad).tan() / width.min(height) as f32;
    let offset = |i: u32, n: u32| (i as f32 + 0.5 - 0.5 * n as f32) * scale;
    (0..width * height)
        .map(|k| right * offset(k % width, width) - up * offset(k / width, height) + ahead)
        .map(|direction| Ray::new(model.eye, direction.normalized()))
        .collect()
}
