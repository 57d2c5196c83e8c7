//! Physics of the small program.

use super::*;

const O: V = V(0.0, 0.0, 0.0);
const WHITE: V = V(10.0, 10.0, 10.0);

fn program(objects: Vec<Object>, as_printed: bool) -> Program {
    Program { objects, ..Program::new(false, as_printed) }
}

#[track_caller]
fn assert_close(a: V, b: V, tolerance: f64) {
    assert!((a - b).dot(a - b).sqrt() <= tolerance, "{a:?} is not {b:?}");
}

/// SPEC SMALL-2, L29: products of vectors.
#[test]
fn algebra() {
    let (a, b) = (V(1.0, -2.0, 3.0), V(0.5, 4.0, -1.0));
    assert_eq!((a + b, a - b), (V(1.5, 2.0, 2.0), V(0.5, -6.0, 4.0)));
    assert_eq!((a * b, a * 2.0, a.dot(b)), (V(0.5, -8.0, -3.0), V(2.0, -4.0, 6.0), -10.5));
    assert_eq!(V(1.0, 0.0, 0.0).cross(V(0.0, 1.0, 0.0)), V(0.0, 0.0, 1.0));
    assert_eq!(a.cross(b), V(-10.0, 2.5, 5.0));
    assert_eq!((a.cross(b).dot(a), a.cross(b).dot(b)), (0.0, 0.0));
    assert!((a.normalized().dot(a.normalized()) - 1.0).abs() < 1e-15);
}

/// SPEC SMALL-3, L30: from before a ball, in it and behind it; a plane from both sides.
#[test]
fn surfaces_are_met() {
    let check = |shape: Shape, o: V, d: V, expected: Option<f64>| {
        assert_eq!(Object(shape, Kind::Mirror).intersect(&Ray(o, d)), expected, "{shape:?} from {o:?}");
    };
    let (ball, z) = (Shape::Sphere(V(0.0, 0.0, -3.0), 1.0), V(0.0, 0.0, -1.0));
    check(ball, O, z, Some(2.0));
    check(ball, V(0.0, 0.0, -3.0), z, Some(1.0));
    check(ball, V(0.0, 0.0, -2.0), z, Some(2.0));
    check(ball, V(0.0, 0.0, -5.0), z, None);
    check(ball, V(0.0, 1.5, 0.0), z, None);
    let plane = Shape::Plane(V(0.0, 0.0, 1.0), 5.5);
    check(plane, O, z, Some(5.5));
    check(plane, V(0.0, 0.0, -6.0), z * -1.0, Some(0.5));
    check(plane, O, V(0.0, 1.0, 0.0), None);
    check(plane, O, z * -1.0, None);
    let normal = |shape| Object(shape, Kind::Mirror).normal(V(0.0, 0.0, -2.0));
    assert_eq!((normal(ball), normal(plane)), (V(0.0, 0.0, 1.0), V(0.0, 0.0, 1.0)));
}

/// SPEC SMALL-4: 90 degrees across and down, in the axes of either scene. A small lamp in the direction of one pixel's middle is
/// in that pixel alone.
#[test]
fn pixels_look_where_they_should() {
    const SIZE: usize = 9;
    for first in [false, true] {
        let axes = Program::new(first, false).axes;
        for target in [[0, 4], [8, 0], [4, 4], [2, 7]] {
            let place = |i: usize| (2 * i + 1) as f64 / SIZE as f64 - 1.0;
            let lamp = Object(
                Shape::Sphere(axes(place(target[0]), place(target[1]), -1.0) * 9.0, 0.5),
                Kind::Lamp(1.0),
            );
            let program = Program { objects: vec![lamp], ..Program::new(first, false) };
            for (x, y) in (0..SIZE * SIZE).map(|k| (k % SIZE, k / SIZE)) {
                assert_eq!(program.pixel([x, y], SIZE, 200) != O, [x, y] == target, "{x} {y} of {target:?}");
            }
        }
    }
}

