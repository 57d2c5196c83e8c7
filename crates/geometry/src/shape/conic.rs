//! Cones, paraboloids and hyperboloids: surfaces x² + y² = q(z) with a quadratic q, cut by z and azimuth.
//!
//! Each is a profile turned about z: a segment for cones and hyperboloids (the two straight lines through each point of
//! a hyperboloid were Wren's discovery, 1669; RenderMan's and pbrt's form), a parabola for paraboloids. A segment askew
//! to the axis turns the profile: its azimuth changes with z. u = phi / phi_max from the profile on, v = 0 at its start and
//! 1 at its end, linear in z.
//!
//! A strip of height dz has the area phi_max sqrt(q + q'²/4) dz, since r = sqrt(q) and r' = q' / 2r; the root of a quadratic
//! is integrated in closed form and inverted by Newton's method.

use std::f64::consts::TAU;

use etendue_math::Point2;
use glam::{DVec2, DVec3};

use super::quadric::{QuadricPoint, QuadricSample};
use super::{Candidate, Candidates};
use crate::double;

/// A quadric of revolution about z.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Conic {
    profile: Profile,
    phi_max: f64,
    /// The middle of its extent along z; q counts z from there.
    z_centre: f64,
    /// Half the extent along z.
    half_height: f64,
    /// q(z) = q[0] + q[1] z + q[2] z².
    q: [f64; 3],
}

/// What is turned about z, by v in [0, 1].
#[derive(Clone, Copy, Debug)]
enum Profile {
    /// The segment between two points.
    Segment(DVec3, DVec3),
    /// x² = a² z for z between these.
    Parabola { a2: f64, z_min: f64, z_max: f64 },
}

/// A point of the profile with its derivatives by v: across the axis, and along it.
#[derive(Clone, Copy, Debug)]
struct ProfilePoint {
    xy: DVec2,
    d_xy: DVec2,
    d2_xy: DVec2,
    d_z: f64,
}

impl Conic {
    /// The surface that the segment from `p1` to `p2` describes about z.
    pub(crate) fn hyperboloid(p1: DVec3, p2: DVec3, phi_max: f64) -> Self {
        let middle = 0.5 * (p1 + p2);
        let slope = (p2 - p1).truncate() / (p2.z - p1.z);
        let q =
            [middle.truncate().length_squared(), 2.0 * middle.truncate().dot(slope), slope.length_squared()];
        Self {
            profile: Profile::Segment(p1, p2),
            phi_max: super::clamp_azimuth(phi_max),
            z_centre: middle.z,
            half_height: 0.5 * (p2.z - p1.z).abs(),
            q,
        }
    }

    /// The cone of this radius at z = 0 with its tip at z = `height`.
    pub(crate) fn cone(radius: f64, height: f64, phi_max: f64) -> Self {
        Self::hyperboloid(DVec3::new(radius.abs(), 0.0, 0.0), DVec3::new(0.0, 0.0, height), phi_max)
    }

    /// The paraboloid x² + y² = a² z for z in [`z_min`, `z_max`], which begins at 0 at the least.
    pub(crate) fn paraboloid(a: f64, z_min: f64, z_max: f64, phi_max: f64) -> Self {
        let (z_min, z_max) = (z_min.min(z_max).max(0.0), z_min.max(z_max).max(0.0));
        let a2 = a * a;
        let z_centre = 0.5 * (z_min + z_max);
        Self {
            profile: Profile::Parabola { a2, z_min, z_max },
            phi_max: super::clamp_azimuth(phi_max),
            z_centre,
            half_height: 0.5 * (z_max - z_min),
            q: [a2 * z_centre, a2, 0.0],
        }
    }

    /// The square of the radius, z from the middle.
    fn q(&self, z: f64) -> f64 {
        self.q[0] + z * (self.q[1] + z * self.q[2])
    }

    /// Half the derivative of the square of the radius.
    fn half_slope(&self, z: f64) -> f64 {
        0.5 * self.q[1] + z * self.q[2]
    }

    pub(crate) fn bounds(&self) -> (DVec3, DVec3) {
        // q is convex or linear, so that an end is widest.
        let r = self.q(-self.half_height).max(self.q(self.half_height)).sqrt();
        let (low, high) = (self.z_centre - self.half_height, self.z_centre + self.half_height);
        (DVec3::new(-r, -r, low), DVec3::new(r, r, high))
    }

