//! Perturbed shading frames, which make a flat surface look as if it had small relief.

use std::sync::Arc;

use super::bump::bump;
use super::normal_map::{NormalMap, NormalMapId, perturb_by_texture};
use super::{MaterialContext, Materials};
use crate::parameters::{Parameters, SpectrumRole};
use crate::texture::{FloatTexture, SpectrumTexture, SpectrumTextureId, Textures};

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
    /// A texture `imagemap` of normals, whose x and y count `scale` times; other kinds change nothing.
    NormalTexture {
        /// The texture.
        texture: SpectrumTextureId,
        /// Strength of the relief.
        scale: f32,
    },
}

impl Perturbation {
    pub(super) fn build(p: &mut Parameters<'_, '_>, materials: &mut Materials) -> Self {
        let height = p.float_texture_opt("displacement");
        if !p.has("normalmap") {
            return height.map_or(Self::None, Self::Bump);
        }
        if height.is_some() {
            let span = p.span_of("displacement");
            p.diagnostics().warning(span, "\"displacement\" is ignored: \"normalmap\" is given too");
        }
        Self::build_normal_map(p, "normalmap", materials).unwrap_or_default()
    }

    /// The image of normals that a parameter names, if it does and there is one.
    pub(super) fn build_normal_map(
        p: &mut Parameters<'_, '_>,
        name: &'static str,
        materials: &mut Materials,
    ) -> Option<Self> {
        let file = p.string_opt(name)?;
        // An image that could not be read has been reported by its reader.
        let texels = p.context.assets.images.get(&file)?;
        let Some(map) = NormalMap::new(Arc::clone(texels)) else {
            let span = p.span_of(name);
            p.diagnostics().error(span, format!("the normal map \"{file}\" needs three channels"));
            return None;
        };
        Some(Self::NormalMap(materials.add_normal_map(map)))
    }

    /// The texture of normals that the first parameter names, with the strength that the second gives.
    pub(super) fn build_normal_texture(
        p: &mut Parameters<'_, '_>,
        name: &'static str,
        scale: &'static str,
    ) -> Option<Self> {
        let scale = p.float(scale, 1.0);
        let texture = p.spectrum_texture_opt(name, SpectrumRole::Unbounded)?;
        if let SpectrumTexture::Node(texture) = texture {
            return Some(Self::NormalTexture { texture, scale });
        }
        let span = p.span_of(name);
        p.diagnostics().error(span, format!("\"{name}\" must be a texture \"imagemap\""));
        None
    }

    /// The context with the perturbed shading frame; `None` if nothing perturbs it.
    #[inline]
    pub(super) fn apply(
        &self,
        materials: &Materials,
        textures: &Textures,
        ctx: &MaterialContext,
    ) -> Option<MaterialContext> {
        match *self {
            Self::None => None,
            Self::Bump(height) => Some(bump(height, textures, ctx)),
            Self::NormalMap(id) => Some(materials.normal_map(id).perturb(ctx)),
            Self::NormalTexture { texture, scale } => Some(perturb_by_texture(texture, scale, textures, ctx)),
        }
    }
}
