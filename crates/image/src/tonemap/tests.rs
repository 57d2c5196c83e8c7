use super::{
    Dither, Operator, Quantization, Reinhard, apply, bayer_8x8, log_average_luminance, mean_luminance, to_u8,
};
use crate::{Encoding, Image, luminance, srgb_decode};

const OPERATORS: [Operator; 5] = [
    Operator::Clamp,
    Operator::DivideByMaximum,
    Operator::Exponential,
    Operator::Reinhard(Reinhard { key: 0.18, delta: 1e-5, white: None }),
    Operator::Reinhard(Reinhard { key: 0.36, delta: 1e-6, white: Some(4.0) }),
];

/// Gray ramp over ten powers of ten with a black pixel at its start.
fn ramp() -> Image {
    let gray = |x: usize| if x == 0 { 0.0 } else { 10f32.powf(x as f32 / 20.0 - 5.0) };
    Image::from_fn(201, 1, |x, _| [gray(x); 3])
}

fn mapped(image: &Image, operator: Operator, exposure_ev: f32) -> Vec<[f32; 3]> {
    apply(image, operator, exposure_ev).rgb_pixels().expect("the result has colour")
}

/// A display shows nothing darker than black or brighter than white.
#[test]
fn operators_are_bounded() {
    for operator in OPERATORS {
        for pixel in mapped(&ramp(), operator, 0.0) {
            let shown = luminance(pixel);
            assert!((0.0..=1.0 + 1e-6).contains(&shown), "{operator:?} gives {shown}");
        }
    }
}

/// More light never looks darker.
#[test]
fn operators_are_monotone() {
    for operator in OPERATORS {
        let shown: Vec<f32> = mapped(&ramp(), operator, 0.0).into_iter().map(luminance).collect();
        assert!(shown.windows(2).all(|pair| pair[1] >= pair[0] - 1e-7), "{operator:?}");
        assert!(shown[0] == 0.0 && shown[200] > 0.5, "{operator:?}");
    }
}

/// A global operator knows nothing of neighbours: equal pixels stay equal wherever they are.
#[test]
fn operators_are_global() {
    let image =
        Image::from_fn(8, 8, |x, y| if (x + y) % 3 == 0 { [0.2, 0.5, 0.1] } else { [x as f32, 3.0, 0.1] });
    for operator in OPERATORS {
        let shown = mapped(&image, operator, 1.0);
        assert!((0..64).filter(|i| (i % 8 + i / 8) % 3 == 0).all(|i| shown[i] == shown[0]), "{operator:?}");
    }
}

/// Scaling RGB by one factor keeps the ratios of its channels, so the hue.
#[test]
fn curves_keep_hue() {
    let image = Image::rgb(2, 1, vec![[4.0, 2.0, 1.0], [0.1, 0.3, 0.2]]);
    for operator in &OPERATORS[1..] {
        let shown = mapped(&image, *operator, 0.0)[0];
        assert!(
            (shown[0] / shown[1] - 2.0).abs() < 1e-5 && (shown[1] / shown[2] - 2.0).abs() < 1e-5,
            "{operator:?}"
        );
    }
}

/// Clamping clips each channel on both sides and leaves the displayable range alone.
#[test]
fn clamp_clips() {
    let image = Image::rgb(1, 1, vec![[-1.0, 0.25, 7.0]]);
    assert_eq!(mapped(&image, Operator::Clamp, 0.0), [[0.0, 0.25, 1.0]]);
    assert_eq!(mapped(&image, Operator::Clamp, 1.0), [[0.0, 0.5, 1.0]]);
}

/// Dividing by the maximum shows the brightest channel as 1 whatever the exposure.
#[test]
fn divide_by_maximum() {
    let image = Image::rgb(2, 1, vec![[8.0, 2.0, 0.0], [4.0, 4.0, 1.0]]);
    assert_eq!(mapped(&image, Operator::DivideByMaximum, 3.0), [[1.0, 0.25, 0.0], [0.5, 0.5, 0.125]]);
    let black = Image::rgb(1, 1, vec![[0.0; 3]]);
    assert_eq!(mapped(&black, Operator::DivideByMaximum, 0.0), [[0.0; 3]]);
}

/// A pixel of mean luminance is shown as 1 - 1/e.
#[test]
fn exponential_of_the_mean() {
    let image = Image::rgb(3, 1, vec![[2.0; 3], [0.0; 3], [4.0; 3]]);
    let shown = mapped(&image, Operator::Exponential, 0.0);
    assert!((shown[0][1] - (1.0 - (-1.0f32).exp())).abs() < 1e-6);
    assert!((shown[2][1] - (1.0 - (-2.0f32).exp())).abs() < 1e-6);
    let pixels = image.rgb_pixels().expect("colour");
    assert!((mean_luminance(&pixels).expect("three pixels") - 2.0).abs() < 1e-6);
}

