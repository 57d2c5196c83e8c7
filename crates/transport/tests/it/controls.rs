//! Switches of artists (SPEC EMI-14): each removes exactly the component that it names, and lights reach whom they may.

use etendue_math::statistics::Moments;
use etendue_scene::Scene;
use etendue_scene::document::{Entity, Value};

use crate::support::{
    Setup, block_moments, expect_equal_pixels, expect_same_image, flat, layer, lit, luminance, render_layers,
    render_passes,
};

/// A floor and a wall, a glass ball, a mirror ball, a ball of sharp gloss and one of wide gloss under a lamp. `all` applies to
/// every shape, `floor` to floor and wall alone.
pub(crate) fn scene(all: &str, floor: &str, integrator: &str) -> etendue_scene::Scene {
    let attribute =
        |what: &str| if what.is_empty() { String::new() } else { format!("Attribute \"shape\" {what}\n") };
    let world = format!(
        "{}
        AttributeBegin {} Material \"diffuse\" {} Shape \"bilinearmesh\" \"point3 P\" [-1 -1 -1  1 -1 -1  -1 -1 1  1 -1 1]
        Shape \"bilinearmesh\" \"point3 P\" [-1 -1 1  1 -1 1  -1 1 1  1 1 1] AttributeEnd
        AttributeBegin Translate -0.5 -0.5 0 Material \"dielectric\" Shape \"sphere\" \"float radius\" 0.4 AttributeEnd
        AttributeBegin Translate 0.5 -0.5 0.3 Material \"conductor\" Shape \"sphere\" \"float radius\" 0.4 AttributeEnd
        AttributeBegin Translate 0 0.4 0.4 Material \"conductor\" \"float roughness\" 0.4
        Shape \"sphere\" \"float radius\" 0.3 AttributeEnd
        AttributeBegin Translate 0.6 0.4 0.4 Material \"conductor\" \"float roughness\" 0.001
        Shape \"sphere\" \"float radius\" 0.2 AttributeEnd
        AttributeBegin AreaLightSource \"diffuse\" {} \"bool twosided\" true
        Shape \"bilinearmesh\" \"point3 P\" [-0.4 1 -0.4  0.4 1 -0.4  -0.4 1 0.4  0.4 1 0.4] AttributeEnd
        LightSource \"infinite\" {}",
        attribute(all),
        attribute(floor),
        flat("reflectance", 0.6),
        lit("L", 4.0),
        lit("L", 0.1)
    );
    let camera = "LookAt 0 0.2 -3.5  0 0 0  0 1 0 Camera \"perspective\" \"float fov\" 42";
    let integrator = format!("\"integer maxdepth\" 6 {integrator}");
    Setup { size: [24, 24], integrator: &integrator, camera, world: &world, ..Setup::default() }
        .scene("controls")
}

/// The same scene by light tracing.
fn traced(mut scene: Scene, depth: i32) -> Scene {
    scene.integrator = Entity::new("light").with("maxdepth", Value::Integers(vec![depth]));
    scene
}

/// The picture with a switch is the picture without, less the layer of the component: the same paths by the same numbers. So it is of
/// what light tracing finds.
#[track_caller]
fn removes(all: &str, floor: &str, component: &str) {
    for by in [|scene| scene, |scene| traced(scene, 6)] as [fn(Scene) -> Scene; 2] {
        let whole = render_layers(&by(scene("", "", "")), 0..16, &[("gone", component)]);
        let gone = layer(&whole, "gone");
        assert!(gone.iter().any(|v| *v > 0.0), "{component} is there");
        let expected: Vec<f64> = luminance(&whole).iter().zip(&gone).map(|(a, b)| a - b).collect();
        let found = luminance(&render_passes(&by(scene(all, floor, "")), 0..16));
        expect_equal_pixels(component, &found, &expected, 1e-3);
    }
}

#[test]
fn switches_remove_exactly_what_they_name() {
    let off = |name: &str| format!("\"bool {name}\" false");
    removes(&off("castscaustics"), "", "LS+D(S|D)*E");
    removes(&off("receivescaustics"), "", "LS+D(S|D)*E");
    removes(&off("castsindirect"), "", "L(S|D)*DS*D(S|D)*E");
    removes(&off("receivesindirect"), "", "L(S|D)*DS*D(S|D)*E");
    let both = format!("{} {}", off("castsindirect"), off("castscaustics"));
    removes(&both, "", "L(S|D)*(S|D)S*D(S|D)*E");
}

/// The balls of mirror and glass never show diffuse light of their own, so to switch off what they receive, or the caustics
/// that walls cast, changes nothing.
#[test]
fn switches_of_other_shapes_change_nothing() {
    let whole = luminance(&render_passes(&scene("", "", ""), 0..8));
    let walls = luminance(&render_passes(&scene("", "\"bool castscaustics\" false", ""), 0..8));
    expect_equal_pixels("walls cast no caustics", &walls, &whole, 1e-4);
    let stated = luminance(&render_passes(&scene("\"bool castscaustics\" true", "", ""), 0..8));
    expect_equal_pixels("the default", &stated, &whole, 0.0);
}

