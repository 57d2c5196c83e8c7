//! Writes meshes: binary, little endian, in single precision.

use std::fmt::Write;

use etendue_scene::{AttributeDomain, LoadedMesh, MeshAttribute};

/// The mesh as the bytes of a PLY file, which [`read_ply`](super::read_ply) reads back as it was.
///
/// Normals, texture coordinates, face indices and attributes are written if there is one for each vertex or face.
#[must_use]
pub fn write_ply(mesh: &LoadedMesh) -> Vec<u8> {
    let LoadedMesh { triangles, quads, positions, normals, uvs, face_indices, attributes, .. } = mesh;
    let (n_vertices, n_faces) = (positions.len(), triangles.len() + quads.len());
    let has_normals = normals.len() == n_vertices && n_vertices > 0;
    let has_uvs = uvs.len() == n_vertices && n_vertices > 0;
    let has_face_indices = face_indices.len() == n_faces && n_faces > 0;

    let whole = |attribute: &&MeshAttribute| {
        let n = if attribute.domain == AttributeDomain::Vertex { n_vertices } else { n_faces };
        attribute.n_components > 0 && attribute.values.len() == n * attribute.n_components
    };
    let attributes: Vec<&MeshAttribute> = attributes.iter().filter(whole).collect();
    let extra = |bytes: &mut Vec<u8>, domain: AttributeDomain, index: usize| {
        for attribute in attributes.iter().filter(|attribute| attribute.domain == domain) {
            let n = attribute.n_components;
            floats(bytes, &attribute.values[index * n..(index + 1) * n]);
        }
    };
    let has = [has_normals, has_uvs, has_face_indices];
    let mut bytes = header([n_vertices, n_faces], has, &attributes).into_bytes();
    bytes.reserve(n_vertices * 32 + n_faces * 21);
    for (index, p) in positions.iter().enumerate() {
        floats(&mut bytes, &[p.x, p.y, p.z]);
        if has_normals {
            let n = normals[index];
            floats(&mut bytes, &[n.x, n.y, n.z]);
        }
        if has_uvs {
            floats(&mut bytes, &[uvs[index].x, uvs[index].y]);
        }
        extra(&mut bytes, AttributeDomain::Vertex, index);
    }
    // A patch `p00 p10 p01 p11` is the polygon `p00 p10 p11 p01`.
    let polygons = quads.iter().map(|[a, b, d, c]| [*a, *b, *c, *d]);
    let mut face_index = face_indices.iter();
    let mut n_written = 0;
    let mut face = |corners: &[u32]| {
        bytes.push(corners.len() as u8);
        for corner in corners {
            bytes.extend(corner.to_le_bytes());
        }
        if has_face_indices && let Some(index) = face_index.next() {
            bytes.extend(index.to_le_bytes());
        }
        extra(&mut bytes, AttributeDomain::Face, n_written);
        n_written += 1;
    };
    triangles.iter().for_each(|corners| face(corners));
    polygons.for_each(|corners| face(&corners));
    bytes
}

fn floats(bytes: &mut Vec<u8>, values: &[f32]) {
    values.iter().for_each(|value| bytes.extend(value.to_le_bytes()));
}

/// The declarations of the properties of an attribute: `weight`, or `weight_0 weight_1`.
fn declared(attribute: &MeshAttribute) -> String {
    let name = attribute.name.trim_start_matches("vertex_").trim_start_matches("face_");
    let names = (0..attribute.n_components).map(|i| match attribute.n_components {
        1 => format!("property float {name}\n"),
        _ => format!("property float {name}_{i}\n"),
    });
    names.collect()
}

fn header(
    counts: [usize; 2],
    [normals, uvs, face_indices]: [bool; 3],
    attributes: &[&MeshAttribute],
) -> String {
    let mut text = "ply\nformat binary_little_endian 1.0\ncomment written by Etendue\n".to_owned();
    let mut properties = |names: &str, is_there: bool| {
        for name in names.split(' ').filter(|_| is_there) {
            let _ = writeln!(text, "property float {name}");
        }
    };
    properties("x y z", true);
    properties("nx ny nz", normals);
    properties("u v", uvs);
    let declare = |domain: AttributeDomain| -> String {
        attributes
            .iter()
            .filter(|attribute| attribute.domain == domain)
            .map(|attribute| declared(attribute))
            .collect()
    };
    text.push_str(&declare(AttributeDomain::Vertex));
    let vertices = text.find("property").unwrap_or(text.len());
    text.insert_str(vertices, &format!("element vertex {}\n", counts[0]));
    let _ = writeln!(text, "element face {}\nproperty list uchar uint vertex_indices", counts[1]);
    if face_indices {
        text.push_str("property int face_indices\n");
    }
    text.push_str(&declare(AttributeDomain::Face));
    text.push_str("end_header\n");
    text
}
