//! What traversal needs to know of a ray, computed once.
//!
//! The origin is replaced by two: one a little ahead for the planes where the ray enters a box, one a little
//! behind for those where it leaves. Boxes so grow by the error that the triangle test makes when it moves
//! vertices to the origin of the ray, and a triangle which the test accepts is never culled with its box
//! (Woop, Benthin and Wald 2013, "Watertight Ray/Triangle Intersection", JCGT 2(1), section 4).

use etendue_math::{Bounds3, Ray};
use glam::Vec4;

/// A ray made ready for slab tests and triangle tests.
#[derive(Clone, Copy, Debug)]
pub(crate) struct TraversalRay {
    pub(super) origin: [f32; 4],
    pub(super) direction: [f32; 4],
    /// Reciprocal direction; infinite where the direction is 0.
    pub(super) inverse: [f32; 4],
    /// The same for the planes where the ray leaves, widened.
    pub(super) inverse_far: [f32; 4],
    pub(super) near_origin: [f32; 4],
    pub(super) far_origin: [f32; 4],
    /// Which of the six planes of a box the ray enters through and which it leaves through, per axis.
    pub(super) planes: &'static [[usize; 3]; 2],
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
        let origin = Vec4::new(ray.origin.x, ray.origin.y, ray.origin.z, 0.0);
        let direction = Vec4::new(ray.direction.x, ray.direction.y, ray.direction.z, 0.0);
        let low = Vec4::new(bounds.min.x, bounds.min.y, bounds.min.z, 0.0);
        let high = Vec4::new(bounds.max.x, bounds.max.y, bounds.max.z, 0.0);
        let reach = (high - origin).abs().max((low - origin).abs()).max_element();
        let step = Vec4::splat(5.0 * f32::EPSILON * reach).copysign(direction);
        let inverse = Vec4::ONE / direction;
        let d = direction.to_array();
        let axes = axes_by_length(direction.abs().to_array());
        let [x, y, z] = axes;
        let scale = 1.0 / d[z];
        // What is not finite remains so, or becomes NaN.
        let zeros = origin * Vec4::ZERO + direction * Vec4::ZERO;
        if zeros.cmpeq(Vec4::ZERO).bitmask() != 0b1111 || d[z] == 0.0 {
            return None;
        }
        Some(Self {
            origin: origin.to_array(),
            direction: d,
            inverse: inverse.to_array(),
            inverse_far: (inverse * Self::WIDEN).to_array(),
            near_origin: (origin + step).to_array(),
            far_origin: (origin - step).to_array(),
            planes: &PLANES[direction.is_negative_bitmask() as usize & 7],
            shear: Shear { axes, x: -d[x] * scale, y: -d[y] * scale, z: scale },
        })
    }
}

/// For each combination of signs of a direction: the planes of a box where the ray enters and those where it leaves.
static PLANES: [[[usize; 3]; 2]; 8] = {
    let mut planes = [[[0; 3]; 2]; 8];
    let mut signs = 0;
    while signs < 8 {
        let mut axis = 0;
        while axis < 3 {
            let is_negative = signs >> axis & 1;
            planes[signs][is_negative][axis] = axis;
            planes[signs][1 - is_negative][axis] = axis + 3;
            axis += 1;
        }
        signs += 1;
    }
    planes
};

/// The longest axis last, the others in cyclic order. Without branches, which random directions would defeat.
#[inline(always)]
fn axes_by_length([x, y, z, _]: [f32; 4]) -> [usize; 3] {
    static CYCLES: [[usize; 3]; 4] = [[1, 2, 0], [2, 0, 1], [0, 1, 2], [0, 1, 2]];
    let (y_exceeds_x, z_exceeds_x, z_exceeds_y) = (y >= x, z >= x, z >= y);
    CYCLES[usize::from(y_exceeds_x) | usize::from(z_exceeds_x & z_exceeds_y) << 1]
}
