//! Polygons as triangles: fans where they are convex, ears where not (Meisters 1975, "Polygons Have Ears").

use etendue_math::{Point3, Vector3};

/// Polygons of more corners are cut into fans, whatever their shape: ears take quadratic time.
pub(super) const MAX_CLIPPED: usize = 1000;

/// Triangles as indices into `corners`, in the orientation of the polygon; there are `corners.len() - 2`.
pub(super) fn triangulate(corners: &[Point3]) -> Vec<[usize; 3]> {
    let n = corners.len();
    if n < 3 {
        return Vec::new();
    }
    let fan = || (1..n - 1).map(|i| [0, i, i + 1]).collect();
    if n == 3 || n > MAX_CLIPPED {
        return fan();
    }
    let Some(flat) = projected(corners) else { return fan() };
    let is_convex = (0..n).all(|i| cross(flat[i], flat[(i + 1) % n], flat[(i + 2) % n]) >= 0.0);
    if is_convex { fan() } else { clip_ears(&flat) }
}

/// The polygon in the plane across its normal (Newell's sum), counter-clockwise.
fn projected(corners: &[Point3]) -> Option<Vec<[f64; 2]>> {
    let origin = corners[0];
    let triangles = corners.windows(2).map(|pair| (pair[0] - origin).cross(pair[1] - origin));
    let n = triangles.fold(Vector3::default(), |sum, area| sum + area).try_normalized()?;
    // The projection along the longest axis of the normal keeps the order of corners, up to its sign.
    let (u, v, sign) = match n.abs().max_dimension() {
        0 => (1, 2, n.x),
        1 => (2, 0, n.y),
        _ => (0, 1, n.z),
    };
    let flip = f64::from(sign.signum());
    let at = |p: &Point3, axis: usize| f64::from([p.x, p.y, p.z][axis]);
    Some(corners.iter().map(|p| [at(p, u) * flip, at(p, v)]).collect())
}

/// Twice the area of a triangle, positive if counter-clockwise.
fn cross(a: [f64; 2], b: [f64; 2], c: [f64; 2]) -> f64 {
    (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])
}

fn clip_ears(flat: &[[f64; 2]]) -> Vec<[usize; 3]> {
    let mut rest: Vec<usize> = (0..flat.len()).collect();
    let mut triangles = Vec::with_capacity(flat.len() - 2);
    let (mut at, mut n_tried) = (0, 0);
    while rest.len() > 3 {
        let n = rest.len();
        let ear = [rest[(at + n - 1) % n], rest[at], rest[(at + 1) % n]];
        // A polygon that crosses itself may have no ear left: then any corner goes.
        if n_tried >= n || is_ear(flat, &rest, ear) {
            triangles.push(ear);
            rest.remove(at);
            at = at.saturating_sub(1);
            n_tried = 0;
        } else {
            at = (at + 1) % n;
            n_tried += 1;
        }
    }
    triangles.push([rest[0], rest[1], rest[2]]);
    triangles
}

/// True if the corner turns left and no other corner lies within its triangle.
fn is_ear(flat: &[[f64; 2]], rest: &[usize], ear: [usize; 3]) -> bool {
    let [a, b, c] = ear.map(|i| flat[i]);
    if cross(a, b, c) <= 0.0 {
        return false;
    }
    let is_inside = |p: [f64; 2]| cross(a, b, p) >= 0.0 && cross(b, c, p) >= 0.0 && cross(c, a, p) >= 0.0;
    let mut others = rest.iter().map(|i| flat[*i]).filter(|p| *p != a && *p != b && *p != c);
    !others.any(is_inside)
}
