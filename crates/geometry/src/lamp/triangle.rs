//! A flat triangle that emits.

use etendue_math::warp::{SphericalTriangle, sample_uniform_triangle};
use etendue_math::{Normal3, Point2, Point3, Vector3};

use crate::double;
use crate::hit::{Reference, ShapeSample};
use crate::light_sampling::{SPHERICAL_SAMPLING, area_density, solid_angle_density};
use crate::shape::Triangles;

/// A triangle without vertex normals, in world space.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FlatTriangle {
    corners: [Point3; 3],
    n: Normal3,
    /// Bound of the absolute error of a sampled position, per coordinate.
    p_error: f32,
}

impl FlatTriangle {
    pub(super) fn new(triangles: &Triangles, triangle: u32) -> Option<Self> {
        if !triangles.mesh().normals.is_empty() {
            return None;
        }
        let n = triangles.emission_cone(triangle).0;
        let corners = triangles.positions(triangle);
        let size = double::largest_coordinate(corners.map(double::point)) as f32;
        // Six roundings of numbers no larger than twice the coordinates.
        let p_error = 6.0 * f32::EPSILON * size + f32::MIN_POSITIVE;
        (n.as_vector().length_squared() > 0.0).then_some(Self { corners, n, p_error })
    }

    /// A point as seen from `reference`, its density per steradian, and the weights of the second and third corner. The
    /// sample has no texture coordinates.
    #[inline(always)]
    #[must_use]
    pub fn sample_from(&self, reference: &Reference, u: Point2) -> Option<(ShapeSample, f32, [f32; 2])> {
        let spherical = self.spherical(reference.p);
        let [_, b1, b2] =
            spherical.map_or_else(|| sample_uniform_triangle(u), |spherical| spherical.sample(u));
        let [a, b, c] = self.corners;
        let p = a + (b - a) * b1 + (c - a) * b2;
        let offset = p - reference.p;
        let (pdf_w, pdf_a) = match spherical {
            Some(spherical) => (spherical.pdf_w(), area_density(spherical.pdf_w(), offset, self.n)),
            None => (solid_angle_density(self.pdf_a(), offset, self.n), self.pdf_a()),
        };
        let sample = ShapeSample {
            p,
            p_error: Vector3::splat(self.p_error),
            n: self.n,
            uv: Point2::splat(0.0),
            pdf_a,
        };
        (pdf_w > 0.0).then_some((sample, pdf_w, [b1, b2]))
    }

    /// The density per steradian of [`sample_from`](Self::sample_from) for a point `p` of the triangle.
    #[inline(always)]
    #[must_use]
    pub fn pdf_from(&self, reference: &Reference, p: Point3) -> f32 {
        match self.spherical(reference.p) {
            Some(spherical) => spherical.pdf_w(),
            None => solid_angle_density(self.pdf_a(), p - reference.p, self.n),
        }
    }

    #[inline(always)]
    fn spherical(&self, p: Point3) -> Option<SphericalTriangle> {
        SphericalTriangle::new(self.corners, p)
            .filter(|spherical| SPHERICAL_SAMPLING.contains(&spherical.solid_angle()))
    }

    #[inline(always)]
    fn pdf_a(&self) -> f32 {
        let [a, b, c] = self.corners;
        2.0 / (b - a).cross(c - a).length()
    }
}
