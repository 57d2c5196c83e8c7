//! A photon map with all that its estimate needs, and how it is filled.

use etendue_geometry::points::Neighbours;
use etendue_math::{Normal3, Point3, Vector3};
use etendue_scene::Scene;
use etendue_scene::bsdf::{Bsdf, Lobes};
use etendue_scene::scene::Surface;
use etendue_spectrum::{Sampled, Wavelengths, Xyz, flux_to_xyz};

use crate::integrator::Control;
use crate::lpe::Event;
use crate::photon::estimate::radiance::{LitPlace, radiance};
use crate::photon::estimate::{Density, DensityEstimate, EstimateScratch, Photons};
use crate::photon::map::{PhotonMap, StoredPhoton};
use crate::photon::walk::trace_photons_until;
use crate::photon::{Absorption, Onward, PhotonEmitter, PhotonVertex, PhotonWalk, Trail};

/// The lobes of a surface that photons light: all but mirrors and what is nearly as sharp, which rays are for (SPEC LPE-5).
#[inline]
#[must_use]
pub(crate) fn wide_lobes(bsdf: &Bsdf, sharp_alpha: f32) -> Lobes {
    let lobes = bsdf.lobes();
    if !lobes.is_glossy() {
        return lobes & Lobes::DIFFUSE;
    }
    match Event::glossy(bsdf.glossy_roughness(), sharp_alpha) {
        Event::WideGlossy => lobes & Lobes::NON_SPECULAR,
        _ => lobes & Lobes::DIFFUSE,
    }
}

/// Which photons are kept.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Content {
    /// `L(S|D)*D`.
    All,
    /// Those that a surface has scattered: `L(S|D)+D`.
    Scattered,
    /// `LS+D`.
    Caustic,
}

impl Content {
    fn holds(self, trail: Trail) -> bool {
        match self {
            Self::All => true,
            Self::Scattered => !trail.is_empty(),
            Self::Caustic => trail.is_caustic(),
        }
    }

    /// True if a photon may yet come to what is kept, from a surface with these sharp lobes.
    fn may_follow(self, trail: Trail, is_sharp: bool) -> bool {
        self != Self::Caustic || is_sharp && (trail.is_empty() || trail.is_caustic())
    }
}

/// A map to be filled.
#[derive(Clone, Copy, Debug)]
pub(crate) struct MapPlan {
    /// Photons to store, about.
    pub(crate) n_photons: u64,
    /// Which.
    pub(crate) content: Content,
    /// How they walk.
    pub(crate) walk: PhotonWalk,
    /// Photons of each estimate.
    pub(crate) k: usize,
    /// The greatest radius of an estimate in metres; `None` for one that fits the density.
    pub(crate) max_radius: Option<f32>,
    /// How density is estimated.
    pub(crate) estimate: DensityEstimate,
    /// The place of one of so many photons is told; 0 for none.
    pub(crate) place_step: usize,
}

/// A photon map that surfaces can ask.
#[derive(Clone, Debug)]
pub(crate) struct LitMap {
    /// The photons.
    pub(crate) map: PhotonMap,
    /// Photons of each estimate.
    pub(crate) k: usize,
    /// The greatest radius of an estimate in metres.
    pub(crate) max_radius: f32,
    /// How density is estimated.
    pub(crate) estimate: DensityEstimate,
}

/// Where a photon arrived, and the geometric normal on the side that it came from.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Arrival {
    /// Place.
    pub(crate) p: Point3,
    /// Normal.
    pub(crate) n: Normal3,
}

/// A photon on its way into a map, with its number among those that were emitted.
#[derive(Clone, Copy, Debug)]
struct Shot {
    index: u64,
    photon: StoredPhoton,
    n: Normal3,
}

