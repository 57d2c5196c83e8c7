use etendue_math::statistics::{Moments, mean_test, sphere_chi_square};
use etendue_math::warp::spherical_triangle_solid_angle;
use etendue_math::{Normal3, Point2, Point3, Ray, Rng, Transform, Vector3};

use super::{FAR, FlatLamp};
use crate::test_support::single;
use crate::{BilinearMesh, Lamp, Reference, Shape, TriangleMesh};

/// Split of the significance of the suite over the cases here.
const SIGNIFICANCE: f64 = 1e-5;

/// Corners a, b, c and d of a parallelogram a, b, d, c.
const CORNERS: [[f32; 3]; 4] = [[-1.0, -0.5, 0.0], [1.0, 0.0, 0.3], [-0.5, 1.0, -0.2], [1.5, 1.5, 0.1]];

fn corners() -> [Point3; 4] {
    CORNERS.map(|[x, y, z]| Point3::new(x, y, z))
}

fn mesh(positions: [Point3; 4], indices: &[[u32; 3]]) -> TriangleMesh {
    TriangleMesh { positions: positions.to_vec(), indices: indices.to_vec(), ..TriangleMesh::default() }
}

fn lamp_of(shape: Shape) -> FlatLamp {
    let (geometry, id) = single(shape, Transform::IDENTITY, false);
    let lamp = geometry.joined_lamp(id).or_else(|| geometry.lamp(id, 0));
    let Some(Lamp::Flat(lamp)) = lamp else { panic!("no flat lamp") };
    lamp
}

fn joined(mesh: TriangleMesh) -> Option<Lamp> {
    let (geometry, id) = single(Shape::Triangles(mesh), Transform::IDENTITY, false);
    geometry.joined_lamp(id)
}

/// The halves of the parallelogram, and lamps on one half or on both.
fn lamps() -> Vec<(&'static str, FlatLamp, usize)> {
    let patch = BilinearMesh {
        positions: corners().to_vec(),
        indices: vec![[0, 1, 2, 3]],
        ..BilinearMesh::default()
    };
    vec![
        ("triangle", lamp_of(Shape::Triangles(mesh(corners(), &[[0, 1, 3]]))), 1),
        ("patch", lamp_of(Shape::Bilinear(patch)), 2),
        ("two triangles", lamp_of(Shape::Triangles(mesh(corners(), &[[0, 1, 3], [0, 3, 2]]))), 2),
        ("other diagonal", lamp_of(Shape::Triangles(mesh(corners(), &[[1, 2, 0], [3, 2, 1]]))), 2),
    ]
}

fn solid_angle(n_halves: usize, p: Point3) -> f32 {
    let [a, b, c, d] = corners();
    [[a, b, d], [a, d, c]][..n_halves].iter().map(|half| spherical_triangle_solid_angle(*half, p)).sum()
}

fn reference(x: f32, y: f32, z: f32) -> Reference {
    Reference { p: Point3::new(x, y, z), n: None }
}

/// Directions are distributed as `pdf_from` says of the point that a ray meets there: near by, where sampling is by
/// direction, and just beyond, where it is by area.
#[test]
fn directions_have_the_stated_density() {
    for (name, lamp, _) in lamps() {
        let away = Vector3::new(0.3, -0.4, 1.0).normalized() * (1.01 * FAR) * lamp.far_squared.sqrt() / FAR;
        let far = lamp.middle() + away;
        for (reference, is_near) in [
            (reference(0.1, 0.2, 0.9), true),
            (reference(1.4, 1.0, -0.7), true),
            (Reference { p: far, n: None }, false),
        ] {
            assert_eq!(lamp.near(reference.p).is_some(), is_near, "{name}");
            let sample = |rng: &mut Rng| {
                let (sample, pdf_w, _) = lamp.sample_from(&reference, rng.next_point2())?;
                assert!(pdf_w > 0.0 && pdf_w.is_finite());
                Some((sample.p - reference.p).normalized())
            };
            let pdf = |w: Vector3| {
                let hit = lamp.intersect(&Ray::new(reference.p, w));
                hit.map_or(0.0, |p| lamp.pdf_from(&reference, p))
            };
            let result = sphere_chi_square(40_000, 1, sample, pdf, SIGNIFICANCE);
            assert!(result.is_ok(), "{name}: {}", result.unwrap_err());
        }
    }
}

