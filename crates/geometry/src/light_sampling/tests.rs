use std::f32::consts::{PI, TAU};

use etendue_math::statistics::{Moments, mean_test, sphere_chi_square};
use etendue_math::{Point2, Point3, Rng, Transform, Vector3};

use crate::test_support::{assert_close, ball, single};
use crate::{BilinearMesh, Geometry, GeometryId, Lamp, Reference, Shape, TriangleMesh};

/// Split of the significance of the suite over the cases here.
const SIGNIFICANCE: f64 = 1e-5;

fn triangle() -> Shape {
    let p = Point3::new;
    Shape::Triangles(TriangleMesh {
        positions: vec![p(-1.0, -0.5, 0.0), p(1.0, 0.0, 0.3), p(0.0, 1.0, -0.2)],
        indices: vec![[0, 1, 2]],
        ..TriangleMesh::default()
    })
}

fn patch(corner: Point3) -> Shape {
    let p = Point3::new;
    Shape::Bilinear(BilinearMesh {
        positions: vec![p(-1.0, -1.0, 0.0), p(1.0, -1.0, 0.0), p(-1.0, 1.0, 0.0), corner],
        indices: vec![[0, 1, 2, 3]],
        ..BilinearMesh::default()
    })
}

fn disk() -> Shape {
    Shape::Disk { height: 0.0, radius: 1.0, inner_radius: 0.3, phi_max_rad: 0.8 * TAU }
}

/// Shapes of which a ray meets at most one point, or whose sampling sees only the nearest.
fn cases() -> Vec<(&'static str, Geometry, GeometryId)> {
    let id = Transform::IDENTITY;
    let turn = Transform::rotate(0.6, Vector3::new(1.0, 0.3, -0.2)).expect("an axis");
    let scale = Transform::scale(0.7, 0.7, -0.7).expect("invertible");
    let flat = patch(Point3::new(1.0, 1.0, 0.0));
    let shapes = [
        ("triangle", triangle(), id),
        ("sphere", Shape::sphere(0.9), id),
        ("scaled sphere", Shape::sphere(0.9), turn * scale),
        ("disk", disk(), id),
        ("turned disk", disk(), turn),
        ("stretched disk", disk(), turn * Transform::scale(1.5, 0.5, 1.0).expect("invertible")),
        ("rectangle", flat.clone(), id),
        ("turned rectangle", flat, turn),
        ("kite", patch(Point3::new(0.3, 0.4, 0.0)), turn),
    ];
    shapes
        .into_iter()
        .map(|(name, shape, transform)| {
            let (geometry, id) = single(shape, transform, false);
            (name, geometry, id)
        })
        .collect()
}

fn references() -> [Reference; 4] {
    let at = |x: f32, y: f32, z: f32| Reference { p: Point3::new(x, y, z), n: None };
    [at(0.1, -0.2, 1.5), at(2.0, 1.0, -0.7), at(0.4, 0.3, -1.1), at(-60.0, 20.0, 50.0)]
}

/// Directions to a shape are distributed as `pdf_from` says.
#[test]
fn directions_have_the_stated_density() {
    for (name, geometry, id) in cases() {
        for (index, reference) in references().iter().enumerate() {
            let sample = |rng: &mut Rng| {
                let (sample, pdf_w) = geometry.sample_from(id, 0, reference, rng.next_point2())?;
                assert!(pdf_w > 0.0 && pdf_w.is_finite());
                Some((sample.p - reference.p).normalized())
            };
            let pdf = |w: Vector3| geometry.pdf_from(id, 0, reference, w);
            if index == 3 {
                // Seen from far away the shape is a dot; only the Jacobian and consistency tests resolve it.
                continue;
            }
            let result = sphere_chi_square(40_000, 1, sample, pdf, SIGNIFICANCE);
            assert!(result.is_ok(), "{name} from reference {index}: {}", result.unwrap_err());
        }
    }
}

