//! Tests of the film.

use etendue_math::Rng;
use etendue_math::statistics::{Moments, mean_test};
use etendue_spectrum::cie::CIE_Y_INTEGRAL;
use etendue_spectrum::{ColorSpaceName, Sampled, Sensor, SensorSettings, Wavelengths};

use super::*;

/// Split of the significance of the suite over the comparisons here.
const SIGNIFICANCE: f64 = 1e-5;

fn settings(width: u32, height: u32) -> FilmSettings {
    FilmSettings {
        resolution: [width, height],
        crop: PixelBounds { min: [0, 0], max: [width, height] },
        kind: FilmKind::Rgb,
        guides: false,
        sensor: Sensor::cie1931(&SensorSettings::default()),
        color_space: ColorSpaceName::Srgb,
        max_component: f32::INFINITY,
        filename: String::new(),
        diagonal_mm: 35.0,
    }
}

fn with_sensor(kind: FilmKind, sensor: SensorSettings) -> FilmSettings {
    let color_space = sensor.color_space;
    FilmSettings { kind, sensor: Sensor::cie1931(&sensor), color_space, ..settings(2, 1) }
}

fn film(width: u32, height: u32) -> Film {
    Film::new(settings(width, height), Vec::new())
}

fn sample(radiance: Sampled, lambda: &Wavelengths) -> PixelSample<'_> {
    PixelSample { radiance, lambda, filter_weight: 1.0, features: None, layers: &[] }
}

