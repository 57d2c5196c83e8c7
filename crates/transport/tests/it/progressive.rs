//! Progressive photon mapping against closed forms, against the path tracer and against itself (SPEC PROG-1, PROG-2).

use etendue_math::statistics::{Moments, mean_test, sidak};
use etendue_math::{SamplerKind, hash64};
use etendue_scene::document::{Entity, Value};
use etendue_scene::{Film, Scene};
use etendue_transport::lpe::PathExpressions;
use etendue_transport::{Passes, Stop, Unobserved, method, render};

use crate::controls;
use crate::scenes;
use crate::support::{
    Setup, block_means, block_moments, channel, expect_equal_pixels, expect_near, expect_same_image, flat,
    layer, lit, luminance, mean, render_layers, render_passes, runs_slow, seed,
};

/// Looks straight down at a square of 20 cm of the plane z = 0.
const DOWN: &str =
    "LookAt 0 0 0.9  0 0 0  0 1 0 Camera \"orthographic\" \"float screenwindow\" [-0.1 0.1 -0.1 0.1]";

fn level(z: f64, half: f64) -> String {
    format!(
        "Shape \"bilinearmesh\" \"point3 P\" [-{half} -{half} {z}  {half} -{half} {z}  -{half} {half} {z}  {half} {half} {z}]"
    )
}

/// The method in place of the scene's.
fn by(mut scene: Scene, name: &str, parameters: &[(&str, Value)]) -> Scene {
    let entity = Entity::new(name);
    scene.integrator =
        parameters.iter().fold(entity, |entity, (name, value)| entity.with(name, value.clone()));
    scene
}

fn integer(value: i32) -> Value {
    Value::Integers(vec![value])
}

fn float(value: f64) -> Value {
    Value::Floats(vec![value as f32])
}

fn word(value: &str) -> Value {
    Value::Strings(vec![value.to_owned()])
}

/// A lamp of luminous intensity 1 that is 10 m above a floor, behind a pane: no path from the camera finds it.
fn under_a_pane(reflectance: &str, name: &str) -> Scene {
    let pane = format!("Material \"thindielectric\" \"float eta\" 1.5 {}", level(1.0, 0.6));
    under_the_lamp(reflectance, &pane, name)
}

/// That lamp and floor, and what there is besides.
fn under_the_lamp(reflectance: &str, others: &str, name: &str) -> Scene {
    let world = format!(
        "LightSource \"spot\" {} \"point3 from\" [0 0 10] \"point3 to\" [0 0 0] \"float coneangle\" 5
        \"float conedeltaangle\" 1 Material \"diffuse\" {reflectance} {}
        {others}",
        lit("I", 1.0),
        level(0.0, 0.5),
    );
    Setup { size: [16, 16], camera: DOWN, world: &world, ..Setup::default() }.scene(name)
}

/// What of the lamp's light gets through the pane, falls on a floor of that reflectance and goes up.
fn through_the_pane(reflectance: f64) -> f64 {
    let r = 0.04;
    let through = 1.0 - 2.0 * r / (1.0 + r);
    reflectance / std::f64::consts::PI * through / 100.0
}

/// PROG-1, PROG-2: light that comes through glass to a diffuse surface, by both methods and both ways to shrink the radius.
#[test]
fn light_through_a_pane_arrives() {
    for name in ["sppm", "ppm"] {
        for update in ["schedule", "perpixel"] {
            let parameters = [
                ("radiusupdate", word(update)),
                ("radius", float(0.05)),
                ("photonsperiteration", integer(200_000)),
            ];
            let scene = by(under_a_pane(&flat("reflectance", 0.5), name), name, &parameters);
            let film = render_passes(&scene, 0..8);
            // About one in 40 falls on what is seen: 40,000, whose number has a deviation of 0.5 %.
            let image = mean(&luminance(&film));
            expect_near(&format!("{name} {update}"), image, through_the_pane(0.5), 0.03);
        }
    }
}

