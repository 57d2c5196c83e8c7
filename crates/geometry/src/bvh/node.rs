//! A node with eight children, and how a child is named in 32 bits.

use super::TraversalRay;
use super::lanes::Lanes;
use crate::bvh::build::Box3;
use std::ops::Range;

/// Upper two bits of a child that is a node.
pub(super) const INNER: u32 = 0;
/// Upper two bits of a child that is a run of triangle blocks.
pub(super) const TRIANGLES: u32 = 1;
/// Upper two bits of a child that is a run of items.
pub(super) const ITEMS: u32 = 2;
/// No child.
pub(super) const EMPTY: u32 = u32::MAX;
/// Longest run that a leaf can name.
pub(super) const MAX_RUN: usize = 8;

/// Names a node.
pub(super) fn node_index(index: usize) -> u32 {
    assert!(index < 1 << 30, "too many nodes");
    index as u32
}

/// Names a leaf: a run of `n` blocks or items from `first` on.
pub(super) fn leaf(kind: u32, first: usize, n: usize) -> u32 {
    assert!(first < 1 << 27, "too many leaves");
    assert!((1..=MAX_RUN).contains(&n), "leaf of {n}");
    kind << 30 | (first as u32) << 3 | (n as u32 - 1)
}

/// The run that a leaf names.
#[inline]
pub(super) const fn leaf_range(leaf: u32) -> Range<usize> {
    let first = (leaf << 2 >> 5) as usize;
    first..first + (leaf & 7) as usize + 1
}

/// Boxes of eight children, coordinate by coordinate.
#[derive(Clone, Copy, Debug)]
#[repr(C, align(32))]
pub(super) struct Node {
    /// Lower x, y, z, upper x, y, z.
    planes: [[f32; 8]; 6],
    /// See [`leaf`] and [`node_index`].
    pub(super) children: [u32; 8],
}

impl Node {
    /// A node without children: its boxes are missed by every ray.
    pub(super) const EMPTY: Self = Self {
        planes: [
            [f32::INFINITY; 8],
            [f32::INFINITY; 8],
            [f32::INFINITY; 8],
            [f32::NEG_INFINITY; 8],
            [f32::NEG_INFINITY; 8],
            [f32::NEG_INFINITY; 8],
        ],
        children: [EMPTY; 8],
    };

    /// Sets one child.
    pub(super) fn set(&mut self, slot: usize, bounds: &Box3, child: u32) {
        for axis in 0..3 {
            self.planes[axis][slot] = bounds.min[axis];
            self.planes[axis + 3][slot] = bounds.max[axis];
        }
        self.children[slot] = child;
    }

    /// The box of one child.
    #[cfg(test)]
    pub(super) fn child_bounds(&self, slot: usize) -> Box3 {
        let corner = |first: usize| std::array::from_fn(|axis| self.planes[first + axis][slot]);
        Box3 { min: corner(0), max: corner(3) }
    }

    /// Which children the ray meets with t in (0, `t_max`], one bit each, and where it enters them; `far` is `t_max`
    /// with room for rounding.
    ///
    /// The comparisons let NaN lose: 0 * infinity arises where a ray runs within a plane, and such a plane bounds
    /// nothing.
    #[inline(always)]
    pub(super) fn test<L: Lanes>(&self, lanes: L, ray: &TraversalRay, far: L::Floats) -> (u32, L::Floats) {
        let zero = lanes.splat(0.0);
        let [ex, ey, ez] = [self.enter(lanes, ray, 0), self.enter(lanes, ray, 1), self.enter(lanes, ray, 2)];
        let [lx, ly, lz] = [self.leave(lanes, ray, 0), self.leave(lanes, ray, 1), self.leave(lanes, ray, 2)];
        let near = lanes.max(lanes.max(ex, ey), lanes.max(ez, zero));
        let far = lanes.min(lanes.min(lx, ly), lanes.min(lz, far));
        (lanes.at_most(near, far), near)
    }

    #[inline(always)]
    fn enter<L: Lanes>(&self, lanes: L, ray: &TraversalRay, axis: usize) -> L::Floats {
        let plane = lanes.load(lanes.row(&self.planes, ray.planes[0][axis]));
        lanes.mul(lanes.sub(plane, lanes.splat(ray.near_origin[axis])), lanes.splat(ray.inverse[axis]))
    }

    #[inline(always)]
    fn leave<L: Lanes>(&self, lanes: L, ray: &TraversalRay, axis: usize) -> L::Floats {
        let plane = lanes.load(lanes.row(&self.planes, ray.planes[1][axis]));
        lanes.mul(lanes.sub(plane, lanes.splat(ray.far_origin[axis])), lanes.splat(ray.inverse_far[axis]))
    }
}
