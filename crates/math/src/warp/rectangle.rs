//! Rectangles by the solid angle that they fill as seen from a point (Ureña, Fajardo and King 2013, "An Area-Preserving
//! Parametrization for Spherical Rectangles").
//!
//! Sums of angles are products of complex numbers, so that one arctangent and one sine with cosine do for the angles at all
//! four corners. Arithmetic in double precision, since the excess over a full turn cancels for small rectangles; the two
//! functions in single precision, since what is left has no more to lose.

use std::f32::consts::TAU;

use glam::DVec3;

use crate::approx::{atan2, sin_cos_turns};
use crate::{ONE_MINUS_EPSILON, Point2, Point3, Vector3};

/// A rectangle as seen from a point, ready to sample directions uniformly.
#[derive(Clone, Copy, Debug)]
pub struct SphericalRectangle {
    origin: DVec3,
    x: DVec3,
    y: DVec3,
    z: DVec3,
    /// Extent in the local frame about the origin, and its height `z0 < 0`.
    x0: f64,
    x1: f64,
    y0: f64,
    y1: f64,
    z0: f64,
    /// z components of the normals of the lower and upper side's planes.
    b0: f64,
    b1: f64,
    /// Of the angle k = 2 pi - g2 - g3 of the paper.
    cos_k: f64,
    sin_k: f64,
    solid_angle: f32,
}

/// The product of complex numbers of length 1: the sum of their angles.
#[inline]
fn turn(a: [f64; 2], b: [f64; 2]) -> [f64; 2] {
    [a[0] * b[0] - a[1] * b[1], a[0] * b[1] + a[1] * b[0]]
}

fn dvec(v: Vector3) -> DVec3 {
    DVec3::new(f64::from(v.x), f64::from(v.y), f64::from(v.z))
}

impl SphericalRectangle {
    /// The rectangle of a corner and two perpendicular edges, as seen from `p`; `None` if it fills no solid angle.
    #[must_use]
    pub fn new(p: Point3, corner: Point3, edge_x: Vector3, edge_y: Vector3) -> Option<Self> {
        let (ex, ey) = (dvec(edge_x), dvec(edge_y));
        let (x, y) = (ex.try_normalize()?, ey.try_normalize()?);
        let mut z = x.cross(y).try_normalize()?;
        let d = dvec(corner - p);
        let mut z0 = d.dot(z);
        if z0 > 0.0 {
            z = -z;
            z0 = -z0;
        }
        let (x0, y0) = (d.dot(x), d.dot(y));
        let (x1, y1) = (x0 + ex.length(), y0 + ey.length());
        let normal_z = |a: f64| a / (a * a + z0 * z0).sqrt();
        // z components of the inward normals of the four planes through p and a side.
        let [n0, n1, n2, n3] = [-normal_z(y0), normal_z(x1), normal_z(y1), -normal_z(x0)];
        // Cosine and sine of the angle at the corner between two sides.
        let angle = |a: f64, b: f64| [-a * b, (1.0 - (a * b) * (a * b)).max(0.0).sqrt()];
        let (g01, g23) = (turn(angle(n0, n1), angle(n1, n2)), turn(angle(n2, n3), angle(n3, n0)));
        let [cos, sin] = turn(g01, g23);
        // The excess over the full turn, up to 2 pi; rounding may make nothing less than nothing.
        let angle = atan2(sin as f32, cos as f32);
        let solid_angle = if angle < -1e-9 { angle + TAU } else { angle };
        if z0 == 0.0 || solid_angle.is_nan() || solid_angle <= 1e-10 {
            return None;
        }
        Some(Self {
            origin: dvec(p.as_vector()),
            x,
            y,
            z,
            x0,
            x1,
            y0,
            y1,
            z0,
            b0: n0,
            b1: n2,
            cos_k: g23[0],
            sin_k: -g23[1],
            solid_angle,
        })
    }

    /// Steradians.
    #[must_use]
    pub fn solid_angle(&self) -> f32 {
        self.solid_angle
    }

    /// Density of [`sample`](Self::sample) per steradian.
    #[must_use]
    pub fn pdf_w(&self) -> f32 {
        1.0 / self.solid_angle
    }

    /// A point of the rectangle, uniform by solid angle.
    #[must_use]
    pub fn sample(&self, u: Point2) -> Point3 {
        let [xu, yv] = self.sample_local(u);
        let q = self.origin + self.x * xu + self.y * yv + self.z * self.z0;
        Point3::new(q.x as f32, q.y as f32, q.z as f32)
    }

