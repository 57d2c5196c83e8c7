use etendue_math::{AnimatedTransform, Point3, Ray, Rng, Transform, Vector3};

use crate::test_support::{any, assert_close, ball, cube, ray, single, soup, still};
use crate::{Geometry, GeometryBuilder, Hit, NO_INSTANCE, Shape};

fn placements() -> Vec<Transform> {
    let translate = |x: f32, y: f32, z: f32| Transform::translate(Vector3::new(x, y, z));
    let turn = Transform::rotate(1.1, Vector3::new(1.0, -0.5, 0.3)).expect("an axis");
    let scale = Transform::scale(0.5, 1.4, -0.8).expect("invertible");
    vec![
        translate(2.0, 0.0, 0.0),
        translate(-2.0, 0.5, 0.0) * turn,
        translate(0.0, 2.0, 1.0) * scale,
        translate(0.0, -2.0, -1.0) * turn * scale,
    ]
}

/// Objects with triangles and with a sphere, twelve instances in one place, a moving one, and shapes of the world: a ray finds
/// what it finds where each of them is alone, to the last bit, by either kernel. Of equals the first instance counts.
#[test]
fn instances_are_found_among_others() {
    let elsewhere = Transform::translate(Vector3::new(1.0, 1.0, -2.0));
    let twelve = std::iter::repeat_n(still(elsewhere), 12);
    let moving = AnimatedTransform { end: placements()[3], ..still(placements()[0]) };
    let places: Vec<AnimatedTransform> =
        placements().into_iter().map(still).chain(twelve).chain([moving]).collect();
    let shapes = [Shape::Triangles(soup(300, 0.3, 3)), Shape::sphere(0.4)];
    let scene = |with_world: bool, with_instance: &dyn Fn(usize) -> bool| {
        let mut builder = GeometryBuilder::new();
        let objects = [builder.begin_object(), builder.begin_object()];
        builder.add_to_object(objects[0], shapes[0].clone(), &Transform::IDENTITY, false);
        builder.add_to_object(objects[1], shapes[0].clone(), &Transform::IDENTITY, false);
        builder.add_to_object(objects[1], shapes[1].clone(), &Transform::IDENTITY, false);
        for shape in shapes.iter().filter(|_| with_world) {
            builder.add(shape.clone(), &still(Transform::IDENTITY), false);
        }
        for (index, place) in places.iter().enumerate().filter(|(index, _)| with_instance(*index)) {
            builder.add_instance(objects[index % 2], place);
        }
        builder.build()
    };
    let (all, portable) = (scene(true, &|_| true), scene(true, &|_| true).traced_portably());
    let world = scene(true, &|_| false);
    let alone: Vec<_> = (0..places.len()).map(|own| scene(false, &|index| index == own)).collect();
    let mut rng = Rng::new(29, 0);
    let mut n_of_instances = vec![0; places.len()];
    for _ in 0..6000 {
        let ray = Ray { time: rng.next_f32(), ..ray(&mut rng, 3.0) };
        let t_max = if rng.next_below(4) == 0 { rng.next_f32() } else { f32::INFINITY };
        let found = all.intersect(&ray, t_max, &any);
        let of_instance = |(index, geometry): (usize, &Geometry)| {
            let hit = geometry.intersect(&ray, t_max, &any)?;
            Some(Hit { instance: index as u32, ..hit })
        };
        let hits = alone.iter().enumerate().filter_map(of_instance).chain(world.intersect(&ray, t_max, &any));
        let expected = hits.min_by(|a, b| a.t.total_cmp(&b.t).then(a.instance.cmp(&b.instance)));
        assert_eq!(found, expected, "{ray:?}");
        assert_eq!(found, portable.intersect(&ray, t_max, &any), "{ray:?}");
        assert_eq!(found.is_some(), all.occluded(&ray, t_max, &any), "{ray:?}");
        assert_eq!(found.is_some(), portable.occluded(&ray, t_max, &any), "{ray:?}");
        if let Some(n) = found.and_then(|hit| n_of_instances.get_mut(hit.instance as usize)) {
            *n += 1;
        }
    }
    // Behind the first two of the twelve, which are of either object.
    let unseen = n_of_instances.iter().filter(|n| **n == 0).count();
    assert_eq!(unseen, 10, "{n_of_instances:?}");
}