/// Wavelengths of few passes do not tint: after 8 passes each channel of a coloured floor, over that of a grey one, is what
/// path tracing tells of the same floors without the pane.
#[test]
fn few_passes_do_not_tint() {
    let (grey, red) = (flat("reflectance", 0.5), "\"rgb reflectance\" [0.6 0.3 0.1]");
    let ratios = |scene: &dyn Fn(&str) -> Scene, n| {
        let (grey, red) =
            (render_passes(&scene(&grey), 0..n).develop(), render_passes(&scene(red), 0..n).develop());
        ["R", "G", "B"].map(|name| mean(&channel(&red, name)) / mean(&channel(&grey, name)))
    };
    // Of a group's photons 1000 fall on what is seen, so that its weight has a deviation of 3 %. Of the 32 groups at least 8
    // have to do with a channel; where reflectance varies by a third among them, the ratio has one of 0.4 %.
    let photons = [("radius", float(0.05)), ("photonsperiteration", integer(160_000))];
    let found = ratios(&|floor| by(under_a_pane(floor, "tint"), "sppm", &photons), 8);
    let expected = ratios(&|floor| by(under_the_lamp(floor, "", "tint"), "path", &[]), 64);
    for (channel, (found, expected)) in ["R", "G", "B"].iter().zip(found.iter().zip(expected)) {
        expect_near(channel, *found, expected, 0.015);
    }
}

/// Mirrors, glass, coats, rough metal, a clear liquid, and a lamp that all methods find.
fn still_life(name: &str, size: [u32; 2], camera: &str) -> Scene {
    let world = format!(
        "AttributeBegin Material \"diffuse\" {black} AreaLightSource \"diffuse\" {lamp}
        Translate 0 1.9 0 Rotate 90 1 0 0 Shape \"disk\" \"float radius\" 0.6 AttributeEnd
        Material \"diffuse\" \"rgb reflectance\" [0.7 0.6 0.5]
        Shape \"bilinearmesh\" \"point3 P\" [-1 -1 -1  1 -1 -1  -1 -1 1  1 -1 1]
        Shape \"bilinearmesh\" \"point3 P\" [-1 -1 1  1 -1 1  -1 2 1  1 2 1]
        Material \"coateddiffuse\" \"float roughness\" 0 \"rgb reflectance\" [0.2 0.5 0.3]
        Shape \"bilinearmesh\" \"point3 P\" [-1 -1 -1  -1 -1 1  -1 2 -1  -1 2 1]
        Material \"coateddiffuse\" \"float roughness\" 0.1 \"rgb reflectance\" [0.2 0.3 0.5]
        Shape \"bilinearmesh\" \"point3 P\" [1 -1 -1  1 -1 1  1 2 -1  1 2 1]
        AttributeBegin Translate -0.45 -0.6 0.2 Material \"conductor\" \"float roughness\" 0.3
        Shape \"sphere\" \"float radius\" 0.35 AttributeEnd
        AttributeBegin Translate 0.45 -0.6 -0.1 Material \"dielectric\" \"spectrum eta\" \"glass-SF11\"
        Shape \"sphere\" \"float radius\" 0.35 AttributeEnd
        AttributeBegin Translate 0 0.3 0.5 Material \"conductor\" Shape \"sphere\" \"float radius\" 0.3 AttributeEnd",
        black = flat("reflectance", 0.0),
        lamp = lit("L", 10.0),
    );
    Setup { size, sampler: "\"sobol\"", camera, world: &world, ..Setup::default() }.scene(name)
}

const FRONT: &str = "LookAt 0 0 -4  0 0 0  0 1 0 Camera \"perspective\" \"float fov\" 42";

/// All kinds of paths agree with the path tracer, block by block, also with the depth limit.
#[test]
fn the_still_life_is_that_of_the_path_tracer() {
    if !runs_slow("the_still_life_is_that_of_the_path_tracer") {
        return;
    }
    let scene = still_life("still life", [32, 32], FRONT);
    let depth = ("maxdepth", integer(7));
    let path = block_moments(&by(scene, "path", std::slice::from_ref(&depth)), 64, 4);
    let scene = still_life("still life", [32, 32], FRONT);
    let small = [depth, ("radius", float(0.04)), ("photonsperiteration", integer(16_000))];
    let sppm = block_moments(&by(scene, "sppm", &small), 40, 4);
    expect_same_image("still life", &sppm, &path, 0.05);
}

