//! Wavelengths: one or four per path, dispersion, and the spectral film (SPEC SPD-2, FRES-10).

use etendue_math::Vector3;
use etendue_math::statistics::Moments;
use etendue_scene::bsdf::fresnel::refract;

use crate::support::{Setup, channel, expect_agreement, expect_mean, lit, render_passes};

/// Moments over passes of the means of R, G and B.
pub(crate) fn color_moments(setup: &Setup<'_>, name: &str, n_passes: u64) -> [Moments; 3] {
    let scene = setup.scene(name);
    let mut moments = [Moments::new(); 3];
    for pass in 0..n_passes {
        let image = render_passes(&scene, pass..pass + 1).develop();
        for (moments, c) in moments.iter_mut().zip(["R", "G", "B"]) {
            let values = channel(&image, c);
            moments.push(values.iter().sum::<f64>() / values.len() as f64);
        }
    }
    moments
}

#[track_caller]
fn check_modes(what: &str, setup: &Setup<'_>) {
    let hero = Setup { integrator: "\"integer maxdepth\" 8 \"string wavelengths\" \"hero\"", ..*setup };
    let single = Setup { integrator: "\"integer maxdepth\" 8 \"string wavelengths\" \"single\"", ..*setup };
    let hero = color_moments(&hero, &format!("{what}, hero"), 400);
    let single = color_moments(&single, &format!("{what}, single"), 1200);
    for ((hero, single), c) in hero.iter().zip(&single).zip(["red", "green", "blue"]) {
        expect_agreement(&format!("{what}, {c}"), hero, single, 0.08);
        assert!(hero.variance() < single.variance(), "{what}, {c}: four wavelengths are better than one");
    }
}

/// SPD-2: one uniformly chosen wavelength per path and four by importance have the same mean in each colour, and the four
/// less noise.
#[test]
fn single_wavelength_and_hero_agree() {
    let world = "AttributeBegin Material \"diffuse\" \"rgb reflectance\" [0.8 0.4 0.1]
        Shape \"bilinearmesh\" \"point3 P\" [-3 -1 -3  3 -1 -3  -3 -1 3  3 -1 3] AttributeEnd
        AttributeBegin Material \"conductor\" \"spectrum eta\" \"metal-Au-eta\" \"spectrum k\" \"metal-Au-k\" \"float roughness\" 0.1
        Shape \"sphere\" AttributeEnd
        LightSource \"infinite\" \"rgb L\" [0.3 0.5 0.9]
        LightSource \"point\" \"blackbody I\" 2800 \"point3 from\" [2 2 -2] \"float scale\" 4";
    let camera = "LookAt 0 1 -4  0 -0.3 0  0 1 0 Camera \"perspective\" \"float fov\" 50";
    check_modes("colours", &Setup { size: [16, 16], camera, world, ..Setup::default() });
}

/// Dispersion makes a path follow its first wavelength. Behind glass the means of both ways agree still, in each colour:
/// light that was gathered before the path met the glass too.
#[test]
fn dispersion_keeps_the_mean() {
    let world = "AttributeBegin Material \"diffuse\" \"rgb reflectance\" [0.7 0.6 0.4]
        Shape \"bilinearmesh\" \"point3 P\" [-3 -1 -3  3 -1 -3  -3 -1 3  3 -1 3] AttributeEnd
        AttributeBegin Material \"dielectric\" \"spectrum eta\" \"glass-SF11\" Shape \"sphere\" AttributeEnd
        LightSource \"infinite\" \"rgb L\" [0.3 0.5 0.9]
        AttributeBegin AreaLightSource \"diffuse\" \"blackbody L\" 3500 \"float scale\" 5 \"bool twosided\" true
        Shape \"bilinearmesh\" \"point3 P\" [-1 3 -1  1 3 -1  -1 3 1  1 3 1] AttributeEnd";
    let camera = "LookAt 0 1 -4  0 -0.3 0  0 1 0 Camera \"perspective\" \"float fov\" 50";
    check_modes("dispersion", &Setup { size: [16, 16], camera, world, ..Setup::default() });
}

/// A dispersive ball before a uniform sky is invisible like any glass.
#[test]
fn dispersive_glass_in_a_furnace() {
    let world = format!(
        "LightSource \"infinite\" {} Material \"dielectric\" \"spectrum eta\" \"glass-SF11\" Shape \"sphere\"",
        lit("L", 1.0)
    );
    let camera = "LookAt 0 0 -3  0 0 0  0 1 0 Camera \"perspective\" \"float fov\" 20";
    let integrator = "\"integer maxdepth\" 100";
    let setup = Setup { size: [16, 16], integrator, camera, world: &world, ..Setup::default() };
    let scene = setup.scene("dispersive furnace");
    let film = render_passes(&scene, 0..256);
    expect_mean("dispersive furnace", &crate::support::pixel_moments(&film), 1.0, 0.03);
}

