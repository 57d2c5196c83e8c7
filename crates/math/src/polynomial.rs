//! Real roots of polynomials of degree four at most, all of them, by Rolle's theorem: between neighbouring roots of the
//! derivative a polynomial is monotonic, so that the signs at both ends tell whether there is a root, and bisection with
//! Newton's steps finds it. No closed form has that certainty: those of Ferrari and Cardano lose digits where roots meet.

/// Largest degree.
pub const MAX_DEGREE: usize = 4;

/// Roots in rising order.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Roots {
    n: usize,
    values: [f64; MAX_DEGREE],
}

impl Roots {
    /// The roots.
    #[must_use]
    pub fn as_slice(&self) -> &[f64] {
        &self.values[..self.n]
    }

    fn push(&mut self, root: f64) {
        if self.n < MAX_DEGREE && self.as_slice().last().is_none_or(|last| *last < root) {
            self.values[self.n] = root;
            self.n += 1;
        }
    }
}

/// The roots of `c[0] + c[1] t + c[2] t² + ...` in [`low`, `high`]. A place where the polynomial touches zero within its
/// own rounding error counts as one root. No roots of the polynomial 0.
#[must_use]
pub fn real_roots(c: &[f64], low: f64, high: f64) -> Roots {
    assert!(c.len() <= MAX_DEGREE + 1, "the degree of the polynomial exceeds {MAX_DEGREE}");
    let mut roots = Roots::default();
    if c.len() < 2 || !low.is_finite() || !high.is_finite() || low > high {
        return roots;
    }
    let mut derivative = [0.0; MAX_DEGREE];
    for (i, slope) in derivative[..c.len() - 1].iter_mut().enumerate() {
        *slope = (i + 1) as f64 * c[i + 1];
    }
    let turns = real_roots(&derivative[..c.len() - 1], low, high);
    let (mut a, mut fa) = (low, value(c, low));
    if fa == 0.0 && !c.iter().all(|c| *c == 0.0) {
        roots.push(a);
    }
    for &b in turns.as_slice().iter().chain([&high]) {
        let fb = value(c, b);
        if fa * fb < 0.0 {
            roots.push(between(c, a, b, fa));
        }
        if b > a && touches(c, b, fb) {
            roots.push(b);
        }
        (a, fa) = (b, fb);
    }
    roots
}

/// Horner's rule.
fn value(c: &[f64], t: f64) -> f64 {
    c.iter().rev().fold(0.0, |sum, c| sum * t + c)
}

/// True if the value is zero within the rounding error of Horner's rule.
fn touches(c: &[f64], t: f64, value_at_t: f64) -> bool {
    let magnitude = c.iter().rev().fold(0.0, |sum, c| sum * t.abs() + c.abs());
    magnitude > 0.0 && value_at_t.abs() <= 4.0 * f64::EPSILON * magnitude
}

/// The only root between `a` and `b`, where the signs differ.
fn between(c: &[f64], mut a: f64, mut b: f64, fa: f64) -> f64 {
    let mut t = 0.5 * (a + b);
    for _ in 0..100 {
        let (mut f, mut slope) = (0.0, 0.0);
        for c in c.iter().rev() {
            slope = slope * t + f;
            f = f * t + c;
        }
        if f == 0.0 {
            return t;
        }
        if (f < 0.0) == (fa < 0.0) {
            a = t;
        } else {
            b = t;
        }
        let newton = t - f / slope;
        let next = if newton > a && newton < b { newton } else { 0.5 * (a + b) };
        if (next - t).abs() <= f64::EPSILON * t.abs() || next <= a || next >= b {
            return next;
        }
        t = next;
    }
    t
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Rng;

    /// The polynomial with these roots.
    fn with_roots(roots: &[f64]) -> Vec<f64> {
        let mut c = vec![1.0];
        for root in roots {
            let mut next = vec![0.0; c.len() + 1];
            for (i, c) in c.iter().enumerate() {
                next[i + 1] += c;
                next[i] -= c * root;
            }
            c = next;
        }
        c
    }

    #[test]
    fn all_roots_are_found() {
        let mut rng = Rng::new(11, 0);
        for case in 0..2000 {
            let mut expected: Vec<f64> =
                (0..1 + case % 4).map(|_| f64::from(rng.next_f32()) * 4.0 - 2.0).collect();
            expected.sort_by(f64::total_cmp);
            if expected.windows(2).any(|pair| pair[1] - pair[0] < 1e-3) {
                continue;
            }
            let found = real_roots(&with_roots(&expected), -3.0, 3.0);
            assert_eq!(found.as_slice().len(), expected.len(), "{found:?}, not {expected:?}");
            for (a, b) in found.as_slice().iter().zip(&expected) {
                // An error of the coefficients of 1e-15 over the slope, a product of three gaps.
                assert!((a - b).abs() < 1e-6, "{found:?}, not {expected:?}");
            }
        }
    }

    /// Double roots, multiple roots, roots at the ends, none, constants.
    #[test]
    fn special_cases() {
        let check = |c: &[f64], expected: &[f64]| {
            let found = real_roots(c, -2.0, 2.0);
            assert_eq!(found.as_slice().len(), expected.len(), "{c:?}: {found:?}");
            assert!(
                found.as_slice().iter().zip(expected).all(|(a, b)| (a - b).abs() < 1e-7),
                "{c:?}: {found:?}"
            );
        };
        check(&with_roots(&[1.0, 1.0]), &[1.0]);
        check(&with_roots(&[0.5, 0.5, -0.5, -0.5]), &[-0.5, 0.5]);
        check(&with_roots(&[2.0, -2.0]), &[-2.0, 2.0]);
        check(&[1.0, 0.0, 1.0], &[]);
        check(&[1.0, 0.0, 0.0, 0.0, 1.0], &[]);
        check(&[-1.0, 0.0, 0.0, 0.0, 1.0], &[-1.0, 1.0]);
        check(&[0.0, 0.0, 0.0, 0.0, 0.0], &[]);
        check(&[3.0], &[]);
        check(&[], &[]);
        check(&[f64::NAN, 1.0, 2.0], &[]);
        assert!(real_roots(&[0.0, 1.0], f64::NEG_INFINITY, 1.0).as_slice().is_empty());
    }
}
