//! Arithmetic on eight numbers at once, and its portable implementation.
//!
//! Traversal is written once, generic over [`Lanes`]; `wide.rs` implements the trait by AVX2. Both round every operation
//! alike (no fused multiplication and addition), so that both kernels find the same hits to the last bit.

use glam::Vec4;

use super::Bvh;
use super::node::{Node, leaf_range};
use super::traverse::{Entry, MAX_STACK};
use super::triangle_block::TriangleBlock;

/// Operations on eight floats. Values of the type are proof that the processor has the instructions.
pub(super) trait Lanes: Copy {
    /// Eight floats.
    type Floats: Copy;

    /// Nodes still to visit.
    type Stack: Stack;

    /// A node of the tree.
    fn node(self, bvh: &Bvh, node: u32) -> &Node;
    /// The triangles of a leaf of the tree.
    fn blocks(self, bvh: &Bvh, leaf: u32) -> &[TriangleBlock];
    /// Tells the processor that a child of a node will be visited soon.
    fn expect(self, bvh: &Bvh, child: u32);
    /// A row that a prepared ray names.
    fn row<const N: usize>(self, rows: &[[f32; 8]; N], row: usize) -> &[f32; 8];

    fn splat(self, x: f32) -> Self::Floats;
    fn load(self, row: &[f32; 8]) -> Self::Floats;
    fn store(self, v: Self::Floats) -> [f32; 8];
    fn add(self, a: Self::Floats, b: Self::Floats) -> Self::Floats;
    fn sub(self, a: Self::Floats, b: Self::Floats) -> Self::Floats;
    fn mul(self, a: Self::Floats, b: Self::Floats) -> Self::Floats;
    fn div(self, a: Self::Floats, b: Self::Floats) -> Self::Floats;
    fn abs(self, a: Self::Floats) -> Self::Floats;
    /// `a` where it is less than `b`, otherwise `b`: also where either is NaN.
    fn min(self, a: Self::Floats, b: Self::Floats) -> Self::Floats;
    /// `a` where it is greater than `b`, otherwise `b`: also where either is NaN.
    fn max(self, a: Self::Floats, b: Self::Floats) -> Self::Floats;
    /// One bit for each lane where `a <= b`.
    fn at_most(self, a: Self::Floats, b: Self::Floats) -> u32;
    /// Lanes 4 to 7, then 0 to 3.
    fn swap_halves(self, a: Self::Floats) -> Self::Floats;
}

/// Room for nodes still to visit. Traversal keeps the number of entries in a register of its own.
pub(super) trait Stack {
    fn new() -> Self;
    fn read(&self, slot: usize) -> Entry;
    fn write(&mut self, slot: usize, entry: Entry);
}

/// Works everywhere: two vectors of four.
#[derive(Clone, Copy, Debug)]
pub(super) struct Portable;

impl Lanes for Portable {
    type Floats = [Vec4; 2];
    type Stack = CheckedStack;

    #[inline(always)]
    fn node(self, bvh: &Bvh, node: u32) -> &Node {
        &bvh.nodes[node as usize]
    }

    #[inline(always)]
    fn blocks(self, bvh: &Bvh, leaf: u32) -> &[TriangleBlock] {
        &bvh.blocks[leaf_range(leaf)]
    }

    #[inline(always)]
    fn expect(self, _: &Bvh, _: u32) {}

    #[inline(always)]
    fn row<const N: usize>(self, rows: &[[f32; 8]; N], row: usize) -> &[f32; 8] {
        &rows[row]
    }

    #[inline(always)]
    fn splat(self, x: f32) -> [Vec4; 2] {
        [Vec4::splat(x); 2]
    }

    #[inline(always)]
    fn load(self, row: &[f32; 8]) -> [Vec4; 2] {
        let [a, b, c, d, e, f, g, h] = *row;
        [Vec4::new(a, b, c, d), Vec4::new(e, f, g, h)]
    }

    #[inline(always)]
    fn store(self, v: [Vec4; 2]) -> [f32; 8] {
        let [[a, b, c, d], [e, f, g, h]] = [v[0].to_array(), v[1].to_array()];
        [a, b, c, d, e, f, g, h]
    }

    #[inline(always)]
    fn add(self, a: [Vec4; 2], b: [Vec4; 2]) -> [Vec4; 2] {
        [a[0] + b[0], a[1] + b[1]]
    }

    #[inline(always)]
    fn sub(self, a: [Vec4; 2], b: [Vec4; 2]) -> [Vec4; 2] {
        [a[0] - b[0], a[1] - b[1]]
    }

    #[inline(always)]
    fn mul(self, a: [Vec4; 2], b: [Vec4; 2]) -> [Vec4; 2] {
        [a[0] * b[0], a[1] * b[1]]
    }

    #[inline(always)]
    fn div(self, a: [Vec4; 2], b: [Vec4; 2]) -> [Vec4; 2] {
        [a[0] / b[0], a[1] / b[1]]
    }

    #[inline(always)]
    fn abs(self, a: [Vec4; 2]) -> [Vec4; 2] {
        [a[0].abs(), a[1].abs()]
    }

    #[inline(always)]
    fn min(self, a: [Vec4; 2], b: [Vec4; 2]) -> [Vec4; 2] {
        [Vec4::select(a[0].cmplt(b[0]), a[0], b[0]), Vec4::select(a[1].cmplt(b[1]), a[1], b[1])]
    }

    #[inline(always)]
    fn max(self, a: [Vec4; 2], b: [Vec4; 2]) -> [Vec4; 2] {
        [Vec4::select(a[0].cmpgt(b[0]), a[0], b[0]), Vec4::select(a[1].cmpgt(b[1]), a[1], b[1])]
    }

    #[inline(always)]
    fn at_most(self, a: [Vec4; 2], b: [Vec4; 2]) -> u32 {
        a[0].cmple(b[0]).bitmask() | a[1].cmple(b[1]).bitmask() << 4
    }

    #[inline(always)]
    fn swap_halves(self, a: [Vec4; 2]) -> [Vec4; 2] {
        [a[1], a[0]]
    }
}

/// A stack whose every access is checked. Few rays need more than the first entries, which are cheap to clear.
pub(super) struct CheckedStack {
    first: [Entry; Self::N_FIRST],
    others: Vec<Entry>,
}

impl CheckedStack {
    const N_FIRST: usize = 32;
}

impl Stack for CheckedStack {
    #[inline(always)]
    fn new() -> Self {
        Self { first: [Entry::LAST; Self::N_FIRST], others: Vec::new() }
    }

    #[inline(always)]
    fn read(&self, slot: usize) -> Entry {
        if slot < Self::N_FIRST { self.first[slot] } else { self.others[slot - Self::N_FIRST] }
    }

    #[inline(always)]
    fn write(&mut self, slot: usize, entry: Entry) {
        if slot < Self::N_FIRST {
            self.first[slot] = entry;
        } else {
            self.write_other(slot - Self::N_FIRST, entry);
        }
    }
}

impl CheckedStack {
    #[cold]
    fn write_other(&mut self, slot: usize, entry: Entry) {
        if self.others.is_empty() {
            self.others.resize(MAX_STACK, Entry::LAST);
        }
        self.others[slot] = entry;
    }
}