fn in_threads(n: usize, work: impl FnOnce() -> Film + Send) -> Film {
    rayon::ThreadPoolBuilder::new().num_threads(n).build().expect("threads").install(work)
}

/// One seed gives one image for any number of threads, and any split of passes that are independent.
#[test]
fn threads_and_splits_change_nothing() {
    for update in ["schedule", "perpixel"] {
        let scene = still_life("threads", [70, 40], FRONT);
        let parameters = [("photonsperiteration", integer(10_000)), ("radiusupdate", word(update))];
        let scene = by(scene, "sppm", &parameters);
        let layers = [("caustic", "LS+DE"), ("indirect", "L(S|D)*D(S|D)*E")];
        let alone = in_threads(1, || render_layers(&scene, 0..3, &layers));
        let together = in_threads(2, || render_layers(&scene, 0..3, &layers));
        assert_eq!(together.sums(), alone.sums(), "{update}");
        if update == "schedule" {
            let mut parts = in_threads(2, || render_layers(&scene, 2..3, &layers)).sums().clone();
            parts.merge(render_layers(&scene, 0..2, &layers).sums()).expect("different passes");
            assert_eq!(&parts, alone.sums());
        }
    }
}

/// What pixels remember survives a checkpoint: two passes and two more are four.
#[test]
fn saved_state_goes_on() {
    for name in ["sppm", "ppm"] {
        let scene = by(
            still_life("state", [16, 16], FRONT),
            name,
            &[("radiusupdate", word("perpixel")), ("photonsperiteration", integer(4000))],
        );
        let start = || method(&scene.integrator, PathExpressions::default()).0.expect("a method");
        let mut film = Film::new(scene.film.clone(), Vec::new());
        let run = |integrator: &mut dyn etendue_transport::Integrator, film: &mut Film, passes| {
            render(&scene, integrator, film, &Stop { passes, error: None }, &Unobserved);
        };
        let mut first = start();
        assert_eq!(first.passes(), Passes::Sequential);
        assert!(first.save().is_empty());
        run(first.as_mut(), &mut film, 0..2);
        let state = first.save();
        let mut second = start();
        second.load(&state).expect("its own state");
        run(second.as_mut(), &mut film, 2..4);
        assert_eq!(film.sums(), render_passes(&scene, 0..4).sums(), "{name}");
        for broken in [&state[..state.len() - 3], &state[1..], b"sppm\0\0\0\x01\xff\xff\xff\xff\0\0\0\0"] {
            start().load(broken).expect_err("no state of this method");
        }
    }
}

/// The layer of all paths is the image, also where a camera path meets glass that disperses after a coat that received photons
/// which had come through such glass.
#[test]
fn the_layer_of_all_paths_is_the_image() {
    let world = format!(
        "AttributeBegin AreaLightSource \"diffuse\" {} Translate 0 1.9 0 Rotate 90 1 0 0 Shape \"disk\" \"float radius\" 0.6 AttributeEnd
        Material \"coateddiffuse\" \"float roughness\" 0 \"rgb reflectance\" [0.7 0.6 0.5]
        Shape \"bilinearmesh\" \"point3 P\" [-1 -1 -1  1 -1 -1  -1 -1 1  1 -1 1]
        Translate 0 -0.3 0 Material \"dielectric\" \"spectrum eta\" \"glass-SF11\" Shape \"sphere\" \"float radius\" 0.5",
        lit("L", 10.0)
    );
    let scene = Setup { size: [32, 32], camera: FRONT, world: &world, ..Setup::default() }.scene("all");
    let scene = by(scene, "sppm", &[("photonsperiteration", integer(20_000))]);
    let film = render_layers(&scene, 0..2, &[("all", "L(S|D)*E"), ("caustic", "LS+DS*E")]);
    expect_equal_pixels("all", &layer(&film, "all"), &luminance(&film), 1e-4);
    assert!(mean(&layer(&film, "caustic")) > 0.0, "there are dispersed photons");
}

