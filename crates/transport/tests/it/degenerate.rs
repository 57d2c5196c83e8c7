//! Scenes at the edge of sense: all finite, none crashes.

use crate::support::{Setup, flat, lit, luminance, render_passes};

fn render(name: &str, world: &str, integrator: &str) -> Vec<f64> {
    let camera = "LookAt 0 0 -3  0 0 0  0 1 0 Camera \"perspective\" \"float fov\" 50";
    let setup = Setup { size: [12, 12], integrator, camera, world, ..Setup::default() };
    let values = luminance(&render_passes(&setup.scene(name), 0..8));
    assert!(values.iter().all(|v| v.is_finite() && *v >= 0.0), "{name}");
    values
}

fn is_black(values: &[f64]) -> bool {
    values.iter().all(|v| *v == 0.0)
}

/// No light, no image; nor from lights without power.
#[test]
fn darkness() {
    assert!(is_black(&render("nothing", "", "")));
    assert!(is_black(&render("no light", "Shape \"sphere\"", "")));
    let dim = [
        format!("LightSource \"point\" {}", lit("I", 0.0)),
        format!("LightSource \"infinite\" {}", flat("L", 0.0)),
        format!("LightSource \"distant\" {}", lit("L", 0.0)),
        format!("AreaLightSource \"diffuse\" {}", lit("L", 0.0)),
    ];
    for light in dim {
        for sampler in ["uniform", "power", "bvh"] {
            let integrator = format!("\"string lightsampler\" \"{sampler}\"");
            let world = format!("{light} Material \"diffuse\" Shape \"sphere\" \"float radius\" 1");
            assert!(is_black(&render(&light, &world, &integrator)), "{light}");
        }
    }
}

/// A light of no power beside a strong one changes nothing.
#[test]
fn dead_lights_do_not_matter() {
    let bright = format!("Shape \"sphere\" LightSource \"point\" {} \"point3 from\" [2 2 -3]", lit("I", 5.0));
    let dead = format!("LightSource \"point\" {} \"point3 from\" [0 0 -2]", lit("I", 0.0));
    let with = format!("{bright} {dead}");
    for sampler in ["power", "bvh"] {
        let integrator = format!("\"integer maxdepth\" 1 \"string lightsampler\" \"{sampler}\"");
        let (a, b) = (render("dead", &bright, &integrator), render("dead", &with, &integrator));
        assert_eq!(a, b, "{sampler}");
        assert!(!is_black(&a));
    }
}

/// Triangles without area, doubled vertices, and needles neither hang nor spoil the image, emitting or not.
#[test]
fn triangles_without_area() {
    let flat_triangles = "Shape \"trianglemesh\" \"integer indices\" [0 1 2  0 0 1  3 3 3  0 4 1]
        \"point3 P\" [-1 0 0  0 0 0  1 0 0  0 1 0  1e-30 1e-30 0]";
    let sky = format!("LightSource \"infinite\" {}", lit("L", 1.0));
    let plain = render("sliver", &format!("{sky} {flat_triangles} Shape \"sphere\""), "");
    assert!(!is_black(&plain));
    let glowing = format!("{sky} AreaLightSource \"diffuse\" {} {flat_triangles}", lit("L", 1.0));
    for sampler in ["uniform", "power", "bvh"] {
        render("glowing sliver", &glowing, &format!("\"string lightsampler\" \"{sampler}\""));
    }
}

/// From within a mesh, within glass, on a surface, and with lights in the same place as surfaces.
#[test]
fn awkward_places() {
    let sky = format!("LightSource \"infinite\" {}", lit("L", 1.0));
    let cube = "Shape \"bilinearmesh\" \"point3 P\" [-1 -1 -1  1 -1 -1  -1 1 -1  1 1 -1  -1 -1 1  1 -1 1  -1 1 1  1 1 1]
        \"integer indices\" [0 1 2 3  4 5 6 7  0 1 4 5  2 3 6 7  0 2 4 6  1 3 5 7]";
    let inside = format!("{sky} AttributeBegin Scale 5 5 5 {cube} AttributeEnd");
    assert!(is_black(&render("in a closed box", &inside, "")));
    let glass = format!("{sky} Material \"dielectric\" Scale 5 5 5 {cube}");
    assert!(!is_black(&render("in glass", &glass, "\"integer maxdepth\" 20")));
    let touching = format!("{sky} Shape \"sphere\" \"float radius\" 3");
    render("on a sphere", &touching, "");
    let at_surface =
        format!("Shape \"sphere\" LightSource \"point\" {} \"point3 from\" [0 0 -1]", lit("I", 1.0));
    render("lamp on a surface", &at_surface, "");
    let twins = format!(
        "AreaLightSource \"diffuse\" {} Shape \"sphere\" Shape \"sphere\" Material \"dielectric\" Shape \"sphere\"",
        lit("L", 1.0)
    );
    render("three spheres in one place", &twins, "\"integer maxdepth\" 20");
}

/// Extreme materials: index 1, grazing coats, roughness of zero and of one, reflectance beyond one is at least finite.
#[test]
fn extreme_materials() {
    let sky = format!("LightSource \"infinite\" {}", lit("L", 1.0));
    let materials = [
        "\"dielectric\" \"float eta\" 1",
        "\"dielectric\" \"float eta\" 1 \"float roughness\" 0.5",
        "\"dielectric\" \"float eta\" 1.0001",
        "\"dielectric\" \"float eta\" 10 \"float roughness\" 1",
        "\"conductor\" \"float roughness\" 1e-6 \"bool remaproughness\" false",
        "\"conductor\" \"float uroughness\" 0.001 \"float vroughness\" 1",
        "\"coateddiffuse\" \"float roughness\" 0 \"float thickness\" 10",
        "\"coatedconductor\" \"float interface.roughness\" 0 \"float thickness\" 0.001",
        "\"diffusetransmission\"",
    ];
    for material in materials {
        let world =
            format!("{sky} Material {material} Shape \"sphere\" Translate 0.5 0 0 Shape \"cylinder\"");
        for integrator in ["\"integer maxdepth\" 20", "\"integer maxdepth\" 20 \"bool regularize\" true"] {
            assert!(!is_black(&render(material, &world, integrator)), "{material}");
        }
    }
}

