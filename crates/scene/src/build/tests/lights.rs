//! Shapes that emit, and how lights are chosen.

use etendue_geometry::Reference;
use etendue_math::statistics::{Moments, mean_test, means_agree};
use etendue_math::{Point2, Rng, hash64, warp};
use etendue_spectrum::{Sampled, Wavelengths};

use super::*;
use crate::light::{Light, LightId, LightSampler};
use crate::scene::ShapeLights;

/// These shapes, all with the area light of the given entity.
fn emitting(mut shapes: Vec<ShapeEntity>, area_light: Entity) -> Document {
    for shape in &mut shapes {
        shape.area_light = Some(0);
    }
    Document { area_lights: vec![area_light], ..dark_with(shapes) }
}

fn lamp() -> Entity {
    Entity::new("diffuse")
}

/// Each triangle of a mesh is a light, and a ray that meets it finds that light.
#[test]
fn each_primitive_is_a_light() {
    let at = |x: f32| still(Transform::translate(Vector3::new(x, 0.0, 0.0)));
    let kite = Entity::new("trianglemesh")
        .with("P", points(&[[-1.0, -1.0, 0.0], [1.0, -1.0, 0.0], [2.0, 2.0, 0.0], [-1.0, 1.0, 0.0]]))
        .with("indices", integers(&[0, 1, 2, 0, 2, 3]));
    let shapes = vec![
        shape(square()),
        ShapeEntity { world_from_object: at(5.0), ..sphere() },
        ShapeEntity { world_from_object: at(10.0), ..shape(kite) },
    ];
    let mut document = emitting(shapes, lamp());
    document.lights = lit().lights;
    let scene = scene(&document);
    // The two triangles of a square are one light.
    assert_eq!(scene.lights.len(), 1 + 1 + 1 + 2);
    assert!(scene.infinite_lights.is_empty());
    let lights = scene.attributes.iter().map(|a| a.lights).collect::<Vec<_>>();
    let expected =
        [ShapeLights::whole(LightId(1)), ShapeLights::each(LightId(2)), ShapeLights::each(LightId(3))];
    assert_eq!(lights, expected.map(Some));
    for (x, y, light) in [(0.5, -0.5, 1), (-0.5, 0.5, 1), (5.0, 0.0, 2), (10.5, -0.5, 3), (9.5, 0.5, 4)] {
        let ray = down(x, y);
        let hit = scene.intersect(&ray, f32::INFINITY).expect("something is below");
        let surface = scene.surface(&ray, &hit);
        assert_eq!(surface.light, Some(LightId(light)));
        let Light::Area(area) = scene.light(LightId(light)) else { panic!("no area light") };
        let primitive = if light == 1 { 0 } else { hit.primitive };
        assert_eq!((area.geometry, area.primitive), (hit.geometry, primitive));
        assert!(!scene.emitted(&surface, &Wavelengths::sample_visible(0.5)).is_black());
    }
}

/// Boundaries of media are no lights, as in pbrt-v4. They stay visible.
#[test]
fn boundaries_of_media_cannot_be_lights() {
    let emitter = ShapeEntity { area_light: Some(0), ..shape(here(Entity::new("sphere"))) };
    let mut document = Document { area_lights: vec![lamp()], ..lit() };
    document.materials.push(named_material("none", Entity::new("interface")));
    let none = MaterialReference::Name("none".to_owned(), None);
    document.shapes.push(ShapeEntity { material: none, ..emitter });
    let scene = warning_here(&document, "the boundary of a medium cannot be a light");
    assert_eq!(scene.lights.len(), 1);
    assert!(scene.attributes[0].lights.is_none() && below(&scene, 0.5, 0.0).is_some());
}

/// An emissive shape of an object is a light for each instance, in its place.
#[test]
fn emissive_shapes_of_instances_are_lights() {
    let emitter = ShapeEntity { area_light: Some(0), ..shape(here(Entity::new("sphere"))) };
    let mut document = Document { area_lights: vec![lamp()], ..lit() };
    document.lights.clear();
    let shapes = vec![emitter, sphere()];
    document.objects.push(ObjectEntity { name: "o".to_owned(), span: None, shapes });
    for x in [-5.0, 5.0, 50.0] {
        let world_from_instance = still(Transform::translate(Vector3::new(x, 0.0, 0.0)));
        document.instances.push(InstanceEntity { object: "o".to_owned(), span: None, world_from_instance });
    }
    let (scene, problems) = build(&document);
    assert!(problems.is_empty(), "{problems:?}");
    let scene = scene.expect("no problem was reported");
    let context = scene.light_context();
    let places: Vec<f32> =
        scene.lights.iter().filter_map(|light| light.bounds(&context)).map(|b| b.centroid().x).collect();
    assert_eq!(places, [-5.0, 5.0, 50.0]);
}

