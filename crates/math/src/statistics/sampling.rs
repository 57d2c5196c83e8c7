//! Do samples have the density they claim?
//!
//! The domain is cut into cells; the density, integrated over each cell, gives the expected counts, and Pearson's chi-square
//! test compares. A first batch of samples decides on the cells: where many fall, cells are small, so that narrow lobes are
//! resolved and their integral cannot miss the peak. The counts come from a second batch, so that the cells do not depend on them.

use std::f64::consts::TAU;

use super::chi_square::chi_square_test;
use super::cubature::{Rectangle, integrate_rectangle};
use super::distributions::normal_quantile;
use crate::{Point2, Rng, Vector3};

/// Relative error allowed to the integral of a density in single precision.
const INTEGRAL_TOLERANCE: f64 = 2e-3;
/// A cell is split if the pilot batch would put more than this share of all samples there.
const LARGEST_SHARE: f64 = 1.0 / 400.0;
/// Fewest samples expected in a cell.
const MIN_EXPECTED: f64 = 5.0;

/// Tests `sample` against `pdf`, a density per steradian over the sphere, with `samples` directions. `None` stands for the mass
/// that the density lacks to 1.
///
/// # Errors
/// If samples and density disagree at this significance, with a message for people.
pub fn sphere_chi_square(
    samples: usize,
    seed: u64,
    mut sample: impl FnMut(&mut Rng) -> Option<Vector3>,
    pdf: impl Fn(Vector3) -> f32,
    significance: f64,
) -> Result<(), String> {
    // z and phi are coordinates of equal area.
    let domain = Grid {
        domain: Rectangle { x0: -1.0, x1: 1.0, y0: 0.0, y1: TAU },
        nx: 16,
        ny: 16,
        // Cells smaller than the rounding of z near the poles would count rounding.
        max_depth: 12,
    };
    let draw = |rng: &mut Rng| {
        sample(rng).map(|w| {
            let phi = f64::from(w.y).atan2(f64::from(w.x));
            (f64::from(w.z).clamp(-1.0, 1.0), if phi < 0.0 { phi + TAU } else { phi })
        })
    };
    chi_square_cells(samples, seed, draw, |z, phi| f64::from(pdf(direction(z, phi))), &domain, significance)
}

/// Tests `sample` against `pdf`, a density over the unit square, with `samples` points.
///
/// # Errors
/// If samples and density disagree at this significance, with a message for people.
pub fn square_chi_square(
    samples: usize,
    seed: u64,
    mut sample: impl FnMut(&mut Rng) -> Option<Point2>,
    pdf: impl Fn(Point2) -> f32,
    significance: f64,
) -> Result<(), String> {
    let domain =
        Grid { domain: Rectangle { x0: 0.0, x1: 1.0, y0: 0.0, y1: 1.0 }, nx: 16, ny: 16, max_depth: 10 };
    let draw = |rng: &mut Rng| sample(rng).map(|p| (f64::from(p.x), f64::from(p.y)));
    let density = |x: f64, y: f64| f64::from(pdf(Point2::new(x as f32, y as f32)));
    chi_square_cells(samples, seed, draw, density, &domain, significance)
}

/// Tests `sample` against `pdf`, a density over the interval `range`, with `samples` numbers.
///
/// # Errors
/// If samples and density disagree at this significance, with a message for people.
pub fn interval_chi_square(
    samples: usize,
    seed: u64,
    range: [f64; 2],
    mut sample: impl FnMut(&mut Rng) -> Option<f32>,
    pdf: impl Fn(f32) -> f32,
    significance: f64,
) -> Result<(), String> {
    let domain = Grid {
        domain: Rectangle { x0: range[0], x1: range[1], y0: 0.0, y1: 1.0 },
        nx: 64,
        ny: 1,
        max_depth: 0,
    };
    let draw = |rng: &mut Rng| sample(rng).map(|x| (f64::from(x), 0.5));
    chi_square_cells(samples, seed, draw, |x, _| f64::from(pdf(x as f32)), &domain, significance)
}

/// Integral over the sphere of a function of direction, per steradian, to about `tolerance`.
#[must_use]
pub fn integrate_sphere(f: impl Fn(Vector3) -> f64, tolerance: f64) -> f64 {
    let grid =
        Grid { domain: Rectangle { x0: -1.0, x1: 1.0, y0: 0.0, y1: TAU }, nx: 16, ny: 16, max_depth: 0 };
    let f = |z: f64, phi: f64| f(direction(z, phi));
    grid.cells().into_iter().map(|cell| integrate_rectangle(&f, cell, tolerance / 16.0, 10)).sum()
}

/// The direction of height `z` and azimuth `phi`.
fn direction(z: f64, phi: f64) -> Vector3 {
    let sin_theta = (1.0 - z * z).max(0.0).sqrt();
    Vector3::new((sin_theta * phi.cos()) as f32, (sin_theta * phi.sin()) as f32, z as f32)
}

/// How to cut a domain into cells.
#[derive(Clone, Copy, Debug)]
pub struct Grid {
    /// What is cut.
    pub domain: Rectangle,
    /// Coarse cells in x.
    pub nx: usize,
    /// Coarse cells in y.
    pub ny: usize,
    /// How often a coarse cell may be split in four.
    pub max_depth: u32,
}

