//! An octree: crowded cells are divided in eight equal parts (Glassner 1984, "Space Subdivision for Fast Ray Tracing"; SPEC
//! ACC-4).
//!
//! Along a ray, the parts of a cell follow each other in an order that depends on the signs of its direction alone: each of the
//! three middle planes is crossed once, always towards the same side. Boxes of cells are not stored but found on the way down.

use std::ops::ControlFlow;

use super::slab::{clip, runs_down};
use super::{Build, DivisionSettings, PARALLEL, Probe, share};
use crate::bvh::{Box3, TraversalRay};
use crate::mesh::heap;
use rayon::prelude::*;

#[derive(Clone, Copy, Debug)]
enum Node {
    /// Eight children stand side by side. The bits of their number tell which are above the middle: x, y, z.
    Inner {
        first_child: u32,
    },
    Leaf {
        first: u32,
        n: u32,
    },
}

/// See the module.
#[derive(Debug)]
pub(super) struct Octree {
    bounds: Box3,
    nodes: Vec<Node>,
    /// Primitives of the leaves.
    references: Vec<u32>,
}

/// The tree while it is built.
enum Branch {
    Leaf(Vec<u32>),
    Inner(Vec<Self>),
}

/// What a ray needs on its way through the tree.
struct Descent<'a, P> {
    tree: &'a Octree,
    ray: &'a TraversalRay,
    /// The child that the ray meets first.
    first: usize,
    probe: &'a mut P,
}

impl Octree {
    pub(super) fn build(build: &Build<'_>, settings: &DivisionSettings) -> Self {
        let branch = divide(build, *build.bounds, build.all(), build.budget(), 0, settings);
        let empty = Node::Leaf { first: 0, n: 0 };
        let mut tree = Self { bounds: *build.bounds, nodes: vec![empty], references: Vec::new() };
        tree.set(0, branch);
        tree
    }

    fn set(&mut self, index: usize, branch: Branch) {
        match branch {
            Branch::Leaf(primitives) => {
                let first = self.references.len() as u32;
                self.nodes[index] = Node::Leaf { first, n: primitives.len() as u32 };
                self.references.extend(primitives);
            }
            Branch::Inner(children) => {
                let first = self.nodes.len();
                self.nodes.resize(first + children.len(), Node::Leaf { first: 0, n: 0 });
                self.nodes[index] = Node::Inner { first_child: first as u32 };
                for (child, branch) in children.into_iter().enumerate() {
                    self.set(first + child, branch);
                }
            }
        }
    }

    pub(super) fn traverse(&self, ray: &TraversalRay, probe: &mut impl Probe) -> ControlFlow<()> {
        if clip(ray, &self.bounds, probe.end()).is_none() {
            return ControlFlow::Continue(());
        }
        let first = (0..3).map(|axis| usize::from(runs_down(ray, axis)) << axis).sum();
        Descent { tree: self, ray, first, probe }.visit(0, &self.bounds)
    }

    pub(super) const fn n_nodes(&self) -> usize {
        self.nodes.len()
    }

    pub(super) fn memory_bytes(&self) -> usize {
        heap(&self.nodes) + heap(&self.references)
    }
}

impl<P: Probe> Descent<'_, P> {
    fn visit(&mut self, node: u32, bounds: &Box3) -> ControlFlow<()> {
        self.probe.note_node();
        match self.tree.nodes[node as usize] {
            Node::Leaf { first, n } => {
                self.probe.test_all(&self.tree.references[first as usize..(first + n) as usize])
            }
            Node::Inner { first_child } => {
                let middle = middle(bounds);
                for step in 0..8 {
                    let child = step ^ self.first;
                    let node = first_child + child as u32;
                    if matches!(self.tree.nodes[node as usize], Node::Leaf { n: 0, .. }) {
                        continue;
                    }
                    let bounds = part(bounds, &middle, child);
                    if clip(self.ray, &bounds, self.probe.end()).is_some() {
                        self.visit(node, &bounds)?;
                    }
                }
                ControlFlow::Continue(())
            }
        }
    }
}

/// Divides a cell, which may hold `budget` references in all its leaves.
fn divide(
    build: &Build<'_>,
    bounds: Box3,
    primitives: Vec<u32>,
    budget: usize,
    depth: u32,
    settings: &DivisionSettings,
) -> Branch {
    let depth_limit = settings.max_depth.min(DivisionSettings::MAX_DEPTH);
    if primitives.len() <= settings.max_primitives as usize || depth >= depth_limit {
        return Branch::Leaf(primitives);
    }
    let middle = middle(&bounds);
    let mut parts = vec![primitives.clone()];
    for (axis, position) in middle.into_iter().enumerate() {
        let sides: Vec<[Vec<u32>; 2]> = parts.iter().map(|part| build.sides(part, axis, position)).collect();
        let (lower, upper): (Vec<_>, Vec<_>) = sides.into_iter().map(|[lower, upper]| (lower, upper)).unzip();
        parts = lower.into_iter().chain(upper).collect();
    }
    let n = parts.iter().map(Vec::len).sum();
    let is_divisible = (0..3).any(|axis| bounds.min[axis] < middle[axis] && middle[axis] < bounds.max[axis]);
    if n > budget || !is_divisible {
        return Branch::Leaf(primitives);
    }
    let is_large = primitives.len() > PARALLEL;
    drop(primitives);
    let child = |(child, primitives): (usize, Vec<u32>)| {
        let budget = share(budget, primitives.len(), n);
        divide(build, part(&bounds, &middle, child), primitives, budget, depth + 1, settings)
    };
    Branch::Inner(if is_large {
        parts.into_par_iter().enumerate().map(child).collect()
    } else {
        parts.into_iter().enumerate().map(child).collect()
    })
}

fn middle(bounds: &Box3) -> [f32; 3] {
    std::array::from_fn(|axis| 0.5 * bounds.min[axis] + 0.5 * bounds.max[axis])
}

/// The box of one of eight parts.
fn part(bounds: &Box3, middle: &[f32; 3], part: usize) -> Box3 {
    let mut own = *bounds;
    for (axis, position) in middle.iter().enumerate() {
        let side = if part >> axis & 1 == 0 { &mut own.max } else { &mut own.min };
        side[axis] = *position;
    }
    own
}
