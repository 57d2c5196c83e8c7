//! Rectangles by the solid angle that they fill as seen from a point (Ureña, Fajardo and King 2013, "An Area-Preserving
//! Parametrization for Spherical Rectangles"). In double precision, since the spherical excess cancels for small ones.

use glam::DVec3;

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
    k: f64,
    solid_angle: f64,
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
        let angle = |a: f64, b: f64| (-a * b).clamp(-1.0, 1.0).acos();
        let (g0, g1, g2, g3) = (angle(n0, n1), angle(n1, n2), angle(n2, n3), angle(n3, n0));
        let k = std::f64::consts::TAU - g2 - g3;
        let solid_angle = g0 + g1 - k;
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
            k,
            solid_angle,
        })
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
        let (u, v) = (f64::from(u.x), f64::from(u.y));
        // The cut that leaves the share u of the solid angle.
        let au = u * self.solid_angle + self.k;
        let fu = (au.cos() * self.b0 - self.b1) / au.sin();
        let cu = (1.0_f64.copysign(fu) / (fu * fu + self.b0 * self.b0).sqrt()).clamp(-1.0, 1.0);
        let xu = (-(cu * self.z0) / (1.0 - cu * cu).max(1e-24).sqrt()).clamp(self.x0, self.x1);
        // The height on the cut.
        let d2 = xu * xu + self.z0 * self.z0;
        let h0 = self.y0 / (d2 + self.y0 * self.y0).sqrt();
        let h1 = self.y1 / (d2 + self.y1 * self.y1).sqrt();
        let hv = h0 + v * (h1 - h0);
        let yv = if hv * hv < 1.0 - 1e-12 { hv * (d2 / (1.0 - hv * hv)).sqrt() } else { self.y1 };
        [xu, yv.clamp(self.y0, self.y1)]
    }

    /// The numbers for which [`sample`](Self::sample) chooses the point `q` of the rectangle.
    #[must_use]
    pub fn invert(&self, q: Point3) -> Point2 {
        let d = dvec(q.as_vector()) - self.origin;
        let xu = d.dot(self.x).clamp(self.x0, self.x1);
        let yv = d.dot(self.y).clamp(self.y0, self.y1);
        let part = Self { x1: xu, ..*self }.recomputed_solid_angle();
        let d2 = xu * xu + self.z0 * self.z0;
        let h = |y: f64| y / (d2 + y * y).sqrt();
        let v = (h(yv) - h(self.y0)) / (h(self.y1) - h(self.y0));
        let unit = |x: f64| (x as f32).clamp(0.0, ONE_MINUS_EPSILON);
        Point2::new(unit(part / self.solid_angle), unit(v))
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
