use super::{
    CompareError, DifferenceKind, Pair, Settings, VARIANCE, ZTest, compare, flip, hdr_flip, side_by_side,
    split,
};
use crate::{Image, srgb_decode};

fn gradient() -> Image {
    Image::from_fn(24, 16, |x, y| [x as f32 / 24.0, y as f32 / 16.0, ((x * y) % 7) as f32 / 7.0])
}

fn constant(color: [f32; 3]) -> Image {
    Image::from_fn(8, 8, |_, _| color)
}

fn mean_flip(a: &Image, b: &Image) -> f64 {
    compare(a, b, &Settings::default()).expect("comparable images").flip
}

/// An image does not differ from itself.
#[test]
fn identity_is_zero() {
    let image = gradient();
    let same = compare(&image, &image, &Settings::default()).expect("same size");
    for error in [same.mse, same.rmse, same.relmse, same.mape, same.smape, same.flip] {
        assert_eq!(error, 0.0);
    }
    assert_eq!(same.psnr_db, f64::INFINITY);
    assert_eq!((same.mean_ratio, same.channel_ratio), (1.0, [1.0; 3]));
    assert_eq!((same.n_pixels, same.n_masked), (384, 0));
}

/// Two flat fields 0.5 and 0.25: every metric can be written down.
#[test]
fn known_values() {
    let result = compare(&constant([0.5; 3]), &constant([0.25; 3]), &Settings::default()).expect("same size");
    let expected = [
        (result.mse, 0.0625),
        (result.rmse, 0.25),
        (result.relmse, 0.0625 / 0.0725),
        (result.mape, 0.25 / 0.26),
        (result.smape, 0.25 / 0.76),
        (result.psnr_db, 10.0 * 16f64.log10()),
        (result.mean_ratio, 2.0),
        (result.mean_test[1], 0.5),
        (result.mean_reference[2], 0.25),
    ];
    for (value, expected) in expected {
        assert!((value - expected).abs() < 1e-12, "{value} instead of {expected}");
    }
}

/// A loss in one channel shows in that channel's ratio alone.
#[test]
fn ratios_by_channel() {
    let result = compare(&constant([1.0, 0.5, 2.0]), &constant([1.0, 1.0, 2.0]), &Settings::default())
        .expect("same size");
    assert_eq!(result.channel_ratio, [1.0, 0.5, 1.0]);
    assert!((result.mean_ratio - 3.5 / 4.0).abs() < 1e-12);
}

/// A pixel that is not finite in one image is counted and left out of every mean.
#[test]
fn non_finite_pixels_are_masked() {
    let reference = gradient();
    let mut test = gradient();
    test.channels[0].values[5] = f32::NAN;
    test.channels[1].values[5] = f32::INFINITY;
    test.channels[2].values[300] = f32::NEG_INFINITY;
    let result = compare(&test, &reference, &Settings::default()).expect("same size");
    assert_eq!((result.n_masked, result.n_non_finite_test, result.n_non_finite_reference), (2, 2, 0));
    assert_eq!((result.mse, result.flip, result.mean_ratio), (0.0, 0.0, 1.0));
    let nothing =
        compare(&constant([f32::NAN; 3]), &constant([1.0; 3]), &Settings::default()).expect("same size");
    let numbers = [nothing.mse, nothing.relmse_trimmed, nothing.psnr_db, nothing.ssim, nothing.flip];
    assert!(numbers.iter().chain([&nothing.mean_ratio, &nothing.smape]).all(|v| v.is_nan()), "{nothing:?}");
}

/// Clipping both images hides differences beyond the bounds.
#[test]
fn clamping() {
    let settings = Settings { clamp: Some([0.0, 1.0]), ..Settings::default() };
    let result = compare(&constant([7.0; 3]), &constant([1.0; 3]), &settings).expect("same size");
    assert_eq!((result.mse, result.mean_ratio), (0.0, 1.0));
}

