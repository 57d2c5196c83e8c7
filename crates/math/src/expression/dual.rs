//! Numbers with derivatives carried along: each rule of calculus once, for numbers and for intervals.

use super::nodes::{Binary, Unary};
use super::number::{Number, Scalar};

/// A value and its derivatives by N variables.
#[derive(Clone, Copy, Debug)]
pub(super) struct Dual<T, const N: usize> {
    pub(super) value: T,
    pub(super) slopes: [T; N],
}

impl<T: Scalar> Dual<T, 3> {
    /// The three variables themselves.
    pub(super) fn variables(at: [T; 3]) -> [Self; 3] {
        let unit = |i: usize| std::array::from_fn(|j| T::constant(if i == j { 1.0 } else { 0.0 }));
        std::array::from_fn(|i| Self { value: at[i], slopes: unit(i) })
    }
}

fn add<T: Number>(a: T, b: T) -> T {
    T::binary(Binary::Add, a, b)
}

fn sub<T: Number>(a: T, b: T) -> T {
    T::binary(Binary::Sub, a, b)
}

fn mul<T: Number>(a: T, b: T) -> T {
    T::binary(Binary::Mul, a, b)
}

fn div<T: Number>(a: T, b: T) -> T {
    T::binary(Binary::Div, a, b)
}

/// The derivative of a function of one argument `a` with the value `f`.
fn slope<T: Scalar>(function: Unary, a: T, f: T) -> T {
    let one = T::constant(1.0);
    let square_root_of_rest = || T::unary(Unary::Sqrt, sub(one, a.power(2)));
    match function {
        Unary::Neg => T::constant(-1.0),
        Unary::Abs => T::unary(Unary::Sign, a),
        Unary::Sqrt => div(T::constant(0.5), f),
        Unary::Exp => f,
        Unary::Log => div(one, a),
        Unary::Sin => T::unary(Unary::Cos, a),
        Unary::Cos => T::unary(Unary::Neg, T::unary(Unary::Sin, a)),
        Unary::Tan => add(one, f.power(2)),
        Unary::Asin => div(one, square_root_of_rest()),
        Unary::Acos => div(T::constant(-1.0), square_root_of_rest()),
        Unary::Atan => div(one, add(one, a.power(2))),
        Unary::Sinh => T::unary(Unary::Cosh, a),
        Unary::Cosh => T::unary(Unary::Sinh, a),
        Unary::Tanh => sub(one, f.power(2)),
        Unary::Sign | Unary::Floor | Unary::Not => T::slope_of_steps(f),
    }
}

impl<T: Scalar, const N: usize> Dual<T, N> {
    fn with(value: T, slope: impl Fn(usize) -> T) -> Self {
        Self { value, slopes: std::array::from_fn(slope) }
    }

    /// Either, whichever holds; both where that depends.
    fn either(is_first: Option<bool>, value: T, a: Self, b: Self) -> Self {
        match is_first {
            Some(true) => a,
            Some(false) => b,
            None => Self::with(value, |i| T::hull(a.slopes[i], b.slopes[i])),
        }
    }
}

impl<T: Scalar, const N: usize> Number for Dual<T, N> {
    fn constant(value: f64) -> Self {
        Self::with(T::constant(value), |_| T::constant(0.0))
    }

    fn unary(f: Unary, a: Self) -> Self {
        let value = T::unary(f, a.value);
        let slope = slope(f, a.value, value);
        Self::with(value, |i| if a.slopes[i].is_zero() { a.slopes[i] } else { mul(slope, a.slopes[i]) })
    }

    fn binary(f: Binary, a: Self, b: Self) -> Self {
        let value = T::binary(f, a.value, b.value);
        let (da, db) = (a.slopes, b.slopes);
        match f {
            Binary::Add => Self::with(value, |i| add(da[i], db[i])),
            Binary::Sub => Self::with(value, |i| sub(da[i], db[i])),
            Binary::Mul => Self::with(value, |i| add(mul(da[i], b.value), mul(a.value, db[i]))),
            Binary::Div => Self::with(value, |i| div(sub(da[i], mul(value, db[i])), b.value)),
            Binary::Min => Self::either(T::is_less(a.value, b.value), value, a, b),
            Binary::Max => Self::either(T::is_less(b.value, a.value), value, a, b),
            Binary::Atan2 => {
                let square = add(a.value.power(2), b.value.power(2));
                Self::with(value, |i| {
                    let slope = div(sub(mul(b.value, da[i]), mul(a.value, db[i])), square);
                    T::slope_of_angle(a.value, b.value, slope)
                })
            }
            Binary::Pow => {
                let below = T::binary(Binary::Pow, a.value, sub(b.value, T::constant(1.0)));
                let by_base = mul(b.value, below);
                let by_exponent = mul(value, T::unary(Unary::Log, a.value));
                Self::with(value, |i| {
                    let base = mul(by_base, da[i]);
                    if db[i].is_zero() { base } else { add(base, mul(by_exponent, db[i])) }
                })
            }
            Binary::Less | Binary::LessOrEqual | Binary::Equal | Binary::And | Binary::Or => {
                Self::with(value, |_| T::slope_of_steps(value))
            }
        }
    }

    fn power(self, n: i32) -> Self {
        let slope = mul(T::constant(f64::from(n)), self.value.power(n - 1));
        Self::with(self.value.power(n), |i| mul(slope, self.slopes[i]))
    }

    fn select(condition: Self, a: Self, b: Self) -> Self {
        match condition.value.truth() {
            Some(true) => a,
            Some(false) => b,
            // There may be a jump.
            None => Self::with(T::select(condition.value, a.value, b.value), |_| T::unknown()),
        }
    }
}
