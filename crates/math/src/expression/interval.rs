//! Intervals of numbers: operations give intervals that hold all results, whatever the rounding.
//!
//! Sums, products, quotients and roots are rounded correctly, so the neighbouring number is far enough outwards. Elementary
//! functions of common libraries err by less than two units in the last place; four are allowed for.

use std::f64::consts::{FRAC_PI_2, PI, TAU};

use super::nodes::{Binary, Unary};
use super::number::{Number, Scalar};

/// All numbers from `low` to `high`; none if `low` exceeds `high`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Interval {
    /// Least number.
    pub low: f64,
    /// Greatest number.
    pub high: f64,
}

impl Interval {
    /// No number.
    pub const EMPTY: Self = Self { low: f64::INFINITY, high: f64::NEG_INFINITY };
    /// All numbers.
    pub const ENTIRE: Self = Self { low: f64::NEG_INFINITY, high: f64::INFINITY };
    const ZERO: Self = Self { low: 0.0, high: 0.0 };

    /// From one number to another; all numbers if either is NaN.
    #[must_use]
    pub fn new(low: f64, high: f64) -> Self {
        if low.is_nan() || high.is_nan() { Self::ENTIRE } else { Self { low, high } }
    }

    /// One number; none if it is NaN.
    #[must_use]
    pub fn point(value: f64) -> Self {
        if value.is_nan() { Self::EMPTY } else { Self { low: value, high: value } }
    }

    /// True if there is no number in it.
    #[must_use]
    pub fn is_empty(self) -> bool {
        self.low > self.high
    }

    /// True if this number is in it.
    #[must_use]
    pub fn contains(self, value: f64) -> bool {
        self.low <= value && value <= self.high
    }

    /// Largest absolute value; 0 if empty.
    #[must_use]
    pub fn magnitude(self) -> f64 {
        if self.is_empty() { 0.0 } else { self.low.abs().max(self.high.abs()) }
    }

    /// What is in both.
    #[must_use]
    pub fn intersection(self, other: Self) -> Self {
        Self { low: self.low.max(other.low), high: self.high.min(other.high) }
    }

    /// Rounded outwards to the next numbers.
    fn outwards(low: f64, high: f64) -> Self {
        Self::new(low.next_down(), high.next_up())
    }

    /// Rounded outwards by four units in the last place.
    fn wide(low: f64, high: f64) -> Self {
        const ULPS: f64 = 4.0 * f64::EPSILON;
        let down = if low.is_finite() { low - low.abs() * ULPS - f64::MIN_POSITIVE } else { low };
        let up = if high.is_finite() { high + high.abs() * ULPS + f64::MIN_POSITIVE } else { high };
        Self::new(down, up)
    }

    /// A function that rises.
    fn rising(self, f: impl Fn(f64) -> f64) -> Self {
        Self::wide(f(self.low), f(self.high))
    }

    /// A function with a maximum of 1 at `peak`, a minimum of -1 half a turn from there, and the period 2 pi.
    fn wave(self, f: impl Fn(f64) -> f64, peak: f64) -> Self {
        let width = self.high - self.low;
        if width.is_nan() || width >= TAU || self.magnitude() > 1e9 {
            return Self { low: -1.0, high: 1.0 };
        }
        // Peaks just outside count too: rounding may hide them.
        let holds = |at: f64| {
            let turns = |x: f64| (x - at) / TAU;
            (turns(self.low) - 1e-6).ceil() <= turns(self.high) + 1e-6
        };
        let (a, b) = (f(self.low), f(self.high));
        let ends = Self::wide(a.min(b), a.max(b));
        Self {
            low: if holds(peak + PI) { -1.0 } else { ends.low.max(-1.0) },
            high: if holds(peak) { 1.0 } else { ends.high.min(1.0) },
        }
    }

    fn abs(self) -> Self {
        if self.low >= 0.0 {
            self
        } else if self.high <= 0.0 {
            Self { low: -self.high, high: -self.low }
        } else {
            Self { low: 0.0, high: self.magnitude() }
        }
    }

    fn multiply(a: Self, b: Self) -> Self {
        if a == Self::ZERO || b == Self::ZERO {
            return Self::ZERO;
        }
        // Zero times infinity is zero: an infinite end stands for large numbers only.
        let product = |x: f64, y: f64| if x == 0.0 || y == 0.0 { 0.0 } else { x * y };
        let all =
            [product(a.low, b.low), product(a.low, b.high), product(a.high, b.low), product(a.high, b.high)];
        let (low, high) =
            (all[0].min(all[1]).min(all[2].min(all[3])), all[0].max(all[1]).max(all[2].max(all[3])));
        Self::outwards(low, high)
    }

