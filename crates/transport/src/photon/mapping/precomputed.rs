//! Irradiance that is computed before anyone asks (Christensen 1999, "Faster Photon Map Global Illumination"; SPEC OPT-13).
//!
//! At places where photons arrived the irradiance is estimated once. A surface then takes that of the nearest place whose normal is
//! similar: one point is looked for in place of a hundred. A place reaches over a part of the radius of its estimate, within which
//! neighbours have mostly the same photons, so that what the answer lacks in detail is below what the estimate had blurred anyway.
//! Beyond the edge of a caustic its places are too far, and those of photons of any other kind tell that it is dark there. Where the
//! nearest place does not reach, the surface has to ask the map.
//!
//! For Lambert's surfaces alone, to which irradiance is all that counts.

use etendue_geometry::points::{Neighbour, PackedPoints};
use etendue_math::{Point3, Vector3};
use etendue_spectrum::Lifted;
use rayon::prelude::*;

use super::fill::Arrival;
use super::lit_map::LitMap;
use crate::integrator::{Control, RayCounts};
use crate::photon::estimate::EstimateScratch;

/// The least cosine between similar normals.
const LEAST_COSINE: f32 = 0.9;
/// How far a place reaches, as a share of the radius of its estimate. Of 100 photons in a disc, one in four of which is a place, none
/// lies so near to a point with probability exp(-25 0.5^2) = 0.002; of 50 photons, 0.04.
const REACH: f32 = 0.5;
/// Places of a task: results are the same for any number of threads.
const PLACES_PER_TASK: usize = 1024;

/// Irradiance at places.
#[derive(Clone, Debug, Default)]
pub(crate) struct Precomputed {
    points: PackedPoints,
    /// In the order of the points: what a search asks for, apart from what it finds, so that it stays near the processor.
    faces: Vec<Face>,
    irradiance: Vec<Lifted>,
}

/// The side of a surface that a place tells of.
#[derive(Clone, Copy, Debug)]
struct Face {
    /// The unit normal times 127.
    n: [i8; 3],
    /// Beyond this squared distance the place says nothing.
    reach_squared: f32,
}

impl Face {
    fn new(n: Vector3, reach_squared: f32) -> Self {
        Self { n: [n.x, n.y, n.z].map(|v| (v * 127.0).round() as i8), reach_squared }
    }

    #[inline]
    fn is_similar(&self, n: Vector3) -> bool {
        let [x, y, z] = self.n.map(f32::from);
        x * n.x + y * n.y + z * n.z > 127.0 * LEAST_COSINE
    }
}

impl Precomputed {
    /// The irradiance by a map at places. What it says is of no use if the render was cancelled meanwhile.
    #[must_use]
    pub(crate) fn new(map: &LitMap, arrivals: &[Arrival], control: &Control<'_>) -> Self {
        let positions: Vec<Point3> = arrivals.iter().map(|arrival| arrival.p).collect();
        let (points, order) = PackedPoints::new(&positions);
        let places: Vec<(Face, Lifted)> = order
            .par_chunks(PLACES_PER_TASK)
            .flat_map_iter(|chunk| {
                let mut scratch = EstimateScratch::default();
                let ask = |index: &u32| place(map, arrivals[*index as usize], &mut scratch);
                let chunk = if control.is_cancelled() { &[] } else { chunk };
                let places: Vec<(Face, Lifted)> = chunk.iter().map(ask).collect();
                control.tile_done(0, RayCounts::default());
                places
            })
            .collect();
        let (faces, irradiance) = places.into_iter().unzip();
        Self { points, faces, irradiance }
    }

    /// The irradiance at a place on the side of the unit normal; `None` if the map has to be asked.
    #[inline]
    #[must_use]
    pub(crate) fn irradiance(&self, p: Point3, n: Vector3, max_radius: f32) -> Option<&Lifted> {
        let is_similar = |near: Neighbour| self.faces[near.index as usize].is_similar(n);
        let nearest = self.points.nearest_of(p, REACH * max_radius, is_similar)?;
        let place = nearest.index as usize;
        (nearest.distance_squared <= self.faces[place].reach_squared).then(|| &self.irradiance[place])
    }
}

fn place(map: &LitMap, Arrival { p, n }: Arrival, scratch: &mut EstimateScratch) -> (Face, Lifted) {
    let n = n.as_vector();
    let (irradiance, density) = map.estimate.irradiance(&map.map, (p, n), scratch);
    let reach = REACH * density.radius;
    (Face::new(n, reach * reach), Lifted::new(irradiance))
}
