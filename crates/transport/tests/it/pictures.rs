//! Lights with pictures: sampling follows the picture, and running into them finds the same light.

use std::path::PathBuf;

use etendue_image::Image;
use etendue_io::write_image;
use etendue_math::Rng;

use crate::support::{Setup, block_moments, expect_same_image, flat, seed};

/// A picture of bright and dark texels in many colours, half of it nearly black, as a file.
pub(crate) fn picture(name: &str, size: usize) -> PathBuf {
    let mut rng = Rng::new(seed(name), 0);
    let pixels = (0..size * size).map(|i| {
        let brightness = if i % size < size / 2 { 0.01 } else { 8.0 * rng.next_f32().powi(6) };
        [0; 3].map(|_| brightness * rng.next_f32())
    });
    let path = PathBuf::from(env!("CARGO_TARGET_TMPDIR")).join(name);
    write_image(&path, &Image::rgb(size, size, pixels.collect()))
        .expect("the folder of the tests can be written");
    path
}

/// Balls of three materials on a floor.
fn still_life(light: &str) -> String {
    format!(
        "{light} AttributeBegin Material \"diffuse\" {} Shape \"bilinearmesh\" \"point3 P\" [-4 -1 -4  4 -1 -4  -4 -1 4  4 -1 4]
        AttributeEnd
        AttributeBegin Translate -0.9 -0.4 0 Material \"diffuse\" {} Shape \"sphere\" \"float radius\" 0.6 AttributeEnd
        AttributeBegin Translate 0.9 -0.4 0 Material \"conductor\" \"float roughness\" 0.1 Shape \"sphere\" \"float radius\" 0.6 AttributeEnd
        AttributeBegin Translate 0 -0.5 -1 Material \"dielectric\" Shape \"sphere\" \"float radius\" 0.5 AttributeEnd",
        flat("reflectance", 0.5),
        flat("reflectance", 0.8)
    )
}

#[track_caller]
fn check_techniques(what: &str, light: &str, n_passes: [u64; 3], resolution: f64) {
    let world = still_life(light);
    let camera = "LookAt 0 0.6 -4  0 -0.4 0  0 1 0 Camera \"perspective\" \"float fov\" 45";
    let render = |lights: &str, n_passes: u64| {
        let integrator = format!("\"integer maxdepth\" 4 \"string lights\" \"{lights}\"");
        let setup =
            Setup { size: [24, 24], integrator: &integrator, camera, world: &world, ..Setup::default() };
        block_moments(&setup.scene(&format!("{what} by {lights}")), n_passes, 3)
    };
    let both = render("both", n_passes[0]);
    expect_same_image(&format!("{what}: both and lights"), &both, &render("lights", n_passes[1]), resolution);
    expect_same_image(
        &format!("{what}: both and scattering"),
        &both,
        &render("scattering", n_passes[2]),
        resolution,
    );
}

/// A picture of the surroundings.
#[test]
fn techniques_agree_under_a_picture_of_the_sky() {
    let file = picture("sky.pfm", 16);
    let light = format!(
        "AttributeBegin Rotate 40 1 2 3 LightSource \"infinite\" \"string filename\" \"{}\" AttributeEnd",
        file.display()
    );
    check_techniques("sky", &light, [100, 150, 300], 0.15);
}

/// The same picture seen through a portal above the scene.
#[test]
fn techniques_agree_under_a_picture_behind_a_portal() {
    let file = picture("portal.pfm", 16);
    let light = format!(
        "LightSource \"infinite\" \"string filename\" \"{}\" \"point3 portal\" [-2 2 -2  2 2 -2  2 2 2  -2 2 2]",
        file.display()
    );
    check_techniques("portal", &light, [100, 150, 300], 0.2);
}

/// A picture on an area light.
#[test]
fn techniques_agree_under_a_glowing_picture() {
    let file = picture("panel.pfm", 8);
    let light = format!(
        "AttributeBegin AreaLightSource \"diffuse\" \"string filename\" \"{}\" \"bool twosided\" true \"float scale\" 5
        Shape \"bilinearmesh\" \"point3 P\" [-1.5 1 -1  1.5 1.4 -1  -1.5 1 1.5  1.5 1.4 1.5] AttributeEnd",
        file.display()
    );
    check_techniques("panel", &light, [100, 150, 400], 0.2);
}
