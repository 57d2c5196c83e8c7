//! The immutable geometry of a scene.
use crate::hit::{GeometryId, Hit, Reference, ShapeSample, SurfacePoint};
use etendue_math::{Bounds3, Normal3, Point2, Point3, Ray, Vector3};
/// Everything that a ray can meet.
#[derive(Debug)]
pub struct Geometry {}
/// How much there is, for people.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct GeometryCounts {
    /// Shape entities.
    pub n_geometries: usize,
    /// Triangles stored (instances not counted).
    pub n_triangles: usize,
    /// Bilinear patches stored.
    pub n_patches: usize,
    /// Spheres, disks and cylinders.
    pub n_quadrics: usize,
    /// Groups.
    pub n_objects: usize,
    /// Instances of groups.
    pub n_instances: usize,
    /// Nodes of all hierarchies.
    pub n_nodes: usize,
}
#[expect(unused_variables, reason = "bodies follow")]
impl Geometry {
    /// The nearest accepted hit with t in (0, `t_max`). `filter` sees each candidate and may refuse it.
    pub fn intersect(&self, ray: &Ray, t_max: f32, filter: &impl Fn(&Hit) -> bool) -> Option<Hit> {
        unimplemented!()
    }
    /// True if any accepted hit has t in (0, `t_max`).
    pub fn occluded(&self, ray: &Ray, t_max: f32, filter: &impl Fn(&Hit) -> bool) -> bool {
        unimplemented!()
    }
    /// Position, normals and derivatives at a hit, in world space. `ray` is the ray that found the hit.
    #[must_use]
    pub fn surface_point(&self, ray: &Ray, hit: &Hit) -> SurfacePoint {
        unimplemented!()
    }
    /// Texture coordinates at a hit, cheaper than [`surface_point`](Self::surface_point).
    #[must_use]
    pub fn surface_uv(&self, hit: &Hit) -> Point2 {
        unimplemented!()
    }
    /// The box around everything, at all times; empty if there is nothing.
    #[must_use]
    pub fn bounds(&self) -> Bounds3 {
        unimplemented!()
    }
    /// Triangles or patches of an entity; 1 for quadrics.
    #[must_use]
    pub fn n_primitives(&self, geometry: GeometryId) -> u32 {
        unimplemented!()
    }
    /// True if the entity stands still in the world and belongs to no object, so that it may be a light source.
    #[must_use]
    pub fn can_emit(&self, geometry: GeometryId) -> bool {
        unimplemented!()
    }
    /// Area of a primitive in square metres.
    #[must_use]
    pub fn area(&self, geometry: GeometryId, primitive: u32) -> f32 {
        unimplemented!()
    }
    /// Box around a primitive.
    #[must_use]
    pub fn primitive_bounds(&self, geometry: GeometryId, primitive: u32) -> Bounds3 {
        unimplemented!()
    }
    /// Axis and cosine of the half angle of a cone that holds the normals of a primitive.
    #[must_use]
    pub fn emission_cone(&self, geometry: GeometryId, primitive: u32) -> (Vector3, f32) {
        unimplemented!()
    }
    /// A point of a primitive, uniform in area.
    #[must_use]
    pub fn sample_area(&self, geometry: GeometryId, primitive: u32, u: Point2) -> Option<ShapeSample> {
        unimplemented!()
    }
    /// A point of a primitive as seen from `reference`, with its density per steradian.
    #[must_use]
    pub fn sample_from(
        &self,
        geometry: GeometryId,
        primitive: u32,
        reference: &Reference,
        u: Point2,
    ) -> Option<(ShapeSample, f32)> {
        unimplemented!()
    }
    /// Density per steradian with which [`sample_from`](Self::sample_from) chooses the unit direction `wi`; 0 where it misses.
    #[must_use]
    pub fn pdf_from(&self, geometry: GeometryId, primitive: u32, reference: &Reference, wi: Vector3) -> f32 {
        unimplemented!()
    }
    /// The same density for a known point `p` with normal `n` of the primitive, without tracing a ray.
    #[must_use]
    pub fn pdf_from_point(
        &self,
        geometry: GeometryId,
        primitive: u32,
        reference: &Reference,
        p: Point3,
        n: Normal3,
    ) -> f32 {
        unimplemented!()
    }
    /// Bytes on the heap.
    #[must_use]
    pub fn memory_bytes(&self) -> usize {
        unimplemented!()
    }
    /// How much there is.
    #[must_use]
    pub fn counts(&self) -> GeometryCounts {
        unimplemented!()
    }
}
