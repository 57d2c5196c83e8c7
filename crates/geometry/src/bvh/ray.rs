//! What traversal needs to know of a ray, computed once.
//!
//! The origin is replaced by two: one a little ahead for the planes where the ray enters a box, one a little
//! behind for those where it leaves. Boxes so grow by the error that the triangle test makes when it moves
//! vertices to the origin of the ray, and a triangle which the test accepts is never culled with its box
//! (Woop, Benthin and Wald 2013, "Watertight Ray/Triangle Intersection", JCGT 2(1), section 4).

use etendue_math::{Bounds3, Ray};

/// A ray made ready for slab tests and triangle tests.
#[derive(Clone, Copy, Debug)]
pub(crate) struct TraversalRay {
    pub(super) origin: [f32; 3],
    pub(super) direction: [f32; 3],
    /// Reciprocal direction; infinite where the direction is 0.
    pub(super) inverse: [f32; 3],
    pub(super) near_origin: [f32; 3],
    pub(super) far_origin: [f32; 3],
    /// Which of the six planes of a box the ray enters through, per axis.
    pub(super) near_plane: [usize; 3],
    /// Which it leaves through.
    pub(super) far_plane: [usize; 3],
    pub(super) shear: Shear,
}

/// The shear that turns the direction of a ray into the z axis.
#[derive(Clone, Copy, Debug)]
pub(super) struct Shear {
    /// Axes of the sheared x, y, z; z is the longest axis of the direction.
    pub(super) axes: [usize; 3],
    pub(super) x: f32,
    pub(super) y: f32,
    pub(super) z: f32,
}

impl TraversalRay {
    /// Factor on the far end: three roundings on each side of the comparison.
    pub(super) const WIDEN: f32 = 1.0 + 3.0 * f32::EPSILON;

    /// Prepares a ray for a tree with these bounds; `None` for rays that are not finite or have no direction.
    #[inline]
    pub(crate) fn new(ray: &Ray, bounds: &Bounds3) -> Option<Self> {
        if !ray.origin.is_finite() || !ray.direction.is_finite() {
            return None;
        }
        let origin = [ray.origin.x, ray.origin.y, ray.origin.z];
        let direction = [ray.direction.x, ray.direction.y, ray.direction.z];
        let z = ray.direction.max_dimension();
        if direction[z] == 0.0 {
            return None;
        }
        let reach = (bounds.max - ray.origin).abs().max((bounds.min - ray.origin).abs()).max_element();
        let margin = 5.0 * f32::EPSILON * reach;
        let is_negative = direction.map(f32::is_sign_negative);
        let step = is_negative.map(|negative| if negative { -margin } else { margin });
        let (x, y) = ((z + 1) % 3, (z + 2) % 3);
        let scale = 1.0 / direction[z];
        Some(Self {
            origin,
            direction,
            inverse: direction.map(|d| 1.0 / d),
            near_origin: std::array::from_fn(|axis| origin[axis] + step[axis]),
            far_origin: std::array::from_fn(|axis| origin[axis] - step[axis]),
            near_plane: std::array::from_fn(|axis| if is_negative[axis] { axis + 3 } else { axis }),
            far_plane: std::array::from_fn(|axis| if is_negative[axis] { axis } else { axis + 3 }),
            shear: Shear { axes: [x, y, z], x: -direction[x] * scale, y: -direction[y] * scale, z: scale },
        })
    }
}
