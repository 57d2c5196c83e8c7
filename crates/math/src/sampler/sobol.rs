//! Owen-scrambled Sobol points, padded (Burley 2020, "Practical Hash-based Owen Scrambling").
//!
//! Pairs of dimensions are the first two of the Sobol sequence, a (0,2)-sequence: of any 2^m consecutive aligned
//! samples, one lies in each elementary interval. Each pair shuffles the order of the points and scrambles its digits on its own;
//! a shuffle that is itself an Owen scrambling of the index keeps every prefix of 2^m samples a net. For smooth
//! integrands the error of a pair falls as N^(-3/2) for such prefixes; between pairs it falls as N^(-1/2).

use crate::Point2;
use crate::low_discrepancy::laine_karras;
use crate::rng::{mix64, unit_f32};

#[derive(Clone, Debug)]
pub(super) struct Sobol {
    seed: u64,
    /// The sample index with its bits mirrored.
    mirrored_index: u32,
    dimension: u32,
}

impl Sobol {
    pub(super) fn new(seed: u64, sample_index: u64) -> Self {
        // Beyond 2^32 samples a new independent sequence starts.
        let round = sample_index >> 32;
        let seed = if round == 0 { seed } else { mix64(seed ^ mix64(round)) };
        Self { seed, mirrored_index: (sample_index as u32).reverse_bits(), dimension: 0 }
    }

    #[inline]
    fn keys(&self, pair: u32) -> (u32, u64) {
        let key = mix64(self.seed.wrapping_add(u64::from(pair).wrapping_mul(0x9e37_79b9_7f4a_7c15)));
        let index = laine_karras(self.mirrored_index, key as u32).reverse_bits();
        (index, mix64(key ^ 0xda94_2042_e4dd_58b5))
    }

    #[inline]
    pub(super) fn next_1d(&mut self) -> f32 {
        let (index, key) = self.keys(self.dimension >> 1);
        let second = self.dimension & 1 == 1;
        self.dimension += 1;
        let (mirrored, key) =
            if second { (mirrored_pascal(index), (key >> 32) as u32) } else { (index, key as u32) };
        unit_f32(laine_karras(mirrored, key).reverse_bits())
    }

    #[inline]
    pub(super) fn next_2d(&mut self) -> Point2 {
        self.dimension = (self.dimension + 1) & !1;
        let (index, key) = self.keys(self.dimension >> 1);
        self.dimension += 2;
        let x = laine_karras(index, key as u32).reverse_bits();
        let y = laine_karras(mirrored_pascal(index), (key >> 32) as u32).reverse_bits();
        Point2::new(unit_f32(x), unit_f32(y))
    }
}

/// The second Sobol dimension with its bits mirrored: the product with Pascal's triangle modulo 2, in five steps
/// since the triangle is a Kronecker power (Ahmed 2024, "An Implementation Algorithm of 2D Sobol Sequence").
#[inline]
fn mirrored_pascal(mut x: u32) -> u32 {
    x ^= x >> 16;
    x ^= (x & 0xff00_ff00) >> 8;
    x ^= (x & 0xf0f0_f0f0) >> 4;
    x ^= (x & 0xcccc_cccc) >> 2;
    x ^ (x & 0xaaaa_aaaa) >> 1
}
