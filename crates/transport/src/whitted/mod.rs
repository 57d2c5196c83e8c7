//! Recursive ray tracing (Whitted 1980, "An Improved Illumination Model for Shaded Display", doi:10.1145/358876.358882;
//! SPEC WHIT-1, WHIT-3, WHIT-4).
//!
//! ```text
//! L(x, wo) = L_e + sum over lights of f L_i |cos| V + R L(mirrored) + T L(refracted)
//! ```
//!
//! Every light sends one shadow ray: a point light to where it is, one with an area to a random place of it, or to its middle.
//! R and T are what the surface says, Fresnel's reflectance and transmittance for glass, and both rays are followed, so that
//! a pixel costs a tree of rays that `maxdepth` limits. Glossy lobes show lights alone.
//!
//! Finds the paths `LD?S*E`, without noise but for lights with an area: neither light from surface to surface nor
//! caustics. Where there are more than [`MOST_LIGHTS`] lights, one is chosen for each sample as path tracing does.

mod settings;

use etendue_geometry::{GeometryId, Hit};
use etendue_math::{Point2, Ray};
use etendue_scene::bsdf::{Bsdf, Lobes, TransportMode};
use etendue_scene::film::TileSamples;
use etendue_scene::light::{LightId, LightSample};
use etendue_scene::medium::MediumId;
use etendue_scene::scene::Surface;
use etendue_scene::{Film, Scene};
use etendue_spectrum::Sampled;

use crate::integrator::{Control, Integrator, PassEnd, Passes};
use crate::lpe::{Event, PathExpressions};
use crate::path::camera_pass::{CameraPass, CameraPath, Follow, FollowedPath, Tracer};
use crate::path::direct::{choose_light, visibility};
use crate::path::features::describe;

pub use settings::{LightPlace, WhittedSettings};

/// The most lights that are all asked at every surface.
pub const MOST_LIGHTS: usize = 64;

/// Rays of which less reaches the camera are not followed (Hall and Greenberg 1983, "A Testbed for Realistic Image
/// Synthesis"): a surface divides light between its two rays, so that at most a thousand of a level are left.
const LEAST_THROUGHPUT: f32 = 1e-3;

/// Recursive ray tracing.
#[derive(Clone, Debug)]
pub struct Whitted {
    settings: WhittedSettings,
    expressions: PathExpressions,
    /// Memory of the last pass's tiles, for the next.
    tiles: Vec<TileSamples>,
}

impl Whitted {
    /// Recursive ray tracing that fills the film's layers by these expressions.
    #[must_use]
    pub const fn new(settings: WhittedSettings, expressions: PathExpressions) -> Self {
        Self { settings, expressions, tiles: Vec::new() }
    }
}

impl Integrator for Whitted {
    fn passes(&self) -> Passes {
        Passes::Independent
    }

    fn run_pass(&mut self, scene: &Scene, pass: u64, film: &mut Film, control: &Control<'_>) -> PassEnd {
        let camera_pass = CameraPass {
            wavelengths: self.settings.wavelengths,
            expressions: &self.expressions,
            group_size: 1,
            adaptive: None,
        };
        camera_pass.run(scene, pass, film, control, &mut self.tiles, &Tree { settings: &self.settings })
    }
}

/// Follows the tree of rays of a camera sample.
#[derive(Debug)]
struct Tree<'s> {
    settings: &'s WhittedSettings,
}

/// A ray of the tree.
#[derive(Clone, Copy, Debug)]
struct Branch {
    ray: Ray,
    /// What radiance along it is multiplied by on the way to the camera.
    beta: Sampled,
    /// Scattering events so far.
    depth: u32,
    /// What it travels through.
    medium: Option<MediumId>,
    /// The shape that it left last.
    from: Option<GeometryId>,
}

impl Branch {
    /// True if an artist lets a light reach the shape that the branch left: it may see the light then.
    fn admits(&self, scene: &Scene, light: LightId) -> bool {
        let (Some(controls), Some(from)) = (&scene.controls, self.from) else { return true };
        controls.reaches(light, from)
    }
}

impl Follow for Tree<'_> {
    type Left = ();

    fn follow(&self, tracer: &Tracer<'_>, path: &mut CameraPath<'_, '_>) -> (Sampled, ()) {
        let root = Branch { ray: path.ray, beta: Sampled::ONE, depth: 0, medium: path.medium, from: None };
        (self.trace(tracer, root, path), ())
    }

    fn join(&self, _: &Tracer<'_>, _: &mut [FollowedPath<()>]) {}
}

