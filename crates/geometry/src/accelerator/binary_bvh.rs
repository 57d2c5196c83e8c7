//! A plain bounding volume hierarchy: two children for each node, one box for each node, one primitive at a time (Kay and
//! Kajiya 1986, "Ray Tracing Complex Scenes"; SPEC ACC-2, ACC-5).
//!
//! It is to `bvh` what the other structures here are: the same idea without eight children, pairs of triangles and
//! instructions for eight numbers at once. Each primitive is in exactly one leaf; boxes may overlap, so that the end of a ray
//! is known only when all boxes before it have been looked at.

use std::ops::ControlFlow;

use super::slab::clip;
use super::{BinarySplit, Build, PARALLEL, Probe};
use crate::bvh::{Box3, TraversalRay};
use crate::mesh::heap;

/// Bins of the surface area heuristic.
const BINS: usize = 16;
/// Deeper ranges are halved by number, which bounds the depth whatever the input.
const FREE_DEPTH: u32 = 48;
/// No tree is deeper: halving takes at most 32 levels.
const MAX_DEPTH: usize = FREE_DEPTH as usize + 34;

/// A node; the first child of an inner one stands behind it.
#[derive(Clone, Copy, Debug)]
struct Node {
    bounds: Box3,
    /// Second child, or first primitive of a leaf.
    next: u32,
    /// Primitives of a leaf; 0 for an inner node.
    n: u32,
}

/// See the module.
#[derive(Debug)]
pub(super) struct BinaryBvh {
    nodes: Vec<Node>,
    primitives: Vec<u32>,
}

impl BinaryBvh {
    pub(super) fn build(build: &Build<'_>, split: BinarySplit, max_primitives: u32) -> Self {
        let mut primitives = build.all();
        let builder = Builder { build, split, max_primitives: max_primitives.max(1) as usize };
        let nodes = if primitives.is_empty() { Vec::new() } else { builder.nodes(&mut primitives, 0, 0) };
        Self { nodes, primitives }
    }

    pub(super) fn traverse(&self, ray: &TraversalRay, probe: &mut impl Probe) -> ControlFlow<()> {
        let mut waiting = [(0, 0.0); MAX_DEPTH];
        let entry = |node: u32, end: f32| clip(ray, &self.nodes[node as usize].bounds, end);
        if self.nodes.is_empty() || entry(0, probe.end()).is_none() {
            return ControlFlow::Continue(());
        }
        let (mut n_waiting, mut node) = (0, 0);
        loop {
            probe.note_node();
            let Node { next, n, .. } = self.nodes[node as usize];
            if n == 0 {
                let (children, end) = ([node + 1, next], probe.end());
                match children.map(|child| entry(child, end)) {
                    [Some(a), Some(b)] => {
                        let a_is_first = a.near <= b.near;
                        let [first, second] = if a_is_first { children } else { [next, node + 1] };
                        waiting[n_waiting] = (second, a.near.max(b.near));
                        n_waiting += 1;
                        node = first;
                        continue;
                    }
                    [Some(_), None] => {
                        node = children[0];
                        continue;
                    }
                    [None, Some(_)] => {
                        node = children[1];
                        continue;
                    }
                    [None, None] => {}
                }
            } else {
                probe.test_all(&self.primitives[next as usize..(next + n) as usize])?;
            }
            loop {
                if n_waiting == 0 {
                    return ControlFlow::Continue(());
                }
                n_waiting -= 1;
                let near;
                (node, near) = waiting[n_waiting];
                if near <= probe.end() {
                    break;
                }
            }
        }
    }

    pub(super) const fn n_nodes(&self) -> usize {
        self.nodes.len()
    }

    pub(super) fn memory_bytes(&self) -> usize {
        heap(&self.nodes) + heap(&self.primitives)
    }
}

struct Builder<'a> {
    build: &'a Build<'a>,
    split: BinarySplit,
    max_primitives: usize,
}

