//! One dimension.

use crate::ONE_MINUS_EPSILON;

/// A density over an interval, constant in each of n equal cells.
#[derive(Clone, Debug)]
pub struct PiecewiseConstant1 {
    func: Vec<f32>,
    /// Distribution function at the n + 1 cell borders: 0 to 1.
    cdf: Vec<f32>,
    /// For each of n equal steps of the distribution function, the cell where it begins (Chen and Asau 1974): where a
    /// search starts that then has one or two cells to go.
    guide: Vec<u32>,
    min: f32,
    max: f32,
    integral: f32,
}

impl PiecewiseConstant1 {
    /// The density proportional to |`func`| over [`min`, `max`]. If it is 0 everywhere, samples are uniform with density 0.
    ///
    /// # Panics
    /// If `func` is empty or the interval has no length.
    #[must_use]
    pub fn new(func: &[f32], min: f32, max: f32) -> Self {
        assert!(!func.is_empty(), "a density needs a cell");
        assert!(max > min, "no interval from {min} to {max}");
        let func: Vec<f32> = func.iter().map(|f| f.abs()).collect();
        let total: f64 = func.iter().map(|f| f64::from(*f)).sum();
        let n = func.len();
        let mut cdf = Vec::with_capacity(n + 1);
        let mut below = 0.0_f64;
        cdf.push(0.0);
        for (index, f) in func.iter().enumerate() {
            below += f64::from(*f);
            let share = if total > 0.0 { below / total } else { (index + 1) as f64 / n as f64 };
            cdf.push(share as f32);
        }
        cdf[n] = 1.0;
        let begin =
            |step| cdf.partition_point(|c| *c <= step as f32 / n as f32).saturating_sub(1).min(n - 1) as u32;
        let guide = (0..n).map(begin).collect();
        let integral = (total * f64::from(max - min) / n as f64) as f32;
        Self { func, cdf, guide, min, max, integral }
    }

    /// Integral of |func| over the interval.
    #[inline]
    #[must_use]
    pub const fn integral(&self) -> f32 {
        self.integral
    }

    /// Number of cells.
    #[inline]
    #[must_use]
    pub const fn len(&self) -> usize {
        self.func.len()
    }

    /// Always false: there is at least one cell.
    #[inline]
    #[must_use]
    pub const fn is_empty(&self) -> bool {
        self.func.is_empty()
    }

    /// A number of the interval, its density, and the index of its cell.
    #[inline]
    #[must_use]
    pub fn sample(&self, u: f32) -> (f32, f32, usize) {
        let (offset, within) = self.sample_cell(u);
        let place = ((offset as f32 + within) / self.func.len() as f32).min(ONE_MINUS_EPSILON);
        let x = self.min + place * (self.max - self.min);
        (x.min(self.max), self.pdf_of_cell(offset), offset)
    }

    /// A cell, and the place in it, in [0, 1).
    #[inline]
    pub(super) fn sample_cell(&self, u: f32) -> (usize, f32) {
        let offset = self.cell_of_share(u);
        let (low, high) = (self.cdf[offset], self.cdf[offset + 1]);
        let within = if high > low { (u - low) / (high - low) } else { 0.0 };
        (offset, within.min(ONE_MINUS_EPSILON))
    }

    /// The last cell that begins at or below `u`: of positive share, since equal borders are skipped.
    #[inline]
    fn cell_of_share(&self, u: f32) -> usize {
        let last = self.func.len() - 1;
        let mut cell = self.guide[((u * self.func.len() as f32) as usize).min(last)] as usize;
        while cell < last && self.cdf[cell + 1] <= u {
            cell += 1;
        }
        // Rounding may have put u into the next step.
        while cell > 0 && self.cdf[cell] > u {
            cell -= 1;
        }
        cell
    }

    #[inline]
    fn pdf_of_cell(&self, offset: usize) -> f32 {
        if self.integral > 0.0 { self.func[offset] / self.integral } else { 0.0 }
    }

    /// Index of the cell that holds `x`; `None` outside the interval.
    #[inline]
    fn cell(&self, x: f32) -> Option<usize> {
        if !(x >= self.min && x <= self.max) {
            return None;
        }
        let place = (x - self.min) / (self.max - self.min);
        Some(((place * self.func.len() as f32) as usize).min(self.func.len() - 1))
    }

    /// Density at `x`; 0 outside the interval.
    #[inline]
    #[must_use]
    pub fn pdf(&self, x: f32) -> f32 {
        self.cell(x).map_or(0.0, |offset| self.pdf_of_cell(offset))
    }

    /// The number for which [`sample`](Self::sample) gives `x`; `None` outside the interval.
    #[must_use]
    pub fn invert(&self, x: f32) -> Option<f32> {
        let offset = self.cell(x)?;
        let place = (x - self.min) / (self.max - self.min) * self.func.len() as f32;
        let within = (place - offset as f32).clamp(0.0, 1.0);
        let u = self.cdf[offset] + within * (self.cdf[offset + 1] - self.cdf[offset]);
        Some(u.clamp(0.0, ONE_MINUS_EPSILON))
    }
}