/// Images that cannot be compared say why.
#[test]
fn incomparable() {
    let depth = {
        let mut image = Image::new(8, 8);
        image.set_channel("Z", vec![1.0; 64]);
        image
    };
    let settings = Settings::default();
    let sizes = compare(&gradient(), &constant([0.0; 3]), &settings).expect_err("24 x 16 against 8 x 8");
    assert_eq!(sizes, CompareError::SizesDiffer { test: [24, 16], reference: [8, 8] });
    assert!(sizes.to_string().contains("24 x 16 against 8 x 8"));
    assert_eq!(compare(&depth, &constant([0.0; 3]), &settings), Err(CompareError::NoColor));
    let empty = Image::rgb(0, 3, Vec::new());
    assert_eq!(compare(&empty, &empty, &settings), Err(CompareError::Empty));
}

/// Green against blue is the largest distance by construction, so its error is 1.
#[test]
fn flip_of_green_and_blue_is_one() {
    let flip = mean_flip(&constant([0.0, 1.0, 0.0]), &constant([0.0, 0.0, 1.0]));
    assert!((flip - 1.0).abs() < 1e-4, "{flip}");
}

/// Black against white: lightness differs by 100, chroma not at all, and there are no features.
#[test]
fn flip_of_black_and_white() {
    let flip = mean_flip(&constant([0.0; 3]), &constant([1.0; 3]));
    // HyAB of green and blue with the Hunt effect, from their CIELAB coordinates (D65).
    let (green, blue) = ([87.735, -86.184, 83.18], [32.303, 79.197, -107.855]);
    let chroma = |lab: [f64; 3], i: usize| 0.01 * lab[0] * lab[i];
    let (da, db) = (chroma(green, 1) - chroma(blue, 1), chroma(green, 2) - chroma(blue, 2));
    let largest = (green[0] - blue[0] + da.hypot(db)).powf(0.7);
    let expected = 0.95 + 0.05 * (100f64.powf(0.7) - 0.4 * largest) / (0.6 * largest);
    assert!((flip - expected).abs() < 1e-4, "{flip} instead of {expected}");
    assert!(flip > 0.96);
}

/// Flipping A to B shows what flipping B to A shows.
#[test]
fn flip_is_symmetric_and_bounded() {
    let a = gradient();
    let b = Image::from_fn(24, 16, |x, y| [y as f32 / 16.0, if x % 5 == 0 { 1.0 } else { 0.1 }, 0.3]);
    assert_eq!(mean_flip(&a, &b), mean_flip(&b, &a));
    let map = Pair::new(&a, &b, None).expect("same size").flip_map(flip::PIXELS_PER_DEGREE, 0.0);
    assert!(map.iter().all(|error| (0.0..=1.0).contains(error)));
}

/// A stronger change is seen more.
#[test]
fn flip_grows_with_the_change() {
    let brighter = |step: f32| {
        Image::from_fn(24, 16, |x, y| [x as f32 / 24.0 * 0.5 + step, y as f32 / 32.0 + step, 0.2 + step])
    };
    let errors: Vec<f64> =
        [0.01, 0.05, 0.1, 0.3].iter().map(|&step| mean_flip(&brighter(step), &brighter(0.0))).collect();
    assert!(errors.is_sorted() && errors[0] > 0.0, "{errors:?}");
}

/// The eye blurs a fine checkerboard: seen from afar it differs less from its average than seen from near.
#[test]
fn flip_filters_fine_patterns() {
    let checker = Image::from_fn(32, 32, |x, y| [((x + y) % 2) as f32; 3]);
    let average = Image::from_fn(32, 32, |_, _| [0.5; 3]);
    let at = |pixels_per_degree| {
        let settings = Settings { pixels_per_degree, ..Settings::default() };
        compare(&checker, &average, &settings).expect("same size").flip
    };
    assert!(at(120.0) < 0.5 * at(10.0), "{} against {}", at(120.0), at(10.0));
}

/// Bytes of a picture with gradients, a checkerboard and hashed grain.
fn pattern(x: usize, y: usize) -> [u8; 3] {
    let hash = (x as u32).wrapping_mul(2_654_435_761) ^ (y as u32).wrapping_mul(2_246_822_519);
    let hash = (hash ^ (hash >> 15)).wrapping_mul(0x85eb_ca6b);
    let grain = ((hash ^ (hash >> 13)) & 63) as u8;
    [(x * 4) as u8, if (x / 8 + y / 8).is_multiple_of(2) { 200 } else { grain }, (y * 5) as u8]
}

