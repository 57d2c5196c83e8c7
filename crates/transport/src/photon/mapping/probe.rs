//! How well a map answers where the camera looks: figures for the report, and advice.

use etendue_math::{Point2, Sampler};
use etendue_scene::Scene;
use etendue_scene::bsdf::{Bsdf, Lobes, TransportMode};
use etendue_scene::scene::Surface;
use etendue_spectrum::Wavelengths;

use super::lit_map::{LitMap, wide_lobes};
use crate::integrator::ReportEntry;
use crate::path::camera_pass::Tracer;
use crate::photon::estimate::EstimateScratch;

/// Camera rays of a probe.
const N_RAYS: u64 = 1024;
/// Surfaces that such a ray passes or is mirrored by.
const MOST_EVENTS: u32 = 16;
/// A place in the image plane that no pixel has.
const PROBE_PIXEL: [u32; 2] = [0x8000_0000, 0x8000_0000];
/// The share of limited estimates from which a word is said.
const MANY_LIMITED: f64 = 0.5;

/// Estimates at surfaces that are seen, directly or by sharp scattering.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct Probe {
    /// Estimates made.
    pub(crate) n: u32,
    /// Mean radius in metres.
    pub(crate) mean_radius: f32,
    /// The greatest radius in metres.
    pub(crate) worst_radius: f32,
    /// Share of estimates whose greatest radius held fewer photons than were wanted.
    pub(crate) limited: f64,
}

impl Probe {
    /// Looks at a map.
    pub(crate) fn new(scene: &Scene, map: &LitMap, sharp_alpha: f32) -> Self {
        if map.map.is_empty() {
            return Self::default();
        }
        let (tracer, mut scratch) = (Tracer::new(scene), EstimateScratch::default());
        let (mut n, mut n_limited, mut sum, mut worst_radius) = (0, 0, 0.0, 0.0_f32);
        for ray in 0..N_RAYS {
            let mut lambda = Wavelengths::sample_visible((ray as f32 + 0.5) / N_RAYS as f32);
            let Some((surface, bsdf)) = look(&tracer, ray, sharp_alpha, &mut lambda) else { continue };
            let lobes = wide_lobes(&bsdf, sharp_alpha);
            let density = map.radiance(&surface, (&bsdf, lobes), &lambda, &mut scratch).1;
            n += 1;
            n_limited += u32::from(density.is_limited);
            sum += f64::from(density.radius);
            worst_radius = worst_radius.max(density.radius);
        }
        let share = |sum: f64| if n > 0 { sum / f64::from(n) } else { 0.0 };
        Self { n, mean_radius: share(sum) as f32, worst_radius, limited: share(f64::from(n_limited)) }
    }
}

/// The first surface with wide lobes that a camera ray comes to.
fn look(
    tracer: &Tracer<'_>,
    index: u64,
    sharp_alpha: f32,
    lambda: &mut Wavelengths,
) -> Option<(Surface, Bsdf)> {
    let scene = tracer.scene;
    let mut numbers = Sampler::new(&scene.sampler, PROBE_PIXEL, index);
    let (u, u_time, u_lens) = (numbers.next_2d(), numbers.next_1d(), numbers.next_2d());
    let crop = scene.film.crop;
    let at = |axis: usize, u: f32| crop.min[axis] as f32 + u * (crop.max[axis] - crop.min[axis]) as f32;
    let p_film = Point2::new(at(0, u.x), at(1, u.y));
    let mut ray = scene.camera.sample_ray(p_film, u_lens, u_time)?.ray;
    for _ in 0..MOST_EVENTS {
        let surface = scene.surface(&ray, &tracer.intersect(&ray)?);
        let Some(bsdf) = scene.bsdf(&surface, lambda) else {
            ray = surface.spawn_ray(ray.direction);
            continue;
        };
        if !wide_lobes(&bsdf, sharp_alpha).is_empty() {
            return Some((surface, bsdf));
        }
        let (u_component, u) = (numbers.next_1d(), numbers.next_2d());
        let sample = bsdf.sample(surface.wo, u_component, u, TransportMode::Radiance, Lobes::ALL)?;
        ray = surface.spawn_ray(sample.wi);
    }
    None
}

/// What a map's figures are called, and its parameters.
#[derive(Clone, Copy, Debug)]
pub(crate) struct MapNames {
    pub(crate) emitted: &'static str,
    pub(crate) stored: &'static str,
    pub(crate) mean_radius: &'static str,
    pub(crate) worst_radius: &'static str,
    pub(crate) max_radius: &'static str,
    pub(crate) limited: &'static str,
    pub(crate) photons_parameter: &'static str,
    pub(crate) radius_parameter: &'static str,
    /// Photons should be wherever one looks.
    pub(crate) expects_everywhere: bool,
}

/// Figures of a map, with a word where one is off.
pub(crate) fn describe_map(names: &MapNames, map: &LitMap, probe: &Probe) -> Vec<ReportEntry> {
    let length = |name, value: f32| ReportEntry::new(name, f64::from(value), "m");
    let mut limited = ReportEntry::new(names.limited, probe.limited, "");
    if names.expects_everywhere && probe.limited > MANY_LIMITED && probe.n > 0 {
        limited = limited.with_advice(format!(
            "{:.0} % of the places that are seen have fewer photons than an estimate wants within {:.3} m: more \"{}\", or a larger \"{}\"",
            100.0 * probe.limited,
            map.estimate.max_radius,
            names.photons_parameter,
            names.radius_parameter
        ));
    }
    vec![
        ReportEntry::new(names.emitted, map.map.n_emitted() as f64, ""),
        ReportEntry::new(names.stored, map.map.len() as f64, ""),
        length(names.mean_radius, probe.mean_radius),
        length(names.worst_radius, probe.worst_radius),
        length(names.max_radius, map.estimate.max_radius),
        limited,
    ]
}
