//! The metallic-roughness model of glTF 2.0 (Khronos 2021, "glTF 2.0 Specification", appendix B), made to keep the
//! laws.
//!
//! A surface is metal of the base colour to the share m, else a diffuse base under a rough coat of reflectance F0 =
//! 0.04. Facets are those of GGX with `alpha = roughness²`, and Fresnel is Schlick's `F = F0 + (1 - F0)(1 - wo·h)⁵`.
//! Since F is linear in F0, one lobe of `F0 = (1 - m) 0.04 + m base` serves both; later bounces among facets are
//! added as in [`CompensatedConductor`](super::CompensatedConductor).
//!
//! glTF leaves open how diffuse light is dimmed by the coat. Here it is what the coat does not reflect, on its way in
//! and out: `f_d = (1 - m) base (1 - S(wo)) (1 - S(wi)) / (pi (1 - S_avg))`, where S is the albedo of the coat, `F0
//! (E - B) + B` and later bounces, from tables of the model's own integrals (Kulla and Conty 2017). That is
//! reciprocal, and a white surface loses nothing.

use std::f32::consts::FRAC_1_PI;

use etendue_math::{Point2, Vector3, sqr, warp};
use etendue_spectrum::Sampled;

use super::FacetShape;
use super::energy::{EnergyTable, Row};
use crate::bsdf::classic::lobed::{Lobed, Shares};
use crate::bsdf::fresnel::{reflect, schlick_weight};
use crate::bsdf::microfacet::Microfacets;

/// A glTF surface in the shading frame.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Principled {
    microfacets: Microfacets,
    /// Alpha in the tables, which widening for rough paths does not change.
    row: Row,
    /// Reflectance of the coat along the normal.
    coat_f0: f32,
    /// `F_ms` of the coat: later bounces.
    coat_later: f32,
    /// Reflectance of facets along the normal, of coat and metal together.
    f0: Sampled,
    /// `F_ms / (pi (1 - E_avg))` of both together.
    later: Sampled,
    /// `(1 - m) base / (pi (1 - S_avg))`.
    diffuse: Sampled,
}

/// `2 ∫ F cos d cos` of Schlick's fit.
pub(super) fn mean_of_schlick(f0: f32) -> f32 {
    (20.0 * f0 + 1.0) / 21.0
}

/// What remains of white later bounces: `F_avg² E_avg / (1 - F_avg (1 - E_avg))` [Kulla and Conty 2017].
pub(super) fn later_bounces(f: f32, mean: f32) -> f32 {
    sqr(f) * mean / (1.0 - f * (1.0 - mean))
}

impl Principled {
    /// Of the base colour in [0, 1], the share of metal, the roughness whose square is alpha, and the index of the
    /// coat.
    #[must_use]
    pub fn new(base: Sampled, metallic: f32, roughness: f32, eta: f32) -> Self {
        // A mirror would be another lobe; this is as narrow as pictures can tell.
        let alpha = sqr(roughness).max(2.0 * Microfacets::SMOOTH_BELOW);
        let table = EnergyTable::of(FacetShape::Ggx);
        let mean = table.mean(alpha);
        let coat_f0 = sqr((eta - 1.0) / (eta + 1.0));
        let coat_later = later_bounces(mean_of_schlick(coat_f0), mean);
        let lost = (1.0 - mean).max(1e-6);
        let later = base
            .map(|f0| (1.0 - metallic) * coat_later + metallic * later_bounces(mean_of_schlick(f0), mean));
        let s_mean =
            coat_f0 * (mean - table.grazing_mean(alpha)) + table.grazing_mean(alpha) + coat_later * lost;
        Self {
            microfacets: Microfacets::new(alpha, alpha),
            row: Row::of(alpha),
            coat_f0,
            coat_later,
            f0: base * metallic + Sampled::splat((1.0 - metallic) * coat_f0),
            later: later * (FRAC_1_PI / lost),
            diffuse: base * ((1.0 - metallic) * FRAC_1_PI / (1.0 - s_mean).max(1e-6)),
        }
    }

    /// Reflectance along the normal, of coat and metal together.
    #[must_use]
    pub const fn f0(&self) -> Sampled {
        self.f0
    }

    /// With rougher facets where they are narrow.
    pub(super) fn regularized(self) -> Self {
        Self { microfacets: self.microfacets.regularized(), ..self }
    }

    pub(super) fn mean_alpha(&self) -> f32 {
        self.microfacets.mean_alpha()
    }

    /// `1 - E` of a direction.
    fn lost(&self, cos: f32) -> f32 {
        1.0 - EnergyTable::of(FacetShape::Ggx).albedo_in(cos, self.row)
    }

    /// `1 - S` of a direction: what the coat lets pass.
    fn passed(&self, cos: f32) -> f32 {
        let table = EnergyTable::of(FacetShape::Ggx);
        let (e, b) = table.albedos_in(cos, self.row);
        (1.0 - (self.coat_f0 * (e - b) + b + self.coat_later * (1.0 - e))).max(0.0)
    }
}

impl Lobed for Principled {
    fn diffuse(&self, to: Vector3, from: Vector3) -> Sampled {
        self.diffuse * (self.passed(to.z) * self.passed(from.z))
    }

    fn glossy(&self, to: Vector3, from: Vector3) -> Sampled {
        let Some(h) = (to + from).try_normalized() else { return Sampled::ZERO };
        let fresnel = self.f0 + (Sampled::ONE - self.f0) * schlick_weight(to.dot(h));
        let once = 0.25 * self.microfacets.d(h) * self.microfacets.g_over_cosines(to, from);
        fresnel * once + self.later * (self.lost(to.z) * self.lost(from.z))
    }

    fn shares(&self, wo: Vector3) -> Shares {
        let fresnel = self.f0 + (Sampled::ONE - self.f0) * schlick_weight(wo.z);
        let diffuse = self.diffuse.max_value() / FRAC_1_PI;
        let share = if diffuse > 0.0 { (diffuse * self.passed(wo.z)).max(1e-3) } else { 0.0 };
        Shares { diffuse: share, glossy: fresnel.max_value().max(0.05), mirror: 0.0 }
    }

    /// One bounce with the probability E, else evenly.
    fn sample_glossy(&self, wo: Vector3, u_choice: f32, u: Point2) -> Option<Vector3> {
        if u_choice < self.lost(wo.z) {
            return Some(warp::sample_cosine_hemisphere(u));
        }
        Some(reflect(wo, self.microfacets.sample_visible_normal(wo, u)))
    }

    fn glossy_pdf(&self, wo: Vector3, wi: Vector3) -> f32 {
        let Some(h) = (wo + wi).try_normalized() else { return 0.0 };
        let lost = self.lost(wo.z);
        let once = self.microfacets.visible_normal_pdf(wo, h) / (4.0 * wo.dot(h));
        lost * FRAC_1_PI * wi.z + (1.0 - lost) * once
    }

    fn alpha(&self) -> f32 {
        self.mean_alpha()
    }
}