    /// The same point as shares of the two edges, in [0, 1].
    #[must_use]
    pub fn sample_shares(&self, u: Point2) -> Point2 {
        let [xu, yv] = self.sample_local(u);
        let share = |value: f64, low: f64, high: f64| (((value - low) / (high - low)) as f32).clamp(0.0, 1.0);
        Point2::new(share(xu, self.x0, self.x1), share(yv, self.y0, self.y1))
    }

    /// The same point in the local frame.
    fn sample_local(&self, u: Point2) -> [f64; 2] {
        // The cut that leaves the share u of the solid angle: f = (cos(a) b0 - b1) / sin(a) with a = k + u solid_angle,
        // x = -z0 sign(f) / sqrt(f^2 + b0^2 - 1). Differences to a = k are formed from the half angle.
        let (sin, cos) = sin_cos_turns(u.x * self.solid_angle * (0.5 / TAU));
        let (sin, cos) = (f64::from(sin), f64::from(cos));
        // Of length 1 in double precision too, by Newton's step for the inverse root.
        let scale = 1.5 - 0.5 * (sin * sin + cos * cos);
        let (sin, cos) = (sin * scale, cos * scale);
        let change = [-2.0 * sin * sin, 2.0 * sin * cos];
        let cos_a = self.cos_k * change[0] - self.sin_k * change[1];
        let sin_a = self.sin_k + self.sin_k * change[0] + self.cos_k * change[1];
        let f = (self.cos_k * self.b0 - self.b1) + cos_a * self.b0;
        let rest = f * f - (1.0 - self.b0 * self.b0) * sin_a * sin_a;
        let xu = -self.z0 * sin_a.copysign(f * sin_a) / rest.max(1e-30).sqrt();
        let xu = xu.clamp(self.x0, self.x1);
        // The height on the cut.
        let d2 = xu * xu + self.z0 * self.z0;
        let h0 = self.y0 / (d2 + self.y0 * self.y0).sqrt();
        let h1 = self.y1 / (d2 + self.y1 * self.y1).sqrt();
        let hv = h0 + f64::from(u.y) * (h1 - h0);
        let yv = if hv * hv < 1.0 - 1e-12 { hv * (d2 / (1.0 - hv * hv)).sqrt() } else { self.y1 };
        [xu, yv.clamp(self.y0, self.y1)]
    }

    /// The numbers for which [`sample`](Self::sample) chooses the point `q` of the rectangle.
    #[must_use]
    pub fn invert(&self, q: Point3) -> Point2 {
        let d = dvec(q.as_vector()) - self.origin;
        self.invert_local(d.dot(self.x).clamp(self.x0, self.x1), d.dot(self.y).clamp(self.y0, self.y1))
    }

    fn invert_local(&self, xu: f64, yv: f64) -> Point2 {
        let part = Self { x1: xu, ..*self }.recomputed_solid_angle();
        let d2 = xu * xu + self.z0 * self.z0;
        let h = |y: f64| y / (d2 + y * y).sqrt();
        let v = (h(yv) - h(self.y0)) / (h(self.y1) - h(self.y0));
        let unit = |x: f64| (x as f32).clamp(0.0, ONE_MINUS_EPSILON);
        Point2::new(unit(part / self.recomputed_solid_angle()), unit(v))
    }

    /// Solid angle from the extents: a sum of arctangents over the corners.
    fn recomputed_solid_angle(&self) -> f64 {
        let h = -self.z0;
        let corner = |x: f64, y: f64| (x * y / (h * (x * x + y * y + h * h).sqrt())).atan();
        corner(self.x1, self.y1) - corner(self.x0, self.y1) - corner(self.x1, self.y0)
            + corner(self.x0, self.y0)
    }
}

/// A point of the rectangle of a corner and two perpendicular edges, uniform by the solid angle seen from `p`, and the
/// density per steradian; `None` if it fills no solid angle.
#[must_use]
pub fn sample_spherical_rectangle(
    p: Point3,
    corner: Point3,
    edge_x: Vector3,
    edge_y: Vector3,
    u: Point2,
) -> Option<(Point3, f32)> {
    let rectangle = SphericalRectangle::new(p, corner, edge_x, edge_y)?;
    Some((rectangle.sample(u), rectangle.pdf_w()))
}

#[cfg(test)]
mod tests;
