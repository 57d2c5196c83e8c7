//! Every warp: it and its inverse cancel, its density integrates to 1, its samples have the density.

use std::f32::consts::{FRAC_1_PI, FRAC_PI_2, PI, TAU};

use super::*;
use crate::statistics::{
    Moments, integrate_sphere, interval_chi_square, mean_test, sphere_chi_square, square_chi_square,
};
use crate::{Normal3, Point2, Point3, Rng, Vector3};

const N: usize = 60_000;
const SIGNIFICANCE: f64 = 1e-5;

fn random_points(seed: u64) -> impl Iterator<Item = Point2> {
    let mut rng = Rng::new(seed, 77);
    (0..2000).map(move |_| rng.next_point2())
}

#[track_caller]
fn near(actual: Point2, expected: Point2, tolerance: f32) {
    // Azimuths 0 and 1 are the same.
    let dy = (actual.y - expected.y).abs();
    let distance = (actual.x - expected.x).abs().max(dy.min(1.0 - dy));
    assert!(distance <= tolerance, "{actual:?} instead of {expected:?}");
}

/// Round trip, unit length, integral, chi-square and its mutation for a warp to the sphere.
#[track_caller]
fn check_directions(
    sample: impl Fn(Point2) -> Vector3,
    pdf: impl Fn(Vector3) -> f32,
    invert: impl Fn(Vector3) -> Point2,
    tolerance: f32,
) {
    for u in random_points(1) {
        let w = sample(u);
        assert!((w.length() - 1.0).abs() < 1e-5, "{w:?} at {u:?}");
        assert!(pdf(w) > 0.0);
        near(invert(w), u, tolerance);
    }
    for corner in [0.0, crate::ONE_MINUS_EPSILON] {
        for other in [0.0, 0.5, crate::ONE_MINUS_EPSILON] {
            for u in [Point2::new(corner, other), Point2::new(other, corner)] {
                let w = sample(u);
                assert!(w.is_finite() && (w.length() - 1.0).abs() < 1e-5, "{w:?} at {u:?}");
                let back = invert(w);
                assert!((0.0..1.0).contains(&back.x), "{back:?}");
                assert!((0.0..1.0).contains(&back.y), "{back:?}");
            }
        }
    }
    let integral = integrate_sphere(|w| f64::from(pdf(w)), 1e-4);
    assert!((integral - 1.0).abs() < 2e-3, "the density integrates to {integral}");
    let test = |scale: f32| {
        sphere_chi_square(N, 1, |rng| Some(sample(rng.next_point2())), |w| scale * pdf(w), SIGNIFICANCE)
    };
    test(1.0).unwrap();
    assert!(test(0.95).is_err());
    assert!(test(1.05).is_err());
}

/// RAD-11: the hemisphere holds 2 pi steradians, the sphere 4 pi, and the cosine integrates to pi.
#[test]
fn solid_angles_of_sphere_and_hemisphere() {
    let up = |w: Vector3| f64::from(u8::from(w.z > 0.0));
    assert!((integrate_sphere(up, 1e-5) - f64::from(TAU)).abs() < 1e-4);
    assert!((integrate_sphere(|_| 1.0, 1e-5) - f64::from(2.0 * TAU)).abs() < 1e-4);
    assert!((integrate_sphere(|w| f64::from(w.z.max(0.0)), 1e-5) - f64::from(PI)).abs() < 1e-4);
    assert!((1.0 / uniform_hemisphere_pdf() - TAU).abs() < 1e-5);
    assert!((1.0 / uniform_sphere_pdf() - 2.0 * TAU).abs() < 1e-5);
    // A cone of half angle 60 degrees: 2 pi (1 - cos).
    assert!((1.0 / uniform_cone_pdf(0.5) - PI).abs() < 1e-5);
}

