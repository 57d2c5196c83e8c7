//! Ambient occlusion (Zhukov, Iones and Kronin 1998, "An Ambient Light Illumination Model"; Landis 2002, "Production-Ready
//! Global Illumination"): how much of the sky each surface sees.
//!
//! ```text
//! A(x) = 1/pi integral over the hemisphere of V(x, w) cos(theta) dw
//! ```
//!
//! V is 1 where nothing is closer than `maxdistance`. That is the light of a white sky on white surfaces without any bounces; the
//! lights and materials of the scene do not matter. Surfaces that light passes are passed by. By cosine-weighted directions a sample is V;
//! by uniform ones it is 2 V cos(theta), with more noise.
//!
//! A picture of its own, not an approximation of the scene's light: neither unbiased nor consistent.

use etendue_math::{Frame, Normal3, Vector3, warp};
use etendue_scene::film::TileSamples;
use etendue_scene::light::LightPoint;
use etendue_scene::parameters::{ParameterSpec, Parameters};
use etendue_scene::scene::Surface;
use etendue_scene::{Film, Scene};
use etendue_spectrum::Sampled;

use crate::integrator::{Control, Integrator, PassEnd, Passes};
use crate::lpe::PathExpressions;
use crate::path::adaptive::AdaptivePixels;
use crate::path::camera_pass::{CameraPass, CameraPath, Follow, FollowedPath, Tracer, WavelengthMode};
use crate::path::features::describe;

/// Most directions of a camera sample.
const MOST_SAMPLES: u32 = 4096;

/// Settings of ambient occlusion.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct OcclusionSettings {
    /// Directions are chosen in proportion to their cosine, else uniformly.
    pub is_by_cosine: bool,
    /// What is further away does not occlude, in metres.
    pub max_distance: f32,
    /// Directions for each camera sample.
    pub n_samples: u32,
    /// Multiplies by the reflectance of the surface.
    pub shows_albedo: bool,
    /// Interpolates pixels; biased.
    pub adaptive: Option<AdaptivePixels>,
}

impl OcclusionSettings {
    /// Parameters in scene files.
    pub const PARAMETERS: &'static [ParameterSpec] = &[
        ParameterSpec {
            name: "cossample",
            kind: "bool",
            default: "true",
            unit: "",
            doc: "choose directions by their cosine, else uniformly, with more noise",
        },
        ParameterSpec {
            name: "maxdistance",
            kind: "float",
            default: "infinity",
            unit: "m",
            doc: "what is further away does not occlude",
        },
        ParameterSpec {
            name: "samples",
            kind: "integer",
            default: "1",
            unit: "",
            doc: "directions for each camera sample",
        },
        ParameterSpec {
            name: "albedo",
            kind: "bool",
            default: "false",
            unit: "",
            doc: "multiply by the reflectance of the surface",
        },
        AdaptivePixels::PIXELS,
        AdaptivePixels::CONTRAST,
        AdaptivePixels::BLOCK_SIZE,
    ];

    /// Reads the parameters of an integrator entity.
    pub fn from_parameters(p: &mut Parameters<'_, '_>) -> Self {
        let mut max_distance = p.float("maxdistance", f32::INFINITY);
        if max_distance.is_nan() || max_distance <= 0.0 {
            let span = p.span_of("maxdistance");
            let message = format!("\"maxdistance\" must be positive, not {max_distance}");
            p.diagnostics().error(span, message);
            max_distance = f32::INFINITY;
        }
        Self {
            is_by_cosine: p.bool("cossample", true),
            max_distance,
            n_samples: p.count_within("samples", 1, 1, MOST_SAMPLES),
            shows_albedo: p.bool("albedo", false),
            adaptive: AdaptivePixels::from_parameters(p),
        }
    }
}

/// Ambient occlusion.
#[derive(Clone, Debug)]
pub struct AmbientOcclusion {
    settings: OcclusionSettings,
    expressions: PathExpressions,
    /// Memory of the last pass's tiles, for the next.
    tiles: Vec<TileSamples>,
}

