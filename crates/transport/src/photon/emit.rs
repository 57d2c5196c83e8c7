//! Photons leave the lights (SPEC EMI-4 to EMI-10, PHT-1).
//!
//! Each photon chooses a light in proportion to its power, a place and a direction by the light's own density, so that all
//! carry nearly the same flux: `le cos / (pdf_a pdf_w pmf)`. Where a light's own density leaves that uneven, a table of its flux
//! makes up for it ([`evenness`]), and photons may be aimed at what they are meant to meet ([`aim`]).

mod aim;
mod chart;
mod evenness;
mod targets;

use std::collections::HashMap;

use etendue_geometry::GeometryId;
use etendue_math::{
    AliasTable, Normal3, Point2, Ray, Rng, Sampler, SamplerKind, SamplerSettings, offset_ray_origin,
};
use etendue_scene::Scene;
use etendue_scene::light::{
    AreaLight, Directions, EmittedRay, Light, LightContext, LightId, MovingAreaLight,
};
use etendue_scene::medium::MediumId;
use etendue_spectrum::{Sampled, Wavelengths};
use rayon::prelude::*;

use crate::lpe::SHARP_ALPHA;
use crate::path::camera_pass::Tracer;
use crate::path::medium::{medium_along, most_frequent};
use aim::{Aim, Aimed};
use evenness::Evenness;
use targets::Targets;

pub use aim::MapScheme;

/// What photons are meant to meet.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Target {
    /// Anything: no projection maps.
    #[default]
    Anything,
    /// Any shape: what would leave the scene is not sent.
    Shapes,
    /// Shapes that may cast caustics: those of a material that may be sharp, unless an artist has switched them off.
    SharpShapes,
}

impl Target {
    /// Names in scene files.
    pub const NAMES: [(&'static str, Self); 3] =
        [("anything", Self::Anything), ("shapes", Self::Shapes), ("sharp", Self::SharpShapes)];
}

/// Where photons are sent.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct EmissionSettings {
    /// What they are meant to meet.
    pub target: Target,
    /// How they find the cells of projection maps.
    pub scheme: MapScheme,
    /// Cells along the side of a map, at most 1024; a map of a light in all directions has two squares. Those of many lights are
    /// coarser.
    pub n_cells: u32,
    /// Microfacet width below which gloss is sharp.
    pub sharp_alpha: f32,
}

impl Default for EmissionSettings {
    fn default() -> Self {
        Self { target: Target::Anything, scheme: MapScheme::Cell, n_cells: 128, sharp_alpha: SHARP_ALPHA }
    }
}

/// Photons whose first rays tell how many meet a shape, and the share of them from which on they need not be aimed.
const N_TRIALS: u32 = 2048;
const ENOUGH_HITS: f64 = 0.1;

/// The most lights that have maps and tables of their own, those of the most power: each costs some ten milliseconds.
const MAX_PREPARED: usize = 128;

/// Chooses which light sends a photon, and where to.
#[derive(Clone, Debug)]
pub struct PhotonEmitter {
    /// By light; `None` if no light sends any.
    lights: Option<AliasTable>,
    /// By light, where it does not just send photons as it does.
    sources: Vec<Option<Box<Source>>>,
    /// By light, what it stands in; empty if there are no media.
    media: Vec<Option<MediumId>>,
    sent_share: f64,
    is_dark: bool,
}

/// How a light sends photons.
#[derive(Clone, Debug, Default)]
struct Source {
    aim: Option<Aim>,
    evenness: Evenness,
}

/// A photon that leaves a light.
#[derive(Clone, Copy, Debug)]
pub struct EmittedPhoton {
    /// Its way, clear of the light's surface.
    pub ray: Ray,
    /// Flux per wavelength if it is the only photon, in the units of the renderer (radiance times m^2 sr).
    pub flux: Sampled,
    /// Who sent it.
    pub light: LightId,
    /// Geometric normal where it starts, if that is a surface.
    pub n: Option<Normal3>,
    /// What the light stands in.
    pub medium: Option<MediumId>,
}

impl PhotonEmitter {
    /// For the lights of a scene, wherever their photons go.
    #[must_use]
    pub fn new(scene: &Scene) -> Self {
        Self::aimed(scene, &EmissionSettings::default())
    }

