//! Implicit surfaces: no zero is missed that a march in small steps finds, and none is made up.

use etendue_math::Bounds3;
use etendue_math::expression::Expression;

use super::*;
use crate::ImplicitSurface;

fn formula(text: &str) -> Expression {
    Expression::parse(text, &["x", "y", "z"], &mut |_| None).unwrap_or_else(|error| panic!("{text}: {error}"))
}

fn implicit(text: &str, half: f32, lipschitz: Option<f32>) -> Shape {
    let bounds = Bounds3 { min: Point3::splat(-half), max: Point3::splat(half) };
    Shape::Implicit(ImplicitSurface::new(formula(text), bounds, None, lipschitz))
}

const TORUS: &str = "(x^2+y^2+z^2+0.8^2-0.3^2)^2 - 4*0.8^2*(x^2+y^2)";
/// Barth's sextic, with 65 double points: 4 (p²x² - y²)(p²y² - z²)(p²z² - x²) - (1 + 2p)(x² + y² + z² - 1)², p golden.
const BARTH: &str = "4*(2.618033988749895*x^2-y^2)*(2.618033988749895*y^2-z^2)*(2.618033988749895*z^2-x^2) \
    - 4.23606797749979*(x^2+y^2+z^2-1)^2";
const GYROID: &str = "sin(6*x)*cos(6*y) + sin(6*y)*cos(6*z) + sin(6*z)*cos(6*x)";
/// A shell between two spheres, 1e-4 thick.
const SHELL: &str = "abs(length(x,y,z) - 0.9) - 5e-5";
const BLOBS: &str =
    "exp(-8*((x-0.3)^2+y^2+z^2)) + exp(-8*((x+0.3)^2+y^2+z^2)) + exp(-12*(x^2+(y-0.5)^2+z^2)) - 0.5";
const HEART: &str = "(x^2 + 2.25*y^2 + z^2 - 1)^3 - x^2*z^3 - 0.1125*y^2*z^3";
const BOX: &str = "max(max(abs(x)-0.7, abs(y)-0.5), abs(z)-0.6)";
const SDF: &str = "min(length(length(x,y)-0.7, z)-0.2, length(max(abs(x)-0.2,0), max(abs(y)-0.2,0), max(abs(z)-0.5,0))-0.05)";

/// The first change of sign along a ray within the box of half side `half`, by a march in `n` steps, if both sides of it are clear.
fn march(f: &Expression, ray: &Ray, half: f64, n: u32) -> Option<f64> {
    let o = [ray.origin.x, ray.origin.y, ray.origin.z].map(f64::from);
    let d = [ray.direction.x, ray.direction.y, ray.direction.z].map(f64::from);
    let (mut start, mut end) = (0.0_f64, f64::INFINITY);
    for axis in 0..3 {
        let (a, b) = ((-half - o[axis]) / d[axis], (half - o[axis]) / d[axis]);
        start = start.max(a.min(b));
        end = end.min(a.max(b));
    }
    if start >= end {
        return None;
    }
    let at = |i: u32| start + (end - start) * f64::from(i) / f64::from(n);
    let value = |t: f64| f.value(std::array::from_fn(|axis| o[axis] + d[axis] * t));
    let mut before = value(at(0));
    for i in 1..=n {
        let next = value(at(i));
        if before * next < 0.0 {
            return Some(at(i));
        }
        before = next;
    }
    None
}

