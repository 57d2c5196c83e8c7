//! Where a ray meets a bilinear patch, in double precision.

use glam::DVec3;

use super::Corners;
use crate::shape::{Candidate, Candidates};

/// Up to two hits in order of t, with the position on the patch.
pub(super) fn intersect(c: &Corners, origin: DVec3, direction: DVec3) -> Candidates {
    let [p00, p10, p01, p11] = *c;
    let qa = (p10 - p00).cross(p01 - p11).dot(direction);
    let qc = (p00 - origin).cross(direction).dot(p01 - p00);
    let qb = (p10 - origin).cross(direction).dot(p11 - p10) - (qa + qc);
    let mut hits = [None; 2];
    let roots = quadratic(qa, qb, qc);
    for (slot, u) in roots.into_iter().enumerate() {
        hits[slot] = u.and_then(|u| on_line(c, u, origin, direction));
    }
    if let [Some(a), Some(b)] = hits
        && b.t < a.t
    {
        hits = [Some(b), Some(a)];
    }
    hits
}

/// Slack in u and v: neighbours of one edge overlap by it instead of leaving a gap.
const SLACK: f64 = 1e-10;

/// The hit on the line of constant u, if it lies on the patch and ahead.
fn on_line(c: &Corners, u: f64, origin: DVec3, direction: DVec3) -> Option<Candidate> {
    if !(-SLACK..=1.0 + SLACK).contains(&u) {
        return None;
    }
    let u = u.clamp(0.0, 1.0);
    let start = c[0].lerp(c[1], u);
    let line = c[2].lerp(c[3], u) - start;
    let offset = start - origin;
    let normal = direction.cross(line);
    let length_squared = normal.length_squared();
    if length_squared == 0.0 {
        return None;
    }
    let v = offset.cross(direction).dot(normal) / length_squared;
    let t = offset.cross(line).dot(normal) / length_squared;
    ((-SLACK..=1.0 + SLACK).contains(&v) && t > 0.0).then(|| Candidate { t, u, v: v.clamp(0.0, 1.0) })
}

/// Roots of a x² + b x + c; the second is absent where the equation is linear.
fn quadratic(a: f64, b: f64, c: f64) -> [Option<f64>; 2] {
    // The leading coefficient of a planar patch is rounding noise and then has a root far away.
    if a == 0.0 {
        return [(b != 0.0).then(|| -c / b), None];
    }
    let discriminant = b * b - 4.0 * a * c;
    if discriminant < 0.0 || !discriminant.is_finite() {
        return [None; 2];
    }
    let q = -0.5 * (b + discriminant.sqrt().copysign(b));
    [Some(q / a), (q != 0.0).then(|| c / q)]
}
