//! Colours as linear functions of features, pixel window by pixel window (Bitterli et al. 2016, "Nonlinearly Weighted
//! First-Order Regression for Denoising Monte Carlo Renderings", doi:10.1111/cgf.12954).
//!
//! Around each pixel p a weighted least-squares fit of `y_q = a + b (f_q - f_p)` explains the colours y of its window by the
//! features f. The fit is a guess for all pixels of the window, not for p alone: a pixel's result is the weighted mean of
//! the guesses of all windows that hold it (collaborative filtering).
//!
//! What features have of noise flattens their slopes; a ridge of that size keeps slopes that the window does not determine
//! at zero, and the fit becomes a weighted mean.

use rayon::prelude::*;

use super::weights::{Guide, Reach, Tile, tile_rows, weight};

/// One and up to seven features.
pub(super) const N_TERMS: usize = 8;

/// Pixels across and down of a tile.
const TILE: usize = 32;

/// Least ridge, as a variance of features of unit size.
const RIDGE: f32 = 1e-5;

/// What is filtered: row-major pixels.
#[derive(Clone, Copy, Debug)]
pub(super) struct Subject<'s> {
    pub(super) size: [usize; 2],
    /// Colour, and 1 where it is to be trusted, else 0.
    pub(super) colors: &'s [[f32; 4]],
    /// Features, the first of which is 0.
    pub(super) features: &'s [[f32; N_TERMS]],
    /// Variances of the features.
    pub(super) noise: &'s [[f32; N_TERMS]],
}

/// The picture filtered with weights by `guide`, once for each bandwidth.
pub(super) fn filter<const K: usize>(
    subject: Subject<'_>,
    guide: &Guide,
    reach: Reach,
    bandwidths: [f32; K],
) -> [Vec<[f32; 3]>; K] {
    let [width, height] = subject.size;
    let mut sums = [(); K].map(|()| vec![[0.0_f32; 4]; width * height]);
    for tiles in tile_rows(width, height, TILE) {
        let parts: Vec<[Part; K]> =
            tiles.par_iter().map(|tile| filter_tile(subject, guide, reach, bandwidths, tile)).collect();
        // In the order of the tiles, so that sums do not depend on threads.
        for parts in &parts {
            for (sums, part) in sums.iter_mut().zip(parts) {
                part.add_to(sums, width);
            }
        }
    }
    sums.map(|sums| {
        let mean = |(sum, own): (&[f32; 4], &[f32; 4])| {
            if sum[3] > 0.0 { [0, 1, 2].map(|c| sum[c] / sum[3]) } else { [own[0], own[1], own[2]] }
        };
        sums.iter().zip(subject.colors).map(mean).collect()
    })
}

/// What the windows of a tile give the pixels in and around it.
struct Part {
    area: Tile,
    sums: Vec<[f32; 4]>,
}

impl Part {
    fn new(tile: &Tile, reach: usize, [width, height]: [usize; 2]) -> Self {
        let wider = |range: &std::ops::Range<usize>, n: usize| {
            range.start.saturating_sub(reach)..(range.end + reach).min(n)
        };
        let area = Tile { x: wider(&tile.x, width), y: wider(&tile.y, height) };
        let sums = vec![[0.0; 4]; area.x.len() * area.y.len()];
        Self { area, sums }
    }

    fn add_to(&self, sums: &mut [[f32; 4]], width: usize) {
        for (y, row) in self.area.y.clone().zip(self.sums.chunks_exact(self.area.x.len())) {
            let targets = &mut sums[y * width + self.area.x.start..];
            for (target, sum) in targets.iter_mut().zip(row) {
                (0..4).for_each(|c| target[c] += sum[c]);
            }
        }
    }
}

fn filter_tile<const K: usize>(
    subject: Subject<'_>,
    guide: &Guide,
    reach: Reach,
    bandwidths: [f32; K],
    tile: &Tile,
) -> [Part; K] {
    let mut distances = Vec::new();
    guide.distances(tile, &mut distances);
    let mut parts = [(); K].map(|()| Part::new(tile, reach.window, subject.size));
    let mut window = Vec::with_capacity(reach.n_offsets());
    let mut of_pixel = distances.chunks_exact(reach.n_offsets());
    for y in tile.y.clone() {
        for x in tile.x.clone() {
            let Some(distances) = of_pixel.next() else { return parts };
            for (part, bandwidth) in parts.iter_mut().zip(bandwidths) {
                gather(&mut window, [x, y], distances, bandwidth, reach.window, subject.size);
                fit(subject, y * subject.size[0] + x, &window, part);
            }
        }
    }
    parts
}

