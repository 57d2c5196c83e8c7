//! The instruments themselves: known values, coverage, and that a wrong density is found out.

use std::f64::consts::{E, LN_2, PI};

use super::*;
use crate::{Point2, Rng, Vector3, warp};

#[track_caller]
fn close(actual: f64, expected: f64, tolerance: f64) {
    assert!((actual - expected).abs() <= tolerance, "{actual} instead of {expected}");
}

/// Special functions have values in tables.
#[test]
fn special_functions_have_their_known_values() {
    close(ln_gamma(1.0), 0.0, 1e-14);
    close(ln_gamma(0.5), 0.5 * PI.ln(), 1e-13);
    close(ln_gamma(10.0), 362_880.0_f64.ln(), 1e-12);
    close(ln_gamma(0.1), 2.252_712_651_734_206, 1e-12);
    // Gamma distributions of shape 1 are exponential.
    close(regularized_gamma_p(1.0, 2.0), 1.0 - E.powi(-2), 1e-14);
    close(regularized_gamma_q(1.0, 30.0) / E.powi(-30), 1.0, 1e-12);
    close(regularized_gamma_p(3.5, 2.0) + regularized_gamma_q(3.5, 2.0), 1.0, 1e-14);
    close(erf(0.5), 0.520_499_877_813_046_5, 1e-13);
    close(erf(-0.5), -0.520_499_877_813_046_5, 1e-13);
    close(erfc(5.0) / 1.537_459_794_428_034_8e-12, 1.0, 1e-10);
    close(regularized_beta(2.0, 3.0, 0.4), 0.5248, 1e-13);
    close(regularized_beta(2.0, 3.0, 0.9), 0.9963, 1e-13);
}

/// Distribution functions agree with printed quantiles.
#[test]
fn distributions_have_their_known_quantiles() {
    close(normal_cdf(1.959_963_984_540_054), 0.975, 1e-13);
    close(normal_cdf(-6.0) / 9.865_876_450_376_946e-10, 1.0, 1e-10);
    close(normal_quantile(0.975), 1.959_963_984_540_054, 1e-12);
    for p in [1e-12, 1e-5, 0.02, 0.3, 0.5, 0.8, 0.999] {
        close(normal_cdf(normal_quantile(p)) / p, 1.0, 1e-9);
    }
    close(chi_square_sf(18.307_038_053_275_146, 10.0), 0.05, 1e-12);
    close(chi_square_sf(2.0 * LN_2, 2.0), 0.5, 1e-13);
    close(student_t_cdf(1.0, 1.0), 0.75, 1e-13);
    close(student_t_cdf(2.228_138_851_964_939, 10.0), 0.975, 1e-12);
    close(student_t_cdf(-2.228_138_851_964_939, 10.0), 0.025, 1e-12);
    close(student_t_cdf(1.3, 1e7), normal_cdf(1.3), 1e-7);
    close(sidak(0.05, 10), 1.0 - 0.95_f64.powf(0.1), 1e-14);
    close(sidak(1e-3, 1_000_000), 1.000_500_3e-9, 1e-15);
    close(combined_p_value([0.7, sidak(0.05, 3), 0.9]), 0.05, 1e-14);
    close(combined_p_value([1.0, 1.0]), 1.0, 0.0);
}

/// Merged parts know the same as one observer of the whole, also far from zero.
#[test]
fn moments_merge_exactly() {
    let mut rng = Rng::new(1, 1);
    let numbers: Vec<f64> = (0..1000).map(|_| 1e6 + rng.next_f64()).collect();
    let whole: Moments = numbers.iter().copied().collect();
    let mut merged = Moments::new();
    for part in numbers.chunks(77) {
        merged.merge(&part.iter().copied().collect());
    }
    assert_eq!(merged.count(), 1000);
    close(merged.mean(), whole.mean(), 1e-8);
    close(merged.variance() / whole.variance(), 1.0, 1e-8);
    let mean = numbers.iter().sum::<f64>() / 1000.0;
    let variance = numbers.iter().map(|x| (x - mean).powi(2)).sum::<f64>() / 999.0;
    close(whole.variance() / variance, 1.0, 1e-8);
    close(whole.standard_error(), (variance / 1000.0).sqrt(), 1e-9);
}

/// MC-4: of the confidence intervals of level 95 %, 95 % hold the true mean.
#[test]
fn confidence_intervals_cover_the_mean() {
    let mut rng = Rng::new(2, 4);
    let trials = 4000;
    let passed = (0..trials)
        .filter(|_| {
            let moments: Moments = (0..64).map(|_| rng.next_f64()).collect();
            mean_test(&moments, 0.5, 0.05).is_ok()
        })
        .count();
    let sigma = (f64::from(trials) * 0.05 * 0.95).sqrt();
    close(passed as f64, 0.95 * f64::from(trials), 4.0 * sigma);
}

