//! A flat triangle or parallelogram that emits. From afar points are uniform in area, which is cheap and nearly as good;
//! from near by, uniform in solid angle.

#[cfg(test)]
mod tests;

use etendue_math::warp::{SphericalTriangle, sample_uniform_triangle};
use etendue_math::{Bounds3, Normal3, ONE_MINUS_EPSILON, Point2, Point3, Ray, Vector3};

use crate::double;
use crate::hit::{Reference, ShapeSample};
use crate::light_sampling::{SPHERICAL_SAMPLING, area_density, solid_angle_density};
use crate::shape::{Patches, Triangles};

/// Distance from the middle, in radii of the lamp, from which on sampling is by area. Squares of distances to points of the
/// lamp then differ by at most a factor of 4, and it fills less than half a steradian.
const FAR: f32 = 3.0;

/// A flat lamp in world space: all `a + s e1 + t e2`, with s and t in [0, 1], and s + t <= 1 on a triangle.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FlatLamp {
    a: Point3,
    e1: Vector3,
    e2: Vector3,
    n: Normal3,
    is_triangle: bool,
    /// One over the area.
    pdf_a: f32,
    /// Square of the distance from the middle from which on sampling is by area.
    far_squared: f32,
    /// Bound of the absolute error of a sampled position, per coordinate.
    p_error: f32,
}

impl FlatLamp {
    /// A triangle; `None` without area, and where vertex normals are at odds about the side that is outside.
    pub(super) fn of_triangle(triangles: &Triangles, triangle: u32) -> Option<Self> {
        let [a, b, c] = triangles.positions(triangle);
        Self::new([a, b, c], None, triangles.side(triangle)?)
    }

    /// A patch that is a parallelogram, without vertex normals.
    pub(super) fn of_patch(patches: &Patches, patch: u32) -> Option<Self> {
        let is_simple = patches.is_flat() && patches.mesh().normals.is_empty();
        let [a, b, c, d] = patches.positions(patch);
        is_simple.then(|| Self::new([a, b, c], Some(d), patches.emission_cone(patch).0))?
    }

    /// A whole mesh of two triangles that make a parallelogram and look the same way, as lamps often are.
    pub(super) fn of_mesh(triangles: &Triangles) -> Option<Self> {
        if triangles.mesh().indices.len() != 2 {
            return None;
        }
        let (first, second) = (Self::of_triangle(triangles, 0)?, Self::of_triangle(triangles, 1)?);
        let [p, q] = [0, 1].map(|triangle| triangles.positions(triangle));
        let own = (0..3).find(|i| !q.contains(&p[*i]))?;
        let other = *q.iter().find(|corner| !p.contains(corner))?;
        let (a, b, c) = (p[own], p[(own + 1) % 3], p[(own + 2) % 3]);
        let is_parallelogram = q.contains(&b) && q.contains(&c) && opening([a, b, c], other) <= first.p_error;
        let agrees = first.n.dot(second.n) > 0.999_999;
        (is_parallelogram && agrees).then(|| Self::new([a, b, c], Some(other), first.n))?
    }

    /// From the corners a, a + e1 and a + e2, and of a parallelogram the one at a + e1 + e2 but for its rounding.
    fn new(corners: [Point3; 3], opposite: Option<Point3>, n: Normal3) -> Option<Self> {
        let [a, b, c] = corners;
        let is_triangle = opposite.is_none();
        let (e1, e2) = (b - a, c - a);
        let area = e1.cross(e2).length() * if is_triangle { 0.5 } else { 1.0 };
        let all = || corners.into_iter().chain(opposite);
        let size = double::largest_coordinate(all().map(double::point)) as f32;
        // Six roundings of numbers no larger than twice the coordinates, and how far the surface leaves the plane.
        let bend = opposite.map_or(0.0, |opposite| opening(corners, opposite));
        let p_error = 6.0 * f32::EPSILON * size + bend + f32::MIN_POSITIVE;
        let pdf_a = 1.0 / area;
        let lamp = Self { a, e1, e2, n, is_triangle, pdf_a, far_squared: 0.0, p_error };
        let radius_squared = all().map(|p| (p - lamp.middle()).length_squared()).fold(0.0, f32::max);
        let is_valid = n.as_vector().length_squared() > 0.0 && area > 0.0 && pdf_a.is_finite();
        is_valid.then_some(Self { far_squared: FAR * FAR * radius_squared, ..lamp })
    }

    #[inline(always)]
    fn middle(&self) -> Point3 {
        self.a + (self.e1 + self.e2) * if self.is_triangle { 1.0 / 3.0 } else { 0.5 }
    }

    /// Area in square metres.
    #[must_use]
    pub fn area(&self) -> f32 {
        1.0 / self.pdf_a
    }

    /// Box around it.
    #[must_use]
    pub fn bounds(&self) -> Bounds3 {
        let last = if self.is_triangle { self.a } else { self.at([1.0, 1.0]) };
        Bounds3::from_points([self.a, self.at([1.0, 0.0]), self.at([0.0, 1.0]), last])
    }

    /// A point, uniform in area. The sample has no texture coordinates.
    #[must_use]
    pub fn sample_area(&self, u: Point2) -> ShapeSample {
        self.sample_at(self.place(u), self.pdf_a)
    }

