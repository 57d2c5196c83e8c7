//! Traversal by AVX2, where the processor has it: the only module of the hierarchy with `unsafe`.
//!
//! It consists of [`Lanes`] in intrinsics and of indexing without checks. Its safe twin is [`super::lanes::Portable`];
//! both instantiate the same traversal, and the test `both_kernels_find_the_same_hits` compares them. What indexing relies
//! on is checked once for each tree, in `Bvh::new`, whose fields never change.

#![expect(
    unsafe_code,
    reason = "intrinsics and unchecked indexing, for which a benchmark speaks (docs/benchmarks.md)"
)]

use super::lanes::{Lanes, Stack};
use super::node::{INNER, Node, TRIANGLES, leaf_range};
use super::traverse::{Entry, MAX_STACK};
use super::triangle_block::TriangleBlock;
use super::{Bvh, Visitor, traverse};
use etendue_math::Ray;
use std::arch::x86_64::{
    __m256, _CMP_LE_OQ, _MM_HINT_T0, _mm_prefetch, _mm256_add_ps, _mm256_andnot_ps, _mm256_cmp_ps,
    _mm256_div_ps, _mm256_loadu_ps, _mm256_max_ps, _mm256_min_ps, _mm256_movemask_ps, _mm256_mul_ps,
    _mm256_permute2f128_ps, _mm256_set1_ps, _mm256_sub_ps,
};
use std::hint::select_unpredictable;
use std::mem::{MaybeUninit, transmute};

/// The instructions of AVX2: a value exists only where the processor has them.
#[derive(Clone, Copy, Debug)]
pub(super) struct Avx2(());

impl Avx2 {
    /// Asks the processor.
    pub(super) fn detect() -> Option<Self> {
        let has_all = is_x86_feature_detected!("avx2")
            && is_x86_feature_detected!("bmi1")
            && is_x86_feature_detected!("bmi2")
            && is_x86_feature_detected!("lzcnt")
            && is_x86_feature_detected!("popcnt");
        has_all.then_some(Self(()))
    }

    /// See [`super::Kernel::traverse`].
    #[inline(always)]
    pub(super) fn traverse<'a>(self, bvh: &'a Bvh, ray: &Ray, t_max: f32, visitor: &mut impl Visitor<'a>) {
        // SAFETY: the instructions exist, see `Avx2`.
        unsafe { traverse_by_avx2(self, bvh, ray, t_max, visitor) }
    }
}

/// The generic traversal, compiled for AVX2: all that it calls is inlined here.
#[target_feature(enable = "avx2,bmi1,bmi2,lzcnt,popcnt")]
fn traverse_by_avx2<'a>(lanes: Avx2, bvh: &'a Bvh, ray: &Ray, t_max: f32, visitor: &mut impl Visitor<'a>) {
    traverse::traverse(lanes, bvh, ray, t_max, visitor);
}

impl Lanes for Avx2 {
    type Floats = __m256;
    type Stack = UncheckedStack;

    #[inline(always)]
    fn splat(self, x: f32) -> __m256 {
        // SAFETY: the instructions exist, see `Avx2`.
        unsafe { _mm256_set1_ps(x) }
    }

    #[inline(always)]
    fn load(self, row: &[f32; 8]) -> __m256 {
        // SAFETY: the instructions exist, see `Avx2`.
        unsafe { _mm256_loadu_ps(row.as_ptr()) }
    }

    #[inline(always)]
    fn store(self, v: __m256) -> [f32; 8] {
        // SAFETY: the instructions exist, see `Avx2`.
        unsafe { transmute::<__m256, [f32; 8]>(v) }
    }

    #[inline(always)]
    fn add(self, a: __m256, b: __m256) -> __m256 {
        // SAFETY: the instructions exist, see `Avx2`.
        unsafe { _mm256_add_ps(a, b) }
    }

    #[inline(always)]
    fn sub(self, a: __m256, b: __m256) -> __m256 {
        // SAFETY: the instructions exist, see `Avx2`.
        unsafe { _mm256_sub_ps(a, b) }
    }

    #[inline(always)]
    fn mul(self, a: __m256, b: __m256) -> __m256 {
        // SAFETY: the instructions exist, see `Avx2`.
        unsafe { _mm256_mul_ps(a, b) }
    }

