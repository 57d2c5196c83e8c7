//! Mirrors in V-shaped grooves, the first models of microfacets (Torrance and Sparrow 1967, "Theory for Off-Specular
//! Reflection From Roughened Surfaces"; Cook and Torrance 1982, "A Reflectance Model for Computer Graphics").
//!
//! `f = k_d/pi + s D(h) F(wo·h) G / (4 cos_o cos_i)` (SPEC BRDF-16, BRDF-17), where each facet faces one of equal
//! slope, so that `G = min(1, 2 (n·h) cos_o / (wo·h), 2 (n·h) cos_i / (wo·h))`. The facets' angle `delta` from the
//! normal is distributed as Torrance and Sparrow have it, `D = c exp(-delta²/m²)`, or after Beckmann, as Cook and
//! Torrance, `D = exp(-tan² delta / m²) / (pi m² cos⁴ delta)`; both are scaled to `∫ D cos delta dw = 1`. (The paper
//! of 1982 has pi where 4 is right.) Reciprocal; what bounces twice in a groove is lost.

use std::f32::consts::{FRAC_1_PI, FRAC_PI_2, PI};
use std::sync::OnceLock;

use etendue_math::approx::{atan2, exp, ln_1p, sin_cos_turns};
use etendue_math::{Point2, Vector3, sqr};
use etendue_spectrum::Sampled;

use super::lobed::{Lobed, Shares};
use super::powers::{half_vector, widened_alpha};
use super::ward::sample_slopes;
use crate::bsdf::fresnel::{fresnel_conductor, reflect, schlick_weight};

/// How the facets' normals are distributed.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum FacetDistribution {
    /// A Gaussian of the angle.
    Gaussian,
    /// A Gaussian of the slope.
    Beckmann,
}

/// What a facet reflects.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum FacetFresnel {
    /// By Fresnel's equations.
    Exact {
        /// Real part of the index of refraction.
        eta: Sampled,
        /// Imaginary part.
        k: Sampled,
    },
    /// By Schlick's fit, from the reflectance along the normal.
    Schlick(Sampled),
}

impl FacetFresnel {
    #[inline]
    fn at(&self, cos: f32) -> Sampled {
        match *self {
            Self::Exact { eta, k } => fresnel_conductor(cos, eta, k),
            Self::Schlick(f0) => f0 + (Sampled::ONE - f0) * schlick_weight(cos),
        }
    }
}

/// Reflection of grooves in the shading frame.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct VGroove {
    /// Diffuse albedo.
    pub kd: Sampled,
    /// What facets reflect.
    pub fresnel: FacetFresnel,
    /// Share of the light that meets facets, s; `k_d + s` is at most 1.
    pub strength: f32,
    /// Root mean square of angle or slope, times the square root of 2.
    pub m: f32,
    /// Distribution of the facets.
    pub distribution: FacetDistribution,
}

impl VGroove {
    /// With a wider highlight.
    pub(super) fn regularized(self) -> Self {
        Self { m: widened_alpha(self.m), ..self }
    }

    /// `D(h)` in 1/sr.
    #[inline]
    fn d(&self, h: Vector3) -> f32 {
        let m2 = sqr(self.m);
        match self.distribution {
            FacetDistribution::Gaussian => gaussian_scale(self.m) * exp(-sqr(angle(h)) / m2),
            FacetDistribution::Beckmann => {
                let cos2 = sqr(h.z);
                exp(-(sqr(h.x) + sqr(h.y)) / (cos2 * m2)) / (PI * m2 * sqr(cos2).max(f32::MIN_POSITIVE))
            }
        }
    }

    /// Density of sampled half vectors in 1/sr: `D cos delta` for Beckmann's, `delta exp(-delta²/m²)` over `sin
    /// delta` for the Gaussian.
    #[inline]
    fn half_pdf(&self, h: Vector3) -> f32 {
        match self.distribution {
            FacetDistribution::Beckmann => self.d(h) * h.z,
            FacetDistribution::Gaussian => {
                let (delta, sin) = (angle(h), (sqr(h.x) + sqr(h.y)).sqrt());
                let m2 = sqr(self.m);
                let ratio = if sin > 0.0 { delta / sin } else { 1.0 };
                ratio * exp(-sqr(delta) / m2) / (PI * m2 * self.gaussian_mass())
            }
        }
    }

