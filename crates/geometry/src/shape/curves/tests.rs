use etendue_math::{Point3, Ray, Rng, Transform, Vector3};

use super::*;
use crate::Shape;
use crate::test_support::{any, direction, single};

fn bow() -> Curve {
    let p = Point3::new;
    Curve {
        controls: [p(-1.0, 0.0, 0.0), p(-0.5, 1.0, 0.3), p(0.5, -1.0, 0.3), p(1.0, 0.0, 0.0)],
        widths: [0.1, 0.05],
        normals: [Normal3::new(0.0, 0.0, 1.0); 2],
    }
}

fn set(kind: CurveKind, split_depth: u32) -> CurveSet {
    CurveSet { curves: vec![bow()], kind, split_depth }
}

/// Distance of a ray from the curve beside half its width there, by many points.
fn clearance(curve: &Curve, ray: &Ray) -> f64 {
    let (o, d) = (double::point(ray.origin), double::vector(ray.direction).normalize());
    let at = |i: u32| {
        let u = f64::from(i) / 4000.0;
        let way = point_at(&curve.cubic(), u) - o;
        way.reject_from_normalized(d).length() - 0.5 * curve.width(u)
    };
    (0..=4000).map(at).fold(f64::INFINITY, f64::min)
}

/// Rays hit a curve exactly where they pass within half its width, whatever the number of pieces, which all find the same.
#[test]
fn curves_are_hit_within_half_their_width() {
    let geometries = [0, 3, 6]
        .map(|depth| single(Shape::Curves(set(CurveKind::Flat, depth)), Transform::IDENTITY, false).0);
    let mut rng = Rng::new(5, 5);
    let mut n_hits = 0;
    for _ in 0..4000 {
        let d = direction(&mut rng);
        let target = double::to_point(point_at(&bow().cubic(), 0.05 + 0.9 * rng.next_f64()));
        let aside = direction(&mut rng) * (0.1 * rng.next_f32());
        let ray = Ray::new(target + aside - d * 3.0, d);
        let clearance = clearance(&bow(), &ray);
        // Curves are straight to a twentieth of the width only, and along a curve the place that is nearest to the ray is not found.
        if clearance.abs() < 0.006 || d.x.abs() > 0.8 {
            continue;
        }
        for geometry in &geometries {
            let hit = geometry.intersect(&ray, f32::INFINITY, &any);
            assert_eq!(hit.is_some(), clearance < 0.0, "{ray:?} {clearance}");
            n_hits += usize::from(hit.is_some());
        }
    }
    assert!(n_hits > 2000, "{n_hits}");
}

/// Seen from above, u and v are where the ray crosses the band: v = 1/2 on the curve and 0 or 1 at its edges; normals are
/// those of a band or a tube, on the side of the ray.
#[test]
fn parameters_and_normals_are_those_of_a_tube() {
    for kind in [CurveKind::Flat, CurveKind::Cylinder, CurveKind::Ribbon] {
        let p = |x: f32| Point3::new(x, 0.0, 0.0);
        let straight = Curve { controls: [p(0.0), p(1.0), p(2.0), p(3.0)], widths: [0.2; 2], ..bow() };
        let set = CurveSet { curves: vec![straight], kind, split_depth: 2 };
        let (geometry, _) = single(Shape::Curves(set), Transform::IDENTITY, false);
        for (x, y) in [(0.3, 0.0), (1.2, 0.05), (2.2, -0.08)] {
            let ray = Ray::new(Point3::new(x, y, 5.0), Vector3::new(0.0, 0.0, -1.0));
            let hit = geometry.intersect(&ray, f32::INFINITY, &any).expect("below");
            let s = geometry.surface_point(&ray, &hit);
            assert!((hit.t - 5.0).abs() < 1e-5 && (s.uv.x - x / 3.0).abs() < 1e-5, "{s:?}");
            // v grows with y: n × dpdu is z × x.
            assert!((s.uv.y - (0.5 + y / 0.2)).abs() < 1e-4, "{kind:?} {s:?}");
            let derivatives = geometry.surface_derivatives(&ray, &hit);
            assert!(s.ns.as_vector().cross(derivatives.dpdu).dot(derivatives.dpdv) > 0.0);
            assert!((derivatives.dpdu - Vector3::new(3.0, 0.0, 0.0)).length() < 1e-4);
            let expected = match kind {
                // The angle grows with v in proportion, as the sine does near the middle.
                CurveKind::Cylinder => {
                    let angle = y / 0.2 * std::f32::consts::PI;
                    Vector3::new(0.0, angle.sin(), angle.cos())
                }
                _ => Vector3::new(0.0, 0.0, 1.0),
            };
            assert!((s.ns.as_vector() - expected).length() < 1e-4, "{kind:?} {s:?}");
        }
    }
}

