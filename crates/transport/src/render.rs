//! The pass loop: runs passes until a stop rule, the observer or the front end ends it.
//!
//! Knows neither clocks nor files: a time limit, a progress bar and checkpoints live in the [`Observer`].

use std::fmt;
use std::ops::Range;

use etendue_scene::{Film, Scene};

use crate::integrator::{Control, Integrator, PassEnd, RayCounts};

/// What an observer answers.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Flow {
    /// Go on.
    Continue,
    /// Stop as soon as possible.
    Stop,
}

/// Watches a render and may end it. Called from many threads.
pub trait Observer: Sync + fmt::Debug {
    /// After each tile.
    fn tile_done(&self, n_samples: u64, rays: RayCounts) -> Flow;

    /// After each complete pass, with everything gathered so far.
    fn pass_done(&self, pass: u64, film: &Film, integrator: &dyn Integrator) -> Flow;
}

/// An observer that never interferes.
#[derive(Clone, Copy, Debug, Default)]
pub struct Unobserved;

impl Observer for Unobserved {
    fn tile_done(&self, _: u64, _: RayCounts) -> Flow {
        Flow::Continue
    }

    fn pass_done(&self, _: u64, _: &Film, _: &dyn Integrator) -> Flow {
        Flow::Continue
    }
}

/// When a render ends: after the last pass, or once the error is small enough.
#[derive(Clone, Debug, PartialEq)]
pub struct Stop {
    /// The passes to run; those that the film already holds are skipped.
    pub passes: Range<u64>,
    /// Relative standard error of the image ([`Film::relative_error`]) that is good enough.
    pub error: Option<f64>,
}

/// Why a render ended.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Outcome {
    /// All passes are done.
    Finished,
    /// The error target is met.
    Converged,
    /// The observer asked to stop.
    Stopped,
}

/// The error target is not trusted before this many passes: the variance itself is an estimate.
const LEAST_PASSES_FOR_ERROR: u64 = 16;

/// Runs passes into `film` until a stop rule holds. Uses the rayon pool that the caller has installed.
pub fn render(
    scene: &Scene,
    integrator: &mut dyn Integrator,
    film: &mut Film,
    stop: &Stop,
    observer: &dyn Observer,
) -> Outcome {
    let control = Control::new(observer);
    for pass in stop.passes.clone() {
        if film.holds_pass(pass) {
            continue;
        }
        if integrator.run_pass(scene, pass, film, &control) == PassEnd::Cancelled {
            return Outcome::Stopped;
        }
        film.note_pass(pass);
        let flow = observer.pass_done(pass, film, integrator);
        if let Some(target) = stop.error
            && film.n_passes() >= LEAST_PASSES_FOR_ERROR
            && film.relative_error() <= target
        {
            return Outcome::Converged;
        }
        if flow == Flow::Stop || control.is_cancelled() {
            return Outcome::Stopped;
        }
    }
    Outcome::Finished
}
