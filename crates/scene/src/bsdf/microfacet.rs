//! Rough interfaces as many small mirrors: the distribution of Trowbridge and Reitz, known as GGX.
//!
//! The density of facet normals `wm` is `D(wm) = 1 / (pi ax ay (x²/ax² + y²/ay² + z²)²)`, the fraction of facets seen
//! from `w` is Smith's `G1(w) = 1 / (1 + Lambda(w))` with `Lambda = (sqrt(1 + a² tan²) - 1) / 2`, and
//! from two directions `G = 1 / (1 + Lambda(wo) + Lambda(wi))`, heights correlated.
//! (Trowbridge and Reitz 1975, "Average irregularity representation of a rough surface for ray reflection";
//! Walter et al. 2007, "Microfacet Models for Refraction through Rough Surfaces"; Heitz 2014, "Understanding the
//! Masking-Shadowing Function in Microfacet-Based BRDFs"; normals visible from `wo` are sampled as in Dupuy and Benyoub 2023,
//! "Sampling Visible GGX Normals with Spherical Caps".)
//!
//! Light that bounces several times among facets is lost: a white metal, lit along the normal, keeps 99 % of it at
//! alpha 0.1, 69 % at 0.5 and 1 - ln 2 = 31 % at 1. All formulas use `s(w) = sqrt(ax² x² + ay² y² + z²)`, which
//! keeps them finite at grazing angles: `G1(w) / |z| = 2 / (|z| + s(w))`.

use std::f32::consts::FRAC_1_PI;

use etendue_math::approx::sin_cos_turns;
use etendue_math::{Point2, Vector3, sqr};

/// A GGX distribution of facet normals in the shading frame.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Microfacets {
    alpha_x: f32,
    alpha_y: f32,
}

impl Microfacets {
    /// Below this alpha a surface counts as perfectly smooth.
    pub const SMOOTH_BELOW: f32 = 1e-3;

    /// From the alpha along both tangents: the root mean square slope is about alpha.
    #[inline]
    #[must_use]
    pub fn new(alpha_x: f32, alpha_y: f32) -> Self {
        if alpha_x.max(alpha_y) < Self::SMOOTH_BELOW {
            return Self { alpha_x, alpha_y };
        }
        Self { alpha_x: alpha_x.max(1e-4), alpha_y: alpha_y.max(1e-4) }
    }

    /// The alpha of a perceptual roughness in [0, 1]: its square root, as in pbrt-v4.
    #[inline]
    #[must_use]
    pub fn alpha_from_roughness(roughness: f32) -> f32 {
        roughness.max(0.0).sqrt()
    }

    /// True if the surface is treated as a perfect mirror or lens.
    #[inline]
    #[must_use]
    pub fn is_smooth(self) -> bool {
        self.alpha_x.max(self.alpha_y) < Self::SMOOTH_BELOW
    }

    /// Alpha along both tangents.
    #[inline]
    #[must_use]
    pub const fn alpha(self) -> (f32, f32) {
        (self.alpha_x, self.alpha_y)
    }

    /// Mean of both alphas, 0 if smooth.
    #[inline]
    #[must_use]
    pub fn mean_alpha(self) -> f32 {
        if self.is_smooth() { 0.0 } else { 0.5 * (self.alpha_x + self.alpha_y) }
    }

    /// A wider distribution for paths that have already scattered: alpha below 0.3 is doubled, to within [0.1, 0.3].
    #[inline]
    #[must_use]
    pub fn regularized(self) -> Self {
        let widen = |alpha: f32| if alpha < 0.3 { (2.0 * alpha).clamp(0.1, 0.3) } else { alpha };
        Self { alpha_x: widen(self.alpha_x), alpha_y: widen(self.alpha_y) }
    }

    /// `D(wm)` in 1/sr: facet area per surface area and solid angle. Its integral times the cosine is 1.
    #[inline]
    #[must_use]
    pub fn d(self, wm: Vector3) -> f32 {
        self.d_along(wm, 1.0)
    }

    /// `D` along a vector of any length that is not 0, from its squared length.
    #[inline]
    fn d_along(self, v: Vector3, length2: f32) -> f32 {
        let area = self.alpha_x * self.alpha_y;
        let stretched = sqr(v.x * self.alpha_y) + sqr(v.y * self.alpha_x) + sqr(v.z * area);
        sqr(length2 / stretched) * (area * sqr(area) * FRAC_1_PI) // [Heitz 2014 (85)]
    }

