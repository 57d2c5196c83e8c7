//! The walk from the camera through the scene, to where photons tell the rest (Jensen 2001, chapters 8 and 9; SPEC PM-3 to PM-10).
//!
//! Scattering is wide (diffuse, and glossy but for sharp lobes) or sharp, and the letters of path expressions say the same. With
//! `D` and `S` for these, what a wide lobe sends on is
//!
//! ```text
//! L = direct (D, by shadow rays and by running into lights)
//!   + caustic (LS+D, from the caustic map)
//!   + indirect (from other wide lobes, by rays that gather)
//! ```
//!
//! A ray that gathers meets surfaces whose light is asked of the global map, `L(S|D)*D`, unless it is short: in corners the map
//! is blurred over both walls, so that there the surface is treated as one that is seen directly. Sharp lobes are followed on
//! their own. After a wide lobe and sharp ones, lamps do not count: that light is in the caustic map.

use std::f32::consts::FRAC_1_PI;

use etendue_geometry::Reference;
use etendue_math::Ray;
use etendue_scene::Scene;
use etendue_scene::bsdf::{Bsdf, BsdfKind, BsdfSample, Lobes, TransportMode};
use etendue_scene::light::LightId;
use etendue_scene::medium::MediumId;
use etendue_scene::scene::Surface;
use etendue_spectrum::Sampled;

use super::lit_map::{LitMap, wide_lobes};
use super::precomputed::Precomputed;
use crate::lpe::Event;
use crate::path::camera_pass::{CameraPath, Tracer};
use crate::path::direct::{choose_light, visibility};
use crate::path::features::describe;
use crate::path::mis::power_heuristic;
use crate::path::roulette::survival_probability;
use crate::path_tracing::Artist;
use crate::photon::estimate::EstimateScratch;

/// Parts of the image, in the order of [`TERM_NAMES`] (SPEC EXP-11).
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Term {
    /// `LD?E`.
    Direct,
    /// `L(S|D)*SE`.
    Specular,
    /// `LS+DE`.
    Caustic,
    /// `L(S|D)*DS*DE`.
    Indirect,
}

/// Names of the layers of these parts.
pub(crate) const TERM_NAMES: &[&str] = &["direct", "specular", "caustic", "indirect"];

/// What a camera walk asks.
#[derive(Clone, Copy, Debug)]
pub(crate) struct EyeMethod<'m> {
    /// All light on wide lobes, or all but the direct.
    pub(crate) global: &'m LitMap,
    /// `LS+D`; `None` where surfaces are not seen accurately.
    pub(crate) caustic: Option<&'m LitMap>,
    /// Irradiance by the global map.
    pub(crate) global_irradiance: Option<&'m Precomputed>,
    /// Irradiance by the caustic map.
    pub(crate) caustic_irradiance: Option<&'m Precomputed>,
    /// What is done at surfaces that are seen directly.
    pub(crate) seen: Seen,
    /// Rays that gather are followed accurately at surfaces nearer than this, in metres.
    pub(crate) accurate_distance: f32,
    /// A surface that is seen by sharp scattering is treated approximately where its share of the pixel's light is less.
    pub(crate) accurate_share: f32,
    /// Rays that gather from each surface that is seen directly.
    pub(crate) n_gather: u32,
    /// Most scattering events of the walk.
    pub(crate) max_depth: u32,
    /// Glossy lobes narrower than this are sharp.
    pub(crate) sharp_alpha: f32,
}

/// What is done at surfaces that are seen directly, or by sharp scattering.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Seen {
    /// The four terms.
    Accurately,
    /// The map is asked for all light.
    ByMap,
    /// The map is asked for all but direct light, for which there are shadow rays.
    ByMapAndShadowRays,
    /// The map is asked, and no lamp is seen.
    ByMapAlone,
}

/// Throughput below which a walk plays roulette, as in path tracing.
const ROULETTE_THRESHOLD: f32 = 0.5;

/// The vertex that the walk last scattered at, and the density of the direction; `None` if no shadow ray could have found it.
#[derive(Clone, Copy, Debug)]
struct LastScattering {
    reference: Reference,
    pdf_w: Option<f32>,
}

