//! Four numbers that are computed at once: plain arrays, whose loops the compiler turns into vector instructions.

use std::ops::{Add, Div, Mul, Sub};

/// Four numbers side by side. Operations go by lane.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[repr(align(16))]
pub struct Lanes4(pub [f32; 4]);

impl Lanes4 {
    /// The same number in each lane.
    #[inline(always)]
    #[must_use]
    pub const fn splat(value: f32) -> Self {
        Self([value; 4])
    }

    /// The function of each lane.
    #[inline(always)]
    #[must_use]
    pub fn map(self, f: impl Fn(f32) -> f32) -> Self {
        let [a, b, c, d] = self.0;
        Self([f(a), f(b), f(c), f(d)])
    }

    /// The function of each pair of lanes.
    #[inline(always)]
    #[must_use]
    pub fn zip_map(self, other: Self, f: impl Fn(f32, f32) -> f32) -> Self {
        let ([a, b, c, d], [e, g, h, i]) = (self.0, other.0);
        Self([f(a, e), f(b, g), f(c, h), f(d, i)])
    }

    /// The smaller of both; `other` where one is NaN.
    #[inline(always)]
    #[must_use]
    pub fn min(self, other: Self) -> Self {
        self.zip_map(other, |a, b| if a < b { a } else { b })
    }

    /// The larger of both; `other` where one is NaN.
    #[inline(always)]
    #[must_use]
    pub fn max(self, other: Self) -> Self {
        self.zip_map(other, |a, b| if a > b { a } else { b })
    }

    /// Magnitudes.
    #[inline(always)]
    #[must_use]
    pub fn abs(self) -> Self {
        self.map(f32::abs)
    }

    /// Square roots; lanes must not be negative.
    #[inline(always)]
    #[must_use]
    pub fn sqrt(self) -> Self {
        self.map(f32::sqrt)
    }

    /// Where `self > limit`, `above`, else `other`.
    #[inline(always)]
    #[must_use]
    pub fn select_above(self, limit: Self, above: Self, other: Self) -> Self {
        let pick = |i: usize| if self.0[i] > limit.0[i] { above.0[i] } else { other.0[i] };
        Self([pick(0), pick(1), pick(2), pick(3)])
    }

    /// Sum of the lanes.
    #[inline(always)]
    #[must_use]
    pub fn sum(self) -> f32 {
        let [a, b, c, d] = self.0;
        (a + b) + (c + d)
    }
}

/// Implements an operator by lane.
macro_rules! by_lane {
    ($trait:ident, $method:ident, $op:tt) => {
        impl $trait for Lanes4 {
            type Output = Self;
            #[inline(always)]
            fn $method(self, other: Self) -> Self {
                self.zip_map(other, |a, b| a $op b)
            }
        }
    };
}

by_lane!(Add, add, +);
by_lane!(Sub, sub, -);
by_lane!(Mul, mul, *);
by_lane!(Div, div, /);

#[cfg(test)]
mod tests {
    use super::*;

    /// Every operation treats each lane as the same operation on numbers would.
    #[test]
    fn lanes_are_numbers() {
        let (a, b) = (Lanes4([1.0, -2.0, 3.5, 0.25]), Lanes4([4.0, 0.5, -1.0, 0.25]));
        for i in 0..4 {
            let (x, y) = (a.0[i], b.0[i]);
            assert_eq!((a + b).0[i], x + y);
            assert_eq!((a - b).0[i], x - y);
            assert_eq!((a * b).0[i], x * y);
            assert_eq!((a / b).0[i], x / y);
            assert_eq!(a.min(b).0[i], x.min(y));
            assert_eq!(a.max(b).0[i], x.max(y));
            assert_eq!(a.abs().sqrt().0[i], x.abs().sqrt());
            assert_eq!(a.select_above(b, a, b).0[i], if x > y { x } else { y });
        }
        assert_eq!(a.sum(), 2.75);
    }
}
