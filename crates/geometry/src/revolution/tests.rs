use std::f64::consts::PI;

use etendue_math::{Point2, Ray, Rng, Transform};

use super::*;
use crate::Shape;
use crate::test_support::{any, direction, single};

fn contour(points: &[[f32; 2]]) -> Vec<Point2> {
    points.iter().map(|&[h, r]| Point2::new(h, r)).collect()
}

fn half_circle(n: usize) -> Vec<Point2> {
    let point = |i: usize| {
        let theta = PI * i as f64 / n as f64;
        let radius = if i == 0 || i == n { 0.0 } else { theta.sin() };
        Point2::new(-theta.cos() as f32, radius as f32)
    };
    (0..=n).map(point).collect()
}

/// Signed volume inside a mesh, by tetrahedra from the origin.
fn volume(mesh: &TriangleMesh) -> f64 {
    let corner = |i: u32| crate::double::point(mesh.positions[i as usize]);
    let tetrahedron = |&[a, b, c]: &[u32; 3]| corner(a).cross(corner(b)).dot(corner(c)) / 6.0;
    mesh.indices.iter().map(tetrahedron).sum()
}

/// Volume by disks: pi r² dh along the flattened curve.
fn disks(contour: &[Point2], options: &Revolution) -> f64 {
    let pieces = smooth_pieces(contour, options.crease_rad.into()).expect("a valid contour");
    let frustum = |pair: &[CurvePoint]| {
        let (a, b) = (pair[0].p, pair[1].p);
        PI * (b.x - a.x) * (a.y * a.y + a.y * b.y + b.y * b.y) / 3.0
    };
    pieces
        .iter()
        .flat_map(|piece| piece.flattened(1e-7, usize::MAX).windows(2).map(frustum).collect::<Vec<_>>())
        .sum()
}

/// The volume of the mesh is that of the disks, less what regular polygons of so many sides lack of circles; a sphere's is
/// known.
#[test]
fn volume_is_that_of_the_disks() {
    let fine = Revolution { tolerance: 1e-5, ..Revolution::default() };
    let vase = contour(&[[0.0, 0.0], [0.0, 0.5], [0.3, 0.8], [1.0, 0.4], [1.4, 0.45], [1.4, 0.0]]);
    for contour in [half_circle(40), vase] {
        let mesh = fine.mesh(&contour).expect("a valid contour");
        let (found, expected) = (volume(&mesh), disks(&contour, &fine));
        // A polygon within 1e-5 of a circle of radius r > 0.3 has 1 - 4/3 e/r of its area.
        assert!((found / expected - 1.0).abs() < 2e-4, "{found} for {expected}");
    }
    let ball = fine.mesh(&half_circle(40)).expect("a circle");
    assert!((volume(&ball) - 4.0 / 3.0 * PI).abs() < 2e-3, "{}", volume(&ball));
}

/// The torus closes where its contour began; its volume is that of Pappus: the area of the disk times the way of its centre.
#[test]
fn a_closed_contour_makes_a_ring() {
    let n = 64;
    let point = |i: usize| {
        let (sin, cos) = (2.0 * PI * (i % n) as f64 / n as f64).sin_cos();
        Point2::new(0.5 * sin as f32, 2.0 + 0.5 * cos as f32)
    };
    let torus: Vec<Point2> = (0..=n).map(point).collect();
    let mesh = Revolution { tolerance: 1e-4, ..Revolution::default() }.mesh(&torus).expect("a valid contour");
    let expected = 2.0 * PI * 2.0 * PI * 0.25;
    // Counter-clockwise in (h, r) is downwards outside, so that normals point inwards.
    let found = volume(&mesh).abs();
    assert!((found / expected - 1.0).abs() < 2e-3, "{found} for {expected}");
}

/// A closed body leaks no ray, at edges and vertices neither, and its normals are those of the sphere that it stands for.
#[test]
fn closed_bodies_are_watertight_with_exact_normals() {
    let mesh =
        Revolution { tolerance: 1e-3, ..Revolution::default() }.mesh(&half_circle(24)).expect("a circle");
    for (p, n) in mesh.positions.iter().zip(&mesh.normals) {
        let cosine = n.normalized().dot_vector(p.as_vector().normalized());
        // Slopes by three points 7.5 degrees apart have errors of the second order.
        assert!(cosine > 0.9999, "{p:?} {n:?}");
    }
    let targets = mesh.positions.clone();
    let (geometry, _) = single(Shape::Triangles(mesh), Transform::IDENTITY, false);
    let mut rng = Rng::new(3, 14);
    for _ in 0..20_000 {
        let origin = crate::test_support::point_in_cube(&mut rng, 0.4);
        let towards = targets[rng.next_below(targets.len() as u32) as usize] - origin;
        for d in [towards, direction(&mut rng)] {
            assert!(
                geometry.intersect(&Ray::new(origin, d), f32::INFINITY, &any).is_some(),
                "{origin:?} {d:?}"
            );
        }
    }
}

