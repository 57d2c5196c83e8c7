//! Volumes that photons are taken from (SPEC EST-6).
//!
//! A sphere reaches up the wall beside a floor, and takes photons that never met the floor. Volumes that are flat along the
//! normal leave them out. The search finds the nearest photons in a sphere; the volume is what it cuts out of it. That keeps
//! the estimate unbiased: given the radius, the photons within lie as the light laid them, whoever determined the radius. `ΔA`
//! is where the volume meets the tangent plane.

use std::f32::consts::PI;

use etendue_math::{Frame, Vector3};

/// A volume in a sphere.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub enum Volume {
    /// All of the sphere.
    #[default]
    Sphere,
    /// An ellipsoid that is compressed along the normal: distances along it count more.
    Disc {
        /// Height over radius, in (0, 1].
        flatness: f32,
    },
    /// A cylinder around the normal.
    Cylinder {
        /// Half the height over the radius, in (0, 1].
        flatness: f32,
    },
    /// A cube that stands on the tangent plane's axes.
    Cube,
}

impl Volume {
    /// The flatness that flat volumes have unless another is asked for. A photon on a sphere of `R` at distance `d` is
    /// `d^2 / (2 R)` off the tangent plane: this loses none until the radius of the search is a fifth of that of the surface.
    pub const FLATNESS: f32 = 0.1;
    /// A flat ellipsoid.
    pub const DISC: Self = Self::Disc { flatness: Self::FLATNESS };
    /// A flat cylinder.
    pub const CYLINDER: Self = Self::Cylinder { flatness: Self::FLATNESS };

    /// Squared distance by the volume's own measure: on its boundary it is the squared radius of the sphere, and nowhere is
    /// it less than the usual one. Areas in the plane grow in proportion to it.
    #[inline]
    #[must_use]
    pub fn distance_squared(self, frame: &Frame, offset: Vector3, distance_squared: f32) -> f32 {
        match self {
            Self::Sphere => distance_squared,
            Self::Disc { flatness } => {
                let height = offset.dot(frame.z);
                distance_squared + height * height * (1.0 / (flatness * flatness) - 1.0)
            }
            Self::Cylinder { flatness } => {
                let height = offset.dot(frame.z);
                let across = (distance_squared - height * height).max(0.0);
                let up = height / flatness;
                (1.0 + flatness * flatness) * across.max(up * up)
            }
            Self::Cube => {
                let local = frame.to_local(offset).abs();
                let side = local.max_element();
                3.0 * side * side
            }
        }
    }

    /// [`Self::distance_squared`] of a place in the tangent plane, in the frame's x and y.
    #[inline]
    #[must_use]
    pub fn plane_distance_squared(self, x: f32, y: f32) -> f32 {
        match self {
            Self::Sphere | Self::Disc { .. } => x * x + y * y,
            Self::Cylinder { flatness } => (1.0 + flatness * flatness) * (x * x + y * y),
            Self::Cube => 3.0 * (x * x).max(y * y),
        }
    }

    /// Area of the volume in the tangent plane over the squared radius of the sphere.
    #[inline]
    #[must_use]
    pub fn unit_area(self) -> f32 {
        match self {
            Self::Sphere | Self::Disc { .. } => PI,
            Self::Cylinder { flatness } => PI / (1.0 + flatness * flatness),
            Self::Cube => 4.0 / 3.0,
        }
    }
}
