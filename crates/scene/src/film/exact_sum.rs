//! Sums whose result does not depend on the order of their terms.

use std::ops::{Add, AddAssign};

/// A sum of numbers, each rounded once to a multiple of 2^-60 and then added exactly.
///
/// 128 bits hold magnitudes up to 1.5e20 at a resolution of 8.7e-19, so that no scene needs a scale of its own:
/// renders of one scene that were split over threads, passes or machines add up to the same bits.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct ExactSum(i128);

/// Multiples of the quantum in 1.
const SCALE: f64 = (1_u64 << 60) as f64;

/// Terms beyond this magnitude saturate, so that 2^32 of them cannot overflow the sum.
const LARGEST_TERM: f64 = 3.0e10;

/// What a square beyond that magnitude adds: so much that the sum tells how many did, up to 40 000 of them, where no more than that
/// many did not.
const MARK: f64 = 3.0e15;

impl ExactSum {
    /// The empty sum.
    pub const ZERO: Self = Self(0);

    /// The rounded value of one term; magnitudes above 3e10 saturate.
    #[inline]
    #[must_use]
    pub fn of(value: f64) -> Self {
        let scaled = value.clamp(-LARGEST_TERM, LARGEST_TERM) * SCALE;
        // Most terms fit 64 bits, whose conversion is one instruction.
        if scaled.abs() < 9.0e18 { Self(i128::from(scaled as i64)) } else { Self(scaled as i128) }
    }

    /// True if `of` would saturate.
    #[inline]
    #[must_use]
    pub fn saturates(value: f64) -> bool {
        value.abs() > LARGEST_TERM
    }

    /// The rounded value of one square, which is counted rather than added where it saturates: a square that is cut off would
    /// make the worst outliers look sure.
    #[inline]
    #[must_use]
    pub fn of_square(value: f64) -> Self {
        if Self::saturates(value) { Self((MARK * SCALE) as i128) } else { Self::of(value) }
    }

    /// How many of the squares that were added saturated; at least 1 if any did.
    #[inline]
    #[must_use]
    pub fn n_saturated(self) -> u32 {
        let n = (self.value() / MARK).round();
        // Of too many to count, the sum wraps around.
        if n < 0.0 { 1 } else { n as u32 }
    }

    /// The sum, rounded to double precision.
    #[inline]
    #[must_use]
    pub fn value(self) -> f64 {
        self.0 as f64 / SCALE
    }

    /// The sum as an exact sum of `N` floats of falling size; 6 suffice for any.
    #[must_use]
    pub fn to_terms<const N: usize>(self) -> [f32; N] {
        let mut rest = self.0;
        std::array::from_fn(|_| {
            let term = rest as f32;
            rest -= term as i128;
            // Scaling by a power of two is exact: sums are multiples of 2^-60, far above the smallest float.
            term / SCALE as f32
        })
    }

    /// The sum of one float of [`to_terms`](Self::to_terms), unrounded.
    #[must_use]
    pub fn from_term(term: f32) -> Self {
        Self((f64::from(term) * SCALE) as i128)
    }

    /// The exact state, for checkpoints.
    #[must_use]
    pub const fn to_bytes(self) -> [u8; 16] {
        self.0.to_le_bytes()
    }

    /// The exact state from a checkpoint.
    #[must_use]
    pub const fn from_bytes(bytes: [u8; 16]) -> Self {
        Self(i128::from_le_bytes(bytes))
    }
}

impl Add for ExactSum {
    type Output = Self;
    #[inline]
    fn add(self, other: Self) -> Self {
        Self(self.0.wrapping_add(other.0))
    }
}

impl AddAssign for ExactSum {
    #[inline]
    fn add_assign(&mut self, other: Self) {
        *self = *self + other;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Adding terms of very different size in any order gives the same bits, unlike floating-point addition.
    #[test]
    fn order_does_not_matter() {
        let terms: Vec<f64> =
            (0..1000).map(|i| (f64::from(i) * 0.7).sin() * 10_f64.powi(i % 16 - 8)).collect();
        let forward = terms.iter().fold(ExactSum::ZERO, |sum, t| sum + ExactSum::of(*t));
        let backward = terms.iter().rev().fold(ExactSum::ZERO, |sum, t| sum + ExactSum::of(*t));
        assert_eq!(forward, backward);
        let plain: f64 = terms.iter().sum();
        let reverse: f64 = terms.iter().rev().sum();
        assert_ne!(plain.to_bits(), reverse.to_bits(), "the terms are a hard case for floating point");
        assert!((forward.value() - plain).abs() < 1e-9 * plain.abs());
    }

    /// The largest terms saturate instead of wrapping around.
    #[test]
    fn huge_terms_saturate() {
        assert!(ExactSum::saturates(1e30));
        assert_eq!(ExactSum::of(1e30), ExactSum::of(LARGEST_TERM));
        assert_eq!(ExactSum::of(-1e30).value(), -LARGEST_TERM);
    }

    /// Squares that are too large are counted, whatever else is in the sum and wherever it has been.
    #[test]
    fn huge_squares_are_counted() {
        let mut sum = ExactSum::ZERO;
        for i in 0..20_000 {
            sum += ExactSum::of_square(2.9e10);
            if i % 1000 == 0 {
                assert_eq!(sum.n_saturated(), i / 1000);
                sum += ExactSum::of_square(if i % 2000 == 0 { 1e12 } else { f64::INFINITY });
            }
        }
        let terms = sum.to_terms::<6>();
        let back = terms.iter().fold(ExactSum::ZERO, |s, t| s + ExactSum::from_term(*t));
        assert_eq!([sum.n_saturated(), back.n_saturated()], [20; 2]);
    }

    /// A checkpoint gives back the very same sum.
    #[test]
    fn bytes_round_trip() {
        let sum = ExactSum::of(0.1) + ExactSum::of(-7.25e7);
        assert_eq!(ExactSum::from_bytes(sum.to_bytes()), sum);
    }

    /// Floats that add up to the sum carry it through image files.
    #[test]
    fn terms_round_trip() {
        for value in [0.0, 1.0, -0.1, 1e-15, 2.5e10, 0.123_456_789_012_345_67] {
            let mut sum = ExactSum::ZERO;
            for i in 0..1000 {
                sum += ExactSum::of(value * (1.0 + f64::from(i) * 1e-5));
            }
            let terms = sum.to_terms::<6>();
            let back = terms.iter().fold(ExactSum::ZERO, |s, t| s + ExactSum::from_term(*t));
            assert_eq!(back, sum, "{value}");
        }
    }
}
