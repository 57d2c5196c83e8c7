//! One ray through the tree, the same for every instruction set.
//!
//! Children that the ray meets are visited nearest first; those behind the nearest hit so far are dropped when their turn
//! comes. Where any hit will do, the farthest comes first: the nearest boxes of a shadow ray are mostly those of the surface
//! that it leaves. Those that have to wait are announced to the processor, which fetches them meanwhile. Everything here is inlined into functions that are compiled for one instruction set each.

use super::lanes::{Lanes, Stack};
use super::node::{self, EMPTY, INNER, ITEMS, Node, TRIANGLES, leaf_range};
use super::triangle_block::{Hits, TriangleBlock};
use super::{Bvh, INSTANCE, TraversalRay, Verdict, Visitor, WideRay};
use etendue_math::Ray;

/// No descent into one tree stacks more entries: seven for each level of a tree as deep as `build.rs` lets it become, and one
/// for the rest of a leaf.
pub(super) const MAX_TREE_STACK: usize = 256;
/// Entries of the world and of an instance.
pub(super) const MAX_STACK: usize = 2 * MAX_TREE_STACK;

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

    /// A child that is never dropped.
    #[inline(always)]
    const fn at_once(child: u32) -> Self {
        Self(child as u64)
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
///
/// An instance is entered on the same stack: its entries lie above those of the world, and when they are used up, the world's
/// ray and tree come back.
#[inline(always)]
pub(super) fn traverse<'a, L: Lanes, V: Visitor<'a>>(
    lanes: L,
    world: &'a Bvh,
    ray: &Ray,
    t_max: f32,
    visitor: &mut V,
) {
    // Borrowed where it lies: it is large.
    let world_ray = prepared(world, &ray.into());
    let Some(world_ray) = &world_ray else { return };
    let mut instance_ray;
    let (mut bvh, mut ray) = (world, world_ray);
    let mut end = t_max;
    let (mut stack, mut len) = (L::Stack::new(), 0);
    // Entries from here on belong to the instance, or to the world where there are none below.
    let mut floor = 0;
    let mut current = 0;
    loop {
        current = match current >> 30 {
            INNER => {
                visitor.note_node();
                descend::<L, V>(lanes, bvh, current, ray, end, &mut stack, &mut len)
            }
            TRIANGLES => {
                if !visit_triangles(lanes, bvh, current, ray, &mut end, visitor) {
                    return;
                }
                EMPTY
            }
            _ => match visit_items(bvh, current, &mut end, &mut stack, &mut len, visitor) {
                Items::Stop => return,
                Items::Done => EMPTY,
                Items::Instance(instance) => {
                    // The stack has room for two trees.
                    debug_assert!(std::ptr::eq(bvh, world), "an instance holds instances");
                    let (group, group_ray) = visitor.enter(instance);
                    match prepared(group, &group_ray) {
                        None => {
                            visitor.leave();
                            EMPTY
                        }
                        Some(prepared) => {
                            instance_ray = prepared;
                            (bvh, ray, floor) = (group, &instance_ray, len);
                            0
                        }
                    }
                }
            },
        };
        while current == EMPTY {
            if len == floor {
                if floor == 0 {
                    return;
                }
                visitor.leave();
                (bvh, ray, floor) = (world, world_ray, 0);
            }
            len -= 1;
            let entry = stack.read(len);
            if V::ANY || entry.t() <= end {
                current = entry.child();
            }
        }
    }
}

/// The ray made ready for a tree; `None` where it meets nothing.
#[inline(always)]
fn prepared(bvh: &Bvh, ray: &WideRay) -> Option<TraversalRay> {
    if bvh.nodes.is_empty() { None } else { TraversalRay::new(ray, &bvh.bounds) }
}

/// Tests the children of a node; returns the nearest and stacks the others, the farthest lowest. For any hit it returns the
/// farthest.
#[inline(always)]
fn descend<'a, L: Lanes, V: Visitor<'a>>(
    lanes: L,
    bvh: &Bvh,
    node: u32,
    ray: &TraversalRay,
    end: f32,
    stack: &mut L::Stack,
    len: &mut usize,
) -> u32 {
    // Otherwise compilers broadcast the numbers of the ray before the loop, only to spill them.
    let ray = std::hint::black_box(ray);
    let node = lanes.node(bvh, node);
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
        let (nearer, mut last) = first.sorted(second);
        rest &= rest - 1;
        push(stack, len, nearer);
        lanes.expect(bvh, nearer.child());
        while rest != 0 {
            let (nearer, farther) = last.sorted(Entry::of(node, &near, rest));
            push(stack, len, nearer);
            lanes.expect(bvh, nearer.child());
            last = farther;
            rest &= rest - 1;
        }
        return last.child();
    }
    let (mut first, second) = first.sorted(second);
    rest &= rest - 1;
    let start = *len;
    push(stack, len, second);
    lanes.expect(bvh, second.child());
    while rest != 0 {
        let entry = Entry::of(node, &near, rest);
        rest &= rest - 1;
        let (nearer, farther) = first.sorted(entry);
        insert(stack, start, len, farther);
        lanes.expect(bvh, farther.child());
        first = nearer;
    }
    first.child()
}

