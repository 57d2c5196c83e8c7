//! Binary space partitioning: cells are halved across their longest side until they hold few primitives (Kaplan 1985;
//! Sung and Shirley 1992, "Ray Tracing with the BSP Tree"; SPEC ACC-4).
//!
//! It adapts to where primitives are, as an octree does, but in smaller steps. Where planes would best be placed it does not
//! ask; [`kd_tree`](super::kd_tree) does.

use super::plane_tree::{Cell, Plane, PlaneTree};
use super::{Build, DivisionSettings};

pub(super) fn build(build: &Build<'_>, settings: &DivisionSettings) -> PlaneTree {
    PlaneTree::build(build, &|cell| halve(cell, settings))
}

fn halve(cell: &Cell, settings: &DivisionSettings) -> Option<Plane> {
    if cell.primitives.len() <= settings.max_primitives as usize || cell.depth >= settings.max_depth {
        return None;
    }
    let axis = cell.bounds.longest_axis();
    let (min, max) = (cell.bounds.min[axis], cell.bounds.max[axis]);
    // Each is halved on its own, since the sum may be too large.
    let position = 0.5 * min + 0.5 * max;
    (min < position && position < max).then_some(Plane { axis, position })
}
