//! The immutable geometry of a scene.

use etendue_math::{Bounds3, Point2, Ray};

use crate::accelerator::{Accelerator, Structures, Target};
use crate::builder::WORLD;
use crate::bvh::{Bvh, Kernel, PrimitiveRef, Verdict, Visitor, WideRay};
use crate::hit::{GeometryId, Hit, NO_INSTANCE, SurfaceDerivatives, SurfacePoint};
use crate::instance::Instance;
use crate::mesh::heap;
use crate::shape::entity::Entity;
use crate::shape::{Candidates, Implicit, Traced, entity_of, resolve};
use crate::work::{Unnoted, Work};

/// Everything that a ray can meet. Made by [`crate::GeometryBuilder`].
#[derive(Debug)]
pub struct Geometry {
    pub(crate) entities: Vec<Entity>,
    /// Group of each entity.
    pub(crate) entity_groups: Vec<u32>,
    /// Hierarchy of the world, then of each object.
    pub(crate) groups: Vec<Bvh>,
    /// What takes the place of the hierarchies, which then know their boxes alone.
    pub(crate) structures: Option<Structures>,
    pub(crate) instances: Vec<Instance>,
    kernel: Kernel,
}

/// How much there is, for people.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct GeometryCounts {
    /// Shape entities.
    pub n_geometries: usize,
    /// Triangles stored; instances do not count again.
    pub n_triangles: usize,
    /// Bilinear patches stored.
    pub n_patches: usize,
    /// Spheres, disks, cylinders and other shapes given by a formula.
    pub n_quadrics: usize,
    /// Curves stored.
    pub n_curves: usize,
    /// Points of point-sampled surfaces stored.
    pub n_points: usize,
    /// Groups for instancing.
    pub n_objects: usize,
    /// Instances of groups.
    pub n_instances: usize,
    /// Nodes of all hierarchies.
    pub n_nodes: usize,
}

impl Geometry {
    pub(crate) fn new(
        entities: Vec<Entity>,
        entity_groups: Vec<u32>,
        groups: Vec<Bvh>,
        structures: Option<Structures>,
        instances: Vec<Instance>,
    ) -> Self {
        Self { entities, entity_groups, groups, structures, instances, kernel: Kernel::detect() }
    }

    /// What finds the hits.
    #[must_use]
    pub fn accelerator(&self) -> Accelerator {
        self.structures.as_ref().map_or(Accelerator::Bvh, |structures| structures.accelerator)
    }

    /// True if something is elsewhere at another time.
    #[must_use]
    pub fn is_moving(&self) -> bool {
        let is_deforming = |entity: &Entity| match entity {
            Entity::Traced(shape) => matches!(**shape, Traced::Moving(_)),
            _ => false,
        };
        self.instances.iter().any(Instance::is_moving) || self.entities.iter().any(is_deforming)
    }

    /// The same geometry, traced without the instructions that only some processors have. For tests and
    /// measurements: the hits are the same, bit for bit.
    #[must_use]
    pub fn traced_portably(self) -> Self {
        Self { kernel: Kernel::PORTABLE, ..self }
    }

    /// True if rays are traced by the instructions AVX2.
    #[must_use]
    pub const fn is_traced_by_avx2(&self) -> bool {
        self.kernel.is_avx2()
    }

    /// The nearest accepted hit with t in (0, `t_max`), of equally near ones the first in order of instance, shape and
    /// primitive (but where the rounding of a box hides it, another). `filter` sees each candidate and may refuse it.
    #[inline]
    pub fn intersect(&self, ray: &Ray, t_max: f32, filter: &impl Fn(&Hit) -> bool) -> Option<Hit> {
        self.search::<_, _, false>(ray, t_max, filter, Unnoted)
    }

    /// True if any accepted hit has t in (0, `t_max`).
    #[inline]
    pub fn occluded(&self, ray: &Ray, t_max: f32, filter: &impl Fn(&Hit) -> bool) -> bool {
        self.search::<_, _, true>(ray, t_max, filter, Unnoted).is_some()
    }

    /// The nearest hit, or `ANY` hit; `work` notes what it takes.
    #[inline(always)]
    pub(crate) fn search<F: Fn(&Hit) -> bool, W: Work, const ANY: bool>(
        &self,
        ray: &Ray,
        t_max: f32,
        filter: &F,
        work: W,
    ) -> Option<Hit> {
        let mut search = Search::<_, _, ANY> {
            geometry: self,
            world_ray: ray,
            group_ray: ray.into(),
            instance: NO_INSTANCE,
            filter,
            work,
            best: None,
        };
        match &self.structures {
            None => self.kernel.traverse(&self.groups[WORLD as usize], ray, t_max.next_down(), &mut search),
            Some(structures) => structures.search(ray, t_max.next_down(), &mut search),
        }
        search.best
    }

