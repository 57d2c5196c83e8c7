//! Building with the surface area heuristic (SPEC ACC-5).
//!
//! A range of primitives is split where the sum of area times number of leaf blocks over both sides is least;
//! centroids fall into up to 32 bins per axis. Primitives are reordered in place. Above, a node takes the eight
//! ranges that result from always splitting the one of largest area; below, where that would leave many nodes half
//! empty, a binary tree is collapsed at least cost. Large ranges are handled in parallel and joined in order, so
//! that the tree does not depend on the number of threads.

mod assemble;
mod bins;
mod collapse;
mod partition;
mod primitive;

#[cfg(test)]
mod tests;

pub(crate) use primitive::{Box3, BuildPrimitive};

use self::assemble::assemble;
use self::bins::{Candidate, best_split};
use self::collapse::{BinaryNode, collapse};
use self::partition::partition;
use self::primitive::Box4;
use super::node::{ITEMS, Node, TRIANGLES, leaf, node_index};
use super::{Bvh, PrimitiveRef};
use etendue_math::{Bounds3, Point3};
use rayon::prelude::*;

/// Pairs of triangles in a block.
const BLOCK: usize = 4;
/// More primitives never share a leaf.
const MAX_LEAF: usize = 8;
/// Cost of visiting a node, in tests of a block of triangles; measured speed hardly changes between 0.3 and 1.2.
const NODE_COST: f32 = 0.6;
/// The children of ranges from here on are built in parallel.
const PARALLEL_BUILD: usize = 1 << 13;
/// Ranges from here on are binned and reordered in parallel, in chunks.
const PARALLEL_BINNING: usize = 1 << 16;
/// Primitives of a chunk.
const CHUNK: usize = 1 << 13;
/// Levels below which ranges are halved, so that the depth stays bounded whatever the input.
const MAX_SAH_DEPTH: usize = 40;

/// Where the builder looks up triangles.
pub(crate) trait TriangleSource: Sync {
    /// Corners of a triangle.
    fn corners(&self, triangle: PrimitiveRef) -> [[f32; 3]; 3];
    /// The second triangle of the pair that begins with `first`.
    fn second(&self, first: PrimitiveRef) -> Option<u32>;
}

/// Builds the tree.
pub(crate) fn build(mut primitives: Vec<BuildPrimitive>, source: &impl TriangleSource) -> Bvh {
    if primitives.is_empty() {
        return Bvh::default();
    }
    let root = Span::over(&primitives, 0..primitives.len());
    let chunks = build_subtree(&mut primitives, 0, root, 0);
    let point = |p: [f32; 3]| Point3::new(p[0], p[1], p[2]);
    let Box3 { min, max } = root.bounds.to_box3();
    assemble(chunks, &primitives, Bounds3 { min: point(min), max: point(max) }, source)
}

/// A range of primitives.
#[derive(Clone, Copy)]
struct Span {
    start: usize,
    end: usize,
    bounds: Box4,
    /// Box around twice the centres.
    centres: Box4,
    is_leaf: bool,
}

impl Span {
    fn over(primitives: &[BuildPrimitive], range: std::ops::Range<usize>) -> Self {
        let own = &primitives[range.clone()];
        let bounds = united(own, |all, primitive| all.grow(primitive.bounds()));
        Self::with_bounds(primitives, range, bounds)
    }

    fn with_bounds(primitives: &[BuildPrimitive], range: std::ops::Range<usize>, bounds: Box4) -> Self {
        let is_leaf = range.len() == 1;
        let centres = united(&primitives[range.clone()], |all, primitive| all.grow_point(primitive.centre()));
        Self { start: range.start, end: range.end, bounds, centres, is_leaf }
    }

    const fn len(&self) -> usize {
        self.end - self.start
    }
}

/// The box that grows with every primitive.
fn united(primitives: &[BuildPrimitive], grow: impl Fn(&mut Box4, &BuildPrimitive) + Sync) -> Box4 {
    let fold = |chunk: &[BuildPrimitive]| {
        let mut bounds = Box4::EMPTY;
        for primitive in chunk {
            grow(&mut bounds, primitive);
        }
        bounds
    };
    if primitives.len() < PARALLEL_BINNING {
        return fold(primitives);
    }
    primitives.par_chunks(CHUNK).map(fold).reduce(|| Box4::EMPTY, |a, b| a.union(&b))
}

