//! Measured data.

use super::assert_near;
use crate::cie::CIE_Y_INTEGRAL;
use crate::{
    LAMBDA_MAX_NM, LAMBDA_MIN_NM, SpectrumTables, known_but_missing, named_spectrum, named_spectrum_names,
    spectrum_to_photometric,
};

/// Value of a named spectrum at a wavelength.
#[track_caller]
fn value(name: &str, nm: f32) -> f32 {
    let mut tables = SpectrumTables::new();
    tables.add_named(name).unwrap().at(&tables, nm)
}

#[test]
fn every_name_leads_to_data_over_the_whole_range() {
    // Wavelengths are drawn from 360 to 830 nm, so data must not end inside.
    let names = named_spectrum_names();
    assert!(names.len() > 45, "{}", names.len());
    for name in &names {
        let samples = named_spectrum(name).unwrap().samples;
        assert!(samples[0][0] <= LAMBDA_MIN_NM, "{name}");
        assert!(samples[samples.len() - 1][0] >= LAMBDA_MAX_NM, "{name}");
        assert!(samples.is_sorted_by(|a, b| a[0] < b[0]), "{name}");
        assert!(samples.iter().all(|s| s[1].is_finite() && s[1] >= 0.0), "{name}");
    }
    for name in ["metal-Xx-eta", "metal-Au-n", "metal-Au", "glass-", "nm", ""] {
        assert_eq!(named_spectrum(name), None, "{name}");
    }
}

#[test]
fn names_of_pbrt_are_known() {
    // Scene files for pbrt-v4 name these.
    for metal in ["Ag", "Al", "Au", "Cu", "CuZn", "MgO", "TiO2"] {
        assert!(named_spectrum(&format!("metal-{metal}-eta")).is_some());
        assert!(named_spectrum(&format!("metal-{metal}-k")).is_some());
    }
    for glass in ["BK7", "BAF10", "FK51A", "LASF9", "F5", "F10", "F11", "SF5", "SF10", "SF11"] {
        assert!(named_spectrum(&format!("glass-{glass}")).is_some(), "{glass}");
    }
    for f in 1..=12 {
        assert!(named_spectrum(&format!("stdillum-F{f}")).is_some());
    }
    assert_eq!(known_but_missing("canon_eos_5d_mkii"), Some("cie1931"));
    assert_eq!(known_but_missing("stdillum-D65"), None);
}

#[test]
fn illuminants_have_unit_luminance() {
    // Lamps of different kinds are compared at equal brightness.
    for name in named_spectrum_names().iter().filter(|name| name.contains("illum-")) {
        let mut tables = SpectrumTables::new();
        let spectrum = tables.add_named(name).unwrap();
        let integral = spectrum_to_photometric(&spectrum, &tables);
        assert_near(f64::from(integral), f64::from(CIE_Y_INTEGRAL), 1e-4);
    }
}

#[test]
fn glasses_have_their_catalogue_index_and_dispersion() {
    // n_d at 587.56 nm, and Abbe's number (n_d − 1) / (n_F − n_C), from the manufacturer.
    for (name, index, abbe) in [
        ("glass-BK7", 1.51680, 64.17),
        ("glass-BAF10", 1.67003, 47.11),
        ("glass-FK51A", 1.48656, 84.47),
        ("glass-LASF9", 1.85025, 32.17),
        ("glass-SF5", 1.67271, 32.25),
        ("glass-SF10", 1.72828, 28.53),
        ("glass-SF11", 1.78472, 25.68),
        ("glass-silica", 1.45846, 67.82),
        ("glass-diamond", 2.41755, 55.3),
    ] {
        let n_d = value(name, 587.56);
        let actual_abbe = (n_d - 1.0) / (value(name, 486.13) - value(name, 656.27));
        assert_near(f64::from(n_d), index, 5e-5);
        assert_near(f64::from(actual_abbe), abbe, 0.01);
    }
    assert_near(f64::from(value("metal-MgO-eta", 589.3)), 1.7374, 1e-4);
    assert_near(f64::from(value("metal-TiO2-eta", 589.3)), 2.613, 1e-3);
}

#[test]
fn metals_have_their_colours() {
    // Reflectance at normal incidence ((η−1)² + k²) / ((η+1)² + k²): gold and copper are red, silver is bright.
    let reflectance = |metal: &str, nm: f32| {
        let eta = value(&format!("metal-{metal}-eta"), nm);
        let k = value(&format!("metal-{metal}-k"), nm);
        ((eta - 1.0).powi(2) + k * k) / ((eta + 1.0).powi(2) + k * k)
    };
    for metal in ["Au", "Cu", "CuZn"] {
        assert!(reflectance(metal, 650.0) > 0.85, "{metal}");
        assert!(reflectance(metal, 450.0) < 0.65, "{metal}");
    }
    for nm in [450.0, 550.0, 650.0] {
        assert!(reflectance("Ag", nm) > 0.95);
        assert!((0.88..0.94).contains(&reflectance("Al", nm)));
    }
}
