//! Emissive shapes that move are lights at every time.

use etendue_geometry::Reference;
use etendue_math::statistics::{Moments, mean_test, means_agree};
use etendue_math::{Point2, Rng, hash64, warp};
use etendue_spectrum::Wavelengths;

use super::*;
use crate::light::{Light, LightId};

fn rng(name: &str) -> Rng {
    Rng::new(hash64(&name.bytes().map(u64::from).collect::<Vec<u64>>()), 1)
}

fn rotated(degrees: f32, axis: Vector3) -> Transform {
    Transform::rotate(degrees.to_radians(), axis).expect("an axis")
}

/// From a place above the origin, half a turn around a slant axis, stretched by two in the end.
fn turning() -> AnimatedTransform {
    let place = Transform::translate(Vector3::new(0.3, -0.2, 3.0));
    let stretch = Transform::scale(2.0, 1.0, 0.5).expect("not flat");
    let start = place * rotated(180.0, Vector3::new(1.0, 0.0, 0.0));
    let end = place * rotated(290.0, Vector3::new(1.0, 0.4, 0.1)) * stretch;
    AnimatedTransform { start, end, start_time: 0.0, end_time: 1.0 }
}

fn emitter(entity: Entity) -> ShapeEntity {
    ShapeEntity { area_light: Some(0), ..shape(entity) }
}

fn document(area_light: Entity) -> Document {
    Document { area_lights: vec![area_light], ..dark_with(Vec::new()) }
}

/// A shape of the world that moves.
fn moving_scene(entity: Entity, area_light: Entity) -> Scene {
    let shape = ShapeEntity { world_from_object: turning(), ..emitter(entity) };
    scene(&Document { shapes: vec![shape], ..document(area_light) })
}

fn patch() -> Entity {
    Entity::new("bilinearmesh")
        .with("P", points(&[[-1.0, -1.0, 0.0], [1.0, -1.0, 0.3], [-1.0, 1.0, 0.2], [1.0, 1.0, -0.4]]))
}

fn reference() -> Reference {
    Reference { p: Point3::ORIGIN, n: Some(Normal3::new(0.0, 0.0, 1.0)) }
}

/// Densities of the same point. Where a surface is seen nearly edge on they are ill-conditioned: a ray meets a ball's rim with
/// an error of the order of the root of that of rounding.
#[track_caller]
fn expect_density(pdf: f32, expected: f32) {
    let tolerance = if expected < 50.0 { 1e-2 } else { f32::INFINITY };
    assert!((pdf / expected - 1.0).abs() < tolerance, "{pdf} instead of {expected}");
}

/// Irradiance at the origin by samples of the lights, at the first wavelength.
fn by_lights(scene: &Scene, time: f32, name: &str) -> Moments {
    let (mut rng, lambda, reference) = (rng(name), Wavelengths::sample_visible(0.5), reference());
    let context = scene.light_context_at(time);
    let mut light = |light: &Light| {
        let sample = light.sample_li(&context, &reference, rng.next_point2(), &lambda)?;
        // A flat or round shape has one point that shines in a direction.
        expect_density(light.pdf_li(&context, &reference, sample.wi), sample.pdf_w);
        Some(f64::from(sample.le[0] * sample.wi.z.max(0.0) / sample.pdf_w))
    };
    (0..20_000).map(|_| scene.lights.iter().map(|it| light(it).unwrap_or(0.0)).sum::<f64>()).collect()
}

/// The same by rays in random directions.
fn by_rays(scene: &Scene, time: f32, name: &str) -> Moments {
    let (mut rng, lambda) = (rng(name), Wavelengths::sample_visible(0.5));
    (0..100_000)
        .map(|_| {
            let direction = warp::sample_cosine_hemisphere(rng.next_point2());
            let ray = Ray { origin: Point3::ORIGIN, direction, time };
            let Some(hit) = scene.intersect(&ray, f32::INFINITY) else { return 0.0 };
            f64::from(scene.emitted(&scene.surface(&ray, &hit), &lambda)[0]) * std::f64::consts::PI
        })
        .collect()
}

