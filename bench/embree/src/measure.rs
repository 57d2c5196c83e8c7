//! Times of builds and rays.

use etendue_lab::speed::RaySet;
use etendue_math::Ray;

use crate::clock::thread_seconds;
use crate::contestant::{Builder, Contestant, Kind};

/// Rays of a turn.
const TURN: usize = 1 << 15;

/// A contestant's builds.
#[derive(Clone, Debug, Default)]
pub(crate) struct Build {
    /// Processor seconds of all threads, each time.
    pub(crate) seconds: Vec<f64>,
    pub(crate) n_bytes: usize,
}

/// Builds everything so many times, in turns, and keeps the last of each.
pub(crate) fn builds<'a>(
    builder: &Builder<'a>,
    kinds: &[Kind],
    n: usize,
) -> (Vec<Contestant<'a>>, Vec<Build>) {
    let mut builds = vec![Build::default(); kinds.len()];
    let mut contestants = Vec::new();
    for _ in 0..n.max(1) {
        contestants.clear();
        for (kind, build) in kinds.iter().zip(&mut builds) {
            let (contestant, seconds) = builder.build(*kind);
            build.seconds.push(seconds);
            build.n_bytes = contestant.n_bytes();
            contestants.push(contestant);
        }
    }
    (contestants, builds)
}

/// A contestant's work on one set of rays.
#[derive(Clone, Debug, Default)]
pub(crate) struct Traced {
    /// Rays per processor second in each round.
    pub(crate) rates: Vec<f64>,
    /// What each ray met.
    pub(crate) t: Vec<f32>,
}

/// Traces the set in so many rounds, in turns.
pub(crate) fn rays(contestants: &[Contestant<'_>], set: &RaySet, n_rounds: usize) -> Vec<Traced> {
    let n_rays = set.rays.len();
    let mut traced = vec![Traced { t: vec![0.0; n_rays], ..Traced::default() }; contestants.len()];
    let turns: Vec<RaySet> =
        set.rays.chunks(TURN).map(|rays| RaySet { rays: rays.to_vec(), ..*set }).collect();
    for round in 0..n_rounds.max(1) {
        let mut seconds = vec![0.0; contestants.len()];
        for (index, turn) in turns.iter().enumerate() {
            for k in 0..contestants.len() {
                let k = (k + round + index) % contestants.len();
                let t = &mut traced[k].t[index * TURN..][..turn.rays.len()];
                let start = thread_seconds();
                contestants[k].trace(turn, t);
                seconds[k] += thread_seconds() - start;
            }
        }
        for (traced, seconds) in traced.iter_mut().zip(seconds) {
            traced.rates.push(n_rays as f64 / seconds);
        }
    }
    traced
}

/// How many rays of two contestants differ: one hits and the other does not, or t differs by more than one part in ten
/// thousand and the rounding of the origin.
pub(crate) fn n_different(rays: &[Ray], a: &[f32], b: &[f32]) -> usize {
    let is_near = |ray: &Ray, a: f32, b: f32| {
        let origin = ray.origin.abs().max_element();
        a == b || (a - b).abs() <= 1e-4 * a.max(b) + 4.0 * f32::EPSILON * origin
    };
    rays.iter().zip(a.iter().zip(b)).filter(|(ray, (a, b))| !is_near(ray, **a, **b)).count()
}

/// The middle value.
pub(crate) fn median(values: &[f64]) -> f64 {
    let mut sorted = values.to_vec();
    sorted.sort_by(f64::total_cmp);
    let middle = sorted.len() / 2;
    if sorted.len() % 2 == 1 { sorted[middle] } else { 0.5 * (sorted[middle - 1] + sorted[middle]) }
}

/// Median of the ratios within rounds.
pub(crate) fn ratio(a: &[f64], b: &[f64]) -> f64 {
    median(&a.iter().zip(b).map(|(a, b)| a / b).collect::<Vec<_>>())
}
