//! The hemisphere about +z: uniform, by the cosine, and by a power of the cosine (SPEC MC-8).

use std::f32::consts::{FRAC_1_PI, TAU};

use super::disk::{invert_concentric_disk, sample_concentric_disk, turn_fraction};
use crate::approx::sin_cos_turns;
use crate::{ONE_MINUS_EPSILON, Point2, Vector3, safe_sqrt};

/// A direction with density cos(theta) / pi: the disk, lifted to the hemisphere (Malley).
#[inline]
#[must_use]
pub fn sample_cosine_hemisphere(u: Point2) -> Vector3 {
    let p = sample_concentric_disk(u);
    Vector3::new(p.x, p.y, safe_sqrt(1.0 - p.x * p.x - p.y * p.y))
}

/// Density of [`sample_cosine_hemisphere`] per steradian; 0 below the horizon.
#[inline]
#[must_use]
pub const fn cosine_hemisphere_pdf(cos_theta: f32) -> f32 {
    if cos_theta > 0.0 { cos_theta * FRAC_1_PI } else { 0.0 }
}

/// Inverse of [`sample_cosine_hemisphere`].
#[must_use]
pub fn invert_cosine_hemisphere(w: Vector3) -> Point2 {
    invert_concentric_disk(Point2::new(w.x, w.y))
}

/// A direction of the upper hemisphere, all alike.
#[inline]
#[must_use]
pub fn sample_uniform_hemisphere(u: Point2) -> Vector3 {
    let z = u.x;
    direction(z, safe_sqrt(1.0 - z * z), u.y)
}

/// Density of [`sample_uniform_hemisphere`] per steradian: 1 / (2 pi).
#[inline]
#[must_use]
pub const fn uniform_hemisphere_pdf() -> f32 {
    1.0 / TAU
}

/// Inverse of [`sample_uniform_hemisphere`].
#[must_use]
pub fn invert_uniform_hemisphere(w: Vector3) -> Point2 {
    Point2::new(w.z.clamp(0.0, ONE_MINUS_EPSILON), turn_fraction(w.x, w.y))
}

/// A direction with density (n + 1) / (2 pi) cos^n(theta): theta = acos((1 - u.x)^(1 / (n + 1))), phi = 2 pi u.y.
#[inline]
#[must_use]
pub fn sample_cosine_power(u: Point2, n: f32) -> Vector3 {
    // With 1 - u.x, which is never 0, and the sine from expm1, which does not cancel for large n.
    let log_cos = (-u.x).ln_1p() / (n + 1.0);
    direction(log_cos.exp(), safe_sqrt(-(2.0 * log_cos).exp_m1()), u.y)
}

/// Density of [`sample_cosine_power`] per steradian; 0 below the horizon.
#[inline]
#[must_use]
pub fn cosine_power_pdf(cos_theta: f32, n: f32) -> f32 {
    if cos_theta > 0.0 { (n + 1.0) / TAU * cos_theta.powf(n) } else { 0.0 }
}

/// Inverse of [`sample_cosine_power`].
#[must_use]
pub fn invert_cosine_power(w: Vector3, n: f32) -> Point2 {
    // cos^(n + 1) from the sine, which is exact near the pole; below 45 degrees from the cosine.
    let sin_squared = w.x * w.x + w.y * w.y;
    let log_cos = if sin_squared < 0.5 { 0.5 * (-sin_squared).ln_1p() } else { w.z.max(0.0).ln() };
    let u = -((n + 1.0) * log_cos).exp_m1();
    Point2::new(u.clamp(0.0, ONE_MINUS_EPSILON), turn_fraction(w.x, w.y))
}

/// The direction at height `z`, `sin_theta` from the axis, at a fraction of the turn about it.
#[inline]
pub(super) fn direction(z: f32, sin_theta: f32, turn: f32) -> Vector3 {
    let (sin, cos) = sin_cos_turns(turn);
    Vector3::new(sin_theta * cos, sin_theta * sin, z)
}
