//! A thin diffuse sheet such as paper or a leaf: `f = R / pi` on the side of `wo`, `T / pi` on the other.
//!
//! One of both sides is chosen in proportion to its largest albedo among the wavelengths.

use std::f32::consts::FRAC_1_PI;

use etendue_math::{Point2, Vector3, warp};
use etendue_spectrum::Sampled;

use super::local::{abs_cos, same_hemisphere, to_side_of};
use super::{BsdfSample, Lobes};

/// Lambert's reflection and transmission in the shading frame.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct DiffuseTransmission {
    /// Albedo to the side of `wo`, in [0, 1].
    pub reflectance: Sampled,
    /// Albedo to the other side, in [0, 1].
    pub transmittance: Sampled,
}

impl DiffuseTransmission {
    /// The lobes present.
    #[inline]
    #[must_use]
    pub fn lobes(&self) -> Lobes {
        let reflect = if self.reflectance.is_black() { Lobes::NONE } else { Lobes::DIFFUSE_REFLECT };
        let transmit = if self.transmittance.is_black() { Lobes::NONE } else { Lobes::DIFFUSE_TRANSMIT };
        reflect | transmit
    }

    /// Probabilities of reflection and transmission; both 0 if nothing can be chosen.
    #[inline]
    fn probabilities(&self, lobes: Lobes) -> (f32, f32) {
        let choose = |lobe, albedo: Sampled| if lobes.contains(lobe) { albedo.max_value() } else { 0.0 };
        let r = choose(Lobes::DIFFUSE_REFLECT, self.reflectance);
        let t = choose(Lobes::DIFFUSE_TRANSMIT, self.transmittance);
        if r + t > 0.0 { (r / (r + t), t / (r + t)) } else { (0.0, 0.0) }
    }

    /// f in 1/sr, without the cosine.
    #[inline]
    #[must_use]
    pub fn eval(&self, wo: Vector3, wi: Vector3, lobes: Lobes) -> Sampled {
        let (lobe, albedo) = if same_hemisphere(wo, wi) {
            (Lobes::DIFFUSE_REFLECT, self.reflectance)
        } else {
            (Lobes::DIFFUSE_TRANSMIT, self.transmittance)
        };
        if lobes.contains(lobe) { albedo * FRAC_1_PI } else { Sampled::ZERO }
    }

    /// A side by `u_component`, then a direction with density cos / pi.
    #[inline]
    #[must_use]
    pub fn sample(&self, wo: Vector3, u_component: f32, u: Point2, lobes: Lobes) -> Option<BsdfSample> {
        let (p_reflect, p_transmit) = self.probabilities(lobes);
        let w = warp::sample_cosine_hemisphere(u);
        let (lobe, albedo, p, wi) = if u_component < p_reflect {
            (Lobes::DIFFUSE_REFLECT, self.reflectance, p_reflect, to_side_of(w, wo))
        } else {
            (Lobes::DIFFUSE_TRANSMIT, self.transmittance, p_transmit, to_side_of(w, -wo))
        };
        let pdf_w = p * abs_cos(wi) * FRAC_1_PI;
        (pdf_w > 0.0).then(|| BsdfSample {
            wi,
            weight: albedo / p,
            pdf_w,
            pmf: 0.0,
            lobe,
            eta: 1.0,
            roughness: 1.0,
        })
    }

    /// Density of [`Self::sample`] in 1/sr.
    #[inline]
    #[must_use]
    pub fn pdf(&self, wo: Vector3, wi: Vector3, lobes: Lobes) -> f32 {
        let (p_reflect, p_transmit) = self.probabilities(lobes);
        let p = if same_hemisphere(wo, wi) { p_reflect } else { p_transmit };
        p * abs_cos(wi) * FRAC_1_PI
    }
}
