//! Closed rooms that glow, and objects in a uniform sky: the image is known at once (SPEC EQ-1, SCENE-37).
//!
//! In a closed room whose walls emit radiance 1 and reflect a share a diffusely, each point sees
//! `L = 1 + a + a^2 + ... = 1 / (1 - a)` in all directions.

use etendue_math::statistics::Moments;
use etendue_math::{Rng, Vector3};
use etendue_scene::bsdf::microfacet::Microfacets;
use etendue_scene::bsdf::{Dielectric, Lobes, TransportMode};

use crate::support::{
    Setup, Z, expect_agreement, expect_equal_pixels, expect_mean, flat, lit, luminance, pixel_moments,
    render_passes, seed,
};

/// A sphere of radius 1 that glows and reflects inwards.
fn sphere(albedo: f64) -> String {
    format!(
        "Material \"diffuse\" {}
        AreaLightSource \"diffuse\" {}
        ReverseOrientation
        Shape \"sphere\" \"float radius\" 1",
        flat("reflectance", albedo),
        lit("L", 1.0)
    )
}

/// Vertices of the box [-1, 1]^3.
const CORNERS: &str = "-1 -1 -1  1 -1 -1  -1 1 -1  1 1 -1  -1 -1 1  1 -1 1  -1 1 1  1 1 1";
const PATCHES: &str = "0 1 2 3  4 5 6 7  0 1 4 5  2 3 6 7  0 2 4 6  1 3 5 7";
const TRIANGLES: &str = "0 1 2  1 2 3  4 5 6  5 6 7  0 1 4  1 4 5  2 3 6  3 6 7  0 2 4  2 4 6  1 3 5  3 5 7";

/// The same with walls of a box, which glow on both sides.
fn room(albedo: f64, mesh: &str, indices: &str) -> String {
    format!(
        "Material \"diffuse\" {}
        AreaLightSource \"diffuse\" {} \"bool twosided\" true
        Shape \"{mesh}\" \"point3 P\" [{CORNERS}] \"integer indices\" [{indices}]",
        flat("reflectance", albedo),
        lit("L", 1.0)
    )
}

const DEEP: &str = "\"integer maxdepth\" 200 \"integer roulettedepth\" 12";
const INSIDE: &str = "LookAt 0.1 0.2 -0.3  0.4 -0.1 1  0 1 0 Camera \"perspective\" \"float fov\" 80";

/// The furnace shows 1 / (1 - a) through this setup.
#[track_caller]
fn check(name: &str, setup: &Setup<'_>, n_passes: u64, albedo: f64) {
    let film = setup.film(name, n_passes);
    expect_mean(name, &pixel_moments(&film), 1.0 / (1.0 - albedo), 0.02);
}

/// EQ-1: a closed room is 1 / (1 - a) bright, whatever its shape.
#[test]
fn closed_rooms() {
    for albedo in [0.3, 0.5, 0.8] {
        let rooms = [
            ("sphere", sphere(albedo)),
            ("patches", room(albedo, "bilinearmesh", PATCHES)),
            ("triangles", room(albedo, "trianglemesh", TRIANGLES)),
        ];
        for (shape, world) in &rooms {
            let setup = Setup { size: [16, 16], integrator: DEEP, camera: INSIDE, world, ..Setup::default() };
            check(&format!("furnace of {shape}, albedo {albedo}"), &setup, 64, albedo);
        }
    }
}

/// A black room only glows: no path scatters, and the value has no noise but that of wavelengths.
#[test]
fn black_room() {
    let world = sphere(0.0);
    let setup = Setup { size: [16, 16], camera: INSIDE, world: &world, ..Setup::default() };
    check("black furnace", &setup, 64, 0.0);
}

/// How numbers are dealt does not change expectations.
#[test]
fn furnace_through_every_sampler() {
    let world = room(0.5, "bilinearmesh", PATCHES);
    for sampler in [
        "\"independent\"",
        "\"stratified\" \"integer xsamples\" 8 \"integer ysamples\" 8",
        "\"halton\" \"integer pixelsamples\" 64",
        "\"sobol\" \"integer pixelsamples\" 64",
    ] {
        let world = world.as_str();
        let setup =
            Setup { size: [16, 16], sampler, integrator: DEEP, camera: INSIDE, world, ..Setup::default() };
        check(&format!("furnace by {sampler}"), &setup, 64, 0.5);
    }
}

