//! Building with the surface area heuristic (SPEC ACC-5).
//!
//! A range of primitives is split where the sum of area times number of leaf blocks over both sides is least;
//! centroids fall into 32 bins per axis. A node takes the eight ranges that result from always splitting the one
//! of largest area. Large ranges are built in parallel and joined in order, so that the tree does not depend on
//! the number of threads.

use super::node::{ITEMS, MAX_RUN, Node, TRIANGLES, leaf, moved, node_index};
use super::triangle_block::TriangleBlock;
use super::{Bvh, PrimitiveRef};
use etendue_math::{Bounds3, Point3};
use rayon::prelude::*;

const N_BINS: usize = 32;
/// More primitives never share a leaf.
const MAX_LEAF: usize = 8;
/// Cost of visiting a node, in tests of a block of triangles; measured speed hardly changes between 0.3 and 1.2.
const NODE_COST: f32 = 0.6;
/// Ranges from here on are built in parallel.
const PARALLEL_BUILD: usize = 1 << 14;
/// Ranges from here on are binned in parallel.
const PARALLEL_BINNING: usize = 1 << 17;
/// Levels below which ranges are halved, so that the depth stays bounded whatever the input.
const MAX_SAH_DEPTH: usize = 40;

/// A box as arrays, quick to index by axis.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Box3 {
    pub(crate) min: [f32; 3],
    pub(crate) max: [f32; 3],
}

impl Box3 {
    const EMPTY: Self = Self { min: [f32::INFINITY; 3], max: [f32::NEG_INFINITY; 3] };

    #[inline]
    fn grow(&mut self, other: &Self) {
        for axis in 0..3 {
            self.min[axis] = self.min[axis].min(other.min[axis]);
            self.max[axis] = self.max[axis].max(other.max[axis]);
        }
    }

    #[inline]
    fn grow_point(&mut self, p: [f32; 3]) {
        self.grow(&Self { min: p, max: p });
    }

    /// Half the surface area.
    #[inline]
    fn half_area(&self) -> f32 {
        let [x, y, z]: [f32; 3] = std::array::from_fn(|axis| self.max[axis] - self.min[axis]);
        if x < 0.0 { 0.0 } else { x * y + y * z + z * x }
    }
}

/// A primitive as the builder sees it.
#[derive(Clone, Copy, Debug)]
pub(crate) struct BuildPrimitive {
    bounds: Box3,
    reference: PrimitiveRef,
    is_triangle: bool,
}

impl BuildPrimitive {
    /// A triangle.
    pub(crate) fn triangle(reference: PrimitiveRef, vertices: &[[f32; 3]; 3]) -> Self {
        let mut bounds = Box3::EMPTY;
        for vertex in vertices {
            bounds.grow_point(*vertex);
        }
        Self { bounds, reference, is_triangle: true }
    }

    /// Anything else, known by its box.
    pub(crate) fn item(reference: PrimitiveRef, bounds: Bounds3) -> Self {
        let bounds = Box3 {
            min: [bounds.min.x, bounds.min.y, bounds.min.z],
            max: [bounds.max.x, bounds.max.y, bounds.max.z],
        };
        Self { bounds, reference, is_triangle: false }
    }

    /// Twice the centre of the box along an axis.
    #[inline]
    fn centre(&self, axis: usize) -> f32 {
        self.bounds.min[axis] + self.bounds.max[axis]
    }
}

/// Builds the tree. `vertices` gives the corners of a triangle.
pub(crate) fn build(
    mut primitives: Vec<BuildPrimitive>,
    vertices: &(impl Fn(PrimitiveRef) -> [[f32; 3]; 3] + Sync),
) -> Bvh {
    if primitives.is_empty() {
        return Bvh::default();
    }
    let mut tree = Arena::default();
    let root = Span { start: 0, end: primitives.len(), bounds: bounds_of(&primitives), is_leaf: false };
    build_node(&mut tree, &mut primitives, root, 0, vertices);
    tree.nodes.shrink_to_fit();
    tree.blocks.shrink_to_fit();
    tree.items.shrink_to_fit();
    let point = |p: [f32; 3]| Point3::new(p[0], p[1], p[2]);
    let bounds = Bounds3 { min: point(root.bounds.min), max: point(root.bounds.max) };
    Bvh { nodes: tree.nodes, blocks: tree.blocks, items: tree.items, bounds }
}