/// The nodes over `span` in depth-first order, in pieces. A child that is a node is named by its distance, and a
/// leaf by its primitives, of which the first of the slice has the number `offset`.
fn build_subtree(
    primitives: &mut [BuildPrimitive],
    offset: usize,
    span: Span,
    depth: usize,
) -> Vec<Vec<Node>> {
    if span.len() < PARALLEL_BUILD {
        let mut tree = Vec::with_capacity(span.len() + 1);
        append_binary(&mut tree, primitives, &span, 3 * depth);
        let mut nodes = Vec::with_capacity(span.len() / 16 + 1);
        collapse(&tree, primitives, offset, &mut nodes);
        return vec![nodes];
    }
    let children = split_in_eight(primitives, span, depth);
    let leaves: Vec<Option<u32>> = children
        .iter()
        .map(|child| child.is_leaf.then(|| name_leaf(primitives, offset, child.start..child.end)))
        .collect();
    let mut rest = primitives;
    let mut jobs = Vec::with_capacity(children.len());
    for child in &children {
        let (own, tail) = rest.split_at_mut(child.len());
        jobs.push((own, *child));
        rest = tail;
    }
    let subtrees: Vec<Vec<Vec<Node>>> = jobs
        .into_par_iter()
        .map(|(own, child)| {
            if child.is_leaf {
                return Vec::new();
            }
            let local = Span { start: 0, end: own.len(), ..child };
            build_subtree(own, offset + child.start, local, depth + 1)
        })
        .collect();
    let mut node = Node::EMPTY;
    let mut distance = 1;
    for (slot, (child, subtree)) in children.iter().zip(&subtrees).enumerate() {
        let code = leaves[slot].unwrap_or_else(|| node_index(distance));
        node.set(slot, &child.bounds.to_box3(), code);
        distance += subtree.iter().map(Vec::len).sum::<usize>();
    }
    std::iter::once(vec![node]).chain(subtrees.into_iter().flatten()).collect()
}

/// Appends the binary tree over `span` in depth-first order.
fn append_binary(
    tree: &mut Vec<BinaryNode>,
    primitives: &mut [BuildPrimitive],
    span: &Span,
    depth: usize,
) -> bool {
    let index = tree.len();
    let (start, end) = (span.start as u32, span.end as u32);
    tree.push(BinaryNode { bounds: span.bounds, start, end, right: 0, is_pure: true });
    let parts = if span.is_leaf { None } else { split(primitives, span, depth) };
    let is_pure = match parts {
        None => primitives[span.start].is_triangle(),
        Some((left, right)) => {
            let left_is_pure = append_binary(tree, primitives, &left, depth + 1);
            tree[index].right = tree.len() as u32;
            append_binary(tree, primitives, &right, depth + 1) && left_is_pure
        }
    };
    tree[index].is_pure = is_pure;
    is_pure
}

/// Names a leaf by its primitives.
fn name_leaf(primitives: &[BuildPrimitive], offset: usize, range: std::ops::Range<usize>) -> u32 {
    let kind = if primitives[range.start].is_triangle() { TRIANGLES } else { ITEMS };
    leaf(kind, offset + range.start, range.len())
}

/// Splits a range until there are eight, in order of their place in the array.
fn split_in_eight(primitives: &mut [BuildPrimitive], span: Span, depth: usize) -> Vec<Span> {
    let mut spans = Vec::with_capacity(8);
    spans.push(span);
    while spans.len() < 8 {
        let weight = |s: &Span| {
            if 3 * depth < MAX_SAH_DEPTH { s.bounds.half_area() } else { s.len() as f32 }
        };
        let largest = (0..spans.len())
            .filter(|&i| !spans[i].is_leaf)
            .max_by(|&i, &j| weight(&spans[i]).total_cmp(&weight(&spans[j])).then(j.cmp(&i)));
        let Some(largest) = largest else { break };
        match split(primitives, &spans[largest], 3 * depth) {
            None => spans[largest].is_leaf = true,
            Some((left, right)) => {
                spans[largest] = left;
                spans.push(right);
            }
        }
    }
    spans.sort_unstable_by_key(|s| s.start);
    spans
}

/// Number of blocks that `n` triangles fill. Items, whose tests are dear, are always split as far as possible.
#[inline(always)]
const fn leaf_cost(n: usize) -> f32 {
    n.div_ceil(BLOCK) as f32
}

/// Reorders the primitives of a range into two parts; `None` where a leaf is cheaper.
fn split(primitives: &mut [BuildPrimitive], span: &Span, depth: usize) -> Option<(Span, Span)> {
    let own = &mut primitives[span.start..span.end];
    if own.len() <= BLOCK && own.iter().all(BuildPrimitive::is_triangle) {
        return None;
    }
    let candidate = if depth < MAX_SAH_DEPTH { best_split(own, &span.centres) } else { None };
    let may_be_leaf = own.len() <= MAX_LEAF;
    let area = span.bounds.half_area();
    let splits = match &candidate {
        Some(candidate) => {
            let has_items = || own.iter().any(|primitive| !primitive.is_triangle());
            !may_be_leaf || has_items() || candidate.cost < leaf_cost(own.len()) * area
        }
        None => !may_be_leaf,
    };
    let parts = |n_left: usize| (span.start..span.start + n_left, span.start + n_left..span.end);
    if let (true, Some(Candidate { axis, bin, binning, left, right, .. })) = (splits, candidate) {
        let n_left = partition(own, &|primitive| binning.bin(primitive, axis) < bin);
        let (first, second) = parts(n_left);
        return Some((
            Span::with_bounds(primitives, first, left),
            Span::with_bounds(primitives, second, right),
        ));
    }
    let n_left = if splits { own.len() / 2 } else { partition(own, &BuildPrimitive::is_triangle) };
    let (first, second) = parts(n_left);
    (!first.is_empty() && !second.is_empty())
        .then(|| (Span::over(primitives, first), Span::over(primitives, second)))
}
