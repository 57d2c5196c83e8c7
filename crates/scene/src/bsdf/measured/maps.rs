//! Functions on the unit square by their values at nodes, bilinear between them, one for each of some conditions; and the
//! densities in proportion to them.
//!
//! Between conditions functions are mixed linearly. The distribution functions of densities, of rows and within rows, mix
//! in the same way, so that a mixture is sampled by inversion as each of its parts is: the row by the integrals of rows,
//! which are linear between nodes, then the place in it (Dupuy and Jakob 2018, section 4; the inversion of a linear
//! density is [`warp::sample_linear`]).

use etendue_math::{ONE_MINUS_EPSILON, Point2, lerp, warp};

use crate::bsdf::tabulated::place;

/// Up to four conditions with their weights, which sum to 1.
pub(super) type Mixture = [(usize, f32); 4];

/// Values at nodes, x quickest, then y, then the condition.
#[derive(Clone, Debug, PartialEq)]
pub struct Maps {
    /// Nodes along x and y: at least 2.
    pub size: [usize; 2],
    /// All values.
    pub values: Vec<f32>,
}

impl Maps {
    /// Values of one condition.
    const fn stride(&self) -> usize {
        self.size[0] * self.size[1]
    }

    /// The value of a condition at a point.
    pub(super) fn at(&self, condition: usize, p: Point2) -> f32 {
        let [nx, ny] = self.size;
        let ((column, s), (row, t)) = (place(p.x, nx), place(p.y, ny));
        let first = condition * self.stride() + row * nx + column;
        let along = |first: usize| lerp(s, self.values[first], self.values[first + 1]);
        lerp(t, along(first), along(first + nx))
    }

    /// The value of a mixture of conditions, where those of `stride` follow each other and `offset` counts from the first.
    pub(super) fn of_mixture(&self, mixture: &Mixture, stride: usize, offset: usize, p: Point2) -> f32 {
        mixed(mixture, |condition| self.at(condition * stride + offset, p))
    }
}

/// Densities in proportion to maps.
#[derive(Clone, Debug)]
pub(super) struct Densities {
    density: Maps,
    /// For each node the integral along its row from the left edge to it.
    within: Vec<f32>,
    /// For each row the integral from the lower edge to it: 0 to 1.
    below: Vec<f32>,
}

/// A place between two rows: the lower, and the share of the way to the upper.
type Height = (usize, f32);

impl Densities {
    /// What is negative counts as 0; a map without positive values gives the even density.
    pub(super) fn new(mut density: Maps) -> Self {
        let [nx, ny] = density.size;
        let (mut within, mut below) = (Vec::new(), Vec::new());
        for values in density.values.chunks_mut(nx * ny) {
            values.iter_mut().for_each(|value| *value = value.max(0.0));
            if integrals(values, nx).1[ny - 1] <= 0.0 {
                values.fill(1.0);
            }
            let (along_rows, of_rows) = integrals(values, nx);
            let total = of_rows[ny - 1];
            values.iter_mut().for_each(|value| *value = (f64::from(*value) / total) as f32);
            within.extend(along_rows.into_iter().map(|integral| (integral / total) as f32));
            below.extend(of_rows.into_iter().map(|integral| (integral / total) as f32));
        }
        Self { density, within, below }
    }

    /// Density at a point of the unit square.
    pub(super) fn pdf(&self, mixture: &Mixture, p: Point2) -> f32 {
        self.density.of_mixture(mixture, 1, 0, p)
    }

    /// A point of the unit square.
    pub(super) fn sample(&self, mixture: &Mixture, u: Point2) -> Point2 {
        let [nx, ny] = self.density.size;
        let below = |row| self.below(mixture, row);
        let (row, rest) = find(ny, u.y, below);
        let t = through_cell(rest, [row, row + 1].map(|row| self.within(mixture, (row, 0.0), nx - 1)));
        let within = |column| self.within(mixture, (row, t), column);
        let (column, rest) = find(nx, u.x, within);
        let s = through_cell(rest, [column, column + 1].map(|column| self.at(mixture, (row, t), column)));
        Point2::new((column as f32 + s) / (nx - 1) as f32, (row as f32 + t) / (ny - 1) as f32)
    }

