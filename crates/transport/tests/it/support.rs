//! Scenes from texts, their renders, and statistical comparisons.

use std::ops::Range;
use std::path::Path;

use etendue_image::Image;
use etendue_io::{load_assets, read_pbrt_str};
use etendue_math::hash64;
use etendue_math::statistics::{Moments, mean_test, means_agree, sidak};
use etendue_scene::{Diagnostics, Film, Scene};
use etendue_transport::lpe::PathExpressions;
use etendue_transport::{Stop, Unobserved, method, render};

/// Comparisons that all tests together may make, each of which may fail by chance.
const MOST_COMPARISONS: usize = 2000;

/// The significance of one comparison, such that a sound renderer passes the whole suite in 999 of 1000 sets of seeds.
pub(crate) fn significance() -> f64 {
    sidak(1e-3, MOST_COMPARISONS)
}

/// Standard errors that a deviation must exceed at [`significance`].
pub(crate) const Z: f64 = 5.0;

/// A scene as text, by part. The default is empty space seen by a pinhole camera at the origin that looks along +z, through
/// a box filter, by independent samples.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Setup<'t> {
    /// Pixels across and down.
    pub(crate) size: [u32; 2],
    /// The film's name in quotes, with its parameters but for the size.
    pub(crate) film: &'t str,
    /// The sampler's name in quotes, with its parameters.
    pub(crate) sampler: &'t str,
    /// The filter's name in quotes, with its parameters.
    pub(crate) filter: &'t str,
    /// Parameters of the path tracer.
    pub(crate) integrator: &'t str,
    /// Transform and camera.
    pub(crate) camera: &'t str,
    /// All that follows `WorldBegin`.
    pub(crate) world: &'t str,
}

impl Default for Setup<'_> {
    fn default() -> Self {
        Self {
            size: [8, 8],
            film: "\"rgb\"",
            sampler: "\"independent\"",
            filter: "\"box\"",
            integrator: "",
            camera: "Camera \"perspective\" \"float fov\" 60",
            world: "",
        }
    }
}

impl Setup<'_> {
    fn text(&self) -> String {
        let Self { size: [width, height], film, sampler, filter, integrator, camera, world } = self;
        format!(
            "Film {film} \"integer xresolution\" {width} \"integer yresolution\" {height}
            Sampler {sampler}
            PixelFilter {filter}
            Integrator \"path\" {integrator}
            {camera}
            WorldBegin
            {world}"
        )
    }

    /// The scene, with the hash of `name` as its seed.
    #[track_caller]
    pub(crate) fn scene(&self, name: &str) -> Scene {
        let (document, problems) = read_pbrt_str(name, &self.text(), Path::new(""));
        refuse_errors(&problems);
        let (assets, problems) = load_assets(&document);
        refuse_errors(&problems);
        let (scene, problems) = Scene::build(&document, assets);
        refuse_errors(&problems);
        let mut scene = scene.expect("a scene without errors");
        scene.sampler.seed = seed(name);
        scene
    }

    /// The film after so many samples for each pixel.
    #[track_caller]
    pub(crate) fn film(&self, name: &str, n_passes: u64) -> Film {
        render_passes(&self.scene(name), 0..n_passes)
    }
}

#[track_caller]
fn refuse_errors(problems: &Diagnostics) {
    let errors: Vec<&str> = problems.list().iter().map(|d| d.message.as_str()).collect();
    let known = ["the scene has no lights; the image will be black"];
    assert!(errors.iter().all(|e| known.contains(e)), "{errors:?}");
}

/// A seed for each name.
pub(crate) fn seed(name: &str) -> u64 {
    hash64(&name.bytes().map(u64::from).collect::<Vec<_>>())
}

/// Renders these passes.
#[track_caller]
pub(crate) fn render_passes(scene: &Scene, passes: Range<u64>) -> Film {
    render_layers(scene, passes, &[])
}