impl Grid {
    /// The coarse cells, row by row.
    fn cells(&self) -> Vec<Rectangle> {
        let d = self.domain;
        let x = |i: usize| d.x0 + (d.x1 - d.x0) * i as f64 / self.nx as f64;
        let y = |i: usize| d.y0 + (d.y1 - d.y0) * i as f64 / self.ny as f64;
        (0..self.nx * self.ny)
            .map(|i| (i % self.nx, i / self.nx))
            .map(|(ix, iy)| Rectangle { x0: x(ix), x1: x(ix + 1), y0: y(iy), y1: y(iy + 1) })
            .collect()
    }

    /// Index of the coarse cell of a point; points on the border belong inside.
    fn index(&self, (x, y): (f64, f64)) -> Option<usize> {
        let d = self.domain;
        if !(x >= d.x0 && x <= d.x1 && y >= d.y0 && y <= d.y1) {
            return None;
        }
        let ix = (((x - d.x0) / (d.x1 - d.x0) * self.nx as f64) as usize).min(self.nx - 1);
        let iy = (((y - d.y0) / (d.y1 - d.y0) * self.ny as f64) as usize).min(self.ny - 1);
        Some(iy * self.nx + ix)
    }
}

/// A cell of the quadtree: its expected share and where its samples are.
struct Leaf {
    cell: Rectangle,
    observed: Vec<(f64, f64)>,
}

/// Splits cells until no pilot share is too large; gives every leaf the points that fall into it.
fn split(
    cell: Rectangle,
    pilot: Vec<(f64, f64)>,
    counted: Vec<(f64, f64)>,
    limit: usize,
    depth: u32,
    leaves: &mut Vec<Leaf>,
) {
    if depth == 0 || pilot.len() <= limit {
        leaves.push(Leaf { cell, observed: counted });
        return;
    }
    let (mx, my) = (0.5 * (cell.x0 + cell.x1), 0.5 * (cell.y0 + cell.y1));
    let quarter = |(x, y): &(f64, f64)| 2 * usize::from(*y >= my) + usize::from(*x >= mx);
    let deal = |points: Vec<(f64, f64)>| {
        let mut parts: [Vec<(f64, f64)>; 4] = Default::default();
        for point in points {
            parts[quarter(&point)].push(point);
        }
        parts
    };
    let quarters = cell.quarters();
    for ((cell, pilot), counted) in quarters.into_iter().zip(deal(pilot)).zip(deal(counted)) {
        split(cell, pilot, counted, limit, depth - 1, leaves);
    }
}

/// Tests samples of a domain against a density over it: see [`sphere_chi_square`].
///
/// # Errors
/// If samples and density disagree at this significance, with a message for people.
pub fn chi_square_cells(
    samples: usize,
    seed: u64,
    mut draw: impl FnMut(&mut Rng) -> Option<(f64, f64)>,
    density: impl Fn(f64, f64) -> f64,
    grid: &Grid,
    significance: f64,
) -> Result<(), String> {
    let mut rng = Rng::new(seed, 0x51);
    let n_pilot = (samples / 4).max(1);
    let (pilot, _) = batch(n_pilot, grid, || draw(&mut rng))?;
    let (counted, n_none) = batch(samples, grid, || draw(&mut rng))?;
    let limit = ((n_pilot as f64 * LARGEST_SHARE) as usize).max(1);
    let mut leaves = Vec::new();
    for ((cell, pilot), counted) in grid.cells().into_iter().zip(pilot).zip(counted) {
        split(cell, pilot, counted, limit, grid.max_depth, &mut leaves);
    }
    let tolerance = 2e-3 * LARGEST_SHARE;
    let shares: Vec<f64> =
        leaves.iter().map(|leaf| integrate_rectangle(&density, leaf.cell, tolerance, 8)).collect();
    let integral: f64 = shares.iter().sum();
    check_mass(samples, n_none, integral, significance)?;
    // Given that samples are made at all, do they fall where they should?
    let n_made = (samples - n_none) as f64;
    if n_made == 0.0 {
        return Ok(());
    }
    let expected: Vec<f64> = shares.iter().map(|share| share / integral * n_made).collect();
    let observed: Vec<f64> = leaves.iter().map(|leaf| leaf.observed.len() as f64).collect();
    chi_square_test(&observed, &expected, MIN_EXPECTED, 0.5 * significance).map(|_| ())
}

/// Points of `n` draws by coarse cell, and how many draws gave none.
#[expect(clippy::type_complexity, reason = "points by cell, and a count")]
fn batch(
    n: usize,
    grid: &Grid,
    mut draw: impl FnMut() -> Option<(f64, f64)>,
) -> Result<(Vec<Vec<(f64, f64)>>, usize), String> {
    let mut cells = vec![Vec::new(); grid.nx * grid.ny];
    let mut n_none = 0;
    for _ in 0..n {
        let Some(point) = draw() else {
            n_none += 1;
            continue;
        };
        let index = grid.index(point).ok_or_else(|| format!("sample {point:?} lies outside the domain"))?;
        cells[index].push(point);
    }
    Ok((cells, n_none))
}

/// The share of draws that gave a sample must be the integral of the density.
fn check_mass(samples: usize, n_none: usize, integral: f64, significance: f64) -> Result<(), String> {
    if !integral.is_finite() || integral > 1.0 + INTEGRAL_TOLERANCE {
        return Err(format!("the density integrates to {integral}"));
    }
    let missing = (1.0 - integral).max(0.0);
    let share = n_none as f64 / samples as f64;
    let deviate = -normal_quantile(0.25 * significance);
    let sigma = (missing * (1.0 - missing) / samples as f64).sqrt();
    if (share - missing).abs() <= deviate * sigma + INTEGRAL_TOLERANCE {
        return Ok(());
    }
    Err(format!("the density integrates to {integral}, but {:.5} of the draws gave a sample", 1.0 - share))
}
