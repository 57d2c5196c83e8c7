//! Paths of neighbouring pixels share what they find (Bekaert, Sbert and Halton 2002, "Accelerating Path Tracing by
//! Re-Using Paths").
//!
//! Each path of a group finds a first surface x that scatters widely, takes a direction there, and meets a second one, y,
//! where it goes on as every path. What y scatters is worth a whole path; to connect it with the x of another path costs a
//! shadow ray. So each x gathers from the y of all: with the balance heuristic, as samples of one integral over surfaces,
//! `L(x_i) = sum over j of f_i |cos_i| G V L(y_j) / sum over k of p_k(y_j)`, where `p_k(y)` is the density per square metre
//! with which x_k finds y, zero if it does not see it. Unbiased, and of a diffuse y no share exceeds what its own path would
//! have brought. Neighbours that see other surfaces lend little and take little, by those densities.
//!
//! What only the path itself can bring stays its own: emission of y, which x weighs against its own light samples, Dirac
//! lobes, all from a y of narrow lobes alone, and what scatters to a y without a known density. A y is shared among those who
//! see it from the same side. Paths share if they have scattered as often before x, so that `maxdepth` means the same to all.

use etendue_math::Vector3;
use etendue_scene::bsdf::{Bsdf, BsdfSample, Lobes, TransportMode};
use etendue_scene::light::LightPoint;
use etendue_scene::medium::MediumId;
use etendue_scene::scene::Surface;
use etendue_spectrum::{Sampled, Wavelengths};

use super::PathSettings;
use super::settings::MAX_REUSE;
use super::walk::Walk;
use crate::path::camera_pass::{CameraPath, Follow, FollowedPath, Tracer};

/// What a path carries from the surface that it finds counts no less than this in roulette, for others may carry more.
const LEAST_BRIGHTNESS: f32 = 0.1;

/// Lobes of facets narrower than this are not shared.
const NARROW_ALPHA: f32 = 0.1;

/// Most paths of a group.
const MAX_PATHS: usize = (MAX_REUSE * MAX_REUSE) as usize;

/// Path tracing with shared paths.
#[derive(Debug)]
pub(super) struct Reuse<'s> {
    pub settings: &'s PathSettings,
}

/// Where a path gathers from the others.
#[derive(Debug)]
pub(super) struct Gatherer {
    surface: Surface,
    bsdf: Bsdf,
    /// Throughput from the camera.
    beta: Sampled,
    /// Scattering events before.
    depth: u32,
    medium: Option<MediumId>,
    /// What the path found to share.
    found: Option<Source>,
}

/// A surface that scatters light towards all that see it.
#[derive(Debug)]
struct Source {
    point: LightPoint,
    bsdf: Bsdf,
    /// The side that is seen, by the sign of its cosine.
    side: f32,
    /// Light that arrives: its direction, and radiance times cosine per density.
    incident: [(Vector3, Sampled); 2],
    /// How the path itself came here.
    own: Technique,
}

/// What takes light from a source to a gatherer.
#[derive(Clone, Copy, Debug)]
struct Technique {
    /// Scattering function times cosine.
    f_cos: Sampled,
    /// Density of the direction, per steradian.
    pdf_w: f32,
}

impl Follow for Reuse<'_> {
    type Left = Option<Gatherer>;

    fn follow(&self, tracer: &Tracer<'_>, path: &mut CameraPath<'_, '_>) -> (Sampled, Self::Left) {
        let mut walk = Walk::new(self.settings, path);
        let lambda = *path.lambda;
        while let Some((surface, bsdf)) = walk.arrive(tracer, path) {
            if !walk.has_scattered_widely && can_share(&bsdf) && *path.lambda == lambda {
                return gather(walk, tracer, surface, bsdf, path);
            }
            if !walk.visit(tracer, &surface, &bsdf, path) {
                break;
            }
        }
        (walk.radiance, None)
    }

    fn join(&self, tracer: &Tracer<'_>, group: &mut [FollowedPath<Self::Left>]) {
        for source in 0..group.len() {
            let shares = share_out(tracer, group, source);
            for (path, share) in group.iter_mut().zip(shares) {
                path.radiance += share;
            }
        }
    }
}

/// Sharing takes lobes that other directions meet, and samples of a known density.
fn can_share(bsdf: &Bsdf) -> bool {
    bsdf.lobes().has_non_specular() && bsdf.kind().has_density()
}

