//! What a formula can be evaluated on.

use super::nodes::{Binary, Unary};

/// Numbers, intervals, and either with derivatives.
pub(super) trait Number: Copy {
    fn constant(value: f64) -> Self;
    fn unary(f: Unary, a: Self) -> Self;
    fn binary(f: Binary, a: Self, b: Self) -> Self;
    fn power(self, n: i32) -> Self;
    /// `a` where the condition is not 0, else `b`; nothing where the condition has no value.
    fn select(condition: Self, a: Self, b: Self) -> Self;
}

/// Numbers that have derivatives: what carrying those along needs to know besides.
pub(super) trait Scalar: Number {
    /// True if nothing but 0.
    fn is_zero(self) -> bool;
    /// Whether all of `a` are less than all of `b`, or none is; `None` if that depends, or if one has no value.
    fn is_less(a: Self, b: Self) -> Option<bool>;
    /// Whether a condition holds; `None` if that depends, or if it has no value.
    fn truth(self) -> Option<bool>;
    /// What holds both.
    fn hull(a: Self, b: Self) -> Self;
    /// The slope of a step function with these values: 0 but where it jumps.
    fn slope_of_steps(values: Self) -> Self;
    /// The slope of atan2(y, x), given the quotient that is right but across its cut.
    fn slope_of_angle(y: Self, x: Self, slope: Self) -> Self;
    /// A slope of which nothing is known.
    fn unknown() -> Self;
}

const fn truth(condition: bool) -> f64 {
    if condition { 1.0 } else { 0.0 }
}

/// A function that is not defined where an operand is not, so that an interval may leave such points out.
fn defined(a: f64, b: f64, value: impl FnOnce(f64, f64) -> f64) -> f64 {
    if a.is_nan() || b.is_nan() { f64::NAN } else { value(a, b) }
}

impl Number for f64 {
    fn constant(value: f64) -> Self {
        value
    }

    #[inline]
    fn unary(f: Unary, a: Self) -> Self {
        match f {
            Unary::Neg => -a,
            Unary::Abs => a.abs(),
            Unary::Sign => defined(a, a, |a, _| truth(a > 0.0) - truth(a < 0.0)),
            Unary::Sqrt => a.sqrt(),
            Unary::Exp => a.exp(),
            Unary::Log => a.ln(),
            Unary::Sin => a.sin(),
            Unary::Cos => a.cos(),
            Unary::Tan => a.tan(),
            Unary::Asin => a.asin(),
            Unary::Acos => a.acos(),
            Unary::Atan => a.atan(),
            Unary::Sinh => a.sinh(),
            Unary::Cosh => a.cosh(),
            Unary::Tanh => a.tanh(),
            Unary::Floor => a.floor(),
            Unary::Not => defined(a, a, |a, _| truth(a == 0.0)),
        }
    }

    #[inline]
    fn binary(f: Binary, a: Self, b: Self) -> Self {
        match f {
            Binary::Add => a + b,
            Binary::Sub => a - b,
            Binary::Mul => a * b,
            Binary::Div => a / b,
            Binary::Min => defined(a, b, Self::min),
            Binary::Max => defined(a, b, Self::max),
            Binary::Atan2 => a.atan2(b),
            Binary::Pow if a < 0.0 => Self::NAN,
            Binary::Pow => defined(a, b, Self::powf),
            Binary::Less => defined(a, b, |a, b| truth(a < b)),
            Binary::LessOrEqual => defined(a, b, |a, b| truth(a <= b)),
            Binary::Equal => defined(a, b, |a, b| truth(a == b)),
            Binary::And => defined(a, b, |a, b| truth(a != 0.0 && b != 0.0)),
            Binary::Or => defined(a, b, |a, b| truth(a != 0.0 || b != 0.0)),
        }
    }

    #[inline]
    fn power(self, n: i32) -> Self {
        self.powi(n)
    }

    #[inline]
    fn select(condition: Self, a: Self, b: Self) -> Self {
        match Scalar::truth(condition) {
            Some(true) => a,
            Some(false) => b,
            None => Self::NAN,
        }
    }
}

impl Scalar for f64 {
    fn is_zero(self) -> bool {
        self == 0.0
    }

    fn is_less(a: Self, b: Self) -> Option<bool> {
        a.partial_cmp(&b).map(|order| order.is_lt())
    }

    fn truth(self) -> Option<bool> {
        (!self.is_nan()).then_some(self != 0.0)
    }

    fn hull(a: Self, _: Self) -> Self {
        a
    }

    fn slope_of_steps(_: Self) -> Self {
        0.0
    }

    fn slope_of_angle(_: Self, _: Self, slope: Self) -> Self {
        slope
    }

    fn unknown() -> Self {
        Self::NAN
    }
}
