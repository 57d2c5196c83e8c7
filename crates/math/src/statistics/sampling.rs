//! Do samples have the density they claim?
//!
//! The domain is cut into cells; the density, integrated over each cell, gives the expected counts, and Pearson's chi-square
//! test compares. A first batch of samples decides on the cells: where many fall, cells are small, so that narrow lobes are
//! resolved and their integral cannot miss the peak. The counts come from a second batch, so that the cells do not depend on them.

use std::f64::consts::TAU;

use super::chi_square::chi_square_test;
use super::cubature::{Rectangle, integrate_rectangle};
use super::distributions::{combined_p_value, normal_cdf};
use crate::{Point2, Rng, Vector3};

/// Relative error allowed to the integral of a density in single precision.
const INTEGRAL_TOLERANCE: f64 = 2e-3;
/// A cell is split if the pilot batch would put more than this share of all samples there.
const LARGEST_SHARE: f64 = 1.0 / 200.0;
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
    sample: impl FnMut(&mut Rng) -> Option<Vector3>,
    pdf: impl Fn(Vector3) -> f32,
    significance: f64,
) -> Result<(), String> {
    sphere_test(samples, seed, sample, pdf, significance).map(|_| ())
}

/// The probability of a disagreement at least as large as the one that [`sphere_chi_square`] finds, if all is right; 0
/// if the samples are impossible.
#[must_use]
pub fn sphere_p_value(
    samples: usize,
    seed: u64,
    sample: impl FnMut(&mut Rng) -> Option<Vector3>,
    pdf: impl Fn(Vector3) -> f32,
) -> f64 {
    sphere_test(samples, seed, sample, pdf, 0.0).unwrap_or(0.0)
}