/// BRDF-11: directions by the cosine.
#[test]
fn cosine_hemisphere() {
    check_directions(
        sample_cosine_hemisphere,
        |w| cosine_hemisphere_pdf(w.z),
        invert_cosine_hemisphere,
        1e-4,
    );
}

/// All directions above a surface alike.
#[test]
fn uniform_hemisphere() {
    let pdf = |w: Vector3| if w.z >= 0.0 { uniform_hemisphere_pdf() } else { 0.0 };
    check_directions(sample_uniform_hemisphere, pdf, invert_uniform_hemisphere, 1e-5);
}

/// All directions alike.
#[test]
fn uniform_sphere() {
    check_directions(sample_uniform_sphere, |_| uniform_sphere_pdf(), invert_uniform_sphere, 1e-5);
}

/// All directions of a cone alike, wide or narrow.
#[test]
fn uniform_cones() {
    for cos_max in [-0.5, 0.3, 0.875] {
        check_directions(
            |u| sample_uniform_cone(u, cos_max),
            |w| if w.z >= cos_max { uniform_cone_pdf(cos_max) } else { 0.0 },
            |w| invert_uniform_cone(w, cos_max),
            1e-4,
        );
    }
    // The sun: half angle 0.265 degrees. Cosines in single precision hold 180 steps of the cone's height.
    let sin = 0.004_625_f32;
    let one_minus_cos = sin * sin / (1.0 + (1.0 - sin * sin).sqrt());
    for u in random_points(2) {
        let w = sample_narrow_cone(u, one_minus_cos);
        assert!((w.x * w.x + w.y * w.y).sqrt() <= sin * 1.000_001);
        near(invert_narrow_cone(w, one_minus_cos), u, 1e-5);
    }
    assert!((narrow_cone_pdf(one_minus_cos) * PI * sin * sin - 1.0).abs() < 1e-4);
}

/// MC-8: lobes by a power of the cosine; the mean of the cosine is (n + 1) / (n + 2); n = 1 is BRDF-11.
#[test]
fn cosine_power_lobes() {
    for n in [0.5, 1.0, 10.0, 300.0] {
        check_directions(
            |u| sample_cosine_power(u, n),
            |w| cosine_power_pdf(w.z, n),
            |w| invert_cosine_power(w, n),
            1e-4,
        );
        let mut rng = Rng::new(8, 8);
        let cosines: Moments =
            (0..N).map(|_| f64::from(sample_cosine_power(rng.next_point2(), n).z)).collect();
        mean_test(&cosines, f64::from((n + 1.0) / (n + 2.0)), SIGNIFICANCE).unwrap();
    }
    assert!((cosine_power_pdf(0.3, 1.0) - cosine_hemisphere_pdf(0.3)).abs() < 1e-7);
}

/// Both maps to the disk are uniform: density 1 / pi; radii squared are uniform.
#[test]
fn disks() {
    for (sample, invert, pdf) in [
        (
            sample_concentric_disk as fn(Point2) -> Point2,
            invert_concentric_disk as fn(Point2) -> Point2,
            concentric_disk_pdf(),
        ),
        (sample_polar_disk, invert_polar_disk, polar_disk_pdf()),
    ] {
        assert_eq!(pdf, FRAC_1_PI);
        for u in random_points(3) {
            let p = sample(u);
            assert!(p.x * p.x + p.y * p.y <= 1.000_001);
            near(invert(p), u, 1e-5);
        }
        let density = |p: Point2| {
            let (x, y) = (2.0 * p.x - 1.0, 2.0 * p.y - 1.0);
            if x * x + y * y <= 1.0 { 4.0 * pdf } else { 0.0 }
        };
        let draw = |rng: &mut Rng| {
            let p = sample(rng.next_point2());
            Some(Point2::new(0.5 * (p.x + 1.0), 0.5 * (p.y + 1.0)))
        };
        square_chi_square(N, 3, draw, density, SIGNIFICANCE).unwrap();
        assert!(square_chi_square(N, 3, draw, |p| 0.95 * density(p), SIGNIFICANCE).is_err());
    }
    // The centre of the square is the centre of the disk, the middle of a side its rim.
    assert_eq!(sample_concentric_disk(Point2::new(0.5, 0.5)), Point2::new(0.0, 0.0));
    assert_eq!(sample_concentric_disk(Point2::new(0.0, 0.5)), Point2::new(-1.0, 0.0));
}

