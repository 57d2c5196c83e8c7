//! Schlick's model between mirror and matte, made of rational functions (Schlick 1993, "A Customizable Reflectance
//! Model for Everyday Rendering").
//!
//! With `u = wo·h`, `t = n·h`, `v` and `v'` the cosines of both directions and w the cosine between first tangent and
//! the half vector's projection (SPEC BRDF-23 to BRDF-28): `f = S(u) (d/pi + g D + s mirror)`, `S(u) = F0 + (1 -
//! F0)(1 - u)⁵`, `D = G(v) G(v') Z(t) A(w) / (4 pi v v')`, `Z = r/(1 + r t² - t²)²`, `A = sqrt(p/(p² - p² w² + w²))`,
//! `G(v) = v/(r - r v + v)`, for roughness r (sigma in the paper) and isotropy p (psi). The weights follow from r: `g
//! = 4 r (1 - r)`, and the rest is `s` below 0.5, `d` above.
//!
//! As printed, D has the further term `(1 - G G')/(4 pi v v')` for light that is reflected again after obstruction,
//! which makes light: at 80° and full weight the albedo is 2.0 for r = 0.1 and 2.8 for r = 1.
//! [`SchlickForm::Printed`] has it. `Z/pi` is GGX with `alpha² = r`. The mean of A over azimuths is 1 for p = 1
//! alone: anisotropy loses light.

use std::f32::consts::{FRAC_1_PI, PI, TAU};

use etendue_math::approx::sin_cos_turns;
use etendue_math::{Point2, Vector3, sqr, warp};
use etendue_spectrum::Sampled;

use super::lobed::{Lobed, Shares};
use super::powers::half_vector;
use crate::bsdf::fresnel::{reflect, schlick_weight};

/// Which of Schlick's models.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum SchlickForm {
    /// Without light that is reflected again, which keeps energy.
    Conserving,
    /// Equation 2.37 as printed, which does not.
    Printed,
}

/// Schlick's reflection in the shading frame.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Schlick {
    /// Reflectance along the normal, F0.
    pub reflectance: Sampled,
    /// Roughness r: 0 is a mirror, 0.5 glossy, 1 matte.
    pub roughness: f32,
    /// Isotropy p in (0, 1]: 1 is isotropic, less scratched along the first tangent.
    pub isotropy: f32,
    /// Which model.
    pub form: SchlickForm,
}

/// The weights of the three modes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SchlickWeights {
    /// Of the diffuse mode, d.
    pub diffuse: f32,
    /// Of the glossy mode, g.
    pub glossy: f32,
    /// Of the mirror, s.
    pub mirror: f32,
}

impl Schlick {
    /// The weights of a roughness, which sum to 1 [SPEC BRDF-27].
    #[must_use]
    pub fn weights(roughness: f32) -> SchlickWeights {
        let glossy = 4.0 * roughness * (1.0 - roughness);
        let rest = 1.0 - glossy;
        if roughness < 0.5 {
            SchlickWeights { diffuse: 0.0, glossy, mirror: rest }
        } else {
            SchlickWeights { diffuse: rest, glossy, mirror: 0.0 }
        }
    }

    /// S(u) [SPEC BRDF-24].
    #[inline]
    fn s(&self, u: f32) -> Sampled {
        self.reflectance + (Sampled::ONE - self.reflectance) * schlick_weight(u)
    }

    /// Z(t) [SPEC BRDF-25].
    #[inline]
    fn z(&self, h: Vector3) -> f32 {
        // 1 - t² from the sine, which is exact near the normal.
        self.roughness / sqr(sqr(h.x) + sqr(h.y) + self.roughness * sqr(h.z))
    }

    /// A(w)² [SPEC BRDF-25].
    #[inline]
    fn a2(&self, h: Vector3) -> f32 {
        let (x2, y2) = (sqr(h.x), sqr(h.y));
        let p = self.isotropy;
        if x2 + y2 > 0.0 { p * (x2 + y2) / (sqr(p) * y2 + x2) } else { 1.0 }
    }

    /// G(v) / v [SPEC BRDF-25].
    #[inline]
    fn g_over_v(&self, v: f32) -> f32 {
        1.0 / (self.roughness - self.roughness * v + v)
    }

    /// Density of half vectors that reflect; the azimuth has the density `A²/2 pi`, whose inverse is elementary.
    #[inline]
    fn half_pdf(&self, h: Vector3) -> f32 {
        2.0 * h.z * self.z(h) * self.a2(h) / TAU
    }

    /// What share of glossy samples is even over the hemisphere, for light reflected again.
    #[inline]
    fn even_share(&self) -> f32 {
        match self.form {
            SchlickForm::Conserving => 0.0,
            SchlickForm::Printed => 0.5,
        }
    }
}

impl Lobed for Schlick {
    fn diffuse(&self, to: Vector3, from: Vector3) -> Sampled {
        let weight = Self::weights(self.roughness).diffuse;
        let Some(h) = half_vector(to, from) else { return Sampled::ZERO };
        self.s(to.dot(h)) * (weight * FRAC_1_PI) // [SPEC BRDF-23]
    }

    fn glossy(&self, to: Vector3, from: Vector3) -> Sampled {
        let weight = Self::weights(self.roughness).glossy;
        let Some(h) = half_vector(to, from).filter(|_| weight > 0.0) else { return Sampled::ZERO };
        let g_over_vv = self.g_over_v(to.z) * self.g_over_v(from.z);
        let once = g_over_vv * self.z(h) * self.a2(h).sqrt();
        let again = match self.form {
            SchlickForm::Conserving => 0.0,
            SchlickForm::Printed => (1.0 / (to.z * from.z) - g_over_vv).max(0.0),
        };
        self.s(to.dot(h)) * (weight * (once + again) / (4.0 * PI)) // [SPEC BRDF-26]
    }

    fn mirror(&self, wo: Vector3) -> Sampled {
        self.s(wo.z) * Self::weights(self.roughness).mirror
    }

    fn shares(&self, _wo: Vector3) -> Shares {
        let SchlickWeights { diffuse, glossy, mirror } = Self::weights(self.roughness);
        Shares { diffuse, glossy, mirror }
    }

    fn sample_glossy(&self, wo: Vector3, u_choice: f32, u: Point2) -> Option<Vector3> {
        if u_choice < self.even_share() {
            return Some(warp::sample_uniform_hemisphere(u));
        }
        let t2 = u.x / (self.roughness - u.x * self.roughness + u.x).max(f32::MIN_POSITIVE); // [SPEC BRDF-28]
        let (sin, cos) = sin_cos_turns(u.y);
        let (x, y) = (self.isotropy * cos, sin);
        let scale = (1.0 - t2).max(0.0).sqrt() / x.hypot(y).max(f32::MIN_POSITIVE);
        let h = Vector3::new(x * scale, y * scale, t2.sqrt());
        (wo.dot(h) > 0.0).then(|| reflect(wo, h))
    }

    fn glossy_pdf(&self, wo: Vector3, wi: Vector3) -> f32 {
        let Some(h) = half_vector(wo, wi) else { return 0.0 };
        let even = self.even_share();
        even / TAU + (1.0 - even) * self.half_pdf(h) / (4.0 * wo.dot(h))
    }

    fn alpha(&self) -> f32 {
        self.roughness.sqrt()
    }
}
