//! What a render cost, for `--stats`.

use std::path::Path;
use std::time::Duration;

use etendue::transport::RayCounts;
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
    /// Processor time of all threads, user and system; 0 where the system does not tell.
    pub(crate) cpu_seconds: f64,
    /// Passes in the image.
    pub(crate) passes: u64,
    /// Samples per pixel in the image.
    pub(crate) spp: u64,
    /// Camera samples taken in this run.
    pub(crate) samples: u64,
    /// Rays that looked for the nearest hit.
    pub(crate) rays: u64,
    /// Rays that asked for visibility.
    pub(crate) shadow_rays: u64,
    /// Photons stored; none by this method.
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
}

impl Statistics {
    /// Adds what the system knows of the process.
    pub(crate) fn measure_process(&mut self, rays: RayCounts) {
        self.rays = rays.closest;
        self.shadow_rays = rays.shadow;
        self.cpu_seconds = cpu_time().map_or(0.0, |t| t.as_secs_f64());
        self.peak_memory_bytes = peak_memory().unwrap_or(0);
    }

    /// Writes them as JSON.
    pub(crate) fn write(&self, path: &Path) -> Result<()> {
        let failed = |error: String| Failure::Running(format!("cannot write {}: {error}", path.display()));
        let text = serde_json::to_string_pretty(self).map_err(|error| failed(error.to_string()))?;
        std::fs::write(path, text + "\n").map_err(|error| failed(error.to_string()))
    }
}

/// Processor time of the process, from Linux's /proc.
fn cpu_time() -> Option<Duration> {
    let stat = std::fs::read_to_string("/proc/self/stat").ok()?;
    // Fields 14 and 15, user and system time, in ticks of 10 ms; field 2 may hold spaces but ends with ')'.
    let fields: Vec<&str> = stat.rsplit_once(')')?.1.split_whitespace().collect();
    let ticks: u64 = fields.get(11)?.parse::<u64>().ok()? + fields.get(12)?.parse::<u64>().ok()?;
    Some(Duration::from_millis(ticks * 10))
}

/// Largest resident memory of the process, from Linux's /proc.
fn peak_memory() -> Option<u64> {
    let status = std::fs::read_to_string("/proc/self/status").ok()?;
    let line = status.lines().find(|line| line.starts_with("VmHWM:"))?;
    let kilobytes: u64 = line.split_whitespace().nth(1)?.parse().ok()?;
    Some(kilobytes * 1024)
}
