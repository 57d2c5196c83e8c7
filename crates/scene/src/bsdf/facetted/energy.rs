//! How much light leaves a surface of mirror facets after one bounce, tabulated once from our own integrals.
//!
//! `E(cos, alpha)` is the albedo of lossless facets towards a direction, `E_avg(alpha) = 2 ∫ E cos d cos` its mean; B
//! is the same for facets that reflect `(1 - wo·h)⁵`, so that those of Schlick's fit reflect `F0 (E - B) + B`. The
//! tables are even in `sqrt(cos)`, which is how E rises from grazing, and in `sqrt(alpha)`; between entries they are
//! bilinear, and the mean is that of the interpolated function.

use std::sync::OnceLock;

use etendue_math::{Point2, Vector3, lerp, sqr, unit_f32};

use super::{AnyFacets, FacetShape, Facets, FresnelForm};
use crate::bsdf::fresnel::{reflect, schlick_weight};
use crate::bsdf::microfacet::Microfacets;

/// Entries along each axis.
const N: usize = 32;
/// Facets per entry.
const N_POINTS: u32 = 2048;

/// A function of cosine and alpha, and its means.
struct Table {
    /// At `alpha = (i / (N - 1))²`, `cos = (j / (N - 1))²`.
    values: [[f32; N]; N],
    /// `2 ∫ value cos d cos` at the same alphas.
    means: [f32; N],
}

/// The tables of one shape.
pub(super) struct EnergyTable {
    /// E.
    albedo: Table,
    /// B: the same times `(1 - wo·h)⁵`.
    grazing: Table,
}

/// The entry below a place in [0, 1], and the share of the next one.
fn place(x: f32) -> (usize, f32) {
    let x = x.clamp(0.0, 1.0) * (N - 1) as f32;
    let i = (x as usize).min(N - 2);
    (i, x - i as f32)
}

impl Table {
    fn new(values: [[f32; N]; N]) -> Self {
        Self { values, means: std::array::from_fn(|i| Self::mean_of(&values[i])) }
    }

    /// `2 ∫ value cos d cos` of a row, with `cos = t²`, by the midpoint rule.
    fn mean_of(row: &[f32; N]) -> f32 {
        const STEPS: usize = 32 * (N - 1);
        let term = |k: usize| {
            let t = (k as f64 + 0.5) / STEPS as f64;
            let (j, share) = place(t as f32);
            f64::from(lerp(share, row[j], row[j + 1])) * 4.0 * t.powi(3)
        };
        ((0..STEPS).map(term).sum::<f64>() / STEPS as f64) as f32
    }

    fn at(&self, cos: f32, alpha: f32) -> f32 {
        let (i, along_alpha) = place(alpha.sqrt());
        let (j, along_cos) = place(cos.max(0.0).sqrt());
        let row = |i: usize| lerp(along_cos, self.values[i][j], self.values[i][j + 1]);
        lerp(along_alpha, row(i), row(i + 1))
    }

    fn mean(&self, alpha: f32) -> f32 {
        let (i, share) = place(alpha.sqrt());
        lerp(share, self.means[i], self.means[i + 1])
    }
}

impl EnergyTable {
    /// The tables of a shape; computed at the first call.
    pub(super) fn of(shape: FacetShape) -> &'static Self {
        static GGX: OnceLock<EnergyTable> = OnceLock::new();
        static BECKMANN: OnceLock<EnergyTable> = OnceLock::new();
        match shape {
            FacetShape::Ggx => GGX.get_or_init(|| Self::compute(shape)),
            FacetShape::Beckmann => BECKMANN.get_or_init(|| Self::compute(shape)),
        }
    }

    fn compute(shape: FacetShape) -> Self {
        let square = |i: usize| sqr(i as f32 / (N - 1) as f32);
        let (mut albedo, mut grazing) = ([[0.0; N]; N], [[0.0; N]; N]);
        for (i, j) in (0..N).flat_map(|i| (0..N).map(move |j| (i, j))) {
            let (alpha, cos) = (square(i), square(j));
            [albedo[i][j], grazing[i][j]] =
                if i == 0 { [1.0, schlick_weight(cos)] } else { one_bounce(shape, alpha, cos) };
        }
        Self { albedo: Table::new(albedo), grazing: Table::new(grazing) }
    }

    /// `E(cos, alpha)`, for alpha up to 1.
    pub(super) fn albedo(&self, cos: f32, alpha: f32) -> f32 {
        self.albedo.at(cos, alpha)
    }

    /// `E_avg(alpha)`.
    pub(super) fn mean(&self, alpha: f32) -> f32 {
        self.albedo.mean(alpha)
    }

    /// `B(cos, alpha)`: E with facets that reflect `(1 - wo·h)⁵`.
    pub(super) fn grazing_albedo(&self, cos: f32, alpha: f32) -> f32 {
        self.grazing.at(cos, alpha)
    }

    /// `2 ∫ B cos d cos`.
    pub(super) fn grazing_mean(&self, alpha: f32) -> f32 {
        self.grazing.mean(alpha)
    }
}

/// The albedo of lossless facets after one bounce, the mean weight of visible normals at even points, and with
/// facets that reflect `(1 - wo·h)⁵`.
fn one_bounce(shape: FacetShape, alpha: f32, cos: f32) -> [f32; 2] {
    // Multiples of the powers of 1/g with g³ = g + 1 (Roberts 2018), as shares of 2³².
    const STEPS: [u32; 2] = [3_242_174_889, 2_447_445_414];
    let facets = AnyFacets { alphas: Microfacets::new(alpha, alpha), shape, fresnel: FresnelForm::Exact };
    let cos = cos.max(1e-4);
    let wo = Vector3::new((1.0 - sqr(cos)).max(0.0).sqrt(), 0.0, cos);
    let mut sums = [0.0_f64; 2];
    for k in 0..N_POINTS {
        let [x, y] = STEPS.map(|step| unit_f32(step.wrapping_mul(k).wrapping_add(1 << 31)));
        let wm = facets.sample_visible_normal(wo, Point2::new(x, y));
        let wi = reflect(wo, wm);
        if wi.z > 0.0 {
            let weight = f64::from(facets.g_over_g1(wo, wi));
            sums[0] += weight;
            sums[1] += weight * f64::from(schlick_weight(wo.dot(wm)));
        }
    }
    sums.map(|sum| (sum / f64::from(N_POINTS)) as f32)
}
