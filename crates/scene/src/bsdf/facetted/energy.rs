//! How much light leaves a surface of mirror facets after one bounce, tabulated once from our own integrals.
//!
//! `E(cos, alpha)` is the albedo of lossless facets towards a direction, `E_avg(alpha) = 2 ∫ E cos d cos` its mean; B
//! is the same for facets that reflect `(1 - wo·h)⁵`, so that those of Schlick's fit reflect `F0 (E - B) + B`. The
//! tables are even in `sqrt(cos)`, which is how E rises from grazing, and in `sqrt(alpha)`; between entries they are
//! bilinear (of the narrowest facets in alpha²), and the mean is that of the interpolated function.
//!
//! For a transparent interface E counts what is reflected and refracted, as flux; it depends on the relative index too. There
//! is a table for each of some indices, even in the root of `(eta - 1)/(eta + 1)` since what is totally reflected changes
//! quickly where indices are nearly equal; each is computed when it is first needed.

use std::sync::OnceLock;

use etendue_math::{Point2, Vector3, lerp, sqr, unit_f32};

use super::{AnyFacets, FacetShape, Facets, FresnelForm};
use crate::bsdf::fresnel::{reflect, refract, schlick_weight};
use crate::bsdf::microfacet::Microfacets;

/// Entries along each axis.
pub(super) const N: usize = 32;
/// Parts into which what facets reflect is divided.
pub(super) const N_PARTS: usize = 3;
/// Facets per entry.
const N_POINTS: u32 = 2048;

/// A function of cosine and alpha, and its means.
pub(super) struct Table {
    /// At `alpha = (i / (N - 1))²`, `cos = (j / (N - 1))²`.
    values: [[f32; N]; N],
    /// `2 ∫ value cos d cos` at the same alphas.
    means: [f32; N],
}

/// The tables of one shape.
pub(super) struct EnergyTable {
    /// E.
    albedo: Table,
    /// `B - (1 - cos)⁵`, which is small for narrow facets.
    grazing: Table,
    /// Means of `wo·h` over the [`N_PARTS`] parts of what is reflected, by rising `wo·h`.
    cosines: [Table; N_PARTS],
}

/// Where the entries of a table are along either axis.
pub(super) fn square(i: usize) -> f32 {
    sqr(i as f32 / (N - 1) as f32)
}

/// The entry below a place in [0, 1], and the share of the next one.
#[inline]
fn place(x: f32) -> (usize, f32) {
    let x = x.clamp(0.0, 1.0) * (N - 1) as f32;
    let i = (x as usize).min(N - 2);
    (i, x - i as f32)
}

/// The row below an alpha, and the share of the next one.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Row {
    below: u32,
    share: f32,
}

impl Row {
    /// What the narrowest facets lose grows with alpha².
    #[inline]
    pub(super) fn of(alpha: f32) -> Self {
        let (i, share) = place(alpha.sqrt());
        if i > 2 {
            return Self { below: i as u32, share };
        }
        let [low, high] = [i, i + 1].map(|i| sqr(square(i)));
        Self { below: i as u32, share: (sqr(alpha) - low) / (high - low) }
    }
}

/// The column below a cosine, and the share of the next one.
#[inline]
fn column(cos: f32) -> (usize, f32) {
    place(cos.max(0.0).sqrt())
}