/// SPEC GEO-10: instances are hit like copies of the geometry, and shaded alike.
#[test]
fn instances_are_hit_like_copies() {
    let shapes = [Shape::Triangles(soup(300, 0.3, 3)), Shape::sphere(0.4)];
    let mut instanced = GeometryBuilder::new();
    let object = instanced.begin_object();
    for shape in &shapes {
        instanced.add_to_object(object, shape.clone(), &Transform::IDENTITY, false);
    }
    let mut copied = GeometryBuilder::new();
    for placement in placements() {
        instanced.add_instance(object, &still(placement));
        for shape in &shapes {
            copied.add(shape.clone(), &still(placement), false);
        }
    }
    let (instanced, copied) = (instanced.build(), copied.build());
    let mut rng = Rng::new(6, 0);
    let (mut n_hits, mut n_differences) = (0, 0);
    for _ in 0..5000 {
        let ray = ray(&mut rng, 3.0);
        let (a, b) =
            (instanced.intersect(&ray, f32::INFINITY, &any), copied.intersect(&ray, f32::INFINITY, &any));
        assert_eq!(a.is_some(), instanced.occluded(&ray, f32::INFINITY, &any));
        let (Some(a), Some(b)) = (a, b) else {
            n_differences += usize::from(a.is_some() != b.is_some());
            continue;
        };
        if (a.t - b.t).abs() > 1e-4 || a.primitive != b.primitive {
            // Rounding may decide otherwise at silhouettes.
            n_differences += 1;
            continue;
        }
        n_hits += 1;
        assert_eq!(a.geometry.0, b.geometry.0 % 2);
        assert_eq!((a.instance, b.instance), (b.geometry.0 / 2, NO_INSTANCE));
        let (da, db) = (instanced.surface_derivatives(&ray, &a), copied.surface_derivatives(&ray, &b));
        let (a, b) = (instanced.surface_point(&ray, &a), copied.surface_point(&ray, &b));
        assert_close(a.p.as_vector(), b.p.as_vector(), 2e-5);
        assert_close(a.ng.as_vector(), b.ng.as_vector(), 2e-3);
        let size = db.dpdu.length() + db.dpdv.length();
        assert_close(da.dpdu, db.dpdu, 2e-3 * size);
        assert_close(da.dpdv, db.dpdv, 2e-3 * size);
        assert_close(da.dndu, db.dndu, 2e-2 * (1.0 + db.dndu.length()));
    }
    assert!(n_hits > 1000 && n_differences <= 5, "{n_hits} hits, {n_differences} differences");
}

/// SPEC GEO-10: what an instance costs does not depend on what it shows.
#[test]
fn memory_per_instance_is_constant() {
    let bytes = |n_instances: usize, levels: u32| {
        let mut builder = GeometryBuilder::new();
        let object = builder.begin_object();
        builder.add_to_object(object, Shape::Triangles(ball(levels)), &Transform::IDENTITY, false);
        for i in 0..n_instances {
            let place = Transform::translate(Vector3::new(3.0 * i as f32, 0.0, 0.0));
            builder.add_instance(object, &still(place));
        }
        builder.build().memory_bytes()
    };
    let per_instance = |levels: u32| (bytes(1025, levels) - bytes(1, levels)) as f64 / 1024.0;
    let (small, large) = (per_instance(1), per_instance(5));
    assert!((small - large).abs() < 1.0 && large < 400.0, "{small} and {large} bytes");
    assert!(bytes(1025, 5) < 2 * bytes(1, 5));
}

