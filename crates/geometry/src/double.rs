//! Between the single-precision types of `etendue_math` and double-precision vectors, in which quadrics, patches
//! and positions on surfaces are computed: their rounding errors then vanish beside that of the final result.

use etendue_math::{Normal3, Point3, Transform, Vector3};
use glam::{DAffine3, DMat3, DVec3};

/// The vector from the origin to a point.
#[inline]
pub(crate) fn point(p: Point3) -> DVec3 {
    DVec3::new(f64::from(p.x), f64::from(p.y), f64::from(p.z))
}

/// A vector in double precision.
#[inline]
pub(crate) fn vector(v: Vector3) -> DVec3 {
    DVec3::new(f64::from(v.x), f64::from(v.y), f64::from(v.z))
}

/// A normal in double precision.
#[inline]
pub(crate) fn normal(n: Normal3) -> DVec3 {
    DVec3::new(f64::from(n.x), f64::from(n.y), f64::from(n.z))
}

/// Rounds to a point.
#[inline]
pub(crate) fn to_point(p: DVec3) -> Point3 {
    Point3::new(p.x as f32, p.y as f32, p.z as f32)
}

/// Rounds to a vector.
#[inline]
pub(crate) fn to_vector(v: DVec3) -> Vector3 {
    Vector3::new(v.x as f32, v.y as f32, v.z as f32)
}

/// Rounds to a normal.
#[inline]
pub(crate) fn to_normal(n: DVec3) -> Normal3 {
    Normal3::new(n.x as f32, n.y as f32, n.z as f32)
}

/// The affine part of a transform; its inverse is then exact to double precision.
pub(crate) fn affine(transform: &Transform) -> DAffine3 {
    let m = transform.rows().map(|row| row.map(f64::from));
    let column = |c: usize| DVec3::new(m[0][c], m[1][c], m[2][c]);
    DAffine3 { matrix3: DMat3::from_cols(column(0), column(1), column(2)), translation: column(3) }
}

/// Bound of the error made by rounding a point to single precision, with a factor 2 to spare.
#[inline]
pub(crate) fn rounding_error(p: Point3) -> Vector3 {
    p.as_vector().abs() * f32::EPSILON + Vector3::splat(f32::MIN_POSITIVE)
}

/// The same for a point of a shape with coordinates up to `size` that is intersected in double precision. Near the
/// origin of the world the error of that exceeds the rounding of the point: 2^-46 leaves it two decimal digits.
#[inline]
pub(crate) fn surface_error(p: Point3, size: f64) -> Vector3 {
    const RELATIVE: f64 = 1.0 / (1_u64 << 46) as f64;
    rounding_error(p) + Vector3::splat((size * RELATIVE) as f32)
}

/// Largest magnitude of a coordinate.
pub(crate) fn largest_coordinate(points: impl IntoIterator<Item = DVec3>) -> f64 {
    points.into_iter().map(|p| p.abs().max_element()).fold(0.0, f64::max)
}

/// Normal and tangents of a surface after an affine map: tangents are pushed forward, the normal is pulled back.
#[derive(Clone, Copy, Debug)]
pub(crate) struct NormalMap {
    /// Inverse transpose of the linear part.
    matrix: DMat3,
}

impl NormalMap {
    /// The map of normals that belongs to `b_from_a`, by the linear part of its inverse.
    pub(crate) fn new(a_from_b: &DMat3) -> Self {
        Self { matrix: a_from_b.transpose() }
    }

    /// The unit normal and its derivatives after the map.
    pub(crate) fn apply(&self, n: DVec3, dn: [DVec3; 2]) -> (DVec3, [DVec3; 2]) {
        let mapped = self.matrix * n;
        let length = mapped.length();
        let unit = mapped / length;
        let derivative = |dn: DVec3| {
            let d = self.matrix * dn / length;
            d - unit * unit.dot(d)
        };
        (unit, dn.map(derivative))
    }
}
