use std::sync::OnceLock;

use roxmltree::Document;

use crate::convergence::{ErrorCurve, Experiment};
use crate::estimator::LightChoice;
use crate::{
    Convergence, ConvergenceSettings, Estimator, PixelSettings, PixelStudy, SamplerChoice, StudyScene,
    convergence, pixel,
};

fn is_slow() -> bool {
    std::env::var_os("ETENDUE_SLOW").is_some_and(|value| value == "1")
}

/// A small study of the soft shadow; the slow tests have a larger one.
fn small_settings() -> ConvergenceSettings {
    let (resolution, max_samples, n_scrambles) =
        if is_slow() { ([24, 18], 256, 16) } else { ([12, 9], 64, 16) };
    let experiments = vec![Experiment::soft_shadow(resolution, max_samples)];
    ConvergenceSettings {
        experiments,
        n_scrambles,
        n_reference_scrambles: 16,
        reference_samples: 1024,
        seed: 7,
    }
}

fn small_study() -> &'static Convergence {
    static STUDY: OnceLock<Convergence> = OnceLock::new();
    STUDY.get_or_init(|| convergence(&small_settings(), &mut |_| ()))
}

fn curve(name: &str) -> &'static ErrorCurve {
    let curves = &small_study().panels[0].curves;
    curves.iter().find(|c| c.estimator == name).expect("the study has this curve")
}

fn slope(name: &str) -> f64 {
    curve(name).law().expect("a fit").slope
}

/// The error of independent samples falls as 1 / sqrt(N), well sampled or badly (SPEC MC-4).
#[test]
fn independent_samples_have_slope_one_half() {
    for name in ["independent", "independent without light sampling"] {
        let (slope, error) = (slope(name), curve(name).slope_error());
        assert!((slope + 0.5).abs() < 0.05, "{name}: slope {slope} ± {error}");
        assert!(error < 0.02, "{name}: slope {slope} ± {error}");
    }
}

/// Samples that keep apart from each other converge faster than independent ones (SPEC EXP-1).
#[test]
fn even_samples_are_steeper() {
    for name in ["stratified", "Halton", "Sobol"] {
        let (slope, error) = (slope(name), curve(name).slope_error());
        assert!(slope + 4.0 * error < -0.57, "{name}: slope {slope} ± {error}");
        let [[_, even], [_, independent]] =
            [name, "independent"].map(|name| *curve(name).points().last().expect("points"));
        assert!(even < 0.75 * independent, "{name}: error {even} against {independent}");
    }
}

/// Importance sampling shifts the line down as a whole (SPEC EXP-1).
#[test]
fn light_sampling_shifts_the_error() {
    let by_chance = curve("independent without light sampling").points();
    for ([n, sampled], [_, chance]) in curve("independent").points().iter().zip(by_chance) {
        assert!(2.0 * sampled < chance, "{n} samples: {sampled} against {chance}");
    }
}

/// Ten times as many paths have an error smaller by the root of ten (SPEC EXP-2).
#[test]
fn tenfold_paths_gain_the_root_of_ten() {
    let (resolution, max, n_scrambles) = if is_slow() { ([16, 16], 1000, 16) } else { ([8, 8], 100, 16) };
    let mut experiment = Experiment::standard_box(resolution, 1, max);
    experiment.estimators.truncate(1);
    experiment.estimators[0].1.retain(|n| *n >= 10);
    let settings = ConvergenceSettings {
        experiments: vec![experiment],
        n_scrambles,
        n_reference_scrambles: 16,
        reference_samples: 1024,
        seed: 2,
    };
    let study = convergence(&settings, &mut |_| ());
    let points = study.panels[0].curves[0].points();
    for pair in points.windows(2) {
        let ratio = pair[0][1] / pair[1][1];
        // Rare bright paths make the error itself noisy: 16 scrambles know it to some ten per cent.
        assert!((ratio / 10.0_f64.sqrt() - 1.0).abs() < 0.3, "{points:?}");
    }
    assert_eq!(points.len(), if is_slow() { 3 } else { 2 });
}

/// A study depends on its seed alone, not on the number of threads.
#[test]
fn studies_are_deterministic() {
    let estimator = Estimator { sampler: SamplerChoice::Halton, lights: LightChoice::Lights };
    let scene = StudyScene::soft_shadow().with_resolution([6, 4]);
    let study = |seed: u64, n_threads: usize| {
        let experiment = Experiment { scene: scene.clone(), estimators: vec![(estimator, vec![1, 2, 4, 8])] };
        let settings = ConvergenceSettings {
            experiments: vec![experiment],
            n_scrambles: 3,
            n_reference_scrambles: 2,
            reference_samples: 64,
            seed,
        };
        let pool = rayon::ThreadPoolBuilder::new().num_threads(n_threads).build().expect("threads start");
        pool.install(|| convergence(&settings, &mut |_| ())).csv()
    };
    assert_eq!(study(1, 1), study(1, 3));
    assert_ne!(study(1, 1), study(2, 1));
}

