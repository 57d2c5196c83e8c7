//! Compression of gradients (Fattal, Lischinski and Werman 2002, "Gradient Domain High Dynamic Range Compression"; SPEC
//! TONE-8).
//!
//! Steep gradients of the logarithm of luminance are weakened at every scale of a pyramid, weak ones strengthened a little;
//! the picture whose gradients come nearest is the solution of a Poisson equation.

use super::poisson;
use crate::plane::Plane;

/// Parameters of the gradient operator.
#[derive(Copy, Clone, Debug, PartialEq)]
pub struct Gradient {
    /// Gradients of this share of the mean one stay as they are, alpha in the paper.
    pub threshold: f32,
    /// Steeper ones are multiplied by their ratio to that, to this power less 1; beta in the paper.
    pub exponent: f32,
    /// Power of the ratio of a channel to luminance.
    pub saturation: f32,
}

impl Default for Gradient {
    fn default() -> Self {
        Self { threshold: 0.1, exponent: 0.85, saturation: 0.6 }
    }
}

/// Side of the coarsest level of the pyramid, in pixels.
const COARSEST: usize = 32;

/// Reach in pixels over which factors are averaged. Along an edge that is no row or column they differ from pixel to pixel, and then
/// the weakened gradients belong to no picture: without this an edge at 45 degrees has a halo of 8 % of the step, with it of 1 %.
const SMOOTHNESS: f32 = 2.0;

impl Gradient {
    /// Displayed luminance as natural logarithms, up to a constant, of luminances as natural logarithms.
    pub(super) fn map(&self, ln: &Plane) -> Plane {
        let factors = self.attenuation(ln);
        let (width, height) = (ln.width, ln.height);
        // Forward differences, attenuated by the mean of both ends, so that each gradient keeps its sign.
        let gx = Plane::from_rows(width, height, |y, row| {
            let (values, factors) = (ln.row(y), factors.row(y));
            for x in 0..width.saturating_sub(1) {
                row[x] = (values[x + 1] - values[x]) * 0.5 * (factors[x] + factors[x + 1]);
            }
        });
        let gy = Plane::from_rows(width, height, |y, row| {
            if y + 1 == height {
                return;
            }
            let (a, b) = (ln.row(y), ln.row(y + 1));
            let (fa, fb) = (factors.row(y), factors.row(y + 1));
            for x in 0..width {
                row[x] = (b[x] - a[x]) * 0.5 * (fa[x] + fb[x]);
            }
        });
        poisson::solve(&divergence(&gx, &gy), ln)
    }

    /// The factor of each pixel's gradient: the product over all levels.
    fn attenuation(&self, ln: &Plane) -> Plane {
        let mut levels = vec![ln.clone()];
        while let Some(last) = levels.last()
            && last.width.min(last.height) > COARSEST
        {
            levels.push(last.blurred(1.0).halved());
        }
        let mut product: Option<Plane> = None;
        for (level, plane) in levels.iter().enumerate().rev() {
            let steepness = steepness(plane, level);
            let mean =
                steepness.values.iter().map(|v| f64::from(*v)).sum::<f64>() / steepness.values.len() as f64;
            let alpha = self.threshold * mean as f32;
            let exponent = self.exponent - 1.0;
            // Gradients near zero would be strengthened without bound.
            let own = steepness
                .map(|g| if alpha > 0.0 { (g.max(0.1 * alpha) / alpha).powf(exponent) } else { 1.0 });
            product = Some(match product {
                None => own,
                Some(coarse) => {
                    let coarse = coarse.doubled(plane.width, plane.height);
                    let values = coarse.values.iter().zip(&own.values).map(|(a, b)| a * b).collect();
                    Plane::new(plane.width, plane.height, values)
                }
            });
        }
        product.unwrap_or_else(|| ln.clone()).blurred(SMOOTHNESS)
    }
}

/// Length of the gradient for each pixel of the full size, by central differences.
fn steepness(plane: &Plane, level: usize) -> Plane {
    let step = (2.0_f32).powi(level as i32 + 1);
    Plane::from_rows(plane.width, plane.height, |y, row| {
        let last = [plane.width - 1, plane.height - 1];
        let (above, below) = (plane.row(y.saturating_sub(1)), plane.row((y + 1).min(last[1])));
        let here = plane.row(y);
        for (x, value) in row.iter_mut().enumerate() {
            let dx = here[(x + 1).min(last[0])] - here[x.saturating_sub(1)];
            *value = dx.hypot(below[x] - above[x]) / step;
        }
    })
}

/// Backward differences of forward differences: the five-point Laplacian, with no flow across the border.
fn divergence(gx: &Plane, gy: &Plane) -> Plane {
    Plane::from_rows(gx.width, gx.height, |y, row| {
        for (x, value) in row.iter_mut().enumerate() {
            let left = if x > 0 { gx.row(y)[x - 1] } else { 0.0 };
            let above = if y > 0 { gy.row(y - 1)[x] } else { 0.0 };
            *value = gx.row(y)[x] - left + gy.row(y)[x] - above;
        }
    })
}
