//! Formulas that scenes bring along, such as `x^2 + y^2 - z`: read, made short, and evaluated quickly.
//!
//! An [`Expression`] has up to three variables. It is a flat list of steps without repetition, which the same short
//! program runs on numbers, on intervals (so that the result holds every value that the formula takes in a box), and on
//! either with derivatives carried along (forward mode; Griewank and Walther 2008, *Evaluating Derivatives*, chapter 3;
//! Moore 1966, *Interval Analysis*). Outside of the domain of a function the value is NaN, which no
//! comparison or `if` makes a number again; an interval leaves such points out.
//!
//! What may be written: numbers, names, `+ - * / ^`, comparisons `< <= > >= == !=`, `&& || !`, which give 1 or 0, and the functions
//! of [`FUNCTIONS`]. `^` binds before a sign, and to the right: -x^2 = -(x^2), 2^3^2 = 2^9.

mod dual;
mod error;
mod functions;
mod interval;
mod nodes;
mod number;
mod parser;
mod tape;
#[cfg(test)]
mod tests;

pub use error::ExpressionError;
pub use functions::FUNCTIONS;
pub use interval::Interval;

use dual::Dual;
use tape::Tape;

/// Names of constants with their values.
pub const CONSTANTS: &[(&str, f64)] =
    &[("pi", std::f64::consts::PI), ("e", std::f64::consts::E), ("tau", std::f64::consts::TAU)];

/// A formula in up to three variables, ready to be evaluated.
#[derive(Clone, Debug, PartialEq)]
pub struct Expression {
    tape: Tape,
}

impl Expression {
    /// Longest text, in bytes.
    pub const MAX_LENGTH: usize = 1 << 16;

    /// Reads a formula in these variables, at most three; `parameter` knows the values of other names. Names of
    /// variables come before those of parameters, and these before [`CONSTANTS`].
    pub fn parse(
        text: &str,
        variables: &[&str],
        parameter: &mut dyn FnMut(&str) -> Option<f64>,
    ) -> Result<Self, ExpressionError> {
        assert!(variables.len() <= 3, "a formula has at most three variables");
        let (nodes, root) = parser::parse(text, variables, parameter)?;
        Ok(Self { tape: Tape::new(&nodes, root) })
    }

    /// Number of steps, a measure of the time to evaluate.
    #[must_use]
    pub fn n_steps(&self) -> usize {
        self.tape.n_steps()
    }

    /// The value if the formula has no variable in it.
    #[must_use]
    pub fn constant(&self) -> Option<f64> {
        self.tape.constant()
    }

    /// The value at a point; NaN where the formula is not defined.
    #[must_use]
    pub fn value(&self, at: [f64; 3]) -> f64 {
        self.tape.run(&at)
    }

    /// An interval that holds all values in a box; empty if the formula is defined nowhere in it.
    #[must_use]
    pub fn range(&self, over: [Interval; 3]) -> Interval {
        self.tape.run(&over)
    }

    /// The value at a point and its derivatives by the three variables. At a kink the derivatives are those of one side.
    #[must_use]
    pub fn gradient(&self, at: [f64; 3]) -> (f64, [f64; 3]) {
        let result = self.tape.run(&Dual::<f64, 3>::variables(at));
        (result.value, result.slopes)
    }

    /// Intervals that hold all values and all derivatives in a box. A derivative across a jump is the whole line.
    #[must_use]
    pub fn gradient_range(&self, over: [Interval; 3]) -> (Interval, [Interval; 3]) {
        let result = self.tape.run(&Dual::<Interval, 3>::variables(over));
        (result.value, result.slopes)
    }

    /// The same along a line: for arguments in `over` that move with these speeds, values and derivatives by time.
    #[must_use]
    pub fn slope_range(&self, over: [Interval; 3], speeds: [f64; 3]) -> (Interval, Interval) {
        let along = |i: usize| Dual { value: over[i], slopes: [Interval::point(speeds[i])] };
        let result = self.tape.run(&[along(0), along(1), along(2)]);
        (result.value, result.slopes[0])
    }
}