    fn reciprocal(self) -> Self {
        if self == Self::ZERO {
            Self::EMPTY
        } else if self.low < 0.0 && self.high > 0.0 {
            Self::ENTIRE
        } else {
            let low = if self.high == 0.0 { f64::NEG_INFINITY } else { 1.0 / self.high };
            let high = if self.low == 0.0 { f64::INFINITY } else { 1.0 / self.low };
            Self::outwards(low, high)
        }
    }

    fn tangent(self) -> Self {
        let turn = |x: f64| ((x + FRAC_PI_2) / PI).floor();
        let is_smooth = self.high - self.low < PI
            && self.magnitude() < 1e9
            && turn(self.low - 1e-9) == turn(self.high + 1e-9);
        if is_smooth { self.rising(f64::tan) } else { Self::ENTIRE }
    }

    /// True if (x, y) may lie on the cut of the angle, or in the origin.
    fn meets_cut(y: Self, x: Self) -> bool {
        x.low <= 0.0 && y.low <= 0.0 && y.high >= 0.0
    }

    fn angle(y: Self, x: Self) -> Self {
        if Self::meets_cut(y, x) {
            return Self::wide(-PI, PI);
        }
        let corners = [y.low.atan2(x.low), y.low.atan2(x.high), y.high.atan2(x.low), y.high.atan2(x.high)];
        Self::wide(
            corners.into_iter().fold(f64::INFINITY, f64::min),
            corners.into_iter().fold(f64::NEG_INFINITY, f64::max),
        )
    }

    /// A truth value: 1 if surely true, 0 if surely false, else both.
    fn truth_of(surely: bool, surely_not: bool) -> Self {
        Self { low: if surely { 1.0 } else { 0.0 }, high: if surely_not { 0.0 } else { 1.0 } }
    }
}

impl Number for Interval {
    fn constant(value: f64) -> Self {
        Self::point(value)
    }

    fn unary(f: Unary, a: Self) -> Self {
        if a.is_empty() {
            return a;
        }
        let within = |low: f64, high: f64| a.intersection(Self { low, high });
        let domain = match f {
            Unary::Sqrt | Unary::Log => within(0.0, f64::INFINITY),
            Unary::Asin | Unary::Acos => within(-1.0, 1.0),
            _ => a,
        };
        if domain.is_empty() {
            return domain;
        }
        match f {
            Unary::Neg => Self { low: -a.high, high: -a.low },
            Unary::Abs => a.abs(),
            Unary::Sign => Self { low: f64::unary(f, a.low), high: f64::unary(f, a.high) },
            Unary::Sqrt => {
                let root = Self::outwards(domain.low.sqrt(), domain.high.sqrt());
                Self { low: root.low.max(0.0), high: root.high }
            }
            Unary::Exp => {
                let exp = a.rising(f64::exp);
                Self { low: exp.low.max(0.0), high: exp.high }
            }
            Unary::Log => domain.rising(f64::ln),
            Unary::Sin => a.wave(f64::sin, FRAC_PI_2),
            Unary::Cos => a.wave(f64::cos, 0.0),
            Unary::Tan => a.tangent(),
            Unary::Asin => domain.rising(f64::asin),
            Unary::Acos => Self::wide(domain.high.acos(), domain.low.acos()),
            Unary::Atan => a.rising(f64::atan),
            Unary::Sinh => a.rising(f64::sinh),
            Unary::Cosh => {
                let abs = a.abs();
                let cosh = abs.rising(f64::cosh);
                Self { low: cosh.low.max(1.0), high: cosh.high }
            }
            Unary::Tanh => a.rising(f64::tanh).intersection(Self { low: -1.0, high: 1.0 }),
            Unary::Floor => Self { low: a.low.floor(), high: a.high.floor() },
            Unary::Not => Self::truth_of(a == Self::ZERO, !a.contains(0.0)),
        }
    }

