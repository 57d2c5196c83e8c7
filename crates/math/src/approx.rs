//! Elementary functions in single precision without branches, tables or calls: a loop over lanes of them becomes vector
//! code, and they give the same bits on every machine, which the system's mathematics library does not promise.
//!
//! Each reduces its argument to a short interval about 0 and evaluates there a polynomial of least greatest error
//! (Remez's exchange, in 40 digits); the polynomials err by less than 1e-8, rounding by the rest. "ulp" is the distance
//! between neighbouring `f32` at the result; the bounds are those of the tests, which compare sweeps of all arguments with
//! double precision. Reductions: Cody and Waite 1980, "Software Manual for the Elementary Functions".

use std::f32::consts::{FRAC_PI_2, FRAC_PI_4, LOG2_E, PI, TAU};

/// Adding it rounds to an integer, which is then in the lowest bits; for |x| < 2^22.
const ROUND: f32 = 12_582_912.0;
/// ln 2 in two parts; integers below 2^15 times the first are exact.
const LN_2_HIGH: f32 = 0.693_359_375;
const LN_2_LOW: f32 = -2.121_944_4e-4;
/// tan(pi / 8).
const TAN_PI_8: f32 = 0.414_213_56;

/// c0 + c1 x + c2 x^2 + ...: even and odd powers apart, so that two chains of half the length run side by side.
#[inline]
fn polynomial<const N: usize>(x: f32, coefficients: [f32; N]) -> f32 {
    let square = x * x;
    let (mut even, mut odd) = (coefficients[(N - 1) & !1], coefficients[(N - 2) | 1]);
    for k in (0..(N - 1) & !1).step_by(2).rev() {
        even = even * square + coefficients[k];
    }
    for k in (1..(N - 2) | 1).step_by(2).rev() {
        odd = odd * square + coefficients[k];
    }
    even + odd * x
}

/// Sine and cosine of 2 pi `turns`, for |`turns`| < 2^19. Off by at most 1.23e-7 for `turns` in [-1, 1]; both are exact
/// at quarters.
#[inline]
#[must_use]
pub fn sin_cos_turns(turns: f32) -> (f32, f32) {
    // The nearest quarter and the rest r, |r| <= 1/8, exact.
    let rounded = 4.0 * turns + ROUND;
    let quarter = rounded.to_bits();
    let r = turns - 0.25 * (rounded - ROUND);
    let (sin, cos) = sin_cos_small_turns(r);
    let (a, b) = if quarter & 1 == 0 { (sin, cos) } else { (cos, sin) };
    // Quarters 2 and 3 negate the sine, 1 and 2 the cosine.
    let flip = |x: f32, negative: u32| f32::from_bits(x.to_bits() ^ ((negative & 2) << 30));
    (flip(a, quarter), flip(b, quarter.wrapping_add(1)))
}

/// Sine and cosine of 2 pi `turns` for |`turns`| <= 1/8, as precise as [`sin_cos_turns`].
#[inline]
#[must_use]
pub(crate) fn sin_cos_small_turns(turns: f32) -> (f32, f32) {
    let z = turns * turns;
    let sin = turns * polynomial(z, [TAU, -41.341_661, 81.592_354, -75.393_563]);
    let cos = 1.0 + z * polynomial(z, [-19.739_209, 64.939_326, -85.443_742, 59.245_964]);
    (sin, cos)
}

/// The angle in [-pi, pi] of the vector (x, y) from the x axis; 0 or +-pi for the null vector. At most 3 ulp off, for
/// finite arguments whose sum is finite.
#[inline]
#[must_use]
pub fn atan2(y: f32, x: f32) -> f32 {
    let (ax, ay) = (x.abs(), y.abs());
    let steep = ay > ax;
    let (low, high) = if steep { (ax, ay) } else { (ay, ax) };
    // Beyond pi/8 the difference to pi/4: tan(a - pi/4) = (tan a - 1) / (tan a + 1).
    let wide = low > TAN_PI_8 * high;
    let (numerator, denominator) = if wide { (low - high, low + high) } else { (low, high) };
    let t = if denominator == 0.0 { 0.0 } else { numerator / denominator };
    let z = t * t;
    let p = polynomial(z, [-0.333_333_15, 0.199_984_72, -0.142_435_33, 0.105_938_14, -0.060_782_213]);
    let angle = t + t * z * p + if wide { FRAC_PI_4 } else { 0.0 };
    let angle = if steep { FRAC_PI_2 - angle } else { angle };
    let angle = if x.is_sign_negative() { PI - angle } else { angle };
    angle.copysign(y)
}

/// asin(x) for |x| <= 1/2.
#[inline]
fn asin_small(x: f32) -> f32 {
    let z = x * x;
    let p = polynomial(z, [0.166_667_52, 0.074_952_976, 0.045_470_376, 0.024_179_516, 0.042_166_307]);
    x + x * z * p
}

