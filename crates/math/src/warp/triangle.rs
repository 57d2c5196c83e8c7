//! Triangles: uniformly by area, or by the solid angle that they fill as seen from a point.
//!
//! The map is that of Arvo 1995, "Stratified Sampling of Spherical Triangles": the first number cuts the spherical triangle
//! ABC by a great circle through B so that the part next to A has the wanted share of the area; the second chooses a height
//! on the arc from B to the cut. It is computed as in Peters 2021, "BRDF Importance Sampling for Polygonal Lights"
//! (doi:10.1145/3450626.3459672): with unit vectors a, b, c and the solid angle
//! `tan(omega / 2) = |a.(b x c)| / (1 + a.b + b.c + c.a)` (van Oosterom and Strackee 1983), the direction h half way between
//! a and the cut c' gives a triangle of `tan(omega' / 2) = |a.(b x h)| / (h.(a + b))`, which is linear in h.
//!
//! Single precision is enough at any size, because no difference of nearly equal numbers is taken: the triple product comes
//! from the edges of the triangle, and directions are only ever weights of a, b, c, which lead straight to barycentric
//! coordinates.

use std::f32::consts::TAU;

use glam::DVec3;

use crate::approx::{atan2, sin_cos_turns};
use crate::{ONE_MINUS_EPSILON, Point2, Point3, Vector3};

/// Barycentric coordinates of a point of a triangle, uniform by area (Heitz 2019, "A Low-Distortion Map Between Triangle
/// and Square").
#[inline]
#[must_use]
pub fn sample_uniform_triangle(u: Point2) -> [f32; 3] {
    let (b0, b1) = if u.x < u.y {
        let b0 = u.x / 2.0;
        (b0, u.y - b0)
    } else {
        let b1 = u.y / 2.0;
        (u.x - b1, b1)
    };
    [b0, b1, 1.0 - b0 - b1]
}

/// Density of [`sample_uniform_triangle`] per square metre for a triangle of this area.
#[inline]
#[must_use]
pub const fn uniform_triangle_pdf(area: f32) -> f32 {
    1.0 / area
}

/// Inverse of [`sample_uniform_triangle`].
#[inline]
#[must_use]
pub fn invert_uniform_triangle(b: [f32; 3]) -> Point2 {
    if b[1] > b[0] {
        Point2::new((2.0 * b[0]).min(ONE_MINUS_EPSILON), (b[0] + b[1]).min(ONE_MINUS_EPSILON))
    } else {
        Point2::new((b[0] + b[1]).min(ONE_MINUS_EPSILON), (2.0 * b[1]).min(ONE_MINUS_EPSILON))
    }
}

/// A triangle as seen from a point, ready to sample directions uniformly.
#[derive(Clone, Copy, Debug)]
pub struct SphericalTriangle {
    /// Distances of the corners.
    distances: [f32; 3],
    /// Products of the vectors to the corners: A . B, B . C, C . A and A . (B x C), the last not negative.
    ab: f32,
    bc: f32,
    ca: f32,
    triple: f32,
    /// Steradians.
    solid_angle: f32,
}

impl SphericalTriangle {
    /// The triangle `v` as seen from `p`; `None` if it fills no solid angle.
    #[inline(always)]
    #[must_use]
    pub fn new(v: [Point3; 3], p: Point3) -> Option<Self> {
        let [a, b, c] = v.map(|v| v - p);
        let distances = [a.length(), b.length(), c.length()];
        let (ab, bc, ca) = (a.dot(b), b.dot(c), c.dot(a));
        // Of vectors to the corners any may be replaced by edges.
        let triple = a.dot((v[1] - v[0]).cross(v[2] - v[0])).abs();
        // tan(omega / 2), both sides times the three distances.
        let [la, lb, lc] = distances;
        let half = atan2(triple, (la * lb + ab) * lc + (bc * la + ca * lb));
        let solid_angle = 2.0 * half;
        (solid_angle > 1e-30).then_some(Self { distances, ab, bc, ca, triple, solid_angle })
    }

    /// Steradians.
    #[inline]
    #[must_use]
    pub fn solid_angle(&self) -> f32 {
        self.solid_angle
    }

    /// Density of [`sample`](Self::sample) per steradian.
    #[inline]
    #[must_use]
    pub fn pdf_w(&self) -> f32 {
        1.0 / self.solid_angle
    }

