//! One-dimensional densities, and the choice among a few weights.

use std::f32::consts::TAU;

use crate::ONE_MINUS_EPSILON;
use crate::approx::{exp, ln_1p};
use crate::statistics::{normal_cdf, normal_quantile};

/// A number in [0, 1) whose density is linear, `a` at 0 and `b` at 1 up to a factor; weights at least 0, not both 0.
#[inline]
#[must_use]
pub fn sample_linear(u: f32, a: f32, b: f32) -> f32 {
    if u == 0.0 && a == 0.0 {
        return 0.0;
    }
    // The root of the quadratic distribution function in the form that does not cancel.
    let x = u * (a + b) / (a + (a * a + u * (b * b - a * a)).max(0.0).sqrt());
    x.min(ONE_MINUS_EPSILON)
}

/// Density of [`sample_linear`].
#[inline]
#[must_use]
pub fn linear_pdf(x: f32, a: f32, b: f32) -> f32 {
    if (0.0..=1.0).contains(&x) { 2.0 * ((1.0 - x) * a + x * b) / (a + b) } else { 0.0 }
}

/// Inverse of [`sample_linear`].
#[inline]
#[must_use]
pub fn invert_linear(x: f32, a: f32, b: f32) -> f32 {
    (x * (a * (2.0 - x) + b * x) / (a + b)).clamp(0.0, ONE_MINUS_EPSILON)
}

/// A number in (-radius, radius) whose density is a tent with its top at 0.
#[inline]
#[must_use]
pub fn sample_tent(u: f32, radius: f32) -> f32 {
    if u < 0.5 { radius * ((2.0 * u).sqrt() - 1.0) } else { radius * (1.0 - (2.0 * (1.0 - u)).sqrt()) }
}

/// Density of [`sample_tent`].
#[inline]
#[must_use]
pub fn tent_pdf(x: f32, radius: f32) -> f32 {
    if x.abs() < radius { (1.0 - x.abs() / radius) / radius } else { 0.0 }
}

/// Inverse of [`sample_tent`].
#[inline]
#[must_use]
pub fn invert_tent(x: f32, radius: f32) -> f32 {
    let tail = 1.0 - (x.abs() / radius).min(1.0);
    let u = 0.5 * tail * tail;
    if x < 0.0 { u } else { (1.0 - u).min(ONE_MINUS_EPSILON) }
}

/// A number of at least 0 with density `rate * exp(-rate * x)`: the distance to an event in a homogeneous medium.
#[inline]
#[must_use]
pub fn sample_exponential(u: f32, rate: f32) -> f32 {
    -ln_1p(-u) / rate
}

/// Density of [`sample_exponential`].
#[inline]
#[must_use]
pub fn exponential_pdf(x: f32, rate: f32) -> f32 {
    if x < 0.0 { 0.0 } else { rate * exp(-rate * x) }
}

/// Inverse of [`sample_exponential`].
#[inline]
#[must_use]
pub fn invert_exponential(x: f32, rate: f32) -> f32 {
    (-(-rate * x).exp_m1()).clamp(0.0, ONE_MINUS_EPSILON)
}

/// A normally distributed number.
#[must_use]
pub fn sample_normal(u: f32, mean: f32, sigma: f32) -> f32 {
    // The middle of the interval of numbers that round to u: u = 0 would be at minus infinity.
    let u = f64::from(u).max(1.0 / f64::from(1_u32 << 31) / 4.0);
    mean + sigma * normal_quantile(u) as f32
}

/// Density of [`sample_normal`].
#[inline]
#[must_use]
pub fn normal_pdf(x: f32, mean: f32, sigma: f32) -> f32 {
    let t = (x - mean) / sigma;
    exp(-0.5 * t * t) / (sigma * TAU.sqrt())
}

/// Inverse of [`sample_normal`].
#[must_use]
pub fn invert_normal(x: f32, mean: f32, sigma: f32) -> f32 {
    (normal_cdf(f64::from((x - mean) / sigma)) as f32).clamp(0.0, ONE_MINUS_EPSILON)
}

/// An index chosen in proportion to `weights` (at least 0), its probability, and `u` remapped to a fresh number in [0, 1);
/// `None` if all weights are 0. For short lists: cost is linear.
#[inline]
#[must_use]
pub fn sample_discrete(weights: &[f32], u: f32) -> Option<(usize, f32, f32)> {
    let total: f32 = weights.iter().sum();
    if total <= 0.0 || !total.is_finite() {
        return None;
    }
    let target = u * total;
    let mut below = 0.0;
    let mut last = None;
    for (index, &weight) in weights.iter().enumerate() {
        if weight <= 0.0 {
            continue;
        }
        let remapped = (target - below) / weight;
        if remapped < 1.0 {
            return Some((index, weight / total, remapped.clamp(0.0, ONE_MINUS_EPSILON)));
        }
        below += weight;
        last = Some((index, weight / total, ONE_MINUS_EPSILON));
    }
    // Rounding carried the target past the sum.
    last
}
