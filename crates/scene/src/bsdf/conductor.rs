//! Metal: mirror facets with the Fresnel reflectance of a complex index of refraction.
//!
//! `f = D(wm) F(wo·wm) G(wo, wi) / (4 |cos_o| |cos_i|)` with the half vector `wm` (Torrance and Sparrow 1967, "Theory
//! for Off-Specular Reflection From Roughened Surfaces"; Cook and Torrance 1982). This is SPEC BRDF-16 with GGX and
//! Smith's shadowing in place of Gaussian slopes and V-grooves; see [`super::microfacet`] for what is lost. Other facets are
//! a parameter.

use etendue_math::{Point2, Vector3, sqr};
use etendue_spectrum::Sampled;

use super::facetted::Facets;
use super::local::{mirror, same_hemisphere};
use super::microfacet::Microfacets;
use super::{BsdfSample, Lobes};

/// A smooth or rough metal in the shading frame.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Conductor<F = Microfacets> {
    /// Roughness.
    pub microfacets: F,
    /// Real part of the index relative to the outside.
    pub eta: Sampled,
    /// Imaginary part of the index (absorption) relative to the outside.
    pub k: Sampled,
}

impl<F: Facets> Conductor<F> {
    /// The lobe present.
    #[inline]
    #[must_use]
    pub fn lobes(&self) -> Lobes {
        if self.microfacets.is_smooth() { Lobes::SPECULAR_REFLECT } else { Lobes::GLOSSY_REFLECT }
    }

    /// f in 1/sr, without the cosine.
    #[inline]
    #[must_use]
    pub fn eval(&self, wo: Vector3, wi: Vector3, lobes: Lobes) -> Sampled {
        self.eval_and_pdf(wo, wi, lobes).0
    }

    /// [`Self::eval`] and [`Self::pdf`] together, which have most in common.
    #[inline]
    #[must_use]
    pub fn eval_and_pdf(&self, wo: Vector3, wi: Vector3, lobes: Lobes) -> (Sampled, f32) {
        let Some(sum) = self.sum(wo, wi, lobes) else { return (Sampled::ZERO, 0.0) };
        let (reflection, pdf_w) = self.microfacets.reflection(wo, wi, sum);
        let cos2 = 0.25 * sum.length_squared();
        (self.microfacets.metal_reflectance(cos2, self.eta, self.k) * reflection, pdf_w) // [SPEC BRDF-16]
    }

    /// The mirror direction of a facet visible from `wo`.
    #[inline]
    #[must_use]
    pub fn sample(&self, wo: Vector3, u: Point2, lobes: Lobes) -> Option<BsdfSample> {
        if !lobes.intersects(self.lobes()) {
            return None;
        }
        if self.microfacets.is_smooth() {
            let fresnel = self.microfacets.metal_reflectance(sqr(wo.z), self.eta, self.k);
            return Some(BsdfSample::specular(mirror(wo), fresnel, 1.0, Lobes::SPECULAR_REFLECT, 1.0));
        }
        // Mirroring and Fresnel's equations need no unit vector.
        let wm = self.microfacets.sample_facet(wo, u);
        let (dot, length2) = (wo.dot(wm), wm.length_squared());
        let share = dot / length2;
        let wi = wm * (2.0 * share) - wo; // [SPEC FRES-1]
        if !same_hemisphere(wo, wi) {
            return None;
        }
        let (_, pdf_w) = self.microfacets.reflection(wo, wi, wm);
        (pdf_w > 0.0 && pdf_w.is_finite()).then(|| BsdfSample {
            wi,
            weight: self.microfacets.metal_reflectance(dot * share, self.eta, self.k)
                * self.microfacets.g_over_g1(wo, wi),
            pdf_w,
            pmf: 0.0,
            lobe: Lobes::GLOSSY_REFLECT,
            eta: 1.0,
            roughness: self.microfacets.mean_alpha(),
        })
    }

    /// Density of [`Self::sample`] in 1/sr.
    #[inline]
    #[must_use]
    pub fn pdf(&self, wo: Vector3, wi: Vector3, lobes: Lobes) -> f32 {
        let Some(sum) = self.sum(wo, wi, lobes) else { return 0.0 };
        self.microfacets.reflection(wo, wi, sum).1
    }

    /// `wo + wi`, which is normal to the facet that reflects one to the other and `2 cos` long; `None` if nothing glossy
    /// happens.
    #[inline]
    fn sum(&self, wo: Vector3, wi: Vector3, lobes: Lobes) -> Option<Vector3> {
        if self.microfacets.is_smooth() || !lobes.contains(Lobes::GLOSSY_REFLECT) || !same_hemisphere(wo, wi)
        {
            return None;
        }
        let sum = wo + wi;
        // Of opposite directions rounding alone is left.
        (sum.length_squared() > 1e-18).then_some(sum)
    }
}
