//! Tori: a circle of radius r at distance R >= r from the z axis, turned about it.
//!
//! (|p|² + R² - r²)² = 4 R² (x² + y²). On a ray that is a quartic in t; from the point of the ray that is nearest to the
//! centre, and with the size of the torus as unit, its coefficients are of order one, and all of its roots are found
//! between those of its derivative ([`etendue_math::polynomial`]). u = phi / phi_max about the axis, v = (theta - theta_min) /
//! (theta_max - theta_min) about the tube, theta from the outermost circle towards +z.

use std::f64::consts::TAU;

use etendue_math::Point2;
use etendue_math::polynomial::real_roots;
use glam::{DVec2, DVec3};

use super::quadric::{QuadricPoint, QuadricSample};
use super::{Candidate, Candidates, azimuth};

/// A torus about the z axis, or a part of it.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Torus {
    major: f64,
    minor: f64,
    theta_min: f64,
    theta_max: f64,
    phi_max: f64,
}

impl Torus {
    /// A torus; the tube spans from `theta_min` to `theta_max`, at most one turn.
    pub(crate) fn new(major: f64, minor: f64, theta_min: f64, theta_max: f64, phi_max: f64) -> Self {
        let (low, high) = (theta_min.min(theta_max), theta_min.max(theta_max));
        let is_whole = high - low >= TAU * (1.0 - 1e-6);
        Self {
            major: major.abs(),
            minor: minor.abs(),
            theta_min: low,
            theta_max: if is_whole { low + TAU } else { high },
            phi_max: super::clamp_azimuth(phi_max),
        }
    }

    pub(crate) fn bounds(&self) -> (DVec3, DVec3) {
        let corner = DVec3::new(self.major + self.minor, self.major + self.minor, self.minor);
        (-corner, corner)
    }

    /// About the tube, from `theta_min` on, less than a turn.
    fn theta(&self, p: DVec3) -> f64 {
        let theta = p.z.atan2(p.truncate().length() - self.major);
        self.theta_min + (theta - self.theta_min).rem_euclid(TAU)
    }

    fn uv(&self, p: DVec3) -> [f64; 2] {
        let v = (self.theta(p) - self.theta_min) / (self.theta_max - self.theta_min);
        [azimuth(p) / self.phi_max, v]
    }

    /// The first two hits in order of t.
    pub(crate) fn intersect(&self, origin: DVec3, direction: DVec3) -> Candidates {
        let [first, second, ..] = self.hits(origin, direction);
        [first, second]
    }

    /// The third and the fourth hit.
    pub(crate) fn intersect_further(&self, origin: DVec3, direction: DVec3) -> Candidates {
        let [.., third, fourth] = self.hits(origin, direction);
        [third, fourth]
    }

    /// All hits in order of t.
    fn hits(&self, origin: DVec3, direction: DVec3) -> [Option<Candidate>; 4] {
        let mut hits = [None; 4];
        let size = self.major + self.minor;
        let speed = direction.length();
        let d = direction / speed;
        let nearest = -origin.dot(d);
        let o = (origin + d * nearest) / size;
        let half_chord = 1.0 - o.length_squared();
        if half_chord < 0.0 || !half_chord.is_finite() {
            return hits;
        }
        let reach = half_chord.sqrt() * (1.0 + 1e-9) + 1e-9;
        let roots = real_roots(&self.quartic(o, d), -reach, reach);
        let mut n = 0;
        for root in roots.as_slice() {
            let t = (nearest + root * size) / speed;
            let [u, v] = self.uv((o + d * *root) * size);
            if t > 0.0 && u <= 1.0 && v <= 1.0 {
                hits[n] = Some(Candidate { t, u, v });
                n += 1;
            }
        }
        hits
    }

    /// The torus along a ray whose origin is perpendicular to its unit direction, in units of the size.
    fn quartic(&self, o: DVec3, d: DVec3) -> [f64; 5] {
        let size = self.major + self.minor;
        let (major, minor) = (self.major / size, self.minor / size);
        let from_axis = o.truncate().length();
        let k = o.length_squared() + (major - minor) * (major + minor);
        let four = 4.0 * major * major;
        // The value at the origin, as a product of distances to the two circles of the tube in the plane of o and the axis.
        let to_circle = |x: f64| {
            let distance = x.hypot(o.z);
            (distance - minor) * (distance + minor)
        };
        [
            to_circle(from_axis - major) * to_circle(from_axis + major),
            -2.0 * four * o.truncate().dot(d.truncate()),
            2.0 * k - four * d.truncate().length_squared(),
            0.0,
            1.0,
        ]
    }

    /// The point at the end of the tube's radius towards `p`.
    pub(crate) fn surface(&self, p: DVec3) -> QuadricPoint {
        let out = p.truncate().try_normalize().unwrap_or(DVec2::X).extend(0.0);
        let centre = self.major * out;
        let n = (p - centre).try_normalize().unwrap_or(out);
        let p = centre + self.minor * n;
        let around = DVec3::new(-out.y, out.x, 0.0);
        let span = self.theta_max - self.theta_min;
        let along = DVec3::Z * n.dot(out) - out * n.z;
        // On the axis, where a torus with R = r meets itself, a tiny ring keeps the direction.
        let ring = p.truncate().length().max(1e-5 * self.minor);
        let dpdu = self.phi_max * ring * around;
        let dpdv = span * self.minor * along;
        QuadricPoint { p, n, dpdu, dpdv, dndu: self.phi_max * n.dot(out) * around, dndv: span * along }
    }

    /// The integral of R + r cos(theta) from the start of the tube.
    fn ring_integral(&self, theta: f64) -> f64 {
        self.major * (theta - self.theta_min) + self.minor * (theta.sin() - self.theta_min.sin())
    }

    pub(crate) fn area(&self) -> f64 {
        self.phi_max * self.minor * self.ring_integral(self.theta_max)
    }

    pub(crate) fn sample(&self, u: Point2) -> QuadricSample {
        let theta = self.sample_theta(f64::from(u.x));
        let phi = self.phi_max * f64::from(u.y);
        let out = DVec2::from_angle(phi).extend(0.0);
        let n = out * theta.cos() + DVec3::Z * theta.sin();
        let v = (theta - self.theta_min) / (self.theta_max - self.theta_min);
        QuadricSample { p: self.major * out + self.minor * n, n, uv: [f64::from(u.y), v] }
    }

    /// The angle before which a share `u` of the area lies, by Newton's method within a shrinking bracket.
    fn sample_theta(&self, u: f64) -> f64 {
        let target = u * self.ring_integral(self.theta_max);
        let (mut low, mut high) = (self.theta_min, self.theta_max);
        let mut theta = low + u * (high - low);
        for _ in 0..60 {
            let excess = self.ring_integral(theta) - target;
            if excess > 0.0 {
                high = theta;
            } else {
                low = theta;
            }
            let newton = theta - excess / (self.major + self.minor * theta.cos());
            let next = if newton > low && newton < high { newton } else { 0.5 * (low + high) };
            if (next - theta).abs() <= 1e-14 {
                break;
            }
            theta = next;
        }
        theta
    }
}
