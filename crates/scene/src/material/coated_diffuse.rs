//! A diffuse surface under a clear coat: plastic, varnished wood, glazed pottery.

use etendue_spectrum::Wavelengths;

use super::coat::Coat;
use super::roughness::RoughnessNames;
use super::{MaterialContext, Materials, Perturbation, limits, spec};
use crate::bsdf::{Base, BsdfKind, Diffuse};
use crate::parameters::{ParameterSpec, Parameters};
use crate::texture::{SpectrumTexture, Textures};

/// Parameters of `coateddiffuse`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CoatedDiffuseMaterial {
    /// Albedo of the base, clamped to [0, 1].
    pub reflectance: SpectrumTexture,
    /// The coat.
    pub coat: Coat,
    /// Relief.
    pub perturbation: Perturbation,
}

impl CoatedDiffuseMaterial {
    /// What scene files may say.
    pub const PARAMETERS: &'static [ParameterSpec] = &[
        ParameterSpec {
            name: "reflectance",
            kind: "spectrum texture",
            default: "0.5",
            unit: "",
            doc: "Fraction of light that the base reflects, in [0, 1].",
        },
        spec::ROUGHNESS,
        spec::U_ROUGHNESS,
        spec::V_ROUGHNESS,
        spec::REMAP_ROUGHNESS,
        spec::ETA,
        spec::THICKNESS,
        spec::G,
        spec::ALBEDO,
        spec::MAX_DEPTH,
        spec::N_SAMPLES,
        spec::DISPLACEMENT,
        spec::NORMAL_MAP,
    ];

    pub(super) fn build(p: &mut Parameters<'_, '_>, materials: &mut Materials) -> Self {
        Self {
            reflectance: limits::albedo(p, "reflectance", 0.5),
            coat: Coat::build(p, "eta", &RoughnessNames::PLAIN),
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
        let eta = self.coat.eta.of_hero(textures, lambda);
        let reflectance = textures.eval_spectrum(self.reflectance, &ctx.texture, lambda).clamp(0.0, 1.0);
        self.coat.over(Base::Diffuse(Diffuse { reflectance }), eta, textures, ctx, lambda)
    }
}
