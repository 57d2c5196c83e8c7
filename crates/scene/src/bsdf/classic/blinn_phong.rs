//! Phong's highlight from the half vector (Blinn 1977, "Models of Light Reflection for Computer Synthesized
//! Pictures").
//!
//! `f = k_d / pi + k_s c (n·h)ⁿ` with `c = (n + 2)(n + 4) / (8 pi (2^(-n/2) + n))`, which gives the highlight an
//! albedo of exactly k_s along the normal (SPEC BRDF-15). An exponent n looks about like Phong's n / 4. Grazing light
//! loses.

use std::f32::consts::FRAC_1_PI;

use etendue_math::{Point2, Vector3};
use etendue_spectrum::Sampled;

use super::lobed::{Lobed, Shares};
use super::powers::{
    alpha_of_exponent, blinn_scale, half_vector, height_power, power_pdf_scale, sample_cosine_power,
    widened_exponent,
};
use crate::bsdf::fresnel::reflect;

/// Blinn's reflection in the shading frame.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BlinnPhong {
    /// Diffuse albedo.
    pub kd: Sampled,
    /// Albedo of the highlight along the normal.
    pub ks: Sampled,
    /// Exponent n of the highlight, at least 0.
    pub exponent: f32,
}

impl BlinnPhong {
    /// With a wider highlight.
    pub(super) fn regularized(self) -> Self {
        Self { exponent: widened_exponent(self.exponent), ..self }
    }
}

impl Lobed for BlinnPhong {
    fn diffuse(&self, _to: Vector3, _from: Vector3) -> Sampled {
        self.kd * FRAC_1_PI
    }

    fn glossy(&self, to: Vector3, from: Vector3) -> Sampled {
        let Some(h) = half_vector(to, from) else { return Sampled::ZERO };
        self.ks * (blinn_scale(self.exponent) * height_power(h, self.exponent)) // [SPEC BRDF-15]
    }

    fn shares(&self, _wo: Vector3) -> Shares {
        Shares { diffuse: self.kd.max_value(), glossy: self.ks.max_value(), mirror: 0.0 }
    }

    fn sample_glossy(&self, wo: Vector3, _u_choice: f32, u: Point2) -> Option<Vector3> {
        let h = sample_cosine_power(u, self.exponent);
        (wo.dot(h) > 0.0).then(|| reflect(wo, h))
    }

    fn glossy_pdf(&self, wo: Vector3, wi: Vector3) -> f32 {
        let Some(h) = half_vector(wo, wi) else { return 0.0 };
        power_pdf_scale(self.exponent) * height_power(h, self.exponent) / (4.0 * wo.dot(h))
    }

    fn alpha(&self) -> f32 {
        alpha_of_exponent(self.exponent)
    }
}
