//! Bilinear density on the unit square, given by its values at the corners.

use super::interval::{invert_linear, linear_pdf, sample_linear};
use crate::Point2;

/// A point with density bilinear in x and y; `w` are the weights at (0,0), (1,0), (0,1), (1,1), at least 0, not all 0.
#[inline]
#[must_use]
pub fn sample_bilinear(u: Point2, w: [f32; 4]) -> Point2 {
    let y = sample_linear(u.y, w[0] + w[1], w[2] + w[3]);
    let [a, b] = row(y, w);
    Point2::new(sample_linear(u.x, a, b), y)
}

/// Density of [`sample_bilinear`].
#[inline]
#[must_use]
pub fn bilinear_pdf(p: Point2, w: [f32; 4]) -> f32 {
    let [a, b] = row(p.y, w);
    if a + b <= 0.0 {
        return 0.0;
    }
    linear_pdf(p.x, a, b) * linear_pdf(p.y, w[0] + w[1], w[2] + w[3])
}

/// Inverse of [`sample_bilinear`].
#[inline]
#[must_use]
pub fn invert_bilinear(p: Point2, w: [f32; 4]) -> Point2 {
    let [a, b] = row(p.y, w);
    Point2::new(invert_linear(p.x, a, b), invert_linear(p.y, w[0] + w[1], w[2] + w[3]))
}

/// The weights at x = 0 and x = 1 of the row at height `y`.
fn row(y: f32, w: [f32; 4]) -> [f32; 2] {
    [(1.0 - y) * w[0] + y * w[2], (1.0 - y) * w[1] + y * w[3]]
}