/// A walk from the camera.
#[derive(Clone, Copy)]
struct EyeWalk<'m> {
    method: &'m EyeMethod<'m>,
    ray: Ray,
    beta: Sampled,
    /// Bound of the share of the pixel that what is found here has: products of reflectances, whatever was chosen at random.
    share: f32,
    /// Product of squared relative indices, and of the number of rays that gather.
    roulette_scale: f32,
    /// Rays that leave the surface where the walk is for each of its shadow rays.
    walks_per_light_sample: f32,
    depth: u32,
    medium: Option<MediumId>,
    last: Option<LastScattering>,
    /// Wide events so far.
    n_wide: u32,
    /// Sharp events since the last of them, or since the camera.
    n_sharp: u32,
    /// Length of the way since the last wide event, in metres.
    distance: f32,
    /// The part of the image that light belongs to which is found from here on, but for lamps.
    term: Term,
    /// Of no use where nothing is switched off.
    artist: Artist,
    radiance: Sampled,
}

/// Follows a path from the camera, and returns its radiance.
pub(crate) fn follow(
    method: &EyeMethod<'_>,
    tracer: &Tracer<'_>,
    path: &mut CameraPath<'_, '_>,
    scratch: &mut EstimateScratch,
) -> Sampled {
    let walk = EyeWalk {
        method,
        ray: path.ray,
        beta: Sampled::ONE,
        share: 1.0,
        roulette_scale: 1.0,
        walks_per_light_sample: 1.0,
        depth: 0,
        medium: path.medium,
        last: None,
        n_wide: 0,
        n_sharp: 0,
        distance: 0.0,
        term: Term::Direct,
        artist: Artist::default(),
        radiance: Sampled::ZERO,
    };
    walk.follow(tracer, path, scratch)
}

