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
    /// The same for the planes where the ray leaves.
    pub(super) inverse_far: [f32; 3],
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
    /// Factor on the far end: three roundings on each side of the comparison and one of a product with the factor.
    pub(super) const WIDEN: f32 = 1.0 + 4.0 * f32::EPSILON;

    /// Prepares a ray for a tree with these bounds; `None` for rays that are not finite or have no direction.
    #[inline(always)]
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
        let [sx, sy, sz] =
            [step(direction[0], margin), step(direction[1], margin), step(direction[2], margin)];
        let inverse = [1.0 / direction[0], 1.0 / direction[1], 1.0 / direction[2]];
        let near_plane = |axis: usize| if direction[axis].is_sign_negative() { axis + 3 } else { axis };
        let near_plane = [near_plane(0), near_plane(1), near_plane(2)];
        let (x, y) = ([1, 2, 0][z], [2, 0, 1][z]);
        let scale = inverse[z];
        Some(Self {
            origin,
            direction,
            inverse,
            inverse_far: [inverse[0] * Self::WIDEN, inverse[1] * Self::WIDEN, inverse[2] * Self::WIDEN],
            near_origin: [origin[0] + sx, origin[1] + sy, origin[2] + sz],
            far_origin: [origin[0] - sx, origin[1] - sy, origin[2] - sz],
            near_plane,
            far_plane: [3 - near_plane[0], 5 - near_plane[1], 7 - near_plane[2]],
            shear: Shear { axes: [x, y, z], x: -direction[x] * scale, y: -direction[y] * scale, z: scale },
        })
    }
}

/// The margin in the sense of a direction.
#[inline(always)]
const fn step(direction: f32, margin: f32) -> f32 {
    if direction.is_sign_negative() { -margin } else { margin }
}
