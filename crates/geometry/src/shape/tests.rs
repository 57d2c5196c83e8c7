mod implicit;
mod revolved;

use std::f32::consts::{FRAC_PI_2, PI, TAU};

use etendue_math::{Normal3, Point2, Point3, Ray, Rng, Transform, Vector3, offset_ray_origin};
use glam::DVec3;

use super::plane::intersect_plane;
use crate::test_support::{any, assert_close, ball, direction, octahedron, point_in_cube, single};
use crate::{BilinearMesh, Geometry, Hit, Shape, SurfaceDerivatives, SurfacePoint, TriangleMesh};

fn hit(geometry: &Geometry, origin: [f32; 3], direction: [f32; 3]) -> Option<(Hit, SurfacePoint)> {
    let ray = Ray::new(
        Point3::new(origin[0], origin[1], origin[2]),
        Vector3::new(direction[0], direction[1], direction[2]),
    );
    let hit = geometry.intersect(&ray, f32::INFINITY, &any)?;
    Some((hit, geometry.surface_point(&ray, &hit)))
}

/// The same with derivatives.
fn hit_with_derivatives(
    geometry: &Geometry,
    origin: [f32; 3],
    direction: [f32; 3],
) -> Option<(SurfacePoint, SurfaceDerivatives)> {
    let (hit, point) = hit(geometry, origin, direction)?;
    let ([ox, oy, oz], [dx, dy, dz]) = (origin, direction);
    let ray = Ray::new(Point3::new(ox, oy, oz), Vector3::new(dx, dy, dz));
    Some((point, geometry.surface_derivatives(&ray, &hit)))
}

fn at(shape: &Shape, origin: [f32; 3], direction: [f32; 3]) -> Option<(Hit, SurfacePoint)> {
    hit(&single(shape.clone(), Transform::IDENTITY, false).0, origin, direction)
}

fn disk(radius: f32) -> Shape {
    Shape::Disk { height: 0.0, radius, inner_radius: 0.0, phi_max_rad: TAU }
}

fn cylinder() -> Shape {
    Shape::Cylinder { radius: 1.0, z_min: -1.0, z_max: 1.0, phi_max_rad: TAU }
}

fn bent_patch() -> BilinearMesh {
    let p = Point3::new;
    BilinearMesh {
        positions: vec![p(-1.0, -1.0, 0.0), p(1.0, -1.2, 0.5), p(-1.1, 1.0, 0.6), p(1.0, 1.0, -0.4)],
        indices: vec![[0, 1, 2, 3]],
        ..BilinearMesh::default()
    }
}

fn square() -> BilinearMesh {
    let p = Point3::new;
    BilinearMesh {
        positions: vec![p(0.0, 0.0, 0.0), p(2.0, 0.0, 0.0), p(0.0, 3.0, 0.0), p(2.0, 3.0, 0.0)],
        indices: vec![[0, 1, 2, 3]],
        ..BilinearMesh::default()
    }
}

fn triangle() -> TriangleMesh {
    let p = Point3::new;
    TriangleMesh {
        positions: vec![p(0.0, 0.0, 0.0), p(1.0, 0.0, 0.0), p(0.0, 1.0, 0.0)],
        indices: vec![[0, 1, 2]],
        ..TriangleMesh::default()
    }
}

/// SPEC GEO-4: a ray meets a plane where the distance to the plane reaches zero.
#[test]
fn planes_are_met_where_the_distance_vanishes() {
    let n = DVec3::new(0.0, 0.6, 0.8);
    let o = DVec3::new(1.0, 2.0, 3.0);
    let d = DVec3::new(0.1, -0.2, -1.0);
    let t = intersect_plane(n, -1.5, o, d).expect("not parallel");
    assert!((n.dot(o + d * t) - 1.5).abs() < 1e-14);
    assert!(intersect_plane(DVec3::Z, 0.0, o, DVec3::X).is_none());
    assert_eq!(intersect_plane(DVec3::Z, 0.0, DVec3::new(0.0, 0.0, -2.0), -DVec3::Z), Some(-2.0));
}