impl EyeWalk<'_> {
    fn follow(
        mut self,
        tracer: &Tracer<'_>,
        path: &mut CameraPath<'_, '_>,
        scratch: &mut EstimateScratch,
    ) -> Sampled {
        let method = self.method;
        while let Some((surface, bsdf)) = self.arrive(tracer, path) {
            path.sampler.start_vertex();
            let wide = wide_lobes(&bsdf, method.sharp_alpha);
            let is_worth_it = if self.n_wide == 0 {
                self.share >= method.accurate_share
            } else {
                self.distance < method.accurate_distance
            };
            let is_accurate = method.seen == Seen::Accurately && is_worth_it;
            let gathers = is_accurate && self.n_wide == 0 && method.n_gather > 1 && !wide.is_empty();
            self.walks_per_light_sample = if gathers { method.n_gather as f32 } else { 1.0 };
            let admitted = self.admitted_lobes(tracer.scene, &surface, &bsdf);
            let goes_on = if is_accurate {
                let lit = self.lit_lobes(wide) & admitted;
                self.add_direct_light(tracer, &surface, &bsdf, (lit, Lobes::ALL), path);
                if let Some(map) = method.caustic {
                    let caustic = (map, method.caustic_irradiance, Term::Caustic);
                    self.add_from_map(caustic, &surface, (&bsdf, wide & admitted), path, scratch);
                }
                if gathers {
                    return self.gather(tracer, &surface, &bsdf, path, scratch);
                }
                self.scatter(tracer.scene, &surface, &bsdf, Lobes::ALL, path)
            } else {
                self.add_direct_light_beside_map(tracer, &surface, &bsdf, wide, path);
                let global = (method.global, method.global_irradiance, Term::Indirect);
                self.add_from_map(global, &surface, (&bsdf, wide & admitted), path, scratch);
                self.scatter(tracer.scene, &surface, &bsdf, bsdf.lobes() & !wide, path)
            };
            if !goes_on {
                break;
            }
        }
        self.radiance
    }

    /// Goes to the next surface that scatters, adding the light of lamps on the way; `None` if the walk ends before.
    fn arrive(&mut self, tracer: &Tracer<'_>, path: &mut CameraPath<'_, '_>) -> Option<(Surface, Bsdf)> {
        let scene = tracer.scene;
        loop {
            let hit = tracer.intersect(&self.ray);
            let distance = hit.as_ref().map_or(f32::INFINITY, |hit| hit.t);
            if let Some(medium) = self.medium {
                self.beta *= scene.transmittance_of(medium, distance, path.lambda);
            }
            self.distance += distance;
            let Some(hit) = hit else {
                self.add_surroundings(scene, path);
                return None;
            };
            let surface = scene.surface(&self.ray, &hit);
            self.add_emission(scene, &surface, path);
            if self.depth == 0 {
                self.add(Term::Direct, scene.ambient(&surface, path.lambda) * self.beta, path);
            }
            let Some(bsdf) = scene.bsdf(&surface, path.lambda) else {
                self.ray = surface.spawn_ray(self.ray.direction);
                continue;
            };
            if self.depth == 0
                && let Some(features) = &mut path.features
            {
                **features = describe(scene, &surface, &bsdf, path.lambda);
            }
            return (self.depth < self.method.max_depth).then_some((surface, bsdf));
        }
    }

    /// The lobes whose direct light is added where a surface is treated accurately: after a wide event sharp ones make caustics.
    fn lit_lobes(&self, wide: Lobes) -> Lobes {
        if self.n_wide == 0 { Lobes::NON_SPECULAR } else { wide }
    }

    /// The lobes through which a surface may show light that has come to it, where artists have switched something off.
    fn admitted_lobes(&self, scene: &Scene, surface: &Surface, bsdf: &Bsdf) -> Lobes {
        scene.controls.as_ref().map_or(Lobes::ALL, |controls| {
            self.artist.lobes(controls, surface.hit.geometry, bsdf, self.method.sharp_alpha)
        })
    }

    /// Several walks from a surface that is seen directly and whose own light has been added.
    fn gather(
        mut self,
        tracer: &Tracer<'_>,
        surface: &Surface,
        bsdf: &Bsdf,
        path: &mut CameraPath<'_, '_>,
        scratch: &mut EstimateScratch,
    ) -> Sampled {
        let n = self.method.n_gather;
        let mut radiance = std::mem::replace(&mut self.radiance, Sampled::ZERO);
        self.beta /= n as f32;
        self.roulette_scale *= n as f32;
        let position = path.layers.position();
        for part in 0..n {
            path.layers.return_to(&position);
            radiance += path.with_sampler_of_part(&tracer.scene.sampler, part, n, |path| {
                let mut walk = self;
                path.sampler.start_vertex();
                path.sampler.skip_light();
                if walk.scatter(tracer.scene, surface, bsdf, Lobes::ALL, path) {
                    walk.follow(tracer, path, scratch)
                } else {
                    walk.radiance
                }
            });
        }
        radiance
    }

    /// Leaves a surface by some of its lobes; `false` if the walk ends.
    fn scatter(
        &mut self,
        scene: &Scene,
        surface: &Surface,
        bsdf: &Bsdf,
        lobes: Lobes,
        path: &mut CameraPath<'_, '_>,
    ) -> bool {
        if lobes.is_empty() {
            return false;
        }
        let (u_component, u) = (path.sampler.next_1d(), path.sampler.next_2d());
        let Some(sample) = bsdf.sample(surface.wo, u_component, u, TransportMode::Radiance, lobes) else {
            return false;
        };
        if !self.leave(scene, (surface, bsdf), &sample, path) {
            return false;
        }
        let brightness = self.beta.max_value() * self.roulette_scale;
        let probability = survival_probability(brightness, ROULETTE_THRESHOLD);
        if self.depth < 2 || probability == 1.0 {
            return true;
        }
        self.beta /= probability;
        path.sampler.next_1d() < probability
    }

    /// Sets out in a direction; `false` if artists have switched off all that is there.
    fn leave(
        &mut self,
        scene: &Scene,
        (surface, bsdf): (&Surface, &Bsdf),
        sample: &BsdfSample,
        path: &mut CameraPath<'_, '_>,
    ) -> bool {
        let event = Event::at(bsdf, sample, self.method.sharp_alpha);
        if let Some(controls) = &scene.controls
            && !self.artist.scatter(controls, surface.hit.geometry, event)
        {
            return false;
        }
        let is_wide = matches!(event, Event::Diffuse | Event::WideGlossy);
        if self.n_wide == 0 && self.n_sharp == 0 {
            self.term = if is_wide { Term::Indirect } else { Term::Specular };
        }
        if is_wide {
            (self.n_wide, self.n_sharp, self.distance) = (self.n_wide + 1, 0, 0.0);
        } else {
            self.n_sharp += 1;
        }
        self.medium = scene.medium_towards(surface, sample.wi, self.medium);
        self.beta *= sample.weight;
        self.share *= sample.weight.max_value() * if sample.is_specular() { sample.pmf } else { 1.0 };
        self.roulette_scale *= sample.eta * sample.eta;
        self.depth += 1;
        self.ray = surface.spawn_ray(sample.wi);
        let pdf_w = (!sample.is_specular()).then_some(sample.pdf_w * self.walks_per_light_sample);
        self.last = Some(LastScattering { reference: surface.reference(), pdf_w });
        if !path.layers.is_idle() {
            path.layers.scatter(event);
        }
        true
    }

    fn add_surroundings(&mut self, scene: &Scene, path: &mut CameraPath<'_, '_>) {
        if !self.sees_lamps() {
            return;
        }
        let context = scene.light_context();
        let wi = self.ray.direction;
        for &id in &scene.infinite_lights {
            if self.is_switched_off(scene, id) {
                continue;
            }
            let light = scene.light(id);
            let le = light.le_infinite(&context, self.ray.origin, wi, path.lambda);
            if !le.is_black() {
                let weight = self.weight_of_hit(scene, id, |reference| light.pdf_li(&context, reference, wi));
                self.add(self.term_of_lamp(), self.beta * le * weight, path);
            }
        }
    }

    fn add_emission(&mut self, scene: &Scene, surface: &Surface, path: &mut CameraPath<'_, '_>) {
        let Some(id) = surface.light.filter(|id| self.sees_lamps() && !self.is_switched_off(scene, *id))
        else {
            return;
        };
        let le = scene.emitted(surface, path.lambda);
        if le.is_black() {
            return;
        }
        let (context, light, point) = (scene.light_context_at(surface.time), scene.light(id), &surface.point);
        let weight = self.weight_of_hit(scene, id, |reference| {
            light.pdf_li_at(&context, reference, self.ray.direction, point.p, point.ng)
        });
        self.add(self.term_of_lamp(), self.beta * le * weight, path);
    }

    /// False where the light of lamps is in a map.
    fn sees_lamps(&self) -> bool {
        self.method.seen != Seen::ByMapAlone && (self.n_wide == 0 || self.n_sharp == 0)
    }

    /// True if artists keep a light from what the walk left last.
    #[inline]
    fn is_switched_off(&self, scene: &Scene, light: LightId) -> bool {
        scene.controls.as_ref().is_some_and(|controls| !self.artist.admits(controls, light))
    }

    fn term_of_lamp(&self) -> Term {
        let is_direct = self.depth == 0 || self.depth == 1 && self.n_wide == 1;
        if is_direct { Term::Direct } else { self.term }
    }

    /// Weight of a lamp that the walk ran into against the same light by a shadow ray from the last vertex.
    fn weight_of_hit(&self, scene: &Scene, id: LightId, pdf_light: impl Fn(&Reference) -> f32) -> f32 {
        let Some(LastScattering { reference, pdf_w: Some(pdf_scatter) }) = &self.last else { return 1.0 };
        power_heuristic(*pdf_scatter, scene.light_sampler.pmf(reference, id) * pdf_light(reference))
    }

    fn add(&mut self, term: Term, contribution: Sampled, path: &mut CameraPath<'_, '_>) {
        self.radiance += contribution;
        path.layers.add_own(term as usize, contribution);
        if !path.layers.is_idle() {
            path.layers.emit(contribution);
        }
    }

    /// Light that reaches `lit` lobes of a surface straight from one light, weighted against scattering by the `scattering` lobes.
    fn add_direct_light(
        &mut self,
        tracer: &Tracer<'_>,
        surface: &Surface,
        bsdf: &Bsdf,
        (lit, scattering): (Lobes, Lobes),
        path: &mut CameraPath<'_, '_>,
    ) {
        let scene = tracer.scene;
        if !bsdf.lobes().intersects(lit) {
            return;
        }
        let Some(candidate) = choose_light(scene, surface, bsdf, 0.0, path.sampler, path.lambda) else {
            return;
        };
        let light = &candidate.light.sample;
        let visible = visibility(tracer, surface, light) * candidate.weight;
        if visible == 0.0 {
            return;
        }
        let pdf_w = bsdf.pdf(surface.wo, light.wi, TransportMode::Radiance, scattering);
        let mut through = self.beta * (visible * bsdf.abs_cos(light.wi));
        if let Some(medium) = scene.medium_towards(surface, light.wi, self.medium) {
            through *= scene.transmittance_of(medium, light.distance, path.lambda);
        }
        let n_walks = self.walks_per_light_sample;
        let by = |lobes: Lobes| {
            let f = bsdf.eval(surface.wo, light.wi, TransportMode::Radiance, lobes & lit);
            // The light of lobes that no ray follows is found in no other way.
            let pdf_w = if bsdf.lobes().intersects(lobes & scattering) { pdf_w } else { 0.0 };
            through * candidate.light.weighted(pdf_w * n_walks) * f
        };
        if lit.intersects(Lobes::GLOSSY) && bsdf.lobes().is_glossy() {
            let event = Event::glossy(bsdf.glossy_roughness(), self.method.sharp_alpha);
            self.add_through(event, by(Lobes::GLOSSY), Term::Direct, path);
        }
        if lit.intersects(Lobes::DIFFUSE) && bsdf.lobes().is_diffuse() {
            self.add_through(Event::Diffuse, by(Lobes::DIFFUSE), Term::Direct, path);
        }
    }

    /// Adds light that a surface scatters by an event, of some part of the image if the surface is the first.
    fn add_through(&mut self, event: Event, light: Sampled, first: Term, path: &mut CameraPath<'_, '_>) {
        self.radiance += light;
        path.layers.add_own(self.term_through(event, first) as usize, light);
        if !path.layers.is_idle() {
            path.layers.emit_through(event, light);
        }
    }

    fn term_through(&self, event: Event, first: Term) -> Term {
        match event {
            _ if self.depth > 0 => self.term,
            Event::Diffuse | Event::WideGlossy => first,
            _ => Term::Specular,
        }
    }

    /// Light that a map has, of some part of the image if the surface is the first.
    fn add_from_map(
        &mut self,
        (map, irradiance, first): (&LitMap, Option<&Precomputed>, Term),
        surface: &Surface,
        (bsdf, wide): (&Bsdf, Lobes),
        path: &mut CameraPath<'_, '_>,
        scratch: &mut EstimateScratch,
    ) {
        if wide.is_empty() {
            return;
        }
        let light = ask(map, irradiance, surface, (bsdf, wide), path, scratch) * self.beta;
        self.radiance += light;
        path.layers.add_own(self.term_through(Event::Diffuse, first) as usize, light);
        self.add_to_layers(map, surface, bsdf, wide, path, scratch);
    }

    /// The direct light of a surface whose other light a map tells: what sharp glossy lobes make of lamps, and all of it where that
    /// is wanted.
    fn add_direct_light_beside_map(
        &mut self,
        tracer: &Tracer<'_>,
        surface: &Surface,
        bsdf: &Bsdf,
        wide: Lobes,
        path: &mut CameraPath<'_, '_>,
    ) {
        if self.n_wide > 0 {
            return;
        }
        let sharp = bsdf.lobes() & !wide;
        let lit = match self.method.seen {
            Seen::ByMapAndShadowRays => Lobes::NON_SPECULAR,
            Seen::ByMapAlone => Lobes::NONE,
            _ => sharp & Lobes::NON_SPECULAR,
        };
        self.add_direct_light(tracer, surface, bsdf, (lit, sharp), path);
    }

    /// Fills the layers of path expressions by what the trails of photons tell.
    fn add_to_layers(
        &self,
        map: &LitMap,
        surface: &Surface,
        bsdf: &Bsdf,
        wide: Lobes,
        path: &mut CameraPath<'_, '_>,
        scratch: &mut EstimateScratch,
    ) {
        if path.layers.is_idle() {
            return;
        }
        let (lambda, layers) = (*path.lambda, &mut *path.layers);
        for (lobes, event) in [(Lobes::DIFFUSE, Event::Diffuse), (Lobes::GLOSSY, Event::WideGlossy)] {
            map.radiance_by_trail(surface, (bsdf, wide & lobes), &lambda, scratch, |trail, radiance| {
                layers.emit_trail(event, trail.events().rev(), radiance * self.beta);
            });
        }
    }
}

