//! Guards and small scalar functions with a name, so that a formula shows where rounding is handled.

/// `sqrt(max(0, x))`: for values that only rounding can make negative.
#[inline]
#[must_use]
pub fn safe_sqrt(x: f32) -> f32 {
    debug_assert!(x >= -1e-3 || x.is_nan(), "sqrt of {x}");
    if x > 0.0 { x.sqrt() } else { 0.0 }
}

/// `acos` of a value that only rounding can push outside [-1, 1].
#[inline]
#[must_use]
pub fn safe_acos(x: f32) -> f32 {
    x.clamp(-1.0, 1.0).acos()
}

/// A cosine clamped to [0, 1].
#[inline]
#[must_use]
pub fn clamp_cosine(x: f32) -> f32 {
    x.clamp(0.0, 1.0)
}

/// `x * x`.
#[inline]
#[must_use]
pub fn sqr(x: f32) -> f32 {
    x * x
}

/// `a` at `t = 0`, `b` at `t = 1`.
#[inline]
#[must_use]
pub fn lerp(t: f32, a: f32, b: f32) -> f32 {
    (1.0 - t) * a + t * b
}

/// The next larger `f32`; infinity and NaN stay.
#[inline]
#[must_use]
pub fn next_float_up(x: f32) -> f32 {
    x.next_up()
}

/// The next smaller `f32`; negative infinity and NaN stay.
#[inline]
#[must_use]
pub fn next_float_down(x: f32) -> f32 {
    x.next_down()
}