    /// Barycentric coordinates of a point of the triangle, uniform by solid angle.
    #[inline(always)]
    #[must_use]
    pub fn sample(&self, u: Point2) -> [f32; 3] {
        let [ia, ib, ic] = self.distances.map(f32::recip);
        // Of the directions to the corners.
        let (ab, bc, ca) = (self.ab * (ia * ib), self.bc * (ib * ic), self.ca * (ic * ia));
        let triple = self.triple * ia * (ib * ic);
        // tan(omega' / 2) = sin / cos for the half vector h = h_a a + h_c c.
        let (sin, cos) = sin_cos_turns(u.x * self.solid_angle * (0.5 / TAU));
        let (h_a, h_c) = (triple * cos - (ca + bc) * sin, (1.0 + ab) * sin);
        // The cut c' = 2 (a.h) h / h.h - a = p a + q c.
        let a_h = h_a + h_c * ca;
        let twice = 2.0 * a_h / (h_a * a_h + h_c * (h_a * ca + h_c));
        let (p, q) = (twice * h_a - 1.0, twice * h_c);
        // 1 - cos t = u.y (1 - cos s) along the arc of length s from b to c'; (sin t / sin s)^2 from it without cancelling.
        let cos_s = p * ab + q * bc;
        let cos_t = 1.0 - u.y * (1.0 - cos_s);
        let y = (u.y * (1.0 + cos_t) / (1.0 + cos_s).max(f32::MIN_POSITIVE)).max(0.0).sqrt();
        let x = cos_t - y * cos_s;
        barycentric([y * p * ia, x * ib, y * q * ic])
    }
}

/// Barycentric coordinates of the point in the direction that is the sum of the vectors to the corners with these weights.
#[inline]
fn barycentric(weights: [f32; 3]) -> [f32; 3] {
    let [a, b, c] = weights.map(|weight| weight.max(0.0));
    let sum = a + b + c;
    if !(sum > 0.0 && sum.is_finite()) {
        return [1.0 / 3.0; 3];
    }
    let (b, c) = (b / sum, c / sum);
    [(1.0 - b - c).max(0.0), b, c]
}

/// Solid angle in steradians of the triangle `v` as seen from `p`.
#[inline]
#[must_use]
pub fn spherical_triangle_solid_angle(v: [Point3; 3], p: Point3) -> f32 {
    SphericalTriangle::new(v, p).map_or(0.0, |triangle| triangle.solid_angle)
}

/// Barycentric coordinates of a point of the triangle `v`, uniform by the solid angle seen from `p`, and the density per
/// steradian; `None` if the triangle fills no solid angle.
#[inline]
#[must_use]
pub fn sample_spherical_triangle(v: [Point3; 3], p: Point3, u: Point2) -> Option<([f32; 3], f32)> {
    let t = SphericalTriangle::new(v, p)?;
    Some((t.sample(u), t.pdf_w()))
}

/// The numbers for which [`sample_spherical_triangle`] chooses the direction `w` (within the triangle).
#[must_use]
pub fn invert_spherical_triangle(v: [Point3; 3], p: Point3, w: Vector3) -> Option<Point2> {
    invert(v.map(|v| dvec(v - p)), dvec(w))
}

fn dvec(v: Vector3) -> DVec3 {
    DVec3::new(v.x.into(), v.y.into(), v.z.into())
}

fn invert(corners: [DVec3; 3], w: DVec3) -> Option<Point2> {
    let [a, b, c] = corners.map(DVec3::try_normalize);
    let (a, b, c, w) = (a?, b?, c?, w.try_normalize()?);
    // The cut is where the great circle through B and w meets the one through A and C.
    let mut cut = b.cross(w - b).cross(c.cross(a - c)).try_normalize().unwrap_or(a);
    if cut.dot(a + c) < 0.0 {
        cut = -cut;
    }
    let share = solid_angle(a, b, cut) / solid_angle(a, b, c);
    // 1 - cos as half the squared chord, which does not cancel.
    let whole = (cut - b).length_squared();
    let height = if whole > 0.0 { (w - b).length_squared() / whole } else { 0.0 };
    let unit = |x: f64| (x as f32).clamp(0.0, ONE_MINUS_EPSILON);
    Some(Point2::new(unit(share), unit(height)))
}

fn solid_angle(a: DVec3, b: DVec3, c: DVec3) -> f64 {
    let triple = a.dot((b - a).cross(c - a)).abs();
    2.0 * triple.atan2(1.0 + a.dot(b) + b.dot(c) + c.dot(a))
}

#[cfg(test)]
mod tests;
