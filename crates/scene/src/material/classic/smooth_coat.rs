//! A diffuse surface under a smooth clear coat, in closed form.

use etendue_spectrum::Wavelengths;

use crate::bsdf::Classic;
use crate::bsdf::classic::SmoothCoat;
use crate::material::{MaterialContext, limits, spec};
use crate::parameters::{ParameterSpec, Parameters};
use crate::texture::{SpectrumTexture, Textures};

/// Parameters of `smoothcoat`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SmoothCoatMaterial {
    /// Albedo of the base.
    pub reflectance: SpectrumTexture,
    /// Index of the coat.
    pub eta: f32,
}

/// Indices of coats.
const INDICES: [f32; 2] = [1.0, 4.0];

impl SmoothCoatMaterial {
    /// What scene files may say.
    pub const PARAMETERS: &'static [ParameterSpec] = &[
        ParameterSpec { doc: "Fraction of light that the base reflects, in [0, 1].", ..spec::REFLECTANCE },
        ParameterSpec {
            name: "eta",
            kind: "float",
            default: "1.5",
            unit: "",
            doc: "Index of refraction of the coat relative to outside, 1 to 4.",
        },
        spec::DISPLACEMENT,
        spec::NORMAL_MAP,
    ];

    pub(super) fn build(p: &mut Parameters<'_, '_>) -> Self {
        Self {
            reflectance: limits::albedo(p, "reflectance", 0.5),
            eta: limits::constant_within(p, "eta", 1.5, INDICES),
        }
    }

    pub(super) fn bsdf(&self, textures: &Textures, ctx: &MaterialContext, lambda: &Wavelengths) -> Classic {
        let reflectance = textures.eval_spectrum(self.reflectance, &ctx.texture, lambda).clamp(0.0, 1.0);
        Classic::SmoothCoat(SmoothCoat::new(reflectance, self.eta))
    }

    pub(super) const fn is_uniform(&self) -> bool {
        self.reflectance.constant().is_some()
    }
}
