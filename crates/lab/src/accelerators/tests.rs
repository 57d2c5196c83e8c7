//! Tests of the comparison of structures.

use std::cell::Cell;
use std::sync::OnceLock;
use std::time::Duration;

use etendue_geometry::Accelerator;

use super::{AcceleratorSettings, AcceleratorStudy, KINDS, MODELS, TYPICAL, accelerators, models};

/// A small study, by a clock that advances by a millisecond each time it is asked.
fn small_study() -> &'static AcceleratorStudy {
    static STUDY: OnceLock<AcceleratorStudy> = OnceLock::new();
    STUDY.get_or_init(|| {
        let settings = AcceleratorSettings {
            sizes: vec![1000, 16_000],
            resolution: [48, 36],
            n_rounds: 2,
            max_brute: 5000,
        };
        let now = Cell::new(Duration::ZERO);
        let clock = || {
            now.set(now.get() + Duration::from_millis(1));
            now.get()
        };
        accelerators(&settings, &clock, &mut |_| ())
    })
}

/// Models have about as many triangles as they should.
#[test]
fn models_have_their_size() {
    for name in MODELS {
        for size in [1000, 5000, 100_000] {
            let n = models::named(name, size).n_triangles() as f64;
            assert!((n / f64::from(size) - 1.0).abs() < 0.05, "{name} of {size}: {n}");
        }
    }
}

/// SPEC EXP-37, ACC-6: with any structure, 16 times as many triangles take far less than 16 times the tests; without one,
/// a ray tests all.
#[test]
fn structures_save_tests() {
    for model in MODELS {
        for accelerator in Accelerator::ALL {
            let costs: Vec<_> = small_study().of(model, accelerator.name()).collect();
            let tests: Vec<f64> = costs.iter().map(|cost| cost.rays[TYPICAL].primitives).collect();
            if accelerator == Accelerator::Brute {
                // But for those in the middle of the field that have no area.
                let all = costs[0].n_triangles as f64;
                assert!(tests.len() == 1 && (all - 32.0..=all).contains(&tests[0]), "{tests:?} of {all}");
                continue;
            }
            let is_lost = model == "stadium" && matches!(accelerator, Accelerator::Grid { .. });
            assert_eq!(tests[1] > 4.0 * tests[0], is_lost, "{model}, {}: {tests:?}", accelerator.name());
        }
    }
}

/// The result is complete as a table, as a figure and in words.
#[test]
fn accelerators_are_tabled_and_drawn() {
    let study = small_study();
    let csv = study.csv();
    let n_columns = csv.lines().next().map_or(0, |line| line.split(',').count());
    assert!(csv.lines().all(|line| line.split(',').count() == n_columns));
    // Seven structures over two sizes, and brute force over one.
    assert_eq!(csv.lines().count(), 1 + MODELS.len() * 15 * KINDS.len());
    let svg = study.svg();
    for accelerator in Accelerator::ALL {
        assert!(svg.contains(accelerator.name()));
    }
    assert_eq!(study.summary().lines().count(), MODELS.len() * 9);
    assert_eq!(study.costs[0].build_s, 1e-3, "times are those of the clock");
}
