//! The closed set of shapes.

use crate::mesh::{BilinearMesh, TriangleMesh};

/// A surface in object space, in metres.
#[derive(Clone, Debug, PartialEq)]
pub enum Shape {
    /// A triangle mesh.
    Triangles(TriangleMesh),
    /// A mesh of bilinear patches.
    Bilinear(BilinearMesh),
    /// The part of a sphere around the origin with z in [`z_min`, `z_max`] and azimuth up to `phi_max_rad`.
    Sphere {
        /// Radius.
        radius: f32,
        /// Lower cut, `-radius` or below for none.
        z_min: f32,
        /// Upper cut, `radius` or above for none.
        z_max: f32,
        /// Largest azimuth in radians, 2 pi for all.
        phi_max_rad: f32,
    },
    /// A flat ring around the z axis, normal +z.
    Disk {
        /// Its z coordinate.
        height: f32,
        /// Outer radius.
        radius: f32,
        /// Radius of the hole, 0 for none.
        inner_radius: f32,
        /// Largest azimuth in radians, 2 pi for all.
        phi_max_rad: f32,
    },
    /// An open tube around the z axis.
    Cylinder {
        /// Radius.
        radius: f32,
        /// Lower end.
        z_min: f32,
        /// Upper end.
        z_max: f32,
        /// Largest azimuth in radians, 2 pi for all.
        phi_max_rad: f32,
    },
}
