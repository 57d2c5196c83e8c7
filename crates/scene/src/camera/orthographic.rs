//! The orthographic camera (SPEC CAM-2), in camera space: all rays run along +z, their origins cover the window.
//!
//! One unit of the screen window is one metre, so the size of a thing in the image does not depend on its distance.
//! With a lens the camera is telecentric: each image point has its own bundle, centred on its parallel ray, that meets
//! in the plane of focus. (pbrt-v4 starts all bundles at the middle of the image, which turns any aperture, however
//! small, into a perspective.)

use etendue_math::{Point2, Point3, Ray, Vector3};

use super::lens::Lens;
use super::screen::Screen;

/// A camera of parallel rays.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Orthographic {
    /// Film and window; the window is in metres.
    pub screen: Screen,
    /// Aperture and focus.
    pub lens: Lens,
}

impl Orthographic {
    /// The ray of a raster position through a point of the lens.
    #[inline]
    #[must_use]
    pub(super) fn ray(&self, p_film: Point2, u_lens: Point2) -> Ray {
        let p = self.screen.screen_from_raster(p_film);
        let p_lens = self.lens.sample(u_lens);
        let origin = Point3::new(p.x + p_lens.x, p.y + p_lens.y, 0.0);
        if !self.lens.has_area() {
            return Ray::new(origin, Vector3::new(0.0, 0.0, 1.0));
        }
        let focus = Point3::new(p.x, p.y, self.lens.focal_distance);
        Ray::new(origin, (focus - origin).normalized())
    }

    /// The raster position of a ray that leaves the image plane; `None` if its direction is outside the aperture.
    #[inline]
    #[must_use]
    pub(super) fn raster_from_ray(&self, ray: &Ray) -> Option<Point2> {
        let d = ray.direction;
        if d.z <= 0.0 || !self.lens.has_area() {
            return None;
        }
        let scale = self.lens.focal_distance / d.z;
        // The ray runs from the lens point towards the middle of its bundle.
        if !self.lens.contains(Point2::new(-d.x * scale, -d.y * scale)) {
            return None;
        }
        let p = Point2::new(ray.origin.x + d.x * scale, ray.origin.y + d.y * scale);
        Some(self.screen.raster_from_screen(p))
    }

    /// Density of directions per steradian at a cosine to the axis; 1 (discrete) for parallel rays.
    #[inline]
    #[must_use]
    pub(super) fn direction_pdf(&self, cos_theta: f32) -> f32 {
        if !self.lens.has_area() {
            return 1.0;
        }
        let f = self.lens.focal_distance;
        f * f / (self.lens.area() * cos_theta.powi(3))
    }
}
