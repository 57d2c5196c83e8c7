//! Threads of a command.

use crate::failure::{Failure, Result};

/// Does the work with so many threads, by default those of all cores.
pub(crate) fn with_threads(threads: Option<u64>, work: impl FnOnce() -> Result<()> + Send) -> Result<()> {
    let pool = rayon::ThreadPoolBuilder::new()
        .num_threads(threads.map_or(0, |n| n as usize))
        .build()
        .map_err(|error| Failure::Running(format!("cannot start threads: {error}")))?;
    pool.install(work)
}