/// At any time, light found by sampling the lamp is light found by rays that run into it, whatever the map does to the shape.
#[test]
fn moving_lamps_shine_from_where_they_are() {
    let lamp = Entity::new("diffuse");
    for (name, entity) in
        [("square", square()), ("sphere", Entity::new("sphere").with("radius", floats(&[0.7])))]
    {
        let scene = moving_scene(entity, lamp.clone());
        for time in [0.0, 0.3, 0.75, 1.0] {
            let name = format!("{name} at {time}");
            let (lights, rays) =
                (by_lights(&scene, time, &name), by_rays(&scene, time, &format!("{name}, rays")));
            means_agree(&lights, &rays, SIGNIFICANCE).unwrap_or_else(|error| panic!("{name}: {error}"));
            assert!(rays.mean() > 0.0 || time > 0.5, "{name} is dark");
        }
    }
}

/// What a ray runs into is a light with the density that sampling has there, at that time.
#[test]
fn hits_of_moving_lamps_have_their_density() {
    for entity in [square(), Entity::new("sphere"), patch()] {
        let scene = moving_scene(entity, Entity::new("diffuse"));
        let (mut rng, lambda, reference) = (rng("density"), Wavelengths::sample_visible(0.5), reference());
        for _ in 0..200 {
            let time = rng.next_f32();
            let context = scene.light_context_at(time);
            let light = scene.light(LightId(rng.next_u32() % scene.lights.len() as u32));
            let Some(sample) = light.sample_li(&context, &reference, rng.next_point2(), &lambda) else {
                continue;
            };
            let place = sample.p_light.expect("a surface");
            let ray = Ray { origin: Point3::ORIGIN, direction: sample.wi, time };
            let hit = scene.intersect(&ray, f32::INFINITY).expect("the lamp is there");
            if hit.t < 0.999 * sample.distance {
                continue;
            }
            let surface = scene.surface(&ray, &hit);
            assert!((surface.point.p - place.p).length() < 1e-4, "{:?} and {:?}", surface.point.p, place.p);
            // Of two triangles the other may be met, next to their edge.
            let met = scene.light(surface.light.expect("it is a lamp"));
            let pdf = met.pdf_li_at(&context, &reference, sample.wi, surface.point.p, surface.point.ng);
            expect_density(pdf, sample.pdf_w);
        }
    }
}

/// Rays from a moving lamp start on it at their time and carry its power: pi A L, which lumens give as they are.
#[test]
fn rays_leave_moving_lamps_with_their_power() {
    let rigid =
        AnimatedTransform { end: turning().start * rotated(50.0, Vector3::new(0.0, 1.0, 0.0)), ..turning() };
    let shape = ShapeEntity { world_from_object: rigid, ..emitter(square()) };
    let lamp = Entity::new("diffuse").with("power", floats(&[300.0]));
    let scene = scene(&Document { shapes: vec![shape], ..document(lamp) });
    let lumens: f64 = scene.lights.iter().map(|light| light.power(&scene.light_context()).lumens).sum();
    assert!((lumens / 300.0 - 1.0).abs() < 1e-4, "{lumens} lm");
    let (mut rng, lambda) = (rng("emission"), Wavelengths::sample_visible(0.5));
    let radiance = {
        let ray =
            Ray { origin: Point3::new(0.3, -0.2, 0.0), direction: Vector3::new(0.0, 0.0, 1.0), time: 0.0 };
        let hit = scene.intersect(&ray, f32::INFINITY).expect("the lamp is there");
        f64::from(scene.emitted(&scene.surface(&ray, &hit), &lambda)[0])
    };
    let fluxes: Moments = (0..4000)
        .map(|_| {
            let context = scene.light_context_at(rng.next_f32());
            let sum = scene.lights.iter().map(|light| {
                let (u, v): (Point2, Point2) = (rng.next_point2(), rng.next_point2());
                let emitted = light.sample_le(&context, u, v, &lambda).expect("a lamp shines");
                let (pdf_a, pdf_w) = light.pdf_le(&context, &emitted.ray, emitted.n);
                assert!(
                    (pdf_a / emitted.pdf_a - 1.0).abs() < 1e-3 && (pdf_w / emitted.pdf_w - 1.0).abs() < 1e-2
                );
                let back = Ray {
                    origin: emitted.ray.origin + emitted.ray.direction,
                    direction: -emitted.ray.direction,
                    time: context.time,
                };
                let hit = scene.intersect(&back, f32::INFINITY).expect("the lamp is there");
                assert!((hit.t - 1.0).abs() < 1e-3, "it is {} away", hit.t);
                f64::from(emitted.le[0] * emitted.cosine / (emitted.pdf_a * emitted.pdf_w))
            });
            sum.sum::<f64>()
        })
        .collect();
    mean_test(&fluxes, std::f64::consts::PI * 4.0 * radiance, SIGNIFICANCE)
        .unwrap_or_else(|error| panic!("{error}"));
}

