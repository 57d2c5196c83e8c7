//! The unit disk, uniformly: p = 1/pi.

use std::f32::consts::{FRAC_1_PI, FRAC_PI_2, FRAC_PI_4, TAU};

use crate::approx::{atan2, sin_cos_small_turns, sin_cos_turns};
use crate::{ONE_MINUS_EPSILON, Point2};

/// A point of the unit disk; concentric squares become concentric circles, so that neighbours stay neighbours
/// (Shirley and Chiu 1997, "A Low Distortion Map between Disk and Square").
#[inline]
#[must_use]
pub fn sample_concentric_disk(u: Point2) -> Point2 {
    let (x, y) = (2.0 * u.x - 1.0, 2.0 * u.y - 1.0);
    let along_x = x.abs() > y.abs();
    // The radius is the larger coordinate, and the angle from its axis an eighth of a turn times the quotient.
    let (radius, other) = if along_x { (x, y) } else { (y, x) };
    let (sin, cos) = sin_cos_small_turns(if radius == 0.0 { 0.0 } else { 0.125 * (other / radius) });
    let (near, across) = (radius * cos, radius * sin);
    if along_x { Point2::new(near, across) } else { Point2::new(across, near) }
}

/// Density of [`sample_concentric_disk`] per unit area.
#[inline]
#[must_use]
pub const fn concentric_disk_pdf() -> f32 {
    FRAC_1_PI
}

/// Inverse of [`sample_concentric_disk`].
#[must_use]
pub fn invert_concentric_disk(p: Point2) -> Point2 {
    let r = (p.x * p.x + p.y * p.y).sqrt();
    let mut phi = atan2(p.y, p.x);
    if phi < -FRAC_PI_4 {
        phi += TAU;
    }
    let (x, y) = if phi < FRAC_PI_4 {
        (r, phi * r / FRAC_PI_4)
    } else if phi < 3.0 * FRAC_PI_4 {
        (-(phi - FRAC_PI_2) * r / FRAC_PI_4, r)
    } else if phi < 5.0 * FRAC_PI_4 {
        (-r, -(phi - 2.0 * FRAC_PI_2) * r / FRAC_PI_4)
    } else {
        ((phi - 3.0 * FRAC_PI_2) * r / FRAC_PI_4, -r)
    };
    let unit = |t: f32| (0.5 * (t + 1.0)).clamp(0.0, ONE_MINUS_EPSILON);
    Point2::new(unit(x), unit(y))
}

/// A point of the unit disk in polar coordinates: r = sqrt(u.x), phi = 2 pi u.y.
#[inline]
#[must_use]
pub fn sample_polar_disk(u: Point2) -> Point2 {
    let r = u.x.sqrt();
    let (sin, cos) = sin_cos_turns(u.y);
    Point2::new(r * cos, r * sin)
}

/// Density of [`sample_polar_disk`] per unit area.
#[inline]
#[must_use]
pub const fn polar_disk_pdf() -> f32 {
    FRAC_1_PI
}

/// Inverse of [`sample_polar_disk`].
#[must_use]
pub fn invert_polar_disk(p: Point2) -> Point2 {
    Point2::new((p.x * p.x + p.y * p.y).min(ONE_MINUS_EPSILON), turn_fraction(p.x, p.y))
}

/// The angle of (x, y) from the x axis as a fraction of the full turn, in [0, 1).
pub(super) fn turn_fraction(x: f32, y: f32) -> f32 {
    let phi = atan2(y, x);
    let phi = if phi < 0.0 { phi + TAU } else { phi };
    (phi / TAU).clamp(0.0, ONE_MINUS_EPSILON)
}
