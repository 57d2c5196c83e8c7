//! Camera paths: through what is specular or sharply glossy, and at every surface on the way that scatters widely, the photons
//! around (visible points).
//!
//! At a surface the lobes part. Those that receive get light from photons around; the others are followed. Light straight from
//! lights comes from a light sample for all lobes, and from running into lights, by a direction of the receiving lobes that
//! goes no farther than that, and by the one that is followed. The weights of light samples and of directions sum to 1 with
//! any function in the place of the directions' density; it is that of all lobes together.

use std::sync::atomic::{AtomicU32, AtomicU64, Ordering};

use etendue_geometry::points::Neighbours;
use etendue_math::{Sampler, SamplerSettings, hash64};
use etendue_scene::bsdf::{Bsdf, BsdfKind, BsdfSample, Lobes, TransportMode};
use etendue_scene::scene::Surface;
use etendue_spectrum::{Sampled, Wavelengths};

use super::patch::Patch;
use super::photons::{GroupPhoton, GroupPhotons, receiving_lobes};
use super::radius::FirstRadius;
use super::statistics::PixelStatistics;
use super::{DirectLighting, ProgressiveSettings};
use crate::lpe::Event;
use crate::path::camera_pass::{CameraPath, Common, Follow, FollowedPath, Tracer};
use crate::path_tracing::walk::Walk;
use crate::path_tracing::{LightStrategy, PathSettings};

/// The camera paths of a group.
#[derive(Debug)]
pub(super) struct Eye<'p> {
    pub(super) settings: &'p ProgressiveSettings,
    pub(super) path_settings: PathSettings,
    pub(super) photons: &'p GroupPhotons,
    pub(super) first_radius: &'p FirstRadius,
    /// Radius over that of the first pass, where it is not up to the pixel.
    pub(super) shrink: f32,
    pub(super) pixels: Option<(&'p PixelStatistics, u32)>,
    pub(super) common: Common,
    /// Time is that of the photons.
    pub(super) shares_time: bool,
    /// The wavelengths that the group starts with.
    pub(super) lambda: Wavelengths,
    /// Who deals the numbers of light samples where camera paths are always the same, and the number of the sample.
    pub(super) light_numbers: Option<(SamplerSettings, u64)>,
    pub(super) tally: &'p Tally,
    /// Completes the pass.
    pub(super) is_last: bool,
}

/// Figures of some of the visible points.
#[derive(Debug, Default)]
pub(super) struct Tally {
    pub(super) n_points: AtomicU64,
    pub(super) n_empty: AtomicU64,
    pub(super) n_photons: AtomicU64,
    /// Sum of the radii, in units of 1e-6 m.
    pub(super) radius_sum: AtomicU64,
    /// Largest radius: its bits, which are in the order of positive numbers.
    pub(super) largest_radius: AtomicU32,
}

/// Of pixels whose coordinates are multiples of this both, figures are taken.
const TALLY_STEP: u32 = 4;

impl Tally {
    fn note(&self, pixel: [u32; 2], n_photons: u32, radius: f32) {
        if !(pixel[0] | pixel[1]).is_multiple_of(TALLY_STEP) {
            return;
        }
        self.n_points.fetch_add(1, Ordering::Relaxed);
        self.n_empty.fetch_add(u64::from(n_photons == 0), Ordering::Relaxed);
        self.n_photons.fetch_add(u64::from(n_photons), Ordering::Relaxed);
        self.radius_sum.fetch_add((f64::from(radius) * 1e6) as u64, Ordering::Relaxed);
        self.largest_radius.fetch_max(radius.to_bits(), Ordering::Relaxed);
    }
}

