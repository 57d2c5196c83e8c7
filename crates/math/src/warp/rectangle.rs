//! Rectangles by the solid angle that they fill as seen from a point (Ureña, Fajardo and King 2013, "An Area-Preserving
//! Parametrization for Spherical Rectangles").
//!
//! Sums of angles are products of complex numbers, so that one arctangent and one sine with cosine do for the angles of all
//! four corners; the numbers need not have length 1, which saves most square roots and divisions. Arithmetic in double
//! precision, since the angles of small rectangles cancel; the two functions in single precision, since what is left has no
//! more to lose.

use std::f32::consts::TAU;

use glam::DVec3;

use crate::approx::{atan2, sin_cos_turns};
use crate::{ONE_MINUS_EPSILON, Point2, Point3, Vector3};

/// A rectangle in space.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Rectangle {
    corner: Point3,
    /// Unit vectors along the sides.
    x: Vector3,
    y: Vector3,
    /// Lengths of the sides.
    width: f32,
    height: f32,
}

impl Rectangle {
    /// The rectangle of a corner and two perpendicular edges; `None` if it has no area.
    #[must_use]
    pub fn new(corner: Point3, edge_x: Vector3, edge_y: Vector3) -> Option<Self> {
        let (x, y) = (edge_x.try_normalized()?, edge_y.try_normalized()?);
        Some(Self { corner, x, y, width: edge_x.length(), height: edge_y.length() })
    }

    /// The point at these shares of the two edges.
    #[inline]
    #[must_use]
    pub fn at(&self, shares: Point2) -> Point3 {
        self.corner + self.x * (self.width * shares.x) + self.y * (self.height * shares.y)
    }

    /// The unit normal on the side from which the second edge lies to the left of the first.
    #[inline]
    #[must_use]
    pub fn normal(&self) -> Vector3 {
        self.x.cross(self.y)
    }

    /// Area in square metres.
    #[inline]
    #[must_use]
    pub fn area(&self) -> f32 {
        self.width * self.height
    }
}

/// A rectangle as seen from a point, ready to sample directions uniformly.
#[derive(Clone, Copy, Debug)]
pub struct SphericalRectangle {
    rectangle: Rectangle,
    /// Extent in the rectangle's frame about the point, and the distance of the point from its plane.
    x0: f64,
    x1: f64,
    y0: f64,
    y1: f64,
    h: f64,
    /// Distances of the corners at x0.
    r00: f64,
    r01: f64,
    solid_angle: f32,
}

