//! Cones, paraboloids, hyperboloids and tori.

use etendue_math::statistics::sphere_chi_square;

use super::*;
use crate::GeometryId;

fn cone() -> Shape {
    Shape::Cone { radius: 0.8, height: 1.5, phi_max_rad: TAU }
}

fn paraboloid(a: f32, b: f32) -> Shape {
    Shape::Paraboloid { a, b, z_min: 0.1, z_max: 1.2, phi_max_rad: TAU }
}

fn hyperboloid() -> Shape {
    let (p1, p2) = (Point3::new(0.9, -0.3, -0.8), Point3::new(0.4, 0.7, 0.9));
    Shape::Hyperboloid { p1, p2, phi_max_rad: TAU }
}

fn torus(major_radius: f32, minor_radius: f32) -> Shape {
    Shape::Torus { major_radius, minor_radius, theta_min_rad: 0.0, theta_max_rad: TAU, phi_max_rad: TAU }
}

/// Whole shapes, cut ones, and some at the edge of what makes sense.
fn all() -> Vec<Shape> {
    let cut = |p2: Point3| Shape::Hyperboloid { p1: Point3::new(0.9, -0.3, -0.8), p2, phi_max_rad: 4.0 };
    vec![
        cone(),
        Shape::Cone { radius: 0.8, height: -1.5, phi_max_rad: 4.0 },
        paraboloid(1.1, 1.1),
        paraboloid(1.1, 0.6),
        Shape::Paraboloid { a: 0.7, b: 0.7, z_min: 0.0, z_max: 1.0, phi_max_rad: 5.0 },
        hyperboloid(),
        cut(Point3::new(0.4, 0.7, 0.9)),
        // A tube, a cone by its segment, a double cone, a ring.
        cut(Point3::new(0.9, -0.3, 0.8)),
        cut(Point3::new(1.2, -0.4, 0.8)),
        cut(Point3::new(-0.9, 0.3, 0.8)),
        cut(Point3::new(0.2, 0.9, -0.8)),
        torus(0.8, 0.3),
        torus(0.5, 0.5),
        Shape::Torus {
            major_radius: 0.7,
            minor_radius: 0.4,
            theta_min_rad: -1.0,
            theta_max_rad: 2.5,
            phi_max_rad: 4.0,
        },
    ]
}

/// The value of the equation that all points of a shape obey, over the length of its gradient: about the distance.
fn residual(shape: &Shape, p: Point3) -> f64 {
    let (x, y, z) = (f64::from(p.x), f64::from(p.y), f64::from(p.z));
    let (f, gradient) = match *shape {
        Shape::Cone { radius, height, .. } => {
            let k = f64::from(radius / height);
            let w = k * (z - f64::from(height));
            (x * x + y * y - w * w, [2.0 * x, 2.0 * y, -2.0 * k * w])
        }
        Shape::Paraboloid { a, b, .. } => {
            let (a2, b2) = (f64::from(a).powi(2), f64::from(b).powi(2));
            (x * x / a2 + y * y / b2 - z, [2.0 * x / a2, 2.0 * y / b2, -1.0])
        }
        Shape::Hyperboloid { p1, p2, .. } => {
            if p1.z == p2.z {
                return z - f64::from(p1.z);
            }
            let v = (z - f64::from(p1.z)) / f64::from(p2.z - p1.z);
            let d = [f64::from(p2.x - p1.x), f64::from(p2.y - p1.y)];
            let q = [f64::from(p1.x) + v * d[0], f64::from(p1.y) + v * d[1]];
            let slope = 2.0 * (q[0] * d[0] + q[1] * d[1]) / f64::from(p2.z - p1.z);
            (x * x + y * y - q[0] * q[0] - q[1] * q[1], [2.0 * x, 2.0 * y, -slope])
        }
        Shape::Torus { major_radius, minor_radius, .. } => {
            let from_circle = (x.hypot(y) - f64::from(major_radius)).hypot(z);
            return from_circle - f64::from(minor_radius);
        }
        _ => panic!("another shape"),
    };
    f / gradient.iter().map(|g| g * g).sum::<f64>().sqrt().max(1e-3)
}

