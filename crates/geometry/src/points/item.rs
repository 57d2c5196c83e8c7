//! Points with the indices that they have in a list.

use etendue_math::Point3;

/// A point of a list.
#[derive(Clone, Copy, Debug)]
pub(super) struct Item {
    pub(super) p: [f32; 3],
    pub(super) index: u32,
}

impl Item {
    /// Square of the distance from a place; all structures round it in the same way.
    #[inline(always)]
    pub(super) const fn square_of_distance(&self, p: [f32; 3]) -> f32 {
        let (x, y, z) = (self.p[0] - p[0], self.p[1] - p[1], self.p[2] - p[2]);
        x * x + y * y + z * z
    }
}

/// Those of the points that are finite.
///
/// # Panics
/// If there are 2^32 points or more.
pub(super) fn finite_items(points: &[Point3]) -> Vec<Item> {
    assert!(u32::try_from(points.len()).is_ok(), "indices have 32 bits");
    let is_finite = |(_, p): &(u32, &Point3)| p.is_finite();
    let item = |(index, p): (u32, &Point3)| Item { p: [p.x, p.y, p.z], index };
    (0..).zip(points).filter(is_finite).map(item).collect()
}

/// Least and greatest coordinates.
pub(super) fn bounds(items: &[Item]) -> ([f32; 3], [f32; 3]) {
    let (mut min, mut max) = ([f32::INFINITY; 3], [f32::NEG_INFINITY; 3]);
    for item in items {
        for axis in 0..3 {
            min[axis] = min[axis].min(item.p[axis]);
            max[axis] = max[axis].max(item.p[axis]);
        }
    }
    (min, max)
}

/// The axis along which the points extend farthest; the first of equal ones.
pub(super) fn longest_axis(items: &[Item]) -> usize {
    let (min, max) = bounds(items);
    let extent = |axis: usize| max[axis] - min[axis];
    (1..3).fold(0, |longest, axis| if extent(axis) > extent(longest) { axis } else { longest })
}