    /// Share of `2 delta/m² exp(-delta²/m²)` that is below 90°.
    #[inline]
    fn gaussian_mass(&self) -> f32 {
        1.0 - exp(-sqr(FRAC_PI_2 / self.m))
    }

    fn sample_half(&self, u: Point2) -> Vector3 {
        match self.distribution {
            FacetDistribution::Beckmann => sample_slopes(u, self.m, self.m),
            FacetDistribution::Gaussian => {
                let delta = self.m * (-ln_1p(-u.x * self.gaussian_mass())).sqrt();
                let (sin, cos) = delta.sin_cos();
                let (sin_phi, cos_phi) = sin_cos_turns(u.y);
                Vector3::new(sin * cos_phi, sin * sin_phi, cos.max(0.0))
            }
        }
    }
}

/// The half vector, and its cosine with both directions, which is positive and the same if they are exchanged.
#[inline]
fn facet(to: Vector3, from: Vector3) -> Option<(Vector3, f32)> {
    Some((half_vector(to, from)?, 0.5 * (to + from).length()))
}

/// The angle between a unit vector of the upper hemisphere and the normal.
#[inline]
fn angle(h: Vector3) -> f32 {
    atan2((sqr(h.x) + sqr(h.y)).sqrt(), h.z)
}

/// c of the Gaussian distribution: 1 over `2 pi ∫ exp(-delta²/m²) cos delta sin delta d delta`, for m in (0, 1].
///
/// The integral is `m²/2` times a smooth function, of which a table holds the values at equal steps.
#[inline]
fn gaussian_scale(m: f32) -> f32 {
    const N: usize = 64;
    static TABLE: OnceLock<[f32; N + 1]> = OnceLock::new();
    let table = TABLE.get_or_init(|| std::array::from_fn(|i| gaussian_integral(i as f64 / N as f64) as f32));
    let place = m.clamp(0.0, 1.0) * N as f32;
    let i = (place as usize).min(N - 1);
    let t = place - i as f32;
    let integral = table[i] + t * (table[i + 1] - table[i]);
    1.0 / (PI * sqr(m) * integral)
}

/// `2/m² ∫ exp(-delta²/m²) cos delta sin delta d delta` from 0 to 90°, by Simpson's rule over `x = delta / m`.
fn gaussian_integral(m: f64) -> f64 {
    if m == 0.0 {
        return 1.0;
    }
    let end = (std::f64::consts::FRAC_PI_2 / m).min(7.0);
    let f = |x: f64| (-x * x).exp() * (2.0 * m * x).sin() / m;
    let n = 400;
    let step = end / f64::from(n);
    let weight = |i: i32| if i == 0 || i == n { 1.0 } else { f64::from(2 + 2 * (i % 2)) };
    (0..=n).map(|i| weight(i) * f(f64::from(i) * step)).sum::<f64>() * step / 3.0
}

impl Lobed for VGroove {
    fn diffuse(&self, _to: Vector3, _from: Vector3) -> Sampled {
        self.kd * FRAC_1_PI
    }

    fn glossy(&self, to: Vector3, from: Vector3) -> Sampled {
        let Some((h, cos)) = facet(to, from) else { return Sampled::ZERO };
        // G / (cos_o cos_i), which stays finite: the smaller cosine masks.
        let g = (2.0 * h.z / cos / to.z.max(from.z)).min(1.0 / (to.z * from.z));
        self.fresnel.at(cos) * (0.25 * self.strength * self.d(h) * g) // [SPEC BRDF-16]
    }

    fn shares(&self, wo: Vector3) -> Shares {
        let glossy = self.strength * self.fresnel.at(wo.z).max_value().max(0.05);
        Shares { diffuse: self.kd.max_value(), glossy, mirror: 0.0 }
    }

    fn sample_glossy(&self, wo: Vector3, _u_choice: f32, u: Point2) -> Option<Vector3> {
        let h = self.sample_half(u);
        (wo.dot(h) > 0.0).then(|| reflect(wo, h))
    }

    fn glossy_pdf(&self, wo: Vector3, wi: Vector3) -> f32 {
        let Some((h, cos)) = facet(wo, wi) else { return 0.0 };
        self.half_pdf(h) / (4.0 * cos)
    }

    fn alpha(&self) -> f32 {
        self.m
    }
}