    /// Position and normals at a hit, in world space. `ray` is the ray that found the hit.
    #[inline]
    #[must_use]
    pub fn surface_point(&self, ray: &Ray, hit: &Hit) -> SurfacePoint {
        let entity = &self.entities[hit.geometry.0 as usize];
        if hit.instance == NO_INSTANCE {
            return entity.point(hit.primitive, ray, hit.t, hit.uv).1;
        }
        let instance = &self.instances[hit.instance as usize];
        let (p, point) = entity.point(hit.primitive, &instance.group_ray(ray), hit.t, hit.uv);
        instance.world_point(p, &point, ray.time)
    }

    /// Derivatives at a hit, in world space. `ray` is the ray that found the hit.
    #[must_use]
    pub fn surface_derivatives(&self, ray: &Ray, hit: &Hit) -> SurfaceDerivatives {
        let entity = &self.entities[hit.geometry.0 as usize];
        if hit.instance == NO_INSTANCE {
            return entity.surface(hit.primitive, ray, hit.t, hit.uv).derivatives;
        }
        let instance = &self.instances[hit.instance as usize];
        let local = entity.surface(hit.primitive, &instance.group_ray(ray), hit.t, hit.uv);
        instance.world_derivatives(&local, ray.time)
    }

    /// Texture coordinates at a position on a primitive, given as in [`Hit::uv`].
    #[must_use]
    pub fn texture_coordinates(&self, geometry: GeometryId, primitive: u32, uv: [f32; 2]) -> Point2 {
        self.entities[geometry.0 as usize].uv(primitive, uv)
    }

    /// The box around everything, at all times; empty if there is nothing.
    #[must_use]
    pub fn bounds(&self) -> Bounds3 {
        self.groups[WORLD as usize].bounds()
    }

    /// Triangles or patches of an entity; 1 for quadrics.
    #[must_use]
    pub fn n_primitives(&self, geometry: GeometryId) -> u32 {
        self.entities[geometry.0 as usize].n_primitives()
    }

    /// True if the entity is of a shape that can emit ([`crate::Shape::can_emit`]), stands still in the world and belongs to no
    /// object, so that it may be a light source as it is.
    #[must_use]
    pub fn can_emit(&self, geometry: GeometryId) -> bool {
        self.entity_groups[geometry.0 as usize] == WORLD
            && !matches!(self.entities[geometry.0 as usize], Entity::Traced(_))
    }

    /// Bytes on the heap.
    #[must_use]
    pub fn memory_bytes(&self) -> usize {
        let entities: usize = self.entities.iter().map(Entity::memory_bytes).sum();
        let instances: usize = self.instances.iter().map(Instance::memory_bytes).sum();
        entities + instances + self.hierarchy_bytes() + heap(&self.entities) + heap(&self.instances)
    }

    /// Bytes on the heap of the hierarchies alone, or of what takes their place.
    #[must_use]
    pub fn hierarchy_bytes(&self) -> usize {
        let hierarchies = self.groups.iter().map(Bvh::memory_bytes).sum::<usize>() + heap(&self.groups);
        hierarchies + self.structures.as_ref().map_or(0, Structures::memory_bytes)
    }

    /// How much there is.
    #[must_use]
    pub fn counts(&self) -> GeometryCounts {
        let mut counts = GeometryCounts {
            n_objects: self.groups.len() - 1,
            n_instances: self.instances.len(),
            n_nodes: match &self.structures {
                None => self.groups.iter().map(Bvh::n_nodes).sum(),
                Some(structures) => structures.n_nodes(),
            },
            ..GeometryCounts::default()
        };
        for entity in &self.entities {
            entity.count(&mut counts);
        }
        counts
    }
}

/// One question in progress: the nearest hit, or `ANY` hit.
struct Search<'a, F, W, const ANY: bool> {
    geometry: &'a Geometry,
    world_ray: &'a Ray,
    /// The ray in the space of the group that is searched.
    group_ray: WideRay,
    instance: u32,
    filter: &'a F,
    work: W,
    best: Option<Hit>,
}

