//! Meshes in the Stanford polygon format (Turk 1994, "The PLY Polygon File Format"): ASCII and binary, also
//! compressed by gzip. Written is the binary, little-endian form ([`write_ply`]).
//!
//! Read are the vertices' positions, normals and texture coordinates, the faces with their `face_indices`, and further
//! numbers of both as attributes; other elements are skipped. Triangles stay, quadrilaterals become bilinear patches as in pbrt, larger
//! polygons are cut into fans. The header's counts are checked against the size of the file before memory is taken.

mod attributes;
mod body;
mod header;
mod scene;
mod write;

#[cfg(test)]
mod tests;

use std::fmt;

use etendue_math::{Normal3, Point2, Point3};
use etendue_scene::{AttributeDomain, LoadedMesh};

use crate::file::decompressed;
use attributes::{Column, columns_of};
use body::Body;
use header::{Element, Header, PropertyKind};
pub use scene::read_bare_ply;
pub use write::write_ply;

/// A mesh with what was odd about its file.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct PlyMesh {
    /// The mesh.
    pub mesh: LoadedMesh,
    /// What was changed or left out, one sentence each.
    pub warnings: Vec<String>,
}

/// Why bytes are not a mesh.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum PlyError {
    /// The compressed stream is damaged, with the reason.
    Gzip(String),
    /// The header breaks the format: the line, from 1, and what is wrong.
    Header(usize, String),
    /// The data ends early: name of the element, index of its first item that is missing, and the number declared.
    Truncated(String, u64, u64),
    /// A word of an ASCII file is no number: name of the element, its index, and the word.
    NotANumber(String, u64, String),
    /// The vertex of that index has a coordinate that is infinite or not a number.
    NotFinite(u64),
    /// The face of that index refers to a vertex that does not exist: the face, the index, the number of vertices.
    BadIndex(u64, i64, usize),
    /// The file lacks something: what.
    Missing(&'static str),
}

impl fmt::Display for PlyError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Gzip(why) => write!(f, "cannot decompress: {why}"),
            Self::Header(line, why) => write!(f, "line {line} of the header: {why}"),
            Self::Truncated(element, index, count) => {
                write!(f, "the data ends at {element} {index} of {count} that the header declares")
            }
            Self::NotANumber(element, index, word) => {
                write!(f, "{element} {index}: `{word}` is not a number")
            }
            Self::NotFinite(index) => write!(f, "vertex {index} has a coordinate that is not finite"),
            Self::BadIndex(face, index, n_vertices) => {
                write!(f, "face {face} refers to vertex {index}, but there are {n_vertices} vertices")
            }
            Self::Missing(what) => write!(f, "the file has no {what}"),
        }
    }
}

impl std::error::Error for PlyError {}

/// Reads a mesh.
///
/// # Errors
/// If the bytes are no PLY file, or a damaged one.
pub fn read_ply(bytes: &[u8]) -> Result<PlyMesh, PlyError> {
    let ply = read_ply_points(bytes)?;
    if ply.mesh.triangles.is_empty() && ply.mesh.quads.is_empty() {
        return Err(PlyError::Missing("faces"));
    }
    Ok(ply)
}

/// Reads vertices, and faces if there are any.
///
/// # Errors
/// If the bytes are no PLY file, or a damaged one.
pub fn read_ply_points(bytes: &[u8]) -> Result<PlyMesh, PlyError> {
    let bytes = decompressed(bytes).map_err(PlyError::Gzip)?;
    let header = Header::parse(&bytes)?;
    let mut body = Body::new(&bytes[header.data_start..], header.encoding);
    let mut reader = Reader::default();
    for element in &header.elements {
        body.check_size(element)?;
        match element.name.as_str() {
            "vertex" => reader.vertices(&mut body, element)?,
            "face" => reader.faces(&mut body, element)?,
            _ => body.skip(element)?,
        }
    }
    reader.finish()
}

/// Collects the mesh.
#[derive(Debug, Default)]
struct Reader {
    ply: PlyMesh,
    quad_face_indices: Vec<i32>,
    attributes: Vec<Column>,
    n_cut: usize,
    n_degenerate: usize,
    has_vertices: bool,
}

/// Names of texture coordinates in use.
const UV_NAMES: [[&str; 2]; 4] =
    [["u", "v"], ["s", "t"], ["texture_u", "texture_v"], ["texture_s", "texture_t"]];

