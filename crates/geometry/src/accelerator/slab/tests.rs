//! Boxes have to be a little larger than they are, by the errors of the tests of primitives.

use etendue_math::{Bounds3, Point3, Ray, Rng};

use super::{Span, clip};
use crate::bvh::{Box3, TraversalRay, intersect_prepared};
use crate::test_support::point_in_cube;

/// A triangle whose edges are those of its flat box, a ray towards a point of an edge or a corner, and the box of all there is.
struct Grazing {
    triangle: [[f32; 3]; 3],
    own: Box3,
    ray: TraversalRay,
}

impl Grazing {
    /// Triangles are small or large, near the origin or far from it; rays come from near or far.
    fn new(rng: &mut Rng) -> Self {
        let mut power = |low: f32, high: f32| 10.0_f32.powf(low + (high - low) * rng.next_f32());
        let (place, size, distance) = (power(-1.0, 3.0), power(-3.0, 1.0), power(-2.0, 2.0));
        let a = point_in_cube(rng, place);
        let axis = rng.next_below(3) as usize;
        let (mut b, mut c) = (a, a);
        b[(axis + 1) % 3] += size * (rng.next_f32() - 0.5);
        c[(axis + 2) % 3] += size * (rng.next_f32() - 0.5);
        let target = [a, a.lerp(b, rng.next_f32()), a.lerp(c, rng.next_f32())][rng.next_below(3) as usize];
        let origin = target + point_in_cube(rng, distance).as_vector();
        let corners = [a, b, c].map(|p| Bounds3 { min: p, max: p });
        let bounds = corners.into_iter().fold(Bounds3::EMPTY, Bounds3::union);
        let ray = Ray::new(origin, target - origin);
        Self {
            triangle: [a, b, c].map(|Point3 { x, y, z }| [x, y, z]),
            own: bounds.into(),
            ray: TraversalRay::new(&(&ray).into(), &bounds.into()).expect("a direction"),
        }
    }
}

/// [`clip`] without room for errors.
fn clip_tightly(ray: &TraversalRay, bounds: &Box3) -> Option<Span> {
    let mut tight = *ray;
    (tight.near_origin, tight.far_origin, tight.inverse_far) = (ray.origin, ray.origin, ray.inverse);
    clip(&tight, bounds, f32::INFINITY)
}

/// SPEC ACC-7: what the test of triangles accepts is never lost with its box, not at corners and edges either.
#[test]
fn boxes_of_triangles_that_are_hit_are_met() {
    let mut rng = Rng::new(71, 0);
    let (mut n_hits, mut n_tight) = (0, 0);
    for _ in 0..100_000 {
        let Grazing { triangle, own, ray } = Grazing::new(&mut rng);
        if intersect_prepared(&ray, &triangle).is_none() {
            continue;
        }
        n_hits += 1;
        n_tight += u32::from(clip_tightly(&ray, &own).is_some());
        assert!(clip(&ray, &own, f32::INFINITY).is_some(), "{triangle:?} by {ray:?}");
    }
    assert!(n_hits > 20_000, "{n_hits} hits");
    // Otherwise these rays would tell nothing.
    assert!(n_tight < n_hits - n_hits / 20, "{n_tight} of {n_hits} need no room");
}
