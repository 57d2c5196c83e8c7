//! The thin lens (SPEC CAM-3): an aperture disc at z = 0 that images the plane of focus sharply.
//!
//! Every point of the disc sends its ray through the same point of the plane of focus, so what lies there is sharp.
//! A point at distance d is spread over a disc of diameter
//!
//! ```text
//! c = A f |d - d_f| / (d (d_f - f))
//! ```
//!
//! on the film of a lens of focal length f and aperture diameter A focused at d_f; with the f-number N, A = f / N.
//! The aperture is a disc, or a regular polygon as of so many straight blades; its picture is what points out of focus
//! look like.
//!
//! The light of every pixel counts alike: vignetting and the cosine to the fourth of a real film are left out, as in
//! pbrt's perspective camera, so exposure does not change with the aperture.

use etendue_math::{Point2, lerp, warp};

/// The blades of an iris: a regular polygon whose corners lie on the circle of the aperture's radius.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Blades {
    /// Number of corners, at least 3.
    pub n: u32,
    /// Angle of the first corner in radians, from +x towards +y.
    pub rotation_rad: f32,
}

impl Blades {
    /// Angle of a side as seen from the middle, in radians.
    fn side_rad(self) -> f32 {
        std::f32::consts::TAU / self.n as f32
    }

    /// Area for a radius of 1.
    fn area(self) -> f32 {
        0.5 * self.n as f32 * self.side_rad().sin()
    }

    fn corner(self, index: u32) -> Point2 {
        let (sin, cos) = (self.rotation_rad + self.side_rad() * index as f32).sin_cos();
        Point2::new(cos, sin)
    }

    /// A uniformly distributed point for a radius of 1: one of the triangles between the middle and a side, and a point of it.
    fn sample(self, u: Point2) -> Point2 {
        let scaled = u.x * self.n as f32;
        let side = (scaled as u32).min(self.n - 1);
        let (a, b) = (self.corner(side), self.corner(side + 1));
        // The distance from the middle grows as the square root, as in a disc.
        let (along, out) = (scaled - side as f32, u.y.sqrt());
        Point2::new(out * lerp(along, a.x, b.x), out * lerp(along, a.y, b.y))
    }

    /// True if a point lies within, for a radius of 1.
    pub(super) fn contain(self, p: Point2) -> bool {
        let half = 0.5 * self.side_rad();
        let from_middle_of_side = (p.y.atan2(p.x) - self.rotation_rad).rem_euclid(2.0 * half) - half;
        (p.x * p.x + p.y * p.y).sqrt() * from_middle_of_side.cos() <= half.cos()
    }
}

/// Aperture and focus of a camera.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Lens {
    /// Radius of the aperture in metres; 0 for a pinhole.
    pub radius: f32,
    /// Shape of the aperture; `None` for a disc.
    pub blades: Option<Blades>,
    /// Distance from the lens to the plane of focus, along the optical axis, in metres.
    pub focal_distance: f32,
}

impl Default for Lens {
    fn default() -> Self {
        Self::PINHOLE
    }
}

impl Lens {
    /// No lens: everything is sharp.
    pub const PINHOLE: Self = Self { radius: 0.0, blades: None, focal_distance: 1e6 };

    /// A lens given as on a photographer's camera: focal length in metres and f-number N, so that the aperture's
    /// radius is f / (2 N).
    #[must_use]
    pub fn from_f_number(focal_length_m: f32, f_number: f32, focal_distance: f32) -> Self {
        Self { radius: focal_length_m / (2.0 * f_number), blades: None, focal_distance }
    }

    /// True if the aperture has an area.
    #[inline]
    #[must_use]
    pub fn has_area(&self) -> bool {
        self.radius > 0.0
    }

    /// Area of the aperture in square metres; 1 for a pinhole, where densities over it are discrete.
    #[inline]
    #[must_use]
    pub fn area(&self) -> f32 {
        let unit = self.blades.map_or(std::f32::consts::PI, Blades::area);
        if self.has_area() { unit * self.radius * self.radius } else { 1.0 }
    }

    /// A uniformly distributed point of the aperture, in metres.
    #[inline]
    #[must_use]
    pub fn sample(&self, u: Point2) -> Point2 {
        if !self.has_area() {
            return Point2::new(0.0, 0.0);
        }
        let p = match self.blades {
            None => warp::sample_concentric_disk(u),
            Some(blades) => blades.sample(u),
        };
        Point2::new(self.radius * p.x, self.radius * p.y)
    }

    /// True if the aperture has an area and a point, in metres, lies within.
    #[inline]
    #[must_use]
    pub fn contains(&self, p: Point2) -> bool {
        let r2 = p.x * p.x + p.y * p.y;
        self.has_area()
            && match self.blades {
                None => r2 <= self.radius * self.radius,
                Some(blades) => blades.contain(Point2::new(p.x / self.radius, p.y / self.radius)),
            }
    }
}

/// Diameter on the film, in metres, of the image of a point at `distance` from a lens of focal length
/// `focal_length` and aperture diameter `aperture` focused at `focal_distance`; all in metres.
#[must_use]
pub fn circle_of_confusion(aperture: f32, focal_length: f32, focal_distance: f32, distance: f32) -> f32 {
    aperture * focal_length * (distance - focal_distance).abs() / (distance * (focal_distance - focal_length))
}

/// The full field of view in radians that a film of `film_size` sees through a lens of focal length `focal_length`
/// focused at `focal_distance`; all in metres. Focusing near moves the film away from the lens and narrows the view.
#[must_use]
pub fn field_of_view(film_size: f32, focal_length: f32, focal_distance: f32) -> f32 {
    let film_distance = focal_length * focal_distance / (focal_distance - focal_length);
    2.0 * (film_size / (2.0 * film_distance)).atan()
}
