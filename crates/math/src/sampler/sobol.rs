//! Owen-scrambled Sobol points, padded (Burley 2020, "Practical Hash-based Owen Scrambling").
//!
//! Dimensions come in groups of four. Each group shuffles the order of the points and scrambles its digits on its own; a
//! shuffle that is itself an Owen scrambling of the index keeps every prefix of 2^m samples a net. Both pairs of a group are
//! (0,2)-sequences: of 2^m samples, one lies in each elementary interval of area 2^-m. The first pair multiplies the
//! index by (I, P), the first two Sobol matrices, P Pascal's triangle modulo 2; the second by (M, P M), where the unit upper
//! triangular M only re-orders samples within blocks and so keeps the pair's quality. M was chosen by a beam search that made
//! the four-dimensional nets as good as it could: every box of volume 2^(t-m) holds its 2^t of 2^m samples, with t <= 2 up
//! to 2^9 samples and t <= 4 up to 2^19. (The first four dimensions of Joe and Kuo have t <= 3, but 2 within their second
//! pair.) Between groups the error falls as N^(-1/2).

use crate::Point2;
use crate::low_discrepancy::laine_karras;
use crate::rng::{mix64, unit_f32};

#[derive(Clone, Debug)]
pub(super) struct Sobol {
    seed: u64,
    /// The sample index with its bits mirrored.
    mirrored_index: u32,
    dimension: u32,
    /// Of the current group.
    group_key: u64,
    /// The shuffled index of the current group.
    index: u32,
    /// The mirrored digits of the first coordinate of the current pair before scrambling.
    digits: u32,
    /// Scrambling keys of the coordinates of the current pair.
    pair_keys: u64,
}

impl Sobol {
    pub(super) fn new(seed: u64, sample_index: u64) -> Self {
        // Beyond 2^32 samples a new independent sequence starts.
        let round = sample_index >> 32;
        let seed = if round == 0 { seed } else { mix64(seed ^ mix64(round)) };
        let mirrored_index = (sample_index as u32).reverse_bits();
        Self { seed, mirrored_index, dimension: 0, group_key: 0, index: 0, digits: 0, pair_keys: 0 }
    }

    /// Prepares the pair that starts at the current dimension, which is even. Dimensions only go up by 1 or to the next pair,
    /// so that no group is entered but at its start.
    #[inline]
    fn start_pair(&mut self) {
        if self.dimension & 2 == 0 {
            let group = u64::from(self.dimension >> 2);
            self.group_key = mix64(self.seed.wrapping_add(group.wrapping_mul(0x9e37_79b9_7f4a_7c15)));
            self.index = laine_karras(self.mirrored_index, self.group_key as u32).reverse_bits();
            self.digits = self.index;
            self.pair_keys = fold(self.group_key, 0xda94_2042_e4dd_58b5);
        } else {
            self.digits = second_pair(self.index);
            self.pair_keys = fold(self.group_key, 0x6a09_e667_f3bc_c909);
        }
    }

    #[inline]
    pub(super) fn next_1d(&mut self) -> f32 {
        let first = self.dimension & 1 == 0;
        if first {
            self.start_pair();
        }
        self.dimension += 1;
        let x = if first {
            laine_karras(self.digits, self.pair_keys as u32)
        } else {
            laine_karras(mirrored_pascal(self.digits), (self.pair_keys >> 32) as u32)
        };
        unit_f32(x.reverse_bits())
    }

    #[inline]
    pub(super) fn next_2d(&mut self) -> Point2 {
        self.dimension = (self.dimension + 1) & !1;
        self.start_pair();
        self.dimension += 2;
        let x = laine_karras(self.digits, self.pair_keys as u32).reverse_bits();
        let y = laine_karras(mirrored_pascal(self.digits), (self.pair_keys >> 32) as u32).reverse_bits();
        Point2::new(unit_f32(x), unit_f32(y))
    }
}

/// A cheap hash of an already mixed key: both halves of the product.
#[inline]
fn fold(key: u64, constant: u64) -> u64 {
    let product = u128::from(key) * u128::from(constant);
    (product >> 64) as u64 ^ product as u64
}

/// The product with Pascal's triangle modulo 2 (digit k is the sum of C(j, k) i_j over the digits of the index), in five steps
/// since the triangle is a Kronecker power (Ahmed 2024, "An Implementation Algorithm of 2D Sobol Sequence").
#[inline]
const fn mirrored_pascal(mut x: u32) -> u32 {
    x ^= x >> 16;
    x ^= (x & 0xff00_ff00) >> 8;
    x ^= (x & 0xf0f0_f0f0) >> 4;
    x ^= (x & 0xcccc_cccc) >> 2;
    x ^ ((x & 0xaaaa_aaaa) >> 1)
}

/// Columns of M found by search; those after them are the identity's.
const SECOND_PAIR_COLUMNS: [u32; 19] = [
    0x1, 0x2, 0x5, 0xb, 0x10, 0x21, 0x51, 0xb6, 0x102, 0x329, 0x75c, 0x837, 0x1378, 0x2446, 0x544e, 0xe4bd,
    0x13594, 0x2adf7, 0x7ac90,
];

/// M applied to each value of each byte.
static SECOND_PAIR: [[u32; 256]; 4] = {
    let mut table = [[0; 256]; 4];
    let mut byte = 0;
    while byte < 4 {
        let mut value = 0;
        while value < 256 {
            let mut bit = 0;
            while bit < 8 {
                let column = 8 * byte + bit;
                if value >> bit & 1 == 1 {
                    table[byte][value] ^= if column < SECOND_PAIR_COLUMNS.len() {
                        SECOND_PAIR_COLUMNS[column]
                    } else {
                        1 << column
                    };
                }
                bit += 1;
            }
            value += 1;
        }
        byte += 1;
    }
    table
};

#[inline]
fn second_pair(index: u32) -> u32 {
    let [a, b, c, d] = index.to_le_bytes();
    SECOND_PAIR[0][a as usize]
        ^ SECOND_PAIR[1][b as usize]
        ^ SECOND_PAIR[2][c as usize]
        ^ SECOND_PAIR[3][d as usize]
}
