//! Shapes that rays meet but that are no lamps: triangles that move, curves, points with a size, and implicit
//! surfaces.
//!
//! They have no sampling by area; an area light on one is left out when the scene is built.

use etendue_math::{Bounds3, Point2, Ray};
use glam::DVec3;

use super::cloud::Cloud;
use super::curves::Curves;
use super::implicit::Implicit;
use super::moving::MovingTriangles;
use super::{Candidate, Candidates, LocalSurface};
use crate::geometry::GeometryCounts;

/// A placed shape that does not emit.
#[derive(Clone, Debug)]
pub(crate) enum Traced {
    /// Triangles whose vertices move.
    Moving(MovingTriangles),
    /// Hair and the like.
    Curves(Curves),
    /// Points with normals.
    Cloud(Cloud),
    /// The zeros of a formula.
    Implicit(Box<Implicit>),
}

impl Traced {
    /// Triangles, pieces of curves, points, or cells of an implicit surface.
    pub(crate) const fn n_primitives(&self) -> u32 {
        match self {
            Self::Moving(shape) => shape.n_primitives(),
            Self::Curves(shape) => shape.n_primitives(),
            Self::Cloud(shape) => shape.n_primitives(),
            Self::Implicit(shape) => shape.n_primitives(),
        }
    }

    /// Box around a primitive at all times.
    pub(crate) fn bounds(&self, primitive: u32) -> Bounds3 {
        match self {
            Self::Moving(shape) => shape.bounds(primitive),
            Self::Curves(shape) => shape.bounds(primitive),
            Self::Cloud(shape) => shape.bounds(primitive),
            Self::Implicit(shape) => shape.bounds(primitive),
        }
    }

    pub(crate) fn intersect(&self, primitive: u32, ray: &Ray) -> Candidates {
        match self {
            Self::Moving(shape) => shape.intersect(primitive, ray),
            Self::Curves(shape) => shape.intersect(primitive, ray),
            Self::Cloud(shape) => shape.intersect(primitive, ray),
            Self::Implicit(shape) => {
                let hit = shape.next_hit(primitive, ray, 0.0, f64::INFINITY);
                [hit.map(|t| Candidate { t, u: 0.0, v: 0.0 }), None]
            }
        }
    }

    /// Differential geometry where `ray` hits at `t`.
    pub(crate) fn surface(&self, primitive: u32, ray: &Ray, t: f32, uv: [f32; 2]) -> LocalSurface {
        match self {
            Self::Moving(shape) => shape.surface(primitive, ray, uv),
            Self::Curves(shape) => shape.surface(primitive, ray, t, uv),
            Self::Cloud(shape) => shape.surface(primitive, ray, t),
            Self::Implicit(shape) => shape.surface(ray, t),
        }
    }

    /// The point of a hit of `ray`, before rounding too.
    #[inline(never)]
    pub(crate) fn point(
        &self,
        primitive: u32,
        ray: &Ray,
        t: f32,
        uv: [f32; 2],
    ) -> (DVec3, crate::hit::SurfacePoint) {
        if let Self::Implicit(shape) = self {
            return shape.point(ray, t);
        }
        let surface = self.surface(primitive, ray, t, uv);
        (surface.p, surface.point)
    }

    pub(crate) fn uv(&self, primitive: u32, uv: [f32; 2]) -> Point2 {
        match self {
            Self::Moving(shape) => shape.uv(primitive, uv),
            Self::Curves(_) => Point2::new(uv[0], uv[1]),
            Self::Cloud(_) | Self::Implicit(_) => Point2::default(),
        }
    }

    pub(crate) fn memory_bytes(&self) -> usize {
        size_of::<Self>()
            + match self {
                Self::Moving(shape) => shape.memory_bytes(),
                Self::Curves(shape) => shape.memory_bytes(),
                Self::Cloud(shape) => shape.memory_bytes(),
                Self::Implicit(shape) => shape.memory_bytes(),
            }
    }

    pub(crate) const fn count(&self, counts: &mut GeometryCounts) {
        match self {
            Self::Moving(shape) => counts.n_triangles += shape.n_primitives() as usize,
            Self::Curves(shape) => counts.n_curves += shape.n_curves(),
            Self::Cloud(shape) => counts.n_points += shape.n_primitives() as usize,
            Self::Implicit(_) => counts.n_quadrics += 1,
        }
    }
}
