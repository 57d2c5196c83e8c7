//! Three bands in place of wavelengths (SPEC SPD-4): where the two models agree, and where they must not.

use etendue_math::statistics::{Moments, means_agree};
use etendue_spectrum::SpectrumTables;

use crate::spectra::color_moments;
use crate::support::{Setup, expect_agreement, expect_mean, expect_near, significance};

/// Moments over passes of red, green and blue of what the camera sees of the world.
fn colors(name: &str, wavelengths: &str, [camera, world]: [&str; 2], n_passes: u64) -> [Moments; 3] {
    let integrator = &format!("\"integer maxdepth\" 100 \"string wavelengths\" \"{wavelengths}\"");
    let setup = Setup { size: [16, 16], integrator, camera, world, ..Setup::default() };
    color_moments(&setup, &format!("{name}, {wavelengths}"), n_passes)
}

/// Demands an image without colour.
#[track_caller]
fn expect_grey(what: &str, rgb: &[Moments; 3]) {
    expect_near(what, rgb[0].mean(), rgb[1].mean(), 1e-4);
    expect_near(what, rgb[2].mean(), rgb[1].mean(), 1e-4);
}

const ROOM_CAMERA: &str = "LookAt 0 1 -4  0 -0.3 0  0 1 0 Camera \"perspective\" \"float fov\" 50";

/// A floor, a metal ball and a glass ball under a sky and a lamp, all of the given reflectance.
fn room(reflectance: &str) -> String {
    format!(
        "AttributeBegin Material \"diffuse\" \"rgb reflectance\" [{reflectance}]
        Shape \"bilinearmesh\" \"point3 P\" [-3 -1 -3  3 -1 -3  -3 -1 3  3 -1 3] AttributeEnd
        AttributeBegin Material \"conductor\" \"rgb reflectance\" [{reflectance}] \"float roughness\" 0.2
        Translate -1 0 0 Shape \"sphere\" AttributeEnd
        AttributeBegin Material \"dielectric\" \"float eta\" 1.5 Translate 1.1 0 0 Shape \"sphere\" AttributeEnd
        LightSource \"infinite\" \"rgb L\" [0.5 0.5 0.5]
        AttributeBegin AreaLightSource \"diffuse\" \"rgb L\" [4 4 4] \"bool twosided\" true
        Shape \"bilinearmesh\" \"point3 P\" [-1 3 -1  1 3 -1  -1 3 1  1 3 1] AttributeEnd"
    )
}

/// Where all is grey a band is like a wavelength: the images have the same mean, and that in bands has no colour.
#[test]
fn bands_and_wavelengths_agree_on_grey() {
    let world = room("0.6 0.6 0.6");
    let bands = colors("grey", "bands", [ROOM_CAMERA, &world], 60);
    let hero = colors("grey", "hero", [ROOM_CAMERA, &world], 300);
    for (bands, hero) in bands.iter().zip(&hero) {
        expect_agreement("grey", bands, hero, 0.04);
    }
    expect_grey("grey", &bands);
}

/// In a closed sphere that glows, L = L_e + rho L, so L = L_e / (1 - rho) in each band. Nature multiplies the spectrum of a
/// saturated wall with itself at every reflection, which gives another colour.
#[test]
fn colours_multiply_as_numbers() {
    let rho = [0.75, 0.3, 0.05];
    let world = format!(
        "Material \"diffuse\" \"rgb reflectance\" [{} {} {}]
        AreaLightSource \"diffuse\" \"rgb L\" [1 1 1] \"bool twosided\" true Shape \"sphere\"",
        rho[0], rho[1], rho[2]
    );
    let camera = "Camera \"perspective\" \"float fov\" 90";
    let bands = colors("furnace", "bands", [camera, &world], 150);
    for (moments, rho) in bands.iter().zip(rho) {
        expect_mean("furnace", moments, 1.0 / (1.0 - rho), 0.02);
    }
    let hero = colors("furnace", "hero", [camera, &world], 300);
    let [red_bands, red_hero] = [bands[0], hero[0]];
    assert!(means_agree(&red_bands, &red_hero, significance()).is_err(), "the two models differ");
    assert!(red_hero.mean() < 0.9 * red_bands.mean(), "by more than 10 % in red: {}", red_hero.mean());
}

/// Reflectance at normal incidence of a surface of glass with this index.
fn fresnel(eta: f32) -> f64 {
    f64::from((eta - 1.0) / (eta + 1.0)).powi(2)
}

/// A pane before darkness that mirrors a white sky.
fn pane(index: &str) -> String {
    format!(
        "LightSource \"infinite\" \"rgb L\" [1 1 1]
        AttributeBegin Material \"dielectric\" {index}
        Shape \"bilinearmesh\" \"point3 P\" [-9 -9 1  9 -9 1  -9 9 1  9 9 1] AttributeEnd
        AttributeBegin Material \"diffuse\" \"rgb reflectance\" [0 0 0]
        Shape \"bilinearmesh\" \"point3 P\" [-99 -99 1.1  99 -99 1.1  -99 99 1.1  99 99 1.1] AttributeEnd"
    )
}

const PANE_CAMERA: &str = "Camera \"perspective\" \"float fov\" 5";

/// Each band has its own index: the mirror image of white in flint glass is bluish by Fresnel's formula.
#[test]
fn every_band_has_its_index() {
    let eta = SpectrumTables::new().add_named("glass-SF11").expect("a glass").bands().rgb();
    let seen = colors("flint", "bands", [PANE_CAMERA, &pane("\"spectrum eta\" \"glass-SF11\"")], 2500);
    for (moments, eta) in seen.iter().zip(eta) {
        expect_mean("flint", moments, fresnel(eta), 0.04);
    }
    assert!(fresnel(eta[2]) > 1.06 * fresnel(eta[0]), "{eta:?}");
}

/// Equal indices make no colour, although the path follows one band only: the index of this glass depends on wavelength, but
/// not by more than rounding.
#[test]
fn equal_indices_make_no_colour() {
    let index = "\"spectrum eta\" [300 1.8 500 1.8000002 900 1.8]";
    let seen = colors("equal", "bands", [PANE_CAMERA, &pane(index)], 2500);
    for moments in &seen {
        expect_mean("equal indices", moments, fresnel(1.8), 0.04);
        assert!(moments.variance() > 0.0, "one band at a time");
    }
    let constant = colors("constant", "bands", [PANE_CAMERA, &pane("\"float eta\" 1.8")], 200);
    expect_grey("constant index", &constant);
}
