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
pub(super) const MAX_STACK: usize = 400;

/// See [`super::Kernel::traverse`].
#[inline(always)]
pub(super) fn traverse<L: Lanes>(lanes: L, bvh: &Bvh, ray: &Ray, t_max: f32, visitor: &mut impl Visitor) {
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
            INNER => descend(lanes, lanes.node(bvh, current), ray, end, &mut stack),
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
                Some((child, t)) if t <= end => current = child,
                Some(_) => {}
            }
        }
    }
}

/// Tests the children of a node; returns the nearest and stacks the others, the farthest lowest.
#[inline(always)]
fn descend<L: Lanes>(lanes: L, node: &Node, ray: &TraversalRay, end: f32, stack: &mut L::Stack) -> u32 {
    let (mask, near) = node.test(lanes, ray, lanes.splat(end * TraversalRay::WIDEN));
    if mask == 0 {
        return EMPTY;
    }
    let near = lanes.store(near);
    let (mut first, mask) = take(node, &near, mask);
    if mask == 0 {
        return first.0;
    }
    let (mut second, mut mask) = take(node, &near, mask);
    if second.1 < first.1 {
        std::mem::swap(&mut first, &mut second);
    }
    if mask == 0 {
        stack.push(second);
        return first.0;
    }
    let mut sorted = [(EMPTY, 0.0); 8];
    sorted[0] = second;
    sorted[1] = first;
    let mut n = 2;
    while mask != 0 {
        let entry;
        (entry, mask) = take(node, &near, mask);
        let mut slot = n & 7;
        while slot > 0 && sorted[slot - 1].1 < entry.1 {
            sorted[slot] = sorted[slot - 1];
            slot -= 1;
        }
        sorted[slot] = entry;
        n += 1;
    }
    for entry in &sorted[..(n - 1) & 7] {
        stack.push(*entry);
    }
    sorted[(n - 1) & 7].0
}

/// The first child of a mask, and the mask without it.
#[inline(always)]
const fn take(node: &Node, near: &[f32; 8], mask: u32) -> ((u32, f32), u32) {
    let child = mask.trailing_zeros() as usize & 7;
    ((node.children[child], near[child]), mask & (mask - 1))
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