/// The most photons that are emitted for each one that is to be stored.
const MOST_EMITTED: u64 = 30;
/// The least that are emitted: without any by then, there is nothing to be found.
const LEAST_EMITTED: u64 = 20_000;
/// After so many in vain there is nothing to be found, such as caustics where nothing mirrors or refracts.
const FRUITLESS: u64 = 200_000;
/// Photons whose surroundings tell how dense a map is.
const N_PROBES: usize = 1000;
/// Of their radii, the one that most do not exceed, and what it is multiplied by to be the greatest radius of all.
const PROBE_QUANTILE: f64 = 0.95;
const RADIUS_MARGIN: f32 = 1.25;
/// Where a map has no more photons than an estimate wants: this share of the diagonal of the scene.
const RADIUS_OF_FEW: f32 = 0.25;

impl LitMap {
    /// Emits photons until there are as many as planned, or as many were emitted as is worthwhile. Places where they arrived
    /// come with it. `None` if the render was cancelled meanwhile.
    #[must_use]
    pub(crate) fn fill(
        scene: &Scene,
        emitter: &PhotonEmitter,
        plan: &MapPlan,
        control: &Control<'_>,
    ) -> Option<(Self, Vec<Arrival>)> {
        let mut shots: Vec<Shot> = Vec::new();
        let mut n_emitted = 0;
        let most = plan.n_photons.saturating_mul(MOST_EMITTED).max(LEAST_EMITTED);
        // Of photons that branch few are enough to tell how many are kept.
        let first = if plan.walk.absorption == Absorption::Branch { 1 << 11 } else { 1 << 20 };
        let mut next = if emitter.is_dark() { 0 } else { (plan.n_photons / 4).min(first) };
        while next > 0 || n_emitted == 0 && plan.n_photons > 0 && !emitter.is_dark() {
            let range = n_emitted..n_emitted + next.max(1);
            n_emitted = range.end;
            let keep =
                |index, vertex: &PhotonVertex<'_>, kept: &mut Vec<Shot>| visit(plan, index, vertex, kept);
            let (more, _) = trace_photons_until(scene, emitter, range, &plan.walk, control, keep);
            if control.is_cancelled() {
                return None;
            }
            shots.extend(more);
            next = next_round(plan.n_photons, shots.len() as u64, n_emitted, most);
        }
        if let Some(last) = plan.n_photons.checked_sub(1).and_then(|place| shots.get(place as usize)) {
            // No more than were wanted, but for the rest of the way of the last.
            let last = last.index;
            shots.truncate(shots.partition_point(|shot| shot.index <= last));
            n_emitted = last + 1;
        }
        let n_places = if plan.place_step > 0 { shots.len().div_ceil(plan.place_step) } else { 0 };
        let places = shots.iter().step_by(plan.place_step.max(1)).take(n_places);
        let arrivals = places.map(|shot| Arrival { p: shot.photon.position, n: shot.n }).collect();
        let photons: Vec<StoredPhoton> = shots.iter().map(|shot| shot.photon).collect();
        // There may be many millions: what is not needed any more goes before the map comes.
        drop(shots);
        let map = PhotonMap::from_photons(&photons, n_emitted);
        drop(photons);
        let k = plan.k.max(1);
        let max_radius = plan.max_radius.unwrap_or_else(|| fitting_radius(scene, &map, k));
        Some((Self { map, k, max_radius, estimate: plan.estimate }, arrivals))
    }

    /// Finds the photons around a place, for the estimate.
    fn search(&self, p: Point3, scratch: &mut EstimateScratch) -> usize {
        let wanted = self.estimate.search_size(self.k);
        self.map.nearest(p, wanted, self.max_radius, &mut scratch.found);
        wanted
    }

    /// Radiance that some lobes of a surface make of the photons, towards where it is seen from.
    pub(crate) fn radiance(
        &self,
        surface: &Surface,
        (bsdf, lobes): (&Bsdf, Lobes),
        lambda: &Wavelengths,
        scratch: &mut EstimateScratch,
    ) -> (Sampled, Density) {
        if self.map.is_empty() || lobes.is_empty() {
            return (Sampled::ZERO, Density::default());
        }
        let wanted = self.search(surface.point.p, scratch);
        let place = LitPlace { p: surface.point.p, wo: surface.wo, bsdf, lobes, lambda };
        let found = radiance(&self.estimate, &place, wanted, &self.map, scratch);
        (found.radiance, found.density)
    }

