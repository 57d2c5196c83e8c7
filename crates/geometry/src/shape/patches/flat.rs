//! Patches that are parallelograms but for the rounding of their corners. Each is two triangles, which the hierarchy
//! intersects at once with others, watertight and in single precision; the weights of a triangle's corners tell the
//! position on the patch, for on a parallelogram it is linear.
//!
//! Half 0 is p00 p10 p11, where u >= v, and half 1 is p00 p11 p01.

use etendue_math::Point3;
use glam::DVec3;

use super::Corners;
use crate::bvh::PrimitiveRef;

/// Marks a triangle of the hierarchy as half of a patch, in the number of its entity.
const HALF: u32 = 1 << 31;

/// How the hierarchy names a half of a patch.
pub(crate) const fn half_reference(geometry: u32, half: u32) -> PrimitiveRef {
    assert!(geometry < HALF, "too many shapes");
    PrimitiveRef { geometry: geometry | HALF, primitive: half }
}

/// The entity of a triangle of the hierarchy.
#[inline(always)]
pub(crate) const fn entity_of(triangle: PrimitiveRef) -> usize {
    (triangle.geometry & !HALF) as usize
}

/// The primitive that a ray meets and where on it, from the weights of the corners of a triangle of the hierarchy.
#[inline(always)]
pub(crate) fn resolve(triangle: PrimitiveRef, b: [f32; 2]) -> (PrimitiveRef, [f32; 2]) {
    if triangle.geometry & HALF == 0 {
        return (triangle, b);
    }
    let PrimitiveRef { geometry, primitive: half } = triangle;
    (PrimitiveRef { geometry: geometry & !HALF, primitive: half / 2 }, position(half % 2, b))
}

/// Roundings of a corner, relative to the largest coordinate: of a transform and of what the file says.
const ROUNDING: f64 = 8.0 * f32::EPSILON as f64;

/// True if p00 + p11 = p10 + p01 up to rounding, of corners with coordinates up to `size`.
pub(super) fn is_parallelogram(c: &Corners, size: f64) -> bool {
    (c[0] + c[3] - (c[1] + c[2])).abs().max_element() <= ROUNDING * size
}

/// Corners of a half.
pub(super) const fn corners(p: [Point3; 4], half: u32) -> [Point3; 3] {
    let [p00, p10, p01, p11] = p;
    if half == 0 { [p00, p10, p11] } else { [p00, p11, p01] }
}

/// The position on the patch where the second and third corner of a half have the weights `b`.
#[inline(always)]
pub(super) fn position(half: u32, b: [f32; 2]) -> [f32; 2] {
    let sum = (b[0] + b[1]).min(1.0);
    if half == 0 { [sum, b[1]] } else { [b[0], sum] }
}

/// The point at a position on the patch, in the plane of its half.
#[inline]
pub(super) fn point(c: &Corners, u: f64, v: f64) -> DVec3 {
    let [p00, p10, p01, p11] = *c;
    if u >= v { p00 + (p10 - p00) * u + (p11 - p10) * v } else { p00 + (p11 - p01) * u + (p01 - p00) * v }
}

/// The unit normal, the mean over a parallelogram that is none but for rounding; zero without area.
pub(super) fn normal(c: &Corners) -> DVec3 {
    (c[3] - c[0]).cross(c[2] - c[1]).normalize_or_zero()
}
