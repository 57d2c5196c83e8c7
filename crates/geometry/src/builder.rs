//! From shapes to [`Geometry`].

use etendue_math::{AnimatedTransform, Bounds3, Transform};

use crate::accelerator::{Accelerator, Group, Structures};
use crate::bvh::{self, BuildPrimitive, Bvh, INSTANCE, PrimitiveRef, TriangleSource};
use crate::geometry::Geometry;
use crate::hit::{GeometryId, ObjectId};
use crate::instance::Instance;
use crate::shape::entity::Entity;
use crate::shape::{Shape, entity_of};

/// Group index of the world; object `i` is group `i + 1`.
pub(crate) const WORLD: u32 = 0;

/// Collects shapes, objects and instances.
#[derive(Debug, Default)]
pub struct GeometryBuilder {
    entities: Vec<Entity>,
    /// Group of each entity.
    groups: Vec<u32>,
    n_objects: u32,
    instances: Vec<(ObjectId, AnimatedTransform)>,
}

impl GeometryBuilder {
    /// Nothing yet.
    #[must_use]
    pub fn new() -> Self {
        Self::default()
    }

    /// Adds a shape to the world. `reverse_orientation` turns its normals over.
    ///
    /// A moving shape becomes an instance of its own, so it cannot be a light source. Meshes must be valid
    /// ([`Shape::validate`]); triangles with corners that are not finite are left out.
    pub fn add(
        &mut self,
        shape: Shape,
        world_from_object: &AnimatedTransform,
        reverse_orientation: bool,
    ) -> GeometryId {
        if !world_from_object.is_animated() {
            return self.add_entity(WORLD, Entity::new(shape, &world_from_object.start, reverse_orientation));
        }
        let object = self.begin_object();
        let geometry = self.add_to_object(object, shape, &Transform::IDENTITY, reverse_orientation);
        self.add_instance(object, world_from_object);
        geometry
    }

    /// Starts a group of shapes that is visible only through instances.
    pub fn begin_object(&mut self) -> ObjectId {
        self.n_objects += 1;
        ObjectId(self.n_objects - 1)
    }

    /// Adds a shape to a group; `object_from_shape` places it in the space of the group.
    pub fn add_to_object(
        &mut self,
        object: ObjectId,
        shape: Shape,
        object_from_shape: &Transform,
        reverse_orientation: bool,
    ) -> GeometryId {
        assert!(object.0 < self.n_objects, "object {} was not begun", object.0);
        self.add_entity(object.0 + 1, Entity::new(shape, object_from_shape, reverse_orientation))
    }

    /// Places a group in the world; returns the index that [`crate::Hit::instance`] will hold.
    pub fn add_instance(&mut self, object: ObjectId, world_from_object: &AnimatedTransform) -> u32 {
        assert!(object.0 < self.n_objects, "object {} was not begun", object.0);
        self.instances.push((object, *world_from_object));
        (self.instances.len() - 1) as u32
    }

    fn add_entity(&mut self, group: u32, entity: Entity) -> GeometryId {
        self.entities.push(entity);
        self.groups.push(group);
        GeometryId((self.entities.len() - 1) as u32)
    }

    /// Builds the hierarchies, in parallel on the current rayon pool. The result does not depend on its size.
    #[must_use]
    pub fn build(self) -> Geometry {
        let (groups, instances) = self.build_groups(|own, source| bvh::build(own, source), Bvh::bounds);
        Geometry::new(self.entities, self.groups, groups, None, instances)
    }

    /// The same with some other structure. Hits are the same, bit for bit; what they cost is not.
    #[must_use]
    pub fn build_with(self, accelerator: Accelerator) -> Geometry {
        if accelerator == Accelerator::Bvh {
            return self.build();
        }
        let (groups, instances) =
            self.build_groups(|own, source| Group::build(own, source, &accelerator), Group::bounds);
        let placeholders = groups.iter().map(|group| Bvh::placeholder(group.bounds())).collect();
        let structures = Structures { accelerator, groups };
        Geometry::new(self.entities, self.groups, placeholders, Some(structures), instances)
    }

    /// The world first, then the objects; and the instances.
    fn build_groups<G>(
        &self,
        build: impl Fn(Vec<BuildPrimitive>, &Triangles<'_>) -> G,
        bounds: impl Fn(&G) -> Bounds3,
    ) -> (Vec<G>, Vec<Instance>) {
        let (primitives, source) =
            collect(&self.entities, &self.groups, self.n_objects as usize + 1, |_| true);
        let mut primitives = primitives.into_iter();
        let mut world = primitives.next().unwrap_or_default();
        let objects: Vec<G> = primitives.map(|own| build(own, &source)).collect();
        let mut instances = Vec::with_capacity(self.instances.len());
        for (index, (object, world_from_object)) in self.instances.iter().enumerate() {
            let bounds = bounds(&objects[object.0 as usize]);
            let instance = Instance::new(object.0 + 1, world_from_object);
            world.extend(instance_primitive(index as u32, instance.world_bounds(bounds)));
            instances.push(instance);
        }
        let mut groups = vec![build(world, &source)];
        groups.extend(objects);
        (groups, instances)
    }
}

/// Primitives of the groups that are wanted, and where to look up their triangles.
fn collect<'e>(
    entities: &'e [Entity],
    entity_groups: &[u32],
    n_groups: usize,
    is_wanted: impl Fn(u32) -> bool,
) -> (Vec<Vec<BuildPrimitive>>, Triangles<'e>) {
    let mut primitives = vec![Vec::new(); n_groups];
    let mut seconds = vec![Vec::new(); entities.len()];
    for (index, (entity, &group)) in entities.iter().zip(entity_groups).enumerate() {
        if is_wanted(group) {
            seconds[index] = entity.append_primitives(index as u32, &mut primitives[group as usize]);
        }
    }
    (primitives, Triangles { entities, seconds })
}

/// An instance for the hierarchy of the world, if there is anything to hit.
fn instance_primitive(index: u32, bounds: Option<Bounds3>) -> Option<BuildPrimitive> {
    bounds.map(|bounds| BuildPrimitive::item(PrimitiveRef { geometry: INSTANCE, primitive: index }, bounds))
}

/// Builds the hierarchy of one group, or what takes its place; the world has instances in these boxes.
pub(crate) fn build_group<'e, G>(
    entities: &'e [Entity],
    entity_groups: &[u32],
    group: u32,
    instance_bounds: impl Iterator<Item = Option<Bounds3>>,
    build: impl Fn(Vec<BuildPrimitive>, &Triangles<'e>) -> G,
) -> G {
    let (mut primitives, source) = collect(entities, entity_groups, group as usize + 1, |own| own == group);
    let mut own = primitives.swap_remove(group as usize);
    own.extend((0..).zip(instance_bounds).filter_map(|(index, bounds)| instance_primitive(index, bounds)));
    build(own, &source)
}

/// All triangles, for the hierarchies.
pub(crate) struct Triangles<'a> {
    entities: &'a [Entity],
    /// See [`bvh::append_pairs`], for each entity.
    seconds: Vec<Vec<u32>>,
}

impl TriangleSource for Triangles<'_> {
    fn corners(&self, triangle: PrimitiveRef) -> [[f32; 3]; 3] {
        self.entities[entity_of(triangle)].triangle(triangle.primitive)
    }

    fn second(&self, first: PrimitiveRef) -> Option<u32> {
        bvh::second_of(&self.seconds[entity_of(first)], first.primitive)
    }
}
