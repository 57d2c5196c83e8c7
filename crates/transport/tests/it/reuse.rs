//! Paths that share what they find give the image of paths that do not, with less noise (Bekaert, Sbert and Halton 2002).

use etendue_math::statistics::Moments;
use etendue_transport::lpe::PathExpressions;
use etendue_transport::method;

use crate::strategies::{FRONT, blocks, ceiling_light, open_box};
use crate::support::{Setup, block_moments, expect_same_image};

fn ball(material: &str, x: f64) -> String {
    format!(
        "AttributeBegin Translate {x} -0.6 0 Material {material} Shape \"sphere\" \"float radius\" 0.4 AttributeEnd\n"
    )
}

/// Renders with and without sharing, and demands the same image where a difference of `resolution` must show.
#[track_caller]
fn expect_same(name: &str, objects: &str, settings: &str, n_passes: u64, resolution: f64) {
    let world = open_box(&(ceiling_light(0.5) + objects));
    let render = |reuse: u32| {
        let integrator = format!("{settings} \"integer reuse\" {reuse}");
        blocks(&format!("{name}, sides of {reuse}"), &world, &integrator, n_passes)
    };
    let (alone, shared) = (render(1), render(4));
    expect_same_image(name, &alone, &shared, resolution);
}

/// Among diffuse walls, where nearly all of a path can be shared, with groups that cross edges of objects.
#[test]
fn diffuse_surfaces_share_without_bias() {
    expect_same("diffuse balls", &ball("\"diffuse\"", 0.3), "\"integer maxdepth\" 5", 200, 0.03);
}

/// Mirrors, glass and metal in front of, between and behind what is shared; a random coat, which cannot share; deep paths,
/// so that roulette takes part.
#[test]
fn glossy_surfaces_share_without_bias() {
    let objects = [
        ball("\"conductor\" \"float roughness\" 0.3", -0.5),
        ball("\"dielectric\" \"float eta\" 1.5", 0.5),
        "Translate 0 0.8 0.4\n".to_owned(),
        ball("\"coateddiffuse\" \"float roughness\" 0.3", 0.0),
        "Translate 0.6 0 0\n".to_owned(),
        ball("\"conductor\" \"float roughness\" 0", 0.0),
    ];
    expect_same("glossy balls", &objects.concat(), "\"integer maxdepth\" 9", 250, 0.03);
}

/// Coats whose scattering is known by random walks alone, smooth ones, which share, and rough ones, which do not.
#[test]
fn coated_surfaces_share_without_bias() {
    let coat = |roughness: f64, corners: &str| {
        format!(
            "Material \"coateddiffuse\" \"rgb reflectance\" [0.7 0.7 0.7] \"float roughness\" {roughness}
            Shape \"bilinearmesh\" \"point3 P\" [{corners}]\n"
        )
    };
    let inner_walls = [
        coat(0.0, "-0.99 -0.99 -1  0.99 -0.99 -1  -0.99 -0.99 0.99  0.99 -0.99 0.99"),
        coat(0.3, "-0.99 -0.99 0.99  0.99 -0.99 0.99  -0.99 0.99 0.99  0.99 0.99 0.99"),
        coat(0.1, "-0.99 -0.99 -1  -0.99 -0.99 0.99  -0.99 0.99 -1  -0.99 0.99 0.99"),
    ];
    expect_same("coated walls", &inner_walls.concat(), "\"integer maxdepth\" 5", 250, 0.03);
}

/// Glass that absorbs, rough and smooth, and glass that disperses: what paths share crosses media, and may keep one
/// wavelength of four.
#[test]
fn media_and_wavelengths_share_without_bias() {
    let red = "\"rgb absorption\" [0.5 4 4]";
    let objects = [
        ball(&format!("\"dielectric\" \"float roughness\" 0.4 {red}"), -0.5),
        ball("\"dielectric\" \"spectrum eta\" \"glass-SF11\"", 0.5),
        "Translate 0 0.8 0.4\n".to_owned(),
        ball("\"dielectric\" \"spectrum eta\" \"glass-SF11\" \"float roughness\" 0.3", 0.0),
    ];
    expect_same("absorbing and dispersing balls", &objects.concat(), "\"integer maxdepth\" 7", 250, 0.04);
}

