//! Light that arrives anywhere on the film.

use etendue_math::{Point2, Rng, Vector2};
use etendue_spectrum::{ColorSpaceName, Sampled, Sensor, SensorSettings, Wavelengths};

use super::*;
use crate::film::{FilmKind, PixelSample};
use crate::filter::FilterKind;

fn film(max_component: f32, layers: &[&str]) -> Film {
    let settings = FilmSettings {
        resolution: [40, 30],
        crop: PixelBounds { min: [3, 2], max: [37, 29] },
        kind: FilmKind::Rgb,
        guides: false,
        sensor: Sensor::cie1931(&SensorSettings::default()),
        color_space: ColorSpaceName::Srgb,
        max_component,
        filename: String::new(),
        diagonal_mm: 35.0,
    };
    Film::new(settings, layers.iter().map(|name| (*name).to_owned()).collect())
}

/// One sample of this radiance for each pixel, in tiles.
fn samples(film: &Film, radiance: Sampled, filter_weight: f32) -> Vec<TileSamples> {
    let lambda = Wavelengths::sample_visible(0.3);
    let layers = vec![radiance; film.layout().layers.len()];
    let fill = |bounds: PixelBounds| {
        let mut tile = film.start_tile(bounds, TileSamples::default());
        for pixel in bounds.pixels() {
            let sample =
                PixelSample { radiance, lambda: &lambda, filter_weight, features: None, layers: &layers };
            tile.add(pixel, &sample);
        }
        tile.finish()
    };
    film.tiles(16).into_iter().map(fill).collect()
}

/// The image of splats of radiance 1 at these places, joined with samples.
fn image(
    film: &mut Film,
    places: &[Point2],
    filter: &Filter,
    scale: f64,
    tiles: &mut [TileSamples],
) -> Vec<f64> {
    let lambda = Wavelengths::sample_visible(0.3);
    let layers = vec![Sampled::ONE; film.layout().layers.len()];
    let mut sums = SplatSums::default();
    sums.restart(film);
    let tasks: Vec<Splats<'_>> = places
        .chunks(100)
        .map(|places| {
            let mut splats = Splats::new(film);
            places.iter().for_each(|p| splats.add(*p, Sampled::ONE, &lambda, &layers));
            splats
        })
        .collect();
    sums.add(&tasks, filter);
    drop(tasks);
    sums.join(tiles, film, scale);
    film.add_tiles(tiles);
    green(film, "G")
}

fn green(film: &Film, name: &str) -> Vec<f64> {
    let image = film.develop();
    image.channel(name).expect("green").values.iter().map(|v| f64::from(*v)).collect()
}

/// The green of radiance 1.
fn unit(film: &Film) -> f64 {
    f64::from(film.settings().output_rgb(Sampled::ONE, &Wavelengths::sample_visible(0.3))[1])
}

/// Evenly lit, every pixel has the same, whatever the filter, up to the border of the crop.
#[test]
fn even_light_is_even() {
    let filters = [
        (FilterKind::Box, 0.5, 0.5, 1e-3),
        (FilterKind::Box, 2.3, 0.8, 1e-3),
        (FilterKind::Triangle, 2.0, 3.0, 2e-3),
        (FilterKind::Gaussian { sigma: 0.5 }, 1.5, 1.5, 2e-3),
        (FilterKind::Mitchell { b: 1.0 / 3.0, c: 1.0 / 3.0 }, 2.0, 2.0, 2e-3),
        (FilterKind::LanczosSinc { tau: 3.0 }, 4.0, 4.0, 2e-3),
        // Five standard errors of 20² splats for each pixel, each of which goes to one.
        (FilterKind::Box, 40.0, 30.0, 0.25),
        (FilterKind::Gaussian { sigma: 9.0 }, 30.0, 40.0, 0.25),
    ];
    for (kind, rx, ry, tolerance) in filters {
        let filter = Filter::new(kind, Vector2::new(rx, ry)).unwrap();
        // 20 places for each pixel's side, from beyond the border on.
        let (n, reach) = (20_i32, 41_i32);
        let along = |from: i32, to: i32| {
            ((from - reach) * n..(to + reach) * n).map(move |i| (i as f32 + 0.5) / n as f32)
        };
        let places: Vec<Point2> =
            along(0, 30).flat_map(|y| along(0, 40).map(move |x| Point2::new(x, y))).collect();
        let mut film = film(f32::INFINITY, &[]);
        let mut tiles = samples(&film, Sampled::ZERO, 1.0);
        let image = image(&mut film, &places, &filter, 1.0 / f64::from(n * n), &mut tiles);
        let unit = unit(&film);
        for (i, value) in image.iter().enumerate() {
            assert!((value / unit - 1.0).abs() < tolerance, "{kind:?}, pixel {i}: {}", value / unit);
        }
    }
}

