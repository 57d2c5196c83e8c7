//! What rays meet: cut-outs, interfaces, instances, and widened lobes.

use etendue_math::statistics::Moments;

use crate::support::{
    Setup, expect_equal_pixels, expect_mean, flat, lit, luminance, pixel_moments, render_passes,
};

const CAMERA: &str = "LookAt 0 0 -3  0 0 0  0 1 0 Camera \"perspective\" \"float fov\" 30";

/// A black sheet of alpha a before a sky of 1 lets the share 1 - a through; so do n sheets, (1 - a)^n.
#[test]
fn cutouts_let_their_share_through() {
    let sheet = |z: f64, alpha: f64| {
        format!(
            "Shape \"bilinearmesh\" \"float alpha\" {alpha} \"point3 P\" [-5 -5 {z}  5 -5 {z}  -5 5 {z}  5 5 {z}]\n"
        )
    };
    for (alpha, n_sheets) in [(0.5_f64, 1), (0.25, 1), (0.5, 2), (0.0, 1)] {
        let sheets: String = (0..n_sheets).map(|i| sheet(0.5 * f64::from(i), alpha)).collect();
        let world = format!(
            "LightSource \"infinite\" {} Material \"diffuse\" {} {sheets}",
            lit("L", 1.0),
            flat("reflectance", 0.0)
        );
        let setup = Setup { size: [32, 32], camera: CAMERA, world: &world, ..Setup::default() };
        let name = format!("{n_sheets} sheets of alpha {alpha}");
        let moments = pixel_moments(&setup.film(&name, 64));
        expect_mean(&name, &moments, (1.0 - alpha).powi(n_sheets), 0.05);
    }
}

/// The same sheet dims a lamp: shadow rays are let through by the same share, and paths that light it by chance too.
#[test]
fn cutouts_cast_their_shadow() {
    let render = |sheet: &str, lights: &str| {
        let world = format!(
            "LightSource \"distant\" {} \"point3 from\" [0 0 1] \"point3 to\" [0 0 0] LightSource \"infinite\" {}
            Material \"diffuse\" {} Shape \"bilinearmesh\" \"point3 P\" [-50 -50 0  50 -50 0  -50 50 0  50 50 0]
            Material \"diffuse\" {} {sheet}",
            lit("L", 1.0),
            lit("L", 0.5),
            flat("reflectance", 0.8),
            flat("reflectance", 0.0)
        );
        let camera = "LookAt 0 0 0.1  0 0 0  0 1 0 Camera \"orthographic\"";
        let integrator = format!("\"integer maxdepth\" 1 \"string lights\" \"{lights}\"");
        let setup =
            Setup { size: [16, 16], integrator: &integrator, camera, world: &world, ..Setup::default() };
        pixel_moments(&setup.film(&format!("shadow of {sheet} by {lights}"), 128))
    };
    let sheet =
        "Shape \"bilinearmesh\" \"float alpha\" 0.4 \"point3 P\" [-90 -90 1  90 -90 1  -90 90 1  90 90 1]";
    for lights in ["both", "lights"] {
        // rho / pi times the illuminances 1 and pi / 2. The edge of the sheet leaves out a ten-thousandth of the sky.
        let open = 0.8 / std::f64::consts::PI * (1.0 + std::f64::consts::FRAC_PI_2);
        expect_mean("open", &render("", lights), open, 0.03);
        expect_mean("below the sheet", &render(sheet, lights), 0.6 * open, 0.05);
    }
}

/// A texture of alpha cuts holes where it is 0: half of a chequered sheet is gone, in camera and in shadow rays.
#[test]
fn textured_cutouts() {
    let world = format!(
        "LightSource \"infinite\" {} Material \"diffuse\" {}
        Texture \"holes\" \"float\" \"checkerboard\" \"float uscale\" 8 \"float vscale\" 8 \"float tex1\" 1 \"float tex2\" 0
        Shape \"bilinearmesh\" \"texture alpha\" \"holes\" \"point3 P\" [-1 -1 0  1 -1 0  -1 1 0  1 1 0]",
        lit("L", 1.0),
        flat("reflectance", 0.0)
    );
    let camera = "LookAt 0 0 -3  0 0 0  0 1 0 Camera \"orthographic\" \"float screenwindow\" [-1 1 -1 1]";
    let setup = Setup { size: [8, 8], camera, world: &world, ..Setup::default() };
    let film = setup.film("chequered sheet", 64);
    let values = luminance(&film);
    for (index, value) in values.iter().enumerate() {
        let neighbour = values[index ^ 1];
        assert!((*value == 0.0) != (neighbour == 0.0), "{values:?}");
    }
}