fn sphere_test(
    samples: usize,
    seed: u64,
    mut sample: impl FnMut(&mut Rng) -> Option<Vector3>,
    pdf: impl Fn(Vector3) -> f32,
    significance: f64,
) -> Result<f64, String> {
    // z and phi are coordinates of equal area.
    let domain = Grid {
        domain: Rectangle { x0: -1.0, x1: 1.0, y0: 0.0, y1: TAU },
        nx: 8,
        ny: 16,
        // Cells smaller than the rounding of z near the poles would count rounding.
        finest: [2e-6, 1e-4],
    };
    let draw = |rng: &mut Rng| {
        sample(rng).map(|w| {
            let phi = f64::from(w.y).atan2(f64::from(w.x));
            [f64::from(w.z).clamp(-1.0, 1.0), if phi < 0.0 { phi + TAU } else { phi }]
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
    let domain = Grid {
        domain: Rectangle { x0: 0.0, x1: 1.0, y0: 0.0, y1: 1.0 },
        nx: 10,
        ny: 10,
        finest: [1e-5, 1e-5],
    };
    let draw = |rng: &mut Rng| sample(rng).map(|p| [f64::from(p.x), f64::from(p.y)]);
    let density = |x: f64, y: f64| f64::from(pdf(Point2::new(x as f32, y as f32)));
    chi_square_cells(samples, seed, draw, density, &domain, significance).map(|_| ())
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
        finest: [1e-6 * (range[1] - range[0]), 1.0],
    };
    let draw = |rng: &mut Rng| sample(rng).map(|x| [f64::from(x), 0.5]);
    chi_square_cells(samples, seed, draw, |x, _| f64::from(pdf(x as f32)), &domain, significance).map(|_| ())
}

/// Integral over the sphere of a function of direction, per steradian, to about `tolerance`.
#[must_use]
pub fn integrate_sphere(f: impl Fn(Vector3) -> f64, tolerance: f64) -> f64 {
    let grid = Grid {
        domain: Rectangle { x0: -1.0, x1: 1.0, y0: 0.0, y1: TAU },
        nx: 16,
        ny: 16,
        finest: [0.0, 0.0],
    };
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
    /// Cells are not cut below this extent in x and y.
    pub finest: [f64; 2],
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
    fn index(&self, [x, y]: [f64; 2]) -> Option<usize> {
        let d = self.domain;
        if !(x >= d.x0 && x <= d.x1 && y >= d.y0 && y <= d.y1) {
            return None;
        }
        let ix = (((x - d.x0) / (d.x1 - d.x0) * self.nx as f64) as usize).min(self.nx - 1);
        let iy = (((y - d.y0) / (d.y1 - d.y0) * self.ny as f64) as usize).min(self.ny - 1);
        Some(iy * self.nx + ix)
    }
}

/// A cell with the samples that fell into it.
struct Cell {
    bounds: Rectangle,
    /// Decide how cells are cut.
    pilot: Vec<[f64; 2]>,
    /// Are compared with the density.
    counted: Vec<[f64; 2]>,
}

/// The two halves of a cell across an axis and the line between them.
fn halves(bounds: Rectangle, axis: usize) -> (f64, [Rectangle; 2]) {
    if axis == 0 {
        let x = 0.5 * (bounds.x0 + bounds.x1);
        (x, [Rectangle { x1: x, ..bounds }, Rectangle { x0: x, ..bounds }])
    } else {
        let y = 0.5 * (bounds.y0 + bounds.y1);
        (y, [Rectangle { y1: y, ..bounds }, Rectangle { y0: y, ..bounds }])
    }
}

/// The axis across which the points are spread most unevenly, of those along which the cell may still be cut, and how
/// uneven they are: the largest of the differences between halves, and between the diagonal pairs of quarters, in standard
/// deviations of an even spread.
fn uneven_axis(bounds: Rectangle, points: &[[f64; 2]], finest: [f64; 2]) -> Option<(usize, f64)> {
    let extent = [bounds.x1 - bounds.x0, bounds.y1 - bounds.y0];
    let middle = [halves(bounds, 0).0, halves(bounds, 1).0];
    let unevenness = |upper: &dyn Fn(&[f64; 2]) -> bool| {
        let above = points.iter().filter(|point| upper(point)).count() as f64;
        let n = points.len() as f64;
        (2.0 * above - n).abs() / n.max(1.0).sqrt()
    };
    let diagonal = unevenness(&|p| (p[0] >= middle[0]) == (p[1] >= middle[1]));
    (0..2)
        .filter(|axis| extent[*axis] > 2.0 * finest[*axis])
        .map(|axis| (axis, unevenness(&|p| p[axis] >= middle[axis])))
        .max_by(|a, b| a.1.total_cmp(&b.1))
        .map(|(axis, difference)| (axis, difference.max(diagonal)))
}

/// Cuts a cell until no pilot share is too large.
fn cut(cell: Cell, limit: usize, finest: [f64; 2], leaves: &mut Vec<Cell>) {
    let axis = uneven_axis(cell.bounds, &cell.pilot, finest).filter(|_| cell.pilot.len() > limit);
    let Some((axis, _)) = axis else {
        leaves.push(cell);
        return;
    };
    let (middle, [low, high]) = halves(cell.bounds, axis);
    let deal = |points: Vec<[f64; 2]>| -> (Vec<[f64; 2]>, Vec<[f64; 2]>) {
        points.into_iter().partition(|point| point[axis] < middle)
    };
    let (pilot_low, pilot_high) = deal(cell.pilot);
    let (counted_low, counted_high) = deal(cell.counted);
    cut(Cell { bounds: low, pilot: pilot_low, counted: counted_low }, limit, finest, leaves);
    cut(Cell { bounds: high, pilot: pilot_high, counted: counted_high }, limit, finest, leaves);
}

/// How the density is integrated over cells, with samples as guides.
struct Quadrature<'a, F> {
    density: &'a F,
    finest: [f64; 2],
    /// Number of draws that the points of all cells come from.
    n_draws: f64,
}

impl<F: Fn(f64, f64) -> f64> Quadrature<'_, F> {
    /// Integral over a cell with these samples, cut where they are uneven or more than it explains, so that no peak with
    /// samples is missed. Cutting makes a right integral no wronger, whatever the samples are.
    fn share(&self, bounds: Rectangle, points: &[[f64; 2]], tolerance: f64) -> f64 {
        const FEW: usize = 16;
        // An even spread is less even than this about once in 10^4 cells.
        const UNEVEN: f64 = 4.0;
        let uneven = uneven_axis(bounds, points, self.finest);
        if uneven.is_none_or(|(_, unevenness)| points.len() <= FEW || unevenness <= UNEVEN) {
            let integral = integrate_rectangle(self.density, bounds, tolerance, 8);
            if self.explains(integral, points.len()) {
                return integral;
            }
        }
        // A peak, or samples in a sliver of the support or in the foot of a lobe that the rule has missed.
        let Some((axis, _)) = uneven else {
            return integrate_rectangle(self.density, bounds, tolerance, 8);
        };
        let (middle, [low, high]) = halves(bounds, axis);
        let (below, above): (Vec<_>, Vec<_>) = points.iter().copied().partition(|point| point[axis] < middle);
        self.share(low, &below, 0.7 * tolerance) + self.share(high, &above, 0.7 * tolerance)
    }

    /// True unless the samples are many more than the integral says.
    fn explains(&self, integral: f64, n_points: usize) -> bool {
        let expected = integral * self.n_draws;
        n_points == 0 || integral > 0.0 && n_points as f64 <= expected + 3.0 * expected.sqrt() + 2.0
    }
}

