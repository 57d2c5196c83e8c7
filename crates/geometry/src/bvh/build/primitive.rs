//! What the builder knows of a primitive, in 32 bytes.
//!
//! The lower and the upper corner of its box are four numbers wide, so that portable code handles them as one
//! register; the fourth numbers carry the bits of what the primitive is.

use etendue_math::Bounds3;
use glam::{Vec4, Vec4Swizzles};

use crate::bvh::PrimitiveRef;

/// A box as arrays, quick to index by axis.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Box3 {
    pub(crate) min: [f32; 3],
    pub(crate) max: [f32; 3],
}

impl Box3 {
    pub(crate) const EMPTY: Self = Self { min: [f32::INFINITY; 3], max: [f32::NEG_INFINITY; 3] };

    /// The box around both.
    pub(crate) fn union(self, other: &Self) -> Self {
        Self {
            min: std::array::from_fn(|axis| self.min[axis].min(other.min[axis])),
            max: std::array::from_fn(|axis| self.max[axis].max(other.max[axis])),
        }
    }

    /// The lengths of its sides.
    pub(crate) fn diagonal(&self) -> [f32; 3] {
        std::array::from_fn(|axis| self.max[axis] - self.min[axis])
    }

    /// Half the surface area of a box that is not empty.
    pub(crate) fn half_area(&self) -> f32 {
        let [x, y, z] = self.diagonal();
        x * y + y * z + z * x
    }

    /// The axis along which it is longest, of equals the first.
    pub(crate) fn longest_axis(&self) -> usize {
        let d = self.diagonal();
        (1..3).fold(0, |longest, axis| if d[axis] > d[longest] { axis } else { longest })
    }
}

impl From<Bounds3> for Box3 {
    fn from(bounds: Bounds3) -> Self {
        let [min, max] = [bounds.min, bounds.max].map(|p| [p.x, p.y, p.z]);
        Self { min, max }
    }
}

/// A box whose corners are four numbers wide; the fourth mean nothing.
#[derive(Clone, Copy, Debug)]
pub(super) struct Box4 {
    pub(super) min: Vec4,
    pub(super) max: Vec4,
}

impl Box4 {
    pub(super) const EMPTY: Self = Self { min: Vec4::INFINITY, max: Vec4::NEG_INFINITY };

    #[inline(always)]
    pub(super) fn grow(&mut self, other: &Self) {
        self.min = self.min.min(other.min);
        self.max = self.max.max(other.max);
    }

    #[inline(always)]
    pub(super) fn grow_point(&mut self, p: Vec4) {
        self.min = self.min.min(p);
        self.max = self.max.max(p);
    }

    #[inline]
    pub(super) fn union(mut self, other: &Self) -> Self {
        self.grow(other);
        self
    }

    /// Half the surface area of a box that is not empty.
    #[inline(always)]
    pub(super) fn half_area(&self) -> f32 {
        let d = self.max - self.min;
        let p = d * d.yzxw();
        p.x + p.y + p.z
    }

    pub(super) fn to_box3(self) -> Box3 {
        let [x0, y0, z0, _] = self.min.to_array();
        let [x1, y1, z1, _] = self.max.to_array();
        Box3 { min: [x0, y0, z0], max: [x1, y1, z1] }
    }
}

/// A primitive as the builder sees it.
#[derive(Clone, Copy, Debug)]
pub(crate) struct BuildPrimitive {
    /// The fourth numbers hold the bits of entity and primitive, changed by [`PLAIN`].
    bounds: Box4,
}

/// Makes the bits of small integers those of ordinary numbers: sums of subnormal ones are slow on some processors.
const PLAIN: u32 = 1 << 30;
/// Set in the number of a primitive that is no triangle.
const ITEM: u32 = 1 << 31;
/// Set in the number of the first triangle of a pair.
const PAIR: u32 = 1 << 29;

impl BuildPrimitive {
    /// A triangle with corners that are finite.
    #[inline]
    pub(crate) fn triangle(reference: PrimitiveRef, vertices: &[[f32; 3]; 3]) -> Self {
        let [a, b, c] = vertices.map(|[x, y, z]| Vec4::new(x, y, z, 0.0));
        Self::new(reference, 0, a.min(b).min(c), a.max(b).max(c))
    }

    /// Anything else, known by its box.
    pub(crate) fn item(reference: PrimitiveRef, bounds: Bounds3) -> Self {
        let [min, max] = [bounds.min, bounds.max].map(|p| Vec4::new(p.x, p.y, p.z, 0.0));
        Self::new(reference, ITEM, min, max)
    }

    #[inline(always)]
    fn new(reference: PrimitiveRef, kind: u32, min: Vec4, max: Vec4) -> Self {
        assert!(reference.primitive < PAIR, "too many primitives");
        let bits = |bits: u32| f32::from_bits(bits ^ PLAIN);
        // Adding 0 makes -0 to 0, so that minima do not depend on the order.
        let min = (min + Vec4::ZERO).with_w(bits(reference.geometry));
        let max = (max + Vec4::ZERO).with_w(bits(reference.primitive | kind));
        Self { bounds: Box4 { min, max } }
    }

    /// This triangle and another one of its mesh.
    #[inline]
    pub(crate) fn paired(&self, second: &Self) -> Self {
        let bounds = self.bounds.union(&second.bounds);
        let primitive = f32::from_bits(self.bounds.max.w.to_bits() | PAIR);
        Self { bounds: Box4 { min: bounds.min.with_w(self.bounds.min.w), max: bounds.max.with_w(primitive) } }
    }

    /// By how much the area of the box around both exceeds the sum of their areas.
    #[inline]
    pub(crate) fn union_growth(&self, other: &Self) -> f32 {
        self.bounds.union(&other.bounds).half_area() - (self.bounds.half_area() + other.bounds.half_area())
    }

    /// True if the primitive is two triangles.
    #[inline]
    pub(crate) fn is_pair(&self) -> bool {
        self.bounds.max.w.to_bits() & PAIR != 0
    }

    /// The number of the first triangle in its mesh.
    #[inline]
    pub(crate) fn first_triangle(&self) -> u32 {
        self.reference().primitive
    }

    /// What the primitive is; of a pair, the first triangle.
    #[inline]
    pub(crate) fn reference(&self) -> PrimitiveRef {
        let bits = |w: f32| w.to_bits() ^ PLAIN;
        PrimitiveRef {
            geometry: bits(self.bounds.min.w),
            primitive: bits(self.bounds.max.w) & !(ITEM | PAIR),
        }
    }

    #[inline]
    pub(crate) fn is_triangle(&self) -> bool {
        self.bounds.max.w.to_bits() & ITEM == 0
    }

    /// The box; its fourth numbers mean nothing.
    #[inline(always)]
    pub(super) const fn bounds(&self) -> &Box4 {
        &self.bounds
    }

    /// The box.
    pub(crate) fn box3(&self) -> Box3 {
        self.bounds.to_box3()
    }

    /// Twice the centre of the box.
    #[inline(always)]
    pub(super) fn centre(&self) -> Vec4 {
        self.bounds.min + self.bounds.max
    }
}