    /// For the lights of a scene. Photons that are aimed leave out what surely meets no target first; what meets one is the same
    /// in expectation.
    #[must_use]
    pub fn aimed(scene: &Scene, settings: &EmissionSettings) -> Self {
        let context = scene.light_context();
        let powers: Vec<f64> = scene.lights.par_iter().map(|light| entering_power(light, &context)).collect();
        let mut by_power: Vec<usize> = (0..powers.len()).filter(|index| powers[*index] > 0.0).collect();
        by_power.sort_by(|a, b| powers[*b].total_cmp(&powers[*a]).then(a.cmp(b)));
        by_power.truncate(MAX_PREPARED);
        let targets = targets(scene, settings);
        let n_cells = aim::affordable_side(settings.n_cells.clamp(2, 1024) as usize, by_power.len());
        let prepare = |index: &usize| {
            let light = &scene.lights[*index];
            let others = targets_but_itself(scene, light, settings.target);
            let targets = others.as_ref().or(targets.as_ref());
            (*index, Source::new(light, &context, targets, n_cells, settings.scheme))
        };
        let prepared: Vec<_> = by_power.par_iter().map(prepare).collect();
        let mut sources = vec![None; powers.len()];
        let mut sent = powers.clone();
        for (index, (source, share)) in prepared {
            sent[index] *= share;
            sources[index] = source;
        }
        let is_aimless = targets.as_ref().is_some_and(Targets::is_empty);
        let largest = if is_aimless { 0.0 } else { sent.iter().copied().fold(0.0, f64::max) };
        let weights: Vec<f32> = sent.iter().map(|power| (power / largest) as f32).collect();
        let (all, of_sent) = (powers.iter().sum::<f64>(), sent.iter().sum::<f64>());
        Self {
            lights: (largest > 0.0).then(|| AliasTable::new(&weights)),
            sources,
            media: start_media(scene),
            sent_share: if all > 0.0 && largest > 0.0 { of_sent / all } else { 0.0 },
            is_dark: by_power.is_empty(),
        }
    }

    /// Photons for all that light meets: sent wherever lights shine or, where less than a tenth of those would meet any shape
    /// (a lamp far from a small scene), aimed at shapes, unless the settings have no projection maps.
    #[must_use]
    pub fn reaching(scene: &Scene, settings: &EmissionSettings) -> Self {
        let plain = Self::aimed(scene, &EmissionSettings { target: Target::Anything, ..*settings });
        if settings.n_cells == 0 || plain.is_idle() || plain.hit_share(scene) >= ENOUGH_HITS {
            return plain;
        }
        Self::aimed(scene, &EmissionSettings { target: Target::Shapes, ..*settings })
    }

    /// About the share of its photons that meet a shape; always the same for the same scene.
    #[must_use]
    pub fn hit_share(&self, scene: &Scene) -> f64 {
        let (tracer, lambda) = (Tracer::new(scene), Wavelengths::sample_uniform(0.5));
        let settings = SamplerSettings { kind: SamplerKind::Independent, seed: 0x417, samples_per_pixel: 1 };
        let meets = |index: &u32| {
            let mut numbers = Sampler::new(&settings, [0, 0], u64::from(*index));
            let photon = self.emit(scene, &mut numbers, &lambda);
            photon.is_some_and(|photon| tracer.intersect(&photon.ray).is_some())
        };
        (0..N_TRIALS).filter(meets).count() as f64 / f64::from(N_TRIALS)
    }

    /// True if no light sends anything.
    #[must_use]
    pub const fn is_dark(&self) -> bool {
        self.is_dark
    }

    /// True if no photon is sent: there is no light, or none that could meet what photons are aimed at.
    #[must_use]
    pub const fn is_idle(&self) -> bool {
        self.lights.is_none()
    }

    /// About the share of the flux of all lights that is sent: that of active cells.
    #[must_use]
    pub const fn sent_share(&self) -> f64 {
        self.sent_share
    }

    /// Probability with which a light is chosen.
    #[must_use]
    pub fn pmf(&self, light: LightId) -> f32 {
        self.lights.as_ref().map_or(0.0, |lights| lights.pmf(light.0 as usize))
    }

