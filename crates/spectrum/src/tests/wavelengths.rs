//! Choice of wavelengths, and values at them.

use etendue_math::statistics::{Moments, interval_chi_square, mean_test};

use super::{SIGNIFICANCE, assert_near, rng_of};
use crate::cie::{CIE_Y_INTEGRAL, integrate_1nm, y_bar};
use crate::{ColorSpace, ColorSpaceName, LAMBDA_MAX_NM, LAMBDA_MIN_NM, Sampled, SpectrumTables, Wavelengths};

type Choice = fn(f32) -> Wavelengths;
const CHOICES: [Choice; 2] = [Wavelengths::sample_visible, Wavelengths::sample_uniform];

#[test]
fn density_is_the_inverse_of_the_slope() {
    // A random number that moves by du moves the wavelength by dλ = du / pdf.
    for choice in CHOICES {
        for i in 1..240 {
            let u = i as f32 / 1000.0;
            let du = 1e-3;
            let (a, b) = (choice(u - du), choice(u + du));
            let middle = choice(u);
            for k in 0..4 {
                let slope = (b.lambda_nm()[k] - a.lambda_nm()[k]) / (2.0 * du);
                if slope > 0.0 {
                    assert_near(f64::from(slope * middle.pdf()[k]), 1.0, 0.01);
                }
            }
        }
    }
}

#[test]
fn every_wavelength_follows_the_density() {
    // Each of the four wavelengths alone is distributed like the first.
    let pdf = |nm: f32| {
        let cosh = (0.0072 * (nm - 538.0)).cosh();
        0.003_939_804_2 / (cosh * cosh)
    };
    let range = [f64::from(LAMBDA_MIN_NM), f64::from(LAMBDA_MAX_NM)];
    let check = |k: usize, factor: f32| {
        interval_chi_square(
            100_000,
            17 + k as u64,
            range,
            |rng| Some(Wavelengths::sample_visible(rng.next_f32()).lambda_nm()[k]),
            |nm| factor * pdf(nm),
            SIGNIFICANCE,
        )
    };
    for k in 0..4 {
        check(k, 1.0).unwrap();
        let wrong = |nm: f32| pdf(nm) * (1.0 + 0.05 * (nm - 538.0).signum());
        interval_chi_square(
            100_000,
            17,
            range,
            |rng| Some(Wavelengths::sample_visible(rng.next_f32()).lambda_nm()[k]),
            wrong,
            SIGNIFICANCE,
        )
        .expect_err("a density off by 5 % is noticed");
    }
}

#[test]
fn wavelengths_stay_in_range_at_the_ends() {
    // The largest random number below 1 and zero give wavelengths of the rendered range with a positive density.
    for choice in CHOICES {
        for u in [0.0, f32::EPSILON, 0.25, 0.5, 0.75, 1.0 - f32::EPSILON / 2.0] {
            let wavelengths = choice(u);
            for k in 0..4 {
                let nm = wavelengths.lambda_nm()[k];
                assert!((LAMBDA_MIN_NM..=LAMBDA_MAX_NM).contains(&nm), "{nm}");
                assert!(wavelengths.pdf()[k] > 0.0);
            }
        }
    }
}

#[test]
fn terminating_the_others_leaves_means_alone() {
    // After dispersion one wavelength carries the light of all four: its density falls to a quarter, once.
    let mut wavelengths = Wavelengths::sample_visible(0.3);
    let before = wavelengths.pdf()[0];
    assert!(!wavelengths.secondary_terminated());
    wavelengths.terminate_secondary();
    wavelengths.terminate_secondary();
    assert!(wavelengths.secondary_terminated());
    assert_eq!(wavelengths.pdf().to_array(), [before / 4.0, 0.0, 0.0, 0.0]);
}