/// What is too much of one object leaves the lamps of others alight.
#[test]
fn emissive_shapes_are_judged_by_object() {
    let emitter = |entity: Entity| ShapeEntity { area_light: Some(0), ..shape(here(entity)) };
    let dense = || {
        let p = points(&[[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]]);
        Entity::new("loopsubdiv").with("P", p).with("indices", integers(&[0, 1, 2]))
    };
    let curve = Entity::new("curve").with("P", points(&[[0.0; 3], [0.1; 3], [0.2; 3], [0.3; 3]]));
    let wandering = ShapeEntity { world_from_object: moving(), ..emitter(Entity::new("sphere")) };
    let mut document = Document { area_lights: vec![lamp()], ..lit() };
    document.lights.clear();
    for (name, shapes, place, n) in [
        ("moves", vec![emitter(Entity::new("sphere"))], moving(), 1),
        ("dense", vec![emitter(dense().with("levels", integers(&[10])))], still(Transform::IDENTITY), 3),
        ("fine", vec![emitter(dense())], still(Transform::IDENTITY), 1),
        (
            "still",
            vec![emitter(Entity::new("sphere")), wandering, emitter(curve)],
            still(Transform::IDENTITY),
            3,
        ),
    ] {
        document.objects.push(ObjectEntity { name: name.to_owned(), span: None, shapes });
        for _ in 0..n {
            let (object, world_from_instance) = (name.to_owned(), place);
            document.instances.push(InstanceEntity { object, span: None, world_from_instance });
        }
    }
    let placed = crate::build::emitters::place_emitters(&document, &Assets::default());
    let document = placed.document.as_ref();
    let left: Vec<usize> = document.objects.iter().map(|object| object.shapes.len()).collect();
    // What moves is in an object of its own at the end, with an instance of its own.
    assert_eq!((left, document.shapes.len()), (vec![0, 1, 0, 2, 1], 1 + 3));
    assert_eq!((placed.moving[&document.objects[4].name], document.instances.len()), (8, 9));
}

/// A scene without light is black, which is seldom meant.
#[test]
fn darkness_is_a_warning() {
    let (scene, problems) = build(&dark_with(vec![sphere()]));
    let [problem] = problems.as_slice() else { panic!("{problems:?}") };
    assert!(problem.severity == Severity::Warning && problem.message.contains("no lights"));
    let scene = scene.expect("a warning leaves a scene");
    let reference = Reference { p: Point3::ORIGIN, n: None };
    assert!(scene.light_sampler.sample(0, &reference, 0.5).is_none());
}

/// An area light of an unknown kind is an error, and its unknown parameters are warnings, once for all shapes.
#[test]
fn area_lights_are_checked() {
    let mut document = emitting(vec![sphere(), sphere()], here(Entity::new("difuse")));
    document.lights = lit().lights;
    let problem = error_here(&document, "unknown area light \"difuse\"");
    assert_helps(&problem, "did you mean \"diffuse\"?");
    let lamp = here(lamp().with("scal", floats(&[2.0])));
    let scene =
        warning_here(&emitting(vec![sphere(), sphere()], lamp), "does not know the parameter \"scal\"");
    assert_eq!(scene.lights.len(), 2);
}

/// Lights are chosen as the integrator's parameter says.
#[test]
fn light_samplers_by_name() {
    let with = |name: &str| {
        let integrator = here(Entity::new("path").with("lightsampler", strings(&[name])));
        Document { integrator: Some(integrator), ..lit() }
    };
    assert!(matches!(scene(&lit()).light_sampler, LightSampler::Tree(_)));
    assert!(matches!(scene(&with("bvh")).light_sampler, LightSampler::Tree(_)));
    assert!(matches!(scene(&with("exhaustive")).light_sampler, LightSampler::Tree(_)));
    assert!(matches!(scene(&with("power")).light_sampler, LightSampler::Power(Some(_))));
    assert!(matches!(scene(&with("uniform")).light_sampler, LightSampler::Uniform(1)));
    let problem = error_here(&with("uniforms"), "unknown light sampler \"uniforms\"");
    assert_helps(&problem, "did you mean \"uniform\"?");
}

/// The square at z = 1 that shines on the origin, with an alpha, and a texture for it that is 1 in the left half.
fn lamp_above(alpha: Option<Value>) -> Scene {
    let entity = match alpha {
        Some(alpha) => square().with("alpha", alpha),
        None => square(),
    };
    let lamp = ShapeEntity {
        world_from_object: still(Transform::translate(Vector3::new(0.0, 0.0, 1.0))),
        reverse_orientation: true,
        ..shape(entity)
    };
    let checks = Entity::new("checkerboard").with("uscale", floats(&[2.0]));
    let document = emitting(vec![lamp], self::lamp().with("scale", floats(&[10.0])));
    scene(&Document { textures: vec![float_texture("left", checks)], ..document })
}

