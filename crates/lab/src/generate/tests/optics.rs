//! Mirrors of the scenes in numbers: where the light that they reflect meets. Rays are traced through the scene as it is built,
//! with its own geometry, one after the other; nothing is random.

use std::f64::consts::PI;

use etendue_geometry::Hit;
use etendue_math::{Point3, Ray, Vector3};
use etendue_scene::Scene;
use etendue_scene::light::Light;
use etendue_scene::scene::Surface;

use super::{Folder, build, find};

type Complex = [f64; 2];

fn built(name: &str, changes: &[(&str, &str)]) -> Scene {
    let files = find(name).generate(changes.iter().copied()).unwrap_or_else(|error| panic!("{error}"));
    let folder = Folder::new(&format!("{name}-optics"), &files);
    build(&folder.0.join(format!("{name}.pbrt")))
}

/// The middle of the lamp.
fn lamp(scene: &Scene) -> Point3 {
    let place = scene.lights.iter().find_map(|light| match light {
        Light::Area(area) => Some(scene.geometry.primitive_bounds(area.geometry, area.primitive)),
        _ => None,
    });
    let bounds = place.expect("the scene has a lamp that is a surface");
    bounds.min + (bounds.max - bounds.min) * 0.5
}

fn surface(scene: &Scene, ray: &Ray) -> Option<Surface> {
    let hit: Option<Hit> = scene.intersect(ray, f32::INFINITY);
    hit.map(|hit| scene.surface(ray, &hit))
}

/// The ray that the surface reflects like a mirror.
fn reflected(surface: &Surface) -> Ray {
    let n = surface.point.ns.as_vector();
    surface.spawn_ray((n * (2.0 * n.dot(surface.wo)) - surface.wo).normalized())
}

fn complex(p: Point3) -> Complex {
    // Rotated, so that the lamp lies in the direction of the real axis.
    [f64::from(p.y), -f64::from(p.x)]
}

fn unit(angle: f64) -> Complex {
    [angle.cos(), angle.sin()]
}

fn sum(a: f64, x: Complex, b: f64, y: Complex) -> Complex {
    [a * x[0] + b * y[0], a * x[1] + b * y[1]]
}

fn distance(x: Complex, y: Complex) -> f64 {
    (x[0] - y[0]).hypot(x[1] - y[1])
}

/// Where two lines through pairs of points cross.
fn crossing([a, b]: [Complex; 2], [c, d]: [Complex; 2]) -> Complex {
    let [u, v, w] = [sum(1.0, b, -1.0, a), sum(1.0, d, -1.0, c), sum(1.0, c, -1.0, a)];
    let cross = |x: Complex, y: Complex| x[0] * y[1] - x[1] * y[0];
    sum(1.0, a, cross(w, v) / cross(u, v), u)
}

/// Angles of places on the ring's inner side, counted from the one next to the lamp: the far half but for its ends.
const STEP: f64 = 0.01;
fn angles() -> impl Iterator<Item = f64> {
    (-120..=120).map(|i| PI + STEP * f64::from(i))
}

/// Where neighbouring rays from the middle of the lamp cross that the ring reflects onto the table, seen from above, with the
/// angle between their places on the ring.
fn ring_envelope(scene: &Scene) -> Vec<(f64, Complex)> {
    let lamp = lamp(scene);
    let rays: Vec<(f64, [Complex; 2])> = angles()
        .map(|angle| {
            let [y, x] = unit(angle).map(|c| c as f32);
            let towards = Point3::new(-x, y, 0.2) - lamp;
            // Outside of the lamp.
            let ray = Ray::new(lamp + towards * 0.1, towards.normalized());
            let wall = surface(scene, &ray).expect("a ring");
            let place = complex(wall.point.p);
            assert!((distance(place, [0.0; 2]) - 1.0).abs() < 1e-5, "met {:?} on the way", wall.point.p);
            let table = surface(scene, &reflected(&wall)).expect("a table");
            assert!(table.point.p.z.abs() < 1e-5, "reflected to {:?}", table.point.p);
            (angle, [place, complex(table.point.p)])
        })
        .collect();
    rays.windows(2).map(|pair| (0.5 * (pair[0].0 + pair[1].0), crossing(pair[0].1, pair[1].1))).collect()
}

/// What reflects parallel light, or light of a point at distance `a` in the plane, from the place at an angle of the unit
/// circle: the mirror equation 1 / L + 1 / s = 2 / cos i for rays that cross in the plane of incidence.
fn catacaustic(a: f64, angle: f64) -> Complex {
    let place = unit(angle);
    let length = distance(place, [a, 0.0]);
    let incoming = sum(1.0 / length, place, -1.0 / length, [a, 0.0]);
    let cosine = incoming[0] * place[0] + incoming[1] * place[1];
    let outgoing = sum(1.0, incoming, -2.0 * cosine, place);
    sum(1.0, place, 1.0 / (2.0 / cosine - 1.0 / length), outgoing)
}

/// Twice three quarters of a turn for each turn of the place: the curve with two cusps.
fn nephroid(angle: f64) -> Complex {
    sum(0.75, unit(angle), -0.25, unit(3.0 * angle))
}

