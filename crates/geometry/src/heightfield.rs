//! Height fields: z over the unit square, from numbers or from fractal noise (SPEC GEO-11).
//!
//! The fractal is made by midpoint displacement on squares: the middle of a square gets the mean of its corners and noise,
//! then the middle of an edge that of its four neighbours, which are a turned square, and noise, on ever finer grids
//! (Fournier, Fussell and Carpenter 1982, "Computer Rendering of Stochastic Models"; Miller 1986, "The Definition and
//! Rendering of Terrain Maps"). Fractional Brownian motion has E (z(p) - z(q))^2 = a^2 d^(2H) at a distance d. In it the
//! middle of a square of side s differs from the mean of the corners by the variance
//!
//! a^2 s^(2H) (2^(-H) - 1/4 - 2^H / 8),
//!
//! which is that of the noise here: the mean of squared distances to the corners, less half that among the corners. The
//! field is not stationary, though: points of coarse levels lie among linear pieces of finer ones, so that differences of
//! height grow a little more slowly than in that motion where H is large.

#[cfg(test)]
mod tests;

use etendue_math::{Normal3, Point2, Point3};

use crate::mesh::TriangleMesh;
use crate::refine::gaussian;

/// More levels of [`HeightGrid::fractal`] are refused: 11 make 8.4 million triangles.
pub const MAX_HEIGHT_LEVELS: u32 = 11;
/// A grid has at most so many heights, which make twice as many triangles.
pub const MAX_HEIGHTS: u64 = 1 << 23;

/// Heights on a grid, rows in order of y, each in order of x.
#[derive(Clone, Debug, PartialEq)]
pub struct HeightGrid {
    n: [u32; 2],
    heights: Vec<f32>,
}

/// How a fractal height field is made.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FractalHeights {
    /// Subdivision steps: 2^levels squares along each side, at most [`MAX_HEIGHT_LEVELS`].
    pub levels: u32,
    /// Hurst exponent H, between 0 and 1: near 1 smooth, near 0 rough.
    pub hurst: f32,
    /// Standard deviation a of differences of height over the distance 1, the side of the field.
    pub amplitude: f32,
    /// Which of all such fields.
    pub seed: u64,
}

impl HeightGrid {
    /// A grid of n[0] by n[1] heights; `None` unless [`Self::is_size`], there are as many as that, and finite.
    #[must_use]
    pub fn new(n: [u32; 2], heights: Vec<f32>) -> Option<Self> {
        let is_full = Self::is_size(n) && heights.len() == n[0] as usize * n[1] as usize;
        (is_full && heights.iter().all(|z| z.is_finite())).then_some(Self { n, heights })
    }

    /// True if a grid may have these sides: at least 2 heights along each, and at most [`MAX_HEIGHTS`] in all.
    #[must_use]
    pub fn is_size(n: [u32; 2]) -> bool {
        n.iter().all(|n| *n >= 2) && u64::from(n[0]) * u64::from(n[1]) <= MAX_HEIGHTS
    }

    /// Fractal noise; the corners have height 0. More levels than possible are taken for [`MAX_HEIGHT_LEVELS`].
    #[must_use]
    pub fn fractal(fractal: &FractalHeights) -> Self {
        let side = 1_usize << fractal.levels.min(MAX_HEIGHT_LEVELS);
        let n = side + 1;
        let mut heights = vec![0.0_f32; n * n];
        let mut step = side;
        while step > 1 {
            let half = step / 2;
            let size = step as f64 / side as f64;
            let square_noise = fractal.deviation(size);
            for y in (half..n).step_by(step) {
                for x in (half..n).step_by(step) {
                    let at = |x: usize, y: usize| heights[y * n + x];
                    let sum = at(x - half, y - half)
                        + at(x + half, y - half)
                        + at(x - half, y + half)
                        + at(x + half, y + half);
                    heights[y * n + x] = sum / 4.0 + fractal.noise(square_noise, step, x, y);
                }
            }
            let edge_noise = fractal.deviation(size / std::f64::consts::SQRT_2);
            for y in (0..n).step_by(half) {
                let first = if (y / half).is_multiple_of(2) { half } else { 0 };
                for x in (first..n).step_by(step) {
                    let mean = mean_of_neighbours(&heights, n, x, y, half);
                    heights[y * n + x] = mean + fractal.noise(edge_noise, half, x, y);
                }
            }
            step = half;
        }
        Self { n: [n as u32; 2], heights }
    }