/// A spectral film under light of equal energy: every band has the same radiance.
#[test]
fn spectral_film_of_flat_light() {
    let film = "\"spectral\" \"integer nbuckets\" 8 \"float lambdamin\" 400 \"float lambdamax\" 720";
    let world = format!("LightSource \"infinite\" {}", lit("L", 1.0));
    let setup = Setup { size: [16, 16], film, world: &world, ..Setup::default() };
    let scene = setup.scene("flat spectrum");
    let film = render_passes(&scene, 0..512);
    let image = film.develop();
    // Radiance whose luminance integral with CIE y is 1.
    let expected = 1.0 / 106.856_895;
    for bucket in 0..8 {
        let name = scene.film.bucket_name(bucket);
        let moments: Moments = channel(&image, &name).into_iter().collect();
        expect_mean(&name, &moments, expected, 0.03);
    }
}

/// The index of flint glass SF11 (Schott) at a wavelength, as the renderer knows it.
fn sf11(nm: f32) -> f32 {
    let samples = etendue_spectrum::named_spectrum("glass-SF11").expect("a named glass").samples;
    let after = samples.iter().position(|s| s[0] >= nm).expect("within the visible");
    let (a, b) = (samples[after.max(1) - 1], samples[after.max(1)]);
    a[1] + (b[1] - a[1]) * ((nm - a[0]) / (b[0] - a[0])).clamp(0.0, 1.0)
}

/// Apex of the prism, its thickness where the camera's axis passes, and the place of the slit behind it.
const APEX: f64 = 20.0 * std::f64::consts::PI / 180.0;
const THICKNESS: f64 = 1.0;
const SLIT_Z: f64 = 10.0;

/// The tangent of the angle by which the prism turns a ray that meets its first face squarely.
fn deviation(eta: f32) -> f64 {
    let normal = Vector3::new(APEX.sin() as f32, 0.0, APEX.cos() as f32);
    let inside = Vector3::new(0.0, 0.0, 1.0);
    let out = refract(-inside, -normal, 1.0 / eta).expect("no total reflection").wt;
    f64::from(-out.x / out.z)
}

/// FRES-10: a prism turns violet more than red, by the angles of Snell's law at the glass's indices. A slit of light behind it
/// appears at a place of its own in each band of a spectral film.
#[test]
fn prism_spreads_colours() {
    assert!(sf11(420.0) > sf11(550.0) && sf11(550.0) > sf11(680.0));
    assert!(deviation(sf11(420.0)) > deviation(sf11(680.0)) + 0.02);
    // The second face is z = 1 - x tan(apex). A ray at x meets the slit's plane at x - (10 - 1 + x tan(apex)) tan(deviation).
    let slope = APEX.tan();
    let center = -(SLIT_Z - THICKNESS) * deviation(sf11(550.0));
    let seen_at = |nm: f32| {
        let turn = deviation(sf11(nm));
        (center + (SLIT_Z - THICKNESS) * turn) / (1.0 - slope * turn)
    };
    let (thick, thin) = (THICKNESS + slope, THICKNESS - slope);
    let (left, right) = (center - 0.03, center + 0.03);
    let world = format!(
        "AttributeBegin Material \"dielectric\" \"spectrum eta\" \"glass-SF11\"
        Shape \"bilinearmesh\" \"point3 P\" [-1 -1 0  -1 1 0  1 -1 0  1 1 0]
        Shape \"bilinearmesh\" \"point3 P\" [-1 -1 {thick}  1 -1 {thin}  -1 1 {thick}  1 1 {thin}] AttributeEnd
        AttributeBegin AreaLightSource \"diffuse\" {} \"bool twosided\" true Translate 0 0 {SLIT_Z}
        Shape \"bilinearmesh\" \"point3 P\" [{left} -1 0  {right} -1 0  {left} 1 0  {right} 1 0] AttributeEnd",
        lit("L", 1.0)
    );
    let setup = Setup {
        size: [60, 4],
        film: "\"spectral\" \"integer nbuckets\" 6 \"float lambdamin\" 420 \"float lambdamax\" 690",
        sampler: "\"sobol\"",
        integrator: "\"integer maxdepth\" 2",
        camera: "LookAt 0 0 -1  0 0 0  0 1 0 Camera \"orthographic\" \"float screenwindow\" [-0.6 0.6 -0.05 0.05]",
        world: &world,
        ..Setup::default()
    };
    let scene = setup.scene("prism");
    let image = render_passes(&scene, 0..1024).develop();
    let mut last = f64::INFINITY;
    for bucket in 0..6 {
        let (mut weight, mut sum) = (0.0, 0.0);
        for (index, value) in channel(&image, &scene.film.bucket_name(bucket)).iter().enumerate() {
            weight += value;
            sum += value * (((index % 60) as f64 + 0.5) / 60.0 * 1.2 - 0.6);
        }
        let place = sum / weight;
        let band = (0..45).map(|i| seen_at(420.5 + (45 * bucket + i) as f32));
        let expected = band.sum::<f64>() / 45.0;
        // A quarter of a pixel; neighbouring bands are one to eight pixels apart.
        assert!((place - expected).abs() < 0.005, "band {bucket}: {place} instead of {expected}");
        assert!(place < last, "longer waves are turned less");
        last = place;
    }
}
