//! The sphere as a square, equal areas to equal areas (Clarberg 2008, "Fast Equal-Area Mapping of the (Hemi)Sphere
//! using SIMD"): the upper hemisphere is the inner diamond, the lower one the four corners folded out. Environment maps
//! of pbrt scenes have this layout.

use std::f32::consts::FRAC_PI_2;

use crate::approx::{atan2, sin_cos_turns};
use crate::{ONE_MINUS_EPSILON, Point2, Vector3, safe_sqrt};

/// The direction of a point of the unit square. Density per steradian of a uniform point: 1 / (4 pi).
#[inline]
#[must_use]
pub fn equal_area_square_to_sphere(p: Point2) -> Vector3 {
    let (u, v) = (2.0 * p.x - 1.0, 2.0 * p.y - 1.0);
    let (u_abs, v_abs) = (u.abs(), v.abs());
    // Signed distance to the diamond, positive inside it.
    let signed_distance = 1.0 - (u_abs + v_abs);
    let d = signed_distance.abs();
    let r = 1.0 - d;
    // An angle of the first quadrant.
    let turns = if r == 0.0 { 0.125 } else { 0.125 * ((v_abs - u_abs) / r + 1.0) };
    let z = (1.0 - r * r).copysign(signed_distance);
    let (sin_phi, cos_phi) = sin_cos_turns(turns);
    let sin_theta = r * safe_sqrt(2.0 - r * r);
    Vector3::new(cos_phi.copysign(u) * sin_theta, sin_phi.copysign(v) * sin_theta, z)
}

/// The point of the unit square of a unit vector: inverse of [`equal_area_square_to_sphere`].
#[inline]
#[must_use]
pub fn equal_area_sphere_to_square(w: Vector3) -> Point2 {
    let (x, y, z) = (w.x.abs(), w.y.abs(), w.z.abs());
    // sqrt(1 - |z|), from the sine near the pole, where 1 - |z| cancels.
    let r = if z > 0.5 { ((x * x + y * y) / (1.0 + z)).sqrt() } else { safe_sqrt(1.0 - z) };
    let phi = atan2(y, x) / FRAC_PI_2;
    let (mut u, mut v) = ((1.0 - phi) * r, phi * r);
    if w.z < 0.0 {
        (u, v) = (1.0 - v, 1.0 - u);
    }
    let unit = |t: f32| (0.5 * (t + 1.0)).clamp(0.0, ONE_MINUS_EPSILON);
    Point2::new(unit(u.copysign(w.x)), unit(v.copysign(w.y)))
}

/// The point of the unit square that continues the map beyond its border: each side is folded in its middle. For
/// filters that reach past the border, by less than the side of the square.
#[inline]
#[must_use]
pub fn wrap_equal_area_square(mut p: Point2) -> Point2 {
    if p.x < 0.0 {
        p = Point2::new(-p.x, 1.0 - p.y);
    } else if p.x > 1.0 {
        p = Point2::new(2.0 - p.x, 1.0 - p.y);
    }
    if p.y < 0.0 {
        p = Point2::new(1.0 - p.x, -p.y);
    } else if p.y > 1.0 {
        p = Point2::new(1.0 - p.x, 2.0 - p.y);
    }
    p
}
