use etendue_math::{AnimatedTransform, Point3, Ray, Rng, Transform, Vector3};

use super::MovedVertices;
use crate::test_support::{any, ball, octahedron, point_in_cube, ray, single, soup, still};
use crate::{Geometry, GeometryBuilder, GeometryId, MeshError, Shape, TriangleMesh};

fn move_to(geometry: &mut Geometry, id: GeometryId, positions: Vec<Point3>) {
    let moved = MovedVertices { geometry: id, positions, normals: Vec::new() };
    geometry.move_vertices(vec![moved]).expect("the vertices are valid");
}

/// Fails unless both geometries answer alike.
#[track_caller]
fn check_same_hits(a: &Geometry, b: &Geometry, n_rays: usize) {
    let mut rng = Rng::new(17, 0);
    let mut n_hits = 0;
    for _ in 0..n_rays {
        let ray = ray(&mut rng, 1.5);
        let hit = a.intersect(&ray, f32::INFINITY, &any);
        n_hits += usize::from(hit.is_some());
        assert_eq!(hit, b.intersect(&ray, f32::INFINITY, &any), "{ray:?}");
        assert_eq!(a.occluded(&ray, f32::INFINITY, &any), hit.is_some(), "{ray:?}");
    }
    assert!(n_hits > n_rays / 20, "{n_hits} hits");
}

/// Builds `before`, moves its vertices to where `after` has them, and compares with a build of `after`.
#[track_caller]
fn check(before: &TriangleMesh, after: &TriangleMesh) {
    let (mut moved, id) = single(Shape::Triangles(before.clone()), Transform::IDENTITY, false);
    move_to(&mut moved, id, after.positions.clone());
    let (built, _) = single(Shape::Triangles(after.clone()), Transform::IDENTITY, false);
    assert_eq!(moved.bounds(), built.bounds());
    check_same_hits(&moved, &built, 3000);
}

fn bent(mesh: &TriangleMesh) -> TriangleMesh {
    let bend =
        |p: &Point3| Point3::new(p.x + 0.3 * (2.0 * p.y).sin(), 0.7 * p.y, p.z + 0.2 * (3.0 * p.x).cos());
    TriangleMesh { positions: mesh.positions.iter().map(bend).collect(), ..mesh.clone() }
}

/// SPEC ACC-8: hits after a refit are those of a new hierarchy, bit for bit.
#[test]
fn hits_after_moving_are_those_of_a_rebuild() {
    for mesh in [ball(5), soup(2000, 0.1, 4), soup(9, 0.9, 5), octahedron()] {
        check(&mesh, &bent(&mesh));
    }
    // Triangles that share corners but no vertices may come apart.
    let mut loose = TriangleMesh::default();
    let mesh = ball(3);
    for triangle in &mesh.indices {
        let n = loose.positions.len() as u32;
        loose.indices.push([n, n + 1, n + 2]);
        loose.positions.extend(triangle.map(|v| mesh.positions[v as usize]));
    }
    let mut apart = bent(&loose);
    let mut rng = Rng::new(2, 0);
    for p in &mut apart.positions {
        *p += point_in_cube(&mut rng, 0.02).as_vector();
    }
    check(&loose, &apart);
    check(&loose, &bent(&loose));
}

/// Triangles that lose or gain their area leave or enter the hierarchy.
#[test]
fn triangles_may_vanish_and_appear() {
    let mesh = ball(3);
    let mut flat = mesh.clone();
    for triangle in mesh.indices.iter().take(50) {
        let [a, b, _] = triangle.map(|v| v as usize);
        flat.positions[a] = flat.positions[b];
    }
    check(&mesh, &flat);
    check(&flat, &mesh);
    let nothing = TriangleMesh { positions: vec![Point3::ORIGIN; mesh.positions.len()], ..mesh.clone() };
    check(&nothing, &mesh);
}

/// A closed surface stays closed.
#[test]
fn a_moved_ball_is_watertight() {
    let mesh = ball(4);
    let (mut geometry, id) = single(Shape::Triangles(mesh.clone()), Transform::IDENTITY, false);
    let moved = bent(&mesh);
    move_to(&mut geometry, id, moved.positions.clone());
    let mut rng = Rng::new(3, 0);
    for i in 0..20_000 {
        let [a, b, _] = moved.indices[i % moved.indices.len()].map(|v| moved.positions[v as usize]);
        let target = if i % 2 == 0 { a } else { a.lerp(b, rng.next_f32()) };
        let origin = Point3::new(0.0, 0.0, 0.2) + point_in_cube(&mut rng, 0.05).as_vector();
        assert!(geometry.occluded(&Ray::new(origin, target - origin), f32::INFINITY, &any), "{target:?}");
    }
}

/// Instances go where their objects go, beside other shapes.
#[test]
fn instances_follow_their_objects() {
    let build = |mesh: TriangleMesh| {
        let mut builder = GeometryBuilder::new();
        let object = builder.begin_object();
        let id = builder.add_to_object(object, Shape::Triangles(mesh), &Transform::IDENTITY, false);
        builder.add_to_object(
            object,
            Shape::sphere(0.2),
            &Transform::translate(Vector3::new(0.0, 0.0, 0.9)),
            false,
        );
        for x in [-0.8, 0.8] {
            let place = Transform::translate(Vector3::new(x, 0.1, 0.0))
                * Transform::scale(0.6, 0.5, 0.4).expect("no factor is 0");
            builder.add_instance(object, &still(place));
        }
        let ends = [Vector3::new(0.0, -0.5, 0.0), Vector3::new(0.0, 0.5, 0.0)].map(Transform::translate);
        builder.add_instance(
            object,
            &AnimatedTransform { start: ends[0], start_time: 0.0, end: ends[1], end_time: 1.0 },
        );
        builder.add(Shape::Triangles(soup(50, 0.2, 8)), &still(Transform::IDENTITY), false);
        (builder.build(), id)
    };
    for mesh in
        [ball(2), TriangleMesh { positions: vec![Point3::ORIGIN; ball(2).positions.len()], ..ball(2) }]
    {
        let (mut moved, id) = build(mesh);
        let after = bent(&ball(2));
        move_to(&mut moved, id, after.positions.clone());
        check_same_hits(&moved, &build(after).0, 3000);
    }
}

/// Senseless arrays are refused and change nothing.
#[test]
fn invalid_vertices_are_refused() {
    let (mut geometry, id) = single(Shape::Triangles(ball(1)), Transform::IDENTITY, false);
    let (before, n) = (geometry.bounds(), ball(1).positions.len());
    let mut check = |positions: Vec<Point3>, expected: MeshError| {
        let moved = MovedVertices { geometry: id, positions, normals: Vec::new() };
        assert_eq!(geometry.move_vertices(vec![moved]), Err(expected));
    };
    check(Vec::new(), MeshError::WrongLength { array: "positions", found: 0, expected: n });
    check(vec![Point3::splat(f32::NAN); n], MeshError::NotFinite { array: "positions", vertex: 0 });
    assert_eq!(geometry.bounds(), before);
    let (mut geometry, id) = single(Shape::sphere(1.0), Transform::IDENTITY, false);
    let moved = MovedVertices { geometry: id, positions: vec![Point3::ORIGIN], normals: Vec::new() };
    let expected = MeshError::WrongLength { array: "positions", found: 1, expected: 0 };
    assert_eq!(geometry.move_vertices(vec![moved]), Err(expected));
}