impl AmbientOcclusion {
    /// Ambient occlusion for a film with these layers, which stay black; where there are any, pixels are not interpolated.
    #[must_use]
    pub fn new(mut settings: OcclusionSettings, expressions: PathExpressions) -> Self {
        if !expressions.is_empty() {
            settings.adaptive = None;
        }
        Self { settings, expressions, tiles: Vec::new() }
    }
}

impl Integrator for AmbientOcclusion {
    fn passes(&self) -> Passes {
        Passes::Independent
    }

    fn run_pass(&mut self, scene: &Scene, pass: u64, film: &mut Film, control: &Control<'_>) -> PassEnd {
        let camera_pass = CameraPass {
            wavelengths: WavelengthMode::Hero,
            expressions: &self.expressions,
            group_size: 1,
            adaptive: self.settings.adaptive,
        };
        camera_pass.run(scene, pass, film, control, &mut self.tiles, &Occlusion { settings: &self.settings })
    }
}

/// Looks around from the first surface.
#[derive(Debug)]
struct Occlusion<'s> {
    settings: &'s OcclusionSettings,
}

impl Follow for Occlusion<'_> {
    type Left = ();

    fn follow(&self, tracer: &Tracer<'_>, path: &mut CameraPath<'_, '_>) -> (Sampled, ()) {
        (self.occlusion(tracer, path).unwrap_or(Sampled::ZERO), ())
    }

    fn join(&self, _: &Tracer<'_>, _: &mut [FollowedPath<()>]) {}
}

impl Occlusion<'_> {
    /// The light of the first surface; `None` if there is none.
    fn occlusion(&self, tracer: &Tracer<'_>, path: &mut CameraPath<'_, '_>) -> Option<Sampled> {
        let scene = tracer.scene;
        let mut ray = path.ray;
        let (surface, bsdf) = loop {
            let surface = scene.surface(&ray, &tracer.intersect(&ray)?);
            match scene.bsdf(&surface, path.lambda) {
                Some(bsdf) => break (surface, bsdf),
                None => ray = surface.spawn_ray(ray.direction),
            }
        };
        if let Some(features) = &mut path.features {
            **features = describe(scene, &surface, &bsdf, path.lambda);
        }
        let n = self.settings.n_samples;
        let mut open = 0.0;
        for part in 0..n {
            open += path.with_sampler_of_part(&scene.sampler, part, n, |path| {
                path.sampler.start_vertex();
                self.look(tracer, &surface, path)
            });
        }
        let white = scene.film.white(path.lambda) * (open / n as f32);
        Some(if self.settings.shows_albedo { white * bsdf.albedo(surface.wo) } else { white })
    }

    /// What one direction says.
    fn look(&self, tracer: &Tracer<'_>, surface: &Surface, path: &mut CameraPath<'_, '_>) -> f32 {
        let u = path.sampler.next_2d();
        let (local, weight) = if self.settings.is_by_cosine {
            (warp::sample_cosine_hemisphere(u), 1.0)
        } else {
            let local = warp::sample_uniform_hemisphere(u);
            (local, 2.0 * local.z)
        };
        let n = towards(surface.point.ng, surface.wo);
        let wi = Frame::from_z(n).to_world(local);
        tracer.count_shadow_ray();
        weight * self.visibility(tracer.scene, surface, wi)
    }

    fn visibility(&self, scene: &Scene, surface: &Surface, wi: Vector3) -> f32 {
        if self.settings.max_distance == f32::INFINITY {
            return scene.transmittance_to_infinity(surface, wi);
        }
        let end = LightPoint {
            p: surface.point.p + wi * self.settings.max_distance,
            p_error: Vector3::default(),
            n: None,
            uv: surface.point.uv,
        };
        scene.transmittance(surface, &end)
    }
}

/// The normal on the side of a direction.
fn towards(n: Normal3, w: Vector3) -> Vector3 {
    let n = n.as_vector();
    if n.dot(w) < 0.0 { -n } else { n }
}
