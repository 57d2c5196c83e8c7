//! A bounding volume hierarchy over triangles and other items (SPEC ACC-2).
//!
//! Nodes have eight children whose boxes lie side by side in memory, so that they are tested
//! at once; leaves hold blocks of eight triangles, in four pairs, in the same manner. One ray at a time descends nearest child
//! first (Wald, Benthin and Boulos 2008, "Getting Rid of Packets"). The tree is built with the surface area
//! heuristic over 32 bins (Wald 2007, "On fast Construction of SAH-based Bounding Volume Hierarchies"). The file
//! `ray.rs` prepares a ray, `traverse.rs` descends, `triangle_block.rs` intersects eight triangles; `lanes.rs` and
//! `wide.rs` have the arithmetic that both are written in, portable and by AVX2.

mod build;
mod lanes;
mod node;
mod pages;
mod pair;
mod ray;
mod refit;
mod traverse;
mod triangle_block;
#[cfg(target_arch = "x86_64")]
mod wide;

#[cfg(test)]
mod tests;

pub(crate) use build::{Box3, BuildPrimitive, TriangleSource, build};
pub(crate) use pages::vec_in_large_pages;
pub(crate) use pair::{append_pairs, second_of};
pub(crate) use ray::{TraversalRay, WideBounds, WideRay};

use etendue_math::{Bounds3, Ray};
use node::{INNER, ITEMS, Node, TRIANGLES, leaf_range};
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
pub(crate) trait Visitor<'a> {
    /// True where any hit will do, so that the order of visits matters little.
    const ANY: bool;
    /// A triangle is hit at `t`; `b` are the weights of its second and third vertex.
    fn triangle(&mut self, triangle: PrimitiveRef, t: f32, b: [f32; 2]) -> Verdict;
    /// The ray meets the box of an item that is no instance no farther than `t_max`.
    fn shape(&mut self, item: PrimitiveRef, t_max: f32) -> Verdict;
    /// The ray meets the box of an instance: what follows is in its group, until it leaves.
    fn enter(&mut self, instance: u32) -> (&'a Bvh, WideRay);
    /// What follows is in the world again.
    fn leave(&mut self);
    /// The children of a node are about to be tested.
    fn note_node(&mut self);
    /// A block of triangles is about to be tested; how many it holds is told on request.
    fn note_block(&mut self, n_triangles: impl FnOnce() -> u32);
}

/// What processors keep near at hand, roughly: a first-level cache and some of the second. Below this size announcing nodes
/// costs more than it gains.
const NEAR_CACHE_BYTES: usize = 128 << 10;

/// The tree. Its root is node 0; no node at all means no primitive.
#[derive(Debug, Default)]
pub(crate) struct Bvh {
    nodes: Vec<Node>,
    blocks: Vec<TriangleBlock>,
    items: Vec<PrimitiveRef>,
    bounds: WideBounds,
    /// True where nodes and blocks need more than the processor has near at hand.
    exceeds_cache: bool,
}

impl Bvh {
    /// Puts a tree together. Checks once what traversal relies on: children exist and come after their parents, and
    /// the tree is not too deep.
    fn new(nodes: Vec<Node>, blocks: Vec<TriangleBlock>, items: Vec<PrimitiveRef>, bounds: Bounds3) -> Self {
        let mut depths = vec![0_u8; nodes.len()];
        for (index, node) in nodes.iter().enumerate() {
            let depth = depths[index] + 1;
            assert!(usize::from(depth) * 7 < traverse::MAX_TREE_STACK, "the tree is too deep");
            for child in node.children {
                match child >> 30 {
                    INNER => {
                        assert!(child as usize > index, "a child stands before its parent");
                        depths[child as usize] = depth;
                    }
                    TRIANGLES => assert!(leaf_range(child).end <= blocks.len(), "a leaf without triangles"),
                    ITEMS => assert!(leaf_range(child).end <= items.len(), "a leaf without items"),
                    _ => {}
                }
            }
        }
        let n_bytes = size_of_val(&nodes[..]) + size_of_val(&blocks[..]);
        Self { nodes, blocks, items, bounds: bounds.into(), exceeds_cache: n_bytes > NEAR_CACHE_BYTES }
    }

    /// A tree without nodes that stands for another structure with this box.
    pub(crate) fn placeholder(bounds: Bounds3) -> Self {
        Self { bounds: bounds.into(), ..Self::default() }
    }

    /// Box around all primitives.
    pub(crate) fn bounds(&self) -> Bounds3 {
        self.bounds.into()
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
}

/// The code that traverses: portable, or for the instructions that the processor has. The answers are the same, bit for bit.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Kernel {
    #[cfg(target_arch = "x86_64")]
    avx2: Option<wide::Avx2>,
}

impl Kernel {
    /// Asks the processor.
    pub(crate) fn detect() -> Self {
        Self {
            #[cfg(target_arch = "x86_64")]
            avx2: wide::Avx2::detect(),
        }
    }

    /// Works everywhere.
    pub(crate) const PORTABLE: Self = Self {
        #[cfg(target_arch = "x86_64")]
        avx2: None,
    };

    /// True if it needs AVX2.
    pub(crate) const fn is_avx2(self) -> bool {
        #[cfg(target_arch = "x86_64")]
        return self.avx2.is_some();
        #[cfg(not(target_arch = "x86_64"))]
        false
    }

    /// Shows the visitor every primitive of the tree that the ray may hit with t in (0, `t_max`], near ones first.
    #[inline(always)]
    pub(crate) fn traverse<'a>(self, bvh: &'a Bvh, ray: &Ray, t_max: f32, visitor: &mut impl Visitor<'a>) {
        #[cfg(target_arch = "x86_64")]
        if let Some(lanes) = self.avx2 {
            lanes.traverse(bvh, ray, t_max, visitor);
            return;
        }
        traverse_portably(bvh, ray, t_max, visitor);
    }
}

#[inline(never)]
fn traverse_portably<'a>(bvh: &'a Bvh, ray: &Ray, t_max: f32, visitor: &mut impl Visitor<'a>) {
    traverse::traverse(lanes::Portable, bvh, ray, t_max, visitor);
}

/// The test of the leaves on a single triangle: t and the weights of the second and third vertex.
pub(crate) fn intersect_triangle(ray: &Ray, triangle: &[[f32; 3]; 3]) -> Option<(f32, [f32; 2])> {
    let prepared = TraversalRay::new(&ray.into(), &Bounds3 { min: ray.origin, max: ray.origin }.into())?;
    intersect_prepared(&prepared, triangle)
}

/// The same for a ray that is ready.
pub(crate) fn intersect_prepared(ray: &TraversalRay, triangle: &[[f32; 3]; 3]) -> Option<(f32, [f32; 2])> {
    triangle_block::intersect(ray, triangle)
}
