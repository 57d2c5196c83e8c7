//! Trees of planes across the axes, which [`bsp`](super::bsp) and [`kd_tree`](super::kd_tree) place each in its own way.
//!
//! A ray goes down to the child that it meets first and remembers the other with the part of the ray that lies in it
//! (Jansen 1986; Sung and Shirley 1992, "Ray Tracing with the BSP Tree", Graphics Gems III). The first leaf with a hit before
//! its end ends the search, since those that are left begin behind it.

use std::ops::ControlFlow;

use super::slab::{Span, clip, crossing, runs_down};
use super::{Build, DivisionSettings, PARALLEL, Probe, share};
use crate::bvh::{Box3, TraversalRay};
use crate::mesh::heap;

/// A place to divide a cell.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Plane {
    pub(super) axis: usize,
    pub(super) position: f32,
}

/// A cell and the primitives that it holds.
#[derive(Debug)]
pub(super) struct Cell {
    pub(super) bounds: Box3,
    pub(super) primitives: Vec<u32>,
    pub(super) depth: u32,
}

/// A node; its lower child stands behind it.
#[derive(Clone, Copy, Debug)]
enum Node {
    Inner { axis: u8, position: f32, upper: u32 },
    Leaf { first: u32, n: u32 },
}

/// See the module.
#[derive(Debug)]
pub(super) struct PlaneTree {
    bounds: Box3,
    nodes: Vec<Node>,
    /// Primitives of the leaves.
    references: Vec<u32>,
}

/// The tree while it is built.
enum Branch {
    Leaf(Vec<u32>),
    Inner { plane: Plane, children: Box<[Self; 2]> },
}

impl PlaneTree {
    /// Builds the tree whose planes `place` chooses; `None` leaves a cell undivided.
    pub(super) fn build(build: &Build<'_>, place: &(impl Fn(&Cell) -> Option<Plane> + Sync)) -> Self {
        let root = Cell { bounds: *build.bounds, primitives: build.all(), depth: 0 };
        let branch = divide(build, root, build.budget(), place);
        let mut tree = Self { bounds: *build.bounds, nodes: Vec::new(), references: Vec::new() };
        tree.append(branch);
        tree
    }

    fn append(&mut self, branch: Branch) {
        match branch {
            Branch::Leaf(primitives) => {
                let first = self.references.len() as u32;
                self.nodes.push(Node::Leaf { first, n: primitives.len() as u32 });
                self.references.extend(primitives);
            }
            Branch::Inner { plane: Plane { axis, position }, children } => {
                let index = self.nodes.len();
                self.nodes.push(Node::Inner { axis: axis as u8, position, upper: 0 });
                let [lower, upper] = *children;
                self.append(lower);
                let place = self.nodes.len() as u32;
                self.nodes[index] = Node::Inner { axis: axis as u8, position, upper: place };
                self.append(upper);
            }
        }
    }

    pub(super) fn traverse(&self, ray: &TraversalRay, probe: &mut impl Probe) -> ControlFlow<()> {
        let Some(mut span) = clip(ray, &self.bounds, probe.end()) else { return ControlFlow::Continue(()) };
        let mut waiting = [(0, span); DivisionSettings::MAX_DEPTH as usize];
        let (mut n_waiting, mut node) = (0, 0);
        loop {
            probe.note_node();
            match self.nodes[node as usize] {
                Node::Inner { axis, position, upper } => {
                    let axis = usize::from(axis);
                    let [early, late] = crossing(ray, axis, position);
                    let lower = node + 1;
                    let [first, second] = if runs_down(ray, axis) { [upper, lower] } else { [lower, upper] };
                    // NaN means both.
                    if early > span.far {
                        node = first;
                    } else if late < span.near {
                        node = second;
                    } else {
                        waiting[n_waiting] = (second, Span { near: span.near.max(early), ..span });
                        n_waiting += 1;
                        span.far = span.far.min(late);
                        node = first;
                    }
                    continue;
                }
                Node::Leaf { first, n } => {
                    let first = first as usize;
                    probe.test_all(&self.references[first..first + n as usize])?;
                }
            }
            loop {
                if n_waiting == 0 {
                    return ControlFlow::Continue(());
                }
                n_waiting -= 1;
                (node, span) = waiting[n_waiting];
                if span.near <= probe.end() {
                    break;
                }
            }
        }
    }

    pub(super) const fn n_nodes(&self) -> usize {
        self.nodes.len()
    }

    pub(super) fn memory_bytes(&self) -> usize {
        heap(&self.nodes) + heap(&self.references)
    }
}

/// Divides a cell, which may hold `budget` references in all its leaves.
fn divide(
    build: &Build<'_>,
    cell: Cell,
    budget: usize,
    place: &(impl Fn(&Cell) -> Option<Plane> + Sync),
) -> Branch {
    let Cell { bounds, primitives, depth } = &cell;
    let may_divide = *depth < DivisionSettings::MAX_DEPTH;
    let Some(plane) = may_divide.then(|| place(&cell)).flatten() else {
        return Branch::Leaf(cell.primitives);
    };
    let sides = build.sides(primitives, plane.axis, plane.position);
    let n = sides[0].len() + sides[1].len();
    if n > budget {
        return Branch::Leaf(cell.primitives);
    }
    let parts = {
        let (mut lower, mut upper) = (*bounds, *bounds);
        lower.max[plane.axis] = plane.position;
        upper.min[plane.axis] = plane.position;
        [lower, upper]
    };
    let depth = depth + 1;
    let is_large = primitives.len() > PARALLEL;
    drop(cell);
    let [lower, upper] = sides;
    let child = |bounds: Box3, primitives: Vec<u32>| {
        let budget = share(budget, primitives.len(), n);
        divide(build, Cell { bounds, primitives, depth }, budget, place)
    };
    let children = if is_large {
        let (lower, upper) = rayon::join(|| child(parts[0], lower), || child(parts[1], upper));
        [lower, upper]
    } else {
        [child(parts[0], lower), child(parts[1], upper)]
    };
    Branch::Inner { plane, children: Box::new(children) }
}
