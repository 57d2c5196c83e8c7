//! Meshes from parameters and from files.

use std::sync::Arc;

use etendue_math::Point2;

use super::*;
use crate::assets::LoadedMesh;

#[track_caller]
fn mesh_error(entity: Entity, message: &str) {
    error_here(&lit_with(vec![shape(here(entity))]), message);
}

/// A mesh that cannot be what was meant is an error, not a crash: numbers of vertices that do not exist would read
/// beyond the arrays.
#[test]
fn impossible_meshes_are_errors() {
    let triangle = points(&[[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]]);
    let mesh = |positions: &Value, indices: &[i32]| {
        Entity::new("trianglemesh").with("P", positions.clone()).with("indices", integers(indices))
    };
    mesh_error(Entity::new("trianglemesh"), "needs vertex positions");
    mesh_error(Entity::new("bilinearmesh"), "needs vertex positions");
    mesh_error(Entity::new("loopsubdiv"), "needs vertex positions");
    mesh_error(mesh(&triangle, &[0, 1]), "has 2 numbers, not a multiple of 3");
    mesh_error(mesh(&triangle, &[0, 1, -2]), "has the negative number -2");
    mesh_error(mesh(&triangle, &[0, 1, 3]), "face 0 uses vertex 3, but there are 3 vertices");
    let nan = points(&[[0.0, 0.0, 0.0], [1.0, f32::NAN, 0.0], [0.0, 1.0, 0.0]]);
    mesh_error(mesh(&nan, &[0, 1, 2]), "entry 1 is not finite");
    mesh_error(mesh(&triangle, &[0, 1, 2]).with("faceIndices", integers(&[1, 2])), "2 entries instead of 1");
    let four = points(&[[0.0; 3]; 4]);
    mesh_error(Entity::new("trianglemesh").with("P", four.clone()), "needs \"indices\"");
    let patch = Entity::new("bilinearmesh").with("P", four.clone());
    mesh_error(patch.clone().with("indices", integers(&[0, 1, 2])), "not a multiple of 4");
    mesh_error(patch.with("indices", integers(&[0, 1, 2, 4])), "uses vertex 4");
    let control = Entity { type_name: "loopsubdiv".to_owned(), ..mesh(&triangle, &[0, 1, 2]) };
    mesh_error(control.clone().with("levels", integers(&[-1])), "\"levels\" must lie between");
    mesh_error(control.with("levels", integers(&[40])), "\"levels\" must lie between");
    mesh_error(Entity::new("plymesh"), "needs a \"filename\"");
}

/// An attribute with too few values is ignored, since the mesh is still there.
#[test]
fn wrong_attributes_are_ignored() {
    let normals = Value::Normals3(vec![Normal3::new(0.0, 0.0, 1.0); 3]);
    let document = lit_with(vec![shape(here(square().with("N", normals)))]);
    let scene = warning_here(&document, "\"N\" has 3 values for 4 vertices; it is ignored");
    assert!(below(&scene, 0.1, 0.2).is_some());
}

/// Texture coordinates are points or pairs of floats.
#[test]
fn texture_coordinates_have_two_forms() {
    let uv = |name: &str, value: Value| {
        let mut entity = square();
        entity.parameters.retain(|p| p.name != "uv");
        let scene = scene(&lit_with(vec![shape(entity.with(name, value))]));
        let hit = scene.intersect(&down(0.5, -0.25), f32::INFINITY).expect("the square is below");
        scene.geometry.texture_coordinates(hit.geometry, hit.primitive, hit.uv)
    };
    let pairs = floats(&[0.0, 0.0, 2.0, 0.0, 2.0, 2.0, 0.0, 2.0]);
    let corners = [(0.0, 0.0), (2.0, 0.0), (2.0, 2.0), (0.0, 2.0)].map(|(u, v)| Point2::new(u, v));
    for uv in [uv("uv", pairs.clone()), uv("st", pairs), uv("uv", Value::Points2(corners.to_vec()))] {
        assert!((uv.x - 1.5).abs() < 1e-5 && (uv.y - 0.75).abs() < 1e-5, "{uv:?}");
    }
}