    /// `s(w)` of the module's text.
    #[inline]
    fn s(self, w: Vector3) -> f32 {
        (sqr(self.alpha_x * w.x) + sqr(self.alpha_y * w.y) + sqr(w.z)).sqrt()
    }

    /// Fraction of facets visible from `w`, averaged over facet orientation.
    #[inline]
    #[must_use]
    pub fn g1(self, w: Vector3) -> f32 {
        2.0 * w.z.abs() / (w.z.abs() + self.s(w))
    }

    /// Fraction of facets visible from both directions.
    #[inline]
    #[must_use]
    pub fn g(self, wo: Vector3, wi: Vector3) -> f32 {
        self.g_over_cosines(wo, wi) * (wo.z * wi.z).abs()
    }

    /// `G(wo, wi) / (|cos_o| |cos_i|)`.
    #[inline]
    #[must_use]
    pub fn g_over_cosines(self, wo: Vector3, wi: Vector3) -> f32 {
        2.0 / (self.s(wo) * wi.z.abs() + self.s(wi) * wo.z.abs())
    }

    /// `G(wo, wi) / G1(wo)`: what remains of the weight if visible normals are sampled.
    #[inline]
    #[must_use]
    pub fn g_over_g1(self, wo: Vector3, wi: Vector3) -> f32 {
        let (cos_o, cos_i) = (wo.z.abs(), wi.z.abs());
        let s_o = self.s(wo);
        cos_i * (cos_o + s_o) / (s_o * cos_i + self.s(wi) * cos_o)
    }

    /// `D(wm) G(wo, wi) / (4 |cos_o| |cos_i|)`, mirror reflection but for Fresnel's factor, and the density in 1/sr of `wi` if
    /// visible normals are sampled, where `wm`, of any length, is normal to the facet that reflects `wo` to `wi`.
    #[inline]
    #[must_use]
    pub fn reflection(self, wo: Vector3, wi: Vector3, wm: Vector3) -> (f32, f32) {
        let half_d = 0.5 * self.d_along(wm, wm.length_squared());
        let (cos_o, cos_i) = (wo.z.abs(), wi.z.abs());
        let s_o = self.s(wo);
        (half_d / (s_o * cos_i + self.s(wi) * cos_o), half_d / (cos_o + s_o))
    }

    /// Density in 1/sr of the normals visible from `wo`: `D(wm) G1(wo) |wo·wm| / |cos_o|`.
    #[inline]
    #[must_use]
    pub fn visible_normal_pdf(self, wo: Vector3, wm: Vector3) -> f32 {
        2.0 * self.d(wm) * wo.dot(wm).abs() / (wo.z.abs() + self.s(wo))
    }

    /// A normal visible from `wo`, in the upper hemisphere; density [`Self::visible_normal_pdf`].
    #[inline]
    #[must_use]
    pub fn sample_visible_normal(self, wo: Vector3, u: Point2) -> Vector3 {
        self.sample_facet(wo, u).normalized()
    }

    /// [`Self::sample_visible_normal`] times a length.
    #[inline]
    #[must_use]
    pub fn sample_facet(self, wo: Vector3, u: Point2) -> Vector3 {
        // Stretched space has a hemisphere in place of the distribution, and mirrors `wh` evenly into a cap of the sphere.
        let wh = Vector3::new(self.alpha_x * wo.x, self.alpha_y * wo.y, wo.z).normalized();
        let wh = if wh.z < 0.0 { -wh } else { wh };
        let depth = u.x * (1.0 + wh.z);
        let sin = (depth * (2.0 - depth)).max(0.0).sqrt();
        let (sin_phi, cos_phi) = sin_cos_turns(u.y);
        // The half vector of `wh` and its mirror image (sin cos_phi, sin sin_phi, 1 - depth).
        let h = Vector3::new(sin * cos_phi + wh.x, sin * sin_phi + wh.y, (1.0 - depth + wh.z).max(1e-6));
        Vector3::new(self.alpha_x * h.x, self.alpha_y * h.y, h.z)
    }
}