/// Disjoint layers add up to the image, and each is that of the path tracer.
#[test]
fn layers_are_those_of_the_path_tracer() {
    if !runs_slow("layers_are_those_of_the_path_tracer") {
        return;
    }
    let layers = [
        ("seen", "L(S|D)?E"),
        ("caustic", "LS+DE"),
        ("rest", "L(S|D)*(D(S|D)+|SS)E"),
        ("all", "L(S|D)*E"),
        ("deep", "LDD+S*E"),
    ];
    let render = |name: &str, n: u64, parameters: &[(&str, Value)]| {
        let scene = by(still_life("layers", [16, 16], FRONT), name, parameters);
        render_layers(&scene, 0..n, &layers)
    };
    let small = [("photonsperiteration", integer(20_000)), ("radius", float(0.05))];
    let (sppm, path) = (render("sppm", 16, &small), render("path", 1024, &[]));
    expect_equal_pixels("all", &layer(&sppm, "all"), &luminance(&sppm), 1e-4);
    for (name, tolerance) in [("seen", 0.02), ("caustic", 0.3), ("deep", 0.05)] {
        expect_near(name, mean(&layer(&sppm, name)), mean(&layer(&path, name)), tolerance);
    }
}

/// A lens, motion, surroundings, surfaces that let light pass, a clear coloured liquid, glass that disperses: the mean
/// over the image is that of the path tracer.
#[test]
fn whole_scenes_are_those_of_the_path_tracer() {
    if !runs_slow("whole_scenes_are_those_of_the_path_tracer") {
        return;
    }
    let floor = "Material \"diffuse\" \"rgb reflectance\" [0.8 0.7 0.6] Shape \"bilinearmesh\" \"point3 P\" [-1 -1 -1  1 -1 -1  -1 -1 1  1 -1 1]";
    let lamp = format!(
        "AttributeBegin AreaLightSource \"diffuse\" {} Translate 0 2 0 Rotate 90 1 0 0 Shape \"disk\" \"float radius\" 0.8 AttributeEnd",
        lit("L", 5.0)
    );
    let sky = format!("LightSource \"infinite\" {}", lit("L", 0.5));
    let ball = "Material \"diffuse\" \"rgb reflectance\" [0.5 0.7 0.4] Shape \"sphere\" \"float radius\" 0.4";
    let moving = format!(
        "{lamp} {floor} AttributeBegin ActiveTransform EndTime Translate 0.8 0.3 0 ActiveTransform All {ball} AttributeEnd"
    );
    let alpha = format!("{lamp} {floor} {ball} \"float alpha\" 0.5");
    let liquid = format!(
        "{lamp} {floor} AttributeBegin Translate 0 -0.5 0 Material \"dielectric\" \"float eta\" 1.33 \"spectrum absorption\" [360 0.2 830 1.5]
        Shape \"sphere\" \"float radius\" 0.45 AttributeEnd"
    );
    let dispersion = format!(
        "{lamp} {floor} Material \"dielectric\" \"spectrum eta\" \"glass-SF11\" Translate 0 -0.5 0 Shape \"sphere\" \"float radius\" 0.4"
    );
    let lens = "LookAt 0 0 -4  0 0 0  0 1 0 Camera \"perspective\" \"float fov\" 42 \"float lensradius\" 0.2 \"float focaldistance\" 3";
    let scenes = [
        ("lens", lens, format!("{lamp} {floor} {ball}"), 64),
        ("sky", FRONT, format!("{sky} {floor} {ball}"), 64),
        ("motion", FRONT, moving, 64),
        ("alpha", FRONT, alpha, 64),
        // Path tracing finds the caustic only by running into the lamp.
        ("liquid", FRONT, liquid, 1024),
        ("dispersion", FRONT, dispersion, 1024),
    ];
    for (name, camera, world, n_path) in scenes {
        let scene = || {
            Setup { size: [16, 16], sampler: "\"sobol\"", camera, world: &world, ..Setup::default() }
                .scene(name)
        };
        let blocks = |method: &str, n, parameters: &[(&str, Value)]| {
            block_moments(&by(scene(), method, parameters), n, 2)
        };
        let small = [("photonsperiteration", integer(16_000)), ("radius", float(0.05))];
        let (sppm, path) = (blocks("sppm", 32, &small), blocks("path", n_path, &[]));
        // Through glass that disperses a path has one wavelength, which makes luminance noisier.
        let resolution = if name == "dispersion" { 0.2 } else { 0.1 };
        expect_same_image(name, &sppm, &path, resolution);
    }
}

