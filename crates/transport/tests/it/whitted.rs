//! Recursive ray tracing against closed forms and against the paths of the path tracer that it claims.

use std::f64::consts::PI;

use etendue_math::statistics::Moments;
use etendue_scene::Scene;
use etendue_scene::document::{Entity, Value};

use crate::support::{
    Setup, expect_mean, expect_near, flat, layer, lit, luminance, render_layers, render_passes,
};

/// A scene rendered by `whitted` to that depth.
fn recursive(name: &str, setup: &Setup<'_>, depth: i32) -> Scene {
    let mut scene = setup.scene(name);
    scene.integrator = Entity::new("whitted").with("maxdepth", Value::Integers(vec![depth]));
    scene
}

/// WHIT-1: a wall of reflectance a, lit by a point of intensity I at the distance r, shows a/pi I cos / r^2.
#[test]
fn light_falls_with_the_square_of_the_distance() {
    let albedo = 0.6;
    for (height, distance) in [(0.0_f64, 1.0_f64), (0.0, 2.0), (0.0, 5.0), (1.5, 2.0)] {
        let world = format!(
            "LightSource \"point\" {} \"point3 from\" [{height} 0 {}]
            Material \"diffuse\" {} Shape \"bilinearmesh\" \"point3 P\" [-9 -9 5  9 -9 5  -9 9 5  9 9 5]",
            lit("I", 3.0),
            5.0 - distance,
            flat("reflectance", albedo)
        );
        let camera = "Camera \"orthographic\" \"float screenwindow\" [-0.001 0.001 -0.001 0.001]";
        let setup = Setup { world: &world, camera, ..Setup::default() };
        let square = height * height + distance * distance;
        let expected = albedo / PI * 3.0 * distance / square.sqrt() / square;
        let found: Moments =
            luminance(&render_passes(&recursive("inverse square", &setup, 1), 0..16)).into_iter().collect();
        expect_mean(&format!("{height} beside, {distance} away"), &found, expected, 0.06);
    }
}

/// WHIT-1: what stands between a surface and the light makes it black, up to an edge where the light's line of sight is.
#[test]
fn shadows_have_their_edge_where_geometry_says() {
    let world = format!(
        "LightSource \"point\" {} \"point3 from\" [0 0 0]
        Shape \"bilinearmesh\" \"point3 P\" [0 -9 2  9 -9 2  0 9 2  9 9 2]
        Translate 0 0 4 Shape \"bilinearmesh\" \"point3 P\" [-9 -9 0  9 -9 0  -9 9 0  9 9 0]",
        lit("I", 1.0)
    );
    // Seen from behind, so that the thing in between hides nothing.
    let camera = "LookAt 0 0 3  0 0 4  0 1 0 Camera \"orthographic\" \"float screenwindow\" [-1 1 -1 1]";
    let setup = Setup { size: [16, 4], world: &world, camera, ..Setup::default() };
    let values = luminance(&render_passes(&recursive("edge", &setup, 1), 0..1));
    let lit: Vec<bool> = values[..16].iter().map(|value| *value > 0.0).collect();
    let n_lit = lit.iter().filter(|is_lit| **is_lit).count();
    assert_eq!(n_lit, 8, "{lit:?}");
    assert!(lit[..8].iter().all(|x| *x == lit[0]) && lit[8..].iter().all(|x| *x != lit[0]), "{lit:?}");
}

/// A wall at z from end to end.
fn wall(z: f32) -> String {
    format!("Shape \"bilinearmesh\" \"point3 P\" [-9 -9 {z}  9 -9 {z}  -9 9 {z}  9 9 {z}]")
}