/// The test above can fail: a density that is off by 5 % is found.
#[test]
fn a_wrong_density_is_noticed() {
    let (geometry, id) = single(Shape::sphere(0.9), Transform::IDENTITY, false);
    let reference = references()[0];
    let sample = |rng: &mut Rng| {
        let (sample, _) = geometry.sample_from(id, 0, &reference, rng.next_point2())?;
        Some((sample.p - reference.p).normalized())
    };
    let pdf = |w: Vector3| 0.95 * geometry.pdf_from(id, 0, &reference, w);
    assert!(sphere_chi_square(40_000, 1, sample, pdf, SIGNIFICANCE).is_err());
}

/// The density that comes with a sample is that of the direction, of the point, and its area density after the
/// change of measure.
#[test]
fn densities_agree_with_each_other() {
    let mut rng = Rng::new(2, 0);
    for (name, geometry, id) in cases() {
        for reference in &references() {
            for _ in 0..500 {
                let u = rng.next_point2();
                let Some((sample, pdf_w)) = geometry.sample_from(id, 0, reference, u) else { continue };
                let offset = sample.p - reference.p;
                let cosine = sample.n.abs_dot_vector(offset.normalized());
                if cosine < 1e-2 {
                    continue;
                }
                let close = |other: f32, tolerance: f32| (other / pdf_w - 1.0).abs() < tolerance;
                let by_point = geometry.pdf_from_point(id, 0, reference, sample.p, sample.n);
                assert!(close(by_point, 2e-3), "{name} at a point: {by_point} instead of {pdf_w}");
                let by_area = sample.pdf_a * offset.length_squared() / cosine;
                assert!(close(by_area, 1e-3), "{name} by area: {by_area} instead of {pdf_w}");
                let by_direction = geometry.pdf_from(id, 0, reference, offset.normalized());
                // At the very edge the rounded direction may miss.
                let near_edge = u.x < 1e-2 || u.x > 0.99 || u.y < 1e-2 || u.y > 0.99;
                assert!(
                    near_edge || close(by_direction, 1e-2),
                    "{name} along a direction: {by_direction} instead of {pdf_w}"
                );
            }
        }
    }
}

/// The map from the unit square to directions stretches area by one over the density.
#[test]
fn the_jacobian_of_sampling_is_one_over_the_density() {
    let mut rng = Rng::new(3, 0);
    for (name, geometry, id) in cases() {
        for reference in &references()[..3] {
            for _ in 0..50 {
                let u = Point2::new(0.1 + 0.8 * rng.next_f32(), 0.1 + 0.8 * rng.next_f32());
                if name == "triangle" && (u.x - u.y).abs() < 0.02 {
                    continue;
                }
                let h = 4e-3;
                let direction = |x: f32, y: f32| {
                    let u = Point2::new(u.x + x, u.y + y);
                    let (sample, _) = geometry.sample_from(id, 0, reference, u).expect("in front");
                    (sample.p - reference.p).normalized()
                };
                let dx = (direction(h, 0.0) - direction(-h, 0.0)) / (2.0 * h);
                let dy = (direction(0.0, h) - direction(0.0, -h)) / (2.0 * h);
                let jacobian = dx.cross(dy).length();
                let (_, pdf_w) = geometry.sample_from(id, 0, reference, u).expect("in front");
                assert!(
                    (jacobian * pdf_w - 1.0).abs() < 0.02,
                    "{name} at {u:?}: {jacobian} times {pdf_w} is not 1"
                );
            }
        }
    }
}

fn revolved() -> [Shape; 5] {
    let phi_max_rad = 5.0;
    [
        Shape::Cone { radius: 0.8, height: 1.5, phi_max_rad },
        Shape::Paraboloid { a: 0.9, b: 0.9, z_min: 0.0, z_max: 0.8, phi_max_rad },
        Shape::Paraboloid { a: 0.9, b: 0.5, z_min: 0.1, z_max: 0.8, phi_max_rad },
        Shape::Hyperboloid { p1: Point3::new(0.9, -0.3, -0.8), p2: Point3::new(0.4, 0.7, 0.9), phi_max_rad },
        Shape::Torus {
            major_radius: 0.8,
            minor_radius: 0.3,
            theta_min_rad: -1.0,
            theta_max_rad: 2.0,
            phi_max_rad,
        },
    ]
}

