//! Triangles and rectangles on the sphere of directions, sampled uniformly in solid angle.
//!
//! Triangle: Arvo 1995, "Stratified Sampling of Spherical Triangles". Rectangle: Ureña, Fajardo and King 2013, "An
//! Area-Preserving Parametrization for Spherical Rectangles". Both in double precision, because angles of narrow
//! shapes cancel.

use std::f64::consts::{PI, TAU};

use glam::DVec3;

/// A triangle seen from a point.
#[derive(Clone, Debug)]
pub(crate) struct SphericalTriangle {
    corners: [DVec3; 3],
    origin: DVec3,
    /// Unit directions to the corners.
    directions: [DVec3; 3],
    solid_angle: f64,
}

impl SphericalTriangle {
    /// The view of a triangle from `origin`; `None` if there is none.
    pub(crate) fn new(corners: &[DVec3; 3], origin: DVec3) -> Option<Self> {
        let mut directions = [DVec3::ZERO; 3];
        for (direction, corner) in directions.iter_mut().zip(corners) {
            *direction = (*corner - origin).try_normalize()?;
        }
        let [a, b, c] = directions;
        // Van Oosterom and Strackee 1983, "The Solid Angle of a Plane Triangle".
        let numerator = a.dot(b.cross(c)).abs();
        let solid_angle = 2.0 * numerator.atan2(1.0 + a.dot(b) + b.dot(c) + c.dot(a));
        let solid_angle = if solid_angle < 0.0 { solid_angle + TAU } else { solid_angle };
        (solid_angle > 0.0).then_some(Self { corners: *corners, origin, directions, solid_angle })
    }

    /// In steradians.
    pub(crate) const fn solid_angle(&self) -> f64 {
        self.solid_angle
    }

    /// Barycentric weights of the second and third corner of a point uniform in solid angle.
    pub(crate) fn sample(&self, u: [f64; 2]) -> [f64; 2] {
        self.barycentrics(self.direction(u))
    }

    fn direction(&self, u: [f64; 2]) -> DVec3 {
        let [a, b, c] = self.directions;
        let reject = |v: DVec3, w: DVec3| (v - w * v.dot(w)).normalize_or(w.any_orthonormal_vector());
        // Angle at a between the great circles to b and c.
        let (ab, ac) = (reject(b, a), reject(c, a));
        let cos_alpha = ab.dot(ac).clamp(-1.0, 1.0);
        let sin_alpha = ab.cross(ac).length();
        let alpha = sin_alpha.atan2(cos_alpha);
        // The smaller triangle of area u0 * solid angle that shares the side ab.
        let phi = u[0] * self.solid_angle - alpha;
        let (sin_phi, cos_phi) = phi.sin_cos();
        let k1 = cos_phi - cos_alpha;
        let k2 = sin_phi + sin_alpha * a.dot(b);
        let numerator = (k2 * cos_phi - k1 * sin_phi) * cos_alpha - k2;
        let denominator = (k2 * sin_phi + k1 * cos_phi) * sin_alpha;
        let cos_beta = if denominator == 0.0 { 1.0 } else { (numerator / denominator).clamp(-1.0, 1.0) };
        let sin_beta = (1.0 - cos_beta * cos_beta).max(0.0).sqrt();
        let c_new = a * cos_beta + ac * sin_beta;
        let cos_theta = 1.0 - u[1] * (1.0 - c_new.dot(b));
        let sin_theta = (1.0 - cos_theta * cos_theta).max(0.0).sqrt();
        b * cos_theta + reject(c_new, b) * sin_theta
    }

    /// Where a direction meets the plane of the triangle (Moeller and Trumbore 1997), clamped into it.
    fn barycentrics(&self, w: DVec3) -> [f64; 2] {
        let [p0, p1, p2] = self.corners;
        let (e1, e2) = (p1 - p0, p2 - p0);
        let s1 = w.cross(e2);
        let divisor = s1.dot(e1);
        if divisor == 0.0 {
            return [1.0 / 3.0; 2];
        }
        let s = self.origin - p0;
        let b1 = (s.dot(s1) / divisor).clamp(0.0, 1.0);
        let b2 = (w.dot(s.cross(e1)) / divisor).clamp(0.0, 1.0);
        let sum = b1 + b2;
        if sum > 1.0 { [b1 / sum, b2 / sum] } else { [b1, b2] }
    }
}

/// A rectangle seen from a point; names as in the paper.
#[derive(Clone, Debug)]
pub(crate) struct SphericalRectangle {
    x0: f64,
    x1: f64,
    y0: f64,
    y1: f64,
    z0: f64,
    b0: f64,
    b1: f64,
    k: f64,
    solid_angle: f64,
}

impl SphericalRectangle {
    /// The rectangle `corner + s * side_x + t * side_y` with s, t in [0, 1] and perpendicular sides.
    pub(crate) fn new(corner: DVec3, side_x: DVec3, side_y: DVec3, origin: DVec3) -> Option<Self> {
        let (x, y) = (side_x.try_normalize()?, side_y.try_normalize()?);
        let d = corner - origin;
        let z0 = -d.dot(x.cross(y)).abs();
        let (x0, y0) = (d.dot(x), d.dot(y));
        let (x1, y1) = (x0 + side_x.length(), y0 + side_y.length());
        // Normals of the planes through the origin and each side: z0 and the coordinate of the side decide.
        let n0 = DVec3::new(0.0, z0, -y0).try_normalize()?;
        let n1 = DVec3::new(-z0, 0.0, x1).try_normalize()?;
        let n2 = DVec3::new(0.0, -z0, y1).try_normalize()?;
        let n3 = DVec3::new(z0, 0.0, -x0).try_normalize()?;
        let angle = |a: DVec3, b: DVec3| (-a.dot(b)).clamp(-1.0, 1.0).acos();
        let k = TAU - angle(n2, n3) - angle(n3, n0);
        let solid_angle = angle(n0, n1) + angle(n1, n2) - k;
        (solid_angle > 0.0).then_some(Self { x0, x1, y0, y1, z0, b0: n0.z, b1: n2.z, k, solid_angle })
    }

    /// In steradians.
    pub(crate) const fn solid_angle(&self) -> f64 {
        self.solid_angle
    }

    /// s and t of a point uniform in solid angle.
    pub(crate) fn sample(&self, u: [f64; 2]) -> [f64; 2] {
        let au = (u[0] * self.solid_angle + self.k).clamp(-4.0 * PI, 4.0 * PI);
        let fu = (au.cos() * self.b0 - self.b1) / au.sin();
        let cu = (1.0 / (fu * fu + self.b0 * self.b0).sqrt()).copysign(fu).clamp(-1.0, 1.0);
        let xu = (-(cu * self.z0) / (1.0 - cu * cu).max(1e-30).sqrt()).clamp(self.x0, self.x1);
        let d2 = xu * xu + self.z0 * self.z0;
        let h0 = self.y0 / (d2 + self.y0 * self.y0).sqrt();
        let h1 = self.y1 / (d2 + self.y1 * self.y1).sqrt();
        let hv = h0 + u[1] * (h1 - h0);
        let yv = if hv * hv < 1.0 - 1e-12 { hv * d2.sqrt() / (1.0 - hv * hv).sqrt() } else { self.y1 };
        let part = |value: f64, low: f64, high: f64| ((value - low) / (high - low)).clamp(0.0, 1.0);
        [part(xu, self.x0, self.x1), part(yv, self.y0, self.y1)]
    }
}
