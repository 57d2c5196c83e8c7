//! Perturbed shading frames, which make a flat surface look as if it had small relief.

use crate::texture::{FloatTexture, Textures};

use super::bump::bump;
use super::normal_map::NormalMapId;
use super::{MaterialContext, Materials};
use crate::parameters::Parameters;

/// What perturbs the shading normal.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub enum Perturbation {
    /// Nothing.
    #[default]
    None,
    /// The slope of a height field, in metres along the normal.
    Bump(FloatTexture),
    /// An image of normals.
    NormalMap(NormalMapId),
}

impl Perturbation {
    pub(super) fn build(p: &mut Parameters<'_, '_>, materials: &mut Materials) -> Self {
        let height = p.float_texture_opt("displacement");
        if let Some(file) = p.string_opt("normalmap") {
            if height.is_some() {
                let span = p.span_of("displacement");
                p.diagnostics().warning(span, "\"displacement\" is ignored: \"normalmap\" is given too");
            }
            return materials.load_normal_map(p, &file).map_or(Self::None, Self::NormalMap);
        }
        height.map_or(Self::None, Self::Bump)
    }

    /// The context with the perturbed shading frame.
    #[inline]
    pub(super) fn apply(
        &self,
        materials: &Materials,
        textures: &Textures,
        ctx: &MaterialContext,
    ) -> MaterialContext {
        match *self {
            Self::None => *ctx,
            Self::Bump(height) => bump(height, textures, ctx),
            Self::NormalMap(id) => materials.normal_map(id).perturb(ctx),
        }
    }
}
