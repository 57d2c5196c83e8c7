//! Meshes in the format of Wavefront (`.obj`) with their materials (`.mtl`).
//!
//! Read are polygons, concave ones too, with negative indices, normals, texture coordinates and smoothing groups; faces of
//! one material make one shape. Curves, surfaces, lines and points are skipped. A face without normals is flat unless it
//! has a smoothing group; where a scene's file has neither, faces are smooth but for creases.

mod materials;
mod mesh;
mod mtl;
mod parse;
mod polygon;
mod scene;
#[cfg(test)]
mod tests;

use etendue_scene::diagnostics::{FileId, Severity};
use etendue_scene::{Diagnostics, LoadedMesh};

pub use scene::{read_obj, read_obj_bytes};

pub(crate) use scene::bare_material;

/// Reads all faces of a file as one mesh, with what was odd about it.
///
/// # Errors
/// The first problem, with its line.
pub fn read_obj_mesh(bytes: &[u8]) -> Result<(LoadedMesh, Vec<String>), String> {
    let text = String::from_utf8_lossy(bytes);
    let mut diagnostics = Diagnostics::default();
    let obj = parse::parse(&text, FileId(0), &mut diagnostics);
    let mut warnings = Vec::new();
    for problem in diagnostics.list() {
        let start = problem.span.map_or(0, |span| span.start as usize);
        let line = text.as_bytes()[..start].iter().filter(|byte| **byte == b'\n').count() + 1;
        let message = format!("line {line}: {}", problem.message);
        if problem.severity == Severity::Error {
            return Err(message);
        }
        warnings.push(message);
    }
    if obj.faces.is_empty() {
        return Err("the file has no faces".to_owned());
    }
    Ok((mesh::whole_mesh(&obj), warnings))
}
