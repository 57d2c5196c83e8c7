//! What instruments at a point would read: a luxmeter, and a luminance meter that looks along its normal.
//!
//! The light that falls on a point x with unit normal n from the side of n is its irradiance
//!
//! ```text
//! E = integral over the hemisphere of L_i(x, w) (n . w) dw   [RAD-13, in photometric units: illuminance in lux]
//! ```
//!
//! A perfectly white Lambert surface at the point would send E / pi into every direction, so that its radiance is estimated as
//! that of any surface which a camera sees: by samples of the lights and by directions that run into them, weighted, and by paths
//! that go on from there ([`crate::path_tracing`]). The sensor shades nothing and reflects nothing. Unbiased but for the largest
//! depth.
//!
//! Samples are Sobol points in [`N_BATCHES`] batches of independent seeds; the spread of their means tells the standard error.

use std::f64::consts::PI;

use etendue_geometry::{GeometryId, Hit, NO_INSTANCE, SurfacePoint};
use etendue_math::statistics::Moments;
use etendue_math::{
    Normal3, Point2, Point3, Rng, Sampler, SamplerKind, SamplerSettings, Vector3, hash64, warp,
};
use etendue_scene::Scene;
use etendue_scene::bsdf::{Bsdf, BsdfKind, Diffuse};
use etendue_scene::material::MaterialId;
use etendue_scene::medium::MediumId;
use etendue_scene::scene::Surface;
use etendue_spectrum::{Sampled, Wavelengths};
use rayon::prelude::*;

use crate::lpe::PathExpressions;
use crate::path::camera_pass::{CameraPath, Tracer};
use crate::path::medium::{medium_along, most_frequent};
use crate::path_tracing::PathSettings;
use crate::path_tracing::walk::Walk;

/// Batches of independent samples.
pub const N_BATCHES: u32 = 16;

/// Points as near to a surface as this share of the scene's size lie on it, on the side of their normal: who types a point of a
/// wall cannot type its rounding.
const ON_SURFACE: f32 = 1e-5;

/// Rays that look for what the point lies in.
const N_MEDIUM_RAYS: u32 = 16;

/// Where the instruments are.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ProbePoint {
    /// Position.
    pub p: Point3,
    /// Unit normal of the luxmeter, and where the luminance meter looks.
    pub n: Normal3,
}

/// How long they measure.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct ProbeSettings {
    /// Paths for each point and instrument; rounded up to a multiple of [`N_BATCHES`].
    pub samples: u32,
    /// Most scattering events of a path before it reaches the point.
    pub max_depth: u32,
    /// Seed of all random numbers.
    pub seed: u64,
}

impl Default for ProbeSettings {
    fn default() -> Self {
        Self { samples: 1024, max_depth: 100, seed: 0 }
    }
}

/// A reading with its standard error.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Estimate {
    /// Value.
    pub mean: f64,
    /// Standard error of the value.
    pub standard_error: f64,
}

/// What the instruments read.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Reading {
    /// Illuminance of the side of the normal in lux, where a light of luminance 1 in the scene file has 1 cd/m^2.
    pub illuminance_lx: Estimate,
    /// The part of it that comes straight from lights.
    pub direct_lx: Estimate,
    /// Luminance of what is seen along the normal, in cd/m^2.
    pub luminance_cd_m2: Estimate,
    /// Samples that were not finite or negative, and count as black.
    pub n_invalid: u32,
}

/// Sums of one batch.
#[derive(Clone, Copy, Debug, Default)]
struct Batch {
    illuminance: f64,
    direct: f64,
    luminance: f64,
    n_invalid: u32,
}

/// Reads the instruments at some points. To a scene with switches of artists (SPEC EMI-14), which are for pictures, the sensor is
/// a part of the first shape: take them off before.
#[must_use]
pub fn probe(scene: &Scene, points: &[ProbePoint], settings: &ProbeSettings) -> Vec<Reading> {
    let n = settings.samples.div_ceil(N_BATCHES).max(1);
    let read = |(index, point): (usize, &ProbePoint)| {
        let probe = Probe::new(scene, *point, *settings);
        let batches: Vec<Batch> =
            (0..N_BATCHES).into_par_iter().map(|batch| probe.batch(index, batch, n)).collect();
        reading(&batches)
    };
    points.par_iter().enumerate().map(read).collect()
}

fn reading(batches: &[Batch]) -> Reading {
    let estimate = |value: fn(&Batch) -> f64| {
        let mut moments = Moments::new();
        batches.iter().for_each(|batch| moments.push(value(batch)));
        Estimate { mean: moments.mean(), standard_error: moments.standard_error() }
    };
    Reading {
        illuminance_lx: estimate(|batch| batch.illuminance),
        direct_lx: estimate(|batch| batch.direct),
        luminance_cd_m2: estimate(|batch| batch.luminance),
        n_invalid: batches.iter().map(|batch| batch.n_invalid).sum(),
    }
}

/// The instruments at one point.
struct Probe<'s> {
    scene: &'s Scene,
    /// A surface at the point that nothing meets, seen along its normal.
    surface: Surface,
    bsdf: Bsdf,
    medium: Option<MediumId>,
    settings: ProbeSettings,
}