/// Nothing to find is black, or what samples of lights find: never NaN, never a panic.
#[test]
fn empty_scenes_are_black() {
    let floor = level(0.0, 0.5);
    let point = |place: &str| format!("LightSource \"point\" {} \"point3 from\" [{place}] ", lit("I", 1.0));
    let scenes = [
        (String::new(), true),
        (floor.clone(), true),
        (point("0 0 5"), true),
        (point("0 0 -5") + &floor, true),
        (format!("{} Material \"diffuse\" {} {floor}", point("0 0 5"), flat("reflectance", 0.0)), true),
        (point("0 0 5") + &floor, false),
    ];
    for (index, (world, is_black)) in scenes.iter().enumerate() {
        let scene = Setup { size: [8, 8], camera: DOWN, world, ..Setup::default() }.scene("empty");
        let settings: [Vec<(&str, Value)>; 5] = [
            vec![],
            vec![("photonsperiteration", integer(1))],
            vec![("maxdepth", integer(0))],
            vec![("radius", float(1e-30))],
            vec![("radius", float(1e30)), ("radiusupdate", word("perpixel"))],
        ];
        let mut scene = scene;
        for parameters in settings {
            scene = by(scene, "sppm", &parameters);
            let film = render_passes(&scene, 0..2);
            let total: f64 = luminance(&film).iter().sum();
            let expects_black = *is_black || parameters.first().is_some_and(|p| p.0 == "maxdepth");
            assert!(total.is_finite() && (total == 0.0) == expects_black, "scene {index}: {total}");
        }
    }
}

/// What artists switch off is the layer of that component, for photons as for camera paths, also where camera paths go on from
/// wide gloss. One radius for all, since what is switched off also changes the density that chooses it.
#[test]
fn switches_remove_exactly_what_they_name() {
    let (caustic, indirect) = ("LS+D(S|D)*E", "L(S|D)*DS*D(S|D)*E");
    let switches = [
        ("castscaustics", caustic),
        ("receivescaustics", caustic),
        ("castsindirect", indirect),
        ("receivesindirect", indirect),
    ];
    for receiver_alpha in [0.15, 0.9] {
        let parameters = [
            ("maxdepth", integer(6)),
            ("photonsperiteration", integer(20_000)),
            ("radius", float(0.1)),
            ("receiveralpha", float(receiver_alpha)),
            // What is switched off is not aimed at, which would change which photons are emitted.
            ("causticshare", float(0.0)),
        ];
        let scene = |all: &str| by(controls::scene(all, "", ""), "sppm", &parameters);
        let layers = [("caustic", caustic), ("indirect", indirect)];
        let whole = render_layers(&scene(""), 0..2, &layers);
        for (switch, component) in switches {
            let name = if component == caustic { "caustic" } else { "indirect" };
            let gone = layer(&whole, name);
            assert!(gone.iter().any(|v| *v > 0.0), "{name} is there");
            let expected: Vec<f64> = luminance(&whole).iter().zip(&gone).map(|(a, b)| a - b).collect();
            let found = luminance(&render_passes(&scene(&format!("\"bool {switch}\" false")), 0..2));
            expect_equal_pixels(switch, &found, &expected, 1e-3);
        }
    }
}

