//! Mean and variance of a stream of numbers (Welford 1962; merging by Chan, Golub and LeVeque 1979), and tests of means.

use super::distributions::{normal_cdf, student_t_cdf};

/// Count, mean and squared deviations of numbers seen so far.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Moments {
    count: u64,
    mean: f64,
    /// Sum of squared deviations from the mean.
    squares: f64,
}

impl Moments {
    /// Nothing seen yet.
    #[must_use]
    pub const fn new() -> Self {
        Self { count: 0, mean: 0.0, squares: 0.0 }
    }

    /// Takes one number.
    #[inline]
    pub fn push(&mut self, x: f64) {
        self.count += 1;
        let delta = x - self.mean;
        self.mean += delta / self.count as f64;
        self.squares += delta * (x - self.mean);
    }

    /// Takes all that `other` has seen.
    pub fn merge(&mut self, other: &Self) {
        if other.count == 0 {
            return;
        }
        let (n, m) = (self.count as f64, other.count as f64);
        let delta = other.mean - self.mean;
        self.count += other.count;
        self.mean += delta * m / (n + m);
        self.squares += other.squares + delta * delta * n * m / (n + m);
    }

    /// How many numbers.
    #[must_use]
    pub const fn count(&self) -> u64 {
        self.count
    }

    /// Their mean; 0 for none.
    #[must_use]
    pub const fn mean(&self) -> f64 {
        self.mean
    }

    /// Unbiased estimate of the variance of the population; 0 for fewer than two numbers.
    #[must_use]
    pub fn variance(&self) -> f64 {
        if self.count < 2 { 0.0 } else { self.squares / (self.count - 1) as f64 }
    }

    /// Estimate of the standard deviation of the population.
    #[must_use]
    pub fn standard_deviation(&self) -> f64 {
        self.variance().sqrt()
    }

    /// Estimate of the standard deviation of the mean (SPEC MC-4).
    #[must_use]
    pub fn standard_error(&self) -> f64 {
        if self.count == 0 { 0.0 } else { (self.variance() / self.count as f64).sqrt() }
    }
}

impl FromIterator<f64> for Moments {
    fn from_iter<I: IntoIterator<Item = f64>>(numbers: I) -> Self {
        let mut moments = Self::new();
        for x in numbers {
            moments.push(x);
        }
        moments
    }
}

/// Tests that the numbers come from a population of mean `expected`: two-sided, by Student's t. Returns the p-value.
///
/// # Errors
/// If the p-value is below `significance`, with a message for people.
pub fn mean_test(moments: &Moments, expected: f64, significance: f64) -> Result<f64, String> {
    let difference = moments.mean() - expected;
    let error = moments.standard_error();
    // Rounding in the mean of numbers of this size.
    let rounding = 1e-6 * expected.abs();
    if difference.abs() <= rounding {
        return Ok(1.0);
    }
    let dof = moments.count().saturating_sub(1).max(1) as f64;
    let p_value = if error > 0.0 { 2.0 * student_t_cdf(-(difference / error).abs(), dof) } else { 0.0 };
    if p_value >= significance {
        return Ok(p_value);
    }
    Err(format!(
        "mean {} of {} numbers differs from {expected} by {:.2} standard errors of {error:e} (p = {p_value:e})",
        moments.mean(),
        moments.count(),
        difference / error,
    ))
}

/// Tests that two sets of numbers come from populations of the same mean: two-sided, large samples. Returns the p-value.
///
/// # Errors
/// If the p-value is below `significance`, with a message for people.
pub fn means_agree(a: &Moments, b: &Moments, significance: f64) -> Result<f64, String> {
    let difference = a.mean() - b.mean();
    let error = a.standard_error().hypot(b.standard_error());
    if difference.abs() <= 1e-6 * a.mean().abs() {
        return Ok(1.0);
    }
    let p_value = if error > 0.0 { 2.0 * normal_cdf(-(difference / error).abs()) } else { 0.0 };
    if p_value >= significance {
        return Ok(p_value);
    }
    Err(format!(
        "means {} and {} differ by {:.2} standard errors (p = {p_value:e})",
        a.mean(),
        b.mean(),
        difference / error,
    ))
}