/// Tests samples of a domain against a density over it: see [`sphere_chi_square`]. Returns the p-value.
///
/// # Errors
/// If samples and density disagree at this significance, with a message for people.
pub fn chi_square_cells(
    samples: usize,
    seed: u64,
    mut draw: impl FnMut(&mut Rng) -> Option<[f64; 2]>,
    density: impl Fn(f64, f64) -> f64,
    grid: &Grid,
    significance: f64,
) -> Result<f64, String> {
    let mut rng = Rng::new(seed, 0x51);
    let n_pilot = (samples / 4).max(1);
    let (pilot, _) = batch(n_pilot, grid, || draw(&mut rng))?;
    let (counted, n_none) = batch(samples, grid, || draw(&mut rng))?;
    let limit = ((n_pilot as f64 * LARGEST_SHARE) as usize).max(1);
    let mut leaves = Vec::new();
    for ((bounds, pilot), counted) in grid.cells().into_iter().zip(pilot).zip(counted) {
        cut(Cell { bounds, pilot, counted }, limit, grid.finest, &mut leaves);
    }
    let tolerance = 2e-3 * LARGEST_SHARE;
    let quadrature = Quadrature { density: &density, finest: grid.finest, n_draws: samples as f64 };
    let shares: Vec<f64> =
        leaves.iter().map(|leaf| quadrature.share(leaf.bounds, &leaf.counted, tolerance)).collect();
    let integral: f64 = shares.iter().sum();
    let mass_p = check_mass(samples, n_none, integral, 0.5 * significance)?;
    // Given that samples are made at all, do they fall where they should?
    let n_made = (samples - n_none) as f64;
    if n_made == 0.0 {
        return Ok(mass_p);
    }
    let expected: Vec<f64> = shares.iter().map(|share| share / integral * n_made).collect();
    let observed: Vec<f64> = leaves.iter().map(|leaf| leaf.counted.len() as f64).collect();
    let cells = chi_square_test(&observed, &expected, MIN_EXPECTED, 0.5 * significance)?;
    Ok(combined_p_value([mass_p, cells.p_value]))
}

/// Points of `n` draws by coarse cell, and how many draws gave none.
#[expect(clippy::type_complexity, reason = "points by cell, and a count")]
fn batch(
    n: usize,
    grid: &Grid,
    mut draw: impl FnMut() -> Option<[f64; 2]>,
) -> Result<(Vec<Vec<[f64; 2]>>, usize), String> {
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

/// The share of draws that gave a sample must be the integral of the density. Returns the p-value.
fn check_mass(samples: usize, n_none: usize, integral: f64, significance: f64) -> Result<f64, String> {
    if !integral.is_finite() || integral > 1.0 + INTEGRAL_TOLERANCE {
        return Err(format!("the density integrates to {integral}"));
    }
    let missing = (1.0 - integral).max(0.0);
    let share = n_none as f64 / samples as f64;
    let excess = ((share - missing).abs() - INTEGRAL_TOLERANCE).max(0.0);
    let sigma = (missing * (1.0 - missing) / samples as f64).sqrt();
    let p_value = if excess > 0.0 { 2.0 * normal_cdf(-excess / sigma) } else { 1.0 };
    if p_value >= significance {
        return Ok(p_value);
    }
    Err(format!("the density integrates to {integral}, but {:.5} of the draws gave a sample", 1.0 - share))
}