    #[inline(always)]
    fn div(self, a: __m256, b: __m256) -> __m256 {
        // SAFETY: the instructions exist, see `Avx2`.
        unsafe { _mm256_div_ps(a, b) }
    }

    #[inline(always)]
    fn abs(self, a: __m256) -> __m256 {
        // SAFETY: the instructions exist, see `Avx2`.
        unsafe { _mm256_andnot_ps(_mm256_set1_ps(-0.0), a) }
    }

    #[inline(always)]
    fn min(self, a: __m256, b: __m256) -> __m256 {
        // SAFETY: the instructions exist, see `Avx2`.
        unsafe { _mm256_min_ps(a, b) }
    }

    #[inline(always)]
    fn max(self, a: __m256, b: __m256) -> __m256 {
        // SAFETY: the instructions exist, see `Avx2`.
        unsafe { _mm256_max_ps(a, b) }
    }

    #[inline(always)]
    fn at_most(self, a: __m256, b: __m256) -> u32 {
        // SAFETY: the instructions exist, see `Avx2`.
        unsafe { _mm256_movemask_ps(_mm256_cmp_ps::<_CMP_LE_OQ>(a, b)) as u32 }
    }

    #[inline(always)]
    fn swap_halves(self, a: __m256) -> __m256 {
        // SAFETY: the instructions exist, see `Avx2`.
        unsafe { _mm256_permute2f128_ps::<1>(a, a) }
    }

    #[inline(always)]
    fn node(self, bvh: &Bvh, node: u32) -> &Node {
        debug_assert!((node as usize) < bvh.nodes.len());
        // SAFETY: `Bvh::new` has checked the children of every node, and that there is a root.
        unsafe { bvh.nodes.get_unchecked(node as usize) }
    }

    #[inline(always)]
    fn blocks(self, bvh: &Bvh, leaf: u32) -> &[TriangleBlock] {
        debug_assert!(leaf_range(leaf).end <= bvh.blocks.len());
        // SAFETY: `Bvh::new` has checked every leaf.
        unsafe { bvh.blocks.get_unchecked(leaf_range(leaf)) }
    }

    #[inline(always)]
    fn expect(self, bvh: &Bvh, child: u32) {
        if !bvh.exceeds_cache {
            return;
        }
        let node: *const i8 = bvh.nodes.as_ptr().wrapping_add(child as usize).cast();
        let block = bvh.blocks.as_ptr().wrapping_add(leaf_range(child).start).cast();
        let item = bvh.items.as_ptr().wrapping_add(leaf_range(child).start).cast();
        let leaf = select_unpredictable(child >> 30 == TRIANGLES, block, item);
        let address = select_unpredictable(child >> 30 == INNER, node, leaf);
        // Nodes and blocks have four lines of 64 bytes.
        for line in 0..4 {
            // SAFETY: a hint, which may name any address.
            unsafe { _mm_prefetch::<_MM_HINT_T0>(address.wrapping_add(64 * line)) };
        }
    }

    #[inline(always)]
    fn row<const N: usize>(self, rows: &[[f32; 8]; N], row: usize) -> &[f32; 8] {
        debug_assert!(row < N);
        // SAFETY: `TraversalRay::new` makes axes below 3 for blocks and planes below 6 for nodes.
        unsafe { rows.get_unchecked(row) }
    }
}

/// A stack that is neither cleared nor checked.
pub(super) struct UncheckedStack([MaybeUninit<Entry>; MAX_STACK]);

impl Stack for UncheckedStack {
    #[inline(always)]
    fn new() -> Self {
        Self([const { MaybeUninit::uninit() }; MAX_STACK])
    }

    #[inline(always)]
    fn write(&mut self, slot: usize, entry: Entry) {
        debug_assert!(slot < MAX_STACK);
        // SAFETY: `Bvh::new` has checked that no descent into a tree stacks more than half of them, and there are two
        // trees at most, the world's and that of an instance.
        unsafe { self.0.get_unchecked_mut(slot) }.write(entry);
    }

    #[inline(always)]
    fn read(&self, slot: usize) -> Entry {
        debug_assert!(slot < MAX_STACK);
        // SAFETY: traversal reads below the number of entries that it has written.
        unsafe { self.0.get_unchecked(slot).assume_init() }
    }
}
