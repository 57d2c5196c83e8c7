use super::{
    Bilateral, DisplayCurve, Dither, Gradient, HistogramAdjustment, Logarithmic, Operator, Quantization,
    Reinhard, ReinhardLocal, apply, automatic_exposure, log_average_luminance, mean_luminance, to_u8,
};
use crate::{Encoding, Image, luminance, srgb_decode};

const OPERATORS: [Operator; 6] = [
    Operator::Clamp,
    Operator::DivideByMaximum,
    Operator::Exponential,
    Operator::Reinhard(Reinhard { key: 0.18, delta: 1e-5, white: None }),
    Operator::Reinhard(Reinhard { key: 0.36, delta: 1e-6, white: Some(4.0) }),
    Operator::Logarithmic(Logarithmic { bias: 0.85, display: 100.0 }),
];

/// Operators that change colours or are not monotone over all pictures.
fn others() -> [Operator; 7] {
    [
        Operator::Display(DisplayCurve::Filmic),
        Operator::Display(DisplayCurve::Aces),
        Operator::Display(DisplayCurve::Agx),
        Operator::Histogram(HistogramAdjustment::default()),
        Operator::ReinhardLocal(ReinhardLocal::default()),
        Operator::Bilateral(Bilateral::default()),
        Operator::Gradient(Gradient::default()),
    ]
}

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

/// A picture of ten powers of ten in all directions, with texture.
fn scene() -> Image {
    Image::from_fn(160, 120, |x, y| {
        let l = 10_f32
            .powf((x as f32 / 16.0 - 5.0) * 0.5 + 0.05 * ((x * 7 + y * 13) % 5) as f32 + y as f32 / 120.0);
        [l, 0.8 * l, 0.5 * l]
    })
}

/// Whatever the operator, a display gets finite numbers from 0 on, whatever the picture holds, and white is not far above 1.
#[test]
fn all_operators_are_tame() {
    let odd = Image::from_fn(9, 7, |x, y| match (x, y) {
        (0, 0) => [f32::NAN, 1.0, 1.0],
        (1, 0) => [f32::INFINITY, 1.0, 0.0],
        (2, 0) => [-1.0, 0.5, 0.0],
        (_, 1) => [0.0; 3],
        (_, 2) => [1e30; 3],
        (_, 3) => [1e-30; 3],
        _ => [0.3, 0.2, 0.7],
    });
    let faint = Image::from_fn(6, 5, |x, _| [if x == 0 { 0.0 } else { 1e-40 }; 3]);
    let dark = Image::from_fn(5, 4, |_, _| [0.0; 3]);
    let one = Image::from_fn(1, 1, |_, _| [3.0, 2.0, 1.0]);
    let flat = Image::from_fn(70, 40, |_, _| [0.4; 3]);
    let line = Image::from_fn(200, 1, |x, _| [x as f32; 3]);
    for operator in OPERATORS.into_iter().chain(others()) {
        for image in [&odd, &faint, &dark, &one, &flat, &line, &scene(), &Image::new(0, 0)] {
            let shown = apply(image, operator, 0.0).rgb_pixels().unwrap_or_default();
            for pixel in &shown {
                let is_tame = pixel.iter().all(|value| value.is_finite() && *value >= 0.0);
                assert!(is_tame && luminance(*pixel) <= 2.0, "{operator:?}: {pixel:?}");
            }
            assert_eq!(shown.len(), image.rgb_pixels().unwrap_or_default().len());
        }
        assert!(mapped(&dark, operator, 0.0).iter().all(|pixel| luminance(*pixel) < 1e-3), "{operator:?}");
        assert_eq!(mapped(&odd, operator, 0.0)[0], [0.0; 3], "{operator:?} shows NaN");
    }
}

/// Equal pixels of a flat picture stay equal, also where operators look around.
#[test]
fn flat_pictures_stay_flat() {
    let flat = Image::from_fn(90, 50, |_, _| [0.6, 0.4, 0.2]);
    for operator in OPERATORS.into_iter().chain(others()) {
        let shown = mapped(&flat, operator, 0.0);
        let first = luminance(shown[0]);
        assert!(shown.iter().all(|pixel| (luminance(*pixel) - first).abs() < 1e-4 * first), "{operator:?}");
    }
    let global = mapped(&flat, Operator::Reinhard(Reinhard { delta: 0.0, ..Reinhard::default() }), 0.0);
    let local = mapped(&flat, Operator::ReinhardLocal(ReinhardLocal::default()), 0.0);
    assert!((global[0][0] - local[0][0]).abs() < 1e-5, "{global:?} {local:?}");
}

