//! The random walk of a camera path.

use etendue_geometry::Reference;
use etendue_math::Ray;
use etendue_scene::Scene;
use etendue_scene::bsdf::{Bsdf, BsdfSample, Lobes, TransportMode};
use etendue_scene::controls::Controls;
use etendue_scene::light::LightId;
use etendue_scene::medium::MediumId;
use etendue_scene::scene::Surface;
use etendue_spectrum::Sampled;

use super::Artist;
use super::{LightStrategy, PathSettings};
use crate::lpe::{Event, LayerRecorder};
use crate::path::camera_pass::{CameraPath, Tracer};
use crate::path::direct::{Candidate, choose_light, visibility};
use crate::path::features::describe;
use crate::path::mis::power_heuristic;
use crate::path::roulette::survival_probability;

/// The vertex that the path last scattered at, for the density with which it might have sampled a light instead.
#[derive(Clone, Copy, Debug)]
pub(crate) struct LastScattering {
    reference: Reference,
    /// Density of the directions taken for each light sample, per steradian; `None` if no light sample could have found them.
    pdf_w: Option<f32>,
}

/// A random walk from the camera.
#[derive(Clone, Copy)]
pub(crate) struct Walk<'s> {
    pub(crate) settings: &'s PathSettings,
    ray: Ray,
    /// Throughput: product of `f |cos| / pdf`, in radiance's measure.
    pub(crate) beta: Sampled,
    /// What roulette multiplies the throughput by: the product of squared relative indices, so that it sees flux and not
    /// radiance, and the number of walks among which the throughput was divided.
    pub(crate) roulette_scale: f32,
    pub(crate) has_split: bool,
    /// Scattering events so far.
    pub(crate) depth: u32,
    last: Option<LastScattering>,
    pub(crate) has_scattered_widely: bool,
    /// What the ray travels through.
    pub(crate) medium: Option<MediumId>,
    /// What is switched off on the way; of no use where nothing is.
    artist: Artist,
    pub(crate) radiance: Sampled,
}

impl<'s> Walk<'s> {
    pub(crate) fn new(settings: &'s PathSettings, path: &CameraPath<'_, '_>) -> Self {
        Self {
            settings,
            ray: path.ray,
            beta: Sampled::ONE,
            roulette_scale: 1.0,
            has_split: false,
            depth: 0,
            last: None,
            has_scattered_widely: false,
            medium: path.medium,
            artist: Artist::default(),
            radiance: Sampled::ZERO,
        }
    }

