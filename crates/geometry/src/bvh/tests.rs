use etendue_math::{Bounds3, Point3, Ray, Rng, Vector3, offset_ray_origin};

use super::build::Box3;
use super::lanes::{Lanes, Portable};
use super::node::{Node, leaf, leaf_range};
use super::{TraversalRay, intersect_triangle};
use crate::test_support::{any, ball, brute_force, cube, direction, point_in_cube, ray, single, soup};
use crate::{Hit, Shape, TriangleMesh};
use etendue_math::Transform;
use rayon::prelude::*;

fn slab(min: [f32; 3], max: [f32; 3], ray: &Ray, t_max: f32) -> bool {
    let mut node = Node::EMPTY;
    node.set(3, &Box3 { min, max }, 7);
    let bounds =
        Bounds3 { min: Point3::new(min[0], min[1], min[2]), max: Point3::new(max[0], max[1], max[2]) };
    let prepared = TraversalRay::new(&ray.into(), &bounds.into()).expect("the ray is finite");
    node.test(Portable, &prepared, Portable.splat(t_max)).0 == 1 << 3
}

/// SPEC ACC-7: a box is met exactly where three slabs overlap, also for directions along an axis.
#[test]
fn slabs_are_met_by_rays_along_axes_grazing_and_inside() {
    let check = |origin: [f32; 3], direction: [f32; 3], t_max: f32, expected: bool| {
        let ray = Ray::new(
            Point3::new(origin[0], origin[1], origin[2]),
            Vector3::new(direction[0], direction[1], direction[2]),
        );
        assert_eq!(slab([0.0; 3], [1.0; 3], &ray, t_max), expected, "{ray:?} up to {t_max}");
    };
    check([0.5, 0.5, -1.0], [0.0, 0.0, 1.0], f32::INFINITY, true);
    check([0.5, 0.5, -1.0], [0.0, 0.0, -1.0], f32::INFINITY, false);
    check([0.5, 0.5, -1.0], [-0.0, -0.0, 1.0], f32::INFINITY, true);
    check([0.5, 0.5, -1.0], [0.0, 0.0, 1.0], 0.9, false);
    check([1.5, 0.5, -1.0], [0.0, 0.0, 1.0], f32::INFINITY, false);
    // Inside, and inside a plane of the box.
    check([0.5, 0.5, 0.5], [1.0, 0.0, 0.0], f32::INFINITY, true);
    check([1.0, 0.5, -1.0], [0.0, 0.0, 1.0], f32::INFINITY, true);
    check([0.0, 0.0, -1.0], [0.0, -0.0, 1.0], f32::INFINITY, true);
    check([1.0, 1.0, -1.0], [-0.0, 0.0, 1.0], f32::INFINITY, true);
    // Through an edge and past it.
    check([-1.0, 0.0, 0.5], [1.0, 1.01, 0.0], f32::INFINITY, false);
    check([-1.0, 0.0, 0.5], [1.0, 1.0, 0.0], f32::INFINITY, true);
    check([-1.0, -1.0, 0.5], [1.0, 1.0, 0.0], f32::INFINITY, true);
    check([-1.0, 2.0, 0.5], [1.0, -1.0, 0.0], f32::INFINITY, true);
    check([0.5, 0.5, -1.0], [1e-30, 1e-42, 1.0], f32::INFINITY, true);
}

/// A ray without direction or with NaN meets nothing, and finds that out at once.
#[test]
fn rays_that_are_not_finite_meet_nothing() {
    let (geometry, _) = single(Shape::Triangles(ball(2)), Transform::IDENTITY, false);
    for bad in [f32::NAN, f32::INFINITY, f32::NEG_INFINITY] {
        let z = Vector3::new(0.0, 0.0, 1.0);
        assert!(geometry.intersect(&Ray::new(Point3::new(bad, 0.0, 0.0), z), 1e9, &any).is_none());
        let ray = Ray::new(Point3::ORIGIN, Vector3::new(0.0, bad, 1.0));
        assert!(geometry.intersect(&ray, 1e9, &any).is_none());
    }
    assert!(!geometry.occluded(&Ray::new(Point3::ORIGIN, Vector3::default()), 1e9, &any));
}