/// SPEC GEO-3: one root in front, two, none behind, one from inside.
#[test]
fn spheres_are_hit_at_the_roots_of_the_quadratic() {
    let sphere = Shape::sphere(2.0);
    let t = |origin, direction| at(&sphere, origin, direction).map(|(hit, _)| hit.t);
    assert_eq!(t([0.0, 0.0, -5.0], [0.0, 0.0, 1.0]), Some(3.0));
    assert_eq!(t([0.0, 0.0, 5.0], [0.0, 0.0, 1.0]), None);
    assert_eq!(t([0.0, 0.0, 0.0], [0.0, 1.0, 0.0]), Some(2.0));
    assert_eq!(t([1.0, 0.0, 0.0], [1.0, 0.0, 0.0]), Some(1.0));
    // Tangent: just inside hits near the point of touch, just outside misses.
    let touch = t([1.999_999, -4.0, 0.0], [0.0, 1.0, 0.0]).expect("inside the outline");
    assert!((touch - 4.0).abs() < 3e-3, "{touch}");
    assert_eq!(t([2.0, -4.0, 0.0], [0.0, 1.0, 0.0]), Some(4.0));
    assert_eq!(t([2.000_001, -4.0, 0.0], [0.0, 1.0, 0.0]), None);
    // Far away cancellation must not matter.
    let far = t([0.0, 1.0, 1e6], [0.0, 0.0, -1.0]).expect("straight ahead");
    assert!((f64::from(far) - (1e6 - 3.0_f64.sqrt())).abs() < 0.07, "{far}");
    assert!(t([0.0, 2.000_1, 1e6], [0.0, 0.0, -1.0]).is_none());
    // The length of the direction only scales t.
    assert_eq!(t([0.0, 0.0, -5.0], [0.0, 0.0, 4.0]), Some(0.75));
}

/// The parameters of quadrics are those of pbrt-v4, and partial ones end where they say.
#[test]
fn partial_quadrics_have_the_stated_extent_and_parameters() {
    let part = Shape::Sphere { radius: 1.0, z_min: -0.5, z_max: 0.5, phi_max_rad: PI };
    let (_, s) = at(&part, [0.0, 3.0, 0.0], [0.0, -1.0, 0.0]).expect("azimuth pi / 2");
    assert!((s.uv.x - 0.5).abs() < 1e-6 && (s.uv.y - 0.5).abs() < 1e-6, "{s:?}");
    // Azimuth 3 pi / 2 is cut off: the ray passes and meets the other side from within.
    let (inner, _) = at(&part, [0.0, -3.0, 0.0], [0.0, 1.0, 0.0]).expect("the far side");
    assert!((inner.t - 4.0).abs() < 1e-6);
    assert!(at(&part, [0.0, 0.0, 3.0], [0.0, 0.0, -1.0]).is_none());
    let (_, top) = at(&part, [3.0, 1e-3, 0.499], [-1.0, 0.0, 0.0]).expect("near z_max");
    assert!(top.uv.y > 0.99, "v grows towards z_max: {:?}", top.uv);
    let (_, north) = at(&Shape::sphere(1.0), [1e-3, 0.0, 3.0], [0.0, 0.0, -1.0]).expect("the pole");
    assert!(north.uv.y > 0.99);

    let ring = Shape::Disk { height: 1.0, radius: 2.0, inner_radius: 1.0, phi_max_rad: PI };
    let (_, s) = at(&ring, [0.0, 1.25, 5.0], [0.0, 0.0, -1.0]).expect("on the ring");
    assert!((s.uv.x - 0.5).abs() < 1e-6 && (s.uv.y - 0.75).abs() < 1e-6);
    assert_eq!(s.ng, Normal3::new(0.0, 0.0, 1.0));
    for outside in [[0.0, 0.9, 5.0], [0.0, 2.1, 5.0], [0.0, -1.5, 5.0]] {
        assert!(at(&ring, outside, [0.0, 0.0, -1.0]).is_none());
    }
    assert!(at(&ring, [0.0, 1.5, 1.0], [1.0, 0.0, 0.0]).is_none(), "edge on");

    let tube = Shape::Cylinder { radius: 1.0, z_min: -1.0, z_max: 3.0, phi_max_rad: PI };
    let (_, s) = at(&tube, [0.0, 3.0, 0.0], [0.0, -1.0, 0.0]).expect("azimuth pi / 2");
    assert!((s.uv.x - 0.5).abs() < 1e-6 && (s.uv.y - 0.25).abs() < 1e-6);
    assert_close(s.ng.as_vector(), Vector3::new(0.0, 1.0, 0.0), 1e-6);
    assert!(at(&tube, [0.0, 3.0, 3.1], [0.0, -1.0, 0.0]).is_none());
    assert!(at(&tube, [0.0, 0.0, -5.0], [0.0, 0.0, 1.0]).is_none(), "along the axis");
}