/// Tiny and huge scenes render as those of human size do.
#[test]
fn scale_does_not_matter() {
    let image = |scale: f64| {
        let camera =
            format!("LookAt 0 0 {}  0 0 0  0 1 0 Camera \"perspective\" \"float fov\" 50", -3.0 * scale);
        let world = format!(
            "LightSource \"infinite\" {} Scale {scale} {scale} {scale} Shape \"sphere\"
            AreaLightSource \"diffuse\" {} Translate 0 2 0 Shape \"sphere\" \"float radius\" 0.5",
            lit("L", 0.2),
            lit("L", 3.0)
        );
        let setup = Setup { size: [12, 12], camera: &camera, world: &world, ..Setup::default() };
        luminance(&setup.film("scale", 16))
    };
    let human = image(1.0);
    for scale in [1e-4, 1e4] {
        let other = image(scale);
        let total = |v: &[f64]| v.iter().sum::<f64>();
        crate::support::expect_near(&format!("scale {scale}"), total(&other), total(&human), 1e-3);
    }
}

/// SPEC GEO-8: no light leaks into a closed room, through corners, edges or surfaces; lamps outside do not reach inside
/// either. Far from the origin coordinates have fewer digits, and a point beside an edge may come to lie outside: 1000 rooms
/// away a thousandth of the light may leak.
#[test]
fn closed_rooms_stay_dark() {
    let cube = |mesh: &str, indices: &str| {
        format!(
            "Shape \"{mesh}\" \"integer indices\" [{indices}]
            \"point3 P\" [-1 -1 -1  1 -1 -1  -1 1 -1  1 1 -1  -1 -1 1  1 -1 1  -1 1 1  1 1 1]"
        )
    };
    let rooms = [
        cube("bilinearmesh", "0 1 2 3  4 5 6 7  0 1 4 5  2 3 6 7  0 2 4 6  1 3 5 7"),
        cube(
            "trianglemesh",
            "0 1 2  1 2 3  4 5 6  5 6 7  0 1 4  1 4 5  2 3 6  3 6 7  0 2 4  2 4 6  1 3 5  3 5 7",
        ),
        "Shape \"sphere\"".to_owned(),
    ];
    for room in rooms {
        for ([x, y, z], most) in [([0.0, 0.0, 0.0], 0.0), ([0.7, 1000.3, -2000.1], 1e-3)] {
            let world = format!(
                "LightSource \"infinite\" {} LightSource \"distant\" {}
                AttributeBegin Translate {x} {y} {z} LightSource \"point\" {} \"point3 from\" [1.5 2 3]
                Rotate 20 1 2 3 Material \"diffuse\" {} {room} AttributeEnd",
                lit("L", 1.0),
                lit("L", 1.0),
                lit("I", 1.0),
                flat("reflectance", 0.9)
            );
            let camera = format!(
                "LookAt {x} {y} {z}  {} {y} {z}  0 1 0 Camera \"spherical\" \"string mapping\" \"equalarea\"",
                x + 1.0
            );
            let setup = Setup { size: [32, 32], camera: &camera, world: &world, ..Setup::default() };
            let values = luminance(&render_passes(&setup.scene("dark room"), 0..16));
            let mean = values.iter().sum::<f64>() / values.len() as f64;
            assert!(mean <= most, "{mean} leaks into {room} at {x}, {y}, {z}");
        }
    }
}

/// Meshes with normals and texture coordinates that make no sense are finite still.
#[test]
fn senseless_vertex_data() {
    let sky = format!("LightSource \"infinite\" {}", lit("L", 1.0));
    let lamp = format!("LightSource \"point\" {} \"point3 from\" [1 1 -2]", lit("I", 1.0));
    for data in [
        "\"normal N\" [0 0 0  0 0 0  0 0 0]",
        "\"normal N\" [0 0 1  0 0 -1  0 0 1]",
        "\"normal N\" [1 0 0  -1 0 0  0 1 0]",
        "\"normal N\" [1e-30 0 0  0 1e30 0  0 0 1]",
        "\"point2 uv\" [0.5 0.5  0.5 0.5  0.5 0.5]",
        "\"point2 uv\" [0 0  1e30 0  0 1e-30]",
        "\"vector S\" [0 0 0  0 0 0  0 0 1]",
    ] {
        for material in
            ["\"diffuse\"", "\"dielectric\"", "\"conductor\" \"float roughness\" 0.3", "\"coateddiffuse\""]
        {
            for emission in [String::new(), format!("AreaLightSource \"diffuse\" {}", lit("L", 1.0))] {
                let world = format!(
                    "{sky} {lamp} Texture \"t\" \"spectrum\" \"checkerboard\" Material {material} {emission}
                    Shape \"trianglemesh\" \"point3 P\" [-1 -1 0  1 -1 0  0 1 0.2] {data}
                    Translate 0 0.5 0.5 Material \"diffuse\" \"texture reflectance\" \"t\"
                    Shape \"trianglemesh\" \"point3 P\" [-1 -1 0  1 -1 0  0 1 0.2] {data}"
                );
                assert!(!is_black(&render(data, &world, "\"integer maxdepth\" 4")));
            }
        }
    }
}