/// A room of two lamps, of which one belongs to the group `key`. `linked` says what the ball receives.
pub(crate) fn linked(name: &str, linked: &str, key: f64, integrator: &str) -> etendue_scene::Scene {
    let world = format!(
        "AttributeBegin Material \"diffuse\" {} Shape \"bilinearmesh\" \"point3 P\" [-1 -1 -1  1 -1 -1  -1 -1 1  1 -1 1] {linked}
        Translate 0 -0.5 0 Shape \"sphere\" \"float radius\" 0.5 {linked} AttributeEnd
        AttributeBegin Translate 0.7 -0.6 0 Material \"conductor\" Shape \"sphere\" \"float radius\" 0.3 {linked} AttributeEnd
        AttributeBegin Translate 0 2 -1 AreaLightSource \"diffuse\" {} \"string group\" \"key\"
        Shape \"sphere\" \"float radius\" 0.4 {linked} AttributeEnd
        LightSource \"point\" {} \"point3 from\" [1 1 -1] \"string group\" \"key\"
        LightSource \"infinite\" {} \"string group\" \"fill\"",
        flat("reflectance", 0.5),
        lit("L", key),
        lit("I", key),
        lit("L", 0.3)
    );
    let camera = "LookAt 0 0 -3  0 -0.4 0  0 1 0 Camera \"perspective\" \"float fov\" 40";
    let integrator = format!("\"integer maxdepth\" 4 {integrator}");
    Setup { size: [16, 16], integrator: &integrator, camera, world: &world, ..Setup::default() }.scene(name)
}

/// Shapes that a light does not reach look as if it were dark, to every technique.
#[test]
fn linked_lights_reach_whom_they_may() {
    let dark = block_moments(&linked("dark", "", 0.0, ""), 96, 2);
    for lights in ["both", "lights", "scattering"] {
        let integrator = format!("\"string lights\" \"{lights}\"");
        let scene = linked(lights, "\"string lights\" [ \"fill\" ]", 5.0, &integrator);
        expect_same_image(lights, &block_moments(&scene, 96, 2), &dark, 0.05);
    }
    let traced_dark = block_moments(&traced(linked("dark", "", 0.0, ""), 4), 96, 2);
    let scene = traced(linked("light", "\"string lights\" [ \"fill\" ]", 5.0, ""), 4);
    expect_same_image("light", &block_moments(&scene, 96, 2), &traced_dark, 0.1);
    let reached = linked("reached", "\"string lights\" [ \"key\" \"fill\" ]", 5.0, "");
    let all = linked("reached", "", 5.0, "");
    let pixels = |scene| luminance(&render_passes(scene, 0..8));
    expect_equal_pixels("all groups are named", &pixels(&reached), &pixels(&all), 1e-4);
}

fn by_photons(scene: Scene) -> Scene {
    let integers = |entity: Entity, name, value| entity.with(name, Value::Integers(vec![value]));
    let few = integers(Entity::new("photonmap"), "globalphotons", 40_000);
    Scene { integrator: integers(few, "causticphotons", 20_000), ..scene }
}

/// Two images whose means differ by no more than noise and this share of the first: what maps blur.
#[track_caller]
fn expect_alike(what: &str, paths: &[f64], photons: &[f64], bias: f64) {
    let difference: Moments = photons.iter().zip(paths).map(|(a, b)| a - b).collect();
    let mean = paths.iter().sum::<f64>() / paths.len() as f64;
    let tolerance = bias * mean + 5.0 * difference.standard_error();
    assert!(
        difference.mean().abs() < tolerance,
        "{what}: {} beside {mean}, tolerance {tolerance}",
        difference.mean()
    );
}

/// Photon maps leave out what paths leave out: the part that a switch names is a twenty-fifth of the image, the tolerance
/// a quarter of that and noise.
#[test]
fn photons_heed_switches() {
    let (whole, _) = of_both("", 200);
    for name in ["castscaustics", "receivescaustics", "castsindirect", "receivesindirect"] {
        let (paths, photons) = of_both(&format!("\"bool {name}\" false"), 100);
        let sum = |image: &[f64]| image.iter().sum::<f64>();
        assert!(
            sum(&paths) < 0.98 * sum(&whole),
            "{name} switches something off: {}",
            sum(&paths) / sum(&whole)
        );
        expect_alike(name, &paths, &photons, 0.01);
    }
}

/// The scene with a switch by paths and by photons.
fn of_both(switch: &str, n_passes: u64) -> (Vec<f64>, Vec<f64>) {
    let paths = luminance(&render_passes(&scene(switch, "", ""), 0..n_passes));
    let photons = luminance(&render_passes(&by_photons(scene(switch, "", "")), 0..16));
    (paths, photons)
}

/// Nor do photons of lights come to shapes that those do not reach, nor do rays that gather see them there.
#[test]
fn photons_heed_links() {
    let dark = luminance(&render_passes(&linked("dark", "", 0.0, ""), 0..200));
    let unreached = linked("unreached", "\"string lights\" [ \"fill\" ]", 5.0, "");
    // The lamp itself is seen by the camera in neither.
    let photons = luminance(&render_passes(&by_photons(unreached), 0..32));
    expect_alike("linked", &dark, &photons, 0.02);
}
