//! Metal under a clear coat: lacquered brass, car paint.

use etendue_spectrum::Wavelengths;

use super::coat::Coat;
use super::metal::{Metal, MetalNames};
use super::roughness::{Roughness, RoughnessNames};
use super::{MaterialContext, Materials, Perturbation, spec};
use crate::bsdf::{Base, BsdfKind, Conductor};
use crate::parameters::{ParameterSpec, Parameters};
use crate::texture::Textures;

/// Parameters of `coatedconductor`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CoatedConductorMaterial {
    /// Optics of the metal.
    pub metal: Metal,
    /// Roughness of the metal.
    pub roughness: Roughness,
    /// The coat.
    pub coat: Coat,
    /// Relief.
    pub perturbation: Perturbation,
}

impl CoatedConductorMaterial {
    /// What scene files may say.
    pub const PARAMETERS: &'static [ParameterSpec] = &[
        ParameterSpec {
            name: "conductor.eta",
            kind: "spectrum texture",
            default: "metal-Cu-eta",
            unit: "",
            doc: "Real part of the metal's index of refraction.",
        },
        ParameterSpec {
            name: "conductor.k",
            kind: "spectrum texture",
            default: "metal-Cu-k",
            unit: "",
            doc: "Imaginary part of the metal's index of refraction (absorption).",
        },
        ParameterSpec {
            name: "reflectance",
            kind: "spectrum texture",
            default: "",
            unit: "",
            doc: "Reflectance of the metal in air at normal incidence, in place of its index.",
        },
        ParameterSpec { name: "conductor.roughness", ..spec::ROUGHNESS },
        ParameterSpec { name: "conductor.uroughness", default: "conductor.roughness", ..spec::U_ROUGHNESS },
        ParameterSpec { name: "conductor.vroughness", default: "conductor.roughness", ..spec::V_ROUGHNESS },
        ParameterSpec { name: "interface.eta", ..spec::ETA },
        ParameterSpec { name: "interface.roughness", ..spec::ROUGHNESS },
        ParameterSpec { name: "interface.uroughness", default: "interface.roughness", ..spec::U_ROUGHNESS },
        ParameterSpec { name: "interface.vroughness", default: "interface.roughness", ..spec::V_ROUGHNESS },
        spec::REMAP_ROUGHNESS,
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
            metal: Metal::build(p, &MetalNames { eta: "conductor.eta", k: "conductor.k" }),
            roughness: Roughness::build(p, &RoughnessNames::BASE),
            coat: Coat::build(p, "interface.eta", &RoughnessNames::COAT),
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
        let coat_eta = self.coat.eta.of_hero(textures, lambda);
        let (eta, k) = self.metal.eta_k(textures, ctx, lambda);
        let base = Conductor {
            microfacets: self.roughness.microfacets(textures, &ctx.texture),
            eta: eta / coat_eta,
            k: k / coat_eta,
        };
        self.coat.over(Base::Conductor(base), coat_eta, textures, ctx, lambda)
    }
}