/// A moving shape is found where its transform puts it at the time of the ray.
#[test]
fn moving_instances_are_hit_where_they_are() {
    let motion = AnimatedTransform {
        start: Transform::translate(Vector3::new(-4.0, 0.0, 0.0)),
        end: Transform::translate(Vector3::new(4.0, 0.0, 0.0)),
        start_time: 0.0,
        end_time: 2.0,
    };
    let mut builder = GeometryBuilder::new();
    let id = builder.add(Shape::sphere(0.5), &motion, false);
    let geometry = builder.build();
    assert!(!geometry.can_emit(id));
    for (time, x) in [(-1.0, -4.0), (0.0, -4.0), (0.5, -2.0), (1.0, 0.0), (1.5, 2.0), (3.0, 4.0)] {
        let ray = Ray { time, ..Ray::new(Point3::new(x, 0.0, 5.0), Vector3::new(0.0, 0.0, -1.0)) };
        let hit = geometry.intersect(&ray, f32::INFINITY, &any).expect("it is there");
        assert_eq!(hit.instance, 0);
        assert!((hit.t - 4.5).abs() < 1e-5);
        let s = geometry.surface_point(&ray, &hit);
        assert_close(s.p.as_vector(), Vector3::new(x, 0.0, 0.5), 1e-5);
        let elsewhere = Ray { origin: Point3::new(x + 1.0, 0.0, 5.0), ..ray };
        assert!(geometry.intersect(&elsewhere, f32::INFINITY, &any).is_none());
    }
}

/// A turning instance is never culled by the box of its motion.
#[test]
fn turning_instances_stay_in_their_box() {
    let axis = Vector3::new(0.0, 0.0, 1.0);
    let motion = AnimatedTransform {
        start: Transform::translate(Vector3::new(3.0, 0.0, 0.0)),
        end: Transform::rotate(2.5, axis).expect("an axis")
            * Transform::translate(Vector3::new(1.0, 1.0, 0.0)),
        start_time: 0.0,
        end_time: 1.0,
    };
    let mut builder = GeometryBuilder::new();
    let object = builder.begin_object();
    builder.add_to_object(object, Shape::Triangles(cube()), &Transform::IDENTITY, false);
    builder.add_instance(object, &motion);
    let geometry = builder.build();
    for step in 0..100 {
        let time = step as f32 / 99.0;
        let (copy, _) = single(Shape::Triangles(cube()), motion.at(time), false);
        let mut rng = Rng::new(8, step);
        for _ in 0..40 {
            let ray = Ray { time, ..ray(&mut rng, 5.0) };
            let expected = copy.intersect(&ray, f32::INFINITY, &any).map(|hit| hit.t);
            let found = geometry.intersect(&ray, f32::INFINITY, &any).map(|hit| hit.t);
            match (found, expected) {
                (Some(a), Some(b)) => assert!((a - b).abs() < 1e-4, "{a} {b}"),
                (None, None) => {}
                other => panic!("{other:?} at {time} for {ray:?}"),
            }
        }
    }
}

/// Instances of nothing, and a world of nothing, are no trouble.
#[test]
fn empty_scenes_answer() {
    let mut builder = GeometryBuilder::new();
    let ray = Ray::new(Point3::ORIGIN, Vector3::new(0.0, 0.0, 1.0));
    let nothing = GeometryBuilder::new().build();
    assert!(nothing.bounds().is_empty());
    assert!(nothing.intersect(&ray, f32::INFINITY, &any).is_none());
    assert!(!nothing.occluded(&ray, f32::INFINITY, &any));
    assert_eq!(nothing.counts(), crate::GeometryCounts::default());
    let object = builder.begin_object();
    builder.add_instance(object, &still(Transform::IDENTITY));
    builder.add(Shape::Triangles(crate::TriangleMesh::default()), &still(Transform::IDENTITY), false);
    let empty = builder.build();
    assert!(empty.bounds().is_empty());
    assert!(empty.intersect(&ray, f32::INFINITY, &any).is_none());
    assert_eq!(empty.counts().n_instances, 1);
}