/// Hits lie on the surface, on the ray, with a normal that faces away from the axis or tube and the stated derivatives.
#[test]
fn hits_lie_on_the_surface() {
    let mut rng = Rng::new(31, 0);
    for shape in all() {
        let (geometry, _) = single(shape.clone(), Transform::IDENTITY, false);
        let mut n_hits = 0;
        for _ in 0..3000 {
            let ray = crate::test_support::ray(&mut rng, 2.0);
            let Some(hit) = geometry.intersect(&ray, f32::INFINITY, &any) else { continue };
            n_hits += 1;
            let s = geometry.surface_point(&ray, &hit);
            assert!(residual(&shape, s.p).abs() < 1e-6, "{shape:?} at {:?}: {}", s.p, residual(&shape, s.p));
            let d = geometry.surface_derivatives(&ray, &hit);
            let grazing = (ray.direction.dot_normal(s.ng)).abs();
            let error = (s.p - ray.at(hit.t)).length();
            assert!(error * grazing < 2e-6, "{shape:?} at {:?}: off the ray by {error}", s.p);
            assert!((0.0..=1.0).contains(&s.uv.x) && (-1e-6..=1.000_001).contains(&s.uv.y), "{s:?}");
            let cross = d.dpdu.cross(d.dpdv).normalized();
            assert!(cross.abs_dot_normal(s.ng) > 1.0 - 1e-4, "{shape:?}: {d:?} at {s:?}");
        }
        assert!(n_hits > 40, "{shape:?}: {n_hits}");
    }
}

/// Moving along dp/du and dp/dv changes u and v by as much, and the normal by dn/du and dn/dv.
#[test]
fn derivatives_follow_texture_coordinates() {
    let mut rng = Rng::new(37, 0);
    for shape in all() {
        let (geometry, id) = single(shape.clone(), Transform::IDENTITY, false);
        let probe = |p: Point3, n: Vector3| {
            let ray = Ray::new(p + n * 0.02, -n);
            let hit = geometry.intersect(&ray, 0.04, &any)?;
            Some((geometry.surface_point(&ray, &hit), geometry.surface_derivatives(&ray, &hit)))
        };
        let mut n_checked = 0;
        for _ in 0..300 {
            let sample = geometry.sample_area(id, 0, rng.next_point2()).expect("it has an area");
            let n = sample.n.as_vector();
            let Some((here, d)) = probe(sample.p, n) else { continue };
            let from_axis = here.p.x.hypot(here.p.y);
            if from_axis < 0.15 || here.uv.x < 0.02 || here.uv.x > 0.98 {
                continue;
            }
            for tangent in [d.dpdu, d.dpdv] {
                let step = tangent.normalized() * 2e-3;
                let (Some((ahead, _)), Some((behind, _))) =
                    (probe(here.p + step, n), probe(here.p - step, n))
                else {
                    continue;
                };
                // Across the seam of a whole tube.
                if (ahead.uv.y - behind.uv.y).abs() > 0.5 {
                    continue;
                }
                n_checked += 1;
                let (du, dv) = (ahead.uv.x - behind.uv.x, ahead.uv.y - behind.uv.y);
                let dp = d.dpdu * du + d.dpdv * dv;
                assert!(((dp - (ahead.p - behind.p)) / 4e-3).length() < 1e-2, "{shape:?} at {here:?}");
                let dn = d.dndu * du + d.dndv * dv - (ahead.ns - behind.ns).as_vector();
                assert!((dn / 4e-3).length() < 3e-2, "{shape:?} at {here:?}: {:?} {d:?}", dn / 4e-3);
            }
        }
        assert!(n_checked > 100, "{shape:?}: {n_checked}");
    }
}

/// Every crossing of a torus is found: as many as a march in small steps finds changes of side, in the same places.
#[test]
fn tori_are_met_up_to_four_times() {
    let mut rng = Rng::new(41, 0);
    let shape = torus(0.8, 0.3);
    let (geometry, _) = single(shape.clone(), Transform::IDENTITY, false);
    let mut most = 0;
    for _ in 0..400 {
        // Nearly flat, so that many rays cross the tube twice.
        let p = point_in_cube(&mut rng, 0.25);
        let mut w = direction(&mut rng);
        w.z *= 0.1;
        let ray = Ray::new(p - w.normalized() * 2.0, w.normalized());
        let at = |t: f32| residual(&shape, ray.at(t));
        let steps: Vec<f32> = (0..4000).map(|i| i as f32 * 1e-3).collect();
        let marched: Vec<f32> =
            steps.windows(2).filter(|t| (at(t[0]) < 0.0) != (at(t[1]) < 0.0)).map(|t| t[0]).collect();
        let mut found = Vec::new();
        while let Some(hit) =
            geometry.intersect(&ray, f32::INFINITY, &|hit| found.last().is_none_or(|t| hit.t > *t))
        {
            found.push(hit.t);
        }
        most = most.max(found.len());
        for t in &marched {
            assert!(found.iter().any(|own| (own - t - 5e-4).abs() < 6e-4), "{marched:?}, not {found:?}");
        }
        assert!(found.len() >= marched.len() && found.len() % 2 == 0, "{found:?} {marched:?}");
    }
    assert_eq!(most, 4);
}

