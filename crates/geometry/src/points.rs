//! Look-ups of points: the nearest `k`, or all within a radius (SPEC KD-1, KD-2, KD-8).
//!
//! [`PointTree`] is the structure to use: buckets of points under a kd-tree. [`PackedPoints`] is the same without names, for
//! owners who keep what belongs to the points in the order of the tree, as photon maps do. The others are there to be compared
//! with it, by way of [`PointIndex`].
//!
//! The answer is that of a search through all points: the `k` least by distance, then by index. It does not depend on
//! the structure, nor on the number of threads that built it.

mod found;
mod item;

mod packed;
mod tree;

mod grid;
mod growing_tree;
mod heap_tree;
mod list;
mod structure;

#[cfg(test)]
mod tests;

pub use found::{Neighbour, Neighbours};
pub use grid::HashGrid;
pub use growing_tree::GrowingTree;
pub use heap_tree::HeapTree;
pub use list::PointList;
pub use packed::{NotInOrder, PackedPoints};
pub use structure::{PointIndex, Structure};
pub use tree::PointTree;