/// A pixel's sample of weight w and value v and light s make w v + s, in colour and layers.
#[test]
fn samples_and_splats_add_up() {
    let filter = Filter::new(FilterKind::Box, Vector2::splat(0.5)).unwrap();
    for weight in [1.0_f32, 1.2, -1.2] {
        let mut film = film(f32::INFINITY, &["layer"]);
        let mut tiles = samples(&film, Sampled::splat(3.0), weight);
        let places =
            [Point2::new(3.0, 2.0), Point2::new(3.9, 2.9), Point2::new(20.5, 10.5), Point2::new(2.9, 2.0)];
        let values = image(&mut film, &places, &filter, 10.0, &mut tiles);
        let unit = unit(&film);
        let background = 3.0 * f64::from(weight);
        let twice = film.settings().crop.index([20, 10]);
        for (i, (value, layer)) in values.iter().zip(green(&film, "layer.G")).enumerate() {
            let expected = background
                + if i == 0 {
                    20.0
                } else if i == twice {
                    10.0
                } else {
                    0.0
                };
            assert!((value / unit - expected).abs() < 1e-4, "pixel {i}: {} but {expected}", value / unit);
            assert!((layer / unit - expected).abs() < 1e-4, "pixel {i} of the layer");
        }
    }
}

/// The limit of a sample holds for all that a pixel gets in a pass.
#[test]
fn the_sum_is_limited() {
    let filter = Filter::new(FilterKind::Box, Vector2::splat(0.5)).unwrap();
    let mut film = film(2.0, &[]);
    let mut tiles = samples(&film, Sampled::ZERO, 1.0);
    let values = image(&mut film, &[Point2::new(10.5, 10.5); 50], &filter, 1e6, &mut tiles);
    assert!(values.iter().all(|v| *v <= 2.0 + 1e-6) && values.iter().any(|v| *v > 0.5));
}

/// Threads and the cut into tasks change no bit.
#[test]
fn order_is_that_of_paths() {
    let filter = Filter::default();
    let mut rng = Rng::new(5, 1);
    let places: Vec<Point2> =
        (0..5000).map(|_| Point2::new(42.0 * rng.next_f32() - 1.0, 32.0 * rng.next_f32() - 1.0)).collect();
    let render = |n: usize| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(n).build().unwrap();
        pool.install(|| {
            let mut film = film(f32::INFINITY, &[]);
            let mut tiles = samples(&film, Sampled::splat(0.1), 1.0);
            image(&mut film, &places, &filter, 0.37, &mut tiles);
            film.sums().clone()
        })
    };
    assert_eq!(render(1), render(3));
}

/// NaN is counted and left out.
#[test]
#[cfg(not(debug_assertions))]
fn nonsense_is_counted() {
    let film = film(f32::INFINITY, &[]);
    let lambda = Wavelengths::sample_visible(0.3);
    let mut splats = Splats::new(&film);
    splats.add(Point2::new(5.0, 5.0), Sampled::splat(f32::NAN), &lambda, &[]);
    assert!(splats.is_empty());
    assert_eq!(splats.faults.invalid, 1);
}
