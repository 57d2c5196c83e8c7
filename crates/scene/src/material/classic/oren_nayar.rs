//! A rough matte surface.

use etendue_spectrum::Wavelengths;

use crate::bsdf::Classic;
use crate::bsdf::classic::{OrenNayar, OrenNayarForm};
use crate::material::{MaterialContext, limits, spec};
use crate::parameters::{ParameterSpec, Parameters};
use crate::texture::{FloatTexture, SpectrumTexture, Textures};

/// Parameters of `orennayar`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct OrenNayarMaterial {
    /// Albedo of the walls of the grooves.
    pub reflectance: SpectrumTexture,
    /// Standard deviation of their angle in degrees.
    pub sigma_deg: FloatTexture,
    /// Full or qualitative.
    pub form: OrenNayarForm,
}

const SIGMAS: [f32; 2] = [0.0, 90.0];

impl OrenNayarMaterial {
    /// What scene files may say.
    pub const PARAMETERS: &'static [ParameterSpec] = &[
        spec::REFLECTANCE,
        ParameterSpec {
            name: "sigma",
            kind: "float texture",
            default: "20",
            unit: "deg",
            doc: "Standard deviation of the angle of the walls of grooves, 0 to 90; 0 is Lambert's model.",
        },
        ParameterSpec {
            name: "form",
            kind: "string",
            default: "full",
            unit: "",
            doc: "full: the model of 1994 with two bounces. qualitative: its short formula.",
        },
        spec::DISPLACEMENT,
        spec::NORMAL_MAP,
    ];

    pub(super) fn build(p: &mut Parameters<'_, '_>) -> Self {
        let forms = [("full", OrenNayarForm::Full), ("qualitative", OrenNayarForm::Qualitative)];
        Self {
            reflectance: limits::albedo(p, "reflectance", 0.5),
            sigma_deg: limits::float_within(p, "sigma", 20.0, SIGMAS),
            form: p.choice("form", "full", &forms),
        }
    }

    pub(super) fn bsdf(&self, textures: &Textures, ctx: &MaterialContext, lambda: &Wavelengths) -> Classic {
        let sigma_deg = limits::clamp(textures.eval_float(self.sigma_deg, &ctx.texture), SIGMAS);
        Classic::OrenNayar(OrenNayar {
            reflectance: textures.eval_spectrum(self.reflectance, &ctx.texture, lambda).clamp(0.0, 1.0),
            sigma_rad: sigma_deg.to_radians(),
            form: self.form,
        })
    }

    pub(super) const fn is_uniform(&self) -> bool {
        self.reflectance.constant().is_some() && self.sigma_deg.constant().is_some()
    }
}
