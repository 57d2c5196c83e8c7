//! Lights as paths see them that carry bands of linear sRGB instead of wavelengths (SPEC SPD-4).

use etendue_math::Point2;
use etendue_spectrum::cie::CIE_Y_INTEGRAL;
use etendue_spectrum::{Sensor, SensorSettings};

use super::*;

/// What the film records of a surrounding in the direction +z: in the bands, and on average over wavelengths.
fn recorded(world: &World) -> ([f32; 3], [f32; 3]) {
    let sensor = Sensor::cie1931(&SensorSettings::default());
    let up = Vector3::new(0.1, 0.2, 0.9).normalized();
    let record = |lambda: &Wavelengths| {
        let le = world.light().le_infinite(&world.context(), Point3::ORIGIN, up, lambda);
        sensor.sensor_rgb(le, lambda)
    };
    let n = 5000;
    let mut mean = [0.0; 3];
    for i in 0..n {
        let rgb = record(&Wavelengths::sample_visible((i as f32 + 0.5) / n as f32));
        mean = std::array::from_fn(|c| mean[c] + rgb[c] / n as f32);
    }
    (record(&Wavelengths::bands(0.5)), mean)
}

#[test]
fn light_has_the_same_colour_and_luminance_in_bands_and_at_wavelengths() {
    // Nothing is multiplied with a spectrum on the way, so the two models agree, whatever kind of spectrum a light has.
    let samples = |s: &[[f32; 2]]| Value::SpectrumSamples(s.to_vec());
    let spectra = [
        ("default", None),
        ("rgb", Some(rgb(3.0, 2.0, 0.7))),
        ("blackbody", Some(Value::Blackbody(vec![4500.0]))),
        ("constant", Some(samples(&[[360.0, 2.0], [830.0, 2.0]]))),
        ("table", Some(samples(&[[360.0, 1.0], [500.0, 3.0], [830.0, 2.0]]))),
        ("named", Some(Value::SpectrumNames(vec!["stdillum-A".to_owned()]))),
    ];
    for (name, spectrum) in spectra {
        for extra in
            [("scale", floats(&[2.5])), ("illuminance", floats(&[7.0])), ("units", string("radiometric"))]
        {
            let entity = Entity::new("infinite").with(extra.0, extra.1);
            let entity = match &spectrum {
                Some(value) => entity.with("L", value.clone()),
                None => entity,
            };
            let (bands, wavelengths) = recorded(&World::of(entity));
            for c in 0..3 {
                let (a, b) = (f64::from(bands[c]), f64::from(wavelengths[c]));
                assert!(
                    (a - b).abs() < 3e-3 * b,
                    "{name}: {bands:?} in bands, {wavelengths:?} at wavelengths"
                );
            }
        }
    }
}

#[test]
fn pictures_keep_their_colours_in_bands() {
    // A saturated picture shows the numbers of its file, which no smooth spectrum has exactly.
    let color = [40.0, 3.0, 0.0];
    let picture = Texels::from_fn(4, 4, 3, |_, _, c| color[c]);
    let world = World::with_picture(Entity::new("infinite").with("filename", string("map")), Some(picture));
    let (bands, _) = recorded(&world);
    for c in 0..3 {
        assert!((bands[c] - color[c]).abs() < 4e-5 * color[0], "{bands:?}");
    }
}

#[test]
fn pictures_interpolate_in_bands() {
    // Halfway between a red and a green texel lies the mean of both.
    let mut spectra = SpectrumTables::new();
    let space = etendue_spectrum::ColorSpaceName::Srgb;
    let white = spectra.illuminant(space);
    let picture = image::LightImage::new(2, 1, &[[8.0, 0.0, 0.0], [0.0, 2.0, 0.0]], space, white);
    let bands = Wavelengths::bands(0.9);
    let [r, g, b] = bands.estimate_bands(picture.bilinear(Point2::splat(0.5), &spectra, &bands)).unwrap();
    assert!((r - 4.0).abs() < 1e-3 && (g - 1.0).abs() < 1e-3 && b == 0.0, "{r} {g} {b}");
    let [r, g, b] = bands.estimate_bands(picture.mean().sample(&spectra, &bands)).unwrap();
    assert!((r - 4.0).abs() < 1e-3 && (g - 1.0).abs() < 1e-3 && b == 0.0, "{r} {g} {b}");
}

#[test]
fn white_of_luminance_one_is_one_in_bands() {
    // The internal unit of light is that of wavelengths: luminance over the integral of y-bar.
    let world = World::of(Entity::new("point").with("I", rgb(1.0, 1.0, 1.0)));
    let lambda = Wavelengths::bands(0.2);
    let sample = world.light().sample_li(
        &world.context(),
        &at(Point3::new(0.0, 0.0, 1.0)),
        Point2::splat(0.5),
        &lambda,
    );
    for value in sample.expect("a point light shines everywhere").le.to_array() {
        assert_close(f64::from(value), 1.0 / f64::from(CIE_Y_INTEGRAL), 1e-5);
    }
}
