//! Meshes: from parameters and loaded files to shapes.

use std::collections::HashMap;
use std::sync::Arc;

use etendue_geometry::{BilinearMesh, Shape, TriangleMesh, loop_subdivide};
use etendue_math::{Normal3, Point2, Vector3};

use crate::assets::LoadedMesh;
use crate::diagnostics::Span;
use crate::document::{ShapeEntity, Value};
use crate::parameters::Parameters;
use crate::texture::{AttributeId, Corners, MeshAttributes, ShapeAttribute};

/// Loop subdivision multiplies faces by four at each step; more than this exhausts memory.
const MAX_SUBDIVISION_LEVELS: i32 = 10;

/// Shapes whose `filename` is that of a mesh.
pub const MESH_FILES: &[&str] = &["plymesh", "fractal"];
/// Parameters with names of such files.
pub const MESH_FILE_PARAMETERS: &[&str] = &["filename", "filename1"];

/// Meshes from files, moved out at their last use and copied before.
#[derive(Debug, Default)]
pub(super) struct MeshStore {
    meshes: HashMap<String, (Arc<LoadedMesh>, usize)>,
    /// Attributes of the shapes of the mesh that was read last, in their order; those that textures name.
    pub(super) attributes: Vec<Vec<(AttributeId, ShapeAttribute)>>,
}

impl MeshStore {
    pub(super) fn new<'d>(
        mut loaded: HashMap<String, Arc<LoadedMesh>>,
        shapes: impl Iterator<Item = &'d ShapeEntity>,
    ) -> Self {
        let mut meshes: HashMap<String, (Arc<LoadedMesh>, usize)> = HashMap::new();
        for shape in shapes {
            for name in mesh_files(shape) {
                if let Some(entry) = meshes.get_mut(name) {
                    entry.1 += 1;
                } else if let Some(mesh) = loaded.remove(name) {
                    meshes.insert(name.to_owned(), (mesh, 1));
                }
            }
        }
        Self { meshes, attributes: Vec::new() }
    }

    pub(super) fn take(&mut self, name: &str) -> Option<LoadedMesh> {
        let entry = self.meshes.get_mut(name)?;
        entry.1 -= 1;
        if entry.1 > 0 {
            return Some(LoadedMesh::clone(&entry.0));
        }
        self.meshes.remove(name).map(|(mesh, _)| Arc::unwrap_or_clone(mesh))
    }
}

fn mesh_files(shape: &ShapeEntity) -> impl Iterator<Item = &str> {
    let type_name = shape.entity.type_name.as_str();
    let is_mesh = MESH_FILES.contains(&type_name) || type_name == "points";
    let names = move |name: &'static str| {
        let parameter = shape.entity.parameters.iter().find(|p| p.name == name)?;
        match &parameter.value {
            Value::Strings(names) if is_mesh => names.first().map(String::as_str),
            _ => None,
        }
    };
    MESH_FILE_PARAMETERS.iter().filter_map(move |name| names(name))
}

/// Integers of a parameter as groups of N vertex numbers; a remainder or a negative number is reported.
fn read_indices<const N: usize>(p: &mut Parameters<'_, '_>, default: [u32; N]) -> Option<Vec<[u32; N]>> {
    let Some(values) = p.integers("indices") else {
        return Some(vec![default]);
    };
    let span = p.span_of("indices");
    let (groups, rest) = values.as_chunks::<N>();
    if !rest.is_empty() {
        let message = format!("\"indices\" has {} numbers, not a multiple of {N}", values.len());
        p.diagnostics().error(span, message);
        return None;
    }
    if let Some(negative) = values.iter().find(|v| **v < 0) {
        p.diagnostics().error(span, format!("\"indices\" has the negative number {negative}"));
        return None;
    }
    Some(groups.iter().map(|group| group.map(|v| v as u32)).collect())
}

/// An optional vertex attribute; a count that differs from that of the vertices is reported and drops it.
pub(super) fn per_vertex<T: Clone>(
    p: &mut Parameters<'_, '_>,
    name: &'static str,
    values: Option<&[T]>,
    n_vertices: usize,
) -> Vec<T> {
    let values = values.unwrap_or_default();
    if values.is_empty() || values.len() == n_vertices {
        return values.to_vec();
    }
    let span = p.span_of(name);
    let message = format!("\"{name}\" has {} values for {n_vertices} vertices; it is ignored", values.len());
    p.diagnostics().warning(span, message);
    Vec::new()
}

/// Texture coordinates, as points or as plain floats in pairs.
fn read_uvs(p: &mut Parameters<'_, '_>, n_vertices: usize) -> Vec<Point2> {
    let name = if p.has("st") && !p.has("uv") { "st" } else { "uv" };
    let pairs: Option<Vec<Point2>> = match p.find(name).map(|parameter| &parameter.value) {
        Some(Value::Floats(values)) => {
            Some(values.as_chunks::<2>().0.iter().map(|[u, v]| Point2::new(*u, *v)).collect())
        }
        _ => p.points2(name).map(<[Point2]>::to_vec),
    };
    per_vertex(p, name, pairs.as_deref(), n_vertices)
}

fn read_face_indices(p: &mut Parameters<'_, '_>) -> Vec<i32> {
    p.integers("faceIndices").unwrap_or_default().to_vec()
}

fn report_mesh<E: std::fmt::Display>(
    p: &mut Parameters<'_, '_>,
    span: Option<Span>,
    result: Result<(), E>,
) -> Option<()> {
    match result {
        Ok(()) => Some(()),
        Err(error) => {
            p.diagnostics().error(span, error.to_string());
            None
        }
    }
}

