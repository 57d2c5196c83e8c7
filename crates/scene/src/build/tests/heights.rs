//! Height fields, fractals and displaced meshes.

use std::sync::Arc;

use etendue_image::Texels;

use super::*;

/// Height of the scene above a point of the plane.
#[track_caller]
fn height(scene: &Scene, x: f32, y: f32) -> f32 {
    let ray = down(x, y);
    let hit = scene.intersect(&ray, f32::INFINITY).expect("there is something below");
    scene.surface(&ray, &hit).point.p.z
}

fn field() -> Entity {
    here(Entity::new("heightfield"))
}

/// Numbers are rows in order of y; pictures have y upwards.
#[test]
fn heights_come_from_numbers_and_pictures() {
    let z = floats(&[0.0, 1.0, 2.0, 3.0]);
    let numbers = field().with("z", z).with("nu", integers(&[2])).with("nv", integers(&[2]));
    let numbers = numbers.with("scale", floats(&[2.0])).with("offset", floats(&[0.5]));
    let scene = scene(&lit_with(vec![shape(numbers)]));
    for (x, y, z) in [(0.001, 0.001, 0.5), (0.999, 0.001, 2.5), (0.001, 0.999, 4.5), (0.999, 0.999, 6.5)] {
        assert!((height(&scene, x, y) - z).abs() < 0.02, "{x} {y}");
    }
    let texels = Texels::from_fn(2, 2, 1, |x, y, _| if (x, y) == (0, 0) { 1.0 } else { 0.0 });
    let images = HashMap::from([("z.pfm".to_owned(), Arc::new(texels))]);
    let picture = field().with("filename", strings(&["z.pfm"]));
    let assets = Assets { images, ..Assets::default() };
    let (scene, problems) = build_with(&lit_with(vec![shape(picture)]), assets);
    assert!(problems.is_empty(), "{problems:?}");
    let scene = scene.expect("no problem was reported");
    assert!(height(&scene, 0.001, 0.999) > 0.99 && height(&scene, 0.001, 0.001) < 0.01);
}

/// Impossible fields are errors, and sizes are known before memory is taken.
#[test]
fn impossible_fields_are_errors() {
    let error = |entity: Entity, message: &str| error_here(&lit_with(vec![shape(entity)]), message);
    let z = floats(&[0.0, 1.0, 2.0, 3.0]);
    error(field().with("z", z.clone()), "not \"nu\" times \"nv\"");
    let row = field().with("z", z).with("nu", integers(&[4])).with("nv", integers(&[1]));
    error(row, "4 by 1 heights make no field");
    error(field().with("hurst", floats(&[2.0])), "\"hurst\" must lie between 0 and 1");
    error(field().with("amplitude", floats(&[f32::INFINITY])), "and finite ones");
    error(field().with("filename", strings(&["gone.png"])), "was not loaded");
    let shallow = field().with("levels", integers(&[0]));
    warning_here(&lit_with(vec![shape(shallow)]), "\"levels\" must be between 1 and 11");
}

/// A fractal grows from a mesh, and its border stays.
#[test]
fn fractals_grow_from_meshes() {
    let entity = Entity { type_name: "fractal".to_owned(), ..square() };
    let fractal = entity.clone().with("levels", integers(&[4]));
    let scene = scene(&lit_with(vec![shape(fractal)]));
    assert_eq!(scene.geometry.counts().n_triangles, 2 * 256);
    let bounds = scene.bounds();
    assert!(bounds.max.z > bounds.min.z, "{bounds:?}");
    let many = here(entity.with("levels", integers(&[12])));
    error_here(&lit_with(vec![shape(many)]), "triangles or more");
}

/// Displacement by a constant lifts a square, in object space; edges are split in the world.
#[test]
fn textures_displace_meshes() {
    let displaced = |length: f32| {
        here(square().with("displacement", floats(&[0.25])).with("edgelength", floats(&[length])))
    };
    let scene = scene(&lit_with(vec![shape(displaced(0.5))]));
    assert!((height(&scene, 0.1, 0.2) - 0.25).abs() < 1e-6);
    assert!(scene.geometry.counts().n_triangles >= 32);
    error_here(&lit_with(vec![shape(displaced(0.0))]), "\"edgelength\" must be positive");
    error_here(&lit_with(vec![shape(displaced(1e-6))]), "triangles or more");
    let nan = here(square().with("displacement", floats(&[f32::NAN])));
    error_here(&lit_with(vec![shape(nan)]), "has the value NaN");
}