/// Rays that start on a torus, just inside or outside, and such as touch it.
#[test]
fn tori_have_robust_tangents() {
    let shape = torus(1.0, 0.25);
    let t = |origin, direction| at(&shape, origin, direction).map(|(hit, _)| hit.t);
    // Along the top circle: touches or passes, by the last bit.
    let touch = t([-3.0, 1.0, 0.249_999_99], [1.0, 0.0, 0.0]).expect("just inside");
    // Contact of fourth order: 1.5e-8 below the top the chord is 2 (2 * 1.5e-8)^(1/4) long.
    assert!((touch - 3.0).abs() < 1.4e-2, "{touch}");
    assert!(t([-3.0, 1.0, 0.250_000_06], [1.0, 0.0, 0.0]).is_none());
    // Through the hole.
    assert!(t([0.0, 0.0, 5.0], [0.0, 0.0, -1.0]).is_none());
    assert!(t([0.749, 0.0, 5.0], [0.0, 0.0, -1.0]).is_none());
    assert!(t([0.751, 0.0, 5.0], [0.0, 0.0, -1.0]).is_some());
    // From inside the tube, and from the middle of the hole.
    assert!((t([1.0, 0.0, 0.0], [1.0, 0.0, 0.0]).expect("the wall") - 0.25).abs() < 1e-6);
    assert!((t([0.0, 0.0, 0.0], [1.0, 0.0, 0.0]).expect("the inner wall") - 0.75).abs() < 1e-6);
    // Far away.
    let far = t([1e5, 0.01, 0.01], [-1.0, 0.0, 0.0]).expect("straight ahead");
    assert!((far - (1e5 - 1.249_5)).abs() < 0.02, "{far}");
}

/// SPEC GEO-6: rays along the axis of a round paraboloid meet after one reflection at z = a² / 4.
#[test]
fn a_paraboloid_has_a_focus() {
    let mut rng = Rng::new(43, 0);
    for a in [0.5_f32, 1.0, 2.0] {
        let shape = Shape::Paraboloid { a, b: a, z_min: 0.0, z_max: 4.0, phi_max_rad: TAU };
        let (geometry, _) = single(shape, Transform::IDENTITY, false);
        for _ in 0..500 {
            let offset = point_in_cube(&mut rng, 1.2 * a);
            let ray = Ray::new(Point3::new(offset.x, offset.y, 10.0), Vector3::new(0.0, 0.0, -1.0));
            let hit = geometry.intersect(&ray, f32::INFINITY, &any).expect("below the rim");
            let s = geometry.surface_point(&ray, &hit);
            let n = s.ng.as_vector();
            let reflected = ray.direction - n * (2.0 * ray.direction.dot(n));
            let focus = Point3::new(0.0, 0.0, 0.25 * a * a);
            let towards = focus - s.p;
            // The distance of the focus from the reflected ray.
            let miss = towards.cross(reflected).length();
            assert!(miss < 1e-5 * (1.0 + towards.length()) && towards.dot(reflected) > 0.0, "{miss}");
        }
    }
}

/// Areas are those of closed forms where there are some, and the integral of the stretch elsewhere.
#[test]
fn areas_are_right() {
    let check = |shape: Shape, expected: f64| {
        let (geometry, id) = single(shape.clone(), Transform::IDENTITY, false);
        let area = f64::from(geometry.area(id, 0));
        assert!((area / expected - 1.0).abs() < 1e-5, "{shape:?}: {area}, not {expected}");
    };
    let pi = std::f64::consts::PI;
    check(cone(), pi * 0.8 * 1.7);
    check(torus(0.8, 0.3), 4.0 * pi * pi * 0.8 * 0.3);
    // pi a / 6 ((a² + 4 z)^1.5 - a³) for x² + y² = a² z... with a = 1, z = 1: pi / 6 (5^1.5 - 1).
    let whole = Shape::Paraboloid { a: 1.0, b: 1.0, z_min: 0.0, z_max: 1.0, phi_max_rad: TAU };
    check(whole, pi / 6.0 * (5.0_f64.powf(1.5) - 1.0));
    // Segments at an angle to the axis, down to nearly parallel ones, against the sum over thin strips.
    for twist in [1.0_f32, 0.1, 1e-2, 1e-3, 1e-4, 1e-6] {
        let (p1, p2) = (Point3::new(0.9, -twist, -0.8), Point3::new(0.9 - twist, 2.0 * twist, 0.9));
        let q = |z: f64| {
            let v = (z + 0.8) / 1.7;
            let lerp = |a: f32, b: f32| f64::from(a) + v * f64::from(b - a);
            lerp(p1.x, p2.x).powi(2) + lerp(p1.y, p2.y).powi(2)
        };
        let strip = |i: i32| {
            let (z, h) = (-0.8 + 1.7 * (f64::from(i) + 0.5) / 1e4, 1e-5);
            let slope = (q(z + h) - q(z - h)) / (2.0 * h);
            (q(z) + 0.25 * slope * slope).sqrt() * 1.7e-4
        };
        let expected = 2.0 * pi * (0..10_000).map(strip).sum::<f64>();
        check(Shape::Hyperboloid { p1, p2, phi_max_rad: TAU }, expected);
    }
}

