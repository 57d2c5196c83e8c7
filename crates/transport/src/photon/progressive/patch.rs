//! The piece of surface whose photons count for a visible point, and how much of it there is.
//!
//! Photons count that are no farther than the radius r, close to the tangent plane, and on a surface that is turned much the
//! same way: not those on the other wall of a corner, on the back of a pole or inside a lamp's housing. Of the disc in the
//! tangent plane that the estimate divides by, the surface covers a share s: less than 1 at edges, in corners, on poles that
//! are thinner than r. Each photon weighs as much as its surface is turned towards the disc, cos(n, n'), so that even light E
//! brings `E s pi r^2`, which must be divided by s.
//!
//! `1/s` has an estimate without bias: points of the disc are chosen at random until a line through one, along the normal,
//! meets that surface. That takes 1/s trials in the mean (as Qin et al. 2015, "Unbiased Photon Gathering for Light Transport
//! Simulation", doi:10.1145/2816795.2818119, invert a probability). On even ground it takes one.

use etendue_math::warp::sample_concentric_disk;
use etendue_math::{Frame, Normal3, Point3, Ray, Sampler};
use etendue_scene::scene::Surface;
use etendue_spectrum::Wavelengths;

use super::photons::receiving_lobes;
use crate::path::camera_pass::Tracer;

/// Places count that are no farther from the tangent plane than this share of the radius.
const THICKNESS: f32 = 0.25;
/// Rounding errors of a place that are within it at least.
const LEAST_ERRORS: f32 = 4.0;
/// Least cosine between the normals.
const LEAST_COSINE: f32 = 0.5;
/// Most trials. Where the surface covers a share s of the disc, what they find is too dark by (1 - s)^256: 8 % at a hundredth,
/// nothing to speak of at a thirtieth.
const MOST_TRIALS: u32 = 256;
/// Surfaces that a line meets at most: those that do not count may lie above one that does.
const MOST_HITS: u32 = 4;

/// What counts around a visible point.
#[derive(Clone, Copy, Debug)]
pub(super) struct Patch {
    pub(super) p: Point3,
    pub(super) n: Normal3,
    pub(super) radius: f32,
    thickness: f32,
}

impl Patch {
    /// The surroundings of a point seen from the side of `wo`.
    pub(super) fn new(surface: &Surface, radius: f32) -> Self {
        let point = &surface.point;
        let thickness = (THICKNESS * radius).max(LEAST_ERRORS * point.p_error.max_element());
        Self { p: point.p, n: point.ng.facing(surface.wo), radius, thickness }
    }

    /// Cosine between the normals at a place within the radius; 0 if the place does not count. The normal there is on the side
    /// of a direction that is on the side of the normal here if `side` is positive.
    #[inline]
    pub(super) fn weight(&self, p: Point3, n: Normal3, side: f32) -> f32 {
        let cosine = n.as_vector().dot_normal(self.n) * 1.0_f32.copysign(side);
        let is_near = (p - self.p).dot_normal(self.n).abs() <= self.thickness;
        if is_near && cosine >= LEAST_COSINE { cosine } else { 0.0 }
    }

    /// An estimate of the disc's area over that of what counts, both as seen along the normal.
    pub(super) fn inverse_share(
        &self,
        tracer: &Tracer<'_>,
        surface: &Surface,
        receiver_alpha: f32,
        lambda: &Wavelengths,
        numbers: &mut Sampler,
    ) -> f32 {
        let frame = Frame::from_z(self.n.as_vector());
        let mut n_trials = 1;
        while n_trials < MOST_TRIALS {
            let u = sample_concentric_disk(numbers.next_2d());
            let in_plane = self.p + (frame.x * u.x + frame.y * u.y) * self.radius;
            let start = in_plane + self.n.as_vector() * self.thickness;
            let ray = Ray { origin: start, direction: -self.n.as_vector(), time: surface.time };
            if self.is_met(tracer, surface, ray, receiver_alpha, lambda) {
                break;
            }
            n_trials += 1;
        }
        n_trials as f32
    }

    /// Whether a line through the disc meets a place that counts.
    fn is_met(
        &self,
        tracer: &Tracer<'_>,
        surface: &Surface,
        mut ray: Ray,
        receiver_alpha: f32,
        lambda: &Wavelengths,
    ) -> bool {
        let scene = tracer.scene;
        let materials = &scene.materials;
        // What receives here receives everywhere on the material.
        let is_even = !materials.is_mixture(surface.material)
            && (materials.is_uniform(surface.material)
                || !materials.may_be_sharp(surface.material, receiver_alpha));
        for _ in 0..MOST_HITS {
            let left = self.thickness + (ray.origin - self.p).dot_normal(self.n);
            let Some(hit) = tracer.intersect_within(&ray, left) else { return false };
            let met = scene.surface(&ray, &hit);
            let is_within = met.point.p.distance_squared(self.p) <= self.radius * self.radius;
            if is_within && self.weight(met.point.p, met.point.ng.facing(met.wo), 1.0) > 0.0 {
                let receives = || {
                    let mut lambda = *lambda;
                    let bsdf = scene.bsdf(&met, &mut lambda);
                    bsdf.is_some_and(|bsdf| !receiving_lobes(&bsdf, receiver_alpha).is_empty())
                };
                if (met.material == surface.material && is_even) || receives() {
                    return true;
                }
            }
            ray = met.spawn_ray(ray.direction);
        }
        false
    }
}
