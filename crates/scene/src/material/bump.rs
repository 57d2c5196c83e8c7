//! Bump mapping: the shading frame of a surface that a height field d would displace along its normal.
//!
//! `dp'/du = dp/du + (dd/du) n + d dn/du`, likewise for v, and the new normal is their cross product; derivatives of d are
//! differences over half a pixel (Blinn 1978, "Simulation of Wrinkled Surfaces", SIGGRAPH). The surface itself does not
//! move: silhouettes and shadows stay smooth.

use etendue_math::{Point2, Vector3};

use super::MaterialContext;
use crate::texture::{FloatTexture, TextureContext, Textures};

/// Parameter distance of the difference where the size of a pixel is unknown.
const DEFAULT_STEP: f32 = 0.0005;

/// The context with the shading frame that follows the height field.
pub(super) fn bump(height: FloatTexture, textures: &Textures, ctx: &MaterialContext) -> MaterialContext {
    let at = ctx.texture;
    let d = textures.eval_float(height, &at);
    let slope = |step: f32, dp: Vector3, duv: Point2| {
        let shifted = TextureContext {
            p: at.p + dp * step,
            uv: Point2::new(at.uv.x + duv.x * step, at.uv.y + duv.y * step),
            ..at
        };
        (textures.eval_float(height, &shifted) - d) / step
    };
    let du = step_of_pixel(at.dudx, at.dudy);
    let dv = step_of_pixel(at.dvdx, at.dvdy);
    let n = ctx.ns.as_vector();
    let dddu = slope(du, ctx.shading_dpdu, Point2::new(1.0, 0.0));
    let dddv = slope(dv, ctx.shading_dpdv, Point2::new(0.0, 1.0));
    let dpdu = ctx.shading_dpdu + n * dddu + ctx.dndu * d; // [Blinn 1978]
    let dpdv = ctx.shading_dpdv + n * dddv + ctx.dndv * d;
    ctx.with_tangents(dpdu, dpdv)
}

fn step_of_pixel(dx: f32, dy: f32) -> f32 {
    let step = 0.5 * (dx.abs() + dy.abs());
    if step > 0.0 && step.is_finite() { step } else { DEFAULT_STEP }
}
