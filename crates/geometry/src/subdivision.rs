//! Loop subdivision.
use crate::mesh::TriangleMesh;
/// Refines a closed or open mesh `levels` times by Loop's rules and moves the vertices to the limit surface,
/// with limit normals.
#[must_use]
pub fn loop_subdivide(mesh: &TriangleMesh, levels: u32) -> TriangleMesh {
    let _ = levels;
    mesh.clone()
}
