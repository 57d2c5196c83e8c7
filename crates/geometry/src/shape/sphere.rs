//! Spheres (SPEC GEO-3), whole or cut by z and azimuth.
//!
//! |o + t d|² = r². The discriminant is computed from the distance of the centre to the ray, which avoids the
//! cancellation of b² - 4ac far away (Pharr et al. 2023, section 6.8.3), all in double precision.
//! u = phi / phi_max, v = (theta - theta(z_min)) / (theta(z_max) - theta(z_min)), theta from +z.

use std::f64::consts::TAU;

use etendue_math::Point2;
use glam::DVec3;

use super::quadric::{QuadricPoint, QuadricSample};
use super::{Candidate, Candidates, azimuth};

/// A sphere around the origin.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Sphere {
    radius: f64,
    z_min: f64,
    z_max: f64,
    theta_z_min: f64,
    theta_z_max: f64,
    phi_max: f64,
}

impl Sphere {
    /// A sphere with z in [`z_min`, `z_max`], cut to its extent, and azimuth up to `phi_max`.
    pub(crate) fn new(radius: f64, z_min: f64, z_max: f64, phi_max: f64) -> Self {
        let radius = radius.abs();
        let (z_min, z_max) =
            (z_min.min(z_max).max(-radius).min(radius), z_min.max(z_max).max(-radius).min(radius));
        Self {
            radius,
            z_min,
            z_max,
            theta_z_min: (z_min / radius).clamp(-1.0, 1.0).acos(),
            theta_z_max: (z_max / radius).clamp(-1.0, 1.0).acos(),
            phi_max: super::clamp_azimuth(phi_max),
        }
    }

    /// A sphere of which nothing is cut off.
    pub(crate) fn whole(radius: f64) -> Self {
        Self::new(radius, -radius, radius, TAU)
    }

    pub(crate) const fn radius(&self) -> f64 {
        self.radius
    }

    /// True if nothing is cut off.
    pub(crate) fn is_whole(&self) -> bool {
        self.z_min <= -self.radius && self.z_max >= self.radius && self.phi_max >= TAU
    }

    pub(crate) fn bounds(&self) -> (DVec3, DVec3) {
        let r = self.radius;
        (DVec3::new(-r, -r, self.z_min), DVec3::new(r, r, self.z_max))
    }

    /// Texture coordinates of a point on the sphere.
    pub(crate) fn uv(&self, p: DVec3) -> [f64; 2] {
        let theta = (p.z / self.radius).clamp(-1.0, 1.0).acos();
        [azimuth(p) / self.phi_max, (theta - self.theta_z_min) / (self.theta_z_max - self.theta_z_min)]
    }

    pub(crate) fn intersect(&self, origin: DVec3, direction: DVec3) -> Candidates {
        let mut result = [None; 2];
        let a = direction.length_squared();
        let b = origin.dot(direction);
        let to_axis = (origin - direction * (b / a)).length();
        let discriminant = a * (self.radius + to_axis) * (self.radius - to_axis);
        if discriminant < 0.0 || !discriminant.is_finite() {
            return result;
        }
        let root = discriminant.sqrt();
        let distance = origin.length();
        let c = (distance + self.radius) * (distance - self.radius);
        let q = if b < 0.0 { -b + root } else { -b - root };
        let (t0, t1) = if q == 0.0 { (0.0, 0.0) } else { (q / a, c / q) };
        for (slot, t) in [t0.min(t1), t0.max(t1)].into_iter().enumerate() {
            result[slot] = self.candidate(origin + direction * t, t);
        }
        result
    }

    fn candidate(&self, p: DVec3, t: f64) -> Option<Candidate> {
        let p = p * (self.radius / p.length());
        let [u, v] = self.uv(p);
        // Rounding may lift a pole above the sphere, where nothing must be cut off.
        let z = p.z.clamp(-self.radius, self.radius);
        let inside = z >= self.z_min && z <= self.z_max && azimuth(p) <= self.phi_max;
        (t > 0.0 && inside).then_some(Candidate { t, u, v })
    }

    pub(crate) fn surface(&self, p: DVec3) -> QuadricPoint {
        let n = p.try_normalize().unwrap_or(DVec3::Z);
        let p = n * self.radius;
        let from_axis = p.x.hypot(p.y);
        let (cos_phi, sin_phi) =
            if from_axis > 0.0 { (p.x / from_axis, p.y / from_axis) } else { (1.0, 0.0) };
        // At the poles the derivative with respect to u vanishes; a tiny ring keeps its direction.
        let ring = from_axis.max(1e-5 * self.radius);
        let dpdu = self.phi_max * ring * DVec3::new(-sin_phi, cos_phi, 0.0);
        let dpdv =
            (self.theta_z_max - self.theta_z_min) * DVec3::new(p.z * cos_phi, p.z * sin_phi, -from_axis);
        QuadricPoint { p, n, dpdu, dpdv, dndu: dpdu / self.radius, dndv: dpdv / self.radius }
    }

    /// Zones of a sphere have the area of the cylinder around them (Archimedes).
    pub(crate) fn area(&self) -> f64 {
        self.phi_max * self.radius * (self.z_max - self.z_min)
    }

    pub(crate) fn sample(&self, u: Point2) -> QuadricSample {
        let z = self.z_max + (self.z_min - self.z_max) * f64::from(u.x);
        let phi = self.phi_max * f64::from(u.y);
        let ring = (self.radius * self.radius - z * z).max(0.0).sqrt();
        let p = DVec3::new(ring * phi.cos(), ring * phi.sin(), z);
        QuadricSample { p, n: p / self.radius, uv: self.uv(p) }
    }
}
