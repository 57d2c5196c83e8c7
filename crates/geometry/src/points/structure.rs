//! One interface to all structures, to compare them.

use etendue_math::Point3;

use super::{GrowingTree, HashGrid, HeapTree, Neighbour, Neighbours, PointList, PointTree};

/// A way to keep points.
///
/// To add one: a variant here and in [`PointIndex`], a line in each `match`; the tests take it from [`Structure::ALL`].
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Structure {
    /// [`PointList`].
    List,
    /// [`HashGrid`].
    Grid,
    /// [`GrowingTree`].
    Growing,
    /// [`HeapTree`].
    Heap,
    /// [`PointTree`].
    Buckets,
}

impl Structure {
    /// All of them.
    pub const ALL: [Self; 5] = [Self::List, Self::Grid, Self::Growing, Self::Heap, Self::Buckets];

    /// Its name in tables.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::List => "list",
            Self::Grid => "hash grid",
            Self::Growing => "unbalanced kd-tree",
            Self::Heap => "left-balanced kd-tree",
            Self::Buckets => "bucket kd-tree",
        }
    }
}

/// Points in one of the structures. All give the same answers.
#[derive(Clone, Debug)]
pub enum PointIndex {
    /// All of them, one by one.
    List(PointList),
    /// By cells of a grid.
    Grid(HashGrid),
    /// A tree in order of arrival.
    Growing(GrowingTree),
    /// A tree in heap order.
    Heap(HeapTree),
    /// A tree of buckets.
    Buckets(PointTree),
}

/// The method of the structure that is there.
macro_rules! dispatch {
    ($index:expr, $it:ident => $call:expr) => {
        match $index {
            PointIndex::List($it) => $call,
            PointIndex::Grid($it) => $call,
            PointIndex::Growing($it) => $call,
            PointIndex::Heap($it) => $call,
            PointIndex::Buckets($it) => $call,
        }
    };
}

impl PointIndex {
    /// Points in such a structure; `radius`, positive and finite, is what questions are expected to have, and matters to the
    /// grid alone.
    ///
    /// # Panics
    /// If there are 2^32 points or more, or the radius of a grid is not positive and finite.
    #[must_use]
    pub fn new(structure: Structure, points: &[Point3], radius: f32) -> Self {
        match structure {
            Structure::List => Self::List(PointList::new(points)),
            Structure::Grid => Self::Grid(HashGrid::new(points, radius)),
            Structure::Growing => Self::Growing(GrowingTree::new(points)),
            Structure::Heap => Self::Heap(HeapTree::new(points)),
            Structure::Buckets => Self::Buckets(PointTree::new(points)),
        }
    }

    /// As [`PointTree::nearest`].
    pub fn nearest(&self, p: Point3, k: usize, max_radius: f32, found: &mut Neighbours) {
        dispatch!(self, it => it.nearest(p, k, max_radius, found));
    }

    /// As [`PointTree::within`].
    pub fn within(&self, p: Point3, radius: f32, visit: impl FnMut(Neighbour)) {
        dispatch!(self, it => it.within(p, radius, visit));
    }

    /// Bytes on the heap.
    #[must_use]
    pub fn memory_bytes(&self) -> usize {
        dispatch!(self, it => it.memory_bytes())
    }
}