/// A tree under construction.
#[derive(Default)]
struct Arena {
    nodes: Vec<Node>,
    blocks: Vec<TriangleBlock>,
    items: Vec<PrimitiveRef>,
}

/// A range of primitives.
#[derive(Clone, Copy)]
struct Span {
    start: usize,
    end: usize,
    bounds: Box3,
    is_leaf: bool,
}

fn bounds_of(primitives: &[BuildPrimitive]) -> Box3 {
    let fold = |chunk: &[BuildPrimitive]| {
        let mut bounds = Box3::EMPTY;
        for primitive in chunk {
            bounds.grow(&primitive.bounds);
        }
        bounds
    };
    if primitives.len() < PARALLEL_BINNING {
        return fold(primitives);
    }
    primitives.par_chunks(PARALLEL_BUILD).map(fold).reduce(
        || Box3::EMPTY,
        |mut a, b| {
            a.grow(&b);
            a
        },
    )
}

/// Appends the node over `span` and all below it; returns its index.
fn build_node<F>(
    arena: &mut Arena,
    primitives: &mut [BuildPrimitive],
    span: Span,
    depth: usize,
    vertices: &F,
) -> usize
where
    F: Fn(PrimitiveRef) -> [[f32; 3]; 3] + Sync,
{
    let index = arena.nodes.len();
    arena.nodes.push(Node::EMPTY);
    let children = split_in_eight(primitives, span, depth);
    let children = children.as_slice();
    let codes = if span.end - span.start >= PARALLEL_BUILD {
        build_children_in_parallel(arena, primitives, children, depth, vertices)
    } else {
        // Leaves first, so that those of one node lie together.
        let mut codes: Vec<u32> = children
            .iter()
            .map(|child| {
                let own = &primitives[child.start..child.end];
                if child.is_leaf { append_leaf(arena, own, vertices) } else { 0 }
            })
            .collect();
        for (child, code) in children.iter().zip(&mut codes).filter(|(child, _)| !child.is_leaf) {
            *code = node_index(build_node(arena, primitives, *child, depth + 1, vertices));
        }
        codes
    };
    for (slot, (child, code)) in children.iter().zip(codes).enumerate() {
        arena.nodes[index].set(slot, &child.bounds, code);
    }
    index
}

fn build_children_in_parallel<F>(
    arena: &mut Arena,
    primitives: &mut [BuildPrimitive],
    children: &[Span],
    depth: usize,
    vertices: &F,
) -> Vec<u32>
where
    F: Fn(PrimitiveRef) -> [[f32; 3]; 3] + Sync,
{
    let mut rest = primitives;
    let mut offset = 0;
    let mut jobs = Vec::with_capacity(children.len());
    for child in children {
        let (_, tail) = rest.split_at_mut(child.start - offset);
        let (own, tail) = tail.split_at_mut(child.end - child.start);
        jobs.push((own, *child));
        rest = tail;
        offset = child.end;
    }
    let subtrees: Vec<(Arena, u32)> = jobs
        .into_par_iter()
        .map(|(own, child)| {
            let mut subtree = Arena::default();
            if child.is_leaf {
                let code = append_leaf(&mut subtree, own, vertices);
                return (subtree, code);
            }
            let local = Span { start: 0, end: own.len(), ..child };
            let root = build_node(&mut subtree, own, local, depth + 1, vertices);
            (subtree, node_index(root))
        })
        .collect();
    subtrees.into_iter().map(|(subtree, code)| append_subtree(arena, subtree, code)).collect()
}

fn append_subtree(arena: &mut Arena, mut subtree: Arena, root: u32) -> u32 {
    let (n_nodes, n_blocks, n_items) = (arena.nodes.len(), arena.blocks.len(), arena.items.len());
    for node in &mut subtree.nodes {
        node.children = node.children.map(|child| moved(child, n_nodes, n_blocks, n_items));
    }
    arena.nodes.append(&mut subtree.nodes);
    arena.blocks.append(&mut subtree.blocks);
    arena.items.append(&mut subtree.items);
    moved(root, n_nodes, n_blocks, n_items)
}

