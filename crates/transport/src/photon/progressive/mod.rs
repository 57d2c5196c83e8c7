//! Progressive photon mapping: passes of photons, each an image of its own with a smaller radius, whose mean converges.
//!
//! A pass estimates the radiance that a surface sends on by the flux of the photons around a visible point,
//!
//! ```text
//!   L(x, wo) = 1 / (n pi r^2) * sum over photons within r of f(wo, wi) Phi,
//! ```
//!
//! which is blurred by the radius r and noisy. Passes are independent; as r shrinks with their number by
//! `r_(i+1)^2 = r_i^2 (i + alpha) / (i + 1)`, the blur of their mean vanishes and so does its variance (Knaus and Zwicker 2011,
//! "Progressive Photon Mapping: A Probabilistic Approach", doi:10.1145/1966394.1966404). Light that reaches the eye through
//! specular-diffuse-specular paths, which no path tracer finds, is found as any other.
//!
//! `ppm` has the same camera paths in every pass (Hachisuka, Ogaki and Jensen 2008; SPEC PROG-1), `sppm` new ones
//! (Hachisuka and Jensen 2009; SPEC PROG-2), so that edges, lenses and motion converge too. Both papers let each pixel have a
//! radius that shrinks by what it has found ([`RadiusUpdate::PerPixel`]); see `statistics`.
//!
//! Camera paths and photons of a *group* share four wavelengths, and the time where things move, so that they meet without
//! approximation. Photons are traced first and kept in a tree; camera paths ask it where they are, and nothing of them
//! needs to be kept. So memory is that of the photons of one group, whatever the number of passes.

mod eye;
mod families;
mod patch;
mod photons;
mod radius;
mod schedule;
mod settings;
mod statistics;

#[cfg(test)]
mod tests;

use std::sync::atomic::Ordering;

use etendue_math::{SamplerSettings, hash64};
use etendue_scene::film::TileSamples;
use etendue_scene::{Film, Scene};

use self::eye::{Eye, Tally};
use self::families::Family;
use self::photons::{GroupPhotons, PhotonPlan};
use self::radius::FirstRadius;
use self::statistics::PixelStatistics;
use super::PhotonWalk;
use super::lack::Lack;
use crate::integrator::{Control, Integrator, PassEnd, Passes, ReportEntry, StateError};
use crate::lpe::PathExpressions;
use crate::path::camera_pass::{CameraPass, Common};
use crate::path_tracing::{LightStrategy, PathSettings};

pub use settings::{DirectLighting, ProgressiveSettings, RadiusUpdate};

/// Fewest and most photons of a pass that are chosen by the number of camera paths. One for each makes a pass of the standard
/// box 1.45 times as long as a quarter of that, and leaves a third of the variance in blocks of pixels.
const PHOTONS_BY_PATHS: std::ops::RangeInclusive<usize> = (1 << 16)..=(1 << 21);

/// Share of the visible points without photons from which on users are told.
const MANY_EMPTY: f64 = 0.5;
/// If none of so many photons was scattered onto a second surface, nothing is.
const MANY_PHOTONS: u64 = 1 << 14;

/// Progressive photon mapping.
#[derive(Debug)]
pub struct Progressive {
    settings: ProgressiveSettings,
    expressions: PathExpressions,
    prepared: Option<Prepared>,
    pixels: PixelStatistics,
    /// Memory of the last pass's tiles, for the next: a list for each group.
    tiles: Vec<Vec<TileSamples>>,
    tally: Tally,
    n_emitted: u64,
    n_stored: u64,
}

/// What all passes have in common.
#[derive(Debug)]
struct Prepared {
    families: Vec<Family>,
    first_radius: FirstRadius,
    is_moving: bool,
    /// What lies with the lights if no photon meets a shape.
    lack: Option<Lack>,
}

/// A group of photons and camera paths.
#[derive(Clone, Copy, Debug)]
struct Group {
    index: u32,
    /// Counted over all passes.
    number: u64,
    common: Common,
}

impl Progressive {
    /// Progressive photon mapping that fills the film's layers by these expressions.
    #[must_use]
    pub fn new(settings: ProgressiveSettings, expressions: PathExpressions) -> Self {
        Self {
            settings,
            expressions,
            prepared: None,
            pixels: PixelStatistics::default(),
            tiles: Vec::new(),
            tally: Tally::default(),
            n_emitted: 0,
            n_stored: 0,
        }
    }

