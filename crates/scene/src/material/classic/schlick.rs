//! Schlick's surface between mirror and matte.

use etendue_spectrum::Wavelengths;

use crate::bsdf::Classic;
use crate::bsdf::classic::{Schlick, SchlickForm};
use crate::material::{MaterialContext, limits, spec};
use crate::parameters::{ParameterSpec, Parameters};
use crate::texture::{FloatTexture, SpectrumTexture, Textures};

/// Parameters of `schlick`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SchlickMaterial {
    /// Reflectance along the normal.
    pub reflectance: SpectrumTexture,
    /// From mirror to matte.
    pub roughness: FloatTexture,
    /// 1 is isotropic.
    pub isotropy: FloatTexture,
    /// Conserving or as printed.
    pub form: SchlickForm,
}

const ISOTROPIES: [f32; 2] = [0.01, 1.0];

impl SchlickMaterial {
    /// What scene files may say.
    pub const PARAMETERS: &'static [ParameterSpec] = &[
        ParameterSpec { doc: "Reflectance along the normal, F0, in [0, 1].", ..spec::REFLECTANCE },
        ParameterSpec {
            name: "roughness",
            kind: "float texture",
            default: "0.5",
            unit: "",
            doc: "Sigma of the paper: 0 is a mirror, 0.5 glossy, 1 matte.",
        },
        ParameterSpec {
            name: "isotropy",
            kind: "float texture",
            default: "1",
            unit: "",
            doc: "Psi of the paper, 0.01 to 1: 1 is isotropic, less is scratched along the first tangent.",
        },
        ParameterSpec {
            name: "form",
            kind: "string",
            default: "conserving",
            unit: "",
            doc: "conserving: keeps energy. printed: with light that is reflected again, which makes light.",
        },
        spec::DISPLACEMENT,
        spec::NORMAL_MAP,
    ];

    pub(super) fn build(p: &mut Parameters<'_, '_>) -> Self {
        let forms = [("conserving", SchlickForm::Conserving), ("printed", SchlickForm::Printed)];
        Self {
            reflectance: limits::albedo(p, "reflectance", 0.5),
            roughness: limits::float_within(p, "roughness", 0.5, limits::SHARES),
            isotropy: limits::float_within(p, "isotropy", 1.0, ISOTROPIES),
            form: p.choice("form", "conserving", &forms),
        }
    }

    pub(super) fn bsdf(&self, textures: &Textures, ctx: &MaterialContext, lambda: &Wavelengths) -> Classic {
        let within = |texture, range| limits::clamp(textures.eval_float(texture, &ctx.texture), range);
        Classic::Schlick(Schlick {
            reflectance: textures.eval_spectrum(self.reflectance, &ctx.texture, lambda).clamp(0.0, 1.0),
            roughness: within(self.roughness, limits::SHARES),
            isotropy: within(self.isotropy, ISOTROPIES),
            form: self.form,
        })
    }

    pub(super) fn is_uniform(&self) -> bool {
        let is_isotropic = self.isotropy.constant() == Some(1.0);
        self.reflectance.constant().is_some() && self.roughness.constant().is_some() && is_isotropic
    }
}
