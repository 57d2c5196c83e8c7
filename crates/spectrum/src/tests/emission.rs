//! Thermal radiation: EMI-2, EMI-3.

use super::assert_near;
use crate::blackbody::{
    C1, C2, STEFAN_BOLTZMANN, WIEN, exitance, normalized, radiance, total_exitance, wien_peak_nm,
};
use crate::{ColorSpace, ColorSpaceName, Spectrum, SpectrumTables, spectrum_to_xyz};

#[test]
fn radiation_constants_have_their_published_values() {
    // C1' = 2π h c² and C2 = h c / k (CODATA).
    assert_near(C1, 3.7418e-16, 1e-4);
    assert_near(C2, 1.4388e-2, 1e-4);
}

#[test]
fn the_peak_follows_wien() {
    // λ_max T = 2.8978e-3 m K: the sun at 5900 K radiates most at 491 nm.
    assert_near(f64::from(wien_peak_nm(5900.0)), 491.0, 1e-3);
    for kelvin in [1500.0, 2856.0, 5900.0, 10000.0] {
        let peak = WIEN * 1e9 / kelvin;
        let at_peak = exitance(peak, kelvin);
        for step in [0.99, 1.01] {
            assert!(exitance(peak * step, kelvin) < at_peak);
        }
    }
}

#[test]
fn total_exitance_follows_stefan_and_boltzmann() {
    // ∫ M_λ dλ = σ T⁴, integrated over λ = peak · eˢ.
    for kelvin in [300.0, 1000.0, 2856.0, 5900.0, 20000.0] {
        let peak = WIEN * 1e9 / kelvin;
        let step = 1e-3;
        let integral: f64 = (-3000..9000)
            .map(|i| {
                let nm = peak * (f64::from(i) * step).exp();
                exitance(nm, kelvin) * nm * step
            })
            .sum();
        assert_near(integral, total_exitance(kelvin), 1e-6);
        assert_near(total_exitance(kelvin), STEFAN_BOLTZMANN * kelvin.powi(4), 1e-12);
    }
    assert_near(STEFAN_BOLTZMANN, 5.6704e-8, 1e-5);
}

#[test]
fn the_normalised_spectrum_is_planck_over_its_peak() {
    // Relative radiance is 1 at the peak and has Planck's shape.
    for kelvin in [800.0, 2856.0, 6500.0, 30000.0] {
        let peak = wien_peak_nm(kelvin);
        assert_near(f64::from(normalized(peak, kelvin)), 1.0, 1e-5);
        for nm in [360.0, 450.0, 555.0, 700.0, 830.0] {
            let expected = radiance(nm, kelvin) / radiance(peak, kelvin);
            assert_near(f64::from(normalized(nm, kelvin)), f64::from(expected), 1e-4);
        }
    }
    assert_eq!(normalized(360.0, 100.0), 0.0);
    assert_eq!(exitance(500.0, 0.0), 0.0);
}

#[test]
fn radiance_is_exitance_over_pi() {
    // A black body radiates equally in all directions. 5900 K at 500 nm: 2.64e4 W m⁻² sr⁻¹ nm⁻¹.
    assert_near(f64::from(radiance(500.0, 5900.0)), exitance(500.0, 5900.0) / std::f64::consts::PI, 1e-6);
    let by_hand =
        1.191_043e-16 / (500e-9_f64.powi(5) * ((0.014_387_77_f64 / (500e-9 * 5900.0)).exp() - 1.0)) * 1e-9;
    assert_near(f64::from(radiance(500.0, 5900.0)), by_hand, 1e-5);
}

#[test]
fn temperature_gives_the_expected_colour() {
    // 6500 K is nearly white, a candle is orange, a hot star bluish (EMI-3); chromaticities of Planck's locus.
    let tables = SpectrumTables::new();
    let space = ColorSpace::get(ColorSpaceName::Srgb);
    let xyz = |kelvin: f32| spectrum_to_xyz(&Spectrum::blackbody(kelvin), &tables);
    for (kelvin, expected) in
        [(2000.0, [0.5267, 0.4133]), (4000.0, [0.3805, 0.3768]), (6500.0, [0.3135, 0.3237])]
    {
        let xy = xyz(kelvin).chromaticity();
        for c in 0..2 {
            assert!((xy[c] - expected[c]).abs() < 5e-4, "{kelvin} K: {xy:?} instead of {expected:?}");
        }
    }
    let rgb = |kelvin: f32| {
        let value = space.to_rgb(xyz(kelvin));
        let largest = value.into_iter().fold(0.0, f32::max);
        value.map(|c| c / largest)
    };
    assert!(rgb(6500.0).iter().all(|c| *c > 0.9), "{:?}", rgb(6500.0));
    let [r, g, b] = rgb(1900.0);
    assert!(r > 2.0 * g, "{:?}", [r, g, b]);
    assert!(g > 2.0 * b, "{:?}", [r, g, b]);
    let [r, _, b] = rgb(12000.0);
    assert!(b > 1.5 * r, "{r} {b}");
}
