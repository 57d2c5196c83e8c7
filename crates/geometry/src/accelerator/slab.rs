//! Where a ray crosses planes and boxes, never too narrow (SPEC ACC-7).
//!
//! For a plane there are two answers: a t that is too early and one that is too late, by the error that the tests of
//! primitives make; see `bvh/ray.rs`. Cells that are entered early and left late leave no gaps between them.
//! Where a ray runs along a plane and starts within it, both are NaN, which bounds nothing.

use crate::bvh::{Box3, TraversalRay};

#[cfg(test)]
mod tests;

/// A part of a ray.
#[derive(Clone, Copy, Debug)]
pub(super) struct Span {
    pub(super) near: f32,
    pub(super) far: f32,
}

/// Where the ray crosses a plane across `axis`: early and late.
#[inline(always)]
pub(super) fn crossing(ray: &TraversalRay, axis: usize, position: f32) -> [f32; 2] {
    [
        (position - ray.near_origin[axis]) * ray.inverse[axis],
        (position - ray.far_origin[axis]) * ray.inverse_far[axis],
    ]
}

/// True if the ray runs towards smaller coordinates; also tells between 0 and -0, as [`crossing`] does.
#[inline(always)]
pub(super) const fn runs_down(ray: &TraversalRay, axis: usize) -> bool {
    ray.direction[axis].is_sign_negative()
}

/// The part of the ray up to `end` that lies in a box.
#[inline(always)]
pub(super) fn clip(ray: &TraversalRay, bounds: &Box3, end: f32) -> Option<Span> {
    let mut span = Span { near: 0.0, far: end };
    for axis in 0..3 {
        let slab = [bounds.min[axis], bounds.max[axis]];
        let [first, last] = if runs_down(ray, axis) { [slab[1], slab[0]] } else { slab };
        // These forms drop NaN.
        span.near = span.near.max(crossing(ray, axis, first)[0]);
        span.far = span.far.min(crossing(ray, axis, last)[1]);
    }
    (span.near <= span.far).then_some(span)
}
