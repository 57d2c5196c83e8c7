//! Pearson's chi-square test: sum over cells of (observed - expected)^2 / expected.

use super::distributions::chi_square_sf;

/// Outcome of a test that passed.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ChiSquare {
    /// The test statistic.
    pub statistic: f64,
    /// Degrees of freedom: cells after pooling, less one.
    pub dof: usize,
    /// Probability of a statistic at least as large if all is right.
    pub p_value: f64,
}

/// Tests that counts come from a multinomial distribution of these expectations, whose totals agree. Cells expected to hold
/// fewer than `min_expected` (usually 5) are pooled.
///
/// # Errors
/// If the p-value is below `significance`, or if something was observed where nothing is possible, with a message for people.
///
/// # Panics
/// If the lengths differ.
pub fn chi_square_test(
    observed: &[f64],
    expected: &[f64],
    min_expected: f64,
    significance: f64,
) -> Result<ChiSquare, String> {
    assert_eq!(observed.len(), expected.len(), "one expectation for each count");
    if let Some(cell) = expected.iter().position(|e| !(e.is_finite() && *e >= 0.0)) {
        return Err(format!("cell {cell} has expectation {}", expected[cell]));
    }
    let cells = pool(observed, expected, min_expected)?;
    let statistic: f64 = cells.iter().map(|(o, e)| (o - e) * (o - e) / e).sum();
    let dof = cells.len().saturating_sub(1);
    let p_value = if dof == 0 { 1.0 } else { chi_square_sf(statistic, dof as f64) };
    if p_value >= significance {
        return Ok(ChiSquare { statistic, dof, p_value });
    }
    let (o, e) = cells
        .iter()
        .copied()
        .max_by(|a, b| ((a.0 - a.1).powi(2) / a.1).total_cmp(&((b.0 - b.1).powi(2) / b.1)))
        .expect("a statistic above 0 has a cell");
    Err(format!(
        "chi-square {statistic:.1} at {dof} degrees of freedom, p = {p_value:e} < {significance:e}; \
         the worst cell holds {o} where {e:.2} are expected"
    ))
}

/// Pairs of observed and expected counts after pooling.
fn pool(observed: &[f64], expected: &[f64], min_expected: f64) -> Result<Vec<(f64, f64)>, String> {
    let mut order: Vec<usize> = (0..expected.len()).collect();
    order.sort_by(|a, b| expected[*a].total_cmp(&expected[*b]));
    let mut cells: Vec<(f64, f64)> = Vec::new();
    let mut pooled = (0.0, 0.0);
    let mut impossible = 0.0;
    for index in order {
        if expected[index] == 0.0 {
            impossible += observed[index];
        }
        pooled = (pooled.0 + observed[index], pooled.1 + expected[index]);
        if pooled.1 >= min_expected {
            cells.push(pooled);
            pooled = (0.0, 0.0);
        }
    }
    if impossible > 0.0 {
        return Err(format!("{impossible} samples where the density is 0"));
    }
    if pooled.1 > 0.0 {
        match cells.last_mut() {
            Some(last) => *last = (last.0 + pooled.0, last.1 + pooled.1),
            None => cells.push(pooled),
        }
    }
    Ok(cells)
}