    /// A point as seen from `reference`, its density per steradian, and its coordinates s and t. The sample has no texture
    /// coordinates.
    #[inline(always)]
    #[must_use]
    pub fn sample_from(&self, reference: &Reference, u: Point2) -> Option<(ShapeSample, f32, [f32; 2])> {
        if let Some(near) = self.near(reference.p) {
            let (place, pdf_w) = near.sample(u);
            let mut sample = self.sample_at(place, 0.0);
            sample.pdf_a = area_density(pdf_w, sample.p - reference.p, self.n);
            return Some((sample, pdf_w, place));
        }
        let place = self.place(u);
        let sample = self.sample_at(place, self.pdf_a);
        let pdf_w = solid_angle_density(self.pdf_a, sample.p - reference.p, self.n);
        (pdf_w > 0.0).then_some((sample, pdf_w, place))
    }

    /// The density per steradian of [`sample_from`](Self::sample_from) for a point `p` of the lamp.
    #[inline(always)]
    #[must_use]
    pub fn pdf_from(&self, reference: &Reference, p: Point3) -> f32 {
        match self.near(reference.p) {
            Some(near) => 1.0 / near.solid_angle,
            None => solid_angle_density(self.pdf_a, p - reference.p, self.n),
        }
    }

    /// The point that a ray meets.
    #[must_use]
    pub fn intersect(&self, ray: &Ray) -> Option<Point3> {
        let t = (self.a - ray.origin).dot_normal(self.n) / ray.direction.dot_normal(self.n);
        let offset = ray.at(t) - self.a;
        let normal = self.e1.cross(self.e2);
        let scale = 1.0 / normal.length_squared();
        let (s, t_edge) =
            (offset.cross(self.e2).dot(normal) * scale, self.e1.cross(offset).dot(normal) * scale);
        let end = if self.is_triangle { 1.0 - s } else { 1.0 };
        let is_inside = (0.0..=1.0).contains(&s) && (0.0..=end).contains(&t_edge);
        (t > 0.0 && t.is_finite() && is_inside).then(|| ray.at(t))
    }

    #[inline(always)]
    fn at(&self, [s, t]: [f32; 2]) -> Point3 {
        self.a + self.e1 * s + self.e2 * t
    }

    #[inline(always)]
    fn sample_at(&self, place: [f32; 2], pdf_a: f32) -> ShapeSample {
        let p_error = Vector3::splat(self.p_error);
        ShapeSample { p: self.at(place), p_error, n: self.n, uv: Point2::splat(0.0), pdf_a }
    }

    /// Coordinates uniform in area.
    #[inline(always)]
    fn place(&self, u: Point2) -> [f32; 2] {
        if self.is_triangle {
            let [_, s, t] = sample_uniform_triangle(u);
            [s, t]
        } else {
            [u.x, u.y]
        }
    }

    /// What sampling by direction needs; `None` where sampling is by area.
    #[inline(always)]
    fn near(&self, p: Point3) -> Option<NearLamp> {
        if (p - self.middle()).length_squared() > self.far_squared {
            return None;
        }
        self.as_seen_from(p)
    }

    fn as_seen_from(&self, p: Point3) -> Option<NearLamp> {
        let (b, c) = (self.a + self.e1, self.a + self.e2);
        let halves = if self.is_triangle {
            [SphericalTriangle::new([self.a, b, c], p), None]
        } else {
            let d = b + self.e2;
            [SphericalTriangle::new([self.a, b, d], p), SphericalTriangle::new([self.a, d, c], p)]
        };
        let solid_angle = halves.iter().flatten().map(SphericalTriangle::solid_angle).sum();
        let is_accurate = solid_angle > 0.0 && SPHERICAL_SAMPLING.contains(&solid_angle);
        is_accurate.then_some(NearLamp { halves, solid_angle, is_triangle: self.is_triangle })
    }
}

/// By how much, per coordinate, a fourth corner misses the parallelogram over a corner and its two neighbours.
fn opening([a, b, c]: [Point3; 3], opposite: Point3) -> f32 {
    ((b - a) - (opposite - c)).abs().max_element()
}

/// A lamp on the sphere of directions: a triangle, or the halves a, b, d and a, d, c of a parallelogram a, b, d, c.
struct NearLamp {
    halves: [Option<SphericalTriangle>; 2],
    /// Steradians of both.
    solid_angle: f32,
    is_triangle: bool,
}

impl NearLamp {
    /// Coordinates uniform in solid angle, and their density per steradian.
    #[inline]
    fn sample(&self, u: Point2) -> ([f32; 2], f32) {
        let shares =
            self.halves.each_ref().map(|half| half.as_ref().map_or(0.0, SphericalTriangle::solid_angle));
        let position = u.x * self.solid_angle;
        let half = usize::from(shares[0] == 0.0 || (position >= shares[0] && shares[1] > 0.0));
        let start = if half == 0 { 0.0 } else { shares[0] };
        let x = ((position - start) / shares[half]).clamp(0.0, ONE_MINUS_EPSILON);
        let weights = self.halves[half].as_ref().map_or([1.0, 0.0, 0.0], |t| t.sample(Point2::new(x, u.y)));
        let [_, second, third] = weights;
        let place = match (self.is_triangle, half) {
            (true, _) => [second, third],
            (false, 0) => [second + third, third],
            (false, _) => [second, second + third],
        };
        (place, 1.0 / self.solid_angle)
    }
}
