//! A polished coat over a diffuse base: varnished wood, smooth plastic, brushed metal (Ashikhmin and Shirley 2000,
//! "An Anisotropic Phong BRDF Model").
//!
//! `f_s = sqrt((n_u + 1)(n_v + 1))/(8 pi) (n·h)^(n_u cos² phi + n_v sin² phi) F(h·wo) / ((h·wo) max(cos_o, cos_i))`
//! with Schlick's Fresnel factor `F(u) = k_s + (1 - k_s)(1 - u)⁵`, and below it, for what the coat lets pass, `f_d =
//! 28 k_d/(23 pi) (1 - k_s) (1 - (1 - cos_o/2)⁵) (1 - (1 - cos_i/2)⁵)` (SPEC BRDF-19). Reciprocal; the albedo of
//! `f_d` is k_d (1 - k_s) at most.

use std::f32::consts::PI;

use etendue_math::approx::{exp, ln, ln_1p, sin_cos_turns};
use etendue_math::{Point2, Vector3, sqr};
use etendue_spectrum::Sampled;

use super::lobed::{Lobed, Shares};
use super::powers::{alpha_of_exponent, half_vector, widened_exponent};
use crate::bsdf::fresnel::{reflect, schlick_weight};

/// A coated surface in the shading frame.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct AshikhminShirley {
    /// Albedo of the base.
    pub kd: Sampled,
    /// Reflectance of the coat along the normal.
    pub ks: Sampled,
    /// Exponent of the highlight along the first tangent, at least 0.
    pub exponent_u: f32,
    /// The same along the second tangent.
    pub exponent_v: f32,
}

impl AshikhminShirley {
    /// With a wider highlight.
    pub(super) fn regularized(self) -> Self {
        Self {
            exponent_u: widened_exponent(self.exponent_u),
            exponent_v: widened_exponent(self.exponent_v),
            ..self
        }
    }

    /// Schlick's Fresnel factor.
    #[inline]
    fn fresnel(&self, cos: f32) -> Sampled {
        self.ks + (Sampled::ONE - self.ks) * schlick_weight(cos)
    }

    /// Density of half vectors in 1/sr, `sqrt((n_u + 1)(n_v + 1)) / 2 pi` times the power of the cosine.
    #[inline]
    fn half_pdf(&self, h: Vector3) -> f32 {
        let (x2, y2) = (sqr(h.x), sqr(h.y));
        let sin2 = x2 + y2;
        // From the sine where the cosine is nearly 1.
        let ln_cos = if sin2 < 0.5 { 0.5 * ln_1p(-sin2) } else { ln(h.z.max(1e-30)) };
        let exponent =
            if sin2 > 0.0 { (self.exponent_u * x2 + self.exponent_v * y2) / sin2 } else { self.exponent_u };
        let scale = (self.exponent_u + 1.0).sqrt() * (self.exponent_v + 1.0).sqrt();
        scale * exp(exponent * ln_cos) * (0.5 / PI)
    }
}

impl Lobed for AshikhminShirley {
    fn diffuse(&self, to: Vector3, from: Vector3) -> Sampled {
        let passed = |cos: f32| 1.0 - (1.0 - 0.5 * cos).powi(5);
        let scale = 28.0 / (23.0 * PI) * passed(to.z) * passed(from.z);
        self.kd * (Sampled::ONE - self.ks) * scale // [SPEC BRDF-19]
    }

    fn glossy(&self, to: Vector3, from: Vector3) -> Sampled {
        let Some(h) = half_vector(to, from) else { return Sampled::ZERO };
        let cos = to.dot(h);
        self.fresnel(cos) * (0.25 * self.half_pdf(h) / (cos * to.z.max(from.z))) // [SPEC BRDF-19]
    }

    /// There is a highlight at grazing angles even where k_s is 0.
    fn shares(&self, wo: Vector3) -> Shares {
        let diffuse = (self.kd * (Sampled::ONE - self.ks)).max_value();
        Shares { diffuse, glossy: self.fresnel(wo.z).max_value().max(0.05), mirror: 0.0 }
    }

    fn sample_glossy(&self, wo: Vector3, _u_choice: f32, u: Point2) -> Option<Vector3> {
        // tan phi = sqrt((n_u + 1) / (n_v + 1)) tan(2 pi u), quadrant by quadrant.
        let (sin, cos) = sin_cos_turns(u.y);
        let (x, y) = ((self.exponent_v + 1.0).sqrt() * cos, (self.exponent_u + 1.0).sqrt() * sin);
        let length = x.hypot(y);
        let (x, y) = (x / length, y / length);
        let exponent = self.exponent_u * sqr(x) + self.exponent_v * sqr(y);
        let ln_cos = ln_1p(-u.x) / (exponent + 1.0);
        let sin = (-(2.0 * ln_cos).exp_m1()).max(0.0).sqrt();
        let h = Vector3::new(sin * x, sin * y, exp(ln_cos));
        (wo.dot(h) > 0.0).then(|| reflect(wo, h))
    }

    fn glossy_pdf(&self, wo: Vector3, wi: Vector3) -> f32 {
        let Some(h) = half_vector(wo, wi) else { return 0.0 };
        self.half_pdf(h) / (4.0 * wo.dot(h))
    }

    fn alpha(&self) -> f32 {
        0.5 * (alpha_of_exponent(self.exponent_u) + alpha_of_exponent(self.exponent_v))
    }
}
