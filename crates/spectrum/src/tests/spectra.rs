//! Spectra in all their forms: SPD-1.

use super::{assert_near, rng_of};
use crate::cie::{CIE_Y_INTEGRAL, x_bar, y_bar, z_bar};
use crate::{
    ColorSpace, ColorSpaceName, Spectrum, SpectrumTables, Wavelengths, spectrum_to_photometric,
    spectrum_to_xyz,
};

/// One spectrum of each form.
fn forms(tables: &mut SpectrumTables) -> Vec<Spectrum> {
    let space = ColorSpace::get(ColorSpaceName::Srgb);
    vec![
        Spectrum::Constant(0.7),
        space.rgb_albedo([0.8, 0.3, 0.1]),
        space.rgb_unbounded([3.0, 0.2, 7.0]),
        space.rgb_illuminant(tables, [2.0, 1.0, 5.0]),
        tables.add_samples(&[[300.0, 1.0], [500.0, 4.0], [520.0, 2.0], [900.0, 3.0]]),
        Spectrum::blackbody(4000.0).scaled(3.0),
    ]
}

#[test]
fn sample_at_and_maximum_agree() {
    // A spectrum is one function, whether looked up singly or at a path's wavelengths, and its bound holds.
    let mut tables = SpectrumTables::new();
    let mut rng = rng_of("sample_at_and_maximum_agree");
    for spectrum in forms(&mut tables) {
        let bound = spectrum.max_value(&tables);
        let mut largest = 0.0_f32;
        for _ in 0..5000 {
            let wavelengths = Wavelengths::sample_uniform(rng.next_f32());
            let values = spectrum.sample(&tables, &wavelengths);
            for k in 0..4 {
                let at = spectrum.at(&tables, wavelengths.lambda_nm()[k]);
                assert!((values[k] - at).abs() <= 1e-6 * at, "{spectrum:?}: {} and {at}", values[k]);
            }
            largest = largest.max(values.max_value());
        }
        assert!(largest <= bound * 1.000_001, "{spectrum:?}: {largest} above {bound}");
        assert!(largest >= bound * 0.5, "{spectrum:?}: {largest} far below {bound}");
    }
}

#[test]
fn scaling_multiplies_values() {
    // Twice the power of a lamp doubles its spectrum at every wavelength.
    let mut tables = SpectrumTables::new();
    for spectrum in forms(&mut tables) {
        for nm in [360.0, 444.4, 555.0, 700.0, 830.0] {
            let (once, twice) = (spectrum.at(&tables, nm), spectrum.scaled(2.0).at(&tables, nm));
            assert_eq!(twice, 2.0 * once, "{spectrum:?}");
        }
    }
}

#[test]
fn equal_energy_integrates_to_the_observer() {
    // ∫ ȳ dλ is the normalisation of tristimulus values; equal energy has X = Y = Z = 1 and Y integral 106.86 nm.
    let tables = SpectrumTables::new();
    let one = Spectrum::Constant(1.0);
    assert_near(f64::from(spectrum_to_photometric(&one, &tables)), f64::from(CIE_Y_INTEGRAL), 1e-6);
    let xyz = spectrum_to_xyz(&one, &tables);
    assert_near(f64::from(xyz.x), 106.8655 / 106.8569, 1e-5);
    assert_near(f64::from(xyz.y), 1.0, 1e-6);
    // The published tables sum to 106.866, 106.857 and 106.892.
    assert_near(f64::from(xyz.z), 106.8922 / 106.8569, 1e-5);
    let [x, y] = xyz.chromaticity();
    assert_near(f64::from(x), 1.0 / 3.0, 1e-3);
    assert_near(f64::from(y), 1.0 / 3.0, 1e-3);
}

#[test]
fn monochromatic_light_has_the_colour_of_its_wavelength() {
    // A line of 1 W at 530 nm has tristimulus values x̄, ȳ, z̄ at 530 nm.
    let mut tables = SpectrumTables::new();
    let line = tables.add_samples(&[[529.0, 0.0], [530.0, 1.0], [531.0, 0.0]]);
    let xyz = spectrum_to_xyz(&line, &tables);
    for (actual, bar) in xyz.to_array().into_iter().zip([x_bar(530.0), y_bar(530.0), z_bar(530.0)]) {
        assert_near(f64::from(actual), f64::from(bar / CIE_Y_INTEGRAL), 1e-6);
    }
}

