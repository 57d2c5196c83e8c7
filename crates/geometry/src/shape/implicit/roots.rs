//! The first zero of a function along a line, which none comes before: by intervals that hold all values and all slopes.
//!
//! An interval of t is dropped if the values in it exclude zero, or if the slopes do and both ends lie on one side. If the
//! slopes exclude zero and the ends lie on two sides, there is exactly one zero. Otherwise the ends move inwards as far as the
//! slopes forbid a zero (Newton's method on intervals), or the interval is halved. Slopes say nothing across a pole, where the
//! values have no bound. At the width of rounding a change of sign
//! is a zero, and so is a touch; a pole is none.

use etendue_math::expression::Interval;

/// Intervals of values and slopes asked for at most. Then only changes of sign between what is left are found: a safe answer, for
/// functions like sin(1/x) that no other way would end with.
const MAX_QUESTIONS: u32 = 1000;
/// Intervals that wait; the depth of halving is at most 52.
const MAX_WAITING: usize = 64;
/// What an interval of t may hold.
#[derive(Clone, Copy, Debug)]
pub(super) struct Slopes {
    /// All values.
    pub(super) range: Interval,
    /// All slopes.
    pub(super) slope: Interval,
}

/// A function of t.
pub(super) trait Line {
    fn value(&self, t: f64) -> f64;
    /// Values and slopes for t in [a, b].
    fn slopes(&self, a: f64, b: f64) -> Slopes;
    /// Relative width at which halving ends.
    fn finest(&self) -> f64;
}

/// A part of the line with the values at its ends.
#[derive(Clone, Copy, Debug)]
struct Part {
    a: f64,
    fa: f64,
    b: f64,
    fb: f64,
}

impl Part {
    fn changes_sign(&self) -> bool {
        self.fa * self.fb < 0.0 || self.fb == 0.0 || self.fa == 0.0
    }
}

/// The first zero in [0, `end`].
pub(super) fn first_root(line: &impl Line, end: f64) -> Option<f64> {
    let finest = line.finest() * end;
    let mut waiting = [Part { a: 0.0, fa: line.value(0.0), b: end, fb: line.value(end) }; MAX_WAITING];
    let mut n_waiting = 1;
    for question in 0.. {
        if n_waiting == 0 {
            return None;
        }
        n_waiting -= 1;
        let mut part = waiting[n_waiting];
        if question >= MAX_QUESTIONS {
            if part.changes_sign() {
                return Some(refine(line, part, finest));
            }
            continue;
        }
        let Slopes { range, slope } = line.slopes(part.a, part.b);
        // Across a pole a function jumps against its slope.
        let is_bounded = range.low.is_finite() && range.high.is_finite();
        let slope = if is_bounded { slope } else { Interval::ENTIRE };
        if !range.contains(0.0) {
            // A bound that people state may be exceeded by rounding.
            if part.changes_sign() {
                return Some(refine(line, part, finest));
            }
            continue;
        }
        let is_monotonic = !slope.contains(0.0);
        if is_monotonic && part.changes_sign() {
            return Some(refine(line, part, finest));
        }
        if is_monotonic && part.fa.is_finite() && part.fb.is_finite() {
            continue;
        }
        if part.b - part.a <= finest {
            // Values beyond all bounds mean a pole.
            if is_bounded && (part.changes_sign() || slope.magnitude().is_finite()) {
                return Some(part.a);
            }
            continue;
        }
        let width = part.b - part.a;
        if let Some(root) = move_front(line, &mut part, slope, finest) {
            return Some(root);
        }
        if !move_end(line, &mut part, slope) {
            continue;
        }
        if part.b - part.a < 0.6 * width {
            waiting[n_waiting] = part;
            n_waiting += 1;
            continue;
        }
        let m = 0.5 * (part.a + part.b);
        let fm = line.value(m);
        if n_waiting + 2 <= MAX_WAITING {
            waiting[n_waiting] = Part { a: m, fa: fm, ..part };
            waiting[n_waiting + 1] = Part { b: m, fb: fm, ..part };
            n_waiting += 2;
        }
    }
    None
}

/// Moves the start of a part to where the slopes first allow a zero. If rounding let it step over one, that is the answer.
fn move_front(line: &impl Line, part: &mut Part, slope: Interval, finest: f64) -> Option<f64> {
    let step = without_root(part.fa, slope.low, slope.high);
    if step == 0.0 {
        return None;
    }
    let to = part.a + step;
    if to.is_nan() || to >= part.b {
        if part.changes_sign() {
            return Some(refine(line, *part, finest));
        }
        part.a = f64::INFINITY;
        return None;
    }
    let value = line.value(to);
    if value * part.fa < 0.0 {
        return Some(refine(line, Part { b: to, fb: value, ..*part }, finest));
    }
    (part.a, part.fa) = (to, value);
    None
}

/// Moves the end of a part back to where the slopes last allow a zero; false if they allow none.
fn move_end(line: &impl Line, part: &mut Part, slope: Interval) -> bool {
    let b = part.b - without_root(part.fb, -slope.high, -slope.low);
    if b.is_nan() || part.a > b {
        return part.changes_sign();
    }
    let value = line.value(b);
    // Rounding may lead over a zero; then the end stays.
    if value * part.fb > 0.0 {
        (part.b, part.fb) = (b, value);
    }
    true
}

/// How far from a value zero cannot be, for slopes in [low, high] by the way gone.
fn without_root(value: f64, low: f64, high: f64) -> f64 {
    let towards_zero = if value > 0.0 { -low } else { high };
    let step = value.abs() / towards_zero * (1.0 - 1e-10);
    if towards_zero <= 0.0 && value.is_finite() && value != 0.0 {
        f64::INFINITY
    } else if step.is_finite() {
        step
    } else {
        0.0
    }
}

/// The zero between two values of different sign, by false position with halving where that lags (the Illinois method;
/// Dowell and Jarratt 1971).
fn refine(line: &impl Line, part: Part, finest: f64) -> f64 {
    let Part { mut a, mut fa, mut b, mut fb } = part;
    if fa == 0.0 {
        return a;
    }
    // The end that stayed last time.
    let mut stayed = 0;
    for step in 0..200 {
        if b - a <= finest || fb == 0.0 {
            break;
        }
        let secant = b - fb * (b - a) / (fb - fa);
        let is_inside = secant > a && secant < b && step % 4 != 3;
        let m = if is_inside { secant } else { 0.5 * (a + b) };
        if m <= a || m >= b {
            break;
        }
        let fm = line.value(m);
        if fm == 0.0 {
            return m;
        }
        if (fm < 0.0) == (fa < 0.0) {
            fb *= if stayed == 1 { 0.5 } else { 1.0 };
            (a, fa, stayed) = (m, fm, 1);
        } else {
            fa *= if stayed == -1 { 0.5 } else { 1.0 };
            (b, fb, stayed) = (m, fm, -1);
        }
    }
    b
}