/// Round trip, chi-square and its mutation for a warp to an interval that holds all but 1e-6 of the density.
#[track_caller]
fn check_interval(
    range: [f64; 2],
    sample: impl Fn(f32) -> f32,
    pdf: impl Fn(f32) -> f32,
    invert: impl Fn(f32) -> f32,
) {
    for u in random_points(4).map(|p| p.x) {
        let x = sample(u);
        let back = invert(x);
        assert!((back - u).abs() < 2e-5, "{u} to {x} to {back}");
        assert!(pdf(x) > 0.0, "density 0 at {x}");
    }
    assert!(sample(0.0).is_finite() && sample(crate::ONE_MINUS_EPSILON).is_finite());
    let test = |scale: f32| {
        interval_chi_square(N, 4, range, |rng| Some(sample(rng.next_f32())), |x| scale * pdf(x), SIGNIFICANCE)
    };
    test(1.0).unwrap();
    assert!(test(0.95).is_err());
    assert!(test(1.05).is_err());
}

/// MC-7: inversion in one dimension.
#[test]
fn intervals() {
    for (a, b) in [(1.0, 1.0), (0.0, 2.0), (3.0, 0.0), (0.2, 5.0)] {
        check_interval(
            [0.0, 1.0],
            |u| sample_linear(u, a, b),
            |x| linear_pdf(x, a, b),
            |x| invert_linear(x, a, b),
        );
    }
    check_interval([-1.5, 1.5], |u| sample_tent(u, 1.5), |x| tent_pdf(x, 1.5), |x| invert_tent(x, 1.5));
    check_interval(
        [0.0, 20.0],
        |u| sample_exponential(u, 2.0),
        |x| exponential_pdf(x, 2.0),
        |x| invert_exponential(x, 2.0),
    );
    check_interval(
        [-20.0, 30.0],
        |u| sample_normal(u, 3.0, 2.0),
        |x| normal_pdf(x, 3.0, 2.0),
        |x| invert_normal(x, 3.0, 2.0),
    );
    // Quartiles of the normal distribution.
    assert!((sample_normal(0.75, 0.0, 1.0) - 0.674_489_75).abs() < 1e-6);
}

/// Bilinear weights, one corner of which may be 0.
#[test]
fn bilinear_square() {
    for w in [[1.0, 1.0, 1.0, 1.0], [1.0, 2.0, 3.0, 4.0], [0.0, 1.0, 0.5, 7.0], [0.0, 0.0, 1.0, 0.0]] {
        for u in random_points(5) {
            near(invert_bilinear(sample_bilinear(u, w), w), u, 1e-4);
        }
        let test = |scale: f32| {
            square_chi_square(
                N,
                5,
                |rng| Some(sample_bilinear(rng.next_point2(), w)),
                |p| scale * bilinear_pdf(p, w),
                SIGNIFICANCE,
            )
        };
        test(1.0).unwrap();
        assert!(test(0.95).is_err());
    }
}

/// MC-3: a discrete choice has the probabilities of its weights, and leaves a uniform number.
#[test]
fn discrete_choice() {
    let weights = [1.0, 0.0, 3.0, 0.0];
    let mut rng = Rng::new(6, 6);
    let mut chosen = Moments::new();
    let mut remapped = Moments::new();
    for _ in 0..N {
        let (index, pmf, u) = sample_discrete(&weights, rng.next_f32()).unwrap();
        assert_eq!(pmf, weights[index] / 4.0);
        assert!(pmf > 0.0);
        assert!((0.0..1.0).contains(&u));
        chosen.push(index as f64);
        remapped.push(f64::from(u));
    }
    mean_test(&chosen, 1.5, SIGNIFICANCE).unwrap();
    mean_test(&remapped, 0.5, SIGNIFICANCE).unwrap();
    assert_eq!(sample_discrete(&[0.0], 0.5), None);
    assert_eq!(sample_discrete(&weights, crate::ONE_MINUS_EPSILON).map(|s| s.0), Some(2));
}