#[inline(always)]
fn push(stack: &mut impl Stack, len: &mut usize, entry: Entry) {
    stack.write(*len, entry);
    *len += 1;
}

/// Puts an entry among those from `start` on, which stand in falling order.
#[inline(always)]
fn insert(stack: &mut impl Stack, start: usize, len: &mut usize, entry: Entry) {
    let mut slot = *len;
    while slot > start && stack.read(slot - 1).is_before(entry) {
        stack.write(slot, stack.read(slot - 1));
        slot -= 1;
    }
    stack.write(slot, entry);
    *len += 1;
}

/// Tests the triangles of a leaf, which may bring the end of the ray nearer; false to stop.
#[inline(always)]
fn visit_triangles<'a, L: Lanes>(
    lanes: L,
    bvh: &Bvh,
    leaf: u32,
    ray: &TraversalRay,
    end: &mut f32,
    visitor: &mut impl Visitor<'a>,
) -> bool {
    for block in lanes.blocks(bvh, leaf) {
        visitor.note_block(|| block.n_triangles());
        let t_max = *end;
        let found = |mask, hits: &Hits| visit_hits(block, mask, hits, end, visitor);
        if block.intersect(lanes, ray, t_max, found) == Some(false) {
            return false;
        }
    }
    true
}

/// Shows the triangles of a block that are hit; false to stop.
#[inline(always)]
fn visit_hits<'a>(
    block: &TriangleBlock,
    mut mask: u32,
    hits: &Hits,
    end: &mut f32,
    visitor: &mut impl Visitor<'a>,
) -> bool {
    while mask != 0 {
        let lane = mask.trailing_zeros() as usize & 7;
        mask &= mask - 1;
        let t = hits.t[lane];
        if t > *end {
            continue;
        }
        match visitor.triangle(block.reference(lane), t, block.weights(lane, hits)) {
            Verdict::Pass => {}
            Verdict::Shorten(t) => *end = t,
            Verdict::Stop => return false,
        }
    }
    true
}

/// What to do after the items of a leaf.
enum Items {
    Done,
    Stop,
    /// To enter; the items behind it are stacked.
    Instance(u32),
}

/// Shows the items of a leaf up to the first instance; they may bring the end of the ray nearer.
#[inline(always)]
fn visit_items<'a>(
    bvh: &Bvh,
    leaf: u32,
    end: &mut f32,
    stack: &mut impl Stack,
    len: &mut usize,
    visitor: &mut impl Visitor<'a>,
) -> Items {
    debug_assert!(leaf >> 30 == ITEMS);
    let mut range = leaf_range(leaf);
    while let Some(index) = range.next() {
        let item = bvh.items[index];
        if item.geometry == INSTANCE {
            if !range.is_empty() {
                push(stack, len, Entry::at_once(node::leaf(ITEMS, range.start, range.len())));
            }
            return Items::Instance(item.primitive);
        }
        match visitor.shape(item, *end) {
            Verdict::Pass => {}
            Verdict::Shorten(t) => *end = t,
            Verdict::Stop => return Items::Stop,
        }
    }
    Items::Done
}
