//! Curves from parameters.

use super::*;

fn curve(control_points: &[[f32; 3]]) -> Entity {
    here(Entity::new("curve").with("P", points(control_points)).with("width", floats(&[0.2])))
}

const LINE: [[f32; 3]; 4] = [[-1.0, 0.0, 0.0], [-0.3, 0.0, 0.0], [0.3, 0.0, 0.0], [1.0, 0.0, 0.0]];

/// Strands with the same attributes are one geometry; another width does not matter, another material or alpha does.
#[test]
fn neighbouring_curves_are_one_geometry() {
    let strand = |y: f32| curve(&LINE.map(|[x, _, z]| [x, y, z]));
    let mut shapes: Vec<ShapeEntity> = (0..20).map(|i| shape(strand(i as f32))).collect();
    shapes.push(shape(strand(20.0).with("alpha", floats(&[0.5]))));
    shapes.push(sphere());
    shapes.push(shape(strand(21.0)));
    let mut document = lit_with(shapes);
    document.materials.push(named_material("red", Entity::new("diffuse")));
    document.shapes[5].material = MaterialReference::Name("red".to_owned(), None);
    let scene = scene(&document);
    assert_eq!(scene.geometry.counts().n_curves, 22);
    // 5 before the red one, it, 14 behind, the one with alpha, the sphere and the last.
    assert_eq!(scene.attributes.len(), 6);
    for y in [0.0, 4.0, 5.0, 19.0, 21.0] {
        assert!(below(&scene, 0.5, y + 0.05).is_some(), "{y}");
    }
    assert!(below(&scene, 0.5, 2.5).is_none());
}

/// Strands that say the same of switches are one geometry; others keep their own.
#[test]
fn curves_keep_their_switches() {
    let strand = |y: f32| curve(&LINE.map(|[x, _, z]| [x, y, z]));
    let off = |y: f32| strand(y).with("castscaustics", Value::Bools(vec![false]));
    let linked = |y: f32| strand(y).with("lights", strings(&["key"]));
    let mut document =
        lit_with([strand(0.0), off(1.0), off(2.0), linked(3.0), linked(4.0)].map(shape).into());
    document.lights[0].entity = document.lights[0].entity.clone().with("group", strings(&["key"]));
    let scene = scene(&document);
    let controls = scene.controls.as_ref().expect("switches are used");
    assert_eq!(scene.attributes.len(), 3);
    let casts = [0, 1, 2].map(|id| controls.shape(etendue_geometry::GeometryId(id)).casts_caustics);
    assert_eq!(casts, [true, false, true]);
}

/// What makes no curve is an error at the curve.
#[test]
fn impossible_curves_are_errors() {
    let error = |entity: Entity, message: &str| error_here(&lit_with(vec![shape(entity)]), message);
    error(here(Entity::new("curve")), "needs control points");
    error(curve(&LINE[..3]), "3 control points make no curve of degree 3");
    error(curve(&LINE).with("degree", integers(&[4])), "\"degree\" must be 2 or 3");
    error(curve(&LINE).with("width0", floats(&[-1.0])), "must be a number that is not negative");
    error(curve(&LINE).with("type", strings(&["tube"])), "tube");
    error(curve(&LINE).with("type", strings(&["ribbon"])), "needs 2 normals");
    error(curve(&[[f32::NAN; 3]; 4]), "curves: entry 0 is not finite");
    let normals = Value::Normals3(vec![Normal3::new(0.0, 0.0, 1.0); 2]);
    warning_here(&lit_with(vec![shape(curve(&LINE).with("N", normals.clone()))]), "only curves of the type");
    scene(&lit_with(vec![shape(curve(&LINE).with("N", normals).with("type", strings(&["ribbon"])))]));
}

/// Curves do not emit.
#[test]
fn curves_are_no_lights() {
    let mut document = lit_with(vec![shape(curve(&LINE))]);
    document.area_lights.push(Entity::new("diffuse"));
    document.shapes[0].area_light = Some(0);
    warning_here(&document, "curves and points cannot be lights");
}