/// Surfaces that light passes in part, and one that moves: connections see what traced rays see.
#[test]
fn holes_and_motion_share_without_bias() {
    let objects = format!(
        "AttributeBegin Material \"diffuse\" Shape \"bilinearmesh\" \"float alpha\" 0.5
        \"point3 P\" [-0.9 -0.5 0  0.9 -0.5 0  -0.9 0.2 -0.4  0.9 0.2 -0.4] AttributeEnd
        AttributeBegin ActiveTransform EndTime Translate 0.4 0.5 0 ActiveTransform All {} AttributeEnd",
        ball("\"diffuse\"", -0.3)
    );
    expect_same("veil and moving ball", &objects, "\"integer maxdepth\" 4", 250, 0.03);
}

/// A sheet that is lit from above and from below, seen edge on where it meets a dark wall: pixels of one group stand above and
/// below it, and find its two sides, which they must not mix up.
#[test]
fn both_sides_of_a_sheet_are_kept_apart() {
    let sheet = "Material \"diffuse\" \"rgb reflectance\" [0.9 0.9 0.9]
        Shape \"bilinearmesh\" \"point3 P\" [-0.98 0 -0.98  0.98 0 -0.98  -0.98 0 0.98  0.98 0 0.98]\n";
    let wall = "Material \"diffuse\" \"rgb reflectance\" [0.5 0.5 0.5]
        Shape \"bilinearmesh\" \"point3 P\" [-1 -1 1  1 -1 1  -1 1 1  1 1 1]\n";
    let lamps =
        "LightSource \"point\" \"point3 from\" [0 1 0.2] LightSource \"point\" \"point3 from\" [0 -1 0.2]";
    let world = [sheet, wall, lamps].concat();
    let render = |reuse: u32| {
        let integrator = format!("\"integer maxdepth\" 2 \"integer reuse\" {reuse}");
        let camera = "LookAt 0 0 -3.4  0 0 0  0 1 0 Camera \"perspective\" \"float fov\" 4";
        let setup =
            Setup { size: [18, 18], integrator: &integrator, camera, world: &world, ..Setup::default() };
        block_moments(&setup.scene(&format!("sheet, sides of {reuse}")), 400, 3)
    };
    expect_same_image("sheet", &render(1), &render(4), 0.02);
}

/// More samples of the lights where paths gather.
#[test]
fn light_samples_are_weighted_against_shared_paths() {
    let settings = "\"integer maxdepth\" 4 \"integer lightsamples\" 3";
    expect_same(
        "three light samples",
        &ball("\"conductor\" \"float roughness\" 0.2", 0.0),
        settings,
        150,
        0.03,
    );
}

/// Of sixteen pixels that share, most have less than a fourth of the variance that they have alone: in a room lit by a small
/// lamp, most of it is that of indirect light.
#[test]
fn sharing_lowers_the_variance_of_pixels() {
    let world = open_box(&(ceiling_light(0.1) + &ball("\"diffuse\"", 0.3)));
    let variances = |reuse: u32| -> Vec<f64> {
        let integrator =
            format!("\"integer maxdepth\" 5 \"string wavelengths\" \"bands\" \"integer reuse\" {reuse}");
        let n = 48;
        let setup =
            Setup { size: [n, n], integrator: &integrator, camera: FRONT, world: &world, ..Setup::default() };
        let pixels = block_moments(&setup.scene(&format!("variance, sides of {reuse}")), 40, n as usize);
        pixels.iter().map(Moments::variance).collect()
    };
    let mut shares: Vec<f64> =
        variances(4).iter().zip(variances(1)).map(|(shared, alone)| shared / alone).collect();
    shares.sort_by(f64::total_cmp);
    let median = shares[shares.len() / 2];
    assert!(median < 0.25, "the variance falls to {median} only");
}

/// Layers sort paths by what they met, which shared paths do not tell: sharing is off, with a warning.
#[test]
fn layers_turn_sharing_off() {
    let setup = Setup { integrator: "\"integer reuse\" 4", ..Setup::default() };
    let scene = setup.scene("layers");
    let layers = PathExpressions::new(&[("direct".to_owned(), "LDE".to_owned())]).expect("a good expression");
    let (integrator, problems) = method(&scene.integrator, layers);
    assert!(integrator.is_some());
    let messages: Vec<&str> = problems.list().iter().map(|problem| problem.message.as_str()).collect();
    assert_eq!(messages, ["layers by path expression need paths of their own: \"reuse\" is taken as 1"]);
}
