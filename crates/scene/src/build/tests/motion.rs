//! Meshes that deform while the shutter is open.

use super::*;
use crate::assets::{AttributeDomain, LoadedMesh, MeshAttribute};

fn lifted() -> Entity {
    here(
        square()
            .with("P1", points(&[[-1.0, -1.0, 4.0], [1.0, -1.0, 4.0], [1.0, 1.0, 4.0], [-1.0, 1.0, 4.0]])),
    )
}

/// The square of the tests rises by 4 m in the time from 0 to 1.
#[test]
fn vertices_go_to_their_second_place() {
    let scene = scene(&lit_with(vec![shape(lifted())]));
    let height = |time: f32| {
        let ray = Ray { time, ..down(0.1, 0.2) };
        let hit = scene.intersect(&ray, f32::INFINITY).expect("the square is below");
        scene.surface(&ray, &hit).point.p.z
    };
    let start = height(0.0);
    for time in [0.25, 0.5, 1.0] {
        assert!((height(time) - (start * (1.0 - time) + 4.0 * time)).abs() < 1e-5, "{time}");
    }
    assert!(scene.bounds().max.z >= 4.0);
}

/// What does not fit is an error, and what cannot be is a warning.
#[test]
fn impossible_motions_are_reported() {
    let few = here(square().with("P1", points(&[[0.0; 3]; 3])));
    error_here(&lit_with(vec![shape(few)]), "3 entries instead of 4");
    let nan = here(square().with("P1", points(&[[f32::NAN; 3]; 4])));
    error_here(&lit_with(vec![shape(nan)]), "is not finite");
    let displaced = here(lifted().with("displacement", floats(&[0.5])));
    warning_here(&lit_with(vec![shape(displaced)]), "a displaced mesh cannot move");
    let mut document = lit_with(vec![shape(lifted())]);
    document.area_lights.push(Entity::new("diffuse"));
    document.shapes[0].area_light = Some(0);
    warning_here(&document, "meshes that deform");
}

/// A moving mesh with quadrilaterals is made of triangles: what the file says of its faces would be read on wrong ones.
#[test]
fn moving_quadrilaterals_lose_their_attributes() {
    let corners = [(0.0, 0.0), (1.0, 0.0), (1.0, 1.0), (0.0, 1.0), (2.0, 0.0)];
    let attribute = MeshAttribute {
        name: "face_weight".to_owned(),
        domain: AttributeDomain::Face,
        n_components: 1,
        values: vec![0.25, 0.75],
    };
    let mesh = LoadedMesh {
        triangles: vec![[1, 4, 2]],
        quads: vec![[0, 1, 3, 2]],
        positions: corners.map(|(x, y)| Point3::new(x, y, 0.0)).to_vec(),
        attributes: vec![attribute],
        ..LoadedMesh::default()
    };
    let warnings = |mesh: &LoadedMesh, entity: Entity| {
        let weight = Entity::new("meshattribute").with("name", strings(&["face_weight"]));
        let textures = vec![float_texture("weight", weight)];
        let leaf = here(entity).with("alpha", texture("weight"));
        let document = Document { textures, ..lit_with(vec![shape(leaf)]) };
        let meshes = ["a.ply", "b.ply"].map(|name| (name.to_owned(), mesh.clone().into()));
        let (scene, problems) = build_with(&document, Assets { meshes: meshes.into(), ..Assets::default() });
        assert!(scene.is_some(), "{problems:?}");
        problems.iter().filter(|problem| problem.message.contains("moving mesh of quadrilaterals")).count()
    };
    let still = Entity::new("plymesh").with("filename", strings(&["a.ply"]));
    let moving = still.clone().with("filename1", strings(&["b.ply"]));
    assert_eq!((warnings(&mesh, still), warnings(&mesh, moving.clone())), (0, 1));
    let triangles = LoadedMesh { quads: Vec::new(), ..mesh };
    assert_eq!(warnings(&triangles, moving), 0);
}
