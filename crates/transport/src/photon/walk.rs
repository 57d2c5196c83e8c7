//! The walk of a photon: from surface to surface until it is absorbed (SPEC PHT-2 to PHT-10).
//!
//! Where it arrives at a surface that scatters, it is shown to a visitor, who may keep it, connect it or end the walk. Then
//! it is scattered by the density of the surface; roulette by the mean of what that multiplies its flux by keeps the flux of
//! all photons alike. Flux knows no squared index: scattering is that of importance.

use std::ops::Range;

use etendue_math::{Sampler, SamplerSettings};
use etendue_scene::Scene;
use etendue_scene::bsdf::{Bsdf, Lobes, TransportMode};
use etendue_scene::light::LightId;
use etendue_scene::medium::MediumId;
use etendue_scene::scene::Surface;
use etendue_spectrum::{Sampled, Wavelengths};
use rayon::prelude::*;

use super::{EmittedPhoton, PhotonEmitter, Trail};
use crate::integrator::RayCounts;
use crate::lpe::{Event, SHARP_ALPHA};
use crate::path::camera_pass::{Tracer, WavelengthMode};
use crate::path::roulette::reflect_or_absorb;

/// How photons walk.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PhotonWalk {
    /// Most scattering events.
    pub max_depth: u32,
    /// Glossy events narrower than this are sharp.
    pub sharp_alpha: f32,
    /// Choice of wavelengths.
    pub wavelengths: WavelengthMode,
    /// Who deals the numbers; those of a photon depend on this, `stream` and its index alone.
    pub sampler: SamplerSettings,
    /// Photons of different streams are independent.
    pub stream: u32,
}

impl Default for PhotonWalk {
    fn default() -> Self {
        Self {
            max_depth: 100,
            sharp_alpha: SHARP_ALPHA,
            wavelengths: WavelengthMode::Hero,
            sampler: SamplerSettings::default(),
            stream: 0,
        }
    }
}

/// A place where a photon arrives, on a surface that scatters.
#[derive(Clone, Copy, Debug)]
pub struct PhotonVertex<'a> {
    /// The light that sent it.
    pub light: LightId,
    /// The surface; its `wo` is the direction towards where the photon comes from.
    pub surface: &'a Surface,
    /// How it scatters.
    pub bsdf: &'a Bsdf,
    /// What arrives, per wavelength, if this is the only photon that was emitted.
    pub flux: Sampled,
    /// Its wavelengths.
    pub lambda: &'a Wavelengths,
    /// What it came through.
    pub medium: Option<MediumId>,
    /// Its events before this surface.
    pub trail: Trail,
    /// Their number, also where the trail does not hold all of them.
    pub depth: u32,
    /// The last of them, if any, also where there were more than the trail holds.
    pub last_event: Option<Event>,
}

/// What becomes of a photon that was visited.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Onward {
    /// It goes on.
    Continue,
    /// Its walk ends.
    Stop,
}

/// Photons that one task follows: their number is fixed, so that results are in the same order for any number of threads.
const PHOTONS_PER_TASK: u64 = 4096;

/// A place in the image plane that no pixel has, whose random numbers photons take.
const PHOTON_PIXEL: u32 = 0x8000_0000;

impl PhotonWalk {
    /// The random numbers of a photon.
    #[must_use]
    pub fn numbers(&self, index: u64) -> Sampler {
        Sampler::new(&self.sampler, [PHOTON_PIXEL, self.stream], index)
    }

    /// Emits a photon and follows it. `visit` sees it wherever it arrives.
    pub fn trace(
        &self,
        tracer: &Tracer<'_>,
        emitter: &PhotonEmitter,
        index: u64,
        visit: &mut impl FnMut(&PhotonVertex<'_>) -> Onward,
    ) {
        let mut numbers = self.numbers(index);
        let mut lambda = self.wavelengths.sample(numbers.next_1d());
        if let Some(photon) = emitter.emit(tracer.scene, &mut numbers, &lambda) {
            self.follow(tracer, &photon, &mut numbers, &mut lambda, visit);
        }
    }

    /// Follows a photon that was emitted.
    pub fn follow(
        &self,
        tracer: &Tracer<'_>,
        photon: &EmittedPhoton,
        numbers: &mut Sampler,
        lambda: &mut Wavelengths,
        visit: &mut impl FnMut(&PhotonVertex<'_>) -> Onward,
    ) {
        let scene = tracer.scene;
        let (mut ray, mut flux, mut trail, mut depth) = (photon.ray, photon.flux, Trail::EMPTY, 0);
        // What a photon starts in shows at the first boundary that it meets.
        let (mut medium, mut knows_medium) = (None, false);
        let mut last_event = None;
        while let Some(hit) = tracer.intersect(&ray) {
            let surface = scene.surface(&ray, &hit);
            if !knows_medium {
                medium = scene.medium_towards(&surface, surface.wo, None);
            }
            if let Some(medium) = medium {
                flux *= scene.transmittance_of(medium, hit.t, lambda);
            }
            // Borrowed where it lies: it is large.
            let bsdf = scene.bsdf(&surface, lambda);
            let Some(bsdf) = &bsdf else {
                // Light passes as if the surface were not there.
                ray = surface.spawn_ray(ray.direction);
                continue;
            };
            knows_medium = true;
            let light = photon.light;
            let vertex = PhotonVertex {
                light,
                surface: &surface,
                bsdf,
                flux,
                lambda,
                medium,
                trail,
                depth,
                last_event,
            };
            if visit(&vertex) == Onward::Stop || depth == self.max_depth {
                return;
            }
            numbers.start_vertex();
            numbers.skip_light();
            let (u_component, u) = (numbers.next_1d(), numbers.next_2d());
            let Some(sample) = bsdf.sample(surface.wo, u_component, u, TransportMode::Importance, Lobes::ALL)
            else {
                return;
            };
            let Some(factor) = reflect_or_absorb(sample.weight, numbers.next_1d()) else { return };
            flux *= factor;
            depth += 1;
            let event = Event::of(&sample, self.sharp_alpha);
            trail = trail.with(event);
            last_event = Some(event);
            medium = scene.medium_towards(&surface, sample.wi, medium);
            ray = surface.spawn_ray(sample.wi);
        }
    }
}

/// Emits and follows photons of these indices in parallel. What `gather` leaves comes in order of the photons and of their
/// way, the same for any number of threads.
pub fn trace_photons<T: Send>(
    scene: &Scene,
    emitter: &PhotonEmitter,
    range: Range<u64>,
    walk: &PhotonWalk,
    gather: impl Fn(u64, &PhotonVertex<'_>, &mut Vec<T>) -> Onward + Sync,
) -> (Vec<T>, RayCounts) {
    let n_tasks = (range.end - range.start).div_ceil(PHOTONS_PER_TASK);
    let parts: Vec<(Vec<T>, RayCounts)> = (0..n_tasks)
        .into_par_iter()
        .map(|task| {
            let tracer = Tracer::new(scene);
            let start = range.start + task * PHOTONS_PER_TASK;
            let mut gathered = Vec::new();
            for index in start..range.end.min(start + PHOTONS_PER_TASK) {
                walk.trace(&tracer, emitter, index, &mut |vertex| gather(index, vertex, &mut gathered));
            }
            (gathered, tracer.counts())
        })
        .collect();
    let mut all = Vec::with_capacity(parts.iter().map(|(part, _)| part.len()).sum());
    let mut rays = RayCounts::default();
    for (part, counts) in parts {
        all.extend(part);
        rays += counts;
    }
    (all, rays)
}