pub(super) fn read_triangle_mesh(p: &mut Parameters<'_, '_>) -> Option<TriangleMesh> {
    let positions = p.points3("P").unwrap_or_default().to_vec();
    if positions.is_empty() {
        p.missing("P", "a triangle mesh needs vertex positions \"P\"");
        return None;
    }
    if !p.has("indices") && positions.len() != 3 {
        p.missing("indices", "a triangle mesh of more than one triangle needs \"indices\"");
        return None;
    }
    let n = positions.len();
    let indices = read_indices::<3>(p, [0, 1, 2]);
    let normals: Option<&[Normal3]> = p.normals3("N");
    let normals = per_vertex(p, "N", normals, n);
    let tangents: Option<&[Vector3]> = p.vectors3("S");
    let tangents = per_vertex(p, "S", tangents, n);
    let uvs = read_uvs(p, n);
    let face_indices = read_face_indices(p);
    let mesh = TriangleMesh { positions, indices: indices?, normals, tangents, uvs, face_indices };
    let span = p.span_of("indices");
    report_mesh(p, span, mesh.validate())?;
    Some(mesh)
}

pub(super) fn read_bilinear_mesh(p: &mut Parameters<'_, '_>) -> Option<BilinearMesh> {
    let positions = p.points3("P").unwrap_or_default().to_vec();
    if positions.is_empty() {
        p.missing("P", "a bilinear mesh needs vertex positions \"P\"");
        return None;
    }
    let n = positions.len();
    let indices = read_indices::<4>(p, [0, 1, 2, 3]);
    let normals: Option<&[Normal3]> = p.normals3("N");
    let normals = per_vertex(p, "N", normals, n);
    let uvs = read_uvs(p, n);
    let face_indices = read_face_indices(p);
    if p.has("emissionfilename") {
        p.ignore("emissionfilename");
        let span = p.span_of("emissionfilename");
        p.diagnostics().warning(span, "\"emissionfilename\" only guides sampling; it is not used");
    }
    let mesh = BilinearMesh { positions, indices: indices?, normals, uvs, face_indices };
    let span = p.span_of("indices");
    report_mesh(p, span, mesh.validate())?;
    Some(mesh)
}

pub(super) fn read_loop_subdivision(p: &mut Parameters<'_, '_>) -> Option<Shape> {
    let levels = p.integer("levels", 3);
    p.ignore("scheme");
    let mesh = read_triangle_mesh(p)?;
    if !(0..=MAX_SUBDIVISION_LEVELS).contains(&levels) {
        let span = p.span_of("levels");
        p.diagnostics()
            .error(span, format!("\"levels\" must lie between 0 and {MAX_SUBDIVISION_LEVELS}, not {levels}"));
        return None;
    }
    Some(Shape::Triangles(loop_subdivide(&mesh, levels as u32)))
}

pub(super) fn read_ply_mesh(
    p: &mut Parameters<'_, '_>,
    meshes: &mut MeshStore,
    wanted: &MeshAttributes,
) -> Vec<Shape> {
    let Some(name) = p.string_opt("filename").filter(|name| !name.is_empty()) else {
        let message = format!("a \"{}\" needs a \"filename\"", p.entity().type_name);
        p.missing("filename", message);
        return Vec::new();
    };
    // A file that could not be read was reported when it was loaded.
    let Some(mesh) = meshes.take(&name) else {
        return Vec::new();
    };
    meshes.attributes = attributes_of_parts(&mesh, wanted);
    split_loaded_mesh(p, mesh)
}

/// Attributes of the shapes that [`split_loaded_mesh`] makes.
fn attributes_of_parts(
    mesh: &LoadedMesh,
    wanted: &MeshAttributes,
) -> Vec<Vec<(AttributeId, ShapeAttribute)>> {
    let mut parts = Vec::new();
    if !mesh.quads.is_empty() {
        let corners = || Corners::Patches(mesh.quads.clone());
        parts.push(wanted.of_shape(&mesh.attributes, corners, mesh.triangles.len()));
    }
    if !mesh.triangles.is_empty() {
        let corners = || Corners::Triangles(mesh.triangles.clone());
        parts.push(wanted.of_shape(&mesh.attributes, corners, 0));
    }
    parts
}

/// Triangles and quadrilaterals of a file as separate shapes.
pub(super) fn split_loaded_mesh(p: &mut Parameters<'_, '_>, mesh: LoadedMesh) -> Vec<Shape> {
    let LoadedMesh { triangles, quads, positions, normals, tangents, uvs, mut face_indices, attributes: _ } =
        mesh;
    let quad_faces = if face_indices.len() > triangles.len() {
        face_indices.split_off(triangles.len())
    } else {
        Vec::new()
    };
    let span = p.span_of("filename");
    let mut shapes = Vec::new();
    if !quads.is_empty() {
        let patches = BilinearMesh {
            positions: positions.clone(),
            indices: quads,
            normals: normals.clone(),
            uvs: uvs.clone(),
            face_indices: quad_faces,
        };
        if report_mesh(p, span, patches.validate()).is_some() {
            shapes.push(Shape::Bilinear(patches));
        }
    }
    if !triangles.is_empty() {
        let mesh = TriangleMesh { positions, indices: triangles, normals, tangents, uvs, face_indices };
        if report_mesh(p, span, mesh.validate()).is_some() {
            shapes.push(Shape::Triangles(mesh));
        }
    }
    shapes
}
