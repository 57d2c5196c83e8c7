//! A bounding volume hierarchy over triangles and other items (SPEC ACC-2).
//!
//! Nodes have eight children whose boxes lie side by side in memory, so that one loop over arrays of eight tests
//! them all; leaves hold blocks of four triangles in the same manner. One ray at a time descends nearest child
//! first (Wald, Benthin and Boulos 2008, "Getting Rid of Packets"). The tree is built with the surface area
//! heuristic over 32 bins (Wald 2007, "On fast Construction of SAH-based Bounding Volume Hierarchies"). The file
//! `ray.rs` prepares a ray, `triangle_block.rs` intersects four triangles.

mod build;
mod node;
mod ray;
mod triangle_block;

#[cfg(test)]
mod tests;

pub(crate) use build::{BuildPrimitive, build};
pub(crate) use ray::TraversalRay;

use etendue_math::{Bounds3, Ray};
use node::{EMPTY, INNER, ITEMS, Node, TRIANGLES, leaf_range, node_index};
use triangle_block::TriangleBlock;

/// Value of [`PrimitiveRef::geometry`] that marks an instance; its index is then in `primitive`.
pub(crate) const INSTANCE: u32 = u32::MAX;

/// What a leaf refers to.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct PrimitiveRef {
    /// Index of the entity, or [`INSTANCE`].
    pub(crate) geometry: u32,
    /// Triangle or patch of the entity, or the instance.
    pub(crate) primitive: u32,
}

/// What the visitor makes of a candidate.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Verdict {
    /// No hit: go on as before.
    Pass,
    /// A hit at this t: look only for nearer ones.
    Shorten(f32),
    /// The question is answered.
    Stop,
}

/// Receives what a ray may hit, roughly front to back.
pub(crate) trait Visitor {
    /// A triangle is hit at `t`; `b` are the weights of its second and third vertex.
    fn triangle(&mut self, triangle: PrimitiveRef, t: f32, b: [f32; 2]) -> Verdict;
    /// The ray meets the box of an item nearer than `t_max`.
    fn item(&mut self, item: PrimitiveRef, t_max: f32) -> Verdict;
}

/// The tree. Its root is node 0; no node at all means no primitive.
#[derive(Debug, Default)]
pub(crate) struct Bvh {
    nodes: Vec<Node>,
    blocks: Vec<TriangleBlock>,
    items: Vec<PrimitiveRef>,
    bounds: Bounds3,
}

/// Entries of the traversal stack that need no allocation.
const STACK_SIZE: usize = 64;

/// Nodes still to visit with the ray parameter where the ray enters them.
struct Stack {
    entries: [(u32, f32); STACK_SIZE],
    len: usize,
    /// For degenerate trees; empty otherwise.
    spill: Vec<(u32, f32)>,
}

impl Stack {
    #[inline]
    fn new() -> Self {
        Self { entries: [(EMPTY, 0.0); STACK_SIZE], len: 0, spill: Vec::new() }
    }

    #[inline]
    fn push(&mut self, entry: (u32, f32)) {
        if let Some(slot) = self.entries.get_mut(self.len) {
            *slot = entry;
            self.len += 1;
        } else {
            self.spill.push(entry);
        }
    }

    #[inline]
    fn pop(&mut self) -> Option<(u32, f32)> {
        if let Some(entry) = self.spill.pop() {
            return Some(entry);
        }
        self.len = self.len.checked_sub(1)?;
        Some(self.entries[self.len & (STACK_SIZE - 1)])
    }
}

impl Bvh {
    /// Box around all primitives.
    pub(crate) const fn bounds(&self) -> Bounds3 {
        self.bounds
    }

    /// Number of inner nodes.
    pub(crate) const fn n_nodes(&self) -> usize {
        self.nodes.len()
    }

    /// Bytes on the heap.
    pub(crate) fn memory_bytes(&self) -> usize {
        use crate::mesh::heap;
        heap(&self.nodes) + heap(&self.blocks) + heap(&self.items)
    }

