//! Two dimensions, restricted to a window that is known only when sampling: what can be seen through a portal (Bitterli,
//! Novák and Jarosz 2015, "Portal-Masked Environment Map Sampling"). A summed-area table gives the integral over any
//! window; the distribution functions are inverted by bisection.

use crate::{Bounds2, Point2};

/// A density over a rectangle, constant in each cell of a grid, that may be restricted to a window.
#[derive(Clone, Debug)]
pub struct WindowedPiecewiseConstant2 {
    func: Vec<f32>,
    nx: usize,
    ny: usize,
    domain: Bounds2,
    /// Sums over the cells below and left of each grid corner, (nx + 1) by (ny + 1).
    sums: Vec<f64>,
}

impl WindowedPiecewiseConstant2 {
    /// The density proportional to |`func`|, row by row: `nx` values for the lowest y first.
    ///
    /// # Panics
    /// If `func` does not hold `nx * ny` values, none, or the domain has no area.
    #[must_use]
    pub fn new(func: &[f32], nx: usize, ny: usize, domain: Bounds2) -> Self {
        assert_eq!(func.len(), nx * ny, "a grid of {nx} x {ny} cells");
        assert!(!func.is_empty(), "a density needs a cell");
        assert!(domain.area() > 0.0, "a domain without area");
        let func: Vec<f32> = func.iter().map(|f| f.abs()).collect();
        let stride = nx + 1;
        let mut sums = vec![0.0; stride * (ny + 1)];
        for y in 0..ny {
            let mut row = 0.0;
            for x in 0..nx {
                row += f64::from(func[y * nx + x]);
                sums[(y + 1) * stride + x + 1] = sums[y * stride + x + 1] + row;
            }
        }
        Self { func, nx, ny, domain, sums }
    }

    /// A point of the window and its density there; `None` if the function is 0 throughout.
    #[must_use]
    pub fn sample(&self, u: Point2, window: Bounds2) -> Option<(Point2, f32)> {
        let cells = self.cells_of(window)?;
        let [x0, y0, x1, y1] = cells;
        let total = self.integral(cells);
        if total <= 0.0 {
            return None;
        }
        let x = bisect(f64::from(u.x) * total, x0, x1, self.nx, |x| self.integral([x0, y0, x, y1]));
        // A strip of one column: the density in y given x.
        let (left, right) = strip(x, x0, x1);
        let column = self.integral([left, y0, right, y1]);
        if column <= 0.0 {
            return None;
        }
        let y = bisect(f64::from(u.y) * column, y0, y1, self.ny, |y| self.integral([left, y0, right, y]));
        let p = Point2::new(
            self.domain.min.x + (x / self.nx as f64) as f32 * self.width(),
            self.domain.min.y + (y / self.ny as f64) as f32 * self.height(),
        );
        let value = self.value(x.min(self.nx as f64 - 1e-9), y.min(self.ny as f64 - 1e-9));
        (value > 0.0).then(|| (p, self.density(value, total)))
    }

    /// Density at `p` of [`sample`](Self::sample) with this window; 0 outside of it.
    #[must_use]
    pub fn pdf(&self, p: Point2, window: Bounds2) -> f32 {
        let inside = p.x >= window.min.x && p.x <= window.max.x && p.y >= window.min.y && p.y <= window.max.y;
        let Some(cells) = self.cells_of(window).filter(|_| inside) else { return 0.0 };
        let total = self.integral(cells);
        if total <= 0.0 {
            return 0.0;
        }
        let x = f64::from((p.x - self.domain.min.x) / self.width()) * self.nx as f64;
        let y = f64::from((p.y - self.domain.min.y) / self.height()) * self.ny as f64;
        if x < 0.0 || y < 0.0 || x > self.nx as f64 || y > self.ny as f64 {
            return 0.0;
        }
        self.density(self.value(x, y), total)
    }