/// Leaves survive the packing into 32 bits.
#[test]
fn leaves_are_packed_without_loss() {
    for (kind, first, n) in [(1, 0, 1), (1, (1 << 27) - 1, 8), (2, 12_345, 3)] {
        let code = leaf(kind, first, n);
        assert_eq!(code >> 30, kind);
        assert_eq!(leaf_range(code), first..first + n);
    }
}

/// SPEC ACC-2, GEO-2: the hierarchy finds exactly what testing every triangle finds.
#[test]
fn accelerated_hits_are_those_of_brute_force() {
    for (n, size) in [(1, 0.5), (7, 0.5), (40, 0.3), (1500, 0.08), (3000, 0.5)] {
        let (geometry, _) = single(Shape::Triangles(soup(n, size, 7)), Transform::IDENTITY, false);
        let mut rng = Rng::new(11, n as u64);
        let mut n_hits = 0;
        for _ in 0..1000 {
            let ray = ray(&mut rng, 1.5);
            let expected = brute_force(&geometry, &ray);
            let found = geometry.intersect(&ray, f32::INFINITY, &any);
            assert_eq!(found.map(|hit| hit.t), expected, "{n} triangles, {ray:?}");
            assert_eq!(geometry.occluded(&ray, f32::INFINITY, &any), expected.is_some());
            if let Some(t) = expected {
                n_hits += 1;
                assert!(geometry.intersect(&ray, t, &any).is_none(), "t must lie below t_max");
                assert!(!geometry.occluded(&ray, t, &any));
                assert!(geometry.occluded(&ray, t.next_up(), &any));
            }
        }
        assert!(n == 1 || n_hits > 20, "{n} triangles, {n_hits} hits");
    }
}

/// SPEC EQ-3: x sees x' if and only if x' sees x. Segments that graze an edge within rounding may differ; of random ones
/// hardly any does.
#[test]
fn visibility_is_symmetric() {
    const N: u32 = 20_000;
    let (geometry, _) = single(Shape::Triangles(soup(300, 0.3, 5)), Transform::IDENTITY, false);
    let mut rng = Rng::new(3, 0);
    let (mut n_blocked, mut n_different) = (0, 0);
    for _ in 0..N {
        let (a, b) = (point_in_cube(&mut rng, 1.0), point_in_cube(&mut rng, 1.0));
        let there = geometry.occluded(&Ray::new(a, b - a), 1.0, &any);
        let back = geometry.occluded(&Ray::new(b, a - b), 1.0, &any);
        n_blocked += u32::from(there);
        n_different += u32::from(there != back);
    }
    assert!(n_blocked > N / 10 && n_blocked < N - N / 10, "{n_blocked} of {N} are blocked");
    assert!(n_different <= N / 10_000, "{n_different} of {N} differ");
}

/// A slope of 2 n^2 triangles over the square [0, n]^2.
fn grid(n: u32) -> TriangleMesh {
    let mut mesh = TriangleMesh::default();
    for (j, i) in (0..=n).flat_map(|j| (0..=n).map(move |i| (j, i))) {
        mesh.positions.push(Point3::new(i as f32, j as f32, 0.25 * (i as f32)));
    }
    for (j, i) in (0..n).flat_map(|j| (0..n).map(move |i| (j, i))) {
        let a = j * (n + 1) + i;
        mesh.indices.extend([[a, a + 1, a + n + 2], [a, a + n + 2, a + n + 1]]);
    }
    mesh
}

/// Axis-parallel rays through a regular grid run along edges and box planes; they must hit all the same.
#[test]
fn rays_along_grid_lines_hit() {
    const N: u32 = 16;
    let mesh = grid(N);
    let (geometry, _) = single(Shape::Triangles(mesh), Transform::IDENTITY, false);
    for j in 0..=4 * N {
        for i in 0..=4 * N {
            let (x, y) = (i as f32 * 0.25, j as f32 * 0.25);
            for (z, direction) in [(-7.0, 1.0), (9.0, -1.0)] {
                let ray = Ray::new(Point3::new(x, y, z), Vector3::new(0.0, -0.0, direction));
                let hit = geometry.intersect(&ray, f32::INFINITY, &any);
                let hit = hit.unwrap_or_else(|| panic!("nothing at {x}, {y} from {z}"));
                assert!((z + direction * hit.t - 0.25 * x).abs() < 1e-5);
            }
        }
    }
}

