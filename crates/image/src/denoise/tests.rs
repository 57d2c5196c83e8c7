//! Tests of the denoiser on made noise, whose truth is known.

use super::*;

/// Numbers that look random, in [-1, 1), of variance 1/3.
fn noise(seed: u32) -> impl FnMut() -> f32 {
    let mut state = seed.wrapping_mul(2_654_435_761).wrapping_add(12_345);
    move || {
        state ^= state << 13;
        state ^= state >> 17;
        state ^= state << 5;
        state as f32 / 2_f32.powi(31) - 1.0
    }
}

/// A render of `truth` with uniform noise of `sigma` times the truth in each half.
fn noisy(width: usize, height: usize, sigma: f32, truth: impl Fn(usize, usize) -> f32) -> Image {
    let mut random = noise(width as u32 + 7);
    let mut half = || -> Vec<[f32; 3]> {
        let pixel = |i: usize| truth(i % width, i / width);
        (0..width * height)
            .map(|i| [(); 3].map(|()| pixel(i) * (1.0 + sigma * 3_f32.sqrt() * random())))
            .collect()
    };
    let (a, b) = (half(), half());
    let mean: Vec<[f32; 3]> =
        a.iter().zip(&b).map(|(a, b)| std::array::from_fn(|c| 0.5 * (a[c] + b[c]))).collect();
    let mut image = Image::rgb(width, height, mean);
    image.set_rgb("halfA", &a);
    image.set_rgb("halfB", &b);
    let variance = |i: usize| [0.5 * (sigma * truth(i % width, i / width)).powi(2); 3];
    let variances: Vec<[f32; 3]> = (0..width * height).map(variance).collect();
    image.set_rgb("variance", &variances);
    image
}

fn with_albedo(mut image: Image, albedo: impl Fn(usize, usize) -> f32) -> Image {
    let width = image.width;
    let pixels: Vec<[f32; 3]> = (0..image.n_pixels()).map(|i| [albedo(i % width, i / width); 3]).collect();
    image.set_rgb("Albedo", &pixels);
    image.set_rgb("variance.Albedo", &vec![[0.0; 3]; pixels.len()]);
    image
}

fn without(mut image: Image, names: &[&str]) -> Image {
    image.channels.retain(|channel| !names.iter().any(|name| channel.name.starts_with(name)));
    image
}

#[track_caller]
fn clean(image: &Image) -> Vec<[f32; 3]> {
    let denoised = denoise(image, &Settings::default()).expect("it can be denoised");
    denoised.image.rgb_pixels().expect("it has colours")
}

fn mean(pixels: &[[f32; 3]]) -> f64 {
    pixels.iter().flatten().map(|v| f64::from(*v)).sum::<f64>() / (3 * pixels.len()) as f64
}

fn mean_square_error(pixels: &[[f32; 3]], truth: impl Fn(usize) -> f32) -> f64 {
    let error = |(i, pixel): (usize, &[f32; 3])| {
        pixel.iter().map(|v| f64::from(v - truth(i)).powi(2)).sum::<f64>() / 3.0
    };
    pixels.iter().enumerate().map(error).sum::<f64>() / pixels.len() as f64
}

/// Noise on an even wall goes, and the mean stays: with weights that owe nothing to the noise of a pixel, only their
/// unevenness moves it. A window has 361 pixels; a twentieth of the variance is far more than it may leave.
#[test]
fn noise_on_a_constant_goes() {
    let image = noisy(64, 48, 0.4, |_, _| 2.0);
    let before = image.rgb_pixels().unwrap();
    let after = clean(&image);
    let (error_before, error_after) =
        (mean_square_error(&before, |_| 2.0), mean_square_error(&after, |_| 2.0));
    assert!(error_after < error_before / 20.0, "{error_before} to {error_after}");
    assert!((mean(&after) / mean(&before) - 1.0).abs() < 0.005, "{} to {}", mean(&before), mean(&after));
}

/// An edge that a feature shows is as sharp afterwards as before, even where noise hides it: the regression makes no pixel
/// beside it a mean of both sides.
#[test]
fn edges_of_features_stay_sharp() {
    let truth = |x: usize| if x < 24 { 0.5 } else { 1.0 };
    let image = with_albedo(noisy(48, 48, 0.5, |x, _| truth(x)), |x, _| truth(x));
    let after = clean(&image);
    for x in [22, 23, 24, 25] {
        let column: Vec<[f32; 3]> = (0..48).map(|y| after[y * 48 + x]).collect();
        // Noise of a half leaves 0.5 / sqrt(2 * 48 * 3) = 3 % on the mean of an unfiltered column.
        let ratio = mean(&column) / f64::from(truth(x));
        assert!((ratio - 1.0).abs() < 0.06, "column {x}: {ratio}");
    }
}

