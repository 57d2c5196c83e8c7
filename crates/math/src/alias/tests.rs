//! The table draws in proportion to the weights.

use super::*;
use crate::Rng;
use crate::statistics::{Moments, chi_square_test, mean_test};

#[track_caller]
fn check(weights: &[f32]) {
    let table = AliasTable::new(weights);
    assert_eq!(table.len(), weights.len());
    let sum: f32 = weights.iter().sum();
    let n = 100_000;
    let mut counts = vec![0.0; weights.len()];
    let mut remapped = Moments::new();
    let mut rng = Rng::new(1, weights.len() as u64);
    for _ in 0..n {
        let (index, pmf, u) = table.sample(rng.next_f32());
        assert!((0.0..1.0).contains(&u));
        assert!((pmf - weights[index] / sum).abs() <= 1e-6 * pmf);
        assert_eq!(pmf, table.pmf(index));
        counts[index] += 1.0;
        remapped.push(f64::from(u));
    }
    let expected: Vec<f64> = weights.iter().map(|w| f64::from(*w) / f64::from(sum) * f64::from(n)).collect();
    chi_square_test(&counts, &expected, 5.0, 1e-4).unwrap();
    mean_test(&remapped, 0.5, 1e-4).unwrap();
}

/// Drawn indices follow their weights; the remapped number is uniform again; weight 0 is never drawn.
#[test]
fn draws_follow_the_weights() {
    check(&[1.0]);
    check(&[1.0, 1.0, 1.0]);
    check(&[0.1, 0.2, 0.3, 0.4]);
    check(&[0.0, 5.0, 0.0, 1.0, 0.0]);
    check(&[1e-6, 1e6, 3.0]);
    check(&(0..999).map(|i| (i % 7) as f32).collect::<Vec<f32>>());
}

/// Probabilities sum to 1, also for many weights.
#[test]
fn probabilities_sum_to_one() {
    let weights: Vec<f32> = (0..100_000).map(|i| 1.0 + (i % 13) as f32).collect();
    let table = AliasTable::new(&weights);
    let sum: f64 = (0..table.len()).map(|i| f64::from(table.pmf(i))).sum();
    assert!((sum - 1.0).abs() < 1e-5, "{sum}");
}

/// Darkness has no distribution: whatever is drawn has probability 0.
#[test]
fn weights_of_zero_have_no_probability() {
    let table = AliasTable::new(&[0.0, 0.0]);
    assert_eq!(table.sample(0.7).1, 0.0);
    assert!(AliasTable::new(&[]).is_empty());
}
