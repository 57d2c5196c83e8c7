//! Ideal diffuse reflection: `f = R / pi` on the side of `wo` (Lambert 1760; SPEC BRDF-11).

use std::f32::consts::FRAC_1_PI;

use etendue_math::{Point2, Vector3, warp};
use etendue_spectrum::Sampled;

use super::local::{abs_cos, same_hemisphere, to_side_of};
use super::{BsdfSample, Lobes};

/// Lambert's reflection in the shading frame.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Diffuse {
    /// Albedo per wavelength, in [0, 1].
    pub reflectance: Sampled,
}

impl Diffuse {
    /// Of that albedo, limited to [0, 1].
    #[inline]
    #[must_use]
    pub fn new(reflectance: Sampled) -> Self {
        Self { reflectance: reflectance.clamp(0.0, 1.0) }
    }

    /// The lobes present.
    #[inline]
    #[must_use]
    pub fn lobes(&self) -> Lobes {
        if self.reflectance.is_black() { Lobes::NONE } else { Lobes::DIFFUSE_REFLECT }
    }

    /// f in 1/sr, without the cosine.
    #[inline]
    #[must_use]
    pub fn eval(&self, wo: Vector3, wi: Vector3, lobes: Lobes) -> Sampled {
        if !lobes.contains(Lobes::DIFFUSE_REFLECT) || !same_hemisphere(wo, wi) {
            return Sampled::ZERO;
        }
        self.reflectance * FRAC_1_PI
    }

    /// A direction with density cos / pi.
    #[inline]
    #[must_use]
    pub fn sample(&self, wo: Vector3, u: Point2, lobes: Lobes) -> Option<BsdfSample> {
        if !lobes.contains(Lobes::DIFFUSE_REFLECT) {
            return None;
        }
        let wi = to_side_of(warp::sample_cosine_hemisphere(u), wo);
        let pdf_w = abs_cos(wi) * FRAC_1_PI;
        (pdf_w > 0.0).then_some(BsdfSample {
            wi,
            weight: self.reflectance,
            pdf_w,
            pmf: 0.0,
            lobe: Lobes::DIFFUSE_REFLECT,
            eta: 1.0,
            roughness: 1.0,
        })
    }

    /// Density of [`Self::sample`] in 1/sr.
    #[inline]
    #[must_use]
    pub fn pdf(&self, wo: Vector3, wi: Vector3, lobes: Lobes) -> f32 {
        if !lobes.contains(Lobes::DIFFUSE_REFLECT) || !same_hemisphere(wo, wi) {
            return 0.0;
        }
        abs_cos(wi) * FRAC_1_PI
    }
}