impl<F: Fn(&Hit) -> bool, W: Work, const ANY: bool> Search<'_, F, W, ANY> {
    #[inline]
    fn consider(&mut self, reference: PrimitiveRef, t: f32, uv: [f32; 2]) -> Verdict {
        let hit = Hit {
            t,
            geometry: GeometryId(reference.geometry),
            primitive: reference.primitive,
            instance: self.instance,
            uv,
        };
        if !(self.filter)(&hit) {
            return Verdict::Pass;
        }
        self.accept(hit)
    }

    /// Takes a hit that is at least as near as the best one. That the order of visits does not decide between equals
    /// keeps hits the same whatever the tree.
    #[inline(always)]
    fn accept(&mut self, hit: Hit) -> Verdict {
        if ANY {
            self.best = Some(hit);
            return Verdict::Stop;
        }
        if self.best.is_none_or(|best| hit.t < best.t || order(&hit) < order(&best)) {
            self.best = Some(hit);
        }
        Verdict::Shorten(hit.t)
    }

    #[inline(always)]
    fn enter_instance(&mut self, index: u32) -> (u32, WideRay) {
        self.work.note_instance();
        let instance = &self.geometry.instances[index as usize];
        self.instance = index;
        self.group_ray = instance.carried(self.world_ray);
        (instance.group, self.group_ray)
    }

    /// Tests a primitive that is no triangle.
    #[inline(never)]
    fn test_shape(&mut self, item: PrimitiveRef, t_max: f32) -> Verdict {
        self.work.note_primitives(|| 1);
        let entity = &self.geometry.entities[item.geometry as usize];
        let ray = &self.group_ray.at(self.world_ray.time);
        if let Entity::Sphere(sphere) = entity {
            let Some((near, far)) = sphere.globe().intersect(ray) else { return Verdict::Pass };
            return match (self.found(item, near, [0.0; 2], t_max), far) {
                (Verdict::Pass, Some(far)) => self.found(item, far, [0.0; 2], t_max),
                (verdict, _) => verdict,
            };
        }
        if let Entity::Traced(shape) = entity
            && let Traced::Implicit(surface) = &**shape
        {
            return self.test_implicit(item, surface, ray, t_max);
        }
        let candidates = entity.intersect(item.primitive, ray);
        match (self.found_any(item, &candidates, t_max), candidates) {
            // Refused or beyond the end; few shapes have more.
            (Verdict::Pass, [_, Some(_)]) => self.found_any(item, &entity.intersect_further(ray), t_max),
            (verdict, _) => verdict,
        }
    }

    /// Tests a cell of an implicit surface, of which only the hits that are asked for are looked for.
    #[inline(never)]
    fn test_implicit(&mut self, item: PrimitiveRef, surface: &Implicit, ray: &Ray, t_max: f32) -> Verdict {
        let mut after = 0.0;
        // A surface of so many sheets within a cell is none to see through.
        for _ in 0..64 {
            let Some(t) = surface.next_hit(item.primitive, ray, after, t_max.into()) else { break };
            let verdict = self.found(item, t, [0.0; 2], t_max);
            if verdict != Verdict::Pass {
                return verdict;
            }
            after = t;
        }
        Verdict::Pass
    }

    /// Considers hits of a primitive that is no triangle, in their order.
    #[inline(always)]
    fn found_any(&mut self, item: PrimitiveRef, candidates: &Candidates, t_max: f32) -> Verdict {
        for candidate in candidates.iter().flatten() {
            let verdict = self.found(item, candidate.t, [candidate.u as f32, candidate.v as f32], t_max);
            if verdict != Verdict::Pass {
                return verdict;
            }
        }
        Verdict::Pass
    }

    /// Considers a hit of a primitive that is no triangle, if t is within the ray.
    #[inline(always)]
    fn found(&mut self, item: PrimitiveRef, t: f64, uv: [f32; 2], t_max: f32) -> Verdict {
        let t = t as f32;
        if t > 0.0 && t <= t_max { self.consider(item, t, uv) } else { Verdict::Pass }
    }
}

/// Decides between hits at the same t; what stands in the world itself comes last.
#[inline(always)]
const fn order(hit: &Hit) -> (u32, u32, u32) {
    (hit.instance, hit.geometry.0, hit.primitive)
}

impl<'a, F: Fn(&Hit) -> bool, W: Work, const ANY: bool> Visitor<'a> for Search<'a, F, W, ANY> {
    const ANY: bool = ANY;

    #[inline]
    fn triangle(&mut self, triangle: PrimitiveRef, t: f32, b: [f32; 2]) -> Verdict {
        let (primitive, uv) = resolve(triangle, b);
        self.consider(primitive, t, uv)
    }

    #[inline(always)]
    fn shape(&mut self, item: PrimitiveRef, t_max: f32) -> Verdict {
        self.test_shape(item, t_max)
    }

    #[inline(always)]
    fn enter(&mut self, index: u32) -> (&'a Bvh, WideRay) {
        let (group, ray) = self.enter_instance(index);
        (&self.geometry.groups[group as usize], ray)
    }

    #[inline(always)]
    fn leave(&mut self) {
        self.instance = NO_INSTANCE;
        self.group_ray = self.world_ray.into();
    }

    #[inline(always)]
    fn note_node(&mut self) {
        self.work.note_node();
    }

    #[inline(always)]
    fn note_block(&mut self, n_triangles: impl FnOnce() -> u32) {
        self.work.note_block();
        self.work.note_primitives(n_triangles);
    }
}

impl<'a, F: Fn(&Hit) -> bool, W: Work, const ANY: bool> Target<'a> for Search<'a, F, W, ANY> {
    #[inline]
    fn corners(&self, triangle: PrimitiveRef) -> [[f32; 3]; 3] {
        self.geometry.entities[entity_of(triangle)].triangle(triangle.primitive)
    }

    #[inline]
    fn enter_group(&mut self, instance: u32) -> (u32, WideRay) {
        self.enter_instance(instance)
    }

    #[inline]
    fn note_triangle(&mut self) {
        self.work.note_primitives(|| 1);
    }
}