/// The equal-area map: known points of the layout, round trip, equal density everywhere.
#[test]
fn equal_area_map() {
    let check = |p: (f32, f32), w: (f32, f32, f32)| {
        let actual = equal_area_square_to_sphere(Point2::new(p.0, p.1));
        assert!((actual - Vector3::new(w.0, w.1, w.2)).length() < 1e-6, "{p:?} to {actual:?}");
    };
    // Centre: north; corners: south; middles of the sides: the horizon.
    check((0.5, 0.5), (0.0, 0.0, 1.0));
    check((1.0, 0.5), (1.0, 0.0, 0.0));
    check((0.5, 1.0), (0.0, 1.0, 0.0));
    check((0.0, 0.5), (-1.0, 0.0, 0.0));
    check((0.0, 0.0), (0.0, 0.0, -1.0));
    check((1.0, 1.0), (0.0, 0.0, -1.0));
    let half = 0.5_f32.sqrt();
    check((0.75, 0.75), (half, half, 0.0));
    // r = 1/2 on the diagonal: z = 3/4.
    let side = (7.0_f32 / 16.0).sqrt() * half;
    check((0.625, 0.625), (side, side, 0.75));
    check((0.375, 0.625), (-side, side, 0.75));
    check((0.875, 0.125), (side, -side, -0.75));
    check_directions(
        equal_area_square_to_sphere,
        |_| uniform_sphere_pdf(),
        equal_area_sphere_to_square,
        1e-5,
    );
}

/// Beyond the border the map continues: a step outside gives the direction of a step inside, mirrored along the side.
#[test]
fn equal_area_map_wraps() {
    assert_eq!(wrap_equal_area_square(Point2::new(0.3, 0.4)), Point2::new(0.3, 0.4));
    let step = 1e-3;
    for t in [0.1_f32, 0.35, 0.8] {
        for (outside, inside) in [
            (Point2::new(-step, t), Point2::new(step, t)),
            (Point2::new(1.0 + step, t), Point2::new(1.0 - step, t)),
            (Point2::new(t, -step), Point2::new(t, step)),
            (Point2::new(t, 1.0 + step), Point2::new(t, 1.0 - step)),
        ] {
            let w = equal_area_square_to_sphere(wrap_equal_area_square(outside));
            let neighbour = equal_area_square_to_sphere(inside);
            assert!((w - neighbour).length() < 10.0 * step, "{outside:?}: {w:?} beside {neighbour:?}");
        }
    }
}

/// Points of a triangle, uniform by area: the barycentric coordinates fill their triangle with density 2.
#[test]
fn uniform_triangle() {
    for u in random_points(7) {
        let b = sample_uniform_triangle(u);
        assert!(b.iter().all(|b| (0.0..=1.0).contains(b)), "{b:?}");
        assert!((b[0] + b[1] + b[2] - 1.0).abs() < 1e-6);
        near(invert_uniform_triangle(b), u, 1e-6);
    }
    square_chi_square(
        N,
        7,
        |rng| {
            let b = sample_uniform_triangle(rng.next_point2());
            Some(Point2::new(b[1], b[2]))
        },
        |p| if p.x + p.y < 1.0 { uniform_triangle_pdf(0.5) } else { 0.0 },
        SIGNIFICANCE,
    )
    .unwrap();
}