fn rng(name: &str) -> Rng {
    Rng::new(hash64(&name.bytes().map(u64::from).collect::<Vec<u64>>()), 1)
}

/// Irradiance at the origin by samples of the lights, at the first wavelength.
fn irradiance_by_lights(scene: &Scene, name: &str) -> Moments {
    let (mut rng, lambda) = (rng(name), Wavelengths::sample_visible(0.5));
    let up = Normal3::new(0.0, 0.0, 1.0);
    let reference = Reference { p: Point3::ORIGIN, n: Some(up) };
    let light = |light: &Light, u: Point2| {
        let sample = light.sample_li(&scene.light_context(), &reference, u, &lambda)?;
        Some(f64::from(sample.le[0] * up.dot_vector(sample.wi) / sample.pdf_w))
    };
    (0..20_000)
        .map(|_| scene.lights.iter().map(|it| light(it, rng.next_point2()).unwrap_or(0.0)).sum::<f64>())
        .collect()
}

/// The same by rays in random directions.
fn irradiance_by_rays(scene: &Scene, name: &str) -> Moments {
    let (mut rng, lambda) = (rng(name), Wavelengths::sample_visible(0.5));
    let emitted = |ray: &Ray| -> Sampled {
        let Some(hit) = scene.intersect(ray, f32::INFINITY) else { return Sampled::ZERO };
        scene.emitted(&scene.surface(ray, &hit), &lambda)
    };
    (0..100_000)
        .map(|_| {
            let ray = Ray::new(Point3::ORIGIN, warp::sample_cosine_hemisphere(rng.next_point2()));
            f64::from(emitted(&ray)[0]) * std::f64::consts::PI
        })
        .collect()
}

/// Light of a surface with holes is the same by samples of the light as by rays that find it: alpha times that of the
/// whole surface, which is E = pi L F with the form factor F of a square of side 2 m at 1 m.
#[test]
fn light_of_a_surface_with_holes() {
    let (scene, ray) = (lamp_above(None), Ray::new(Point3::ORIGIN, Vector3::new(0.0, 0.0, 1.0)));
    let hit = scene.intersect(&ray, f32::INFINITY).expect("the lamp is above");
    let radiance = scene.emitted(&scene.surface(&ray, &hit), &Wavelengths::sample_visible(0.5))[0];
    let whole = f64::from(radiance) * 4.0 * 0.5_f64.sqrt() * 0.5_f64.sqrt().atan();
    for (name, alpha, share) in
        [("half", floats(&[0.5]), 0.5), ("fifth", floats(&[0.2]), 0.2), ("texture", texture("left"), 0.5)]
    {
        let scene = lamp_above(Some(alpha));
        assert!(scene.lights.iter().all(|light| !light.is_delta()));
        let (lights, rays) = (irradiance_by_lights(&scene, name), irradiance_by_rays(&scene, name));
        means_agree(&lights, &rays, SIGNIFICANCE).unwrap_or_else(|error| panic!("{name}: {error}"));
        mean_test(&lights, share * whole, SIGNIFICANCE).unwrap_or_else(|error| panic!("{name}: {error}"));
    }
}

/// Alpha 0 makes an invisible light, as in pbrt-v4: no ray meets it, but it shines with its whole radiance on whatever
/// samples it. No other technique finds it, so it counts as a delta light.
#[test]
fn alpha_zero_makes_invisible_lights() {
    let (whole, invisible) = (lamp_above(None), lamp_above(Some(floats(&[0.0]))));
    let [seen, found] = [&whole, &invisible].map(|scene| irradiance_by_lights(scene, "invisible"));
    assert!(found.mean() > 0.0 && found.mean() == seen.mean());
    assert_eq!(irradiance_by_rays(&invisible, "rays").mean(), 0.0);

    let reference = Reference { p: Point3::ORIGIN, n: None };
    let context = invisible.light_context();
    for light in &invisible.lights {
        assert!(light.is_delta() && !light.is_infinite() && !light.is_environment());
        let sample = light
            .sample_li(&context, &reference, Point2::new(0.3, 0.4), &Wavelengths::sample_visible(0.5))
            .expect("the lamp is above");
        assert!(sample.is_delta && sample.pdf_w > 0.0);
        assert_eq!(light.pdf_li(&context, &reference, sample.wi), 0.0);
    }
    let power = |scene: &Scene| scene.lights[0].power(&scene.light_context()).lumens;
    assert_eq!(power(&whole), power(&invisible));
}
