//! Structures to compare with the hierarchy of `bvh`: the other classic ways to find what a ray meets (SPEC ACC-1,
//! ACC-3, ACC-4, EXP-37).
//!
//! Each is built over boxes and shows a ray the primitives whose boxes it may meet, roughly front to back: [`Build`] is what
//! they get, [`Probe`] what they show primitives to. The rest is common: a [`Group`] tests primitives and enters instances, so
//! that every structure has two levels, moves and filters as the hierarchy does. They are written to be read and to be compared
//! with each other, with one primitive tested at a time; only `bvh` is made for speed.
//!
//! All find the hits of [`brute`], bit for bit; only `bvh` may rarely take another of several at the very same distance. The arithmetic of a primitive's test does not depend on the structure; ties are
//! decided by the order of primitives, not of visits; and whatever divides space by planes takes them where a ray is a little
//! ahead of itself and a little behind, as `bvh/ray.rs` does for boxes, so that no part of the ray falls between two cells.
//! Structures that divide space hold a primitive in every cell that its box overlaps. That it may be tested more than once
//! changes nothing but time, most of which a mailbox of the latest tests saves (Amanatides and Woo 1987, with memory for each
//! ray as in Shevtsov, Soupikov and Kapustin 2007, "Highly Parallel Fast KD-tree Construction").
//!
//! Memory is bounded: a structure that divides space may hold [`REFERENCES_PER_PRIMITIVE`] references to each primitive on
//! average, and each cell gets the share of that its primitives make up; cells that would need more are not divided.

mod binary_bvh;
mod brute;
mod grid;
mod group;
mod octree;
mod plane_tree;
mod settings;
mod slab;

mod bsp;
mod kd_tree;

#[cfg(test)]
mod tests;

pub(crate) use group::{Group, Structures, Target};
pub use settings::{Accelerator, BinarySplit, DivisionSettings, GridSettings, KdTreeSettings};

use std::ops::ControlFlow;

use crate::bvh::{Box3, TraversalRay};
use binary_bvh::BinaryBvh;
use brute::Brute;
use grid::Grid;
use octree::Octree;
use plane_tree::PlaneTree;

/// References that structures which divide space may hold for each primitive, on average.
const REFERENCES_PER_PRIMITIVE: usize = 16;
/// Cells with more primitives are divided in parallel.
const PARALLEL: usize = 1 << 12;

/// What a structure is built over.
#[derive(Clone, Copy, Debug)]
struct Build<'a> {
    /// The boxes of all primitives.
    boxes: &'a [Box3],
    /// The box around them.
    bounds: &'a Box3,
}

impl Build<'_> {
    /// The numbers of all primitives.
    fn all(&self) -> Vec<u32> {
        (0..self.boxes.len() as u32).collect()
    }

    /// How many references the structure may hold.
    fn budget(&self) -> usize {
        // Places of references are 32 bits wide.
        (self.boxes.len() * REFERENCES_PER_PRIMITIVE + 1024).min(u32::MAX as usize)
    }

    /// The primitives of a cell on both sides of a plane. What lies within the plane is on the lower side; what only
    /// touches it is not on the other.
    fn sides(&self, primitives: &[u32], axis: usize, position: f32) -> [Vec<u32>; 2] {
        let bounds = |primitive: &u32| &self.boxes[*primitive as usize];
        let below = |b: &Box3| b.min[axis] < position || b.max[axis] <= position;
        [
            primitives.iter().copied().filter(|p| below(bounds(p))).collect(),
            primitives.iter().copied().filter(|p| bounds(p).max[axis] > position).collect(),
        ]
    }
}

/// The part of the references that a cell may hold which one of its parts may hold.
const fn share(budget: usize, n_of_part: usize, n_of_all: usize) -> usize {
    // Products of these numbers fit: both are less than 2^40.
    (budget as u128 * n_of_part as u128 / if n_of_all > 0 { n_of_all as u128 } else { 1 }) as usize
}

/// What a structure shows primitives to.
trait Probe {
    /// A node or a cell is about to be looked at.
    fn note_node(&mut self);
    /// Where the ray ends, as far as is known, with room for rounding.
    fn end(&self) -> f32;
    /// Tests a primitive, which may bring the end nearer; breaks where the question is answered.
    fn test(&mut self, primitive: u32) -> ControlFlow<()>;

    /// Tests several.
    fn test_all(&mut self, primitives: &[u32]) -> ControlFlow<()> {
        primitives.iter().try_for_each(|primitive| self.test(*primitive))
    }
}

/// Some structure. To add one: a variant here and in [`Accelerator`], a file with `build`, `traverse`, `n_nodes` and
/// `memory_bytes`, and a line in the table of accelerators of the crate `scene`.
#[derive(Debug)]
enum Structure {
    Brute(Brute),
    BinaryBvh(BinaryBvh),
    Grid(Grid),
    Octree(Octree),
    PlaneTree(PlaneTree),
}

/// Calls a method of whichever structure there is.
macro_rules! of_each {
    ($structure:expr, $own:ident => $call:expr) => {
        match $structure {
            Structure::Brute($own) => $call,
            Structure::BinaryBvh($own) => $call,
            Structure::Grid($own) => $call,
            Structure::Octree($own) => $call,
            Structure::PlaneTree($own) => $call,
        }
    };
}

impl Structure {
    fn build(build: &Build<'_>, accelerator: &Accelerator) -> Self {
        match accelerator {
            // The wide hierarchy is not one of these.
            Accelerator::Bvh | Accelerator::Brute => Self::Brute(Brute::build(build)),
            Accelerator::BinaryBvh { split, max_primitives } => {
                Self::BinaryBvh(BinaryBvh::build(build, *split, *max_primitives))
            }
            Accelerator::Grid { density } => Self::Grid(Grid::build(build, &GridSettings::uniform(*density))),
            Accelerator::HierarchicalGrid(settings) => Self::Grid(Grid::build(build, settings)),
            Accelerator::Octree(settings) => Self::Octree(Octree::build(build, settings)),
            Accelerator::Bsp(settings) => Self::PlaneTree(bsp::build(build, settings)),
            Accelerator::KdTree(settings) => Self::PlaneTree(kd_tree::build(build, settings)),
        }
    }

    fn traverse(&self, ray: &TraversalRay, probe: &mut impl Probe) -> ControlFlow<()> {
        of_each!(self, own => own.traverse(ray, probe))
    }

    fn n_nodes(&self) -> usize {
        of_each!(self, own => own.n_nodes())
    }

    fn memory_bytes(&self) -> usize {
        of_each!(self, own => own.memory_bytes())
    }
}
