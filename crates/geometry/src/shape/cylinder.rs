//! Open cylinders around z: x² + y² = r², cut by z and azimuth.
//! u = phi / phi_max, v = (z - z_min) / (z_max - z_min).

use etendue_math::Point2;
use glam::{DVec2, DVec3};

use super::quadric::{QuadricPoint, QuadricSample};
use super::{Candidate, Candidates, azimuth};

/// A tube without lids.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Cylinder {
    radius: f64,
    z_min: f64,
    z_max: f64,
    phi_max: f64,
}

impl Cylinder {
    /// A tube from `z_min` to `z_max`.
    pub(crate) fn new(radius: f64, z_min: f64, z_max: f64, phi_max: f64) -> Self {
        Self {
            radius: radius.abs(),
            z_min: z_min.min(z_max),
            z_max: z_min.max(z_max),
            phi_max: super::clamp_azimuth(phi_max),
        }
    }

    pub(crate) const fn bounds(&self) -> (DVec3, DVec3) {
        let r = self.radius;
        (DVec3::new(-r, -r, self.z_min), DVec3::new(r, r, self.z_max))
    }

    /// Texture coordinates of a point on the surface.
    pub(crate) fn uv(&self, p: DVec3) -> [f64; 2] {
        let height = self.z_max - self.z_min;
        [azimuth(p) / self.phi_max, if height > 0.0 { (p.z - self.z_min) / height } else { 0.0 }]
    }

    pub(crate) fn intersect(&self, origin: DVec3, direction: DVec3) -> Candidates {
        let mut result = [None; 2];
        let (o, d) = (DVec2::new(origin.x, origin.y), DVec2::new(direction.x, direction.y));
        let a = d.length_squared();
        if a == 0.0 {
            return result;
        }
        let b = o.dot(d);
        let to_axis = (o - d * (b / a)).length();
        let discriminant = a * (self.radius + to_axis) * (self.radius - to_axis);
        if discriminant < 0.0 || !discriminant.is_finite() {
            return result;
        }
        let root = discriminant.sqrt();
        let distance = o.length();
        let c = (distance + self.radius) * (distance - self.radius);
        let q = if b < 0.0 { -b + root } else { -b - root };
        let (t0, t1) = if q == 0.0 { (0.0, 0.0) } else { (q / a, c / q) };
        for (slot, t) in [t0.min(t1), t0.max(t1)].into_iter().enumerate() {
            result[slot] = self.candidate(origin + direction * t, t);
        }
        result
    }

    fn candidate(&self, p: DVec3, t: f64) -> Option<Candidate> {
        let inside = p.z >= self.z_min && p.z <= self.z_max && azimuth(p) <= self.phi_max;
        let [u, v] = self.uv(p);
        (t > 0.0 && inside).then_some(Candidate { t, u, v })
    }

    pub(crate) fn surface(&self, p: DVec3) -> QuadricPoint {
        let n = DVec3::new(p.x, p.y, 0.0).try_normalize().unwrap_or(DVec3::X);
        let dpdu = self.phi_max * self.radius * DVec3::new(-n.y, n.x, 0.0);
        QuadricPoint {
            p: DVec3::new(n.x * self.radius, n.y * self.radius, p.z),
            n,
            dpdu,
            dpdv: DVec3::new(0.0, 0.0, self.z_max - self.z_min),
            dndu: dpdu / self.radius,
            dndv: DVec3::ZERO,
        }
    }

    pub(crate) fn area(&self) -> f64 {
        self.phi_max * self.radius * (self.z_max - self.z_min)
    }

    pub(crate) fn sample(&self, u: Point2) -> QuadricSample {
        let z = self.z_min + (self.z_max - self.z_min) * f64::from(u.x);
        let phi = self.phi_max * f64::from(u.y);
        let n = DVec3::new(phi.cos(), phi.sin(), 0.0);
        let p = DVec3::new(n.x * self.radius, n.y * self.radius, z);
        QuadricSample { p, n, uv: self.uv(p) }
    }
}
