//! M_p: how a rough fibre spreads light along itself.
//!
//! `M(theta_i) = I0(cos_i cos_o / v) exp(-sin_i sin_o / v) / (2 v sinh(1 / v))`, a density over the sphere but for the
//! even azimuth: 1 is its integral times cos_i over theta_i (d'Eon et al. 2011, "An Energy-Conserving Hair Reflectance
//! Model", doi:10.1111/j.1467-8659.2011.01976.x). It is the distribution of von Mises and Fisher about the cone of mirror
//! directions theta_i = -theta_o, averaged over the azimuth; v is the inverse of its concentration. With
//! `e = 1 - cos(theta_i + theta_o)` and `I0(a) = exp(a) I0e(a)` no large terms cancel:
//! `M = exp(-e / v) I0e(cos_i cos_o / v) / (v (1 - exp(-2 / v)))`, for any v.

use etendue_math::approx::{exp, ln, sin_cos_turns};
use etendue_math::{Point2, Vector3, safe_sqrt, sqr};

/// The angle of a direction with the normal plane of the fibre, which runs along x; the cosine is not negative.
#[derive(Clone, Copy, Debug)]
pub(super) struct Inclination {
    pub(super) sin: f32,
    pub(super) cos: f32,
}

impl Inclination {
    pub(super) fn of(w: Vector3) -> Self {
        Self { sin: w.x.clamp(-1.0, 1.0), cos: (sqr(w.y) + sqr(w.z)).sqrt().min(1.0) }
    }

    /// With an angle added, given by its sine and cosine; beyond the axis it comes back on the other side.
    pub(super) fn turned(self, (sin, cos): (f32, f32)) -> Self {
        Self { sin: self.sin * cos + self.cos * sin, cos: (self.cos * cos - self.sin * sin).abs() }
    }

    /// M for light from `other` that leaves towards this.
    pub(super) fn density(self, other: &Self, v: f32) -> f32 {
        let e = 0.5 * (sqr(self.cos - other.cos) + sqr(self.sin + other.sin));
        let norm = v * (1.0 - exp(-2.0 / v));
        // Its integral with cos_i over theta_i is 1, as that of N_p over phi is.
        exp(-e / v) * scaled_bessel_i0(self.cos * other.cos / v) / norm
    }

    /// Sine and cosine of an angle with that density.
    ///
    /// The distance from the mirror cone is drawn first, then the direction about it.
    /// [d'Eon, Marschner and Hanika 2013, "Importance Sampling for Physically-Based Hair Fiber Models"]
    pub(super) fn sample(self, v: f32, u: Point2) -> (f32, f32) {
        let below = (-v * ln(u.x + (1.0 - u.x) * exp(-2.0 / v))).clamp(0.0, 2.0);
        let (cos, sin) = (1.0 - below, safe_sqrt(below * (2.0 - below)));
        let (_, cos_phi) = sin_cos_turns(u.y);
        let sin_i = (sin * cos_phi * self.cos - cos * self.sin).clamp(-1.0, 1.0);
        (sin_i, safe_sqrt(1.0 - sqr(sin_i)))
    }
}

/// exp(-x) I0(x) for x of at least 0, by polynomials with an error below 2e-7.
/// [Abramowitz and Stegun 1964, 9.8.1 and 9.8.2]
fn scaled_bessel_i0(x: f32) -> f32 {
    const SMALL: [f32; 7] = [1.0, 3.515_623, 3.089_942_4, 1.206_749_2, 0.265_973_2, 0.036_076_8, 0.004_581_3];
    const LARGE: [f32; 9] = [
        0.398_942_28,
        0.013_285_92,
        0.002_253_19,
        -0.001_575_65,
        0.009_162_81,
        -0.020_577_06,
        0.026_355_37,
        -0.016_476_33,
        0.003_923_77,
    ];
    let polynomial = |coefficients: &[f32], t: f32| coefficients.iter().rev().fold(0.0, |sum, c| sum * t + c);
    if x < 3.75 {
        exp(-x) * polynomial(&SMALL, sqr(x / 3.75))
    } else {
        polynomial(&LARGE, 3.75 / x) / x.sqrt()
    }
}
