//! Shapes that emit, with what sampling they need at hand: lamps are asked from everywhere, and the way over entity, mesh,
//! indices and vertices costs as much as the sampling.

mod flat;

use etendue_math::{Point2, Point3};

pub use flat::FlatLamp;

use crate::Geometry;
use crate::hit::{GeometryId, Reference, ShapeSample};
use crate::shape::entity::Entity;
use crate::shape::globe::Globe;

/// A primitive for quicker sampling, or a whole shape, in world space.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Lamp {
    /// A triangle or a parallelogram.
    Flat(FlatLamp),
    /// A whole sphere.
    Sphere(Globe),
}

impl Geometry {
    /// A primitive for quicker sampling; `None` for other shapes and those without area.
    #[must_use]
    pub fn lamp(&self, geometry: GeometryId, primitive: u32) -> Option<Lamp> {
        if !self.can_emit(geometry) {
            return None;
        }
        match self.entity(geometry) {
            Entity::Triangles(triangles) => FlatLamp::of_triangle(triangles, primitive).map(Lamp::Flat),
            Entity::Patches(patches) => FlatLamp::of_patch(patches, primitive).map(Lamp::Flat),
            Entity::Sphere(sphere) => Some(Lamp::Sphere(*sphere.globe())),
            Entity::Quadric(_) | Entity::Traced(_) => None,
        }
    }

    /// A whole shape of several primitives that is one lamp: two triangles that make a parallelogram.
    #[must_use]
    pub fn joined_lamp(&self, geometry: GeometryId) -> Option<Lamp> {
        let Entity::Triangles(triangles) = self.entity(geometry) else { return None };
        self.can_emit(geometry).then(|| FlatLamp::of_mesh(triangles).map(Lamp::Flat))?
    }
}

impl Lamp {
    /// A point as seen from `reference`, its density per steradian, and its place on the primitive, given as in
    /// [`crate::Hit::uv`]. The sample has no texture coordinates.
    #[inline(always)]
    #[must_use]
    pub fn sample_from(&self, reference: &Reference, u: Point2) -> Option<(ShapeSample, f32, [f32; 2])> {
        match self {
            Self::Flat(lamp) => lamp.sample_from(reference, u),
            Self::Sphere(lamp) => {
                lamp.sample_from(reference, u).map(|(sample, pdf_w)| (sample, pdf_w, [0.0; 2]))
            }
        }
    }

    /// The density per steradian of [`sample_from`](Self::sample_from) for a point of the lamp.
    #[inline(always)]
    #[must_use]
    pub fn pdf_from(&self, reference: &Reference, p: Point3) -> f32 {
        match self {
            Self::Flat(lamp) => lamp.pdf_from(reference, p),
            Self::Sphere(lamp) => lamp.pdf_from(reference, p),
        }
    }

    /// The parallelogram or triangle that it is.
    #[must_use]
    pub const fn flat(&self) -> Option<&FlatLamp> {
        match self {
            Self::Flat(lamp) => Some(lamp),
            Self::Sphere(_) => None,
        }
    }

    /// True if the place that comes with a sample tells its texture coordinates.
    #[must_use]
    pub const fn has_places(&self) -> bool {
        !matches!(self, Self::Sphere(_))
    }
}
