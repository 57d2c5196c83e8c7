//! A whole sphere that stands anywhere (SPEC GEO-3): all that rays and light ask of it, without its texture coordinates.
//!
//! |o + t d|² = r². With `b = o.d` and `c = o.o - r²` the product of the roots is `c / d.d`, so that the sign of c tells
//! whether the ray starts inside, and which roots are positive follows from it and the sign of b, however they are rounded.
//! The discriminant comes from the distance of the centre to the ray, `r² d.d - |o x d|²`, which avoids the cancellation of
//! b² - a c far away (Haines, Günther and Akenine-Möller 2019, "Precision Improvements for Ray/Sphere Intersection"). In
//! double precision, where no division is needed before a hit is certain.
//!
//! As a lamp it is sampled by the cone of directions in which it is seen (Shirley, Wang and Zimmerman 1996, "Monte Carlo
//! Techniques for Direct Lighting Calculations"), in single precision but for the distance to its surface.

use std::f32::consts::TAU;

use etendue_math::approx::sin_cos_turns;
use etendue_math::warp::sample_cosine_hemisphere;
use etendue_math::{Frame, Point2, Point3, Ray, Vector3};
use glam::DVec3;

use crate::bounding_sphere::BoundingSphere;
use crate::double;
use crate::hit::{Reference, ShapeSample};
use crate::light_sampling::{area_density, solid_angle_density};

/// A whole sphere.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Globe {
    pub(super) centre: Point3,
    pub(super) radius: f32,
    /// -1 if the normal points inwards, else 1.
    pub(super) sign: f32,
    /// Bound of the magnitude of all coordinates.
    pub(super) size: f32,
}

impl Globe {
    pub(super) fn new(centre: Point3, radius: f32, sign: f32) -> Self {
        Self { centre, radius, sign, size: centre.abs().max_element() + radius }
    }

    /// The positive ray parameters where the ray meets the sphere, the nearer first; `None` if it does not.
    #[inline(always)]
    pub(crate) fn intersect(&self, ray: &Ray) -> Option<(f64, Option<f64>)> {
        let o = double::point(ray.origin) - double::point(self.centre);
        let d = double::vector(ray.direction);
        let rr = f64::from(self.radius) * f64::from(self.radius);
        let (b, c) = (o.dot(d), o.length_squared() - rr);
        let is_outside = c > 0.0;
        if is_outside && b >= 0.0 {
            return None;
        }
        let a = d.length_squared();
        let discriminant = a * rr - o.cross(d).length_squared();
        // Of a point inside it is negative by rounding alone.
        if is_outside && discriminant < 0.0 {
            return None;
        }
        let root = discriminant.max(0.0).sqrt();
        if is_outside {
            let q = root - b;
            return Some((c / q, Some(q / a)));
        }
        let t = if b < 0.0 { (root - b) / a } else { -c / (root + b) };
        (t > 0.0).then_some((t, None))
    }

    /// The point of the surface nearest to where the ray is at `t`, before rounding, and the outward normal.
    #[inline(always)]
    pub(super) fn nearest(&self, ray: &Ray, t: f32) -> (DVec3, DVec3) {
        let centre = double::point(self.centre);
        let offset = double::point(ray.origin) + double::vector(ray.direction) * f64::from(t) - centre;
        let length = offset.length();
        let n = if length > 0.0 { offset * (1.0 / length) } else { DVec3::Z };
        (centre + n * f64::from(self.radius), n)
    }

    /// The ball that it bounds, moved outwards by rounding.
    pub(crate) fn ball(&self) -> BoundingSphere {
        BoundingSphere { centre: self.centre, radius: self.radius + 8.0 * f32::EPSILON * self.size }
    }

    /// Area in square metres.
    pub(super) fn area(&self) -> f32 {
        2.0 * TAU * self.radius * self.radius
    }

    /// A point by its outward normal, which has length 1 up to rounding, and its density per area.
    #[inline(always)]
    fn sample_at(&self, n: Vector3, pdf_a: f32) -> ShapeSample {
        ShapeSample {
            p: self.centre + n * self.radius,
            // Rounding of the normal, of two operations and of what the normal lacks in length.
            p_error: Vector3::splat(8.0 * f32::EPSILON * self.size + f32::MIN_POSITIVE),
            n: (n * self.sign).as_normal(),
            uv: Point2::splat(0.0),
            pdf_a,
        }
    }

    /// A point, uniform in area, on a sphere whose axis is +z. Its texture coordinates are left out.
    #[inline]
    pub(super) fn sample_area(&self, u: Point2) -> ShapeSample {
        let z = 1.0 - 2.0 * u.x;
        let ring = (4.0 * u.x * (1.0 - u.x)).max(0.0).sqrt();
        let (sin, cos) = sin_cos_turns(u.y);
        self.sample_at(Vector3::new(ring * cos, ring * sin, z), 1.0 / self.area())
    }

