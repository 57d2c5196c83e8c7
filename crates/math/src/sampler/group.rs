//! Seven dimensions of scrambled Sobol points that are even together, four at a time.

use crate::low_discrepancy::laine_karras;

/// A point of a group: the shuffled index and the key of the scrambling.
#[derive(Clone, Debug, Default)]
pub(super) struct Group {
    index: u32,
    key: u64,
    /// Digits of M, Q0, Q1 and Q2 times the index, the highest in the lowest bit.
    products: [u32; 4],
}

impl Group {
    #[inline]
    pub(super) fn new(index: u32, key: u64) -> Self {
        Self { index, key, products: multiply(index) }
    }

    /// The pair of I and P, and the numbers of Q1 and Q2.
    #[inline]
    pub(super) fn first_half(&self) -> [f32; 4] {
        let [_, _, q1, q2] = self.products;
        let keys = [fold(self.key, 0xda94_2042_e4dd_58b5), fold(self.key, 0x9fb2_1c65_1e98_df25)];
        scramble([self.index, mirrored_pascal(self.index), q1, q2], keys)
    }

    /// The pair of M and P M, the number of Q0, and one of no use.
    #[inline]
    pub(super) fn second_half(&self) -> [f32; 4] {
        let [m, q0, ..] = self.products;
        let keys = [fold(self.key, 0x6a09_e667_f3bc_c909), fold(self.key, 0xc2b2_ae3d_27d4_eb4f)];
        scramble([m, mirrored_pascal(m), q0, 0], keys)
    }
}

/// A cheap hash of an already mixed key: both halves of the product.
#[inline]
fn fold(key: u64, constant: u64) -> u64 {
    let product = u128::from(key) * u128::from(constant);
    (product >> 64) as u64 ^ product as u64
}

/// Owen-scrambled numbers of mirrored digits. A loop over lanes that becomes vector code.
#[inline]
fn scramble(digits: [u32; 4], keys: [u64; 2]) -> [f32; 4] {
    let keys = [keys[0] as u32, (keys[0] >> 32) as u32, keys[1] as u32, (keys[1] >> 32) as u32];
    let mut numbers = [0.0; 4];
    for i in 0..4 {
        let bits = reverse_bits(laine_karras(digits[i], keys[i]));
        // 24 bits, which a float holds exactly; the conversion of signed integers is the cheap one.
        numbers[i] = (bits >> 8) as i32 as f32 * (1.0 / 16_777_216.0);
    }
    numbers
}

/// As the method of integers, but in steps that exist for vectors.
#[inline]
const fn reverse_bits(mut x: u32) -> u32 {
    x = x.rotate_left(16);
    x = ((x >> 8) & 0x00ff_00ff) | ((x & 0x00ff_00ff) << 8);
    x = ((x >> 4) & 0x0f0f_0f0f) | ((x & 0x0f0f_0f0f) << 4);
    x = ((x >> 2) & 0x3333_3333) | ((x & 0x3333_3333) << 2);
    ((x >> 1) & 0x5555_5555) | ((x & 0x5555_5555) << 1)
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

/// Columns of M, Q0, Q1 and Q2 found by search; those after them are the identity's.
const COLUMNS: [&[u32]; 4] = [
    &[
        0x1, 0x2, 0x5, 0xb, 0x10, 0x21, 0x51, 0xb6, 0x102, 0x329, 0x75c, 0x837, 0x1378, 0x2446, 0x544e,
        0xe4bd, 0x13594, 0x2adf7, 0x7ac90,
    ],
    &[0x1, 0x2, 0x5, 0x8, 0x12, 0x29, 0x66, 0xf5, 0x10e, 0x30d, 0x5f8, 0xb10, 0x14bc, 0x3906, 0x6a89, 0x8e3f],
    &[0x1, 0x3, 0x4, 0xa, 0x17, 0x22, 0x79, 0xab, 0x1c9, 0x2f6, 0x43e, 0xd9d, 0x198c, 0x339f, 0x6bb1, 0x8460],
    &[0x1, 0x3, 0x6, 0x9, 0x16, 0x38, 0x6b, 0xc7, 0x1b1, 0x212, 0x587, 0xe7a, 0x13ae, 0x2745, 0x53b5, 0x8d1e],
];

/// The matrices applied to each value of each byte of an index. A pixel's first 256 samples touch the first 4 KiB of 16.
static PRODUCTS: [[[u32; 4]; 256]; 4] = {
    let mut table = [[[0; 4]; 256]; 4];
    let mut column = 0;
    while column < 32 {
        let (byte, bit) = (column / 8, column % 8);
        let mut value = 0;
        while value < 256 {
            let mut matrix = 0;
            while matrix < 4 {
                if value >> bit & 1 == 1 {
                    let columns = COLUMNS[matrix];
                    table[byte][value][matrix] ^=
                        if column < columns.len() { columns[column] } else { 1 << column };
                }
                matrix += 1;
            }
            value += 1;
        }
        column += 1;
    }
    table
};

#[inline]
fn multiply(index: u32) -> [u32; 4] {
    let [a, b, c, d] = index.to_le_bytes().map(usize::from);
    let mut products = PRODUCTS[0][a];
    if index > 0xff {
        products = xor(products, xor(PRODUCTS[1][b], xor(PRODUCTS[2][c], PRODUCTS[3][d])));
    }
    products
}

#[inline]
fn xor(a: [u32; 4], b: [u32; 4]) -> [u32; 4] {
    std::array::from_fn(|i| a[i] ^ b[i])
}
