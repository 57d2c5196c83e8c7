//! Axis-aligned boxes.

use crate::{Point2, Point3, Vector3};

/// An axis-aligned box; empty when `min > max`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Bounds3 {
    /// Lower corner.
    pub min: Point3,
    /// Upper corner.
    pub max: Point3,
}

impl Default for Bounds3 {
    fn default() -> Self {
        Self::EMPTY
    }
}

impl Bounds3 {
    /// The box without points: the neutral element of [`union`](Self::union).
    pub const EMPTY: Self = Self { min: Point3::splat(f32::INFINITY), max: Point3::splat(f32::NEG_INFINITY) };

    /// The smallest box that holds both points.
    #[inline]
    #[must_use]
    pub fn new(a: Point3, b: Point3) -> Self {
        Self { min: a.min(b), max: a.max(b) }
    }

    /// The smallest box that holds all points.
    pub fn from_points(points: impl IntoIterator<Item = Point3>) -> Self {
        points.into_iter().fold(Self::EMPTY, Self::with_point)
    }

    /// The smallest box that holds this box and `p`.
    #[inline]
    #[must_use]
    pub fn with_point(self, p: Point3) -> Self {
        Self { min: self.min.min(p), max: self.max.max(p) }
    }

    /// The smallest box that holds both boxes.
    #[inline]
    #[must_use]
    pub fn union(self, other: Self) -> Self {
        Self { min: self.min.min(other.min), max: self.max.max(other.max) }
    }

    /// True if the box holds no point.
    #[inline]
    #[must_use]
    pub fn is_empty(self) -> bool {
        self.min.x > self.max.x || self.min.y > self.max.y || self.min.z > self.max.z
    }

    /// From the lower to the upper corner.
    #[inline]
    #[must_use]
    pub fn diagonal(self) -> Vector3 {
        self.max - self.min
    }

    /// The middle of the box.
    #[inline]
    #[must_use]
    pub fn centroid(self) -> Point3 {
        self.min.lerp(self.max, 0.5)
    }

    /// Surface area in square metres; 0 for the empty box.
    #[inline]
    #[must_use]
    pub fn surface_area(self) -> f32 {
        if self.is_empty() {
            return 0.0;
        }
        let d = self.diagonal();
        2.0 * (d.x * d.y + d.y * d.z + d.z * d.x)
    }

    /// True if `p` is inside or on the border.
    #[inline]
    #[must_use]
    pub fn contains(self, p: Point3) -> bool {
        (0..3).all(|axis| p[axis] >= self.min[axis] && p[axis] <= self.max[axis])
    }

    /// The eight corners.
    #[must_use]
    pub fn corners(self) -> [Point3; 8] {
        std::array::from_fn(|i| {
            let pick =
                |bit: usize, axis: usize| if i >> bit & 1 == 0 { self.min[axis] } else { self.max[axis] };
            Point3::new(pick(0, 0), pick(1, 1), pick(2, 2))
        })
    }

    /// Centre and radius of the sphere through the corners; radius 0 for the empty box.
    #[must_use]
    pub fn bounding_sphere(self) -> (Point3, f32) {
        if self.is_empty() {
            (Point3::ORIGIN, 0.0)
        } else {
            (self.centroid(), self.diagonal().length() / 2.0)
        }
    }
}

/// An axis-aligned rectangle in the plane.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Bounds2 {
    /// Lower corner.
    pub min: Point2,
    /// Upper corner.
    pub max: Point2,
}

impl Bounds2 {
    /// The smallest rectangle that holds both points.
    #[must_use]
    pub fn new(a: Point2, b: Point2) -> Self {
        Self { min: a.min(b), max: a.max(b) }
    }

    /// Area; negative rectangles count as 0.
    #[must_use]
    pub fn area(self) -> f32 {
        (self.max.x - self.min.x).max(0.0) * (self.max.y - self.min.y).max(0.0)
    }
}
