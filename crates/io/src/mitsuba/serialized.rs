//! Meshes in Mitsuba's own format (`.serialized`, versions 3 and 4): several meshes, each compressed by zlib, and at the
//! end of the file a table of where they begin (documentation of Mitsuba 0.6, shape plugin `serialized`).

use std::io::Read;

use etendue_math::{Normal3, Point2, Point3};
use etendue_scene::LoadedMesh;
use flate2::read::ZlibDecoder;

const MAGIC: u16 = 0x041c;
const HAS_NORMALS: u32 = 0x0001;
const HAS_UVS: u32 = 0x0002;
const HAS_COLORS: u32 = 0x0008;
const IS_DOUBLE: u32 = 0x2000;

/// Vertices, and triangles, that a mesh may have.
const MAX_COUNT: u64 = 1 << 31;

/// Bytes that a mesh may decompress to beyond [`MAX_RATIO`] times those of the file: deflate can make a thousand of one, which
/// no real mesh does.
const FREE_BYTES: u64 = 16 << 20;
const MAX_RATIO: u64 = 256;

/// The mesh of that index.
///
/// # Errors
/// Why the bytes are no such file, or have no such mesh.
pub(super) fn read_serialized(bytes: &[u8], index: usize) -> Result<LoadedMesh, String> {
    let word = |at: usize| bytes.get(at..at + 2).map(|b| u16::from_le_bytes([b[0], b[1]]));
    if word(0) != Some(MAGIC) {
        return Err("this is no serialized mesh of Mitsuba".to_owned());
    }
    let version = word(2).unwrap_or(0);
    let width = match version {
        3 => 4,
        4 => 8,
        _ => return Err(format!("version {version} is not known, but 3 and 4")),
    };
    let start = offset(bytes, width, index)?;
    let compressed = bytes.get(start + 4..).ok_or("the file is cut off")?;
    let most = FREE_BYTES + MAX_RATIO * bytes.len() as u64;
    let mut stream = ZlibDecoder::new(compressed).take(most);
    let result = read_mesh(&mut stream, version);
    result.map_err(|error| match error.kind() {
        _ if stream.limit() == 0 => format!("mesh {index} decompresses to more than {most} bytes"),
        std::io::ErrorKind::InvalidData => error.to_string(),
        _ => format!("mesh {index} is damaged: {error}"),
    })
}

/// Where the mesh begins, by the table at the end.
fn offset(bytes: &[u8], width: usize, index: usize) -> Result<usize, String> {
    let cut_off = || "the table at the end of the file is cut off".to_owned();
    let count_at = bytes.len().checked_sub(4).ok_or_else(cut_off)?;
    let count = bytes[count_at..].iter().rev().fold(0_usize, |n, byte| n << 8 | usize::from(*byte));
    if index >= count {
        return Err(format!("the file has {count} meshes, and none of index {index}"));
    }
    let at = count.checked_mul(width).and_then(|size| count_at.checked_sub(size)).ok_or_else(cut_off)?;
    let entry = &bytes[at + index * width..at + (index + 1) * width];
    let offset = entry.iter().rev().fold(0_u64, |n, byte| n << 8 | u64::from(*byte));
    usize::try_from(offset).ok().filter(|offset| *offset < at).ok_or_else(cut_off)
}

fn invalid(why: String) -> std::io::Error {
    std::io::Error::new(std::io::ErrorKind::InvalidData, why)
}

fn read_mesh(stream: &mut impl Read, version: u16) -> std::io::Result<LoadedMesh> {
    let flags = u32::from_le_bytes(take(stream)?);
    if version == 4 {
        while take::<1>(stream)? != [0] {}
    }
    let n_vertices = u64::from_le_bytes(take(stream)?);
    let n_triangles = u64::from_le_bytes(take(stream)?);
    if n_vertices > MAX_COUNT || n_triangles > MAX_COUNT {
        return Err(invalid(format!("{n_vertices} vertices and {n_triangles} triangles are too many")));
    }
    let is_double = flags & IS_DOUBLE != 0;
    let mut mesh = LoadedMesh::default();
    // No memory is taken before there is data for it.
    for _ in 0..n_vertices {
        let [x, y, z] = floats(stream, is_double)?;
        mesh.positions.push(Point3::new(x, y, z));
    }
    if !mesh.positions.iter().all(|p| p.is_finite()) {
        return Err(invalid("a vertex has a coordinate that is not finite".to_owned()));
    }
    if flags & HAS_NORMALS != 0 {
        for _ in 0..n_vertices {
            let [x, y, z] = floats(stream, is_double)?;
            mesh.normals.push(Normal3::new(x, y, z));
        }
    }
    if flags & HAS_UVS != 0 {
        for _ in 0..n_vertices {
            let [u, v] = floats(stream, is_double)?;
            mesh.uvs.push(Point2::new(u, v));
        }
    }
    if flags & HAS_COLORS != 0 {
        for _ in 0..n_vertices {
            let _: [f32; 3] = floats(stream, is_double)?;
        }
    }
    for triangle in 0..n_triangles {
        let mut corners = [0; 3];
        for corner in &mut corners {
            *corner = u32::from_le_bytes(take(stream)?);
            if u64::from(*corner) >= n_vertices {
                let why = format!("triangle {triangle} refers to vertex {corner} of {n_vertices}");
                return Err(invalid(why));
            }
        }
        mesh.triangles.push(corners);
    }
    Ok(mesh)
}

fn take<const N: usize>(stream: &mut impl Read) -> std::io::Result<[u8; N]> {
    let mut bytes = [0; N];
    stream.read_exact(&mut bytes)?;
    Ok(bytes)
}

fn floats<const N: usize>(stream: &mut impl Read, is_double: bool) -> std::io::Result<[f32; N]> {
    let mut values = [0.0; N];
    for value in &mut values {
        *value = if is_double {
            f64::from_le_bytes(take(stream)?) as f32
        } else {
            f32::from_le_bytes(take(stream)?)
        };
    }
    Ok(values)
}
