//! A polished coat over a diffuse base, by Ashikhmin and Shirley.

use etendue_spectrum::Wavelengths;

use crate::bsdf::Classic;
use crate::bsdf::classic::AshikhminShirley;
use crate::material::limits::PerTangent;
use crate::material::{MaterialContext, limits, spec};
use crate::parameters::{ParameterSpec, Parameters};
use crate::texture::{SpectrumTexture, Textures};

/// Parameters of `ashikhminshirley`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct AshikhminShirleyMaterial {
    /// Albedo of the base.
    pub kd: SpectrumTexture,
    /// Reflectance of the coat along the normal.
    pub ks: SpectrumTexture,
    /// Of the highlight along both tangents.
    pub exponent: PerTangent,
}

impl AshikhminShirleyMaterial {
    /// What scene files may say.
    pub const PARAMETERS: &'static [ParameterSpec] = &[
        ParameterSpec {
            name: "kd",
            kind: "spectrum texture",
            default: "0.5",
            unit: "",
            doc: "Albedo of the base, in [0, 1]; the coat takes its part of it.",
        },
        ParameterSpec {
            name: "ks",
            kind: "spectrum texture",
            default: "0.05",
            unit: "",
            doc: "Reflectance of the coat along the normal, in [0, 1].",
        },
        spec::EXPONENT_100,
        ParameterSpec {
            name: "uexponent",
            kind: "float texture",
            default: "exponent",
            unit: "",
            doc: "Exponent along the first tangent.",
        },
        ParameterSpec {
            name: "vexponent",
            kind: "float texture",
            default: "exponent",
            unit: "",
            doc: "Exponent along the second tangent.",
        },
        spec::DISPLACEMENT,
        spec::NORMAL_MAP,
    ];

    pub(super) fn build(p: &mut Parameters<'_, '_>) -> Self {
        let names = ["exponent", "uexponent", "vexponent"];
        Self {
            kd: limits::albedo(p, "kd", 0.5),
            ks: limits::albedo(p, "ks", 0.05),
            exponent: PerTangent::build(p, names, 100.0, limits::EXPONENTS),
        }
    }

    pub(super) fn bsdf(&self, textures: &Textures, ctx: &MaterialContext, lambda: &Wavelengths) -> Classic {
        let albedo = |texture| textures.eval_spectrum(texture, &ctx.texture, lambda).clamp(0.0, 1.0);
        let [exponent_u, exponent_v] = self.exponent.at(textures, ctx, limits::EXPONENTS);
        Classic::AshikhminShirley(AshikhminShirley {
            kd: albedo(self.kd),
            ks: albedo(self.ks),
            exponent_u,
            exponent_v,
        })
    }

    pub(super) fn is_uniform(&self) -> bool {
        self.kd.constant().is_some() && self.ks.constant().is_some() && self.exponent.is_isotropic()
    }
}
