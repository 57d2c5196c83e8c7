//! A diffuse surface with Blinn's highlight.

use etendue_spectrum::Wavelengths;

use super::LobeColors;
use crate::bsdf::Classic;
use crate::bsdf::classic::BlinnPhong;
use crate::material::{MaterialContext, limits, spec};
use crate::parameters::{ParameterSpec, Parameters};
use crate::texture::{FloatTexture, Textures};

/// Parameters of `blinnphong`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BlinnPhongMaterial {
    /// Of diffuse part and highlight.
    pub colors: LobeColors,
    /// Of the highlight.
    pub exponent: FloatTexture,
}

impl BlinnPhongMaterial {
    /// What scene files may say.
    pub const PARAMETERS: &'static [ParameterSpec] = &[
        LobeColors::KD,
        LobeColors::KS,
        LobeColors::AMBIENT,
        spec::EXPONENT,
        spec::DISPLACEMENT,
        spec::NORMAL_MAP,
    ];

    pub(super) fn build(p: &mut Parameters<'_, '_>) -> Self {
        Self {
            colors: LobeColors::build(p),
            exponent: limits::float_within(p, "exponent", 30.0, limits::EXPONENTS),
        }
    }

    pub(super) fn bsdf(&self, textures: &Textures, ctx: &MaterialContext, lambda: &Wavelengths) -> Classic {
        let (kd, ks) = self.colors.at(textures, ctx, lambda);
        let exponent = limits::clamp(textures.eval_float(self.exponent, &ctx.texture), limits::EXPONENTS);
        Classic::BlinnPhong(BlinnPhong { kd, ks, exponent })
    }

    pub(super) const fn is_uniform(&self) -> bool {
        self.colors.is_constant() && self.exponent.constant().is_some()
    }
}
