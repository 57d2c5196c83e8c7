//! Response of the film.

use etendue_math::statistics::{Moments, mean_test};

use super::{SIGNIFICANCE, assert_near, distance, rng_of};
use crate::cie::CIE_Y_INTEGRAL;
use crate::{
    ColorSpace, ColorSpaceName, Sensor, SensorSettings, Spectrum, SpectrumTables, Wavelengths, Xyz, daylight,
    spectrum_to_photometric, spectrum_to_xyz,
};

/// What the film records of a light on average: an even grid over the random number.
fn recorded(sensor: &Sensor, light: &Spectrum, tables: &SpectrumTables) -> [f32; 3] {
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
fn a_light_of_unit_luminance_gives_a_film_value_of_one() {
    // The chain of units: a light divided by its photometric size, at ISO 100 and 1 s, records RGB (1, 1, 1).
    for color_space in ColorSpaceName::ALL {
        let mut tables = SpectrumTables::new();
        let light = ColorSpace::get(color_space).rgb_illuminant(&mut tables, [1.0; 3]);
        let light = light.scaled(1.0 / spectrum_to_photometric(&light, &tables));
        let sensor = Sensor::cie1931(&SensorSettings { color_space, ..SensorSettings::default() });
        let rgb = recorded(&sensor, &light, &tables);
        assert!(distance(rgb, [1.0; 3]) < 1e-3, "{color_space:?}: {rgb:?}");
    }
}

#[test]
fn colours_are_recorded_as_they_are_defined() {
    // Light of a given RGB is recorded with that RGB; any spectrum with the RGB of its XYZ.
    let mut tables = SpectrumTables::new();
    let space = ColorSpace::get(ColorSpaceName::Srgb);
    let sensor = Sensor::cie1931(&SensorSettings::default());
    let a = tables.add_named("stdillum-A").unwrap();
    let lights = [space.rgb_illuminant(&mut tables, [0.2, 0.7, 1.5]), a];
    for light in lights {
        let expected = space.to_rgb(spectrum_to_xyz(&light, &tables));
        let rgb = recorded(&sensor, &light, &tables).map(|c| c / CIE_Y_INTEGRAL);
        assert!(distance(rgb, expected) < 2e-3, "{rgb:?} instead of {expected:?}");
    }
}

#[test]
fn exposure_and_sensitivity_multiply() {
    // Half the time at four times the sensitivity doubles the film value.
    let settings = SensorSettings { exposure_time_s: 0.5, iso: 400.0, ..SensorSettings::default() };
    assert_eq!(settings.imaging_ratio(), 2.0);
    let wavelengths = Wavelengths::sample_visible(0.4);
    let l = crate::Sampled::splat(0.01);
    let (plain, fast) = (Sensor::cie1931(&SensorSettings::default()), Sensor::cie1931(&settings));
    let (a, b) = (plain.sensor_rgb(l, &wavelengths), fast.sensor_rgb(l, &wavelengths));
    assert!(distance(a.map(|c| 2.0 * c), b) < 1e-5);
    assert_near(
        f64::from(fast.luminance(l, &wavelengths)),
        f64::from(fast.sensor_xyz(l, &wavelengths).y),
        1e-4,
    );
}

#[test]
fn white_balance_makes_its_daylight_white() {
    // With the balance at the light's temperature a white wall is recorded neutral, at the same luminance.
    for kelvin in [3200.0, 5000.0, 6500.0, 9000.0] {
        let mut tables = SpectrumTables::new();
        let values = daylight(kelvin);
        let table = tables.add_dense(|nm| values[(nm - 360.0) as usize]);
        let light = Spectrum::table(table, &tables);
        let light = light.scaled(1.0 / spectrum_to_photometric(&light, &tables));
        let settings = SensorSettings { white_balance_kelvin: Some(kelvin), ..SensorSettings::default() };
        let rgb = recorded(&Sensor::cie1931(&settings), &light, &tables);
        assert!(distance(rgb, [1.0; 3]) < 2e-3, "{kelvin} K: {rgb:?}");
        let unbalanced = recorded(&Sensor::cie1931(&SensorSettings::default()), &light, &tables);
        assert_eq!(distance(unbalanced, [1.0; 3]) > 0.05, kelvin != 6500.0, "{kelvin} K: {unbalanced:?}");
    }
}

#[test]
fn one_wavelength_records_the_same_on_average() {
    // Dispersion drops three of four wavelengths; the mean film value must not change.
    let mut tables = SpectrumTables::new();
    let light = ColorSpace::get(ColorSpaceName::Srgb).rgb_illuminant(&mut tables, [0.8, 0.5, 0.9]);
    let light = light.scaled(1.0 / CIE_Y_INTEGRAL);
    let sensor = Sensor::cie1931(&SensorSettings::default());
    let expected = ColorSpace::get(ColorSpaceName::Srgb).to_xyz([0.8, 0.5, 0.9]);
    let mut rng = rng_of("one_wavelength_records_the_same_on_average");
    let mut record = |scale: f32| -> [Moments; 3] {
        let mut moments = [Moments::new(); 3];
        for _ in 0..200_000 {
            let mut wavelengths = Wavelengths::sample_visible(rng.next_f32());
            wavelengths.terminate_secondary();
            let l = light.sample(&tables, &wavelengths) * scale;
            let xyz: Xyz = sensor.sensor_xyz(l, &wavelengths);
            for (m, v) in moments.iter_mut().zip(xyz.to_array()) {
                m.push(f64::from(v));
            }
        }
        moments
    };
    for (moments, value) in record(1.0).iter().zip(expected.to_array()) {
        mean_test(moments, f64::from(value), SIGNIFICANCE).unwrap();
    }
    for (moments, value) in record(1.05).iter().zip(expected.to_array()) {
        mean_test(moments, f64::from(value), SIGNIFICANCE).expect_err("an error of 5 % is noticed");
    }
}
