//! Shapes that emit, with what sampling they need at hand: lamps are asked from everywhere, and the way over entity, mesh,
//! indices and vertices costs as much as the sampling.

mod rectangle;
mod triangle;

use etendue_math::Point2;

pub use rectangle::FlatRectangle;
pub use triangle::FlatTriangle;

use crate::Geometry;
use crate::hit::{GeometryId, Reference, ShapeSample};
use crate::shape::entity::Entity;
use crate::shape::globe::Globe;

/// A primitive for quicker sampling, in world space.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Lamp {
    /// A triangle without vertex normals.
    Triangle(FlatTriangle),
    /// A rectangular patch without vertex normals.
    Rectangle(FlatRectangle),
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
            Entity::Triangles(triangles) => FlatTriangle::new(triangles, primitive).map(Lamp::Triangle),
            Entity::Patches(patches) => FlatRectangle::new(patches, primitive).map(Lamp::Rectangle),
            Entity::Sphere(sphere) => Some(Lamp::Sphere(*sphere.globe())),
            Entity::Quadric(_) => None,
        }
    }
}

impl Lamp {
    /// A point as seen from `reference`, its density per steradian, and its place on the primitive, given as in
    /// [`crate::Hit::uv`]. The sample has no texture coordinates.
    #[inline(always)]
    #[must_use]
    pub fn sample_from(&self, reference: &Reference, u: Point2) -> Option<(ShapeSample, f32, [f32; 2])> {
        match self {
            Self::Triangle(lamp) => lamp.sample_from(reference, u),
            Self::Rectangle(lamp) => lamp.sample_from(reference, u),
            Self::Sphere(lamp) => {
                lamp.sample_from(reference, u).map(|(sample, pdf_w)| (sample, pdf_w, [0.0; 2]))
            }
        }
    }

    /// The density per steradian of [`sample_from`](Self::sample_from) for a point of the lamp.
    #[inline(always)]
    #[must_use]
    pub fn pdf_from(&self, reference: &Reference, p: etendue_math::Point3) -> f32 {
        match self {
            Self::Triangle(lamp) => lamp.pdf_from(reference, p),
            Self::Rectangle(lamp) => lamp.pdf_from(reference, p),
            Self::Sphere(lamp) => lamp.pdf_from(reference, p),
        }
    }

    /// True if the place that comes with a sample tells its texture coordinates.
    #[must_use]
    pub const fn has_places(&self) -> bool {
        !matches!(self, Self::Sphere(_))
    }
}
