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

/// One of so many photons that were wanted is too few.
const SCARCE: u64 = 10;
/// Mean radius over the diagonal of the scene from which a word is said where that many times the photons of an estimate were wanted.
const WIDE: f32 = 0.25;
const MANY: u64 = 100;

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
    let scarce = scarce_advice(names, map);
    let wide = wide_advice(names, map, probe).filter(|_| scarce.is_none());
    vec![
        ReportEntry::new(names.emitted, map.map.n_emitted() as f64, ""),
        ReportEntry::new(names.stored, map.map.len() as f64, "").with_advice_if_any(scarce),
        length(names.mean_radius, probe.mean_radius).with_advice_if_any(wide),
        length(names.worst_radius, probe.worst_radius),
        length(names.max_radius, map.estimate.max_radius),
        ReportEntry::new(names.limited, probe.limited, "")
            .with_advice_if_any(limited_advice(names, map, probe)),
    ]
}

/// A word where emission ended with far fewer photons than were wanted.
fn scarce_advice(names: &MapNames, map: &LitMap) -> Option<String> {
    let (stored, wanted) = (map.map.len() as u64, map.asked.n_photons);
    (names.expects_everywhere && stored > 0 && stored < wanted / SCARCE).then(|| {
        format!(
            "of the {wanted} photons wanted {stored} were stored when {} were emitted: few come to where they are kept, and \
             what they show is blotchy or dark; compare with \"path\"",
            map.map.n_emitted()
        )
    })
}

/// A word where estimates blur all that there is, though not because few photons were asked for.
fn wide_advice(names: &MapNames, map: &LitMap, probe: &Probe) -> Option<String> {
    let size = map.asked.scene_size;
    let is_wide = probe.n > 0 && probe.mean_radius > WIDE * size;
    let are_many_wanted = map.asked.n_photons >= MANY * map.estimate.k as u64;
    (names.expects_everywhere && is_wide && are_many_wanted).then(|| {
        format!(
            "estimates take photons from {:.3} m around, in a scene of {size:.3} m: few are where the camera looks, and light is \
             blurred over all of it; more \"{}\" show more",
            probe.mean_radius, names.photons_parameter
        )
    })
}

/// A word where a radius that was given holds too few photons. One that was chosen by density is smaller the more photons there
/// are, and what it finds too few of is just dim.
fn limited_advice(names: &MapNames, map: &LitMap, probe: &Probe) -> Option<String> {
    let (radius, photons, own) = (map.estimate.max_radius, names.photons_parameter, names.radius_parameter);
    if !map.asked.has_radius || probe.n == 0 {
        return None;
    }
    if names.expects_everywhere {
        return (probe.limited > MANY_LIMITED).then(|| {
            format!(
                "{:.0} % of the places that are seen have fewer photons than an estimate wants within {radius:.3} m: more \
                 \"{photons}\", or a larger \"{own}\"",
                100.0 * probe.limited
            )
        });
    }
    map.asked.sufficient_radius.map(|sufficient| {
        format!(
            "around most photons there are fewer than an estimate wants within \"{own}\" {radius:?}: more \"{photons}\", or a \
             larger radius, such as {sufficient:.2e} m"
        )
    })
}
