//! The form of the aperture stop: how much light passes at each of its points.

use std::sync::Arc;

use etendue_math::Point2;

use crate::camera::Blades;

/// How much of the stop's circle is open.
#[derive(Clone, Debug, Default, PartialEq)]
pub enum StopShape {
    /// All.
    #[default]
    Disc,
    /// A regular polygon, whose corners are at this share of the radius.
    Polygon(Blades, f32),
    /// A star of five points.
    Star,
    /// Less towards the rim.
    Gaussian,
    /// A picture over the square around the circle, whose values are the share that passes.
    Picture(Arc<StopPicture>),
}

/// Shares in [0, 1] by place, row by row from the top.
#[derive(Clone, Debug, PartialEq)]
pub struct StopPicture {
    width: usize,
    height: usize,
    open: Vec<f32>,
}

impl StopPicture {
    /// A picture of values, which are clamped to [0, 1]; `None` if there are not as many as pixels, or none.
    #[must_use]
    pub fn new(width: usize, height: usize, mut open: Vec<f32>) -> Option<Self> {
        if open.is_empty() || width.checked_mul(height) != Some(open.len()) {
            return None;
        }
        for value in &mut open {
            *value = if value.is_nan() { 0.0 } else { value.clamp(0.0, 1.0) };
        }
        Some(Self { width, height, open })
    }

    fn at(&self, p: Point2) -> f32 {
        let index = |x: f32, n: usize| ((0.5 * (x + 1.0) * n as f32).max(0.0) as usize).min(n - 1);
        self.open[index(-p.y, self.height) * self.width + index(p.x, self.width)]
    }
}

impl StopShape {
    /// False for a picture without light.
    pub(super) fn has_opening(&self) -> bool {
        !matches!(self, Self::Picture(picture) if picture.open.iter().all(|open| *open <= 0.0))
    }

    /// The share of light that passes a point of the circle of radius 1.
    pub(super) fn open_at(&self, p: Point2) -> f32 {
        let r2 = p.x * p.x + p.y * p.y;
        if r2 > 1.0 {
            return 0.0;
        }
        let if_open = |is_open: bool| if is_open { 1.0 } else { 0.0 };
        match self {
            Self::Disc => 1.0,
            Self::Polygon(blades, scale) => if_open(blades.contain(Point2::new(p.x / scale, p.y / scale))),
            Self::Star => if_open(in_star(p)),
            Self::Gaussian => (-r2).exp() - (-1.0_f32).exp(),
            Self::Picture(picture) => picture.at(p),
        }
    }
}

/// True within the pentagram whose five points, the first at the top, lie on the circle of radius 1: within at least four of
/// the five half-planes that its lines bound.
fn in_star(p: Point2) -> bool {
    // The lines pass the middle at cos(72 degrees), opposite to the points.
    const FROM_MIDDLE: f32 = 0.309_017;
    let n_within = (0..5)
        .filter(|i| {
            let (sin, cos) = (std::f32::consts::TAU * *i as f32 / 5.0).sin_cos();
            p.x * sin + p.y * cos >= -FROM_MIDDLE
        })
        .count();
    n_within >= 4
}
