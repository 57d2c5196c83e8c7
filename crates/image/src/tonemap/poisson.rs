//! The Poisson equation on a rectangle without flow across its border, by multigrid (Brandt 1977).
//!
//! `sum over neighbours of (u_n - u) = f`. On grids of half the size what is left of the right side is averaged, where
//! four cells count as one, and the correction comes back interpolated. Red and black Gauss-Seidel sweeps smooth.

use rayon::prelude::*;

use crate::plane::Plane;

/// Sweeps before and after the coarse correction.
const SWEEPS: usize = 2;
/// Sweeps on the smallest grid.
const COARSE_SWEEPS: usize = 50;
/// Cycles end when the residual is this share of the right side, or do not help any longer.
const TOLERANCE: f64 = 1e-6;
const MAX_CYCLES: usize = 30;

/// The solution nearest in the mean to 0, found from a guess.
pub(super) fn solve(f: &Plane, guess: &Plane) -> Plane {
    let mut u = guess.clone();
    let size = norm(f);
    let mut last = f64::INFINITY;
    for _ in 0..MAX_CYCLES {
        let left = norm(&residual(&u, f));
        if left <= TOLERANCE * size || left >= 0.9 * last {
            break;
        }
        last = left;
        cycle(&mut u, f);
        remove_mean(&mut u);
    }
    u
}

fn cycle(u: &mut Plane, f: &Plane) {
    if u.width <= 2 && u.height <= 2 {
        (0..COARSE_SWEEPS).for_each(|_| smooth(u, f));
        return;
    }
    (0..SWEEPS).for_each(|_| smooth(u, f));
    let mut coarse_f = restricted(&residual(u, f));
    remove_mean(&mut coarse_f);
    let mut correction = Plane::zeros(coarse_f.width, coarse_f.height);
    cycle(&mut correction, &coarse_f);
    let fine = correction.doubled(u.width, u.height);
    u.values.par_iter_mut().zip(&fine.values).for_each(|(u, c)| *u += c);
    (0..SWEEPS).for_each(|_| smooth(u, f));
}

/// The right side for half the size. What flows over a coarse border is what flows over both fine ones at half the slope: the
/// same, so that right sides add up; along a line, where borders do not grow, half of it.
fn restricted(fine: &Plane) -> Plane {
    let factor = if fine.width == 1 || fine.height == 1 { 2.0 } else { 1.0 };
    Plane::from_rows(fine.width.div_ceil(2), fine.height.div_ceil(2), |y, row| {
        for y in [2 * y, 2 * y + 1].into_iter().filter(|y| *y < fine.height) {
            for (value, pair) in row.iter_mut().zip(fine.row(y).chunks(2)) {
                *value += factor * pair.iter().sum::<f32>();
            }
        }
    })
}

/// One sweep: first the cells of even, then those of odd sum of coordinates. Each sees neighbours of the other kind alone.
fn smooth(u: &mut Plane, f: &Plane) {
    let (width, height) = (u.width, u.height);
    for colour in 0..2 {
        let before = u.values.clone();
        u.values.par_chunks_mut(width).enumerate().for_each(|(y, row)| {
            for x in ((colour + y) % 2..width).step_by(2) {
                let (sum, n) = neighbours(&before, width, height, x, y);
                if n > 0.0 {
                    row[x] = (sum - f.values[y * width + x]) / n;
                }
            }
        });
    }
}

/// Sum and number of the neighbours of a cell.
#[inline]
fn neighbours(values: &[f32], width: usize, height: usize, x: usize, y: usize) -> (f32, f32) {
    let i = y * width + x;
    let (mut sum, mut n) = (0.0, 0.0);
    let mut add = |is_inside: bool, index: usize| {
        if is_inside {
            sum += values[index];
            n += 1.0;
        }
    };
    add(x > 0, i.wrapping_sub(1));
    add(x + 1 < width, i + 1);
    add(y > 0, i.wrapping_sub(width));
    add(y + 1 < height, i + width);
    (sum, n)
}

fn residual(u: &Plane, f: &Plane) -> Plane {
    Plane::from_rows(u.width, u.height, |y, row| {
        for (x, value) in row.iter_mut().enumerate() {
            let (sum, n) = neighbours(&u.values, u.width, u.height, x, y);
            let i = y * u.width + x;
            *value = f.values[i] - (sum - n * u.values[i]);
        }
    })
}

fn remove_mean(u: &mut Plane) {
    let mean = u.values.iter().map(|v| f64::from(*v)).sum::<f64>() / u.values.len() as f64;
    u.values.iter_mut().for_each(|v| *v -= mean as f32);
}

fn norm(plane: &Plane) -> f64 {
    plane.values.iter().map(|v| f64::from(*v).powi(2)).sum::<f64>().sqrt()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The right side made of a known surface gives it back, up to its mean.
    #[test]
    fn known_surfaces_come_back() {
        for (width, height) in [(64, 64), (61, 47), (5, 100), (1, 9), (130, 2)] {
            let known = Plane::from_rows(width, height, |y, row| {
                for (x, value) in row.iter_mut().enumerate() {
                    *value = (x as f32 * 0.3).sin()
                        + (y as f32 * 0.11).cos() * 2.0
                        + if x > width / 2 { 3.0 } else { 0.0 };
                }
            });
            let zero = Plane::zeros(width, height);
            let mut f = residual(&known, &zero);
            f.values.iter_mut().for_each(|v| *v = -*v);
            let found = solve(&f, &zero);
            let mut expected = known;
            remove_mean(&mut expected);
            let error =
                found.values.iter().zip(&expected.values).map(|(a, b)| (a - b).abs()).fold(0.0, f32::max);

            assert!(error < 0.01, "{width} by {height}: {error}");
        }
    }
}
