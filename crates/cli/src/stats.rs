//! What a render cost, for `--stats`.

use std::path::Path;
use std::time::{Duration, Instant};

use cpu_time::{ProcessTime, ThreadTime};
use etendue::transport::ReportEntry;
use serde::Serialize;

use crate::failure::{Failure, Result};

/// Statistics of a render; the names are stable.
#[derive(Clone, Debug, Serialize)]
pub(crate) struct Statistics {
    /// Version of the program.
    pub(crate) version: &'static str,
    /// Method.
    pub(crate) integrator: &'static str,
    /// Wall time from start to end.
    pub(crate) seconds_total: f64,
    /// Wall time of reading and building.
    pub(crate) seconds_build: f64,
    /// Wall time of rendering.
    pub(crate) seconds_render: f64,
    /// Processor time of all threads since the start of the process, user and system; 0 where the system does not tell.
    pub(crate) cpu_seconds: f64,
    /// Processor time of each thread during rendering.
    pub(crate) thread_cpu_seconds: Vec<f64>,
    /// The least of these over the wall time of rendering: 1 if no thread ever waited, for work or for a processor.
    pub(crate) busy_share: f64,
    /// Passes in the image.
    pub(crate) passes: u64,
    /// Samples per pixel in the image.
    pub(crate) spp: u64,
    /// Camera samples taken in this run.
    pub(crate) samples: u64,
    /// Those of them that were interpolated from others, and so cost no ray; 0 unless pixels are adaptive.
    pub(crate) interpolated_samples: u64,
    /// Rays that looked for the nearest hit.
    pub(crate) rays: u64,
    /// Rays that asked for visibility.
    pub(crate) shadow_rays: u64,
    /// Photons stored; 0 where the method stores none.
    pub(crate) photons_stored: u64,
    /// Largest resident memory of the process; 0 where the system does not tell.
    pub(crate) peak_memory_bytes: u64,
    /// Threads that rendered.
    pub(crate) threads: usize,
    /// Samples of NaN, infinite or negative radiance, taken as black.
    pub(crate) nan_samples: u64,
    /// Samples beyond what a sum can hold.
    pub(crate) saturated_samples: u64,
    /// Relative standard error of the image.
    pub(crate) relative_error: Option<f64>,
    /// What the method tells of its work.
    pub(crate) report: Vec<Figure>,
}

/// A figure that a method tells of its work.
#[derive(Clone, Debug, Serialize)]
pub(crate) struct Figure {
    name: &'static str,
    /// `null` where it is not finite.
    value: f64,
    #[serde(skip_serializing_if = "str::is_empty")]
    unit: &'static str,
    #[serde(skip_serializing_if = "Option::is_none")]
    advice: Option<String>,
}

impl From<ReportEntry> for Figure {
    fn from(ReportEntry { name, value, unit, advice }: ReportEntry) -> Self {
        Self { name, value, unit, advice }
    }
}

impl Statistics {
    /// Writes them as JSON.
    pub(crate) fn write(&self, path: &Path) -> Result<()> {
        let failed = |error: String| Failure::Running(format!("cannot write {}: {error}", path.display()));
        let text = serde_json::to_string_pretty(self).map_err(|error| failed(error.to_string()))?;
        std::fs::write(path, text + "\n").map_err(|error| failed(error.to_string()))
    }
}

/// Measures a render: by the clock on the wall, and by those of the threads of the current rayon pool.
#[derive(Clone, Debug)]
pub(crate) struct RenderClock {
    started: Instant,
    threads: Vec<Duration>,
}

/// What a render took.
#[derive(Clone, Debug)]
pub(crate) struct RenderTime {
    /// Wall time.
    pub(crate) wall: Duration,
    /// Processor time of each thread.
    pub(crate) threads: Vec<Duration>,
}

impl RenderClock {
    /// Starts it.
    pub(crate) fn start() -> Self {
        let threads = thread_times();
        Self { started: Instant::now(), threads }
    }

    /// The time since.
    pub(crate) fn elapsed(&self) -> RenderTime {
        let wall = self.started.elapsed();
        let threads =
            thread_times().into_iter().zip(&self.threads).map(|(now, then)| now.saturating_sub(*then));
        RenderTime { wall, threads: threads.collect() }
    }
}

impl RenderTime {
    /// See [`Statistics::busy_share`].
    pub(crate) fn busy_share(&self) -> f64 {
        let least = self.threads.iter().min().copied().unwrap_or_default();
        least.as_secs_f64() / self.wall.as_secs_f64().max(1e-9)
    }
}

/// Processor time of each thread of the current rayon pool so far; 0 where the system does not tell.
fn thread_times() -> Vec<Duration> {
    rayon::broadcast(|_| thread_time())
}

/// Processor time of the current thread so far; 0 where the system does not tell.
pub(crate) fn thread_time() -> Duration {
    ThreadTime::try_now().map_or(Duration::ZERO, |time| time.as_duration())
}

/// Processor time of the process.
pub(crate) fn cpu_time() -> Option<Duration> {
    ProcessTime::try_now().ok().map(|time| time.as_duration())
}

/// Largest resident memory of the process, from Linux's /proc.
pub(crate) fn peak_memory() -> Option<u64> {
    let status = std::fs::read_to_string("/proc/self/status").ok()?;
    let line = status.lines().find(|line| line.starts_with("VmHWM:"))?;
    let kilobytes: u64 = line.split_whitespace().nth(1)?.parse().ok()?;
    Some(kilobytes * 1024)
}