/// WHIT-3: a lamp seen in a plane of glass has Fresnel's share of its radiance, 4 % at right angles, and what is behind
/// the glass the rest, for both of its ways through. Radiance that goes through grows by the square of the index on the eye's side
/// over that on the lamp's: the normal of a plane is +z, away from the eye, which is within the glass then.
#[test]
fn glass_mirrors_and_lets_pass_what_fresnel_says() {
    let lamp = |z: f32, l: f64| {
        let emit = lit("L", l);
        format!(
            "AttributeBegin AreaLightSource \"diffuse\" {emit} \"bool twosided\" true {} AttributeEnd",
            wall(z)
        )
    };
    let (before, behind) = (lamp(-1.0, 2.0), lamp(9.0, 1.0));
    let both = format!("{before} {behind}");
    let (eye_within, eye_outside) = (wall(5.0), format!("ReverseOrientation {}", wall(5.0)));
    let slab = format!("{} ReverseOrientation {}", wall(6.0), wall(5.0));
    let square = 1.5_f64.powi(2);
    let camera = "Camera \"orthographic\" \"float screenwindow\" [-1 1 -1 1]";
    for (name, lamps, glass, expected) in [
        ("mirrored from within", &before, &eye_within, 0.04 * 2.0),
        ("mirrored from outside", &before, &eye_outside, 0.04 * 2.0),
        ("through, from within", &behind, &eye_within, 0.96 * square),
        ("through, from outside", &behind, &eye_outside, 0.96 / square),
        ("both, from within", &both, &eye_within, 0.08 + 0.96 * square),
        ("both, from outside", &both, &eye_outside, 0.08 + 0.96 / square),
        ("through a slab", &behind, &slab, 0.96 * 0.96),
    ] {
        let world = format!("{lamps} Material \"dielectric\" \"float eta\" 1.5 {glass}");
        // By the same wavelengths, of which each pixel has but a few.
        let [lamp, found] = [&behind, &world].map(|world| {
            let setup = Setup { world, camera, ..Setup::default() };
            luminance(&render_passes(&recursive("glass", &setup, 2), 0..1))
        });
        for (lamp, found) in lamp.iter().zip(&found) {
            expect_near(name, found / lamp, expected, 1e-3);
        }
    }
}

/// EMI-14: a mirror shows the lamps and the sky that an artist lets reach it, and no others; the eye sees all.
#[test]
fn mirrors_show_the_lights_that_reach_them() {
    let emit = lit("L", 1.0);
    let lamp = format!(
        "AttributeBegin AreaLightSource \"diffuse\" {emit} \"string group\" \"key\" \"bool twosided\" true {} AttributeEnd",
        wall(-1.0)
    );
    let sky = format!("LightSource \"infinite\" {emit} \"string group\" \"key\"");
    let other = format!(
        "LightSource \"point\" \"point3 from\" [0 0 99] {} \"string group\" \"other\"",
        lit("I", 1e-6)
    );
    let camera = "Camera \"orthographic\" \"float screenwindow\" [-1 1 -1 1]";
    for (name, light) in [("lamp", &lamp), ("sky", &sky)] {
        let shown = ["key", "other"].map(|group| {
            let world = format!(
                "{light} {other} Material \"conductor\" {} \"string lights\" [ \"{group}\" ]",
                wall(5.0)
            );
            let setup = Setup { world: &world, camera, ..Setup::default() };
            luminance(&render_passes(&recursive(name, &setup, 2), 0..1))
        });
        assert!(shown[0].iter().all(|value| *value > 0.5), "{name}: {:?}", shown[0]);
        assert!(shown[1].iter().all(|value| *value == 0.0), "{name}: {:?}", shown[1]);
    }
    let setup = Setup { world: &sky, camera, ..Setup::default() };
    let seen = luminance(&render_passes(&recursive("sky alone", &setup, 2), 0..1));
    assert!(seen.iter().all(|value| *value > 0.5), "sky alone: {seen:?}");
}

