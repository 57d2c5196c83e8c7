//! Glass, water, diamond: a boundary between transparent media, smooth or rough.

use etendue_spectrum::Wavelengths;

use super::index::RefractiveIndex;
use super::roughness::{Roughness, RoughnessNames};
use super::{MaterialContext, Materials, Perturbation, spec};
use crate::bsdf::{BsdfKind, Dielectric};
use crate::parameters::{ParameterSpec, Parameters};
use crate::texture::Textures;

/// Parameters of `dielectric`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct DielectricMaterial {
    /// Index inside, where the normal does not point, relative to outside.
    pub eta: RefractiveIndex,
    /// Roughness.
    pub roughness: Roughness,
    /// Relief.
    pub perturbation: Perturbation,
}

impl DielectricMaterial {
    /// What scene files may say.
    pub const PARAMETERS: &'static [ParameterSpec] = &[
        spec::ETA,
        spec::ROUGHNESS,
        spec::U_ROUGHNESS,
        spec::V_ROUGHNESS,
        spec::REMAP_ROUGHNESS,
        spec::DISPLACEMENT,
        spec::NORMAL_MAP,
    ];

    pub(super) fn build(p: &mut Parameters<'_, '_>, materials: &mut Materials) -> Self {
        Self {
            eta: RefractiveIndex::build(p, "eta"),
            roughness: Roughness::build(p, &RoughnessNames::PLAIN),
            perturbation: Perturbation::build(p, materials),
        }
    }

    #[inline]
    pub(super) fn bsdf(
        &self,
        textures: &Textures,
        ctx: &MaterialContext,
        lambda: &mut Wavelengths,
    ) -> BsdfKind {
        let eta = self.eta.of_hero(textures, lambda);
        BsdfKind::Dielectric(Dielectric {
            microfacets: self.roughness.microfacets(textures, &ctx.texture),
            eta,
        })
    }
}