/// The mean of one over the density is the solid angle, and a sample agrees with itself by point and by area.
#[test]
fn densities_agree_with_each_other() {
    let mut rng = Rng::new(2, 0);
    for (name, lamp, n_halves) in lamps() {
        for reference in [reference(0.1, 0.2, 0.9), reference(2.0, -7.0, 5.0), reference(-60.0, 20.0, 50.0)] {
            let mut moments = Moments::default();
            for _ in 0..4000 {
                let (sample, pdf_w, place) =
                    lamp.sample_from(&reference, rng.next_point2()).expect("not seen edge on");
                let close =
                    |other: f32| assert!((other / pdf_w - 1.0).abs() < 1e-3, "{name} {other} {pdf_w}");
                close(lamp.pdf_from(&reference, sample.p));
                let offset = sample.p - reference.p;
                close(sample.pdf_a * offset.length_squared() / sample.n.abs_dot_vector(offset.normalized()));
                let end = if n_halves == 1 { 1.0 - place[0] } else { 1.0 };
                assert!(
                    (0.0..=1.0).contains(&place[0]) && place[1] >= 0.0 && place[1] <= end + 1e-6,
                    "{name}"
                );
                moments.push(f64::from(1.0 / pdf_w));
            }
            let expected = f64::from(solid_angle(n_halves, reference.p));
            let is_constant = moments.variance() < 1e-6 * expected * expected;
            let is_right = if is_constant {
                (moments.mean() / expected - 1.0).abs() < 1e-4
            } else {
                mean_test(&moments, expected, SIGNIFICANCE).is_ok()
            };
            assert!(is_right, "{name} {} {expected}", moments.mean());
        }
    }
}

/// Area, bounds and points by area.
#[test]
fn the_whole_of_a_lamp() {
    let [a, b, c, d] = corners();
    let area = (b - a).cross(c - a).length();
    for (name, lamp, n_halves) in lamps() {
        assert!((lamp.area() / (0.5 * n_halves as f32 * area) - 1.0).abs() < 1e-5, "{name}");
        for corner in &[a, b, d, c][..n_halves + 2] {
            assert!((0..3).all(|axis| {
                lamp.bounds().min[axis] <= corner[axis] + 1e-5
                    && lamp.bounds().max[axis] >= corner[axis] - 1e-5
            }));
        }
        let mut rng = Rng::new(3, 0);
        for _ in 0..100 {
            let u = Point2::new(0.01 + 0.98 * rng.next_f32(), 0.01 + 0.98 * rng.next_f32());
            let sample = lamp.sample_area(u);
            let ray = Ray::new(sample.p + sample.n.as_vector() * 0.5, -sample.n.as_vector());
            let found = lamp.intersect(&ray).expect("a point inside");
            assert!((found - sample.p).length() < 1e-5, "{name}");
        }
    }
}

/// Only two triangles that make a parallelogram and look the same way are one lamp.
#[test]
fn what_is_joined() {
    let [a, b, c, d] = corners();
    let halves = [[0, 1, 3], [0, 3, 2]];
    assert!(joined(mesh([a, b, c, d], &halves)).is_some());
    assert!(joined(mesh([a, b, c, d + Vector3::new(0.01, 0.0, 0.0)], &halves)).is_none(), "a kite");
    assert!(joined(mesh([a, b, c, d + Vector3::new(0.0, 0.0, 0.1)], &halves)).is_none(), "bent");
    assert!(joined(mesh([a, b, c, d], &[[0, 1, 3], [0, 2, 3]])).is_none(), "back to back");
    assert!(joined(mesh([a, b, c, d], &[[0, 1, 3], [0, 1, 2]])).is_none(), "overlapping");
    assert!(joined(mesh([a, b, c, d], &[[0, 1, 3], [3, 1, 0]])).is_none(), "twice the same");
    let up = Normal3::new(0.0, 0.0, 1.0);
    let smooth = |last| TriangleMesh { normals: vec![up, up, up, last], ..mesh([a, b, c, d], &halves) };
    assert!(joined(smooth(up)).is_some(), "vertex normals on one side");
    assert!(joined(smooth(-up)).is_none(), "vertex normals on both sides");
}

/// Patches that are parallelograms but for rounding leave the lamp's plane by no more than the stated error.
#[test]
fn bent_corners_are_within_the_error() {
    let [a, b, c, d] = corners();
    for bend in [0.0, 5e-7, -1.2e-6] {
        let d = d + Vector3::splat(bend);
        let patch = BilinearMesh {
            positions: vec![a, b, c, d],
            indices: vec![[0, 1, 2, 3]],
            ..BilinearMesh::default()
        };
        let lamp = lamp_of(Shape::Bilinear(patch));
        let sample = lamp.sample_area(Point2::splat(1.0));
        assert!((sample.p - d).abs().max_element() <= sample.p_error.x, "{bend}");
    }
}
