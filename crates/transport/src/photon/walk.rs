//! The walk of a photon: from surface to surface until it is absorbed (SPEC PHT-2 to PHT-10).
//!
//! Where it arrives at a surface that scatters, it is shown to a visitor, who may keep it, connect it or end the walk. Then
//! it is scattered by the density of the surface; roulette by what that leaves of its flux keeps the flux of all photons
//! alike. Flux knows no squared index: scattering is that of importance.
//!
//! Surfaces that light passes, by their alpha or as interfaces, are no places. On its way a photon is absorbed by the medium
//! that the last boundary left it in (Bouguer's law); the first of them decides what it started in.

use std::ops::Range;

use etendue_math::{Point2, Ray, Sampler, SamplerSettings};
use etendue_scene::Scene;
use etendue_scene::bsdf::{Bsdf, Lobes, TransportMode};
use etendue_scene::light::LightId;
use etendue_scene::medium::MediumId;
use etendue_scene::scene::Surface;
use etendue_spectrum::{Sampled, Wavelengths};
use rayon::prelude::*;

use super::{EmittedPhoton, PhotonEmitter, PhotonPattern, Switches, Trail};
use crate::integrator::{Control, RayCounts};
use crate::lpe::{Event, SHARP_ALPHA};
use crate::path::camera_pass::{Tracer, WavelengthMode};
use crate::path::roulette::survival_probability;
use crate::render::Unobserved;

/// What becomes of a photon where a part of its flux is absorbed (SPEC PHT-3 to PHT-9, EXP-10).
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Absorption {
    /// It lives on with the probability that makes up for it: photons keep their flux, and become fewer.
    #[default]
    Roulette,
    /// It lives on with what is left: photons become weak, not fewer. For comparison.
    Scale,
    /// As many go on as the surface has lobes, each with what that scatters: they become many and weak. Ends after
    /// eight events at most, with up to 2^8 photons where there are two lobes. For comparison.
    Branch,
}