/// dp/du, dp/dv and the derivatives of the normal are those of the surface: checked by moving the ray a little.
#[test]
fn derivatives_are_those_of_the_surface() {
    let mut curved_triangle = triangle();
    curved_triangle.normals =
        vec![Normal3::new(-0.3, -0.2, 1.0), Normal3::new(0.5, 0.0, 1.0), Normal3::new(0.0, 0.4, 0.7)];
    curved_triangle.uvs = vec![Point2::new(0.1, 0.2), Point2::new(0.9, 0.3), Point2::new(0.2, 1.1)];
    let mut mapped_patch = bent_patch();
    mapped_patch.uvs =
        vec![Point2::new(0.0, 0.1), Point2::new(0.8, 0.0), Point2::new(0.2, 1.0), Point2::new(1.3, 0.9)];
    let mut smooth_patch = mapped_patch.clone();
    smooth_patch.normals = vec![
        Normal3::new(-0.3, -0.2, 1.0),
        Normal3::new(0.5, 0.0, 1.0),
        Normal3::new(0.0, 0.4, 0.7),
        Normal3::new(0.2, 0.4, 0.9),
    ];
    let shapes = [
        Shape::sphere(1.3),
        disk(1.5),
        Shape::Triangles(curved_triangle),
        Shape::Bilinear(bent_patch()),
        Shape::Bilinear(mapped_patch),
        Shape::Bilinear(smooth_patch),
    ];
    let stretch = Transform::scale(1.0, 0.7, 1.4).expect("invertible");
    for (index, shape) in shapes.into_iter().enumerate() {
        for transform in [Transform::IDENTITY, stretch] {
            for reverse in [false, true] {
                let (geometry, _) = single(shape.clone(), transform, reverse);
                let probe = |x: f32, y: f32| {
                    hit_with_derivatives(&geometry, [x, y, 4.0], [0.0, 0.0, -1.0]).expect("a hit")
                };
                let (here, d) = probe(0.3, 0.25);
                for step in [[2e-3, 0.0], [0.0, 2e-3]] {
                    let ahead = probe(0.3 + step[0], 0.25 + step[1]).0;
                    let behind = probe(0.3 - step[0], 0.25 - step[1]).0;
                    let (du, dv) = (ahead.uv.x - behind.uv.x, ahead.uv.y - behind.uv.y);
                    let dp = d.dpdu * du + d.dpdv * dv;
                    assert_close(dp / 4e-3, (ahead.p - behind.p) / 4e-3, 3e-3);
                    let dn = d.dndu * du + d.dndv * dv;
                    let expected = (ahead.ns - behind.ns).as_vector();
                    assert!(
                        ((dn - expected) / 4e-3).length() < 3e-3,
                        "shape {index}: {dn:?} is not {expected:?}"
                    );
                }
                assert!(here.ns.dot(here.ng) > 0.0);
                assert!(d.shading_dpdu.abs_dot_normal(here.ns) < 1e-5 * d.shading_dpdu.length());
                assert!(d.shading_dpdv.abs_dot_normal(here.ns) < 1e-5 * d.shading_dpdv.length());
            }
        }
    }
}

