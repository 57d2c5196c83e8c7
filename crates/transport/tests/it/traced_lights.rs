//! Light tracing against path tracing: lights with pictures and tables, and cameras that stand in a medium.

use std::path::PathBuf;

use etendue_scene::document::{Entity, Value};

use crate::light_tracing::{THINGS, check_with, pinhole};
use crate::pictures::picture;
use crate::support::{Setup, expect_near, lit, luminance, render_passes};

#[track_caller]
fn check(name: &str, world: &str, n_passes: u64) {
    check_with(name, &Setup { camera: &pinhole(), world, ..Setup::default() }, 4, n_passes, 0.25);
}

/// A lamp whose intensity falls to a quarter from below to above, as a file.
fn luminaire() -> PathBuf {
    let path = PathBuf::from(env!("CARGO_TARGET_TMPDIR")).join("traced.ies");
    let text = "IESNA91\nTILT=NONE\n1 -1 1 3 1 1 2 0 0 0\n1 1 50\n0 90 180\n0\n80 50 20\n";
    std::fs::write(&path, text).expect("the folder of the tests can be written");
    path
}

/// Lights that shine by a picture or a table send photons by it.
#[test]
fn lights_with_pictures_agree() {
    let lights = [
        (
            "table",
            format!(
                "Translate 0.4 0.8 -0.7 LightSource \"ies\" \"string filename\" \"{}\"",
                luminaire().display()
            ),
        ),
        (
            "goniometer",
            format!(
                "Translate 0.4 0.8 -0.7 Rotate 70 1 2 3 LightSource \"goniometric\" \"string filename\" \"{}\"",
                picture("traced_gonio.pfm", 16).display()
            ),
        ),
        (
            "projector",
            format!(
                "Translate 0.2 0.9 -1 Rotate 50 1 0 0 LightSource \"projection\" \"float fov\" 60 \"string filename\" \"{}\"",
                picture("traced_slide.pfm", 16).display()
            ),
        ),
        (
            "picture of the sky",
            format!(
                "Rotate 40 1 2 3 LightSource \"infinite\" \"string filename\" \"{}\"",
                picture("traced_sky.pfm", 16).display()
            ),
        ),
        (
            "portal",
            format!(
                "LightSource \"infinite\" \"string filename\" \"{}\" \"point3 portal\" [-1 1.2 -1  1 1.2 -1  1 1.2 1  -1 1.2 1]",
                picture("traced_portal.pfm", 16).display()
            ),
        ),
    ];
    for (name, light) in lights {
        check(&format!("light from {name}"), &format!("{THINGS}\nAttributeBegin {light} AttributeEnd"), 96);
    }
}

/// Water that only absorbs, around lamp, things and camera: the ways from the lamp and to the camera are both dimmed.
#[test]
fn cameras_under_water_agree() {
    let world = format!(
        "{THINGS} AttributeBegin AreaLightSource \"diffuse\" {} Translate 0 0.99 0 Rotate 90 1 0 0 Shape \"disk\" \"float radius\" 0.6
        AttributeEnd Material \"dielectric\" \"float eta\" 1 \"spectrum absorption\" [400 0.3 550 0.1 700 0.2] Shape \"sphere\" \"float radius\" 9",
        lit("L", 6.0)
    );
    check("camera under water", &world, 32);
}

/// A lamp 3 m in front of a camera in a medium of 0.1 / m, by every method: in a ball, under an open surface, and above one.
#[test]
fn the_camera_knows_what_it_stands_in() {
    let level = |z: f64| {
        format!("Shape \"bilinearmesh\" \"point3 P\" [-50 -50 {z}  50 -50 {z}  -50 50 {z}  50 50 {z}]")
    };
    let waters = [
        ("ball", "Shape \"sphere\" \"float radius\" 8".to_owned(), 3.0),
        (
            "shell",
            "Shape \"sphere\" \"float radius\" 8 ReverseOrientation Shape \"sphere\" \"float radius\" 1"
                .to_owned(),
            2.0,
        ),
        ("under a surface", level(2.0), 3.0),
        ("above a surface", level(-1.0), 2.0),
        ("outside", "Translate 20 0 0 Shape \"sphere\" \"float radius\" 2".to_owned(), 0.0),
    ];
    for (name, water, way) in waters {
        let camera = "LookAt 0 0 0  0 0 -1  0 1 0 Camera \"orthographic\" \"float screenwindow\" [-0.01 0.01 -0.01 0.01]";
        for method in ["path", "whitted", "light", "photonmap", "sppm"] {
            // By the same wavelengths, of which each pixel has but a few.
            let [clear, dim] = [0.0, 0.1].map(|absorption| {
                let world = format!(
                    "AttributeBegin AreaLightSource \"diffuse\" {} \"bool twosided\" true {} AttributeEnd
                    Material \"dielectric\" \"float eta\" 1 \"float absorption\" {absorption} {water}",
                    lit("L", 2.0),
                    level(-3.0)
                );
                let setup = Setup { size: [2, 2], camera, world: &world, ..Setup::default() };
                let mut scene = setup.scene(name);
                scene.integrator = Entity::new(method).with("maxdepth", Value::Integers(vec![4]));
                if method == "light" {
                    scene.integrator = scene.integrator.with("mirrors", Value::Bools(vec![true]));
                }
                luminance(&render_passes(&scene, 0..1))
            });
            for (clear, dim) in clear.iter().zip(&dim) {
                expect_near(&format!("{name} by {method}"), dim / clear, (-0.1_f64 * way).exp(), 1e-3);
            }
        }
    }
}

/// The depth limit decides how many paths a task follows, and paths that end before it bring the same bits.
#[test]
fn tasks_of_any_size_add_up_alike() {
    let world = format!("{THINGS} LightSource \"point\" {} \"point3 from\" [0.4 0.8 -0.7]", lit("I", 2.0));
    let setup = Setup { size: [40, 40], camera: &pinhole(), world: &world, ..Setup::default() };
    let film = |depth: i32| {
        let mut scene = setup.scene("tasks");
        scene.integrator = Entity::new("light").with("maxdepth", Value::Integers(vec![depth]));
        render_passes(&scene, 0..2)
    };
    let few = film(200);
    assert_eq!(film(60_000).sums(), few.sums());
}
