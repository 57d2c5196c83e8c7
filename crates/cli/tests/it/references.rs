//! Renders of scenes that others made, against the pictures that other renderers made of them.
//!
//! Tolerances are those by which the scenes' editions for different renderers differ, plus what noise allows: four
//! standard errors of the mean, measured by the render itself.

use std::path::Path;

use etendue::image::{Image, box_downsample};
use etendue::io::images::read_image;

use crate::real_scenes::shared_scenes;
use crate::support::{Folder, is_slow};

/// Both images are clamped here where single overexposed pixels would decide a mean.
const CLAMP: f32 = 10.0;

struct Case<'a> {
    scene: &'a str,
    resolution: &'a str,
    spp: &'a str,
    /// Extra arguments.
    arguments: &'a [&'a str],
}

/// A render with the relative standard error of its mean luminance.
fn render(case: &Case<'_>, shared: &Path) -> (Image, f64) {
    let folder = Folder::new();
    let scene = shared.join(case.scene);
    let mut arguments = vec!["render", scene.to_str().expect("a path is text"), "-q", "-o", "out.exr"];
    arguments.extend(["--resolution", case.resolution, "--spp", case.spp]);
    arguments.extend(case.arguments);
    folder.run_with(&arguments).expect(0);
    let image = folder.image("out.exr");
    let variance = &image.channel("variance.Y").expect("renders state their variance").values;
    let n = variance.len() as f64;
    let error = variance.iter().map(|v| f64::from(*v)).sum::<f64>().sqrt() / n;
    let pixels = image.rgb_pixels().expect("a render has colour");
    let mean = pixels.iter().map(|c| f64::from(etendue::image::luminance(*c))).sum::<f64>() / n;
    (image, error / mean)
}

/// The reference, averaged over blocks down to the size of the render.
fn reference(shared: &Path, image: &Image) -> Image {
    let reference = read_image(shared.join("reference.exr")).expect("a reference");
    let factor = reference.width / image.width;
    assert_eq!(reference.width, factor * image.width, "a whole multiple");
    box_downsample(&reference, factor)
}

/// Mean of each channel, of values up to `clamp`.
fn means(image: &Image, clamp: f32) -> [f64; 3] {
    let pixels = image.rgb_pixels().expect("colour");
    let sum = pixels.iter().fold([0.0; 3], |sum: [f64; 3], pixel| {
        std::array::from_fn(|c| sum[c] + f64::from(pixel[c].min(clamp)))
    });
    sum.map(|s| s / pixels.len() as f64)
}

#[track_caller]
fn check_means(mean: [f64; 3], expected: [f64; 3], tolerance: f64, relative_error: f64) {
    for c in 0..3 {
        let ratio = mean[c] / expected[c];
        let limit = tolerance + 4.0 * relative_error;
        assert!(
            (ratio - 1.0).abs() <= limit,
            "channel {c}: ratio {ratio}, limit {limit}; {mean:?} for {expected:?}"
        );
    }
}

/// Five other renderers agree on the mean of this box to 0.3 %.
#[test]
fn box_of_the_peers() {
    let (Some(scenes), true) = (shared_scenes(), is_slow()) else { return };
    let peers = scenes.join("../peers/cornell");
    let case = Case { scene: "cornell-path.pbrt", resolution: "128x128", spp: "256", arguments: &[] };
    let (image, error) = render(&case, &peers);
    check_means(means(&image, f32::INFINITY), [0.2437, 0.2248, 0.1936], 0.003, error);
}

/// Rendered in three bands as the reference was, the classic box agrees within 1 %.
#[test]
fn cornell_box_in_bands() {
    let (Some(scenes), true) = (shared_scenes(), is_slow()) else { return };
    let shared = scenes.join("cornell-box");
    let arguments = &["--wavelengths", "bands"];
    let case = Case { scene: "scene-v4.pbrt", resolution: "128x128", spp: "256", arguments };
    let (image, error) = render(&case, &shared);
    // Nothing is brighter than the lamp, so that nothing needs to be clamped.
    let theirs = means(&reference(&shared, &image), f32::INFINITY);
    check_means(means(&image, f32::INFINITY), theirs, 0.01, error);
}

/// Spectra multiply otherwise than RGB triples do: under the warm lamp of this box, walls return less blue light than
/// the product of their RGB values says. Spectral renderers agree on that, so we assert it.
#[test]
fn cornell_box_is_less_blue_in_spectra() {
    let (Some(scenes), true) = (shared_scenes(), is_slow()) else { return };
    let shared = scenes.join("cornell-box");
    let case = Case { scene: "scene-v4.pbrt", resolution: "128x128", spp: "256", arguments: &[] };
    let (image, _) = render(&case, &shared);
    let ours = means(&image, f32::INFINITY);
    let theirs = means(&reference(&shared, &image), f32::INFINITY);
    let ratio: [f64; 3] = std::array::from_fn(|c| ours[c] / theirs[c]);
    assert!((ratio[0] - 1.0).abs() < 0.015, "{ratio:?}");
    assert!((ratio[1] - 1.0).abs() < 0.015, "{ratio:?}");
    assert!((0.95..0.98).contains(&ratio[2]), "{ratio:?}");
}

/// A room of lamps, wood and a glass egg agrees within 2 %.
#[test]
fn bidirectional_room() {
    let (Some(scenes), true) = (shared_scenes(), is_slow()) else { return };
    let shared = scenes.join("veach-bidir");
    let case = Case { scene: "scene-v4.pbrt", resolution: "128x128", spp: "256", arguments: &[] };
    let (image, error) = render(&case, &shared);
    check_means(means(&image, CLAMP), means(&reference(&shared, &image), CLAMP), 0.02, error);
}

/// The four plates: the median over blocks of 8 x 8 pixels of the relative difference is at most 5 %.
#[test]
fn plates_of_four_roughnesses() {
    let (Some(scenes), true) = (shared_scenes(), is_slow()) else { return };
    let shared = scenes.join("veach-mis");
    let case = Case { scene: "scene-v4.pbrt", resolution: "320x180", spp: "64", arguments: &[] };
    let (image, _) = render(&case, &shared);
    let theirs = reference(&shared, &image);
    let mut differences: Vec<f32> = Vec::new();
    let (a, b) = (image.rgb_pixels().expect("colour"), theirs.rgb_pixels().expect("colour"));
    for block_y in 0..image.height / 8 {
        for block_x in 0..image.width / 8 {
            let mean = |pixels: &[[f32; 3]], c: usize| {
                let at = |i: usize| {
                    pixels[(block_y * 8 + i / 8) * image.width + block_x * 8 + i % 8][c].min(CLAMP)
                };
                (0..64).map(at).sum::<f32>() / 64.0
            };
            differences.extend((0..3).map(|c| (mean(&a, c) - mean(&b, c)).abs() / mean(&b, c).max(1e-6)));
        }
    }
    differences.sort_by(f32::total_cmp);
    let median = differences[differences.len() / 2];
    assert!(median <= 0.05, "median difference {median}");
}
