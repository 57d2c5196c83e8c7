//! From the nodes of subtrees to the arrays that rays traverse.

use rayon::prelude::*;

use super::TriangleSource;
use super::primitive::BuildPrimitive;
use crate::bvh::node::{EMPTY, INNER, ITEMS, Node, TRIANGLES, leaf, leaf_range, node_index};
use crate::bvh::pages::vec_in_large_pages;
use crate::bvh::pair::Pair;
use crate::bvh::triangle_block::TriangleBlock;
use crate::bvh::{Bvh, PrimitiveRef};
use etendue_math::Bounds3;

/// Makes the tree from its nodes in order, in which children are named by their distance in the array and leaves
/// by their primitives. The blocks of a node lie together, in the order of nodes.
pub(super) fn assemble(
    chunks: Vec<Vec<Node>>,
    primitives: &[BuildPrimitive],
    bounds: Bounds3,
    source: &impl TriangleSource,
) -> Bvh {
    let mut nodes: Vec<Node> = vec_in_large_pages(chunks.iter().map(Vec::len).sum());
    let mut leaves = Leaves { blocks: Vec::with_capacity(primitives.len() / 3), items: Vec::new() };
    for chunk in chunks {
        for mut node in chunk {
            let place = |child| match child >> 30 {
                INNER => node_index(nodes.len() + child as usize),
                TRIANGLES => leaves.append_triangles(child),
                ITEMS => leaves.append_items(child, primitives),
                _ => EMPTY,
            };
            node.children = node.children.map(place);
            nodes.push(node);
        }
    }
    let block = |run: &u32| {
        let first = (run >> 2) as usize;
        let mut block = TriangleBlock::EMPTY;
        for (lane, primitive) in primitives[first..=first + (run & 3) as usize].iter().enumerate() {
            let first = primitive.reference();
            let second = if primitive.is_pair() { source.second(first) } else { None };
            block.set(lane, Pair { first, second }, |reference| source.corners(reference));
        }
        block
    };
    let mut blocks = vec_in_large_pages(leaves.blocks.len());
    leaves.blocks.par_iter().with_min_len(256).map(block).collect_into_vec(&mut blocks);
    leaves.items.shrink_to_fit();
    Bvh::new(nodes, blocks, leaves.items, bounds)
}

/// Contents of the leaves so far.
struct Leaves {
    /// First primitive of each block and, in the lowest two bits, the number of primitives less one.
    blocks: Vec<u32>,
    items: Vec<PrimitiveRef>,
}

impl Leaves {
    /// Turns a run of primitives into a run of blocks.
    fn append_triangles(&mut self, run: u32) -> u32 {
        let range = leaf_range(run);
        let first = self.blocks.len();
        let block = |start: usize| (start as u32) << 2 | ((range.end - start).min(4) as u32 - 1);
        self.blocks.extend(range.clone().step_by(4).map(block));
        leaf(TRIANGLES, first, range.len().div_ceil(4))
    }

    /// Turns a run of primitives into a run of items.
    fn append_items(&mut self, run: u32, primitives: &[BuildPrimitive]) -> u32 {
        let range = leaf_range(run);
        let first = self.items.len();
        self.items.extend(primitives[range.clone()].iter().map(BuildPrimitive::reference));
        leaf(ITEMS, first, range.len())
    }
}