/// Points chosen by area: the integral of 1 / density is the area, and they lie on the surface.
#[test]
fn area_samples_integrate_the_area() {
    let stretched = Transform::scale(1.0, 2.0, 0.5).expect("invertible");
    let cylinder = Shape::Cylinder { radius: 0.5, z_min: -1.0, z_max: 0.5, phi_max_rad: 4.0 };
    let part = Shape::Sphere { radius: 1.0, z_min: -0.4, z_max: 0.8, phi_max_rad: 5.0 };
    let bent = patch(Point3::new(0.4, 1.5, 1.0));
    for (shape, transform) in [
        (cylinder.clone(), Transform::IDENTITY),
        (cylinder, stretched),
        (part.clone(), Transform::IDENTITY),
        (part, stretched),
        (bent, Transform::IDENTITY),
        (disk(), stretched),
        (triangle(), stretched),
    ]
    .into_iter()
    .chain(
        revolved().into_iter().flat_map(|shape| [(shape.clone(), Transform::IDENTITY), (shape, stretched)]),
    ) {
        let (geometry, id) = single(shape.clone(), transform, false);
        let mut rng = Rng::new(4, 0);
        let mut moments = Moments::default();
        for _ in 0..20_000 {
            let sample = geometry.sample_area(id, 0, rng.next_point2()).expect("it has an area");
            moments.push(f64::from(1.0 / sample.pdf_a));
            let pdf_a = geometry.area_pdf(id, 0, sample.p, sample.n);
            assert!((pdf_a / sample.pdf_a - 1.0).abs() < 2e-3, "{shape:?}: {pdf_a}, {}", sample.pdf_a);
            let ray = etendue_math::Ray::new(sample.p + sample.n.as_vector() * 0.1, -sample.n.as_vector());
            let hit = geometry.intersect(&ray, 0.2, &|hit| (hit.t - 0.1).abs() < 1e-4);
            if let Some(hit) = hit {
                let s = geometry.surface_point(&ray, &hit);
                assert!(s.ng.dot(sample.n) > 0.999, "{s:?} {sample:?}");
                assert_close(s.p.as_vector(), sample.p.as_vector(), 1e-5);
                // Across the seam of the azimuth u jumps from 1 to 0.
                let du = (s.uv.x - sample.uv.x).abs();
                assert!(du.min(1.0 - du) < 1e-3 && (s.uv.y - sample.uv.y).abs() < 1e-3, "{s:?} {sample:?}");
            }
        }
        let area = f64::from(geometry.area(id, 0));
        // Uniform densities have no variance to test with.
        if moments.standard_error() < 1e-5 * area {
            assert!((moments.mean() / area - 1.0).abs() < 1e-4, "{shape:?}");
        } else {
            let test = mean_test(&moments, area, SIGNIFICANCE);
            assert!(test.is_ok(), "{shape:?}: {}", test.unwrap_err());
        }
    }
}

/// From inside a sphere every direction meets it; the density integrates to 1 all around.
#[test]
fn a_sphere_seen_from_inside_covers_all_directions() {
    let (geometry, id) = single(Shape::sphere(1.0), Transform::IDENTITY, false);
    let reference = Reference { p: Point3::new(0.3, -0.2, 0.4), n: None };
    let sample = |rng: &mut Rng| {
        let (sample, _) = geometry.sample_from(id, 0, &reference, rng.next_point2())?;
        Some((sample.p - reference.p).normalized())
    };
    let pdf = |w: Vector3| geometry.pdf_from(id, 0, &reference, w);
    sphere_chi_square(40_000, 1, sample, pdf, SIGNIFICANCE).expect("the densities agree");
}