    /// Photons of fewer events do not count.
    const fn least_depth(&self) -> u32 {
        match self.settings.direct {
            DirectLighting::Lights => 1,
            DirectLighting::Photons => 0,
        }
    }

    /// What users are told of so many visible points, that share of which found no photon.
    fn advice(&self, n_points: u64, empty: f64) -> Option<String> {
        let prepared = self.prepared.as_ref()?;
        if n_points == 0 {
            let advice = "of the pixels that were looked at (one in sixteen) none saw a surface that photons are gathered on: there \
                          is nothing in view, or mirrors, clear glass and black surfaces alone, and then nothing is missing; or \
                          \"maxdepth\" is too small";
            return Some(advice.to_owned());
        }
        // Samples of lights find all that comes to the first surface.
        let is_all_direct = self.n_stored == 0 && self.n_emitted >= MANY_PHOTONS && self.least_depth() > 0;
        if empty <= MANY_EMPTY || is_all_direct || prepared.lack.is_some() {
            return None;
        }
        let percent = 100.0 * empty;
        Some(match self.settings.radius {
            Some(radius) => format!(
                "{percent:.0} % of the visible points found no photon within \"radius\" {radius:?} m, which shrinks from pass to pass: a \
                 larger one, or none, so that it is chosen by the density of photons, shows the light there with less noise"
            ),
            None => format!(
                "{percent:.0} % of the visible points found no photon: a larger \"photonsperiteration\" or more passes show the light \
                 there with less noise"
            ),
        })
    }

    fn prepare(&self, scene: &Scene, film: &Film) -> Prepared {
        let settings = &self.settings;
        let n_paths = film.settings().crop.n_pixels().saturating_mul(settings.n_groups as usize);
        let by_paths = n_paths.clamp(*PHOTONS_BY_PATHS.start(), *PHOTONS_BY_PATHS.end()) as u64;
        let n_pass = settings.photons.map_or(by_paths, u64::from);
        let n_group = n_pass.div_ceil(u64::from(settings.n_groups));
        let sampler = SamplerSettings { seed: hash64(&[scene.sampler.seed, settings.seed]), ..scene.sampler };
        let walk = PhotonWalk {
            // The last event is that of the visible point.
            max_depth: settings.max_depth.saturating_sub(1),
            sharp_alpha: settings.sharp_alpha,
            wavelengths: settings.wavelengths,
            pattern: settings.pattern,
            sampler,
            stream: 0,
            ..PhotonWalk::default()
        };
        let families = Family::of(scene, settings, walk, n_group);
        let first_radius = FirstRadius::new(scene, settings, &families, n_group, self.least_depth());
        let lack = families.first().and_then(|plain| Lack::of_light(scene, &plain.emitter));
        Prepared { families, first_radius, is_moving: scene.geometry.is_moving(), lack }
    }

    /// The samples of a group, into its tiles; `false` if the render was stopped meanwhile.
    fn run_group(
        &mut self,
        scene: &Scene,
        prepared: &Prepared,
        pass: u64,
        group: Group,
        film: &Film,
        control: &Control<'_>,
    ) -> bool {
        let settings = &self.settings;
        let lambda = settings.wavelengths.sample(group.common.u_lambda);
        let plan = PhotonPlan {
            families: &prepared.families,
            lambda,
            time: prepared.is_moving.then(|| scene.camera.sample_time(group.common.u_time)),
            least_depth: self.least_depth(),
            receiver_alpha: settings.receiver_alpha,
            wants_trails: !self.expressions.is_empty(),
        };
        let Some(photons) = GroupPhotons::trace(scene, group.number, &plan, control) else {
            return false;
        };
        self.n_emitted += prepared.families.iter().map(Family::n_emitted).sum::<u64>();
        self.n_stored += photons.len() as u64;
        let is_fixed = settings.has_fixed_points;
        let part = if is_fixed { group.index } else { 0 };
        let lights = match settings.direct {
            DirectLighting::Lights => LightStrategy::Both,
            DirectLighting::Photons => LightStrategy::Scattering,
        };
        let eye = Eye {
            settings,
            path_settings: PathSettings {
                max_depth: settings.max_depth,
                sharp_alpha: settings.sharp_alpha,
                lights,
                ..PathSettings::default()
            },
            photons: &photons,
            first_radius: &prepared.first_radius,
            shrink: schedule::shrink(pass, settings.alpha),
            pixels: (settings.update == RadiusUpdate::PerPixel).then_some((&self.pixels, part)),
            common: group.common,
            shares_time: prepared.is_moving,
            lambda,
            light_numbers: is_fixed.then_some((scene.sampler, group.number)),
            tally: &self.tally,
            is_last: group.index + 1 == settings.n_groups,
        };
        let camera_pass = CameraPass {
            wavelengths: settings.wavelengths,
            expressions: &self.expressions,
            group_size: 1,
            adaptive: None,
        };
        let sample = if is_fixed { u64::from(group.index) } else { group.number };
        let memory = &mut self.tiles[group.index as usize];
        camera_pass.gather(scene, sample, film, control, memory, &eye) == PassEnd::Complete
    }
}

