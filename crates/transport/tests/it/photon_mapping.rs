//! Photon maps against path tracing, against themselves, and on scenes where there is nothing to map.

use std::sync::atomic::{AtomicU64, Ordering};

use etendue_math::statistics::Moments;
use etendue_scene::document::{Entity, Value};
use etendue_scene::{Film, Scene};
use etendue_transport::lpe::PathExpressions;
use etendue_transport::{
    Flow, INTEGRATORS, Integrator, Observer, Outcome, RayCounts, ReportEntry, Stop, Unobserved, method,
    render, with_own_layers,
};

use crate::support::{Setup, flat, layer, lit, luminance, mean, render_layers};

/// A closed room with a lamp in the ceiling, a mirror ball and a glass ball.
fn room() -> String {
    format!(
        "Material \"diffuse\" {}
        Shape \"bilinearmesh\" \"integer indices\" [0 1 2 3  4 5 6 7  2 3 6 7  0 1 4 5  0 2 4 6  1 3 5 7]
        \"point3 P\" [-1 -1 -1  1 -1 -1  -1 -1 1  1 -1 1  -1 1 -1  1 1 -1  -1 1 1  1 1 1]
        AttributeBegin Translate -0.4 -0.6 0.4 Material \"conductor\" Shape \"sphere\" \"float radius\" 0.35 AttributeEnd
        AttributeBegin Translate 0.4 -0.6 0 Material \"dielectric\" Shape \"sphere\" \"float radius\" 0.35 AttributeEnd
        AttributeBegin AreaLightSource \"diffuse\" {} Translate 0 0.99 0.2 Rotate 90 1 0 0
        Shape \"bilinearmesh\" \"point3 P\" [-0.5 -0.5 0  0.5 -0.5 0  -0.5 0.5 0  0.5 0.5 0] AttributeEnd",
        flat("reflectance", 0.5),
        lit("L", 3.0)
    )
}

const CAMERA: &str = "LookAt 0 0 -0.95  0 -0.1 1  0 1 0 Camera \"perspective\" \"float fov\" 75";