    fn binary(f: Binary, a: Self, b: Self) -> Self {
        if a.is_empty() || b.is_empty() {
            return Self::EMPTY;
        }
        match f {
            Binary::Add if a == Self::ZERO => b,
            Binary::Add | Binary::Sub if b == Self::ZERO => a,
            Binary::Add => Self::outwards(a.low + b.low, a.high + b.high),
            Binary::Sub => Self::outwards(a.low - b.high, a.high - b.low),
            Binary::Mul => Self::multiply(a, b),
            Binary::Div if b.low == b.high && b.low != 0.0 => {
                let (x, y) = (a.low / b.low, a.high / b.low);
                if a == Self::ZERO { a } else { Self::outwards(x.min(y), x.max(y)) }
            }
            Binary::Div => {
                let reciprocal = b.reciprocal();
                if reciprocal.is_empty() { reciprocal } else { Self::multiply(a, reciprocal) }
            }
            Binary::Min => Self { low: a.low.min(b.low), high: a.high.min(b.high) },
            Binary::Max => Self { low: a.low.max(b.low), high: a.high.max(b.high) },
            Binary::Atan2 => Self::angle(a, b),
            // exp(b log(a)), where a is not negative; 0 to the power of 0 is 1.
            Binary::Pow => {
                let log = Self::unary(Unary::Log, a);
                let power = Self::unary(Unary::Exp, Self::binary(Binary::Mul, b, log));
                // Exp and log multiply relative errors by the exponent.
                let slack = 8.0 * f64::EPSILON * (1.0 + b.magnitude() * log.magnitude().min(800.0));
                let widened = Self::new(power.low * (1.0 - slack), power.high * (1.0 + slack));
                let has_zero_to_zero = a.contains(0.0) && b.contains(0.0);
                if has_zero_to_zero { Self::hull(widened, Self::point(1.0)) } else { widened }
            }
            Binary::Less => Self::truth_of(a.high < b.low, a.low >= b.high),
            Binary::LessOrEqual => Self::truth_of(a.high <= b.low, a.low > b.high),
            Binary::Equal => Self::truth_of(a == b && a.low == a.high, a.intersection(b).is_empty()),
            Binary::And => {
                let surely = !a.contains(0.0) && !b.contains(0.0);
                Self::truth_of(surely, a == Self::ZERO || b == Self::ZERO)
            }
            Binary::Or => {
                let surely = !a.contains(0.0) || !b.contains(0.0);
                Self::truth_of(surely, a == Self::ZERO && b == Self::ZERO)
            }
        }
    }

    fn power(self, n: i32) -> Self {
        if self.is_empty() {
            return self;
        }
        if n < 0 {
            return self.power(-n).reciprocal();
        }
        let base = if n % 2 == 0 { self.abs() } else { self };
        if n == 1 || base == Self::ZERO {
            return base;
        }
        let (low, high) = (base.low.powi(n), base.high.powi(n));
        // Repeated squares round about once for each bit, and errors double with each.
        let slack = f64::EPSILON * f64::from(n);
        let power = Self::new(
            low - low.abs() * slack - f64::MIN_POSITIVE,
            high + high.abs() * slack + f64::MIN_POSITIVE,
        );
        if n % 2 == 0 { Self { low: power.low.max(0.0), high: power.high } } else { power }
    }

    fn select(condition: Self, a: Self, b: Self) -> Self {
        if condition.is_empty() {
            return condition;
        }
        match condition.truth() {
            Some(true) => a,
            Some(false) => b,
            None => Self::hull(a, b),
        }
    }
}

impl Scalar for Interval {
    fn is_zero(self) -> bool {
        self == Self::ZERO
    }

    fn is_less(a: Self, b: Self) -> Option<bool> {
        if a.is_empty() || b.is_empty() {
            None
        } else if a.high < b.low {
            Some(true)
        } else if a.low >= b.high {
            Some(false)
        } else {
            None
        }
    }

    fn truth(self) -> Option<bool> {
        if self == Self::ZERO {
            Some(false)
        } else if self.contains(0.0) || self.is_empty() {
            None
        } else {
            Some(true)
        }
    }

    fn hull(a: Self, b: Self) -> Self {
        Self { low: a.low.min(b.low), high: a.high.max(b.high) }
    }

    fn slope_of_steps(values: Self) -> Self {
        if values.low == values.high { Self::ZERO } else { Self::ENTIRE }
    }

    fn slope_of_angle(y: Self, x: Self, slope: Self) -> Self {
        if Self::meets_cut(y, x) { Self::ENTIRE } else { slope }
    }

    fn unknown() -> Self {
        Self::ENTIRE
    }
}
