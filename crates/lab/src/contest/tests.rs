//! Contests find what their documentation says, in small. Clocks count calls: times are not tested.

use std::cell::Cell;

use super::*;
use crate::generate::Generator;

const TINY: ContestSettings =
    ContestSettings { width: 16, n_samples: 16, photons: 0.1, reference_samples: 64, n_runs: 2, seed: 1 };

/// A clock that goes on by a second each time it is asked.
fn ticking() -> impl Fn() -> Duration {
    let ticks = Cell::new(0);
    move || {
        ticks.set(ticks.get() + 1);
        Duration::from_secs(ticks.get())
    }
}

fn run(contests: &[Contest]) -> ContestStudy {
    contest(contests, &TINY, &ticking(), &mut |_| ())
}

fn find<'a>(study: &'a ContestStudy, contest: &str, way: &str) -> &'a Outcome {
    let mut found = study.outcomes.iter().filter(|o| o.contest.starts_with(contest) && o.way.name == way);
    found.next().expect("it is measured")
}

/// The same caustic in the mean by all ways; paths that hit a lamp by chance need the longer the smaller it is, photons do not care.
#[test]
fn photons_do_not_care_how_small_a_lamp_is() {
    // The focus is small: fewer pixels, or fewer samples, miss it.
    let settings = ContestSettings { width: 48, reference_samples: 16, ..TINY };
    let mut contests = caustic(&settings);
    contests.remove(1);
    let study = contest(&contests, &settings, &ticking(), &mut |_| ());
    for way in ["photons", "light tracing"] {
        let mean = find(&study, "lamp of radius 0.12", way).mean;
        assert!((mean - 1.0).abs() < 0.3, "{way}: {mean}");
    }
    let [large, small] =
        ["lamp of radius 0.12", "lamp of radius 0.01"].map(|lamp| find(&study, lamp, "photons").error);
    assert!(small < 3.0 * large, "{small} beside {large}");
    // What paths do not find is missing from the mean; what they find is far too bright.
    let path = find(&study, "lamp of radius 0.01", "path");
    assert!(path.mean < 0.6 || path.error > 3.0 * small, "{} {}", path.mean, path.error);
    assert!(study.csv().lines().count() == 7 && study.svg().matches("<image").count() == 6);
}

/// More photons err less, and shadows by rays less still; recursive ray tracing lacks the indirect light.
#[test]
fn rays_for_direct_light_save_photons() {
    let settings = ContestSettings { photons: 0.2, ..TINY };
    let study = contest(&seen_directly(&settings), &settings, &ticking(), &mut |_| ());
    let error = |way: &str| find(&study, "box", way).error;
    assert!(error("10000 photons, 100 nearest") < error("200 photons, 50 nearest"));
    assert!(error("10000 photons, 50 nearest, direct by rays") < error("10000 photons, 100 nearest"));
    assert!(find(&study, "box", "whitted").mean < 0.9);
}

/// Equal error: four times the error in the same time takes sixteen times as long.
#[test]
fn times_to_equal_error_go_by_squares() {
    let outcome = |name: &str, time_s: f64, error: f64, is_unbiased: bool| Outcome {
        contest: "c".to_owned(),
        way: Way { name: name.to_owned(), integrator: String::new(), n_samples: 1, is_unbiased },
        time_s,
        error,
        mean: 1.0,
        photons: None,
        image: Image::default(),
    };
    let outcomes =
        vec![outcome("a", 2.0, 0.1, false), outcome("b", 2.0, 0.4, true), outcome("c", 1.0, 0.1, false)];
    let study = ContestStudy { outcomes };
    let time = study.time_to_equal_error(&study.outcomes[1]).expect("it has no bias");
    assert!((time - 16.0).abs() < 1e-9);
    assert!(study.time_to_equal_error(&study.outcomes[2]).is_none());
}

/// Both methods agree, and photon maps err less for as many samples in the box.
#[test]
fn two_passes_beside_paths() {
    let mut contests = two_passes(&TINY);
    contests.truncate(1);
    let study = run(&contests);
    let [maps, path] = ["photonmap", "path"].map(|way| find(&study, "box", way));
    assert!((maps.mean - 1.0).abs() < 0.1 && (path.mean - 1.0).abs() < 0.1, "{} {}", maps.mean, path.mean);
    assert!(maps.photons.is_some_and(|[n, _]| n > 20_000.0));
}

/// Errors fall with photons, between rough walls as between flat ones.
#[test]
fn errors_fall_with_photons_between_any_walls() {
    // With fewer samples the noise of direct light hides it.
    let settings = ContestSettings { n_samples: 96, ..TINY };
    let study = photon_counts(&settings, 3, &ticking(), &mut |_| ());
    let errors = |walls: &str| study.points(walls, "direct by rays").iter().map(|p| p[2]).collect::<Vec<_>>();
    let [flat, rough] = ["flat walls", "fractal walls"].map(errors);
    assert!(flat[4] < 0.75 * flat[0] && rough[4] < 0.75 * rough[0], "{flat:?} {rough:?}");
    assert!(study.svg().contains("fractal walls") && study.summary().contains("for each m^2"));
}

/// A prism throws a spectrum by photons as by light tracing: blue and red as far apart, at the same places, and the same light in all
/// (SPEC VIS-6).
#[test]
fn prisms_throw_spectra() {
    let files =
        Generator::find("prism").and_then(|prism| prism.generate([])).unwrap_or_else(|e| panic!("{e}"));
    let text = String::from_utf8_lossy(&files.0[1].bytes).into_owned();
    let scene = StudyScene::of_text("prism", &text).with_resolution([64, 32]);
    let ways = [
        ("\"photons\" \"string show\" \"caustics\" \"integer photons\" 100000 \"integer nearest\" 20", 32),
        ("\"light\" \"integer maxdepth\" 8", 4096),
    ];
    let [photons, light] = ways.map(|(integrator, n_samples)| {
        let way =
            Way { name: String::new(), integrator: integrator.to_owned(), n_samples, is_unbiased: false };
        let contest = Contest {
            name: String::new(),
            scene: scene.clone(),
            paths: None,
            reference: way.clone(),
            ways: Vec::new(),
        };
        let pixels = contest.render(&way, 1).0.rgb_pixels().expect("a picture has colour");
        // Sum of each channel, and its centre across.
        [0, 1, 2].map(|c| {
            let sum: f32 = pixels.iter().map(|rgb| rgb[c]).sum();
            let moment: f32 = pixels.iter().enumerate().map(|(i, rgb)| rgb[c] * (i % 64) as f32).sum();
            [sum, moment / sum]
        })
    });
    for [found, truth] in [0, 1, 2].map(|c| [photons[c], light[c]]) {
        // Some thousands of photons and of paths arrive, each of one wavelength: sums of blue scatter by a tenth from seed to seed.
        assert!((found[0] / truth[0] - 1.0).abs() < 0.3, "{photons:?} {light:?}");
        assert!((found[1] - truth[1]).abs() < 2.0, "{photons:?} {light:?}");
    }
    assert!((photons[0][1] - photons[2][1]).abs() > 2.0, "{photons:?}");
}