/// SPEC GEO-8: no ray leaves a closed surface, not even through an edge or a vertex.
#[test]
fn closed_surfaces_are_watertight() {
    for (name, mesh) in [("ball", ball(4)), ("cube", cube())] {
        for offset in [Vector3::default(), Vector3::new(37.1, -12.7, 81.3)] {
            let (geometry, _) = single(Shape::Triangles(mesh.clone()), Transform::translate(offset), false);
            let mut rng = Rng::new(3, 5);
            for i in 0..50_000_usize {
                let origin = point_in_cube(&mut rng, 0.3) + offset;
                let target = match i % 3 {
                    0 => origin + direction(&mut rng),
                    1 => mesh.positions[i % mesh.positions.len()] + offset,
                    _ => {
                        let [a, b, _] = mesh.indices[i % mesh.indices.len()];
                        let t = if i % 2 == 0 { 0.5 } else { rng.next_f32() };
                        mesh.positions[a as usize].lerp(mesh.positions[b as usize], t) + offset
                    }
                };
                let ray = Ray::new(origin, target - origin);
                assert!(geometry.intersect(&ray, f32::INFINITY, &any).is_some(), "{name} leaks: {ray:?}");
                assert!(geometry.occluded(&ray, f32::INFINITY, &any), "{name} leaks: {ray:?}");
            }
        }
    }
}

/// The same for rays that start on the surface, right beside edges and in corners, where the next wall is nearer than the
/// error of the distance to it.
#[test]
fn rays_do_not_slip_through_corners() {
    let (geometry, _) = single(Shape::Triangles(cube()), Transform::IDENTITY, false);
    let mut rng = Rng::new(31, 0);
    let mut n_departures = 0;
    for _ in 0..60_000 {
        // A point of the inside that is 1 in one coordinate and near 1 or -1 in another or two.
        let mut target = point_in_cube(&mut rng, 1.0);
        for axis in [rng.next_below(3) as usize, rng.next_below(3) as usize] {
            target[axis] = (1.0 - 10.0_f32.powf(-6.5 * rng.next_f32())).copysign(target[axis]);
        }
        let axis = rng.next_below(3) as usize;
        target[axis] = 1.0_f32.copysign(target[axis]);
        let ray = Ray::new(Point3::ORIGIN, target.as_vector().normalized());
        let hit = geometry.intersect(&ray, f32::INFINITY, &any).expect("a wall");
        let s = geometry.surface_point(&ray, &hit);
        for _ in 0..4 {
            let w = direction(&mut rng);
            let w = if s.ng.dot_vector(w) > 0.0 { -w } else { w };
            let departing = Ray::new(offset_ray_origin(s.p, s.p_error, s.ng, w), w);
            let next = geometry.intersect(&departing, f32::INFINITY, &any);
            assert!(next.is_some(), "{departing:?} leaves at {:?}", s.p);
            assert!(
                next.is_some_and(|next| next.primitive != hit.primitive),
                "{departing:?} stays at {:?}",
                s.p
            );
            n_departures += 1;
        }
    }
    assert_eq!(n_departures, 240_000);
}

/// Triangles without area or with corners that are no numbers do not exist for rays.
#[test]
fn degenerate_triangles_are_never_hit() {
    let p = Point3::new;
    let mut mesh = soup(200, 0.3, 5);
    let n = mesh.positions.len() as u32;
    mesh.positions.extend([
        p(0.0, 0.0, 0.0),
        p(1.0, 1.0, 1.0),
        p(2.0, 2.0, 2.0),
        p(f32::NAN, 0.0, 0.0),
        p(f32::INFINITY, 1.0, 0.0),
    ]);
    let n_good = mesh.indices.len();
    for bad in [[0, 1, 2], [0, 0, 1], [1, 1, 1], [0, 1, 3], [0, 3, 4], [0, 2, 4]] {
        mesh.indices.push(bad.map(|i| n + i));
    }
    let (geometry, _) = single(Shape::Triangles(mesh), Transform::IDENTITY, false);
    let bounds = geometry.bounds();
    assert!(bounds.min.is_finite() && bounds.max.x < 1.5, "{bounds:?}");
    let mut rng = Rng::new(1, 1);
    for _ in 0..2000 {
        let ray = ray(&mut rng, 1.0);
        if let Some(hit) = geometry.intersect(&ray, f32::INFINITY, &any) {
            assert!((hit.primitive as usize) < n_good);
            assert!(hit.t.is_finite());
        }
    }
    assert!(
        intersect_triangle(&Ray::new(p(0.0, 0.0, -1.0), Vector3::new(0.0, 0.0, 1.0)), &[[0.0; 3]; 3])
            .is_none()
    );
}

