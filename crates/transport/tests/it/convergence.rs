//! How errors fall with the number of samples (SPEC MC-4, EXP-1, EXP-2, EXP-3).

use std::f64::consts::PI;

use etendue_math::statistics::{Moments, log_log_slope, normal_quantile};
use etendue_scene::Film;

use crate::radiometry::{DOWN, floor_means, strip_irradiance, strip_light_and_edge};
use crate::support::{
    Setup, Z, channel, expect_agreement, expect_mean, flat, lit, luminance, render_passes, runs_slow,
};

/// A soft shadow, known in every pixel.
fn soft_shadow(sampler: &str) -> (String, String) {
    let world = format!(
        "Material \"diffuse\" {} Shape \"bilinearmesh\" \"point3 P\" [-9 -9 0  9 -9 0  -9 9 0  9 9 0] {}",
        flat("reflectance", 1.0),
        strip_light_and_edge()
    );
    (world, format!("\"{sampler}\" \"integer pixelsamples\" 256"))
}

/// Squared errors of the pixels of that scene.
fn squared_errors(film: &Film) -> Moments {
    let expected = floor_means(film, |x, y| strip_irradiance(x, y) / PI);
    luminance(film).iter().zip(expected).map(|(v, e)| (v - e) * (v - e)).collect()
}

fn rmse_at(sampler: &str, counts: &[u64]) -> Vec<f64> {
    let (world, sampler_text) = soft_shadow(sampler);
    let setup = Setup {
        size: [24, 24],
        sampler: &sampler_text,
        integrator: "\"integer maxdepth\" 1",
        camera: DOWN,
        world: &world,
        ..Setup::default()
    };
    let scene = setup.scene(&format!("convergence by {sampler}"));
    counts.iter().map(|n| squared_errors(&render_passes(&scene, 0..*n)).mean().sqrt()).collect()
}

/// MC-4, EXP-1: independent samples have an error of N^(-1/2), Sobol points a smaller one that falls faster.
#[test]
fn error_falls_with_samples() {
    let counts = [1, 4, 16, 64, 256];
    let n: Vec<f64> = counts.iter().map(|n| *n as f64).collect();
    let independent = rmse_at("independent", &counts);
    let slope = log_log_slope(&n, &independent);
    assert!((slope + 0.5).abs() < 0.05, "independent samples: {slope}, {independent:?}");
    for sampler in ["sobol", "halton"] {
        let even = rmse_at(sampler, &counts);
        let slope = log_log_slope(&n, &even);
        assert!(slope < -0.55, "{sampler}: {slope}, {even:?}");
        assert!(even[4] < 0.7 * independent[4], "{sampler}: {even:?} and {independent:?}");
    }
}

/// A furnace with roulette, whose estimates scatter widely around 1 / (1 - a) = 2.
fn noisy_furnace(name: &str, size: [u32; 2]) -> etendue_scene::Scene {
    let world = format!(
        "Material \"diffuse\" {} AreaLightSource \"diffuse\" {} ReverseOrientation Shape \"sphere\"",
        flat("reflectance", 0.5),
        lit("L", 1.0)
    );
    let integrator = "\"integer maxdepth\" 100 \"integer roulettedepth\" 0";
    let camera = "LookAt 0.1 0.2 -0.3  0.4 -0.1 1  0 1 0 Camera \"perspective\"";
    Setup { size, integrator, camera, world: &world, ..Setup::default() }.scene(name)
}

/// EXP-2: with 10, 100 and 1000 paths per pixel the error falls by the root of ten each: N times the mean squared error
/// is the same number, the variance of one path.
#[test]
fn ten_times_the_paths() {
    let scene = noisy_furnace("paths", [16, 16]);
    let scaled = |n: u64| -> Moments {
        luminance(&render_passes(&scene, 0..n)).iter().map(|v| n as f64 * (v - 2.0) * (v - 2.0)).collect()
    };
    let (ten, hundred, thousand) = (scaled(10), scaled(100), scaled(1000));
    expect_agreement("10 and 100 paths", &ten, &hundred, 1.0);
    expect_agreement("100 and 1000 paths", &hundred, &thousand, 1.0);
}

