//! Ambient occlusion against closed forms.

use etendue_math::statistics::Moments;
use etendue_scene::Scene;
use etendue_scene::document::{Entity, Value};

use crate::support::{Setup, channel, expect_mean, luminance, render_passes};

/// A scene rendered by `ao` with these parameters.
fn occluded(name: &str, setup: &Setup<'_>, parameters: &[(&'static str, Value)]) -> Scene {
    let mut scene = setup.scene(name);
    scene.integrator =
        parameters.iter().fold(Entity::new("ao"), |entity, (name, v)| entity.with(name, v.clone()));
    scene
}

/// Moments of the pixels' luminance.
fn moments(scene: &Scene, n_passes: u64) -> Moments {
    luminance(&render_passes(scene, 0..n_passes)).into_iter().collect()
}

const WALL: &str = "Shape \"bilinearmesh\" \"point3 P\" [-50 -50 5  50 -50 5  -50 50 5  50 50 5]";

/// What sees the whole sky is 1, with no noise but that of wavelengths; where nothing is, is black; surfaces that light passes are not there.
#[test]
fn an_open_wall_is_white() {
    let world = format!("AttributeBegin Material \"interface\" Shape \"sphere\" AttributeEnd {WALL}");
    let setup = Setup { world: &world, ..Setup::default() };
    expect_mean("an open wall", &moments(&occluded("open wall", &setup, &[]), 64), 1.0, 0.01);
    let uniform = occluded("open wall", &setup, &[("cossample", Value::Bools(vec![false]))]);
    expect_mean("uniform directions", &moments(&uniform, 256), 1.0, 0.04);
    let empty = occluded("nothing", &Setup::default(), &[]);
    assert!(luminance(&render_passes(&empty, 0..2)).iter().all(|value| *value == 0.0));
}

/// Inside a ball of radius R a direction at the angle t meets the other side after 2 R cos t, so that a share 1 - (d / 2R)^2 of
/// the cosine-weighted sky is further away than d.
#[test]
fn distance_limits_occlusion() {
    let world = "Shape \"sphere\" \"float radius\" 2";
    let setup = Setup { size: [16, 16], world, ..Setup::default() };
    for (distance, expected) in [(1.0_f32, 15.0 / 16.0), (2.0, 0.75), (3.0, 7.0 / 16.0), (5.0, 0.0)] {
        for samples in [1, 4] {
            let parameters =
                [("maxdistance", Value::Floats(vec![distance])), ("samples", Value::Integers(vec![samples]))];
            let scene = occluded("ball", &setup, &parameters);
            let found = moments(&scene, 64);
            if expected == 0.0 {
                assert_eq!(found.mean(), 0.0);
            } else {
                expect_mean(&format!("within {distance}"), &found, expected, 0.06);
            }
        }
    }
}

/// A floor beside a wall of height h sees 1/2 (1 + x / sqrt(x^2 + h^2)) of the sky at the distance x from it.
#[test]
fn a_wall_hides_its_part_of_the_sky() {
    let world = "Shape \"bilinearmesh\" \"point3 P\" [0 0 -900  8 0 -900  0 0 900  8 0 900]
        Shape \"bilinearmesh\" \"point3 P\" [0 0 -900  0 2 -900  0 0 900  0 2 900]";
    for x in [0.5_f64, 1.0, 4.0] {
        let camera = format!(
            "LookAt {x} 1 0  {x} 0 0  0 0 1 Camera \"orthographic\" \"float screenwindow\" [-0.001 0.001 -0.001 0.001]"
        );
        let setup = Setup { size: [16, 16], world, camera: &camera, ..Setup::default() };
        let expected = 0.5 * (1.0 + x / x.hypot(2.0));
        expect_mean(&format!("at {x}"), &moments(&occluded("wall", &setup, &[]), 64), expected, 0.04);
    }
}

/// Colours of surfaces show if they are asked for, and features always.
#[test]
fn albedo_and_features_are_shown() {
    let world = format!("Material \"diffuse\" \"rgb reflectance\" [0.8 0.4 0.2] {WALL}");
    let setup = Setup { world: &world, film: "\"gbuffer\"", ..Setup::default() };
    let scene = occluded("albedo", &setup, &[("albedo", Value::Bools(vec![true]))]);
    let image = render_passes(&scene, 0..64).develop();
    for (name, expected, tolerance) in
        [("R", 0.8, 0.1), ("G", 0.4, 0.05), ("B", 0.2, 0.05), ("depth.Z", 5.0, 1e-4)]
    {
        let values = channel(&image, name);
        let mean = values.iter().sum::<f64>() / values.len() as f64;
        assert!((mean - expected).abs() <= tolerance, "{name}: {mean} instead of {expected}");
    }
}
