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

/// Steps of a sequence that is even in both coordinates together: powers of 1/g with g^3 = g + 1 (Roberts 2018, "The
/// Unreasonable Effectiveness of Quasirandom Sequences").
const STEPS: [f64; 2] = [0.754_877_666_246_692_7, 0.569_840_290_998_053_2];

/// What all paths and photons of a group have in common. Groups are numbered over all passes. Any four in a row, from a
/// multiple of four on, have each of their four wavelengths as hero, and the places of the wavelengths are even over all groups.
pub(super) fn group(seed: u64, number: u64) -> Common {
    let even = |axis: usize| {
        // Fixed point: all numbers are equally precise, and the sum wraps as it should.
        let step = (STEPS[axis] * 2_f64.powi(64)) as u64;
        let bits = step.wrapping_mul(number).wrapping_add(hash64(&[seed, axis as u64]));
        unit_f32((bits >> 32) as u32)
    };
    let hero = (number / 4 + number) % 4;
    let u_lambda = (hero as f32 + even(0)) / 4.0;
    Common { u_lambda: u_lambda.min(ONE_MINUS_EPSILON), u_time: even(1) }
}