    /// One photon; `None` if this choice of numbers sends none, which counts as emitted all the same. Always takes as many
    /// numbers: direction, time, place, light.
    #[must_use]
    pub fn emit(&self, scene: &Scene, numbers: &mut Sampler, lambda: &Wavelengths) -> Option<EmittedPhoton> {
        self.emit_at(None, scene, numbers, lambda)
    }

    /// The same at a given time in seconds; `None` for any while the shutter is open.
    #[must_use]
    pub fn emit_at(
        &self,
        time: Option<f32>,
        scene: &Scene,
        numbers: &mut Sampler,
        lambda: &Wavelengths,
    ) -> Option<EmittedPhoton> {
        let u_direction = numbers.next_2d();
        let u_time = numbers.next_1d();
        let time = time.unwrap_or_else(|| scene.camera.sample_time(u_time));
        let u_position = numbers.next_2d();
        let (index, pmf, u_rest) = self.lights.as_ref()?.sample(numbers.next_1d());
        let (light, context) = (&scene.lights[index], scene.light_context_at(time));
        let (emitted, density) = match &self.sources[index] {
            None => (light.sample_le(&context, u_position, u_direction, lambda)?, 1.0),
            Some(source) => source.emit(light, &context, [u_position, u_direction], u_rest, lambda)?,
        };
        let flux = emitted.le * (emitted.cosine / (emitted.pdf_a * emitted.pdf_w) / (density * pmf));
        if flux.is_black() || !flux.is_finite() {
            return None;
        }
        let mut ray = Ray { time, ..emitted.ray };
        if let Some(n) = emitted.n {
            ray.origin = offset_ray_origin(ray.origin, emitted.p_error, n, ray.direction);
        }
        let medium = self.media.get(index).copied().flatten();
        Some(EmittedPhoton { ray, flux, light: LightId(index as u32), n: emitted.n, medium })
    }
}

impl Source {
    /// How a light sends photons, if it is not just as it does, and which share of its flux.
    fn new(
        light: &Light,
        context: &LightContext,
        targets: Option<&Targets>,
        n_cells: usize,
        scheme: MapScheme,
    ) -> (Option<Box<Self>>, f64) {
        let aimed =
            targets.map_or(Aimed::Everywhere, |targets| Aim::of(light, context, targets, n_cells, scheme));
        let (aim, share) = match aimed {
            Aimed::Nowhere => return (None, 0.0),
            Aimed::Everywhere => (None, 1.0),
            Aimed::Towards(aim, share) => (Some(*aim), share),
        };
        let is_even =
            light.is_even(context) && matches!(aim, None | Some(Aim::Directions(_) | Aim::Plane(_)));
        if is_even {
            return (aim.map(|aim| Box::new(Self { aim: Some(aim), ..Self::default() })), share);
        }
        let plain = Self { aim, evenness: Evenness::default() };
        let lambda = Wavelengths::sample_uniform(0.5);
        let flux = |[position, direction]: [Point2; 2]| {
            // What pictured lights send in two ways is decided by a number that stands for any.
            let u = (position.x * 61.0 + direction.y * 37.0).fract();
            let emitted = plain.emit(light, context, [position, direction], u, &lambda);
            emitted.map_or(0.0, |(ray, _)| flux_of(&ray).average())
        };
        let evenness = Evenness::measure(&flux);
        (Some(Box::new(Self { evenness, ..plain })), share)
    }

