//! Irradiance that is computed before anyone asks (Christensen 1999, "Faster Photon Map Global Illumination"; SPEC OPT-13).
//!
//! At photons of the map the irradiance is estimated once. A surface then takes that of the nearest one whose normal is
//! similar: one photon is looked for in place of a hundred. The places are as dense as the photons, so that what the answer
//! lacks in detail is below what the estimate had blurred anyway. Where the nearest place is far for the density that its
//! estimate found, light falls off in between, and there is no answer: the surface has to ask the map.
//!
//! For Lambert's surfaces alone, to which irradiance is all that counts.

use etendue_geometry::points::{Neighbours, PackedPoints};
use etendue_math::Point3;
use etendue_math::Vector3;
use etendue_spectrum::Xyz;
use rayon::prelude::*;

use super::fill::Arrival;
use super::lit_map::LitMap;
use crate::integrator::{Control, RayCounts};
use crate::photon::estimate::{EstimateScratch, irradiance};

/// Places that are looked at for one with a similar normal.
const N_CANDIDATES: usize = 4;
/// The least cosine between similar normals.
const LEAST_COSINE: f32 = 0.9;
/// Places are expected within the mean distance of neighbours; as a share of that, squared, beyond which there is no answer.
const FAR_SQUARED: f32 = 9.0;
/// Places of a task: results are the same for any number of threads.
const PLACES_PER_TASK: usize = 1024;

/// Irradiance at places of a map.
#[derive(Clone, Debug, Default)]
pub(crate) struct Precomputed {
    points: PackedPoints,
    /// In the order of the points.
    places: Vec<Place>,
    /// True if every photon of the map is a place.
    is_whole: bool,
}

#[derive(Clone, Copy, Debug)]
struct Place {
    n: Vector3,
    irradiance: Xyz,
    /// Beyond this squared distance it says nothing.
    reach_squared: f32,
}

impl Precomputed {
    /// The irradiance at places where photons of a map arrived, one of `step`. What it says is of no use if the render was
    /// cancelled meanwhile.
    #[must_use]
    pub(crate) fn new(map: &LitMap, arrivals: &[Arrival], step: usize, control: &Control<'_>) -> Self {
        let positions: Vec<Point3> = arrivals.iter().map(|arrival| arrival.p).collect();
        let (points, order) = PackedPoints::new(&positions);
        let places = order
            .par_chunks(PLACES_PER_TASK)
            .flat_map_iter(|chunk| {
                let mut scratch = EstimateScratch::default();
                let ask = |index: &u32| place(map, arrivals[*index as usize], step, &mut scratch);
                let chunk = if control.is_cancelled() { &[] } else { chunk };
                let places: Vec<Place> = chunk.iter().map(ask).collect();
                control.tile_done(0, RayCounts::default());
                places
            })
            .collect();
        Self { points, places, is_whole: step == 1 }
    }

    /// The irradiance at a place on the side of the unit normal; `None` if the map has to be asked.
    #[inline]
    #[must_use]
    pub(crate) fn irradiance(
        &self,
        p: Point3,
        n: Vector3,
        max_radius: f32,
        found: &mut Neighbours,
    ) -> Option<Xyz> {
        self.points.nearest(p, N_CANDIDATES, max_radius, found);
        if found.iter().len() == 0 {
            // Nothing within the radius: neither has the map, unless it holds photons that are no places.
            return self.is_whole.then(Xyz::default);
        }
        let similar = found.iter().filter_map(|near| {
            let place = &self.places[near.index as usize];
            (place.n.dot(n) > LEAST_COSINE).then_some((near.distance_squared, near.index, place))
        });
        let (distance_squared, _, place) = similar.min_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)))?;
        (distance_squared <= place.reach_squared).then_some(place.irradiance)
    }
}

fn place(map: &LitMap, Arrival { p, n }: Arrival, step: usize, scratch: &mut EstimateScratch) -> Place {
    let n = n.as_vector();
    let wanted = map.estimate.search_size(map.k);
    map.map.nearest(p, wanted, map.max_radius, &mut scratch.found);
    let (irradiance, density) = irradiance(&map.estimate, (p, n), wanted, &map.map, scratch);
    let n_photons = density.n_photons.max(1) as f32;
    let spacing_squared = density.radius * density.radius / n_photons * step as f32;
    Place { n, irradiance, reach_squared: FAR_SQUARED * spacing_squared }
}
