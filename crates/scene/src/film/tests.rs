//! Tests of the film.

use etendue_spectrum::{ColorSpaceName, Sensor, SensorSettings};

use super::*;

fn settings(kind: FilmKind, sensor: SensorSettings) -> FilmSettings {
    let resolution = [2, 1];
    FilmSettings {
        resolution,
        crop: PixelBounds { min: [0, 0], max: resolution },
        kind,
        sensor: Sensor::cie1931(&sensor),
        color_space: sensor.color_space,
        max_component: f32::INFINITY,
        filename: String::new(),
        diagonal_mm: 35.0,
    }
}

/// A grey surface is grey under the white of the output, however exposed, in bands as on average over wavelengths.
#[test]
fn albedo_is_seen_under_white_light() {
    for color_space in ColorSpaceName::ALL {
        let sensor = SensorSettings { iso: 400.0, color_space, ..SensorSettings::default() };
        let settings = settings(FilmKind::Rgb, sensor);
        let grey = settings.white_rgb(Sampled::splat(0.4), &Wavelengths::bands(0.7));
        assert!(grey.iter().all(|c| (c - 0.4).abs() < 1e-4), "{color_space:?}: {grey:?}");
        let n = 2000;
        let mut mean = [0.0_f32; 3];
        for i in 0..n {
            let lambda = Wavelengths::sample_visible((i as f32 + 0.5) / n as f32);
            let rgb = settings.white_rgb(Sampled::splat(0.4), &lambda);
            mean = std::array::from_fn(|c| mean[c] + rgb[c] / n as f32);
        }
        assert!(mean.iter().all(|c| (c - 0.4).abs() < 1e-3), "{color_space:?}: {mean:?}");
    }
}

/// Red, green and blue tell nothing of the spectrum: they add to the colour and leave the spectral channels black.
#[test]
fn bands_leave_spectral_channels_black() {
    let kind = FilmKind::Spectral { n_buckets: 4, min_nm: 360.0, max_nm: 830.0 };
    let film = Film::new(settings(kind, SensorSettings::default()), Vec::new());
    let sums = |lambda: &Wavelengths| {
        let mut tile = film.start_tile(film.settings().crop);
        let radiance = Sampled::splat(0.1);
        let sample = PixelSample { radiance, lambda, filter_weight: 1.0, features: None, layers: &[] };
        tile.add([1, 0], &sample);
        let mut film = film.clone();
        film.add_sums(&Film::finish_tile(tile));
        let image = film.develop();
        let value = |prefix: &str| -> f32 {
            image.channels.iter().filter(|c| c.name.starts_with(prefix)).map(|c| c.values[1]).sum()
        };
        (value("R"), value("S0."))
    };
    let (red, spectral) = sums(&Wavelengths::bands(0.5));
    assert!(red > 1.0 && spectral == 0.0, "{red} {spectral}");
    let (_, spectral) = sums(&Wavelengths::sample_visible(0.5));
    assert!(spectral > 0.0);
}
