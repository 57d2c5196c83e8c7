//! Photons leave the lights (SPEC EMI-4 to EMI-9, PHT-1).
//!
//! Each photon chooses a light in proportion to its power, a place and a direction by the light's own density, so that all
//! carry nearly the same flux: `le cos / (pdf_a pdf_w pmf)`.

use etendue_math::{AliasTable, Normal3, Ray, Sampler, offset_ray_origin};
use etendue_scene::Scene;
use etendue_scene::light::LightId;
use etendue_spectrum::{Sampled, Wavelengths};

/// Chooses which light sends a photon.
#[derive(Clone, Debug)]
pub struct PhotonEmitter {
    /// By light; `None` if no light has any power.
    lights: Option<AliasTable>,
}

/// A photon that leaves a light.
#[derive(Clone, Copy, Debug)]
pub struct EmittedPhoton {
    /// Its way, clear of the light's surface.
    pub ray: Ray,
    /// Flux per wavelength if it is the only photon, in the units of the renderer (radiance times m^2 sr).
    pub flux: Sampled,
    /// Who sent it.
    pub light: LightId,
    /// Geometric normal where it starts, if that is a surface.
    pub n: Option<Normal3>,
}

impl PhotonEmitter {
    /// For the lights of a scene.
    #[must_use]
    pub fn new(scene: &Scene) -> Self {
        let context = scene.light_context();
        let powers: Vec<f64> = scene.lights.iter().map(|light| light.power(&context).weight).collect();
        let largest = powers.iter().copied().filter(|power| power.is_finite()).fold(0.0, f64::max);
        if largest <= 0.0 {
            return Self { lights: None };
        }
        let weight = |power: &f64| if power.is_finite() { (power / largest).max(0.0) as f32 } else { 0.0 };
        let weights: Vec<f32> = powers.iter().map(weight).collect();
        Self { lights: Some(AliasTable::new(&weights)) }
    }

    /// True if there is no light to send photons.
    #[must_use]
    pub const fn is_dark(&self) -> bool {
        self.lights.is_none()
    }

    /// Probability with which a light is chosen.
    #[must_use]
    pub fn pmf(&self, light: LightId) -> f32 {
        self.lights.as_ref().map_or(0.0, |lights| lights.pmf(light.0 as usize))
    }

    /// One photon; `None` if this choice of numbers sends none, which counts as emitted all the same. Always takes as many
    /// numbers: direction, time, place, light.
    #[must_use]
    pub fn emit(&self, scene: &Scene, numbers: &mut Sampler, lambda: &Wavelengths) -> Option<EmittedPhoton> {
        self.emit_at(None, scene, numbers, lambda)
    }

    /// The same at a given time in seconds; `None` for any while the shutter is open.
    #[must_use]
    pub fn emit_at(
        &self,
        time: Option<f32>,
        scene: &Scene,
        numbers: &mut Sampler,
        lambda: &Wavelengths,
    ) -> Option<EmittedPhoton> {
        let u_direction = numbers.next_2d();
        let u_time = numbers.next_1d();
        let time = time.unwrap_or_else(|| scene.camera.sample_time(u_time));
        let u_position = numbers.next_2d();
        let (index, pmf, _) = self.lights.as_ref()?.sample(numbers.next_1d());
        let light = LightId(index as u32);
        let context = scene.light_context_at(time);
        let emitted = scene.light(light).sample_le(&context, u_position, u_direction, lambda)?;
        let density = emitted.pdf_a * emitted.pdf_w * pmf;
        let flux = emitted.le * (emitted.cosine / density);
        if flux.is_black() || !flux.is_finite() {
            return None;
        }
        let mut ray = Ray { time, ..emitted.ray };
        if let Some(n) = emitted.n {
            ray.origin = offset_ray_origin(ray.origin, emitted.p_error, n, ray.direction);
        }
        Some(EmittedPhoton { ray, flux, light, n: emitted.n })
    }
}
