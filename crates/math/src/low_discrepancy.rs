//! Point sequences that fill the unit cube more evenly than random points (SPEC MC-10), their randomisation, and
//! the measure of evenness (SPEC MC-14).
//!
//! - Radical inverse: the digits of `i` in base b, mirrored at the point, `Phi_b(i) = sum_k d_k b^(-k-1)`
//!   (van der Corput 1935); Halton 1960 takes one prime base per dimension.
//! - Sobol 1967: in base 2, each dimension multiplies the bits of `i` by its own matrix over GF(2). Direction numbers of
//!   Joe and Kuo 2008, "Constructing Sobol Sequences with Better Two-Dimensional Projections".
//! - Owen 1995 scrambling permutes each digit at random, dependent on all digits before it; the points keep their
//!   evenness and each becomes uniform. In base 2 a hash does it (Laine and Karras 2011, "Stratified Sampling for Stochastic
//!   Transparency"; Burley 2020, "Practical Hash-based Owen Scrambling"). In other bases the random permutations
//!   are affine, `d -> a d + c (mod b)`: pairs of digits are then mapped uniformly, and variance depends on pairs only
//!   (Owen 2003, "Variance with Alternative Scramblings of Digital Nets").

use crate::Point2;
use crate::rng::{ONE_MINUS_EPSILON, mix64, unit_f32};

/// Number of prime bases at hand.
pub const N_PRIMES: usize = 128;

/// The first primes: the bases of the Halton sequence.
pub const PRIMES: [u32; N_PRIMES] = first_primes();

const fn first_primes() -> [u32; N_PRIMES] {
    let mut primes = [0; N_PRIMES];
    let mut n = 0;
    let mut candidate = 2;
    while n < N_PRIMES {
        let mut divisor = 2;
        let mut is_prime = true;
        while divisor * divisor <= candidate {
            if candidate % divisor == 0 {
                is_prime = false;
                break;
            }
            divisor += 1;
        }
        if is_prime {
            primes[n] = candidate;
            n += 1;
        }
        candidate += 1;
    }
    primes
}

/// Radical inverse of `i` in the base of index `base_index` of [`PRIMES`].
///
/// # Panics
/// If `base_index` is not below [`N_PRIMES`].
#[must_use]
pub fn radical_inverse(base_index: usize, mut i: u64) -> f32 {
    let base = u64::from(PRIMES[base_index]);
    let inverse_base = 1.0 / base as f64;
    let mut mirrored = 0.0_f64;
    let mut scale = inverse_base;
    while i > 0 {
        mirrored += (i % base) as f64 * scale;
        scale *= inverse_base;
        i /= base;
    }
    (mirrored as f32).min(ONE_MINUS_EPSILON)
}

/// Radical inverse in base 2.
#[inline]
#[must_use]
pub fn van_der_corput(i: u32) -> f32 {
    unit_f32(i.reverse_bits())
}

/// Coordinate `dimension` of point `i` of the Halton sequence.
#[must_use]
pub fn halton(i: u64, dimension: usize) -> f32 {
    radical_inverse(dimension, i)
}

/// Radical inverse with nested random affine permutations of its digits, chosen by `seed`.
///
/// # Panics
/// If `base_index` is not below [`N_PRIMES`].
#[must_use]
pub fn scrambled_radical_inverse(base_index: usize, mut i: u64, seed: u64) -> f32 {
    let base = u64::from(PRIMES[base_index]);
    let inverse_base = 1.0 / base as f64;
    let mut mirrored = 0.0_f64;
    let mut scale = 1.0;
    // The hash of the digits so far: each node of the tree of digits has its own permutation.
    let mut node = seed;
    // All digits that an f32 can hold; the digits beyond the last of `i` are zeros, and zeros are permuted too.
    while scale > 1e-8 {
        let digit = i % base;
        i /= base;
        node = mix64(node.wrapping_add(0x9e37_79b9_7f4a_7c15));
        // Multiplying by n and keeping the upper bits chooses among n values.
        let factor = 1 + (((node & 0xffff_ffff) * (base - 1)) >> 32);
        let shift = ((node >> 32) * base) >> 32;
        scale *= inverse_base;
        mirrored += ((digit * factor + shift) % base) as f64 * scale;
        node ^= digit;
    }
    (mirrored as f32).min(ONE_MINUS_EPSILON)
}

/// Dimensions of the table of [`SOBOL_MATRICES`].
pub const N_SOBOL_DIMENSIONS: usize = 16;

/// Primitive polynomials (degree, inner coefficients) and initial direction numbers of Joe and Kuo's set D(6) from its
/// second dimension on.
const JOE_KUO: [(u32, u32, [u32; 6]); N_SOBOL_DIMENSIONS - 1] = [
    (1, 0, [1, 0, 0, 0, 0, 0]),
    (2, 1, [1, 3, 0, 0, 0, 0]),
    (3, 1, [1, 3, 1, 0, 0, 0]),
    (3, 2, [1, 1, 1, 0, 0, 0]),
    (4, 1, [1, 1, 3, 3, 0, 0]),
    (4, 4, [1, 3, 5, 13, 0, 0]),
    (5, 2, [1, 1, 5, 5, 17, 0]),
    (5, 4, [1, 1, 5, 5, 5, 0]),
    (5, 7, [1, 1, 7, 11, 19, 0]),
    (5, 11, [1, 1, 5, 1, 1, 0]),
    (5, 13, [1, 1, 1, 3, 11, 0]),
    (5, 14, [1, 3, 5, 5, 31, 0]),
    (6, 1, [1, 3, 3, 9, 7, 49]),
    (6, 13, [1, 1, 1, 15, 21, 21]),
    (6, 16, [1, 3, 1, 13, 27, 49]),
];

