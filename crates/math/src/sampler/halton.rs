//! Halton points: dimension d is the radical inverse of the sample index in the d-th prime base, its digits
//! scrambled by permutations of the pixel's own. Every prefix of the sequence is even, without a favoured count.
//! Dimensions beyond the table of primes are independent numbers: large bases are even only after very many samples.

use crate::Point2;
use crate::low_discrepancy::{N_PRIMES, scrambled_radical_inverse};
use crate::rng::{hash64, mix64, unit_f32};

#[derive(Clone, Debug)]
pub(super) struct Halton {
    seed: u64,
    index: u64,
    dimension: u32,
}

impl Halton {
    pub(super) fn new(seed: u64, sample_index: u64) -> Self {
        // An f32 does not tell larger indices apart: beyond 2^24 samples a new independent sequence starts.
        let (round, index) = (sample_index >> 24, sample_index & 0xff_ffff);
        let seed = if round == 0 { seed } else { mix64(seed ^ mix64(round)) };
        Self { seed, index, dimension: 0 }
    }

    pub(super) fn next_1d(&mut self) -> f32 {
        let dimension = self.dimension;
        self.dimension += 1;
        if dimension as usize >= N_PRIMES {
            return unit_f32(hash64(&[self.seed, self.index, u64::from(dimension)]) as u32);
        }
        let seed = mix64(self.seed ^ mix64(u64::from(dimension) + 1));
        scrambled_radical_inverse(dimension as usize, self.index, seed)
    }

    pub(super) fn next_2d(&mut self) -> Point2 {
        let x = self.next_1d();
        Point2::new(x, self.next_1d())
    }
}