/// Curves of displays never show more light darker, keep grey grey, show black as black and bright light as white.
#[test]
fn display_curves_are_monotone() {
    for operator in &others()[..3] {
        let ramp = Image::from_fn(300, 1, |x, _| [10_f32.powf(x as f32 / 50.0 - 4.0); 3]);
        let shown = mapped(&ramp, *operator, 0.0);
        assert!(shown.windows(2).all(|pair| pair[1][1] >= pair[0][1] - 1e-4), "{operator:?}");
        assert!(shown[0][1] < 0.005 && shown[299][1] > 0.9, "{operator:?} {:?} {:?}", shown[0], shown[299]);
        let grey = |pixel: &[f32; 3]| (pixel[0] - pixel[1]).abs().max((pixel[2] - pixel[1]).abs());
        assert!(shown.iter().all(|pixel| grey(pixel) < 0.01), "{operator:?}");
        let middle = mapped(&Image::from_fn(1, 1, |_, _| [0.18; 3]), *operator, 0.0)[0][1];
        assert!((0.08..0.4).contains(&middle), "{operator:?} shows middle grey as {middle}");
    }
}

/// The largest luminance is the display's white, and the log-average lies where the formula puts it (Drago et al. (4)).
#[test]
fn logarithm_of_known_values() {
    let image = Image::from_fn(3, 1, |x, _| [[0.01, 1.0, 100.0][x]; 3]);
    let shown = mapped(&image, Operator::Logarithmic(Logarithmic::default()), 0.0);
    assert!((shown[2][0] - 1.0).abs() < 1e-5, "{shown:?}");
    // L_avg = 1: ln 2 / ln(2 + 8 (1/100)^(ln 0.85 / ln 0.5)) / log10(101).
    let expected =
        2.0_f64.ln() / (2.0 + 8.0 * 0.01_f64.powf(0.85_f64.ln() / 0.5_f64.ln())).ln() / 101_f64.log10();
    assert!((f64::from(shown[1][0]) - expected).abs() < 1e-5, "{shown:?} {expected}");
}

/// Where a picture is bright and where it is dark.
#[derive(Copy, Clone, Debug)]
enum Border {
    /// Bright beyond a straight line: direction of its normal in degrees, and where it crosses the middle row, as a share of the width.
    Straight(f32, f32),
    /// Bright within a circle of that radius in pixels about the middle.
    Disc(f32),
    /// Dark within it.
    DarkDisc(f32),
}

impl Border {
    /// Distance in pixels to the border, positive where it is bright.
    fn distance(self, x: usize, y: usize, size: [usize; 2]) -> f32 {
        let [width, height] = size.map(|n| n as f32);
        let (x, y) = (x as f32 + 0.5, y as f32 + 0.5 - 0.5 * height);
        match self {
            Self::Straight(degrees, place) => {
                let (sin, cos) = degrees.to_radians().sin_cos();
                (x - place * width) * cos + y * sin
            }
            Self::Disc(radius) => radius - (x - 0.5 * width).hypot(y),
            Self::DarkDisc(radius) => (x - 0.5 * width).hypot(y) - radius,
        }
    }
}

/// How far the shown step exceeds its plateaus in the logarithm, over its shown height, the larger of both sides. The plateaus are
/// what is shown farthest from the border.
fn overshoot(operator: Operator, border: Border, decades: f32) -> f32 {
    let size = [320, 240];
    let distance = |i: usize| border.distance(i % size[0], i / size[0], size);
    let bright = 10_f32.powf(decades);
    let image = Image::from_fn(size[0], size[1], |x, y| {
        [if border.distance(x, y, size) > 0.0 { bright } else { 1.0 }; 3]
    });
    let shown: Vec<f32> = mapped(&image, operator, 0.0).iter().map(|pixel| pixel[1].log10()).collect();
    let farthest = |sign: f32| {
        let place = (0..shown.len()).max_by(|a, b| (sign * distance(*a)).total_cmp(&(sign * distance(*b))));
        shown[place.expect("pixels")]
    };
    let (low, high) = (farthest(-1.0), farthest(1.0));
    let (least, most) = shown.iter().fold((low, high), |(a, b), v| (a.min(*v), b.max(*v)));
    assert!(high > low, "{operator:?} shows no step");
    (low - least).max(most - high) / (high - low)
}

