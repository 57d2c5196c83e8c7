//! A flat rectangle that emits.

use etendue_math::warp::{Rectangle, SphericalRectangle};
use etendue_math::{Normal3, Point2, Point3, Vector3};

use crate::double;
use crate::hit::{Reference, ShapeSample};
use crate::light_sampling::{area_density, solid_angle_density};
use crate::shape::{Patches, RECTANGLE_SAMPLING};

/// A rectangular patch without vertex normals, in world space.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FlatRectangle {
    rectangle: Rectangle,
    /// -1 if the normal lies on the other side of the rectangle than its own, else 1.
    sign: f32,
    /// Bound of the absolute error of a sampled position, per coordinate.
    p_error: f32,
}

impl FlatRectangle {
    pub(super) fn new(patches: &Patches, patch: u32) -> Option<Self> {
        let [p00, p10, p01, _] = patches.flat_rectangle(patch)?;
        let rectangle = Rectangle::new(p00, p10 - p00, p01 - p00)?;
        let sign = 1.0_f32.copysign(patches.emission_cone(patch).0.dot_vector(rectangle.normal()));
        let size = double::largest_coordinate([p00, p10, p01].map(double::point)) as f32;
        // Ten roundings of numbers no larger than twice the coordinates, and as many ulps that a patch may be bent by.
        Some(Self { rectangle, sign, p_error: 20.0 * f32::EPSILON * size + f32::MIN_POSITIVE })
    }

    /// See [`Lamp::sample_from`](super::Lamp::sample_from).
    #[inline(always)]
    #[must_use]
    pub fn sample_from(&self, reference: &Reference, u: Point2) -> Option<(ShapeSample, f32, [f32; 2])> {
        let spherical = self.spherical(reference.p);
        let place = spherical.map_or(u, |spherical| spherical.sample_shares(u));
        let p = self.rectangle.at(place);
        let (n, offset) = (self.normal(), p - reference.p);
        let (pdf_w, pdf_a) = match spherical {
            Some(spherical) => (spherical.pdf_w(), area_density(spherical.pdf_w(), offset, n)),
            None => (solid_angle_density(self.pdf_a(), offset, n), self.pdf_a()),
        };
        let p_error = Vector3::splat(self.p_error);
        let sample = ShapeSample { p, p_error, n, uv: Point2::splat(0.0), pdf_a };
        (pdf_w > 0.0).then_some((sample, pdf_w, [place.x, place.y]))
    }

    /// The density per steradian of [`sample_from`](Self::sample_from) for a point `p` of the rectangle.
    #[inline(always)]
    #[must_use]
    pub fn pdf_from(&self, reference: &Reference, p: Point3) -> f32 {
        match self.spherical(reference.p) {
            Some(spherical) => spherical.pdf_w(),
            None => solid_angle_density(self.pdf_a(), p - reference.p, self.normal()),
        }
    }

    #[inline(always)]
    fn spherical(&self, p: Point3) -> Option<SphericalRectangle> {
        SphericalRectangle::seen_from(p, &self.rectangle)
            .filter(|spherical| RECTANGLE_SAMPLING.contains(&spherical.solid_angle()))
    }

    #[inline(always)]
    fn normal(&self) -> Normal3 {
        (self.rectangle.normal() * self.sign).as_normal()
    }

    #[inline(always)]
    fn pdf_a(&self) -> f32 {
        1.0 / self.rectangle.area()
    }
}
