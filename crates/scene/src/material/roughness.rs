//! Roughness of an interface as scene files give it.

use super::limits::{self, PerTangent};
use crate::bsdf::microfacet::Microfacets;
use crate::parameters::Parameters;
use crate::texture::{FloatTexture, TextureContext, Textures};

/// How the number in the scene becomes a GGX alpha.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum RoughnessScale {
    /// Alpha is the square root of the number, so that equal steps look about equal.
    Perceptual,
    /// The number is alpha.
    Alpha,
}

/// Roughness along both tangents.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Roughness {
    /// Along the first tangent.
    pub u: FloatTexture,
    /// Along the second tangent.
    pub v: FloatTexture,
    /// Meaning of both numbers.
    pub scale: RoughnessScale,
}

/// The names of the parameters that give the roughness of one interface.
pub(super) struct RoughnessNames {
    pub(super) both: &'static str,
    pub(super) u: &'static str,
    pub(super) v: &'static str,
}

impl RoughnessNames {
    pub(super) const PLAIN: Self = Self { both: "roughness", u: "uroughness", v: "vroughness" };
    pub(super) const COAT: Self =
        Self { both: "interface.roughness", u: "interface.uroughness", v: "interface.vroughness" };
    pub(super) const BASE: Self =
        Self { both: "conductor.roughness", u: "conductor.uroughness", v: "conductor.vroughness" };
}

impl Roughness {
    /// A smooth interface.
    pub const SMOOTH: Self =
        Self { u: FloatTexture::Constant(0.0), v: FloatTexture::Constant(0.0), scale: RoughnessScale::Alpha };

    /// The same roughness along both tangents.
    #[must_use]
    pub const fn isotropic(roughness: FloatTexture, scale: RoughnessScale) -> Self {
        Self { u: roughness, v: roughness, scale }
    }

    pub(super) fn build(p: &mut Parameters<'_, '_>, names: &RoughnessNames) -> Self {
        let PerTangent { u, v } =
            PerTangent::build(p, [names.both, names.u, names.v], 0.0, limits::ROUGHNESSES);
        let scale =
            if p.bool("remaproughness", true) { RoughnessScale::Perceptual } else { RoughnessScale::Alpha };
        Self { u, v, scale }
    }

    /// The facets at a point.
    #[inline]
    #[must_use]
    pub fn microfacets(&self, textures: &Textures, ctx: &TextureContext) -> Microfacets {
        let (u, v) = (textures.eval_float(self.u, ctx), textures.eval_float(self.v, ctx));
        match self.scale {
            RoughnessScale::Perceptual => {
                Microfacets::new(Microfacets::alpha_from_roughness(u), Microfacets::alpha_from_roughness(v))
            }
            RoughnessScale::Alpha => Microfacets::new(u.max(0.0), v.max(0.0)),
        }
    }
}