/// An edge has no halo: at most 2 % of the shown step for the bilateral operator, 5 % for the local photographic one and
/// for gradients, in any direction, off the centre and around discs.
#[test]
fn edges_have_no_halos() {
    use Border::{DarkDisc, Disc, Straight};
    let borders = [
        Straight(0.0, 0.5),
        Straight(90.0, 0.5),
        Straight(0.0, 0.25),
        Straight(10.0, 0.5),
        Straight(27.0, 0.8),
        Straight(45.0, 0.5),
        Straight(225.0, 0.25),
        Disc(30.0),
        Disc(90.0),
        DarkDisc(30.0),
        DarkDisc(90.0),
    ];
    for border in borders {
        for decades in [0.5, 0.75, 1.1, 3.5] {
            let limits = [
                (Operator::Bilateral(Bilateral::default()), 0.02),
                (Operator::ReinhardLocal(ReinhardLocal::default()), 0.05),
                (Operator::Gradient(Gradient::default()), 0.05),
            ];
            for (operator, limit) in limits {
                let found = overshoot(operator, border, decades);
                assert!(found < limit, "{operator:?}, {border:?}: {found} of {decades} decades");
            }
        }
    }
}

/// Local operators keep the contrast of texture that the global curve flattens, on both sides of a large step.
#[test]
fn texture_survives_local_operators() {
    let texture = |x: usize, y: usize| if (x / 2 + y / 2).is_multiple_of(2) { 1.0 } else { 1.3 };
    let image = Image::from_fn(256, 128, |x, y| [texture(x, y) * if x < 128 { 0.05 } else { 200.0 }; 3]);
    let contrast = |operator: Operator, x: usize| {
        let shown = mapped(&image, operator, 0.0);
        let at = |x: usize| shown[64 * 256 + x][1];
        at(x + 2).max(at(x)) / at(x + 2).min(at(x))
    };
    let world = 1.3;
    let global = contrast(Operator::Reinhard(Reinhard::default()), 192);
    for operator in
        [Operator::ReinhardLocal(ReinhardLocal::default()), Operator::Bilateral(Bilateral::default())]
    {
        for x in [60, 192] {
            let local = contrast(operator, x);
            assert!(
                local > global && local > 1.0 + 0.4 * (world - 1.0),
                "{operator:?} {local} against {global}"
            );
        }
    }
    let gradient = contrast(Operator::Gradient(Gradient::default()), 192);
    assert!(gradient > global, "{gradient} against {global}");
}

/// The gradient operator keeps the sign of every steep gradient of a smooth picture.
#[test]
fn gradients_keep_their_signs() {
    let image = Image::from_fn(128, 96, |x, y| {
        [10_f32.powf((x as f32 * 0.1).sin() * 2.0 + (y as f32 * 0.07).cos()); 3]
    });
    let shown = mapped(&image, Operator::Gradient(Gradient { saturation: 1.0, ..Gradient::default() }), 0.0);
    let world = image.rgb_pixels().expect("colour");
    let (mut n, mut n_kept) = (0, 0);
    for y in 0..96 {
        for x in 0..127 {
            let i = y * 128 + x;
            let (before, after) = (world[i + 1][1] / world[i][1], shown[i + 1][1] / shown[i][1]);
            // What is shown as white has no gradient.
            if before.ln().abs() > 0.05 && shown[i][1].max(shown[i + 1][1]) < 0.999 {
                n += 1;
                n_kept += i32::from((before > 1.0) == (after > 1.0));
            }
        }
    }
    assert!(n > 5000 && n_kept >= n - n / 200, "{n_kept} of {n}");
}

/// The gradient operator uses the display's range where the world has more, and shows no more contrast than the world where it has less.
#[test]
fn compressed_gradients_fill_the_display() {
    for (decades, expected) in [(4.0, 2.0), (3.0, 2.0), (1.0, 1.0)] {
        let image = Image::from_fn(200, 150, |x, y| {
            [10_f32.powf(decades * 0.5 * ((x as f32 * 0.05).sin() + 0.1 * (y as f32 * 0.9).sin())); 3]
        });
        let mut shown: Vec<f32> =
            mapped(&image, Operator::Gradient(Gradient { saturation: 1.0, ..Gradient::default() }), 0.0)
                .iter()
                .map(|pixel| pixel[1].log10())
                .collect();
        shown.sort_by(f32::total_cmp);
        let range = shown[29_700] - shown[300];
        assert!((range / expected - 1.0).abs() < 0.12, "{range} of {expected} decades");
    }
}