/// A ribbon seen edge on is thin.
#[test]
fn ribbons_have_a_face() {
    let (geometry, _) = single(Shape::Curves(set(CurveKind::Ribbon, 3)), Transform::IDENTITY, false);
    let (flat, _) = single(Shape::Curves(set(CurveKind::Flat, 3)), Transform::IDENTITY, false);
    let (mut n_ribbon, mut n_flat) = (0, 0);
    let mut rng = Rng::new(1, 4);
    for _ in 0..4000 {
        let target = Point3::new(2.0 * rng.next_f32() - 1.0, 0.0, 0.6 * rng.next_f32() - 0.1);
        let ray = Ray::new(target - Vector3::new(0.0, 5.0, 0.0), Vector3::new(0.0, 1.0, 0.02));
        n_ribbon += u32::from(geometry.occluded(&ray, f32::INFINITY, &any));
        n_flat += u32::from(flat.occluded(&ray, f32::INFINITY, &any));
    }
    assert!(n_flat > 200 && n_ribbon * 10 < n_flat, "{n_ribbon} {n_flat}");
}

/// All bases describe the same straight line evenly, and numbers of points that fit none are refused.
#[test]
fn bases_become_cubic_bezier_curves() {
    let line: Vec<Point3> = (0..7).map(|i| Point3::new(i as f32, 0.0, 0.0)).collect();
    for (degree, basis, n, first, last) in [
        (3, CurveBasis::Bezier, 2, 0.0, 6.0),
        (2, CurveBasis::Bezier, 3, 0.0, 6.0),
        (3, CurveBasis::BSpline, 4, 1.0, 5.0),
        (2, CurveBasis::BSpline, 5, 0.5, 5.5),
    ] {
        let segments = bezier_segments(&line, degree, basis).expect("the number fits");
        assert_eq!(segments.len(), n);
        assert!((segments[0][0].x - first).abs() < 1e-6 && (segments[n - 1][3].x - last).abs() < 1e-6);
        for pair in segments.windows(2) {
            assert!(pair[0][3].distance(pair[1][0]) < 1e-6);
        }
        for c in &segments {
            for k in 0..3 {
                assert!((c[k + 1].x - c[k].x - (c[3].x - c[0].x) / 3.0).abs() < 1e-5, "{c:?}");
            }
        }
    }
    assert!(bezier_segments(&line[..6], 3, CurveBasis::Bezier).is_none());
    assert!(bezier_segments(&line[..3], 3, CurveBasis::BSpline).is_none());
    assert!(bezier_segments(&line, 1, CurveBasis::Bezier).is_none());
    assert!(bezier_segments(&[], 3, CurveBasis::Bezier).is_none());
}

/// Hostile curves: no length, no width, control points that coincide or are huge.
#[test]
fn degenerate_curves_are_harmless() {
    let p = Point3::new(0.1, 0.2, 0.3);
    let far = Point3::new(1e30, -1e30, 1e30);
    for (controls, widths) in [
        ([p; 4], [0.1; 2]),
        (bow().controls, [0.0; 2]),
        ([p, p, far, far], [0.1, 1e30]),
        ([p, far, p, far], [1e-30; 2]),
    ] {
        let curve = Curve { controls, widths, ..bow() };
        let set = CurveSet { curves: vec![curve], kind: CurveKind::Cylinder, split_depth: 20 };
        assert!(set.validate().is_ok());
        let (geometry, _) = single(Shape::Curves(set), Transform::IDENTITY, false);
        let mut rng = Rng::new(8, 1);
        for _ in 0..200 {
            let ray = crate::test_support::ray(&mut rng, 1.0);
            if let Some(hit) = geometry.intersect(&ray, f32::INFINITY, &any) {
                let s = geometry.surface_point(&ray, &hit);
                assert!(s.ng.is_finite() && (s.ng.as_vector().length() - 1.0).abs() < 1e-3, "{s:?}");
            }
        }
    }
    let nan = Curve { widths: [f32::NAN; 2], ..bow() };
    assert!(CurveSet { curves: vec![nan], ..CurveSet::default() }.validate().is_err());
}
