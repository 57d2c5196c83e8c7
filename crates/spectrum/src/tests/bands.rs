//! Bands of linear sRGB in place of wavelengths: SPD-4.

use etendue_math::statistics::{Moments, mean_test};

use super::{SIGNIFICANCE, assert_near, distance, rng_of};
use crate::cie::{CIE_Y_INTEGRAL, integrate_1nm};
use crate::{
    Bands, ColorSpace, ColorSpaceName, Sampled, Sensor, SensorSettings, Spectrum, SpectrumTables,
    Wavelengths, spectrum_to_photometric, spectrum_to_xyz,
};

/// Choices of the first band: red, green and blue.
const FIRST: [f32; 3] = [0.1, 0.5, 0.9];

fn srgb() -> &'static ColorSpace {
    ColorSpace::get(ColorSpaceName::Srgb)
}

/// Red, green and blue of a spectrum as a path that starts with this band sees it.
fn seen(spectrum: &Spectrum, tables: &SpectrumTables, u: f32) -> [f32; 3] {
    let bands = Wavelengths::bands(u);
    bands.estimate_bands(spectrum.sample(tables, &bands)).unwrap()
}

/// What the film records of light that is divided so that its luminance is 1, in the bands.
fn recorded_in_bands(sensor: &Sensor, light: &Spectrum, tables: &SpectrumTables) -> [f32; 3] {
    let light = light.as_light(tables).scaled(1.0 / spectrum_to_photometric(light, tables));
    let bands = Wavelengths::bands(0.4);
    sensor.sensor_rgb(light.sample(tables, &bands), &bands)
}

/// The same with many wavelengths.
fn recorded(sensor: &Sensor, light: &Spectrum, tables: &SpectrumTables) -> [f32; 3] {
    let light = light.scaled(1.0 / spectrum_to_photometric(light, tables));
    let n = 20_000;
    let mut sum = [0.0_f64; 3];
    for i in 0..n {
        let wavelengths = Wavelengths::sample_visible((i as f32 + 0.5) / n as f32);
        let rgb = sensor.sensor_rgb(light.sample(tables, &wavelengths), &wavelengths);
        for c in 0..3 {
            sum[c] += f64::from(rgb[c]) / f64::from(n);
        }
    }
    sum.map(|v| v as f32)
}

#[test]
fn a_constant_is_the_same_in_both() {
    // A grey wall reflects as much of a band as of a wavelength; so does one that a table describes.
    let mut tables = SpectrumTables::new();
    let table = tables.add_dense(|_| 0.3);
    let grey = [
        Spectrum::Constant(0.3),
        Spectrum::table(table, &tables),
        srgb().rgb_albedo([0.3; 3]),
        ColorSpace::get(ColorSpaceName::Aces2065_1).rgb_albedo([0.3; 3]),
        ColorSpace::get(ColorSpaceName::Rec2020).rgb_unbounded([0.3; 3]),
    ];
    for spectrum in grey {
        for lambda in [Wavelengths::sample_visible(0.7), Wavelengths::bands(0.7)] {
            let values = spectrum.sample(&tables, &lambda);
            assert!((values - Sampled::splat(0.3)).map(f32::abs).max_value() < 1e-6, "{values:?}");
        }
    }
}

#[test]
fn rgb_stays_what_it_is() {
    // A renderer without spectra multiplies the numbers of the file; colours that no smooth spectrum has stay too.
    let mut tables = SpectrumTables::new();
    for rgb in [[0.63, 0.065, 0.05], [0.14, 0.45, 0.091], [0.0, 1.0, 0.0], [0.0; 3], [1.0, 1.0, 0.999]] {
        let bright = rgb.map(|c| 17.0 * c);
        let cases = [
            (srgb().rgb_albedo(rgb), rgb),
            (srgb().rgb_unbounded(bright), bright),
            (srgb().rgb_illuminant(&mut tables, bright), bright),
            (srgb().rgb_illuminant(&mut tables, bright).scaled(0.5), rgb.map(|c| 8.5 * c)),
        ];
        for (spectrum, expected) in cases {
            for u in FIRST {
                let found = seen(&spectrum, &tables, u);
                assert!(distance(found, expected) < 4e-6, "{found:?} instead of {expected:?}");
            }
        }
    }
}

