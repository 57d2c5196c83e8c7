//! Independent numbers: the error falls as N^(-1/2) whatever the integrand (SPEC MC-4).

use crate::Point2;
use crate::rng::{Rng, mix64};

#[derive(Clone, Debug)]
pub(super) struct Independent {
    rng: Rng,
}

impl Independent {
    pub(super) fn new(seed: u64, sample_index: u64) -> Self {
        let stream = mix64(seed ^ mix64(sample_index.wrapping_add(0x632b_e59b_d9b4_e019)));
        Self { rng: Rng::new(mix64(stream), stream) }
    }

    #[inline]
    pub(super) fn next_1d(&mut self) -> f32 {
        self.rng.next_f32()
    }

    #[inline]
    pub(super) fn next_2d(&mut self) -> Point2 {
        self.rng.next_point2()
    }
}