/// SPEC SMALL-6: as printed, paths have 6.56 vertices in the mean and at most 16, so that what comes after is lost;
/// here they have 8 in the mean, and any number.
#[test]
fn roulette_ends_paths() {
    let lengths = |as_printed: bool| {
        let program = Program::new(false, as_printed);
        let mut alive = 1.0;
        let reached = (0..200).map(|depth| {
            alive *= 1.0 - program.stop_probability(depth);
            alive
        });
        reached.collect::<Vec<f64>>()
    };
    let (printed, own) = (lengths(true), lengths(false));
    assert!((own.iter().sum::<f64>() - 8.0).abs() < 1e-9);
    assert!((printed.iter().sum::<f64>() - 6.5605).abs() < 1e-4);
    assert!(printed[15] > 0.0 && printed[16] == 0.0 && own[16] > 0.0);
}

/// SPEC SMALL-7, L31: Halton's numbers, and directions in proportion to the cosine: their mean is 2/3 n, and the mean of the
/// squared cosine is 1/2.
#[test]
fn lobes_are_cosines() {
    assert_eq!([1, 2, 3, 4].map(|i| radical_inverse(2, i)), [0.5, 0.25, 0.75, 0.125]);
    assert_eq!([1, 2, 3].map(|i| (radical_inverse(3, i) * 9.0).round()), [3.0, 6.0, 1.0]);
    for n in [V(0.0, 0.0, 1.0), V(0.0, -1.0, 0.0), V(1.0, 0.0, 0.0), V(0.6, -0.48, 0.64)] {
        const N: u64 = 4096;
        let (mut mean, mut squares) = (O, 0.0);
        for sample in 0..N {
            let d = cosine_lobe(n, halton_pair([7, sample], 2));
            assert!((d.dot(d) - 1.0).abs() < 1e-12 && d.dot(n) >= 0.0);
            mean = mean + d * (1.0 / N as f64);
            squares += d.dot(n).powi(2) / N as f64;
        }
        // Even points err by about log(N)² / N, which is 0.02.
        assert_close(mean, n * (2.0 / 3.0), 0.02);
        assert!((squares - 0.5).abs() < 0.02, "{squares}");
    }
}

/// SPEC SMALL-5 to SMALL-7: a matte ball around a lamp of radiance 1 sees it under the share F = (r / R)² of its light, so that
/// its radiance is L = a (F + (1 - F) L) everywhere. Albedos above 1 become 1, where L is 1. As printed, all is different.
#[test]
fn a_room_is_as_bright_as_it_should_be() {
    let (centre, r, big_r) = (V(0.0, 0.0, -3.0), 1.5, 5.0);
    let walls = Object(Shape::Sphere(centre, big_r), Kind::Diffuse(V(3.0, 8.0, 12.0)));
    let objects = vec![walls, Object(Shape::Sphere(centre, r), Kind::Lamp(1.0))];
    let share = r * r / (big_r * big_r);
    let expected = |albedo: f64| albedo * share / (1.0 - albedo * (1.0 - share));
    let z_scores = |as_printed: bool| {
        let program = program(objects.clone(), as_printed);
        // A pixel at the edge looks past the lamp.
        let blocks: Vec<V> = (0..64).map(|k| program.pixel([0, k], 64, 256)).collect();
        let score = |value: &dyn Fn(&V) -> f64, albedo: f64| {
            let n = blocks.len() as f64;
            let mean = blocks.iter().map(value).sum::<f64>() / n;
            let variance = blocks.iter().map(|b| (value(b) - mean).powi(2)).sum::<f64>() / (n - 1.0);
            (mean - expected(albedo)) / (variance / n).sqrt()
        };
        [score(&|v| v.0, 0.3), score(&|v| v.1, 0.8), score(&|v| v.2, 1.0)]
    };
    let own = z_scores(false);
    assert!(own.iter().all(|z| z.abs() < 4.0), "{own:?}");
    assert!(z_scores(true).iter().all(|z| z.abs() > 10.0));
}

