//! Powers of cosines, the highlights of Phong and his successors, precise also for exponents of a million.

use std::f32::consts::{PI, TAU};

use etendue_math::approx::{exp, ln, ln_1p};
use etendue_math::{Vector3, sqr, warp};

use crate::bsdf::microfacet::Microfacets;

/// cosⁿ of the angle between two unit vectors; 0 beyond 90°.
#[inline]
pub(super) fn cosine_power(a: Vector3, b: Vector3, n: f32) -> f32 {
    let one_minus_cos = 0.5 * (a - b).length_squared();
    if one_minus_cos < 1.0 { exp(n * ln_1p(-one_minus_cos)) } else { 0.0 }
}

/// cosⁿ of the angle between a unit vector of the upper hemisphere and +z.
#[inline]
pub(super) fn height_power(h: Vector3, n: f32) -> f32 {
    let sin2 = sqr(h.x) + sqr(h.y);
    // From the sine where the cosine is nearly 1.
    let ln_cos = if sin2 < 0.5 { 0.5 * ln_1p(-sin2) } else { ln(h.z.max(1e-30)) };
    exp(n * ln_cos)
}

/// The half vector of two directions of the upper hemisphere.
#[inline]
pub(super) fn half_vector(a: Vector3, b: Vector3) -> Option<Vector3> {
    (a + b).try_normalized()
}

/// What the integral of cosⁿ over the hemisphere is divided by to get 1.
#[inline]
pub(super) fn power_pdf_scale(n: f32) -> f32 {
    (n + 1.0) / TAU
}

/// A half vector with density `(n + 1) / 2 pi cosⁿ`.
pub(super) use warp::sample_cosine_power;

/// GGX alpha of the half-vector highlight cosⁿ: both are about `exp(-tan² / alpha²)` near the peak.
#[inline]
pub(super) fn alpha_of_exponent(n: f32) -> f32 {
    (2.0 / (n + 2.0)).sqrt()
}

/// The exponent of that alpha.
#[inline]
pub(super) fn exponent_of_alpha(alpha: f32) -> f32 {
    (2.0 / sqr(alpha) - 2.0).max(0.0)
}

/// The exponent of a half-vector highlight that is wide enough for paths that have scattered before.
pub(super) fn widened_exponent(n: f32) -> f32 {
    let alpha = alpha_of_exponent(n);
    let wide = widened_alpha(alpha);
    if wide > alpha { exponent_of_alpha(wide) } else { n }
}

/// The alpha that paths which have scattered before see; see [`Microfacets::regularized`].
pub(super) fn widened_alpha(alpha: f32) -> f32 {
    Microfacets::new(alpha, alpha).regularized().alpha().0
}

/// Blinn's `(n + 2)(n + 4) / (8 pi (2^(-n/2) + n))`: with it `cosⁿ` of the half vector has albedo 1 at normal
/// incidence [SPEC BRDF-15].
#[inline]
pub(super) fn blinn_scale(n: f32) -> f32 {
    (n + 2.0) * (n + 4.0) / (8.0 * PI * (exp(-0.5 * std::f32::consts::LN_2 * n) + n))
}