/// A picture without variance is the result, whatever its features say.
#[test]
fn pictures_without_noise_stay() {
    let truth = |x: usize, y: usize| 1.0 + (x * 7 % 13) as f32 * 0.1 + y as f32 * 0.05;
    for image in [noisy(40, 20, 0.0, truth), with_albedo(noisy(40, 20, 0.0, truth), |x, _| x as f32)] {
        for (after, i) in clean(&image).iter().zip(0..) {
            let truth = truth(i % 40, i / 40);
            assert!(
                after.iter().all(|v| (v / truth - 1.0).abs() < 1e-4),
                "pixel {i}: {after:?}, not {truth}"
            );
        }
    }
}

/// The same picture ten thousand times as bright is denoised the same.
#[test]
fn brightness_does_not_matter() {
    let truth = |x: usize, y: usize| if x + y < 30 { 1.0 } else { 3.0 };
    let (dim, bright) =
        (clean(&noisy(32, 32, 0.3, truth)), clean(&noisy(32, 32, 0.3, |x, y| 1e4 * truth(x, y))));
    for (dim, bright) in dim.iter().zip(&bright) {
        assert!((0..3).all(|c| (bright[c] / dim[c] / 1e4 - 1.0).abs() < 1e-2), "{dim:?} {bright:?}");
    }
}

/// Threads change no bit.
#[test]
fn threads_change_nothing() {
    let image =
        with_albedo(noisy(70, 41, 0.4, |x, y| 1.0 + (x ^ y) as f32 * 0.02), |x, y| (x ^ y) as f32 * 0.02);
    let with = |n: usize| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(n).build().unwrap();
        pool.install(|| clean(&image))
    };
    assert!(with(1) == with(3));
}

/// Pixels that are not finite are guessed from their neighbours and spoil none of them; negative ones (colours beyond the
/// gamut) are colours like others.
#[test]
fn broken_pixels_are_guessed() {
    let mut image = noisy(32, 32, 0.1, |_, _| 1.0);
    for (name, i, value) in
        [("R", 100, f32::NAN), ("halfA.G", 500, f32::INFINITY), ("B", 7, f32::NEG_INFINITY)]
    {
        image.channel_mut(name).unwrap().values[i] = value;
    }
    for (name, value) in [("variance.R", f32::NAN), ("variance.G", -1.0), ("variance.B", f32::INFINITY)] {
        image.channel_mut(name).unwrap().values[300] = value;
    }
    for name in ["halfA.R", "halfB.R", "R"] {
        image.channel_mut(name).unwrap().values[800] = -0.5;
    }
    let denoised = denoise(&image, &Settings::default()).unwrap();
    assert_eq!(denoised.n_repaired, 3);
    let pixels = denoised.image.rgb_pixels().unwrap();
    assert!(pixels.iter().flatten().all(|v| v.is_finite()));
    for i in [100, 500, 7, 101, 300] {
        assert!(pixels[i].iter().all(|v| (v - 1.0).abs() < 0.2), "pixel {i}: {:?}", pixels[i]);
    }
    let all_broken = Image::rgb(3, 3, vec![[f32::NAN; 3]; 9]);
    let mut all_broken = Image { ..all_broken };
    all_broken.set_channel("variance.Y", vec![f32::NAN; 9]);
    assert!(clean(&all_broken).iter().flatten().all(|v| v.is_finite()));
}

/// Pictures smaller than a window, down to a pixel.
#[test]
fn tiny_pictures() {
    for (width, height) in [(1, 1), (2, 1), (1, 5), (3, 33)] {
        let image = with_albedo(noisy(width, height, 0.2, |_, _| 1.0), |x, _| x as f32);
        let after = clean(&image);
        assert!(after.iter().flatten().all(|v| (v - 1.0).abs() < 0.5), "{width} x {height}: {after:?}");
    }
    let empty = denoise(&Image::new(0, 4), &Settings::default());
    assert_eq!(empty.err(), Some(DenoiseError::Empty));
}

/// What is missing is told; a picture and its variance are enough.
#[test]
fn channels_may_be_missing() {
    let full = with_albedo(noisy(32, 32, 0.3, |_, _| 1.0), |_, _| 0.5);
    let run = |image: &Image| denoise(image, &Settings::default());
    let denoised = run(&full).unwrap();
    assert_eq!((denoised.features, denoised.missing_features), (vec!["Albedo"], vec!["Ns", "depth"]));
    assert!(denoised.has_halves);
    assert!(denoised.image.channels.iter().all(|channel| !channel.name.starts_with("half")));
    assert!(denoised.image.channel("variance.R").is_none());
    assert!(denoised.image.channel("Albedo.R").is_some());

    let plain = run(&without(full.clone(), &["half", "Albedo", "variance.Albedo"])).unwrap();
    assert!(!plain.has_halves && plain.features.is_empty());
    let before = mean_square_error(&full.rgb_pixels().unwrap(), |_| 1.0);
    let after = mean_square_error(&plain.image.rgb_pixels().unwrap(), |_| 1.0);
    assert!(after < before / 4.0, "{before} to {after}");

    // Halves alone tell the variance.
    assert!(run(&without(full.clone(), &["variance"])).is_ok());
    assert_eq!(run(&without(full.clone(), &["variance", "half"])).err(), Some(DenoiseError::NoVariance));
    assert_eq!(run(&without(full, &["R", "G", "B"])).err(), Some(DenoiseError::NoColor));
}