/// The point of a triangle that barycentric coordinates name.
fn point_of(v: [Point3; 3], b: [f32; 3]) -> Point3 {
    Point3::ORIGIN + v[0].as_vector() * b[0] + v[1].as_vector() * b[1] + v[2].as_vector() * b[2]
}

/// True if the ray from the origin along `w` meets the triangle (all triple products of one sign).
fn meets(v: [Point3; 3], w: Vector3) -> bool {
    let side = |i: usize, j: usize| w.dot(v[i].as_vector().cross(v[j].as_vector()));
    let (a, b, c) = (side(0, 1), side(1, 2), side(2, 0));
    (a >= 0.0 && b >= 0.0 && c >= 0.0) || (a <= 0.0 && b <= 0.0 && c <= 0.0)
}

/// Triangles by solid angle: uniform over the directions that meet them, whatever their size and slant.
#[test]
fn spherical_triangles() {
    for v in [
        // An octant, half a radian, a sliver, a large one.
        [Point3::new(2.0, 0.0, 0.0), Point3::new(0.0, 1.0, 0.0), Point3::new(0.0, 0.0, 3.0)],
        [Point3::new(0.5, 0.2, 2.0), Point3::new(-0.5, 0.4, 2.2), Point3::new(0.1, -0.6, 1.8)],
        [Point3::new(-3.0, 0.05, 1.0), Point3::new(3.0, 0.0, 1.0), Point3::new(3.0, 0.1, 1.0)],
        [Point3::new(-30.0, -20.0, 0.5), Point3::new(30.0, -20.0, 0.5), Point3::new(0.0, 50.0, 0.5)],
    ] {
        let p = Point3::ORIGIN;
        let solid_angle = spherical_triangle_solid_angle(v, p);
        for u in random_points(8) {
            let (b, pdf) = sample_spherical_triangle(v, p, u).unwrap();
            assert!((pdf * solid_angle - 1.0).abs() < 1e-5);
            let w = point_of(v, b).as_vector().normalized();
            near(invert_spherical_triangle(v, p, w).unwrap(), u, 2e-3);
        }
        let test = |scale: f32| {
            sphere_chi_square(
                N,
                8,
                |rng| {
                    let (b, _) = sample_spherical_triangle(v, p, rng.next_point2())?;
                    Some(point_of(v, b).as_vector().normalized())
                },
                |w| {
                    // The line along w meets the plane ahead or behind.
                    let n = (v[1] - v[0]).cross(v[2] - v[0]);
                    let ahead = w.dot(n) * v[0].as_vector().dot(n) > 0.0;
                    if ahead && meets(v, w) { scale / solid_angle } else { 0.0 }
                },
                SIGNIFICANCE,
            )
        };
        test(1.0).unwrap_or_else(|error| panic!("{v:?}: {error}"));
        assert!(test(0.95).is_err());
    }
    let octant = [Point3::new(1.0, 0.0, 0.0), Point3::new(0.0, 1.0, 0.0), Point3::new(0.0, 0.0, 1.0)];
    assert!((spherical_triangle_solid_angle(octant, Point3::ORIGIN) - FRAC_PI_2).abs() < 1e-6);
}

/// A small triangle far away: the solid angle is area times cosine over distance squared (RAD-11), and samples stay uniform.
#[test]
fn small_spherical_triangles() {
    let v = [Point3::new(0.0, 0.0, 100.0), Point3::new(0.1, 0.0, 100.0), Point3::new(0.0, 0.1, 100.0)];
    let solid_angle = spherical_triangle_solid_angle(v, Point3::ORIGIN);
    assert!((solid_angle / (0.005 / 1e4) - 1.0).abs() < 1e-3, "{solid_angle}");
    let mut means = [Moments::new(), Moments::new()];
    for u in random_points(9) {
        let (b, _) = sample_spherical_triangle(v, Point3::ORIGIN, u).unwrap();
        means[0].push(f64::from(b[1]));
        means[1].push(f64::from(b[2]));
    }
    for mean in &means {
        mean_test(mean, 1.0 / 3.0, SIGNIFICANCE).unwrap();
    }
    // Seen edge-on there is nothing to sample.
    let edge_on = [Point3::new(1.0, 0.0, 0.0), Point3::new(2.0, 1.0, 0.0), Point3::new(2.0, -1.0, 0.0)];
    assert!(sample_spherical_triangle(edge_on, Point3::ORIGIN, Point2::new(0.5, 0.5)).is_none());
}