/// A file with a triangle on the right of a quadrilateral, whose corners are a, b, d, c in the order of patches.
fn loaded() -> LoadedMesh {
    let corners = [(0.0, 0.0), (1.0, 0.0), (1.0, 1.0), (0.0, 1.0), (2.0, 0.0)];
    LoadedMesh {
        triangles: vec![[1, 4, 2]],
        quads: vec![[0, 1, 3, 2]],
        positions: corners.map(|(x, y)| Point3::new(x, y, 0.0)).to_vec(),
        face_indices: vec![11, 22],
        ..LoadedMesh::default()
    }
}

fn files() -> Assets {
    Assets { meshes: HashMap::from([("a.ply".to_owned(), loaded().into())]), ..Assets::default() }
}

fn ply() -> Entity {
    Entity::new("plymesh").with("filename", strings(&["a.ply"]))
}

/// Quadrilaterals and triangles of a file become two shapes of the same attributes, each with its face indices.
#[test]
fn files_may_mix_triangles_and_quadrilaterals() {
    let mut document = lit_with(vec![shape(ply())]);
    document.materials.push(named_material("red", Entity::new("diffuse")));
    document.shapes[0].material = MaterialReference::Name("red".to_owned(), None);
    let (scene, problems) = build_with(&document, files());
    assert!(problems.is_empty(), "{problems:?}");
    let scene = scene.expect("no problem was reported");
    assert_eq!(scene.attributes.len(), 2);
    assert_eq!(scene.attributes[0].material, scene.attributes[1].material);
    let counts = scene.geometry.counts();
    assert_eq!((counts.n_triangles, counts.n_patches), (1, 1));
    let face_index = |x: f32, y: f32| {
        let ray = down(x, y);
        let hit = scene.intersect(&ray, f32::INFINITY).expect("the mesh is below");
        scene.surface(&ray, &hit).point.face_index
    };
    assert_eq!((face_index(0.5, 0.6), face_index(1.2, 0.3)), (22, 11));
}

/// A file that several shapes name is the same mesh for each, in the world as in objects.
#[test]
fn shapes_may_share_a_file() {
    let at = |x: f32| still(Transform::translate(Vector3::new(x, 0.0, 0.0)));
    let shapes = [0.0, 10.0].map(|x| ShapeEntity { world_from_object: at(x), ..shape(ply()) }).to_vec();
    let objects = vec![ObjectEntity { name: "o".to_owned(), span: None, shapes: vec![shape(ply())] }];
    let instance = InstanceEntity { object: "o".to_owned(), span: None, world_from_instance: at(20.0) };
    let document = Document { objects, instances: vec![instance], ..lit_with(shapes) };
    let (scene, problems) = build_with(&document, files());
    assert!(problems.is_empty(), "{problems:?}");
    let scene = scene.expect("no problem was reported");
    assert_eq!(scene.attributes.len(), 6);
    for x in [0.0, 10.0, 20.0] {
        assert!(below(&scene, x + 0.5, 0.5).is_some() && below(&scene, x + 1.2, 0.3).is_some());
        assert!(below(&scene, x + 2.5, 0.5).is_none());
    }
}

/// A file that could not be read was reported by its reader: here its shape is just not there.
#[test]
fn files_that_were_not_read_are_left_out() {
    let (scene, problems) = build(&lit_with(vec![shape(ply()), sphere()]));
    assert!(problems.is_empty(), "{problems:?}");
    assert_eq!(scene.expect("no problem was reported").attributes.len(), 1);
}

/// Indices in a file are checked like those in parameters.
#[test]
fn files_are_checked() {
    let mut assets = files();
    Arc::make_mut(assets.meshes.get_mut("a.ply").expect("it is there")).quads[0][2] = 9;
    let (_, problems) = build_with(&lit_with(vec![shape(here(ply()))]), assets);
    only_problem(&problems, Severity::Error, "face 0 uses vertex 9");
}
