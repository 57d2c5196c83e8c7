use super::*;

fn plain(scale: Scale) -> FalseColors {
    FalseColors { scale, palette: Palette::Gray, contours: false, unit: None }
}

/// Ends of a scale get the ends of the palette, what is beyond them too, and what is no number gets grey.
#[test]
fn colors_of_values() {
    let scale = Scale::new(Spread::Logarithmic, 1.0, 100.0).expect("a scale");
    let colors = plain(scale);
    let gray = |value| colors.color(value)[0];
    assert_eq!([gray(0.0), gray(1.0), gray(100.0), gray(f64::INFINITY)], [0.0, 0.0, 1.0, 1.0]);
    assert!((gray(10.0) - srgb_decode(0.5)).abs() < 1e-6);
    assert_eq!(gray(f64::NAN), srgb_decode(NO_VALUE));
    assert_eq!(gray(-1.0), srgb_decode(NO_VALUE));
}

/// Scales that mean nothing are refused.
#[test]
fn refused_scales() {
    for (spread, low, high) in [
        (Spread::Linear, 1.0, 1.0),
        (Spread::Linear, 2.0, 1.0),
        (Spread::Logarithmic, 0.0, 1.0),
        (Spread::Logarithmic, -1.0, 1.0),
        (Spread::Linear, f64::NAN, 1.0),
        (Spread::Linear, 0.0, f64::INFINITY),
    ] {
        assert_eq!(Scale::new(spread, low, high), None, "{spread:?} {low} {high}");
    }
    assert!(Scale::new(Spread::Linear, -5.0, 5.0).is_some());
}

/// Ticks are round and within the ends.
#[test]
fn ticks() {
    let ticks = |spread, low, high| Scale::new(spread, low, high).expect("a scale").ticks();
    assert_eq!(ticks(Spread::Linear, 0.0, 500.0), (0..=10).map(|k| 50.0 * f64::from(k)).collect::<Vec<_>>());
    assert_eq!(ticks(Spread::Linear, 3.0, 7.0), [3.0, 3.5, 4.0, 4.5, 5.0, 5.5, 6.0, 6.5, 7.0]);
    let log = ticks(Spread::Logarithmic, 1.0, 100.0);
    assert_eq!(log.len(), 7);
    assert!(
        log.iter().zip([1.0, 2.0, 5.0, 10.0, 20.0, 50.0, 100.0]).all(|(a, b)| (a / b - 1.0_f64).abs() < 1e-9)
    );
    assert_eq!(ticks(Spread::Logarithmic, 1e-6, 1.0).len(), 7);
    let labels: Vec<String> = [0.0, 0.05, 1.0, 250.0, 2e7].into_iter().map(label).collect();
    assert_eq!(labels, ["0", "0.05", "1", "250", "2e7"]);
}

/// A scale that fits leaves almost nothing above it, and is logarithmic where the range is wide.
#[test]
fn fitting_scales() {
    let even: Vec<f32> = (1..=1000).map(|i| i as f32 * 0.37).collect();
    let scale = Scale::fitting(&even, None);
    assert_eq!((scale.spread(), scale.ends()), (Spread::Linear, [0.0, 500.0]));
    let wide: Vec<f32> = (0..1000).map(|i| 10f32.powf(i as f32 / 200.0)).collect();
    let scale = Scale::fitting(&wide, None);
    assert_eq!((scale.spread(), scale.ends()), (Spread::Logarithmic, [100.0, 100_000.0]));
    // Nothing to fit.
    for values in [vec![], vec![f32::NAN, 0.0, f32::INFINITY]] {
        assert_eq!(Scale::fitting(&values, None).ends(), [0.0, 1.0]);
    }
    let tiny = Scale::fitting(&[1e-42; 4], None);
    assert!(tiny.ends()[1] > 0.0 && tiny.ticks().len() > 2);
}

/// Contours of a ramp are where it crosses ticks, one pixel wide.
#[test]
fn contours() {
    let values: Vec<f32> = (0..200).map(|i| (i % 100) as f32 + 0.5).collect();
    let scale = Scale::new(Spread::Linear, 0.0, 100.0).expect("a scale");
    let with =
        FalseColors { contours: true, ..plain(scale) }.draw(&values, 100).rgb_pixels().expect("colour");
    let without = plain(scale).draw(&values, 100).rgb_pixels().expect("colour");
    let changed: Vec<usize> = (0..100).filter(|&i| with[i] != without[i]).collect();
    assert_eq!(changed, (1..10).map(|k| 10 * k - 1).collect::<Vec<_>>());
    // NaN has no contour.
    let _ = FalseColors { contours: true, ..plain(scale) }.draw(&[f32::NAN, 1.0, f32::NAN, 90.0], 2);
}