    /// The heights, rows in order of y.
    #[must_use]
    pub fn heights(&self) -> &[f32] {
        &self.heights
    }

    /// Two triangles for each square of the grid over [0, 1]², with smooth normals (central differences), and texture
    /// coordinates (x, y).
    #[must_use]
    pub fn mesh(&self) -> TriangleMesh {
        let [nx, ny] = self.n;
        let n_vertices = self.heights.len();
        let mut mesh = TriangleMesh {
            positions: Vec::with_capacity(n_vertices),
            normals: Vec::with_capacity(n_vertices),
            uvs: Vec::with_capacity(n_vertices),
            indices: Vec::with_capacity(2 * n_vertices),
            ..TriangleMesh::default()
        };
        for j in 0..ny {
            for i in 0..nx {
                let (x, y) = (i as f32 / (nx - 1) as f32, j as f32 / (ny - 1) as f32);
                mesh.positions.push(Point3::new(x, y, self.at(i, j)));
                mesh.uvs.push(Point2::new(x, y));
                mesh.normals.push(self.normal(i, j));
                if i + 1 < nx && j + 1 < ny {
                    let a = j * nx + i;
                    mesh.indices.extend([[a, a + 1, a + 1 + nx], [a, a + 1 + nx, a + nx]]);
                }
            }
        }
        mesh
    }

    fn at(&self, i: u32, j: u32) -> f32 {
        self.heights[j as usize * self.n[0] as usize + i as usize]
    }

    /// Along the gradient by central differences, at borders by those of one side.
    fn normal(&self, i: u32, j: u32) -> Normal3 {
        let [nx, ny] = self.n;
        let (i0, i1) = (i.saturating_sub(1), (i + 1).min(nx - 1));
        let (j0, j1) = (j.saturating_sub(1), (j + 1).min(ny - 1));
        let dzdx = (self.at(i1, j) - self.at(i0, j)) * (nx - 1) as f32 / (i1 - i0) as f32;
        let dzdy = (self.at(i, j1) - self.at(i, j0)) * (ny - 1) as f32 / (j1 - j0) as f32;
        Normal3::new(-dzdx, -dzdy, 1.0).try_normalized().unwrap_or(Normal3::new(0.0, 0.0, 1.0))
    }
}

impl FractalHeights {
    /// Standard deviation of the middle of a square of that side from the mean of its corners.
    fn deviation(&self, side: f64) -> f64 {
        let h = f64::from(self.hurst);
        let variance = (-h).exp2() - 0.25 - h.exp2() / 8.0;
        f64::from(self.amplitude) * side.powf(h) * variance.max(0.0).sqrt()
    }

    fn noise(&self, deviation: f64, step: usize, x: usize, y: usize) -> f32 {
        (deviation * gaussian(&[self.seed, step as u64, x as u64, y as u64])) as f32
    }
}

/// Mean of the heights `half` to the left, right, below and above that are there.
fn mean_of_neighbours(heights: &[f32], n: usize, x: usize, y: usize, half: usize) -> f32 {
    let (mut sum, mut count) = (0.0, 0.0);
    let mut add = |x: usize, y: usize| {
        sum += heights[y * n + x];
        count += 1.0;
    };
    if x >= half {
        add(x - half, y);
    }
    if x + half < n {
        add(x + half, y);
    }
    if y >= half {
        add(x, y - half);
    }
    if y + half < n {
        add(x, y + half);
    }
    sum / count
}
