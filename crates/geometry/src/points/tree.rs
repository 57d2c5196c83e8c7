//! Points that keep the names they had in a list.

use etendue_math::Point3;

use super::found::{Neighbour, Neighbours, square_of_radius};
use super::packed::{Nearest, PackedPoints, Within};

/// Points that wait for questions: a bucket tree with the indices of the list that it was made of.
#[derive(Clone, Debug, Default)]
pub struct PointTree {
    pub(super) points: PackedPoints,
    /// By place.
    pub(super) indices: Vec<u32>,
}

impl PointTree {
    /// A tree of points, built in parallel on the current rayon pool. Points that are not finite are never found.
    ///
    /// # Panics
    /// If there are 2^32 points or more.
    #[must_use]
    pub fn new(points: &[Point3]) -> Self {
        let (points, indices) = PackedPoints::new(points);
        Self { points, indices }
    }

    /// Bytes on the heap.
    #[must_use]
    pub fn memory_bytes(&self) -> usize {
        self.points.memory_bytes() + crate::mesh::heap(&self.indices)
    }

    /// Finds the `k` points nearest to `p` among those no farther than `max_radius`; of equally near ones those of
    /// lower index.
    pub fn nearest(&self, p: Point3, k: usize, max_radius: f32, found: &mut Neighbours) {
        found.start(k, max_radius);
        if k > 0 {
            self.points.search(p, &mut Nearest { found, name: |place| self.indices[place as usize] });
        }
    }

    /// Shows all points no farther than `radius` from `p`, in no particular order (but always in the same).
    pub fn within(&self, p: Point3, radius: f32, mut visit: impl FnMut(Neighbour)) {
        let visit = |n: Neighbour| visit(Neighbour { index: self.indices[n.index as usize], ..n });
        self.points.search(p, &mut Within { limit_squared: square_of_radius(radius), visit });
    }
}