/// SPEC SMALL-8: mirrors and glass neither lose nor make light; as printed, each passage of glass adds 15 %.
#[test]
fn mirrors_and_glass_keep_radiance() {
    for kind in [Kind::Mirror, Kind::Glass] {
        let ball = Object(Shape::Sphere(V(0.0, 0.0, -3.0), 1.0), kind);
        let sky = Object(Shape::Sphere(O, 50.0), Kind::Lamp(1.0));
        let mut random = Random(1);
        for x in 0..20 {
            let ray = || Ray(O, V(0.015 * x as f64, 0.0, -1.0).normalized());
            let own = program(vec![ball, sky], false);
            let mean = (0..400).map(|k| own.trace(ray(), [0, k], &mut random).0).sum::<f64>() / 400.0;
            // Paths that end count for the others: at most a few in a hundred get that far.
            assert!((mean - 1.0).abs() < 0.05, "{kind:?} {x}: {mean}");
            let printed = program(vec![ball, sky], true).trace(ray(), [0, 0], &mut random).0;
            let is_mirror = matches!(kind, Kind::Mirror);
            assert!(if is_mirror { printed == 2.0 } else { printed == 0.0 || printed >= 2.3 }, "{printed}");
        }
    }
}

/// SPEC SMALL-8: Snell's law; nothing passes beyond the critical angle; reflectance is the same from both sides.
#[test]
fn glass_refracts() {
    let n = V(0.0, 0.0, 1.0);
    for (sine, ior) in [(0.0, 1.5), (0.3, 1.5), (0.8, 1.5), (0.99, 1.9)] {
        let d = V(sine, 0.0, -(1.0_f64 - sine * sine).sqrt());
        let inside = refract(d, n, ior, 1.0, false);
        assert_close(V(inside.0 * ior, 0.0, 0.0), V(sine, 0.0, 0.0), 1e-12);
        assert!(inside.2 < 0.0);
        assert_close(refract(inside * -1.0, n, ior, 1.0, false), d * -1.0, 1e-12);
        assert_close(refract(d, n, ior, 0.0, false), V(d.0, 0.0, -d.2), 1e-12);
        // The reflectance is the choice from which on light passes.
        let reflectance = |d: V| {
            let steps = (0..10_000).map(|k| k as f64 / 10_000.0);
            steps.filter(|choice| refract(d, n, ior, *choice, false).2.signum() != d.2.signum()).count()
        };
        assert!(reflectance(d).abs_diff(reflectance(inside * -1.0)) <= 1);
        if sine == 0.0 {
            assert!(reflectance(d).abs_diff((1e4 * ((1.0 - ior) / (1.0 + ior)).powi(2)) as usize) <= 1);
        }
    }
    let beyond = V(0.8, 0.0, 0.6);
    assert_close(refract(beyond, n, 1.5, 1.0, false), V(0.8, 0.0, -0.6), 1e-12);
}

/// SPEC SMALL-10, EXP-25: the later scene is lit; in the first, no path finds the lamp.
#[test]
fn scenes_have_their_light() {
    let mean = |first: bool| {
        let program = Program::new(first, false);
        let pixels = (0..400).map(|k| program.pixel([k % 20, k / 20], 20, 4).1);
        pixels.sum::<f64>() / 400.0
    };
    assert_eq!(mean(true), 0.0);
    assert!((300.0..900.0).contains(&mean(false)), "{}", mean(false));
    let Kind::Diffuse(colour) = Program::new(false, false).objects[0].1 else { panic!("the floor is matte") };
    assert_eq!(colour * (1.0 / 0.6), WHITE);
}

/// SPEC SMALL-9: a text file with three numbers for each pixel, at most 255; as printed they are the radiance without its
/// fraction.
#[test]
fn pictures_are_text() {
    let pixels = [V(0.0, 12.9, 254.99), V(255.0, 1e9, 40.0), O, V(1.0, 2.0, 3.0)];
    let printed = Program::new(false, true).encode(&pixels, 2);
    assert_eq!(printed, "P3 2 2 255\n0\n12\n254\n255\n255\n40\n0\n0\n0\n1\n2\n3\n");
    let own = Program::new(false, false).encode(&[V(500.0, 0.0, 125.0)], 1);
    // A quarter of what is white has the square of a half, nearly.
    assert_eq!(own, "P3 1 1 255\n255\n0\n135\n");
}
