//! Rough matte surfaces: clay, plaster, the moon (Oren and Nayar 1994, "Generalization of Lambert's Reflectance
//! Model").
//!
//! The surface is made of long symmetric V-grooves of all directions whose walls are Lambertian; their slope angles
//! have the standard deviation sigma. With the larger and smaller polar angle `alpha` and `beta`, the difference of
//! azimuth `phi` and `s = sigma²`, the qualitative model keeps what matters most (SPEC BRDF-18): `f = R/pi (A + B
//! max(0, cos phi) sin alpha tan beta)`, `A = 1 - s / (2 (s + 0.33))`, `B = 0.45 s / (s + 0.09)`.
//!
//! The full model fits masking better and adds light that two walls reflect (equations 26 to 29 of the paper):
//! `f1 = R/pi (A + C2 cos phi tan beta + C3 (1 - |cos phi|) tan((alpha + beta)/2))`,
//! `f2 = 0.17 R²/pi s/(s + 0.13) (1 - cos phi (2 beta/pi)²)`, with `C2 = B (sin alpha - [cos phi < 0] (2 beta/pi)³)`,
//! `C3 = 0.125 s/(s + 0.09) (4 alpha beta/pi²)²`. The fit is negative where dark surfaces are seen and lit grazing
//! from opposite sides; there it counts as 0. Both are reciprocal.

use std::f32::consts::{FRAC_1_PI, FRAC_2_PI};

use etendue_math::approx::acos;
use etendue_math::{Vector3, sqr};
use etendue_spectrum::Sampled;

use super::lobed::{Lobed, Shares};

/// Which of the models of Oren and Nayar.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum OrenNayarForm {
    /// With two bounces and the better fit of masking.
    Full,
    /// The short formula that most programs use.
    Qualitative,
}

/// Rough diffuse reflection in the shading frame.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct OrenNayar {
    /// Albedo of the walls of the grooves, in [0, 1].
    pub reflectance: Sampled,
    /// Standard deviation of the angle of the walls, in radians; 0 is Lambert's reflection.
    pub sigma_rad: f32,
    /// Which model.
    pub form: OrenNayarForm,
}

/// The angles that the models depend on.
struct Angles {
    cos_phi: f32,
    cos_alpha: f32,
    cos_beta: f32,
}

impl Angles {
    #[inline]
    fn new(a: Vector3, b: Vector3) -> Self {
        let sin2 = |w: Vector3| sqr(w.x) + sqr(w.y);
        let sines = (sin2(a) * sin2(b)).sqrt();
        let cos_phi = if sines > 0.0 { ((a.x * b.x + a.y * b.y) / sines).clamp(-1.0, 1.0) } else { 1.0 };
        Self { cos_phi, cos_alpha: a.z.min(b.z).min(1.0), cos_beta: a.z.max(b.z).min(1.0) }
    }

    #[inline]
    fn sin_alpha(&self) -> f32 {
        (1.0 - sqr(self.cos_alpha)).sqrt()
    }

    #[inline]
    fn tan_beta(&self) -> f32 {
        (1.0 - sqr(self.cos_beta)).sqrt() / self.cos_beta
    }
}

impl OrenNayar {
    fn qualitative(&self, angles: &Angles) -> Sampled {
        let s = sqr(self.sigma_rad);
        let (a, b) = (1.0 - 0.5 * s / (s + 0.33), 0.45 * s / (s + 0.09));
        let masked = angles.cos_phi.max(0.0) * angles.sin_alpha() * angles.tan_beta();
        self.reflectance * (FRAC_1_PI * (a + b * masked)) // [SPEC BRDF-18]
    }

    fn full(&self, angles: &Angles) -> Sampled {
        let s = sqr(self.sigma_rad);
        let (alpha, beta) = (acos(angles.cos_alpha), acos(angles.cos_beta));
        let cos_phi = angles.cos_phi;
        let shadowed = if cos_phi < 0.0 { (FRAC_2_PI * beta).powi(3) } else { 0.0 };
        let c1 = 1.0 - 0.5 * s / (s + 0.33);
        let c2 = 0.45 * s / (s + 0.09) * (angles.sin_alpha() - shadowed);
        let c3 = 0.125 * s / (s + 0.09) * sqr(sqr(FRAC_2_PI) * alpha * beta);
        // tan((alpha + beta) / 2), at most 1 / cos_beta.
        let half = 0.5 * (alpha + beta);
        let tan_half = (half.sin() / half.cos().max(1e-6)).min(1.0 / angles.cos_beta);
        let once = c1 + c2 * cos_phi * angles.tan_beta() + c3 * (1.0 - cos_phi.abs()) * tan_half;
        let twice = 0.17 * s / (s + 0.13) * (1.0 - cos_phi * sqr(FRAC_2_PI * beta));
        let r = self.reflectance;
        ((r * once + r * r * twice) * FRAC_1_PI).max(Sampled::ZERO) // [Oren and Nayar 1994 (26), (28), (29)]
    }
}

impl Lobed for OrenNayar {
    fn diffuse(&self, to: Vector3, from: Vector3) -> Sampled {
        let angles = Angles::new(to, from);
        match self.form {
            OrenNayarForm::Full => self.full(&angles),
            OrenNayarForm::Qualitative => self.qualitative(&angles),
        }
    }

    fn shares(&self, _wo: Vector3) -> Shares {
        Shares { diffuse: self.reflectance.max_value(), glossy: 0.0, mirror: 0.0 }
    }
}