/// Shapes that a light does not reach look as if it were dark, to photons too.
#[test]
fn linked_lights_reach_whom_they_may() {
    for direct in ["lights", "photons"] {
        let parameters = [
            ("maxdepth", integer(4)),
            ("photonsperiteration", integer(8000)),
            ("radius", float(0.1)),
            ("direct", word(direct)),
        ];
        let moments = |shapes: &str, key| {
            block_moments(&by(controls::linked(direct, shapes, key, ""), "sppm", &parameters), 16, 2)
        };
        let only_fill = "\"string lights\" [ \"fill\" ]";
        expect_same_image(direct, &moments(only_fill, 5.0), &moments("", 0.0), 0.1);
    }
}

/// Point-like lights glint in sharp gloss, which receives no photons, also where photons bring all direct light.
#[test]
fn point_lights_glint_without_light_samples_of_receivers() {
    let world = format!(
        "LightSource \"point\" {} \"point3 from\" [0 0 2]
        Material \"conductor\" \"float roughness\" 0.1 \"bool remaproughness\" false {}",
        lit("I", 1.0),
        level(0.0, 0.5)
    );
    let image = |name, parameters: &[(&str, Value)], n| {
        let setup = Setup { size: [16, 16], camera: DOWN, world: &world, ..Setup::default() };
        mean(&luminance(&render_passes(&by(setup.scene("glint"), name, parameters), 0..n)))
    };
    let found = image("sppm", &[("direct", word("photons"))], 4);
    // Both see the same function at random places in pixels; over 256 of them it varies by a part of itself.
    expect_near("glint", found, image("path", &[], 16), 0.01);
}

/// Light that is even everywhere stays so on what is thinner or smaller than the radius: convex things of reflectance 1/2 under
/// an even sky have half of its radiance, by photons alone. On bent things photons are lost that come from below the horizon of
/// the visible point: (1 - cos a) / 2 of those on surface turned away by a, which counts up to 60 degrees and weighs cos a.
#[test]
fn thin_and_small_things_are_as_bright_as_large_ones() {
    let window = |x: f64, y: f64| {
        format!(
            "LookAt 0 0 0.9  0 0 0  0 1 0 Camera \"orthographic\" \"float screenwindow\" [-{x} {x} -{y} {y}]"
        )
    };
    let things = [
        (
            "pole",
            window(0.005, 0.08),
            "Rotate 90 1 0 0 Shape \"cylinder\" \"float radius\" 0.01 \"float zmin\" -0.15 \"float zmax\" 0.15",
            // Over the angle: (sin a - a / 2 - sin(2a) / 4) / (2 sin a).
            0.0727,
        ),
        // Over the cap: (sin(a)^2 / 2 - (1 - cos(a)^3) / 3) / sin(a)^2.
        ("ball", window(0.01, 0.01), "Shape \"sphere\" \"float radius\" 0.02", 0.1111),
        ("plate", window(0.02, 0.02), "Shape \"disk\" \"float radius\" 0.03", 0.0),
        // A twentieth of the disc: 2 * 0.004 * 0.05 of pi * 0.05^2.
        (
            "strip",
            window(0.0015, 0.08),
            "Shape \"bilinearmesh\" \"point3 P\" [-0.002 -0.15 0  0.002 -0.15 0  -0.002 0.15 0  0.002 0.15 0]",
            0.0,
        ),
    ];
    let parameters = [
        ("radius", float(0.05)),
        ("photonsperiteration", integer(200_000)),
        ("direct", word("photons")),
        ("maxdepth", integer(1)),
    ];
    for (name, camera, thing, lost) in things {
        let world = format!(
            "LightSource \"infinite\" {} Material \"diffuse\" {} {thing}",
            lit("L", 1.0),
            flat("reflectance", 0.5)
        );
        let scene = Setup { size: [32, 32], camera: &camera, world: &world, ..Setup::default() }.scene(name);
        let n_passes = if name == "strip" { 16 } else { 4 };
        let film = render_passes(&by(scene, "sppm", &parameters), 0..n_passes);
        // At least 20,000 photons: 0.7 %. On the pole, which covers a fifth of the disc, each of 16,384 points multiplies by a
        // number of trials whose deviation is 0.9 of its mean: another 0.7 %. The strip has four times the points,
        // and 12,000 photons: 0.9 %.
        expect_near(name, mean(&luminance(&film)), 0.5 * (1.0 - lost), 0.04);
    }
}

