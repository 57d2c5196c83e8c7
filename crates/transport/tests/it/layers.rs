//! Layers by path expression: what each selects, and that nothing is lost or counted twice (SPEC EQ-7, LPE-1, LPE-2).

use etendue_math::statistics::Moments;
use etendue_scene::Film;

use crate::support::{
    Setup, expect_equal_pixels, expect_mean, flat, layer, lit, luminance, render_layers, render_passes,
};

/// A glowing sphere seen from inside, and expressions for 0 to 6 bounces.
const ALBEDO: f64 = 0.7;
const BOUNCES: [(&str, &str); 7] = [
    ("b0", "L.{0}E"),
    ("b1", "L.{1}E"),
    ("b2", "L.{2}E"),
    ("b3", "L.{3}E"),
    ("b4", "L.{4}E"),
    ("b5", "L.{5}E"),
    ("b6", "L.{6}E"),
];

fn furnace(integrator: &str) -> etendue_scene::Scene {
    let world = format!(
        "Material \"diffuse\" {} AreaLightSource \"diffuse\" {} ReverseOrientation Shape \"sphere\"",
        flat("reflectance", ALBEDO),
        lit("L", 1.0)
    );
    let camera = "LookAt 0.1 0.2 -0.3  0.4 -0.1 1  0 1 0 Camera \"perspective\"";
    Setup { size: [16, 16], integrator, camera, world: &world, ..Setup::default() }.scene("bounces")
}

/// The sum over the named layers.
fn sum_of(film: &Film, names: &[&str]) -> Vec<f64> {
    let mut sum = vec![0.0; film.settings().crop.n_pixels()];
    for name in names {
        for (sum, value) in sum.iter_mut().zip(layer(film, name)) {
            *sum += value;
        }
    }
    sum
}

/// EQ-7: term k of the Neumann series, light reflected k times, has the share a^k of the emission; partial sums rise
/// towards 1 / (1 - a).
#[test]
fn bounce_layers_are_the_neumann_series() {
    let film =
        render_layers(&furnace("\"integer maxdepth\" 6 \"integer roulettedepth\" 2"), 0..256, &BOUNCES);
    for (k, (name, _)) in BOUNCES.iter().enumerate() {
        let moments: Moments = layer(&film, name).into_iter().collect();
        expect_mean(name, &moments, ALBEDO.powi(k as i32), 0.05);
    }
    let names = BOUNCES.map(|(name, _)| name);
    expect_equal_pixels("sum of bounces", &sum_of(&film, &names), &luminance(&film), 1e-4);
}

/// EQ-7, PT-5: a depth limit of n leaves exactly the layers up to n: the same paths up to there, by the same numbers.
#[test]
fn depth_limit_keeps_the_first_layers() {
    let deep = render_layers(&furnace("\"integer maxdepth\" 6 \"integer roulettedepth\" 1"), 0..16, &BOUNCES);
    for n in 0..6 {
        let integrator = format!("\"integer maxdepth\" {n} \"integer roulettedepth\" 1");
        let shallow = render_passes(&furnace(&integrator), 0..16);
        let names: Vec<&str> = BOUNCES[..=n].iter().map(|(name, _)| *name).collect();
        expect_equal_pixels(&format!("depth {n}"), &sum_of(&deep, &names), &luminance(&shallow), 1e-4);
    }
}

/// A floor under a lamp with a glass ball, a mirror ball, a glossy ball, and walls around.
fn mixed_scene(balls: bool) -> etendue_scene::Scene {
    let objects = "AttributeBegin Translate -0.5 -0.5 0 Material \"dielectric\" Shape \"sphere\" \"float radius\" 0.4 AttributeEnd
        AttributeBegin Translate 0.5 -0.5 0.3 Material \"conductor\" Shape \"sphere\" \"float radius\" 0.4 AttributeEnd
        AttributeBegin Translate 0 0.4 0.4 Material \"coateddiffuse\" \"float roughness\" 0.2
        Shape \"sphere\" \"float radius\" 0.3 AttributeEnd
        AttributeBegin Translate 0.6 0.4 0.4 Material \"conductor\" \"float roughness\" 0.001
        Shape \"sphere\" \"float radius\" 0.2 AttributeEnd";
    let world = format!(
        "AttributeBegin Material \"diffuse\" {} Shape \"bilinearmesh\" \"point3 P\" [-1 -1 -1  1 -1 -1  -1 -1 1  1 -1 1]
        Shape \"bilinearmesh\" \"point3 P\" [-1 -1 1  1 -1 1  -1 1 1  1 1 1] AttributeEnd
        {}
        AttributeBegin AreaLightSource \"diffuse\" {} \"bool twosided\" true
        Shape \"bilinearmesh\" \"point3 P\" [-0.4 1 -0.4  0.4 1 -0.4  -0.4 1 0.4  0.4 1 0.4] AttributeEnd
        LightSource \"infinite\" {}",
        flat("reflectance", 0.6),
        if balls { objects } else { "" },
        lit("L", 4.0),
        lit("L", 0.1)
    );
    let camera = "LookAt 0 0.2 -3.5  0 0 0  0 1 0 Camera \"perspective\" \"float fov\" 42";
    Setup { size: [24, 24], integrator: "\"integer maxdepth\" 8", camera, world: &world, ..Setup::default() }
        .scene("mixed")
}

