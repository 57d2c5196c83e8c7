//! What readers of meshes do when a file leaves something to them.

use etendue_math::Vector3;
use etendue_scene::{AttributeDomain, LoadedMesh};

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
            *sum += normal * a.angle_between(b);
        }
    }
    let up = Vector3::new(0.0, 0.0, 1.0);
    mesh.normals = sums.iter().map(|sum| sum.try_normalized().unwrap_or(up).as_normal()).collect();
}

/// Cuts every bilinear patch into two triangles, which follow those that are there.
pub fn split_quads(mesh: &mut LoadedMesh) {
    let (n, n_quads) = (mesh.triangles.len(), mesh.quads.len());
    for [a, b, d, c] in std::mem::take(&mut mesh.quads) {
        mesh.triangles.extend([[a, b, c], [a, c, d]]);
    }
    if mesh.face_indices.len() > n {
        let quads = mesh.face_indices.split_off(n);
        mesh.face_indices.extend(quads.into_iter().flat_map(|index| [index; 2]));
    }
    for attribute in mesh.attributes.iter_mut().filter(|a| a.domain == AttributeDomain::Face) {
        let width = attribute.n_components;
        if n_quads > 0 && width > 0 && attribute.values.len() == (n + n_quads) * width {
            let quads = attribute.values.split_off(n * width);
            attribute.values.extend(quads.chunks_exact(width).flat_map(|value| [value; 2].concat()));
        }
    }
}

/// Vertices of more triangles than this are smooth all around: to compare all their faces would take too long.
const MAX_COMPARED: usize = 64;

/// Gives every corner the mean normal of those triangles at its vertex that are turned from its own by less than
/// `crease_degrees`; vertices on creases are split. For meshes of triangles alone whose files say nothing of normals.
pub fn smooth_but_creases(mesh: &mut LoadedMesh, crease_degrees: f32) {
    let least = crease_degrees.to_radians().cos();
    let normals: Vec<Option<Vector3>> =
        mesh.triangles.iter().map(|triangle| unit_normal(mesh, triangle)).collect();
    let around = Fans::new(mesh);
    let old = std::mem::take(&mut mesh.triangles);
    // For each vertex its copies, with their normals.
    let mut copies: Vec<Vec<(Vector3, u32)>> = vec![Vec::new(); mesh.positions.len()];
    let mut origins: Vec<u32> = Vec::new();
    let mut made = Vec::with_capacity(old.len());
    for (face, triangle) in old.iter().enumerate() {
        made.push(triangle.map(|vertex| {
            let fan = around.of(vertex);
            let is_large = fan.len() > MAX_COMPARED;
            // All corners of a large fan have the same normal.
            if is_large && let Some((_, copy)) = copies[vertex as usize].first() {
                return *copy;
            }
            let sum = fan.iter().fold(Vector3::default(), |sum, other| {
                match (normals[face], normals[*other as usize]) {
                    (Some(own), Some(other)) if !is_large && own.dot(other) < least => sum,
                    (_, Some(normal)) => sum + normal * angle_at(mesh, &old[*other as usize], vertex),
                    (_, None) => sum,
                }
            });
            let normal = sum.try_normalized().unwrap_or(Vector3::new(0.0, 0.0, 1.0));
            let known =
                copies[vertex as usize].iter().find(|(known, _)| (*known - normal).length_squared() < 1e-8);
            if let Some((_, copy)) = known {
                return *copy;
            }
            let copy = origins.len() as u32;
            origins.push(vertex);
            mesh.normals.push(normal.as_normal());
            copies[vertex as usize].push((normal, copy));
            copy
        }));
    }
    mesh.triangles = made;
    mesh.tangents.clear();
    mesh.positions = origins.iter().map(|origin| mesh.positions[*origin as usize]).collect();
    if !mesh.uvs.is_empty() {
        mesh.uvs = origins.iter().map(|origin| mesh.uvs[*origin as usize]).collect();
    }
    for attribute in mesh.attributes.iter_mut().filter(|a| a.domain == AttributeDomain::Vertex) {
        let n = attribute.n_components;
        let of = |origin: &u32| attribute.values[*origin as usize * n..(*origin as usize + 1) * n].to_vec();
        attribute.values = origins.iter().flat_map(of).collect();
    }
}

/// Triangles by the vertices that they share, one list after another.
struct Fans {
    starts: Vec<u32>,
    triangles: Vec<u32>,
}

impl Fans {
    fn new(mesh: &LoadedMesh) -> Self {
        let mut starts = vec![0; mesh.positions.len() + 1];
        for vertex in mesh.triangles.iter().flatten() {
            starts[*vertex as usize + 1] += 1;
        }
        for i in 1..starts.len() {
            starts[i] += starts[i - 1];
        }
        let mut next = starts.clone();
        let mut triangles = vec![0; 3 * mesh.triangles.len()];
        for (face, triangle) in mesh.triangles.iter().enumerate() {
            for vertex in triangle {
                let slot = &mut next[*vertex as usize];
                triangles[*slot as usize] = face as u32;
                *slot += 1;
            }
        }
        Self { starts, triangles }
    }