/// WHIT-4: between two parallel mirrors a lamp is seen once, and once more for each reflection that the depth allows.
#[test]
fn parallel_mirrors_show_as_many_images_as_the_depth_allows() {
    let world = format!(
        "AttributeBegin AreaLightSource \"diffuse\" {} Translate 0 0.3 0
        Shape \"sphere\" \"float radius\" 0.01 AttributeEnd
        Material \"conductor\"
        Shape \"bilinearmesh\" \"point3 P\" [-9 -9 1  9 -9 1  -9 9 1  9 9 1]
        Shape \"bilinearmesh\" \"point3 P\" [-9 -9 -1  9 -9 -1  -9 9 -1  9 9 -1]",
        lit("L", 1.0)
    );
    // A column of pixels from the first image at 31 degrees upwards down to the axis, where infinitely many meet.
    let camera = "LookAt 0 0 -0.5  0 0 1  0 1 0
        Camera \"perspective\" \"float fov\" 90 \"float screenwindow\" [-0.001 0.001 0 1]";
    let setup = Setup { size: [1, 2000], world: &world, camera, ..Setup::default() };
    for depth in [0, 1, 2, 5] {
        let values = luminance(&render_passes(&recursive("mirrors", &setup, depth), 0..1));
        // Random places in pixels may leave gaps of one within an image.
        let is_end = |w: &&[f64]| w[0] > 0.0 && w[1] == 0.0 && w[2] == 0.0;
        let n_images = values.windows(3).filter(is_end).count();
        assert_eq!(n_images, depth as usize + 1, "depth {depth}");
    }
}

/// LPE-3: the image is what the path tracer finds along `LD?S*E`, and says so of itself.
#[test]
fn the_paths_are_those_claimed() {
    let world = format!(
        "AttributeBegin Material \"diffuse\" {}
        Shape \"bilinearmesh\" \"point3 P\" [-2 -1 -2  2 -1 -2  -2 -1 2  2 -1 2]
        Shape \"bilinearmesh\" \"point3 P\" [-2 -1 2  2 -1 2  -2 2 2  2 2 2] AttributeEnd
        AttributeBegin Translate -0.5 -0.5 0 Material \"dielectric\" Shape \"sphere\" \"float radius\" 0.4 AttributeEnd
        AttributeBegin Translate 0.5 -0.5 0.3 Material \"conductor\" Shape \"sphere\" \"float radius\" 0.4 AttributeEnd
        AttributeBegin AreaLightSource \"diffuse\" {} \"bool twosided\" true
        Shape \"bilinearmesh\" \"point3 P\" [-0.4 1 -0.4  0.4 1 -0.4  -0.4 1 0.4  0.4 1 0.4] AttributeEnd
        LightSource \"point\" {} \"point3 from\" [-0.5 1 -1]
        LightSource \"infinite\" {}",
        flat("reflectance", 0.6),
        lit("L", 4.0),
        lit("I", 2.0),
        lit("L", 0.1)
    );
    let camera = "LookAt 0 0.2 -3.5  0 0 0  0 1 0 Camera \"perspective\" \"float fov\" 42";
    let setup = Setup {
        size: [24, 24],
        integrator: "\"integer maxdepth\" 8",
        camera,
        world: &world,
        ..Setup::default()
    };
    let layers = [("claimed", "LD?S*E"), ("all", "L.*E")];
    let tree = render_layers(&recursive("claimed", &setup, 8), 0..64, &layers);
    for name in ["claimed", "all"] {
        let (image, layer) = (luminance(&tree), layer(&tree, name));
        assert!(image.iter().zip(&layer).all(|(a, b)| (a - b).abs() <= 1e-4 * a), "{name}");
    }
    let paths = render_layers(&setup.scene("claimed by path"), 0..400, &layers);
    // Pixels differ, so that each is compared with itself.
    let difference: Moments =
        luminance(&tree).iter().zip(layer(&paths, "claimed")).map(|(a, b)| a - b).collect();
    let mean = luminance(&tree).iter().sum::<f64>() / 576.0;
    assert!(5.0 * difference.standard_error() < 0.05 * mean, "{} of {mean}", difference.standard_error());
    assert!(difference.mean().abs() < 5.0 * difference.standard_error(), "{}", difference.mean() / mean);
}
