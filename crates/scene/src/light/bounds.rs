//! What a light tree knows of a light or a group: where it is, and in which directions it emits.
//!
//! A group is a box, and a cone of normals (axis `w`, half angle theta_o) around each of which light leaves within the
//! angle theta_e. From these, an upper bound of the angle terms gives the importance of the group for a point
//! (Conty Estevez and Kulla 2018, "Importance Sampling of Many Lights with Adaptive Tree Splitting", in the variant
//! of pbrt-v4). Two things differ from pbrt-v4: brightness is *intensity*, which compares point lights with surfaces on
//! equal terms, in the brightest direction but for lights with pictures, whose mean is taken; and where rounding could make the importance of a contributing light 0, a small margin
//! keeps it positive.

use std::f32::consts::PI;

use etendue_geometry::Reference;
use etendue_math::{Bounds3, Lanes4, Point3, Vector3, safe_acos};

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
    /// Intensity by the weight of [`LightPower`](super::LightPower): the peak, or the mean over a picture. For a surface, radiance
    /// along the normal times area.
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
}

/// Number of children of a node of the tree.
pub(super) const N_CHILDREN: usize = 4;

/// Four [`LightBounds`] side by side, as the importance needs them. Places not set are of no importance.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct BoundsOfFour {
    /// Middle of the box.
    center: [Lanes4; 3],
    /// Square of half the diagonal of the box.
    radius_squared: Lanes4,
    /// Axis of the cone of normals.
    w: [Lanes4; 3],
    cos_o: Lanes4,
    sin_o: Lanes4,
    cos_e: Lanes4,
    intensity: Lanes4,
    /// 1 where light leaves on both sides, else 0.
    two_sided: Lanes4,
}

impl BoundsOfFour {
    /// Nothing is there.
    pub(super) const EMPTY: Self = Self {
        center: [Lanes4::splat(0.0); 3],
        radius_squared: Lanes4::splat(0.0),
        w: [Lanes4::splat(0.0); 3],
        cos_o: Lanes4::splat(1.0),
        sin_o: Lanes4::splat(0.0),
        cos_e: Lanes4::splat(1.0),
        intensity: Lanes4::splat(0.0),
        two_sided: Lanes4::splat(0.0),
    };

    /// Sets one of the four.
    pub(super) fn set(&mut self, i: usize, bounds: &LightBounds) {
        let center = bounds.centroid();
        for axis in 0..3 {
            self.center[axis].0[i] = center[axis];
            self.w[axis].0[i] = bounds.w[axis];
        }
        self.radius_squared.0[i] = bounds.bounds.diagonal().length_squared() / 4.0;
        self.cos_o.0[i] = bounds.cos_theta_o;
        self.sin_o.0[i] = (1.0 - bounds.cos_theta_o * bounds.cos_theta_o).max(0.0).sqrt();
        self.cos_e.0[i] = bounds.cos_theta_e;
        self.intensity.0[i] = bounds.intensity;
        self.two_sided.0[i] = if bounds.two_sided { 1.0 } else { 0.0 };
    }

    /// How much each may contribute at `reference`: an estimate, 0 only if it contributes nothing.
    #[inline]
    pub(super) fn importance(&self, reference: &Reference) -> Lanes4 {
        let (zero, one) = (Lanes4::splat(0.0), Lanes4::splat(1.0));
        let p = reference.p;
        let from_light = [
            Lanes4::splat(p.x) - self.center[0],
            Lanes4::splat(p.y) - self.center[1],
            Lanes4::splat(p.z) - self.center[2],
        ];
        let true_distance_squared = dot(from_light, from_light).max(Lanes4::splat(1e-30));
        let distance_squared = true_distance_squared.max(self.radius_squared).max(Lanes4::splat(1e-20));
        let inverse_distance = one / true_distance_squared.sqrt();
        // The angle theta_b that the box subtends; everything from within it.
        let sin_squared = self.radius_squared / true_distance_squared;
        let is_outside = one - sin_squared;
        let sin_b = is_outside.select_above(zero, sin_squared.sqrt(), zero);
        let cos_b = is_outside.select_above(zero, is_outside.max(zero).sqrt(), zero - one);
        // theta' = max(0, theta_w - theta_o - theta_b): the least angle between a normal and a direction to the point.
        let cos_w = (dot(self.w, from_light) * inverse_distance).max(zero - one).min(one);
        let cos_w = self.two_sided.select_above(zero, cos_w.abs(), cos_w);
        let from_cone = subtract_clamped([sine(cos_w), cos_w], [self.sin_o, self.cos_o]);
        let [_, cos_prime] = subtract_clamped(from_cone, [sin_b, cos_b]);
        let mut importance = self.intensity * cos_prime.max(Lanes4::splat(COSINE_MARGIN)) / distance_squared;
        if let Some(n) = reference.n {
            let n = [Lanes4::splat(n.x), Lanes4::splat(n.y), Lanes4::splat(n.z)];
            let cos_i = (dot(n, from_light) * inverse_distance).abs().min(one);
            let [_, cos_i_prime] = subtract_clamped([sine(cos_i), cos_i], [sin_b, cos_b]);
            importance = importance * cos_i_prime.max(Lanes4::splat(MIN_RECEIVER_FACTOR));
        }
        let importance = importance.max(Lanes4::splat(1e-30)).min(Lanes4::splat(1e30));
        let importance = cos_prime.select_above(self.cos_e - Lanes4::splat(COSINE_MARGIN), importance, zero);
        self.intensity.select_above(zero, importance, zero)
    }
}

#[inline(always)]
fn dot(a: [Lanes4; 3], b: [Lanes4; 3]) -> Lanes4 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

#[inline(always)]
fn sine(cosine: Lanes4) -> Lanes4 {
    (Lanes4::splat(1.0) - cosine * cosine).max(Lanes4::splat(0.0)).sqrt()
}

/// Sine and cosine of max(0, a - b), for angles in [0, pi] given by sine and cosine.
#[inline(always)]
fn subtract_clamped([sin_a, cos_a]: [Lanes4; 2], [sin_b, cos_b]: [Lanes4; 2]) -> [Lanes4; 2] {
    let sine = sin_a * cos_b - cos_a * sin_b;
    let cosine = cos_a * cos_b + sin_a * sin_b;
    [
        cos_a.select_above(cos_b, Lanes4::splat(0.0), sine),
        cos_a.select_above(cos_b, Lanes4::splat(1.0), cosine),
    ]
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
