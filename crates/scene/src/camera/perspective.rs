//! The perspective camera (SPEC CAM-1, CAM-3), in camera space: +z ahead, +y up, the lens at the origin.
//!
//! A raster position p stands for the direction `(t x, t y, 1)` where (x, y) is its place in the screen window and
//! `t = tan(fov / 2)`. The tangent is scaled, not the angle, so pixels are square in images of any shape; fov is the
//! full angle across the shorter side.

use etendue_math::{Point2, Point3, Ray, Vector3};

use super::lens::Lens;
use super::screen::Screen;

/// A pinhole or thin lens that projects onto a plane.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Perspective {
    /// Film and window.
    pub screen: Screen,
    /// Tangent of half the field of view: size on the plane z = 1 of one unit of the window.
    pub tan_half_fov: f32,
    /// Aperture and focus.
    pub lens: Lens,
}

impl Perspective {
    /// The point of the plane z = 1 that a raster position stands for.
    #[inline]
    #[must_use]
    pub fn plane_point(&self, p_film: Point2) -> Vector3 {
        let p = self.screen.screen_from_raster(p_film);
        Vector3::new(self.tan_half_fov * p.x, self.tan_half_fov * p.y, 1.0)
    }

    /// The raster position that a direction through the centre of the lens stands for; `None` behind the camera.
    #[inline]
    #[must_use]
    pub fn raster_from_direction(&self, d: Vector3) -> Option<Point2> {
        let scale = 1.0 / (self.tan_half_fov * d.z);
        (d.z > 0.0).then(|| self.screen.raster_from_screen(Point2::new(d.x * scale, d.y * scale)))
    }

    /// Area of the film projected to the plane z = 1, in square metres.
    #[must_use]
    pub fn plane_area(&self) -> f32 {
        self.screen.window.area() * self.tan_half_fov * self.tan_half_fov
    }

    /// The ray of a raster position through a point of the lens.
    #[inline]
    #[must_use]
    pub(super) fn ray(&self, p_film: Point2, u_lens: Point2) -> Ray {
        let pinhole = self.plane_point(p_film);
        if !self.lens.has_area() {
            return Ray::new(Point3::ORIGIN, pinhole.normalized());
        }
        let p_lens = self.lens.sample(u_lens);
        let origin = Point3::new(p_lens.x, p_lens.y, 0.0);
        let focus = Point3::ORIGIN + pinhole * self.lens.focal_distance;
        Ray::new(origin, (focus - origin).normalized())
    }

    /// The raster position of a ray that leaves the lens.
    #[inline]
    #[must_use]
    pub(super) fn raster_from_ray(&self, ray: &Ray) -> Option<Point2> {
        if ray.direction.z <= 0.0 {
            return None;
        }
        if !self.lens.has_area() {
            return self.raster_from_direction(ray.direction);
        }
        self.raster_from_direction(ray.at(self.lens.focal_distance / ray.direction.z).as_vector())
    }

    /// Importance that leaves the lens along a direction with this cosine to the axis:
    /// `1 / (A_film A_lens cos^4)`, whose integral over film, lens and directions is 1.
    #[inline]
    #[must_use]
    pub(super) fn importance(&self, cos_theta: f32) -> f32 {
        let cos2 = cos_theta * cos_theta;
        1.0 / (self.plane_area() * self.lens.area() * cos2 * cos2)
    }
}
