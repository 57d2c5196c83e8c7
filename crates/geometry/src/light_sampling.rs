//! Points of shapes as light sources: by area, or by direction from the point to be lit.
//!
//! Densities change measure by p_w = p_a r² / |cos|. Whole spheres are sampled by their cone of directions,
//! triangles and rectangles uniformly in solid angle where that is accurate, everything else by area. Only for
//! entities for which [`Geometry::can_emit`] holds.

#[cfg(test)]
mod tests;

use etendue_math::{Bounds3, Normal3, Point2, Point3, Ray, Vector3};

use crate::geometry::Geometry;
use crate::hit::{GeometryId, Reference, ShapeSample};
use crate::shape::entity::Entity;

/// Solid angles in which sampling triangles by direction is accurate, in steradians: all but nearly half the sphere.
pub(crate) const SPHERICAL_SAMPLING: std::ops::RangeTo<f32> = ..6.22;

/// The density per steradian of a point with density `pdf_a` per area, `offset` away with unit normal `n`; 0 where
/// the surface is seen edge on.
#[inline]
#[must_use]
pub fn solid_angle_density(pdf_a: f32, offset: Vector3, n: Normal3) -> f32 {
    let distance_squared = offset.length_squared();
    let cosine = n.abs_dot_vector(offset) / distance_squared.sqrt();
    let pdf_w = pdf_a * distance_squared / cosine;
    if cosine > 0.0 && pdf_w.is_finite() { pdf_w } else { 0.0 }
}

/// The inverse of [`solid_angle_density`].
#[inline]
pub(crate) fn area_density(pdf_w: f32, offset: Vector3, n: Normal3) -> f32 {
    let distance_squared = offset.length_squared();
    pdf_w * n.abs_dot_vector(offset) / (distance_squared * distance_squared.sqrt())
}

impl Geometry {
    #[inline]
    pub(crate) fn entity(&self, geometry: GeometryId) -> &Entity {
        &self.entities[geometry.0 as usize]
    }

    /// Area of a primitive in square metres.
    #[must_use]
    pub fn area(&self, geometry: GeometryId, primitive: u32) -> f32 {
        self.entity(geometry).area(primitive)
    }

    /// Box around a primitive.
    #[must_use]
    pub fn primitive_bounds(&self, geometry: GeometryId, primitive: u32) -> Bounds3 {
        self.entity(geometry).bounds(primitive)
    }

    /// Axis and cosine of the half angle of a cone that holds the normals of a primitive.
    #[must_use]
    pub fn emission_cone(&self, geometry: GeometryId, primitive: u32) -> (Vector3, f32) {
        self.entity(geometry).emission_cone(primitive)
    }

    /// A point of a primitive, uniform in area (on stretched quadrics and bent patches nearly so).
    #[must_use]
    pub fn sample_area(&self, geometry: GeometryId, primitive: u32, u: Point2) -> Option<ShapeSample> {
        self.entity(geometry).sample_area(primitive, u)
    }

    /// Density per square metre of [`sample_area`](Self::sample_area) at a point `p` of the primitive with unit
    /// normal `n`.
    #[must_use]
    pub fn area_pdf(&self, geometry: GeometryId, primitive: u32, p: Point3, n: Normal3) -> f32 {
        self.entity(geometry).area_pdf_at_point(primitive, p, n)
    }

    /// How far along a ray it first meets a primitive, whatever is before it, and the unit normal there; both in the space in
    /// which the primitive was added.
    #[must_use]
    pub fn meet(&self, geometry: GeometryId, primitive: u32, ray: &Ray) -> Option<(f32, Normal3)> {
        let entity = self.entity(geometry);
        let hit = entity.intersect(primitive, ray).into_iter().flatten().next()?;
        let t = hit.t as f32;
        Some((t, entity.area_pdf_at_hit(primitive, ray, t, [hit.u, hit.v]).1))
    }

    /// A point of a primitive as seen from `reference`, with its density per steradian.
    #[inline]
    #[must_use]
    pub fn sample_from(
        &self,
        geometry: GeometryId,
        primitive: u32,
        reference: &Reference,
        u: Point2,
    ) -> Option<(ShapeSample, f32)> {
        let entity = self.entity(geometry);
        if let Some((mut sample, pdf_w)) = entity.sample_direction(primitive, reference, u) {
            sample.pdf_a = area_density(pdf_w, sample.p - reference.p, sample.n);
            return Some((sample, pdf_w));
        }
        let sample = entity.sample_area(primitive, u)?;
        let pdf_w = solid_angle_density(sample.pdf_a, sample.p - reference.p, sample.n);
        (pdf_w > 0.0).then_some((sample, pdf_w))
    }

    /// Density per steradian with which [`sample_from`](Self::sample_from) chooses the unit direction `wi`; 0 where
    /// it misses. Of two points in that direction only the nearer, visible one counts.
    #[must_use]
    pub fn pdf_from(&self, geometry: GeometryId, primitive: u32, reference: &Reference, wi: Vector3) -> f32 {
        let entity = self.entity(geometry);
        let ray = Ray::new(reference.p, wi);
        let Some(hit) = entity.intersect(primitive, &ray).into_iter().flatten().next() else { return 0.0 };
        if let Some(pdf_w) = entity.direction_pdf(primitive, reference) {
            return pdf_w;
        }
        let t = hit.t as f32;
        let (pdf_a, n) = entity.area_pdf_at_hit(primitive, &ray, t, [hit.u, hit.v]);
        solid_angle_density(pdf_a, wi * t, n)
    }

    /// The same density for a known point `p` of the primitive with unit normal `n`, without tracing a ray.
    #[inline]
    #[must_use]
    pub fn pdf_from_point(
        &self,
        geometry: GeometryId,
        primitive: u32,
        reference: &Reference,
        p: Point3,
        n: Normal3,
    ) -> f32 {
        let entity = self.entity(geometry);
        if let Some(pdf_w) = entity.direction_pdf(primitive, reference) {
            return pdf_w;
        }
        solid_angle_density(entity.area_pdf_at_point(primitive, p, n), p - reference.p, n)
    }
}