/// Thousands of rays against a march: a zero that it finds is found, at that place or before it, and what is found is a zero.
#[track_caller]
fn check_against_march(text: &str, half: f32, lipschitz: Option<f32>, n_rays: u32, n_steps: u32) {
    let f = formula(text);
    let (geometry, _) = single(implicit(text, half, lipschitz), Transform::IDENTITY, false);
    let mut rng = Rng::new(47, u64::from(n_steps));
    let mut n_found = 0;
    for _ in 0..n_rays {
        let from = Point3::ORIGIN + direction(&mut rng) * (3.0 * half);
        let to = point_in_cube(&mut rng, 0.9 * half);
        let ray = Ray::new(from, (to - from).normalized());
        let marched = march(&f, &ray, half.into(), n_steps);
        let hit = geometry.intersect(&ray, f32::INFINITY, &any);
        // A step of the march and the rounding of t.
        let step = 6.0 * f64::from(half) / f64::from(n_steps) + 1e-6;
        if let Some(t) = marched {
            n_found += 1;
            let hit = hit.unwrap_or_else(|| panic!("{text}: {ray:?} missed {t}"));
            assert!(f64::from(hit.t) <= t + step, "{text}: {ray:?} went on to {} from {t}", hit.t);
        }
        let Some(hit) = hit else { continue };
        let s = geometry.surface_point(&ray, &hit);
        let p = [s.p.x, s.p.y, s.p.z].map(f64::from);
        let (value, gradient) = f.gradient(p);
        let slope = gradient.iter().map(|g| g * g).sum::<f64>().sqrt();
        // The value at the rounded point over the slope is its distance; 2e-7 for single precision near 1. Near double points the
        // slope vanishes and the value with its square.
        assert!(
            value.abs() <= 3e-7 * slope * f64::from(1.0 + half) + 1e-9,
            "{text}: {value} at {p:?}, slope {slope}"
        );
        let n = [s.ng.x, s.ng.y, s.ng.z].map(f64::from);
        let along: f64 = (0..3).map(|i| n[i] * gradient[i]).sum();
        assert!(slope < 1e-3 || along > 0.999 * slope, "{text}: {n:?} {gradient:?}");
    }
    assert!(n_found * 10 > n_rays, "{text}: {n_found}");
}

#[test]
fn no_zero_is_missed() {
    let (n_rays, n_steps) =
        if std::env::var_os("ETENDUE_SLOW").is_some() { (800, 100_000) } else { (150, 2000) };
    for text in [TORUS, GYROID, BLOBS, HEART, BOX, SDF] {
        check_against_march(text, 1.35, None, n_rays, n_steps);
    }
    check_against_march(BARTH, 1.5, None, n_rays, n_steps);
    check_against_march(SHELL, 1.0, None, n_rays / 10, 100_000);
    for text in [SDF, "length(x,y,z)-0.9", BOX] {
        check_against_march(text, 1.35, Some(1.0), n_rays, n_steps);
    }
    check_against_march(SHELL, 1.0, Some(1.0), n_rays / 10, 100_000);
}

/// At a pole there is no surface, though the sign changes there and slopes are on one side; a zero beside one is found.
#[test]
fn poles_are_no_surfaces() {
    let hits = |text: &str| {
        let (geometry, _) = single(implicit(text, 1.5, None), Transform::IDENTITY, false);
        let ray = |y: f32| Ray::new(Point3::new(-2.9, y, 0.17), Vector3::new(1.0, 0.01, 0.02).normalized());
        let hit = |y: f32| geometry.intersect(&ray(y), f32::INFINITY, &any).map(|hit| ray(y).at(hit.t));
        (0..200).map(|i| hit(i as f32 / 100.0 - 1.003)).collect::<Vec<_>>()
    };
    for text in ["x^-1", "1/x", "1/(x*x*x - 0.1)", "x^-3"] {
        assert!(hits(text).iter().all(Option::is_none), "{text}");
    }
    for text in ["tan(2*x+1.5707963)", "tan(x) - y", "x^-1 - y", "tan(7*x) + 1"] {
        let f = formula(text);
        let found: Vec<Point3> = hits(text).into_iter().flatten().collect();
        assert!(found.len() > 50, "{text}: {}", found.len());
        for p in found {
            let (value, gradient) = f.gradient([p.x, p.y, p.z].map(f64::from));
            let slope = gradient.iter().map(|g| g * g).sum::<f64>().sqrt();
            assert!(
                value.abs() <= 2e-6 * slope && value.abs() < 0.1,
                "{text}: {value} at {p:?}, slope {slope}"
            );
        }
    }
    // The first zero from the left, beyond poles: -π/4 is the first of tan(2 x + π/2) in the box that is no pole.
    for p in hits("tan(2*x+1.5707963)") {
        assert!((p.expect("a zero").x + std::f32::consts::FRAC_PI_4).abs() < 1e-5, "{p:?}");
    }
}

