//! One ray through the tree, the same for every instruction set.
//!
//! Children that the ray meets are visited nearest first; those behind the nearest hit so far are dropped when their turn
//! comes. Everything here is inlined into functions that are compiled for one instruction set each.

use super::lanes::{Lanes, Stack};
use super::node::{EMPTY, INNER, ITEMS, Node, TRIANGLES, leaf_range};
use super::triangle_block::Hits;
use super::{Bvh, TraversalRay, Verdict, Visitor};
use etendue_math::Ray;

/// No descent stacks more entries: seven for each level of a tree as deep as `build.rs` lets it become.
pub(super) const MAX_STACK: usize = 256;

/// A node or leaf still to visit, behind the ray parameter where the ray enters it: bits of floats that are not negative
/// order like the floats, and ties go to the child.
#[derive(Clone, Copy, Debug)]
pub(super) struct Entry(u64);

impl Entry {
    /// Behind all others.
    pub(super) const LAST: Self = Self(u64::MAX);

    #[inline(always)]
    fn sorted(self, other: Self) -> (Self, Self) {
        if self.0 <= other.0 { (self, other) } else { (other, self) }
    }

    #[inline(always)]
    pub(super) const fn is_before(self, other: Self) -> bool {
        self.0 < other.0
    }

    /// The first child of a mask.
    #[inline(always)]
    const fn of(node: &Node, near: &[f32; 8], mask: u32) -> Self {
        let child = mask.trailing_zeros() as usize & 7;
        Self((near[child].to_bits() as u64) << 32 | node.children[child] as u64)
    }

    #[inline(always)]
    const fn child(self) -> u32 {
        self.0 as u32
    }

    #[inline(always)]
    const fn t(self) -> f32 {
        f32::from_bits((self.0 >> 32) as u32)
    }
}

/// See [`super::Kernel::traverse`].
#[inline(always)]
pub(super) fn traverse<L: Lanes, V: Visitor>(lanes: L, bvh: &Bvh, ray: &Ray, t_max: f32, visitor: &mut V) {
    if bvh.nodes.is_empty() {
        return;
    }
    let Some(ray) = TraversalRay::new(ray, &bvh.bounds) else { return };
    let ray = &ray;
    let mut end = t_max;
    let mut stack = L::Stack::new();
    let mut current = 0;
    loop {
        let descended = match current >> 30 {
            INNER => {
                visitor.note_node();
                descend::<L, V>(lanes, lanes.node(bvh, current), ray, end, &mut stack)
            }
            TRIANGLES => {
                if !visit_triangles(lanes, bvh, current, ray, &mut end, visitor) {
                    return;
                }
                EMPTY
            }
            _ => {
                if !visit_items(bvh, current, &mut end, visitor) {
                    return;
                }
                EMPTY
            }
        };
        current = descended;
        while current == EMPTY {
            match stack.pop() {
                None => return,
                Some(entry) if entry.t() <= end => current = entry.child(),
                Some(_) => {}
            }
        }
    }
}

/// Tests the children of a node; returns the nearest and stacks the others, the farthest lowest.
#[inline(always)]
fn descend<L: Lanes, V: Visitor>(
    lanes: L,
    node: &Node,
    ray: &TraversalRay,
    end: f32,
    stack: &mut L::Stack,
) -> u32 {
    // Otherwise compilers broadcast the numbers of the ray before the loop, only to spill them.
    let ray = std::hint::black_box(ray);
    let (mask, near) = node.test(lanes, ray, lanes.splat(end * TraversalRay::WIDEN));
    if mask == 0 {
        return EMPTY;
    }
    let near = lanes.store(near);
    let first = Entry::of(node, &near, mask);
    let mut rest = mask & (mask - 1);
    if rest == 0 {
        return first.child();
    }
    let second = Entry::of(node, &near, rest);
    if V::ANY {
        let mut last = second;
        rest &= rest - 1;
        stack.push(first);
        while rest != 0 {
            stack.push(last);
            last = Entry::of(node, &near, rest);
            rest &= rest - 1;
        }
        return last.child();
    }
    let (mut first, second) = first.sorted(second);
    rest &= rest - 1;
    let start = stack.len();
    stack.push(second);
    while rest != 0 {
        let entry = Entry::of(node, &near, rest);
        rest &= rest - 1;
        let (nearer, farther) = first.sorted(entry);
        stack.insert(start, farther);
        first = nearer;
    }
    first.child()
}

/// Tests the triangles of a leaf, which may bring the end of the ray nearer; false to stop.
#[inline(always)]
fn visit_triangles<L: Lanes>(
    lanes: L,
    bvh: &Bvh,
    leaf: u32,
    ray: &TraversalRay,
    end: &mut f32,
    visitor: &mut impl Visitor,
) -> bool {
    let mut hits = Hits::NONE;
    for block in lanes.blocks(bvh, leaf) {
        visitor.note_block();
        let mut mask = block.intersect(lanes, ray, *end, &mut hits);
        while mask != 0 {
            let lane = mask.trailing_zeros() as usize & 7;
            mask &= mask - 1;
            let t = hits.t[lane];
            if t > *end {
                continue;
            }
            match visitor.triangle(block.reference(lane), t, block.weights(lane, &hits)) {
                Verdict::Pass => {}
                Verdict::Shorten(t) => *end = t,
                Verdict::Stop => return false,
            }
        }
    }
    true
}

/// Shows the items of a leaf, which may bring the end of the ray nearer; false to stop.
#[inline(always)]
fn visit_items(bvh: &Bvh, leaf: u32, end: &mut f32, visitor: &mut impl Visitor) -> bool {
    debug_assert!(leaf >> 30 == ITEMS);
    for item in &bvh.items[leaf_range(leaf)] {
        match visitor.item(*item, *end) {
            Verdict::Pass => {}
            Verdict::Shorten(t) => *end = t,
            Verdict::Stop => return false,
        }
    }
    true
}
