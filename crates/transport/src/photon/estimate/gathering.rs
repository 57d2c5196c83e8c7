//! Photon gathering: photons as small lights (Jensen 2001, section 7.5; SPEC EST-12).
//!
//! No density is estimated. Each photon that met a surface lights it, and what the surface scatters of it lights all that it sees:
//! with `y` where the photon is and `d` its distance from `x`
//!
//! ```text
//! L(x, wo) = sum over photons of  f_x(wo, x→y) |cos_x|  f_y(y→x, wi_p) |cos_y|  Φ_p V(x, y) / d^2
//! ```
//!
//! A photon after n reflections gives light of n + 1. That is bidirectional path tracing whose light paths are kept; it is
//! unbiased but for colour, which travels from `y` to `x` as XYZ. Each photon wants a shadow ray, so that a few thousand are as many as one
//! can have; [`GatherChoice`] takes some of them. Where `d` is small single photons shine: the variance has no bound, and
//! [`GatherSettings::min_distance`] bounds the light instead (Keller 1997, "Instant Radiosity"), which darkens corners.

use etendue_math::Vector3;
use etendue_scene::bsdf::{Bsdf, Lobes, TransportMode};
use etendue_scene::light::LightPoint;
use etendue_scene::scene::Surface;
use etendue_spectrum::{Sampled, Wavelengths, Xyz, flux_to_xyz};

use super::radiance::LobeSum;
use crate::path::camera_pass::Tracer;
use crate::photon::PhotonVertex;

/// A photon on a surface that it lights.
#[derive(Clone, Copy, Debug)]
pub struct PhotonLight {
    surface: Surface,
    bsdf: Bsdf,
    flux: Sampled,
    lambda: Wavelengths,
}

/// Which photons have shadow rays.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum GatherChoice {
    /// All.
    #[default]
    All,
    /// So many, at equal steps through the list from a random start.
    Random(u32),
    /// So many, in proportion to what they would bring if nothing were in between.
    Important(u32),
}

/// How photons are gathered.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct GatherSettings {
    /// Which photons have shadow rays.
    pub choice: GatherChoice,
    /// Photons that are nearer than this, in metres, count as if they were as far; 0 is unbiased.
    pub min_distance: f32,
}

impl PhotonLight {
    /// A photon where it arrived, of `n_emitted`; `None` where it lights nothing that is not along one line.
    #[must_use]
    pub fn new(vertex: &PhotonVertex<'_>, n_emitted: u64) -> Option<Self> {
        vertex.bsdf.lobes().has_non_specular().then(|| Self {
            surface: *vertex.surface,
            bsdf: *vertex.bsdf,
            flux: vertex.flux / n_emitted as f32,
            lambda: *vertex.lambda,
        })
    }

    /// What it sends in the unit direction `w`, in XYZ per steradian.
    fn intensity(&self, w: Vector3) -> Xyz {
        let f = self.bsdf.eval(self.surface.wo, w, TransportMode::Importance, Lobes::NON_SPECULAR);
        flux_to_xyz(self.flux * f * self.bsdf.abs_cos(w), &self.lambda)
    }

    fn point(&self) -> LightPoint {
        let point = &self.surface.point;
        LightPoint { p: point.p, p_error: point.p_error, n: Some(point.ng), uv: point.uv }
    }
}

/// A photon as a surface sees it.
#[derive(Clone, Copy, Debug)]
struct Connection {
    index: u32,
    /// Its irradiance over the cosine, in XYZ, were nothing in between.
    power: Xyz,
    /// What the surface makes of it, with its cosine.
    f_cos: Sampled,
    /// Brightness of the two, added up to this photon.
    cumulative: f64,
}

/// Memory of the gathering of one thread.
#[derive(Clone, Debug, Default)]
pub struct GatherScratch(Vec<Connection>);

/// Light of one scattering event or more that reaches a surface from photons, and goes on towards `surface.wo`. `u` in [0, 1) chooses
/// photons if not all are wanted.
#[must_use]
pub fn gather(
    tracer: &Tracer<'_>,
    (surface, bsdf, lambda): (&Surface, &Bsdf, &Wavelengths),
    lights: &[PhotonLight],
    settings: GatherSettings,
    u: f32,
    scratch: &mut GatherScratch,
) -> Sampled {
    let mut sum = LobeSum::default();
    let connect = |index: usize| connect(surface, bsdf, lights, index, settings.min_distance);
    let mut add = |connection: &Connection, weight: f32| {
        let light = &lights[connection.index as usize];
        tracer.count_shadow_ray();
        let visibility = tracer.scene.transmittance(surface, &light.point());
        if visibility > 0.0 {
            sum.add(connection.power, visibility * weight, connection.f_cos);
        }
    };
    let n = lights.len();
    match settings.choice {
        GatherChoice::Random(n_rays) if (n_rays as usize) < n => {
            let weight = n as f32 / n_rays as f32;
            for ray in 0..n_rays as usize {
                let index = ((ray as f64 + f64::from(u)) * n as f64 / f64::from(n_rays)) as usize;
                connect(index.min(n - 1)).iter().for_each(|connection| add(connection, weight));
            }
        }
        GatherChoice::Important(n_rays) if (n_rays as usize) < n => {
            let connections = &mut scratch.0;
            connections.clear();
            let mut total = 0.0;
            for mut connection in (0..n).filter_map(connect) {
                total += connection.brightness();
                connection.cumulative = total;
                connections.push(connection);
            }
            let (step, mut next) = (total / f64::from(n_rays), 0);
            for ray in 0..n_rays {
                let at = (f64::from(ray) + f64::from(u)) * step;
                while next + 1 < connections.len() && connections[next].cumulative <= at {
                    next += 1;
                }
                let Some(connection) = connections.get(next) else { break };
                add(connection, (step / connection.brightness()) as f32);
            }
        }
        _ => (0..n).filter_map(connect).for_each(|connection| add(&connection, 1.0)),
    }
    sum.radiance(1.0, lambda)
}

fn connect(
    surface: &Surface,
    bsdf: &Bsdf,
    lights: &[PhotonLight],
    index: usize,
    min_distance: f32,
) -> Option<Connection> {
    let light = &lights[index];
    let to_light = light.surface.point.p - surface.point.p;
    let distance_squared = to_light.length_squared();
    let wi = to_light.try_normalized()?;
    let f_cos = bsdf.eval(surface.wo, wi, TransportMode::Radiance, Lobes::NON_SPECULAR) * bsdf.abs_cos(wi);
    if f_cos.is_black() {
        return None;
    }
    let scale = 1.0 / distance_squared.max(min_distance * min_distance).max(f32::MIN_POSITIVE);
    let [x, y, z] = light.intensity(-wi).to_array().map(|value| value * scale);
    let connection = Connection { index: index as u32, power: Xyz::new(x, y, z), f_cos, cumulative: 0.0 };
    let brightness = connection.brightness();
    (brightness > 0.0 && brightness.is_finite()).then_some(connection)
}

impl Connection {
    fn brightness(&self) -> f64 {
        let Xyz { x, y, z } = self.power;
        f64::from(x + y + z) * f64::from(self.f_cos.average())
    }
}
