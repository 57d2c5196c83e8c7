//! Straight lines through points, and the order of convergence read from them.

/// Slope and intercept of the line of least squares through (x, y).
///
/// # Panics
/// If there are fewer than two points or the lengths differ.
#[must_use]
pub fn linear_fit(x: &[f64], y: &[f64]) -> (f64, f64) {
    assert_eq!(x.len(), y.len(), "one y for each x");
    assert!(x.len() >= 2, "a line needs two points");
    let n = x.len() as f64;
    let mean_x = x.iter().sum::<f64>() / n;
    let mean_y = y.iter().sum::<f64>() / n;
    let covariance: f64 = x.iter().zip(y).map(|(x, y)| (x - mean_x) * (y - mean_y)).sum();
    let variance: f64 = x.iter().map(|x| (x - mean_x) * (x - mean_x)).sum();
    let slope = covariance / variance;
    (slope, mean_y - slope * mean_x)
}

/// The exponent k of `y = c x^k` that fits best on logarithmic axes; all numbers must be above 0.
#[must_use]
pub fn log_log_slope(x: &[f64], y: &[f64]) -> f64 {
    let log = |values: &[f64]| values.iter().map(|v| v.ln()).collect::<Vec<f64>>();
    linear_fit(&log(x), &log(y)).0
}
