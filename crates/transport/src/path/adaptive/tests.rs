//! Which pixels are traced, and what the others get.

use super::*;

const SETTINGS: AdaptivePixels = AdaptivePixels { block_size: 8, contrast: CONTRAST };
const TILE: PixelBounds = PixelBounds { min: [32, 64], max: [64, 96] };

fn gray(value: f32) -> PassPixel {
    PassPixel { radiance: Sampled::splat(value), lambda: Wavelengths::sample_visible(0.3), features: None }
}

/// The values of a tile and how many pixels were interpolated.
fn fill(
    settings: &AdaptivePixels,
    bounds: PixelBounds,
    pass: u64,
    f: impl Fn([u32; 2]) -> f32,
) -> (Vec<f32>, u64) {
    let mut n_traced = 0;
    let (pixels, n_interpolated) = settings.fill(bounds, pass, |pixel| {
        n_traced += 1;
        gray(f(pixel))
    });
    assert_eq!(pixels.len(), bounds.n_pixels(), "every pixel has a value");
    assert_eq!(n_traced + n_interpolated, pixels.len() as u64, "no pixel is traced twice");
    (pixels.iter().map(|pixel| pixel.radiance[0]).collect(), n_interpolated)
}

/// Weights of a mean add up to 1 but for rounding.
fn is_near(a: f32, b: f32) -> bool {
    (a - b).abs() <= 1e-5 * b
}

/// A slope is interpolated without error; most of its pixels are not traced.
#[test]
fn slopes_are_interpolated() {
    for pass in 0..20 {
        let slope = |[x, y]: [u32; 2]| 100.0 + 0.5 * x as f32 + 0.25 * y as f32;
        let (values, n_interpolated) = fill(&SETTINGS, TILE, pass, slope);
        assert!(n_interpolated > 1024 * 9 / 10, "{n_interpolated} in pass {pass}");
        for (pixel, value) in TILE.pixels().zip(values) {
            assert!((value - slope(pixel)).abs() < 1e-3, "{pixel:?}: {value}");
        }
    }
}

/// Where a straight edge divides the tile every value is that of its side, but for cells whose corners all lie on one side.
#[test]
fn edges_are_traced() {
    for pass in 0..20 {
        let edge = |[x, y]: [u32; 2]| if 3 * x + y < 230 { 1.0 } else { 10.0 };
        let (values, n_interpolated) = fill(&SETTINGS, TILE, pass, edge);
        assert!(n_interpolated > 512, "{n_interpolated}");
        let n_wrong =
            TILE.pixels().zip(values).filter(|(pixel, value)| !is_near(*value, edge(*pixel))).count();
        assert!(n_wrong <= 2, "{n_wrong} in pass {pass}");
    }
}

/// A thin line that runs through the lattice is lost in some passes, where no corner falls on it, and found in others: the rule
/// of the module's head.
#[test]
fn thin_lines_are_found_by_the_lattice() {
    let line = |[x, _]: [u32; 2]| if x == 49 { 10.0 } else { 1.0 };
    let n_found = (0..64)
        .filter(|&pass| {
            let (values, _) = fill(&SETTINGS, TILE, pass, line);
            TILE.pixels().zip(&values).all(|(pixel, value)| is_near(*value, line(pixel)))
        })
        .count();
    let n_lost = (0..64)
        .filter(|&pass| fill(&SETTINGS, TILE, pass, line).0.iter().all(|value| is_near(*value, 1.0)))
        .count();
    // One lattice column in eight falls on it; 64 passes leave 8 +- 2.6.
    assert_eq!(n_found + n_lost, 64, "found as a whole or not at all");
    assert!((1..=20).contains(&n_found), "{n_found}");
}

/// Each colour has its own threshold, met exactly.
#[test]
fn thresholds_are_those_of_the_colours() {
    let corner = |value: f32, i: usize| {
        let mut radiance = [1.0; N_LAMBDA];
        radiance[i] = value;
        PassPixel { radiance: Sampled::from_array(radiance), ..gray(0.0) }
    };
    let lambda = Wavelengths::sample_visible(0.3);
    for i in 0..N_LAMBDA {
        let nm = lambda.lambda_nm()[i];
        let threshold = CONTRAST[if nm >= RED_NM {
            0
        } else if nm >= GREEN_NM {
            1
        } else {
            2
        }];
        // (x - 1) / (x + 1) = threshold.
        let at = (1.0 + threshold) / (1.0 - threshold);
        let (one, below, above) = (gray(1.0), corner(0.999 * at, i), corner(1.001 * at, i));
        assert!(SETTINGS.agree([&one, &below, &one, &one]), "{nm}");
        assert!(!SETTINGS.agree([&one, &one, &above, &one]), "{nm}");
    }
    let mut reduced = gray(1.0);
    reduced.lambda.terminate_secondary();
    assert!(!SETTINGS.agree([&gray(1.0), &reduced, &gray(1.0), &gray(1.0)]), "other wavelengths");
    assert!(SETTINGS.agree([&gray(0.0), &gray(0.0), &gray(0.0), &gray(0.0)]), "black is smooth");
}

/// Tiles of any size are filled, also where a threshold of 0 has everything traced.
#[test]
fn tiles_of_any_size_are_filled() {
    let noise = |[x, y]: [u32; 2]| (hash64(&[u64::from(x), u64::from(y)]) % 1000) as f32;
    for (width, height) in [(1, 1), (1, 7), (9, 1), (2, 2), (3, 5), (31, 8), (32, 32)] {
        for block_size in 2..=8 {
            let bounds = PixelBounds { min: [5, 11], max: [5 + width, 11 + height] };
            let settings = AdaptivePixels { block_size, contrast: [0.0; 3] };
            let (values, n_interpolated) = fill(&settings, bounds, u64::from(block_size), noise);
            assert_eq!(n_interpolated, 0);
            assert!(bounds.pixels().zip(values).all(|(pixel, value)| value == noise(pixel)));
            let _ = fill(&AdaptivePixels { block_size, contrast: [1.0; 3] }, bounds, 3, noise);
        }
    }
}
