//! Small helpers for directions in the shading frame, where the normal is +z.

use etendue_math::Vector3;

/// Cosine of the angle to the normal.
#[inline]
pub(crate) fn abs_cos(w: Vector3) -> f32 {
    w.z.abs()
}

/// True if both directions leave on the same side; false if one is tangent.
#[inline]
pub(crate) fn same_hemisphere(a: Vector3, b: Vector3) -> bool {
    a.z * b.z > 0.0
}

/// The mirror direction about +z (SPEC FRES-1).
#[inline]
pub(crate) fn mirror(w: Vector3) -> Vector3 {
    Vector3::new(-w.x, -w.y, w.z)
}

/// `w` on the side of the surface where z has the sign of `reference.z`.
#[inline]
pub(crate) fn to_side_of(w: Vector3, reference: Vector3) -> Vector3 {
    Vector3::new(w.x, w.y, w.z.abs().copysign(reference.z))
}
