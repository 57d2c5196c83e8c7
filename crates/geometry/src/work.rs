//! What it takes to follow a ray, counted: figures that are the same on every machine.

use std::cell::Cell;

use etendue_math::Ray;

use crate::geometry::Geometry;

/// Steps of rays through the hierarchies.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct TraversalWork {
    /// Nodes whose eight children were tested; of other structures, nodes and cells that were looked at.
    pub nodes: u64,
    /// Blocks of up to eight triangles that were tested.
    pub blocks: u64,
    /// Triangles and other shapes that were tested, in blocks or alone.
    pub primitives: u64,
    /// Instances that were entered.
    pub instances: u64,
}

impl Geometry {
    /// What [`Geometry::intersect`] takes for some rays.
    pub fn work_to_intersect<'a>(
        &self,
        rays: impl IntoIterator<Item = &'a Ray>,
        t_max: f32,
    ) -> TraversalWork {
        let work = Cell::default();
        for ray in rays {
            self.search::<_, _, false>(ray, t_max, &|_| true, &work);
        }
        work.get()
    }

    /// What [`Geometry::occluded`] takes for some rays.
    pub fn work_to_occlude<'a>(&self, rays: impl IntoIterator<Item = &'a Ray>, t_max: f32) -> TraversalWork {
        let work = Cell::default();
        for ray in rays {
            self.search::<_, _, true>(ray, t_max, &|_| true, &work);
        }
        work.get()
    }
}

/// Hears of the steps of a search.
pub(crate) trait Work: Copy {
    fn note_node(self);
    fn note_block(self);
    fn note_primitives(self, n: impl FnOnce() -> u32);
    fn note_instance(self);
}

/// Counts nothing and costs nothing.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Unnoted;

impl Work for Unnoted {
    #[inline(always)]
    fn note_node(self) {}
    #[inline(always)]
    fn note_block(self) {}
    #[inline(always)]
    fn note_primitives(self, _: impl FnOnce() -> u32) {}
    #[inline(always)]
    fn note_instance(self) {}
}

impl Work for &Cell<TraversalWork> {
    fn note_node(self) {
        self.update(|work| TraversalWork { nodes: work.nodes + 1, ..work });
    }

    fn note_block(self) {
        self.update(|work| TraversalWork { blocks: work.blocks + 1, ..work });
    }

    fn note_primitives(self, n: impl FnOnce() -> u32) {
        self.update(|work| TraversalWork { primitives: work.primitives + u64::from(n()), ..work });
    }

    fn note_instance(self) {
        self.update(|work| TraversalWork { instances: work.instances + 1, ..work });
    }
}

#[cfg(test)]
mod tests {
    use etendue_math::{AnimatedTransform, Point3, Transform, Vector3};

    use super::*;
    use crate::{GeometryBuilder, Shape, TriangleMesh};

    fn triangle() -> Shape {
        let positions = vec![Point3::splat(0.0), Point3::new(1.0, 0.0, 0.0), Point3::new(0.0, 1.0, 0.0)];
        Shape::Triangles(TriangleMesh { positions, indices: vec![[0, 1, 2]], ..TriangleMesh::default() })
    }

    fn ray(x: f32) -> Ray {
        Ray::new(Point3::new(x, 0.2, 1.0), Vector3::new(0.0, 0.0, -1.0))
    }

    /// A ray beside the only triangle tests the root alone, one through it also the block; an instance has a root of its
    /// own. Both questions take the same steps here, with either kernel.
    #[test]
    fn steps_are_counted() {
        let place = AnimatedTransform::constant(Transform::IDENTITY);
        let mut alone = GeometryBuilder::new();
        alone.add(triangle(), &place, false);
        let mut instanced = GeometryBuilder::new();
        let object = instanced.begin_object();
        instanced.add_to_object(object, triangle(), &Transform::IDENTITY, false);
        instanced.add_instance(object, &place);
        let check = |geometry: &Geometry, hit: [u64; 3]| {
            let miss = TraversalWork { nodes: 1, ..TraversalWork::default() };
            let [nodes, blocks, instances] = hit;
            for (x, expected) in
                [(0.2, TraversalWork { nodes, blocks, primitives: blocks, instances }), (7.0, miss)]
            {
                assert_eq!(geometry.work_to_intersect(&[ray(x)], f32::INFINITY), expected);
                assert_eq!(geometry.work_to_occlude(&[ray(x)], f32::INFINITY), expected);
            }
        };
        check(&alone.build(), [1, 1, 0]);
        let instanced = instanced.build();
        check(&instanced, [2, 1, 1]);
        check(&instanced.traced_portably(), [2, 1, 1]);
    }
}
