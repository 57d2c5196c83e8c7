//! A clear coat over everything else (glTF's `KHR_materials_clearcoat`): GGX facets of index 1.5 with Schlick's fit, to
//! a share, with a normal of their own.
//!
//! What the coat does not reflect, `1 - S` with its albedo S, goes on; light that bounces among its facets thus reaches
//! what is below. Where the coat's normal n is not that of the base, f is damped by `min(1, w·n / w_z)` for both directions:
//! cosines are counted to the normal of the base, and the coat would else make light.

use etendue_math::{Frame, Point2, Vector3};

use super::super::FacetShape;
use super::super::energy::EnergyTable;
use crate::bsdf::fresnel::{reflect, schlick_weight};
use crate::bsdf::microfacet::Microfacets;

/// Reflectance along the normal.
const F0: f32 = 0.04;

/// A coat in the shading frame of the base.
#[derive(Clone, Copy, Debug)]
pub(super) struct Coat {
    /// Share of the surface that is coated.
    pub(super) share: f32,
    pub(super) facets: Microfacets,
    /// Alpha of the tables, which widening does not change.
    pub(super) alpha: f32,
    /// Unit normal.
    pub(super) normal: Vector3,
}

impl Coat {
    pub(super) fn is_tilted(&self) -> bool {
        self.normal.z < 1.0
    }

    fn local(&self, w: Vector3) -> Vector3 {
        if self.is_tilted() { Frame::from_z(self.normal).to_local(w) } else { w }
    }

    /// f in 1/sr.
    pub(super) fn eval(&self, to: Vector3, from: Vector3) -> f32 {
        let (a, b) = (self.local(to), self.local(from));
        let Some(h) = (a + b).try_normalized().filter(|_| a.z > 0.0 && b.z > 0.0) else { return 0.0 };
        let damped = (a.z / to.z).min(1.0) * (b.z / from.z).min(1.0);
        let fresnel = F0 + (1.0 - F0) * schlick_weight(a.dot(h));
        self.share * fresnel * 0.25 * self.facets.d(h) * self.facets.g_over_cosines(a, b) * damped
    }

    /// Albedo, but for what tilt takes away.
    pub(super) fn albedo(&self, w: Vector3) -> f32 {
        if self.share == 0.0 {
            return 0.0;
        }
        let (table, cos) = (EnergyTable::of(FacetShape::Ggx), self.local(w).z.max(0.0));
        let (e, b) = table.albedos(cos, self.alpha);
        self.share * (F0 * (e - b) + b)
    }

    /// What goes on.
    pub(super) fn passed(&self, w: Vector3) -> f32 {
        1.0 - self.albedo(w)
    }

    /// The mirror direction of a facet visible from `wo`.
    pub(super) fn sample(&self, wo: Vector3, u: Point2) -> Option<Vector3> {
        let a = self.local(wo);
        let b = (a.z > 0.0).then(|| reflect(a, self.facets.sample_visible_normal(a, u)))?;
        Some(if self.is_tilted() { Frame::from_z(self.normal).to_world(b) } else { b })
    }

    /// Density of [`Self::sample`] in 1/sr.
    pub(super) fn pdf(&self, wo: Vector3, wi: Vector3) -> f32 {
        let (a, b) = (self.local(wo), self.local(wi));
        let Some(h) = (a + b).try_normalized().filter(|h| a.z > 0.0 && h.z > 0.0) else { return 0.0 };
        self.facets.visible_normal_pdf(a, h) / (4.0 * a.dot(h))
    }
}
