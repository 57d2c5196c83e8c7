//! Pseudo-random numbers and hashing.
//!
//! The generator is PCG32 (O'Neill 2014, "PCG: A Family of Simple Fast Space-Efficient Statistically Good Algorithms
//! for Random Number Generation"): a linear congruence `s' = a s + c (mod 2^64)` whose state is permuted to 32 bits.
//! The hash is the finaliser of Stafford's variant 13 of MurmurHash3, chained over the words. Neither is meant for
//! secrets; both are fixed, so that a seed means the same image on every machine.

/// The largest `f32` below 1: the end of every random number's range.
pub const ONE_MINUS_EPSILON: f32 = 1.0 - f32::EPSILON / 2.0;

const MULTIPLIER: u64 = 0x5851_f42d_4c95_7f2d;

/// Bijective mixing of 64 bits: every input bit changes every output bit with probability about 1/2.
#[inline]
#[must_use]
pub const fn mix64(mut x: u64) -> u64 {
    x ^= x >> 30;
    x = x.wrapping_mul(0xbf58_476d_1ce4_e5b9);
    x ^= x >> 27;
    x = x.wrapping_mul(0x94d0_49bb_1331_11eb);
    x ^ (x >> 31)
}

/// A hash of a sequence of words; sequences of different length or order differ.
#[inline]
#[must_use]
pub const fn hash64(words: &[u64]) -> u64 {
    let mut h = 0x9e37_79b9_7f4a_7c15_u64 ^ (words.len() as u64);
    let mut i = 0;
    while i < words.len() {
        h = mix64(
            h.wrapping_add(0x9e37_79b9_7f4a_7c15) ^ mix64(words[i].wrapping_add(0xd1b5_4a32_d192_ed03)),
        );
        i += 1;
    }
    h
}

/// The number in [0, 1) whose binary digits are `bits`.
#[inline]
#[must_use]
pub fn unit_f32(bits: u32) -> f32 {
    (bits as f32 * (1.0 / 4_294_967_296.0)).min(ONE_MINUS_EPSILON)
}

/// The number in [0, 1) whose binary digits are the upper 53 of `bits`.
#[inline]
#[must_use]
pub fn unit_f64(bits: u64) -> f64 {
    (bits >> 11) as f64 * (1.0 / 9_007_199_254_740_992.0)
}

/// A PCG32 generator: 2^63 independent streams of period 2^64.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Rng {
    state: u64,
    increment: u64,
}

impl Rng {
    /// The start of stream number `stream` for this seed.
    #[inline]
    #[must_use]
    pub const fn new(seed: u64, stream: u64) -> Self {
        let increment = (stream << 1) | 1;
        let state = increment.wrapping_add(seed).wrapping_mul(MULTIPLIER).wrapping_add(increment);
        Self { state, increment }
    }

    /// 32 uniform bits.
    #[inline]
    pub fn next_u32(&mut self) -> u32 {
        let old = self.state;
        self.state = old.wrapping_mul(MULTIPLIER).wrapping_add(self.increment);
        let xor_shifted = (((old >> 18) ^ old) >> 27) as u32;
        xor_shifted.rotate_right((old >> 59) as u32)
    }

    /// 64 uniform bits.
    #[inline]
    pub fn next_u64(&mut self) -> u64 {
        let high = u64::from(self.next_u32());
        high << 32 | u64::from(self.next_u32())
    }

    /// Uniform in [0, 1).
    #[inline]
    pub fn next_f32(&mut self) -> f32 {
        unit_f32(self.next_u32())
    }

    /// Uniform in [0, 1) with 53 random bits.
    #[inline]
    pub fn next_f64(&mut self) -> f64 {
        unit_f64(self.next_u64())
    }

    /// Uniform in the unit square.
    #[inline]
    pub fn next_point2(&mut self) -> crate::Point2 {
        let x = self.next_f32();
        crate::Point2::new(x, self.next_f32())
    }

    /// Uniform among `0..n` without bias (Lemire 2019, "Fast Random Integer Generation in an Interval").
    ///
    /// # Panics
    /// If `n` is 0.
    #[inline]
    pub fn next_below(&mut self, n: u32) -> u32 {
        assert!(n > 0, "no number lies below 0");
        let threshold = n.wrapping_neg() % n;
        loop {
            let product = u64::from(self.next_u32()) * u64::from(n);
            if product as u32 >= threshold {
                return (product >> 32) as u32;
            }
        }
    }

    /// Skips `delta` calls of `next_u32` in O(log delta) steps; negative steps wrap around the period
    /// (Brown 1994, "Random Number Generation with Arbitrary Strides").
    pub fn advance(&mut self, mut delta: u64) {
        let mut multiplier = MULTIPLIER;
        let mut increment = self.increment;
        let mut total_multiplier = 1_u64;
        let mut total_increment = 0_u64;
        while delta > 0 {
            if delta & 1 == 1 {
                total_multiplier = total_multiplier.wrapping_mul(multiplier);
                total_increment = total_increment.wrapping_mul(multiplier).wrapping_add(increment);
            }
            increment = multiplier.wrapping_add(1).wrapping_mul(increment);
            multiplier = multiplier.wrapping_mul(multiplier);
            delta >>= 1;
        }
        self.state = total_multiplier.wrapping_mul(self.state).wrapping_add(total_increment);
    }
}

#[cfg(test)]
mod tests;