/// Histogram adjustment is monotone, never shows more contrast than the world, and uses the display's range where the world has more:
/// of a ramp with most of it in the dark, of narrow peaks with most of the pixels, and of a flat picture with two lights.
#[test]
fn histogram_adjustment_exaggerates_nothing() {
    // Decades of luminance of pixel number t in [0, 1).
    let peak = |at: f32, width: f32, share: f32, t: f32| {
        if t < share { at + width * (t / share - 0.5) } else { 5.0 * (t - share) / (1.0 - share) }
    };
    let pictures: [&dyn Fn(f32) -> f32; 7] = [
        &|t| 5.0 * t.powi(3),
        &|t| peak(2.0, 0.02, 0.97, t),
        &|t| peak(4.99, 0.01, 0.97, t),
        &|t| peak(0.2, 0.3, 0.8, t),
        &|t| if t < 0.5 { 0.01 * t } else { 5.0 + 0.01 * t },
        &|t| if t < 0.999 { 0.0 } else { 4000.0 * (t - 0.999) },
        &|t| 1.5 * t,
    ];
    for (index, picture) in pictures.into_iter().enumerate() {
        let (width, n) = (120, 120 * 120);
        let image =
            Image::from_fn(width, width, |x, y| [10_f32.powf(picture((y * width + x) as f32 / n as f32)); 3]);
        for contrast in [1.5_f32, 30.0, 100.0, 1000.0] {
            let operator = HistogramAdjustment { contrast, ..HistogramAdjustment::default() };
            let shown = mapped(&image, Operator::Histogram(operator), 0.0);
            let world = image.rgb_pixels().expect("colour");
            // The display adds its black to all that it shows.
            let seen = |i: usize| (shown[i][1] * (1.0 - 1.0 / contrast) + 1.0 / contrast).ln();
            let mut order: Vec<usize> = (0..n).collect();
            order.sort_by(|a, b| world[*a][1].total_cmp(&world[*b][1]));
            for step in [1, n / 100, n / 4] {
                for pair in order.windows(step + 1) {
                    let (a, b) = (pair[0], pair[step]);
                    let there = (world[b][1] / world[a][1]).ln();
                    let seen = seen(b) - seen(a);
                    // Rounding of shares of the display's range.
                    assert!(
                        seen > -1e-5 && seen <= 1.0001 * there + 1e-4,
                        "picture {index}, contrast {contrast}: {seen} of {there}"
                    );
                }
            }
            let range = |values: &dyn Fn(usize) -> f32| values(order[n - 1]) - values(order[0]);
            let (seen, there) = (range(&seen), range(&|i| world[i][1].ln()));
            assert!(there < contrast.ln() || seen > 0.97 * contrast.ln(), "picture {index}: {seen}");
        }
    }
}

#[test]
fn automatic_exposure_gives_the_key() {
    let image = Image::from_fn(2, 1, |x, _| [[4.0, 16.0][x]; 3]);
    assert!((automatic_exposure(&image, 0.18) - (0.18_f32 / 8.0).log2()).abs() < 1e-4);
    assert_eq!(automatic_exposure(&Image::from_fn(2, 1, |_, _| [0.0; 3]), 0.18), 0.0);
}

/// The ranges of the problem (TONE-1): what the world has, what eyes take and what displays show; and every global operator brings
/// that of the world to that of a display, with white paper in the sun at least as bright as any other.
#[test]
fn the_range_of_the_world_fits_a_display() {
    // Sun over moon, white over black surfaces; receptors, pupil, adaptation.
    let (world, eye) = (800_000.0_f32 * 100.0, 100.0_f32 * 10.0 * 10_000.0);
    assert_eq!((world, eye), (8e7, 1e7));
    let illuminated = |light: f32| [1.0, 10.0, 100.0].map(|paper| light * paper);
    let lights = [1.0, 1e2, 1e4, 800_000.0];
    let image = Image::from_fn(3, 4, |x, y| [0.001 * illuminated(lights[y])[x]; 3]);
    let range = |pixels: &[[f32; 3]]| {
        let values = || pixels.iter().map(|pixel| luminance(*pixel));
        (values().fold(f32::INFINITY, f32::min), values().fold(0.0, f32::max))
    };
    let (dark, bright) = range(&image.rgb_pixels().expect("colour"));
    assert!((bright / dark / world - 1.0).abs() < 1e-5, "{}", bright / dark);
    // The local ones come last.
    for operator in OPERATORS.into_iter().chain(others().into_iter().take(4)) {
        let shown = mapped(&image, operator, 0.0);
        let (least, most) = range(&shown);
        assert!(least >= 0.0 && most <= 1.001 && most > 0.3, "{operator:?}: {least} to {most}");
        assert!(luminance(shown[11]) >= most - 1e-3, "{operator:?}: {shown:?}");
    }
    // 256 levels of a display in eight bits: a step near white is below 1 %.
    let step = srgb_decode(1.0) / srgb_decode(254.0 / 255.0);
    assert!((1.0..1.01).contains(&step), "{step}");
}
