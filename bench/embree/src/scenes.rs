//! Models from scene files.

use std::path::Path;

use etendue_geometry::TriangleMesh;
use etendue_io::{load_assets, read_pbrt};
use etendue_lab::speed::{Lamp, Model};
use etendue_math::{Point3, Vector3};
use etendue_scene::LoadedMesh;
use etendue_scene::document::{ShapeEntity, Value};

/// The car of `bmw-m6`, with the camera of its file and a lamp above; `None` if the file is not there.
pub(crate) fn bmw_m6(scenes: &Path) -> Option<Model> {
    let (document, _) = read_pbrt(&scenes.join("bmw-m6/bmw-m6.pbrt"));
    let (assets, _) = load_assets(&document);
    let mesh = |shape: &ShapeEntity| {
        let file = shape.entity.parameters.iter().find_map(|parameter| match &parameter.value {
            Value::Strings(names) if parameter.name == "filename" => names.first(),
            _ => None,
        })?;
        Some(world_mesh(shape, assets.meshes.get(file)?))
    };
    let meshes: Vec<TriangleMesh> = document.shapes.iter().filter_map(mesh).collect();
    (!meshes.is_empty()).then(|| Model {
        name: "bmw-m6".to_owned(),
        meshes,
        copies: Vec::new(),
        eye: Point3::new(-11.0, 0.8, 5.0),
        target: Point3::new(-2.0, -0.5, 0.0),
        fov_rad: 30.0_f32.to_radians(),
        lamp: Lamp {
            corner: Point3::new(-4.0, 8.0, -2.0),
            edges: [Vector3::new(4.0, 0.0, 0.0), Vector3::new(0.0, 0.0, 4.0)],
        },
    })
}

fn world_mesh(shape: &ShapeEntity, mesh: &LoadedMesh) -> TriangleMesh {
    let place = &shape.world_from_object.start;
    let halves = mesh.quads.iter().flat_map(|[a, b, d, c]| [[*a, *b, *c], [*a, *c, *d]]);
    TriangleMesh {
        positions: mesh.positions.iter().map(|p| place.point(*p)).collect(),
        indices: mesh.triangles.iter().copied().chain(halves).collect(),
        ..TriangleMesh::default()
    }
}