impl Absorption {
    /// Names in scene files.
    pub const NAMES: [(&'static str, Self); 3] =
        [("roulette", Self::Roulette), ("scale", Self::Scale), ("branch", Self::Branch)];
}

/// Most events of photons that branch.
const BRANCHING_DEPTH: u32 = 8;

/// What photons branch into.
const BRANCHES: [Lobes; 3] = [Lobes::NON_SPECULAR, Lobes::SPECULAR_REFLECT, Lobes::SPECULAR_TRANSMIT];

/// How photons walk.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PhotonWalk {
    /// Most scattering events.
    pub max_depth: u32,
    /// Glossy events narrower than this are sharp.
    pub sharp_alpha: f32,
    /// Choice of wavelengths.
    pub wavelengths: WavelengthMode,
    /// In what pattern photons leave.
    pub pattern: PhotonPattern,
    /// What becomes of what surfaces absorb.
    pub absorption: Absorption,
    /// Its seed, with `pattern`, `stream` and the index of a photon, decides all numbers of it; who deals them is the pattern's
    /// choice.
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
            pattern: PhotonPattern::default(),
            absorption: Absorption::default(),
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
    /// The lobes through which it may be seen: all, but where artists have switched something off.
    pub lobes: Lobes,
}

impl PhotonVertex<'_> {
    /// True on surfaces that photon maps are for: what mirrors and clear glass send on alone is found by rays
    /// (SPEC PHT-10).
    #[inline]
    #[must_use]
    pub fn is_stored(&self) -> bool {
        self.bsdf.lobes().intersects(self.lobes & Lobes::NON_SPECULAR)
    }
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
        let kind = self.pattern.sampler_kind();
        Sampler::new(&SamplerSettings { kind, ..self.sampler }, [PHOTON_PIXEL, self.stream], index)
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
        // Filled by photons that branch alone.
        let mut others = Vec::new();
        let mut flight = Flight::new(photon);
        loop {
            if !self.step(tracer, &mut flight, numbers, lambda, &mut others, visit) {
                let Some(other) = others.pop() else { return };
                flight = other;
            }
        }
    }

    /// Carries a photon to the next surface and away from it; `false` if its way ends.
    #[inline(always)]
    fn step(
        &self,
        tracer: &Tracer<'_>,
        flight: &mut Flight,
        numbers: &mut Sampler,
        lambda: &mut Wavelengths,
        others: &mut Vec<Flight>,
        visit: &mut impl FnMut(&PhotonVertex<'_>) -> Onward,
    ) -> bool {
        let scene = tracer.scene;
        let Some(hit) = tracer.intersect(&flight.ray) else { return false };
        let surface = scene.surface(&flight.ray, &hit);
        if !flight.knows_medium {
            // The first boundary tells what it came through, opaque surfaces do not.
            flight.medium = scene.medium_towards(&surface, surface.wo, flight.medium);
        }
        if let Some(medium) = flight.medium {
            flight.flux *= scene.transmittance_of(medium, hit.t, lambda);
        }
        // Borrowed where it lies: it is large.
        let bsdf = scene.bsdf(&surface, lambda);
        let Some(bsdf) = &bsdf else {
            // Light passes as if the surface were not there.
            flight.ray = surface.spawn_ray(flight.ray.direction);
            return true;
        };
        flight.knows_medium = true;
        let mut lobes = Lobes::ALL;
        if let Some(controls) = &scene.controls {
            if flight.depth == 0 && !controls.reaches(flight.light, hit.geometry) {
                return false;
            }
            lobes = flight.switches.lobes(controls, hit.geometry, bsdf, self.sharp_alpha);
        }
        if flight.flux.is_black() {
            return false;
        }
        let vertex = PhotonVertex {
            light: flight.light,
            surface: &surface,
            bsdf,
            flux: flight.flux,
            lambda,
            medium: flight.medium,
            trail: flight.trail,
            depth: flight.depth,
            last_event: flight.last_event,
            lobes,
        };
        if visit(&vertex) == Onward::Stop || flight.depth >= self.max_depth {
            return false;
        }
        if self.absorption == Absorption::Branch {
            self.branch(scene, flight, &surface, bsdf, numbers, others);
            return false;
        }
        let numbers = flight.start_vertex(numbers);
        self.scatter(scene, flight, (&surface, bsdf), Lobes::ALL, &numbers, lambda)
    }

    /// Scatters a photon by some of a surface's lobes; `false` if it is absorbed.
    #[inline(always)]
    fn scatter(
        &self,
        scene: &Scene,
        flight: &mut Flight,
        (surface, bsdf): (&Surface, &Bsdf),
        lobes: Lobes,
        numbers: &ScatterNumbers,
        lambda: &Wavelengths,
    ) -> bool {
        let ScatterNumbers { component, direction, roulette } = *numbers;
        let sample = bsdf.sample(surface.wo, component, direction, TransportMode::Importance, lobes);
        let Some(sample) = sample else { return false };
        let mut left = flight.flux * sample.weight;
        if self.absorption == Absorption::Roulette {
            // Of photons that are alike so many live on that those are: by what is left over all wavelengths, each over its
            // density, which is 0 for those that dispersion gave up.
            let weights = Sampled::splat(1.0).safe_div(lambda.pdf());
            let share = (left * weights).sum() / (flight.flux * weights).sum();
            let survival = survival_probability(share, 1.0);
            if roulette >= survival {
                return false;
            }
            left /= survival;
        }
        let event = Event::at(bsdf, &sample, self.sharp_alpha);
        if let Some(controls) = &scene.controls
            && !flight.switches.scatter(controls, surface.hit.geometry, event)
        {
            return false;
        }
        flight.flux = left;
        flight.depth += 1;
        flight.trail = flight.trail.with(event);
        flight.last_event = Some(event);
        flight.medium = scene.medium_towards(surface, sample.wi, flight.medium);
        flight.ray = surface.spawn_ray(sample.wi);
        left.is_finite()
    }

    /// One photon for each lobe.
    #[cold]
    fn branch(
        &self,
        scene: &Scene,
        flight: &Flight,
        surface: &Surface,
        bsdf: &Bsdf,
        numbers: &mut Sampler,
        others: &mut Vec<Flight>,
    ) {
        if flight.depth >= BRANCHING_DEPTH {
            return;
        }
        for lobes in BRANCHES.into_iter().filter(|lobes| bsdf.lobes().intersects(*lobes)) {
            let (numbers, mut other) = (flight.start_vertex(numbers), *flight);
            let lambda = Wavelengths::bands(0.0); // Roulette alone asks for it.
            if self.scatter(scene, &mut other, (surface, bsdf), lobes, &numbers, &lambda) {
                others.push(other);
            }
        }
    }
}

