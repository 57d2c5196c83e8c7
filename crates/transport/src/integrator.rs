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
