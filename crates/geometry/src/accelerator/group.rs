//! What all structures have in common: primitives are tested, instances entered.

use std::ops::ControlFlow;

use super::{Accelerator, Build, Probe, Structure};
use crate::bvh::{
    Box3, BuildPrimitive, INSTANCE, PrimitiveRef, TraversalRay, TriangleSource, Verdict, Visitor, WideRay,
    intersect_prepared,
};
use crate::mesh::heap;
use etendue_math::{Bounds3, Point3, Ray};

/// A structure over the primitives of one group.
#[derive(Debug)]
pub(crate) struct Group {
    /// First the triangles.
    primitives: Vec<PrimitiveRef>,
    n_triangles: usize,
    bounds: Bounds3,
    structure: Structure,
}

impl Group {
    /// Builds the structure over what the hierarchy would hold; pairs of triangles are taken apart.
    pub(crate) fn build(
        own: Vec<BuildPrimitive>,
        source: &impl TriangleSource,
        accelerator: &Accelerator,
    ) -> Self {
        let (mut primitives, mut boxes) = (Vec::new(), Vec::new());
        for primitive in own.iter().filter(|primitive| primitive.is_triangle()) {
            let first = primitive.reference();
            let second = primitive.is_pair().then(|| source.second(first)).flatten();
            let second = second.map(|primitive| PrimitiveRef { primitive, ..first });
            for triangle in std::iter::once(first).chain(second) {
                primitives.push(triangle);
                boxes.push(BuildPrimitive::triangle(triangle, &source.corners(triangle)).box3());
            }
        }
        let n_triangles = primitives.len();
        for item in own.iter().filter(|primitive| !primitive.is_triangle()) {
            primitives.push(item.reference());
            boxes.push(item.box3());
        }
        drop(own);
        if boxes.is_empty() {
            let structure =
                Structure::build(&Build { boxes: &[], bounds: &Box3::EMPTY }, &Accelerator::Brute);
            return Self { primitives, n_triangles, bounds: Bounds3::EMPTY, structure };
        }
        let all = boxes.iter().fold(Box3::EMPTY, Box3::union);
        let point = |[x, y, z]: [f32; 3]| Point3::new(x, y, z);
        let bounds = Bounds3 { min: point(all.min), max: point(all.max) };
        let structure = Structure::build(&Build { boxes: &boxes, bounds: &all }, accelerator);
        Self { primitives, n_triangles, bounds, structure }
    }

    /// Box around all primitives; empty if there are none.
    pub(crate) const fn bounds(&self) -> Bounds3 {
        self.bounds
    }
}

/// Who asks for hits: tests shapes, takes hits of triangles, knows where triangles and instances are.
pub(crate) trait Target<'a>: Visitor<'a> {
    /// Corners of a triangle.
    fn corners(&self, triangle: PrimitiveRef) -> [[f32; 3]; 3];
    /// What follows is in an instance, until it is left: its group, and the ray there.
    fn enter_group(&mut self, instance: u32) -> (u32, WideRay);
    /// A triangle is about to be tested.
    fn note_triangle(&mut self);
}

/// A structure for the world and one for each object.
#[derive(Debug)]
pub(crate) struct Structures {
    pub(crate) accelerator: Accelerator,
    /// As [`crate::Geometry`] numbers them.
    pub(crate) groups: Vec<Group>,
}

impl Structures {
    /// Shows the target what a ray may hit with t in (0, `t_max`], beginning in the first group.
    pub(crate) fn search<'a>(&self, ray: &Ray, t_max: f32, target: &mut impl Target<'a>) {
        let mut end = t_max;
        let _ = self.search_group(0, &ray.into(), &mut end, target);
    }

    fn search_group<'a>(
        &self,
        group: u32,
        ray: &WideRay,
        end: &mut f32,
        target: &mut impl Target<'a>,
    ) -> ControlFlow<()> {
        let group = &self.groups[group as usize];
        let Some(ray) = TraversalRay::new(ray, &group.bounds.into()) else {
            return ControlFlow::Continue(());
        };
        if group.primitives.is_empty() {
            return ControlFlow::Continue(());
        }
        let mailbox = Mailbox::default();
        let mut search = GroupSearch { structures: self, group, ray: &ray, end: *end, target, mailbox };
        group.structure.traverse(&ray, &mut search)?;
        *end = search.end;
        ControlFlow::Continue(())
    }

    /// Nodes or cells of all groups.
    pub(crate) fn n_nodes(&self) -> usize {
        self.groups.iter().map(|group| group.structure.n_nodes()).sum()
    }

    /// Bytes on the heap.
    pub(crate) fn memory_bytes(&self) -> usize {
        let own = |group: &Group| group.structure.memory_bytes() + heap(&group.primitives);
        self.groups.iter().map(own).sum::<usize>() + heap(&self.groups)
    }
}

/// A ray on its way through one group.
struct GroupSearch<'s, T> {
    structures: &'s Structures,
    group: &'s Group,
    ray: &'s TraversalRay,
    end: f32,
    target: &'s mut T,
    mailbox: Mailbox,
}

impl<'a, T: Target<'a>> Probe for GroupSearch<'_, T> {
    #[inline(always)]
    fn note_node(&mut self) {
        self.target.note_node();
    }

    #[inline(always)]
    fn end(&self) -> f32 {
        self.end * TraversalRay::WIDEN
    }

    #[inline]
    fn test(&mut self, primitive: u32) -> ControlFlow<()> {
        if !self.mailbox.is_new(primitive) {
            return ControlFlow::Continue(());
        }
        let reference = self.group.primitives[primitive as usize];
        let verdict = if (primitive as usize) < self.group.n_triangles {
            self.target.note_triangle();
            match intersect_prepared(self.ray, &self.target.corners(reference)) {
                Some((t, b)) if t <= self.end => self.target.triangle(reference, t, b),
                _ => Verdict::Pass,
            }
        } else if reference.geometry == INSTANCE {
            return self.test_instance(reference.primitive);
        } else {
            self.target.shape(reference, self.end)
        };
        match verdict {
            Verdict::Pass => {}
            Verdict::Shorten(t) => self.end = t,
            Verdict::Stop => return ControlFlow::Break(()),
        }
        ControlFlow::Continue(())
    }
}

impl<'a, T: Target<'a>> GroupSearch<'_, T> {
    fn test_instance(&mut self, instance: u32) -> ControlFlow<()> {
        let (group, ray) = self.target.enter_group(instance);
        self.structures.search_group(group, &ray, &mut self.end, self.target)?;
        self.target.leave();
        ControlFlow::Continue(())
    }
}

/// Remembers what a ray has been tested against last.
#[derive(Debug)]
struct Mailbox {
    latest: [u32; 8],
    oldest: usize,
}

impl Default for Mailbox {
    fn default() -> Self {
        Self { latest: [u32::MAX; 8], oldest: 0 }
    }
}

impl Mailbox {
    /// False for what is remembered; all else is from now on.
    #[inline(always)]
    fn is_new(&mut self, primitive: u32) -> bool {
        if self.latest.contains(&primitive) {
            return false;
        }
        self.latest[self.oldest] = primitive;
        self.oldest = (self.oldest + 1) % self.latest.len();
        true
    }
}