/// The same with two channels swapped in a box, red halved at the right, and green a little raised elsewhere.
fn changed_pattern(x: usize, y: usize) -> [u8; 3] {
    let [r, g, b] = pattern(x, y);
    if (20..40).contains(&x) && (10..30).contains(&y) {
        return [g, r, b];
    }
    if x > 44 { [r / 2, g, b] } else { [r, g.saturating_add(6), b] }
}

/// The authors' C++ implementation (version 1.2) on the same two pictures, 67.02064 pixels per degree.
#[test]
fn flip_agrees_with_the_authors() {
    let picture = |pattern: fn(usize, usize) -> [u8; 3]| {
        Image::from_fn(64, 48, |x, y| pattern(x, y).map(|byte| srgb_decode(f32::from(byte) / 255.0)))
    };
    let pair = Pair::new(&picture(changed_pattern), &picture(pattern), None).expect("same size");
    let map = pair.flip_map(flip::PIXELS_PER_DEGREE, 0.0);
    assert!((pair.mean_of_map(&map) - 0.434_109_134).abs() < 1e-6);
    let pixels = [
        ([0, 0], 0.199_357_67),
        ([30, 20], 0.715_311_4),
        ([19, 15], 0.330_463_23),
        ([50, 40], 0.641_897_56),
        ([63, 47], 0.799_855_95),
        ([5, 33], 0.199_022_49),
    ];
    for ([x, y], expected) in pixels {
        assert!(
            (map[y * 64 + x] - expected).abs() < 5e-6,
            "{x}, {y}: {} instead of {expected}",
            map[y * 64 + x]
        );
    }
}

/// The two pictures of [`flip_agrees_with_the_authors`], eight stops brighter from left to right by `stops`.
fn patterns(stops: f32) -> [Image; 2] {
    [changed_pattern, pattern].map(|pattern| {
        Image::from_fn(64, 48, |x, y| {
            let exposure = (stops * x as f32 / 64.0).exp2();
            pattern(x, y).map(|byte| srgb_decode(f32::from(byte) / 255.0) * exposure)
        })
    })
}

/// The authors' Python package (`flip-evaluator` 1.7) on the same two pictures, eight stops brighter to the right.
#[test]
fn hdr_flip_agrees_with_the_authors() {
    let [test, reference] = patterns(8.0);
    let exposures = hdr_flip::exposures(&reference.rgb_pixels().expect("colour"));
    assert_eq!(exposures.len(), 6);
    assert!((exposures[0] + 6.235_355_4).abs() < 1e-5 && (exposures[5] + 0.652_319_73).abs() < 1e-5);
    let pair = Pair::new(&test, &reference, None).expect("same size");
    let map = pair.hdr_flip_map(flip::PIXELS_PER_DEGREE);
    let mean = pair.mean_of_map(&map);
    assert!((mean - 0.417_033_2).abs() < 1e-5, "{mean}");
    let pixels =
        [([0, 0], 0.155_251_25), ([30, 20], 0.974_960_74), ([50, 40], 0.642_549_93), ([63, 47], 0.506_825_8)];
    for ([x, y], expected) in pixels {
        let value = map[y * 64 + x];
        assert!((value - expected).abs() < 2e-5, "{x}, {y}: {value} instead of {expected}");
    }
}

/// What black, infinite and huge references ask for stays bounded.
#[test]
fn exposures_of_odd_references() {
    assert!(hdr_flip::exposures(&[[0.0; 3]; 4]).is_empty());
    assert!(hdr_flip::exposures(&[]).is_empty());
    let n = hdr_flip::exposures(&[[0.0; 3], [0.0; 3], [f32::MAX; 3]]).len();
    assert!((100..200).contains(&n), "{n}");
    let one = hdr_flip::exposures(&[[1.0; 3]; 4]);
    assert_eq!(one.len(), 2);
    // Nothing is measured against a reference that is black, or where all is masked.
    for [test, reference] in [[1.0, 0.0], [0.0, 0.0], [1.0, f32::NAN]] {
        let pair = Pair::new(&constant([test; 3]), &constant([reference; 3]), None).expect("same size");
        assert!(pair.mean_of_map(&pair.hdr_flip_map(flip::PIXELS_PER_DEGREE)).is_nan());
    }
}

