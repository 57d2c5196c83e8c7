//! Tests of the crate by subject, and what they share.

mod bands;
mod color;
mod emission;
mod media;
mod named;
mod quantities;
mod sensor;
mod spectra;
mod uplift;
mod wavelengths;

use etendue_math::{Rng, hash64};

use crate::cie::{CIE_Y_INTEGRAL, integrate_1nm};
use crate::{ColorSpace, SigmoidPolynomial, Xyz};

/// Chance that one of the statistical tests of the suite fails by accident, split over its tests.
const SIGNIFICANCE: f64 = 1e-5;

/// Random numbers whose seed is the name of the test.
fn rng_of(test: &str) -> Rng {
    let words: Vec<u64> = test.bytes().map(u64::from).collect();
    Rng::new(hash64(&words), 0)
}

/// Fails unless two numbers differ by at most `tolerance` relative to the second.
#[track_caller]
fn assert_near(actual: f64, expected: f64, tolerance: f64) {
    assert!(
        (actual - expected).abs() <= tolerance * expected.abs(),
        "{actual} instead of {expected}, off by {:e}",
        (actual - expected) / expected
    );
}

/// Largest difference between the components of two colours.
fn distance(a: [f32; 3], b: [f32; 3]) -> f32 {
    (0..3).map(|i| (a[i] - b[i]).abs()).fold(0.0, f32::max)
}

/// Linear RGB of a reflectance under the white of a colour space, by summation over wavelength.
fn rgb_of(space: &ColorSpace, reflectance: &SigmoidPolynomial) -> [f32; 3] {
    let xyz = integrate_1nm(|nm| reflectance.at(nm) * space.illuminant[(nm - 360.0) as usize]);
    space.to_rgb(Xyz::from(xyz.map(|v| v / CIE_Y_INTEGRAL)))
}
