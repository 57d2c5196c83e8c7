//! Triangles: uniformly by area, or by the solid angle that they fill as seen from a point.
//!
//! Arvo 1995, "Stratified Sampling of Spherical Triangles": the first number cuts the spherical triangle ABC by a great
//! circle through B so that the part next to A has the wanted share of the area (Girard: area = alpha + beta + gamma - pi);
//! the second chooses a height on the arc from B to the cut. In double precision, since the excess cancels for small ones.

use glam::DVec3;

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
    corners: [Point3; 3],
    origin: Point3,
    /// Unit directions to the corners.
    a: DVec3,
    b: DVec3,
    c: DVec3,
    /// Steradians.
    solid_angle: f64,
}

fn dvec(v: Vector3) -> DVec3 {
    DVec3::new(f64::from(v.x), f64::from(v.y), f64::from(v.z))
}

impl SphericalTriangle {
    /// The triangle `v` as seen from `p`; `None` if it fills no solid angle.
    #[must_use]
    pub fn new(v: [Point3; 3], p: Point3) -> Option<Self> {
        let a = dvec(v[0] - p).try_normalize()?;
        let b = dvec(v[1] - p).try_normalize()?;
        let c = dvec(v[2] - p).try_normalize()?;
        // tan(area / 2) = |a . (b x c)| / (1 + a.b + b.c + c.a)  [van Oosterom and Strackee 1983]
        let triple = a.dot((b - a).cross(c - a)).abs();
        let solid_angle = 2.0 * triple.atan2(1.0 + a.dot(b) + b.dot(c) + c.dot(a));
        if solid_angle.is_nan() || solid_angle <= 1e-12 {
            return None;
        }
        Some(Self { corners: v, origin: p, a, b, c, solid_angle })
    }

    /// Interior angle at `a`.
    fn alpha(&self) -> Option<f64> {
        let n_ab = self.a.cross(self.b).try_normalize()?;
        let n_ac = self.a.cross(self.c).try_normalize()?;
        Some(n_ab.angle_between(n_ac))
    }

    /// Steradians.
    #[must_use]
    pub fn solid_angle(&self) -> f32 {
        self.solid_angle as f32
    }

    /// Density of [`sample`](Self::sample) per steradian.
    #[must_use]
    pub fn pdf_w(&self) -> f32 {
        (1.0 / self.solid_angle) as f32
    }

    /// Barycentric coordinates of a point of the triangle, uniform by solid angle; `None` where rounding leaves none.
    #[must_use]
    pub fn sample(&self, u: Point2) -> Option<[f32; 3]> {
        let area = f64::from(u.x) * self.solid_angle;
        let alpha = self.alpha()?;
        let (sin_alpha, cos_alpha) = alpha.sin_cos();
        let (s, c) = (area - alpha).sin_cos();
        // The cut C' on the arc from A to C that leaves the area, by its distance from A.  [Arvo, section 3]
        let (k_u, k_v) = (c - cos_alpha, s + sin_alpha * self.a.dot(self.b));
        let numerator = k_v - (k_v * c - k_u * s) * cos_alpha;
        let denominator = (k_v * s + k_u * c) * sin_alpha;
        let cos_b = (-numerator / denominator).clamp(-1.0, 1.0);
        let cos_b = if cos_b.is_nan() { 1.0 } else { cos_b };
        let cut = self.a * cos_b + orthogonal_part(self.c, self.a)? * (1.0 - cos_b * cos_b).sqrt();
        // The height on the arc from B to the cut.
        let one_minus_cos = f64::from(u.y) * (1.0 - cut.dot(self.b));
        let sine = (one_minus_cos * (2.0 - one_minus_cos)).max(0.0).sqrt();
        let w = match orthogonal_part(cut, self.b) {
            Some(across) => self.b * (1.0 - one_minus_cos) + across * sine,
            None => self.b,
        };
        barycentric(self.corners, self.origin, w)
    }
}

/// The component of `v` perpendicular to the unit vector `w`, normalised.
fn orthogonal_part(v: DVec3, w: DVec3) -> Option<DVec3> {
    (v - w * v.dot(w)).try_normalize()
}

/// Solid angle in steradians of the triangle `v` as seen from `p`.
#[must_use]
pub fn spherical_triangle_solid_angle(v: [Point3; 3], p: Point3) -> f32 {
    SphericalTriangle::new(v, p).map_or(0.0, |triangle| triangle.solid_angle as f32)
}

/// Barycentric coordinates of a point of the triangle `v`, uniform by the solid angle seen from `p`, and the density per
/// steradian; `None` if the triangle fills no solid angle.
#[must_use]
pub fn sample_spherical_triangle(v: [Point3; 3], p: Point3, u: Point2) -> Option<([f32; 3], f32)> {
    let t = SphericalTriangle::new(v, p)?;
    Some((t.sample(u)?, t.pdf_w()))
}

/// Barycentric coordinates of the point where the ray from `p` along `w` meets the plane of the triangle.
fn barycentric(v: [Point3; 3], p: Point3, w: DVec3) -> Option<[f32; 3]> {
    let (e1, e2) = (dvec(v[1] - v[0]), dvec(v[2] - v[0]));
    let s1 = w.cross(e2);
    let determinant = s1.dot(e1);
    if determinant == 0.0 {
        return None;
    }
    let s = dvec(p - v[0]);
    let b1 = (s.dot(s1) / determinant).clamp(0.0, 1.0);
    let b2 = (w.dot(s.cross(e1)) / determinant).clamp(0.0, 1.0 - b1);
    Some([(1.0 - b1 - b2) as f32, b1 as f32, b2 as f32])
}

/// The numbers for which [`sample_spherical_triangle`] chooses the direction `w` (of length 1, within the triangle).
#[must_use]
pub fn invert_spherical_triangle(v: [Point3; 3], p: Point3, w: Vector3) -> Option<Point2> {
    let t = SphericalTriangle::new(v, p)?;
    let w = dvec(w).try_normalize()?;
    // The cut is where the great circle through B and w meets the one through A and C.
    let mut cut = t.b.cross(w).cross(t.c.cross(t.a)).try_normalize().unwrap_or(t.a);
    if cut.dot(t.a + t.c) < 0.0 {
        cut = -cut;
    }
    let part = |x: DVec3| {
        let triple = t.a.dot((t.b - t.a).cross(x - t.a)).abs();
        2.0 * triple.atan2(1.0 + t.a.dot(t.b) + t.b.dot(x) + x.dot(t.a))
    };
    let share = part(cut) / t.solid_angle;
    // 1 - cos as half the squared chord, which does not cancel.
    let whole = (cut - t.b).length_squared();
    let height = if whole > 0.0 { (w - t.b).length_squared() / whole } else { 0.0 };
    let unit = |x: f64| (x as f32).clamp(0.0, ONE_MINUS_EPSILON);
    Some(Point2::new(unit(share), unit(height)))
}
