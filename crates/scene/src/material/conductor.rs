//! Metal, smooth or rough.

use etendue_spectrum::Wavelengths;

use super::metal::{Metal, MetalNames};
use super::roughness::{Roughness, RoughnessNames};
use super::{MaterialContext, Materials, Perturbation, spec};
use crate::bsdf::{BsdfKind, Conductor};
use crate::parameters::{ParameterSpec, Parameters};
use crate::texture::Textures;

/// Parameters of `conductor`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ConductorMaterial {
    /// Optics.
    pub metal: Metal,
    /// Roughness.
    pub roughness: Roughness,
    /// Relief.
    pub perturbation: Perturbation,
}

impl ConductorMaterial {
    /// What scene files may say.
    pub const PARAMETERS: &'static [ParameterSpec] = &[
        spec::METAL_ETA,
        spec::METAL_K,
        spec::METAL_REFLECTANCE,
        spec::ROUGHNESS,
        spec::U_ROUGHNESS,
        spec::V_ROUGHNESS,
        spec::REMAP_ROUGHNESS,
        spec::DISPLACEMENT,
        spec::NORMAL_MAP,
    ];

    pub(super) fn build(p: &mut Parameters<'_, '_>, materials: &mut Materials) -> Self {
        Self {
            metal: Metal::build(p, &MetalNames { eta: "eta", k: "k" }),
            roughness: Roughness::build(p, &RoughnessNames::PLAIN),
            perturbation: Perturbation::build(p, materials),
        }
    }

    #[inline]
    pub(super) fn bsdf(&self, textures: &Textures, ctx: &MaterialContext, lambda: &Wavelengths) -> BsdfKind {
        let (eta, k) = self.metal.eta_k(textures, ctx, lambda);
        BsdfKind::Conductor(Conductor {
            microfacets: self.roughness.microfacets(textures, &ctx.texture),
            eta,
            k,
        })
    }
}