    fn of(&self, vertex: u32) -> &[u32] {
        &self.triangles[self.starts[vertex as usize] as usize..self.starts[vertex as usize + 1] as usize]
    }
}

fn unit_normal(mesh: &LoadedMesh, triangle: &[u32; 3]) -> Option<Vector3> {
    let [a, b, c] = triangle.map(|vertex| mesh.positions[vertex as usize]);
    (b - a).cross(c - a).try_normalized()
}

/// The angle of a triangle at one of its vertices.
fn angle_at(mesh: &LoadedMesh, triangle: &[u32; 3], vertex: u32) -> f32 {
    let Some(i) = triangle.iter().position(|v| *v == vertex) else { return 0.0 };
    let at = |j: usize| mesh.positions[triangle[(i + j) % 3] as usize];
    let to = |j: usize| (at(j) - at(0)).try_normalized();
    match (to(1), to(2)) {
        (Some(a), Some(b)) => a.angle_between(b),
        _ => 0.0,
    }
}

#[cfg(test)]
mod tests {
    use etendue_math::Point3;
    use etendue_scene::MeshAttribute;

    use super::*;

    /// Both halves of a cut patch have the values of its face.
    #[test]
    fn halves_keep_the_values_of_faces() {
        let colors = MeshAttribute {
            name: "face_color".to_owned(),
            domain: AttributeDomain::Face,
            n_components: 2,
            values: vec![1.0, 2.0, 3.0, 4.0, 5.0, 6.0],
        };
        let mut mesh = LoadedMesh {
            positions: vec![Point3::ORIGIN; 4],
            triangles: vec![[0, 1, 2]],
            quads: vec![[0, 1, 2, 3]; 2],
            attributes: vec![colors],
            ..LoadedMesh::default()
        };
        split_quads(&mut mesh);
        assert_eq!(mesh.triangles.len(), 5);
        assert_eq!(mesh.attributes[0].values, [1.0, 2.0, 3.0, 4.0, 3.0, 4.0, 5.0, 6.0, 5.0, 6.0]);
    }

    /// The time that a large fan takes grows with its triangles: with their square it would be minutes here.
    #[test]
    fn large_fans_are_folded_once() {
        let n = 300_000;
        let rim = |i: u32| {
            let (sin, cos) = (i as f32 * std::f32::consts::TAU / n as f32).sin_cos();
            Point3::new(cos, sin, 0.0)
        };
        let mut mesh = LoadedMesh {
            positions: [Point3::ORIGIN].into_iter().chain((0..n).map(rim)).collect(),
            triangles: (0..n).map(|i| [0, 1 + i, 1 + (i + 1) % n]).collect(),
            ..LoadedMesh::default()
        };
        smooth_but_creases(&mut mesh, 40.0);
        assert_eq!(mesh.positions.len(), n as usize + 1);
        assert!(mesh.normals[0].z > 0.999);
    }

    /// A strip that is bent by 20 degrees is smooth there, and by 90 degrees has an edge.
    #[test]
    fn creases_split_vertices() {
        let check = |degrees: f32, n_vertices: usize| {
            let (sin, cos) = degrees.to_radians().sin_cos();
            let profile = [[-1.0, 0.0], [0.0, 0.0], [cos, sin]];
            let positions =
                profile.iter().flat_map(|[x, z]| [Point3::new(*x, 0.0, *z), Point3::new(*x, 1.0, *z)]);
            let mut mesh = LoadedMesh {
                positions: positions.collect(),
                triangles: vec![[0, 2, 3], [0, 3, 1], [2, 4, 5], [2, 5, 3]],
                ..LoadedMesh::default()
            };
            smooth_but_creases(&mut mesh, 40.0);
            assert_eq!(mesh.positions.len(), n_vertices, "{degrees}");
            assert_eq!(mesh.normals.len(), n_vertices);
            assert!(mesh.normals.iter().all(|n| n.z > -1e-6));
        };
        check(20.0, 6);
        check(90.0, 8);
    }

    /// The mean of a fan does not depend on how its polygons were cut.
    #[test]
    fn normals_are_weighted_by_angles() {
        let corner = |x, y, z| Point3::new(x, y, z);
        let positions = vec![
            corner(0.0, 0.0, 0.0),
            corner(1.0, 0.0, 0.0),
            corner(1.0, 1.0, 0.0),
            corner(0.0, 1.0, 0.0),
            corner(0.0, 0.0, 1.0),
        ];
        // A square in z = 0, cut in two, beside a triangle in x = 0.
        let mut mesh = LoadedMesh {
            positions,
            triangles: vec![[0, 1, 2], [0, 2, 3], [0, 3, 4]],
            ..LoadedMesh::default()
        };
        compute_normals(&mut mesh);
        let n = mesh.normals[0];
        assert!((n.x - n.z).abs() < 1e-6 && n.y.abs() < 1e-6, "{n:?}");
    }
}