/// Points chosen by area are spread evenly: seen as directions from the middle of a sphere around all, a chi-square test of
/// the map from area to (u, v) against the stretch of the parameters.
#[test]
fn areas_are_sampled_evenly() {
    for (index, shape) in all().into_iter().enumerate() {
        let (geometry, id) = single(shape.clone(), Transform::IDENTITY, false);
        // (u, v) as a direction: uniform on the square means uniform on the sphere.
        let to_direction = |u: f32, v: f32| {
            let z = (1.0 - 2.0 * v).clamp(-1.0, 1.0);
            let r = (1.0 - z * z).sqrt();
            Vector3::new(r * (TAU * u).cos(), r * (TAU * u).sin(), z)
        };
        let sample = |rng: &mut Rng| {
            let sample = geometry.sample_area(id, 0, rng.next_point2())?;
            Some(to_direction(sample.uv.x, sample.uv.y))
        };
        let pdf = |w: Vector3| {
            let v = 0.5 * (1.0 - w.z);
            stretch(&geometry, id, &shape, v) / (4.0 * PI)
        };
        let result = sphere_chi_square(20_000, index as u64 + 1, sample, pdf, 1e-5);
        assert!(result.is_ok(), "{shape:?}: {}", result.unwrap_err());
    }
}

/// |dp/du x dp/dv| over the area, at v.
fn stretch(geometry: &Geometry, id: GeometryId, shape: &Shape, v: f32) -> f32 {
    let area = geometry.area(id, 0);
    match *shape {
        Shape::Torus { major_radius, minor_radius, theta_min_rad, theta_max_rad, phi_max_rad } => {
            let span = theta_max_rad - theta_min_rad;
            let theta = theta_min_rad + v * span;
            span * minor_radius * phi_max_rad * (major_radius + minor_radius * theta.cos()) / area
        }
        Shape::Cone { radius, height, phi_max_rad } => {
            phi_max_rad * radius * (1.0 - v) * radius.hypot(height) / area
        }
        Shape::Paraboloid { a, z_min, z_max, .. } => {
            // Uniform in area before the stretch along y.
            let q = |z: f32| (a * a * z + 0.25 * a * a * a * a).sqrt();
            let integral = |z: f32| 2.0 / 3.0 * q(z).powi(3) / (a * a);
            q(z_min + v * (z_max - z_min)) * (z_max - z_min) / (integral(z_max) - integral(z_min))
        }
        Shape::Hyperboloid { p1, p2, phi_max_rad } if p1.z != p2.z => {
            let (p, d) = (p1 + (p2 - p1) * v, p2 - p1);
            let r2 = p.x * p.x + p.y * p.y;
            let slope = p.x * d.x + p.y * d.y;
            phi_max_rad * (r2 * d.z * d.z + slope * slope).sqrt() / area
        }
        Shape::Hyperboloid { p1, p2, phi_max_rad } => {
            // A ring, whose v falls from the rim to the hole.
            let d = p2 - p1;
            let nearest = (-(p1.x * d.x + p1.y * d.y) / (d.x * d.x + d.y * d.y)).clamp(0.0, 1.0);
            let inner = (p1.x + d.x * nearest).hypot(p1.y + d.y * nearest);
            let outer = p1.x.hypot(p1.y).max(p2.x.hypot(p2.y));
            phi_max_rad * (outer - v * (outer - inner)) * (outer - inner) / area
        }
        _ => panic!("another shape"),
    }
}