/// An instrument; each has random numbers of its own.
#[derive(Clone, Copy, Debug)]
enum Instrument {
    /// The luxmeter, for paths of at most so many scattering events, that of the sensor included.
    Luxmeter(u32),
    LuminanceMeter,
}

impl<'s> Probe<'s> {
    fn new(scene: &'s Scene, point: ProbePoint, settings: ProbeSettings) -> Self {
        let surface = surface(scene, point);
        let white = BsdfKind::Diffuse(Diffuse::new(Sampled::ONE));
        let bsdf = Bsdf::isotropic(point.n, point.n, white);
        Self { scene, surface, bsdf, medium: medium(scene, &surface), settings }
    }

    /// Means of `n` samples at the point of this index.
    fn batch(&self, index: usize, batch: u32, n: u32) -> Batch {
        let luxmeter = Instrument::Luxmeter(self.settings.max_depth.saturating_add(1));
        let mut sum = Batch::default();
        let mut add = |instrument, factor: f64| {
            let values =
                (0..u64::from(n)).map(|pass| self.sample([index as u32, batch], pass, n, instrument));
            let mut total = 0.0;
            for value in values {
                let is_valid = value.is_finite() && value >= 0.0;
                sum.n_invalid += u32::from(!is_valid);
                total += if is_valid { value } else { 0.0 };
            }
            total * factor / f64::from(n)
        };
        let (illuminance, direct) = (add(luxmeter, PI), add(Instrument::Luxmeter(1), PI));
        let luminance = add(Instrument::LuminanceMeter, 1.0);
        Batch { illuminance, direct, luminance, ..sum }
    }

    /// One sample of the luminance that the instrument sees.
    fn sample(&self, [index, batch]: [u32; 2], pass: u64, n: u32, instrument: Instrument) -> f64 {
        let scene = self.scene;
        let (stream, max_depth) = match instrument {
            Instrument::Luxmeter(max_depth) => (0, max_depth),
            Instrument::LuminanceMeter => (1, self.settings.max_depth),
        };
        let seed = hash64(&[self.settings.seed, u64::from(batch)]);
        let settings = SamplerSettings { kind: SamplerKind::Sobol, seed, samples_per_pixel: n };
        let mut sampler = Sampler::new(&settings, [index, stream], pass);
        let mut lambda = Wavelengths::sample_visible(sampler.next_1d());
        let time = scene.camera.sample_time(sampler.next_1d());
        let surface = Surface { time, ..self.surface };
        let expressions = PathExpressions::default();
        let tracer = Tracer::new(scene);
        let mut path = CameraPath {
            ray: surface.spawn_ray(surface.wo),
            medium: self.medium,
            numbers_of: [index, stream],
            pass,
            lambda: &mut lambda,
            sampler: &mut sampler,
            layers: &mut expressions.recorder(),
            features: None,
        };
        let settings = PathSettings { max_depth, ..PathSettings::default() };
        let mut walk = Walk::new(&settings, &path);
        let goes_on = match instrument {
            Instrument::LuminanceMeter => true,
            Instrument::Luxmeter(_) => walk.visit(&tracer, &surface, &self.bsdf, &mut path),
        };
        let radiance = walk.follow_if(goes_on, &tracer, &mut path);
        let sensor = &scene.film.sensor;
        f64::from(sensor.luminance(radiance, &lambda) / sensor.settings().imaging_ratio())
    }
}

/// The luxmeter as a surface that sends light along its normal.
fn surface(scene: &Scene, ProbePoint { p, n }: ProbePoint) -> Surface {
    let bounds = scene.bounds();
    let size = if bounds.is_empty() { 0.0 } else { bounds.diagonal().length() };
    let point = SurfacePoint {
        p,
        p_error: Vector3::splat(ON_SURFACE * size),
        ng: n,
        ns: n,
        uv: Point2::new(0.5, 0.5),
        face_index: 0,
    };
    let hit = Hit { t: 1.0, geometry: GeometryId(0), primitive: 0, instance: NO_INSTANCE, uv: [0.5, 0.5] };
    let wo = n.as_vector();
    let material = opaque_material(scene);
    Surface { point, hit, ray_origin: p + wo, wo, time: scene.camera.sample_time(0.5), material, light: None }
}

/// A material that does not part space, so that paths keep the medium of the point.
fn opaque_material(scene: &Scene) -> MaterialId {
    let ids = (0..scene.materials.len() as u32).map(MaterialId);
    ids.into_iter().find(|id| scene.materials.interface(*id).is_none()).unwrap_or(MaterialId(0))
}

/// What the point lies in, as most rays from it find.
fn medium(scene: &Scene, surface: &Surface) -> Option<MediumId> {
    if scene.materials.media().is_empty() {
        return None;
    }
    let mut rng = Rng::new(0x9b0e, 1);
    let found = (0..N_MEDIUM_RAYS).filter_map(|_| {
        let w = warp::sample_uniform_sphere(rng.next_point2());
        let n = surface.wo;
        let w = if w.dot(n) < 0.0 { -w } else { w };
        medium_along(scene, surface.spawn_ray(w))
    });
    most_frequent(found)
}
