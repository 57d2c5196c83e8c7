//! Where a material is evaluated.

use etendue_geometry::{SurfaceDerivatives, SurfacePoint};
use etendue_math::{Normal3, Vector3};

use crate::texture::TextureContext;

/// The point at which a material is evaluated.
#[derive(Clone, Copy, Debug)]
pub struct MaterialContext {
    /// Where textures are evaluated.
    pub texture: TextureContext,
    /// Unit vector towards the viewer.
    pub wo: Vector3,
    /// Geometric unit normal.
    pub ng: Normal3,
    /// Shading unit normal.
    pub ns: Normal3,
    /// Change of the position with v.
    pub dpdv: Vector3,
    /// First shading tangent.
    pub shading_dpdu: Vector3,
    /// Second shading tangent.
    pub shading_dpdv: Vector3,
    /// Change of the shading normal with u.
    pub dndu: Vector3,
    /// Change of the shading normal with v.
    pub dndv: Vector3,
}

impl MaterialContext {
    /// From a point of a surface.
    #[inline]
    #[must_use]
    pub fn new(
        texture: TextureContext,
        point: &SurfacePoint,
        derivatives: &SurfaceDerivatives,
        wo: Vector3,
    ) -> Self {
        Self {
            texture,
            wo,
            ng: point.ng,
            ns: point.ns,
            dpdv: derivatives.dpdv,
            shading_dpdu: derivatives.shading_dpdu,
            shading_dpdv: derivatives.shading_dpdv,
            dndu: derivatives.dndu,
            dndv: derivatives.dndv,
        }
    }

    /// From a point of a surface whose material needs no derivatives.
    #[inline]
    #[must_use]
    pub fn uniform(point: &SurfacePoint, wo: Vector3) -> Self {
        Self::new(TextureContext::at(point), point, &SurfaceDerivatives::default(), wo)
    }

    /// With other shading tangents; their cross product becomes the normal, on the side of the geometric normal.
    /// Tangents that span no plane change nothing.
    pub(super) fn with_tangents(&self, dpdu: Vector3, dpdv: Vector3) -> Self {
        let Some(ns) = dpdu.cross(dpdv).try_normalized() else { return *self };
        let ns = ns.as_normal().facing(self.ng.as_vector());
        Self { ns, shading_dpdu: dpdu, shading_dpdv: dpdv, ..*self }
    }
}