fn append_leaf<F>(arena: &mut Arena, primitives: &[BuildPrimitive], vertices: &F) -> u32
where
    F: Fn(PrimitiveRef) -> [[f32; 3]; 3] + Sync,
{
    if !primitives[0].is_triangle {
        let first = arena.items.len();
        arena.items.extend(primitives.iter().map(|primitive| primitive.reference));
        return leaf(ITEMS, first, primitives.len());
    }
    let first = arena.blocks.len();
    for group in primitives.chunks(4) {
        let mut block = TriangleBlock::EMPTY;
        for (lane, primitive) in group.iter().enumerate() {
            block.set(lane, primitive.reference, &vertices(primitive.reference));
        }
        arena.blocks.push(block);
    }
    leaf(TRIANGLES, first, primitives.len().div_ceil(4))
}

/// Splits a range until there are eight, in order of their place in the array.
fn split_in_eight(primitives: &mut [BuildPrimitive], span: Span, depth: usize) -> Vec<Span> {
    let mut spans = Vec::with_capacity(MAX_RUN);
    spans.push(span);
    while spans.len() < 8 {
        let weight = |s: &Span| {
            if depth < MAX_SAH_DEPTH { s.bounds.half_area() } else { (s.end - s.start) as f32 }
        };
        let largest = (0..spans.len())
            .filter(|&i| !spans[i].is_leaf)
            .max_by(|&i, &j| weight(&spans[i]).total_cmp(&weight(&spans[j])).then(j.cmp(&i)));
        let Some(largest) = largest else { break };
        let s = spans[largest];
        match split(&mut primitives[s.start..s.end], &s.bounds, depth) {
            None => spans[largest].is_leaf = true,
            Some(n_left) => {
                let part = |start: usize, end: usize| Span {
                    start,
                    end,
                    bounds: bounds_of(&primitives[start..end]),
                    is_leaf: end - start == 1,
                };
                spans[largest] = part(s.start, s.start + n_left);
                spans.push(part(s.start + n_left, s.end));
            }
        }
    }
    for s in &mut spans {
        s.is_leaf |= s.end - s.start == 1;
    }
    spans.sort_by_key(|s| s.start);
    spans
}

/// Number of blocks that `n` triangles fill. Items, whose tests are dear, are always split as far as possible.
#[inline]
fn leaf_cost(n: usize) -> f32 {
    n.div_ceil(4) as f32
}

/// Reorders the primitives into two parts and returns the size of the first; `None` where a leaf is cheaper.
fn split(primitives: &mut [BuildPrimitive], bounds: &Box3, depth: usize) -> Option<usize> {
    let n = primitives.len();
    let may_be_leaf = n <= MAX_LEAF;
    let candidate = if depth < MAX_SAH_DEPTH { best_split(primitives) } else { None };
    let area = bounds.half_area();
    let splits = match &candidate {
        Some(candidate) => {
            let has_items = || primitives.iter().any(|primitive| !primitive.is_triangle);
            !may_be_leaf || has_items() || candidate.cost + NODE_COST * area < leaf_cost(n) * area
        }
        None => !may_be_leaf,
    };
    if !splits {
        let n_triangles = partition(primitives, |primitive| primitive.is_triangle);
        return (n_triangles != 0 && n_triangles != n).then_some(n_triangles);
    }
    match candidate {
        Some(Candidate { axis, bin, binning, .. }) => {
            Some(partition(primitives, |primitive| binning.bin(primitive.centre(axis), axis) < bin))
        }
        None => Some(n / 2),
    }
}

/// Moves the primitives that satisfy a condition to the front; returns their number.
fn partition(primitives: &mut [BuildPrimitive], is_left: impl Fn(&BuildPrimitive) -> bool) -> usize {
    let (mut i, mut j) = (0, primitives.len());
    while i < j {
        if is_left(&primitives[i]) {
            i += 1;
        } else {
            j -= 1;
            primitives.swap(i, j);
        }
    }
    i
}

/// How centroids map to bins.
#[derive(Clone, Copy)]
struct Binning {
    min: [f32; 3],
    scale: [f32; 3],
}

impl Binning {
    fn new(centres: &Box3) -> Self {
        let scale = std::array::from_fn(|axis| {
            let extent = centres.max[axis] - centres.min[axis];
            if extent > 0.0 && extent.is_finite() { N_BINS as f32 * 0.9999 / extent } else { 0.0 }
        });
        Self { min: centres.min, scale }
    }

