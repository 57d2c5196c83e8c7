//! Next event estimation: light that reaches a surface straight from a light (SPEC PT-3, EMI-13).
//!
//! One light is chosen, one point or direction of it, and a shadow ray tells whether it is seen:
//! `f(wo, wi) |cos| L_e V / (pmf pdf_w)`, weighted against the chance that scattering finds the same direction.

use etendue_math::Sampler;
use etendue_scene::Scene;
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

/// Chooses a light and a direction to it. Always takes the same number of random numbers.
#[inline]
#[must_use]
pub fn sample_light(
    scene: &Scene,
    surface: &Surface,
    sampler: &mut Sampler,
    lambda: &Wavelengths,
) -> Option<DirectLight> {
    let (u_light, u) = (sampler.next_1d(), sampler.next_2d());
    let reference = surface.reference();
    let (light, pmf) = scene.light_sampler.sample(&reference, u_light)?;
    let sample = scene.light(light).sample_li(&scene.light_context(), &reference, u, lambda)?;
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
