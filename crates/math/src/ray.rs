//! Rays (SPEC GEO-1) and where a ray may start without meeting the surface it leaves.

use crate::{Normal3, Point3, Vector3};

/// The half-line `origin + t * direction`, t > 0.
///
/// In world space the direction has length 1, so that t is a distance in metres; in the space of an instance the
/// direction keeps the length that the transform gives it, so that t stays comparable.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Ray {
    /// Start of the ray.
    pub origin: Point3,
    /// Direction of travel.
    pub direction: Vector3,
    /// Time within the shutter interval, in seconds.
    pub time: f32,
}

impl Ray {
    /// A ray at time 0.
    #[inline]
    #[must_use]
    pub const fn new(origin: Point3, direction: Vector3) -> Self {
        Self { origin, direction, time: 0.0 }
    }

    /// The point at parameter `t`.
    #[inline]
    #[must_use]
    pub fn at(&self, t: f32) -> Point3 {
        self.origin + self.direction * t
    }
}

/// Moves `p` off a surface to the side of `w`, just beyond its rounding error.
///
/// `p_error` bounds the absolute error of each coordinate of `p`; `n` is the geometric normal of the surface
/// (Pharr, Jakob and Humphreys 2023, "Physically Based Rendering", 4th ed., section 6.8.6).
#[inline]
#[must_use]
pub fn offset_ray_origin(p: Point3, p_error: Vector3, n: Normal3, w: Vector3) -> Point3 {
    // The sum is rounded too, by half of these at most, and by the last factor where the offset exceeds the point.
    let error = p_error + p.as_vector().abs() * f32::EPSILON;
    let distance =
        (n.x.abs() * error.x + n.y.abs() * error.y + n.z.abs() * error.z) * (1.0 + 8.0 * f32::EPSILON);
    p + n.as_vector() * distance.copysign(n.dot_vector(w))
}
