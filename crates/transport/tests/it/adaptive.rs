//! Interpolated pixels (CAM-6) against all pixels.

use std::sync::atomic::{AtomicU64, Ordering};

use etendue_math::statistics::Moments;
use etendue_scene::document::{Entity, Value};
use etendue_scene::{Film, Scene};
use etendue_transport::lpe::PathExpressions;
use etendue_transport::{Flow, Integrator, Observer, RayCounts, Stop, method, render};

use crate::support::{Setup, channel, lit, luminance, render_passes, seed};

/// A floor and a ball under a large lamp.
fn ball(name: &str, size: [u32; 2], integrator: Entity) -> Scene {
    let world = format!(
        "Material \"diffuse\" \"rgb reflectance\" [0.5 0.5 0.5]
        Shape \"bilinearmesh\" \"point3 P\" [-6 -1 -3  6 -1 -3  -6 -1 9  6 -1 9]
        AttributeBegin Translate 0 -0.3 3 Shape \"sphere\" \"float radius\" 0.7 AttributeEnd
        AttributeBegin AreaLightSource \"diffuse\" {} \"bool twosided\" true
        Shape \"bilinearmesh\" \"point3 P\" [-2 4 1  2 4 1  -2 4 5  2 4 5] AttributeEnd",
        lit("L", 3.0)
    );
    let setup = Setup { size, world: &world, ..Setup::default() };
    let mut scene = setup.scene(name);
    scene.integrator = integrator;
    scene
}

fn path() -> Entity {
    Entity::new("path").with("maxdepth", Value::Integers(vec![3]))
}

fn adaptive(integrator: Entity) -> Entity {
    integrator.with("pixels", Value::Strings(vec!["adaptive".to_owned()]))
}

/// Counts what a render costs.
#[derive(Debug, Default)]
struct Counter {
    samples: AtomicU64,
    rays: AtomicU64,
    interpolated: AtomicU64,
}

impl Observer for Counter {
    fn tile_done(&self, n_samples: u64, rays: RayCounts) -> Flow {
        self.samples.fetch_add(n_samples, Ordering::Relaxed);
        self.rays.fetch_add(rays.closest + rays.shadow, Ordering::Relaxed);
        self.interpolated.fetch_add(rays.interpolated, Ordering::Relaxed);
        Flow::Continue
    }

    fn pass_done(&self, _: u64, _: &Film, _: &dyn Integrator) -> Flow {
        Flow::Continue
    }
}

fn count(scene: &Scene, n_passes: u64) -> (Film, Counter) {
    let expressions = PathExpressions::new(&[]).expect("none");
    let mut film = Film::new(scene.film.clone(), Vec::new());
    let (integrator, _) = method(&scene.integrator, expressions);
    let counter = Counter::default();
    let stop = Stop { passes: 0..n_passes, error: None };
    render(scene, integrator.expect("a method").as_mut(), &mut film, &stop, &counter);
    (film, counter)
}

/// On a smooth scene half of the rays are spared, and the image is that of all rays: in the mean within a per cent, and in each
/// pixel within what thresholds allow, but for noise.
#[test]
fn rays_are_spared_at_a_bounded_error() {
    let size = [96, 96];
    for (name, integrator) in [("path", path()), ("ao", Entity::new("ao"))] {
        let n_passes = 256;
        let (all, all_counts) = count(&ball(name, size, integrator.clone()), n_passes);
        let (some, counts) = count(&ball(name, size, adaptive(integrator)), n_passes);
        let [rays, all_rays] =
            [&counts, &all_counts].map(|counts| counts.rays.load(Ordering::Relaxed) as f64);
        assert!(rays < 0.5 * all_rays, "{name}: {rays} of {all_rays}");
        let spared = counts.interpolated.load(Ordering::Relaxed) as f64
            / counts.samples.load(Ordering::Relaxed) as f64;
        assert!(spared > 0.5 && all_counts.interpolated.load(Ordering::Relaxed) == 0, "{spared}");
        let (a, b) = (luminance(&all), luminance(&some));
        let mean = |values: &[f64]| values.iter().sum::<f64>() / values.len() as f64;
        let bias = mean(&b) / mean(&a) - 1.0;
        assert!(bias.abs() < 0.02, "{name}: {bias}");
        // Noise of the pixels, and a part of the contrast of 0.3 in the worst.
        let variance = |film: &Film| channel(&film.develop(), "variance.Y");
        let noise: Vec<f64> =
            variance(&all).iter().zip(variance(&some)).map(|(a, b)| 5.0 * (a + b).sqrt()).collect();
        let n_far = (0..a.len()).filter(|&i| (a[i] - b[i]).abs() > 0.15 * a[i] + noise[i]).count();
        assert!(n_far < a.len() / 50, "{name}: {n_far} of {} pixels are far off", a.len());
    }
}

/// A threshold of 0 traces whatever differs at all: the mean is that of all pixels.
#[test]
fn threshold_zero_is_unbiased() {
    let exact = adaptive(Entity::new("ao")).with("contrast", Value::Floats(vec![0.0]));
    let n_passes = 200;
    let mean_of_passes = |scene: &Scene| -> Moments {
        (0..n_passes)
            .map(|pass| {
                let values = luminance(&render_passes(scene, pass..pass + 1));
                values.iter().sum::<f64>() / values.len() as f64
            })
            .collect()
    };
    let some = mean_of_passes(&ball("zero", [24, 24], exact));
    let all = mean_of_passes(&ball("zero of all", [24, 24], Entity::new("ao")));
    crate::support::expect_agreement("threshold 0", &some, &all, 0.5);
}

/// Threads and the split of passes change no bit.
#[test]
fn interpolation_is_deterministic() {
    let scene = ball("threads", [70, 40], adaptive(path()));
    let in_threads = |n: usize| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(n).build().expect("threads");
        pool.install(|| render_passes(&scene, 0..4))
    };
    let whole = in_threads(1);
    assert_eq!(whole.sums(), in_threads(3).sums());
    let mut parts = render_passes(&scene, 0..2);
    parts.sums_mut().merge(render_passes(&scene, 2..4).sums()).expect("parts of one render");
    assert_eq!(parts.sums(), whole.sums());
}

/// The variance of a pixel is that of what many renders give it: noise that pixels have in common is noise all the same.
#[test]
fn variance_is_that_of_the_pixels() {
    let mut scene = ball("variance", [8, 8], adaptive(path()));
    let n_renders = 400;
    let mut pixels = vec![Moments::new(); 64];
    let mut claimed = 0.0;
    for i in 0..n_renders {
        scene.sampler.seed = seed(&format!("variance {i}"));
        let film = render_passes(&scene, 0..4);
        claimed += channel(&film.develop(), "variance.Y").iter().sum::<f64>() / n_renders as f64;
        for (pixel, value) in pixels.iter_mut().zip(luminance(&film)) {
            pixel.push(value);
        }
    }
    let found: f64 = pixels.iter().map(Moments::variance).sum();
    // Renders are independent, pixels need not be: a relative error of sqrt(2 / 400) and five of these.
    assert!((claimed / found - 1.0).abs() < 0.36, "{claimed} but {found}");
}