/// The side of the normal: outwards, turned over by reversed orientation only, whatever mirrors the shape.
#[test]
fn normals_keep_their_side() {
    let mirror = Transform::scale(-1.0, 1.0, 1.0).expect("invertible");
    let turn = Transform::rotate(0.4, Vector3::new(1.0, 2.0, -1.0)).expect("an axis");
    for transform in [Transform::IDENTITY, mirror, turn, mirror * turn] {
        for reverse in [false, true] {
            let sign = if reverse { -1.0 } else { 1.0 };
            for shape in [Shape::sphere(1.0), Shape::Triangles(octahedron()), cylinder()] {
                let (geometry, _) = single(shape, transform, reverse);
                let (_, s) = hit(&geometry, [0.1, 0.2, 0.1], [0.7, 0.3, 0.2]).expect("from inside");
                assert!(sign * s.ng.dot_vector(s.p.as_vector()) > 0.0, "{transform:?} {reverse}");
                assert_eq!(s.ng, s.ns);
            }
            // With vertex normals they decide, and reversal turns them.
            for n in [Normal3::new(0.1, 0.2, 1.0), Normal3::new(0.1, 0.2, -1.0)] {
                let mesh = TriangleMesh { normals: vec![n; 3], ..triangle() };
                let (geometry, id) = single(Shape::Triangles(mesh), transform, reverse);
                let up = transform.vector(Vector3::new(0.0, 0.0, 1.0));
                let target = transform.point(Point3::new(0.2, 0.2, 0.0));
                let ray = Ray::new(target + up, -up);
                let hit = geometry.intersect(&ray, f32::INFINITY, &any).expect("straight below");
                let s = geometry.surface_point(&ray, &hit);
                assert!(sign * n.z * s.ng.dot_vector(up) > 0.0);
                assert!(s.ng.dot(s.ns) > 0.0);
                let sample = geometry.sample_area(id, 0, Point2::new(0.3, 0.4)).expect("it has an area");
                assert!(sample.n.dot(s.ng) > 0.999);
                assert!(geometry.emission_cone(id, 0).0.dot_normal(s.ng) > 0.999);
            }
        }
    }
}

/// Without texture coordinates triangles carry (0,0), (1,0), (1,1); patches their own u and v.
#[test]
fn default_texture_coordinates_are_those_of_pbrt() {
    let (_, s) = at(&Shape::Triangles(triangle()), [0.5, 0.25, 1.0], [0.0, 0.0, -1.0]).expect("a hit");
    assert!((s.uv.x - 0.75).abs() < 1e-6 && (s.uv.y - 0.25).abs() < 1e-6, "{:?}", s.uv);
    let (_, s) = at(&Shape::Bilinear(square()), [0.5, 0.75, 1.0], [0.0, 0.0, -1.0]).expect("a hit");
    assert!((s.uv.x - 0.25).abs() < 1e-6 && (s.uv.y - 0.25).abs() < 1e-6, "{:?}", s.uv);
    let degenerate = TriangleMesh { uvs: vec![Point2::new(0.5, 0.5); 3], ..triangle() };
    let (geometry, _) = single(Shape::Triangles(degenerate), Transform::IDENTITY, false);
    let (_, d) = hit_with_derivatives(&geometry, [0.25, 0.25, 1.0], [0.0, 0.0, -1.0]).expect("a hit");
    assert!(d.dpdu.cross(d.dpdv).length() > 0.5, "tangents exist all the same");
}

/// Tangents given with the mesh direct the shading frame.
#[test]
fn mesh_tangents_direct_the_shading_frame() {
    let tangent = Vector3::new(0.6, 0.8, 0.3);
    let mesh = TriangleMesh { tangents: vec![tangent; 3], ..triangle() };
    let (geometry, _) = single(Shape::Triangles(mesh), Transform::IDENTITY, false);
    let (_, d) = hit_with_derivatives(&geometry, [0.25, 0.25, 1.0], [0.0, 0.0, -1.0]).expect("a hit");
    assert_close(d.shading_dpdu, Vector3::new(0.6, 0.8, 0.0), 1e-6);
    assert_close(d.shading_dpdv, Vector3::new(-0.8, 0.6, 0.0), 1e-6);
}

/// A bilinear patch is hit where its equation says, and twice if the ray passes it twice.
#[test]
fn patches_are_hit_on_their_surface() {
    let (geometry, _) = single(Shape::Bilinear(bent_patch()), Transform::IDENTITY, false);
    let mut rng = Rng::new(5, 0);
    let mut n_hits = 0;
    for _ in 0..5000 {
        let ray = crate::test_support::ray(&mut rng, 1.5);
        let Some(hit) = geometry.intersect(&ray, f32::INFINITY, &any) else { continue };
        let s = geometry.surface_point(&ray, &hit);
        assert_close(s.p.as_vector(), ray.at(hit.t).as_vector(), 2e-5);
        n_hits += 1;
        let behind = geometry.intersect(&ray, f32::INFINITY, &|other| other.t > hit.t);
        assert!(behind.is_none_or(|other| other.t > hit.t));
    }
    assert!(n_hits > 500, "{n_hits}");
}