/// The product of complex numbers: the sum of their angles.
#[inline(always)]
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
        Self::seen_from(p, &Rectangle::new(corner, edge_x, edge_y)?)
    }

    /// A rectangle as seen from `p`; `None` if it fills no solid angle.
    #[inline(always)]
    #[must_use]
    pub fn seen_from(p: Point3, rectangle: &Rectangle) -> Option<Self> {
        let d = dvec(rectangle.corner.as_vector()) - dvec(p.as_vector());
        let (x, y) = (dvec(rectangle.x), dvec(rectangle.y));
        let (x0, y0, h) = (d.dot(x), d.dot(y), d.dot(x.cross(y)).abs());
        let (x1, y1) = (x0 + f64::from(rectangle.width), y0 + f64::from(rectangle.height));
        let [xx0, xx1, yy0, yy1, hh] = [x0 * x0, x1 * x1, y0 * y0, y1 * y1, h * h];
        let distance = |xx: f64, yy: f64| (xx + yy + hh).sqrt();
        let [r00, r01, r10, r11] =
            [distance(xx0, yy0), distance(xx0, yy1), distance(xx1, yy0), distance(xx1, yy1)];
        // The solid angle is the sum over the corners of +-atan(x y / (h r)).
        let upper = turn([h * r11, x1 * y1], [h * r01, -x0 * y1]);
        let lower = turn([h * r10, -x1 * y0], [h * r00, x0 * y0]);
        let [cos, sin] = turn(upper, lower);
        let scale = 1.0 / (cos.abs() + sin.abs());
        // Up to 2 pi; rounding may make nothing less than nothing.
        let angle = atan2((sin * scale) as f32, (cos * scale) as f32);
        let solid_angle = if angle < -1e-9 { angle + TAU } else { angle };
        if h == 0.0 || solid_angle.is_nan() || solid_angle <= 1e-10 {
            return None;
        }
        Some(Self { rectangle: *rectangle, x0, x1, y0, y1, h, r00, r01, solid_angle })
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

    /// A point of the rectangle, uniform by solid angle.
    #[must_use]
    pub fn sample(&self, u: Point2) -> Point3 {
        self.rectangle.at(self.sample_shares(u))
    }

    /// The same point as shares of the two edges, in [0, 1].
    #[inline(always)]
    #[must_use]
    pub fn sample_shares(&self, u: Point2) -> Point2 {
        let [xu, yv] = self.sample_local(u);
        let share = |value: f64, low: f64, length: f32| ((value - low) as f32 / length).clamp(0.0, 1.0);
        Point2::new(share(xu, self.x0, self.rectangle.width), share(yv, self.y0, self.rectangle.height))
    }

    /// The same point in the local frame.
    #[inline(always)]
    fn sample_local(&self, u: Point2) -> [f64; 2] {
        let Self { x0, y0, y1, h, r00, r01, .. } = *self;
        let hh = h * h;
        // z components of the normals of the lower and upper side's planes are b0 = -y0 / s0 and b1 = y1 / s1. All that
        // follows is scaled, to divide only once.
        let (s0, s1, xx) = ((y0 * y0 + hh).sqrt(), (y1 * y1 + hh).sqrt(), x0 * x0 + hh);
        let s01 = s0 * s1;
        let scale = s01 * xx;
        // Cosine and sine of k = 2 pi - g2 - g3, where g2 and g3 are the angles at the corners at x0, times the scale.
        let cos_k = -(x0 * x0 * y0 * y1 + hh * r00 * r01);
        let sin_k = x0 * h * (y0 * r01 - y1 * r00);
        // The cut that leaves the share u of the solid angle: f = (cos(a) b0 - b1) / sin(a) with a = k + u solid_angle,
        // x = h sign(f) / sqrt(f^2 + b0^2 - 1). Differences to a = k are formed from the half angle.
        let (sin, cos) = sin_cos_turns(u.x * self.solid_angle * (0.5 / TAU));
        let (sin, cos) = (f64::from(sin), f64::from(cos));
        // Of length 1 in double precision too, by Newton's step for the inverse root.
        let unit = 1.5 - 0.5 * (sin * sin + cos * cos);
        let (sin, cos) = (sin * unit, cos * unit);
        let change = [-2.0 * sin * sin, 2.0 * sin * cos];
        let cos_a = cos_k * change[0] - sin_k * change[1];
        let sin_a = sin_k + sin_k * change[0] + cos_k * change[1];
        // f times the scale and s01, and likewise the root of (1 - b0^2) sin(a)^2.
        let f = (-cos_k * y0 * s1 - y1 * s0 * scale) - cos_a * y0 * s1;
        let shrunk = h * s1 * sin_a;
        let least = 1e-15 * scale * s01;
        let rest = ((f - shrunk) * (f + shrunk)).max(least * least).max(f64::MIN_POSITIVE);
        let along = h * sin_a * s01;
        let x_squared = along * along / rest;
        let xu = x_squared.sqrt().copysign(f * sin_a).clamp(self.x0, self.x1);
        // The height on the cut.
        let d2 = x_squared + hh;
        let (t0, t1) = ((d2 + y0 * y0).sqrt(), (d2 + y1 * y1).sqrt());
        let inverse = 1.0 / (t0 * t1);
        let (h0, h1) = (y0 * t1 * inverse, y1 * t0 * inverse);
        let hv = h0 + f64::from(u.y) * (h1 - h0);
        let yv = if hv * hv < 1.0 - 1e-12 { hv * (d2 / (1.0 - hv * hv)).sqrt() } else { self.y1 };
        [xu, yv.clamp(self.y0, self.y1)]
    }

    /// The numbers for which [`sample`](Self::sample) chooses the point `q` of the rectangle.
    #[must_use]
    pub fn invert(&self, q: Point3) -> Point2 {
        let d = q - self.rectangle.corner;
        let along = |low: f64, axis: Vector3, length: f32| low + f64::from(d.dot(axis).clamp(0.0, length));
        self.invert_local(
            along(self.x0, self.rectangle.x, self.rectangle.width),
            along(self.y0, self.rectangle.y, self.rectangle.height),
        )
    }

    fn invert_local(&self, xu: f64, yv: f64) -> Point2 {
        let part = Self { x1: xu, ..*self }.recomputed_solid_angle();
        let d2 = xu * xu + self.h * self.h;
        let h = |y: f64| y / (d2 + y * y).sqrt();
        let v = (h(yv) - h(self.y0)) / (h(self.y1) - h(self.y0));
        let unit = |x: f64| (x as f32).clamp(0.0, ONE_MINUS_EPSILON);
        Point2::new(unit(part / self.recomputed_solid_angle()), unit(v))
    }

    /// Solid angle from the extents: a sum of arctangents over the corners.
    fn recomputed_solid_angle(&self) -> f64 {
        let h = self.h;
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