/// EXP-3: the estimates of 1024 pixels that all see the same close in on it as samples are added: the band from least to
/// greatest halves with each four times as many.
#[test]
fn band_of_estimators_narrows() {
    let scene = noisy_furnace("band", [32, 32]);
    let band = |n: u64| {
        let values = luminance(&render_passes(&scene, 0..n));
        let (low, high) = values.iter().fold((f64::MAX, f64::MIN), |(l, h), v| (l.min(*v), h.max(*v)));
        assert!(low < 2.0 && 2.0 < high, "the truth lies within");
        high - low
    };
    let bands = [4, 16, 64, 256].map(band);
    for pair in bands.windows(2) {
        let ratio = pair[1] / pair[0];
        assert!((0.35..0.65).contains(&ratio), "{bands:?}");
    }
}

/// MC-4: the interval of 1.96 standard errors that the film's variance tells holds the truth in 95 % of pixels. Filters with
/// negative lobes raise the variance, and the film says so.
#[test]
fn intervals_cover_the_truth() {
    for filter in ["\"box\"", "\"gaussian\"", "\"mitchell\"", "\"sinc\""] {
        let mut scene = noisy_furnace(&format!("coverage {filter}"), [48, 48]);
        let (width, n_passes) = (normal_quantile(0.975), 200);
        let setup = Setup { filter, ..Setup::default() };
        scene.filter = setup.scene("filter").filter;
        let film = render_passes(&scene, 0..n_passes);
        let variance = channel(&film.develop(), "variance.Y");
        let covered: Moments = luminance(&film)
            .iter()
            .zip(&variance)
            .map(|(v, variance)| f64::from((v - 2.0).abs() <= width * variance.sqrt()))
            .collect();
        // Estimates of few paths are skewed: the coverage is a little below 95 %.
        let error = Z * covered.standard_error();
        assert!((covered.mean() - 0.945).abs() < 0.01 + error, "{filter}: {}", covered.mean());
        let variances: Moments = variance.into_iter().collect();
        let squared: Moments = luminance(&film).iter().map(|v| (v - 2.0) * (v - 2.0)).collect();
        expect_agreement(&format!("variance through {filter}"), &variances, &squared, 0.5);
    }
}

/// The stop rule: rendering to a relative error of 2 % gives an image that is about 2 % off.
#[test]
fn error_target_is_met() {
    let scene = noisy_furnace("target", [16, 16]);
    let (integrator, _) = etendue_transport::method(&scene.integrator, Default::default());
    let mut film = Film::new(scene.film.clone(), Vec::new());
    let stop = etendue_transport::Stop { passes: 0..100_000, error: Some(0.02) };
    let mut integrator = integrator.expect("the path tracer");
    let outcome = etendue_transport::render(
        &scene,
        integrator.as_mut(),
        &mut film,
        &stop,
        &etendue_transport::Unobserved,
    );
    assert_eq!(outcome, etendue_transport::Outcome::Converged);
    // The error is relative to the luminance plus a tenth of its mean.
    let relative: Moments = luminance(&film).iter().map(|v| ((v - 2.0) / 2.2).powi(2)).collect();
    expect_mean("mean squared relative error", &relative, 0.02 * 0.02, 1.0);
}

/// EXP-1, the whole study: errors to 4096 samples and the slopes of all samplers.
#[test]
fn error_falls_with_very_many_samples() {
    if !runs_slow("error_falls_with_very_many_samples") {
        return;
    }
    let counts = [1, 4, 16, 64, 256, 1024, 4096];
    let n: Vec<f64> = counts.iter().map(|n| *n as f64).collect();
    let slope = log_log_slope(&n, &rmse_at("independent", &counts));
    assert!((slope + 0.5).abs() < 0.02, "independent samples: {slope}");
    // Steeper than what counts as -1/2.
    for sampler in ["sobol", "halton"] {
        let slope = log_log_slope(&n, &rmse_at(sampler, &counts));
        assert!(slope < -0.55, "{sampler}: {slope}");
    }
}