/// The pixel of log-average luminance is shown as a / (1 + a), and exposure cancels out.
#[test]
fn reinhard_of_the_log_average() {
    let image = Image::rgb(3, 1, vec![[1.0; 3], [4.0; 3], [2.0; 3]]);
    let pixels = image.rgb_pixels().expect("colour");
    assert!((log_average_luminance(&pixels, 1e-9).expect("three pixels") - 2.0).abs() < 1e-6);
    for key in [0.09, 0.18, 0.72] {
        for exposure_ev in [-3.0, 0.0, 5.0] {
            let operator = Operator::Reinhard(Reinhard { key, delta: 1e-9, white: None });
            let shown = mapped(&image, operator, exposure_ev)[2][0];
            assert!((shown - key / (1.0 + key)).abs() < 1e-5, "key {key}: {shown}");
        }
    }
}

/// With a white point, luminance at it is shown as white and nothing exceeds white.
#[test]
fn reinhard_white_point() {
    let image = Image::rgb(3, 1, vec![[1.0; 3], [0.25; 3], [4.0; 3]]);
    let operator = Operator::Reinhard(Reinhard { key: 1.0, delta: 1e-9, white: Some(4.0) });
    let shown = mapped(&image, operator, 0.0);
    assert!((shown[2][0] - 1.0).abs() < 1e-5);
    assert!((shown[0][0] - (1.0 + 1.0 / 16.0) / 2.0).abs() < 1e-5);
}

/// One black pixel would send the log average to zero without the delta.
#[test]
fn delta_keeps_black_harmless() {
    let average = log_average_luminance(&[[0.0; 3], [1.0; 3]], 1e-4).expect("two pixels");
    assert!((average - 1e-2).abs() < 1e-5);
}

/// A NaN is shown black, an infinity white, and neither spoils the rest.
#[test]
fn non_finite_pixels() {
    let clean = Image::rgb(2, 1, vec![[1.0; 3], [0.5; 3]]);
    let dirty = Image::rgb(4, 1, vec![[1.0; 3], [0.5; 3], [f32::NAN, 1.0, 1.0], [f32::INFINITY, 0.0, 0.0]]);
    for operator in &OPERATORS[1..] {
        let shown = mapped(&dirty, *operator, 0.0);
        assert_eq!(shown[..2], mapped(&clean, *operator, 0.0));
        assert_eq!(shown[2..], [[0.0; 3], [1.0; 3]]);
    }
}

/// Alpha is coverage, not light, and passes through; layers are not part of the picture.
#[test]
fn alpha_and_layers() {
    let mut image = Image::rgb(1, 1, vec![[3.0; 3]]);
    image.set_channel("A", vec![0.5]);
    image.set_rgb("direct", &[[1.0; 3]]);
    let shown = apply(&image, Operator::Clamp, 0.0);
    assert_eq!(shown.channel("A").map(|alpha| alpha.values[0]), Some(0.5));
    assert_eq!(shown.layers(), [""]);
}

/// Every byte survives decoding and encoding, with any dithering: it is on the grid already.
#[test]
fn bytes_round_trip() {
    for encoding in [Encoding::Srgb, Encoding::Linear, Encoding::Gamma(2.2)] {
        for dither in [Dither::None, Dither::Ordered, Dither::Hashed(7)] {
            let image = Image::from_fn(256, 3, |x, _| [encoding.decode(x as f32 / 255.0); 3]);
            let bytes = to_u8(&image, Quantization { encoding, dither }).expect("colour");
            assert!((0..768).all(|i| bytes[i] == [(i % 256) as u8; 3]), "{encoding:?} {dither:?}");
        }
    }
}

/// Light outside the gamut is clipped; NaN is black.
#[test]
fn gamut_clip() {
    let image =
        Image::rgb(2, 1, vec![[-0.5, 2.0, f32::NAN], [f32::INFINITY, f32::NEG_INFINITY, 0.214_041_14]]);
    assert_eq!(to_u8(&image, Quantization::default()), Some(vec![[0, 255, 0], [255, 0, 128]]));
}

/// Dithering trades the step for noise: the mean over an area is the value itself, which rounding misses.
#[test]
fn dithering_keeps_the_mean() {
    let value = srgb_decode(100.3 / 255.0);
    let image = Image::from_fn(64, 64, |_, _| [value; 3]);
    let mean = |dither| {
        let bytes = to_u8(&image, Quantization { encoding: Encoding::Srgb, dither }).expect("colour");
        bytes.iter().map(|pixel| f64::from(pixel[0])).sum::<f64>() / 4096.0
    };
    assert_eq!(mean(Dither::None), 100.0);
    assert!((mean(Dither::Ordered) - 100.3).abs() < 1.0 / 64.0);
    // Standard deviation of the mean of 4096 Bernoulli trials of p = 0.3 is 0.0072; five of them.
    assert!((mean(Dither::Hashed(1)) - 100.3).abs() < 0.036);
}

/// The Bayer matrix holds each threshold once.
#[test]
fn bayer_is_a_permutation() {
    let mut entries: Vec<usize> = (0..64).map(|i| bayer_8x8(i % 8, i / 8)).collect();
    assert_eq!(entries[..2], [0, 32]);
    entries.sort_unstable();
    assert!(entries.iter().copied().eq(0..64));
}
