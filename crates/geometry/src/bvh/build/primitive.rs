//! What the builder knows of a primitive, in 32 bytes.
//!
//! The lower and the upper corner of its box are four numbers wide, so that portable code handles them as one
//! register; the fourth numbers carry the bits of what the primitive is.

use etendue_math::Bounds3;
use glam::{Vec4, Vec4Swizzles};

use crate::bvh::PrimitiveRef;
use crate::bvh::pair::Pair;

/// A box as arrays, quick to index by axis.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Box3 {
    pub(crate) min: [f32; 3],
    pub(crate) max: [f32; 3],
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
/// The upper bits of the entity of a pair of triangles hold the distance to the second one.
const DISTANCE_SHIFT: u32 = 28;

impl BuildPrimitive {
    /// A triangle with corners that are finite.
    #[inline]
    pub(crate) fn triangle(reference: PrimitiveRef, vertices: &[[f32; 3]; 3]) -> Self {
        assert!(reference.geometry < 1 << DISTANCE_SHIFT, "too many shapes");
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
        assert!(reference.primitive < PLAIN, "too many primitives");
        let bits = |bits: u32| f32::from_bits(bits ^ PLAIN);
        // Adding 0 makes -0 to 0, so that minima do not depend on the order.
        let min = (min + Vec4::ZERO).with_w(bits(reference.geometry));
        let max = (max + Vec4::ZERO).with_w(bits(reference.primitive | kind));
        Self { bounds: Box4 { min, max } }
    }

    /// This triangle and another one of its mesh, `distance` behind it.
    #[inline]
    pub(crate) fn paired(&self, second: &Self, distance: u32) -> Self {
        debug_assert!(distance <= Pair::MAX_DISTANCE);
        let bounds = self.bounds.union(&second.bounds);
        let geometry = self.bounds.min.w.to_bits() ^ distance << DISTANCE_SHIFT;
        let min = bounds.min.with_w(f32::from_bits(geometry));
        Self { bounds: Box4 { min, max: bounds.max.with_w(self.bounds.max.w) } }
    }

    /// Half the surface area of the box.
    pub(crate) fn half_area(&self) -> f32 {
        self.bounds.half_area()
    }

    fn bits(&self) -> [u32; 2] {
        [self.bounds.min.w.to_bits() ^ PLAIN, self.bounds.max.w.to_bits() ^ PLAIN]
    }

    /// What a primitive is that is no triangle.
    pub(super) fn item_reference(&self) -> PrimitiveRef {
        let [geometry, primitive] = self.bits();
        PrimitiveRef { geometry, primitive: primitive & !ITEM }
    }

    /// Which triangles the primitive is.
    pub(super) fn pair(&self) -> Pair {
        let [geometry, primitive] = self.bits();
        let first = PrimitiveRef { geometry: geometry & ((1 << DISTANCE_SHIFT) - 1), primitive };
        Pair { first, distance: geometry >> DISTANCE_SHIFT }
    }

    #[inline]
    pub(super) fn is_triangle(&self) -> bool {
        self.bounds.max.w.to_bits() & ITEM == 0
    }

    /// The box; its fourth numbers mean nothing.
    #[inline(always)]
    pub(super) const fn bounds(&self) -> &Box4 {
        &self.bounds
    }

    /// Twice the centre of the box.
    #[inline(always)]
    pub(super) fn centre(&self) -> Vec4 {
        self.bounds.min + self.bounds.max
    }
}