/// Self-intersection: a ray that leaves by the error bound does not meet the surface it left, and a ray back does.
#[test]
fn rays_leave_surfaces_and_come_back() {
    let far = Transform::translate(Vector3::new(130.0, -70.0, 40.0));
    let turn = Transform::rotate(0.7, Vector3::new(1.0, 2.0, 3.0)).expect("an axis");
    let scale = Transform::scale(3.0, 0.2, 1.7).expect("invertible");
    let shapes = [
        Shape::sphere(1.0),
        disk(1.0),
        cylinder(),
        Shape::Triangles(ball(3)),
        Shape::Triangles(triangle()),
        Shape::Bilinear(square()),
    ];
    let mut rng = Rng::new(17, 0);
    for shape in shapes {
        for transform in [Transform::IDENTITY, far, far * turn * scale] {
            for instanced in [false, true] {
                let geometry = if instanced {
                    let mut builder = crate::GeometryBuilder::new();
                    let object = builder.begin_object();
                    builder.add_to_object(object, shape.clone(), &Transform::IDENTITY, false);
                    builder.add_instance(object, &crate::test_support::still(transform));
                    builder.build()
                } else {
                    single(shape.clone(), transform, false).0
                };
                check_departures(&geometry, &transform, &mut rng);
            }
        }
    }
}

/// All shapes of the test are convex or flat, so that a ray which departs outwards meets nothing.
fn check_departures(geometry: &Geometry, transform: &Transform, rng: &mut Rng) {
    let (mut n_hits, mut n_returns, mut n_missed) = (0, 0, 0);
    for _ in 0..400 {
        let from = transform.point(Point3::ORIGIN + direction(rng) * 3.0);
        let to = transform.point(point_in_cube(rng, 0.9));
        let ray = Ray::new(from, (to - from).normalized());
        let Some(hit) = geometry.intersect(&ray, f32::INFINITY, &any) else { continue };
        n_hits += 1;
        let s = geometry.surface_point(&ray, &hit);
        let towards_viewer = s.ng.facing(-ray.direction);
        for _ in 0..8 {
            let w = direction(rng);
            let w = if towards_viewer.dot_vector(w) < 0.0 { -w } else { w };
            if towards_viewer.dot_vector(w) < 1e-4 || s.ng.dot(towards_viewer) < 0.0 {
                continue;
            }
            let departing = Ray::new(offset_ray_origin(s.p, s.p_error, s.ng, w), w);
            let again = geometry.intersect(&departing, f32::INFINITY, &any);
            assert!(again.is_none(), "left {s:?} along {w:?}, met {again:?}");
            // A grazing line may pass between the offset and the curve of the surface, or beyond its border.
            if towards_viewer.dot_vector(w) > 0.2 {
                let back = Ray::new(departing.at(0.5), -w);
                n_returns += 1;
                n_missed += usize::from(!geometry.occluded(&back, 1.0, &any));
            }
        }
    }
    assert!(n_hits > 20, "{n_hits}");
    assert!(n_missed * 50 <= n_returns, "{n_missed} of {n_returns} rays back missed");
}

/// A whole sphere has no hole at its poles, where rounding may put z beyond the radius.
#[test]
fn spheres_are_closed_at_the_poles() {
    let mut rng = Rng::new(29, 0);
    for radius in [0.3, 1.0, 50.0, 77.7] {
        let (geometry, _) = single(Shape::sphere(radius), Transform::IDENTITY, false);
        for pole in [radius, -radius] {
            for _ in 0..500 {
                let from = Point3::ORIGIN + direction(&mut rng) * (2.0 * radius);
                let to = Point3::new(0.0, 0.0, pole);
                if (from.z - pole) * pole <= 0.1 * radius * radius {
                    continue;
                }
                let ray = Ray::new(from, (to - from).normalized());
                let hit = geometry.intersect(&ray, f32::INFINITY, &any).expect("the pole");
                assert!((hit.t / (to - from).length() - 1.0).abs() < 1e-4, "{ray:?} {hit:?}");
            }
        }
    }
}

/// Rays leave shapes too that are wide and pass through the origin: there coordinates vanish and with them the rounding of the
/// point, while the arithmetic of the intersection still rounds numbers of the shape's size.
#[test]
fn rays_leave_wide_shapes_at_the_origin() {
    let patch = |size: f32| {
        let mut patch = square();
        for p in &mut patch.positions {
            *p = Point3::new(size * (p.x - 0.4), size * (p.y - 0.7), 0.0);
        }
        Shape::Bilinear(patch)
    };
    let turn = Transform::rotate(0.7, Vector3::new(1.0, 2.0, 3.0)).expect("an axis");
    let below = |r: f32| Transform::translate(Vector3::new(0.0, 0.0, -r));
    let mut rng = Rng::new(19, 0);
    for size in [0.37, 50.0, 1000.0] {
        for transform in [Transform::IDENTITY, turn] {
            leave_near_origin(patch(size), transform, &mut rng);
            leave_near_origin(disk(size), transform, &mut rng);
            leave_near_origin(Shape::sphere(size), transform * below(size), &mut rng);
        }
    }
}

