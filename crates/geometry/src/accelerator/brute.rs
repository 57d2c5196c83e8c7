//! No structure: every primitive is tested, O(N) for each ray (SPEC ACC-1). What it finds is what all others have to find.

use std::ops::ControlFlow;

use super::{Build, Probe};
use crate::bvh::TraversalRay;

#[derive(Debug)]
pub(super) struct Brute {
    n_primitives: u32,
}

impl Brute {
    pub(super) const fn build(build: &Build<'_>) -> Self {
        Self { n_primitives: build.boxes.len() as u32 }
    }

    pub(super) fn traverse(&self, _: &TraversalRay, probe: &mut impl Probe) -> ControlFlow<()> {
        (0..self.n_primitives).try_for_each(|primitive| probe.test(primitive))
    }

    pub(super) const fn n_nodes(&self) -> usize {
        0
    }

    pub(super) const fn memory_bytes(&self) -> usize {
        0
    }
}
