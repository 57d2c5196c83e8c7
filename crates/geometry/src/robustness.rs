//! Experiments with meshes as files have them: tiny, huge, far away, sheared, mirrored, without area.

use etendue_math::{Point3, Ray, Rng, Transform, Vector3};
use rayon::prelude::*;

use crate::test_support::{any, ball, cube, direction, point_in_cube, single, soup, still};
use crate::{Geometry, GeometryBuilder, Shape, TriangleMesh};

/// Rays for each mesh: 10⁸ in all if `ETENDUE_SLOW` is set.
fn n_rays() -> u64 {
    if std::env::var_os("ETENDUE_SLOW").is_some_and(|v| v == "1") { 12_500_000 } else { 6000 }
}

fn placed(mesh: &TriangleMesh, scale: f32, offset: Vector3) -> TriangleMesh {
    let place = |p: &Point3| Point3::ORIGIN + p.as_vector() * scale + offset;
    TriangleMesh { positions: mesh.positions.iter().map(place).collect(), ..mesh.clone() }
}

/// A ray from within half the size of a mesh around `centre` to a vertex, a point of an edge, or anywhere.
fn outward_ray(rng: &mut Rng, mesh: &TriangleMesh, centre: Vector3, size: f32) -> Ray {
    let origin = point_in_cube(rng, 0.3 * size) + centre;
    let [a, b, _] = mesh.indices[rng.next_below(mesh.indices.len() as u32) as usize];
    let [a, b] = [a, b].map(|v| mesh.positions[v as usize]);
    let along = match rng.next_below(4) {
        0 => a - origin,
        1 => a.lerp(b, 0.5) - origin,
        2 => a.lerp(b, rng.next_f32()) - origin,
        _ => direction(rng),
    };
    Ray::new(origin, along)
}

/// SPEC GEO-8: a closed mesh leaks no ray, aimed at vertices and edges or not, at any size, near the origin or far away.
#[test]
fn closed_meshes_of_any_size_leak_no_ray() {
    let far = Vector3::new(1.0, -0.7, 0.9);
    let places =
        [(1.0, 0.0), (1e-4, 0.0), (1e5, 0.0), (1e-4, 1.0), (1.0, 1e4), (1e5, 1e7), (1e-10, 0.0), (1e10, 0.0)];
    let mesh = ball(4);
    places.par_iter().enumerate().for_each(|(index, &(scale, distance))| {
        let offset = far * distance;
        let mesh = placed(&mesh, scale, offset);
        let (geometry, _) = single(Shape::Triangles(mesh.clone()), Transform::IDENTITY, false);
        let geometry = &geometry;
        (0..n_rays().div_ceil(1000)).into_par_iter().for_each(|chunk| {
            let mut rng = Rng::new(chunk, index as u64);
            for _ in 0..1000 {
                let ray = outward_ray(&mut rng, &mesh, offset, scale);
                let hit = geometry.intersect(&ray, f32::INFINITY, &any);
                assert!(hit.is_some(), "scale {scale} at {distance} leaks: {ray:?}");
            }
        });
    });
}

/// A group seen through a map that shears and mirrors is what its vertices after the map would be: the same hits, on the same side.
#[test]
fn sheared_and_mirrored_instances_are_like_copies() {
    let rows = [[1.0, 0.7, -0.2, 3.0], [0.1, -0.8, 0.4, -2.0], [0.3, 0.2, 1.4, 0.5], [0.0, 0.0, 0.0, 1.0]];
    let map = Transform::from_rows(rows).expect("invertible");
    assert!(map.swaps_handedness());
    for mesh in [cube(), ball(3)] {
        let mut builder = GeometryBuilder::new();
        let object = builder.begin_object();
        builder.add_to_object(object, Shape::Triangles(mesh.clone()), &Transform::IDENTITY, false);
        builder.add_instance(object, &still(map));
        let instance = builder.build();
        let (copy, _) = single(Shape::Triangles(mesh), map, false);
        let mut rng = Rng::new(12, 4);
        let (mut n_hits, mut n_different) = (0, 0);
        for _ in 0..20_000 {
            let ray = Ray::new(point_in_cube(&mut rng, 6.0), direction(&mut rng));
            let find = |geometry: &Geometry| {
                let hit = geometry.intersect(&ray, f32::INFINITY, &any)?;
                Some((hit.primitive, geometry.surface_point(&ray, &hit)))
            };
            match (find(&instance), find(&copy)) {
                (None, None) => {}
                (Some((i, a)), Some((j, b))) if i == j => {
                    n_hits += 1;
                    assert!(a.p.distance(b.p) < 1e-4 && a.ng.dot(b.ng) > 0.9999, "{a:?} {b:?}");
                }
                // Rays within rounding of an edge meet one triangle or the other.
                _ => n_different += 1,
            }
        }
        assert!(n_hits > 300 && n_different <= 5, "{n_hits} {n_different}");
    }
}

/// A million triangles without area, all in one place, on one line or in one plane, take time and hide nothing, but are not hit.
#[test]
fn a_million_triangles_without_area_are_not_there() {
    let mut mesh = soup(1000, 0.3, 4);
    let first = mesh.positions.len() as u32;
    let n_good = mesh.indices.len() as u32;
    let p = Point3::new;
    mesh.positions.extend([p(0.0, 0.0, 0.0), p(1.0, 1.0, 1.0), p(-1.0, -1.0, -1.0), p(0.5, 0.5, 0.5)]);
    let flat = [[0, 0, 0], [1, 2, 0], [0, 3, 1], [1, 1, 2], [2, 3, 2]];
    mesh.indices.extend((0..1_000_000).map(|i| flat[i % flat.len()].map(|v| first + v)));
    let (geometry, _) = single(Shape::Triangles(mesh.clone()), Transform::IDENTITY, false);
    mesh.indices.truncate(n_good as usize);
    let (good, _) = single(Shape::Triangles(mesh), Transform::IDENTITY, false);
    let mut rng = Rng::new(7, 7);
    for _ in 0..5000 {
        let ray = crate::test_support::ray(&mut rng, 1.2);
        let hit = |geometry: &Geometry| geometry.intersect(&ray, f32::INFINITY, &any);
        assert_eq!(hit(&geometry), hit(&good));
    }
}
