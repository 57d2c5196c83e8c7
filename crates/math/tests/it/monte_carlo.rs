//! Estimators of integrals with known values (SPEC MC-1 to MC-9, RAD-12).

use std::f64::consts::{FRAC_PI_4, PI};

use etendue_math::statistics::{Moments, chi_square_test, interval_chi_square, log_log_slope, mean_test};
use etendue_math::{Rng, warp};

const SIGNIFICANCE: f64 = 1e-5;

/// Moments of `n` values of an estimator.
fn estimate(n: usize, seed: u64, mut value: impl FnMut(&mut Rng) -> f64) -> Moments {
    let mut rng = Rng::new(seed, 2026);
    (0..n).map(|_| value(&mut rng)).collect()
}

/// MC-1: the share of random points of a square that hit the quarter disk is its area.
#[test]
fn hit_or_miss_measures_area() {
    let hits = estimate(100_000, 1, |rng| {
        let p = rng.next_point2();
        f64::from(u8::from(p.x * p.x + p.y * p.y < 1.0))
    });
    mean_test(&hits, FRAC_PI_4, SIGNIFICANCE).unwrap();
    // The variance of a hit is p (1 - p).
    assert!((hits.variance() / (FRAC_PI_4 * (1.0 - FRAC_PI_4)) - 1.0).abs() < 0.02);
}

/// MC-2: sample means of the two worked integrals: 2 sin^2 x over [0, pi] is pi, and x over [a, b] is (b^2 - a^2) / 2.
#[test]
fn sample_means_of_the_worked_integrals() {
    let sines = estimate(100_000, 2, |rng| PI * 2.0 * (PI * rng.next_f64()).sin().powi(2));
    mean_test(&sines, PI, SIGNIFICANCE).unwrap();
    let (a, b) = (1.5, 4.0);
    let line = estimate(100_000, 3, |rng| (b - a) * (a + (b - a) * rng.next_f64()));
    mean_test(&line, (b * b - a * a) / 2.0, SIGNIFICANCE).unwrap();
    // MC-4: the variance of one term is (b - a) * integral of f^2 - I^2 = pi * 3 pi / 2 - pi^2.
    assert!((sines.variance() / (0.5 * PI * PI) - 1.0).abs() < 0.02, "{}", sines.variance());
}

/// MC-4: the error of the mean falls as N^(-1/2): four times the samples halve it.
#[test]
fn error_falls_with_the_root_of_samples() {
    let counts = [16, 64, 256, 1024];
    let errors = counts.map(|n| {
        let means = (0..400).map(|trial| estimate(n, 1000 + trial, |rng| rng.next_f64().exp()).mean());
        means.collect::<Moments>().standard_deviation()
    });
    let slope = log_log_slope(&counts.map(|n| n as f64), &errors);
    // The standard deviation of each of the four is known to 3.5 %: that of the slope is about 0.012.
    assert!((slope + 0.5).abs() < 0.05, "slope {slope}: {errors:?}");
}

/// MC-5: the nearer the density to the integrand x^2, the less variance; at p = f / I it is zero.
#[test]
fn importance_sampling_lowers_variance() {
    let f = |x: f64| x * x;
    // Densities (k + 1) x^k by inversion: x = u^(1 / (k + 1)).
    let with_power = |k: f64| {
        estimate(50_000, 4, |rng| {
            let x = (1.0 - rng.next_f64()).powf(1.0 / (k + 1.0));
            f(x) / ((k + 1.0) * x.powf(k))
        })
    };
    let (uniform, linear, exact) = (with_power(0.0), with_power(1.0), with_power(2.0));
    for moments in [&uniform, &linear, &exact] {
        mean_test(moments, 1.0 / 3.0, SIGNIFICANCE).unwrap();
    }
    // Variances: 1/5 - 1/9, 1/8 - 1/9, 0.
    assert!((uniform.variance() / (4.0 / 45.0) - 1.0).abs() < 0.05);
    assert!((linear.variance() / (1.0 / 72.0) - 1.0).abs() < 0.05);
    assert!(exact.variance() < 1e-20);
}

/// MC-5: a density that vanishes faster than the integrand has infinite variance: the estimate of it grows without end.
#[test]
fn bad_densities_have_infinite_variance() {
    // f = 1 with p = 4 x^3: the integral of f^2 / p diverges as eps^-2, so that among N samples variance grows as N^(1/2).
    let variance = |n, seed| {
        estimate(n, seed, |rng| {
            let x = (1.0 - rng.next_f64()).powf(0.25);
            1.0 / (4.0 * x.powi(3))
        })
        .variance()
    };
    let median = |n| {
        let mut variances: Vec<f64> = (0..15).map(|seed| variance(n, 50 + seed)).collect();
        variances.sort_by(f64::total_cmp);
        variances[7]
    };
    let (few, many) = (median(100), median(100_000));
    assert!(many > 8.0 * few, "{few} {many}");
}

/// MC-6: rejection from an envelope M g accepts 1/M of the candidates, and what it accepts has the density.
#[test]
fn rejection_accepts_its_share() {
    // The tent 2 - 2x on [0, 1) under the constant 2.
    let mut tried = 0_u32;
    let mut accepted = 0_u32;
    let draw = |rng: &mut Rng| loop {
        tried += 1;
        let (x, y) = (rng.next_f32(), rng.next_f32());
        if y < 1.0 - x {
            accepted += 1;
            return Some(x);
        }
    };
    interval_chi_square(50_000, 5, [0.0, 1.0], draw, |x| warp::linear_pdf(x, 1.0, 0.0), SIGNIFICANCE)
        .unwrap();
    let (tried, accepted) = (f64::from(tried), f64::from(accepted));
    chi_square_test(&[accepted, tried - accepted], &[0.5 * tried, 0.5 * tried], 5.0, SIGNIFICANCE).unwrap();
}

/// MC-16: the error does not know the dimension: in 1 and in 10 dimensions it falls as N^(-1/2).
#[test]
fn error_does_not_depend_on_dimension() {
    for dimensions in [1, 3, 10] {
        // The product of sqrt(3) (2 x - 1) has mean 0 and variance 1 in every dimension.
        let moments = estimate(40_000, 6, |rng| {
            (0..dimensions).map(|_| 3.0_f64.sqrt() * (2.0 * rng.next_f64() - 1.0)).product()
        });
        mean_test(&moments, 0.0, SIGNIFICANCE).unwrap();
        assert!((moments.variance() - 1.0).abs() < 0.3, "{dimensions}: {}", moments.variance());
    }
}
