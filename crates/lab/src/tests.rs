use std::cell::Cell;
use std::sync::OnceLock;
use std::time::Duration;

use roxmltree::Document;

use crate::convergence::{ErrorCurve, Experiment};
use crate::estimator::LightChoice;
use crate::light_size::{Room, SizeCurve, SizePoint, WAYS};
use crate::neighbours::{Distribution, Making, Measurement};
use crate::plot::{Axes, Mark, Panel, Series, draw};
use crate::scene_size::{KINDS, Laws, RayCost};
use crate::{
    Convergence, ConvergenceSettings, Estimator, LightSize, LightSizeSettings, NeighbourSettings,
    PixelSettings, PixelStudy, ReferenceSettings, SamplerChoice, SceneSize, SceneSizeSettings, StudyScene,
    convergence, light_size, neighbours, pixel, scene_size,
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
        reference: ReferenceSettings { n_scrambles: 16, n_samples: 1024 },
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
        reference: ReferenceSettings { n_scrambles: 16, n_samples: 1024 },
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
            reference: ReferenceSettings { n_scrambles: 2, n_samples: 64 },
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
        reference: ReferenceSettings { n_scrambles: 2, n_samples: 1 },
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

/// A small study of the size of scenes, by a clock that advances by a millisecond each time it is asked.
fn small_scene_size() -> &'static SceneSize {
    static STUDY: OnceLock<SceneSize> = OnceLock::new();
    STUDY.get_or_init(|| {
        let settings = SceneSizeSettings {
            terrains: vec![8, 16, 32, 64, 128],
            fractals: vec![0, 1],
            resolution: [64, 48],
            n_rounds: 2,
        };
        let now = Cell::new(Duration::ZERO);
        let clock = || {
            now.set(now.get() + Duration::from_millis(1));
            now.get()
        };
        scene_size(&settings, &clock, &mut |_| ())
    })
}

/// The steps of a ray grow by as much each time a mesh is refined, not by a factor (SPEC EXP-14, ACC-6): a line in log N.
/// Nodes have eight children, so that twice as many triangles take at least a third of a step.
#[test]
fn steps_of_rays_grow_as_the_logarithm() {
    let study = small_scene_size();
    for (index, kind) in KINDS.iter().enumerate() {
        let Laws { line, power } = study.ray_law("terrain", index, &RayCost::steps).expect("five terrains");
        assert!(line.explained > 0.98, "{}: {line:?}", kind.name());
        assert!((1.0 / 3.0..1.0).contains(&line.slope), "{}: {line:?}", kind.name());
        assert!(power.slope < 0.25, "{}: {power:?}", kind.name());
    }
    // With 20 times as many triangles in the same copies, a ray enters about as many of them.
    let copies: Vec<f64> = study.family("fractal").map(|model| model.rays[0].instances).collect();
    assert!(copies[0] > 0.5 && (copies[1] / copies[0] - 1.0).abs() < 0.1, "{copies:?}");
}

/// Times are those of the clock that the caller brings.
#[test]
fn times_come_from_the_clock() {
    let model = &small_scene_size().models[0];
    assert_eq!(model.build_s, 1e-3);
    assert_eq!(model.rays[0].time_s, 1e-3 / (64.0 * 48.0));
    assert_eq!(model.build_ns_per_primitive(), 1e6 / 128.0);
}

/// The result of the study of the size of scenes is complete as a table and as a figure.
#[test]
fn scene_size_is_tabled_and_drawn() {
    let study = small_scene_size();
    check_csv(&study.csv(), 2, 7 * 3);
    let texts = ["steps of a ray", "building", "fractal: shadow", "10000"];
    check_svg(&study.svg(), &texts, 14, 2 * 3 * 7 + 7);
    assert_eq!(study.summary().lines().count(), 1 + 2 * 7);
}

fn small_light_size() -> &'static LightSize {
    static STUDY: OnceLock<LightSize> = OnceLock::new();
    STUDY.get_or_init(|| {
        let settings = LightSizeSettings {
            sides: vec![0.0625, 0.25, 1.0],
            resolution: [12, 12],
            reference: ReferenceSettings { n_scrambles: 4, n_samples: 512 },
            ..LightSizeSettings::quick(5)
        };
        light_size(&settings, &mut |_| ())
    })
}

fn points(room: Room, way: LightChoice) -> &'static [SizePoint] {
    &small_light_size().curve(room, way).expect("the study has this curve").points
}

/// Whoever runs into lamps by chance has an error as 1 / side; whoever samples them finds small ones as well as large
/// ones (SPEC EXP-16).
#[test]
fn sampling_finds_lamps_of_any_size() {
    let [lights, scattering] =
        [LightChoice::Lights, LightChoice::Scattering].map(|way| points(Room::Matte, way));
    for pair in lights.windows(2) {
        assert!((pair[0].error / pair[1].error - 1.0).abs() < 0.25, "{lights:?}");
    }
    for pair in scattering.windows(2) {
        let uncertainty = pair[0].uncertainty / pair[0].error + pair[1].uncertainty / pair[1].error;
        let ratio = pair[0].error / pair[1].error;
        // The law holds for lamps that are small as seen from everywhere; a lamp that fills the ceiling covers less of
        // the hemisphere than its area promises.
        assert!((ratio / 4.0).ln().abs() < 0.25 + 4.0 * uncertainty, "{ratio}: {scattering:?}");
    }
    for (sampled, found) in lights.iter().zip(scattering) {
        assert!(found.error > 2.0 * sampled.error, "{sampled:?} {found:?}");
    }
}

