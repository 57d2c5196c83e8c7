//! Metal: mirror facets with the Fresnel reflectance of a complex index of refraction.
//!
//! `f = D(wm) F(wo·wm) G(wo, wi) / (4 |cos_o| |cos_i|)` with the half vector `wm` (Torrance and Sparrow 1967, "Theory
//! for Off-Specular Reflection From Roughened Surfaces"; Cook and Torrance 1982). This is SPEC BRDF-16 with GGX and
//! Smith's shadowing in place of Gaussian slopes and V-grooves; see [`super::microfacet`] for what is lost. Other facets are
//! a parameter.

use etendue_math::{Point2, Vector3};
use etendue_spectrum::Sampled;

use super::facetted::Facets;
use super::fresnel::reflect;
use super::local::{abs_cos, mirror, same_hemisphere};
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
        let Some(wm) = self.half_vector(wo, wi, lobes) else { return (Sampled::ZERO, 0.0) };
        let (reflection, pdf_w) = self.microfacets.reflection(wo, wi, wm);
        (self.microfacets.metal_reflectance(wo.dot(wm), self.eta, self.k) * reflection, pdf_w) // [SPEC BRDF-16]
    }

    /// The mirror direction of a facet visible from `wo`.
    #[inline]
    #[must_use]
    pub fn sample(&self, wo: Vector3, u: Point2, lobes: Lobes) -> Option<BsdfSample> {
        if !lobes.intersects(self.lobes()) {
            return None;
        }
        if self.microfacets.is_smooth() {
            let fresnel = self.microfacets.metal_reflectance(abs_cos(wo), self.eta, self.k);
            return Some(BsdfSample::specular(mirror(wo), fresnel, 1.0, Lobes::SPECULAR_REFLECT, 1.0));
        }
        let wm = self.microfacets.sample_visible_normal(wo, u);
        let wi = reflect(wo, wm);
        if !same_hemisphere(wo, wi) {
            return None;
        }
        let cos_m = wo.dot(wm).abs();
        let (_, pdf_w) = self.microfacets.reflection(wo, wi, wm);
        (pdf_w > 0.0 && pdf_w.is_finite()).then(|| BsdfSample {
            wi,
            weight: self.microfacets.metal_reflectance(cos_m, self.eta, self.k)
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
        let Some(wm) = self.half_vector(wo, wi, lobes) else { return 0.0 };
        self.microfacets.reflection(wo, wi, wm).1
    }

    /// The facet normal that reflects `wo` to `wi`, in the upper hemisphere; `None` if nothing glossy happens.
    #[inline]
    fn half_vector(&self, wo: Vector3, wi: Vector3, lobes: Lobes) -> Option<Vector3> {
        if self.microfacets.is_smooth() || !lobes.contains(Lobes::GLOSSY_REFLECT) || !same_hemisphere(wo, wi)
        {
            return None;
        }
        let wm = (wo + wi).try_normalized()?;
        Some(if wm.z < 0.0 { -wm } else { wm })
    }
}
