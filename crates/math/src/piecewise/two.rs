//! Two dimensions: a marginal density of rows, and for each row a conditional density within it.

use super::PiecewiseConstant1;
use crate::{Bounds2, Point2};

/// A density over a rectangle, constant in each cell of a grid.
#[derive(Clone, Debug)]
pub struct PiecewiseConstant2 {
    rows: Vec<PiecewiseConstant1>,
    marginal: PiecewiseConstant1,
}

impl PiecewiseConstant2 {
    /// The density proportional to |`func`|, row by row: `nx` values for the lowest y first.
    ///
    /// # Panics
    /// If `func` does not hold `nx * ny` values, none, or the domain has no area.
    #[must_use]
    pub fn new(func: &[f32], nx: usize, ny: usize, domain: Bounds2) -> Self {
        assert_eq!(func.len(), nx * ny, "a grid of {nx} x {ny} cells");
        assert!(nx > 0, "a density needs a cell");
        let rows: Vec<PiecewiseConstant1> = func
            .chunks_exact(nx)
            .map(|row| PiecewiseConstant1::new(row, domain.min.x, domain.max.x))
            .collect();
        let integrals: Vec<f32> = rows.iter().map(PiecewiseConstant1::integral).collect();
        let marginal = PiecewiseConstant1::new(&integrals, domain.min.y, domain.max.y);
        Self { rows, marginal }
    }

    /// Integral of |func| over the domain.
    #[inline]
    #[must_use]
    pub const fn integral(&self) -> f32 {
        self.marginal.integral()
    }

    /// Numbers of cells in x and y.
    #[must_use]
    pub fn resolution(&self) -> [usize; 2] {
        [self.rows[0].len(), self.rows.len()]
    }

    /// A point and its density per unit area of the domain.
    #[inline]
    #[must_use]
    pub fn sample(&self, u: Point2) -> (Point2, f32) {
        let (y, pdf_y, row) = self.marginal.sample(u.y);
        let (x, pdf_x, _) = self.rows[row].sample(u.x);
        (Point2::new(x, y), pdf_x * pdf_y)
    }

    /// Density at `p`; 0 outside the domain.
    #[inline]
    #[must_use]
    pub fn pdf(&self, p: Point2) -> f32 {
        let Some(row) = self.marginal.cell(p.y) else { return 0.0 };
        self.marginal.pdf_of_cell(row) * self.rows[row].pdf(p.x)
    }

    /// The numbers for which [`sample`](Self::sample) gives `p`; `None` outside the domain.
    #[must_use]
    pub fn invert(&self, p: Point2) -> Option<Point2> {
        let row = self.marginal.cell(p.y)?;
        Some(Point2::new(self.rows[row].invert(p.x)?, self.marginal.invert(p.y)?))
    }
}