/// Renders these passes with named path expressions.
#[track_caller]
pub(crate) fn render_layers(scene: &Scene, passes: Range<u64>, layers: &[(&str, &str)]) -> Film {
    let named: Vec<(String, String)> =
        layers.iter().map(|(n, e)| ((*n).to_owned(), (*e).to_owned())).collect();
    let expressions = PathExpressions::new(&named).expect("good expressions");
    let mut film = Film::new(scene.film.clone(), expressions.names().to_vec());
    let (integrator, problems) = method(&scene.integrator, expressions);
    refuse_errors(&problems);
    let stop = Stop { passes, error: None };
    render(scene, integrator.expect("the path tracer").as_mut(), &mut film, &stop, &Unobserved);
    assert_eq!(film.sums().faults.invalid, 0, "NaN, infinite or negative radiance");
    film
}

/// Luminance of each pixel.
pub(crate) fn luminance(film: &Film) -> Vec<f64> {
    layer_luminance(film, &film.develop(), "")
}

/// Mean of these values.
pub(crate) fn mean(values: &[f64]) -> f64 {
    values.iter().sum::<f64>() / values.len() as f64
}

/// Luminance of each pixel of a layer.
pub(crate) fn layer(film: &Film, name: &str) -> Vec<f64> {
    layer_luminance(film, &film.develop(), &format!("{name}."))
}

fn layer_luminance(film: &Film, image: &Image, prefix: &str) -> Vec<f64> {
    let weights = film.settings().luminance_weights();
    let channels = ["R", "G", "B"].map(|c| channel(image, &format!("{prefix}{c}")));
    let n = channels[0].len();
    (0..n).map(|i| (0..3).map(|c| f64::from(weights[c]) * channels[c][i]).sum()).collect()
}

/// Values of a channel.
#[track_caller]
pub(crate) fn channel(image: &Image, name: &str) -> Vec<f64> {
    let channel = image.channels.iter().find(|c| c.name == name);
    let channel = channel.unwrap_or_else(|| panic!("no channel {name}"));
    channel.values.iter().map(|v| f64::from(*v)).collect()
}

/// Moments over the pixels of luminance. Pixels are independent of each other whatever the sampler.
pub(crate) fn pixel_moments(film: &Film) -> Moments {
    luminance(film).into_iter().collect()
}

/// Means of `n` by `n` blocks of an image.
pub(crate) fn block_means(values: &[f64], width: usize, n: usize) -> Vec<f64> {
    let height = values.len() / width;
    let mut sums = vec![Moments::new(); n * n];
    for (index, value) in values.iter().enumerate() {
        let (x, y) = (index % width, index / width);
        sums[(y * n / height) * n + x * n / width].push(*value);
    }
    sums.iter().map(Moments::mean).collect()
}

/// Moments over passes, which must be independent, of the means of `n` by `n` blocks and, last, of the whole image.
#[track_caller]
pub(crate) fn block_moments(scene: &Scene, n_passes: u64, n: usize) -> Vec<Moments> {
    let width = scene.film.resolution[0] as usize;
    let mut blocks = vec![Moments::new(); n * n + 1];
    for pass in 0..n_passes {
        let values = luminance(&render_passes(scene, pass..pass + 1));
        let mut means = block_means(&values, width, n);
        means.push(values.iter().sum::<f64>() / values.len() as f64);
        for (moments, mean) in blocks.iter_mut().zip(means) {
            moments.push(mean);
        }
    }
    blocks
}

/// Demands that the numbers have this expectation, and that a relative error of `resolution` would show.
#[track_caller]
pub(crate) fn expect_mean(what: &str, moments: &Moments, expected: f64, resolution: f64) {
    if let Err(message) = mean_test(moments, expected, significance()) {
        panic!("{what}: {message}");
    }
    let visible = Z * moments.standard_error();
    assert!(
        visible <= resolution * expected.abs(),
        "{what}: an error of {visible} of {expected} would not show"
    );
}