#[test]
fn other_primaries_become_those_of_srgb() {
    // Red of Rec. 2020 is beyond sRGB: more than red, less than no green. A colour inside keeps its XYZ.
    let wide = ColorSpace::get(ColorSpaceName::Rec2020);
    let [r, g, b] = wide.light_bands([1.0, 0.0, 0.0]).rgb();
    assert!(r > 1.5 && g == 0.0 && b == 0.0, "{r} {g} {b}");
    assert_eq!(wide.albedo_bands([1.0, 0.0, 0.0]).rgb(), [1.0, 0.0, 0.0]);
    let inside = [0.5, 0.4, 0.3];
    let expected = wide.to_xyz(inside).to_array();
    for bands in [wide.light_bands(inside), wide.reflectance_bands(inside)] {
        assert!(distance(srgb().to_xyz(bands.rgb()).to_array(), expected) < 1e-5);
    }
    // White light of ACES is that of D60, reddish in sRGB; white matter is white.
    let aces = ColorSpace::get(ColorSpaceName::Aces2065_1);
    let [r, _, b] = aces.light_bands([1.0; 3]).rgb();
    assert!(r > 1.02 && b < 0.98, "{r} {b}");
    assert!(distance(aces.reflectance_bands([0.501, 0.5, 0.5]).rgb(), [0.5; 3]) < 5e-3);
}

#[test]
fn the_film_records_light_as_with_wavelengths() {
    // The colour of light reaches the film whichever way it is carried: luminance, white balance, exposure, output space.
    let mut tables = SpectrumTables::new();
    let lights = [
        srgb().rgb_illuminant(&mut tables, [0.9, 0.7, 0.4]),
        ColorSpace::get(ColorSpaceName::Aces2065_1).rgb_illuminant(&mut tables, [0.8, 0.9, 0.85]),
        tables.add_named("stdillum-A").unwrap(),
        tables.add_named("stdillum-F11").unwrap(),
        Spectrum::blackbody(5000.0),
        Spectrum::Constant(2.0),
    ];
    for settings in [
        SensorSettings::default(),
        SensorSettings { iso: 250.0, white_balance_kelvin: Some(5000.0), ..SensorSettings::default() },
        SensorSettings { color_space: ColorSpaceName::Rec2020, ..SensorSettings::default() },
    ] {
        let sensor = Sensor::cie1931(&settings);
        for light in &lights {
            let (a, b) = (recorded_in_bands(&sensor, light, &tables), recorded(&sensor, light, &tables));
            let tolerance = 3e-3 * settings.imaging_ratio();
            assert!(distance(a, b) < tolerance, "{light:?}: {a:?} in bands, {b:?} at wavelengths");
        }
    }
}

#[test]
fn luminance_is_that_of_the_light() {
    // A white lamp of luminance 1 gives a film value of 1 in the bands, and the sensor's luminance says so.
    let mut tables = SpectrumTables::new();
    let white = srgb().rgb_illuminant(&mut tables, [1.0; 3]);
    let sensor = Sensor::cie1931(&SensorSettings::default());
    assert!(distance(recorded_in_bands(&sensor, &white, &tables), [1.0; 3]) < 1e-4);
    let bands = Wavelengths::bands(0.8);
    let l = white.scaled(1.0 / CIE_Y_INTEGRAL).sample(&tables, &bands);
    assert_near(f64::from(sensor.luminance(l, &bands)), 1.0, 1e-4);
}

#[test]
fn light_is_not_matter() {
    // A constant is white as matter, and as light that of equal energy, which is redder than D65.
    let tables = SpectrumTables::new();
    let constant = Spectrum::Constant(1.0);
    assert_eq!(constant.bands().rgb(), [1.0; 3]);
    let light = constant.as_light(&tables);
    let expected = srgb().to_rgb(spectrum_to_xyz(&constant, &tables));
    assert!(distance(light.bands().rgb(), expected) < 1e-5 && expected[0] > 1.1, "{expected:?}");
    for nm in [360.0, 500.0, 830.0] {
        assert_eq!(light.at(&tables, nm), 1.0);
    }
    assert_eq!(light.as_light(&tables), light);
}

