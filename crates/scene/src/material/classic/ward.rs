//! A diffuse surface with Ward's highlight.

use etendue_spectrum::Wavelengths;

use super::LobeColors;
use crate::bsdf::Classic;
use crate::bsdf::classic::{Ward, WardForm};
use crate::material::limits::PerTangent;
use crate::material::{MaterialContext, limits, spec};
use crate::parameters::{ParameterSpec, Parameters};
use crate::texture::Textures;

/// Parameters of `ward`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct WardMaterial {
    /// Of diffuse part and highlight.
    pub colors: LobeColors,
    /// Of the highlight along both tangents.
    pub roughness: PerTangent,
    /// As published or with the later fix.
    pub form: WardForm,
}

impl WardMaterial {
    /// What scene files may say.
    pub const PARAMETERS: &'static [ParameterSpec] = &[
        LobeColors::KD,
        LobeColors::KS,
        ParameterSpec {
            name: "roughness",
            kind: "float texture",
            default: "0.15",
            unit: "",
            doc: "Root mean square slope times the square root of 2, along both tangents, 0.001 to 1.",
        },
        spec::U_ROUGHNESS,
        spec::V_ROUGHNESS,
        ParameterSpec {
            name: "form",
            kind: "string",
            default: "bounded",
            unit: "",
            doc: "bounded: the fix of 2010, which keeps grazing light. original: as published in 1992.",
        },
        spec::DISPLACEMENT,
        spec::NORMAL_MAP,
    ];

    pub(super) fn build(p: &mut Parameters<'_, '_>) -> Self {
        let forms = [("bounded", WardForm::Bounded), ("original", WardForm::Original)];
        let names = ["roughness", "uroughness", "vroughness"];
        Self {
            colors: LobeColors::build(p),
            roughness: PerTangent::build(p, names, 0.15, limits::SLOPES),
            form: p.choice("form", "bounded", &forms),
        }
    }

    pub(super) fn bsdf(&self, textures: &Textures, ctx: &MaterialContext, lambda: &Wavelengths) -> Classic {
        let (kd, ks) = self.colors.at(textures, ctx, lambda);
        let [alpha_x, alpha_y] = self.roughness.at(textures, ctx, limits::SLOPES);
        Classic::Ward(Ward { kd, ks, alpha_x, alpha_y, form: self.form })
    }

    pub(super) fn is_uniform(&self) -> bool {
        self.colors.is_constant() && self.roughness.is_isotropic()
    }
}
