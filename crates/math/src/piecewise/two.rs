//! Two dimensions, in two levels: first a square block of cells, then a cell within it. At each level first the row, then
//! the place in it.
//!
//! A picture's distribution is larger than the caches near the processor, and a sample may fall anywhere. The coarse level
//! of a picture of 512 x 512 cells has 128 KiB; the numbers of a block are one cache line.

use super::PiecewiseConstant1;
use crate::{Bounds2, ONE_MINUS_EPSILON, Point2, lerp};

/// Cells along the side of a block.
const SIDE: usize = 4;

/// The values of the cells of a block, row by row; 0 beyond the grid.
#[derive(Clone, Copy, Debug, Default)]
#[repr(align(64))]
struct Block([[f32; SIDE]; SIDE]);

/// A density over a rectangle, constant in each cell of a grid.
#[derive(Clone, Debug)]
pub struct PiecewiseConstant2 {
    resolution: [usize; 2],
    domain: Bounds2,
    /// Density of the rows of blocks, and of the blocks within each row, over their numbers.
    marginal: PiecewiseConstant1,
    rows: Vec<PiecewiseConstant1>,
    blocks: Vec<Block>,
    integral: f32,
    /// Density per unit area of the domain for a value of 1.
    density: f32,
}

impl PiecewiseConstant2 {
    /// The density proportional to |`func`|, row by row: `nx` values for the lowest y first. If it is 0 everywhere, samples
    /// are uniform with density 0.
    ///
    /// # Panics
    /// If `func` does not hold `nx * ny` values, none, or the domain has no area.
    #[must_use]
    pub fn new(func: &[f32], nx: usize, ny: usize, domain: Bounds2) -> Self {
        assert_eq!(func.len(), nx * ny, "a grid of {nx} x {ny} cells");
        assert!(!func.is_empty(), "a density needs a cell");
        assert!(domain.area() > 0.0, "a domain without area");
        let (n_columns, n_rows) = (nx.div_ceil(SIDE), ny.div_ceil(SIDE));
        let mut blocks = vec![Block::default(); n_columns * n_rows];
        for (index, value) in func.iter().enumerate() {
            let (x, y) = (index % nx, index / nx);
            blocks[y / SIDE * n_columns + x / SIDE].0[y % SIDE][x % SIDE] = value.abs();
        }
        let rows: Vec<PiecewiseConstant1> = blocks
            .chunks_exact(n_columns)
            .map(|row| {
                let sums: Vec<f32> = row.iter().map(Block::sum).collect();
                PiecewiseConstant1::new(&sums, 0.0, n_columns as f32)
            })
            .collect();
        let sums: Vec<f32> = rows.iter().map(PiecewiseConstant1::integral).collect();
        let marginal = PiecewiseConstant1::new(&sums, 0.0, n_rows as f32);
        let total: f64 = func.iter().map(|value| f64::from(value.abs())).sum();
        let integral = (total * f64::from(domain.area()) / func.len() as f64) as f32;
        let density = if integral > 0.0 { 1.0 / integral } else { 0.0 };
        Self { resolution: [nx, ny], domain, marginal, rows, blocks, integral, density }
    }

    /// Integral of |func| over the domain.
    #[inline]
    #[must_use]
    pub const fn integral(&self) -> f32 {
        self.integral
    }

    /// Numbers of cells in x and y.
    #[must_use]
    pub const fn resolution(&self) -> [usize; 2] {
        self.resolution
    }