impl Builder<'_> {
    /// The nodes over primitives, of which the first has the number `offset` among all. Second children are named by
    /// their distance from the first node.
    fn nodes(&self, primitives: &mut [u32], offset: usize, depth: u32) -> Vec<Node> {
        let bounds = primitives.iter().fold(Box3::EMPTY, |all, p| all.union(self.bounds(*p)));
        let Some(n_lower) = self.divide(primitives, &bounds, depth) else {
            return vec![Node { bounds, next: offset as u32, n: primitives.len() as u32 }];
        };
        let is_large = primitives.len() > PARALLEL;
        let (lower, upper) = primitives.split_at_mut(n_lower);
        let mut first = || self.nodes(lower, offset, depth + 1);
        let mut second = || self.nodes(upper, offset + n_lower, depth + 1);
        let (first, second) = if is_large { rayon::join(first, second) } else { (first(), second()) };
        let mut nodes = vec![Node { bounds, next: first.len() as u32 + 1, n: 0 }];
        for child in [first, second] {
            let start = nodes.len() as u32;
            nodes.extend(child.into_iter().map(|node| {
                let next = if node.n == 0 { node.next + start } else { node.next };
                Node { next, ..node }
            }));
        }
        nodes
    }

    fn bounds(&self, primitive: u32) -> &Box3 {
        &self.build.boxes[primitive as usize]
    }

    /// Half the centre of a box would do as well, but this does not overflow.
    fn centre(&self, primitive: u32, axis: usize) -> f32 {
        0.5 * self.bounds(primitive).min[axis] + 0.5 * self.bounds(primitive).max[axis]
    }

    /// Reorders primitives; gives the number of those in the first part, or `None` for a leaf.
    fn divide(&self, primitives: &mut [u32], bounds: &Box3, depth: u32) -> Option<usize> {
        let n = primitives.len();
        if n <= self.max_primitives {
            return None;
        }
        let centres = primitives.iter().fold(Box3::EMPTY, |all, p| {
            let centre = std::array::from_fn(|axis| self.centre(*p, axis));
            all.union(&Box3 { min: centre, max: centre })
        });
        let axis = centres.longest_axis();
        let is_lower = match self.split {
            _ if depth >= FREE_DEPTH => None,
            BinarySplit::Equal => None,
            BinarySplit::Middle => Some((axis, 0.5 * centres.min[axis] + 0.5 * centres.max[axis])),
            BinarySplit::SurfaceArea => self.best_plane(primitives, bounds, &centres),
        };
        if let Some((axis, position)) = is_lower {
            let n_lower = partition(primitives, |p| self.centre(p, axis) < position);
            if 0 < n_lower && n_lower < n {
                return Some(n_lower);
            }
        }
        let by_centre =
            |a: &u32, b: &u32| self.centre(*a, axis).total_cmp(&self.centre(*b, axis)).then(a.cmp(b));
        primitives.select_nth_unstable_by(n / 2, by_centre);
        Some(n / 2)
    }

    /// The plane between two bins of centres where the sum of area times number is least.
    fn best_plane(&self, primitives: &[u32], bounds: &Box3, centres: &Box3) -> Option<(usize, f32)> {
        let mut best = None;
        let mut best_cost = f32::INFINITY;
        for axis in 0..3 {
            let (min, extent) = (centres.min[axis], centres.max[axis] - centres.min[axis]);
            let edge = |bin: usize| min + extent * (bin as f32 / BINS as f32);
            if !(extent > 0.0 && extent.is_finite()) {
                continue;
            }
            let mut bins = [(0_usize, Box3::EMPTY); BINS];
            for p in primitives {
                let place = (self.centre(*p, axis) - min) / extent * BINS as f32;
                let bin = &mut bins[(place as usize).min(BINS - 1)];
                *bin = (bin.0 + 1, bin.1.union(self.bounds(*p)));
            }
            let sum = |bins: &[(usize, Box3)]| {
                let (n, all) = bins.iter().fold((0, Box3::EMPTY), |(n, all), b| (n + b.0, all.union(&b.1)));
                if n == 0 { None } else { Some(n as f32 * all.half_area()) }
            };
            for bin in 1..BINS {
                let Some(cost) = sum(&bins[..bin]).zip(sum(&bins[bin..])).map(|(a, b)| a + b) else {
                    continue;
                };
                if cost < best_cost {
                    best_cost = cost;
                    best = Some((axis, edge(bin)));
                }
            }
        }
        // A box without area tells nothing.
        best.filter(|_| bounds.half_area() > 0.0)
    }
}

/// Brings those that are wanted to the front; gives their number.
fn partition(primitives: &mut [u32], is_wanted: impl Fn(u32) -> bool) -> usize {
    let mut n = 0;
    for i in 0..primitives.len() {
        if is_wanted(primitives[i]) {
            primitives.swap(i, n);
            n += 1;
        }
    }
    n
}
