//! Meshes whose vertices move while the shutter is open.

use etendue_geometry::{MovingMesh, Shape};
use etendue_math::{Normal3, Point3};

use crate::parameters::{ParameterSpec, Parameters, spec};

use super::heights::triangulated;
use super::meshes::{MeshStore, per_vertex, split_loaded_mesh};

/// Vertices of a `trianglemesh` at the end.
pub(super) const P1: ParameterSpec = spec(
    "P1",
    "point3",
    "",
    "m",
    "vertex positions at the end of the motion, to which they go in straight lines",
);
/// Their normals.
pub(super) const N1: ParameterSpec = spec("N1", "normal", "", "", "vertex normals then");
/// The mesh of a `plymesh` at the end.
pub(super) const FILENAME_1: ParameterSpec = spec(
    "filename1",
    "string",
    "",
    "",
    "PLY file with the same faces and the vertices at the end of the motion",
);

/// The shapes, as one that moves if parameters give a second place for each vertex. `times` are those of the transform.
pub(super) fn moved(
    p: &mut Parameters<'_, '_>,
    shapes: Vec<Shape>,
    meshes: &mut MeshStore,
    times: [f32; 2],
) -> Vec<Shape> {
    let name = if p.entity().type_name == "plymesh" { "filename1" } else { "P1" };
    if !p.has(name) {
        return shapes;
    }
    if p.has("displacement") {
        let span = p.span_of(name);
        p.diagnostics().warning(span, format!("a displaced mesh cannot move; \"{name}\" is ignored"));
        p.ignore(name);
        return shapes;
    }
    let has_quads = shapes.iter().any(|shape| !matches!(shape, Shape::Triangles(_)));
    if has_quads && meshes.attributes.iter().any(|attributes| !attributes.is_empty()) {
        let message = "a moving mesh of quadrilaterals is made of triangles and loses what textures read of its vertices and faces";
        let span = p.span_of(name);
        p.diagnostics().warning(span, message).with_help("make it of triangles");
        meshes.attributes.clear();
    }
    let Some(mesh) = triangulated(shapes) else { return Vec::new() };
    let end = if name == "P1" {
        let positions = p.points3("P1").unwrap_or_default().to_vec();
        let normals = p.normals3("N1");
        let normals = per_vertex(p, "N1", normals, mesh.positions.len());
        Some((positions, normals))
    } else {
        read_end(p, meshes, &mesh.indices)
    };
    let Some((end_positions, mut end_normals)) = end else { return Vec::new() };
    if mesh.normals.is_empty() {
        end_normals.clear();
    }
    let moving = MovingMesh { mesh, end_positions, end_normals, times };
    if let Err(error) = moving.validate() {
        let span = p.span_of(name);
        p.diagnostics().error(span, error.to_string());
        return Vec::new();
    }
    vec![Shape::Moving(moving)]
}

/// The vertices of a second file, whose faces must be these.
fn read_end(
    p: &mut Parameters<'_, '_>,
    meshes: &mut MeshStore,
    faces: &[[u32; 3]],
) -> Option<(Vec<Point3>, Vec<Normal3>)> {
    let name = p.string_opt("filename1")?;
    // A file that could not be read was reported when it was loaded.
    let loaded = meshes.take(&name)?;
    let mesh = triangulated(split_loaded_mesh(p, loaded))?;
    if mesh.indices != faces {
        let span = p.span_of("filename1");
        p.diagnostics().error(span, format!("the faces of \"{name}\" are not those of the first file"));
        return None;
    }
    Some((mesh.positions, mesh.normals))
}
