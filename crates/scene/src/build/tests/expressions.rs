//! Shapes with formulas of their own, right and wrong.

use super::*;

fn implicit(function: &str) -> Entity {
    Entity::new("implicit").with("function", strings(&[function]))
}

fn parametric(x: &str, y: &str, z: &str) -> Entity {
    Entity::new("parametric").with("x", strings(&[x])).with("y", strings(&[y])).with("z", strings(&[z]))
}

/// A ray along -z from above meets a surface at this height.
fn height(entity: Entity, x: f32, y: f32) -> Option<f32> {
    let scene = scene(&lit_with(vec![shape(entity)]));
    let ray = Ray::new(Point3::new(x, y, 10.0), Vector3::new(0.0, 0.0, -1.0));
    scene.geometry.intersect(&ray, f32::INFINITY, &|_| true).map(|hit| 10.0 - hit.t)
}

/// Formulas say where surfaces are; names are numbers among the parameters.
#[test]
fn formulas_say_where_surfaces_are() {
    let close = |found: Option<f32>, expected: f32| {
        assert!(found.is_some_and(|z| (z - expected).abs() < 1e-5), "{found:?}, not {expected}");
    };
    close(height(implicit("x^2 + y^2 + z^2 - r^2").with("r", floats(&[0.5])), 0.3, 0.0), 0.4);
    close(height(implicit("z - n/4").with("n", integers(&[1])), 0.3, 0.0), 0.25);
    let wide = points(&[[-3.0, -3.0, -3.0], [3.0, 3.0, 3.0]]);
    close(
        height(
            implicit("length(x, y, z) - 2").with("bounds", wide).with("sdf", Value::Bools(vec![true])),
            0.0,
            0.0,
        ),
        2.0,
    );
    assert_eq!(height(implicit("z").with("radius", floats(&[0.5])), 0.6, 0.0), None);
    let plane = parametric("2*u", "2*v", "h").with("h", floats(&[0.7])).with("urange", floats(&[-1.0, 1.0]));
    close(height(plane, -0.5, 0.5), 0.7);
}

/// Each mistake is an error or warning where it stands.
#[test]
fn mistakes_are_located() {
    let error = |entity: Entity, message: &str| error_here(&lit_with(vec![shape(here(entity))]), message);
    error(implicit("x^2 +"), "\"function\", column 6: expected a number");
    error(implicit("x + foo"), "column 5: unknown name \"foo\"");
    error(implicit("sine(x)"), "column 1: unknown function \"sine\"");
    error(implicit("2 + 3"), "is 5 everywhere");
    error(implicit("0"), "is 0 everywhere");
    error(Entity::new("implicit"), "needs a formula");
    error(implicit(&"(".repeat(1_000_000)), "bytes");
    error(implicit(&"(".repeat(10_000)), "deep");
    for corners in [[[1.0, 1.0, 1.0], [-1.0, -1.0, -1.0]], [[0.0, 0.0, 0.0], [1.0, 1.0, 0.0]]] {
        error(implicit("x").with("bounds", points(&corners)), "two corners of a box");
    }
    error(implicit("x").with("bounds", points(&[[0.0; 3]])), "are two points, not 1");
    error(implicit("x").with("radius", floats(&[-1.0])), "must be positive");
    error(parametric("u", "w", "v"), "\"y\", column 1: unknown name \"w\"");
    error(parametric("u", "x", "v"), "unknown name \"x\"");
    error(parametric("u", "v", "1").with("urange", floats(&[1.0, 1.0])), "two different numbers");
    error(parametric("u", "v", "1").with("tolerance", floats(&[0.0])), "must be positive");
}

/// The problems of a document with one shape.
fn warnings(entity: Entity) -> Vec<String> {
    let (scene, problems) = build(&lit_with(vec![shape(here(entity))]));
    assert!(scene.is_some(), "{problems:?}");
    problems.into_iter().map(|problem| problem.message).collect()
}

/// What can be done without is a warning.
#[test]
fn empty_shapes_are_left_out() {
    let warns = |entity: Entity, message: &str| {
        let found = warnings(entity);
        assert!(found.iter().any(|text| text.contains(message)), "{found:?}");
    };
    warns(implicit("x^2 + 1"), "zero nowhere within the bounds");
    warns(implicit("sqrt(-1 - x^2)"), "zero nowhere within the bounds");
    warns(parametric("u", "u", "u"), "have no area");
    warns(parametric("0/0*u", "u", "v"), "have no area");
    warns(
        parametric("u", "v", "sin(99*u)").with("maxtriangles", integers(&[200])),
        "more than the tolerance",
    );
    warns(implicit("x").with("lipshitz", floats(&[2.0])), "does not know the parameter");
}

/// An implicit surface is no lamp; a parametric one is.
#[test]
fn implicit_surfaces_do_not_emit() {
    let emitting = |entity: Entity| {
        let shapes = vec![ShapeEntity { area_light: Some(0), ..shape(here(entity)) }];
        build(&Document { area_lights: vec![Entity::new("diffuse")], ..lit_with(shapes) })
    };
    let (scene, problems) = emitting(implicit("z"));
    assert!(problems.iter().any(|problem| problem.message.contains("implicit surfaces")), "{problems:?}");
    assert_eq!(scene.expect("a warning only").lights.len(), 1);
    let (scene, problems) = emitting(parametric("u", "v", "0"));
    assert!(problems.is_empty(), "{problems:?}");
    assert!(scene.expect("no problem").lights.len() > 1);
}