/// asin(|x|) where |x| <= 1/2 and pi/2 - asin(|x|) beyond; and whether it is beyond.
#[inline]
fn asin_or_rest(x: f32) -> (f32, bool) {
    let a = x.abs();
    let beyond = a > 0.5;
    // acos(a) = 2 asin(sqrt((1 - a) / 2)); 1 - a is exact. The root is below a just where a is beyond 1/2.
    let root = (0.5 * (1.0 - a)).sqrt();
    let t = if root >= a { a } else { root };
    (asin_small(t) * if beyond { 2.0 } else { 1.0 }, beyond)
}

/// The angle in [-pi/2, pi/2] whose sine is `x`, for |`x`| <= 1, NaN beyond. At most 2.5 ulp off.
#[inline]
#[must_use]
pub fn asin(x: f32) -> f32 {
    let (s, beyond) = asin_or_rest(x);
    (if beyond { FRAC_PI_2 - s } else { s }).copysign(x)
}

/// The angle in [0, pi] whose cosine is `x`, for |`x`| <= 1, NaN beyond. At most 2.5 ulp off.
#[inline]
#[must_use]
pub fn acos(x: f32) -> f32 {
    let (s, beyond) = asin_or_rest(x);
    // pi/2 - asin(x), acos(a) or pi - acos(a): a constant plus or minus s.
    let end = FRAC_PI_2 - FRAC_PI_2.copysign(x);
    let constant = if beyond { end } else { FRAC_PI_2 };
    constant + s.copysign(x) * if beyond { 1.0 } else { -1.0 }
}

/// e^x for every `x`; at most 2 ulp off, subnormal results included.
#[inline]
#[must_use]
pub fn exp(x: f32) -> f32 {
    // Beyond these the result is 0 or infinite. Comparisons that let NaN pass.
    let x = if x < -104.0 { -104.0 } else { x };
    let x = if x > 89.0 { 89.0 } else { x };
    let rounded = x * LOG2_E + ROUND;
    let n = rounded.to_bits().wrapping_sub(ROUND.to_bits()) as i32;
    let nf = rounded - ROUND;
    let r = (x - nf * LN_2_HIGH) - nf * LN_2_LOW;
    let p = polynomial(r, [0.499_999_93, 0.166_665_21, 0.041_668_387, 0.008_368_71, 0.001_381_461_3]);
    let mantissa = 1.0 + (r + r * r * p);
    // 2^n as two factors, neither of which leaves the normal numbers.
    let half = n >> 1;
    let power = |k: i32| f32::from_bits((k.wrapping_add(127) as u32) << 23);
    mantissa * power(half) * power(n.wrapping_sub(half))
}

/// The natural logarithm: minus infinity at 0, NaN below. At most 2 ulp off.
#[inline]
#[must_use]
pub fn ln(x: f32) -> f32 {
    let (f, e) = split_logarithm(x);
    let finite = e * LN_2_HIGH + (ln_near_1(f) + e * LN_2_LOW);
    finite + at_the_ends(x)
}

/// The logarithm to base 2: minus infinity at 0, NaN below. At most 3 ulp off; exact for powers of 2.
#[inline]
#[must_use]
pub fn log2(x: f32) -> f32 {
    let (f, e) = split_logarithm(x);
    e + ln_near_1(f) * LOG2_E + at_the_ends(x)
}

/// ln(1 + x), also for tiny `x`: minus infinity at -1, NaN below. At most 3 ulp off.
#[inline]
#[must_use]
pub fn ln_1p(x: f32) -> f32 {
    let w = 1.0 + x;
    // What rounding took from 1 + x, to first order.
    let lost = x - (w - 1.0);
    ln(w) + if lost.abs() > 0.0 { lost / w } else { 0.0 }
}

/// x = 2^e (1 + f) with 1 + f in [sqrt(1/2), sqrt(2)).
#[inline]
fn split_logarithm(x: f32) -> (f32, f32) {
    let subnormal = x < f32::MIN_POSITIVE;
    let scaled = x * if subnormal { 8_388_608.0 } else { 1.0 };
    let e = (scaled.to_bits() as i32).wrapping_sub(std::f32::consts::FRAC_1_SQRT_2.to_bits() as i32) >> 23;
    let mantissa = f32::from_bits(scaled.to_bits().wrapping_sub((e as u32) << 23));
    (mantissa - 1.0, e as f32 - if subnormal { 23.0 } else { 0.0 })
}

/// ln(1 + f), by s = f / (2 + f): ln(1 + f) = 2 artanh(s) = f - s (f - R(s^2)), grouped so that f itself is not rounded
/// (as in fdlibm).
#[inline]
fn ln_near_1(f: f32) -> f32 {
    let s = f / (2.0 + f);
    let z = s * s;
    let r = z * polynomial(z, [0.666_667_76, 0.399_775_42, 0.298_717_28]);
    let half_square = 0.5 * f * f;
    f - (half_square - s * (half_square + r))
}

/// What to add to the logarithm: 0 where it is finite. Choices between constants, since others would be branches.
#[inline]
fn at_the_ends(x: f32) -> f32 {
    let above = if x < f32::INFINITY { 0.0 } else { f32::INFINITY };
    let below = if x == 0.0 { f32::NEG_INFINITY } else { f32::NAN };
    if x > 0.0 { above } else { below }
}

#[cfg(test)]
mod tests;