#[test]
fn metals_have_their_colour() {
    // Reflectance at normal incidence, ((n - 1)² + k²) / ((n + 1)² + k²), from the index in each band is about the colour of
    // the spectral reflectance: gold is yellow, copper red, aluminium and silver are white.
    let reflectance = |n: f32, k: f32| ((n - 1.0).powi(2) + k * k) / ((n + 1.0).powi(2) + k * k);
    let mut tables = SpectrumTables::new();
    let mut color = |metal: &str| -> [f32; 3] {
        let [n, k] = ["eta", "k"].map(|q| tables.add_named(&format!("metal-{metal}-{q}")).unwrap());
        let rgb = std::array::from_fn(|c| reflectance(n.bands().rgb()[c], k.bands().rgb()[c]));
        let exact = Bands::of_reflectance(|nm| reflectance(n.at(&tables, nm), k.at(&tables, nm))).rgb();
        assert!(distance(rgb, exact) < 0.03, "{metal}: {rgb:?} instead of {exact:?}");
        rgb
    };
    let [gold, copper, silver, aluminium] = ["Au", "Cu", "Ag", "Al"].map(&mut color);
    assert!(gold[0] > 0.95 && gold[0] > gold[1] + 0.15 && gold[1] > gold[2] + 0.3, "{gold:?}");
    assert!(copper[0] > 0.9 && copper[0] > copper[1] + 0.2 && copper[1] > copper[2], "{copper:?}");
    assert!(silver.iter().all(|c| *c > 0.93), "{silver:?}");
    assert!(distance(aluminium, [0.91; 3]) < 0.015, "{aluminium:?}");
}

#[test]
fn glass_bends_blue_more_than_red() {
    // Each band has its own index of refraction, and all lie between those at the ends of the visible range.
    let mut tables = SpectrumTables::new();
    let glass = tables.add_named("glass-SF11").unwrap();
    let [r, g, b] = glass.bands().rgb();
    assert!(r < g && g < b, "{r} {g} {b}");
    assert!(glass.at(&tables, 700.0) < r && b < glass.at(&tables, 420.0), "{r} {b}");
}

#[test]
fn reflectances_are_projected_under_daylight() {
    // The bands of a measured leaf are its sRGB under D65: on white light the same colour as by wavelength.
    let mut tables = SpectrumTables::new();
    let leaf = tables.add_samples(&[[360.0, 0.03], [500.0, 0.05], [550.0, 0.2], [660.0, 0.05], [830.0, 0.6]]);
    let white = tables.illuminant(ColorSpaceName::Srgb);
    let xyz = integrate_1nm(|nm| leaf.at(&tables, nm) * tables.at(white, nm)).map(|v| v / CIE_Y_INTEGRAL);
    assert!(distance(leaf.bands().rgb(), srgb().to_rgb(xyz.into())) < 1e-4);
    let other = Bands::of_light(|nm| leaf.at(&tables, nm));
    assert!(distance(leaf.bands().rgb(), other.rgb()) > 0.01, "equal energy is another white");
}

#[test]
fn bands_take_turns_at_the_first_place() {
    // The order of the places changes from path to path, what they hold does not; the fourth place is the mean.
    let rgb = [0.2, 0.3, 0.7];
    let bands = Bands::from_rgb(rgb);
    for (first, u) in FIRST.into_iter().enumerate() {
        let lambda = Wavelengths::bands(u);
        assert!(lambda.is_bands() && !lambda.secondary_terminated());
        let values = lambda.of_bands(bands);
        assert_eq!(values[0], rgb[first]);
        assert!((values[3] - 0.4).abs() < 1e-6);
        assert_eq!(lambda.estimate_bands(values), Some(rgb));
    }
    assert_eq!(Wavelengths::bands(1.0 - f32::EPSILON / 2.0).of_bands(bands)[0], 0.7);
    assert_eq!(Wavelengths::sample_visible(0.5).estimate_bands(Sampled::ONE), None);
    assert!(!Wavelengths::sample_single(0.5).is_bands());
}

#[test]
fn dispersion_leaves_a_random_band() {
    // One band in three carries three times its light, so that each is right on average.
    let bands = Bands::from_rgb([0.2, 0.5, 0.9]);
    let mut rng = rng_of("dispersion_leaves_a_random_band");
    let mut moments = [Moments::new(); 3];
    for _ in 0..30_000 {
        let mut lambda = Wavelengths::bands(rng.next_f32());
        lambda.terminate_secondary();
        lambda.terminate_secondary();
        assert!(lambda.secondary_terminated());
        let found = lambda.estimate_bands(lambda.of_bands(bands)).unwrap();
        assert_eq!(found.iter().filter(|v| **v > 0.0).count(), 1);
        for (m, v) in moments.iter_mut().zip(found) {
            m.push(f64::from(v));
        }
    }
    for (m, expected) in moments.iter().zip(bands.rgb()) {
        mean_test(m, f64::from(expected), SIGNIFICANCE).unwrap();
        mean_test(m, f64::from(expected) * 1.1, SIGNIFICANCE).expect_err("an error of 10 % is noticed");
    }
}
