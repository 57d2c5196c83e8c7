//! The four terms of photon mapping, each by itself, against path tracing with the same path expressions (SPEC PM-3 to PM-10,
//! EXP-11): whatever balls are made of, wherever light is sharp or wide, and however accurately surfaces are treated.
//!
//! Each term may differ by noise, five standard errors of the pixels' differences, and by the bias of its map. The direct term has
//! none. Caustics and indirect light are blurred by radii of 0.1 m in a room of 2 m: light that blur carries beyond edges or into
//! corners is lost or won in a strip of that width, a few per cent of it in the mean.

use etendue_math::statistics::Moments;
use etendue_scene::document::{Entity, Value};
use etendue_scene::{Film, Scene};
use etendue_transport::lpe::PathExpressions;
use etendue_transport::{Stop, Unobserved, method, render, with_own_layers};

use crate::support::{Setup, flat, layer, lit, luminance, mean, render_layers, runs_slow};

const TERMS: [(&str, &str); 4] =
    [("direct", "LD?E"), ("specular", "L(S|D)*SE"), ("caustic", "LS+DE"), ("indirect", "L(S|D)*DS*DE")];

/// Bias of the terms, as a share of each.
const BIAS: [f64; 4] = [0.0, 0.02, 0.03, 0.02];

const CAMERA: &str = "LookAt 0 0 -0.95  0 -0.3 1  0 1 0 Camera \"perspective\" \"float fov\" 75";

/// A closed room with a large lamp in the ceiling and two balls close to the floor, whose caustics paths find.
fn room(left: &str, right: &str, walls: &str) -> String {
    format!(
        "Material {walls} Shape \"bilinearmesh\" \"integer indices\" [0 1 2 3  4 5 6 7  2 3 6 7  0 1 4 5  0 2 4 6  1 3 5 7]
        \"point3 P\" [-1 -1 -1  1 -1 -1  -1 -1 1  1 -1 1  -1 1 -1  1 1 -1  -1 1 1  1 1 1]
        AttributeBegin Translate -0.45 -0.5 0.3 Material {left} Shape \"sphere\" \"float radius\" 0.4 AttributeEnd
        AttributeBegin Translate 0.45 -0.55 0 Material {right} Shape \"sphere\" \"float radius\" 0.4 AttributeEnd
        AttributeBegin AreaLightSource \"diffuse\" {} Translate 0 0.99 0.2 Rotate 90 1 0 0
        Shape \"bilinearmesh\" \"point3 P\" [-0.6 -0.6 0  0.6 -0.6 0  -0.6 0.6 0  0.6 0.6 0] AttributeEnd",
        lit("L", 3.0)
    )
}

fn matte() -> String {
    format!("\"diffuse\" {}", flat("reflectance", 0.5))
}

fn scene(world: &str, name: &str, integrator: Entity) -> Scene {
    let mut scene = Setup { size: [24, 24], camera: CAMERA, world, ..Setup::default() }.scene(name);
    scene.integrator = integrator;
    scene
}

fn photon_map(parameters: &[(&str, f32)]) -> Entity {
    let entity = Entity::new("photonmap")
        .with("globalphotons", Value::Integers(vec![60_000]))
        .with("causticphotons", Value::Integers(vec![60_000]));
    parameters.iter().fold(entity, |entity, (name, value)| {
        let value = if *name == "gatherrays" {
            Value::Integers(vec![*value as i32])
        } else {
            Value::Floats(vec![*value])
        };
        entity.with(name, value)
    })
}

fn run(scene: &Scene, n_passes: u64) -> Film {
    let expressions = with_own_layers(&scene.integrator, PathExpressions::default());
    let mut film = Film::new(scene.film.clone(), expressions.names().to_vec());
    let (integrator, problems) = method(&scene.integrator, expressions);
    assert!(!problems.has_errors(), "{:?}", problems.list());
    let stop = Stop { passes: 0..n_passes, error: None };
    render(scene, integrator.expect("a method").as_mut(), &mut film, &stop, &Unobserved);
    assert_eq!(film.sums().faults.invalid, 0, "NaN, infinite or negative radiance");
    film
}

/// Holds all terms of a room against paths, for each set of parameters.
#[track_caller]
fn check(name: &str, world: &str, bias: [f64; 4], settings: &[&[(&str, f32)]]) {
    let path = Entity::new("path").with("maxdepth", Value::Integers(vec![64]));
    let paths = render_layers(&scene(world, &format!("{name} paths"), path), 0..400, &TERMS);
    let whole = mean(&luminance(&paths));
    for parameters in settings {
        let film = run(&scene(world, name, photon_map(parameters)), 32);
        let sum: f64 = TERMS.iter().map(|(term, _)| mean(&layer(&film, term))).sum();
        assert!((sum / mean(&luminance(&film)) - 1.0).abs() < 1e-4, "terms add up");
        for ((term, _), bias) in TERMS.iter().zip(bias) {
            let (ours, theirs) = (layer(&film, term), layer(&paths, term));
            let difference: Moments = ours.iter().zip(&theirs).map(|(a, b)| a - b).collect();
            let expected = mean(&theirs);
            let tolerance = bias * expected + 5.0 * difference.standard_error() + 1e-4 * whole;
            assert!(
                difference.mean().abs() < tolerance,
                "{name} {parameters:?} {term}: {} instead of {expected} (tolerance {tolerance})",
                mean(&ours)
            );
            // The test would see a term that is lost or counted twice.
            assert!(expected < 0.03 * whole || tolerance < 0.5 * expected, "{name} {term}: {tolerance}");
        }
    }
}