    /// A point whose normal is within a right angle of the unit direction `w`, in proportion to the cosine: its density per area
    /// is `cos / (pi r^2)`.
    #[must_use]
    pub fn sample_facing(&self, w: Vector3, u: Point2) -> ShapeSample {
        let local = sample_cosine_hemisphere(u);
        let n = Frame::from_z(w).to_world(local);
        self.sample_at(n * self.sign, local.z / (0.5 * TAU * self.radius * self.radius))
    }

    /// The cone of directions from `p` to the sphere, unless `p` is inside or may be but for rounding: a point of the sphere
    /// sees all of its inside, on whichever side its coordinates were rounded to.
    #[inline(always)]
    fn cone(&self, p: Point3) -> Option<Cone> {
        let to_centre = double::point(self.centre) - double::point(p);
        let radius = f64::from(self.radius);
        let (dd, rr) = (to_centre.length_squared(), radius * radius);
        let error = double::surface_error(p, f64::from(self.size));
        let error = f64::from(error.x + error.y + error.z);
        // The square of the length of a tangent from p.
        let gap = dd - rr;
        if gap <= error * (2.0 * radius + error) || gap <= 1e-9 * dd {
            return None;
        }
        let inverse = 1.0 / dd;
        let (sin2_max, cos_max) = ((rr * inverse) as f32, ((gap * inverse) as f32).sqrt());
        let one_minus_cos = sin2_max / (1.0 + cos_max);
        let pdf_w = 1.0 / (TAU * one_minus_cos);
        pdf_w.is_finite().then_some(Cone { to_centre, sin2_max, cos_max, one_minus_cos, pdf_w })
    }

    /// A point uniform in solid angle from `reference` with its density per steradian; `None` from inside.
    #[inline(always)]
    pub(super) fn sample_cone(&self, reference: &Reference, u: Point2) -> Option<(ShapeSample, f32)> {
        let cone = self.cone(reference.p)?;
        let mut sample = self.sample_at(cone.normal(u), 0.0);
        sample.pdf_a = area_density(cone.pdf_w, sample.p - reference.p, sample.n);
        Some((sample, cone.pdf_w))
    }

    /// The density per steradian of [`sample_cone`](Self::sample_cone).
    pub(super) fn cone_pdf(&self, p: Point3) -> Option<f32> {
        self.cone(p).map(|cone| cone.pdf_w)
    }

    /// A point as seen from `reference`, with its density per steradian; without texture coordinates.
    #[inline(always)]
    #[must_use]
    pub fn sample_from(&self, reference: &Reference, u: Point2) -> Option<(ShapeSample, f32)> {
        if let Some(sample) = self.sample_cone(reference, u) {
            return Some(sample);
        }
        let sample = self.sample_area(u);
        let pdf_w = solid_angle_density(sample.pdf_a, sample.p - reference.p, sample.n);
        (pdf_w > 0.0).then_some((sample, pdf_w))
    }

    /// The density per steradian of [`sample_from`](Self::sample_from) for a point `p` of the sphere.
    #[inline(always)]
    #[must_use]
    pub fn pdf_from(&self, reference: &Reference, p: Point3) -> f32 {
        match self.cone(reference.p) {
            Some(cone) => cone.pdf_w,
            None => {
                let n = (p - self.centre).normalized().as_normal();
                solid_angle_density(1.0 / self.area(), p - reference.p, n)
            }
        }
    }
}

/// A sphere seen from outside.
#[derive(Clone, Copy, Debug)]
struct Cone {
    to_centre: DVec3,
    /// Of the half angle, 1 - cosine too.
    sin2_max: f32,
    cos_max: f32,
    one_minus_cos: f32,
    pdf_w: f32,
}

impl Cone {
    /// The outward normal of the sphere where a direction uniform in the cone first meets it.
    #[inline(always)]
    fn normal(&self, u: Point2) -> Vector3 {
        let one_minus_cos = self.one_minus_cos * u.x;
        let cos_theta = 1.0 - one_minus_cos;
        let sin_theta = (one_minus_cos * (2.0 - one_minus_cos)).sqrt();
        // sin(theta)^2 / sin(theta_max)^2 is the square of the sine of the angle between direction and normal.
        let ratio = u.x * (2.0 - one_minus_cos) / (1.0 + self.cos_max);
        let cos_beta = (1.0 - ratio).max(0.0).sqrt();
        // The angle at the centre between the viewer and the point, with r and d the radius and the distance:
        // r sin(alpha) = t sin(theta) and t = d cos(theta) - r cos(beta).
        let sin_max = self.sin2_max.sqrt();
        let cos_alpha = ratio * sin_max + cos_theta * cos_beta;
        let sin_alpha = sin_theta * (cos_theta / sin_max - cos_beta);
        let (sin_phi, cos_phi) = sin_cos_turns(u.y);
        let Frame { x, y, z } = Frame::from_z(-double::to_vector(self.to_centre).normalized());
        x * (sin_alpha * cos_phi) + y * (sin_alpha * sin_phi) + z * cos_alpha
    }
}
