//! Facets whose slopes are Gaussian (Beckmann and Spizzichino 1963, "The Scattering of Electromagnetic Waves from
//! Rough Surfaces").
//!
//! `D = exp(-(x²/ax² + y²/ay²)/z²) / (pi ax ay z⁴)`. With `s(w) = sqrt(ax² x² + ay² y²)`, `c = |z|` and `a = c/s`,
//! the facets that face w have the projected area `p(w) = c (1 + Lambda) = c (1 + erf a)/2 + s exp(-a²)/(2
//! sqrt(pi))`, of which c is seen (Smith 1967, "Geometrical Shadowing of a Random Rough Surface"; Heitz 2014,
//! "Understanding the Masking-Shadowing Function in Microfacet-Based BRDFs"). So `G1/c = 1/p`, and with correlated
//! heights `G/(c_o c_i) = 1/(c_i p_o + c_o p_i - c_o c_i)`.
//!
//! Visible normals: where alpha is 1, the slope towards the viewer has the density `(cos - x sin) exp(-x²)/sqrt(pi)`
//! over p, for `x < cos/sin`, and the other slope is Gaussian; Newton's method inverts the first (Heitz and d'Eon
//! 2014, "Importance Sampling Microfacet-Based BSDFs using the Distribution of Visible Normals").

use std::f32::consts::{FRAC_1_SQRT_2, PI};

use etendue_math::approx::exp;
use etendue_math::{Point2, Vector3, sqr, warp};

use super::Facets;

/// 1 / (2 sqrt(pi)).
const HALF_RSQRT_PI: f32 = 0.282_094_8;

/// A Beckmann distribution of facet normals in the shading frame.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Beckmann {
    /// Root mean square slope along the first tangent, times the square root of 2; more than 0.
    pub alpha_x: f32,
    /// The same along the second tangent.
    pub alpha_y: f32,
}

/// `(1 + erf x) / 2` and `exp(-x²)`, the first off by at most 1e-7 [Abramowitz and Stegun 1964, 7.1.26].
fn gaussian_cdf(x: f32) -> (f32, f32) {
    let bell = exp(-sqr(x));
    let t = 1.0 / (1.0 + 0.327_591_1 * x.abs());
    let series =
        t * (0.254_829_6 + t * (-0.284_496_74 + t * (1.421_413_7 + t * (-1.453_152 + t * 1.061_405_4))));
    let tail = 0.5 * series * bell;
    (if x < 0.0 { tail } else { 1.0 - tail }, bell)
}

/// Area of the facets that face a direction, projected, for alpha 1: p of the module's text, up to a slope `x`.
fn projected_area(x: f32, sin: f32, cos: f32) -> f32 {
    let (cdf, bell) = gaussian_cdf(x);
    cos * cdf + sin * HALF_RSQRT_PI * bell
}

impl Beckmann {
    /// s(w) of the module's text.
    fn s(self, w: Vector3) -> f32 {
        (sqr(self.alpha_x * w.x) + sqr(self.alpha_y * w.y)).sqrt()
    }

    /// p(w) of the module's text.
    fn p(self, w: Vector3) -> f32 {
        let (c, s) = (w.z.abs(), self.s(w));
        // Beyond a = 6 nothing is hidden in single precision.
        if c > 6.0 * s { c } else { projected_area(c / s, s, c) }
    }
}

impl Facets for Beckmann {
    fn is_smooth(self) -> bool {
        false
    }

    fn mean_alpha(self) -> f32 {
        0.5 * (self.alpha_x + self.alpha_y)
    }

    fn d(self, wm: Vector3) -> f32 {
        let z2 = sqr(wm.z).max(1e-18);
        let slope2 = (sqr(wm.x / self.alpha_x) + sqr(wm.y / self.alpha_y)) / z2;
        exp(-slope2) / (PI * self.alpha_x * self.alpha_y * sqr(z2)) // [Heitz 2014 (80)]
    }

    fn g_over_cosines(self, wo: Vector3, wi: Vector3) -> f32 {
        let (c_o, c_i) = (wo.z.abs(), wi.z.abs());
        // Finite, since D may be 0 along the horizon.
        (1.0 / (c_i * self.p(wo) + c_o * self.p(wi) - c_o * c_i)).min(1e30)
    }

    fn g_over_g1(self, wo: Vector3, wi: Vector3) -> f32 {
        wi.z.abs() * self.p(wo) * self.g_over_cosines(wo, wi)
    }

    fn visible_normal_pdf(self, wo: Vector3, wm: Vector3) -> f32 {
        self.d(wm) * wo.dot(wm).abs() / self.p(wo)
    }

    fn sample_visible_normal(self, wo: Vector3, u: Point2) -> Vector3 {
        let wo = if wo.z < 0.0 { -wo } else { wo };
        // Stretch space so that alpha is 1, and turn so that the viewer is above the x axis.
        let s = self.s(wo);
        let length = s.hypot(wo.z);
        let (sin, cos) = (s / length, wo.z / length);
        let (cos_phi, sin_phi) =
            if s > 0.0 { (self.alpha_x * wo.x / s, self.alpha_y * wo.y / s) } else { (1.0, 0.0) };
        let x = sample_visible_slope(u.x, sin, cos);
        let y = warp::sample_normal(u.y.clamp(1e-7, 1.0 - 1e-7), 0.0, FRAC_1_SQRT_2);
        let slope_x = cos_phi * x - sin_phi * y;
        let slope_y = sin_phi * x + cos_phi * y;
        Vector3::new(-self.alpha_x * slope_x, -self.alpha_y * slope_y, 1.0).normalized()
    }
}

/// The slope with density `(cos - x sin) exp(-x²)/sqrt(pi)`, normalised, below cos/sin.
fn sample_visible_slope(u: f32, sin: f32, cos: f32) -> f32 {
    const STEEPEST: f32 = 6.0;
    let (mut low, mut high) = (-STEEPEST, if cos < STEEPEST * sin { cos / sin } else { STEEPEST });
    let target = u * projected_area(high, sin, cos);
    let mut x = (-0.5_f32).min(0.5 * (low + high));
    for _ in 0..24 {
        let (cdf, bell) = gaussian_cdf(x);
        let error = cos * cdf + sin * HALF_RSQRT_PI * bell - target;
        if error < 0.0 {
            low = x;
        } else {
            high = x;
        }
        let slope = (cos - x * sin) * 2.0 * HALF_RSQRT_PI * bell;
        let newton = x - error / slope;
        // Halve the bracket where Newton's step would leave it.
        let next = if newton > low && newton < high { newton } else { 0.5 * (low + high) };
        if (next - x).abs() < 2e-6 {
            return next;
        }
        x = next;
    }
    x
}