/// Contours of noise around a step are one line along the step.
#[test]
fn contours_ignore_noise() {
    let value = |x: usize, y: usize| {
        let noise = (x as u32).wrapping_mul(2_654_435_761) ^ (y as u32).wrapping_mul(2_246_822_519);
        40.0 + 20.0 * x as f32 / 199.0 + ((noise >> 13) % 100) as f32 / 100.0 - 0.5
    };
    let values: Vec<f32> = (0..200 * 100).map(|i| value(i % 200, i / 200)).collect();
    let scale = Scale::new(Spread::Linear, 0.0, 100.0).expect("a scale");
    let with =
        FalseColors { contours: true, ..plain(scale) }.draw(&values, 200).rgb_pixels().expect("colour");
    let without = plain(scale).draw(&values, 200).rgb_pixels().expect("colour");
    let changed = (0..values.len()).filter(|&i| with[i] != without[i]);
    // 40 at the left border, 50 in the middle, 60 at the right one.
    assert!(changed.map(|i| i % 200).all(|x| x < 12 || (88..112).contains(&x) || x > 187));
}

/// Enlarged fields are interpolated between their middles, and keep their mean.
#[test]
fn enlarged_fields() {
    assert_eq!(enlarged(&[1.0, 3.0], 2, 2), [1.0, 1.5, 2.5, 3.0, 1.0, 1.5, 2.5, 3.0]);
    assert_eq!(enlarged(&[7.0], 1, 3), [7.0; 9]);
}

/// A legend stands at the right of the map, which it leaves as it is; its bar has all colours from high to low.
#[test]
fn legend() {
    let values = vec![50.0f32; 150 * 120];
    let scale = Scale::new(Spread::Linear, 0.0, 100.0).expect("a scale");
    let colors = FalseColors { unit: Some("cd/m²".to_owned()), ..plain(scale) };
    let picture = colors.draw(&values, 150);
    assert!(picture.width > 180 && picture.height == 120);
    let pixels = picture.rgb_pixels().expect("colour");
    assert!((0..120).all(|y| pixels[y * picture.width + 149] == colors.color(50.0)));
    let bar: Vec<f32> = (20..110).map(|y| pixels[y * picture.width + 158][0]).collect();
    assert!(bar.windows(2).all(|pair| pair[0] >= pair[1]), "{bar:?}");
    assert_eq!(pixels[20 * picture.width + 158], [1.0; 3]);
    // Small pictures grow by white so that the legend has room.
    assert_eq!(colors.draw(&[1.0], 1).height, LEAST_HEIGHT);
}

/// A linear scale may end at zero or below it; what leaves no room between its ends is none.
#[test]
fn scales_below_zero() {
    let scale = Scale::new(Spread::Linear, -10.0, 0.0).expect("a scale");
    assert_eq!((scale.place(-2.5), scale.ticks().len()), (Some(0.75), 11));
    assert!(Scale::new(Spread::Linear, -4.0, -2.0).is_some());
    for [low, high] in [[0.0, 0.0], [1.0, -1.0], [f64::MIN, f64::MAX], [f64::NAN, 1.0]] {
        assert_eq!(Scale::new(Spread::Linear, low, high), None, "{low} {high}");
    }
    for [low, high] in [[0.0, 1.0], [-2.0, -1.0], [2.0, 1.0]] {
        assert_eq!(Scale::new(Spread::Logarithmic, low, high), None, "{low} {high}");
    }
}

/// Ticks show no digits of rounding.
#[test]
fn labels_are_short() {
    assert_eq!(label(1.500_000_000_000_000_1e-4), "1.5e-4");
    assert_eq!(label(3.0 * 1e-7), "3e-7");
    assert_eq!(label(-2e6), "-2e6");
    assert_eq!([label(0.0), label(0.3), label(1500.0)], ["0", "0.3", "1500"]);
}