/// Two estimates of one quantity agree; estimates of different quantities do not.
#[test]
fn mean_tests_tell_right_from_wrong() {
    let mut rng = Rng::new(3, 4);
    let mut uniform = |shift: f64| (0..100_000).map(|_| rng.next_f64() + shift).collect::<Moments>();
    let (a, b, shifted) = (uniform(0.0), uniform(0.0), uniform(0.01));
    means_agree(&a, &b, 1e-4).unwrap();
    mean_test(&a, 0.5, 1e-4).unwrap();
    assert!(means_agree(&a, &shifted, 1e-4).is_err());
    assert!(mean_test(&shifted, 0.5, 1e-4).is_err());
}

/// A power law is a straight line on logarithmic axes.
#[test]
fn regression_finds_exponents() {
    let x = [1.0, 2.0, 4.0, 8.0];
    let y = x.map(|x: f64| 3.0 * x.powf(-1.5));
    close(log_log_slope(&x, &y), -1.5, 1e-12);
    let (slope, intercept) = linear_fit(&[0.0, 1.0, 2.0], &[1.0, 3.0, 5.0]);
    close(slope, 2.0, 1e-14);
    close(intercept, 1.0, 1e-14);
}

/// If all is right, p-values are uniform: a test of level 10 % fails in 10 % of cases.
#[test]
fn chi_square_fails_as_often_as_it_says() {
    let mut rng = Rng::new(4, 4);
    let trials = 2000;
    // Uneven cells, some of which need pooling.
    let shares: Vec<f64> = (0..30).map(|i| 0.7_f64.powi(i)).collect();
    let total: f64 = shares.iter().sum();
    let failed = (0..trials)
        .filter(|_| {
            let mut observed = vec![0.0; shares.len()];
            for _ in 0..1000 {
                let mut target = rng.next_f64() * total;
                let cell = shares.iter().position(|s| {
                    target -= s;
                    target < 0.0
                });
                observed[cell.unwrap_or(0)] += 1.0;
            }
            let expected: Vec<f64> = shares.iter().map(|s| s / total * 1000.0).collect();
            chi_square_test(&observed, &expected, 5.0, 0.1).is_err()
        })
        .count();
    // Discreteness of small cells shifts the level a little.
    close(failed as f64 / f64::from(trials), 0.1, 0.03);
}

/// Nothing can be seen where nothing is possible.
#[test]
fn chi_square_rejects_the_impossible() {
    let error = chi_square_test(&[100.0, 1.0], &[101.0, 0.0], 5.0, 1e-9).unwrap_err();
    assert!(error.contains("density is 0"), "{error}");
    assert!(chi_square_test(&[1.0], &[f64::NAN], 5.0, 0.01).is_err());
    let passed = chi_square_test(&[11.0, 9.0, 1.0, 2.0], &[10.0, 10.0, 1.5, 1.5], 5.0, 0.01).unwrap();
    assert_eq!(passed.dof, 1);
}

/// Smooth, kinked and broken integrands over rectangles.
#[test]
fn cubature_reaches_its_tolerance() {
    let unit = Rectangle { x0: 0.0, x1: 1.0, y0: 0.0, y1: 1.0 };
    close(integrate_rectangle(&|x, y| x.powi(5) * y.powi(4), unit, 1e-12, 3), 1.0 / 30.0, 1e-14);
    let circle = |x: f64, y: f64| if x * x + y * y < 1.0 { 1.0 } else { 0.0 };
    // Between a side of the square and the circle that touches it all rules miss a sliver.
    close(integrate_rectangle(&circle, unit, 1e-5, 12), 0.25 * PI, 1e-3);
    close(integrate_sphere(|w| f64::from(w.z.max(0.0)), 1e-5), PI, 1e-4);
}

/// A lobe of cos^n about an axis off the poles, with a density scaled by `factor` and powers that may differ.
fn tilted_lobe(power: f32, pdf_power: f32, factor: f32) -> Result<(), String> {
    let frame = crate::Frame::from_z(Vector3::new(0.6, -0.64, 0.48));
    sphere_chi_square(
        400_000,
        9,
        |rng| Some(frame.to_world(warp::sample_cosine_power(rng.next_point2(), power))),
        |w| factor * warp::cosine_power_pdf(frame.to_local(w).z, pdf_power),
        1e-4,
    )
}

/// Samples of a lobe have the lobe's density, wide or as narrow as a reflection on polished metal.
#[test]
fn sphere_test_accepts_lobes_of_every_width() {
    for power in [1.0, 20.0, 1000.0, 100_000.0] {
        tilted_lobe(power, power, 1.0).unwrap_or_else(|error| panic!("power {power}: {error}"));
    }
}

