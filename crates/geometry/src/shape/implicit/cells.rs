//! The cells of a box in which a function may vanish, all of one size: the leaves of an octree whose other nodes are
//! needed no longer, since the hierarchy takes their place.

use glam::DVec3;
use rayon::prelude::*;

/// Finest division: 2^9 cells along each side.
const MAX_LEVEL: u32 = 9;
/// No further division once there are so many cells; more would not make rays quicker. A choice, measured on a gyroid.
const ENOUGH_CELLS: usize = 1 << 14;
/// Work of the division, in steps of the formula over a box.
const MAX_WORK: usize = 1 << 25;

/// Cells by their numbers along the axes.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Cells {
    min: DVec3,
    max: DVec3,
    level: u32,
    cells: Vec<[u16; 3]>,
}

impl Cells {
    /// One cell.
    pub(super) fn new(min: DVec3, max: DVec3) -> Self {
        Self { min, max, level: 0, cells: vec![[0; 3]] }
    }

    /// Divides all cells in eight, again and again, and keeps those that are wanted. `n_steps` is the cost of asking.
    pub(super) fn refine(&mut self, n_steps: usize, is_wanted: impl Fn(DVec3, DVec3) -> bool + Sync) {
        let mut work = 0;
        if !is_wanted(self.min, self.max) {
            self.cells.clear();
        }
        while !self.cells.is_empty() && self.level < MAX_LEVEL && self.cells.len() < ENOUGH_CELLS {
            work += 8 * self.cells.len() * n_steps;
            if work > MAX_WORK {
                break;
            }
            self.level += 1;
            let old = std::mem::take(&mut self.cells);
            self.cells = old
                .par_iter()
                .flat_map_iter(|&[x, y, z]| {
                    let child = move |i: u16| [2 * x + (i & 1), 2 * y + (i >> 1 & 1), 2 * z + (i >> 2)];
                    (0..8).map(child)
                })
                .filter(|cell| {
                    let (min, max) = self.box_of(*cell);
                    is_wanted(min, max)
                })
                .collect();
        }
    }

    pub(super) const fn len(&self) -> usize {
        self.cells.len()
    }

    pub(super) fn memory_bytes(&self) -> usize {
        self.cells.capacity() * size_of::<[u16; 3]>()
    }

    /// The whole box.
    pub(super) fn bounds(&self) -> (DVec3, DVec3) {
        (self.min, self.max)
    }

    pub(super) fn middle(&self) -> DVec3 {
        0.5 * (self.min + self.max)
    }

    fn box_of(&self, cell: [u16; 3]) -> (DVec3, DVec3) {
        let n = f64::from(1_u32 << self.level);
        let cell = DVec3::from_array(cell.map(f64::from));
        let at = |cell: DVec3| self.min + (self.max - self.min) * (cell / n);
        (at(cell), at(cell + 1.0))
    }

    /// The box of a cell, a little larger, so that neighbours overlap whatever the rounding.
    pub(super) fn padded_box(&self, cell: u32) -> (DVec3, DVec3) {
        let (min, max) = self.box_of(self.cells[cell as usize]);
        let pad = (max - min) * 1e-7 + min.abs().max(max.abs()) * 1e-14;
        (min - pad, max + pad)
    }
}