/// An interface is no obstacle: with a box of it around ball, lamp or camera, the image is the same but for rounding.
#[test]
fn interfaces_are_transparent() {
    let image = |interfaces: &str| {
        let world = format!(
            "Material \"diffuse\" {} Shape \"sphere\" Shape \"bilinearmesh\" \"point3 P\" [-9 -1 -9  9 -1 -9  -9 -1 9  9 -1 9]
            LightSource \"infinite\" {}
            LightSource \"point\" {} \"point3 from\" [1 2 -2]
            AttributeBegin Translate -1 2 -1 AreaLightSource \"diffuse\" {} Shape \"sphere\" \"float radius\" 0.3 AttributeEnd
            {interfaces}",
            flat("reflectance", 0.7),
            lit("L", 0.2),
            lit("I", 1.0),
            lit("L", 4.0)
        );
        let camera = "LookAt 0 1 -5  0 0 0  0 1 0 Camera \"perspective\" \"float fov\" 40";
        let setup = Setup { size: [24, 24], camera, world: &world, ..Setup::default() };
        luminance(&render_passes(&setup.scene("interfaces"), 0..16))
    };
    let plain = image("");
    let shells = "Material \"interface\"
        Shape \"sphere\" \"float radius\" 1.3
        AttributeBegin Translate -1 2 -1 Shape \"sphere\" \"float radius\" 0.6 AttributeEnd
        AttributeBegin Translate 0 1 -5 Shape \"sphere\" \"float radius\" 0.2 AttributeEnd";
    expect_equal_pixels("interfaces", &image(shells), &plain, 2e-2);
    let (a, b): (Moments, Moments) = (plain.into_iter().collect(), image(shells).into_iter().collect());
    crate::support::expect_near("interfaces", b.mean(), a.mean(), 1e-3);
}

/// GEO-10: instances look like copies.
#[test]
fn instances_look_like_copies() {
    let object = "Material \"diffuse\" \"rgb reflectance\" [0.8 0.4 0.2] Shape \"sphere\" \"float radius\" 0.5
        Translate 0.4 0.3 0 Material \"conductor\" Shape \"trianglemesh\" \"point3 P\" [-0.5 0 0  0.5 0 0  0 1 0.3]";
    let places = [
        "Translate -1 -0.2 0",
        "Translate 1 0 0.5 Rotate 70 0 1 0 Scale 0.7 1.2 0.7",
        "Translate 0 0.8 1 Rotate 30 1 1 0 Scale -1 1 1",
    ];
    let image = |objects: String| {
        let world = format!(
            "LightSource \"infinite\" {} LightSource \"point\" {} \"point3 from\" [2 3 -4]
            Shape \"bilinearmesh\" \"point3 P\" [-9 -1 -9  9 -1 -9  -9 -1 9  9 -1 9] {objects}",
            lit("L", 0.3),
            lit("I", 10.0)
        );
        let camera = "LookAt 0 0.5 -5  0 0 0  0 1 0 Camera \"perspective\" \"float fov\" 45";
        let setup = Setup { size: [32, 32], camera, world: &world, ..Setup::default() };
        luminance(&render_passes(&setup.scene("instances"), 0..16))
    };
    let instances: String = places
        .iter()
        .map(|p| format!("AttributeBegin {p} ObjectInstance \"thing\" AttributeEnd\n"))
        .collect();
    let copies: String =
        places.iter().map(|p| format!("AttributeBegin {p} {object} AttributeEnd\n")).collect();
    let instanced = image(format!("ObjectBegin \"thing\" {object} ObjectEnd {instances}"));
    let copied = image(copies);
    let close = |a: &f64, b: &f64| (a - b).abs() <= 1e-3 * b.abs();
    let different = instanced.iter().zip(&copied).filter(|(a, b)| !close(a, b)).count();
    // Where rounding decides whether a ray meets an edge, a path goes another way.
    assert!(different <= 20, "{different} pixels differ");
    let mean = |v: &[f64]| v.iter().sum::<f64>() / v.len() as f64;
    crate::support::expect_near("instances", mean(&instanced), mean(&copied), 2e-3);
}

/// Widened lobes keep images finite and calm: less variance of a caustic, and energy that stays near the truth.
#[test]
fn regularization_calms_caustics() {
    let render = |regularize: bool| {
        let world = format!(
            "Material \"diffuse\" {} Shape \"bilinearmesh\" \"point3 P\" [-5 -1 -5  5 -1 -5  -5 -1 5  5 -1 5]
            AttributeBegin Material \"dielectric\" Translate 0 0 0 Shape \"sphere\" \"float radius\" 0.6 AttributeEnd
            AttributeBegin Translate 0.5 3 0 AreaLightSource \"diffuse\" {} Shape \"sphere\" \"float radius\" 0.1 AttributeEnd",
            flat("reflectance", 0.7),
            lit("L", 100.0)
        );
        let integrator = format!("\"integer maxdepth\" 6 \"bool regularize\" {regularize}");
        let camera = "LookAt 0 1 -4  0 -0.5 0  0 1 0 Camera \"perspective\" \"float fov\" 40";
        let setup =
            Setup { size: [24, 24], integrator: &integrator, camera, world: &world, ..Setup::default() };
        crate::support::block_moments(&setup.scene("regularize"), 200, 1).remove(1)
    };
    let (plain, calm) = (render(false), render(true));
    assert!(calm.variance() < 0.5 * plain.variance(), "{plain:?} {calm:?}");
    assert!((calm.mean() / plain.mean() - 1.0).abs() < 0.5);
}

