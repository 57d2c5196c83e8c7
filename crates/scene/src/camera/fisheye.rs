//! The fisheye camera, in camera space: a disc that shows all directions within an angle of the axis.
//!
//! A direction at the angle theta from +z lands at the distance `r = g(theta) / g(fov / 2)` from the middle of the window,
//! so that the border of the view is the circle of radius 1, which touches the longer sides of the image. The four laws g of
//! lens makers (Miyamoto 1964, "Fish Eye Lens", https://doi.org/10.1364/JOSA.54.001060):
//!
//! ```text
//! equidistant    g = theta               equal angles are equal lengths
//! equisolid      g = 2 sin(theta / 2)    equal solid angles are equal areas
//! stereographic  g = 2 tan(theta / 2)    small shapes keep their form
//! orthographic   g = sin(theta)          irradiance of a horizontal surface is the mean of its sky
//! ```
//!
//! Beyond the circle the film is black. The camera is a point; the density of directions for uniform raster positions is
//! `g g' / (sin(theta) g(fov / 2)^2 A)` per steradian, where A is the area of the window.

use etendue_math::{Point2, Point3, Ray, Vector3};

use super::screen::Screen;

/// How the distance from the middle of the image grows with the angle from the axis.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum FisheyeMapping {
    /// In proportion.
    #[default]
    Equidistant,
    /// Equal solid angles have equal areas.
    Equisolid,
    /// Circles stay circles; up to 360 degrees, exclusive.
    Stereographic,
    /// As a hemisphere seen from afar; up to 180 degrees.
    Orthographic,
}

impl FisheyeMapping {
    /// Widest full angle of view in degrees, and whether it is one itself.
    #[must_use]
    pub const fn widest_fov_deg(self) -> (f32, bool) {
        match self {
            Self::Equidistant | Self::Equisolid => (360.0, true),
            Self::Stereographic => (360.0, false),
            Self::Orthographic => (180.0, true),
        }
    }

    /// The law g.
    fn distance(self, theta: f32) -> f32 {
        match self {
            Self::Equidistant => theta,
            Self::Equisolid => 2.0 * (theta / 2.0).sin(),
            Self::Stereographic => 2.0 * (theta / 2.0).tan(),
            Self::Orthographic => theta.sin(),
        }
    }

    /// The inverse of g.
    fn angle(self, distance: f32) -> f32 {
        match self {
            Self::Equidistant => distance,
            Self::Equisolid => 2.0 * (distance / 2.0).min(1.0).asin(),
            Self::Stereographic => 2.0 * (distance / 2.0).atan(),
            Self::Orthographic => distance.min(1.0).asin(),
        }
    }

    /// `g g' / sin(theta)`.
    fn stretch(self, theta: f32) -> f32 {
        match self {
            Self::Equidistant if theta < 1e-3 => 1.0,
            Self::Equidistant => theta / theta.sin().abs().max(1e-6),
            Self::Equisolid => 1.0,
            Self::Stereographic => (theta / 2.0).cos().powi(4).recip(),
            Self::Orthographic => theta.cos().max(0.0),
        }
    }
}

/// A camera that sees a cone of directions, however wide.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Fisheye {
    /// Film and window; the view is the circle of radius 1.
    pub screen: Screen,
    /// From angle to distance.
    pub mapping: FisheyeMapping,
    /// Angle between the axis and the border of the view, in radians; at most half of the mapping's widest.
    pub half_fov_rad: f32,
}

impl Fisheye {
    /// The unit direction that a raster position stands for; `None` beyond the circle.
    #[inline]
    #[must_use]
    pub fn direction(&self, p_film: Point2) -> Option<Vector3> {
        let p = self.screen.screen_from_raster(p_film);
        let r = (p.x * p.x + p.y * p.y).sqrt();
        if r > 1.0 {
            return None;
        }
        let theta = self.mapping.angle(r * self.mapping.distance(self.half_fov_rad));
        let (sin, cos) = theta.sin_cos();
        // In the limit of the middle any azimuth will do, for the sine is 0.
        let scale = if r > 0.0 { sin / r } else { 0.0 };
        Some(Vector3::new(p.x * scale, p.y * scale, cos))
    }

    /// Angle of a unit direction from the axis; `None` outside of the view.
    fn angle(&self, d: Vector3) -> Option<f32> {
        let theta = (d.x * d.x + d.y * d.y).sqrt().atan2(d.z);
        (theta <= self.half_fov_rad * (1.0 + 1e-6)).then_some(theta)
    }

    /// The raster position of a unit direction; `None` outside of the view.
    #[inline]
    #[must_use]
    pub fn raster_from_direction(&self, d: Vector3) -> Option<Point2> {
        let theta = self.angle(d)?;
        let r = self.mapping.distance(theta) / self.mapping.distance(self.half_fov_rad);
        let sin = (d.x * d.x + d.y * d.y).sqrt();
        let scale = if sin > 0.0 { r / sin } else { 0.0 };
        Some(self.screen.raster_from_screen(Point2::new(d.x * scale, d.y * scale)))
    }

    /// Density per steradian of directions when raster positions are uniform over the film; its integral is the share of the
    /// film within the circle. 0 outside of the view.
    #[inline]
    #[must_use]
    pub fn direction_pdf(&self, d: Vector3) -> f32 {
        let Some(theta) = self.angle(d) else { return 0.0 };
        let border = self.mapping.distance(self.half_fov_rad);
        self.mapping.stretch(theta) / (border * border * self.screen.window.area())
    }

    /// The ray of a raster position.
    #[inline]
    pub(super) fn ray(&self, p_film: Point2) -> Option<Ray> {
        Some(Ray::new(Point3::ORIGIN, self.direction(p_film)?))
    }
}