/// Generator matrices: the columns of one dimension, the highest bit first after the point.
pub static SOBOL_MATRICES: [[u32; 32]; N_SOBOL_DIMENSIONS] = sobol_matrices();

const fn sobol_matrices() -> [[u32; 32]; N_SOBOL_DIMENSIONS] {
    let mut matrices = [[0_u32; 32]; N_SOBOL_DIMENSIONS];
    let mut column = 0;
    while column < 32 {
        matrices[0][column] = 1 << (31 - column);
        column += 1;
    }
    let mut dimension = 1;
    while dimension < N_SOBOL_DIMENSIONS {
        let (degree, coefficients, initial) = JOE_KUO[dimension - 1];
        let s = degree as usize;
        let mut v = [0_u32; 32];
        let mut i = 0;
        while i < 32 {
            if i < s {
                v[i] = initial[i] << (31 - i);
            } else {
                // v_i = a_1 v_(i-1) + ... + a_(s-1) v_(i-s+1) + v_(i-s) + v_(i-s) / 2^s
                v[i] = v[i - s] ^ (v[i - s] >> s);
                let mut k = 1;
                while k < s {
                    if (coefficients >> (s - 1 - k)) & 1 == 1 {
                        v[i] ^= v[i - k];
                    }
                    k += 1;
                }
            }
            i += 1;
        }
        matrices[dimension] = v;
        dimension += 1;
    }
    matrices
}

/// Binary digits of coordinate `dimension` of point `i` of the Sobol sequence.
///
/// # Panics
/// If `dimension` is not below [`N_SOBOL_DIMENSIONS`].
#[must_use]
pub fn sobol_bits(mut i: u32, dimension: usize) -> u32 {
    let mut bits = 0;
    for column in &SOBOL_MATRICES[dimension] {
        if i == 0 {
            break;
        }
        if i & 1 == 1 {
            bits ^= column;
        }
        i >>= 1;
    }
    bits
}

/// Coordinate `dimension` of point `i` of the Sobol sequence.
#[must_use]
pub fn sobol(i: u32, dimension: usize) -> f32 {
    unit_f32(sobol_bits(i, dimension))
}

/// Laine and Karras' hash, with constants by Vegdahl 2021: bit k of the result depends on bits 0..=k only, so that it
/// is Owen's scrambling of bits read from the lowest up.
#[inline]
#[must_use]
pub const fn laine_karras(mut x: u32, seed: u32) -> u32 {
    x ^= x.wrapping_mul(0x3d20_adea);
    x = x.wrapping_add(seed);
    x = x.wrapping_mul((seed >> 16) | 1);
    x ^= x.wrapping_mul(0x0552_6c56);
    x ^ x.wrapping_mul(0x53a2_2864)
}

/// Owen's scrambling in base 2 of the digits `bits`, chosen by `seed`.
#[inline]
#[must_use]
pub const fn owen_scramble(bits: u32, seed: u32) -> u32 {
    laine_karras(bits.reverse_bits(), seed).reverse_bits()
}

/// Element `i` of a random permutation of `0..n` (Kensler 2013, "Correlated Multi-Jittered Sampling": a hash that is
/// bijective on the next power of two, repeated until it falls into the range).
///
/// # Panics
/// If `i` is not below `n`.
#[must_use]
pub fn permutation_element(i: u32, n: u32, seed: u32) -> u32 {
    assert!(i < n, "element {i} of a permutation of {n}");
    let mask = n.next_power_of_two().wrapping_sub(1);
    let shift = mask.count_ones().div_ceil(2).max(1);
    let keys = mix64(u64::from(seed) << 32 | u64::from(n));
    let mut x = i;
    loop {
        let mut key = keys;
        for _ in 0..4 {
            // Each step is a bijection of the masked bits.
            x = x.wrapping_add(key as u32) & mask;
            x = x.wrapping_mul((key >> 32) as u32 | 1) & mask;
            x ^= x >> shift;
            key = key.rotate_right(17);
        }
        if x < n {
            return x;
        }
    }
}

/// Star discrepancy of points in the unit square: the largest difference between the area of a box at the
/// origin and the share of the points in it. Exact, in O(n^2) steps.
#[must_use]
pub fn star_discrepancy(points: &[Point2]) -> f64 {
    let n = points.len() as f64;
    let mut by_x: Vec<(f64, f64)> = points.iter().map(|p| (f64::from(p.x), f64::from(p.y))).collect();
    by_x.sort_by(|a, b| a.0.total_cmp(&b.0));
    let mut result = 0.0_f64;
    // Sorted y of the points whose x is at most that of the box. The extreme boxes end at coordinates of points or at 1.
    let mut ys: Vec<f64> = Vec::with_capacity(points.len());
    for k in 0..=by_x.len() {
        // Open boxes up to x of point k hold the points before it; closed boxes up to x of point k - 1 hold the same.
        let open_x = by_x.get(k).map_or(1.0, |p| p.0);
        let closed_x = if k == 0 { 0.0 } else { by_x[k - 1].0 };
        for count in 0..=ys.len() {
            let open_y = ys.get(count).copied().unwrap_or(1.0);
            let closed_y = if count == 0 { 0.0 } else { ys[count - 1] };
            let share = count as f64 / n;
            result = result.max(open_x * open_y - share).max(share - closed_x * closed_y);
        }
        if let Some(p) = by_x.get(k) {
            ys.insert(ys.partition_point(|y| *y < p.1), p.1);
        }
    }
    result
}

#[cfg(test)]
mod tests;
