//! What conductors and dielectrics ask of their facets.

use etendue_math::{Point2, Vector3};
use etendue_spectrum::Sampled;

use super::Beckmann;
use crate::bsdf::fresnel::{
    fresnel_conductor, fresnel_conductor_of_cos2, fresnel_dielectric, fresnel_schlick, schlick_weight,
};
use crate::bsdf::microfacet::Microfacets;

/// A distribution of small mirrors, with what they reflect.
pub trait Facets: Copy {
    /// True if the surface is treated as a perfect mirror or lens.
    fn is_smooth(self) -> bool;
    /// Mean alpha of both tangents, 0 if smooth.
    fn mean_alpha(self) -> f32;
    /// Facet area per surface area and solid angle, in 1/sr.
    fn d(self, wm: Vector3) -> f32;
    /// `G(wo, wi) / (|cos_o| |cos_i|)`.
    fn g_over_cosines(self, wo: Vector3, wi: Vector3) -> f32;
    /// `G(wo, wi) / G1(wo)`.
    fn g_over_g1(self, wo: Vector3, wi: Vector3) -> f32;
    /// Density in 1/sr of the normals visible from `wo`.
    fn visible_normal_pdf(self, wo: Vector3, wm: Vector3) -> f32;
    /// A normal visible from `wo`, in the upper hemisphere.
    fn sample_visible_normal(self, wo: Vector3, u: Point2) -> Vector3;

    /// [`Self::sample_visible_normal`] times a length.
    #[inline]
    fn sample_facet(self, wo: Vector3, u: Point2) -> Vector3 {
        self.sample_visible_normal(wo, u)
    }

    /// `D(wm) G(wo, wi) / (4 |cos_o| |cos_i|)`, and the density in 1/sr of `wi` if visible normals are sampled, where
    /// the facet whose normal is `wm`, of any length, reflects `wo` to `wi`.
    #[inline]
    fn reflection(self, wo: Vector3, wi: Vector3, wm: Vector3) -> (f32, f32) {
        let wm = wm.normalized();
        let wm = if wm.z < 0.0 { -wm } else { wm };
        let pdf_w = self.visible_normal_pdf(wo, wm) / (4.0 * wo.dot(wm).abs());
        (0.25 * self.d(wm) * self.g_over_cosines(wo, wi), pdf_w)
    }

    /// Fraction of light reflected between transparent media.
    #[inline]
    fn reflectance(self, cos: f32, eta: f32) -> f32 {
        fresnel_dielectric(cos, eta)
    }

    /// Fraction of light reflected by metal, from the squared cosine.
    #[inline]
    fn metal_reflectance(self, cos2: f32, eta: Sampled, k: Sampled) -> Sampled {
        fresnel_conductor_of_cos2(cos2, eta, k)
    }
}

impl Facets for Microfacets {
    #[inline]
    fn is_smooth(self) -> bool {
        Self::is_smooth(self)
    }

    #[inline]
    fn mean_alpha(self) -> f32 {
        Self::mean_alpha(self)
    }

    #[inline]
    fn d(self, wm: Vector3) -> f32 {
        Self::d(self, wm)
    }

    #[inline]
    fn g_over_cosines(self, wo: Vector3, wi: Vector3) -> f32 {
        Self::g_over_cosines(self, wo, wi)
    }

    #[inline]
    fn g_over_g1(self, wo: Vector3, wi: Vector3) -> f32 {
        Self::g_over_g1(self, wo, wi)
    }

    #[inline]
    fn visible_normal_pdf(self, wo: Vector3, wm: Vector3) -> f32 {
        Self::visible_normal_pdf(self, wo, wm)
    }

    #[inline]
    fn sample_visible_normal(self, wo: Vector3, u: Point2) -> Vector3 {
        Self::sample_visible_normal(self, wo, u)
    }

    #[inline]
    fn sample_facet(self, wo: Vector3, u: Point2) -> Vector3 {
        Self::sample_facet(self, wo, u)
    }

    #[inline]
    fn reflection(self, wo: Vector3, wi: Vector3, wm: Vector3) -> (f32, f32) {
        Self::reflection(self, wo, wi, wm)
    }
}

/// The distribution of facet normals.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum FacetShape {
    /// Trowbridge and Reitz, with long tails.
    Ggx,
    /// A Gaussian of the slope.
    Beckmann,
}

/// How the reflectance of a facet depends on the angle.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum FresnelForm {
    /// Fresnel's equations.
    Exact,
    /// Schlick's fit, from the reflectance along the normal.
    Schlick,
}

/// Facets of which shape and reflectance are chosen when the program runs.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct AnyFacets {
    /// Alpha along both tangents.
    pub alphas: Microfacets,
    /// Distribution of normals.
    pub shape: FacetShape,
    /// Reflectance.
    pub fresnel: FresnelForm,
}

impl AnyFacets {
    /// A wider distribution for paths that have already scattered.
    #[must_use]
    pub fn regularized(self) -> Self {
        Self { alphas: self.alphas.regularized(), ..self }
    }

    fn beckmann(self) -> Beckmann {
        let (alpha_x, alpha_y) = self.alphas.alpha();
        Beckmann { alpha_x, alpha_y }
    }
}

/// One expression for each shape.
macro_rules! each {
    ($self:expr, $facets:ident => $body:expr) => {
        match $self.shape {
            FacetShape::Ggx => {
                let $facets = $self.alphas;
                $body
            }
            FacetShape::Beckmann => {
                let $facets = $self.beckmann();
                $body
            }
        }
    };
}

impl Facets for AnyFacets {
    fn is_smooth(self) -> bool {
        self.alphas.is_smooth()
    }

    fn mean_alpha(self) -> f32 {
        self.alphas.mean_alpha()
    }

    fn d(self, wm: Vector3) -> f32 {
        each!(self, facets => facets.d(wm))
    }

    fn g_over_cosines(self, wo: Vector3, wi: Vector3) -> f32 {
        each!(self, facets => facets.g_over_cosines(wo, wi))
    }

    fn g_over_g1(self, wo: Vector3, wi: Vector3) -> f32 {
        each!(self, facets => facets.g_over_g1(wo, wi))
    }

    fn visible_normal_pdf(self, wo: Vector3, wm: Vector3) -> f32 {
        each!(self, facets => facets.visible_normal_pdf(wo, wm))
    }

    fn sample_visible_normal(self, wo: Vector3, u: Point2) -> Vector3 {
        each!(self, facets => facets.sample_visible_normal(wo, u))
    }

    fn sample_facet(self, wo: Vector3, u: Point2) -> Vector3 {
        each!(self, facets => Facets::sample_facet(facets, wo, u))
    }

    fn reflection(self, wo: Vector3, wi: Vector3, wm: Vector3) -> (f32, f32) {
        each!(self, facets => Facets::reflection(facets, wo, wi, wm))
    }

    fn reflectance(self, cos: f32, eta: f32) -> f32 {
        match self.fresnel {
            FresnelForm::Exact => fresnel_dielectric(cos, eta),
            FresnelForm::Schlick => fresnel_schlick(cos, eta),
        }
    }

    fn metal_reflectance(self, cos2: f32, eta: Sampled, k: Sampled) -> Sampled {
        match self.fresnel {
            FresnelForm::Exact => fresnel_conductor_of_cos2(cos2, eta, k),
            FresnelForm::Schlick => {
                let f0 = fresnel_conductor(1.0, eta, k);
                f0 + (Sampled::ONE - f0) * schlick_weight(cos2.sqrt())
            }
        }
    }
}
