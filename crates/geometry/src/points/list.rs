//! Points in a list, all of which are looked at: what other structures are held against (SPEC KD-2).

use etendue_math::Point3;

use super::found::{Neighbour, Neighbours, square_of_radius};
use super::item::{Item, finite_items};

/// Points in no order: 16 bytes a point.
#[derive(Clone, Debug, Default)]
pub struct PointList {
    items: Vec<Item>,
}

impl PointList {
    /// Those of the points that are finite.
    ///
    /// # Panics
    /// If there are 2^32 points or more.
    #[must_use]
    pub fn new(points: &[Point3]) -> Self {
        Self { items: finite_items(points) }
    }

    /// Bytes on the heap.
    #[must_use]
    pub fn memory_bytes(&self) -> usize {
        crate::mesh::heap(&self.items)
    }

    /// As [`PointTree::nearest`](super::PointTree::nearest).
    pub fn nearest(&self, p: Point3, k: usize, max_radius: f32, found: &mut Neighbours) {
        found.start(k, max_radius);
        for item in self.items.iter().filter(|_| k > 0) {
            let distance_squared = item.square_of_distance([p.x, p.y, p.z]);
            if distance_squared <= found.limit_squared() {
                found.offer(distance_squared, item.index);
            }
        }
    }

    /// As [`PointTree::within`](super::PointTree::within).
    pub fn within(&self, p: Point3, radius: f32, mut visit: impl FnMut(Neighbour)) {
        let limit_squared = square_of_radius(radius);
        for item in &self.items {
            let distance_squared = item.square_of_distance([p.x, p.y, p.z]);
            if distance_squared <= limit_squared {
                visit(Neighbour { index: item.index, distance_squared });
            }
        }
    }
}