/// On polished metal chance is better where the lamp is large, and both together are as good as the better one.
#[test]
fn both_ways_are_as_good_as_the_better() {
    let [both, lights, scattering] = WAYS.map(|way| points(Room::Metal, way));
    assert!(lights[0].error < scattering[0].error && scattering[2].error < lights[2].error);
    for ((both, lights), scattering) in both.iter().zip(lights).zip(scattering) {
        let better = lights.error.min(scattering.error);
        assert!(both.error < better + 3.0 * (both.uncertainty + lights.uncertainty), "{both:?}");
    }
    let study = small_light_size();
    let crossing = study.crossing(Room::Metal, &|point| point.error).expect("they cross");
    // Chance has more samples for its rays.
    let at_rays = study.crossing(Room::Metal, &|point| point.error_at_equal_rays(64)).expect("they cross");
    assert!(0.0625 < at_rays && at_rays < crossing && crossing < 1.0, "{at_rays} {crossing}");
}

/// Whoever samples no lamp sends no shadow rays.
#[test]
fn shadow_rays_are_for_sampled_lamps() {
    for room in Room::ALL {
        assert!(points(room, LightChoice::Scattering).iter().all(|point| point.shadow_rays == 0.0));
        for way in [LightChoice::Both, LightChoice::Lights] {
            let is_right = |point: &SizePoint| point.shadow_rays > 0.5 && point.shadow_rays <= point.rays;
            assert!(points(room, way).iter().all(is_right), "{:?}", points(room, way));
        }
    }
}

/// Curves cross where a line between their points does, and only if the one that loses for small lamps wins for large ones.
#[test]
fn crossings_are_found() {
    let curve = |way, errors: [f64; 3]| {
        let points = std::iter::zip([0.25, 0.5, 1.0], errors)
            .map(|(side, error)| SizePoint { side, error, uncertainty: 0.0, rays: 2.0, shadow_rays: 2.0 })
            .collect();
        SizeCurve { room: Room::Matte, way, points }
    };
    let crossing = |scattering: [f64; 3]| {
        let curves = vec![curve(LightChoice::Lights, [1.0; 3]), curve(LightChoice::Scattering, scattering)];
        LightSize { n_samples: 64, curves }.crossing(Room::Matte, &|point| point.error)
    };
    let side = crossing([4.0, 2.0, 0.5]).expect("they cross");
    assert!((side - 0.5_f64.sqrt()).abs() < 1e-12, "{side}");
    assert_eq!(crossing([4.0, 2.0, 1.5]), None);
    assert_eq!(crossing([0.4, 0.2, 0.1]), None);
    // 64 samples of four rays are half of 512.
    let point = SizePoint { side: 1.0, error: 1.0, uncertainty: 0.0, rays: 2.0, shadow_rays: 2.0 };
    assert_eq!(point.error_at_equal_rays(64), 0.5_f64.sqrt());
}

/// The result of the study of lamps is complete as a table and as a figure.
#[test]
fn light_size_is_tabled_and_drawn() {
    let study = small_light_size();
    check_csv(&study.csv(), 2, 2 * 3 * 3);
    let texts =
        ["metal room at 64 samples per pixel", "at 512 rays per pixel", "side of the lamp", "scattering"];
    check_svg(&study.svg(), &texts, 2 * 6, 2 * 18);
    assert_eq!(study.summary().lines().count(), 4);
}

/// Labels of an axis over many decades are powers of ten, which do not run into each other.
#[test]
fn axes_over_many_decades_have_powers_of_ten() {
    let panel = |end: f64| {
        let series = vec![Series {
            name: String::new(),
            points: vec![[1.0, 1.0], [end, 2.0]],
            mark: Mark::LineAndDots,
        }];
        draw(&[Panel { axes: Axes::SemiLogarithmic, series, ..Panel::default() }])
    };
    check_svg(&panel(1e3), &["100", "200"], 1, 2);
    check_svg(&panel(1e6), &["10⁰", "10³", "10⁶"], 1, 2);
}

/// All structures find as many photons, the clock is the caller's, and the result is complete as a table and as a figure
/// (SPEC EXP-13). Photons that come cell after cell make a tree that is not balanced deeper (SPEC KD-12).
#[test]
fn structures_of_photons_are_compared() {
    let settings = NeighbourSettings {
        sizes: vec![300, 2000],
        ks: vec![1, 50, 120],
        n_questions: 40,
        n_rounds: 1,
        longest_list: 300,
        seed: 1,
    };
    let ticks = Cell::new(0);
    let clock = || {
        ticks.set(ticks.get() + 1);
        Duration::from_millis(ticks.get())
    };
    let study = neighbours(&settings, &clock, &mut |_| ());
    // Three scenes; five structures with 2 questions of 300 photons, four with 4 of 2000.
    assert_eq!((study.makings.len(), study.measurements.len()), (3 * 9, 3 * (5 * 2 + 4 * 4)));
    for m in &study.measurements {
        let same = |other: &&Measurement| {
            (other.distribution, other.n_points, other.k) == (m.distribution, m.n_points, m.k)
        };
        assert!(study.measurements.iter().filter(same).all(|other| other.n_found == m.n_found), "{m:?}");
        assert!(m.k.is_none_or(|k| m.n_found == k as f64), "{m:?}");
        assert_eq!(m.time_s, 1e-3 / 40.0);
    }
    let depth = |d: Distribution| {
        let of = |m: &&Making| m.distribution == d && m.n_points == 2000 && m.depth.is_some();
        study.makings.iter().find(of).and_then(|m| m.depth).expect("it is a tree")
    };
    assert!(depth(Distribution::Cells) > depth(Distribution::Room), "{:?}", study.makings);
    assert_eq!(study.csv().lines().count(), 1 + 3 * 9 + 3 * 26);
    assert_eq!(study.summary().lines().count(), 2 + 3 * 4);
    assert!(study.svg().contains("room in cells: among 2000 photons"));
}
