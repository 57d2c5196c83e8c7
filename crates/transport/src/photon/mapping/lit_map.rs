//! A photon map with all that its estimate needs.

use etendue_geometry::points::Neighbours;
use etendue_math::{Point3, Vector3};
use etendue_scene::Scene;
use etendue_scene::bsdf::{Bsdf, Lobes};
use etendue_scene::scene::Surface;
use etendue_spectrum::{Sampled, Wavelengths, Xyz};

use super::plan::MapPlan;
use crate::lpe::Event;
use crate::photon::Trail;
use crate::photon::estimate::radiance::{LitPlace, radiance};
use crate::photon::estimate::{Density, EstimateScratch, MapEstimate, Photons};
use crate::photon::map::PhotonMap;

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

/// A photon map that surfaces can ask.
#[derive(Clone, Debug)]
pub(crate) struct LitMap {
    /// The photons.
    pub(crate) map: PhotonMap,
    /// How it is asked.
    pub(crate) estimate: MapEstimate,
    /// What there is to say of it.
    pub(crate) asked: Asked,
}

/// What was asked of a map.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Asked {
    /// Photons to be stored; 0 if the map is from a file.
    pub(crate) n_photons: u64,
    /// Whether the greatest radius was given.
    pub(crate) has_radius: bool,
    /// If it was, and is too small at most of the photons for as many as an estimate wants: one that is not, in metres.
    pub(crate) sufficient_radius: Option<f32>,
    /// Diagonal of the scene in metres.
    pub(crate) scene_size: f32,
}

/// Photons whose surroundings tell how dense a map is.
const N_PROBES: usize = 1000;
/// Of their radii, the one that most do not exceed, and what it is multiplied by to be the greatest radius of all.
const PROBE_QUANTILE: f64 = 0.95;
const RADIUS_MARGIN: f32 = 1.25;
/// Share of the photons around which a radius that was given may hold too few.
const MANY_SHORT: f32 = 0.5;
/// Where a map has no more photons than an estimate wants: this share of the diagonal of the scene.
const RADIUS_OF_FEW: f32 = 0.25;

impl LitMap {
    /// A map that is asked as planned.
    #[must_use]
    pub(crate) fn new(scene: &Scene, plan: &MapPlan, map: PhotonMap) -> Self {
        let k = plan.k.max(1);
        let max_radius = plan.max_radius.unwrap_or_else(|| fitting_radius(scene, &map, k));
        let sufficient = plan.max_radius.and_then(|_| map.radius_from_density(k, MANY_SHORT));
        let asked = Asked {
            n_photons: if plan.file.is_some() { 0 } else { plan.n_photons },
            has_radius: plan.max_radius.is_some(),
            sufficient_radius: sufficient.filter(|radius| *radius > max_radius),
            scene_size: scene.bounds().diagonal().length(),
        };
        Self { map, estimate: MapEstimate { density: plan.estimate, k, max_radius }, asked }
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
        let place = LitPlace { p: surface.point.p, wo: surface.wo, bsdf, lobes, lambda };
        let found = self.estimate.radiance(&self.map, &place, scratch);
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
        let wanted = self.estimate.find(&self.map, surface.point.p, scratch);
        let mut numbers: Vec<usize> =
            scratch.found.iter().map(|near| self.map.photon(near.index).trail_number()).collect();
        numbers.sort_unstable();
        numbers.dedup();
        let place = LitPlace { p: surface.point.p, wo: surface.wo, bsdf, lobes, lambda };
        for number in numbers {
            let Some(trail) = self.map.trails().get(number) else { continue };
            let photons = OfTrail { map: &self.map, number };
            show(*trail, radiance(&self.estimate.density, &place, wanted, &photons, scratch).radiance);
        }
    }
}

/// A radius that holds as many photons as are wanted wherever most of the photons are.
fn fitting_radius(scene: &Scene, map: &PhotonMap, k: usize) -> f32 {
    let diagonal = scene.bounds().diagonal().length();
    let radius_of_few = if diagonal.is_finite() { RADIUS_OF_FEW * diagonal } else { 1.0 };
    if map.len() <= k {
        return radius_of_few;
    }
    let (mut found, mut radii) = (Neighbours::new(), Vec::new());
    let step = (map.len() / N_PROBES).max(1);
    for place in (0..map.len()).step_by(step) {
        map.nearest(map.photon(place as u32).position(), k + 1, f32::INFINITY, &mut found);
        let farthest = found.iter().map(|near| near.distance_squared).fold(0.0, f32::max);
        radii.push(farthest.sqrt());
    }
    radii.sort_by(f32::total_cmp);
    let radius = radii[((radii.len() - 1) as f64 * PROBE_QUANTILE) as usize] * RADIUS_MARGIN;
    // Photons may all lie at one point, where they would be seen by nobody.
    if radius > 0.0 { radius } else { radius_of_few }
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
