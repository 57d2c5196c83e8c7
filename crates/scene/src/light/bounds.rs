//! What a light tree knows of a light or a group: where it is, and in which directions it emits.
//!
//! A group is a box, and a cone of normals (axis `w`, half angle theta_o) around each of which light leaves within the
//! angle theta_e. From these, an upper bound of the angle terms gives the importance of the group for a point
//! (Conty Estevez and Kulla 2018, "Importance Sampling of Many Lights with Adaptive Tree Splitting", in the variant
//! of pbrt-v4). Two things differ from pbrt-v4: brightness is the peak *intensity*, which compares point lights with
//! surfaces on equal terms, and where rounding could make the importance of a contributing light 0, a small margin
//! keeps it positive.

use std::f32::consts::PI;

use etendue_geometry::Reference;
use etendue_math::{Bounds3, Point3, Vector3, safe_acos};

/// Slack of cosines, so that rounding never hides a light.
const COSINE_MARGIN: f32 = 1e-3;
/// Least factor for the orientation of the receiver.
const MIN_RECEIVER_FACTOR: f32 = 1e-2;

/// A conservative description of where and in which directions a light, or several, emit.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LightBounds {
    /// Box around the positions.
    pub bounds: Bounds3,
    /// Unit axis of the cone of normals.
    pub w: Vector3,
    /// Cosine of the half angle of the cone of normals.
    pub cos_theta_o: f32,
    /// Cosine of the largest angle between a normal and light leaving there.
    pub cos_theta_e: f32,
    /// Peak intensity by the weight of [`LightPower`](super::LightPower): for a surface, radiance times area.
    pub intensity: f32,
    /// True if light leaves on both sides.
    pub two_sided: bool,
}

impl LightBounds {
    /// The neutral element of [`union`](Self::union).
    pub const EMPTY: Self = Self {
        bounds: Bounds3::EMPTY,
        w: Vector3::new(0.0, 0.0, 1.0),
        cos_theta_o: 1.0,
        cos_theta_e: 1.0,
        intensity: 0.0,
        two_sided: false,
    };

    /// A light that emits in all directions from within a box.
    #[must_use]
    pub fn point(bounds: Bounds3, intensity: f64) -> Self {
        Self {
            bounds,
            w: Vector3::new(0.0, 0.0, 1.0),
            cos_theta_o: -1.0,
            cos_theta_e: 0.0,
            intensity: intensity as f32,
            two_sided: false,
        }
    }

    /// Middle of the box.
    #[must_use]
    pub fn centroid(&self) -> Point3 {
        self.bounds.centroid()
    }

    /// The bounds of both.
    #[must_use]
    pub fn union(&self, other: &Self) -> Self {
        if self.bounds.is_empty() {
            return *other;
        }
        if other.bounds.is_empty() {
            return *self;
        }
        let (w, cos_theta_o) = cone_union((self.w, self.cos_theta_o), (other.w, other.cos_theta_o));
        Self {
            bounds: self.bounds.union(other.bounds),
            w,
            cos_theta_o,
            cos_theta_e: self.cos_theta_e.min(other.cos_theta_e),
            intensity: self.intensity + other.intensity,
            two_sided: self.two_sided || other.two_sided,
        }
    }

    /// How much this may contribute at `reference`: an estimate, 0 only if it contributes nothing.
    #[must_use]
    pub fn importance(&self, reference: &Reference) -> f32 {
        if self.intensity <= 0.0 {
            return 0.0;
        }
        let from_light = reference.p - self.centroid();
        let radius_squared = self.bounds.diagonal().length_squared() / 4.0;
        let true_distance_squared = from_light.length_squared();
        let distance_squared = true_distance_squared.max(radius_squared).max(1e-20);
        let Some(wi) = from_light.try_normalized() else {
            return (self.intensity / distance_squared).clamp(1e-30, 1e30);
        };
        // The angle theta_b that the box subtends.
        let (sin_b, cos_b) = if true_distance_squared <= radius_squared {
            (0.0, -1.0)
        } else {
            let sin_squared = radius_squared / true_distance_squared;
            (sin_squared.sqrt(), (1.0 - sin_squared).max(0.0).sqrt())
        };
        // theta' = max(0, theta_w - theta_o - theta_b): the least angle between a normal and a direction to the point.
        let mut cos_w = self.w.dot(wi).clamp(-1.0, 1.0);
        if self.two_sided {
            cos_w = cos_w.abs();
        }
        let (sin_o, cos_o) = (sine(self.cos_theta_o), self.cos_theta_o);
        let (sin_x, cos_x) = subtract_clamped((sine(cos_w), cos_w), (sin_o, cos_o));
        let (_, cos_prime) = subtract_clamped((sin_x, cos_x), (sin_b, cos_b));
        if cos_prime <= self.cos_theta_e - COSINE_MARGIN {
            return 0.0;
        }
        let mut importance = self.intensity * cos_prime.max(COSINE_MARGIN) / distance_squared;
        if let Some(n) = reference.n {
            let cos_i = wi.abs_dot_normal(n).min(1.0);
            let (_, cos_i_prime) = subtract_clamped((sine(cos_i), cos_i), (sin_b, cos_b));
            importance *= cos_i_prime.max(MIN_RECEIVER_FACTOR);
        }
        importance.clamp(1e-30, 1e30)
    }
}

fn sine(cosine: f32) -> f32 {
    (1.0 - cosine * cosine).max(0.0).sqrt()
}

/// Sine and cosine of max(0, a - b), for angles in [0, pi] given by sine and cosine.
fn subtract_clamped((sin_a, cos_a): (f32, f32), (sin_b, cos_b): (f32, f32)) -> (f32, f32) {
    if cos_a > cos_b {
        return (0.0, 1.0);
    }
    (sin_a * cos_b - cos_a * sin_b, cos_a * cos_b + sin_a * sin_b)
}

/// A cone (axis, cosine of half angle) that holds both.
fn cone_union((w_a, cos_a): (Vector3, f32), (w_b, cos_b): (Vector3, f32)) -> (Vector3, f32) {
    let (theta_a, theta_b) = (safe_acos(cos_a), safe_acos(cos_b));
    let between = w_a.angle_between(w_b);
    if (between + theta_b).min(PI) <= theta_a {
        return (w_a, cos_a);
    }
    if (between + theta_a).min(PI) <= theta_b {
        return (w_b, cos_b);
    }
    let theta = (theta_a + between + theta_b) / 2.0;
    let everything = (w_a, -1.0);
    if theta >= PI {
        return everything;
    }
    let Some(axis) = w_a.cross(w_b).try_normalized() else { return everything };
    let (sin_r, cos_r) = (theta - theta_a).sin_cos();
    ((w_a * cos_r + axis.cross(w_a) * sin_r).normalized(), theta.cos())
}