/// The same torus as a quartic and as a formula: the same hits, normals and misses.
#[test]
fn quadrics_agree_with_their_formulas() {
    let pairs = [
        (
            Shape::Torus {
                major_radius: 0.8,
                minor_radius: 0.3,
                theta_min_rad: 0.0,
                theta_max_rad: TAU,
                phi_max_rad: TAU,
            },
            TORUS,
        ),
        (Shape::sphere(0.9), "x^2 + y^2 + z^2 - 0.81"),
        (
            Shape::Paraboloid { a: 1.1, b: 0.6, z_min: 0.0, z_max: 1.35, phi_max_rad: TAU },
            "x^2/1.21 + y^2/0.36 - z",
        ),
    ];
    let turn = Transform::rotate(0.7, Vector3::new(1.0, 2.0, 3.0)).expect("an axis");
    let place = turn * Transform::scale(2.0, 0.5, 1.0).expect("invertible");
    let mut rng = Rng::new(53, 0);
    for (shape, text) in pairs {
        for transform in [Transform::IDENTITY, place] {
            let (quadric, _) = single(shape.clone(), transform, false);
            let (formula, _) = single(implicit(text, 1.35, None), transform, false);
            let mut n_hits = 0;
            for _ in 0..2000 {
                // Within the box of the formula.
                let from = transform.point(point_in_cube(&mut rng, 1.3));
                let to = transform.point(point_in_cube(&mut rng, 1.3));
                let (ray, length) = (Ray::new(from, (to - from).normalized()), (to - from).length());
                let a = quadric.intersect(&ray, length, &any).map(|hit| quadric.surface_point(&ray, &hit));
                let b = formula.intersect(&ray, length, &any).map(|hit| formula.surface_point(&ray, &hit));
                let grazes = [a, b].iter().flatten().any(|s| s.ng.abs_dot_vector(ray.direction) < 1e-2);
                if grazes || [a, b].iter().flatten().any(|s| (s.p - to).length() < 1e-4) {
                    continue;
                }
                match (a, b) {
                    (Some(a), Some(b)) => {
                        n_hits += 1;
                        assert!((a.p - b.p).length() < 1e-4, "{text}: {a:?} {b:?}");
                        assert!(a.ng.dot(b.ng).abs() > 0.999, "{text}: {a:?} {b:?}");
                    }
                    (None, None) => {}
                    _ => panic!("{text}: {ray:?} {a:?} {b:?}"),
                }
            }
            assert!(n_hits > 100, "{text}: {n_hits}");
        }
    }
}

/// Rays leave surfaces and come back, thin shells and saddles too: a ray that starts at the point of a hit does not find that
/// point again.
#[test]
fn rays_leave_implicit_surfaces() {
    let mut rng = Rng::new(59, 0);
    let far = Transform::translate(Vector3::new(130.0, -70.0, 40.0));
    for (text, lipschitz) in
        [(TORUS, None), (GYROID, None), (SDF, Some(1.0)), (HEART, None), (SHELL, Some(1.0))]
    {
        for transform in [Transform::IDENTITY, far] {
            let (geometry, _) = single(implicit(text, 1.3, lipschitz), transform, false);
            let mut n_departures = 0;
            for _ in 0..500 {
                let from = transform.point(point_in_cube(&mut rng, 2.0));
                let ray = Ray::new(from, (transform.point(point_in_cube(&mut rng, 1.0)) - from).normalized());
                let Some(hit) = geometry.intersect(&ray, f32::INFINITY, &any) else { continue };
                let s = geometry.surface_point(&ray, &hit);
                for _ in 0..4 {
                    let w = direction(&mut rng);
                    if s.ng.abs_dot_vector(w) < 0.05 {
                        continue;
                    }
                    n_departures += 1;
                    let departing = Ray::new(offset_ray_origin(s.p, s.p_error, s.ng, w), w);
                    let again = geometry.intersect(&departing, f32::INFINITY, &any);
                    // Next to the start nothing else is met: the thinnest sheet is 1e-4 thick, up to rounding far from the origin.
                    let near = if text == SHELL { 2e-5 } else { 1e-3 };
                    assert!(again.is_none_or(|hit| hit.t > near), "{text}: {s:?} {w:?} {again:?}");
                }
            }
            assert!(n_departures > 200, "{text}: {n_departures}");
        }
    }
}