/// A photon on its way.
#[derive(Clone, Copy, Debug)]
struct Flight {
    ray: Ray,
    flux: Sampled,
    light: LightId,
    trail: Trail,
    last_event: Option<Event>,
    /// Events so far.
    depth: u32,
    medium: Option<MediumId>,
    /// False until a boundary has told.
    knows_medium: bool,
    /// Of no use where nothing is switched off.
    switches: Switches,
}

/// The numbers that scatter a photon.
#[derive(Clone, Copy, Debug)]
struct ScatterNumbers {
    component: f32,
    direction: Point2,
    roulette: f32,
}

impl Flight {
    fn new(photon: &EmittedPhoton) -> Self {
        Self {
            ray: photon.ray,
            flux: photon.flux,
            light: photon.light,
            trail: Trail::EMPTY,
            last_event: None,
            depth: 0,
            medium: photon.medium,
            knows_medium: false,
            switches: Switches::default(),
        }
    }

    /// The numbers for the surface where the photon is. Those of the first are even together with those that it left the light
    /// by (SPEC OPT-11): samplers deal them as what a camera path lights its first vertex with.
    #[inline]
    fn start_vertex(&self, numbers: &mut Sampler) -> ScatterNumbers {
        numbers.start_vertex();
        if self.depth > 0 {
            numbers.skip_light();
        }
        ScatterNumbers {
            component: numbers.next_1d(),
            direction: numbers.next_2d(),
            roulette: numbers.next_1d(),
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
    let (parts, rays) = trace_photon_parts(scene, emitter, range, walk, gather);
    let mut all = Vec::with_capacity(parts.iter().map(Vec::len).sum());
    all.extend(parts.into_iter().flatten());
    (all, rays)
}

/// The same in parts one after another, for those who have no need of all in one place: many are not copied.
pub fn trace_photon_parts<T: Send>(
    scene: &Scene,
    emitter: &PhotonEmitter,
    range: Range<u64>,
    walk: &PhotonWalk,
    gather: impl Fn(u64, &PhotonVertex<'_>, &mut Vec<T>) -> Onward + Sync,
) -> (Vec<Vec<T>>, RayCounts) {
    trace_photons_until(scene, emitter, range, walk, &Control::new(&Unobserved), gather)
}

/// The same, but that no more tasks are begun once the render is cancelled. Each reports its rays when it is done.
pub(crate) fn trace_photons_until<T: Send>(
    scene: &Scene,
    emitter: &PhotonEmitter,
    range: Range<u64>,
    walk: &PhotonWalk,
    control: &Control<'_>,
    gather: impl Fn(u64, &PhotonVertex<'_>, &mut Vec<T>) -> Onward + Sync,
) -> (Vec<Vec<T>>, RayCounts) {
    let n_tasks = range.end.saturating_sub(range.start).div_ceil(PHOTONS_PER_TASK);
    let trace = |task| {
        let (tracer, mut gathered) = (Tracer::new(scene), Vec::new());
        if control.is_cancelled() {
            return (gathered, tracer.counts());
        }
        let start = range.start + task * PHOTONS_PER_TASK;
        for index in start..range.end.min(start + PHOTONS_PER_TASK) {
            walk.trace(&tracer, emitter, index, &mut |vertex| gather(index, vertex, &mut gathered));
        }
        control.tile_done(0, tracer.counts());
        (gathered, tracer.counts())
    };
    let (parts, rays): (Vec<_>, Vec<_>) = (0..n_tasks).into_par_iter().map(trace).unzip();
    let total = rays.into_iter().fold(RayCounts::default(), |mut total, rays| {
        total += rays;
        total
    });
    (parts, total)
}