/// Aims at points near the origin from the outside, where the shape is convex or flat.
#[track_caller]
fn leave_near_origin(shape: Shape, transform: Transform, rng: &mut Rng) {
    let (geometry, _) = single(shape.clone(), transform, false);
    let mut n_departures = 0;
    for _ in 0..400 {
        let size = [0.3, 1e-3, 1e-9, 0.0][rng.next_u32() as usize % 4];
        let target = point_in_cube(rng, size);
        let up = transform.vector(Vector3::new(0.0, 0.0, 1.0));
        let view = (direction(rng) - up * 1.5).normalized();
        let ray = Ray::new(target - view * 3.0, view);
        let Some(hit) = geometry.intersect(&ray, f32::INFINITY, &any) else { continue };
        let s = geometry.surface_point(&ray, &hit);
        let side = s.ng.facing(-view);
        for _ in 0..8 {
            let w = direction(rng);
            let w = if side.dot_vector(w) < 0.0 { -w } else { w };
            let departing = Ray::new(offset_ray_origin(s.p, s.p_error, s.ng, w), w);
            let again = geometry.intersect(&departing, f32::INFINITY, &any);
            assert!(again.is_none(), "{shape:?} at {:?} towards {w:?}: {again:?}", s.p);
            n_departures += 1;
        }
    }
    assert!(n_departures > 500, "{n_departures}");
}

/// Quadrics of impossible size are left out instead of failing.
#[test]
fn impossible_quadrics_are_left_out() {
    for radius in [0.0, f32::NAN, f32::INFINITY] {
        for shape in [
            Shape::sphere(radius),
            disk(radius),
            Shape::Disk { height: f32::NAN, radius: 1.0, inner_radius: radius, phi_max_rad: TAU },
            Shape::Cylinder { radius, z_min: 0.0, z_max: 1.0, phi_max_rad: TAU },
        ] {
            let (geometry, _) = single(shape, Transform::IDENTITY, false);
            assert!(geometry.bounds().is_empty());
        }
    }
}

/// Areas add up to the closed forms.
#[test]
fn areas_are_those_of_the_closed_forms() {
    let check = |shape: Shape, transform: Transform, expected: f32| {
        let (geometry, id) = single(shape, transform, false);
        let sum: f32 = (0..geometry.n_primitives(id)).map(|i| geometry.area(id, i)).sum();
        assert!((sum / expected - 1.0).abs() < 1e-4, "{sum} instead of {expected}");
    };
    let id = Transform::IDENTITY;
    check(Shape::sphere(2.0), id, 16.0 * PI);
    check(Shape::Sphere { radius: 2.0, z_min: 0.0, z_max: 1.0, phi_max_rad: PI }, id, 2.0 * PI);
    check(Shape::Disk { height: 0.0, radius: 2.0, inner_radius: 1.0, phi_max_rad: FRAC_PI_2 }, id, 0.75 * PI);
    check(cylinder(), id, 4.0 * PI);
    check(Shape::Triangles(crate::test_support::cube()), id, 24.0);
    check(Shape::Bilinear(square()), id, 6.0);
    let twice = Transform::scale(2.0, 2.0, 2.0).expect("invertible");
    check(Shape::sphere(1.0), twice, 16.0 * PI);
    check(Shape::Triangles(crate::test_support::cube()), twice, 96.0);
    // A prolate spheroid with axes 1, 1, 2: 2 pi (1 + 2 asin(e) / e), e² = 3/4.
    let e = 0.75_f32.sqrt();
    let stretched = Transform::scale(1.0, 1.0, 2.0).expect("invertible");
    check(Shape::sphere(1.0), stretched, TAU * (1.0 + 2.0 * e.asin() / e));
    check(disk(1.0), Transform::scale(1.0, 3.0, 1.0).expect("invertible"), 3.0 * PI);
}