/// What is too sharp to receive photons is no part of the area that photons are divided by, though it is the same material: metal
/// whose roughness alternates within the radius.
#[test]
fn parts_that_receive_nothing_are_no_area() {
    let world = format!(
        "LightSource \"infinite\" {}
        Texture \"checks\" \"float\" \"checkerboard\" \"float uscale\" 20 \"float vscale\" 20 \"float tex1\" 0.05 \"float tex2\" 0.4
        Material \"conductor\" \"texture roughness\" \"checks\" \"bool remaproughness\" false {}",
        lit("L", 1.0),
        level(0.0, 0.2)
    );
    let image = |name, n, parameters: &[(&str, Value)]| {
        let scene = Setup { size: [32, 32], camera: DOWN, world: &world, ..Setup::default() }.scene(name);
        mean(&luminance(&render_passes(&by(scene, name, parameters), 0..n)))
    };
    let parameters = [
        ("radius", float(0.05)),
        ("photonsperiteration", integer(100_000)),
        ("direct", word("photons")),
        ("maxdepth", integer(1)),
    ];
    // Half of the metal is wide gloss, which would be half as bright.
    expect_near("checks", image("sppm", 8, &parameters), image("path", 16, &[]), 0.04);
}

/// A share of the photons that is aimed at a small ball of glass changes noise alone: caustic, shadow and floor stay.
#[test]
fn aimed_photons_bring_the_same_light() {
    let ball = "Translate 0 0 0.2 Material \"dielectric\" Shape \"sphere\" \"float radius\" 0.05";
    let blocks = |share: f64| {
        let parameters = [
            ("photonsperiteration", integer(100_000)),
            ("radius", float(0.02)),
            ("causticshare", float(share)),
        ];
        let scene = under_the_lamp(&flat("reflectance", 0.5), ball, &format!("aim {share}"));
        block_moments(&by(scene, "sppm", &parameters), 16, 2)
    };
    // A fifth of the light comes through the ball. Unaimed, 500 photons a pass bring it, so that its mean over 16 passes has a
    // deviation of 1.1 %, and the image one of 0.25 %.
    expect_same_image("aim", &blocks(0.25), &blocks(0.0), 0.03);
}

/// What is inside a shell that is smaller than the radius is not seen on its outside.
#[test]
fn light_within_a_shell_stays_there() {
    let world = format!(
        "AttributeBegin AreaLightSource \"diffuse\" {} Shape \"sphere\" \"float radius\" 0.005 AttributeEnd
        Material \"diffuse\" {} Shape \"sphere\" \"float radius\" 0.03",
        lit("L", 1.0),
        flat("reflectance", 0.5)
    );
    let scene = Setup { size: [16, 16], camera: DOWN, world: &world, ..Setup::default() }.scene("shell");
    let parameters = [("radius", float(0.1)), ("photonsperiteration", integer(20_000))];
    let film = render_passes(&by(scene, "sppm", &parameters), 0..2);
    assert!(luminance(&film).iter().all(|value| *value == 0.0));
}

/// A sampler that plans for one pass deals new numbers in each that follows.
#[test]
fn passes_beyond_the_planned_ones_are_new() {
    let photons = [("radius", float(0.05)), ("photonsperiteration", integer(100_000))];
    let mut scene = by(under_a_pane(&flat("reflectance", 0.5), "planned"), "sppm", &photons);
    scene.sampler.kind = SamplerKind::ZSobol;
    scene.sampler.samples_per_pixel = 1;
    let images: Vec<Vec<f64>> =
        (0..16).map(|pass| luminance(&render_passes(&scene, pass..pass + 1))).collect();
    for (index, image) in images.iter().enumerate() {
        assert!(!images[..index].contains(image), "pass {index} repeats another");
    }
    // 40,000 photons in all are seen: 0.5 %.
    expect_near("mean", mean(&images.concat()), through_the_pane(0.5), 0.03);
    // The means of single passes deviate by 2 % or less, and not all the same way.
    let means: Moments = images.iter().map(|image| mean(image)).collect();
    assert!(means.standard_deviation() > 0.0 && means.standard_deviation() < 0.05 * means.mean());
}