    /// A point and its density per unit area of the domain.
    #[inline]
    #[must_use]
    pub fn sample(&self, u: Point2) -> (Point2, f32) {
        if self.integral <= 0.0 {
            return (self.place(u), 0.0);
        }
        let (row, v_rest) = self.marginal.sample_cell(u.y);
        let (column, u_rest) = self.rows[row].sample_cell(u.x);
        let block = &self.blocks[row * self.rows[0].len() + column];
        let (y, v_rest) = choose(&block.row_sums(), v_rest);
        let (x, u_rest) = choose(&block.0[y], u_rest);
        let along = |block: usize, cell: usize, rest: f32, n: usize| {
            (((block * SIDE + cell) as f32 + rest) / n as f32).min(ONE_MINUS_EPSILON)
        };
        let [nx, ny] = self.resolution;
        let p = Point2::new(along(column, x, u_rest, nx), along(row, y, v_rest, ny));
        (self.place(p), block.0[y][x] * self.density)
    }

    /// Density at `p`; 0 outside the domain.
    #[inline]
    #[must_use]
    pub fn pdf(&self, p: Point2) -> f32 {
        self.cell(p).map_or(0.0, |([x, y], _)| self.block(x, y).0[y % SIDE][x % SIDE] * self.density)
    }

    /// The numbers for which [`sample`](Self::sample) gives `p`; `None` outside the domain.
    #[must_use]
    pub fn invert(&self, p: Point2) -> Option<Point2> {
        let ([x, y], rest) = self.cell(p)?;
        let block = self.block(x, y);
        let v = share_below(&block.row_sums(), y % SIDE, rest.y);
        let u = share_below(&block.0[y % SIDE], x % SIDE, rest.x);
        let (row, column) = (y / SIDE, x / SIDE);
        let u = self.rows[row].invert(column as f32 + u)?;
        Some(Point2::new(u, self.marginal.invert(row as f32 + v)?))
    }

    /// The point of the domain at coordinates from 0 to 1.
    #[inline]
    fn place(&self, t: Point2) -> Point2 {
        let Bounds2 { min, max } = self.domain;
        Point2::new(lerp(t.x, min.x, max.x), lerp(t.y, min.y, max.y))
    }

    /// The cell that holds `p`, and where in it.
    #[inline]
    fn cell(&self, p: Point2) -> Option<([usize; 2], Point2)> {
        let Bounds2 { min, max } = self.domain;
        let axis = |p: f32, min: f32, max: f32, n: usize| {
            let place = (p - min) / (max - min) * n as f32;
            let cell = (place as usize).min(n - 1);
            (p >= min && p <= max).then_some((cell, (place - cell as f32).clamp(0.0, 1.0)))
        };
        let (x, x_rest) = axis(p.x, min.x, max.x, self.resolution[0])?;
        let (y, y_rest) = axis(p.y, min.y, max.y, self.resolution[1])?;
        Some(([x, y], Point2::new(x_rest, y_rest)))
    }

    #[inline]
    fn block(&self, x: usize, y: usize) -> &Block {
        &self.blocks[y / SIDE * self.rows[0].len() + x / SIDE]
    }
}

impl Block {
    #[inline]
    fn row_sums(&self) -> [f32; SIDE] {
        self.0.map(|row| row.iter().sum())
    }

    fn sum(&self) -> f32 {
        self.row_sums().iter().sum()
    }
}

/// A number in proportion to its weight, and the remainder of `u`; never one of weight 0 while another has some.
#[inline]
fn choose(weights: &[f32; SIDE], u: f32) -> (usize, f32) {
    let position = u * weights.iter().sum::<f32>();
    let (mut chosen, mut start, mut end) = (0, 0.0, 0.0);
    for (index, weight) in weights.iter().enumerate() {
        if *weight > 0.0 {
            (chosen, start) = (index, end);
            end += weight;
            if position < end {
                break;
            }
        }
    }
    let within = if weights[chosen] > 0.0 { (position - start) / weights[chosen] } else { u };
    (chosen, within.clamp(0.0, ONE_MINUS_EPSILON))
}

/// The number for which [`choose`] gives this choice and remainder.
fn share_below(weights: &[f32; SIDE], index: usize, rest: f32) -> f32 {
    let below: f32 = weights[..index].iter().sum();
    let total: f32 = weights.iter().sum();
    if total > 0.0 { (below + rest * weights[index]) / total } else { rest }
}