/// LPE-1: without media every path consists of S and D, so that `L(S|D)*E` is the image; expressions that exclude each other
/// and cover all paths add up to it. Layers do not change the image.
#[test]
fn expressions_partition_the_image() {
    let scene = mixed_scene(true);
    let all = [("all", "L(S|D)*E"), ("any", "L.*E"), ("three", "L(S|D|G)*E")];
    let by_length = [("l0", "LE"), ("l1", "L(S|D)E"), ("l2", "L(S|D){2}E"), ("l3", "L(S|D){3,}E")];
    let by_last = [("e", "LE"), ("d", "L(S|D)*DE"), ("s", "L(S|D)*SE")];
    let by_glossy = [("n", "L(S|D)*E"), ("g", "L[SDG]*GE"), ("gs", "L[SDG]*SE"), ("gd", "L[SDG]*DE")];
    let film = render_layers(&scene, 0..8, &[&all[..], &by_length, &by_last, &by_glossy].concat());
    let image = luminance(&film);
    for (name, expression) in all {
        expect_equal_pixels(expression, &layer(&film, name), &image, 1e-4);
    }
    expect_equal_pixels("by length", &sum_of(&film, &["l0", "l1", "l2", "l3"]), &image, 1e-4);
    expect_equal_pixels("by last event", &sum_of(&film, &["e", "d", "s"]), &image, 1e-4);
    expect_equal_pixels("with glossy events", &sum_of(&film, &["e", "g", "gs", "gd"]), &image, 1e-4);
    assert_eq!(luminance(&render_passes(&scene, 0..8)), image, "layers leave the image alone");
    for name in ["l0", "l1", "l2", "l3", "d", "s", "g", "gs", "gd"] {
        assert!(layer(&film, name).iter().any(|v| *v > 0.0), "{name} selects something here");
    }
}

/// LPE-3: caustics need something specular between the light and a diffuse surface.
#[test]
fn caustics_need_specular_objects() {
    let expressions = [("caustic", "LS+DE"), ("direct", "LDE"), ("mirrored", "L.*SE")];
    let with = render_layers(&mixed_scene(true), 0..32, &expressions);
    let without = render_layers(&mixed_scene(false), 0..32, &expressions);
    let total = |film: &Film, name: &str| layer(film, name).iter().sum::<f64>();
    assert!(total(&with, "caustic") > 0.0);
    assert!(total(&with, "mirrored") > 0.0);
    assert_eq!(total(&without, "caustic"), 0.0);
    assert_eq!(total(&without, "mirrored"), 0.0);
    assert!(total(&without, "direct") > 0.0);
}

/// LPE-1 by class of light: `LDE` is the image of a render of one bounce among diffuse surfaces, light sources left out.
#[test]
fn direct_layer_is_direct_light() {
    let world = format!(
        "Material \"diffuse\" {} Shape \"bilinearmesh\" \"point3 P\" [-5 -1 -5  5 -1 -5  -5 -1 5  5 -1 5]
        Translate 0 -0.4 0 Shape \"sphere\" \"float radius\" 0.5
        LightSource \"point\" {} \"point3 from\" [1 2 -1]",
        flat("reflectance", 0.5),
        lit("I", 3.0)
    );
    let scene = |depth: u32| {
        let integrator = format!("\"integer maxdepth\" {depth}");
        let camera = "LookAt 0 0 -3  0 -0.5 0  0 1 0 Camera \"perspective\"";
        Setup { size: [16, 16], integrator: &integrator, camera, world: &world, ..Setup::default() }
            .scene("direct")
    };
    let film = render_layers(&scene(5), 0..8, &[("direct", "LDE"), ("indirect", "LDD+E")]);
    expect_equal_pixels("LDE", &layer(&film, "direct"), &luminance(&render_passes(&scene(1), 0..8)), 1e-5);
    assert!(layer(&film, "indirect").iter().sum::<f64>() > 0.0);
}

/// A disk of a material under a white sky, seen from above.
fn disk_layers(name: &str, material: &str, integrator: &str) -> Film {
    let world = format!("LightSource \"infinite\" {} Material {material} Shape \"disk\"", lit("L", 1.0));
    let camera =
        "LookAt 0 0 2  0 0 0  0 1 0 Camera \"orthographic\" \"float screenwindow\" [-0.5 0.5 -0.5 0.5]";
    let setup = Setup { size: [16, 16], integrator, camera, world: &world, ..Setup::default() };
    render_layers(&setup.scene(name), 0..512, &[("specular", "LSE"), ("diffuse", "LDE")])
}

/// LPE-5: of a coated surface, what the coat reflects has the letter S, and what comes back through it the letter D: as much
/// of each as there is of each lobe. The coat reflects 4 % at normal incidence.
#[test]
fn letters_come_from_the_sampled_component() {
    let material =
        format!("\"coateddiffuse\" {} \"float roughness\" 0 \"float eta\" 1.5", flat("reflectance", 0.5));
    let film = disk_layers("coat", &material, "");
    let (specular, diffuse) = (layer(&film, "specular"), layer(&film, "diffuse"));
    expect_mean("the coat", &specular.iter().copied().collect(), 0.04, 0.08);
    let sum: Vec<f64> = specular.iter().zip(&diffuse).map(|(a, b)| a + b).collect();
    expect_equal_pixels("coat and base", &sum, &luminance(&film), 1e-5);
}

/// LPE-5: whether a glossy lobe counts as S or as D is a matter of width, and scenes may set which.
#[test]
fn scenes_say_what_is_sharp() {
    let material = "\"conductor\" \"float roughness\" 0.2 \"bool remaproughness\" false";
    for (integrator, name, other) in [
        ("\"float sharpalpha\" 0.3", "specular", "diffuse"),
        ("\"float sharpalpha\" 0.15", "diffuse", "specular"),
        ("", "diffuse", "specular"),
    ] {
        let film = disk_layers("metal", material, integrator);
        expect_equal_pixels(name, &layer(&film, name), &luminance(&film), 1e-5);
        assert!(layer(&film, other).iter().all(|value| *value == 0.0));
    }
}