    /// Shows the visitor every primitive that the ray may hit with t in (0, `t_max`), near ones first.
    #[inline]
    pub(crate) fn traverse(&self, ray: &TraversalRay, t_max: f32, visitor: &mut impl Visitor) {
        if self.nodes.is_empty() {
            return;
        }
        let mut t_max = t_max;
        let mut stack = Stack::new();
        let mut current = node_index(0);
        loop {
            let descended = match current >> 30 {
                INNER => self.descend(current, ray, t_max, &mut stack),
                TRIANGLES => match self.visit_triangles(current, ray, t_max, visitor) {
                    Some(shorter) => {
                        t_max = shorter;
                        None
                    }
                    None => return,
                },
                ITEMS => match self.visit_items(current, t_max, visitor) {
                    Some(shorter) => {
                        t_max = shorter;
                        None
                    }
                    None => return,
                },
                _ => None,
            };
            current = match descended {
                Some(child) => child,
                None => loop {
                    match stack.pop() {
                        None => return,
                        Some((child, t)) if t < t_max => break child,
                        Some(_) => {}
                    }
                },
            };
        }
    }

    /// Tests the children of a node; returns the nearest and stacks the others, the farthest lowest.
    #[inline(always)]
    fn descend(&self, node: u32, ray: &TraversalRay, t_max: f32, stack: &mut Stack) -> Option<u32> {
        let node = &self.nodes[node as usize];
        let (mut mask, near) = node.test(ray, t_max);
        if mask == 0 {
            return None;
        }
        let mut take = || {
            let child = mask.trailing_zeros() as usize & 7;
            mask &= mask - 1;
            ((node.children[child], near[child]), mask)
        };
        let (mut first, rest) = take();
        if rest == 0 {
            return Some(first.0);
        }
        let (mut second, rest) = take();
        if second.1 < first.1 {
            std::mem::swap(&mut first, &mut second);
        }
        if rest == 0 {
            stack.push(second);
            return Some(first.0);
        }
        let mut sorted = [(EMPTY, 0.0); 8];
        sorted[0] = second;
        sorted[1] = first;
        let mut n = 2;
        loop {
            let (entry, rest) = take();
            let mut slot = n;
            while slot > 0 && sorted[slot - 1].1 < entry.1 {
                sorted[slot] = sorted[slot - 1];
                slot -= 1;
            }
            sorted[slot] = entry;
            n += 1;
            if rest == 0 {
                break;
            }
        }
        for entry in &sorted[..n - 1] {
            stack.push(*entry);
        }
        Some(sorted[n - 1].0)
    }

    /// Tests the triangles of a leaf; returns the new end of the ray, `None` to stop.
    #[inline(always)]
    fn visit_triangles(
        &self,
        leaf: u32,
        ray: &TraversalRay,
        t_max: f32,
        visitor: &mut impl Visitor,
    ) -> Option<f32> {
        let mut t_max = t_max;
        for block in &self.blocks[leaf_range(leaf)] {
            let (mut mask, lanes) = block.intersect(ray, t_max);
            while mask != 0 {
                let lane = mask.trailing_zeros() as usize & 3;
                mask &= mask - 1;
                if lanes.t[lane] >= t_max {
                    continue;
                }
                match visitor.triangle(block.reference(lane), lanes.t[lane], [lanes.b1[lane], lanes.b2[lane]])
                {
                    Verdict::Pass => {}
                    Verdict::Shorten(t) => t_max = t,
                    Verdict::Stop => return None,
                }
            }
        }
        Some(t_max)
    }

    /// Shows the items of a leaf; returns the new end of the ray, `None` to stop.
    #[inline]
    fn visit_items(&self, leaf: u32, t_max: f32, visitor: &mut impl Visitor) -> Option<f32> {
        let mut t_max = t_max;
        for item in &self.items[leaf_range(leaf)] {
            match visitor.item(*item, t_max) {
                Verdict::Pass => {}
                Verdict::Shorten(t) => t_max = t,
                Verdict::Stop => return None,
            }
        }
        Some(t_max)
    }
}

/// The test of the leaves on a single triangle: t and the weights of the second and third vertex.
pub(crate) fn intersect_triangle(ray: &Ray, triangle: &[[f32; 3]; 3]) -> Option<(f32, [f32; 2])> {
    let prepared = TraversalRay::new(ray, &Bounds3 { min: ray.origin, max: ray.origin })?;
    let mut block = TriangleBlock::EMPTY;
    block.set(0, PrimitiveRef { geometry: 0, primitive: 0 }, triangle);
    let (mask, lanes) = block.intersect(&prepared, f32::INFINITY);
    (mask != 0).then_some((lanes.t[0], [lanes.b1[0], lanes.b2[0]]))
}