/// The progress names each estimator once, after the reference.
#[test]
fn progress_names_the_estimators() {
    let scene = StudyScene::soft_shadow().with_resolution([2, 2]);
    let estimators = SamplerChoice::ALL.map(|s| (Estimator::of_sampler(s), vec![1])).into();
    let settings = ConvergenceSettings {
        experiments: vec![Experiment { scene, estimators }],
        n_scrambles: 2,
        n_reference_scrambles: 2,
        reference_samples: 1,
        seed: 0,
    };
    let mut steps = Vec::new();
    let _ = convergence(&settings, &mut |step| steps.push(step.to_owned()));
    let names = ["reference", "independent", "stratified", "Halton", "Sobol"];
    assert_eq!(steps, names.map(|name| format!("soft shadow: {name}")));
}

/// Every row of a table has the columns of its header, and numbers where they belong.
#[track_caller]
fn check_csv(csv: &str, n_text_columns: usize, n_rows: usize) {
    let mut lines = csv.lines();
    let n_columns = lines.next().expect("a header").split(',').count();
    let rows: Vec<Vec<&str>> = lines.map(|line| line.split(',').collect()).collect();
    assert_eq!(rows.len(), n_rows);
    for row in rows {
        assert_eq!(row.len(), n_columns, "{row:?}");
        for cell in &row[n_text_columns..] {
            assert!(cell.parse::<f64>().is_ok_and(f64::is_finite), "{row:?}");
        }
    }
}

/// A figure is well-formed XML with these texts, a curve for each series and a dot for each measurement.
#[track_caller]
fn check_svg(svg: &str, texts: &[&str], n_curves: usize, n_dots: usize) {
    let document = Document::parse(svg).expect("well-formed");
    assert_eq!(document.root_element().tag_name().name(), "svg");
    let count = |tag: &str| {
        document.descendants().filter(|node| node.has_tag_name(("http://www.w3.org/2000/svg", tag))).count()
    };
    assert!(count("polyline") >= n_curves, "{} curves", count("polyline"));
    assert_eq!(count("circle"), n_dots);
    let all: String = document.descendants().filter_map(|node| node.text()).collect();
    for text in texts {
        assert!(all.contains(text), "no \"{text}\"");
    }
    for name in ["NaN", "inf"] {
        assert!(!svg.contains(name), "a coordinate is {name}");
    }
}

/// The result of the convergence study is complete as a table and as a figure.
#[test]
fn convergence_is_tabled_and_drawn() {
    let study = small_study();
    let n_counts = curve("Sobol").counts.len();
    check_csv(&study.csv(), 2, 5 * n_counts);
    let texts = ["soft shadow: error against samples", "samples per pixel", "Sobol: slope −0."];
    check_svg(&study.svg(), &texts, 5, 5 * n_counts);
    assert_eq!(study.summary().lines().count(), 6);
}

fn small_pixel_study() -> &'static PixelStudy {
    static STUDY: OnceLock<PixelStudy> = OnceLock::new();
    STUDY.get_or_init(|| pixel(&PixelSettings { n_estimators: 200, n_samples: 64, ..PixelSettings::full(3) }))
}

/// The spread of estimators that do not know of each other falls as 1 / sqrt(N) (SPEC EXP-3, MC-4).
#[test]
fn estimators_of_a_pixel_close_in() {
    let study = small_pixel_study();
    let at = |n: u32| study.spread(study.counts.iter().position(|count| *count == n).expect("counted"));
    // A standard deviation from 200 values of a heavy tail is uncertain by some ten per cent.
    let ratio = at(1).deviation / at(64).deviation;
    assert!((ratio / 8.0 - 1.0).abs() < 0.4, "the deviation falls by {ratio}");
    assert!(at(64).min > at(4).min && at(64).max < at(4).max);
    let shown = &study.running_means[study.shown()];
    for (index, value) in shown.iter().enumerate() {
        let spread = study.spread(index);
        assert!((spread.min..=spread.max).contains(value));
        assert!((spread.min..=spread.max).contains(&spread.mean));
    }
}

/// A running mean is what a render of that many samples gives.
#[test]
fn running_mean_is_the_render() {
    let study = small_pixel_study();
    let scene = PixelSettings::full(3).scene;
    let mean = |counts: &[u32]| {
        let images = Estimator::of_sampler(SamplerChoice::Independent).images(
            &scene.clone().with_resolution([4, 4]),
            9,
            counts,
        );
        images.last().and_then(etendue_image::Image::rgb_pixels)
    };
    assert_eq!(mean(&[1, 2, 5]), mean(&[5]));
    assert_eq!(study.counts[..4], [1, 2, 3, 4]);
    assert_eq!(study.counts.last(), Some(&64));
}

/// The result of the pixel study is complete as a table and as a figure.
#[test]
fn pixel_is_tabled_and_drawn() {
    let study = small_pixel_study();
    check_csv(&study.csv(), 0, study.counts.len());
    check_svg(&study.svg(), &["200 estimators", "running mean", "one estimator", "1 ± σ/√N"], 3, 0);
    assert_eq!(study.summary().lines().count(), 2);
}
