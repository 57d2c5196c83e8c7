//! The studies find what their documentation says, in small.

use super::*;

fn last(study: &CurveStudy, panel: usize, curve: &str) -> [f64; 2] {
    let series = study.panels[panel].series.iter().find(|series| series.name.starts_with(curve));
    *series.and_then(|series| series.points.last()).expect("the curve has points")
}

/// With k = sqrt(N) the error is `N^(-1/4)`, with a fixed k it stays.
#[test]
fn errors_fall_with_more_photons() {
    let study = consistency(&ConsistencySettings { counts: vec![1000, 30_000], n_estimates: 600, seed: 1 });
    assert!((last(&study, 0, "k = √N:")[1] / 30_000_f64.powf(-0.25) - 1.0).abs() < 0.2);
    assert!((last(&study, 0, "k = 50")[1] * 49_f64.sqrt() - 1.0).abs() < 0.2);
    assert!(study.csv().lines().count() == 1 + 2 * 6 && study.svg().contains("</svg>"));
}

/// Filters make edges narrower.
#[test]
fn filters_sharpen_edges() {
    let study = edge(&EdgeSettings { n_fields: 4, k: 100, seed: 1 });
    let width = |name: &str| -> f64 {
        let line = study.summary.lines().find(|line| line.starts_with(&format!("{name}:")));
        let numbers = line.and_then(|line| line.split(": ").nth(1)).expect("each filter has a line");
        numbers.split(',').next().and_then(|w| w.parse().ok()).expect("a width")
    };
    assert!(width("cone 1.1") < 0.85 * width("none"), "{}", study.summary);
    assert!(width("Gaussian") < 0.85 * width("none"), "{}", study.summary);
}

/// At a wall a disc sees half of the light, and its hull all.
#[test]
fn hulls_mend_walls() {
    let study = walls(&WallSettings { n_fields: 4, k: 100, seed: 1 });
    let at_wall = |panel: usize, name: &str| {
        let series = study.panels[panel].series.iter().find(|series| series.name == name);
        series.map(|series| series.points[0][1]).expect("the curve has points")
    };
    assert!((at_wall(0, "disc") - 0.5).abs() < 0.06);
    assert!((at_wall(0, "disc, hull") - 1.0).abs() < 0.1);
    assert!(at_wall(2, "sphere") > 1.1);
}

/// Few photons on many triangles: `exp(-n / n_triangles)` of them stay black, roughly; the estimate does not care.
#[test]
fn handles_are_black_in_histograms() {
    let settings = HandleSettings { n_triangles: vec![4096], counts: vec![1000], ..HandleSettings::quick(1) };
    let study = handle(&settings);
    assert!(last(&study, 0, "histogram")[1] > 0.7);
    assert!(last(&study, 1, "estimate")[1] < 0.3);
    assert!(last(&study, 1, "histogram")[1] > 1.0);
}

/// Both ways give the indirect light of path tracing.
#[test]
fn gathering_agrees_with_paths() {
    let settings = GatheringSettings {
        resolution: [8, 8],
        reference_samples: 128,
        n_places: 8,
        light_counts: vec![400],
        density_counts: vec![60_000],
        n_rays: 16,
        seed: 3,
    };
    let study = gathering(&settings, &mut |_| ());
    for line in study.summary.lines().skip(1) {
        let mean: f64 = line.rsplit(' ').next().and_then(|m| m.parse().ok()).expect("a mean");
        // Five times what one set of 400 photons differs from another by, a twentieth.
        assert!((mean - 1.0).abs() < 0.25, "{}", study.summary);
    }
}
