//! Indexed meshes of triangles and of bilinear patches.

#[cfg(test)]
mod tests;

use std::fmt;

use etendue_math::{Normal3, Point2, Point3, Vector3};

/// Triangles that share vertices. Arrays other than `positions` and `indices` are empty when absent.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct TriangleMesh {
    /// Vertices.
    pub positions: Vec<Point3>,
    /// Three vertices per triangle, counter-clockwise seen from the side of the normal in right-handed space.
    pub indices: Vec<[u32; 3]>,
    /// Shading normal per vertex, of any length.
    pub normals: Vec<Normal3>,
    /// Shading tangent per vertex.
    pub tangents: Vec<Vector3>,
    /// Texture coordinates per vertex.
    pub uvs: Vec<Point2>,
    /// Number of each face, per triangle.
    pub face_indices: Vec<i32>,
}

/// Bilinear patches that share vertices. Arrays other than `positions` and `indices` are empty when absent.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct BilinearMesh {
    /// Vertices.
    pub positions: Vec<Point3>,
    /// Four vertices per patch, in the order (u, v) = (0,0), (1,0), (0,1), (1,1).
    pub indices: Vec<[u32; 4]>,
    /// Shading normal per vertex.
    pub normals: Vec<Normal3>,
    /// Texture coordinates per vertex.
    pub uvs: Vec<Point2>,
    /// Number of each face, per patch.
    pub face_indices: Vec<i32>,
}

/// Why a mesh cannot be used.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum MeshError {
    /// A face names a vertex that does not exist.
    IndexOutOfRange {
        /// The face.
        face: usize,
        /// The index it holds.
        index: u32,
        /// Number of vertices.
        n_vertices: usize,
    },
    /// A vertex has a NaN or infinite coordinate.
    NotFinite {
        /// Which array: "positions", "normals", "tangents" or "uvs".
        array: &'static str,
        /// The vertex.
        vertex: usize,
    },
    /// An array has the wrong number of entries.
    WrongLength {
        /// Name of the array.
        array: &'static str,
        /// Entries it has.
        found: usize,
        /// Entries it should have.
        expected: usize,
    },
    /// More faces or vertices than 32-bit indices can name.
    TooLarge {
        /// Name of the array.
        array: &'static str,
        /// Entries it has.
        found: usize,
    },
}

impl fmt::Display for MeshError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::IndexOutOfRange { face, index, n_vertices } => {
                write!(f, "face {face} uses vertex {index}, but there are {n_vertices} vertices")
            }
            Self::NotFinite { array, vertex } => write!(f, "{array}: entry {vertex} is not finite"),
            Self::WrongLength { array, found, expected } => {
                write!(f, "{array}: {found} entries instead of {expected}")
            }
            Self::TooLarge { array, found } => write!(f, "{array}: {found} entries are too many"),
        }
    }
}

impl std::error::Error for MeshError {}

impl TriangleMesh {
    /// Checks indices, lengths and that every number is finite.
    pub fn validate(&self) -> Result<(), MeshError> {
        check_indices(&self.indices, self.positions.len())?;
        check_finite("positions", &self.positions, |p| p.is_finite())?;
        check_vertices("normals", &self.normals, self.positions.len(), |n| n.is_finite())?;
        check_vertices("tangents", &self.tangents, self.positions.len(), |s| s.is_finite())?;
        check_vertices("uvs", &self.uvs, self.positions.len(), |uv| uv.is_finite())?;
        check_length("face_indices", self.face_indices.len(), self.indices.len())
    }

    /// Bytes on the heap.
    #[must_use]
    pub fn memory_bytes(&self) -> usize {
        heap(&self.positions)
            + heap(&self.indices)
            + heap(&self.normals)
            + heap(&self.tangents)
            + heap(&self.uvs)
            + heap(&self.face_indices)
    }
}

impl BilinearMesh {
    /// Checks indices, lengths and that every number is finite.
    pub fn validate(&self) -> Result<(), MeshError> {
        check_indices(&self.indices, self.positions.len())?;
        check_finite("positions", &self.positions, |p| p.is_finite())?;
        check_vertices("normals", &self.normals, self.positions.len(), |n| n.is_finite())?;
        check_vertices("uvs", &self.uvs, self.positions.len(), |uv| uv.is_finite())?;
        check_length("face_indices", self.face_indices.len(), self.indices.len())
    }

    /// Bytes on the heap.
    #[must_use]
    pub fn memory_bytes(&self) -> usize {
        heap(&self.positions)
            + heap(&self.indices)
            + heap(&self.normals)
            + heap(&self.uvs)
            + heap(&self.face_indices)
    }
}

/// Bytes that a vector holds on the heap.
pub(crate) fn heap<T>(v: &Vec<T>) -> usize {
    v.capacity() * size_of::<T>()
}

fn check_indices<const N: usize>(faces: &[[u32; N]], n_vertices: usize) -> Result<(), MeshError> {
    const LIMIT: usize = u32::MAX as usize / 2;
    if faces.len() > LIMIT {
        return Err(MeshError::TooLarge { array: "indices", found: faces.len() });
    }
    if n_vertices > u32::MAX as usize {
        return Err(MeshError::TooLarge { array: "positions", found: n_vertices });
    }
    for (face, indices) in faces.iter().enumerate() {
        for &index in indices {
            if index as usize >= n_vertices {
                return Err(MeshError::IndexOutOfRange { face, index, n_vertices });
            }
        }
    }
    Ok(())
}

fn check_length(array: &'static str, found: usize, expected: usize) -> Result<(), MeshError> {
    if found == 0 || found == expected {
        return Ok(());
    }
    Err(MeshError::WrongLength { array, found, expected })
}

/// Checks the length of an array per vertex, if it is there, and that its numbers are finite.
pub(crate) fn check_vertices<T>(
    array: &'static str,
    values: &[T],
    n_vertices: usize,
    is_finite: impl Fn(&T) -> bool,
) -> Result<(), MeshError> {
    check_length(array, values.len(), n_vertices)?;
    check_finite(array, values, is_finite)
}

fn check_finite<T>(
    array: &'static str,
    values: &[T],
    is_finite: impl Fn(&T) -> bool,
) -> Result<(), MeshError> {
    match values.iter().position(|value| !is_finite(value)) {
        Some(vertex) => Err(MeshError::NotFinite { array, vertex }),
        None => Ok(()),
    }
}
