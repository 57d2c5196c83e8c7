//! First points, evenness and scrambling of the sequences (SPEC MC-10, MC-14).

use super::*;
use crate::Rng;
use crate::statistics::{Moments, mean_test};

/// Bases are the primes.
#[test]
fn primes_are_prime() {
    assert_eq!(PRIMES[..8], [2, 3, 5, 7, 11, 13, 17, 19]);
    assert_eq!(PRIMES[N_PRIMES - 1], 719);
}

/// MC-10: the first points of van der Corput, Halton and Sobol.
#[test]
fn first_points() {
    let halton_points = |dimension| [0, 1, 2, 3, 4, 5].map(|i| f64::from(halton(i, dimension)));
    let close = |actual: [f64; 6], expected: [f64; 6]| {
        assert!(actual.iter().zip(expected).all(|(a, e)| (a - e).abs() < 1e-7), "{actual:?}");
    };
    assert_eq!([0, 1, 2, 3, 4, 5].map(van_der_corput), [0.0, 0.5, 0.25, 0.75, 0.125, 0.625]);
    close(halton_points(0), [0.0, 0.5, 0.25, 0.75, 0.125, 0.625]);
    close(halton_points(1), [0.0, 1.0, 2.0, 1.0 / 3.0, 4.0 / 3.0, 7.0 / 3.0].map(|x| x / 3.0));
    close(halton_points(2), [0.0, 0.2, 0.4, 0.6, 0.8, 0.04]);
    assert_eq!([0, 1, 2, 3, 4, 5].map(|i| sobol(i, 0)), [0.0, 0.5, 0.25, 0.75, 0.125, 0.625]);
    assert_eq!([0, 1, 2, 3, 4, 5].map(|i| sobol(i, 1)), [0.0, 0.5, 0.75, 0.25, 0.625, 0.125]);
    assert_eq!([0, 1, 2, 3, 4].map(|i| sobol(i, 2)), [0.0, 0.5, 0.75, 0.25, 0.375]);
}

/// True if of 2^m points one lies in each elementary interval of 2^k by 2^(m - k) cells, for every k.
fn is_net(points: &[(u32, u32)]) -> bool {
    let m = points.len().ilog2();
    (0..=m).all(|k| {
        let mut seen = vec![false; points.len()];
        points.iter().all(|(x, y)| {
            let x = u64::from(*x) >> (32 - k);
            let y = u64::from(*y) >> (32 - (m - k));
            let cell = (x << (m - k) | y) as usize;
            !std::mem::replace(&mut seen[cell], true)
        })
    })
}

/// MC-10: every aligned block of 2^m Sobol points in two dimensions is a (0, m, 2)-net, and stays one when scrambled.
#[test]
fn sobol_points_fill_elementary_intervals() {
    for m in 0..=9 {
        for block in [0, 1, 5] {
            let indices = (block << m)..((block + 1) << m);
            let points: Vec<(u32, u32)> = indices.map(|i| (sobol_bits(i, 0), sobol_bits(i, 1))).collect();
            assert!(is_net(&points), "block {block} of 2^{m}");
            let scrambled: Vec<(u32, u32)> =
                points.iter().map(|(x, y)| (owen_scramble(*x, 17), owen_scramble(*y, 4711))).collect();
            assert!(is_net(&scrambled), "scrambled block {block} of 2^{m}");
        }
    }
    // The test can fail: two dimensions of the same digits are no net.
    assert!(!is_net(&[(0, 0), (1 << 31, 1 << 31), (1 << 30, 1 << 30), (3 << 30, 3 << 30)]));
}

/// Each Sobol dimension alone is stratified: the matrices are invertible, thus the polynomials and numbers are sound.
#[test]
fn each_sobol_dimension_is_stratified() {
    for dimension in 0..N_SOBOL_DIMENSIONS {
        let mut strata: Vec<u32> = (0..1024).map(|i| sobol_bits(i, dimension) >> 22).collect();
        strata.sort_unstable();
        assert!(strata.iter().enumerate().all(|(i, s)| i as u32 == *s), "dimension {dimension}");
    }
    // Joe and Kuo's numbers make any two dimensions different.
    for dimension in 1..N_SOBOL_DIMENSIONS {
        assert_ne!(SOBOL_MATRICES[dimension], SOBOL_MATRICES[dimension - 1]);
    }
}