impl Table {
    pub(super) fn new(values: [[f32; N]; N]) -> Self {
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

    #[inline]
    pub(super) fn at(&self, cos: f32, alpha: f32) -> f32 {
        self.between(column(cos), Row::of(alpha))
    }

    /// The value between entries.
    #[inline]
    fn between(&self, (j, along_cos): (usize, f32), row: Row) -> f32 {
        let i = row.below as usize;
        let at = |i: usize| lerp(along_cos, self.values[i][j], self.values[i][j + 1]);
        lerp(row.share, at(i), at(i + 1))
    }

    fn mean(&self, alpha: f32) -> f32 {
        let Row { below, share } = Row::of(alpha);
        lerp(share, self.means[below as usize], self.means[below as usize + 1])
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
        let (mut albedo, mut grazing) = ([[0.0; N]; N], [[0.0; N]; N]);
        let mut cosines = [[[0.0; N]; N]; N_PARTS];
        for (i, j) in (0..N).flat_map(|i| (0..N).map(move |j| (i, j))) {
            let (alpha, cos) = (square(i), square(j));
            let bounce = if i == 0 { OneBounce::of_mirror(cos) } else { OneBounce::new(shape, alpha, cos) };
            (albedo[i][j], grazing[i][j]) = (bounce.albedo, bounce.grazing);
            cosines.iter_mut().zip(bounce.cosines).for_each(|(table, cosine)| table[i][j] = cosine);
        }
        Self { albedo: Table::new(albedo), grazing: Table::new(grazing), cosines: cosines.map(Table::new) }
    }

    /// `E(cos, alpha)`, for alpha up to 1.
    #[inline]
    pub(super) fn albedo(&self, cos: f32, alpha: f32) -> f32 {
        self.albedo.at(cos, alpha)
    }

    /// `E_avg(alpha)`.
    pub(super) fn mean(&self, alpha: f32) -> f32 {
        self.albedo.mean(alpha)
    }

    /// E, and B: the same with facets that reflect `(1 - wo·h)⁵`.
    #[inline]
    pub(super) fn albedos(&self, cos: f32, alpha: f32) -> (f32, f32) {
        self.albedos_in(cos, Row::of(alpha))
    }

    /// The same, of a row.
    #[inline]
    pub(super) fn albedos_in(&self, cos: f32, row: Row) -> (f32, f32) {
        let column = column(cos);
        (self.albedo.between(column, row), self.grazing.between(column, row) + schlick_weight(cos))
    }

    /// E of a row.
    #[inline]
    pub(super) fn albedo_in(&self, cos: f32, row: Row) -> f32 {
        self.albedo.between(column(cos), row)
    }

    /// Cosines `wo·h` that stand for equal parts of what is reflected.
    pub(super) fn cosines(&self, cos: f32, alpha: f32) -> [f32; N_PARTS] {
        std::array::from_fn(|part| self.cosines[part].at(cos, alpha))
    }

    /// `2 ∫ B cos d cos`.
    pub(super) fn grazing_mean(&self, alpha: f32) -> f32 {
        self.grazing.mean(alpha) + 1.0 / 21.0
    }
}

/// What facets of some alpha reflect to a direction, at the first bounce.
struct OneBounce {
    /// Albedo of lossless facets.
    albedo: f32,
    /// That of facets that reflect `(1 - wo·h)⁵`, less `(1 - cos)⁵`.
    grazing: f32,
    /// Means of `wo·h` over parts.
    cosines: [f32; N_PARTS],
}

impl OneBounce {
    const fn of_mirror(cos: f32) -> Self {
        Self { albedo: 1.0, grazing: 0.0, cosines: [cos; N_PARTS] }
    }

    fn new(shape: FacetShape, alpha: f32, cos: f32) -> Self {
        let facets = AnyFacets { alphas: Microfacets::new(alpha, alpha), shape, fresnel: FresnelForm::Exact };
        let reflected: Vec<(f32, f64)> = visible_facets(facets, cos, N_POINTS)
            .filter_map(|(wo, wm)| {
                let wi = reflect(wo, wm);
                (wi.z > 0.0).then(|| (wo.dot(wm), f64::from(facets.g_over_g1(wo, wi))))
            })
            .collect();
        let sum: f64 = reflected.iter().map(|(_, weight)| weight).sum();
        let grazing: f64 = reflected.iter().map(|(c, weight)| weight * f64::from(schlick_weight(*c))).sum();
        let n = f64::from(N_POINTS);
        Self {
            albedo: (sum / n) as f32,
            grazing: (grazing / n - f64::from(schlick_weight(cos.max(LEAST_COSINE)))) as f32,
            cosines: means_of_parts(reflected, sum),
        }
    }
}

/// Weighted means of the numbers over parts of equal weight, from the lowest to the highest.
fn means_of_parts(mut weighted: Vec<(f32, f64)>, sum: f64) -> [f32; N_PARTS] {
    weighted.sort_by(|a, b| a.0.total_cmp(&b.0));
    let mut means = [0.0_f64; N_PARTS];
    let mut before = 0.0;
    for (number, weight) in weighted {
        let middle = (before + 0.5 * weight) / sum;
        let part = ((middle * N_PARTS as f64) as usize).min(N_PARTS - 1);
        means[part] += f64::from(number) * weight;
        before += weight;
    }
    means.map(|mean| (mean * N_PARTS as f64 / sum) as f32)
}

/// Below this a direction counts as this.
const LEAST_COSINE: f32 = 1e-4;

/// A direction of that cosine, with even points of the normals visible from it.
fn visible_facets(facets: AnyFacets, cos: f32, n_points: u32) -> impl Iterator<Item = (Vector3, Vector3)> {
    // Multiples of the powers of 1/g with g³ = g + 1 (Roberts 2018), as shares of 2³².
    const STEPS: [u32; 2] = [3_242_174_889, 2_447_445_414];
    let cos = cos.max(LEAST_COSINE);
    let wo = Vector3::new((1.0 - sqr(cos)).max(0.0).sqrt(), 0.0, cos);
    (0..n_points).map(move |k| {
        let [x, y] = STEPS.map(|step| unit_f32(step.wrapping_mul(k).wrapping_add(1 << 31)));
        (wo, facets.sample_visible_normal(wo, Point2::new(x, y)))
    })
}

/// Relative indices with a table.
const N_INDICES: usize = 49;
/// Facets per entry of these tables.
const N_INTERFACE_POINTS: u32 = 1024;

/// E of a transparent interface at one relative index.
#[derive(Clone, Copy)]
pub(super) struct InterfaceEnergy {
    /// Tables of the neighbouring indices.
    tables: [&'static Table; 2],
    /// How far the index is from the first to the second.
    share: f32,
}

impl InterfaceEnergy {
    /// Of facets between media whose indices have the ratio `eta`, seen from the first.
    pub(super) fn of(facets: AnyFacets, eta: f32) -> Self {
        let contrast = (eta - 1.0) / (eta + 1.0);
        let root = contrast.abs().sqrt().copysign(contrast);
        let x = 0.5 * (root + 1.0) * (N_INDICES - 1) as f32;
        let i = (x as usize).min(N_INDICES - 2);
        let table = |i| interface_table(facets.shape, facets.fresnel, i);
        Self { tables: [table(i), table(i + 1)], share: x - i as f32 }
    }