/// A pixel of a window, with its weight.
struct Weighted {
    pixel: u32,
    weight: f32,
}

/// The pixels of a window that have a weight.
fn gather(
    window: &mut Vec<Weighted>,
    [x, y]: [usize; 2],
    distances: &[f32],
    bandwidth: f32,
    radius: usize,
    [width, _]: [usize; 2],
) {
    window.clear();
    for (dy, row) in distances.chunks_exact(2 * radius + 1).enumerate() {
        // Pixels beyond the picture are infinitely far and get no weight.
        let first = ((y + dy).wrapping_sub(radius).wrapping_mul(width) + x).wrapping_sub(radius);
        for (dx, distance) in row.iter().enumerate() {
            let weight = weight(*distance, bandwidth);
            if weight > 0.0 {
                window.push(Weighted { pixel: first.wrapping_add(dx) as u32, weight });
            }
        }
    }
}

/// Fits the window of `center` and adds its guesses.
fn fit(subject: Subject<'_>, center: usize, window: &[Weighted], part: &mut Part) {
    let own = &subject.features[center];
    let terms = |pixel: u32| {
        let features = &subject.features[pixel as usize];
        let mut terms: [f32; N_TERMS] = std::array::from_fn(|i| features[i] - own[i]);
        terms[0] = 1.0;
        terms
    };
    let mut matrix = [[0.0_f32; N_TERMS]; N_TERMS];
    let mut sides = [[0.0_f32; N_TERMS]; 3];
    for Weighted { pixel, weight } in window {
        let color = &subject.colors[*pixel as usize];
        let (phi, weight) = (terms(*pixel), weight * color[3]);
        for (row, term) in matrix.iter_mut().zip(phi) {
            let scaled = weight * term;
            row.iter_mut().zip(phi).for_each(|(entry, term)| *entry += scaled * term);
        }
        for (side, color) in sides.iter_mut().zip(color) {
            let scaled = weight * color;
            side.iter_mut().zip(phi).for_each(|(entry, term)| *entry += scaled * term);
        }
    }
    let total = matrix[0][0];
    if total <= 0.0 {
        return;
    }
    for (i, (row, noise)) in matrix.iter_mut().zip(&subject.noise[center]).enumerate().skip(1) {
        row[i] += total * (RIDGE + noise);
    }
    let slopes = solve(&matrix, &sides);
    let width = subject.size[0];
    let area = &part.area;
    for Weighted { pixel, weight } in window {
        let phi = terms(*pixel);
        let (x, y) = (*pixel as usize % width, *pixel as usize / width);
        let sum = &mut part.sums[(y - area.y.start) * area.x.len() + x - area.x.start];
        for (sum, slopes) in sum.iter_mut().zip(&slopes) {
            let guess: f32 = slopes.iter().zip(phi).map(|(slope, term)| slope * term).sum();
            *sum += weight * guess;
        }
        sum[3] += weight;
    }
}

/// Solves the normal equations for three right-hand sides by Cholesky's decomposition; where the matrix is not positive
/// definite, by the mean alone.
fn solve(matrix: &[[f32; N_TERMS]; N_TERMS], sides: &[[f32; N_TERMS]; 3]) -> [[f32; N_TERMS]; 3] {
    let mut lower = [[0.0_f64; N_TERMS]; N_TERMS];
    for i in 0..N_TERMS {
        for j in 0..=i {
            let sum: f64 = (0..j).map(|k| lower[i][k] * lower[j][k]).sum();
            let rest = f64::from(matrix[i][j]) - sum;
            if i != j {
                lower[i][j] = rest / lower[j][j];
            } else if rest > 0.0 {
                lower[i][i] = rest.sqrt();
            } else {
                return sides.map(|side| {
                    let mut mean = [0.0; N_TERMS];
                    mean[0] = side[0] / matrix[0][0];
                    mean
                });
            }
        }
    }
    sides.map(|side| {
        let mut x = side.map(f64::from);
        for i in 0..N_TERMS {
            let sum: f64 = (0..i).map(|k| lower[i][k] * x[k]).sum();
            x[i] = (x[i] - sum) / lower[i][i];
        }
        for i in (0..N_TERMS).rev() {
            let sum: f64 = (i + 1..N_TERMS).map(|k| lower[k][i] * x[k]).sum();
            x[i] = (x[i] - sum) / lower[i][i];
        }
        x.map(|value| value as f32)
    })
}