impl Follow for Eye<'_> {
    type Left = ();

    fn common(&self, own: Common) -> Common {
        let u_time = if self.shares_time { self.common.u_time } else { own.u_time };
        Common { u_lambda: self.common.u_lambda, u_time }
    }

    fn follow(&self, tracer: &Tracer<'_>, path: &mut CameraPath<'_, '_>) -> (Sampled, ()) {
        let mut light_numbers = self.light_numbers.as_ref().map(|(settings, index)| {
            let settings = SamplerSettings { seed: hash64(&[settings.seed, 1]), ..*settings };
            Sampler::new(&settings, path.numbers_of, *index)
        });
        let mut walk = Walk::new(&self.path_settings, path);
        let mut state = EyeState::default();
        while let Some((surface, bsdf)) = walk.arrive(tracer, path) {
            state.distance += (surface.point.p - surface.ray_origin).length();
            path.sampler.start_vertex();
            let received = receiving_lobes(&bsdf, self.settings.receiver_alpha);
            // Fixed paths meet new light samples in each pass.
            swap_numbers(path, &mut light_numbers);
            walk.add_direct_light(tracer, &surface, &bsdf, 1.0, path);
            let followed = bsdf.lobes() & !received;
            if self.settings.direct == DirectLighting::Photons && followed.has_non_specular() {
                add_delta_lights(&mut walk, tracer, &surface, &bsdf, followed, path);
            }
            if !received.is_empty() {
                if self.settings.direct == DirectLighting::Lights {
                    probe(&mut walk, tracer, &surface, &bsdf, received, path);
                }
                let admitted = received & walk.admitted(tracer.scene, &surface, &bsdf);
                self.receive(tracer, &mut walk, &mut state, &surface, &bsdf, admitted, path);
            }
            swap_numbers(path, &mut light_numbers);
            if followed.is_empty() || !leave(&mut walk, tracer, &surface, &bsdf, followed, path) {
                break;
            }
            if !walk.survives_roulette(path) {
                break;
            }
        }
        // Photons of one wavelength are an estimate for all that the path has left: all or the same one.
        let mut radiance = walk.radiance;
        let one = single(&self.lambda).pdf()[0];
        if state.single > 0.0 && one > 0.0 {
            let weight = path.lambda.pdf()[0] / one;
            radiance[0] += state.single * weight;
            path.layers.settle_single(weight);
        }
        (radiance, ())
    }

    fn n_samples(&self, n_paths: u64) -> u64 {
        if self.is_last { n_paths } else { 0 }
    }

    fn join(&self, _: &Tracer<'_>, _: &mut [FollowedPath<()>]) {}
}

/// The wavelengths after dispersion.
fn single(lambda: &Wavelengths) -> Wavelengths {
    let mut single = *lambda;
    single.terminate_secondary();
    single
}

fn swap_numbers(path: &mut CameraPath<'_, '_>, other: &mut Option<Sampler>) {
    if let Some(other) = other {
        std::mem::swap(path.sampler, other);
        path.sampler.start_vertex();
    }
}

/// What a camera path gathers beyond what its walk does.
#[derive(Debug, Default)]
struct EyeState {
    /// Way from the camera in metres.
    distance: f32,
    /// Radiance from photons of one wavelength at that wavelength.
    single: f32,
    neighbours: Neighbours,
}

/// Adds the light of lights that no direction runs into, for lobes that do not get it from photons.
fn add_delta_lights(
    walk: &mut Walk<'_>,
    tracer: &Tracer<'_>,
    surface: &Surface,
    bsdf: &Bsdf,
    lobes: Lobes,
    path: &mut CameraPath<'_, '_>,
) {
    let settings = PathSettings { lights: LightStrategy::Lights, ..*walk.settings };
    let sampling = walk.with_settings(&settings);
    let lobes = lobes & walk.admitted(tracer.scene, surface, bsdf);
    let scattered = sampling.direct_light(tracer, surface, bsdf, 1.0, path, |candidate, through, path| {
        if !candidate.light.sample.is_delta {
            return Sampled::ZERO;
        }
        sampling.scatter_by_lobes(surface, bsdf, lobes, candidate, through, path.layers)
    });
    walk.radiance += scattered.unwrap_or(Sampled::ZERO);
}

/// Chooses a direction among these lobes, and leaves.
fn leave(
    walk: &mut Walk<'_>,
    tracer: &Tracer<'_>,
    surface: &Surface,
    bsdf: &Bsdf,
    lobes: Lobes,
    path: &mut CameraPath<'_, '_>,
) -> bool {
    let (u_component, u) = (path.sampler.next_1d(), path.sampler.next_2d());
    let sample = bsdf.sample(surface.wo, u_component, u, TransportMode::Radiance, lobes);
    let Some(mut sample) = sample else { return false };
    if !sample.is_specular() && lobes != bsdf.lobes() {
        let pdf_w = bsdf.pdf(surface.wo, sample.wi, TransportMode::Radiance, Lobes::ALL);
        sample = BsdfSample { pdf_w, ..sample };
    }
    walk.leave(tracer.scene, surface, &sample, 1.0, path.layers);
    true
}

/// Adds the light that a direction of these lobes runs into.
fn probe(
    walk: &mut Walk<'_>,
    tracer: &Tracer<'_>,
    surface: &Surface,
    bsdf: &Bsdf,
    lobes: Lobes,
    path: &mut CameraPath<'_, '_>,
) {
    let position = path.layers.position();
    let settings = PathSettings { max_depth: walk.depth + 1, ..*walk.settings };
    let mut probe = walk.with_settings(&settings);
    if leave(&mut probe, tracer, surface, bsdf, lobes, path) {
        let mut lambda = *path.lambda;
        std::mem::swap(path.lambda, &mut lambda);
        let _ = probe.arrive(tracer, path);
        // What disperses ends the probe, and is no business of the path.
        *path.lambda = lambda;
    }
    walk.radiance += probe.radiance;
    path.layers.return_to(&position);
}