/// Filters of weight 1 in all keep the brightness, those with negative lobes too.
#[test]
fn furnace_through_every_filter() {
    let world = sphere(0.5);
    for filter in ["\"box\"", "\"triangle\"", "\"gaussian\"", "\"mitchell\"", "\"sinc\""] {
        let world = world.as_str();
        let setup =
            Setup { size: [16, 16], filter, integrator: DEEP, camera: INSIDE, world, ..Setup::default() };
        check(&format!("furnace through {filter}"), &setup, 100, 0.5);
    }
}

/// Radiance is the same along every ray, so that every camera sees the same.
#[test]
fn furnace_through_every_camera() {
    let world = sphere(0.5);
    let at = "LookAt 0.1 0.2 -0.3  0.4 -0.1 1  0 1 0";
    for camera in [
        "\"perspective\" \"float fov\" 20",
        "\"perspective\" \"float lensradius\" 0.2 \"float focaldistance\" 0.7",
        "\"orthographic\" \"float screenwindow\" [-0.3 0.3 -0.3 0.3]",
        "\"orthographic\" \"float screenwindow\" [-0.2 0.2 -0.2 0.2] \"float lensradius\" 0.2 \"float focaldistance\" 0.5",
        "\"spherical\" \"string mapping\" \"equalarea\"",
        "\"spherical\" \"string mapping\" \"equirectangular\"",
    ] {
        let (camera, world) = (format!("{at} Camera {camera}"), world.as_str());
        let setup = Setup { size: [16, 16], integrator: DEEP, camera: &camera, world, ..Setup::default() };
        check(&format!("furnace through {camera}"), &setup, 64, 0.5);
    }
}

/// PT-5: without paths of more than k bounces the series 1 + a + ... + a^k is cut off, which darkens.
#[test]
fn depth_limit_cuts_the_series() {
    let albedo: f64 = 0.8;
    let world = sphere(albedo);
    for k in [0, 1, 2, 5] {
        let integrator = format!("\"integer maxdepth\" {k} \"integer roulettedepth\" 100");
        let setup = Setup {
            size: [16, 16],
            integrator: &integrator,
            camera: INSIDE,
            world: &world,
            ..Setup::default()
        };
        let sum = (1.0 - albedo.powi(k + 1)) / (1.0 - albedo);
        let name = format!("furnace of at most {k} bounces");
        expect_mean(&name, &pixel_moments(&setup.film(&name, 64)), sum, 0.02);
    }
}

/// PT-5, MC-11: roulette ends paths without taking anything from their expectation, from the first bounce on.
#[test]
fn roulette_does_not_darken() {
    let world = sphere(0.8);
    for depth in [0, 1, 4] {
        let integrator = format!("\"integer maxdepth\" 200 \"integer roulettedepth\" {depth}");
        let setup = Setup {
            size: [32, 32],
            integrator: &integrator,
            camera: INSIDE,
            world: &world,
            ..Setup::default()
        };
        check(&format!("furnace with roulette after {depth}"), &setup, 64, 0.8);
    }
}

/// Light that surrounds the furnace instead of coming from its walls: both ways to find lights carry all of it.
#[test]
fn furnace_by_one_technique() {
    let world = room(0.5, "trianglemesh", TRIANGLES);
    for lights in ["lights", "scattering"] {
        let integrator = format!("{DEEP} \"string lights\" \"{lights}\"");
        let setup = Setup {
            size: [16, 16],
            integrator: &integrator,
            camera: INSIDE,
            world: &world,
            ..Setup::default()
        };
        check(&format!("furnace by {lights}"), &setup, 256, 0.5);
    }
}

const AROUND: &str = "LookAt 0 0 -3  0 0 0  0 1 0 Camera \"perspective\" \"float fov\" 45";