impl Reader {
    fn vertices(&mut self, body: &mut Body<'_>, element: &Element) -> Result<(), PlyError> {
        self.has_vertices = true;
        let column = |name: &str| element.scalar(name);
        let (Some(x), Some(y), Some(z)) = (column("x"), column("y"), column("z")) else {
            return Err(PlyError::Missing("vertex properties x, y and z"));
        };
        let normal = match (column("nx"), column("ny"), column("nz")) {
            (Some(nx), Some(ny), Some(nz)) => Some([nx, ny, nz]),
            _ => None,
        };
        let uv = UV_NAMES.iter().find_map(|[u, v]| Some([column(u)?, column(v)?]));
        let mut attributes = columns_of(element, AttributeDomain::Vertex);
        let mesh = &mut self.ply.mesh;
        mesh.positions.reserve_exact(element.count as usize);
        mesh.normals.reserve_exact(if normal.is_some() { element.count as usize } else { 0 });
        mesh.uvs.reserve_exact(if uv.is_some() { element.count as usize } else { 0 });
        let mut row = vec![0.0_f64; element.properties.len()];
        for index in 0..element.count {
            body.scalars(element, index, &mut row)?;
            let at = |column: usize| row[column] as f32;
            let p = Point3::new(at(x), at(y), at(z));
            if !p.is_finite() {
                return Err(PlyError::NotFinite(index));
            }
            mesh.positions.push(p);
            if let Some([nx, ny, nz]) = normal {
                mesh.normals.push(Normal3::new(at(nx), at(ny), at(nz)));
            }
            if let Some([u, v]) = uv {
                mesh.uvs.push(Point2::new(at(u), at(v)));
            }
            attributes.iter_mut().for_each(|column| column.push(&row, 1));
        }
        self.attributes.append(&mut attributes);
        Ok(())
    }

    fn faces(&mut self, body: &mut Body<'_>, element: &Element) -> Result<(), PlyError> {
        let list = element.properties.iter().position(|property| {
            matches!(property.kind, PropertyKind::List { .. })
                && matches!(property.name.as_str(), "vertex_indices" | "vertex_index")
        });
        let Some(list) = list else { return Err(PlyError::Missing("face property `vertex_indices`")) };
        let face_index = element.scalar("face_indices");
        self.ply.mesh.triangles.reserve_exact(element.count as usize);
        let mut attributes = columns_of(element, AttributeDomain::Face);
        let mut corners = Vec::with_capacity(4);
        let mut row = vec![0.0_f64; element.properties.len()];
        for index in 0..element.count {
            body.list_and_scalars(element, index, list, &mut corners, &mut row)?;
            let n = self.ply.mesh.positions.len();
            if self.has_vertices
                && let Some(bad) = corners.iter().find(|i| **i < 0 || **i >= n as i64)
            {
                return Err(PlyError::BadIndex(index, *bad, n));
            }
            self.face(&corners, face_index.map(|column| row[column] as i32));
            for column in &mut attributes {
                match corners.len() {
                    4 => column.push_quad(&row),
                    n => column.push(&row, n.saturating_sub(2)),
                }
            }
        }
        self.attributes.append(&mut attributes);
        Ok(())
    }

    fn face(&mut self, corners: &[i64], face_index: Option<i32>) {
        // Indices that do not fit become ones that surely do not exist; `finish` finds them.
        let vertex = |i: usize| u32::try_from(corners[i]).unwrap_or(u32::MAX);
        let mesh = &mut self.ply.mesh;
        match corners.len() {
            0..=2 => self.n_degenerate += 1,
            3 => {
                mesh.triangles.push([vertex(0), vertex(1), vertex(2)]);
                mesh.face_indices.extend(face_index);
            }
            4 => {
                mesh.quads.push([vertex(0), vertex(1), vertex(3), vertex(2)]);
                self.quad_face_indices.extend(face_index);
            }
            n => {
                self.n_cut += 1;
                for i in 1..n - 1 {
                    mesh.triangles.push([vertex(0), vertex(i), vertex(i + 1)]);
                    mesh.face_indices.extend(face_index);
                }
            }
        }
    }

    fn finish(mut self) -> Result<PlyMesh, PlyError> {
        let mesh = &mut self.ply.mesh;
        if !self.has_vertices {
            return Err(PlyError::Missing("element `vertex`"));
        }
        check_indices(mesh)?;
        mesh.face_indices.append(&mut self.quad_face_indices);
        mesh.triangles.shrink_to_fit();
        let warnings = &mut self.ply.warnings;
        if self.n_cut > 0 {
            warnings
                .push(format!("{} polygons of more than four corners were cut into triangles", self.n_cut));
        }
        if self.n_degenerate > 0 {
            warnings.push(format!("{} faces of less than three corners were left out", self.n_degenerate));
        }
        if !mesh.normals.iter().all(|n| n.is_finite()) {
            mesh.normals.clear();
            warnings.push("the normals were left out, as some are not finite".to_owned());
        }
        if !mesh.uvs.iter().all(|uv| uv.is_finite()) {
            mesh.uvs.clear();
            warnings.push("the texture coordinates were left out, as some are not finite".to_owned());
        }
        self.ply.mesh.attributes = self.attributes.into_iter().filter_map(Column::finish).collect();
        Ok(self.ply)
    }
}

/// Done once more at the end, since faces may stand before the vertices.
fn check_indices(mesh: &LoadedMesh) -> Result<(), PlyError> {
    let n = mesh.positions.len();
    let bad = |corners: &[u32]| corners.iter().copied().find(|i| *i as usize >= n);
    let triangles = mesh.triangles.iter().map(|corners| corners.as_slice());
    let quads = mesh.quads.iter().map(|corners| corners.as_slice());
    for (face, corners) in triangles.chain(quads).enumerate() {
        if let Some(index) = bad(corners) {
            return Err(PlyError::BadIndex(face as u64, i64::from(index), n));
        }
    }
    Ok(())
}