/// SPD-2, and the same for the other choices: mean of value / density against the sum over the table.
#[test]
fn random_wavelengths_estimate_the_integral_of_a_table() {
    // The luminance of daylight on a green leaf is an integral over wavelength, whichever way wavelengths are drawn.
    let mut tables = SpectrumTables::new();
    let space = ColorSpace::get(ColorSpaceName::Srgb);
    let leaf = space.fit_albedo([0.1, 0.4, 0.05]);
    let light = space.rgb_illuminant(&mut tables, [1.0; 3]);
    let expected = f64::from(integrate_1nm(|nm| leaf.at(nm) * light.at(&tables, nm))[1] / CIE_Y_INTEGRAL);
    let estimate = |wavelengths: &Wavelengths, cmf_scale: f32| {
        let value = light.sample(&tables, wavelengths) * leaf.sample(wavelengths);
        let cmf = Sampled::from_array(wavelengths.lambda_nm().map(y_bar)) * cmf_scale;
        f64::from((value * cmf).safe_div(wavelengths.pdf()).average() / CIE_Y_INTEGRAL)
    };
    let terminated: Choice = |u| {
        let mut wavelengths = Wavelengths::sample_visible(u);
        wavelengths.terminate_secondary();
        wavelengths
    };
    let mut rng = rng_of("random_wavelengths_estimate_the_integral_of_a_table");
    for choice in [CHOICES[0], CHOICES[1], Wavelengths::sample_single, terminated] {
        let mut run = |scale: f32| -> Moments {
            (0..200_000).map(|_| estimate(&choice(rng.next_f32()), scale)).collect()
        };
        mean_test(&run(1.0), expected, SIGNIFICANCE).unwrap();
        mean_test(&run(1.05), expected, SIGNIFICANCE).expect_err("an error of 5 % is noticed");
    }
}

#[test]
fn four_wavelengths_are_less_noisy_than_one() {
    // Hero wavelengths spread over the spectrum: the variance of luminance falls well below that of a single one.
    let variance = |choice: Choice| {
        let mut rng = rng_of("four_wavelengths_are_less_noisy_than_one");
        let moments: Moments = (0..20_000)
            .map(|_| {
                let wavelengths = choice(rng.next_f32());
                let cmf = Sampled::from_array(wavelengths.lambda_nm().map(y_bar));
                f64::from(cmf.safe_div(wavelengths.pdf()).average())
            })
            .collect();
        moments.variance()
    };
    assert!(variance(Wavelengths::sample_visible) < 0.05 * variance(Wavelengths::sample_single));
}

#[test]
fn sampled_works_by_component() {
    // Light at different wavelengths does not mix.
    let a = Sampled::from_array([1.0, 2.0, 3.0, 4.0]);
    let b = Sampled::from_array([2.0, 0.0, -1.0, 0.5]);
    assert_eq!((a + b).to_array(), [3.0, 2.0, 2.0, 4.5]);
    assert_eq!((a - b).to_array(), [-1.0, 2.0, 4.0, 3.5]);
    assert_eq!((a * b).to_array(), [2.0, 0.0, -3.0, 2.0]);
    assert_eq!((b / a).to_array(), [2.0, 0.0, -1.0 / 3.0, 0.125]);
    assert_eq!(a.safe_div(b).to_array(), [0.5, 0.0, -3.0, 8.0]);
    assert_eq!((2.0 * a, a * 2.0), (a + a, a + a));
    assert_eq!((-a + a, a.average(), a.sum()), (Sampled::ZERO, 2.5, 10.0));
    assert_eq!((b.max_value(), b.min_value()), (2.0, -1.0));
    assert_eq!(b.clamp(0.0, 1.0).to_array(), [1.0, 0.0, 0.0, 0.5]);
    assert_eq!(a.lerp(b, 0.5), (a + b) * 0.5);
    assert_eq!(Sampled::splat(4.0).sqrt(), Sampled::splat(2.0));
    assert_eq!(Sampled::ZERO.exp(), Sampled::ONE);
    assert!(Sampled::ZERO.is_black());
    assert!(!b.is_black());
    assert!(!(a / Sampled::ZERO).is_finite());
    assert_eq!(std::mem::align_of::<Sampled>(), 16);
}
