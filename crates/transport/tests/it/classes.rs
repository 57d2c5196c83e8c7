//! The class of light paths that each method finds (SPEC LPE-3): nothing outside of it, and less than there is.

use etendue_math::statistics::Moments;
use etendue_scene::Scene;
use etendue_scene::document::{Entity, Value};

use crate::support::{Setup, expect_near, flat, layer, lit, luminance, mean, render_layers};

/// A closed room with a lamp in the ceiling, a mirror ball, and a glass ball that throws a caustic on the floor.
fn room(name: &str, integrator: Entity) -> Scene {
    let world = format!(
        "Material \"diffuse\" {}
        Shape \"bilinearmesh\" \"integer indices\" [0 1 2 3  4 5 6 7  2 3 6 7  0 1 4 5  0 2 4 6  1 3 5 7]
        \"point3 P\" [-1 -1 -1  1 -1 -1  -1 -1 1  1 -1 1  -1 1 -1  1 1 -1  -1 1 1  1 1 1]
        AttributeBegin Translate -0.4 -0.6 0.4 Material \"conductor\" Shape \"sphere\" \"float radius\" 0.35 AttributeEnd
        AttributeBegin Translate 0.4 -0.6 0 Material \"dielectric\" Shape \"sphere\" \"float radius\" 0.35 AttributeEnd
        AttributeBegin AreaLightSource \"diffuse\" {} Translate 0 0.99 0 Rotate 90 1 0 0
        Shape \"disk\" \"float radius\" 0.5 AttributeEnd",
        flat("reflectance", 0.5),
        lit("L", 3.0)
    );
    let camera = "LookAt 0 0 -0.95  0 -0.1 1  0 1 0 Camera \"perspective\" \"float fov\" 75";
    let mut scene = Setup { size: [32, 32], camera, world: &world, ..Setup::default() }.scene(name);
    scene.integrator = integrator;
    scene
}

fn photons(show: &str) -> Entity {
    Entity::new("photons")
        .with("photons", Value::Integers(vec![100_000]))
        .with("show", Value::Strings(vec![show.to_owned()]))
}

/// LPE-3, WHIT-4, VIS-2, BDPT-7: outside of its class a method finds nothing, where path tracing finds a good part of the light.
#[test]
fn methods_find_the_paths_of_their_class_alone() {
    let outside = [
        // Not LD?S*E: something before a diffuse surface.
        ("whitted", "L(S|D)*(S|D)D(S|D)*E", Entity::new("whitted")),
        // Not LS+DS*E: no diffuse surface, one at the start, or two.
        ("caustics", "L(S*|D(S|D)*|(S|D)*D(S|D)*D(S|D)*)E", photons("caustics")),
        // Not L((S|D)*D)?E: light comes from a mirror to the eye.
        ("light", "L(S|D)*SE", Entity::new("light")),
    ];
    let paths = room("path", Entity::new("path").with("maxdepth", Value::Integers(vec![64])));
    for (name, others, integrator) in outside {
        let own = render_layers(&room(name, integrator), 0..4, &[("others", others), ("all", "L(S|D)*E")]);
        assert!(mean(&layer(&own, "all")) > 1e-3, "{name} shows something");
        assert!(layer(&own, "others").iter().all(|value| *value == 0.0), "{name} finds {others}");
        let all = render_layers(&paths, 0..16, &[("others", others)]);
        let share = mean(&layer(&all, "others")) / mean(&luminance(&all));
        assert!(share > 0.05, "{name}: {others} is {share} of all light");
    }
}

/// VIS-2, VIS-4: caustics alone are those of light tracing, and the picture whose direct light comes by shadow rays is the path tracer's. A
/// radius of 30 of 100,000 photons on 30 m^2, 5 cm, moves light but keeps its mean, except at the seams of walls and balls: 3 %
/// is their share.
#[test]
fn photons_seen_directly_keep_the_light() {
    let path = Entity::new("path").with("maxdepth", Value::Integers(vec![64]));
    let cases = [("caustics", "LS+DE", Entity::new("light"), 600), ("shadowrays", "L(S|D)*E", path, 200)];
    for (show, class, referee, n_passes) in cases {
        let class = [("class", class)];
        let referee = room("referee", referee);
        let of = |passes| mean(&layer(&render_layers(&referee, passes, &class), "class"));
        let theirs: Moments = (0..n_passes).map(|pass| of(pass..pass + 1)).collect();
        let integrator = photons(show).with("nearest", Value::Integers(vec![30]));
        let ours = layer(&render_layers(&room(show, integrator), 0..32, &class), "class");
        let tolerance = 0.03 + 4.0 * theirs.standard_error() / theirs.mean();
        assert!(tolerance < 0.12, "{show}: the comparison would not see {tolerance}");
        expect_near(show, mean(&ours), theirs.mean(), tolerance);
    }
}
