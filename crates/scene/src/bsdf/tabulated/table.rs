//! A grid with what is needed to sample it.
//!
//! For each range of the angle of view, half vectors are drawn from cells over (phi_h, theta_h), evenly in solid angle
//! within a cell, in proportion to `f cos_i 4 (wo·h)`; reflection of `wo` turns their density p_h into
//! `p_h / (4 wo·h)` (Torrance and Sparrow 1967). Rings of cells are as wide as the nodes of the grid are apart.

use std::f32::consts::{FRAC_1_PI, FRAC_PI_2, PI, TAU};
use std::sync::OnceLock;

use etendue_math::{Bounds2, PiecewiseConstant2, Point2, Vector3, lerp, sqr, warp};

use super::rejection::Rejection;
use super::{BrdfGrid, TableSampling};
use crate::bsdf::kept::Kept;

/// Rings of cells over theta_h.
const N_RINGS: usize = 32;
/// Cells of a ring.
const N_SECTORS: usize = 32;
/// Points of a cell along each side at which f is looked at.
const N_POINTS: usize = 2;
/// Share of samples that scatter evenly.
const EVEN: f32 = 0.1;

/// A table of a BRDF, ready to sample.
#[derive(Debug)]
pub struct BrdfTable {
    grid: BrdfGrid,
    /// f of the diffuse lobe.
    diffuse: [f32; 3],
    /// Half vectors of the glossy lobe, by angle of view: azimuth from that of `wo`, and ring.
    views: Vec<PiecewiseConstant2>,
    shares: [f32; 2],
    albedo_max: f32,
    alpha: f32,
    /// Computed if it is wanted.
    rejection: OnceLock<Rejection>,
}

impl BrdfTable {
    /// Number of ranges of the angle of view.
    pub const N_VIEWS: usize = 32;

    /// The table of a grid: one in a process for equal grids, never freed.
    #[must_use]
    pub fn of(grid: &BrdfGrid) -> &'static Self {
        static TABLES: Kept<BrdfTable> = Kept::new();
        TABLES.find_or_keep(|known| known.grid == *grid, || Self::new(grid.clone()))
    }

    fn new(grid: BrdfGrid) -> Self {
        let diffuse = grid.least();
        let (views, albedos): (Vec<_>, Vec<_>) =
            (0..Self::N_VIEWS).map(|view| half_vectors(&grid, diffuse, view)).unzip();
        let greatest = |c: usize| albedos.iter().map(|albedo| albedo[c]).fold(0.0, f32::max);
        let [glossy, even] = [[0, 1, 2].map(greatest), diffuse.map(|f| PI * f)];
        let albedo_max = (0..3).map(|c| glossy[c] + even[c]).fold(0.0, f32::max);
        let mean = |rgb: [f32; 3]| rgb.iter().sum::<f32>() / 3.0;
        // The rest of a constant is rounding.
        let glossy = Some(mean(glossy)).filter(|share| *share > 1e-4 * albedo_max).unwrap_or(0.0);
        let alpha = alpha_of_half_width(grid.half_width());
        Self {
            shares: [mean(even), glossy],
            grid,
            diffuse,
            views,
            albedo_max,
            alpha,
            rejection: OnceLock::new(),
        }
    }

    /// Greatest fraction of light that it reflects, over channels and the middles of the ranges of view.
    #[must_use]
    pub const fn albedo_max(&self) -> f32 {
        self.albedo_max
    }

    /// How much diffuse and glossy lobe reflect.
    pub(super) const fn shares(&self) -> [f32; 2] {
        self.shares
    }

    /// GGX alpha of about the width of the glossy lobe.
    pub(super) const fn alpha(&self) -> f32 {
        self.alpha
    }

    /// f of the diffuse lobe.
    pub(super) const fn diffuse(&self) -> [f32; 3] {
        self.diffuse
    }

    /// f of the glossy lobe.
    pub(super) fn glossy(&self, wo: Vector3, wi: Vector3) -> [f32; 3] {
        if self.shares[1] > 0.0 { rest(&self.grid, self.diffuse, wo, wi) } else { [0.0; 3] }
    }

    /// The half vectors from about `wo`, and the share of samples that scatter evenly.
    fn view(&self, wo: Vector3) -> (&PiecewiseConstant2, f32) {
        let theta = wo.x.hypot(wo.y).atan2(wo.z);
        let index = (theta / FRAC_PI_2 * Self::N_VIEWS as f32) as usize;
        let view = &self.views[index.min(Self::N_VIEWS - 1)];
        (view, if view.integral() > 0.0 { EVEN } else { 1.0 })
    }

    fn rejection(&self) -> &Rejection {
        self.rejection.get_or_init(|| Rejection::new(&self.grid, self.diffuse))
    }

    pub(super) fn sample_glossy(
        &self,
        sampling: TableSampling,
        wo: Vector3,
        u_choice: f32,
        u: Point2,
    ) -> Option<Vector3> {
        match sampling {
            TableSampling::Cells => self.sample_cells(wo, u_choice, u),
            TableSampling::Rejection => {
                Some(self.rejection().sample(|wi| rest(&self.grid, self.diffuse, wo, wi), u_choice, u))
            }
        }
    }

    pub(super) fn glossy_pdf(&self, sampling: TableSampling, wo: Vector3, wi: Vector3) -> f32 {
        match sampling {
            TableSampling::Cells => self.cells_pdf(wo, wi),
            TableSampling::Rejection => {
                let theta_o = wo.x.hypot(wo.y).atan2(wo.z);
                self.rejection().pdf(theta_o, rest(&self.grid, self.diffuse, wo, wi), wi.z)
            }
        }
    }

    fn sample_cells(&self, wo: Vector3, u_choice: f32, u: Point2) -> Option<Vector3> {
        let (view, even) = self.view(wo);
        if u_choice < even {
            return Some(warp::sample_cosine_hemisphere(u));
        }
        let (p, _) = view.sample(u);
        let h = half_vector(p, wo.y.atan2(wo.x));
        let cos = wo.dot(h);
        (cos > 0.0).then(|| h * (2.0 * cos) - wo)
    }

    fn cells_pdf(&self, wo: Vector3, wi: Vector3) -> f32 {
        let (view, even) = self.view(wo);
        let Some(h) = (wo + wi).try_normalized() else { return 0.0 };
        let ring = N_RINGS as f32 * (h.x.hypot(h.y).atan2(h.z) / FRAC_PI_2).sqrt();
        let phi = (h.y.atan2(h.x) - wo.y.atan2(wo.x)).rem_euclid(TAU);
        let pdf_h = view.pdf(Point2::new(phi, ring.min(N_RINGS as f32))) / ring_width(ring as usize);
        even * FRAC_1_PI * wi.z + (1.0 - even) * pdf_h / (4.0 * wo.dot(h))
    }
}

