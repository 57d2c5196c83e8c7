use std::f64::consts::PI;

use etendue_math::{Normal3, Point3, Ray, Rng, Transform, Vector3, offset_ray_origin};

use super::*;
use crate::Shape;
use crate::test_support::{any, direction, single};

/// Points spread evenly over the unit sphere, along a spiral.
fn spiral(n: u32) -> Vec<Point3> {
    let golden = PI * (3.0 - 5.0_f64.sqrt());
    let point = |i: u32| {
        let z = 1.0 - (2.0 * f64::from(i) + 1.0) / f64::from(n);
        let (r, phi) = ((1.0 - z * z).sqrt(), golden * f64::from(i));
        Point3::new((r * phi.cos()) as f32, (r * phi.sin()) as f32, z as f32)
    };
    (0..n).map(point).collect()
}

fn sphere(n: u32, n_neighbours: u32) -> PointCloud {
    let positions = spiral(n);
    let normals = positions.iter().map(|p| p.as_vector().as_normal()).collect();
    PointCloud::with_local_radii(positions, normals, n_neighbours)
}

/// Rays meet a sphere of points where they meet the sphere: with no holes, within a small fraction of the radius of points, and with
/// its normals. For a mean over disks of radius r on the unit sphere the error is of the order r²: disks reach r²/2 above it.
#[test]
fn a_sphere_of_points_is_a_sphere() {
    let cloud = sphere(20_000, 8);
    let r = f64::from(cloud.radii.iter().fold(0.0_f32, |a, b| a.max(*b)));
    assert!((0.03..0.05).contains(&r), "{r}");
    let (geometry, _) = single(Shape::Points(cloud), Transform::IDENTITY, false);
    let mut rng = Rng::new(9, 0);
    let (mut n_hits, mut squares) = (0, 0.0);
    for _ in 0..4000 {
        let d = direction(&mut rng);
        let across = d.cross(direction(&mut rng)).normalized();
        let b = 1.1 * rng.next_f32();
        let ray = Ray::new(Point3::ORIGIN + across * b - d * 3.0, d);
        let hit = geometry.intersect(&ray, f32::INFINITY, &any);
        if f64::from(b) > 1.0 + r * r {
            assert!(hit.is_none(), "the outline is too large: {b}");
            continue;
        }
        if b > 0.999 {
            continue;
        }
        let hit = hit.expect("no holes within the outline");
        let point = geometry.surface_point(&ray, &hit);
        let expected = 3.0 - (1.0 - b * b).sqrt();
        let cosine = (1.0 - b * b).sqrt();
        let error = f64::from((hit.t - expected).abs());
        // A disk is met early by its height above the sphere over the cosine.
        assert!(error < 2.0 * r * r / f64::from(cosine) + 1e-5, "{error} at {b}");
        if b < 0.9 {
            let outside = point.p.as_vector().normalized();
            let sine = f64::from(point.ns.as_vector().cross(outside).length());
            let depth = f64::from((point.p.as_vector().length() - 1.0).abs());
            assert!(sine < r && depth < r * r, "{sine} {depth} at {b}");
            squares += sine * sine;
            n_hits += 1;
        }
    }
    let rms = (squares / f64::from(n_hits)).sqrt();
    assert!(rms < 0.25 * r, "normals are off by {rms} rad, for points of radius {r}");
}

/// Rays leave to both sides and cross the body once: what enters glass meets the far side and not its own.
#[test]
fn rays_cross_a_sphere_of_points_twice() {
    let (geometry, _) = single(Shape::Points(sphere(5000, 8)), Transform::IDENTITY, false);
    let mut rng = Rng::new(2, 7);
    for _ in 0..3000 {
        let d = direction(&mut rng);
        let across = d.cross(direction(&mut rng)).normalized() * (0.8 * rng.next_f32());
        let ray = Ray::new(Point3::ORIGIN + across - d * 2.0, d);
        let hit = geometry.intersect(&ray, f32::INFINITY, &any).expect("the front");
        let front = geometry.surface_point(&ray, &hit);
        assert!(front.ng.dot_vector(d) < 0.0);
        let inner = Ray::new(offset_ray_origin(front.p, front.p_error, front.ng, d), d);
        let hit = geometry.intersect(&inner, f32::INFINITY, &any).expect("the back");
        let back = geometry.surface_point(&inner, &hit);
        let depth = (back.p.as_vector().length() - 1.0).abs();
        assert!(depth < 0.01 && back.ng.dot_vector(d) > 0.0, "{ray:?} {front:?} {back:?}");
        assert!(back.p.distance(front.p) > 0.5);
        let outer = Ray::new(offset_ray_origin(back.p, back.p_error, back.ng, d), d);
        assert!(!geometry.occluded(&outer, f32::INFINITY, &any));
    }
}

/// Normals by neighbours are those of the sphere, all outside.
#[test]
fn normals_can_be_estimated() {
    let positions = spiral(3000);
    let normals = estimate_normals(&positions, 12);
    for (p, n) in positions.iter().zip(&normals) {
        assert!(n.dot_vector(p.as_vector()) > 0.999, "{p:?} {n:?}");
    }
    // Points on one line or in one place have no plane, but no number is wrong.
    let line: Vec<Point3> = (0..20).map(|i| Point3::new(i as f32, 0.0, 0.0)).collect();
    assert!(estimate_normals(&line, 5).iter().all(|n| n.is_finite() && n.x.abs() < 1e-3));
    assert!(estimate_normals(&[Point3::ORIGIN; 20], 5).iter().all(|n| *n == Normal3::default()));
    assert!(estimate_normals(&[], 5).is_empty());
}

/// Points scale and move with their transform, and bad ones are refused.
#[test]
fn points_are_placed_and_checked() {
    let scale = Transform::scale(2.0, 2.0, 2.0).expect("invertible");
    let (geometry, _) = single(Shape::Points(sphere(2000, 10)), scale, false);
    let ray = Ray::new(Point3::new(0.3, 0.0, 9.0), Vector3::new(0.0, 0.0, -1.0));
    let hit = geometry.intersect(&ray, f32::INFINITY, &any).expect("the sphere of radius 2");
    assert!((hit.t - (9.0 - (4.0_f32 - 0.09).sqrt())).abs() < 0.02, "{hit:?}");
    let cloud = sphere(50, 8);
    assert!(cloud.validate().is_ok());
    assert!(PointCloud { radii: vec![1.0], ..cloud.clone() }.validate().is_err());
    assert!(PointCloud { radii: vec![f32::NAN; 50], ..cloud.clone() }.validate().is_err());
    assert!(PointCloud { normals: Vec::new(), ..cloud }.validate().is_err());
    let zero =
        PointCloud { positions: vec![Point3::ORIGIN], normals: vec![Normal3::default()], radii: vec![1.0] };
    let (geometry, _) = single(Shape::Points(zero), Transform::IDENTITY, false);
    assert!(geometry.bounds().is_empty());
}