/// A Gaussian lobe beside a pole: its foot fills corners of cells whose middles it does not reach.
#[test]
fn sphere_test_accepts_the_foot_of_a_gaussian() {
    for (seed, width) in [(11, 0.04), (12, 0.02), (13, 0.005)] {
        let axis = Vector3::new(0.06, 0.06, 0.99639).normalized();
        let frame = crate::Frame::from_z(axis);
        // Slopes with the density exp(-tan² / width²) / (pi width²).
        let lobe = |factor: f32| {
            sphere_chi_square(
                100_000,
                seed,
                |rng| {
                    let tan = width * (-(1.0 - rng.next_f32()).ln()).sqrt();
                    let (sin, cos) = (std::f32::consts::TAU * rng.next_f32()).sin_cos();
                    Some(frame.to_world(Vector3::new(tan * cos, tan * sin, 1.0)).normalized())
                },
                |w| {
                    let v = frame.to_local(w);
                    let slope2 = (v.x * v.x + v.y * v.y) / (v.z * v.z) / (width * width);
                    let density = (-slope2).exp() / (std::f32::consts::PI * width * width * v.z.powi(3));
                    if v.z > 0.0 { factor * density } else { 0.0 }
                },
                1e-4,
            )
        };
        lobe(1.0).unwrap_or_else(|error| panic!("width {width}: {error}"));
        assert!(lobe(0.95).is_err() && lobe(1.05).is_err());
    }
}

/// Mutation: a density that is 5 % off, in scale or in shape, is found out.
#[test]
fn sphere_test_rejects_densities_5_percent_off() {
    for power in [1.0, 20.0, 1000.0, 100_000.0] {
        for (pdf_power, factor) in [(power, 1.05), (power, 0.95), (1.05 * power, 1.0), (0.95 * power, 1.0)] {
            assert!(
                tilted_lobe(power, pdf_power, factor).is_err(),
                "power {power} passed as {factor} times power {pdf_power}"
            );
        }
    }
}

/// If all is right, p-values of the whole test are about uniform, so that one below 0.2 comes up a fifth of the time; a
/// tolerance for the rounding of the integral makes it a little less.
#[test]
fn sphere_test_has_uniform_p_values() {
    let trials = 200;
    let low = (0..trials)
        .filter(|seed| {
            let draw = |rng: &mut Rng| Some(warp::sample_cosine_power(rng.next_point2(), 3.0));
            sphere_p_value(4000, *seed, draw, |w| warp::cosine_power_pdf(w.z, 3.0)) < 0.2
        })
        .count();
    // The cells alone give 1 - sqrt(0.8) each; the mass of this density is 1 and passes always.
    close(low as f64 / trials as f64, 1.0 - 0.8_f64.sqrt(), 0.08);
}

/// Draws without result must be as many as the density lacks to 1.
#[test]
fn sphere_test_accounts_for_missing_mass() {
    let half = |rng: &mut Rng| {
        let w = warp::sample_uniform_sphere(rng.next_point2());
        (w.z > 0.0).then_some(w)
    };
    let whole = warp::uniform_sphere_pdf();
    let upper = |w: Vector3| if w.z > 0.0 { whole } else { 0.0 };
    sphere_chi_square(50_000, 5, half, upper, 1e-4).unwrap();
    assert!(sphere_chi_square(50_000, 5, half, |w| 2.0 * upper(w), 1e-4).is_err());
    assert!(sphere_chi_square(50_000, 5, half, |_| whole, 1e-4).is_err());
}

/// A mixture of a broad and a very narrow lobe: both are resolved.
#[test]
fn sphere_test_sees_both_lobes_of_a_mixture() {
    let check = |narrow_share: f32| {
        sphere_chi_square(
            200_000,
            6,
            |rng| {
                let n = if rng.next_f32() < 0.3 { 20_000.0 } else { 1.0 };
                Some(warp::sample_cosine_power(rng.next_point2(), n))
            },
            |w| {
                narrow_share * warp::cosine_power_pdf(w.z, 20_000.0)
                    + (1.0 - narrow_share) * warp::cosine_power_pdf(w.z, 1.0)
            },
            1e-4,
        )
    };
    check(0.3).unwrap();
    assert!(check(0.315).is_err());
}

/// The same in the unit square and on an interval.
#[test]
fn square_and_interval_tests_tell_right_from_wrong() {
    let squares = |slope: f32| {
        square_chi_square(
            200_000,
            7,
            |rng| Some(Point2::new(rng.next_f32().sqrt(), rng.next_f32())),
            |p| (1.0 - 0.5 * slope) + slope * p.x,
            1e-4,
        )
    };
    squares(2.0).unwrap();
    assert!(squares(1.9).is_err());
    let interval = |rate: f32| {
        interval_chi_square(
            200_000,
            8,
            [0.0, 60.0],
            |rng| Some(warp::sample_exponential(rng.next_f32(), 1.0)),
            |x| warp::exponential_pdf(x, rate),
            1e-4,
        )
    };
    interval(1.0).unwrap();
    assert!(interval(1.05).is_err());
}