impl Eye<'_> {
    /// Adds the light of the photons around.
    #[expect(clippy::too_many_arguments, reason = "all that photons meet")]
    fn receive(
        &self,
        tracer: &Tracer<'_>,
        walk: &mut Walk<'_>,
        state: &mut EyeState,
        surface: &Surface,
        bsdf: &Bsdf,
        lobes: Lobes,
        path: &mut CameraPath<'_, '_>,
    ) {
        let point = &surface.point;
        let cosine = surface.wo.dot_normal(point.ng).abs();
        let shrink = match self.pixels {
            Some((pixels, part)) => pixels.shrink(path.numbers_of, part),
            None => self.shrink,
        };
        let radius = self.first_radius.at(point.p, state.distance, cosine, &mut state.neighbours) * shrink;
        let scale = 1.0 / (std::f32::consts::PI * radius * radius * self.photons.n_emitted as f32);
        if !scale.is_finite() {
            self.tally.note(path.numbers_of, 0, radius);
            return;
        }
        let limit = self.settings.max_depth.saturating_sub(walk.depth + 1);
        let mut n_photons = 0;
        let patch = Patch::new(surface, radius);
        let is_recorded = !path.layers.is_idle();
        // What else the path does with these numbers is added to this, never multiplied.
        let mut numbers = path.sampler.clone();
        numbers.start_vertex();
        let alpha = self.settings.receiver_alpha;
        let mut inverse_share = || patch.inverse_share(tracer, surface, alpha, &self.lambda, &mut numbers);
        let known = is_recorded.then(&mut inverse_share);
        let (mut all, mut one) = (Sampled::ZERO, 0.0);
        if let BsdfKind::Diffuse(diffuse) = bsdf.kind()
            && !is_recorded
            && !lobes.is_empty()
        {
            let ns = bsdf.ns();
            let side = surface.wo.dot_normal(ns);
            self.photons.visit(&patch, &mut |photon, weight, _| {
                if u32::from(photon.depth) > limit || photon.wi.dot_normal(ns) * side <= 0.0 {
                    return;
                }
                n_photons += 1;
                if photon.is_single { one += photon.flux[0] * weight } else { all += photon.flux * weight }
            });
            let f = diffuse.reflectance * std::f32::consts::FRAC_1_PI;
            (all, one) = (all * f, one * f[0]);
        } else {
            self.photons.visit(&patch, &mut |photon, weight, index| {
                if u32::from(photon.depth) > limit {
                    return;
                }
                let lobes = lobes & photon.lobes;
                let f = bsdf.eval(surface.wo, photon.wi, TransportMode::Radiance, lobes) * weight;
                if f.is_black() {
                    return;
                }
                n_photons += 1;
                if photon.is_single {
                    one += photon.flux[0] * f[0]
                } else {
                    all += photon.flux * f
                }
                if let Some(inverse_share) = known {
                    let scale = walk.beta * (scale * weight * inverse_share);
                    self.record(photon, index, surface, bsdf, lobes, scale, path);
                }
            });
        }
        if n_photons > 0 {
            let scale = scale * known.unwrap_or_else(inverse_share);
            walk.radiance += walk.beta * all * scale;
            state.single += walk.beta[0] * one * scale;
        }
        if let Some((pixels, part)) = self.pixels {
            pixels.count(path.numbers_of, part, n_photons);
        }
        self.tally.note(path.numbers_of, n_photons, radius);
    }

    /// Adds what a photon brings to the layers that select its path.
    #[expect(clippy::too_many_arguments, reason = "all that one photon meets")]
    fn record(
        &self,
        photon: &GroupPhoton,
        index: u32,
        surface: &Surface,
        bsdf: &Bsdf,
        lobes: Lobes,
        scale: Sampled,
        path: &mut CameraPath<'_, '_>,
    ) {
        let flux = photon.flux * scale;
        let glossy = Event::glossy(bsdf.glossy_roughness(), self.settings.sharp_alpha);
        for (event, lobes) in [(Event::Diffuse, lobes & Lobes::DIFFUSE), (glossy, lobes & Lobes::GLOSSY)] {
            let f = bsdf.eval(surface.wo, photon.wi, TransportMode::Radiance, lobes);
            if f.is_black() {
                continue;
            }
            let trail = self.photons.trail(index).events().rev();
            if photon.is_single {
                path.layers.emit_single_trail(event, trail, f[0] * flux[0]);
            } else {
                path.layers.emit_trail(event, trail, f * flux);
            }
        }
    }
}