/// A ball before a sky of radiance 1, and the sky alone, by the same random numbers.
fn ball_in_sky(name: &str, material: &str, integrator: &str, n_passes: u64) -> [Vec<f64>; 2] {
    let sky = format!("LightSource \"infinite\" {}", lit("L", 1.0));
    let ball = format!("{sky} {material} Shape \"sphere\" \"float radius\" 1");
    [ball, sky].map(|world| {
        let setup = Setup { size: [20, 20], integrator, camera: AROUND, world: &world, ..Setup::default() };
        luminance(&render_passes(&setup.scene(name), 0..n_passes))
    })
}

/// FRES-2, FRES-8: what is lossless and smooth vanishes before a uniform sky. Each path carries exactly the sky's radiance,
/// so that the pictures with and without the ball agree but for rounding, roulette notwithstanding.
#[test]
fn lossless_and_smooth_is_invisible() {
    for material in [
        "Material \"dielectric\" \"float eta\" 1.5",
        "Material \"dielectric\" \"float eta\" 0.7",
        "Material \"thindielectric\" \"float eta\" 1.5",
        "Material \"interface\"",
    ] {
        let [ball, sky] = ball_in_sky(material, material, "\"integer maxdepth\" 1000", 16);
        expect_equal_pixels(material, &ball, &sky, 1e-4);
    }
}

/// FRES-2: a mirror that reflects everything shows the sky undimmed (its reflectance is limited to 0.9999), one that
/// reflects half of it shows half.
#[test]
fn mirrors_show_their_reflectance() {
    for reflectance in [1.0, 0.5] {
        let material = format!("Material \"conductor\" {}", flat("reflectance", reflectance));
        // The sphere fills the picture.
        let camera = "LookAt 0 0 -3  0 0 0  0 1 0 Camera \"perspective\" \"float fov\" 10";
        let sky = format!("LightSource \"infinite\" {}", lit("L", 1.0));
        let ball = format!("{sky} {material} Shape \"sphere\" \"float radius\" 1");
        let [ball, sky] = [ball, sky].map(|world| {
            let setup = Setup { camera, world: &world, ..Setup::default() };
            luminance(&setup.film("mirror", 16))
        });
        // Reflectance is met at normal incidence; slightly aside it rises by some thousandths at most.
        let scaled: Vec<f64> = sky.iter().map(|v| v * reflectance).collect();
        expect_equal_pixels("mirror", &ball, &scaled, 5e-3);
    }
}

/// A white diffuse ball is as bright as the sky: rho L with rho = 1. A grey one shows its albedo.
#[test]
fn diffuse_ball_shows_its_albedo() {
    let camera = "LookAt 0 0 -3  0 0 0  0 1 0 Camera \"perspective\" \"float fov\" 20";
    for albedo in [1.0, 0.6] {
        for (lights, n_passes) in [("both", 64), ("lights", 256), ("scattering", 64)] {
            let world = format!(
                "LightSource \"infinite\" {} Material \"diffuse\" {} Shape \"sphere\"",
                lit("L", 1.0),
                flat("reflectance", albedo)
            );
            let integrator = format!("\"integer maxdepth\" 100 \"string lights\" \"{lights}\"");
            let setup =
                Setup { size: [16, 16], integrator: &integrator, camera, world: &world, ..Setup::default() };
            let name = format!("ball of albedo {albedo} by {lights}");
            expect_mean(&name, &pixel_moments(&setup.film(&name, n_passes)), albedo, 0.03);
        }
    }
}

