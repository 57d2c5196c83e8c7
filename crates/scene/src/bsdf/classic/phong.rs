//! Phong's highlight around the mirror direction (Phong 1975, "Illumination for Computer Generated Pictures").
//!
//! With alpha between `wi` and the mirror image of `wo`, Lewis's form is a BRDF that obeys the laws,
//! `f = k_d / pi + k_s (n + 2) / (2 pi) cosⁿ alpha` with `k_d + k_s <= 1` (Lewis 1993, "Making Shaders More
//! Physically Plausible"; SPEC BRDF-14); its highlight reflects k_s along the normal and less elsewhere.
//!
//! Phong's illumination equation `I = I_l (k_d cos_i + k_s cosⁿ alpha)` (SPEC BRDF-12, BRDF-13) has no cosine at its
//! highlight. As a BRDF it must divide by it: `f = (k_d + k_s cosⁿ alpha / cos_i) / pi`, where a light of irradiance
//! `pi I_l` stands for the light of the equation. It breaks two laws: it is not reciprocal, and light that comes in
//! grazing leaves multiplied by up to `2 k_s / ((n + 1) cos_i)`; so does any light for n < 1. Light carriers
//! (importance) get the adjoint, so that all methods agree.

use std::f32::consts::{FRAC_1_PI, TAU};

use etendue_math::{Frame, Point2, Vector3, sqr};
use etendue_spectrum::Sampled;

use super::lobed::{Lobed, Shares};
use super::powers::{cosine_power, power_pdf_scale, sample_cosine_power, widened_alpha};
use crate::bsdf::local::mirror;

/// Which of Phong's models.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum PhongForm {
    /// Normalised by Lewis: reciprocal, and keeps energy.
    Lewis,
    /// The illumination equation of 1975, divided by the cosine.
    Illumination,
}

/// Phong's reflection in the shading frame.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Phong {
    /// Diffuse albedo.
    pub kd: Sampled,
    /// Strength of the highlight: its albedo along the normal in Lewis's form.
    pub ks: Sampled,
    /// Exponent n of the highlight, at least 0.
    pub exponent: f32,
    /// Which model.
    pub form: PhongForm,
}

impl Phong {
    /// With a wider highlight.
    pub(super) fn regularized(self) -> Self {
        let (alpha, wide) = (self.alpha(), widened_alpha(self.alpha()));
        let exponent = if wide > alpha { exponent_of_alpha(wide) } else { self.exponent };
        Self { exponent, ..self }
    }
}

/// The exponent whose highlight is as wide as that of facets of this alpha.
fn exponent_of_alpha(alpha: f32) -> f32 {
    (0.5 / sqr(alpha) - 0.5).max(0.0)
}

impl Lobed for Phong {
    fn diffuse(&self, _to: Vector3, _from: Vector3) -> Sampled {
        self.kd * FRAC_1_PI
    }

    fn glossy(&self, to: Vector3, from: Vector3) -> Sampled {
        let scale = match self.form {
            PhongForm::Lewis => (self.exponent + 2.0) / TAU, // [SPEC BRDF-14]
            PhongForm::Illumination => FRAC_1_PI / from.z,   // [SPEC BRDF-13]
        };
        self.ks * (scale * cosine_power(mirror(to), from, self.exponent))
    }

    fn shares(&self, _wo: Vector3) -> Shares {
        let gain = match self.form {
            PhongForm::Lewis => 1.0,
            PhongForm::Illumination => 2.0 / (self.exponent + 1.0),
        };
        Shares { diffuse: self.kd.max_value(), glossy: gain * self.ks.max_value(), mirror: 0.0 }
    }

    fn sample_glossy(&self, wo: Vector3, _u_choice: f32, u: Point2) -> Option<Vector3> {
        Some(Frame::from_z(mirror(wo)).to_world(sample_cosine_power(u, self.exponent)))
    }

    fn glossy_pdf(&self, wo: Vector3, wi: Vector3) -> f32 {
        power_pdf_scale(self.exponent) * cosine_power(mirror(wo), wi, self.exponent)
    }

    /// A highlight around the mirror direction is half as wide as one of the half vector, whose exponent is 4 n.
    fn alpha(&self) -> f32 {
        (0.5 / (self.exponent + 0.5)).sqrt()
    }
}
