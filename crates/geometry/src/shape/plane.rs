//! The plane n·p + D = 0 (SPEC GEO-4): t = -(n·o + D) / (n·d).

use glam::DVec3;

/// Where a ray meets a plane; `None` if it runs parallel. Negative t lies behind the origin.
pub(crate) fn intersect_plane(n: DVec3, d: f64, origin: DVec3, direction: DVec3) -> Option<f64> {
    let slope = n.dot(direction);
    (slope != 0.0).then(|| -(n.dot(origin) + d) / slope)
}
