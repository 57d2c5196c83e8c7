//! From shapes to [`Geometry`].
use crate::{
    geometry::Geometry,
    hit::{GeometryId, ObjectId},
    shape::Shape,
};
use etendue_math::{AnimatedTransform, Transform};
/// Collects shapes, objects and instances.
#[derive(Debug, Default)]
pub struct GeometryBuilder {}
impl GeometryBuilder {
    /// Nothing yet.
    #[must_use]
    pub fn new() -> Self {
        Self::default()
    }
    /// Adds a shape to the world. `reverse_orientation` turns its normals over.
    ///
    /// A moving shape becomes an instance of its own, so it cannot be a light source.
    pub fn add(
        &mut self,
        _shape: Shape,
        _world_from_object: &AnimatedTransform,
        _reverse_orientation: bool,
    ) -> GeometryId {
        unimplemented!()
    }
    /// Starts a group of shapes that is visible only through instances.
    pub fn begin_object(&mut self) -> ObjectId {
        unimplemented!()
    }
    /// Adds a shape to a group; `object_from_shape` places it in the space of the group.
    pub fn add_to_object(
        &mut self,
        _object: ObjectId,
        _shape: Shape,
        _object_from_shape: &Transform,
        _reverse_orientation: bool,
    ) -> GeometryId {
        unimplemented!()
    }
    /// Places a group in the world; returns the index that [`crate::Hit::instance`] will hold.
    pub fn add_instance(&mut self, _object: ObjectId, _world_from_object: &AnimatedTransform) -> u32 {
        unimplemented!()
    }
    /// Builds the hierarchies, in parallel on the current rayon pool.
    #[must_use]
    pub fn build(self) -> Geometry {
        unimplemented!()
    }
}
