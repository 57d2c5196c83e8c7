//! Base and detail by the bilateral filter (Durand and Dorsey 2002, "Fast Bilateral Filtering for the Display of
//! High-Dynamic-Range Images"; SPEC TONE-7), on a bilateral grid (Chen, Paris and Durand 2007, "Real-time Edge-Aware Image
//! Processing with the Bilateral Grid").
//!
//! The logarithm of luminance is smoothed within regions but not across edges; what that leaves out is detail. Only the
//! smooth base is compressed, so that texture stays and edges have no halos.

use crate::plane::Plane;

/// Parameters of the bilateral operator.
#[derive(Copy, Clone, Debug, PartialEq)]
pub struct Bilateral {
    /// Ratio of the brightest to the darkest base that the display shows, above 1.
    pub contrast: f32,
    /// Standard deviation in space, as a share of the longer side of the picture.
    pub space: f32,
    /// Standard deviation in decades of luminance.
    pub range: f32,
}

impl Default for Bilateral {
    fn default() -> Self {
        Self { contrast: 50.0, space: 0.02, range: 0.4 }
    }
}

impl Bilateral {
    /// Displayed luminance in decades, at most about 0, of luminances in decades.
    pub(super) fn map(&self, log10: &Plane) -> Plane {
        let sigma = (self.space * log10.width.max(log10.height) as f32).max(1.0);
        let base = Grid::new(log10, sigma, self.range).smoothed().slice(log10);
        let (low, high) = base.range();
        let target = self.contrast.log10();
        let factor = if high - low > target { target / (high - low) } else { 1.0 };
        let shown = log10.values.iter().zip(&base.values);
        let shown = shown.map(|(value, base)| (base - high) * factor + (value - base)).collect();
        Plane::new(log10.width, log10.height, shown)
    }
}

/// Sums of values and of their number over boxes of space and value, with two empty layers around.
struct Grid {
    size: [usize; 3],
    /// Pixels, and decades, for each cell.
    steps: [f32; 2],
    low: f32,
    /// Sum of values, and number of them.
    cells: Vec<[f32; 2]>,
}

/// Empty cells on each side: blurs and interpolation reach over them.
const MARGIN: usize = 2;

impl Grid {
    /// A cell is as large as one standard deviation.
    fn new(plane: &Plane, sigma: f32, range: f32) -> Self {
        let (low, high) = plane.range();
        let n = |extent: f32, step: f32| (extent / step) as usize + 2 + 2 * MARGIN;
        let size = [n(plane.width as f32, sigma), n(plane.height as f32, sigma), n(high - low, range)];
        let mut grid =
            Self { size, steps: [sigma, range], low, cells: vec![[0.0; 2]; size.iter().product()] };
        for y in 0..plane.height {
            for (x, value) in plane.row(y).iter().enumerate() {
                let place = grid.place(x, y, *value).map(|at| at.round() as usize);
                let cell = grid.index(place);
                grid.cells[cell][0] += value;
                grid.cells[cell][1] += 1.0;
            }
        }
        grid
    }

    fn place(&self, x: usize, y: usize, value: f32) -> [f32; 3] {
        let [space, range] = self.steps;
        [x as f32 / space, y as f32 / space, (value - self.low) / range].map(|at| at + MARGIN as f32)
    }

    const fn index(&self, [x, y, z]: [usize; 3]) -> usize {
        (y * self.size[0] + x) * self.size[2] + z
    }

    /// Blurred by (1, 4, 6, 4, 1) / 16 along each axis, which has a standard deviation of one cell.
    fn smoothed(mut self) -> Self {
        let strides = [self.size[2], self.size[0] * self.size[2], 1];
        for (stride, size) in strides.into_iter().zip(self.size) {
            let before = self.cells.clone();
            for (i, cell) in self.cells.iter_mut().enumerate() {
                let at = i / stride % size;
                let mut sum = [0.0; 2];
                for (shift, weight) in [0.0625, 0.25, 0.375, 0.25, 0.0625].into_iter().enumerate() {
                    if at + shift >= 2 && at + shift - 2 < size {
                        let source = before[i + shift * stride - 2 * stride];
                        sum = [sum[0] + weight * source[0], sum[1] + weight * source[1]];
                    }
                }
                *cell = sum;
            }
        }
        self
    }

    /// The smooth value at each pixel: sums and numbers interpolated, then divided.
    fn slice(&self, plane: &Plane) -> Plane {
        Plane::from_rows(plane.width, plane.height, |y, row| {
            for (x, (result, value)) in row.iter_mut().zip(plane.row(y)).enumerate() {
                let place = self.place(x, y, *value);
                let low = place.map(|at| at.floor());
                let t: [f32; 3] = std::array::from_fn(|axis| place[axis] - low[axis]);
                let mut sum = [0.0_f32; 2];
                for corner in 0..8 {
                    let high = |axis: usize| corner >> axis & 1;
                    let weight = |axis: usize| if high(axis) == 1 { t[axis] } else { 1.0 - t[axis] };
                    let w = weight(0) * weight(1) * weight(2);
                    let cell =
                        self.cells[self.index(std::array::from_fn(|axis| low[axis] as usize + high(axis)))];
                    sum = [sum[0] + w * cell[0], sum[1] + w * cell[1]];
                }
                *result = if sum[1] > 1e-12 { sum[0] / sum[1] } else { *value };
            }
        })
    }
}