    #[inline]
    fn bin(&self, centre: f32, axis: usize) -> usize {
        (((centre - self.min[axis]) * self.scale[axis]) as usize).min(N_BINS - 1)
    }
}

/// The cheapest split found.
struct Candidate {
    cost: f32,
    axis: usize,
    /// First bin of the second part.
    bin: usize,
    binning: Binning,
}

/// Boxes and numbers of primitives per bin and axis.
#[derive(Clone)]
struct Bins {
    bounds: [[Box3; N_BINS]; 3],
    n: [[u32; N_BINS]; 3],
}

impl Bins {
    const EMPTY: Self = Self { bounds: [[Box3::EMPTY; N_BINS]; 3], n: [[0; N_BINS]; 3] };

    fn fill(primitives: &[BuildPrimitive], binning: &Binning) -> Self {
        let mut bins = Self::EMPTY;
        for primitive in primitives {
            for axis in 0..3 {
                let bin = binning.bin(primitive.centre(axis), axis);
                bins.bounds[axis][bin].grow(&primitive.bounds);
                bins.n[axis][bin] += 1;
            }
        }
        bins
    }

    fn merge(mut self, other: &Self) -> Self {
        for axis in 0..3 {
            for bin in 0..N_BINS {
                self.bounds[axis][bin].grow(&other.bounds[axis][bin]);
                self.n[axis][bin] += other.n[axis][bin];
            }
        }
        self
    }
}

fn centre_bounds(primitives: &[BuildPrimitive]) -> Box3 {
    let mut centres = Box3::EMPTY;
    for primitive in primitives {
        centres.grow_point([primitive.centre(0), primitive.centre(1), primitive.centre(2)]);
    }
    centres
}

/// The split of least cost, if centroids differ. Minima, maxima and integer sums are exact, so that working in
/// parallel does not change the result.
fn best_split(primitives: &[BuildPrimitive]) -> Option<Candidate> {
    let is_large = primitives.len() >= PARALLEL_BINNING;
    let centres = if is_large {
        primitives.par_chunks(PARALLEL_BUILD).map(centre_bounds).reduce(
            || Box3::EMPTY,
            |mut a, b| {
                a.grow(&b);
                a
            },
        )
    } else {
        centre_bounds(primitives)
    };
    let binning = Binning::new(&centres);
    let bins = if is_large {
        primitives
            .par_chunks(PARALLEL_BUILD)
            .map(|chunk| Bins::fill(chunk, &binning))
            .reduce(|| Bins::EMPTY, |a, b| a.merge(&b))
    } else {
        Bins::fill(primitives, &binning)
    };
    let mut best: Option<Candidate> = None;
    for axis in 0..3 {
        if binning.scale[axis] == 0.0 {
            continue;
        }
        if let Some((cost, bin)) = best_on_axis(&bins.bounds[axis], &bins.n[axis])
            && best.as_ref().is_none_or(|best| cost < best.cost)
        {
            best = Some(Candidate { cost, axis, bin, binning });
        }
    }
    best
}

/// The cheapest plane between bins: its cost and the bin behind it.
fn best_on_axis(bounds: &[Box3; N_BINS], n: &[u32; N_BINS]) -> Option<(f32, usize)> {
    let mut right_costs = [0.0_f32; N_BINS];
    let mut right = Box3::EMPTY;
    let mut n_right = 0;
    for bin in (1..N_BINS).rev() {
        right.grow(&bounds[bin]);
        n_right += n[bin] as usize;
        right_costs[bin] = if n_right == 0 { f32::NAN } else { right.half_area() * leaf_cost(n_right) };
    }
    let mut best: Option<(f32, usize)> = None;
    let mut left = Box3::EMPTY;
    let mut n_left = 0;
    for bin in 1..N_BINS {
        left.grow(&bounds[bin - 1]);
        n_left += n[bin - 1] as usize;
        if n_left == 0 {
            continue;
        }
        let cost = left.half_area() * leaf_cost(n_left) + right_costs[bin];
        if cost.is_finite() && best.is_none_or(|(least, _)| cost < least) {
            best = Some((cost, bin));
        }
    }
    best
}
