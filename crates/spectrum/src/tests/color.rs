//! Colour spaces and XYZ: SPD-3.

use super::{assert_near, distance, rng_of};
use crate::named::named_spectrum;
use crate::{
    ColorSpace, ColorSpaceName, Spectrum, SpectrumTables, Xyz, daylight, spectrum_to_xyz, white_balance,
};

/// Chromaticity of a named illuminant.
fn chromaticity_of(name: &str) -> [f32; 2] {
    let mut tables = SpectrumTables::new();
    let spectrum = tables.add_named(name).unwrap();
    spectrum_to_xyz(&spectrum, &tables).chromaticity()
}

#[test]
fn rgb_and_xyz_round_trip() {
    // A colour is the same colour in any coordinates, also outside the gamut.
    let mut rng = rng_of("rgb_and_xyz_round_trip");
    for name in ColorSpaceName::ALL {
        let space = ColorSpace::get(name);
        for _ in 0..1000 {
            let rgb = [0; 3].map(|_| 3.0 * rng.next_f32() - 1.0);
            let back = space.to_rgb(space.to_xyz(rgb));
            assert!(distance(rgb, back) < 1e-5, "{name:?}: {rgb:?} became {back:?}");
            assert!((space.luminance(rgb) - space.to_xyz(rgb).y).abs() < 1e-6);
        }
    }
}

#[test]
fn the_illuminant_is_white() {
    // The white of a colour space is RGB (1, 1, 1) with luminance 1; for sRGB it is D65.
    for name in ColorSpaceName::ALL {
        let space = ColorSpace::get(name);
        let mut tables = SpectrumTables::new();
        let table = tables.illuminant(name);
        let xyz = spectrum_to_xyz(&Spectrum::table(table, &tables), &tables);
        assert!(distance(space.to_rgb(xyz), [1.0; 3]) < 1e-5, "{name:?}: {:?}", space.to_rgb(xyz));
        assert_near(f64::from(xyz.y), 1.0, 1e-6);
    }
    let mut tables = SpectrumTables::new();
    let d65 = tables.add_named("stdillum-D65").unwrap();
    let rgb = ColorSpace::get(ColorSpaceName::Srgb).to_rgb(spectrum_to_xyz(&d65, &tables));
    assert!(distance(rgb, [1.0; 3]) < 1e-5, "{rgb:?}");
}

#[test]
fn primaries_have_their_chromaticities() {
    // Pure red, green and blue light of a space lie at the corners of its triangle.
    for name in ColorSpaceName::ALL {
        let space = ColorSpace::get(name);
        for (i, expected) in space.primaries_xy.into_iter().enumerate() {
            let mut rgb = [0.0; 3];
            rgb[i] = 1.0;
            let [x, y] = space.to_xyz(rgb).chromaticity();
            assert!((x - expected[0]).abs() < 1e-4, "{name:?}: {x} instead of {expected:?}");
            assert!((y - expected[1]).abs() < 1e-4, "{name:?}: {y} instead of {expected:?}");
        }
    }
}

#[test]
fn srgb_has_the_published_matrix() {
    // IEC 61966-2-1; ours differs a little because its white comes from the table of D65.
    let published = [[3.2406, -1.5372, -0.4986], [-0.9689, 1.8758, 0.0415], [0.0557, -0.2040, 1.0570]];
    let space = ColorSpace::get(ColorSpaceName::Srgb);
    for (row, expected) in space.rgb_from_xyz.into_iter().zip(published) {
        assert!(distance(row, expected) < 2e-3, "{row:?} instead of {expected:?}");
    }
}

#[test]
fn illuminants_have_their_published_chromaticities() {
    // CIE 015, tables of illuminants; D60 as in SMPTE ST 2065-1.
    for (name, expected) in [
        ("stdillum-A", [0.44758, 0.40745]),
        ("stdillum-D50", [0.34567, 0.35850]),
        ("stdillum-D65", [0.31272, 0.32903]),
        ("illum-acesD60", [0.32168, 0.33767]),
        ("stdillum-F1", [0.3131, 0.3371]),
        ("stdillum-F2", [0.3721, 0.3751]),
        ("stdillum-F7", [0.3129, 0.3292]),
        ("stdillum-F11", [0.3805, 0.3769]),
        ("stdillum-F12", [0.4370, 0.4042]),
    ] {
        let xy = chromaticity_of(name);
        for c in 0..2 {
            assert!((xy[c] - expected[c]).abs() < 5e-4, "{name}: {xy:?} instead of {expected:?}");
        }
    }
}

#[test]
fn chromatic_adaptation_maps_white_to_white() {
    // White balance turns the light's colour into the display's white and keeps its luminance.
    let (a, d65) = (chromaticity_of("stdillum-A"), chromaticity_of("stdillum-D65"));
    let matrix = white_balance(a, d65);
    let source = Xyz::from_chromaticity(a, 1.0).to_array();
    let target = Xyz::from_chromaticity(d65, 1.0).to_array();
    let mapped = matrix.map(|row| row[0] * source[0] + row[1] * source[1] + row[2] * source[2]);
    assert!(distance(mapped, target) < 1e-5, "{mapped:?} instead of {target:?}");
    let identity = white_balance(a, a);
    assert!(distance(identity[0], [1.0, 0.0, 0.0]) < 1e-5);
}

#[test]
fn daylight_of_nominal_temperature_is_the_standard_illuminant() {
    // D65 and D50 are daylight of 6500 K and 5000 K by their old names.
    for (kelvin, name) in [(6500.0, "stdillum-D65"), (5000.0, "stdillum-D50")] {
        let ours = daylight(kelvin);
        let table = named_spectrum(name).unwrap().samples;
        let value = |samples: &[[f32; 2]], nm: f32| samples.iter().find(|s| s[0] == nm).unwrap()[1];
        let reference = ours[200] / value(&table, 560.0);
        for nm in (400..=700).step_by(10) {
            let expected = value(&table, nm as f32) * reference;
            assert_near(f64::from(ours[nm - 360]), f64::from(expected), 0.004);
        }
    }
}

#[test]
fn names_round_trip() {
    // Scene files name colour spaces.
    for name in ColorSpaceName::ALL {
        assert_eq!(ColorSpaceName::from_name(name.name()), Some(name));
        assert_eq!(ColorSpace::get(name).name, name);
    }
    assert_eq!(ColorSpaceName::from_name("cmyk"), None);
}