/// Texture coordinates, tangents and the change of the normal follow each other.
#[test]
fn derivatives_follow_the_surface() {
    let (geometry, _) = single(implicit("x^2 + 1.5*y^2 + z^2 - 0.81", 1.0, None), Transform::IDENTITY, false);
    let mut rng = Rng::new(61, 0);
    for _ in 0..300 {
        let w = direction(&mut rng);
        if w.z.abs() > 0.9 {
            continue;
        }
        let probe = |to: Point3| {
            let ray = Ray::new(to + w, -w);
            let hit = geometry.intersect(&ray, f32::INFINITY, &any).expect("towards the middle");
            (geometry.surface_point(&ray, &hit), geometry.surface_derivatives(&ray, &hit))
        };
        let (here, d) = probe(Point3::ORIGIN);
        for tangent in [d.dpdu, d.dpdv] {
            let step = tangent.normalized() * 2e-3;
            let (ahead, behind) = (probe(Point3::ORIGIN + step).0, probe(Point3::ORIGIN - step).0);
            let (du, dv) = (ahead.uv.x - behind.uv.x, ahead.uv.y - behind.uv.y);
            if du.abs() > 0.5 {
                continue;
            }
            let dp = d.dpdu * du + d.dpdv * dv - (ahead.p - behind.p);
            assert!(dp.length() / 4e-3 < 1e-2, "{here:?}");
            let dn = d.dndu * du + d.dndv * dv - (ahead.ns - behind.ns).as_vector();
            assert!(dn.length() / 4e-3 < 1e-2, "{here:?}: {dn:?}");
        }
    }
}

/// Formulas that are nowhere zero, nowhere defined, always zero, or have poles and jumps: answers in bounded time.
#[test]
fn strange_formulas_have_answers() {
    let empty = |text: &str| {
        let Shape::Implicit(surface) = implicit(text, 1.0, None) else { panic!("it is one") };
        surface.is_empty()
    };
    assert!(empty("x^2 + 1") && empty("sqrt(-1-x^2)") && empty("log(-2-x)") && empty("0/0"));
    assert!(!empty("x") && !empty("0*x"));
    let hits = |text: &str| {
        let (geometry, _) = single(implicit(text, 1.0, None), Transform::IDENTITY, false);
        let mut rng = Rng::new(67, 0);
        let mut rays = (0..200).map(|_| crate::test_support::ray(&mut rng, 1.5));
        rays.by_ref().filter(|ray| geometry.intersect(ray, f32::INFINITY, &any).is_some()).count()
    };
    // Poles are no zeros, jumps across zero are.
    assert_eq!(hits("1/x"), 0);
    assert_eq!(hits("tan(2*x + 1.5707963)*0 + 1/(x-0.1)"), 0);
    assert!(hits("if(x < 0.2, -1, 1)") > 20);
    assert!(hits("floor(3*x) + 0.5") > 20);
    // Touching zero without crossing it, endless waves, and zero all over.
    assert!(hits("(x^2+y^2+z^2-0.8)^2") > 20);
    assert!(hits("sin(1/x)") > 20);
    assert!(hits("max(0, x)") > 20);
    assert!(hits("x*0") > 20);
    for text in ["x^1000 - y^999", "mod(x, 1e-3) - 5e-4", "sqrt(x) - 0.5", "atan2(y, x) - 1"] {
        assert!(hits(text) > 10, "{text}");
    }
}

/// The radius ends the surface, too.
#[test]
fn a_radius_bounds_the_surface() {
    let bounds = Bounds3 { min: Point3::splat(-1.0), max: Point3::splat(1.0) };
    let plane = Shape::Implicit(ImplicitSurface::new(formula("z"), bounds, Some(0.5), None));
    let t = |x: f32| at(&plane, [x, 0.0, 1.0], [0.0, 0.0, -1.0]).map(|(hit, _)| hit.t);
    assert_eq!((t(0.49), t(-0.49), t(0.51)), (Some(1.0), Some(1.0), None));
}