    /// A ray of the light, and the density that its flux is divided by.
    fn emit(
        &self,
        light: &Light,
        context: &LightContext,
        points: [Point2; 2],
        u: f32,
        lambda: &Wavelengths,
    ) -> Option<(EmittedRay, f32)> {
        let (points, density) = self.evenness.draw(points);
        let emitted = match &self.aim {
            None => light.sample_le(context, points[0], points[1], lambda)?,
            Some(aim) => aim.emit(light, context, points, u, lambda)?,
        };
        Some((emitted, density))
    }
}

/// The flux that a ray stands for.
fn flux_of(ray: &EmittedRay) -> Sampled {
    let flux = ray.le * (ray.cosine / (ray.pdf_a * ray.pdf_w));
    if flux.is_finite() { flux } else { Sampled::ZERO }
}

/// What photons are aimed at; `None` if they are not.
fn targets(scene: &Scene, settings: &EmissionSettings) -> Option<Targets> {
    let casts =
        |id: GeometryId| scene.controls.as_ref().is_none_or(|controls| controls.shape(id).casts_caustics);
    let is_sharp = |id: GeometryId| {
        let material = scene.attributes[id.0 as usize].material;
        scene.materials.may_be_sharp(material, settings.sharp_alpha) && casts(id)
    };
    match settings.target {
        Target::Anything => None,
        Target::Shapes => Some(Targets::new(scene, &|_| true)),
        Target::SharpShapes => Some(Targets::new(scene, &is_sharp)),
    }
}

/// All shapes but the light's own, if that is one that cannot shine on itself: a flat one or a ball, and one light. Its own would be
/// in the way of maps: it is in all directions.
fn targets_but_itself(scene: &Scene, light: &Light, target: Target) -> Option<Targets> {
    let Light::Area(lamp) = light else { return None };
    let is_convex = !matches!(light.directions(&scene.light_context()), Directions::Varied);
    let is_of_shape = |other: &&Light| matches!(other, Light::Area(other) if other.geometry == lamp.geometry);
    let is_whole = || scene.lights.iter().filter(is_of_shape).nth(1).is_none();
    (target == Target::Shapes && is_convex && is_whole())
        .then(|| Targets::new(scene, &|id| id != lamp.geometry))
}

/// Power of a light by the weight of sampling; of one at infinity, that through the box around the scene.
fn entering_power(light: &Light, context: &LightContext) -> f64 {
    let power = light.power(context).weight;
    let is_through_opening = matches!(light, Light::InfinitePortal(_));
    let share = if light.is_infinite() && !is_through_opening && power > 0.0 {
        f64::from(mean_entry_area(light, context) / context.tables.scene_sphere.cross_section())
    } else {
        1.0
    };
    let entering = power * share;
    if entering.is_finite() { entering.max(0.0) } else { 0.0 }
}

/// Mean area across the directions of a light at infinity through which it emits into the scene.
fn mean_entry_area(light: &Light, context: &LightContext) -> f32 {
    let (mut rng, lambda) = (Rng::new(0x0a5ea, 1), Wavelengths::sample_uniform(0.5));
    let (mut sum, mut n) = (0.0, 0.0_f32);
    for _ in 0..256 {
        let (position, direction) = (rng.next_point2(), rng.next_point2());
        if let Some(emitted) = light.sample_le(context, position, direction, &lambda) {
            sum += context.tables.entry_area(emitted.ray.direction);
            n += 1.0;
        }
    }
    sum / n.max(1.0)
}

/// Rays by which a light looks for what it stands in.
const N_PROBES: u32 = 5;

/// What each light stands in: what most of a few of its rays find on their side of the first boundary, past whatever else is in their
/// way. Nothing for lights at infinity, for which the first boundary on a photon's way tells. The lights of a shape share the answer.
fn start_media(scene: &Scene) -> Vec<Option<MediumId>> {
    if scene.materials.media().is_empty() {
        return Vec::new();
    }
    let mut of_shapes = HashMap::new();
    let lights = (0..scene.lights.len()).map(|index| match &scene.lights[index] {
        light if light.is_infinite() => None,
        light @ (Light::Area(AreaLight { geometry, .. })
        | Light::MovingArea(MovingAreaLight { geometry, .. })) => {
            *of_shapes.entry(*geometry).or_insert_with(|| start_medium(scene, light))
        }
        light => start_medium(scene, light),
    });
    lights.collect()
}

fn start_medium(scene: &Scene, light: &Light) -> Option<MediumId> {
    let (context, lambda) = (scene.light_context(), Wavelengths::sample_uniform(0.5));
    let mut rng = Rng::new(0x3ed1, 1);
    most_frequent((0..N_PROBES).filter_map(|_| {
        let (position, direction) = (rng.next_point2(), rng.next_point2());
        let emitted = light.sample_le(&context, position, direction, &lambda)?;
        let mut ray = emitted.ray;
        if let Some(n) = emitted.n {
            ray.origin = offset_ray_origin(ray.origin, emitted.p_error, n, ray.direction);
        }
        Some(medium_along(scene, ray).flatten())
    }))
}
