//! Brushed metal, by Poulin and Fournier.

use etendue_spectrum::Wavelengths;

use super::LobeColors;
use crate::bsdf::Classic;
use crate::bsdf::classic::PoulinFournier;
use crate::material::{MaterialContext, limits, spec};
use crate::parameters::{ParameterSpec, Parameters};
use crate::texture::{FloatTexture, Textures};

/// Parameters of `poulinfournier`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PoulinFournierMaterial {
    /// Of the material of the cylinders.
    pub colors: LobeColors,
    /// Of its highlight.
    pub exponent: FloatTexture,
    /// Distance of neighbouring axes in radii.
    pub spacing: FloatTexture,
    /// How far cylinders rise above the floor, in radii.
    pub height: FloatTexture,
}

const SPACINGS: [f32; 2] = [0.01, 1e4];

impl PoulinFournierMaterial {
    /// What scene files may say.
    pub const PARAMETERS: &'static [ParameterSpec] = &[
        LobeColors::KD,
        LobeColors::KS,
        spec::EXPONENT_100,
        ParameterSpec {
            name: "spacing",
            kind: "float texture",
            default: "2",
            unit: "radii",
            doc: "Distance of the axes of neighbouring cylinders, which lie along the first tangent; at 2 they touch.",
        },
        ParameterSpec {
            name: "height",
            kind: "float texture",
            default: "1",
            unit: "radii",
            doc: "How far cylinders rise above the floor, 0 to 1; 0 is a flat floor.",
        },
        spec::DISPLACEMENT,
        spec::NORMAL_MAP,
    ];

    pub(super) fn build(p: &mut Parameters<'_, '_>) -> Self {
        Self {
            colors: LobeColors::build(p),
            exponent: limits::float_within(p, "exponent", 100.0, limits::EXPONENTS),
            spacing: limits::float_within(p, "spacing", 2.0, SPACINGS),
            height: limits::float_within(p, "height", 1.0, limits::SHARES),
        }
    }

    pub(super) fn bsdf(&self, textures: &Textures, ctx: &MaterialContext, lambda: &Wavelengths) -> Classic {
        let (kd, ks) = self.colors.at(textures, ctx, lambda);
        let within = |texture, range| limits::clamp(textures.eval_float(texture, &ctx.texture), range);
        Classic::PoulinFournier(PoulinFournier {
            kd,
            ks,
            exponent: within(self.exponent, limits::EXPONENTS),
            spacing: within(self.spacing, SPACINGS),
            height: within(self.height, limits::SHARES),
        })
    }

    /// Never: the cylinders have a direction.
    #[expect(clippy::unused_self, reason = "asked of all models alike")]
    pub(super) const fn is_uniform(&self) -> bool {
        false
    }
}
