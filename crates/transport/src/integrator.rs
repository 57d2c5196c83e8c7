//! What a method of light transport is to the pass loop.

use std::sync::atomic::{AtomicBool, Ordering};

use etendue_scene::{Film, Scene};

use crate::render::{Flow, Observer};

/// How the passes of a method relate to each other.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Passes {
    /// A pass depends on its index alone: any split over machines or runs adds up exactly.
    Independent,
    /// State carries over from pass to pass, so that they run in order in one place.
    Sequential,
}

/// How a pass ended.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum PassEnd {
    /// Every pixel has its sample.
    Complete,
    /// Stopped; the film holds the finished tiles of the pass if it had no complete pass, else nothing of it.
    Cancelled,
}

/// State that does not belong to the method that is asked to load it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct StateError;

impl std::fmt::Display for StateError {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "the saved state does not belong to this integrator")
    }
}

impl std::error::Error for StateError {}

/// A method of light transport.
pub trait Integrator: Send {
    /// How its passes relate.
    fn passes(&self) -> Passes;

    /// Adds one sample per pixel, or what corresponds to it, to the film.
    fn run_pass(&mut self, scene: &Scene, pass: u64, film: &mut Film, control: &Control<'_>) -> PassEnd;

    /// What the method tells of its work so far beyond rays, in a fixed order; names are stable.
    fn report(&self) -> Vec<ReportEntry> {
        Vec::new()
    }

    /// State between passes, for checkpoints; empty for independent passes.
    fn save(&self) -> Vec<u8> {
        Vec::new()
    }

    /// Brings back saved state.
    ///
    /// # Errors
    /// If the state was not saved by the same method with the same settings.
    fn load(&mut self, state: &[u8]) -> Result<(), StateError> {
        if state.is_empty() { Ok(()) } else { Err(StateError) }
    }
}

/// A figure that a method tells of its work, such as how many photons it stored.
#[derive(Clone, Debug, PartialEq)]
pub struct ReportEntry {
    /// What it is, in words joined by underscores. `photons_stored` is what `--stats` shows by that name.
    pub name: &'static str,
    /// How much of it.
    pub value: f64,
    /// Unit; empty for counts and pure numbers.
    pub unit: &'static str,
    /// What the user should know or change where the figure is off, in one line.
    pub advice: Option<String>,
}

impl ReportEntry {
    /// A figure as it should be.
    #[must_use]
    pub const fn new(name: &'static str, value: f64, unit: &'static str) -> Self {
        Self { name, value, unit, advice: None }
    }

    /// The figure with a word to the user.
    #[must_use]
    pub fn with_advice(self, advice: impl Into<String>) -> Self {
        Self { advice: Some(advice.into()), ..self }
    }

    /// The same where there is a word to say.
    #[must_use]
    pub fn with_advice_if_any(self, advice: Option<impl Into<String>>) -> Self {
        Self { advice: advice.map(Into::into).or(self.advice), ..self }
    }
}

/// The way back from a running pass to the front end: progress out, cancellation in.
#[derive(Debug)]
pub struct Control<'a> {
    observer: &'a dyn Observer,
    cancelled: AtomicBool,
}

impl<'a> Control<'a> {
    /// Reports to that observer.
    #[must_use]
    pub const fn new(observer: &'a dyn Observer) -> Self {
        Self { observer, cancelled: AtomicBool::new(false) }
    }

    /// True once the observer asked to stop.
    #[must_use]
    pub fn is_cancelled(&self) -> bool {
        self.cancelled.load(Ordering::Relaxed)
    }

    /// Reports a finished tile of `n_samples` camera samples and `rays`; remembers a wish to stop.
    pub fn tile_done(&self, n_samples: u64, rays: RayCounts) {
        if self.observer.tile_done(n_samples, rays) == Flow::Stop {
            self.cancelled.store(true, Ordering::Relaxed);
        }
    }
}

/// Rays traced, and spared.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct RayCounts {
    /// Rays that look for the nearest hit.
    pub closest: u64,
    /// Rays that ask whether anything is in the way.
    pub shadow: u64,
    /// Pixels of passes that were interpolated and cost none.
    pub interpolated: u64,
}

impl std::ops::AddAssign for RayCounts {
    fn add_assign(&mut self, other: Self) {
        self.closest += other.closest;
        self.shadow += other.shadow;
        self.interpolated += other.interpolated;
    }
}