    fn v(&self, z: f64) -> f64 {
        match self.profile {
            Profile::Segment(p1, p2) => (z - p1.z) / (p2.z - p1.z),
            Profile::Parabola { z_min, z_max, .. } => (z - z_min) / (z_max - z_min),
        }
    }

    fn profile(&self, v: f64) -> ProfilePoint {
        match self.profile {
            Profile::Segment(p1, p2) => {
                let d = p2 - p1;
                ProfilePoint { xy: (p1 + v * d).truncate(), d_xy: d.truncate(), d2_xy: DVec2::ZERO, d_z: d.z }
            }
            Profile::Parabola { a2, z_min, z_max } => {
                let d_z = z_max - z_min;
                // At the vertex the profile is upright; a tiny ring keeps derivatives finite.
                let r = (a2 * (z_min + v * d_z)).max(1e-10 * a2 * z_max).sqrt();
                let slope = 0.5 * a2 / r;
                ProfilePoint {
                    xy: DVec2::new(r, 0.0),
                    d_xy: DVec2::new(slope * d_z, 0.0),
                    d2_xy: DVec2::new(-slope * slope / r * d_z * d_z, 0.0),
                    d_z,
                }
            }
        }
    }

    /// Texture coordinates of a point on the surface.
    fn uv(&self, p: DVec3) -> [f64; 2] {
        let v = self.v(p.z);
        let (xy, q) = (self.profile(v).xy, p.truncate());
        let phi = xy.perp_dot(q).atan2(xy.dot(q));
        let phi = if phi < 0.0 { phi + TAU } else { phi };
        [phi / self.phi_max, v]
    }

    pub(crate) fn intersect(&self, origin: DVec3, direction: DVec3) -> Candidates {
        let mut result = [None; 2];
        let d = direction;
        let o = origin - self.z_centre * DVec3::Z;
        // From the point of the ray that is nearest to the middle, numbers stay small however far the origin is.
        let nearest = -o.dot(d) / d.length_squared();
        let o = o + d * nearest;
        let a = d.truncate().length_squared() - self.q[2] * d.z * d.z;
        let b = o.truncate().dot(d.truncate()) - self.half_slope(o.z) * d.z;
        let c = o.truncate().length_squared() - self.q(o.z);
        for (slot, root) in quadratic_roots(a, b, c).into_iter().enumerate() {
            let mut p = o + d * root;
            p.z += self.z_centre;
            result[slot] = self.candidate(p, nearest + root);
        }
        result
    }

    fn candidate(&self, p: DVec3, t: f64) -> Option<Candidate> {
        let [u, v] = self.uv(p);
        let inside = (p.z - self.z_centre).abs() <= self.half_height && u <= 1.0;
        (t > 0.0 && t.is_finite() && inside).then_some(Candidate { t, u, v })
    }

    /// Half the gradient of x² + y² - q(z): to the outside, away from the axis.
    fn half_gradient(&self, p: DVec3) -> DVec3 {
        DVec3::new(p.x, p.y, -self.half_slope(p.z - self.z_centre))
    }

    pub(crate) fn surface(&self, mut p: DVec3) -> QuadricPoint {
        // Newton's steps along the gradient; near the tip of a cone, where that vanishes, they shorten too.
        for _ in 0..2 {
            let f = p.truncate().length_squared() - self.q(p.z - self.z_centre);
            let gradient = self.half_gradient(p);
            let step = gradient * (0.5 * f / gradient.length_squared());
            p -= if step.is_finite() { step } else { DVec3::ZERO };
        }
        let n = self.half_gradient(p).try_normalize().unwrap_or(DVec3::Z);
        let profile = self.profile(self.v(p.z));
        // The turn from the profile to the point.
        let turn = DVec2::new(profile.xy.dot(p.truncate()), profile.xy.perp_dot(p.truncate()));
        let turn = turn.try_normalize().unwrap_or(DVec2::X);
        let ring = if p.truncate() == DVec2::ZERO { turn * 1e-5 * self.bounds().1.x } else { p.truncate() };
        let across = |v: DVec2| turn.rotate(v).extend(0.0);
        let turned = |v: DVec3| self.phi_max * DVec3::new(-v.y, v.x, 0.0);
        let dpdu = turned(ring.extend(0.0));
        let dpdv = across(profile.d_xy) + profile.d_z * DVec3::Z;
        let second = [-self.phi_max * self.phi_max * ring.extend(0.0), turned(dpdv), across(profile.d2_xy)];
        let (dndu, dndv) = super::weingarten(dpdu, dpdv, n, second);
        QuadricPoint { p, n, dpdu, dpdv, dndu: double::vector(dndu), dndv: double::vector(dndv) }
    }