/// A refused candidate lets the ray pass to what lies behind.
#[test]
fn the_filter_sees_every_candidate_and_may_refuse_it() {
    let (geometry, _) = single(Shape::Triangles(cube()), Transform::IDENTITY, false);
    let ray = Ray::new(Point3::new(0.3, 0.2, 5.0), Vector3::new(0.0, 0.0, -1.0));
    let near = geometry.intersect(&ray, f32::INFINITY, &any).expect("the cube is ahead");
    assert!((near.t - 4.0).abs() < 1e-6);
    let refuse = |hit: &Hit| hit.primitive != near.primitive;
    let far = geometry.intersect(&ray, f32::INFINITY, &refuse).expect("the back of the cube");
    assert!((far.t - 6.0).abs() < 1e-6);
    assert!(geometry.occluded(&ray, f32::INFINITY, &refuse));
    assert!(!geometry.occluded(&ray, f32::INFINITY, &|_| false));
}

/// Hits of both kernels are the same to the last bit, whatever the mesh and wherever rays start.
#[test]
fn both_kernels_find_the_same_hits() {
    let n_rays = if std::env::var_os("ETENDUE_SLOW").is_some_and(|v| v == "1") { 15_000_000 } else { 10_000 };
    let shapes =
        [cube(), ball(2), ball(6), grid(16), soup(3, 0.5, 1), soup(1500, 0.08, 2), soup(3000, 0.5, 3)];
    let n_hits: usize =
        shapes.par_iter().enumerate().map(|(i, mesh)| same_hits(mesh, i as u64, n_rays)).sum();
    assert!(n_hits > n_rays, "{n_hits} hits");
}

/// Traces rays by both kernels; returns how many hit.
fn same_hits(mesh: &TriangleMesh, seed: u64, n_rays: usize) -> usize {
    let geometry = || single(Shape::Triangles(mesh.clone()), Transform::IDENTITY, false).0;
    let (geometry, portable) = (geometry(), geometry().traced_portably());
    let mut rng = Rng::new(17, seed);
    let mut n_hits = 0;
    for _ in 0..n_rays {
        let ray = kernel_ray(&mut rng, mesh);
        let t_max = if rng.next_below(4) == 0 { rng.next_f32() } else { f32::INFINITY };
        let hit = geometry.intersect(&ray, t_max, &any);
        n_hits += usize::from(hit.is_some());
        assert_eq!(hit, portable.intersect(&ray, t_max, &any), "{ray:?}");
        assert_eq!(hit.is_some(), geometry.occluded(&ray, t_max, &any), "{ray:?}");
        assert_eq!(hit.is_some(), portable.occluded(&ray, t_max, &any), "{ray:?}");
    }
    n_hits
}

/// A ray in any direction, along an axis, or towards a vertex or the middle of an edge.
fn kernel_ray(rng: &mut Rng, mesh: &TriangleMesh) -> Ray {
    let free = ray(rng, 1.5);
    let [a, b, _] = mesh.indices[rng.next_below(mesh.indices.len() as u32) as usize];
    let [a, b] = [a, b].map(|v| mesh.positions[v as usize]);
    match rng.next_below(8) {
        0 => Ray::new(free.origin, a - free.origin),
        1 => Ray::new(free.origin, a.lerp(b, 0.5) - free.origin),
        2 => Ray::new(a, free.direction),
        3 => {
            let mut along = Vector3::default();
            along[rng.next_below(3) as usize] = if rng.next_below(2) == 0 { 1.0 } else { -1.0 };
            Ray::new(free.origin, along)
        }
        _ => free,
    }
}

/// The hierarchy of a large mesh needs at most 70 bytes per triangle.
#[test]
fn memory_per_triangle_is_small() {
    let (geometry, _) = single(Shape::Triangles(ball(7)), Transform::IDENTITY, false);
    let n = geometry.counts().n_triangles;
    let bytes = geometry.hierarchy_bytes() as f64 / n as f64;
    assert!(n == 8 << 14 && bytes < 70.0, "{bytes} bytes for each of {n} triangles");
}
