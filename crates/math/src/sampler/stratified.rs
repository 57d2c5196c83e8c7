//! Stratified (jittered) numbers (SPEC MC-9): of n = x * y samples one falls into each of n intervals of every
//! single number, and into each cell of the x by y grid of every pair. The order of the strata is a random
//! permutation per dimension, so that dimensions are independent of each other. Sample n starts a new independent round.

use crate::Point2;
use crate::low_discrepancy::permutation_element;
use crate::rng::{ONE_MINUS_EPSILON, hash64, mix64, unit_f32};

#[derive(Clone, Debug)]
pub(super) struct Stratified {
    /// Of the pixel and the round.
    seed: u64,
    strata: [u32; 2],
    /// Sample index within the round.
    index: u32,
    dimension: u32,
    jitter: bool,
}

impl Stratified {
    pub(super) fn new(seed: u64, sample_index: u64, strata: [u32; 2], jitter: bool) -> Self {
        let strata = strata.map(|n| n.clamp(1, 1 << 15));
        let n = u64::from(strata[0]) * u64::from(strata[1]);
        let seed = hash64(&[seed, sample_index / n]);
        Self { seed, strata, index: (sample_index % n) as u32, dimension: 0, jitter }
    }

    /// The stratum of this sample in the current dimension, and two numbers of place within it.
    fn next_stratum(&mut self) -> (u32, [f32; 2]) {
        let key = mix64(self.seed ^ mix64(u64::from(self.dimension) + 1));
        self.dimension += 1;
        let n = self.strata[0] * self.strata[1];
        let stratum = permutation_element(self.index, n, key as u32);
        if !self.jitter {
            return (stratum, [0.5, 0.5]);
        }
        let bits = mix64(key ^ mix64(u64::from(self.index) ^ 0x2545_f491_4f6c_dd1d));
        (stratum, [unit_f32(bits as u32), unit_f32((bits >> 32) as u32)])
    }

    pub(super) fn next_1d(&mut self) -> f32 {
        let (stratum, place) = self.next_stratum();
        within(stratum, place[0], self.strata[0] * self.strata[1])
    }

    pub(super) fn next_2d(&mut self) -> Point2 {
        let (stratum, place) = self.next_stratum();
        let [x, y] = self.strata;
        Point2::new(within(stratum % x, place[0], x), within(stratum / x, place[1], y))
    }
}

fn within(stratum: u32, place: f32, n: u32) -> f32 {
    ((stratum as f32 + place) / n as f32).min(ONE_MINUS_EPSILON)
}