    /// The point of which [`Self::sample`] makes this one.
    pub(super) fn invert(&self, mixture: &Mixture, p: Point2) -> Point2 {
        let [nx, ny] = self.density.size;
        let ((column, s), (row, t)) = (place(p.x, nx), place(p.y, ny));
        let rows = [row, row + 1].map(|row| self.within(mixture, (row, 0.0), nx - 1));
        let below = |row| self.below(mixture, row);
        let y = lerp(back_through_cell(t, rows), below(row), below(row + 1)) / below(ny - 1);
        let nodes = [column, column + 1].map(|column| self.at(mixture, (row, t), column));
        let within = |column| self.within(mixture, (row, t), column);
        let x = lerp(back_through_cell(s, nodes), within(column), within(column + 1)) / within(nx - 1);
        // A row of nothing is never drawn.
        Point2::new(if x.is_finite() { x.clamp(0.0, 1.0) } else { p.x }, y.clamp(0.0, 1.0))
    }

    fn below(&self, mixture: &Mixture, row: usize) -> f32 {
        mixed(mixture, |condition| self.below[condition * self.density.size[1] + row])
    }

    /// The integral from the left edge to a column.
    fn within(&self, mixture: &Mixture, height: Height, column: usize) -> f32 {
        self.between_rows(&self.within, mixture, height, column)
    }

    /// The density at a column.
    fn at(&self, mixture: &Mixture, height: Height, column: usize) -> f32 {
        self.between_rows(&self.density.values, mixture, height, column)
    }

    fn between_rows(&self, values: &[f32], mixture: &Mixture, (row, t): Height, column: usize) -> f32 {
        let first = row * self.density.size[0] + column;
        let at = |node: usize| mixed(mixture, |condition| values[condition * self.density.stride() + node]);
        if t > 0.0 { lerp(t, at(first), at(first + self.density.size[0])) } else { at(first) }
    }
}

/// The mean over a mixture.
fn mixed(mixture: &Mixture, value: impl Fn(usize) -> f32) -> f32 {
    let parts = mixture.iter().filter(|(_, weight)| *weight > 0.0);
    parts.map(|(condition, weight)| weight * value(*condition)).sum()
}

/// The integral along its row up to each node, and over all rows up to each row.
fn integrals(values: &[f32], nx: usize) -> (Vec<f64>, Vec<f64>) {
    let along_row = |row: &[f32]| cumulated(row.iter().map(|value| f64::from(*value)).collect());
    let along_rows: Vec<f64> = values.chunks(nx).flat_map(along_row).collect();
    let of_rows = cumulated(along_rows.chunks(nx).map(|row| row[nx - 1]).collect());
    (along_rows, of_rows)
}

/// The integral up to each of the nodes of a unit interval, of a function that is linear between them.
fn cumulated(mut values: Vec<f64>) -> Vec<f64> {
    let half_step = 0.5 / (values.len() - 1) as f64;
    let (mut sum, mut last) = (0.0, values[0]);
    for value in &mut values[1..] {
        sum += half_step * (last + *value);
        last = std::mem::replace(value, sum);
    }
    values[0] = 0.0;
    values
}

/// The cell between two of `n` nodes in which an increasing function reaches a share of its last value, and the share of
/// the cell's increase.
fn find(n: usize, share: f32, integral: impl Fn(usize) -> f32) -> (usize, f32) {
    let wanted = share * integral(n - 1);
    let (mut low, mut high) = (0, n - 1);
    while high - low > 1 {
        let middle = low.midpoint(high);
        if integral(middle) <= wanted {
            low = middle;
        } else {
            high = middle;
        }
    }
    let (begin, end) = (integral(low), integral(low + 1));
    (low, if end > begin { ((wanted - begin) / (end - begin)).clamp(0.0, ONE_MINUS_EPSILON) } else { 0.5 })
}

/// How far through a cell whose density goes linearly from `a` to `b` a share of it lies.
fn through_cell(share: f32, [a, b]: [f32; 2]) -> f32 {
    if a + b > 0.0 { warp::sample_linear(share, a, b) } else { 0.5 }
}

/// Inverse of [`through_cell`].
fn back_through_cell(t: f32, [a, b]: [f32; 2]) -> f32 {
    if a + b > 0.0 { warp::invert_linear(t, a, b) } else { 0.5 }
}