/// Rough glass and metal lose light that should bounce several times among facets, and no more: seen squarely, a white metal
/// keeps 98.7 % at alpha 0.1 and 68.7 % at 0.5 (the single-scattering losses that the model states), and a sheet of glass
/// what its BSDF keeps of light that comes to both sides.
#[test]
fn rough_sheets_keep_what_their_model_keeps() {
    let camera = "LookAt 0 0 -3  0 0 0  0 1 0 Camera \"orthographic\"";
    let sheet = |material: &str| {
        let world = format!(
            "LightSource \"infinite\" {} Material {material} \"bool remaproughness\" false
            Shape \"bilinearmesh\" \"point3 P\" [-9 -9 0  -9 9 0  9 -9 0  9 9 0]",
            lit("L", 1.0)
        );
        let setup = Setup { size: [16, 16], camera, world: &world, ..Setup::default() };
        pixel_moments(&setup.film(material, 256))
    };
    for (alpha, kept) in [(0.1_f32, 0.987), (0.5, 0.687)] {
        let metal = sheet(&format!("\"conductor\" {} \"float roughness\" {alpha}", flat("reflectance", 1.0)));
        assert!(
            (metal.mean() - kept).abs() < 0.008 + Z * metal.standard_error(),
            "{} of {kept}",
            metal.mean()
        );
        let glass = sheet(&format!("\"dielectric\" \"float eta\" 1.5 \"float roughness\" {alpha}"));
        let model = Dielectric { microfacets: Microfacets::new(alpha, alpha), eta: 1.5 };
        let mut rng = Rng::new(seed("rough sheet"), 0);
        let expected: Moments = (0..100_000)
            .map(|_| {
                let (u, up) = (rng.next_f32(), Vector3::new(0.0, 0.0, 1.0));
                let sample = model.sample(up, u, rng.next_point2(), TransportMode::Radiance, Lobes::ALL);
                sample.map_or(0.0, |s| f64::from(s.weight[0]))
            })
            .collect();
        expect_agreement(&format!("glass of alpha {alpha}"), &glass, &expected, 0.03);
    }
}

/// Rough glass looks the same whether lights are found by sampling, by scattering, or both: the sampled density of refraction
/// is the one that weights use.
#[test]
fn rough_glass_by_every_technique() {
    let camera = "LookAt 0 0 -3  0 0 0  0 1 0 Camera \"perspective\" \"float fov\" 20";
    let world = format!(
        "LightSource \"infinite\" {}
        Material \"dielectric\" \"float roughness\" 0.4 \"bool remaproughness\" false
        Shape \"sphere\"",
        lit("L", 1.0)
    );
    let moments: Vec<Moments> = ["both", "scattering", "lights"]
        .iter()
        .map(|lights| {
            let integrator = format!("\"integer maxdepth\" 30 \"string lights\" \"{lights}\"");
            let setup =
                Setup { size: [16, 16], integrator: &integrator, camera, world: &world, ..Setup::default() };
            pixel_moments(&setup.film(&format!("rough glass by {lights}"), 256))
        })
        .collect();
    expect_agreement("both and scattering", &moments[0], &moments[1], 0.03);
    expect_agreement("both and lights", &moments[0], &moments[2], 0.15);
}

/// Sheets in a uniform sky show the share of light that they reflect and let through: R + T where light passes, the mean of
/// both parts where they are mixed.
#[test]
fn sheets_show_their_albedo() {
    let camera = "LookAt 0 0 -3  0 0 0  0 1 0 Camera \"perspective\" \"float fov\" 20";
    let veil = format!(
        "Material \"diffusetransmission\" {} {}",
        flat("reflectance", 0.3),
        flat("transmittance", 0.4)
    );
    let mix = |amount: f64| {
        format!(
            "MakeNamedMaterial \"a\" \"string type\" \"diffuse\" {} MakeNamedMaterial \"b\" \"string type\" \"diffuse\" {}
            Material \"mix\" \"string materials\" [\"a\" \"b\"] \"float amount\" {amount}",
            flat("reflectance", 0.2),
            flat("reflectance", 0.9)
        )
    };
    let cases = [("veil", veil, 0.7), ("mix", mix(0.25), 0.375), ("mix of none", mix(0.0), 0.2)];
    for (what, material, albedo) in &cases {
        for lights in ["both", "scattering"] {
            let world = format!(
                "LightSource \"infinite\" {} {material}
                Shape \"bilinearmesh\" \"point3 P\" [-9 -9 0  9 -9 0  -9 9 0  9 9 0]",
                lit("L", 1.0)
            );
            let integrator = format!("\"integer maxdepth\" 3 \"string lights\" \"{lights}\"");
            let setup =
                Setup { size: [16, 16], integrator: &integrator, camera, world: &world, ..Setup::default() };
            let name = format!("{what} by {lights}");
            expect_mean(&name, &pixel_moments(&setup.film(&name, 128)), *albedo, 0.05);
        }
    }
}