/// A direction from a surface for the path to share. It goes on even if the path itself sees nothing of what it finds.
fn sample_to_share(surface: &Surface, bsdf: &Bsdf, path: &mut CameraPath<'_, '_>) -> Option<BsdfSample> {
    let (u_component, u) = (path.sampler.next_1d(), path.sampler.next_2d());
    bsdf.sample_by_density(surface.wo, u_component, u)
}

/// True if what a surface scatters one way may be found by samples for another: those for one of two narrow lobes are rare and
/// bright in the other.
fn is_source(bsdf: &Bsdf) -> bool {
    let lobes = bsdf.lobes();
    lobes.is_diffuse() || lobes.is_glossy() && bsdf.glossy_roughness() >= NARROW_ALPHA
}

/// Goes on from the first surface that scatters widely.
fn gather(
    mut walk: Walk<'_>,
    tracer: &Tracer<'_>,
    surface: Surface,
    bsdf: Bsdf,
    path: &mut CameraPath<'_, '_>,
) -> (Sampled, Option<Gatherer>) {
    let walks_per_light_sample = 1.0 / walk.settings.light_samples as f32;
    let radiance = walk.light_samples(tracer, &surface, &bsdf, walks_per_light_sample, path);
    let lambda = *path.lambda;
    let (beta, depth, medium) = (walk.beta, walk.depth, walk.medium);
    walk.radiance = Sampled::ZERO;
    walk.has_split = true;
    path.sampler.start_vertex();
    path.sampler.skip_light();
    let (own, found) = find_source(walk, tracer, &surface, &bsdf, walks_per_light_sample, path);
    let own = of_all_wavelengths(own, path.lambda, &lambda);
    *path.lambda = lambda;
    (radiance + own, Some(Gatherer { surface, bsdf, beta, depth, medium, found }))
}

/// Takes a direction from a surface that gathers; returns what only this path can bring, and what it found for all.
fn find_source(
    mut walk: Walk<'_>,
    tracer: &Tracer<'_>,
    surface: &Surface,
    bsdf: &Bsdf,
    walks_per_light_sample: f32,
    path: &mut CameraPath<'_, '_>,
) -> (Sampled, Option<Source>) {
    let lambda = *path.lambda;
    let Some(sample) = sample_to_share(surface, bsdf, path) else {
        return (walk.radiance, None);
    };
    walk.leave(tracer.scene, surface, &sample, walks_per_light_sample, path.layers);
    if sample.is_specular() {
        let goes_on = walk.survives_roulette(path);
        return (walk.follow_if(goes_on, tracer, path), None);
    }
    let Some((y, y_bsdf)) = walk.arrive(tracer, path) else {
        return (walk.radiance, None);
    };
    if !is_source(&y_bsdf) {
        let goes_on = walk.visit(tracer, &y, &y_bsdf, path);
        return (walk.follow_if(goes_on, tracer, path), None);
    }
    path.sampler.start_vertex();
    // Light arriving at y does not depend on the way from the camera.
    let mut alone = walk;
    alone.beta = Sampled::ONE;
    let direct = alone.direct_light(tracer, &y, &y_bsdf, 1.0, path, |candidate, through, path| {
        let wi = candidate.light.sample.wi;
        let light = through * candidate.weighted * y_bsdf.abs_cos(wi);
        (wi, of_all_wavelengths(light, path.lambda, &lambda))
    });
    let direct = direct.unwrap_or((y.wo, Sampled::ZERO));
    let mut indirect = (y.wo, Sampled::ZERO);
    let mut own = walk.radiance;
    if !can_share(&y_bsdf) {
        own = walk.finish(tracer, &y, &y_bsdf, 1.0, path);
    } else if let Some(sample) = sample_to_share(&y, &y_bsdf, path) {
        walk.leave(tracer.scene, &y, &sample, 1.0, path.layers);
        if sample.is_specular() {
            let goes_on = walk.survives_roulette(path);
            own = walk.follow_if(goes_on, tracer, path);
        } else {
            let cos_per_pdf = y_bsdf.abs_cos(sample.wi) / sample.pdf_w;
            // Roulette still sees the throughput from the camera.
            walk.roulette_scale *= walk.beta.max_value().max(LEAST_BRIGHTNESS) / cos_per_pdf;
            walk.beta = Sampled::splat(cos_per_pdf);
            walk.radiance = Sampled::ZERO;
            if walk.survives_roulette(path) {
                indirect = (sample.wi, of_all_wavelengths(walk.follow(tracer, path), path.lambda, &lambda));
            }
        }
    }
    let source = Source {
        point: LightPoint { p: y.point.p, p_error: y.point.p_error, n: Some(y.point.ng), uv: y.point.uv },
        bsdf: y_bsdf,
        side: y.wo.dot_normal(y_bsdf.ns()).signum(),
        incident: [direct, indirect],
        own: Technique { f_cos: sample.weight * sample.pdf_w, pdf_w: sample.pdf_w },
    };
    (own, source.is_lit().then_some(source))
}

