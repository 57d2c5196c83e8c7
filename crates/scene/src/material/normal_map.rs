//! Normal mapping: shading normals from an image, whose red, green and blue are x, y, z in the tangent frame, each
//! mapped from [-1, 1] to [0, 1] without further encoding (Cohen, Olano and Manocha 1998, "Appearance-Preserving
//! Simplification"). The image repeats and its top row is v = 1.

use std::sync::Arc;

use etendue_image::Texels;
use etendue_math::{Frame, Point2, Vector3};

use super::MaterialContext;
use crate::texture::{SpectrumTextureId, SpectrumTextureNode, Textures};

/// Index of a normal map in [`Materials`](super::Materials).
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct NormalMapId(pub u32);

/// An image of tangent-space normals.
#[derive(Clone, Debug)]
pub struct NormalMap {
    texels: Arc<Texels>,
}

impl NormalMap {
    /// From an image of at least three channels; `None` if it has fewer or no pixels.
    #[must_use]
    pub fn new(texels: Arc<Texels>) -> Option<Self> {
        let is_usable = texels.n_channels() >= 3 && texels.width() > 0 && texels.height() > 0;
        is_usable.then_some(Self { texels })
    }

    /// True if both are the same image in memory.
    pub(super) fn shares_image_with(&self, other: &Self) -> bool {
        Arc::ptr_eq(&self.texels, &other.texels)
    }

    /// The unit normal in the tangent frame, interpolated between texels.
    #[must_use]
    pub fn normal(&self, uv: Point2) -> Vector3 {
        let (width, height) = (self.texels.width(), self.texels.height());
        let x = uv.x * width as f32 - 0.5;
        let y = (1.0 - uv.y) * height as f32 - 0.5;
        let (x0, y0) = (x.floor(), y.floor());
        let (fx, fy) = (x - x0, y - y0);
        let texel = |dx: i64, dy: i64| {
            let column = (x0 as i64 + dx).rem_euclid(width as i64) as usize;
            let row = (y0 as i64 + dy).rem_euclid(height as i64) as usize;
            self.texel(column, row)
        };
        let top = texel(0, 0).lerp(texel(1, 0), fx);
        let bottom = texel(0, 1).lerp(texel(1, 1), fx);
        top.lerp(bottom, fy).try_normalized().unwrap_or(Vector3::new(0.0, 0.0, 1.0))
    }

    fn texel(&self, x: usize, y: usize) -> Vector3 {
        let channel = |c| 2.0 * self.texels.texel(x, y, c) - 1.0;
        Vector3::new(channel(0), channel(1), channel(2))
    }

    /// The context with the shading frame of the mapped normal; tangents keep their lengths.
    pub(super) fn perturb(&self, ctx: &MaterialContext) -> MaterialContext {
        let frame = Frame::from_zx(ctx.ns.as_vector(), ctx.shading_dpdu);
        let ns = frame.to_world(self.normal(ctx.texture.uv)).normalized();
        let x = Frame::from_zx(ns, ctx.shading_dpdu).x;
        let dpdu = x * ctx.shading_dpdu.length();
        let dpdv = ns.cross(x) * ctx.shading_dpdv.length();
        ctx.with_tangents(dpdu, dpdv)
    }
}

/// The context with the shading frame of the normal that a texture gives. Other than in [`NormalMap::perturb`], which
/// follows pbrt, green runs along v where texture coordinates are mirrored too, as glTF has it.
pub(super) fn perturb_by_texture(
    texture: SpectrumTextureId,
    scale: f32,
    textures: &Textures,
    ctx: &MaterialContext,
) -> MaterialContext {
    let SpectrumTextureNode::Image(image) = textures.spectrum_node(texture) else { return *ctx };
    let [x, y, z] = image
        .texture
        .eval_rgb(textures.image(image.texture.image), &ctx.texture)
        .map(|value| 2.0 * value - 1.0);
    let mut frame = Frame::from_zx(ctx.ns.as_vector(), ctx.shading_dpdu);
    if frame.y.dot(ctx.dpdv) < 0.0 {
        frame.y = -frame.y;
    }
    let normal = frame.x * (scale * x) + frame.y * (scale * y) + frame.z * z;
    let Some(ns) = normal.try_normalized() else { return *ctx };
    let x = Frame::from_zx(ns, ctx.shading_dpdu).x;
    let dpdu = x * ctx.shading_dpdu.length();
    ctx.with_tangents(dpdu, ns.cross(x) * ctx.shading_dpdv.length())
}
