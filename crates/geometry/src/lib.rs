//! Shapes, ray intersection and bounding volume hierarchies. Knows nothing of materials or light.
//!
//! A [`GeometryBuilder`] takes [`Shape`]s, objects made of shapes and instances of objects; [`Geometry`] is the
//! immutable result that answers [`intersect`](Geometry::intersect), [`occluded`](Geometry::occluded) and
//! [`surface_point`](Geometry::surface_point), and samples points of shapes for light sources. Hit parameters t
//! lie in the open interval (0, `t_max`): callers leave a surface with [`etendue_math::offset_ray_origin`] and the
//! error bounds of [`SurfacePoint`], so no global epsilon exists (SPEC GEO-1, GEO-2).

mod hit;
mod mesh;
mod shape;

mod accelerator;
mod bounding_sphere;
mod builder;
mod geometry;
mod heightfield;
mod instance;
mod lamp;
mod light_sampling;
mod parametric;
mod refine;
mod refit;
mod revolution;
mod subdivision;
mod work;

mod bvh;
mod double;

pub mod points;

#[cfg(test)]
mod robustness;
#[cfg(test)]
mod test_support;

pub use accelerator::{Accelerator, BinarySplit, DivisionSettings, GridSettings, KdTreeSettings};
pub use bounding_sphere::{BoundingSphere, ObjectReference};
pub use builder::GeometryBuilder;
pub use geometry::{Geometry, GeometryCounts};
pub use heightfield::{FractalHeights, HeightGrid, MAX_HEIGHT_LEVELS, MAX_HEIGHTS};
pub use hit::{
    GeometryId, Hit, NO_INSTANCE, ObjectId, Reference, ShapeSample, SurfaceDerivatives, SurfacePoint,
};
pub use lamp::{FlatLamp, Lamp};
pub use light_sampling::solid_angle_density;
pub use mesh::{BilinearMesh, MeshError, TriangleMesh};
pub use parametric::{ParametricSurface, Tessellation, tessellate};
pub use refine::{Fractal, MAX_REFINED_TRIANGLES, Refined, TooManyTriangles};
pub use refit::MovedVertices;
pub use revolution::{ContourError, MAX_CONTOUR_POINTS, Revolution};
pub use shape::{
    Curve, CurveBasis, CurveKind, CurveSet, ImplicitSurface, MovingMesh, PointCloud, Shape, bezier_segments,
    estimate_normals,
};
pub use subdivision::loop_subdivide;
pub use work::TraversalWork;
