//! From a binary tree to nodes of eight children at least cost (Ylitie, Karras and Laine 2017, "Efficient
//! Incoherent Ray Traversal on GPUs Through Compressed Wide BVHs", section 4.1).
//!
//! C(n, i) is the least cost of showing what lies below the binary node n as at most i children of some wide node:
//! C(n, 1) = min(area times blocks, `NODE_COST` times area + D(n, 8)), where the first is a leaf;
//! D(n, i) = min over k of C(left, k) + C(right, i - k); C(n, i) = min(C(n, i - 1), D(n, i)).

use super::primitive::{Box4, BuildPrimitive};
use super::{MAX_LEAF, NODE_COST, leaf_cost, name_leaf};
use crate::bvh::node::{Node, node_index};

/// A node of the binary tree, in depth-first order: the left child is the next one.
#[derive(Debug)]
pub(super) struct BinaryNode {
    pub(super) bounds: Box4,
    pub(super) start: u32,
    pub(super) end: u32,
    /// 0 for a leaf.
    pub(super) right: u32,
    /// True if all primitives are triangles.
    pub(super) is_pure: bool,
}

/// Least costs of a binary node and how they arise.
#[derive(Clone, Copy, Debug)]
struct Plan {
    /// C(n, i) for i = 1 to 7.
    costs: [f32; 7],
    /// How many children left and right contribute to C(n, i), at i - 1, and to D(n, 8); (0, 0) for one child.
    shares: [(u8, u8); 8],
    is_leaf: bool,
}

/// Appends the nodes of eight children for a binary tree.
pub(super) fn collapse(
    tree: &[BinaryNode],
    primitives: &[BuildPrimitive],
    offset: usize,
    nodes: &mut Vec<Node>,
) {
    let mut plans: Vec<Plan> = Vec::with_capacity(tree.len());
    // From the last to the first, so that children come before their parents; the plan of node i is `len - 1 - i`.
    for (index, node) in tree.iter().enumerate().rev() {
        let plan_of = |child: usize| &plans[tree.len() - 1 - child];
        let plan = if node.right == 0 {
            Plan::of_leaf(node)
        } else {
            Plan::of_inner(node, plan_of(index + 1), plan_of(node.right as usize))
        };
        plans.push(plan);
    }
    plans.reverse();
    Collapse { tree, plans, primitives, offset }.append(0, nodes);
}

impl Plan {
    fn of_leaf(node: &BinaryNode) -> Self {
        let cost = leaf_cost((node.end - node.start) as usize) * node.bounds.half_area();
        Self { costs: [cost; 7], shares: [(0, 0); 8], is_leaf: true }
    }

    fn of_inner(node: &BinaryNode, left: &Self, right: &Self) -> Self {
        // D(n, i) at i - 2 and its k.
        let distributed: [(f32, u8); 7] = std::array::from_fn(|at| {
            let mut best = (f32::INFINITY, 1);
            for k in 0..=at {
                let cost = left.costs[k] + right.costs[at - k];
                if cost < best.0 {
                    best = (cost, k as u8 + 1);
                }
            }
            best
        });
        let share = |at: usize| (distributed[at].1, at as u8 + 2 - distributed[at].1);
        let area = node.bounds.half_area();
        let n = (node.end - node.start) as usize;
        let inner = NODE_COST * area + distributed[6].0;
        let leaf = leaf_cost(n) * area;
        let is_leaf = node.is_pure && n <= MAX_LEAF && leaf <= inner;
        let mut plan = Self { costs: [0.0; 7], shares: [(0, 0); 8], is_leaf };
        plan.costs[0] = if is_leaf { leaf } else { inner };
        plan.shares[7] = share(6);
        for at in 1..7 {
            let improves = distributed[at - 1].0 < plan.costs[at - 1];
            plan.costs[at] = if improves { distributed[at - 1].0 } else { plan.costs[at - 1] };
            plan.shares[at] = if improves { share(at - 1) } else { plan.shares[at - 1] };
        }
        plan
    }
}

struct Collapse<'a> {
    tree: &'a [BinaryNode],
    plans: Vec<Plan>,
    primitives: &'a [BuildPrimitive],
    offset: usize,
}

impl Collapse<'_> {
    /// Appends the wide node over a binary one and all below it.
    fn append(&self, binary: usize, nodes: &mut Vec<Node>) {
        let mut children = [0_usize; 8];
        let mut n = 0;
        self.gather(binary, self.plans[binary].shares[7], &mut children, &mut n);
        let index = nodes.len();
        nodes.push(Node::EMPTY);
        for (slot, &child) in children[..n].iter().enumerate() {
            let own = &self.tree[child];
            let is_leaf = self.plans[child].is_leaf;
            let code = if is_leaf {
                name_leaf(self.primitives, self.offset, own.start as usize..own.end as usize)
            } else {
                node_index(nodes.len() - index)
            };
            nodes[index].set(slot, &own.bounds.to_box3(), code);
            if !is_leaf {
                self.append(child, nodes);
            }
        }
    }

    /// Lists the binary nodes that become children of one wide node, in order.
    fn gather(&self, binary: usize, (left, right): (u8, u8), children: &mut [usize; 8], n: &mut usize) {
        if left == 0 {
            children[*n] = binary;
            *n += 1;
            return;
        }
        for (child, share) in [(binary + 1, left), (self.tree[binary].right as usize, right)] {
            self.gather(child, self.plans[child].shares[usize::from(share) - 1], children, n);
        }
    }
}