/// Mirror and glass, whatever is gathered and wherever surfaces are treated accurately (PM-6).
#[test]
fn strong_caustics() {
    let settings: [&[(&str, f32)]; 5] = [
        &[],
        &[("gatherrays", 4.0)],
        &[("accuratedistance", 0.0)],
        &[("accuratedistance", f32::INFINITY)],
        &[("accurateshare", 0.5)],
    ];
    check("mirror and glass", &room("\"conductor\"", "\"dielectric\"", &matte()), BIAS, &settings);
}

/// Rough metal on either side of the width that parts `S` from `D`.
#[test]
fn gloss_on_both_sides_of_sharp() {
    let metal =
        |alpha: f32| format!("\"conductor\" \"bool remaproughness\" false \"float roughness\" {alpha}");
    check("gloss", &room(&metal(0.07), &metal(0.14), &matte()), BIAS, &[&[], &[("accuratedistance", 0.0)]]);
}

/// Coats have lobes of both kinds on one surface, walls of varnish and rough glass as well.
#[test]
fn coated_balls_and_walls() {
    let coated = |alpha: f32| {
        format!(
            "\"coateddiffuse\" {} \"bool remaproughness\" false \"float roughness\" {alpha}",
            flat("reflectance", 0.5)
        )
    };
    let rough = "\"dielectric\" \"bool remaproughness\" false \"float roughness\" 0.2";
    check("coats", &room(&coated(0.0), rough, &coated(0.3)), BIAS, &[&[]]);
}

/// Shading normals that are not the geometric ones, as normal maps and smooth meshes have them: photons arrive by the one, and are
/// reflected by the other, which weighs those of another wall by a cosine that may be small. Here normals lean by up to 55 degrees, and
/// indirect light is 7.5 % too bright in the mean of four maps; with ten times as many photons 1.3 %.
#[test]
fn bent_normals() {
    let world = room("\"conductor\"", "\"dielectric\"", &matte()).replace(
        "\"point3 P\" [-1 -1 -1",
        "\"normal N\" [1 2 1  -1 2 1  1 2 -1  -1 2 -1  1 -2 1  -1 -2 1  1 -2 -1  -1 -2 -1] \"point3 P\" [-1 -1 -1",
    );
    check("bent", &world, [0.0, 0.05, 0.06, 0.09], &[&[]]);
    let indirect = |n: i32| {
        let mut integrator = photon_map(&[]);
        integrator.parameters.retain(|parameter| parameter.name != "globalphotons");
        let integrator = integrator.with("globalphotons", Value::Integers(vec![n]));
        mean(&layer(&run(&scene(&world, "bent", integrator), 16), "indirect"))
    };
    let (few, many) = (indirect(60_000), indirect(600_000));
    assert!(few > 1.02 * many, "{few} with few photons, {many} with many");
}

/// What is left of the caustic's mean once noise is known, by several maps of independent photons with a small radius. Blur moves
/// light over edges and conserves it on a plane; beside the ball itself some of it falls onto the ball. Found are 2.3 % with a
/// standard error of 1.5 %: a bias below 8 % is not seen, and whether it falls with the radius is not tested.
#[test]
fn caustics_with_a_small_radius_have_the_mean_of_paths() {
    if !runs_slow("caustics_with_a_small_radius_have_the_mean_of_paths") {
        return;
    }
    let world = room("\"conductor\"", "\"dielectric\"", &matte());
    let path = Entity::new("path").with("maxdepth", Value::Integers(vec![64]));
    let of = |film: &Film| mean(&layer(film, "caustic"));
    let paths: Moments = (0..8)
        .map(|seed| of(&render_layers(&scene(&world, &format!("p{seed}"), path.clone()), 0..400, &TERMS)))
        .collect();
    let maps: Moments = (0..8)
        .map(|seed| {
            let integrator = photon_map(&[("causticradius", 0.05)]);
            of(&run(&scene(&world, &format!("m{seed}"), integrator), 16))
        })
        .collect();
    let bias = maps.mean() / paths.mean() - 1.0;
    let error = maps.standard_error().hypot(paths.standard_error()) / paths.mean();
    assert!(bias.abs() < 0.005 + 5.0 * error && error < 0.02, "{bias} ± {error}");
}
