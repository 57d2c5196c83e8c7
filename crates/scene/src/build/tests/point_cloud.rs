//! Point-sampled surfaces from parameters and files.

use super::*;
use crate::assets::LoadedMesh;

/// A square of 20 by 20 points.
fn grid() -> Vec<[f32; 3]> {
    (0..400).map(|i| [(i % 20) as f32 / 10.0 - 1.0, (i / 20) as f32 / 10.0 - 1.0, 0.0]).collect()
}

fn cloud() -> Entity {
    here(Entity::new("points"))
}

/// Points have the radii that are given, or those of their neighbours, and normals by neighbours if there are none.
#[test]
fn points_are_a_surface() {
    let surface = cloud().with("P", points(&grid()));
    let thin = surface.clone().with("radius", floats(&[0.01]));
    let scenes = [surface, thin].map(|entity| scene(&lit_with(vec![shape(entity)])));
    let n_hits = scenes.map(|scene| {
        assert_eq!(scene.geometry.counts().n_points, 400);
        (0..100).filter(|i| below(&scene, 0.017 * *i as f32 - 0.9, 0.3 + 0.003 * *i as f32).is_some()).count()
    });
    assert!(n_hits[0] == 100 && n_hits[1] < 20, "{n_hits:?}");
}

/// A file of points needs no faces.
#[test]
fn points_come_from_files() {
    let positions = grid().iter().map(|p| Point3::new(p[0], p[1], p[2])).collect();
    let mesh = LoadedMesh { positions, ..LoadedMesh::default() };
    let assets = Assets { meshes: HashMap::from([("a.ply".to_owned(), mesh.into())]), ..Assets::default() };
    let (scene, problems) =
        build_with(&lit_with(vec![shape(cloud().with("filename", strings(&["a.ply"])))]), assets);
    assert!(problems.is_empty(), "{problems:?}");
    assert!(below(&scene.expect("no problem was reported"), 0.111, 0.222).is_some());
}

/// What is wrong with points is said.
#[test]
fn impossible_points_are_errors() {
    let error = |entity: Entity, message: &str| error_here(&lit_with(vec![shape(entity)]), message);
    error(cloud(), "needs positions \"P\"");
    error(cloud().with("P", points(&[[f32::NAN; 3]])), "point 0 is not finite");
    let two = cloud().with("P", points(&[[0.0; 3], [1.0; 3]]));
    error(two.clone().with("radius", floats(&[1.0, 2.0, 3.0])), "3 entries instead of 2");
    error(two.with("radius", floats(&[-1.0])), "radii: entry 0");
}