/// A light with holes: a sheet of alpha a sends out the share a of its light, whether it is sampled or met by chance, and lets
/// the share 1 - a of the light behind it pass.
#[test]
fn lights_with_holes() {
    let render = |alpha: f64, lights: &str, n_passes: u64| {
        let world = format!(
            "AttributeBegin Material \"diffuse\" {} Shape \"bilinearmesh\" \"point3 P\" [-9 -9 0  9 -9 0  -9 9 0  9 9 0] AttributeEnd
            AttributeBegin Material \"diffuse\" {} AreaLightSource \"diffuse\" {} \"bool twosided\" true
            Shape \"bilinearmesh\" \"float alpha\" {alpha} \"point3 P\" [-1 -1 1  1 -1 1  -1 1 1  1 1 1] AttributeEnd
            AttributeBegin Material \"diffuse\" {} AreaLightSource \"diffuse\" {} \"bool twosided\" true
            Shape \"bilinearmesh\" \"point3 P\" [-1 -1 2  1 -1 2  -1 1 2  1 1 2] AttributeEnd",
            flat("reflectance", 0.5),
            flat("reflectance", 0.0),
            lit("L", 1.0),
            flat("reflectance", 0.0),
            lit("L", 3.0)
        );
        let integrator = format!("\"integer maxdepth\" 1 \"string lights\" \"{lights}\"");
        let camera =
            "LookAt 0 0 0.1  0 0 0  0 1 0 Camera \"orthographic\" \"float screenwindow\" [-0.1 0.1 -0.1 0.1]";
        let setup =
            Setup { size: [16, 16], integrator: &integrator, camera, world: &world, ..Setup::default() };
        pixel_moments(&setup.film(&format!("holes of {alpha} by {lights}"), n_passes))
    };
    let square = |h: f64| {
        crate::radiometry::polygon_irradiance(
            0.0,
            0.0,
            &[[-1.0, -1.0, h], [1.0, -1.0, h], [1.0, 1.0, h], [-1.0, 1.0, h]],
        )
    };
    // From the middle of the floor the far sheet hides behind the near one.
    for alpha in [0.5, 0.2, 1.0] {
        let irradiance = alpha * square(1.0) + (1.0 - alpha) * 3.0 * square(2.0);
        for (lights, n_passes) in [("both", 128), ("lights", 128), ("scattering", 256)] {
            let expected = 0.5 / std::f64::consts::PI * irradiance;
            expect_mean(
                &format!("alpha {alpha} by {lights}"),
                &render(alpha, lights, n_passes),
                expected,
                0.06,
            );
        }
    }
}

/// A dark sheet moves over a bright background, from x = -0.8 to x = 0.8 during the exposure. A point x is covered for the
/// share (x + 0.8) / 1.6 of it, in the picture and, under parallel light, in the shadow on the wall behind.
#[test]
fn moving_sheets_blur() {
    let sheet = format!(
        "ObjectBegin \"sheet\" Material \"diffuse\" {} Shape \"bilinearmesh\" \"point3 P\" [-9 -9 0  0 -9 0  -9 9 0  0 9 0] ObjectEnd
        AttributeBegin ActiveTransform StartTime Translate 0.8 0 0 ActiveTransform EndTime Translate -0.8 0 0
        ActiveTransform All ObjectInstance \"sheet\" AttributeEnd",
        flat("reflectance", 0.0)
    );
    let camera_at = |z: f64| {
        format!(
            "TransformTimes 0 1 Scale -1 1 1 LookAt 0 0 {z}  0 0 -9  0 1 0
            Camera \"orthographic\" \"float screenwindow\" [-1 1 -1 1] \"float shutteropen\" 0 \"float shutterclose\" 1"
        )
    };
    // The camera before the sheet sees the sky behind it; between sheet and wall it sees the wall, lit from behind the camera.
    let sky = format!("LightSource \"infinite\" {} {sheet}", lit("L", 1.0));
    let wall = format!(
        "LightSource \"distant\" {} \"point3 from\" [0 0 1] \"point3 to\" [0 0 0] {sheet}
        Material \"diffuse\" {} Shape \"bilinearmesh\" \"point3 P\" [-9 -9 -1  9 -9 -1  -9 9 -1  9 9 -1]",
        lit("L", std::f64::consts::PI),
        flat("reflectance", 1.0)
    );
    for (what, world, z) in [("picture", &sky, 5.0), ("shadow", &wall, -0.5)] {
        let camera = camera_at(z);
        let setup = Setup {
            size: [20, 8],
            sampler: "\"sobol\"",
            camera: &camera,
            integrator: "\"integer maxdepth\" 1",
            world,
            ..Setup::default()
        };
        let values = luminance(&setup.film(what, 256));
        for column in 0..20 {
            let seen: Moments = (0..8).map(|row| values[20 * row + column]).collect();
            let x = (column as f64 + 0.5) / 10.0 - 1.0;
            // Uncovered while the edge is left of x.
            let expected = 1.0 - ((0.8 - x) / 1.6).clamp(0.0, 1.0);
            let difference = (seen.mean() - expected).abs();
            assert!(difference < 0.03, "{what}, column {column}: {} instead of {expected}", seen.mean());
        }
    }
}

