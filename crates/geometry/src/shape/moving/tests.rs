use etendue_math::{Point3, Ray, Rng, Transform, Vector3};

use super::*;
use crate::Shape;
use crate::test_support::{any, ball, cube, direction, single};

/// A mesh that goes from where it is to where `end` takes its vertices.
fn moving(mesh: TriangleMesh, end: impl Fn(Point3) -> Point3) -> MovingMesh {
    let end_positions = mesh.positions.iter().map(|p| end(*p)).collect();
    MovingMesh { mesh, end_positions, end_normals: Vec::new(), times: [0.0, 1.0] }
}

/// At each time rays meet what they would meet of a mesh that stands still with its vertices on the way.
#[test]
fn moving_meshes_are_hit_as_they_are_at_the_time() {
    let bent = |p: Point3| Point3::new(p.x + 2.0 + p.z, 2.0 * p.y, p.z);
    let mesh = moving(ball(3), bent);
    let (geometry, _) = single(Shape::Moving(mesh.clone()), Transform::IDENTITY, false);
    let mut rng = Rng::new(1, 2);
    for time in [-1.0, 0.0, 0.25, 0.7, 1.0, 2.0_f32] {
        let way = time.clamp(0.0, 1.0);
        let places = mesh.mesh.positions.iter().zip(&mesh.end_positions);
        let positions = places.map(|(a, b)| a.lerp(*b, way)).collect();
        let still = TriangleMesh { positions, ..mesh.mesh.clone() };
        let (still, _) = single(Shape::Triangles(still), Transform::IDENTITY, false);
        let mut n_hits = 0;
        for _ in 0..500 {
            let mut ray = crate::test_support::ray(&mut rng, 3.0);
            ray.time = time;
            let (a, b) =
                (geometry.intersect(&ray, f32::INFINITY, &any), still.intersect(&ray, f32::INFINITY, &any));
            let key = |hit: crate::Hit| (hit.t, hit.primitive, hit.uv);
            assert_eq!(a.map(key), b.map(key));
            let (Some(a), Some(b)) = (a, b) else { continue };
            n_hits += 1;
            let (p, q) = (geometry.surface_point(&ray, &a), still.surface_point(&ray, &b));
            assert_eq!((p.p, p.ng, p.ns, p.uv), (q.p, q.ng, q.ns, q.uv));
        }
        assert!(n_hits > 10, "{n_hits} hits at {time}");
    }
}

/// A closed mesh stays closed while it moves: rays from inside aimed at edges and vertices do not get out.
#[test]
fn moving_meshes_are_watertight() {
    let mesh = moving(ball(3), |p| Point3::new(1.5 * p.x, p.y + 0.1 * p.z, 0.7 * p.z));
    let (starts, ends) = (mesh.mesh.positions.clone(), mesh.end_positions.clone());
    let (geometry, _) = single(Shape::Moving(mesh), Transform::IDENTITY, false);
    let mut rng = Rng::new(6, 6);
    for _ in 0..20_000 {
        let time = rng.next_f32();
        let vertex = rng.next_below(starts.len() as u32) as usize;
        let target = starts[vertex].lerp(ends[vertex], time);
        let origin = crate::test_support::point_in_cube(&mut rng, 0.2);
        for d in [target - origin, direction(&mut rng)] {
            let ray = Ray { origin, direction: d, time };
            assert!(geometry.intersect(&ray, f32::INFINITY, &any).is_some(), "{ray:?}");
        }
    }
}

/// A moving body leaves a streak: the time that a point of its way is covered is the length of the body over that of the way.
#[test]
fn motion_covers_each_place_for_its_share_of_time() {
    let mesh = moving(cube(), |p| p + Vector3::new(8.0, 0.0, 0.0));
    let (geometry, _) = single(Shape::Moving(mesh), Transform::IDENTITY, false);
    for (x, share) in [(0.0, 1.0 / 8.0), (4.0, 2.0 / 8.0), (8.5, 0.5 / 8.0), (9.5, 0.0), (-0.5, 0.5 / 8.0)] {
        let n = 10_000;
        let is_covered = |i: &u32| {
            let time = (*i as f32 + 0.5) / n as f32;
            let ray = Ray { origin: Point3::new(x, 0.1, 9.0), direction: Vector3::new(0.0, 0.0, -1.0), time };
            geometry.occluded(&ray, f32::INFINITY, &any)
        };
        let found = (0..n).filter(is_covered).count() as f32 / n as f32;
        assert!((found - share).abs() < 3.0 / n as f32, "{found} for {share} at {x}");
    }
}

/// Arrays of the second time are checked.
#[test]
fn arrays_at_the_end_are_checked() {
    let mesh = moving(cube(), |p| p);
    assert!(mesh.validate().is_ok());
    assert!(MovingMesh { end_positions: Vec::new(), ..mesh.clone() }.validate().is_err());
    assert!(MovingMesh { end_normals: vec![Normal3::default(); 8], ..mesh.clone() }.validate().is_err());
    let mut nan = mesh;
    nan.end_positions[3].x = f32::NAN;
    assert!(nan.validate().is_err());
}