/// All vertices and the middles of all triangles are within the tolerance of the surface.
#[test]
fn the_mesh_keeps_its_tolerance() {
    for tolerance in [1e-2, 1e-3, 1e-4_f32] {
        let cone = contour(&[[0.0, 1.0], [1.0, 0.5]]);
        let mesh = Revolution { tolerance, ..Revolution::default() }.mesh(&cone).expect("a cone");
        for face in &mesh.indices {
            let [a, b, c] = face.map(|i| mesh.positions[i as usize].as_vector());
            for p in [(a + b + c) / 3.0, (a + b) / 2.0, (b + c) / 2.0] {
                let radius = 1.0 - 0.5 * p.z;
                let distance = (radius - p.x.hypot(p.y)).abs();
                assert!(distance <= tolerance + 1e-6, "{distance} exceeds {tolerance}");
            }
        }
    }
}

/// The curve has no overshoot: between two points both coordinates are monotone; and normals are continuous but at creases.
#[test]
fn curves_are_smooth_and_stay_between_their_points() {
    let steps = contour(&[[0.0, 1.0], [1.0, 1.0], [1.3, 2.0], [2.0, 2.05], [3.0, 2.05]]);
    let pieces = smooth_pieces(&steps, 1.5).expect("a valid contour");
    assert_eq!(pieces.len(), 1);
    let curve = pieces[0].flattened(1e-5, usize::MAX);
    for pair in curve.windows(2) {
        assert!(pair[1].p.x >= pair[0].p.x && pair[1].p.y >= pair[0].p.y, "{pair:?}");
        let turn = pair[0].tangent.angle_to(pair[1].tangent).abs();
        assert!(turn < 0.1, "a kink of {turn}");
    }
    assert!(curve.iter().all(|c| (1.0..=2.05).contains(&c.p.y)));
    // The turns by 73 and 69 degrees are edges now.
    assert_eq!(smooth_pieces(&steps, 1.0).expect("valid").len(), 3);
}

/// What cannot be revolved is said, with the points that are to blame.
#[test]
fn impossible_contours_are_named() {
    let error = |points: &[[f32; 2]]| Revolution::default().mesh(&contour(points)).expect_err("impossible");
    assert_eq!(error(&[]), ContourError::TooFew);
    assert_eq!(error(&[[0.0, 1.0], [0.0, 1.0]]), ContourError::TooFew);
    assert_eq!(error(&[[0.0, 0.0], [1.0, 0.0]]), ContourError::TooFew);
    assert_eq!(error(&[[0.0, 1.0], [f32::NAN, 1.0]]), ContourError::NotFinite { point: 1 });
    assert_eq!(error(&[[0.0, 1.0], [1.0, -0.5]]), ContourError::NegativeRadius { point: 1, radius: -0.5 });
    let eight = [[0.0, 1.0], [1.0, 2.0], [0.0, 2.0], [1.0, 1.0]];
    assert_eq!(error(&eight), ContourError::Crosses { first: 0, second: 2 });
    let back = [[0.0, 1.0], [1.0, 1.0], [0.5, 1.0]];
    assert_eq!(error(&back), ContourError::Crosses { first: 0, second: 1 });
    let many = vec![[0.0, 1.0]; MAX_CONTOUR_POINTS + 1];
    assert!(matches!(error(&many), ContourError::TooMany { .. }));
    let fine = Revolution { tolerance: 1e-14, ..Revolution::default() };
    let cylinder = contour(&[[0.0, 1.0], [1.0, 1.0]]);
    assert!(matches!(fine.mesh(&cylinder), Err(ContourError::TooFine { .. })));
    // The curve ends with the limit: all of it would have 2^12 points for each of the contour's.
    let pieces = smooth_pieces(&half_circle(1000), 1.0).expect("a circle");
    assert!(pieces[0].flattened(1e-30, 5000).len() <= 5002);
    let Err(ContourError::TooFine { n_triangles }) = fine.mesh(&half_circle(1000)) else {
        panic!("it is too fine");
    };
    assert!(n_triangles > MAX_TRIANGLES);
}

/// The axis may be met on the way, and a side may run along it: both bodies are there, and nothing between.
#[test]
fn contours_may_touch_the_axis() {
    let beads = contour(&[[0.0, 0.0], [0.5, 0.5], [1.0, 0.0], [2.0, 0.0], [2.5, 0.5], [3.0, 0.0]]);
    let mesh = Revolution::default().mesh(&beads).expect("two beads");
    assert!(mesh.validate().is_ok());
    let (found, expected) = (volume(&mesh), disks(&beads, &Revolution::default()));
    assert!((found / expected - 1.0).abs() < 2e-3, "{found} for {expected}");
}