#[test]
fn samples_are_joined_by_lines() {
    // Measured points are linear between and zero beyond.
    let mut tables = SpectrumTables::new();
    let ramp = tables.add_samples(&[[400.0, 1.0], [500.0, 3.0], [600.0, 2.0]]);
    for (nm, value) in [
        (399.0, 0.0),
        (400.0, 1.0),
        (425.0, 1.5),
        (450.25, 2.005),
        (500.0, 3.0),
        (575.0, 2.25),
        (600.0, 2.0),
        (601.0, 0.0),
        (300.0, 0.0),
        (900.0, 0.0),
    ] {
        assert!((ramp.at(&tables, nm) - value).abs() < 1e-5, "{nm}: {}", ramp.at(&tables, nm));
    }
    let Spectrum::Table { table, .. } = ramp else { panic!("a table") };
    let sum: f32 = tables.table(table).iter().sum();
    // Trapezoids 200 + 250, and half of each end value since both ends jump to zero.
    assert_near(f64::from(sum), 450.0 + 0.5 * (1.0 + 2.0), 1e-5);
}

#[test]
fn narrow_lines_keep_their_power() {
    // A line of a gas discharge may be a tenth of a nanometre wide.
    let mut tables = SpectrumTables::new();
    let line = tables.add_samples(&[[546.0, 0.0], [546.05, 20.0], [546.1, 0.0]]);
    let Spectrum::Table { table, .. } = line else { panic!("a table") };
    let power: f32 = tables.table(table).iter().sum();
    assert_near(f64::from(power), 1.0, 1e-3);
}

#[test]
fn equal_samples_are_a_constant() {
    // Glass without dispersion must not split colours, however its index is written.
    let mut tables = SpectrumTables::new();
    assert_eq!(tables.add_samples(&[[300.0, 1.5], [900.0, 1.5]]), Spectrum::Constant(1.5));
    assert!(!tables.add_samples(&[[400.0, 1.5], [900.0, 1.5]]).is_constant());
    assert_eq!(tables.add_samples(&[]), Spectrum::Constant(0.0));
    assert!(ColorSpace::get(ColorSpaceName::Srgb).rgb_albedo([0.5; 3]).is_constant());
}

#[test]
fn disorderly_samples_are_put_in_order() {
    // A table is a set of points, whatever their order, and a point without a value says nothing.
    let mut tables = SpectrumTables::new();
    let given = tables.add_samples(&[[600.0, 2.0], [400.0, 1.0], [f32::NAN, 1.0], [500.0, f32::INFINITY]]);
    assert!((given.at(&tables, 500.0) - 1.5).abs() < 1e-6);
}

#[test]
fn names_enter_a_table_once() {
    // A hundred gold objects share one table.
    let mut tables = SpectrumTables::new();
    let first = tables.add_named("metal-Au-eta");
    assert!(first.is_some());
    assert_eq!(tables.add_named("metal-Au-eta"), first);
    assert_eq!(tables.len(), 1);
    assert_eq!(tables.add_named("metal-Unobtainium-eta"), None);
    let white = tables.illuminant(ColorSpaceName::Srgb);
    assert_eq!(tables.illuminant(ColorSpaceName::Srgb), white);
    assert_eq!(tables.len(), 2);
}

#[test]
fn only_the_illuminant_counts_for_the_photometric_size() {
    // A light of RGB (2, 2, 2) shall be twice as bright as one of (1, 1, 1), so the RGB stays out of the normalisation.
    let mut tables = SpectrumTables::new();
    let space = ColorSpace::get(ColorSpaceName::Srgb);
    for rgb in [[1.0, 1.0, 1.0], [2.0, 2.0, 2.0], [5.0, 0.1, 0.1]] {
        let light = space.rgb_illuminant(&mut tables, rgb);
        let size = spectrum_to_photometric(&light, &tables);
        assert_near(f64::from(size), f64::from(CIE_Y_INTEGRAL), 1e-5);
    }
}