    /// `E(cos, alpha)`, for alpha up to 1.
    pub(super) fn albedo(&self, cos: f32, alpha: f32) -> f32 {
        lerp(self.share, self.tables[0].at(cos, alpha), self.tables[1].at(cos, alpha))
    }

    /// `E_avg(alpha)`.
    pub(super) fn mean(&self, alpha: f32) -> f32 {
        lerp(self.share, self.tables[0].mean(alpha), self.tables[1].mean(alpha))
    }
}

/// The table of an index; computed at the first call.
fn interface_table(shape: FacetShape, fresnel: FresnelForm, i: usize) -> &'static Table {
    type Tables = [OnceLock<Box<Table>>; N_INDICES];
    static GGX: [Tables; 2] = [const { [const { OnceLock::new() }; N_INDICES] }; 2];
    static BECKMANN: [Tables; 2] = [const { [const { OnceLock::new() }; N_INDICES] }; 2];
    let forms = match shape {
        FacetShape::Ggx => &GGX,
        FacetShape::Beckmann => &BECKMANN,
    };
    let tables = match fresnel {
        FresnelForm::Exact => &forms[0],
        FresnelForm::Schlick => &forms[1],
    };
    tables[i].get_or_init(|| {
        // At both ends one index is infinitely larger; in the middle both are equal.
        let root = (2.0 * i as f32 / (N_INDICES - 1) as f32 - 1.0).clamp(-0.999, 0.999);
        let contrast = root * root.abs();
        Box::new(interface_energy(shape, fresnel, (1.0 + contrast) / (1.0 - contrast)))
    })
}

fn interface_energy(shape: FacetShape, fresnel: FresnelForm, eta: f32) -> Table {
    let mut values = [[1.0; N]; N];
    for (i, j) in (1..N).flat_map(|i| (0..N).map(move |j| (i, j))) {
        let facets = AnyFacets { alphas: Microfacets::new(square(i), square(i)), shape, fresnel };
        let leaving = visible_facets(facets, square(j), N_INTERFACE_POINTS)
            .map(|(wo, wm)| f64::from(leaving_once(facets, eta, wo, wm)));
        values[i][j] = (leaving.sum::<f64>() / f64::from(N_INTERFACE_POINTS)).min(1.0) as f32;
    }
    Table::new(values)
}

/// Flux from `wo` that a facet `wm` reflects or refracts to the outside.
fn leaving_once(facets: AnyFacets, eta: f32, wo: Vector3, wm: Vector3) -> f32 {
    let f = facets.reflectance(wo.dot(wm), eta);
    let reflected = Some(reflect(wo, wm)).filter(|wi| wi.z > 0.0);
    let refracted = refract(wo, wm, eta).map(|refraction| refraction.wt).filter(|wi| wi.z < 0.0);
    let passed = |wi: Option<Vector3>| wi.map_or(0.0, |wi| facets.g_over_g1(wo, wi));
    f * passed(reflected) + (1.0 - f) * passed(refracted)
}
