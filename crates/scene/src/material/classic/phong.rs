//! A diffuse surface with Phong's highlight.

use etendue_spectrum::Wavelengths;

use super::LobeColors;
use crate::bsdf::Classic;
use crate::bsdf::classic::{Phong, PhongForm};
use crate::material::{MaterialContext, limits, spec};
use crate::parameters::{ParameterSpec, Parameters};
use crate::texture::{FloatTexture, Textures};

/// Parameters of `phong`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PhongMaterial {
    /// Of diffuse part and highlight.
    pub colors: LobeColors,
    /// Of the highlight.
    pub exponent: FloatTexture,
    /// Normalised or not.
    pub form: PhongForm,
}

impl PhongMaterial {
    /// What scene files may say.
    pub const PARAMETERS: &'static [ParameterSpec] = &[
        LobeColors::KD,
        LobeColors::KS,
        LobeColors::AMBIENT,
        spec::EXPONENT,
        ParameterSpec {
            name: "form",
            kind: "string",
            default: "lewis",
            unit: "",
            doc: "lewis: reciprocal, keeps energy. illumination: Phong's equation of 1975, which does not.",
        },
        spec::DISPLACEMENT,
        spec::NORMAL_MAP,
    ];

    pub(super) fn build(p: &mut Parameters<'_, '_>) -> Self {
        let forms = [("lewis", PhongForm::Lewis), ("illumination", PhongForm::Illumination)];
        Self {
            colors: LobeColors::build(p),
            exponent: limits::float_within(p, "exponent", 30.0, limits::EXPONENTS),
            form: p.choice("form", "lewis", &forms),
        }
    }

    pub(super) fn bsdf(&self, textures: &Textures, ctx: &MaterialContext, lambda: &Wavelengths) -> Classic {
        let (kd, ks) = self.colors.at(textures, ctx, lambda);
        let exponent = limits::clamp(textures.eval_float(self.exponent, &ctx.texture), limits::EXPONENTS);
        Classic::Phong(Phong { kd, ks, exponent, form: self.form })
    }

    pub(super) const fn is_uniform(&self) -> bool {
        self.colors.is_constant() && self.exponent.constant().is_some()
    }
}
