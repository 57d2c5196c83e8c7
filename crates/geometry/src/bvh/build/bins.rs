//! The search for the cheapest plane between bins of centroids (Wald 2007).

use glam::Vec4;
use rayon::prelude::*;

use super::primitive::{Box4, BuildPrimitive};
use super::{CHUNK, PARALLEL_BINNING, leaf_cost};

/// Most bins per axis; ranges of few primitives take fewer.
const MAX_BINS: usize = 32;

/// How centroids map to bins.
#[derive(Clone, Copy, Debug)]
pub(super) struct Binning {
    min: Vec4,
    /// Bins per unit of length; 0 for an axis along which centroids do not differ.
    scale: Vec4,
    n_bins: usize,
}

/// Added to a number of small magnitude it leaves the nearest integer in the lowest bits.
const ROUND: f32 = 12_582_912.0;

impl Binning {
    /// Bins for `n` primitives with centroids in this box.
    fn new(centres: &Box4, n: usize) -> Self {
        let n_bins = (4 + n / 16).min(MAX_BINS);
        let extent = (centres.max - centres.min).to_array();
        let scale = |axis: usize| {
            let scale = n_bins as f32 * 0.9999 / extent[axis];
            if extent[axis].is_finite() && scale.is_finite() { scale } else { 0.0 }
        };
        Self { min: centres.min, scale: Vec4::new(scale(0), scale(1), scale(2), 0.0), n_bins }
    }

    /// The bin on each axis.
    #[inline(always)]
    fn bins(&self, primitive: &BuildPrimitive) -> [usize; 3] {
        let place = (primitive.centre() - self.min) * self.scale - Vec4::splat(0.5);
        let [x, y, z, _] = (place + Vec4::splat(ROUND)).to_array();
        [x, y, z].map(|place| place.to_bits() as usize & (MAX_BINS - 1))
    }

    /// The bin on one axis.
    #[inline(always)]
    pub(super) fn bin(&self, primitive: &BuildPrimitive, axis: usize) -> usize {
        self.bins(primitive)[axis]
    }
}

/// The cheapest split found.
#[derive(Clone, Copy, Debug)]
pub(super) struct Candidate {
    pub(super) cost: f32,
    pub(super) axis: usize,
    /// First bin of the second part.
    pub(super) bin: usize,
    pub(super) binning: Binning,
    pub(super) left: Box4,
    pub(super) right: Box4,
}

/// Boxes and numbers of primitives per bin and axis.
#[derive(Clone)]
struct Bins {
    bounds: [[Box4; MAX_BINS]; 3],
    n: [[u32; MAX_BINS]; 3],
}

impl Bins {
    const EMPTY: Self = Self { bounds: [[Box4::EMPTY; MAX_BINS]; 3], n: [[0; MAX_BINS]; 3] };

    fn fill(primitives: &[BuildPrimitive], binning: &Binning) -> Self {
        let mut bins = Self::EMPTY;
        for primitive in primitives {
            for (axis, bin) in binning.bins(primitive).into_iter().enumerate() {
                bins.bounds[axis][bin].grow(primitive.bounds());
                bins.n[axis][bin] += 1;
            }
        }
        bins
    }

    fn merge(mut self, other: &Self) -> Self {
        for axis in 0..3 {
            for bin in 0..MAX_BINS {
                self.bounds[axis][bin].grow(&other.bounds[axis][bin]);
                self.n[axis][bin] += other.n[axis][bin];
            }
        }
        self
    }
}

/// The split of least cost, if centroids differ. Minima, maxima and integer sums are exact, so that working in
/// parallel does not change the result.
pub(super) fn best_split(primitives: &[BuildPrimitive], centres: &Box4) -> Option<Candidate> {
    let binning = Binning::new(centres, primitives.len());
    let bins = if primitives.len() < PARALLEL_BINNING {
        Bins::fill(primitives, &binning)
    } else {
        primitives
            .par_chunks(CHUNK)
            .map(|chunk| Bins::fill(chunk, &binning))
            .reduce(|| Bins::EMPTY, |a, b| a.merge(&b))
    };
    let mut best: Option<(f32, usize, usize)> = None;
    for axis in 0..3 {
        if binning.scale[axis] == 0.0 {
            continue;
        }
        let (bounds, n) = (&bins.bounds[axis][..binning.n_bins], &bins.n[axis][..binning.n_bins]);
        if let Some((cost, bin)) = best_plane(bounds, n)
            && best.is_none_or(|(least, ..)| cost < least)
        {
            best = Some((cost, axis, bin));
        }
    }
    best.map(|(cost, axis, bin)| {
        let (left, right) = bins.bounds[axis][..binning.n_bins].split_at(bin);
        let union = |bounds: &[Box4]| bounds.iter().fold(Box4::EMPTY, Box4::union);
        Candidate { cost, axis, bin, binning, left: union(left), right: union(right) }
    })
}

/// The cheapest plane between bins of an axis: its cost and the bin behind it.
fn best_plane(bounds: &[Box4], n: &[u32]) -> Option<(f32, usize)> {
    let mut right_costs = [0.0_f32; MAX_BINS];
    let mut right = Box4::EMPTY;
    let mut n_right = 0;
    for bin in (1..bounds.len()).rev() {
        right.grow(&bounds[bin]);
        n_right += n[bin];
        right_costs[bin] = right.half_area() * leaf_cost(n_right as usize);
    }
    let mut best: Option<(f32, usize)> = None;
    let mut left = Box4::EMPTY;
    let mut n_left = 0;
    for bin in 1..bounds.len() {
        left.grow(&bounds[bin - 1]);
        n_left += n[bin - 1];
        // An empty side has the area infinity times 0 blocks: not a number, which is no cost.
        let cost = left.half_area() * leaf_cost(n_left as usize) + right_costs[bin];
        if cost.is_finite() && best.is_none_or(|(least, _)| cost < least) {
            best = Some((cost, bin));
        }
    }
    best
}
