//! Inks, and scattering by small particles.

use super::assert_near;
use crate::cmyk::Cmyk;
use crate::scattering::{air, air_index, rayleigh};
use crate::{ColorSpace, ColorSpaceName, LAMBDA_MAX_NM, SpectrumTables, Wavelengths, Xyz};

/// SPEC SPD-5: blue of 450 nm is scattered (650/450)⁴ = 4.353 times as much as red of 650 nm.
#[test]
fn blue_scatters_more_than_red() {
    assert_near(f64::from(rayleigh(450.0) / rayleigh(650.0)), 4.353, 1e-3);
    assert_near(f64::from(rayleigh(550.0)), 1.0, 1e-6);
    let mut tables = SpectrumTables::new();
    let spectrum = tables.add_named("rayleigh").unwrap();
    assert_near(f64::from(spectrum.at(&tables, 450.0) / spectrum.at(&tables, 650.0)), 4.353, 1e-3);
    assert!(spectrum.at(&tables, LAMBDA_MAX_NM) > 0.0 && !spectrum.is_constant());
    let [red, green, blue] = spectrum.bands().rgb();
    assert!(red < green && green < blue, "{red} {green} {blue}");
    let lambda = Wavelengths::sample_visible(0.3);
    let sampled = spectrum.scaled(2.0).sample(&tables, &lambda);
    for (nm, value) in lambda.lambda_nm().into_iter().zip(sampled.to_array()) {
        assert!((value / (2.0 * rayleigh(nm)) - 1.0).abs() < 1e-4, "{nm} nm: {value}");
    }
}

/// Clean air at sea level scatters 1.16 % of light of 550 nm in each kilometre (Bucholtz 1995, "Rayleigh-Scattering
/// Calculations for the Terrestrial Atmosphere"), its index is 1.000278 there, and since that falls with the wavelength the
/// exponent is 4.08 in the middle of the visible range in place of 4.
#[test]
fn air_scatters_as_measured() {
    assert!((air_index(550.0) - 1.000_277_9).abs() < 2e-7, "{}", air_index(550.0));
    // His molecules are a little less round.
    assert_near(air(550.0), 1.16e-5, 0.02);
    assert_near((air(500.0) / air(600.0)).ln() / (600.0_f64 / 500.0).ln(), 4.08, 0.007);
}

/// SPEC SPD-3: inks give their colour back, with any share of black; out of the gamut the nearest component is printed.
#[test]
fn inks_round_trip() {
    let levels = [0.0_f32, 0.1, 0.5, 0.9, 1.0];
    for rgb in
        levels.iter().flat_map(|r| levels.map(|g| [*r, g])).flat_map(|[r, g]| levels.map(|b| [r, g, b]))
    {
        for share in [0.0, 0.4, 1.0] {
            let inks = Cmyk::with_black(rgb, share);
            assert!(inks.to_array().iter().all(|ink| (0.0..=1.0).contains(ink)), "{inks:?}");
            let back = inks.to_rgb();
            assert!((0..3).all(|c| (back[c] - rgb[c]).abs() < 1e-6), "{rgb:?} {inks:?} {back:?}");
        }
        // With full black one of the colours is not needed.
        assert!(Cmyk::from_rgb(rgb).to_array()[..3].iter().any(|ink| *ink < 1e-6));
    }
    assert_eq!(Cmyk::from_rgb([1.5, -0.2, 0.5]), Cmyk::from_rgb([1.0, 0.0, 0.5]));
}

/// Red is magenta and yellow; white paper needs no ink, grey black alone.
#[test]
fn inks_of_known_colors() {
    assert_eq!(Cmyk::from_rgb([1.0, 0.0, 0.0]).to_array(), [0.0, 1.0, 1.0, 0.0]);
    assert_eq!(Cmyk::from_rgb([0.25; 3]).to_array(), [0.0, 0.0, 0.0, 0.75]);
    assert_eq!(Cmyk::with_black([0.25; 3], 0.0).to_array(), [0.75, 0.75, 0.75, 0.0]);
    assert_eq!(Cmyk::from_rgb([0.0; 3]).to_array(), [0.0, 0.0, 0.0, 1.0]);
    let white = ColorSpace::get(ColorSpaceName::Srgb).to_xyz([1.0; 3]);
    assert!(Cmyk::from_xyz(white).to_array().iter().all(|ink| *ink < 1e-4));
    let half = Cmyk::from_xyz(Xyz { x: 0.5 * white.x, y: 0.5 * white.y, z: 0.5 * white.z });
    assert_near(f64::from(half.black), 0.5, 1e-4);
}