/// Pixels that are left out do not make pictures alike: half of a picture masked, the other of similarity s, has s and not (1 + s) / 2.
#[test]
fn similarity_leaves_masked_pixels_out() {
    let field =
        |value: f32, masked: f32| Image::from_fn(60, 40, |x, _| [if x < 30 { value } else { masked }; 3]);
    let [bright, dark] = [srgb_decode(0.8), srgb_decode(0.4)];
    let pair = Pair::new(&field(bright, f32::NAN), &field(dark, 0.5), None).expect("same size");
    // Of flat fields: (2 a b + C1) / (a^2 + b^2 + C1). Windows of six columns of thirty reach over the masked half.
    let flat = (2.0 * 0.8 * 0.4 + 1e-4) / (0.64 + 0.16 + 1e-4);
    let found = pair.ssim(0.0);
    assert!((found - flat).abs() < 0.05, "{found} instead of {flat}");
}

/// scikit-image 0.26 and NumPy on the same two pictures: `structural_similarity` with `gaussian_weights`, `sigma` 1.5 and without
/// `use_sample_covariance`, and the formulas of the others in double precision.
#[test]
fn metrics_agree_with_scikit_image() {
    let [test, reference] = patterns(0.0);
    let result = compare(&test, &reference, &Settings::default()).expect("same size");
    for (what, value, expected) in [
        ("ssim", result.ssim, 0.776_176_15),
        ("mse", result.mse, 0.039_445_185_018),
        ("relmse", result.relmse, 0.272_797_961_9),
        ("trimmed relmse", result.relmse_trimmed, 0.267_925_819_1),
        ("mape", result.mape, 0.362_538_949_9),
        ("smape", result.smape, 0.132_368_389_1),
        ("psnr", result.psnr_db, 14.040_060_025),
    ] {
        assert!((value / expected - 1.0).abs() < 2e-6, "{what}: {value} instead of {expected}");
    }
}

/// Pictures smaller than the window have a similarity too; equal ones are alike.
#[test]
fn similarity_of_small_pictures() {
    for (width, height) in [(1, 1), (11, 2), (11, 11), (30, 12)] {
        let image = Image::from_fn(width, height, |x, y| [0.1 * (x % 7) as f32, 0.2 * (y % 3) as f32, 0.5]);
        let pair = Pair::new(&image, &image, None).expect("same size");
        assert_eq!(pair.ssim(0.0), 1.0);
    }
}

/// Ten thousand pixels of honest noise pass, those of another mean do not.
#[test]
fn z_test() {
    let noise = |seed: u32, mean: f32| {
        let normal = |i: u32| {
            // Sum of twelve hashed uniform numbers: variance 1.
            let uniform = |k: u32| {
                let mut h =
                    (i * 12 + k).wrapping_add(seed.wrapping_mul(0x9e37_79b9)).wrapping_mul(0x85eb_ca6b);
                h = (h ^ (h >> 13)).wrapping_mul(0xc2b2_ae35);
                h = (h ^ (h >> 16)).wrapping_mul(0x27d4_eb2f);
                (h ^ (h >> 15)) as f32 / u32::MAX as f32
            };
            (0..12).map(uniform).sum::<f32>() - 6.0
        };
        let mut image = Image::gray(100, 100, (0..10_000).map(|i| mean + 0.5 * normal(i)).collect());
        image.set_channel(VARIANCE, vec![0.25; 10_000]);
        image
    };
    let test = |a: &Image, b: &Image| ZTest::new(a, b).expect("same size").expect("variance");
    let same = test(&noise(1, 3.0), &noise(2, 3.0));
    assert_eq!(same.n_tested, 10_000);
    // Standard errors of the root mean square and of the share: 0.007 and 0.0005; five of each.
    assert!((same.rms - 1.0).abs() < 0.035, "{}", same.rms);
    assert!((same.share_beyond - 0.0027).abs() < 0.0026, "{}", same.share_beyond);
    assert!(same.z_mean.abs() < 5.0 && same.p_mean > 1e-6);
    let other = test(&noise(1, 3.0), &noise(2, 3.1));
    assert!(other.z_mean < -10.0 && other.p_mean < 1e-6 && other.z.len() == 10_000);
    assert_eq!(ZTest::new(&constant([1.0; 3]), &constant([1.0; 3])), Ok(None));
    // Without noise there is nothing to test, and NaN is left out.
    let mut silent = constant([1.0; 3]);
    silent.set_channel(VARIANCE, vec![0.0; silent.n_pixels()]);
    let mut broken = silent.clone();
    broken.channels[0].values[3] = f32::NAN;
    broken.channels[0].values[2] = 1.5;
    let nothing = test(&silent, &broken);
    assert_eq!([nothing.n_tested, nothing.n_untested], [0, 1]);
    assert!([nothing.rms, nothing.share_beyond, nothing.z_mean, nothing.p_mean].iter().all(|v| v.is_nan()));
}

