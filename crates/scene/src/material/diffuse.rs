//! Ideal diffuse reflection: matte paint, paper, plaster.

use etendue_spectrum::Wavelengths;

use super::{MaterialContext, Materials, Perturbation, limits, spec};
use crate::bsdf::{BsdfKind, Diffuse};
use crate::parameters::{ParameterSpec, Parameters};
use crate::texture::{SpectrumTexture, Textures};

/// Parameters of `diffuse`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct DiffuseMaterial {
    /// Albedo, clamped to [0, 1].
    pub reflectance: SpectrumTexture,
    /// Relief.
    pub perturbation: Perturbation,
}

impl DiffuseMaterial {
    /// What scene files may say.
    pub const PARAMETERS: &'static [ParameterSpec] =
        &[spec::REFLECTANCE, spec::DISPLACEMENT, spec::NORMAL_MAP];

    pub(super) fn build(p: &mut Parameters<'_, '_>, materials: &mut Materials) -> Self {
        Self {
            reflectance: limits::albedo(p, "reflectance", 0.5),
            perturbation: Perturbation::build(p, materials),
        }
    }

    #[inline]
    pub(super) fn bsdf(&self, textures: &Textures, ctx: &MaterialContext, lambda: &Wavelengths) -> BsdfKind {
        BsdfKind::Diffuse(Diffuse::new(textures.eval_spectrum(self.reflectance, &ctx.texture, lambda)))
    }
}
