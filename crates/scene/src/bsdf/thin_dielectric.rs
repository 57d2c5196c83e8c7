//! A pane of clear glass too thin to displace light: it reflects, or passes light straight on.
//!
//! Light that bounces inside leaves with it: with R of one face and T = 1 - R, all orders sum to
//! `R' = R + T² R / (1 - R²)` and `T' = 1 - R'` (Stokes 1862). Absorption is neglected.

use etendue_math::{Vector3, sqr};
use etendue_spectrum::Sampled;

use super::fresnel::fresnel_dielectric;
use super::local::{abs_cos, mirror};
use super::{BsdfSample, Lobes};

/// A thin pane in the shading frame.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ThinDielectric {
    /// Index of the pane relative to the surroundings on both sides.
    pub eta: f32,
}

impl ThinDielectric {
    /// The lobes present.
    #[inline]
    #[must_use]
    pub fn lobes(&self) -> Lobes {
        Lobes::SPECULAR
    }

    /// Fraction of light reflected by both faces together.
    #[inline]
    #[must_use]
    pub fn reflectance(&self, cos: f32) -> f32 {
        let r = fresnel_dielectric(cos.abs(), self.eta);
        if r < 1.0 { r + sqr(1.0 - r) * r / (1.0 - sqr(r)) } else { r }
    }

    /// Reflection or passage by `u_component`.
    #[inline]
    #[must_use]
    pub fn sample(&self, wo: Vector3, u_component: f32, lobes: Lobes) -> Option<BsdfSample> {
        let r = self.reflectance(abs_cos(wo));
        let p_reflect = if lobes.contains(Lobes::SPECULAR_REFLECT) { r } else { 0.0 };
        let p_transmit = if lobes.contains(Lobes::SPECULAR_TRANSMIT) { 1.0 - r } else { 0.0 };
        let total = p_reflect + p_transmit;
        if total <= 0.0 {
            return None;
        }
        // Both weights are the same: each is its fraction over its probability.
        let weight = Sampled::splat(total);
        let p_reflect = p_reflect / total;
        if u_component < p_reflect {
            Some(BsdfSample::specular(mirror(wo), weight, p_reflect, Lobes::SPECULAR_REFLECT, 1.0))
        } else {
            Some(BsdfSample::specular(-wo, weight, 1.0 - p_reflect, Lobes::SPECULAR_TRANSMIT, 1.0))
        }
    }
}
