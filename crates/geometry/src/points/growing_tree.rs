//! A kd-tree that takes points one after the other and is never balanced (Bentley 1975; SPEC KD-12): what a photon map would be
//! if photons went into the tree as they come. Photons that arrive in an order, as those of a projection map do, make it deep.

use etendue_math::{Point3, mix64};

use super::found::{Neighbour, Neighbours, square_of_radius};
use super::item::Item;

/// No child.
const NONE: u32 = u32::MAX;

/// A kd-tree in order of arrival, cut along x, y and z in turn: 24 bytes a point.
#[derive(Clone, Debug, Default)]
pub struct GrowingTree {
    nodes: Vec<Node>,
    depth: usize,
}

#[derive(Clone, Copy, Debug)]
struct Node {
    item: Item,
    children: [u32; 2],
}

/// A node that waits for its other side.
#[derive(Clone, Copy, Debug)]
struct Waiting {
    node: u32,
    far: u32,
    far_axis: usize,
    delta_squared: f32,
}

impl GrowingTree {
    /// A tree of points that come in this order. Points that are not finite are left out. Takes O(n^2) if they come in sorted
    /// order.
    ///
    /// # Panics
    /// If there are 2^32 points or more.
    #[must_use]
    pub fn new(points: &[Point3]) -> Self {
        let mut tree = Self::default();
        for item in super::item::finite_items(points) {
            tree.insert(item);
        }
        tree
    }

    /// Number of levels.
    #[must_use]
    pub const fn depth(&self) -> usize {
        self.depth
    }

    /// Bytes on the heap.
    #[must_use]
    pub fn memory_bytes(&self) -> usize {
        crate::mesh::heap(&self.nodes)
    }

    fn insert(&mut self, item: Item) {
        let new = self.nodes.len() as u32;
        self.nodes.push(Node { item, children: [NONE; 2] });
        let (mut node, mut axis, mut depth) = (0, 0, 1);
        while node != new {
            let Node { item: here, children } = &mut self.nodes[node as usize];
            // On a plane all are equal along one axis, and go right: were they on both sides, both would be searched. Those at
            // the very same place go to either side, so that they do not make a list.
            let is_right = match item.p[axis].total_cmp(&here.p[axis]) {
                std::cmp::Ordering::Less => false,
                std::cmp::Ordering::Greater => true,
                std::cmp::Ordering::Equal if item.p != here.p => true,
                std::cmp::Ordering::Equal => mix64(u64::from(new) << 32 | u64::from(node)) & 1 == 1,
            };
            let child = &mut children[usize::from(is_right)];
            if *child == NONE {
                *child = new;
            }
            node = *child;
            axis = (axis + 1) % 3;
            depth += 1;
        }
        self.depth = self.depth.max(depth);
    }

    /// As [`PointTree::nearest`](super::PointTree::nearest).
    pub fn nearest(&self, p: Point3, k: usize, max_radius: f32, found: &mut Neighbours) {
        found.start(k, max_radius);
        if k > 0 {
            self.search(p, found, Neighbours::limit_squared, |found, item, d| found.offer(d, item.index));
        }
    }

    /// As [`PointTree::within`](super::PointTree::within).
    pub fn within(&self, p: Point3, radius: f32, mut visit: impl FnMut(Neighbour)) {
        let limit = square_of_radius(radius);
        let mut show = |item: &Item, d| visit(Neighbour { index: item.index, distance_squared: d });
        self.search(p, &mut (), |()| limit, |(), item, d| show(item, d));
    }

    fn search<S>(
        &self,
        p: Point3,
        state: &mut S,
        limit_squared: impl Fn(&S) -> f32,
        mut offer: impl FnMut(&mut S, &Item, f32),
    ) {
        let p = [p.x, p.y, p.z];
        // As deep as the tree, which may be as deep as it has points.
        let mut stack = Vec::with_capacity(64);
        let (mut node, mut axis) = (if self.nodes.is_empty() { NONE } else { 0 }, 0);
        loop {
            while node != NONE {
                let Node { item, children } = &self.nodes[node as usize];
                let delta = p[axis] - item.p[axis];
                let is_right = usize::from(delta >= 0.0);
                axis = (axis + 1) % 3;
                let far = children[1 - is_right];
                stack.push(Waiting { node, far, far_axis: axis, delta_squared: delta * delta });
                node = children[is_right];
            }
            let Some(waiting) = stack.pop() else { return };
            if waiting.delta_squared <= limit_squared(state) {
                let item = &self.nodes[waiting.node as usize].item;
                let distance_squared = item.square_of_distance(p);
                if distance_squared <= limit_squared(state) {
                    offer(state, item, distance_squared);
                }
                (node, axis) = (waiting.far, waiting.far_axis);
            }
        }
    }
}
