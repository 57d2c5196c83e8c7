//! What changes from pass to pass: the radius, wavelengths and time.

use etendue_math::{ONE_MINUS_EPSILON, hash64, unit_f32};

use crate::path::camera_pass::Common;

/// Radius of a pass over that of the first: the square shrinks by (i + alpha) / (i + 1) after pass i, which lets the variance of
/// the mean and its bias vanish together [Knaus and Zwicker 2011 (15)].
pub(super) fn shrink(pass: u64, alpha: f32) -> f32 {
    /// Factors that are multiplied one by one; the rest of the product is a ratio of gamma functions, a power up to O(1/i^2).
    const N_EXACT: u64 = 256;
    let alpha = f64::from(alpha);
    let n = pass.min(N_EXACT);
    let exact: f64 = (1..=n).map(|i| (i as f64 + alpha) / (i as f64 + 1.0)).product();
    let middle = |i: u64| i as f64 + (2.0 + alpha) / 2.0;
    (exact * (middle(pass) / middle(n)).powf(alpha - 1.0)).sqrt() as f32
}

/// The golden ratio as a fraction of 2^64: multiples of it are even however many there are.
const GOLDEN: u64 = 0x9e37_79b9_7f4a_7c15;

/// What all paths and photons of a group have in common. Groups are numbered over all passes.
///
/// The four wavelengths of a group are equally far apart, so that their place within a quarter tells all of them; which of them is
/// the hero matters to dispersion alone. Places go by the radical inverse in base 2: four groups in a row, from a multiple of
/// four on, have 16 wavelengths equally far apart, and have each of the four heroes; 2^n groups have 4 * 2^n. The quarter of the
/// hero is the sum without carry of the group's digits in base 4. Any two neighbours among the binary digits tell it, given the
/// others, so that of the heroes of 2^n groups one lies in each of 2^n equal parts: behind a prism there is nothing else.
pub(super) fn group(seed: u64, number: u64) -> Common {
    let unit = |bits: u64, axis: u64| unit_f32((bits.wrapping_add(hash64(&[seed, axis])) >> 32) as u32);
    let hero = (0..32).fold(0, |sum, digit| sum ^ (number >> (2 * digit)) & 3);
    let u_lambda = (hero as f32 + unit(number.reverse_bits(), 0)) / 4.0;
    Common { u_lambda: u_lambda.min(ONE_MINUS_EPSILON), u_time: unit(GOLDEN.wrapping_mul(number), 1) }
}