impl Integrator for Progressive {
    fn passes(&self) -> Passes {
        match self.settings.update {
            RadiusUpdate::Schedule => Passes::Independent,
            RadiusUpdate::PerPixel => Passes::Sequential,
        }
    }

    fn run_pass(&mut self, scene: &Scene, pass: u64, film: &mut Film, control: &Control<'_>) -> PassEnd {
        let prepared = self.prepared.take().unwrap_or_else(|| self.prepare(scene, film));
        let n_groups = self.settings.n_groups;
        let is_per_pixel = self.settings.update == RadiusUpdate::PerPixel;
        if is_per_pixel {
            let n_parts = if self.settings.has_fixed_points { n_groups } else { 1 };
            self.pixels.prepare(film.settings().crop, n_parts);
        }
        self.tiles.resize_with(n_groups as usize, Vec::new);
        let seed = hash64(&[scene.sampler.seed, self.settings.seed, 2]);
        let is_complete = (0..n_groups).all(|index| {
            let number = pass * u64::from(n_groups) + u64::from(index);
            let group = Group { index, number, common: schedule::group(seed, number) };
            self.run_group(scene, &prepared, pass, group, film, control)
        });
        self.prepared = Some(prepared);
        // Whole passes only, but for the very first: better a part of a picture than none.
        if is_complete || film.n_passes() == 0 {
            for tiles in &self.tiles {
                film.add_tiles(tiles);
            }
        }
        if !is_complete {
            return PassEnd::Cancelled;
        }
        if is_per_pixel {
            self.pixels.update(self.settings.alpha);
        }
        PassEnd::Complete
    }

    fn report(&self) -> Vec<ReportEntry> {
        let tally = &self.tally;
        let n_found = tally.n_points.load(Ordering::Relaxed);
        let n_points = n_found.max(1) as f64;
        let mean = |sum: u64| sum as f64 / n_points;
        let empty = mean(tally.n_empty.load(Ordering::Relaxed));
        let photons_per_point = mean(tally.n_photons.load(Ordering::Relaxed));
        let lack = self.prepared.as_ref().and_then(|prepared| prepared.lack?.advice());
        vec![
            ReportEntry::new("photons_emitted", self.n_emitted as f64, "").with_advice_if_any(lack),
            ReportEntry::new("photons_stored", self.n_stored as f64, ""),
            ReportEntry::new("photons_per_visible_point", photons_per_point, ""),
            ReportEntry::new("visible_points_without_photons", empty, "")
                .with_advice_if_any(self.advice(n_found, empty)),
            ReportEntry::new("mean_radius", mean(tally.radius_sum.load(Ordering::Relaxed)) * 1e-6, "m"),
            ReportEntry::new(
                "largest_radius",
                f64::from(f32::from_bits(tally.largest_radius.load(Ordering::Relaxed))),
                "m",
            ),
        ]
    }

    fn save(&self) -> Vec<u8> {
        self.pixels.save()
    }

    fn load(&mut self, state: &[u8]) -> Result<(), StateError> {
        match self.settings.update {
            RadiusUpdate::PerPixel => self.pixels.load(state),
            RadiusUpdate::Schedule if state.is_empty() => Ok(()),
            RadiusUpdate::Schedule => Err(StateError),
        }
    }
}
