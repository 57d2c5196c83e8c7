//! Adaptive integrals over rectangles: the 3 by 3 Gauss rule, split in four until whole and parts agree. Gauss points lie
//! inside the cell, so that densities which end at its border do no harm.

/// A rectangle `[x0, x1] x [y0, y1]`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Rectangle {
    /// Lower end in x.
    pub x0: f64,
    /// Upper end in x.
    pub x1: f64,
    /// Lower end in y.
    pub y0: f64,
    /// Upper end in y.
    pub y1: f64,
}

impl Rectangle {
    /// The four quarters; quarter `2 * iy + ix`.
    #[must_use]
    pub fn quarters(self) -> [Self; 4] {
        let (x, y) = (0.5 * (self.x0 + self.x1), 0.5 * (self.y0 + self.y1));
        [
            Self { x1: x, y1: y, ..self },
            Self { x0: x, y1: y, ..self },
            Self { x1: x, y0: y, ..self },
            Self { x0: x, y0: y, ..self },
        ]
    }

    /// True if the point is inside; the lower borders belong to it.
    #[must_use]
    pub fn contains(self, x: f64, y: f64) -> bool {
        x >= self.x0 && x < self.x1 && y >= self.y0 && y < self.y1
    }
}

fn gauss(f: &impl Fn(f64, f64) -> f64, r: Rectangle) -> f64 {
    // Abscissae of the Gauss-Legendre rule of degree 5 on [-1, 1]: 0 and sqrt(3/5).
    const NODES: [(f64, f64); 3] =
        [(-0.774_596_669_241_483_4, 5.0 / 18.0), (0.0, 8.0 / 18.0), (0.774_596_669_241_483_4, 5.0 / 18.0)];
    let (cx, cy) = (0.5 * (r.x0 + r.x1), 0.5 * (r.y0 + r.y1));
    let (hx, hy) = (0.5 * (r.x1 - r.x0), 0.5 * (r.y1 - r.y0));
    let mut sum = 0.0;
    for (y, weight_y) in NODES {
        for (x, weight_x) in NODES {
            sum += weight_x * weight_y * f(cx + hx * x, cy + hy * y);
        }
    }
    sum * 4.0 * hx * hy
}

/// Integral of `f(x, y)` over a rectangle to about the absolute error `tolerance`, with at most `max_depth` splits.
#[must_use]
pub fn integrate_rectangle(
    f: &impl Fn(f64, f64) -> f64,
    r: Rectangle,
    tolerance: f64,
    max_depth: u32,
) -> f64 {
    // The first splits are unconditional: of few cells, whole and parts may agree by accident at a step of the integrand,
    // or all miss a sliver between a curved step and the border.
    let quarters = r.quarters().into_iter().flat_map(Rectangle::quarters);
    quarters.map(|quarter| refine(f, quarter, gauss(f, quarter), 0.25 * tolerance, max_depth)).sum()
}

fn refine(f: &impl Fn(f64, f64) -> f64, r: Rectangle, whole: f64, tolerance: f64, depth: u32) -> f64 {
    let quarters = r.quarters();
    let parts = quarters.map(|quarter| gauss(f, quarter));
    let sum: f64 = parts.iter().sum();
    if depth == 0 || (sum - whole).abs() <= tolerance {
        return sum;
    }
    // Errors of the quarters have random signs, so that each may have half of the whole.
    quarters
        .into_iter()
        .zip(parts)
        .map(|(quarter, part)| refine(f, quarter, part, 0.5 * tolerance, depth - 1))
        .sum()
}