/// Emissive shapes of instances that move are lights, each in its place at each time; what stands still beside them stays
/// sampled as before, and the rest of the object is there but once.
#[test]
fn lamps_of_moving_instances_shine() {
    let mut document = document(Entity::new("diffuse"));
    let shapes = vec![emitter(square()), sphere()];
    document.objects.push(ObjectEntity { name: "o".to_owned(), span: None, shapes });
    let far = still(Transform::translate(Vector3::new(50.0, 0.0, 0.0)));
    let near = turning();
    let other = AnimatedTransform { end: near.start, start: near.end, ..near };
    for world_from_instance in [near, far, other] {
        document.instances.push(InstanceEntity { object: "o".to_owned(), span: None, world_from_instance });
    }
    let (scene, problems) = build(&document);
    assert!(problems.is_empty(), "{problems:?}");
    let scene = scene.expect("no problem was reported");
    let n_moving = scene.lights.iter().filter(|light| matches!(light, Light::MovingArea(_))).count();
    assert_eq!((n_moving, scene.lights.len()), (4, 5));
    let counts = scene.geometry.counts();
    assert_eq!((counts.n_instances, counts.n_triangles, counts.n_quadrics), (5, 6, 1));
    // The balls hide much of the squares.
    let mut alone = document.clone();
    alone.objects[0].shapes.truncate(1);
    alone.instances.remove(1);
    let scene = self::scene(&alone);
    for time in [0.2, 0.9] {
        let name = format!("instances at {time}");
        let rays = by_rays(&scene, time, &name);
        assert!(rays.mean() > 0.0);
        let parts: Vec<Moments> = [0, 1]
            .map(|kept| {
                let mut one = alone.clone();
                one.instances = vec![alone.instances[kept].clone()];
                by_lights(&self::scene(&one), time, &name)
            })
            .into();
        // They may hide each other in part, but never shine more.
        let sum = parts[0].mean() + parts[1].mean();
        assert!(rays.mean() < 1.05 * sum && rays.mean() > 0.4 * sum, "{} of {sum}", rays.mean());
    }
}

/// A lamp that grows from a hundredth is chosen by its mean power: of a side that grows evenly from a to b, the mean square is
/// (a^2 + ab + b^2) / 3.
#[test]
fn a_growing_lamp_has_its_mean_power() {
    let scaled = |s| Transform::scale(s, s, s).expect("not flat");
    let power = |start, end| {
        let motion =
            AnimatedTransform { start: scaled(start), end: scaled(end), start_time: 0.0, end_time: 1.0 };
        let shape = ShapeEntity { world_from_object: motion, ..emitter(patch()) };
        let scene = scene(&Document { shapes: vec![shape], ..document(Entity::new("diffuse")) });
        scene.lights.iter().map(|light| light.power(&scene.light_context()).weight).sum::<f64>()
    };
    let (still, growing) = (power(1.0, 0.999_999), power(0.01, 1.0));
    // The error of eight middles of a parabola is at most b^2 / (12 * 64).
    assert!((growing / still - 0.336_7).abs() < 2e-3, "{growing} of {still}");
}
