//! Watches a render for the front end: progress bar, time limit, interruption and checkpoints.

use std::fmt;
use std::path::PathBuf;
use std::sync::Mutex;
use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};
use std::time::{Duration, Instant};

use etendue::io::checkpoint::{Checkpoint, write_checkpoint};
use etendue::scene::Film;
use etendue::transport::{Flow, Integrator, Observer, RayCounts, Stop};
use indicatif::{ProgressBar, ProgressDrawTarget, ProgressStyle};

use crate::report;

/// Set by the handler of Ctrl-C.
static INTERRUPTED: AtomicBool = AtomicBool::new(false);

/// True once the user pressed Ctrl-C.
#[must_use]
pub(crate) fn is_interrupted() -> bool {
    INTERRUPTED.load(Ordering::Relaxed)
}

/// The first Ctrl-C ends the render and writes what is finished; the second ends the process.
pub(crate) fn catch_interruption() {
    let handler = || {
        if INTERRUPTED.swap(true, Ordering::Relaxed) {
            std::process::exit(130);
        }
    };
    if let Err(error) = ctrlc::set_handler(handler) {
        report::warning(&format!("Ctrl-C will lose what is finished: {error}"));
    }
}

/// Where and how often the state of the render is kept.
#[derive(Clone, Debug)]
pub(crate) struct CheckpointPlan {
    /// The file.
    pub(crate) path: PathBuf,
    /// Time between writes.
    pub(crate) every: Duration,
    /// Identity of the render.
    pub(crate) fingerprint: u64,
    /// Seed of the sampler.
    pub(crate) seed: u64,
}

impl CheckpointPlan {
    /// Writes the state; a failure is said, and the render goes on. Before the first pass is complete there is nothing
    /// to keep: the film may hold some of its tiles, which a resumed render would add again.
    pub(crate) fn write(&self, film: &Film, state: Vec<u8>) {
        if film.n_passes() == 0 {
            return;
        }
        let checkpoint = Checkpoint {
            fingerprint: self.fingerprint,
            seed: self.seed,
            passes: film.passes().to_vec(),
            state,
            sums: film.sums().to_bytes(),
        };
        if let Err(error) = write_checkpoint(&self.path, &checkpoint) {
            report::warning(&format!("cannot write the checkpoint {}: {error}", self.path.display()));
        }
    }
}

/// Watches a render.
pub(crate) struct Watch {
    bar: ProgressBar,
    deadline: Option<Instant>,
    checkpoint: Option<CheckpointPlan>,
    last_checkpoint: Mutex<Instant>,
    n_passes: AtomicU64,
    n_samples: AtomicU64,
    closest: AtomicU64,
    shadow: AtomicU64,
    interpolated: AtomicU64,
}

impl fmt::Debug for Watch {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "Watch")
    }
}

impl Watch {
    /// Starts to watch a render into `film`.
    #[must_use]
    pub(crate) fn new(
        film: &Film,
        stop: &Stop,
        time: Option<Duration>,
        checkpoint: Option<CheckpointPlan>,
        show: ShowProgress,
    ) -> Self {
        let target = match show {
            ShowProgress::Yes => ProgressDrawTarget::stderr_with_hz(5),
            ShowProgress::No => ProgressDrawTarget::hidden(),
        };
        let n_passes = film.sums().n_missing(&stop.passes);
        let n_pixels = film.settings().crop.n_pixels() as u64;
        let bar = ProgressBar::with_draw_target(Some(n_passes.saturating_mul(n_pixels)), target);
        // Where time or error end the render, the share of the passes says nothing.
        let template = match (time, stop.error) {
            (None, None) => "{percent:>3} % [{bar:30}] {msg}, {per_sec}, {elapsed} elapsed, {eta} left",
            _ => "{spinner} {msg}, {per_sec}, {elapsed} elapsed",
        };
        if let Ok(style) = ProgressStyle::with_template(template) {
            let per_second = |state: &indicatif::ProgressState, out: &mut dyn fmt::Write| {
                // A terminal that refuses text cannot be helped.
                let _ = write!(out, "{:.2} M samples/s", state.per_sec() / 1e6);
            };
            bar.set_style(style.progress_chars("=> ").with_key("per_sec", per_second));
        }
        bar.set_message("pass 1");
        let now = Instant::now();
        Self {
            bar,
            // A time beyond what clocks count is no limit.
            deadline: time.and_then(|time| now.checked_add(time)),
            checkpoint,
            last_checkpoint: Mutex::new(now),
            n_passes: AtomicU64::new(0),
            n_samples: AtomicU64::new(0),
            closest: AtomicU64::new(0),
            shadow: AtomicU64::new(0),
            interpolated: AtomicU64::new(0),
        }
    }

    /// Camera samples so far.
    #[must_use]
    pub(crate) fn n_samples(&self) -> u64 {
        self.n_samples.load(Ordering::Relaxed)
    }

    /// Rays so far.
    #[must_use]
    pub(crate) fn rays(&self) -> RayCounts {
        RayCounts {
            closest: self.closest.load(Ordering::Relaxed),
            shadow: self.shadow.load(Ordering::Relaxed),
            interpolated: self.interpolated.load(Ordering::Relaxed),
        }
    }

    /// Ends the progress bar.
    pub(crate) fn clear(&self) {
        self.bar.finish_and_clear();
    }

    /// Ends the progress bar and keeps the last state.
    pub(crate) fn finish(&self, film: &Film, integrator: &dyn Integrator) {
        self.clear();
        if let Some(plan) = &self.checkpoint {
            plan.write(film, integrator.save());
        }
    }

    fn flow(&self) -> Flow {
        let is_late = self.deadline.is_some_and(|deadline| Instant::now() >= deadline);
        if is_late || is_interrupted() { Flow::Stop } else { Flow::Continue }
    }
}

/// Whether to show a progress bar.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum ShowProgress {
    /// On standard error, if that is a terminal.
    Yes,
    /// Not at all.
    No,
}

impl Observer for Watch {
    fn tile_done(&self, n_samples: u64, rays: RayCounts) -> Flow {
        self.n_samples.fetch_add(n_samples, Ordering::Relaxed);
        self.closest.fetch_add(rays.closest, Ordering::Relaxed);
        self.shadow.fetch_add(rays.shadow, Ordering::Relaxed);
        self.interpolated.fetch_add(rays.interpolated, Ordering::Relaxed);
        self.bar.inc(n_samples);
        self.flow()
    }

    fn pass_done(&self, _: u64, film: &Film, integrator: &dyn Integrator) -> Flow {
        let n_passes = self.n_passes.fetch_add(1, Ordering::Relaxed) + 1;
        self.bar.set_message(format!("pass {}", n_passes + 1));
        if let Some(plan) = &self.checkpoint
            && let Ok(mut last) = self.last_checkpoint.lock()
            && last.elapsed() >= plan.every
        {
            plan.write(film, integrator.save());
            *last = Instant::now();
        }
        self.flow()
    }
}
