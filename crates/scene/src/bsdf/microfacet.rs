//! Rough interfaces as many small mirrors: the distribution of Trowbridge and Reitz, known as GGX.
//!
//! The density of facet normals `wm` is `D(wm) = 1 / (pi ax ay (x²/ax² + y²/ay² + z²)²)`, the fraction of facets seen
//! from `w` is Smith's `G1(w) = 1 / (1 + Lambda(w))` with `Lambda = (sqrt(1 + a² tan²) - 1) / 2`, and
//! from two directions `G = 1 / (1 + Lambda(wo) + Lambda(wi))`, heights correlated.
//! (Trowbridge and Reitz 1975, "Average irregularity representation of a rough surface for ray reflection";
//! Walter et al. 2007, "Microfacet Models for Refraction through Rough Surfaces"; Heitz 2014, "Understanding the
//! Masking-Shadowing Function in Microfacet-Based BRDFs"; normals visible from `wo` are sampled as in Heitz 2018,
//! "Sampling the GGX Distribution of Visible Normals".)
//!
//! Light that bounces several times among facets is lost: a white metal, lit along the normal, keeps 99 % of it at
//! alpha 0.1, 69 % at 0.5 and 1 - ln 2 = 31 % at 1. All formulas use `s(w) = sqrt(ax² x² + ay² y² + z²)`, which
//! keeps them finite at grazing angles: `G1(w) / |z| = 2 / (|z| + s(w))`.

use std::f32::consts::PI;

use etendue_math::{Point2, Vector3, sqr, warp};

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
        let stretched = sqr(wm.x / self.alpha_x) + sqr(wm.y / self.alpha_y) + sqr(wm.z);
        1.0 / (PI * self.alpha_x * self.alpha_y * sqr(stretched)) // [Heitz 2014 (85)]
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
    /// visible normals are sampled, where `wm` is the facet that reflects `wo` to `wi`.
    #[inline]
    #[must_use]
    pub fn reflection(self, wo: Vector3, wi: Vector3, wm: Vector3) -> (f32, f32) {
        let half_d = 0.5 * self.d(wm);
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
        // Stretch space so that the distribution becomes a hemisphere seen from `wh`.
        let wh = Vector3::new(self.alpha_x * wo.x, self.alpha_y * wo.y, wo.z).normalized();
        let wh = if wh.z < 0.0 { -wh } else { wh };
        let length_xy = (sqr(wh.x) + sqr(wh.y)).sqrt();
        let t1 = if wh.z < 0.99999 && length_xy > 0.0 {
            Vector3::new(-wh.y / length_xy, wh.x / length_xy, 0.0)
        } else {
            Vector3::new(1.0, 0.0, 0.0)
        };
        let t2 = wh.cross(t1);
        // A point on the projected hemisphere: half of the disk is squeezed to the visible part.
        let disk = warp::sample_polar_disk(u);
        let h = (1.0 - sqr(disk.x)).max(0.0).sqrt();
        let blend = 0.5 * (1.0 + wh.z);
        let y = (1.0 - blend) * h + blend * disk.y;
        let z = (1.0 - sqr(disk.x) - sqr(y)).max(0.0).sqrt();
        let nh = t1 * disk.x + t2 * y + wh * z;
        Vector3::new(self.alpha_x * nh.x, self.alpha_y * nh.y, nh.z.max(1e-6)).normalized()
    }
}
