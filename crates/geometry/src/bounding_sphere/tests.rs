use etendue_math::{AnimatedTransform, Point3, Ray, Rng, Transform, Vector3};

use super::*;
use crate::test_support::{any, ball, direction, still};
use crate::{GeometryBuilder, NO_INSTANCE, Shape};

fn scattered() -> Geometry {
    let mut rng = Rng::new(3, 3);
    let mut builder = GeometryBuilder::new();
    let object = builder.begin_object();
    builder.add_to_object(object, Shape::Triangles(ball(2)), &Transform::IDENTITY, false);
    for i in 0..40 {
        let place = |rng: &mut Rng| {
            let p = crate::test_support::point_in_cube(rng, 20.0);
            Transform::translate(p.as_vector())
                * Transform::rotate(i as f32, direction(rng)).expect("an axis")
        };
        let (start, end) = (place(&mut rng), place(&mut rng));
        match i % 3 {
            0 => drop(builder.add(Shape::sphere(1.5), &still(start), false)),
            1 => drop(builder.add(Shape::Triangles(ball(1)), &still(start), false)),
            _ => drop(
                builder
                    .add_instance(object, &AnimatedTransform { start, end, start_time: 0.0, end_time: 1.0 }),
            ),
        }
    }
    builder.build()
}

/// SPEC GEO-13: whatever a ray meets lies within the ball of its object, of its cluster and of the scene, at any time; and within
/// the cone from where the ray begins.
#[test]
fn every_object_lies_within_its_bound() {
    let geometry = scattered();
    let spheres = geometry.object_spheres();
    assert_eq!(spheres.len(), 40);
    let clusters = geometry.object_clusters(7);
    assert_eq!(clusters.len(), 7);
    assert_eq!(clusters.iter().map(|(objects, _)| objects.len()).sum::<usize>(), 40);
    let scene = geometry.bounding_sphere().expect("there is something");
    let mut rng = Rng::new(4, 3);
    let mut n_hits = 0;
    for _ in 0..20_000 {
        let ray = Ray { time: rng.next_f32(), ..crate::test_support::ray(&mut rng, 25.0) };
        let Some(hit) = geometry.intersect(&ray, f32::INFINITY, &any) else { continue };
        n_hits += 1;
        let p = geometry.surface_point(&ray, &hit).p;
        let object = match hit.instance {
            NO_INSTANCE => ObjectReference::Shape(hit.geometry),
            instance => ObjectReference::Instance(instance),
        };
        let own = spheres.iter().find(|(other, _)| *other == object).expect("each has one").1;
        let cluster =
            clusters.iter().find(|(objects, _)| objects.contains(&object)).expect("each is in one").1;
        for sphere in [own, cluster, scene] {
            assert!(sphere.contains(p), "{p:?} beside {sphere:?}");
            let (axis, cosine) = sphere.cone_from(ray.origin);
            assert!(axis.dot(ray.direction) >= cosine - 1e-5, "{ray:?} beside the cone of {sphere:?}");
        }
    }
    assert!(n_hits > 300, "{n_hits}");
}

/// Balls around balls, and around nothing.
#[test]
fn balls_are_joined() {
    let ball = |x: f32, radius: f32| BoundingSphere { centre: Point3::new(x, 0.0, 0.0), radius };
    let both = ball(0.0, 1.0).union(ball(4.0, 1.0));
    assert!((both.centre.x - 2.0).abs() < 1e-5 && (both.radius - 3.0).abs() < 1e-5, "{both:?}");
    assert_eq!(ball(0.0, 9.0).union(ball(4.0, 1.0)), ball(0.0, 9.0));
    assert_eq!(ball(4.0, 1.0).union(ball(0.0, 9.0)), ball(0.0, 9.0));
    assert_eq!(BoundingSphere::around(etendue_math::Bounds3::EMPTY), None);
    assert_eq!(ball(0.0, 1.0).cone_from(Point3::ORIGIN).1, -1.0);
    let (axis, cosine) = ball(2.0, 1.0).cone_from(Point3::ORIGIN);
    assert!((axis - Vector3::new(1.0, 0.0, 0.0)).length() < 1e-6 && (cosine - 0.75_f32.sqrt()).abs() < 1e-6);
    assert!(GeometryBuilder::new().build().object_clusters(3).is_empty());
}

/// What a ray meets of the wanted shapes lies within one of the covering balls, moving instances and flat shapes included; and
/// a floor is covered by small ones.
#[test]
fn covering_balls_hold_what_is_wanted() {
    let geometry = scattered();
    let wanted = |id: GeometryId| id.0.is_multiple_of(2);
    let mut rng = Rng::new(5, 3);
    for n in [1, 7, 100, 1000] {
        let spheres = geometry.covering_spheres(n, &wanted);
        assert!(!spheres.is_empty() && spheres.len() <= 2 * n, "{} balls instead of {n}", spheres.len());
        for _ in 0..4000 {
            let ray = Ray { time: rng.next_f32(), ..crate::test_support::ray(&mut rng, 25.0) };
            let Some(hit) = geometry.intersect(&ray, f32::INFINITY, &any) else { continue };
            let p = geometry.surface_point(&ray, &hit).p;
            assert!(!wanted(hit.geometry) || spheres.iter().any(|sphere| sphere.contains(p)), "{p:?}");
        }
    }
    assert!(geometry.covering_spheres(10, &|_| false).is_empty());
    let mut builder = GeometryBuilder::new();
    let flat = Transform::scale(5.0, 5.0, 0.01).expect("it has an inverse");
    builder.add(Shape::Triangles(ball(3)), &still(flat), false);
    let spheres = builder.build().covering_spheres(256, &|_| true);
    let volume: f32 = spheres.iter().map(|sphere| sphere.radius.powi(3)).sum();
    assert!(volume < 0.2 * 125.0, "{volume} in {} balls", spheres.len());
}

/// A hundred thousand instances of a mesh of eight thousand triangles do not need a box for each part of each, nor their
/// product in time; all of them are covered.
#[test]
fn many_instances_are_covered_by_few_balls() {
    let mut builder = GeometryBuilder::new();
    let object = builder.begin_object();
    builder.add_to_object(object, Shape::Triangles(ball(5)), &Transform::IDENTITY, false);
    let place = |i: u32| Vector3::new((i % 317) as f32 * 3.0, 0.0, (i / 317) as f32 * 3.0);
    for i in 0..100_000 {
        builder.add_instance(object, &still(Transform::translate(place(i))));
    }
    let geometry = builder.build();
    let wanted = [0];
    assert_eq!(geometry.instance_boxes(&wanted).len(), 100_000);
    let spheres = geometry.covering_spheres(64, &|_| true);
    assert!(!spheres.is_empty() && spheres.len() <= 128);
    for i in (0..100_000).step_by(997) {
        let top = Point3::ORIGIN + place(i) + Vector3::new(0.0, 0.9, 0.0);
        assert!(spheres.iter().any(|sphere| sphere.contains(top)), "{top:?}");
    }
}
