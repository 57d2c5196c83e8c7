//! A smooth clear coat over a diffuse base, with all bounces between them: glazed pottery, plastic.
//!
//! The coat reflects F as a mirror. What passes is made even by the base of albedo R, and of it the coat sends back
//! the share `F_in`, again and again; the series sums to `f = R (1 - F(cos_o)) (1 - F(cos_i)) / (pi eta² (1 - R
//! F_in))` (Orchard 1969, "Reflection and Transmission of Light by Diffusing Suspensions"; Wolff 1994,
//! "Diffuse-Reflectance Model for Smooth Dielectric Surfaces"). With the mean reflectance from outside, `F_out = 2 ∫
//! F cos d cos`, that from inside is `F_in = 1 - (1 - F_out)/eta²`, so that a white base loses nothing.
//!
//! Reciprocal, keeps energy. It is what `coateddiffuse` estimates by walks, for a smooth coat without thickness.

use std::f32::consts::FRAC_1_PI;

use etendue_math::{Vector3, sqr};
use etendue_spectrum::Sampled;

use super::lobed::{Lobed, Shares};
use crate::bsdf::fresnel::fresnel_dielectric;

/// A coated diffuse surface in the shading frame.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SmoothCoat {
    /// `R / (pi eta² (1 - R F_in))`.
    scale: Sampled,
    /// Index of the coat relative to the outside, at least 1.
    eta: f32,
    /// Mean reflectance of the coat from outside.
    f_out: f32,
}

impl SmoothCoat {
    /// Of the albedo of the base, in [0, 1], and the index of the coat, at least 1.
    #[must_use]
    pub fn new(reflectance: Sampled, eta: f32) -> Self {
        let f_out = mean_reflectance(eta);
        let f_in = 1.0 - (1.0 - f_out) / sqr(eta);
        let scale = reflectance / (Sampled::ONE - reflectance * f_in) * (FRAC_1_PI / sqr(eta));
        Self { scale, eta, f_out }
    }
}

impl SmoothCoat {
    /// Index of the coat relative to the outside.
    #[must_use]
    pub const fn eta(&self) -> f32 {
        self.eta
    }
}

/// `2 ∫ F cos d cos` by Gauss's rule of 8 points.
fn mean_reflectance(eta: f32) -> f32 {
    const GAUSS_8: [(f32, f32); 4] = [
        (0.183_434_64, 0.362_683_78),
        (0.525_532_4, 0.313_706_65),
        (0.796_666_5, 0.222_381_03),
        (0.960_289_9, 0.101_228_54),
    ];
    let at = |cos: f32| cos * fresnel_dielectric(cos, eta);
    GAUSS_8.iter().map(|(x, weight)| weight * (at(0.5 - 0.5 * x) + at(0.5 + 0.5 * x))).sum()
}

impl SmoothCoat {
    /// Reflectance of the coat from outside; equal indices reflect nothing, also along the horizon.
    #[inline]
    fn reflected(&self, cos: f32) -> f32 {
        if self.eta > 1.0 { fresnel_dielectric(cos, self.eta) } else { 0.0 }
    }
}

impl Lobed for SmoothCoat {
    fn diffuse(&self, to: Vector3, from: Vector3) -> Sampled {
        let passed = |cos: f32| 1.0 - self.reflected(cos);
        self.scale * (passed(to.z) * passed(from.z))
    }

    fn mirror(&self, wo: Vector3) -> Sampled {
        Sampled::splat(self.reflected(wo.z))
    }

    fn shares(&self, wo: Vector3) -> Shares {
        let mirror = self.reflected(wo.z);
        // What the base sends out of a white surrounding: scale pi (1 - F) (1 - F_out).
        let out = self.scale.max_value() / FRAC_1_PI * (1.0 - self.f_out);
        let diffuse = if out > 0.0 { (out * (1.0 - mirror)).max(1e-3) } else { 0.0 };
        Shares { diffuse, glossy: 0.0, mirror }
    }
}
