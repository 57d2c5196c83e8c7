//! The search for the cheapest plane between bins of centroids (Wald 2007).

use glam::Vec4;
use rayon::prelude::*;

use super::primitive::{Box4, BuildPrimitive};
use super::{CHUNK, PARALLEL_BINNING, leaf_cost};

/// Bins per axis for many primitives.
const MANY: usize = 32;
/// Bins per axis for few.
const FEW: usize = 8;
/// From here on there are many.
const FEW_PRIMITIVES: usize = 32;

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
    /// Maps centroids in this box to `n_bins` bins.
    fn new(centres: &Box4, n_bins: usize) -> Self {
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
        [x, y, z].map(|place| place.to_bits() as usize & (self.n_bins - 1))
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
struct Bins<const N: usize> {
    bounds: [[Box4; N]; 3],
    n: [[u32; N]; 3],
}

impl<const N: usize> Bins<N> {
    const EMPTY: Self = Self { bounds: [[Box4::EMPTY; N]; 3], n: [[0; N]; 3] };

    fn fill(primitives: &[BuildPrimitive], binning: &Binning) -> Self {
        let mut bins = Self::EMPTY;
        for primitive in primitives {
            for (axis, bin) in binning.bins(primitive).into_iter().enumerate() {
                bins.bounds[axis][bin & (N - 1)].grow(primitive.bounds());
                bins.n[axis][bin & (N - 1)] += 1;
            }
        }
        bins
    }

    fn merge(mut self, other: &Self) -> Self {
        for axis in 0..3 {
            for bin in 0..N {
                self.bounds[axis][bin].grow(&other.bounds[axis][bin]);
                self.n[axis][bin] += other.n[axis][bin];
            }
        }
        self
    }

    fn best_split(&self, binning: Binning) -> Option<Candidate> {
        let mut best: Option<(f32, usize, usize)> = None;
        for axis in 0..3 {
            if binning.scale[axis] == 0.0 {
                continue;
            }
            if let Some((cost, bin)) = best_plane(&self.bounds[axis], &self.n[axis])
                && best.is_none_or(|(least, ..)| cost < least)
            {
                best = Some((cost, axis, bin));
            }
        }
        best.map(|(cost, axis, bin)| {
            let (left, right) = self.bounds[axis].split_at(bin);
            let union = |bounds: &[Box4]| bounds.iter().fold(Box4::EMPTY, Box4::union);
            Candidate { cost, axis, bin, binning, left: union(left), right: union(right) }
        })
    }
}

/// The split of least cost, if centroids differ. Minima, maxima and integer sums are exact, so that working in
/// parallel does not change the result.
pub(super) fn best_split(primitives: &[BuildPrimitive], centres: &Box4) -> Option<Candidate> {
    if primitives.len() < FEW_PRIMITIVES {
        let binning = Binning::new(centres, FEW);
        return Bins::<FEW>::fill(primitives, &binning).best_split(binning);
    }
    let binning = Binning::new(centres, MANY);
    let fill = |primitives: &[BuildPrimitive]| Bins::<MANY>::fill(primitives, &binning);
    if primitives.len() < PARALLEL_BINNING {
        return fill(primitives).best_split(binning);
    }
    let bins = primitives.par_chunks(CHUNK).map(fill).reduce(|| Bins::EMPTY, |a, b| a.merge(&b));
    bins.best_split(binning)
}

/// The cheapest plane between bins of an axis: its cost and the bin behind it.
#[inline(always)]
fn best_plane<const N: usize>(bounds: &[Box4; N], n: &[u32; N]) -> Option<(f32, usize)> {
    let mut right_costs = [0.0_f32; N];
    let mut right = Box4::EMPTY;
    let mut n_right = 0;
    for bin in (1..N).rev() {
        right.grow(&bounds[bin]);
        n_right += n[bin];
        right_costs[bin] = right.half_area() * leaf_cost(n_right as usize);
    }
    let mut best = (f32::INFINITY, 0);
    let mut left = Box4::EMPTY;
    let mut n_left = 0;
    for bin in 1..N {
        left.grow(&bounds[bin - 1]);
        n_left += n[bin - 1];
        // An empty side has the area infinity times 0 blocks: not a number, which is no cost.
        let cost = left.half_area() * leaf_cost(n_left as usize) + right_costs[bin];
        if cost < best.0 {
            best = (cost, bin);
        }
    }
    (best.1 != 0).then_some(best)
}
