//! Next event estimation: light that reaches a surface straight from a light (SPEC PT-3, EMI-13).
//!
//! One light is chosen, one point or direction of it, and a shadow ray tells whether it is seen:
//! `f(wo, wi) |cos| L_e V / (pmf pdf_w)`, weighted against the chance that scattering finds the same direction.

use etendue_math::{Point2, Sampler};
use etendue_scene::Scene;
use etendue_scene::bsdf::Bsdf;
use etendue_scene::light::LightSample;
use etendue_scene::scene::Surface;
use etendue_spectrum::{Sampled, Wavelengths};

use super::camera_pass::Tracer;
use super::mis::power_heuristic;

/// A light as a surface sees it, before the surface scatters it.
#[derive(Clone, Copy, Debug)]
pub struct DirectLight {
    /// The light's sample.
    pub sample: LightSample,
    /// Density of the choice per steradian, the choice of the light included.
    pub pdf_w: f32,
}

/// A light's sample that was chosen for a shadow ray.
#[derive(Clone, Copy, Debug)]
pub struct Candidate {
    /// The light.
    pub light: DirectLight,
    /// Its radiance per density, weighted against scattering.
    pub weighted: Sampled,
    /// What the surface sends on of it if nothing is in between.
    pub unoccluded: Sampled,
    /// What to multiply it by, for it stands for all candidates: one over the probability of the choice.
    pub weight: f32,
}

/// Samples each group of lights, and chooses one of the samples in proportion to what the surface would send on of it:
/// resampled importance sampling (Talbot, Cline and Egbert 2005) of one shadow ray. Each group's sample is an unbiased
/// estimate of the group's light, weighted against scattering by its own density; the choice keeps the expectation of
/// their sum, and that they share their random numbers does not matter to it. `scattering_weight` multiplies the density of
/// scattering that samples are weighted against: the number of directions for each sample, 0 for none. Always takes as many
/// numbers.
#[inline]
#[must_use]
pub fn choose_light(
    scene: &Scene,
    surface: &Surface,
    bsdf: &Bsdf,
    scattering_weight: f32,
    sampler: &mut Sampler,
    lambda: &Wavelengths,
) -> Option<Candidate> {
    let (u_light, u_place) = (sampler.next_1d(), sampler.next_2d());
    let candidate = |group| {
        let light = sample_light(scene, group, surface, (u_light, u_place), lambda)?;
        let (f_cos, pdf_scatter) = bsdf.eval_cos_and_pdf(surface.wo, light.sample.wi);
        let weighted = light.weighted(scattering_weight * pdf_scatter);
        let unoccluded = f_cos * weighted;
        (!unoccluded.is_black()).then_some(Candidate { light, weighted, unoccluded, weight: 1.0 })
    };
    let n_groups = scene.light_sampler.n_groups();
    if n_groups == 1 {
        return candidate(0);
    }
    // A number of its own for the choice, where one is taken.
    let u = if scene.light_sampler.uses_number() { sampler.next_1d() } else { u_light };
    choose_candidate((0..n_groups).filter_map(candidate), u)
}

/// One of several candidates, in proportion to what the surface would send on of them.
#[inline(never)]
fn choose_candidate(candidates: impl Iterator<Item = Candidate>, mut u: f32) -> Option<Candidate> {
    let (mut chosen, mut sum, mut chosen_share) = (None, 0.0, 0.0);
    for candidate in candidates {
        let share = candidate.unoccluded.average();
        if share <= 0.0 || !share.is_finite() {
            continue;
        }
        sum += share;
        let p = share / sum;
        if u < p {
            u /= p;
            chosen_share = share;
            chosen = Some(candidate);
        } else {
            u = (u - p) / (1.0 - p);
        }
    }
    chosen.map(|candidate| Candidate { weight: sum / chosen_share, ..candidate })
}

/// Chooses a light of a group and a direction to it.
#[inline]
fn sample_light(
    scene: &Scene,
    group: usize,
    surface: &Surface,
    (u_light, u): (f32, Point2),
    lambda: &Wavelengths,
) -> Option<DirectLight> {
    let reference = surface.reference();
    let (light, pmf) = scene.light_sampler.sample(group, &reference, u_light)?;
    // Light linking keeps some lights from some shapes.
    if scene.controls.as_ref().is_some_and(|controls| !controls.reaches(light, surface.hit.geometry)) {
        return None;
    }
    let sample =
        scene.light(light).sample_li(&scene.light_context_at(surface.time), &reference, u, lambda)?;
    let pdf_w = pmf * sample.pdf_w;
    (pdf_w > 0.0 && !sample.le.is_black()).then_some(DirectLight { sample, pdf_w })
}

impl DirectLight {
    /// The light's radiance per density, weighted against scattering, whose density is `pdf_scatter`: what the product
    /// of scattering function and cosine is multiplied by.
    #[inline]
    #[must_use]
    pub fn weighted(&self, pdf_scatter: f32) -> Sampled {
        let weight = if self.sample.is_delta { 1.0 } else { power_heuristic(self.pdf_w, pdf_scatter) };
        self.sample.le * (weight / self.pdf_w)
    }
}

/// The share of the light's sample that gets through to the surface.
#[inline]
#[must_use]
pub fn visibility(tracer: &Tracer<'_>, surface: &Surface, light: &LightSample) -> f32 {
    tracer.count_shadow_ray();
    match &light.p_light {
        None => tracer.scene.transmittance_to_infinity(surface, light.wi),
        Some(point) => tracer.scene.transmittance(surface, point),
    }
}