/// MC-14: evenness orders point sets as expected: Sobol and Halton, then a grid, then random points.
#[test]
fn star_discrepancy_orders_point_sets() {
    let n = 256;
    let set = |point: &dyn Fn(u32) -> (f32, f32)| {
        let points: Vec<Point2> = (0..n).map(point).map(|(x, y)| Point2::new(x, y)).collect();
        star_discrepancy(&points)
    };
    let sobol_points = set(&|i| (sobol(i, 0), sobol(i, 1)));
    let halton_points = set(&|i| (halton(i.into(), 0), halton(i.into(), 1)));
    let grid = set(&|i| (((i % 16) as f32 + 0.5) / 16.0, ((i / 16) as f32 + 0.5) / 16.0));
    let random: Vec<f64> = (0..10)
        .map(|seed| {
            let mut rng = Rng::new(seed, 10);
            star_discrepancy(&(0..n).map(|_| rng.next_point2()).collect::<Vec<Point2>>())
        })
        .collect();
    let random = random.iter().sum::<f64>() / 10.0;
    assert!(sobol_points < 0.02 && halton_points < 0.025, "{sobol_points} {halton_points}");
    assert!(halton_points < grid && grid < random, "{halton_points} {grid} {random}");
    // A centred grid of m by m: the box to the last centres holds all points, the area (1 - 1/(2m))^2.
    assert!((grid - (1.0 - (1.0 - 1.0 / 32.0_f64).powi(2))).abs() < 1e-9, "{grid}");
    // One point in the middle: the closed box up to it holds everything in a quarter of the area.
    assert!((star_discrepancy(&[Point2::new(0.5, 0.5)]) - 0.75).abs() < 1e-12);
}

/// Scrambled digits keep strata, differ by seed, and every point becomes uniform.
#[test]
fn scrambling_keeps_strata_and_removes_bias() {
    for base_index in [0, 1, 4] {
        let base = PRIMES[base_index];
        let n = base * base;
        let mut strata: Vec<u32> =
            (0..n).map(|i| (scrambled_radical_inverse(base_index, i.into(), 99) * n as f32) as u32).collect();
        strata.sort_unstable();
        assert!(strata.iter().enumerate().all(|(i, s)| i as u32 == *s), "base {base}: {strata:?}");
        let seeds = 0..20_000;
        let moments: Moments = seeds
            .map(|seed| f64::from(scrambled_radical_inverse(base_index, 7, crate::mix64(seed))))
            .collect();
        mean_test(&moments, 0.5, 1e-4).unwrap();
        assert!((moments.variance() * 12.0 - 1.0).abs() < 0.05, "variance {}", moments.variance());
    }
    let moments: Moments = (0..20_000)
        .map(|seed| f64::from(unit_f32(owen_scramble(12345, crate::mix64(seed) as u32))))
        .collect();
    mean_test(&moments, 0.5, 1e-4).unwrap();
}

/// Radical inverses never reach 1, also where all digits are the largest.
#[test]
fn radical_inverses_stay_below_one() {
    assert!(radical_inverse(0, u64::MAX) < 1.0);
    assert!(radical_inverse(1, 3_u64.pow(40) - 1) < 1.0);
    assert!(van_der_corput(u32::MAX) < 1.0);
}

/// A permutation takes every value once, and different seeds give different ones.
#[test]
fn permutations_are_bijective() {
    for n in [1, 2, 3, 16, 100, 1000] {
        let permutation = |seed| (0..n).map(|i| permutation_element(i, n, seed)).collect::<Vec<u32>>();
        let mut sorted = permutation(5);
        sorted.sort_unstable();
        assert!(sorted.iter().copied().eq(0..n), "{n}: {sorted:?}");
        assert!(n < 16 || permutation(5) != permutation(6));
    }
    // The first element is uniform over the seeds.
    let first: Moments = (0..20_000).map(|seed| f64::from(permutation_element(0, 10, seed))).collect();
    mean_test(&first, 4.5, 1e-4).unwrap();
}