/// Means of 16 by 16 blocks of each channel, of renders that have seeds of their own.
fn block_images(mut scene: Scene, n_renders: u64, n_passes: u64) -> Vec<Vec<f64>> {
    let render = |index: u64| {
        scene.sampler.seed = hash64(&[seed("blocks"), index]);
        let image = render_passes(&scene, 0..n_passes).develop();
        let blocks = |name: &&str| block_means(&channel(&image, name), image.width, 16);
        ["R", "G", "B"].iter().flat_map(blocks).collect()
    };
    (0..n_renders).map(render).collect()
}

/// The blocks in which renders by two methods differ by more than chance, with the mean of both.
fn differing_blocks(a: &[Vec<f64>], b: &[Vec<f64>]) -> Vec<(usize, f64, f64)> {
    let n_blocks = a[0].len();
    let mean_of = |images: &[Vec<f64>], block: usize| {
        images.iter().map(|image| image[block]).sum::<f64>() / images.len() as f64
    };
    let differs = |block: &usize| {
        let differences: Moments = a.iter().zip(b).map(|(a, b)| a[*block] - b[*block]).collect();
        mean_test(&differences, 0.0, sidak(1e-3, n_blocks)).is_err()
    };
    (0..n_blocks).filter(differs).map(|block| (block, mean_of(a, block), mean_of(b, block))).collect()
}

/// PROG-2: on the standard box all 16 by 16 blocks of every channel are those of the path tracer, by a test on 16 renders of
/// each; a radius of 30 cm that is left so shows.
#[test]
fn the_standard_box_is_that_of_the_path_tracer() {
    if !runs_slow("the_standard_box_is_that_of_the_path_tracer") {
        return;
    }
    const N_RENDERS: u64 = 16;
    let room = || scenes::scene("box.pbrt", [64, 64], None);
    let path = block_images(room(), N_RENDERS, 64);
    let depth = ("maxdepth", integer(12));
    let sppm = block_images(by(room(), "sppm", std::slice::from_ref(&depth)), N_RENDERS, 8);
    let differing = differing_blocks(&sppm, &path);
    assert!(differing.is_empty(), "{differing:?}");
    for (index, channel) in ["R", "G", "B"].iter().enumerate() {
        let range = index * 256..(index + 1) * 256;
        let of =
            |images: &[Vec<f64>]| mean(&images.iter().map(|i| mean(&i[range.clone()])).collect::<Vec<_>>());
        expect_near(channel, of(&sppm), of(&path), 0.005);
    }
    let blurred = [depth, ("radius", float(0.3)), ("alpha", float(1.0))];
    let blurred = block_images(by(room(), "sppm", &blurred), N_RENDERS, 1);
    assert!(differing_blocks(&blurred, &path).len() > 20, "blur would not show");
}

/// Where the camera sees nothing that photons could be gathered on, the report says so, and only there.
#[test]
fn a_word_where_nothing_is_seen() {
    let lamp = format!("LightSource \"point\" {} \"point3 from\" [0 0 5] ", lit("I", 1.0));
    for (world, says) in [(lamp.clone(), true), (lamp + &level(0.0, 0.5), false)] {
        let scene = Setup { size: [8, 8], camera: DOWN, world: &world, ..Setup::default() }.scene("seen");
        let scene = by(scene, "sppm", &[]);
        let mut film = Film::new(scene.film.clone(), Vec::new());
        let mut integrator = method(&scene.integrator, PathExpressions::default()).0.expect("a method");
        assert!(integrator.report().iter().all(|entry| entry.advice.is_none()), "nothing was looked at yet");
        render(&scene, integrator.as_mut(), &mut film, &Stop { passes: 0..1, error: None }, &Unobserved);
        let is_told = integrator
            .report()
            .iter()
            .any(|entry| entry.advice.as_ref().is_some_and(|advice| advice.contains("nothing in view")));
        assert_eq!(is_told, says, "{:?}", integrator.report());
    }
}
