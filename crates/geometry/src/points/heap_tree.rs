//! The balanced kd-tree of the photon map (Jensen 2001, sections 6.3 and 6.4, appendix B; SPEC KD-6 to KD-8): one point in each
//! node, nodes in the order of a heap, so that those below node `i` (counted from 1) are `2 i` and `2 i + 1` and no pointers
//! are needed. A left-balanced tree fills its levels, the last one from the left, and has no holes in that order.
//!
//! Errata of the book's code: a node is left for `2 i` if `2 i <= N` and for `2 i + 1` if `2 i + 1 <= N`; the bound `N/2 - 1`
//! that stands there misses up to four points.

use etendue_math::Point3;

use super::found::{Neighbour, Neighbours, square_of_radius};
use super::item::{Item, finite_items, longest_axis};

/// Points that one thread puts in order.
const POINTS_PER_TASK: usize = 1 << 14;

/// Levels of a tree whose indices have 32 bits.
const STACK_SIZE: usize = 32;

/// A left-balanced kd-tree in heap order: 17 bytes a point.
#[derive(Clone, Debug, Default)]
pub struct HeapTree {
    /// Node `i` is number `i - 1`.
    pub(super) nodes: Vec<Item>,
    pub(super) axes: Vec<u8>,
}

/// How many of `n` points, at least one, come before the root of their left-balanced tree. The rank of the root, counted from 1,
/// is `2 m` or `n - m + 1`, where `m` is the least power of two with `4 m > n` (SPEC KD-7).
pub(super) const fn n_left(n: usize) -> usize {
    let mut m = 1;
    while 4 * m <= n {
        m *= 2;
    }
    let rank = if 3 * m <= n { 2 * m } else { n - m + 1 };
    rank - 1
}

impl HeapTree {
    /// A tree of points, built in parallel on the current rayon pool in O(n log n). Points that are not finite are left out.
    ///
    /// # Panics
    /// If there are 2^32 points or more.
    #[must_use]
    pub fn new(points: &[Point3]) -> Self {
        let mut items = finite_items(points);
        let mut axes_in_order = vec![0; items.len()];
        sort_into_tree(&mut items, &mut axes_in_order);
        let (mut nodes, mut axes) = (Vec::with_capacity(items.len()), Vec::with_capacity(items.len()));
        // Ranges of points, in the order of the nodes that are their roots.
        let mut level: Vec<_> = std::iter::once(0..items.len()).collect();
        while !level.is_empty() {
            let mut next = Vec::with_capacity(2 * level.len());
            for range in level {
                if range.is_empty() {
                    continue;
                }
                let root = range.start + n_left(range.len());
                nodes.push(items[root]);
                axes.push(axes_in_order[root]);
                next.extend([range.start..root, root + 1..range.end]);
            }
            level = next;
        }
        Self { nodes, axes }
    }

    /// Bytes on the heap.
    #[must_use]
    pub fn memory_bytes(&self) -> usize {
        crate::mesh::heap(&self.nodes) + crate::mesh::heap(&self.axes)
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

    /// Visits the points that are no farther than the limit: near sides first, far sides and the points on the planes between if
    /// the planes are near enough.
    #[inline(always)]
    fn search<S>(
        &self,
        p: Point3,
        state: &mut S,
        limit_squared: impl Fn(&S) -> f32,
        mut offer: impl FnMut(&mut S, &Item, f32),
    ) {
        let (n, p) = (self.nodes.len(), [p.x, p.y, p.z]);
        let mut stack = [(0, 0, 0.0); STACK_SIZE];
        let (mut n_stacked, mut node) = (0, 1);
        loop {
            while node <= n {
                let axis = usize::from(self.axes[node - 1]);
                let delta = p[axis] - self.nodes[node - 1].p[axis];
                let is_right = usize::from(delta >= 0.0);
                stack[n_stacked % STACK_SIZE] = (node, 2 * node + 1 - is_right, delta * delta);
                n_stacked += 1;
                node = 2 * node + is_right;
            }
            node = loop {
                if n_stacked == 0 {
                    return;
                }
                n_stacked -= 1;
                let (node, far, delta_squared) = stack[n_stacked % STACK_SIZE];
                if delta_squared <= limit_squared(state) {
                    let item = &self.nodes[node - 1];
                    let distance_squared = item.square_of_distance(p);
                    if distance_squared <= limit_squared(state) {
                        offer(state, item, distance_squared);
                    }
                    break far;
                }
            };
        }
    }
}

/// Sorts points so that the root of each part is where its left-balanced tree wants it, smaller ones before and greater ones
/// behind it along the longest axis, which is noted for it.
fn sort_into_tree(items: &mut [Item], axes: &mut [u8]) {
    if items.len() < 2 {
        return;
    }
    let axis = longest_axis(items);
    let root = n_left(items.len());
    items.select_nth_unstable_by(root, |a, b| a.p[axis].total_cmp(&b.p[axis]));
    axes[root] = axis as u8;
    let is_large = items.len() > POINTS_PER_TASK;
    let (before, behind) = items.split_at_mut(root);
    let (axes_before, axes_behind) = axes.split_at_mut(root);
    let mut sort_before = || sort_into_tree(before, axes_before);
    let mut sort_behind = || sort_into_tree(&mut behind[1..], &mut axes_behind[1..]);
    if is_large {
        rayon::join(sort_before, sort_behind);
    } else {
        sort_before();
        sort_behind();
    }
}