/// The solid angles of all triangles of a closed surface around a point add up to 4 pi.
#[test]
fn solid_angles_of_a_closed_surface_add_up() {
    let (geometry, id) = single(Shape::Triangles(ball(1)), Transform::IDENTITY, false);
    let reference = Reference { p: Point3::new(0.2, 0.1, -0.3), n: None };
    let mut sum = 0.0;
    for triangle in 0..geometry.n_primitives(id) {
        let (_, pdf_w) =
            geometry.sample_from(id, triangle, &reference, Point2::new(0.5, 0.5)).expect("visible");
        sum += 1.0 / f64::from(pdf_w);
    }
    assert!((sum - 4.0 * f64::from(PI)).abs() < 1e-4, "{sum}");
}

/// A reference in the plane of a flat light sees nothing of it.
#[test]
fn lights_seen_edge_on_have_no_samples() {
    let (geometry, id) = single(disk(), Transform::IDENTITY, false);
    let reference = Reference { p: Point3::new(3.0, 0.0, 0.0), n: None };
    assert!(geometry.sample_from(id, 0, &reference, Point2::new(0.4, 0.6)).is_none());
    assert_eq!(geometry.pdf_from(id, 0, &reference, Vector3::new(-1.0, 0.0, 0.0)), 0.0);
}

/// A point of a sphere sees the rest of its inside, whichever way its coordinates were rounded. There the geometry term is
/// the same for all points, A cos² / (4 R² cos²) = pi, so that each sample of the irradiance under radiance 1 is exact.
#[test]
fn points_of_a_sphere_see_its_inside() {
    let far = Transform::translate(Vector3::new(5.0, -70.0, 0.3));
    for transform in [Transform::IDENTITY, far] {
        let (geometry, id) = single(Shape::sphere(1.3), transform, true);
        let mut rng = Rng::new(23, 0);
        let mut n_near = 0;
        for _ in 0..2000 {
            let place = geometry.sample_area(id, 0, rng.next_point2()).expect("a sphere has area");
            let reference = Reference { p: place.p, n: Some(place.n) };
            let (sample, pdf_w) =
                geometry.sample_from(id, 0, &reference, rng.next_point2()).expect("a sample");
            let offset = sample.p - place.p;
            // Very near, which is rare, rounding of the points shows in the direction between them.
            if offset.length() < 0.05 {
                n_near += 1;
                continue;
            }
            let cosine = place.n.dot_vector(offset) / offset.length();
            assert!((cosine / pdf_w / PI - 1.0).abs() < 2e-3, "{} from {:?}", cosine / pdf_w, place.p);
            let known = geometry.pdf_from_point(id, 0, &reference, sample.p, sample.n);
            assert!((known / pdf_w - 1.0).abs() < 1e-4, "{known} and {pdf_w}");
        }
        assert!(n_near < 10, "{n_near} samples at the point itself");
    }
}

/// The short way to the points of a spherical lamp leads to the same points with the same density.
#[test]
fn spherical_lamps_are_sampled_like_their_shapes() {
    let mut rng = Rng::new(5, 0);
    let mut n_lamps = 0;
    for (name, geometry, id) in cases() {
        let Some(lamp @ Lamp::Sphere(_)) = geometry.lamp(id, 0) else { continue };
        n_lamps += 1;
        for reference in &references() {
            for _ in 0..200 {
                let u = rng.next_point2();
                let (Some((quick, quick_pdf, _)), Some((sample, pdf_w))) =
                    (lamp.sample_from(reference, u), geometry.sample_from(id, 0, reference, u))
                else {
                    panic!("{name} has no sample");
                };
                assert!((quick_pdf / pdf_w - 1.0).abs() < 1e-5, "{name}: {quick_pdf}, not {pdf_w}");
                assert!((quick.pdf_a / sample.pdf_a - 1.0).abs() < 1e-3, "{name}: {quick:?}, not {sample:?}");
                assert_close(quick.p.as_vector(), sample.p.as_vector(), 1e-5);
                assert_close(quick.n.as_vector(), sample.n.as_vector(), 1e-5);
                let by_point = lamp.pdf_from(reference, sample.p);
                assert!((by_point / pdf_w - 1.0).abs() < 1e-5, "{name}: {by_point}, not {pdf_w}");
            }
        }
    }
    assert_eq!(n_lamps, 2);
}