/// Demands that two sets of numbers have the same expectation, and that a relative difference of `resolution` would show.
#[track_caller]
pub(crate) fn expect_agreement(what: &str, a: &Moments, b: &Moments, resolution: f64) {
    if let Err(message) = means_agree(a, b, significance()) {
        panic!("{what}: {message}");
    }
    let visible = Z * a.standard_error().hypot(b.standard_error());
    let mean = 0.5 * (a.mean() + b.mean());
    assert!(visible <= resolution * mean.abs(), "{what}: a difference of {visible} of {mean} would not show");
}

/// Demands agreement in every block and in the whole image, where a difference of `resolution` must show.
#[track_caller]
pub(crate) fn expect_same_image(what: &str, a: &[Moments], b: &[Moments], resolution: f64) {
    let (whole, blocks) = (a.len() - 1, a.len() - 1);
    for block in 0..blocks {
        if a[block].mean() == 0.0 && b[block].mean() == 0.0 {
            continue;
        }
        expect_agreement(&format!("{what}, block {block}"), &a[block], &b[block], f64::INFINITY);
    }
    expect_agreement(what, &a[whole], &b[whole], resolution);
}

/// Demands that two numbers differ by at most a share of the second.
#[track_caller]
pub(crate) fn expect_near(what: &str, actual: f64, expected: f64, tolerance: f64) {
    let difference = (actual - expected).abs();
    assert!(difference <= tolerance * expected.abs(), "{what}: {actual} instead of {expected}");
}

/// Demands that two images agree in every pixel up to rounding: a share of the larger value, or of 1 where both are
/// small.
#[track_caller]
pub(crate) fn expect_equal_pixels(what: &str, a: &[f64], b: &[f64], tolerance: f64) {
    assert_eq!(a.len(), b.len());
    for (index, (a, b)) in a.iter().zip(b).enumerate() {
        let scale = a.abs().max(b.abs()).max(1e-3);
        assert!(
            (a - b).abs() <= tolerance * scale,
            "{what}: pixel {index} is {a} in one and {b} in the other"
        );
    }
}

/// True if studies that need minutes shall run; else notes that `name` is left out.
pub(crate) fn runs_slow(name: &str) -> bool {
    let runs = std::env::var_os("ETENDUE_SLOW").is_some_and(|v| v == "1");
    if !runs {
        #[expect(clippy::print_stderr, reason = "a note for whoever runs the tests")]
        {
            eprintln!("{name} runs with ETENDUE_SLOW=1 only");
        }
    }
    runs
}

/// A spectrum parameter of that value at all wavelengths.
pub(crate) fn flat(name: &str, value: f64) -> String {
    format!("\"spectrum {name}\" [360 {value} 830 {value}]")
}

/// The emission of a light: the spectrum parameter of that name, flat, at that luminance, intensity or illuminance.
pub(crate) fn lit(name: &str, value: f64) -> String {
    format!("{} \"float scale\" {value}", flat(name, 1.0))
}

/// A test of the tests: an expectation that is off by five hundredths is refused, as is one that is too noisy to judge.
#[test]
fn comparisons_can_fail() {
    let numbers: Moments = (0..1000).map(|i| 1.0 + 0.1 * f64::from(i % 7 - 3)).collect();
    assert!(mean_test(&numbers, numbers.mean(), significance()).is_ok());
    assert!(mean_test(&numbers, 1.05 * numbers.mean(), significance()).is_err());
    let tail = etendue_math::statistics::normal_cdf(-Z);
    assert!(
        2.0 * tail < 1.5 * significance() && 2.0 * tail > 0.5 * significance(),
        "Z fits the significance"
    );
    let noisy = std::panic::catch_unwind(|| expect_mean("noise", &numbers, numbers.mean(), 1e-4));
    assert!(noisy.is_err());
    let apart = std::panic::catch_unwind(|| expect_equal_pixels("apart", &[1.0], &[1.05], 1e-2));
    assert!(apart.is_err());
}
