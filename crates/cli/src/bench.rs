//! `etendue bench`: how fast this machine is, on built-in scenes.
//!
//! Rates are by the clock on the wall, as users meet them, and the best of several runs, which other programs have
//! disturbed least.

use std::time::{Duration, Instant};

use etendue::lab::speed::{Task, TaskSize, tasks};
use rayon::ThreadPool;
use serde_json::{Map, Value, json};

use crate::args::BenchArguments;
use crate::failure::{Failure, Result};
use crate::list::print;
use crate::report;

/// How long a task is repeated.
const PATIENCE: Duration = Duration::from_millis(1200);

/// Runs the command.
pub(crate) fn run(arguments: &BenchArguments) -> Result<()> {
    let all = threads(arguments.threads.map_or(0, |n| n as usize))?;
    let one = threads(1)?;
    let (size, patience) =
        if arguments.quick { (TaskSize::TINY, Duration::ZERO) } else { (TaskSize::FULL, PATIENCE) };
    if !arguments.json {
        report::note("making the scenes");
    }
    let (tasks, is_avx2) = all.install(|| tasks(&size));
    let n_threads = all.current_num_threads();
    if !arguments.json {
        print(&format!("{n_threads} threads, {} AVX2", if is_avx2 { "with" } else { "without" }));
        print(&format!("{:<30}{:>12}{:>14}", "millions per second", "one thread", "all threads"));
    }
    let mut figures = Map::new();
    for task in &tasks {
        let rates = [&one, &all].map(|pool| pool.install(|| rate(task, patience)));
        if !arguments.json {
            let [one, all] = rates.map(|rate| rate / 1e6);
            print(&format!("{:<30}{one:>12.3}{all:>14.3}", task.name));
        }
        figures
            .insert(format!("{}_per_s", task.key), json!({"one_thread": rates[0], "all_threads": rates[1]}));
    }
    if arguments.json {
        let version = env!("CARGO_PKG_VERSION");
        let figures = Value::Object(figures);
        print(
            &json!({"version": version, "threads": n_threads, "avx2": is_avx2, "figures": figures})
                .to_string(),
        );
    }
    Ok(())
}

fn threads(n: usize) -> Result<ThreadPool> {
    let pool = rayon::ThreadPoolBuilder::new().num_threads(n).build();
    pool.map_err(|error| Failure::Running(format!("cannot start threads: {error}")))
}

/// Things done per second: the best of the runs that fit into this time, after one that warms up.
fn rate(task: &Task, patience: Duration) -> f64 {
    let begun = Instant::now();
    task.run();
    let mut best = 0.0_f64;
    loop {
        let start = Instant::now();
        let n = task.run() as f64;
        best = best.max(n / start.elapsed().as_secs_f64().max(1e-9));
        if begun.elapsed() >= patience {
            return best;
        }
    }
}