fn entity(name: &str, parameters: &[(&'static str, i32)]) -> Entity {
    parameters
        .iter()
        .fold(Entity::new(name), |entity, (name, value)| entity.with(name, Value::Integers(vec![*value])))
}

/// A film after so many passes, and what the method reports.
fn run(scene: &Scene, n_passes: u64) -> (Film, Vec<ReportEntry>) {
    let expressions = with_own_layers(&scene.integrator, PathExpressions::default());
    let mut film = Film::new(scene.film.clone(), expressions.names().to_vec());
    let (integrator, problems) = method(&scene.integrator, expressions);
    assert!(!problems.has_errors());
    let mut integrator = integrator.expect("a method");
    render(scene, integrator.as_mut(), &mut film, &Stop { passes: 0..n_passes, error: None }, &Unobserved);
    assert_eq!(film.sums().faults.invalid, 0, "NaN, infinite or negative radiance");
    (film, integrator.report())
}

fn room_scene(name: &str, integrator: Entity, size: u32) -> Scene {
    let room = room();
    let setup = Setup { size: [size, size], camera: CAMERA, world: &room, ..Setup::default() };
    let mut scene = setup.scene(name);
    scene.integrator = integrator;
    scene
}

const TERMS: [(&str, &str); 4] =
    [("direct", "LD?E"), ("specular", "L(S|D)*SE"), ("caustic", "LS+DE"), ("indirect", "L(S|D)*DS*DE")];

/// PM-3, EXP-11: the four terms are those of the path tracer, one by one, and add up to the image. Bias is below 2 % in the mean
/// with these photons, noise of the path tracer below that.
#[test]
fn four_terms_agree_with_paths() {
    let small = [("globalphotons", 60_000), ("causticphotons", 60_000)];
    let (film, report) = run(&room_scene("terms", entity("photonmap", &small), 24), 24);
    let image = luminance(&film);
    let mut sum = vec![0.0; image.len()];
    for (name, _) in TERMS {
        sum.iter_mut().zip(layer(&film, name)).for_each(|(sum, value)| *sum += value);
    }
    assert!(image.iter().zip(&sum).all(|(a, b)| (a - b).abs() < 1e-4 * a.max(1e-3)), "terms add up");
    let paths = room_scene("paths", entity("path", &[("maxdepth", 64)]), 24);
    let paths = render_layers(&paths, 0..500, &TERMS);
    for (name, _) in TERMS {
        let (ours, theirs) = (layer(&film, name), layer(&paths, name));
        let difference: Moments = ours.iter().zip(&theirs).map(|(a, b)| a - b).collect();
        let whole = mean(&luminance(&paths));
        let tolerance = 0.012 * whole + 5.0 * difference.standard_error();
        assert!(
            difference.mean().abs() < tolerance && tolerance < 0.06 * whole,
            "{name}: {} instead of {} (tolerance {tolerance}) {report:?}",
            mean(&ours),
            mean(&theirs)
        );
    }
}

/// Stops a render as soon as it is asked.
#[derive(Debug, Default)]
struct Impatient(AtomicU64);

impl Observer for Impatient {
    fn tile_done(&self, _: u64, rays: RayCounts) -> Flow {
        self.0.fetch_add(rays.closest, Ordering::Relaxed);
        Flow::Stop
    }

    fn pass_done(&self, _: u64, _: &Film, _: &dyn Integrator) -> Flow {
        Flow::Stop
    }
}

/// Maps of millions of photons are not made to the end when the render is stopped.
#[test]
fn maps_can_be_cancelled() {
    for (name, photons) in [("photonmap", "globalphotons"), ("photons", "photons")] {
        let scene = room_scene("cancelled", entity(name, &[(photons, 20_000_000)]), 8);
        let expressions = with_own_layers(&scene.integrator, PathExpressions::default());
        let mut film = Film::new(scene.film.clone(), expressions.names().to_vec());
        let (integrator, _) = method(&scene.integrator, expressions);
        let observer = Impatient::default();
        let stop = Stop { passes: 0..1, error: None };
        let mut integrator = integrator.expect("a method");
        let outcome = render(&scene, integrator.as_mut(), &mut film, &stop, &observer);
        assert_eq!(outcome, Outcome::Stopped);
        assert!(observer.0.load(Ordering::Relaxed) < 1_000_000, "{observer:?}");
    }
}

/// Mean luminance of an image and of its indirect term.
fn means(scene: &Scene, n_passes: u64) -> [f64; 2] {
    let (film, _) = run(scene, n_passes);
    [mean(&luminance(&film)), mean(&layer(&film, "indirect"))]
}

/// Irradiance that was computed before changes nothing in the mean: neither where a radius holds so few photons that there is often
/// no place within it, nor where shading normals differ from geometric ones.
#[test]
fn precomputed_irradiance_is_that_of_the_map() {
    let bent = room().replace("\"point3 P\" [-1 -1 -1", "\"normal N\" [1 1 1  -1 1 1  1 1 -1  -1 1 -1  1 -1 1  -1 -1 1  1 -1 -1  -1 -1 -1]\n\"point3 P\" [-1 -1 -1");
    assert!(bent.contains("normal N"));
    // Three photons of 20 000 on 26 square metres lie within 35 mm. An estimate at a photon holds that one, too, and so is
    // too bright by a third; without it half of the places would be dark.
    for (name, world, radius, tolerance) in
        [("sparse", room(), Some(0.035), 0.15), ("bent", bent, None, 0.02)]
    {
        let setup = Setup { size: [24, 24], camera: CAMERA, world: &world, ..Setup::default() };
        let mut found = [0, 4].map(|step| {
            let small = [("globalphotons", 20_000), ("causticphotons", 1000), ("precompute", step)];
            let mut scene = setup.scene(name);
            scene.integrator = entity("photonmap", &small);
            if let Some(radius) = radius {
                scene.integrator = scene.integrator.with("globalradius", Value::Floats(vec![radius]));
            }
            means(&scene, 16)[1]
        });
        found[1] /= found[0];
        assert!((found[1] - 1.0).abs() < tolerance, "{name}: {} of the map's", found[1]);
    }
}

/// PM-6: what makes up a small share of its pixel in a mirror is asked of the map, with the same mean; nothing else changes.
#[test]
fn small_shares_ask_the_map() {
    let film = |share: f32| {
        let small = entity("photonmap", &[("globalphotons", 60_000), ("causticphotons", 60_000)]);
        run(&room_scene("shares", small.with("accurateshare", Value::Floats(vec![share])), 24), 16).0
    };
    let films = [film(0.0), film(1.0)];
    for term in ["direct", "caustic", "indirect"] {
        assert!(layer(&films[0], term) == layer(&films[1], term), "{term}");
    }
    let [accurate, approximate] = films.each_ref().map(|film| mean(&layer(film, "specular")));
    assert!(accurate != approximate);
    assert!((approximate / accurate - 1.0).abs() < 0.1, "{approximate} instead of {accurate}");
}

/// A coat is as sharp or as wide as the metal below it for photons and for rays that ask them, though its samples are not: no
/// light is lost or counted twice.
#[test]
fn coated_metals_agree_with_paths() {
    for (coat, base) in [(0.05, 0.3), (0.12, 0.02)] {
        let metal = format!(
            "Material \"coatedconductor\" \"bool remaproughness\" false \"float interface.roughness\" {coat} \"float conductor.roughness\" {base}"
        );
        let world = room().replace("Material \"dielectric\"", &metal);
        let setup = Setup { size: [24, 24], camera: CAMERA, world: &world, ..Setup::default() };
        let mut scene = setup.scene("coated");
        scene.integrator = entity("photonmap", &[("globalphotons", 60_000), ("causticphotons", 60_000)]);
        let (film, _) = run(&scene, 48);
        let mut scene = setup.scene("coated paths");
        scene.integrator = entity("path", &[("maxdepth", 64)]);
        let paths = render_layers(&scene, 0..800, &[]);
        let (ours, theirs) = (luminance(&film), luminance(&paths));
        let difference: Moments = ours.iter().zip(&theirs).map(|(a, b)| a - b).collect();
        let expected = mean(&theirs);
        let tolerance = 0.01 * expected + 3.0 * difference.standard_error();
        assert!(difference.mean().abs() < tolerance, "{coat} {base}: {} instead of {expected}", mean(&ours));
    }
}

/// EMI-10: a table with a rough coat casts no caustics, so that photons of a large light are aimed at the small ball above it: most
/// of those that are sent arrive.
#[test]
fn rough_coats_are_no_targets() {
    let world = "LightSource \"infinite\"
        Material \"coateddiffuse\" \"float roughness\" 0.2
        Shape \"bilinearmesh\" \"point3 P\" [-3 -1 -3  3 -1 -3  -3 -1 3  3 -1 3]
        AttributeBegin Translate 0 -0.7 0 Material \"dielectric\" Shape \"sphere\" \"float radius\" 0.2 AttributeEnd";
    let setup = Setup { size: [8, 8], camera: CAMERA, world, ..Setup::default() };
    let mut scene = setup.scene("table");
    scene.integrator = entity("photonmap", &[("globalphotons", 1000), ("causticphotons", 5000)]);
    let (_, report) = run(&scene, 1);
    let figure = |name: &str| report.iter().find(|entry| entry.name == name).map_or(0.0, |entry| entry.value);
    let (emitted, stored) = (figure("caustic_photons_emitted"), figure("caustic_photons_stored"));
    assert!(stored >= 5000.0 && emitted < 8.0 * stored, "{stored} of {emitted}");
}

/// One seed gives one image, whatever the number of threads.
#[test]
fn threads_do_not_matter() {
    let image = |n: usize| {
        let pool = rayon_pool(n);
        pool.install(|| {
            let small = [("globalphotons", 20_000), ("causticphotons", 20_000), ("gatherrays", 2)];
            let (film, report) = run(&room_scene("threads", entity("photonmap", &small), 40), 1);
            (film.develop().channels.iter().map(|c| c.values.clone()).collect::<Vec<_>>(), report)
        })
    };
    assert!(image(1) == image(2));
}

fn rayon_pool(n: usize) -> rayon::ThreadPool {
    rayon::ThreadPoolBuilder::new().num_threads(n).build().expect("threads start")
}

/// Nothing, darkness, a lamp that shines away, one photon, more photons asked for than there are: an image without faults, and
/// a word where the maps are empty.
#[test]
fn maps_may_be_empty() {
    let floor = "Shape \"bilinearmesh\" \"point3 P\" [-1 -1 2  1 -1 2  -1 1 2  1 1 2]";
    let black = format!("LightSource \"point\" \"rgb I\" [0 0 0] {floor}");
    let away = format!(
        "LightSource \"spot\" \"point3 from\" [0 0 9] \"point3 to\" [0 0 99] \"spectrum I\" [360 1 830 1] {floor}"
    );
    let lit = format!("LightSource \"point\" \"spectrum I\" [360 1 830 1] {floor}");
    for method in ["photonmap", "photons"] {
        for (name, world, is_empty) in
            [("nothing", "", true), ("black", &black, true), ("away", &away, true), ("lit", &lit, false)]
        {
            for photons in [0, 1, 10] {
                let mut scene = Setup { world, ..Setup::default() }.scene(name);
                let parameters = if method == "photonmap" {
                    [("globalphotons", photons), ("causticphotons", photons)]
                } else {
                    [("photons", photons), ("nearest", 5000)]
                };
                scene.integrator = entity(method, &parameters);
                let (film, report) = run(&scene, 2);
                let stored =
                    report.iter().find(|entry| entry.name == "photons_stored").map_or(0.0, |e| e.value);
                assert_eq!(stored > 0.0, !is_empty && photons > 0, "{method} {name} {photons}");
                if is_empty {
                    assert!(report.iter().any(|entry| entry.advice.is_some()), "{method} {name}: no word");
                }
                let image = luminance(&film);
                assert_eq!(
                    image.iter().any(|value| *value > 0.0),
                    !is_empty && (method == "photonmap" || photons > 0),
                    "{method} {name} {photons}"
                );
            }
        }
    }
}

/// Photons that all lie at one point, as those of a narrow beam far from the origin do, are an image without faults.
#[test]
fn all_photons_at_one_point() {
    let world = format!(
        "LightSource \"spot\" \"point3 from\" [50000 50000 999.9] \"point3 to\" [50000 50000 1000] \"float coneangle\" 0.2
        \"float conedeltaangle\" 0.01 {} Material \"diffuse\" {} Shape \"bilinearmesh\"
        \"point3 P\" [49990 49990 1000  50010 49990 1000  49990 50010 1000  50010 50010 1000]",
        lit("I", 1.0),
        flat("reflectance", 0.5)
    );
    let camera = "LookAt 50000 50000 990  50000 50000 1000  0 1 0 Camera \"perspective\" \"float fov\" 20";
    for (name, count) in
        [("photonmap", "globalphotons"), ("photons", "photons"), ("sppm", "photonsperiteration")]
    {
        let mut scene = Setup { camera, world: &world, ..Setup::default() }.scene(name);
        scene.integrator = entity(name, &[(count, 5000)]);
        // Refuses NaN and infinite values. What is seen may be dark: the nearest of the photons are all of no area.
        run(&scene, 2);
    }
}

/// A point light within a ball of glass lights the room by its caustic alone, and all of its flux arrives: the wall of a closed
/// sphere of radius R and reflectance a around it shows `a Phi / (4 pi R^2) / pi / (1 - a)` everywhere. Total reflection cannot
/// happen: the light is at the middle.
#[test]
fn a_light_within_glass_is_all_caustic() {
    let albedo = 0.5;
    let world = format!(
        "LightSource \"point\" {}
        AttributeBegin Material \"dielectric\" \"float eta\" 1.5 Shape \"sphere\" \"float radius\" 0.5 AttributeEnd
        Material \"diffuse\" {} Shape \"sphere\" \"float radius\" 4",
        lit("I", 1.0),
        flat("reflectance", albedo)
    );
    let camera = "LookAt 0 0 -2  1 0 -3  0 1 0 Camera \"perspective\" \"float fov\" 50";
    let setup = Setup { size: [16, 16], camera, world: &world, ..Setup::default() };
    // 4 pi I / (4 pi R^2), of which the wall sends a/pi on, again and again; the glass absorbs nothing.
    let irradiance = 1.0 / 16.0;
    let caustic = albedo / std::f64::consts::PI * irradiance;
    for name in ["photonmap", "photons", "sppm"] {
        let mut scene = setup.scene(name);
        let (settings, n_passes): (&[_], _) = match name {
            "photonmap" => (&[("globalphotons", 50_000), ("causticphotons", 50_000)], 32),
            "photons" => (&[("photons", 100_000)], 32),
            // Paths of 5 events would lose one in 16 of what the wall sends to itself, and more in the glass.
            _ => (&[("photonsperiteration", 100_000), ("maxdepth", 30)], 4),
        };
        scene.integrator = entity(name, settings);
        let (film, _) = run(&scene, n_passes);
        let found = mean(&luminance(&film));
        let expected = caustic / (1.0 - albedo);
        assert!((found / expected - 1.0).abs() < 0.03, "{name}: {found} instead of {expected}");
        if name == "photonmap" {
            assert!(mean(&layer(&film, "direct")) == 0.0);
            let found = mean(&layer(&film, "caustic"));
            assert!((found / caustic - 1.0).abs() < 0.03, "{found} instead of {caustic}");
        }
    }
}

/// A floor and a wall of 4 m by 4 m, a kilometre below a lamp that sends a millionth of its light there: nothing is lost. Bias by
/// the rims of what is seen and by the corner is below 3 %.
#[test]
fn light_from_afar_is_not_lost() {
    let world = format!(
        "LightSource \"point\" \"point3 from\" [0 1000 -300] {} Material \"diffuse\" {}
        Shape \"bilinearmesh\" \"point3 P\" [-2 0 -2  2 0 -2  -2 0 2  2 0 2]
        Shape \"bilinearmesh\" \"point3 P\" [-2 0 2  2 0 2  -2 4 2  2 4 2]",
        lit("I", 1e6),
        flat("reflectance", 0.5)
    );
    let camera = "LookAt 0 1 -3  0 0.5 0  0 1 0 Camera \"perspective\" \"float fov\" 45";
    let scene = |integrator| {
        let mut scene = Setup { size: [16, 16], camera, world: &world, ..Setup::default() }.scene("afar");
        scene.integrator = integrator;
        scene
    };
    let paths = luminance(&run(&scene(entity("path", &[("maxdepth", 20)])), 256).0);
    let methods = [
        entity("photonmap", &[("globalphotons", 50_000)]),
        entity("photons", &[("photons", 100_000), ("nearest", 50)]),
        entity("sppm", &[("maxdepth", 20)]),
    ];
    for method in methods {
        let (film, report) = run(&scene(method.clone()), 16);
        let difference: Moments = luminance(&film).iter().zip(&paths).map(|(a, b)| a - b).collect();
        let tolerance = 0.03 * mean(&paths) + 5.0 * difference.standard_error();
        assert!(
            difference.mean().abs() < tolerance && tolerance < 0.06 * mean(&paths),
            "{}: {} instead of {} (tolerance {tolerance}) {report:?}",
            method.type_name,
            mean(&luminance(&film)),
            mean(&paths)
        );
    }
}

/// The words to the user.
fn advice(scene: &Scene) -> Vec<String> {
    run(scene, 1).1.into_iter().filter_map(|entry| entry.advice).collect()
}

/// Each cause has its own word, and where nothing is wrong there is none.
#[test]
fn advice_names_the_cause() {
    let floor = "Shape \"bilinearmesh\" \"point3 P\" [-1 -1 2  1 -1 2  -1 1 2  1 1 2]";
    let lamp = |power: f64| format!("LightSource \"point\" {} ", lit("I", power));
    let [lit_floor, unlit, none] = [lamp(1.0) + floor, lamp(0.0) + floor, floor.to_owned()];
    let away = format!(
        "LightSource \"spot\" \"point3 from\" [0 0 9] \"point3 to\" [0 0 99] {} {floor}",
        lit("I", 1.0)
    );
    let elsewhere = format!(
        "LightSource \"spot\" \"point3 from\" [20 0 0] \"point3 to\" [20 0 2] \"float coneangle\" 20 {} {floor}
        Translate 20 0 0 {floor}",
        lit("I", 1.0)
    );
    let wide =
        entity("photons", &[("photons", 20_000), ("nearest", 50)]).with("radius", Value::Floats(vec![100.0]));
    let mirror = format!("{} Material \"conductor\" {floor}", lamp(1.0));
    let room = room();
    let float = |name: &str, parameter: &str, value: f32| {
        Entity::new(name).with(parameter, Value::Floats(vec![value]))
    };
    let show = |what: &str| Entity::new("photons").with("show", Value::Strings(vec![what.to_owned()]));
    let few = |entity: Entity| entity.with("globalphotons", Value::Integers(vec![20_000]));
    let cases = [
        (&unlit, entity("photonmap", &[]), "no light sends photons"),
        (&none, entity("photons", &[]), "no light sends photons"),
        (&none, entity("sppm", &[]), "no light sends photons"),
        (&unlit, entity("ppm", &[]), "no light sends photons"),
        (&away, entity("photonmap", &[]), "shine past the scene"),
        (&away, entity("photons", &[]), "shine past the scene"),
        (&away, entity("sppm", &[]), "shine past the scene"),
        (&lit_floor, entity("photonmap", &[("globalphotons", 0)]), "\"globalphotons\" is 0: indirect"),
        (&lit_floor, float("photonmap", "photonmemory", 0.0), "\"photonmemory\" holds no photons"),
        (&lit_floor, entity("photons", &[("photons", 0)]), "\"photons\" is 0"),
        (&lit_floor, show("caustics"), "there are no caustics"),
        // Nothing is missing.
        (&mirror, entity("photonmap", &[]), ""),
        (&mirror, entity("photons", &[]), ""),
        (&lit_floor, entity("photonmap", &[]), ""),
        (&lit_floor, show("shadowrays"), ""),
        (&lit_floor, entity("sppm", &[]), ""),
        // Radii that are given, and those that are not.
        (&lit_floor, float("sppm", "radius", 1e-20), ""),
        (&room, float("sppm", "radius", 1e-20), "within \"radius\""),
        (&room, float("sppm", "radius", 1e-25), "within \"radius\""),
        (&room, few(float("photonmap", "globalradius", 1e-3)), "or a larger \"globalradius\""),
        (&room, few(float("photonmap", "causticradius", 1e-4)), "within \"causticradius\""),
        (&elsewhere, wide, "few are where the camera looks"),
        (&room, few(entity("photonmap", &[])), ""),
        (&room, entity("photons", &[("photons", 20_000)]), ""),
    ];
    for (world, integrator, expected) in cases {
        let mut scene = Setup { camera: CAMERA, world, ..Setup::default() }.scene("advice");
        let is_progressive = integrator.type_name.ends_with("ppm");
        let photons = Value::Integers(vec![20_000]);
        scene.integrator =
            if is_progressive { integrator.with("photonsperiteration", photons) } else { integrator };
        let said = advice(&scene);
        let n_expected = usize::from(!expected.is_empty());
        assert!(
            said.len() == n_expected && said.iter().all(|word| word.contains(expected)),
            "{:?} expects {expected:?}: {said:?}",
            scene.integrator
        );
    }
}

/// Where emission ends long before as many photons were stored as were wanted, a word is said.
#[test]
fn few_photons_of_many_wanted() {
    // A lamp in a ball of mirrors but for a speck, which keeps one photon in thousands.
    let world = format!(
        "LightSource \"point\" {} AttributeBegin ReverseOrientation Material \"conductor\" \"spectrum reflectance\" [360 0.1 830 0.1]
        Shape \"sphere\" \"float radius\" 3 AttributeEnd
        Material \"diffuse\" Shape \"bilinearmesh\" \"point3 P\" [-0.04 -0.04 2  0.04 -0.04 2  -0.04 0.04 2  0.04 0.04 2]",
        lit("I", 1.0)
    );
    let mut scene = Setup { world: &world, ..Setup::default() }.scene("few");
    for (method, parameter) in [("photonmap", "globalphotons"), ("photons", "photons")] {
        scene.integrator = entity(method, &[(parameter, 10_000)]);
        let said = advice(&scene);
        assert!(said.len() == 1 && said[0].contains("of the 10000 photons wanted"), "{said:?}");
    }
}

/// Numbers that leave nothing to be seen, or that mean nothing, are reported where they stand.
#[test]
fn senseless_numbers_are_reported() {
    let warns = |entity: Entity, text: &str| {
        let (_, problems) = method(&entity, PathExpressions::default());
        let said: Vec<&str> = problems.list().iter().map(|problem| problem.message.as_str()).collect();
        assert!(
            !problems.has_errors() && said.iter().any(|said| said.contains(text)),
            "{entity:?}: {said:?}"
        );
    };
    warns(entity("photonmap", &[("minphotons", 60)]), "indirect light is left out");
    warns(entity("photonmap", &[("minphotons", 100)]), "caustics are left out");
    warns(entity("photons", &[("minphotons", 60), ("nearest", 50)]), "\"nearest\" 50");
    for name in ["photonmap", "photons", "sppm", "ppm", "light", "path", "whitted"] {
        for (value, taken) in [(-1.0, "0 is taken"), (1.5, "1 is taken")] {
            warns(Entity::new(name).with("sharpalpha", Value::Floats(vec![value])), taken);
        }
    }
    warns(Entity::new("sppm").with("receiveralpha", Value::Floats(vec![-1.0])), "0 is taken");
}

/// LPE-4: layers by path expression are filled from the trails of photons, and agree with the terms.
#[test]
fn expressions_follow_trails() {
    let layers =
        [("all", "L(S|D)*E"), ("c", "LS+DE"), ("i", "L(S|D)*DS*DE"), ("s", "L(S|D)*SE"), ("d", "LD?E")];
    let named: Vec<(String, String)> =
        layers.iter().map(|(n, e)| ((*n).to_owned(), (*e).to_owned())).collect();
    for method_name in ["photonmap", "photons"] {
        let small: &[_] = if method_name == "photonmap" {
            &[("globalphotons", 20_000), ("causticphotons", 20_000)]
        } else {
            &[("photons", 20_000)]
        };
        let scene = room_scene("trails", entity(method_name, small), 16);
        let expressions = with_own_layers(&scene.integrator, PathExpressions::new(&named).expect("good"));
        let mut film = Film::new(scene.film.clone(), expressions.names().to_vec());
        let (integrator, _) = method(&scene.integrator, expressions);
        let stop = Stop { passes: 0..8, error: None };
        render(&scene, integrator.expect("a method").as_mut(), &mut film, &stop, &Unobserved);
        let image = mean(&luminance(&film));
        let of = |name: &str| mean(&layer(&film, name));
        assert!((of("all") / image - 1.0).abs() < 0.02, "{method_name}: {} of {image}", of("all"));
        let sum = of("c") + of("i") + of("s") + of("d");
        assert!((sum / of("all") - 1.0).abs() < 1e-3, "{method_name}: {sum} of {}", of("all"));
        if method_name == "photonmap" {
            for (a, b) in [("c", "caustic"), ("i", "indirect"), ("s", "specular"), ("d", "direct")] {
                assert!((of(a) - of(b)).abs() < 0.02 * image, "{a}: {} and {}", of(a), of(b));
            }
        }
    }
}

/// What the tables of the methods with photons say can be said in scene files, by a value of the type that they state; what they
/// do not say is noticed (PM-12).
#[test]
fn parameters_of_the_tables_are_known() {
    for name in ["photonmap", "photons", "sppm", "ppm", "light"] {
        let spec = INTEGRATORS.iter().find(|spec| spec.name == name).expect("a method");
        let problems = |entity: &Entity| method(entity, PathExpressions::default()).1;
        let mut all = Entity::new(name);
        for parameter in spec.parameters {
            let default = parameter.default;
            let value = match parameter.kind {
                "integer" => Value::Integers(vec![default.parse().unwrap_or(1)]),
                "float" => Value::Floats(vec![default.parse().unwrap_or(1.0)]),
                "bool" => Value::Bools(vec![default != "true"]),
                "string" => Value::Strings(vec![default.to_owned()]),
                other => panic!("{name}: {} is of type {other}", parameter.name),
            };
            let one = Entity::new(name).with(parameter.name, value.clone());
            let found = problems(&one);
            assert!(found.list().is_empty(), "{name}: {}: {:?}", parameter.name, found.list());
            all = all.with(parameter.name, value);
        }
        let found = problems(&all.with("foreign", Value::Integers(vec![1])));
        assert_eq!(found.list().len(), 1, "{name}: {:?}", found.list());
        assert!(found.list()[0].message.contains("foreign"), "{name}: {:?}", found.list());
    }
}
