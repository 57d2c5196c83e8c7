//! What a ray finds, and what light sampling needs: plain records without behaviour.

use etendue_math::{Normal3, Point2, Point3, Vector3};

/// One shape entity of a scene: a mesh or a single quadric.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct GeometryId(pub u32);

/// A group of shapes that instances repeat.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct ObjectId(pub u32);

/// Value of [`Hit::instance`] for geometry that belongs to no instance.
pub const NO_INSTANCE: u32 = u32::MAX;

/// Where a ray meets a surface, as small as possible; [`crate::Geometry::surface_point`] and
/// [`surface_derivatives`](crate::Geometry::surface_derivatives) tell the rest.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Hit {
    /// Ray parameter, greater than 0; a distance in metres where the direction has length 1.
    pub t: f32,
    /// The shape entity.
    pub geometry: GeometryId,
    /// Triangle or patch within the entity; 0 for quadrics.
    pub primitive: u32,
    /// Index of the instance, or [`NO_INSTANCE`].
    pub instance: u32,
    /// Barycentric weights of the second and third vertex of a triangle; position on the patch for bilinear
    /// patches; surface coordinates for quadrics, but nothing for whole spheres, where [`SurfacePoint::uv`] tells.
    pub uv: [f32; 2],
}

/// A point of a surface, in world space.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SurfacePoint {
    /// Position.
    pub p: Point3,
    /// Bound of the absolute error of each coordinate of `p`.
    pub p_error: Vector3,
    /// Geometric unit normal, turned by orientation, handedness or vertex normals as in pbrt-v4.
    pub ng: Normal3,
    /// Shading unit normal.
    pub ns: Normal3,
    /// Texture coordinates.
    pub uv: Point2,
    /// Number given to the face by the file (Ptex); 0 if none.
    pub face_index: i32,
}

/// How a surface changes around a point, in world space.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct SurfaceDerivatives {
    /// Change of position with u on the true surface.
    pub dpdu: Vector3,
    /// Change of position with v on the true surface.
    pub dpdv: Vector3,
    /// First shading tangent, perpendicular to `ns`; not of unit length.
    pub shading_dpdu: Vector3,
    /// Second shading tangent, perpendicular to `ns`; not of unit length.
    pub shading_dpdv: Vector3,
    /// Change of the shading normal with u.
    pub dndu: Vector3,
    /// Change of the shading normal with v.
    pub dndv: Vector3,
}

/// The point that a light illuminates.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Reference {
    /// Position.
    pub p: Point3,
    /// Geometric or shading normal; `None` inside a medium.
    pub n: Option<Normal3>,
}

/// A point chosen at random on a shape.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ShapeSample {
    /// Position.
    pub p: Point3,
    /// Bound of the absolute error of each coordinate of `p`.
    pub p_error: Vector3,
    /// Geometric unit normal, turned like [`SurfacePoint::ng`].
    pub n: Normal3,
    /// Texture coordinates.
    pub uv: Point2,
    /// Density per square metre.
    pub pdf_a: f32,
}