/// Radiance of a path that has its wavelengths left, or only the first of them, as one of a path that has all.
fn of_all_wavelengths(radiance: Sampled, now: &Wavelengths, all: &Wavelengths) -> Sampled {
    if now == all {
        return radiance;
    }
    let first = radiance[0] * (all.pdf()[0] / now.pdf()[0]);
    Sampled::from_array([first, 0.0, 0.0, 0.0])
}

/// What each path of a group gets from what one of them has found.
fn share_out(
    tracer: &Tracer<'_>,
    group: &[FollowedPath<Option<Gatherer>>],
    source: usize,
) -> [Sampled; MAX_PATHS] {
    let mut shares = [Sampled::ZERO; MAX_PATHS];
    let Some(Gatherer { depth, found: Some(found), .. }) = &group[source].left else {
        return shares;
    };
    let mut sum_pdf_a = 0.0;
    for (index, path) in group.iter().enumerate() {
        let Some(gatherer) = path.left.as_ref().filter(|gatherer| gatherer.depth == *depth) else {
            continue;
        };
        let own = (index == source).then_some(found.own);
        if let Some((share, pdf_a)) = connect(tracer, gatherer, found, own, &path.lambda) {
            shares[index] = share;
            sum_pdf_a += pdf_a;
        }
    }
    let scale = if sum_pdf_a > 0.0 && sum_pdf_a.is_finite() { 1.0 / sum_pdf_a } else { 0.0 };
    shares.map(|share| share * scale)
}

/// What a gatherer sees of a source, and the density per square metre with which it finds it itself; `None` if it cannot.
fn connect(
    tracer: &Tracer<'_>,
    gatherer: &Gatherer,
    source: &Source,
    own: Option<Technique>,
    lambda: &Wavelengths,
) -> Option<(Sampled, f32)> {
    let Gatherer { surface, bsdf, .. } = gatherer;
    let way = source.point.p - surface.point.p;
    let distance_squared = way.length_squared();
    let distance = distance_squared.sqrt();
    let w = way / distance;
    if -w.dot_normal(source.bsdf.ns()) * source.side <= 0.0 {
        return None;
    }
    let Technique { f_cos, pdf_w } = own.unwrap_or_else(|| {
        let (f_cos, pdf_w) = bsdf.eval_cos_and_pdf(surface.wo, w);
        Technique { f_cos, pdf_w }
    });
    let area_per_steradian = w.dot_normal(source.bsdf.ng()).abs() / distance_squared;
    let pdf_a = pdf_w * area_per_steradian;
    if !(pdf_a > 0.0 && pdf_a.is_finite()) || (own.is_none() && !sees(tracer, surface, &source.point)) {
        return None;
    }
    let mut share = gatherer.beta * f_cos * source.radiance(-w) * area_per_steradian;
    if let Some(medium) = tracer.scene.medium_towards(surface, w, gatherer.medium) {
        share *= tracer.scene.transmittance_of(medium, distance, lambda);
    }
    Some((share, pdf_a))
}

fn sees(tracer: &Tracer<'_>, surface: &Surface, point: &LightPoint) -> bool {
    tracer.count_shadow_ray();
    tracer.scene.transmittance(surface, point) > 0.0
}

impl Source {
    fn is_lit(&self) -> bool {
        self.incident.iter().any(|(_, light)| !light.is_black())
    }

    /// Radiance that it scatters towards `wo`.
    fn radiance(&self, wo: Vector3) -> Sampled {
        let scattered = |(wi, light): (Vector3, Sampled)| {
            if light.is_black() {
                return Sampled::ZERO;
            }
            self.bsdf.eval(wo, wi, TransportMode::Radiance, Lobes::ALL) * light
        };
        scattered(self.incident[0]) + scattered(self.incident[1])
    }
}