/// A path that may not scatter any more still passes a mixture of interfaces, and finds the light behind it.
#[test]
fn mixtures_of_interfaces_let_the_last_segment_pass() {
    let seen_under = |sheet: &str| {
        let world = format!(
            "LightSource \"infinite\" {} MakeNamedMaterial \"nothing\" \"string type\" \"interface\" {sheet}
            Material \"diffuse\" Shape \"disk\" \"float radius\" 5",
            lit("L", 1.0)
        );
        let setup = Setup {
            integrator: "\"integer maxdepth\" 1 \"string lights\" \"scattering\"",
            camera: "LookAt 0 0 1  0.2 0 0  0 1 0 Camera \"perspective\" \"float fov\" 40",
            world: &world,
            ..Setup::default()
        };
        luminance(&setup.film("a sheet of nothing", 16))
    };
    let sheet = "Material \"mix\" \"string materials\" [\"nothing\" \"nothing\"] \"float amount\" 0.5
        AttributeBegin Translate 0 0 2 Shape \"disk\" \"float radius\" 50 AttributeEnd";
    let open = seen_under("");
    assert!(open.iter().all(|value| *value > 0.4));
    expect_equal_pixels("under a sheet", &seen_under(sheet), &open, 1e-4);
}

/// SPEC BRDF-10: with the lights off the ambient term is a constant image, however deep paths go, and other surfaces are not
/// lit by it; with a light on it is added to what is reflected.
#[test]
fn the_ambient_term_is_for_the_eye_alone() {
    let ambient = "Material \"phong\" \"rgb ambient\" [0.3 0.3 0.3]";
    let inside = format!("{ambient} ReverseOrientation Shape \"sphere\" \"float radius\" 1");
    let camera = "LookAt 0 0 -0.5  0 0 1  0 1 0 Camera \"perspective\" \"float fov\" 60";
    let integrator = "\"integer maxdepth\" 6";
    let alone = Setup { integrator, camera, world: &inside, ..Setup::default() };
    expect_mean("ambient alone", &pixel_moments(&alone.film("ambient", 64)), 0.3, 0.02);
    // A ball with the term in a white room without: behind it is nothing to see.
    let world = format!(
        "Material \"diffuse\" \"float reflectance\" 1 ReverseOrientation Shape \"sphere\" \"float radius\" 1
        AttributeBegin {ambient} Translate -0.6 0 0.3 Shape \"sphere\" \"float radius\" 0.2 AttributeEnd"
    );
    let lit_by_none = Setup { integrator, camera, world: &world, ..Setup::default() };
    let values = luminance(&lit_by_none.film("ambient ball", 16));
    let n_dark = values.iter().filter(|v| **v == 0.0).count();
    assert!(
        n_dark > values.len() / 2 && n_dark < values.len(),
        "{n_dark} of {} pixels are dark",
        values.len()
    );
    let lamp = format!("LightSource \"infinite\" {}", lit("L", 1.0));
    let ball = |ambient: &str| {
        let material = format!("Material \"phong\" {ambient} \"float kd\" 0.5 \"float ks\" 0");
        let world = format!("{lamp} {material} Shape \"sphere\" \"float radius\" 4");
        let camera = "LookAt 0 0 -5  0 0 0  0 1 0 Camera \"perspective\" \"float fov\" 10";
        pixel_moments(
            &Setup { integrator, camera, world: &world, ..Setup::default() }.film("ambient and light", 128),
        )
    };
    expect_mean("both", &ball("\"rgb ambient\" [0.3 0.3 0.3]"), 0.8, 0.02);
    expect_mean("light alone", &ball(""), 0.5, 0.02);
}