/// Adds samples through a tile of the whole film.
fn fill(film: &mut Film, add: impl FnOnce(&mut FilmTile<'_>)) {
    let bounds = film.settings().crop;
    let mut tile = film.start_tile(bounds, TileSamples::default());
    add(&mut tile);
    let samples = tile.finish();
    film.add_tiles(&[samples]);
}

fn values(film: &Film, name: &str) -> Vec<f64> {
    let image = film.develop();
    let channel = image.channel(name).expect("a channel of that name");
    channel.values.iter().map(|v| f64::from(*v)).collect()
}

/// The radiance of which the luminance is `y` at these wavelengths.
fn with_luminance(y: f64, lambda: &Wavelengths) -> Sampled {
    let film = film(1, 1);
    let unit = film.sums().luminance(film.settings().output_rgb(Sampled::ONE, lambda));
    Sampled::splat((y / unit) as f32)
}

#[track_caller]
fn check_near(actual: f64, expected: f64, tolerance: f64) {
    assert!(
        (actual - expected).abs() <= tolerance * expected.abs().max(1e-12),
        "{actual} instead of {expected}"
    );
}

/// A pixel is the weighted mean of its samples, `sum of w c / sum of w`, be weights positive or negative.
#[test]
fn pixels_are_weighted_means() {
    let mut film = film(2, 1);
    let lambda = Wavelengths::sample_visible(0.3);
    let (a, b) = (Sampled::from_array([1.0, 2.0, 3.0, 4.0]), Sampled::from_array([4.0, 1.0, 0.0, 2.0]));
    let weights = [[1.0_f32, 3.0], [2.0, -0.5]];
    fill(&mut film, |tile| {
        for (x, [wa, wb]) in weights.into_iter().enumerate() {
            tile.add([x as u32, 0], &PixelSample { filter_weight: wa, ..sample(a, &lambda) });
            tile.add([x as u32, 0], &PixelSample { filter_weight: wb, ..sample(b, &lambda) });
        }
    });
    let rgb = [a, b].map(|radiance| film.settings().output_rgb(radiance, &lambda).map(f64::from));
    for (c, name) in ["R", "G", "B"].into_iter().enumerate() {
        for (x, [wa, wb]) in weights.into_iter().enumerate() {
            let (wa, wb) = (f64::from(wa), f64::from(wb));
            check_near(values(&film, name)[x], (wa * rgb[0][c] + wb * rgb[1][c]) / (wa + wb), 1e-6);
        }
    }
}

/// A pixel without samples is black, and so is one whose weights cancel; neither is NaN.
#[test]
fn empty_pixels_are_black() {
    let mut film = film(2, 1);
    let lambda = Wavelengths::sample_visible(0.3);
    fill(&mut film, |tile| {
        tile.add([1, 0], &sample(Sampled::ONE, &lambda));
        tile.add([1, 0], &PixelSample { filter_weight: -1.0, ..sample(Sampled::ONE, &lambda) });
    });
    film.note_pass(0);
    film.note_pass(1);
    for name in ["R", "G", "B", "variance.Y"] {
        assert_eq!(values(&film, name), [0.0, 0.0], "{name}");
    }
}

/// The variance of the mean of n numbers is sigma² / n, and its estimate from the numbers is right on average, for few
/// numbers too: uniform numbers on [0, 1) have sigma² = 1 / 12.
#[test]
fn variance_of_equal_weights_is_without_bias() {
    for n in [2_u64, 5, 40] {
        let mut film = film(50, 40);
        let lambda = Wavelengths::sample_visible(0.4);
        let unit = with_luminance(1.0, &lambda);
        let mut rng = Rng::new(11, n);
        fill(&mut film, |tile| {
            for pixel in tile.bounds().pixels() {
                for _ in 0..n {
                    tile.add(pixel, &sample(unit * rng.next_f32(), &lambda));
                }
            }
        });
        (0..n).for_each(|pass| film.note_pass(pass));
        let variances: Moments = values(&film, "variance.Y").into_iter().collect();
        mean_test(&variances, 1.0 / (12.0 * n as f64), SIGNIFICANCE).unwrap();
    }
}

/// Weights of both signs raise the variance of the mean: for weights +c and -c that are independent of the numbers it is
/// c² sigma² / (n mean²) of the weights. The film's estimate is that, and is what pixels scatter by. The factor 2 here
/// is that of a sharp filter.
#[test]
fn variance_of_signed_weights() {
    let (n, share_negative) = (200_u64, 0.15);
    let mut film = film(60, 50);
    let lambda = Wavelengths::sample_visible(0.4);
    let unit = with_luminance(1.0, &lambda);
    let mut rng = Rng::new(12, 0);
    fill(&mut film, |tile| {
        for pixel in tile.bounds().pixels() {
            for _ in 0..n {
                let filter_weight = if rng.next_f64() < share_negative { -1.3 } else { 1.3 };
                tile.add(pixel, &PixelSample { filter_weight, ..sample(unit * rng.next_f32(), &lambda) });
            }
        }
    });
    (0..n).for_each(|pass| film.note_pass(pass));
    let mean_weight = 1.0 - 2.0 * share_negative;
    let expected = 1.0 / (12.0 * n as f64 * mean_weight * mean_weight);
    let variances: Moments = values(&film, "variance.Y").into_iter().collect();
    check_near(variances.mean(), expected, 0.04);
    let weights = film.settings().luminance_weights();
    let channels = ["R", "G", "B"].map(|c| values(&film, c));
    let means: Moments =
        (0..3000).map(|i| (0..3).map(|c| f64::from(weights[c]) * channels[c][i]).sum::<f64>()).collect();
    mean_test(&means, 0.5, SIGNIFICANCE).unwrap();
    // The relative error of a variance from 3000 numbers is sqrt(2 / 3000) = 2.6 %.
    check_near(means.variance(), expected, 0.13);
}

/// Equal samples have no variance, however large they are; one pass tells none.
#[test]
fn no_variance_without_spread() {
    let mut film = film(1, 1);
    let lambda = Wavelengths::sample_visible(0.5);
    for pass in 0..3 {
        fill(&mut film, |tile| tile.add([0, 0], &sample(Sampled::splat(12_345.678), &lambda)));
        film.note_pass(pass);
        let mean = values(&film, "G")[0];
        assert!(values(&film, "variance.Y")[0] < 1e-12 * mean * mean);
    }
}

/// Colours of constant radiance: the mean over random wavelengths is that of the spectrum, whose Y is the integral of
/// radiance times y.
#[test]
fn luminance_of_flat_light() {
    let mut film = film(20, 20);
    let mut rng = Rng::new(13, 0);
    fill(&mut film, |tile| {
        for pixel in tile.bounds().pixels() {
            for _ in 0..64 {
                let lambda = Wavelengths::sample_visible(rng.next_f32());
                tile.add(pixel, &sample(Sampled::splat(2.0 / CIE_Y_INTEGRAL), &lambda));
            }
        }
    });
    let weights = film.settings().luminance_weights();
    let channels = ["R", "G", "B"].map(|c| values(&film, c));
    let means: Moments =
        (0..400).map(|i| (0..3).map(|c| f64::from(weights[c]) * channels[c][i]).sum::<f64>()).collect();
    mean_test(&means, 2.0, SIGNIFICANCE).unwrap();
    assert!(means.standard_error() < 0.01);
}

/// Layers are developed like the image, each by itself, and leave it alone.
#[test]
fn layers_are_kept_apart() {
    let mut film = Film::new(settings(1, 1), vec!["direct".to_owned(), "caustic".to_owned()]);
    let lambda = Wavelengths::sample_visible(0.6);
    let layers = [Sampled::splat(2.0), Sampled::splat(0.5)];
    fill(&mut film, |tile| {
        tile.add([0, 0], &PixelSample { layers: &layers, ..sample(Sampled::splat(3.0), &lambda) });
        let none = [Sampled::ZERO; 2];
        tile.add([0, 0], &PixelSample { layers: &none, ..sample(Sampled::ZERO, &lambda) });
    });
    for c in ["R", "G", "B"] {
        let whole = values(&film, c)[0];
        check_near(values(&film, &format!("direct.{c}"))[0], whole * 2.0 / 3.0, 1e-6);
        check_near(values(&film, &format!("caustic.{c}"))[0], whole / 6.0, 1e-6);
    }
}

/// Features are means over the samples of the pixel, with the weights of the filter.
#[test]
fn features_are_means() {
    let settings = FilmSettings { kind: FilmKind::GBuffer(AovSpace::World), ..settings(1, 1) };
    let mut film = Film::new(settings, Vec::new());
    let lambda = Wavelengths::sample_visible(0.6);
    let features = |x: f32| Features {
        albedo: [x, 2.0 * x, 3.0 * x],
        position: [4.0 * x, 5.0 * x, 6.0 * x],
        normal: [0.1 * x, 0.2 * x, 0.3 * x],
        shading_normal: [0.4 * x, 0.5 * x, 0.6 * x],
        uv: [7.0 * x, 8.0 * x],
        depth: 9.0 * x,
    };
    fill(&mut film, |tile| {
        assert!(tile.wants_features());
        for (x, filter_weight) in [(1.0, 3.0), (2.0, 1.0)] {
            let features = Some(features(x));
            tile.add([0, 0], &PixelSample { filter_weight, features, ..sample(Sampled::ONE, &lambda) });
        }
    });
    let expected = features(1.25).to_array();
    for (name, expected) in Features::CHANNELS.into_iter().zip(expected) {
        check_near(values(&film, name)[0], f64::from(expected), 1e-6);
    }
    assert!(
        !self::film(1, 1)
            .start_tile(PixelBounds { min: [0, 0], max: [1, 1] }, TileSamples::default())
            .wants_features()
    );
}

/// Each band of a spectral film holds the mean radiance over the band: under flat light all bands agree, under a slope
/// each has its middle.
#[test]
fn bands_hold_mean_radiance() {
    let kind = FilmKind::Spectral { n_buckets: 5, min_nm: 400.0, max_nm: 700.0 };
    let slope = |nm: f32| 1.0 + (nm - 400.0) / 100.0;
    for (what, radiance) in [("flat", (|_| 3.0) as fn(f32) -> f32), ("slope", slope)] {
        let mut film = Film::new(FilmSettings { kind, ..settings(16, 16) }, Vec::new());
        let mut rng = Rng::new(14, 0);
        fill(&mut film, |tile| {
            for pixel in tile.bounds().pixels() {
                for _ in 0..200 {
                    let lambda = Wavelengths::sample_visible(rng.next_f32());
                    let radiance = Sampled::from_array(lambda.lambda_nm().map(radiance));
                    tile.add(pixel, &sample(radiance, &lambda));
                }
            }
        });
        for bucket in 0..5 {
            let name = film.settings().bucket_name(bucket);
            let middle = 430.0 + 60.0 * bucket as f32;
            assert_eq!(name, format!("S0.{middle:.0},000nm"));
            let moments: Moments = values(&film, &name).into_iter().collect();
            mean_test(&moments, f64::from(radiance(middle)), SIGNIFICANCE).unwrap();
            assert!(moments.standard_error() < 0.01 * moments.mean(), "{what} {name}");
        }
    }
}

/// Wavelengths that dispersion has given up carry nothing, neither to colours nor to bands; the one that remains counts
/// for all, so that means stay.
#[test]
fn given_up_wavelengths_count_for_nothing() {
    let kind = FilmKind::Spectral { n_buckets: 1, min_nm: 400.0, max_nm: 700.0 };
    let mut film = Film::new(FilmSettings { kind, ..settings(16, 16) }, Vec::new());
    let mut rng = Rng::new(15, 0);
    fill(&mut film, |tile| {
        for pixel in tile.bounds().pixels() {
            for _ in 0..400 {
                let mut lambda = Wavelengths::sample_visible(rng.next_f32());
                lambda.terminate_secondary();
                tile.add(pixel, &sample(Sampled::from_array([2.0, 1e6, 1e6, 1e6]), &lambda));
            }
        }
    });
    let moments: Moments = values(&film, &film.settings().bucket_name(0)).into_iter().collect();
    mean_test(&moments, 2.0, SIGNIFICANCE).unwrap();
    assert!(moments.standard_error() < 0.02);
}

/// The relative error of an even image is its standard error over 1.1 times its luminance: a tenth of the mean is added to
/// each pixel.
#[test]
fn relative_error_of_an_even_image() {
    let mut film = film(4, 3);
    let lambda = Wavelengths::sample_visible(0.2);
    assert_eq!(film.relative_error(), f64::INFINITY);
    for (pass, y) in [1.0, 3.0, 1.0, 3.0].into_iter().enumerate() {
        let radiance = with_luminance(y, &lambda);
        fill(&mut film, |tile| {
            for pixel in tile.bounds().pixels() {
                tile.add(pixel, &sample(radiance, &lambda));
            }
        });
        film.note_pass(pass as u64);
    }
    // Deviations of 1 in four numbers: variance of the mean 4 / 3 / 4.
    check_near(film.relative_error(), (1.0_f64 / 3.0).sqrt() / 2.2, 1e-5);
    assert_eq!(self::film(2, 2).relative_error(), f64::INFINITY);
    let mut black = self::film(2, 2);
    black.note_pass(0);
    black.note_pass(1);
    assert_eq!(black.relative_error(), 0.0, "a black image without spread is done");
}

/// PAR-3: films of different passes add up in any order; the same passes twice, other pixels and other channels are
/// refused, and a refusal changes nothing.
#[test]
fn merging_checks_what_it_adds() {
    let lambda = Wavelengths::sample_visible(0.2);
    let part = |passes: Range<u64>, radiance: f32| {
        let mut film = film(2, 1);
        for pass in passes {
            fill(&mut film, |tile| tile.add([0, 0], &sample(Sampled::splat(radiance), &lambda)));
            film.note_pass(pass);
        }
        film.sums().clone()
    };
    let (a, b) = (part(0..3, 1.0), part(3..4, 5.0));
    let (mut ab, mut ba) = (a.clone(), b.clone());
    ab.merge(&b).unwrap();
    ba.merge(&a).unwrap();
    assert_eq!(ab, ba);
    assert_eq!(ab.passes().to_vec(), vec![0..4]);
    let (one, mean) = (a.develop(), ab.develop());
    check_near(f64::from(mean.channels[1].values[0]), 2.0 * f64::from(one.channels[1].values[0]), 1e-6);

    let before = ab.clone();
    assert_eq!(ab.merge(&part(2..9, 1.0)), Err(MergeError::Overlap(2..4)));
    assert_eq!(ab.merge(film(3, 1).sums()), Err(MergeError::Layout));
    let layered = Film::new(settings(2, 1), vec!["direct".to_owned()]);
    assert_eq!(ab.merge(layered.sums()), Err(MergeError::Layout));
    assert_eq!(ab.merge_independent(layered.sums()), Err(MergeError::Layout));
    assert_eq!(ab, before);

    // Gaps are kept, and filled later.
    let mut sparse = part(0..1, 1.0);
    sparse.merge(&part(2..3, 1.0)).unwrap();
    assert_eq!(sparse.passes().to_vec(), vec![0..1, 2..3]);
    assert_eq!(sparse.n_passes(), 2);
    sparse.merge(&part(1..2, 1.0)).unwrap();
    assert_eq!(sparse, a);
    // Of another seed the same passes may be added: they are counted.
    let mut independent = a.clone();
    independent.merge_independent(&a).unwrap();
    assert_eq!(independent.passes().to_vec(), vec![0..6]);
    assert_eq!(independent.develop().channels[1], a.develop().channels[1]);
}

/// Sums are exact: tiles may be cut in any way and come in any order, with samples of every size.
#[test]
fn tiles_and_order_do_not_matter() {
    let lambda = Wavelengths::sample_visible(0.7);
    let render = |tile_size: u32, reverse: bool| {
        let mut film = film(7, 5);
        let mut tiles = film.tiles(tile_size);
        assert_eq!(tiles.iter().map(|t| t.n_pixels()).sum::<usize>(), 35, "tiles cover the film once");
        if reverse {
            tiles.reverse();
        }
        for bounds in tiles {
            let mut tile = film.start_tile(bounds, TileSamples::default());
            for pixel in bounds.pixels() {
                for i in 0..20_u32 {
                    let i = if reverse { 19 - i } else { i };
                    let mut rng = Rng::new(u64::from(i), u64::from(pixel[0] + 7 * pixel[1]));
                    let radiance = Sampled::splat(rng.next_f32() * 10.0_f32.powi(i as i32 - 12));
                    tile.add(pixel, &sample(radiance, &lambda));
                }
            }
            let samples = tile.finish();
            film.add_tiles(&[samples]);
        }
        film
    };
    let whole = render(100, false);
    for (size, reverse) in [(1, false), (2, true), (3, false), (4, true)] {
        assert_eq!(render(size, reverse).sums(), whole.sums());
    }
}

/// Images carry the exact sums, layers and odd names included; an image without them, or with too few, is refused.
#[test]
fn sums_come_back_from_images() {
    let mut film = Film::new(settings(3, 2), vec!["weight".to_owned(), "a-b".to_owned()]);
    let mut rng = Rng::new(16, 0);
    fill(&mut film, |tile| {
        for pixel in tile.bounds().pixels() {
            for _ in 0..5 {
                let lambda = Wavelengths::sample_visible(rng.next_f32());
                let radiance = Sampled::splat(1e4 * rng.next_f32().powi(9));
                let layers = [radiance * 0.1, radiance * 0.9];
                tile.add(pixel, &PixelSample { layers: &layers, ..sample(radiance, &lambda) });
            }
        }
    });
    let mut image = film.develop();
    let (bounds, weights) = (film.settings().crop, film.settings().luminance_weights());
    assert!(FilmSums::from_image(&image, bounds, weights).is_err(), "no sums");
    image.channels.extend(film.sums().exact_channels());
    assert_eq!(&FilmSums::from_image(&image, bounds, weights).unwrap(), film.sums());
    let larger = PixelBounds { min: [0, 0], max: [3, 3] };
    assert!(FilmSums::from_image(&image, larger, weights).is_err(), "other pixels");
    let mut partial = image.clone();
    partial.channels.retain(|c| !c.name.starts_with("sums.weighted luminance"));
    assert!(FilmSums::from_image(&partial, bounds, weights).is_err(), "moments are missing");
}

/// Checkpoints that do not fit are refused.
#[test]
fn foreign_checkpoints_are_refused() {
    let mut film = film(3, 2);
    let bytes = film.sums().to_bytes();
    assert!(film.sums_mut().restore(&bytes[1..], &[]).is_err());
    assert!(film.sums_mut().restore(&bytes[16..], &[]).is_err());
    assert!(film.sums_mut().restore(&bytes, std::slice::from_ref(&(0..4))).is_ok());
    assert_eq!(film.n_passes(), 4);
    assert!(film.holds_pass(3));
    assert!(!film.holds_pass(4));
}

/// Samples brighter than the film's limit are scaled down as a whole, so that their hue stays.
#[test]
fn brightness_can_be_limited() {
    let mut film = Film::new(FilmSettings { max_component: 2.0, ..settings(1, 1) }, Vec::new());
    let lambda = Wavelengths::sample_visible(0.35);
    let bright = Sampled::splat(1e6);
    fill(&mut film, |tile| tile.add([0, 0], &sample(bright, &lambda)));
    let free = settings(1, 1).output_rgb(bright, &lambda).map(f64::from);
    let largest = free[0].max(free[1]).max(free[2]);
    for (c, name) in ["R", "G", "B"].into_iter().enumerate() {
        check_near(values(&film, name)[0], 2.0 * free[c] / largest, 1e-5);
    }
}

/// What cannot be radiance is counted with its place and taken as black, and debug builds stop at once.
fn add_broken_sample(broken: f32) -> Film {
    let mut film = film(2, 1);
    let lambda = Wavelengths::sample_visible(0.35);
    fill(&mut film, |tile| {
        let mut radiance = [1.0; 4];
        radiance[2] = broken;
        tile.add([1, 0], &sample(Sampled::from_array(radiance), &lambda));
        tile.add([1, 0], &sample(Sampled::ONE, &lambda));
    });
    film
}

const BROKEN: [f32; 4] = [f32::NAN, f32::INFINITY, f32::NEG_INFINITY, -1.0];

/// See [`add_broken_sample`].
#[test]
#[cfg(debug_assertions)]
fn broken_samples_stop_debug_builds() {
    for broken in BROKEN {
        assert!(std::panic::catch_unwind(|| add_broken_sample(broken)).is_err(), "{broken}");
    }
}

/// See [`add_broken_sample`].
#[test]
#[cfg(not(debug_assertions))]
fn broken_samples_are_counted() {
    for broken in BROKEN {
        let film = add_broken_sample(broken);
        assert_eq!(film.sums().faults.invalid, 1);
        assert_eq!(film.sums().faults.first_pixel, Some([1, 0]));
        let lambda = Wavelengths::sample_visible(0.35);
        let whole = f64::from(film.settings().output_rgb(Sampled::ONE, &lambda)[1]);
        check_near(values(&film, "G")[1], 0.5 * whole, 1e-6);
    }
}

/// Samples beyond what a sum can hold are cut off and counted.
#[test]
fn saturation_is_counted() {
    let mut film = film(1, 1);
    let lambda = Wavelengths::sample_visible(0.5);
    fill(&mut film, |tile| tile.add([0, 0], &sample(Sampled::splat(1e30), &lambda)));
    assert!(film.sums().faults.saturated > 0);
    assert_eq!(film.sums().faults.invalid, 0);
    assert!(values(&film, "G")[0].is_finite());
}

/// One sample whose square no sum holds makes the worst firefly: its pixel is as unsure as one sample that outweighs all others,
/// with a standard error of the whole mean. A lamp that every sample sees is sure.
#[test]
fn huge_samples_are_unsure() {
    let n = 64_u64;
    for (n_huge, expected) in [(1, 1.0), (16, 1.0 / 21.0), (n, 0.0)] {
        let mut film = Film::new(FilmSettings { guides: true, ..settings(1, 1) }, Vec::new());
        let lambda = Wavelengths::sample_visible(0.5);
        for pass in 0..n {
            let y = if pass < n_huge { 1e6 } else { 1.0 };
            fill(&mut film, |tile| tile.add([0, 0], &sample(with_luminance(y, &lambda), &lambda)));
            film.note_pass(pass);
        }
        for (mean, variance) in
            [(values(&film, "G")[0], "variance.G"), (1e6 * n_huge as f64 / n as f64, "variance.Y")]
        {
            check_near(values(&film, variance)[0], expected * mean * mean, 1e-3);
        }
    }
}

/// A grey surface is grey under the white of the output, however exposed, in bands as on average over wavelengths.
#[test]
fn albedo_is_seen_under_white_light() {
    for color_space in ColorSpaceName::ALL {
        let sensor = SensorSettings { iso: 400.0, color_space, ..SensorSettings::default() };
        let settings = with_sensor(FilmKind::Rgb, sensor);
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
    let film = Film::new(with_sensor(kind, SensorSettings::default()), Vec::new());
    let sums = |lambda: &Wavelengths| {
        let mut tile = film.start_tile(film.settings().crop, TileSamples::default());
        let radiance = Sampled::splat(0.1);
        let sample = PixelSample { radiance, lambda, filter_weight: 1.0, features: None, layers: &[] };
        tile.add([1, 0], &sample);
        let mut film = film.clone();
        film.add_tiles(&[tile.finish()]);
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

/// How much of a render is left is known without counting its passes one by one.
#[test]
fn missing_passes_are_counted() {
    let mut film = film(1, 1);
    for pass in [0, 1, 2, 5] {
        film.note_pass(pass);
    }
    assert_eq!(film.sums().n_missing(&(0..8)), 4);
    assert_eq!(film.sums().n_missing(&(1..3)), 0);
    assert_eq!(film.sums().n_missing(&(6..9)), 3);
    assert_eq!(film.sums().n_missing(&(0..u64::MAX)), u64::MAX - 4);
}

/// At every number of passes the halves differ by four at most, by none at powers of two; from eight on they change after
/// aligned fours.
#[test]
fn halves_are_even() {
    let mut n_second = 0;
    for n in 1..=256_u64 {
        n_second += i64::from(guides::is_in_second_half(n - 1));
        let difference = n as i64 - 2 * n_second;
        assert!(difference.abs() <= 4, "{n}: {difference}");
        assert!(!n.is_power_of_two() || n == 1 || difference == 0, "{n}: {difference}");
    }
    let half = guides::is_in_second_half;
    assert!((8..256).all(|pass| half(pass) == half(pass - pass % 4)));
}

/// Variances are those of means, halves are means of their passes, and all survives a file.
#[test]
fn guides_tell_variances_and_halves() {
    let settings = FilmSettings { guides: true, ..settings(1, 1) };
    let mut film = Film::new(settings, vec!["direct".to_owned()]);
    let lambda = Wavelengths::sample_visible(0.6);
    let depths = [1.0, 2.0, 4.0, 9.0];
    for (pass, depth) in depths.into_iter().enumerate() {
        let bounds = film.settings().crop;
        let mut tile = film.start_tile(bounds, TileSamples::default()).of_pass(pass as u64);
        assert!(tile.wants_features());
        let features = Some(Features { depth, albedo: [0.5; 3], ..Features::default() });
        let radiance = Sampled::splat(depth);
        tile.add([0, 0], &PixelSample { features, layers: &[radiance], ..sample(radiance, &lambda) });
        let samples = tile.finish();
        film.add_tiles(&[samples]);
        film.note_pass(pass as u64);
    }
    check_near(values(&film, "depth.Z")[0], 4.0, 1e-6);
    // The sum of squared deviations is 9 + 4 + 0 + 25; of a mean of four the variance is that over 3 times 4.
    check_near(values(&film, "variance.depth.Z")[0], 38.0 / 12.0, 1e-5);
    check_near(values(&film, "variance.Albedo.G")[0], 0.0, 1e-9);
    let green = values(&film, "G")[0] / 4.0;
    check_near(values(&film, "variance.G")[0], green * green * 38.0 / 12.0, 1e-4);
    check_near(values(&film, "direct.G")[0], 4.0 * green, 1e-6);
    // Passes 0 and 2 are the first half, 1 and 3 the second.
    check_near(values(&film, "halfA.G")[0], 2.5 * green, 1e-6);
    check_near(values(&film, "halfB.G")[0], 5.5 * green, 1e-6);

    let mut image = film.develop();
    image.channels.extend(film.sums().exact_channels());
    // Files order channels by name.
    image.channels.sort_by(|a, b| a.name.cmp(&b.name));
    let mut again =
        FilmSums::from_image(&image, film.settings().crop, film.settings().luminance_weights()).unwrap();
    again.note_passes(0..4);
    for channel in &again.develop().channels {
        assert_eq!(Some(channel), image.channel(&channel.name));
    }
}