/// Alpha of facets whose density has fallen to half at an angle; 1 if it has not.
///
/// That of GGX has at tan² theta = (√2 - 1) alpha².
pub(in crate::bsdf) fn alpha_of_half_width(theta: Option<f32>) -> f32 {
    theta.map_or(1.0, |theta| (theta.tan() / 0.643_594_3).clamp(1e-3, 1.0))
}

/// f without its diffuse lobe.
pub(super) fn rest(grid: &BrdfGrid, diffuse: [f32; 3], wo: Vector3, wi: Vector3) -> [f32; 3] {
    let f = grid.at(wo, wi);
    std::array::from_fn(|c| (f[c] - diffuse[c]).max(0.0))
}

/// `1 - cos theta_h` where a ring begins.
fn ring_border(ring: usize) -> f32 {
    2.0 * sqr((0.5 * FRAC_PI_2 * sqr(ring as f32 / N_RINGS as f32)).sin())
}

/// Solid angle of a ring for each radian of azimuth.
fn ring_width(ring: usize) -> f32 {
    let ring = ring.min(N_RINGS - 1);
    ring_border(ring + 1) - ring_border(ring)
}

/// The half vector of a point of a view, whose `wo` has this azimuth.
fn half_vector(p: Point2, azimuth: f32) -> Vector3 {
    let ring = (p.y as usize).min(N_RINGS - 1);
    let below = lerp(p.y - ring as f32, ring_border(ring), ring_border(ring + 1));
    let sin = (below * (2.0 - below)).max(0.0).sqrt();
    let (sin_phi, cos_phi) = (p.x + azimuth).sin_cos();
    Vector3::new(sin * cos_phi, sin * sin_phi, 1.0 - below)
}

/// The density of half vectors of a range of view, from its middle, and the albedo of the glossy lobe there.
fn half_vectors(grid: &BrdfGrid, diffuse: [f32; 3], view: usize) -> (PiecewiseConstant2, [f32; 3]) {
    let theta = FRAC_PI_2 * (view as f32 + 0.5) / BrdfTable::N_VIEWS as f32;
    let wo = Vector3::new(theta.sin(), 0.0, theta.cos());
    let (n_sectors, n_rings) = (N_SECTORS as f32, N_RINGS as f32);
    let mut albedo = [0.0; 3];
    let mut cells = Vec::with_capacity(N_RINGS * N_SECTORS);
    for cell in 0..N_RINGS * N_SECTORS {
        let (ring, sector) = (cell / N_SECTORS, cell % N_SECTORS);
        let mut flux = [0.0; 3];
        for point in 0..N_POINTS * N_POINTS {
            let within = |index: usize| (index as f32 + 0.5) / N_POINTS as f32;
            let x = (sector as f32 + within(point % N_POINTS)) / n_sectors * TAU;
            let h = half_vector(Point2::new(x, ring as f32 + within(point / N_POINTS)), 0.0);
            let wi = h * (2.0 * wo.dot(h)) - wo;
            if wo.dot(h) > 0.0 && wi.z > 0.0 {
                let scale = ring_width(ring) * 4.0 * wo.dot(h) * wi.z / (N_POINTS * N_POINTS) as f32;
                let f = rest(grid, diffuse, wo, wi);
                (0..3).for_each(|c| flux[c] += scale * f[c]);
            }
        }
        (0..3).for_each(|c| albedo[c] += flux[c] * TAU / n_sectors);
        cells.push(flux.iter().sum());
    }
    let domain = Bounds2 { min: Point2::new(0.0, 0.0), max: Point2::new(TAU, n_rings) };
    (PiecewiseConstant2::new(&cells, N_SECTORS, N_RINGS, domain), albedo)
}
