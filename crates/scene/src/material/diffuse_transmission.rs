//! A thin diffuse sheet that light passes: leaves, paper, lampshades.

use etendue_spectrum::Wavelengths;

use super::{MaterialContext, Materials, Perturbation, limits, spec};
use crate::bsdf::{BsdfKind, DiffuseTransmission};
use crate::parameters::{ParameterSpec, Parameters};
use crate::texture::{SpectrumTexture, Textures};

/// Parameters of `diffusetransmission`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct DiffuseTransmissionMaterial {
    /// Albedo to the side that light came from.
    pub reflectance: SpectrumTexture,
    /// Albedo to the other side.
    pub transmittance: SpectrumTexture,
    /// Multiplies both; the products are clamped to [0, 1].
    pub scale: f32,
    /// Relief.
    pub perturbation: Perturbation,
}

impl DiffuseTransmissionMaterial {
    /// What scene files may say.
    pub const PARAMETERS: &'static [ParameterSpec] = &[
        ParameterSpec {
            name: "reflectance",
            kind: "spectrum texture",
            default: "0.25",
            unit: "",
            doc: "Fraction of light reflected, in [0, 1].",
        },
        ParameterSpec {
            name: "transmittance",
            kind: "spectrum texture",
            default: "0.25",
            unit: "",
            doc: "Fraction of light transmitted, in [0, 1].",
        },
        ParameterSpec {
            name: "scale",
            kind: "float",
            default: "1",
            unit: "",
            doc: "Multiplies both fractions.",
        },
        spec::DISPLACEMENT,
        spec::NORMAL_MAP,
    ];

    pub(super) fn build(p: &mut Parameters<'_, '_>, materials: &mut Materials) -> Self {
        Self {
            reflectance: limits::albedo(p, "reflectance", 0.25),
            transmittance: limits::albedo(p, "transmittance", 0.25),
            scale: p.float("scale", 1.0),
            perturbation: Perturbation::build(p, materials),
        }
    }

    #[inline]
    pub(super) fn bsdf(&self, textures: &Textures, ctx: &MaterialContext, lambda: &Wavelengths) -> BsdfKind {
        let albedo =
            |texture| (textures.eval_spectrum(texture, &ctx.texture, lambda) * self.scale).clamp(0.0, 1.0);
        BsdfKind::DiffuseTransmission(DiffuseTransmission {
            reflectance: albedo(self.reflectance),
            transmittance: albedo(self.transmittance),
        })
    }
}
