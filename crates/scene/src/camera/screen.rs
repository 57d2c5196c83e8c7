//! The rectangle of the image plane that the film sees, and its pixels.

use etendue_math::Point2;

/// A rectangle of the image plane; the shorter side of the image is [-1, 1] unless chosen otherwise.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ScreenWindow {
    /// Left and right end.
    pub x: [f32; 2],
    /// Lower and upper end; y points up.
    pub y: [f32; 2],
}

impl ScreenWindow {
    /// The window of pbrt: [-1, 1] along the shorter side, in proportion along the longer one.
    ///
    /// `aspect` is width over height.
    #[must_use]
    pub fn from_aspect(aspect: f32) -> Self {
        if aspect > 1.0 {
            Self { x: [-aspect, aspect], y: [-1.0, 1.0] }
        } else {
            Self { x: [-1.0, 1.0], y: [-1.0 / aspect, 1.0 / aspect] }
        }
    }

    /// Area of the window.
    #[must_use]
    pub fn area(&self) -> f32 {
        ((self.x[1] - self.x[0]) * (self.y[1] - self.y[0])).abs()
    }
}

/// The map between raster coordinates (pixels, y down, (0, 0) the upper left corner) and the screen window.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Screen {
    /// The window that the whole film covers.
    pub window: ScreenWindow,
    /// Width and height of the whole film in pixels.
    pub resolution: [f32; 2],
}

impl Screen {
    /// The point of the window at a raster position.
    #[inline]
    #[must_use]
    pub fn screen_from_raster(&self, p: Point2) -> Point2 {
        let ScreenWindow { x, y } = self.window;
        Point2::new(
            x[0] + (x[1] - x[0]) * (p.x / self.resolution[0]),
            y[1] + (y[0] - y[1]) * (p.y / self.resolution[1]),
        )
    }

    /// The raster position of a point of the window.
    #[inline]
    #[must_use]
    pub fn raster_from_screen(&self, p: Point2) -> Point2 {
        let ScreenWindow { x, y } = self.window;
        Point2::new(
            (p.x - x[0]) / (x[1] - x[0]) * self.resolution[0],
            (p.y - y[1]) / (y[0] - y[1]) * self.resolution[1],
        )
    }
}
