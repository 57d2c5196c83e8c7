//! Disks and rings: the plane z = height, cut by radius and azimuth.
//! u = phi / phi_max, v = (radius - r) / (radius - inner radius).

use etendue_math::Point2;
use glam::DVec3;

use super::plane::intersect_plane;
use super::quadric::{QuadricPoint, QuadricSample};
use super::{Candidate, Candidates, azimuth};

/// A flat ring around the z axis.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Disk {
    height: f64,
    radius: f64,
    inner_radius: f64,
    phi_max: f64,
}

impl Disk {
    /// A ring at z = `height`.
    pub(crate) fn new(height: f64, radius: f64, inner_radius: f64, phi_max: f64) -> Self {
        Self {
            height,
            radius: radius.abs(),
            inner_radius: inner_radius.max(0.0).min(radius.abs()),
            phi_max: super::clamp_azimuth(phi_max),
        }
    }

    /// The ring that the segment between two points of equal z describes about z.
    pub(crate) fn swept(p1: DVec3, p2: DVec3, phi_max: f64) -> Self {
        let (p, d) = (p1.truncate(), (p2 - p1).truncate());
        let nearest = (-p.dot(d) / d.length_squared()).clamp(0.0, 1.0);
        let inner = if nearest.is_finite() { (p + d * nearest).length() } else { p.length() };
        Self::new(p1.z, p.length().max(p2.truncate().length()), inner, phi_max)
    }

    pub(crate) const fn bounds(&self) -> (DVec3, DVec3) {
        let r = self.radius;
        (DVec3::new(-r, -r, self.height), DVec3::new(r, r, self.height))
    }

    /// Texture coordinates of a point on the surface.
    pub(crate) fn uv(&self, p: DVec3) -> [f64; 2] {
        let r = p.x.hypot(p.y);
        let width = self.radius - self.inner_radius;
        [azimuth(p) / self.phi_max, if width > 0.0 { (self.radius - r) / width } else { 0.0 }]
    }

    pub(crate) fn intersect(&self, origin: DVec3, direction: DVec3) -> Candidates {
        let candidate = intersect_plane(DVec3::Z, -self.height, origin, direction).and_then(|t| {
            let p = origin + direction * t;
            let r = p.x.hypot(p.y);
            let inside = r <= self.radius && r >= self.inner_radius && azimuth(p) <= self.phi_max;
            let [u, v] = self.uv(p);
            (t > 0.0 && inside).then_some(Candidate { t, u, v })
        });
        [candidate, None]
    }

    pub(crate) fn surface(&self, p: DVec3) -> QuadricPoint {
        let p = DVec3::new(p.x, p.y, self.height);
        let r = p.x.hypot(p.y);
        let outwards = if r > 0.0 { DVec3::new(p.x / r, p.y / r, 0.0) } else { DVec3::X };
        let ring = r.max(1e-5 * self.radius);
        QuadricPoint {
            p,
            n: DVec3::Z,
            dpdu: self.phi_max * ring * DVec3::new(-outwards.y, outwards.x, 0.0),
            dpdv: (self.inner_radius - self.radius) * outwards,
            dndu: DVec3::ZERO,
            dndv: DVec3::ZERO,
        }
    }

    pub(crate) fn area(&self) -> f64 {
        0.5 * self.phi_max * (self.radius * self.radius - self.inner_radius * self.inner_radius)
    }

    pub(crate) fn sample(&self, u: Point2) -> QuadricSample {
        let (outer, inner) = (self.radius * self.radius, self.inner_radius * self.inner_radius);
        let r = (inner + (outer - inner) * f64::from(u.x)).sqrt();
        let phi = self.phi_max * f64::from(u.y);
        let p = DVec3::new(r * phi.cos(), r * phi.sin(), self.height);
        QuadricSample { p, n: DVec3::Z, uv: self.uv(p) }
    }
}