    /// The same walk by other settings, which has brought nothing yet.
    pub(crate) fn with_settings<'a>(self, settings: &'a PathSettings) -> Walk<'a>
    where
        's: 'a,
    {
        Walk { settings, radiance: Sampled::ZERO, ..self }
    }

    /// Follows the path to its end, and returns what it brings.
    pub(crate) fn follow(mut self, tracer: &Tracer<'_>, path: &mut CameraPath<'_, '_>) -> Sampled {
        let visit = |walk: &mut Self, surface: &Surface, bsdf: &Bsdf, path: &mut CameraPath<'_, '_>| {
            walk.visit(tracer, surface, bsdf, path)
        };
        while self.arrive_and(tracer, path, visit) == Some(true) {}
        self.radiance
    }

    /// Adds the direct light of a surface and leaves it; `false` if the radiance is complete.
    #[inline]
    pub(crate) fn visit(
        &mut self,
        tracer: &Tracer<'_>,
        surface: &Surface,
        bsdf: &Bsdf,
        path: &mut CameraPath<'_, '_>,
    ) -> bool {
        if self.splits() && !self.has_split && bsdf.lobes().has_non_specular() {
            self.radiance = self.split(tracer, surface, bsdf, path);
            return false;
        }
        path.sampler.start_vertex();
        self.add_direct_light(tracer, surface, bsdf, 1.0, path);
        if self.settings.branches > 1 {
            self.radiance = self.branch(tracer, surface, bsdf, path);
            return false;
        }
        self.goes_on(tracer.scene, surface, bsdf, 1.0, path)
    }

    /// [Follows](Self::follow) the path if it goes on; what it brings.
    pub(crate) fn follow_if(
        self,
        goes_on: bool,
        tracer: &Tracer<'_>,
        path: &mut CameraPath<'_, '_>,
    ) -> Sampled {
        if goes_on { self.follow(tracer, path) } else { self.radiance }
    }

    /// Goes to the next surface that the path may scatter at, adding the emission on the way and of the surface itself;
    /// `None` if the path ends before.
    #[inline(always)]
    pub(crate) fn arrive(
        &mut self,
        tracer: &Tracer<'_>,
        path: &mut CameraPath<'_, '_>,
    ) -> Option<(Surface, Bsdf)> {
        self.arrive_and(tracer, path, |_, surface, bsdf, _| (*surface, *bsdf))
    }

    /// [Arrives](Self::arrive), and does something with the surface where it lies: it is large to hand on.
    #[inline(always)]
    fn arrive_and<T>(
        &mut self,
        tracer: &Tracer<'_>,
        path: &mut CameraPath<'_, '_>,
        work: impl FnOnce(&mut Self, &Surface, &Bsdf, &mut CameraPath<'_, '_>) -> T,
    ) -> Option<T> {
        let scene = tracer.scene;
        loop {
            let hit = tracer.intersect(&self.ray);
            if let Some(medium) = self.medium {
                let distance = hit.as_ref().map_or(f32::INFINITY, |hit| hit.t);
                self.beta *= scene.transmittance_of(medium, distance, path.lambda);
            }
            let Some(hit) = hit else {
                self.add_surroundings(scene, path);
                return None;
            };
            // All that may be left to find is light that this very surface sends.
            let is_last = self.depth > 0 && self.depth == self.settings.max_depth && !scene.may_pass(&hit);
            if is_last && !scene.emits(&hit) {
                return None;
            }
            let surface = scene.surface(&self.ray, &hit);
            self.add_emission(scene, &surface, path);
            if self.depth == 0 {
                self.add(scene.ambient(&surface, path.lambda) * self.beta, path.layers);
            }
            if is_last {
                return None;
            }
            let mut bsdf = scene.bsdf(&surface, path.lambda);
            let Some(bsdf) = &mut bsdf else {
                // Light passes as if the surface were not there.
                self.ray = surface.spawn_ray(self.ray.direction);
                continue;
            };
            if self.depth == 0
                && let Some(features) = &mut path.features
            {
                **features = describe(scene, &surface, bsdf, path.lambda);
            }
            if self.depth == self.settings.max_depth {
                return None;
            }
            if self.settings.regularize && self.has_scattered_widely {
                bsdf.regularize();
            }
            return Some(work(self, &surface, bsdf, path));
        }
    }

    #[inline]
    const fn splits(&self) -> bool {
        self.settings.splitting > 1 || self.settings.light_samples > 1
    }

    /// Several walks from a surface, and as many light samples as are wanted: they have the way from the camera in common,
    /// and the whole of each kind is spread as evenly as so many samples. Roulette takes no notice of the shares.
    fn split(
        mut self,
        tracer: &Tracer<'_>,
        surface: &Surface,
        bsdf: &Bsdf,
        path: &mut CameraPath<'_, '_>,
    ) -> Sampled {
        let n = self.settings.splitting;
        let walks_per_light_sample = n as f32 / self.settings.light_samples as f32;
        let lit = self.light_samples(tracer, surface, bsdf, walks_per_light_sample, path);
        self.has_split = true;
        self.radiance = Sampled::ZERO;
        let scattered = self.share(n, path, |part, mut walk, path| {
            path.with_sampler_of_part(&tracer.scene.sampler, part, n, |path| {
                walk.roulette_scale *= n as f32;
                path.sampler.start_vertex();
                path.sampler.skip_light();
                walk.finish(tracer, surface, bsdf, walks_per_light_sample, path)
            })
        });
        lit + scattered
    }

    /// What the path has brought so far, and the mean of as many samples of the direct light as are wanted.
    pub(crate) fn light_samples(
        &self,
        tracer: &Tracer<'_>,
        surface: &Surface,
        bsdf: &Bsdf,
        walks_per_light_sample: f32,
        path: &mut CameraPath<'_, '_>,
    ) -> Sampled {
        let n = self.settings.light_samples;
        self.share(n, path, |part, mut walk, path| {
            path.with_sampler_of_part(&tracer.scene.sampler, part, n, |path| {
                path.sampler.start_vertex();
                walk.add_direct_light(tracer, surface, bsdf, walks_per_light_sample, path);
                walk.radiance
            })
        })
    }

    /// Goes on in several directions. The rays of a pixel then grow as the power of the depth (SPEC PT-2), most of them
    /// where they matter least: for comparison.
    fn branch(
        self,
        tracer: &Tracer<'_>,
        surface: &Surface,
        bsdf: &Bsdf,
        path: &mut CameraPath<'_, '_>,
    ) -> Sampled {
        self.share(self.settings.branches, path, |_, walk, path| {
            walk.finish(tracer, surface, bsdf, 1.0, path)
        })
    }

    /// What this walk has brought so far and what `n` others bring, which start with its state and a share of its
    /// throughput. `follow` gets the number of each.
    fn share(
        self,
        n: u32,
        path: &mut CameraPath<'_, '_>,
        follow: impl Fn(u32, Self, &mut CameraPath<'_, '_>) -> Sampled,
    ) -> Sampled {
        let position = path.layers.position();
        let mut radiance = self.radiance;
        for part in 0..n {
            path.layers.return_to(&position);
            let walk = Walk { beta: self.beta / n as f32, radiance: Sampled::ZERO, ..self };
            radiance += follow(part, walk, path);
        }
        radiance
    }

    /// The radiance of a walk that stands at a surface whose direct light it has.
    pub(crate) fn finish(
        mut self,
        tracer: &Tracer<'_>,
        surface: &Surface,
        bsdf: &Bsdf,
        walks_per_light_sample: f32,
        path: &mut CameraPath<'_, '_>,
    ) -> Sampled {
        let goes_on = self.goes_on(tracer.scene, surface, bsdf, walks_per_light_sample, path);
        self.follow_if(goes_on, tracer, path)
    }

    /// Chooses where the path goes from a surface; `false` if it ends there.
    #[inline(always)]
    fn goes_on(
        &mut self,
        scene: &Scene,
        surface: &Surface,
        bsdf: &Bsdf,
        walks_per_light_sample: f32,
        path: &mut CameraPath<'_, '_>,
    ) -> bool {
        let (u_component, u) = (path.sampler.next_1d(), path.sampler.next_2d());
        let sample = bsdf.sample(surface.wo, u_component, u, TransportMode::Radiance, Lobes::ALL);
        let Some(sample) = sample else { return false };
        self.leave(scene, surface, &sample, walks_per_light_sample, path.layers);
        self.survives_roulette(path)
    }

    /// Weight of light that scattering found, against the same light sampled from the last vertex.
    fn scattering_weight(&self, scene: &Scene, light: LightId, pdf_light: impl Fn(&Reference) -> f32) -> f32 {
        let Some(LastScattering { reference, pdf_w: Some(pdf_scatter) }) = &self.last else {
            return 1.0;
        };
        match self.settings.lights {
            LightStrategy::Scattering => 1.0,
            LightStrategy::Lights => 0.0,
            LightStrategy::Both => {
                let pdf_light = scene.light_sampler.pmf(reference, light) * pdf_light(reference);
                power_heuristic(*pdf_scatter, pdf_light)
            }
        }
    }

    fn add_surroundings(&mut self, scene: &Scene, path: &mut CameraPath<'_, '_>) {
        let context = scene.light_context();
        for &id in &scene.infinite_lights {
            if self.is_switched_off(scene, id) {
                continue;
            }
            let light = scene.light(id);
            let le = light.le_infinite(&context, self.ray.origin, self.ray.direction, path.lambda);
            if le.is_black() {
                continue;
            }
            let wi = self.ray.direction;
            let weight = self.scattering_weight(scene, id, |reference| light.pdf_li(&context, reference, wi));
            self.add(self.beta * le * weight, path.layers);
        }
    }

    fn add_emission(&mut self, scene: &Scene, surface: &Surface, path: &mut CameraPath<'_, '_>) {
        let Some(id) = surface.light.filter(|id| !self.is_switched_off(scene, *id)) else { return };
        let le = scene.emitted(surface, path.lambda);
        if le.is_black() {
            return;
        }
        let context = scene.light_context_at(surface.time);
        let light = scene.light(id);
        let weight = self.scattering_weight(scene, id, |reference| {
            light.pdf_li_at(&context, reference, self.ray.direction, surface.point.p, surface.point.ng)
        });
        self.add(self.beta * le * weight, path.layers);
    }

    /// True if light that the path runs into is switched off.
    #[inline]
    fn is_switched_off(&self, scene: &Scene, light: LightId) -> bool {
        scene.controls.as_ref().is_some_and(|controls| !self.artist.admits(controls, light))
    }

    fn add(&mut self, contribution: Sampled, layers: &mut LayerRecorder<'_>) {
        self.radiance += contribution;
        if !layers.is_idle() {
            layers.emit(contribution);
        }
    }

    /// Does something with a light that the surface sees, weighted against so many directions of scattering, and with what is
    /// left of its radiance on the way to the camera.
    #[inline(always)]
    pub(crate) fn direct_light<T>(
        &self,
        tracer: &Tracer<'_>,
        surface: &Surface,
        bsdf: &Bsdf,
        walks_per_light_sample: f32,
        path: &mut CameraPath<'_, '_>,
        work: impl FnOnce(&Candidate, Sampled, &mut CameraPath<'_, '_>) -> T,
    ) -> Option<T> {
        if self.settings.lights == LightStrategy::Scattering || !bsdf.lobes().has_non_specular() {
            return None;
        }
        let weighs = if self.settings.lights == LightStrategy::Both { walks_per_light_sample } else { 0.0 };
        let chosen = choose_light(tracer.scene, surface, bsdf, weighs, path.sampler, path.lambda);
        let candidate = chosen.as_ref()?;
        let light = &candidate.light.sample;
        let visible = visibility(tracer, surface, light) * candidate.weight;
        if visible == 0.0 {
            return None;
        }
        let mut through = self.beta * visible;
        if let Some(medium) = tracer.scene.medium_towards(surface, light.wi, self.medium) {
            through *= tracer.scene.transmittance_of(medium, light.distance, path.lambda);
        }
        Some(work(candidate, through, path))
    }

    /// Light that reaches the surface straight from one light.
    #[inline(always)]
    pub(crate) fn add_direct_light(
        &mut self,
        tracer: &Tracer<'_>,
        surface: &Surface,
        bsdf: &Bsdf,
        walks_per_light_sample: f32,
        path: &mut CameraPath<'_, '_>,
    ) {
        let scattered = self.direct_light(
            tracer,
            surface,
            bsdf,
            walks_per_light_sample,
            path,
            |candidate, through, path| {
                let admitted = self.admitted(tracer.scene, surface, bsdf);
                if admitted == Lobes::ALL && path.layers.is_idle() {
                    return through * candidate.unoccluded;
                }
                self.scatter_by_lobes(surface, bsdf, admitted, candidate, through, path.layers)
            },
        );
        if let Some(scattered) = scattered {
            self.radiance += scattered;
        }
    }

    /// The lobes through which the path may see light that reaches the surface: all, but where artists have switched something
    /// off.
    #[inline]
    pub(crate) fn admitted(&self, scene: &Scene, surface: &Surface, bsdf: &Bsdf) -> Lobes {
        scene.controls.as_ref().map_or(Lobes::ALL, |controls| {
            self.artist.lobes(controls, surface.hit.geometry, bsdf, self.settings.sharp_alpha)
        })
    }

    /// What the admitted lobes make of light that reaches the surface; shows each of them to the layers.
    #[cold]
    pub(crate) fn scatter_by_lobes(
        &self,
        surface: &Surface,
        bsdf: &Bsdf,
        admitted: Lobes,
        Candidate { light, weighted, unoccluded, .. }: &Candidate,
        through: Sampled,
        layers: &mut LayerRecorder<'_>,
    ) -> Sampled {
        let through_lobes = |lobes: Lobes| {
            let wi = light.sample.wi;
            let f = bsdf.eval(surface.wo, wi, TransportMode::Radiance, lobes & admitted) * bsdf.abs_cos(wi);
            through * (f * *weighted)
        };
        if !layers.is_idle() {
            let (glossy, diffuse) = (through_lobes(Lobes::GLOSSY), through_lobes(Lobes::DIFFUSE));
            layers.emit_through(Event::glossy(bsdf.glossy_roughness(), self.settings.sharp_alpha), glossy);
            layers.emit_through(Event::Diffuse, diffuse);
        }
        if admitted == Lobes::ALL { through * *unoccluded } else { through_lobes(Lobes::ALL) }
    }

    /// Leaves a surface in a sampled direction.
    #[inline]
    pub(crate) fn leave(
        &mut self,
        scene: &Scene,
        surface: &Surface,
        sample: &BsdfSample,
        walks_per_light_sample: f32,
        layers: &mut LayerRecorder<'_>,
    ) {
        self.medium = scene.medium_towards(surface, sample.wi, self.medium);
        self.beta *= sample.weight;
        self.roulette_scale *= sample.eta * sample.eta;
        self.depth += 1;
        self.ray = surface.spawn_ray(sample.wi);
        let pdf_w = (!sample.is_specular()).then_some(sample.pdf_w * walks_per_light_sample);
        self.has_scattered_widely |= pdf_w.is_some();
        self.last = Some(LastScattering { reference: surface.reference(), pdf_w });
        if let Some(controls) = &scene.controls {
            self.obey(controls, surface, sample);
        }
        if !layers.is_idle() {
            layers.scatter(Event::of(sample, self.settings.sharp_alpha));
        }
    }

    /// Ends the path where all that it may find is switched off: roulette does, for want of throughput.
    #[cold]
    fn obey(&mut self, controls: &Controls, surface: &Surface, sample: &BsdfSample) {
        let event = Event::of(sample, self.settings.sharp_alpha);
        if !self.artist.scatter(controls, surface.hit.geometry, event) {
            self.beta = Sampled::ZERO;
        }
    }

    #[inline]
    pub(crate) fn survives_roulette(&mut self, path: &mut CameraPath<'_, '_>) -> bool {
        if self.depth <= self.settings.roulette_depth {
            return true;
        }
        let brightness = self.beta.max_value() * self.roulette_scale;
        let probability = survival_probability(brightness, self.settings.roulette_threshold);
        if probability == 1.0 {
            return true;
        }
        if path.sampler.next_1d() >= probability {
            return false;
        }
        self.beta /= probability;
        true
    }
}