    /// The same for each kind of path by itself.
    pub(crate) fn radiance_by_trail(
        &self,
        surface: &Surface,
        (bsdf, lobes): (&Bsdf, Lobes),
        lambda: &Wavelengths,
        scratch: &mut EstimateScratch,
        mut show: impl FnMut(Trail, Sampled),
    ) {
        if self.map.is_empty() || lobes.is_empty() {
            return;
        }
        let wanted = self.search(surface.point.p, scratch);
        let mut numbers: Vec<usize> =
            scratch.found.iter().map(|near| self.map.photon(near.index).trail_number()).collect();
        numbers.sort_unstable();
        numbers.dedup();
        let place = LitPlace { p: surface.point.p, wo: surface.wo, bsdf, lobes, lambda };
        for number in numbers {
            let Some(trail) = self.map.trails().get(number) else { continue };
            let photons = OfTrail { map: &self.map, number };
            show(*trail, radiance(&self.estimate, &place, wanted, &photons, scratch).radiance);
        }
    }
}

/// Keeps a photon that belongs into the map.
fn visit(plan: &MapPlan, index: u64, vertex: &PhotonVertex<'_>, kept: &mut Vec<Shot>) -> Onward {
    let wide = wide_lobes(vertex.bsdf, plan.walk.sharp_alpha);
    if wide.intersects(vertex.lobes) && plan.content.holds(vertex.trail) {
        let ng = vertex.surface.point.ng;
        let photon = StoredPhoton {
            position: vertex.surface.point.p,
            power: flux_to_xyz(vertex.flux, vertex.lambda),
            wi: vertex.surface.wo,
            trail: vertex.trail,
            is_shadow: false,
        };
        kept.push(Shot { index, photon, n: if ng.dot_vector(photon.wi) < 0.0 { -ng } else { ng } });
    }
    let is_sharp = wide != vertex.bsdf.lobes();
    if plan.content.may_follow(vertex.trail, is_sharp) { Onward::Continue } else { Onward::Stop }
}

/// Photons to emit next, by how many of those so far were stored; 0 to end.
fn next_round(wanted: u64, n_stored: u64, n_emitted: u64, most: u64) -> u64 {
    if n_stored >= wanted || n_emitted >= most {
        return 0;
    }
    if n_stored == 0 {
        return FRUITLESS.min(most).saturating_sub(n_emitted);
    }
    let missing = wanted - n_stored;
    let share = (n_stored as f64 / n_emitted as f64).max(1e-3);
    let needed = (missing as f64 / share * 1.02).ceil() as u64;
    needed.clamp(1000, 1 << 22).min(most - n_emitted)
}

/// A radius that holds as many photons as are wanted wherever most of the photons are.
fn fitting_radius(scene: &Scene, map: &PhotonMap, k: usize) -> f32 {
    if map.len() <= k {
        let diagonal = scene.bounds().diagonal().length();
        return if diagonal.is_finite() { RADIUS_OF_FEW * diagonal } else { 1.0 };
    }
    let (mut found, mut radii) = (Neighbours::new(), Vec::new());
    let step = (map.len() / N_PROBES).max(1);
    for place in (0..map.len()).step_by(step) {
        map.nearest(map.photon(place as u32).position(), k + 1, f32::INFINITY, &mut found);
        let farthest = found.iter().map(|near| near.distance_squared).fold(0.0, f32::max);
        radii.push(farthest.sqrt());
    }
    radii.sort_by(f32::total_cmp);
    radii[((radii.len() - 1) as f64 * PROBE_QUANTILE) as usize] * RADIUS_MARGIN
}

/// The photons of one kind of path; others are dark.
struct OfTrail<'m> {
    map: &'m PhotonMap,
    number: usize,
}

impl Photons for OfTrail<'_> {
    fn position(&self, index: u32) -> Point3 {
        self.map.photon(index).position()
    }

    fn wi(&self, index: u32) -> Vector3 {
        self.map.photon(index).wi()
    }

    fn power(&self, index: u32) -> Xyz {
        let photon = self.map.photon(index);
        if photon.trail_number() == self.number { self.map.power(&photon) } else { Xyz::default() }
    }
}