    /// The coefficients of q + q'²/4.
    fn stretch(&self) -> [f64; 3] {
        let [q0, q1, q2] = self.q;
        [q0 + 0.25 * q1 * q1, q1 * (1.0 + q2), q2 * (1.0 + q2)]
    }

    pub(crate) fn area(&self) -> f64 {
        let integral = RootIntegral::new(self.stretch(), self.half_height);
        self.phi_max * (integral.at(self.half_height) - integral.at(-self.half_height))
    }

    pub(crate) fn sample(&self, u: Point2) -> QuadricSample {
        let z = RootIntegral::new(self.stretch(), self.half_height).invert(f64::from(u.x)) + self.z_centre;
        let phi = self.phi_max * f64::from(u.y);
        let v = self.v(z);
        let radius = self.q(z - self.z_centre).max(0.0).sqrt();
        let profile = self.profile(v).xy.try_normalize().unwrap_or(DVec2::X) * radius;
        let p = DVec2::from_angle(phi).rotate(profile).extend(z);
        let n = self.half_gradient(p).try_normalize().unwrap_or(DVec3::Z);
        QuadricSample { p, n, uv: [f64::from(u.y), v] }
    }
}

/// The roots of a t² + 2 b t + c in rising order, NaN or infinite where there is none.
fn quadratic_roots(a: f64, b: f64, c: f64) -> [f64; 2] {
    let discriminant = b * b - a * c;
    if discriminant < 0.0 {
        return [f64::NAN; 2];
    }
    let q = -b - discriminant.sqrt().copysign(b);
    let (t0, t1) = if q == 0.0 { (0.0 / a, f64::NAN) } else { (q / a, c / q) };
    if t1 < t0 { [t1, t0] } else { [t0, t1] }
}

/// The integral of sqrt(s0 + s1 z + s2 z²), which is nowhere negative, over [-h, h].
#[derive(Clone, Copy, Debug)]
struct RootIntegral {
    s: [f64; 3],
    h: f64,
}

impl RootIntegral {
    /// Terms too small to matter are dropped: the closed forms that divide by them would lose more.
    fn new(s: [f64; 3], h: f64) -> Self {
        let [s0, mut s1, mut s2] = s;
        let largest = s0 + s1.abs() * h + s2 * h * h;
        if s2 * h * h < 1e-6 * largest {
            s2 = 0.0;
        }
        if s1.abs() * h < 1e-8 * largest {
            s1 = 0.0;
        }
        Self { s: [s0, s1, s2], h }
    }

    fn square(&self, z: f64) -> f64 {
        (self.s[0] + z * (self.s[1] + z * self.s[2])).max(0.0)
    }

    /// An antiderivative.
    fn at(&self, z: f64) -> f64 {
        let [s0, s1, s2] = self.s;
        if s2 > 0.0 {
            // s2 (w² + kappa): (w sqrt(w² + kappa) + kappa asinh(w / sqrt(kappa))) sqrt(s2) / 2.
            let w = z + 0.5 * s1 / s2;
            let kappa = ((s0 - 0.25 * s1 * s1 / s2) / s2).max(0.0);
            let bent = if kappa > 0.0 { kappa * (w / kappa.sqrt()).asinh() } else { 0.0 };
            return 0.5 * s2.sqrt() * (w * (w * w + kappa).sqrt() + bent);
        }
        if s1 != 0.0 { self.square(z).powf(1.5) / (1.5 * s1) } else { s0.sqrt() * z }
    }

    /// The z below which a share `u` of the integral lies.
    fn invert(&self, u: f64) -> f64 {
        let (mut low, mut high) = (-self.h, self.h);
        let start = self.at(low);
        let target = u * (self.at(high) - start);
        let mut z = low + u * (high - low);
        for _ in 0..60 {
            let excess = self.at(z) - start - target;
            if excess > 0.0 {
                high = z;
            } else {
                low = z;
            }
            let newton = z - excess / self.square(z).sqrt();
            let next = if newton > low && newton < high { newton } else { 0.5 * (low + high) };
            if (next - z).abs() <= 1e-14 * self.h {
                break;
            }
            z = next;
        }
        z
    }
}
