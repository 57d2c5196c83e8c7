//! What readers of meshes do when a file leaves something to them.

use etendue_math::Vector3;
use etendue_scene::LoadedMesh;

/// Gives every vertex the mean normal of its triangles, weighted by their angles there (Thürmer and Wüthrich 1998,
/// "Computing Vertex Normals from Polygonal Facets"): it does not depend on how polygons were cut. Quadrilaterals do not
/// count; a vertex without triangles gets +z.
pub fn compute_normals(mesh: &mut LoadedMesh) {
    let mut sums = vec![Vector3::default(); mesh.positions.len()];
    for triangle in &mesh.triangles {
        let corners = triangle.map(|vertex| mesh.positions[vertex as usize]);
        let normal = (corners[1] - corners[0]).cross(corners[2] - corners[0]);
        let Some(normal) = normal.try_normalized() else { continue };
        for i in 0..3 {
            let to = |j: usize| (corners[(i + j) % 3] - corners[i]).try_normalized();
            let (Some(a), Some(b)) = (to(1), to(2)) else { continue };
            let sum = &mut sums[triangle[i] as usize];
            *sum = *sum + normal * a.angle_between(b);
        }
    }
    let up = Vector3::new(0.0, 0.0, 1.0);
    mesh.normals = sums.iter().map(|sum| sum.try_normalized().unwrap_or(up).as_normal()).collect();
}

/// Cuts every bilinear patch into two triangles, which follow those that are there.
pub fn split_quads(mesh: &mut LoadedMesh) {
    let n = mesh.triangles.len();
    for [a, b, d, c] in std::mem::take(&mut mesh.quads) {
        mesh.triangles.extend([[a, b, c], [a, c, d]]);
    }
    if mesh.face_indices.len() > n {
        let quads = mesh.face_indices.split_off(n);
        mesh.face_indices.extend(quads.into_iter().flat_map(|index| [index; 2]));
    }
}