    /// Integral of |func| over the part of the window inside the domain.
    #[must_use]
    pub fn window_integral(&self, window: Bounds2) -> f32 {
        let cell_area = f64::from(self.width()) * f64::from(self.height()) / (self.nx * self.ny) as f64;
        self.cells_of(window).map_or(0.0, |cells| (self.integral(cells) * cell_area) as f32)
    }

    fn width(&self) -> f32 {
        self.domain.max.x - self.domain.min.x
    }

    fn height(&self) -> f32 {
        self.domain.max.y - self.domain.min.y
    }

    /// Density per unit area of the domain, where `total` is the integral in units of cells.
    fn density(&self, value: f64, total: f64) -> f32 {
        let cell_area = f64::from(self.width()) * f64::from(self.height()) / (self.nx * self.ny) as f64;
        (value / (total * cell_area)) as f32
    }

    /// The window in units of cells `[x0, y0, x1, y1]`, cut at the border of the domain.
    fn cells_of(&self, window: Bounds2) -> Option<[f64; 4]> {
        let x = |x: f32| {
            (f64::from((x - self.domain.min.x) / self.width()) * self.nx as f64).clamp(0.0, self.nx as f64)
        };
        let y = |y: f32| {
            (f64::from((y - self.domain.min.y) / self.height()) * self.ny as f64).clamp(0.0, self.ny as f64)
        };
        let cells = [x(window.min.x), y(window.min.y), x(window.max.x), y(window.max.y)];
        (cells[2] > cells[0] && cells[3] > cells[1]).then_some(cells)
    }

    fn value(&self, x: f64, y: f64) -> f64 {
        let (x, y) = ((x as usize).min(self.nx - 1), (y as usize).min(self.ny - 1));
        f64::from(self.func[y * self.nx + x])
    }

    /// Integral over a rectangle in units of cells.
    fn integral(&self, [x0, y0, x1, y1]: [f64; 4]) -> f64 {
        (self.sum(x1, y1) - self.sum(x0, y1) - self.sum(x1, y0) + self.sum(x0, y0)).max(0.0)
    }

    /// Integral from the lower left corner; bilinear between the corners of cells.
    fn sum(&self, x: f64, y: f64) -> f64 {
        let (column, row) = ((x as usize).min(self.nx - 1), (y as usize).min(self.ny - 1));
        let (fx, fy) = (x - column as f64, y - row as f64);
        let at = |column: usize, row: usize| self.sums[row * (self.nx + 1) + column];
        let low = (1.0 - fx) * at(column, row) + fx * at(column + 1, row);
        let high = (1.0 - fx) * at(column, row + 1) + fx * at(column + 1, row + 1);
        (1.0 - fy) * low + fy * high
    }
}

/// The part of the column of cells around `x` within the window.
fn strip(x: f64, x0: f64, x1: f64) -> (f64, f64) {
    let column = x.min(x1 - 1e-12).floor();
    (column.max(x0), (column + 1.0).min(x1))
}

/// Where in [low, high] the increasing function `cumulative`, linear within each of the `n` cells, reaches `target`.
fn bisect(target: f64, low: f64, high: f64, n: usize, cumulative: impl Fn(f64) -> f64) -> f64 {
    // First the cell: the last border at which the target is not yet reached.
    let (mut first, mut last) = (low.floor() as usize, (high.ceil() as usize).min(n));
    let border = |cell: usize| (cell as f64).clamp(low, high);
    while last - first > 1 {
        let middle = first + (last - first) / 2;
        if cumulative(border(middle)) <= target {
            first = middle;
        } else {
            last = middle;
        }
    }
    let (a, b) = (border(first), border(last));
    let (at_a, at_b) = (cumulative(a), cumulative(b));
    let t = if at_b > at_a { ((target - at_a) / (at_b - at_a)).clamp(0.0, 1.0) } else { 0.5 };
    a + t * (b - a)
}
