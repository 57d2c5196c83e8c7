//! New boxes for primitives that moved: the tree keeps its shape, so that its quality falls the more the primitives
//! change places, but its answers are those of a new one.

use rayon::prelude::*;

use super::build::Box3;
use super::node::{EMPTY, INNER, TRIANGLES, leaf_range};
use super::triangle_block::TriangleBlock;
use super::{Bvh, PrimitiveRef};
use etendue_math::{Bounds3, Point3};

impl Bvh {
    /// Reads all primitives anew. `corners` and `item_bounds` give where they are, `None` for what cannot be hit.
    ///
    /// Returns the number of triangles, or `None` where the tree no longer fits and has to be built anew: something
    /// cannot be hit any longer, or the triangles of a pair have come apart.
    pub(crate) fn refit(
        &mut self,
        corners: &(impl Fn(PrimitiveRef) -> Option<[[f32; 3]; 3]> + Sync),
        item_bounds: &impl Fn(PrimitiveRef) -> Option<Bounds3>,
    ) -> Option<usize> {
        let blocks: Vec<(Box3, usize)> =
            self.blocks.par_iter_mut().map(|block| refit_block(block, corners)).collect::<Option<_>>()?;
        let items: Vec<Box3> =
            self.items.iter().map(|item| item_bounds(*item).map(Box3::from)).collect::<Option<_>>()?;
        // Children stand behind their parents.
        let mut bounds = vec![Box3::EMPTY; self.nodes.len()];
        for (index, node) in self.nodes.iter_mut().enumerate().rev() {
            for slot in 0..8 {
                let child = node.children[slot];
                let own = match child >> 30 {
                    INNER => bounds[child as usize],
                    TRIANGLES => blocks[leaf_range(child)].iter().fold(Box3::EMPTY, |all, b| all.union(&b.0)),
                    _ if child == EMPTY => continue,
                    _ => items[leaf_range(child)].iter().fold(Box3::EMPTY, Box3::union),
                };
                node.set(slot, &own, child);
                bounds[index] = bounds[index].union(&own);
            }
        }
        if let Some(Box3 { min, max }) = bounds.first() {
            let point = |p: &[f32; 3]| Point3::new(p[0], p[1], p[2]);
            self.bounds = Bounds3 { min: point(min), max: point(max) }.into();
        }
        Some(blocks.iter().map(|block| block.1).sum())
    }
}

/// Reads the triangles of a block anew; gives its box and their number.
fn refit_block(
    block: &mut TriangleBlock,
    corners: &impl Fn(PrimitiveRef) -> Option<[[f32; 3]; 3]>,
) -> Option<(Box3, usize)> {
    let mut bounds = Box3::EMPTY;
    let mut n = 0;
    for place in 0..4 {
        let Some(pair) = block.pair(place) else { continue };
        let first = corners(pair.first)?;
        let second = match pair.second {
            None => None,
            Some(primitive) => Some(corners(PrimitiveRef { primitive, ..pair.first })?),
        };
        if second.is_some_and(|second| super::pair::common_edge(&first, &second).is_none()) {
            return None;
        }
        for triangle in std::iter::once(first).chain(second) {
            bounds = triangle.iter().fold(bounds, |all, p| all.union(&Box3 { min: *p, max: *p }));
            n += 1;
        }
        block.set(
            place,
            pair,
            |triangle| if triangle == pair.first { first } else { second.unwrap_or(first) },
        );
    }
    Some((bounds, n))
}
