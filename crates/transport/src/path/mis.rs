//! Multiple importance sampling (Veach and Guibas 1995; SPEC MC-12).

/// Weight of the technique of density `p` against another of density `q`, one sample each, by the power heuristic
/// with exponent 2. The two weights of a pair sum to 1.
#[inline]
#[must_use]
pub fn power_heuristic(p: f32, q: f32) -> f32 {
    if p == 0.0 {
        return 0.0;
    }
    // p^2 / (p^2 + q^2), written so that squares cannot overflow.
    let ratio = q / p;
    1.0 / (1.0 + ratio * ratio)
}

/// Weight of the technique of density `p` against another of density `q`, one sample each, by the balance heuristic.
#[inline]
#[must_use]
pub fn balance_heuristic(p: f32, q: f32) -> f32 {
    if p == 0.0 { 0.0 } else { 1.0 / (1.0 + q / p) }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Whatever the densities, the two weights share one unit of light, or unbiasedness is lost.
    #[test]
    fn weights_sum_to_one() {
        for p in [1e-30_f32, 1e-3, 1.0, 7.5, 1e20, 3e38] {
            for q in [0.0, 1e-30, 1e-3, 1.0, 7.5, 1e20, 3e38] {
                for heuristic in [power_heuristic, balance_heuristic] {
                    let sum = heuristic(p, q) + heuristic(q, p);
                    assert!((sum - 1.0).abs() < 1e-6, "p {p} q {q}: {sum}");
                }
            }
        }
    }

    /// The better technique gets more than its share: 4 : 1 in densities is 16 : 1 in weights.
    #[test]
    fn power_two_favours_the_better() {
        assert!((power_heuristic(4.0, 1.0) - 16.0 / 17.0).abs() < 1e-6);
        assert!((balance_heuristic(4.0, 1.0) - 4.0 / 5.0).abs() < 1e-6);
    }
}
