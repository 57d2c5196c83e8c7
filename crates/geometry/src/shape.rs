//! The closed set of shapes.
//!
//! To add one: a variant of [`Shape`], a file with its inherent methods (`bounds`, `intersect`, `surface`, `area`,
//! `sample`), and its arm in every `match` that the compiler then reports in `entity.rs` (and, for shapes given by
//! a formula, in `quadric.rs`).

mod cloud;
mod conic;
mod curves;
mod cylinder;
mod disk;
pub(crate) mod entity;
pub(crate) mod globe;
mod implicit;
mod moving;
mod patches;
mod plane;
mod quadric;
mod sphere;
mod torus;
mod traced;
mod triangles;
mod whole_sphere;

#[cfg(test)]
mod tests;

pub use cloud::{PointCloud, estimate_normals};
pub use curves::{Curve, CurveBasis, CurveKind, CurveSet, bezier_segments};
pub(crate) use implicit::Implicit;
pub use implicit::ImplicitSurface;
pub use moving::MovingMesh;
pub(crate) use patches::{Patches, entity_of, resolve};
pub(crate) use traced::Traced;
pub(crate) use triangles::Triangles;

use std::f64::consts::TAU;

use etendue_math::{Bounds3, Point3, Vector3};
use glam::DVec3;

use crate::hit::{SurfaceDerivatives, SurfacePoint};
use crate::mesh::{BilinearMesh, MeshError, TriangleMesh};

/// A surface in object space, in metres.
#[derive(Clone, Debug, PartialEq)]
pub enum Shape {
    /// A triangle mesh.
    Triangles(TriangleMesh),
    /// A mesh of bilinear patches.
    Bilinear(BilinearMesh),
    /// A triangle mesh whose vertices move.
    Moving(MovingMesh),
    /// Curves with a width.
    Curves(CurveSet),
    /// Points of a surface.
    Points(PointCloud),
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
    /// An open cone around the z axis.
    Cone {
        /// Radius at z = 0.
        radius: f32,
        /// z of the tip, not 0.
        height: f32,
        /// Largest azimuth in radians, 2 pi for all.
        phi_max_rad: f32,
    },
    /// The elliptic paraboloid z = x²/a² + y²/b² (SPEC GEO-6), with z in [`z_min`, `z_max`].
    Paraboloid {
        /// Half axis along x at z = 1, positive.
        a: f32,
        /// Half axis along y at z = 1, positive.
        b: f32,
        /// Lower cut, 0 or below for none.
        z_min: f32,
        /// Upper end, positive.
        z_max: f32,
        /// Largest azimuth in radians, 2 pi for all; where a and b differ, before y is stretched by b / a.
        phi_max_rad: f32,
    },
    /// What the segment from `p1` to `p2` describes as it turns about the z axis: a hyperboloid of one sheet, or where
    /// the segment lies in a plane with the axis a cone, tube or ring.
    Hyperboloid {
        /// Where the segment begins.
        p1: Point3,
        /// Where it ends.
        p2: Point3,
        /// How far it turns, in radians, 2 pi for all.
        phi_max_rad: f32,
    },
    /// Where a formula is zero.
    Implicit(ImplicitSurface),
    /// A torus around the z axis.
    Torus {
        /// From the axis to the middle of the tube.
        major_radius: f32,
        /// Radius of the tube, at most the major one.
        minor_radius: f32,
        /// Where the tube's circle begins, in radians from its outermost point towards +z.
        theta_min_rad: f32,
        /// Where it ends, at most 2 pi further.
        theta_max_rad: f32,
        /// Largest azimuth in radians, 2 pi for all.
        phi_max_rad: f32,
    },
}

impl Shape {
    /// A whole sphere.
    #[must_use]
    pub const fn sphere(radius: f32) -> Self {
        Self::Sphere { radius, z_min: -radius, z_max: radius, phi_max_rad: std::f32::consts::TAU }
    }

    /// True if the shape can be a light source: all but what moves by itself, curves and points.
    #[must_use]
    pub const fn can_emit(&self) -> bool {
        !matches!(self, Self::Moving(_) | Self::Curves(_) | Self::Points(_) | Self::Implicit(_))
    }

    /// Checks the arrays of meshes; shapes given by a formula are always valid.
    pub fn validate(&self) -> Result<(), MeshError> {
        match self {
            Self::Triangles(mesh) => mesh.validate(),
            Self::Bilinear(mesh) => mesh.validate(),
            Self::Moving(mesh) => mesh.validate(),
            Self::Curves(set) => set.validate(),
            Self::Points(cloud) => cloud.validate(),
            _ => Ok(()),
        }
    }
}

/// A hit of a shape that is not a triangle.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Candidate {
    pub(crate) t: f64,
    pub(crate) u: f64,
    pub(crate) v: f64,
}

/// At most two hits in order of t.
pub(crate) type Candidates = [Option<Candidate>; 2];

/// Differential geometry in the space of the group, with the position before rounding.
#[derive(Clone, Copy, Debug)]
pub(crate) struct LocalSurface {
    pub(crate) p: DVec3,
    pub(crate) point: SurfacePoint,
    pub(crate) derivatives: SurfaceDerivatives,
}

/// Azimuth in [0, 2 pi).
fn azimuth(p: DVec3) -> f64 {
    let phi = p.y.atan2(p.x);
    if phi < 0.0 { phi + TAU } else { phi }
}

/// An azimuth limit in [0, 2 pi]; the rounded 2 pi of single precision is taken for the whole circle.
pub(crate) fn clamp_azimuth(phi_max: f64) -> f64 {
    if phi_max >= TAU * (1.0 - 1e-6) { TAU } else { phi_max.max(0.0) }
}

/// The smallest single-precision box around a double-precision one.
fn round_outwards(min: DVec3, max: DVec3) -> Bounds3 {
    let down = |x: f64| (x as f32).next_down();
    let up = |x: f64| (x as f32).next_up();
    Bounds3 {
        min: Point3::new(down(min.x), down(min.y), down(min.z)),
        max: Point3::new(up(max.x), up(max.y), up(max.z)),
    }
}

/// Derivatives of the unit normal from first and second derivatives of position (Weingarten's equations).
fn weingarten(dpdu: DVec3, dpdv: DVec3, n: DVec3, second: [DVec3; 3]) -> (Vector3, Vector3) {
    let [d2uu, d2uv, d2vv] = second;
    let (e1, f1, g1) = (dpdu.dot(dpdu), dpdu.dot(dpdv), dpdv.dot(dpdv));
    let (e2, f2, g2) = (n.dot(d2uu), n.dot(d2uv), n.dot(d2vv));
    let determinant = e1 * g1 - f1 * f1;
    if determinant == 0.0 {
        return (Vector3::default(), Vector3::default());
    }
    let dndu = dpdu * ((f2 * f1 - e2 * g1) / determinant) + dpdv * ((e2 * f1 - f2 * e1) / determinant);
    let dndv = dpdu * ((g2 * f1 - f2 * g1) / determinant) + dpdv * ((f2 * f1 - g2 * e1) / determinant);
    (crate::double::to_vector(dndu), crate::double::to_vector(dndv))
}