/// Cosine of a hundredth of a radian between geometric and shading normal, beyond which irradiance, which knows the geometric
/// one alone, does not tell enough: by then light at 45 degrees from the normal is wrong by a hundredth.
const LEAST_FLAT_COSINE: f32 = 0.999_95;

/// The light of a map on some lobes of a surface, by precomputed irradiance where that is enough.
fn ask(
    map: &LitMap,
    irradiance: Option<&Precomputed>,
    surface: &Surface,
    (bsdf, lobes): (&Bsdf, Lobes),
    path: &CameraPath<'_, '_>,
    scratch: &mut EstimateScratch,
) -> Sampled {
    let is_flat = bsdf.ns().as_vector().dot(surface.point.ng.as_vector()).abs() > LEAST_FLAT_COSINE;
    if let (Some(irradiance), BsdfKind::Diffuse(diffuse), true) = (irradiance, bsdf.kind(), is_flat) {
        let (p, ng) = (surface.point.p, surface.point.ng.as_vector());
        let n = if ng.dot(surface.wo) < 0.0 { -ng } else { ng };
        if let Some(irradiance) = irradiance.irradiance(p, n, map.estimate.max_radius) {
            return irradiance.sample(path.lambda) * diffuse.reflectance * FRAC_1_PI;
        }
    }
    map.radiance(surface, (bsdf, lobes), path.lambda, scratch).0
}
