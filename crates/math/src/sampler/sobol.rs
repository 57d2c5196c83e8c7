//! Owen-scrambled Sobol points, dealt by the vertices of a path (Burley 2020, "Practical Hash-based Owen Scrambling").
//!
//! Numbers come in groups of seven dimensions that are even together. A group holds what the integrand of one path segment
//! depends on: where the segment starts and where light is then sampled. So group 0 has the place in the pixel, the
//! wavelength, and the light of the first vertex; group k the direction in which vertex k scatters and the light of vertex
//! k + 1. Each group shuffles the order of the points and scrambles their digits on its own; a shuffle that is itself an Owen
//! scrambling of the index keeps every prefix of 2^m samples a net. Between groups the error falls as N^(-1/2).
//!
//! Within a group the index is multiplied over GF(2) by
//! (I, P) for the direction, P Pascal's triangle modulo 2; (M, P M) for the point on the light; Q0 for the choice of the light;
//! Q1, Q2 for the choice of the lobe (wavelength) and for roulette. I and P are the first two Sobol matrices. All are unit
//! upper triangular, so that each number alone is stratified; M only re-orders samples, so that both pairs are
//! (0,2)-sequences: of 2^m samples, one lies in each elementary interval of area 2^-m. M, Q0, Q1, Q2 were found by beam
//! search. Of (I, P, M, P M) every box of volume 2^(t-m) holds its 2^t of 2^m samples with t <= 2 up to 2^9 samples and
//! t <= 4 up to 2^19; of (M, P M, Q0) with t <= 2 up to 2^6 and 3 up to 2^16; of (I, P, Q1) and (I, P, Q2) with t <= 3 up to
//! 2^16. (The first four dimensions of Joe and Kuo have t <= 3, but 2 within their second pair.)

use super::group::Group;
use crate::Point2;
use crate::low_discrepancy::laine_karras;
use crate::rng::{hash64, mix64};

/// Bits of the index that every group shuffles, each block of samples in its own way; those above keep their order, so that
/// the first samples look up one byte.
const SHUFFLED_BITS: u32 = 8;

#[derive(Clone, Debug)]
pub(super) struct Sobol {
    seed: u64,
    /// The sample index with its bits mirrored.
    mirrored_index: u32,
    /// Those of its bits that are not shuffled.
    kept: u32,
    next_group: u32,
    /// The group whose second half is still to be dealt.
    group: Group,
    /// Numbers of the current vertex and how many are dealt.
    pairs: [Point2; 2],
    singles: [f32; 3],
    n_pairs: u8,
    n_singles: u8,
}

impl Sobol {
    /// Each pixel has points of its own.
    #[inline]
    pub(super) fn new(pixel_seed: u64, sample_index: u64) -> Self {
        // Beyond 2^32 samples a new independent sequence starts.
        let round = sample_index >> 32;
        let seed = if round == 0 { pixel_seed } else { mix64(pixel_seed ^ mix64(round)) };
        Self::start(seed, sample_index as u32, u32::MAX >> SHUFFLED_BITS)
    }

    /// All pixels share one sequence along a curve that fills the image, so that the errors of neighbours cancel (Ahmed and
    /// Wonka 2020, "Screen-Space Blue-Noise Diffusion of Monte Carlo Sampling Error via Hierarchical Ordering of
    /// Pixels"). Pixels are numbered in Morton's order; a pixel has as many successive points as samples are planned,
    /// rounded up to a power of two. Further samples start a new sequence, and images that have more than 2^32 points are cut
    /// into squares with sequences of their own.
    #[inline]
    pub(super) fn along_curve(seed: u64, pixel: [u32; 2], planned: u32, sample_index: u64) -> Self {
        let bits = planned.clamp(1, 1 << 20).next_power_of_two().trailing_zeros();
        let axis_bits = (32 - bits) / 2;
        let low = (1_u32 << axis_bits) - 1;
        let square = u64::from(pixel[0] >> axis_bits) << 32 | u64::from(pixel[1] >> axis_bits);
        let seed = hash64(&[seed, u64::from(bits), square, sample_index >> bits]);
        let pixel_index = spread(pixel[0] & low) | spread(pixel[1] & low) << 1;
        let index = pixel_index << bits | (sample_index as u32 & ((1 << bits) - 1));
        Self::start(seed, index, 0)
    }

    #[inline]
    fn start(seed: u64, index: u32, kept: u32) -> Self {
        let mut sampler = Self {
            seed,
            mirrored_index: index.reverse_bits(),
            kept,
            next_group: 0,
            group: Group::default(),
            pairs: [Point2::default(); 2],
            singles: [0.0; 3],
            n_pairs: 0,
            n_singles: 0,
        };
        // At the camera the wavelength and the place in the pixel are dealt first, time and lens from a group of their own.
        let own = sampler.new_group().second_half();
        sampler.group = sampler.new_group();
        let first = sampler.group.first_half();
        sampler.deal(first, own);
        sampler.singles[2] = first[3];
        sampler
    }

    #[inline]
    fn new_group(&mut self) -> Group {
        let key =
            mix64(self.seed.wrapping_add(u64::from(self.next_group).wrapping_mul(0x9e37_79b9_7f4a_7c15)));
        self.next_group += 1;
        let shuffled = laine_karras(self.mirrored_index, key as u32);
        let mirrored = (shuffled & !self.kept) | (self.mirrored_index & self.kept);
        Group::new(mirrored.reverse_bits(), key)
    }

    /// Goes to the next vertex: light by the second half of the last group, scattering by the first half of a new one.
    #[inline]
    pub(super) fn start_vertex(&mut self) {
        let light = self.group.second_half();
        self.group = self.new_group();
        let scattering = self.group.first_half();
        self.deal(light, scattering);
        self.singles[2] = scattering[3];
    }

    #[inline]
    fn deal(&mut self, first: [f32; 4], second: [f32; 4]) {
        self.pairs = [Point2::new(first[0], first[1]), Point2::new(second[0], second[1])];
        self.singles[0] = first[2];
        self.singles[1] = second[2];
        self.n_pairs = 0;
        self.n_singles = 0;
    }

    #[inline]
    pub(super) fn next_1d(&mut self) -> f32 {
        if self.n_singles == 3 {
            self.start_vertex();
        }
        let x = self.singles[usize::from(self.n_singles % 3)];
        self.n_singles += 1;
        x
    }

    #[inline]
    pub(super) fn next_2d(&mut self) -> Point2 {
        if self.n_pairs == 2 {
            self.start_vertex();
        }
        let p = self.pairs[usize::from(self.n_pairs % 2)];
        self.n_pairs += 1;
        p
    }
}

/// The bits with a zero between any two: half of Morton's order.
#[inline]
const fn spread(mut x: u32) -> u32 {
    x = (x | x << 8) & 0x00ff_00ff;
    x = (x | x << 4) & 0x0f0f_0f0f;
    x = (x | x << 2) & 0x3333_3333;
    (x | x << 1) & 0x5555_5555
}
