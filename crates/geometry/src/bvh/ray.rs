//! What traversal needs to know of a ray, computed once.
//!
//! The origin is replaced by two: one a little ahead for the planes where the ray enters a box, one a little
//! behind for those where it leaves. Boxes so grow by the error that the triangle test makes when it moves
//! vertices to the origin of the ray, and a triangle which the test accepts is never culled with its box
//! (Woop, Benthin and Wald 2013, "Watertight Ray/Triangle Intersection", JCGT 2(1), section 4).

use etendue_math::{Bounds3, Point3, Ray, Vector3};
use glam::Vec4;

/// Origin and direction, whose fourth lanes are 0.
#[derive(Clone, Copy, Debug)]
pub(crate) struct WideRay {
    pub(crate) origin: Vec4,
    pub(crate) direction: Vec4,
}

impl From<&Ray> for WideRay {
    #[inline(always)]
    fn from(Ray { origin: o, direction: d, .. }: &Ray) -> Self {
        Self { origin: Vec4::new(o.x, o.y, o.z, 0.0), direction: Vec4::new(d.x, d.y, d.z, 0.0) }
    }
}

impl WideRay {
    /// The ray at a time.
    #[inline]
    pub(crate) fn at(&self, time: f32) -> Ray {
        let Self { origin: o, direction: d } = self;
        Ray { origin: Point3::new(o.x, o.y, o.z), direction: Vector3::new(d.x, d.y, d.z), time }
    }
}

/// A box, whose fourth lanes are 0.
#[derive(Clone, Copy, Debug)]
pub(crate) struct WideBounds {
    min: Vec4,
    max: Vec4,
}

impl From<Bounds3> for WideBounds {
    fn from(Bounds3 { min, max }: Bounds3) -> Self {
        Self { min: Vec4::new(min.x, min.y, min.z, 0.0), max: Vec4::new(max.x, max.y, max.z, 0.0) }
    }
}

impl From<WideBounds> for Bounds3 {
    fn from(WideBounds { min, max }: WideBounds) -> Self {
        Self { min: Point3::new(min.x, min.y, min.z), max: Point3::new(max.x, max.y, max.z) }
    }
}

impl Default for WideBounds {
    fn default() -> Self {
        Bounds3::EMPTY.into()
    }
}

/// A ray made ready for slab tests and triangle tests.
#[derive(Clone, Copy, Debug)]
pub(crate) struct TraversalRay {
    pub(crate) origin: [f32; 4],
    pub(crate) direction: [f32; 4],
    /// Reciprocal direction; infinite where the direction is 0.
    pub(crate) inverse: [f32; 4],
    /// The same for the planes where the ray leaves, widened.
    pub(crate) inverse_far: [f32; 4],
    pub(crate) near_origin: [f32; 4],
    pub(crate) far_origin: [f32; 4],
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
    pub(crate) const WIDEN: f32 = 1.0 + 4.0 * f32::EPSILON;

    /// Prepares a ray for a tree with these bounds; `None` for rays that are not finite or have no direction.
    #[inline(always)]
    pub(crate) fn new(ray: &WideRay, bounds: &WideBounds) -> Option<Self> {
        let WideRay { origin, direction } = *ray;
        let reach = (bounds.max - origin).abs().max((bounds.min - origin).abs()).max_element();
        // And what the sum with the origin may lose by rounding, which is all where everything is near a far origin.
        let step = Vec4::splat(5.0 * f32::EPSILON * reach) + origin.abs() * f32::EPSILON;
        let step = step.copysign(direction);
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
