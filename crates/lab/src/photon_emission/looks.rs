//! What the numbers look like: caustics as patterns draw them, and how power is distributed.

use etendue_image::Image;
use etendue_math::hash64;
use etendue_transport::photon::{
    Absorption, EmissionSettings, Onward, PhotonEmitter, PhotonPattern, Target, trace_photons,
};

use super::{AbsorptionRow, Place, walk};
use crate::plot::{Mark, Series};

/// Photons of a picture: a square number, so that grids are full.
pub(super) const N_PHOTONS: u64 = 1 << 14;
/// Pixels along a side of a picture, and how often each is repeated.
const SIDE: usize = 110;
const ZOOM: usize = 4;
/// Left, front corner of what is shown of the floor, and its side in metres.
const CORNER: [f32; 2] = [-0.215, -0.18];
const WIDTH_M: f32 = 0.28;
/// Ranges of power in a decade.
const PER_DECADE: f64 = 2.0;

/// The caustic of a ball of glass on a floor, seen from above: the flux in each pixel.
pub(super) fn caustics(seed: u64) -> Vec<(&'static str, Image)> {
    let mut scene = Place::Caustic.scene();
    scene.sampler.seed = hash64(&[seed, 4]);
    let target = EmissionSettings { target: Target::SharpShapes, ..EmissionSettings::default() };
    let emitter = PhotonEmitter::aimed(&scene, &target);
    let picture = |(name, pattern): (&'static str, PhotonPattern)| {
        let walk = walk(&scene, pattern.planned(N_PHOTONS), Absorption::Roulette, 10);
        let (places, _) = trace_photons(&scene, &emitter, 0..N_PHOTONS, &walk, |_, vertex, places| {
            if vertex.is_stored() && vertex.trail.is_caustic() {
                let p = vertex.surface.point.p;
                places.extend(pixel([p.x, p.z]));
            }
            Onward::Continue
        });
        let mut counts = vec![0_u32; SIDE * SIDE];
        places.into_iter().for_each(|index: usize| counts[index] += 1);
        // All photons have the same power. White is 32 of them; by the root single ones are seen, too.
        let gray = |x: usize, y: usize| (counts[x / ZOOM + SIDE * (y / ZOOM)] as f32 / 32.0).sqrt();
        (name, Image::from_fn(SIDE * ZOOM, SIDE * ZOOM, |x, y| [gray(x, y).min(1.0); 3]))
    };
    PhotonPattern::NAMES.map(picture).into()
}

fn pixel(p: [f32; 2]) -> Option<usize> {
    let [x, y] = [0, 1].map(|axis| (p[axis] - CORNER[axis]) / WIDTH_M);
    let is_inside = [x, y].iter().all(|t| (0.0..1.0).contains(t));
    let cell = |t: f32| ((t * SIDE as f32) as usize).min(SIDE - 1);
    is_inside.then(|| cell(x) + SIDE * cell(y))
}

/// Power over the mean, and the share of photons within half a decade around it, from the weakest to the strongest.
pub(super) fn shares(lumens: &[f32], mean: f64) -> Vec<[f64; 2]> {
    let ranges = lumens.iter().filter(|power| **power > 0.0);
    let mut ranges: Vec<i32> =
        ranges.map(|power| ((f64::from(*power) / mean).log10() * PER_DECADE).round() as i32).collect();
    ranges.sort_unstable();
    let n = ranges.len() as f64;
    let share = |same: &[i32]| [10.0_f64.powf(f64::from(same[0]) / PER_DECADE), same.len() as f64 / n];
    ranges.chunk_by(|a, b| a == b).map(share).collect()
}

pub(super) fn power_curve(row: &AbsorptionRow) -> Series {
    Series { name: row.name.to_owned(), points: row.shares.clone(), mark: Mark::LineAndDots }
}
