//! The whole sphere and cones about +z, uniformly.

use std::f32::consts::TAU;

use super::disk::turn_fraction;
use super::hemisphere::direction;
use crate::{ONE_MINUS_EPSILON, Point2, Vector3, safe_sqrt};

/// A direction of the sphere, all alike: z = 1 - 2 u.x.
#[inline]
#[must_use]
pub fn sample_uniform_sphere(u: Point2) -> Vector3 {
    // 1 - z^2 = 4 u (1 - u) does not cancel at the poles.
    direction(1.0 - 2.0 * u.x, 2.0 * safe_sqrt(u.x * (1.0 - u.x)), u.y)
}

/// Density of [`sample_uniform_sphere`] per steradian: 1 / (4 pi).
#[inline]
#[must_use]
pub const fn uniform_sphere_pdf() -> f32 {
    1.0 / (2.0 * TAU)
}

/// Inverse of [`sample_uniform_sphere`].
#[must_use]
pub fn invert_uniform_sphere(w: Vector3) -> Point2 {
    Point2::new((0.5 * (1.0 - w.z)).clamp(0.0, ONE_MINUS_EPSILON), turn_fraction(w.x, w.y))
}

/// A direction of the cone about +z whose half angle has the cosine `cos_max`, all alike.
#[inline]
#[must_use]
pub fn sample_uniform_cone(u: Point2, cos_max: f32) -> Vector3 {
    sample_narrow_cone(u, 1.0 - cos_max)
}

/// Density of [`sample_uniform_cone`] per steradian within the cone.
#[inline]
#[must_use]
pub const fn uniform_cone_pdf(cos_max: f32) -> f32 {
    narrow_cone_pdf(1.0 - cos_max)
}

/// Inverse of [`sample_uniform_cone`].
#[must_use]
pub fn invert_uniform_cone(w: Vector3, cos_max: f32) -> Point2 {
    invert_narrow_cone(w, 1.0 - cos_max)
}

/// As [`sample_uniform_cone`], the cone given by 1 - cos of its half angle, which stays exact for narrow ones
/// (for a half angle of small sine s it is s^2 / (1 + sqrt(1 - s^2))).
#[inline]
#[must_use]
pub fn sample_narrow_cone(u: Point2, one_minus_cos_max: f32) -> Vector3 {
    let one_minus_z = u.x * one_minus_cos_max;
    direction(1.0 - one_minus_z, safe_sqrt(one_minus_z * (2.0 - one_minus_z)), u.y)
}

/// Density of [`sample_narrow_cone`] per steradian within the cone.
#[inline]
#[must_use]
pub const fn narrow_cone_pdf(one_minus_cos_max: f32) -> f32 {
    1.0 / (TAU * one_minus_cos_max)
}

/// Inverse of [`sample_narrow_cone`].
#[must_use]
pub fn invert_narrow_cone(w: Vector3, one_minus_cos_max: f32) -> Point2 {
    let sin_squared = w.x * w.x + w.y * w.y;
    let one_minus_z = if w.z > 0.0 { sin_squared / (1.0 + w.z) } else { 1.0 - w.z };
    Point2::new((one_minus_z / one_minus_cos_max).clamp(0.0, ONE_MINUS_EPSILON), turn_fraction(w.x, w.y))
}