/// Rectangles by solid angle: uniform over the directions that meet them.
#[test]
fn spherical_rectangles() {
    let p = Point3::new(0.3, -0.2, 0.1);
    for (corner, edge_x, edge_y) in [
        (Point3::new(-1.0, -1.0, 1.1), Vector3::new(2.0, 0.0, 0.0), Vector3::new(0.0, 2.0, 0.0)),
        (Point3::new(1.0, 0.5, -2.0), Vector3::new(0.0, 1.0, 1.0), Vector3::new(0.3, 0.4, -0.4)),
        (Point3::new(-40.0, -0.5, 0.2), Vector3::new(80.0, 0.0, 0.0), Vector3::new(0.0, 1.0, 0.0)),
    ] {
        let r = SphericalRectangle::new(p, corner, edge_x, edge_y).unwrap();
        let n = edge_x.cross(edge_y);
        // Where the ray along w meets the rectangle, in units of the edges.
        let meets = |w: Vector3| {
            let t = (corner - p).dot(n) / w.dot(n);
            let d = p + w * t - corner;
            let (x, y) = (d.dot(edge_x) / edge_x.length_squared(), d.dot(edge_y) / edge_y.length_squared());
            t > 0.0 && (0.0..=1.0).contains(&x) && (0.0..=1.0).contains(&y)
        };
        for u in random_points(10) {
            near(r.invert(r.sample(u)), u, 2e-3);
        }
        let test = |scale: f32| {
            sphere_chi_square(
                N,
                10,
                |rng| Some((r.sample(rng.next_point2()) - p).normalized()),
                |w| if meets(w) { scale * r.pdf_w() } else { 0.0 },
                SIGNIFICANCE,
            )
        };
        test(1.0).unwrap_or_else(|error| panic!("{corner:?}: {error}"));
        assert!(test(0.95).is_err());
    }
}

/// One side of a cube fills a sixth of the sphere as seen from its centre; a point in the plane sees nothing.
#[test]
fn solid_angle_of_a_cube_side() {
    let side = |p: Point3| {
        SphericalRectangle::new(
            p,
            Point3::new(-1.0, -1.0, 1.0),
            Vector3::new(2.0, 0.0, 0.0),
            Vector3::new(0.0, 2.0, 0.0),
        )
    };
    assert!((side(Point3::ORIGIN).unwrap().solid_angle() - 4.0 * PI / 6.0).abs() < 1e-6);
    assert!(side(Point3::new(3.0, 0.0, 1.0)).is_none());
    // Far away: area times cosine over distance squared (RAD-11).
    let far = side(Point3::new(0.0, 0.0, 1001.0)).unwrap();
    assert!((far.solid_angle() / 4e-6 - 1.0).abs() < 1e-3);
    let (q, pdf_w) = sample_spherical_rectangle(
        Point3::ORIGIN,
        Point3::new(-1.0, -1.0, 1.0),
        Vector3::new(2.0, 0.0, 0.0),
        Vector3::new(0.0, 2.0, 0.0),
        Point2::new(0.5, 0.5),
    )
    .unwrap();
    assert!(q.distance(Point3::new(0.0, 0.0, 1.0)) < 1e-5, "{q:?}");
    assert!((pdf_w - 6.0 / (4.0 * PI)).abs() < 1e-5);
    assert_eq!(Normal3::new(0.0, 0.0, 1.0).as_vector(), Vector3::new(0.0, 0.0, 1.0));
}