impl Tree<'_> {
    /// What a ray and all that grows from it bring to the camera.
    fn trace(&self, tracer: &Tracer<'_>, mut branch: Branch, path: &mut CameraPath<'_, '_>) -> Sampled {
        let scene = tracer.scene;
        let mut radiance = Sampled::ZERO;
        loop {
            let hit = tracer.intersect(&branch.ray);
            if let Some(medium) = branch.medium {
                let distance = hit.as_ref().map_or(f32::INFINITY, |hit: &Hit| hit.t);
                branch.beta *= scene.transmittance_of(medium, distance, path.lambda);
            }
            let Some(hit) = hit else {
                return radiance + emit(branch.beta * surroundings(scene, &branch, path), path);
            };
            let surface = scene.surface(&branch.ray, &hit);
            if surface.light.is_some_and(|light| branch.admits(scene, light)) {
                radiance += emit(branch.beta * scene.emitted(&surface, path.lambda), path);
            }
            if branch.depth == 0 {
                radiance += emit(branch.beta * scene.ambient(&surface, path.lambda), path);
            }
            let Some(bsdf) = scene.bsdf(&surface, path.lambda) else {
                branch.ray = surface.spawn_ray(branch.ray.direction);
                continue;
            };
            if branch.depth == 0
                && let Some(features) = &mut path.features
            {
                **features = describe(scene, &surface, &bsdf, path.lambda);
            }
            if branch.depth < self.settings.max_depth {
                radiance += self.shade(tracer, &surface, &bsdf, &branch, path);
            }
            return radiance;
        }
    }

    /// What a surface sends along a branch: light from the lights, and from where it mirrors and refracts.
    fn shade(
        &self,
        tracer: &Tracer<'_>,
        surface: &Surface,
        bsdf: &Bsdf,
        branch: &Branch,
        path: &mut CameraPath<'_, '_>,
    ) -> Sampled {
        path.sampler.start_vertex();
        let mut radiance = Sampled::ZERO;
        if bsdf.lobes().has_non_specular() {
            radiance += self.direct_light(tracer, surface, bsdf, branch, path);
        }
        let position = path.layers.position();
        for lobe in [Lobes::SPECULAR_REFLECT, Lobes::SPECULAR_TRANSMIT] {
            if !bsdf.lobes().intersects(lobe) {
                continue;
            }
            let (u_component, u) = (path.sampler.next_1d(), path.sampler.next_2d());
            let Some(sample) = bsdf.sample(surface.wo, u_component, u, TransportMode::Radiance, lobe) else {
                continue;
            };
            path.layers.return_to(&position);
            path.layers.scatter(Event::Specular);
            let beta = branch.beta * sample.weight;
            if beta.max_value() < LEAST_THROUGHPUT {
                continue;
            }
            let next = Branch {
                ray: surface.spawn_ray(sample.wi),
                beta,
                depth: branch.depth + 1,
                medium: tracer.scene.medium_towards(surface, sample.wi, branch.medium),
                from: Some(surface.hit.geometry),
            };
            radiance += self.trace(tracer, next, path);
        }
        path.layers.return_to(&position);
        radiance
    }

    /// Light of all lights by one shadow ray each, or by one for all where they are too many.
    fn direct_light(
        &self,
        tracer: &Tracer<'_>,
        surface: &Surface,
        bsdf: &Bsdf,
        branch: &Branch,
        path: &mut CameraPath<'_, '_>,
    ) -> Sampled {
        let scene = tracer.scene;
        if scene.lights.len() > MOST_LIGHTS {
            let candidate = choose_light(scene, surface, bsdf, 0.0, path.sampler, path.lambda);
            return candidate.map_or(Sampled::ZERO, |candidate| {
                let le = candidate.weighted * candidate.weight;
                self.reflect(tracer, surface, bsdf, branch, (&candidate.light.sample, le), path)
            });
        }
        let mut radiance = Sampled::ZERO;
        for (index, light) in scene.lights.iter().enumerate() {
            let id = LightId(index as u32);
            let is_linked =
                scene.controls.as_ref().is_none_or(|controls| controls.reaches(id, surface.hit.geometry));
            let u = match self.settings.place {
                LightPlace::Random => path.sampler.next_2d(),
                LightPlace::Middle => Point2::new(0.5, 0.5),
            };
            let sample =
                light.sample_li(&scene.light_context_at(surface.time), &surface.reference(), u, path.lambda);
            if let Some(sample) = sample.filter(|sample| is_linked && sample.pdf_w > 0.0) {
                let le = sample.le / sample.pdf_w;
                radiance += self.reflect(tracer, surface, bsdf, branch, (&sample, le), path);
            }
        }
        radiance
    }

    /// Light of one sample of a light, with its radiance per density, that the surface sends on.
    fn reflect(
        &self,
        tracer: &Tracer<'_>,
        surface: &Surface,
        bsdf: &Bsdf,
        branch: &Branch,
        (light, le): (&LightSample, Sampled),
        path: &mut CameraPath<'_, '_>,
    ) -> Sampled {
        let mode = TransportMode::Radiance;
        let through =
            |lobes| branch.beta * le * bsdf.eval(surface.wo, light.wi, mode, lobes) * bsdf.abs_cos(light.wi);
        let unoccluded = through(Lobes::ALL);
        if unoccluded.is_black() {
            return Sampled::ZERO;
        }
        let scene = tracer.scene;
        let medium = scene.medium_towards(surface, light.wi, branch.medium);
        let dimmed = medium.map_or(Sampled::ONE, |m| scene.transmittance_of(m, light.distance, path.lambda));
        let visible = dimmed * visibility(tracer, surface, light);
        if !path.layers.is_idle() {
            let glossy = Event::glossy(bsdf.glossy_roughness(), self.settings.sharp_alpha);
            path.layers.emit_through(glossy, through(Lobes::GLOSSY) * visible);
            path.layers.emit_through(Event::Diffuse, through(Lobes::DIFFUSE) * visible);
        }
        unoccluded * visible
    }
}

/// Notes light that the path runs into, and returns it.
fn emit(light: Sampled, path: &mut CameraPath<'_, '_>) -> Sampled {
    if !path.layers.is_idle() {
        path.layers.emit(light);
    }
    light
}

/// Radiance from where there is no surface.
fn surroundings(scene: &Scene, branch: &Branch, path: &CameraPath<'_, '_>) -> Sampled {
    let (context, ray) = (scene.light_context(), &branch.ray);
    let seen = scene.infinite_lights.iter().filter(|id| branch.admits(scene, **id));
    seen.fold(Sampled::ZERO, |sum, id| {
        sum + scene.light(*id).le_infinite(&context, ray.origin, ray.direction, path.lambda)
    })
}
