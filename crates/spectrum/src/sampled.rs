//! Values of a function of wavelength at the few wavelengths of a path.
//!
//! The operations are plain loops over four `f32`, which the compiler turns into SIMD instructions.

use std::ops::{Add, AddAssign, Div, DivAssign, Index, IndexMut, Mul, MulAssign, Neg, Sub, SubAssign};

use crate::N_LAMBDA;

/// One value per wavelength of a path: radiance, reflectance, throughput or a density. All operations go by component.
#[repr(align(16))]
#[derive(Copy, Clone, Debug, PartialEq, Default)]
pub struct Sampled([f32; N_LAMBDA]);

impl Sampled {
    /// 0 at every wavelength.
    pub const ZERO: Self = Self([0.0; N_LAMBDA]);
    /// 1 at every wavelength.
    pub const ONE: Self = Self([1.0; N_LAMBDA]);

    /// The same value at every wavelength.
    #[inline]
    #[must_use]
    pub const fn splat(value: f32) -> Self {
        Self([value; N_LAMBDA])
    }

    /// The given values.
    #[inline]
    #[must_use]
    pub const fn from_array(values: [f32; N_LAMBDA]) -> Self {
        Self(values)
    }

    /// The values.
    #[inline]
    #[must_use]
    pub const fn to_array(self) -> [f32; N_LAMBDA] {
        self.0
    }

    /// The function applied to each value.
    #[inline]
    #[must_use]
    pub fn map(self, f: impl Fn(f32) -> f32) -> Self {
        Self(std::array::from_fn(|i| f(self.0[i])))
    }

    /// The function applied to each pair of values.
    #[inline]
    #[must_use]
    pub fn zip_map(self, other: Self, f: impl Fn(f32, f32) -> f32) -> Self {
        Self(std::array::from_fn(|i| f(self.0[i], other.0[i])))
    }

    /// The largest value.
    #[inline]
    #[must_use]
    pub fn max_value(self) -> f32 {
        // Plain comparisons: `f32::max` costs three times as much for what it promises of NaN.
        let max = |a: f32, b: f32| if a > b { a } else { b };
        let [a, b, c, d] = self.0;
        max(max(a, b), max(c, d))
    }

    /// The smallest value.
    #[inline]
    #[must_use]
    pub fn min_value(self) -> f32 {
        let min = |a: f32, b: f32| if a < b { a } else { b };
        let [a, b, c, d] = self.0;
        min(min(a, b), min(c, d))
    }

    /// Sum of the values.
    #[inline]
    #[must_use]
    pub fn sum(self) -> f32 {
        let [a, b, c, d] = self.0;
        (a + b) + (c + d)
    }

    /// Mean of the values.
    #[inline]
    #[must_use]
    pub fn average(self) -> f32 {
        self.sum() * (1.0 / N_LAMBDA as f32)
    }

    /// Whether every value is exactly zero.
    #[inline]
    #[must_use]
    pub fn is_black(self) -> bool {
        self.0 == [0.0; N_LAMBDA]
    }

    /// Whether no value is infinite or NaN.
    #[inline]
    #[must_use]
    pub fn is_finite(self) -> bool {
        self.0.iter().all(|v| v.is_finite())
    }

    /// Square root of each value; values must not be negative.
    #[inline]
    #[must_use]
    pub fn sqrt(self) -> Self {
        self.map(f32::sqrt)
    }

    /// `e` to the power of each value.
    #[inline]
    #[must_use]
    pub fn exp(self) -> Self {
        self.map(f32::exp)
    }

    /// Each value to the given power.
    #[inline]
    #[must_use]
    pub fn powf(self, exponent: f32) -> Self {
        self.map(|v| v.powf(exponent))
    }

    /// Magnitude of each value.
    #[inline]
    #[must_use]
    pub fn abs(self) -> Self {
        self.map(f32::abs)
    }

    /// Each value limited to `[low, high]`.
    #[inline]
    #[must_use]
    pub fn clamp(self, low: f32, high: f32) -> Self {
        self.map(|v| v.clamp(low, high))
    }

    /// The smaller of both, by component.
    #[inline]
    #[must_use]
    pub fn min(self, other: Self) -> Self {
        self.zip_map(other, f32::min)
    }

    /// The larger of both, by component.
    #[inline]
    #[must_use]
    pub fn max(self, other: Self) -> Self {
        self.zip_map(other, f32::max)
    }

    /// Quotient that is 0 where the divisor is 0.
    #[inline]
    #[must_use]
    pub fn safe_div(self, other: Self) -> Self {
        self.zip_map(other, |a, b| if b == 0.0 { 0.0 } else { a / b })
    }

    /// `self` at `t = 0`, `other` at `t = 1`.
    #[inline]
    #[must_use]
    pub fn lerp(self, other: Self, t: f32) -> Self {
        self * (1.0 - t) + other * t
    }
}

impl From<[f32; N_LAMBDA]> for Sampled {
    #[inline]
    fn from(values: [f32; N_LAMBDA]) -> Self {
        Self(values)
    }
}

impl Index<usize> for Sampled {
    type Output = f32;
    #[inline]
    fn index(&self, i: usize) -> &f32 {
        &self.0[i]
    }
}

impl IndexMut<usize> for Sampled {
    #[inline]
    fn index_mut(&mut self, i: usize) -> &mut f32 {
        &mut self.0[i]
    }
}

impl Neg for Sampled {
    type Output = Self;
    #[inline]
    fn neg(self) -> Self {
        self.map(|v| -v)
    }
}

/// Implements one operator with `Sampled` and `f32` on the right, and its assigning form.
macro_rules! by_component {
    ($trait:ident, $method:ident, $assign_trait:ident, $assign_method:ident, $op:tt) => {
        impl $trait for Sampled {
            type Output = Self;
            #[inline]
            fn $method(self, other: Self) -> Self {
                self.zip_map(other, |a, b| a $op b)
            }
        }
        impl $trait<f32> for Sampled {
            type Output = Self;
            #[inline]
            fn $method(self, other: f32) -> Self {
                self.map(|a| a $op other)
            }
        }
        impl $assign_trait for Sampled {
            #[inline]
            fn $assign_method(&mut self, other: Self) {
                *self = *self $op other;
            }
        }
        impl $assign_trait<f32> for Sampled {
            #[inline]
            fn $assign_method(&mut self, other: f32) {
                *self = *self $op other;
            }
        }
    };
}

by_component!(Add, add, AddAssign, add_assign, +);
by_component!(Sub, sub, SubAssign, sub_assign, -);
by_component!(Mul, mul, MulAssign, mul_assign, *);
by_component!(Div, div, DivAssign, div_assign, /);

impl Mul<Sampled> for f32 {
    type Output = Sampled;
    #[inline]
    fn mul(self, other: Sampled) -> Sampled {
        other * self
    }
}

impl std::iter::Sum for Sampled {
    fn sum<I: Iterator<Item = Self>>(values: I) -> Self {
        values.fold(Self::ZERO, |a, b| a + b)
    }
}