/// A plane of zeros estimates no variance; a zero beside other values does: that of a pixel whose samples are equal.
#[test]
fn z_test_without_variance() {
    let with = |values: Vec<f32>, variances: Vec<f32>| {
        let mut image = Image::gray(2, 2, values);
        image.set_channel(VARIANCE, variances);
        image
    };
    let noisy = with(vec![1.0, 2.0, 0.0, 4.0], vec![0.25, 0.25, 0.0, 0.25]);
    for none in [0.0, f32::NAN, f32::INFINITY] {
        let one_sample = with(vec![1.5, 2.0, 0.0, 3.0], vec![none; 4]);
        for [a, b] in [[&noisy, &one_sample], [&one_sample, &noisy]] {
            let test = ZTest::new(a, b).expect("same size").expect("variance");
            assert_eq!([test.n_tested, test.n_untested], [0, 2]);
            assert!([test.rms, test.share_beyond, test.z_mean, test.p_mean].iter().all(|v| v.is_nan()));
            assert_eq!(test.z, [0.0; 4]);
        }
    }
    // Of the pixels that are black in one, that which is not in the other is tested by the variance there.
    let dark = with(vec![1.0, 0.0, 0.0, 4.0], vec![0.25, 0.0, 0.0, 0.25]);
    let test = ZTest::new(&noisy, &dark).expect("same size").expect("variance");
    assert_eq!([test.n_tested, test.n_untested], [3, 0]);
    assert_eq!(test.z, [0.0, 4.0, 0.0, 0.0]);
}

/// Views have the pixels of both.
#[test]
fn views() {
    let (a, b) = (constant([0.25; 3]), constant([0.5; 3]));
    let beside = side_by_side(&[&a, &b]).expect("colour");
    assert_eq!([beside.width, beside.height], [2 * a.width + 1, a.height]);
    let pixels = beside.rgb_pixels().expect("colour");
    assert_eq!([pixels[0][0], pixels[a.width][0], pixels[a.width + 1][0]], [0.25, 1.0, 0.5]);
    let halves = split(&a, &b).expect("colour").rgb_pixels().expect("colour");
    assert_eq!([halves[0][0], halves[a.width / 2][0], halves[a.width - 1][0]], [0.25, 1.0, 0.5]);
    assert_eq!(split(&a, &Image::rgb(1, 1, vec![[0.0; 3]])), None);
    assert_eq!(side_by_side(&[]), None);
}

/// A difference map of a darker pixel is negative there, shown blue, and zero elsewhere.
#[test]
fn difference_maps() {
    let reference = constant([0.5; 3]);
    let mut test = reference.clone();
    test.channels.iter_mut().for_each(|channel| channel.values[9] = 0.25);
    let pair = Pair::new(&test, &reference, None).expect("same size");
    let signed = pair.difference(DifferenceKind::Signed);
    assert!((signed.values[9] + 0.25).abs() < 1e-6 && signed.values[8] == 0.0);
    let shown = signed.to_false_colors(0.25).rgb_pixels().expect("colour");
    assert!(shown[9][2] > shown[9][0] && shown[8][0] > 0.9);
    let absolute = pair.difference(DifferenceKind::Absolute);
    assert!((absolute.max() - 0.25).abs() < 1e-6);
    let relative = pair.difference(DifferenceKind::RelativeSquared).to_image();
    assert!((relative.channels[0].values[9] - 0.0625 / 0.26).abs() < 1e-6);
    let flip = pair
        .difference(DifferenceKind::Flip { pixels_per_degree: flip::PIXELS_PER_DEGREE, exposure_ev: 0.0 });
    assert!(flip.values[9] > flip.values[63]);
}