/// A gray picture stays one.
#[test]
fn gray_pictures_stay_gray() {
    let mut image = Image::gray(8, 8, (0..64).map(|i| 1.0 + 0.1 * (i * 29 % 7) as f32).collect());
    image.set_channel("variance.Y", vec![0.05; 64]);
    let denoised = denoise(&image, &Settings::default()).unwrap().image;
    assert_eq!(denoised.channels.iter().map(|channel| &channel.name[..]).collect::<Vec<_>>(), ["Y"]);
    assert!(denoised.channel("Y").unwrap().values != image.channel("Y").unwrap().values);
}

/// A single sample per pixel leaves the second half black and tells no variance: the picture stays, and says so.
#[test]
fn single_samples_tell_nothing() {
    let mut image = noisy(16, 16, 0.0, |x, _| 1.0 + x as f32);
    image.set_rgb("halfB", &[[0.0; 3]; 256]);
    let denoised = denoise(&image, &Settings::default()).unwrap();
    assert!(denoised.is_noiseless && !denoised.has_halves);
    for (before, after) in image.rgb_pixels().unwrap().iter().zip(denoised.image.rgb_pixels().unwrap()) {
        assert!((before[0] / after[0] - 1.0).abs() < 1e-4);
    }
}

fn sums(image: &Image) -> Vec<f64> {
    image
        .channels
        .iter()
        .map(|c| c.values.iter().filter(|v| v.is_finite()).map(|v| f64::from(*v)).sum())
        .collect()
}

/// Fireflies go, singly, in pairs and in corners, and their light stays in the picture: sums are kept to rounding.
#[test]
fn fireflies_keep_their_energy() {
    let mut image = noisy(40, 30, 0.1, |x, _| 0.5 + 0.02 * x as f32);
    for (pixel, value) in [(0, 50.0), (605, 300.0), (606, 100.0), (1199, 20.0)] {
        for name in ["R", "halfA.R", "G", "halfA.G", "variance.R"] {
            image.channel_mut(name).unwrap().values[pixel] *= value;
        }
    }
    let image = without(image, &["variance"]);
    let spread = spread_fireflies(&image);
    assert_eq!(spread.n_fireflies, 4);
    for (before, after) in sums(&image).iter().zip(sums(&spread.image)) {
        assert!((after / before - 1.0).abs() < 1e-5, "{before} became {after}");
    }
    let pixels = spread.image.rgb_pixels().unwrap();
    assert!([0, 605, 606, 1199].iter().all(|pixel| luminance(pixels[*pixel]) < 20.0));
}

use crate::luminance;

/// What is bright and sure is a lamp; and without surroundings there is nothing to stand out of.
#[test]
fn lamps_are_no_fireflies() {
    let mut image = Image::from_fn(20, 20, |x, y| if (x, y) == (9, 9) { [100.0; 3] } else { [1.0; 3] });
    let with_error = |image: &mut Image, error: f32| {
        let variances = image.rgb_pixels().unwrap().iter().map(|pixel| (error * pixel[0]).powi(2)).collect();
        image.set_channel("variance.Y", variances);
        spread_fireflies(image).n_fireflies
    };
    assert_eq!(with_error(&mut image, 0.2), 0);
    assert_eq!(with_error(&mut image, 0.9), 1);
    // After one sample per pixel there is no variance, which makes nothing sure.
    assert_eq!(with_error(&mut image, 0.0), 1);
    for image in [
        Image::rgb(1, 1, vec![[5.0; 3]]),
        Image::rgb(2, 1, vec![[5.0; 3], [0.0; 3]]),
        Image::rgb(3, 3, vec![[0.0; 3]; 9]),
        Image::rgb(3, 3, vec![[f32::NAN; 3]; 9]),
        Image::new(0, 0),
        Image::new(3, 3),
    ] {
        assert_eq!(spread_fireflies(&image).n_fireflies, 0);
    }
}

/// A firefly in the dark gives its light to the dark; broken neighbours take none.
#[test]
fn fireflies_in_the_dark() {
    let mut image = Image::from_fn(9, 9, |x, y| if (x, y) == (4, 4) { [81.0; 3] } else { [0.0; 3] });
    image.channel_mut("R").unwrap().values[0] = f32::INFINITY;
    let spread = spread_fireflies(&image);
    assert_eq!(spread.n_fireflies, 1);
    let after = sums(&spread.image);
    assert!((after[1] - 81.0).abs() < 1e-3, "{after:?}");
}