/// The curve with one cusp, opposite to the lamp.
fn cardioid(angle: f64) -> Complex {
    sum(2.0 / 3.0, unit(angle), 1.0 / 3.0, unit(2.0 * angle))
}

/// Tangents of a curve whose points are d apart cross within d of it. Coordinates are rounded to 1e-6 and lines cross under
/// more than a quarter of `STEP`, so that rounding moves a crossing by up to 1e-3.
const ROUNDING: f64 = 1e-3;

/// The caustic of the ring is the envelope of the rays in the plane, for the wall is upright: that of a lamp at some distance,
/// and, for a lamp above the rim, the cardioid (SPEC SCENE-16).
#[test]
fn the_ring_has_its_envelope() {
    let far = built("ring", &[]);
    let a = f64::from(lamp(&far).y);
    assert!((a - 6.0 * 35_f64.to_radians().cos()).abs() < 1e-5);
    for (angle, p) in ring_envelope(&far) {
        let expected = catacaustic(a, angle);
        let spread = distance(catacaustic(a, angle - 0.5 * STEP), catacaustic(a, angle + 0.5 * STEP));
        assert!(distance(p, expected) < spread + ROUNDING, "{angle}: {p:?} instead of {expected:?}");
    }
    let rim = built("ring", &[("distance", "1.220775")]);
    assert!((lamp(&rim).y - 1.0).abs() < 1e-5, "above the rim");
    for (angle, p) in ring_envelope(&rim) {
        let expected = cardioid(angle);
        let spread = distance(cardioid(angle - 0.5 * STEP), cardioid(angle + 0.5 * STEP));
        assert!(distance(p, expected) < spread + ROUNDING, "{angle}: {p:?} instead of {expected:?}");
    }
}

/// From a lamp that is far away the caustic is the nephroid, with a cusp half way to the middle. Seen from the ring, light at
/// distance a comes from up to b = arcsin(1 / a) beside the parallel; each ray turns by as much, and so does its angle of
/// incidence: over s <= 1/2 that makes b / 2 each, and the distance of the lamp s² / L <= 1 / (4 (a - 1)).
#[test]
fn far_away_the_ring_has_a_nephroid() {
    let scene = built("ring", &[("distance", "100")]);
    let a = f64::from(lamp(&scene).y);
    let bound = (1.0 / a).asin() + 0.26 / (a - 1.0) + ROUNDING;
    let points = ring_envelope(&scene);
    for (angle, p) in &points {
        let expected = nephroid(*angle);
        let spread = distance(nephroid(angle - 0.5 * STEP), nephroid(angle + 0.5 * STEP));
        assert!(distance(*p, expected) < spread + bound, "{angle}: {p:?} instead of {expected:?}");
    }
    let nearest = points.iter().map(|(_, p)| distance(*p, [0.0; 2])).fold(f64::INFINITY, f64::min);
    assert!((nearest - 0.5).abs() < bound, "the cusp is {nearest} from the middle");
}

/// All light along its axis meets in the focus of the paraboloid. Light of the lamp, which is on the axis at 20 m, misses
/// it by |P - F| sin b where it comes to P at an angle b to the axis: by up to 1.8 cm, all within the target of 3 cm
/// (SPEC SCENE-32, GEO-6).
#[test]
fn the_paraboloid_burns_at_its_focus() {
    let scene = built("formulas", &[]);
    let (sine, cosine) = 30_f32.to_radians().sin_cos();
    let vertex = Point3::new(1.7, 0.0, 0.12);
    let (axis, up) = (Vector3::new(0.0, sine, cosine), Vector3::new(0.0, cosine, -sine));
    let focus = vertex + axis * 0.25;
    let lamp = lamp(&scene);
    assert!((lamp - (vertex + axis * 20.0)).length() < 1e-4, "the lamp is at {lamp:?}");
    for i in 1..=10 {
        for k in 0..16 {
            let (r, turn) = (0.055 * i as f32, std::f32::consts::TAU * k as f32 / 16.0);
            let across = Vector3::new(1.0, 0.0, 0.0) * (r * turn.cos()) + up * (r * turn.sin());
            let mirror = vertex + across + axis * (r * r);
            // The target shades what comes within 3 cm of the axis.
            for from in [mirror + axis, lamp + (mirror - lamp) * 0.1] {
                let ray = Ray::new(from, (mirror - from).normalized());
                let met = surface(&scene, &ray).expect("a mirror");
                assert!((met.point.p - mirror).length() < 1e-4, "met {:?} on the way", met.point.p);
                let ray = reflected(&met);
                let to_focus = focus - ray.origin;
                let miss = to_focus.cross(ray.direction).length();
                let expected = to_focus.length() * axis.cross(met.wo).length();
                assert!((miss - expected).abs() < 2e-6, "misses by {miss} instead of {expected}");
                let target = surface(&scene, &ray).expect("a target");
                assert!(((target.point.p - focus).length() - 0.03).abs() < 1e-5, "{:?}", target.point.p);
            }
        }
    }
}
