//! Small files made here, each held against the document that it should become.

mod broken;
mod compressed;
mod fuzz;
mod materials;
mod nodes;

use std::path::Path;

use etendue_math::{Normal3, Point2, Point3};
use etendue_scene::document::{EmbeddedFile, Entity, ShapeEntity, Value};
use etendue_scene::{Diagnostics, Document, LoadedMesh, Severity};

use super::read_gltf_bytes;

/// A GLB of that text and binary chunk.
fn glb(json: &str, binary: &[u8]) -> Vec<u8> {
    let padded = |bytes: &[u8], with: u8| {
        let mut bytes = bytes.to_vec();
        bytes.resize(bytes.len().next_multiple_of(4), with);
        bytes
    };
    let (json, binary) = (padded(json.as_bytes(), b' '), padded(binary, 0));
    let length = 12 + 8 + json.len() + 8 + binary.len();
    let word = |n: usize| (n as u32).to_le_bytes();
    [
        b"glTF",
        &word(2)[..],
        &word(length),
        &word(json.len()),
        b"JSON",
        &json,
        &word(binary.len()),
        b"BIN\0",
        &binary,
    ]
    .concat()
}

/// A binary chunk in the making, with the buffer views and accessors into it.
#[derive(Default)]
struct Data {
    bytes: Vec<u8>,
    views: Vec<String>,
    accessors: Vec<String>,
}

impl Data {
    /// Adds bytes as a view and gives its index.
    fn view(&mut self, bytes: &[u8], more: &str) -> usize {
        let start = self.bytes.len();
        self.bytes.extend_from_slice(bytes);
        let length = bytes.len();
        self.views.push(format!(r#"{{"buffer": 0, "byteOffset": {start}, "byteLength": {length}{more}}}"#));
        self.bytes.resize(self.bytes.len().next_multiple_of(4), 0);
        self.views.len() - 1
    }

    /// Adds an accessor of floats and gives its index.
    fn floats(&mut self, kind: &str, values: &[f32]) -> usize {
        let n = match kind {
            "SCALAR" => 1,
            "VEC2" => 2,
            "VEC3" => 3,
            "VEC4" => 4,
            _ => 16,
        };
        let bytes: Vec<u8> = values.iter().flat_map(|value| value.to_le_bytes()).collect();
        let view = self.view(&bytes, "");
        self.accessor(&format!(
            r#""bufferView": {view}, "componentType": 5126, "count": {}, "type": "{kind}""#,
            values.len() / n
        ))
    }

    /// Adds an accessor of 16-bit indices.
    fn indices(&mut self, values: &[u16]) -> usize {
        let bytes: Vec<u8> = values.iter().flat_map(|value| value.to_le_bytes()).collect();
        let view = self.view(&bytes, "");
        let count = values.len();
        self.accessor(&format!(
            r#""bufferView": {view}, "componentType": 5123, "count": {count}, "type": "SCALAR""#
        ))
    }

    fn accessor(&mut self, members: &str) -> usize {
        self.accessors.push(format!("{{{members}}}"));
        self.accessors.len() - 1
    }

    /// The whole file, with those members of the top-level object.
    fn file(&self, members: &str) -> Vec<u8> {
        let json = format!(
            r#"{{"asset": {{"version": "2.0"}}, "buffers": [{{"byteLength": {}}}],
            "bufferViews": [{}], "accessors": [{}], {members}}}"#,
            self.bytes.len(),
            self.views.join(", "),
            self.accessors.join(", ")
        );
        glb(&json, &self.bytes)
    }
}

const TRIANGLE: [f32; 9] = [0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0, 0.0];

fn read(bytes: Vec<u8>) -> (Document, Diagnostics) {
    read_gltf_bytes("test.glb", bytes, Path::new("/nonexistent"))
}

fn messages(diagnostics: &Diagnostics) -> Vec<String> {
    diagnostics.list().iter().map(|problem| problem.message.clone()).collect()
}

/// The document of a file without problems.
#[track_caller]
fn document(bytes: Vec<u8>) -> Document {
    let (document, diagnostics) = read(bytes);
    assert!(diagnostics.list().is_empty(), "{:?}", messages(&diagnostics));
    document
}

/// The document of a file with one warning that contains `part`.
#[track_caller]
fn warned(bytes: Vec<u8>, part: &str) -> Document {
    let (document, diagnostics) = read(bytes);
    let all = messages(&diagnostics);
    assert!(all.len() == 1 && all[0].contains(part), "{all:?}");
    assert_eq!(diagnostics.list()[0].severity, Severity::Warning);
    document
}

/// The embedded mesh of a shape.
#[track_caller]
fn mesh_of<'d>(document: &'d Document, shape: &ShapeEntity) -> &'d LoadedMesh {
    let Some(Value::Strings(names)) = value(&shape.entity, "filename") else { panic!("{:?}", shape.entity) };
    let Some(EmbeddedFile::Mesh(mesh)) = document.embedded.get(&names[0]) else { panic!("{}", names[0]) };
    mesh
}

fn value<'e>(entity: &'e Entity, name: &str) -> Option<&'e Value> {
    entity.parameters.iter().find(|parameter| parameter.name == name).map(|parameter| &parameter.value)
}

/// Members of a file that shows one primitive with these members.
fn one_primitive(members: &str) -> String {
    format!(r#""nodes": [{{"mesh": 0}}], "meshes": [{{"primitives": [{{{members}}}]}}]"#)
}

/// Positions, normals and texture coordinates arrive as they are, but for v, which runs down in glTF.
#[test]
fn a_triangle() {
    let mut data = Data::default();
    let (p, n) = (data.floats("VEC3", &TRIANGLE), data.floats("VEC3", &[0.0, 0.0, 1.0].repeat(3)));
    let t = data.floats("VEC2", &[0.0, 0.25, 1.0, 0.25, 0.0, 1.0]);
    let i = data.indices(&[2, 0, 1]);
    let primitive = format!(
        r#""attributes": {{"POSITION": {p}, "NORMAL": {n}, "TEXCOORD_0": {t}}}, "indices": {i}, "mode": 4"#
    );
    let document = document(data.file(&one_primitive(&primitive)));
    let [shape] = &document.shapes[..] else { panic!("one shape") };
    assert!(shape.world_from_object.start.is_identity());
    let mesh = mesh_of(&document, shape);
    assert_eq!(mesh.triangles, [[0, 1, 2]]);
    let corners = [(0.0, 1.0), (0.0, 0.0), (1.0, 0.0)];
    assert_eq!(mesh.positions, corners.map(|(x, y)| Point3::new(x, y, 0.0)));
    assert_eq!(mesh.normals, [Normal3::new(0.0, 0.0, 1.0); 3]);
    assert_eq!(mesh.uvs, [(0.0, 0.0), (0.0, 0.75), (1.0, 0.75)].map(|(u, v)| Point2::new(u, v)));
}

/// Strips turn every other triangle around, fans share their first vertex; without indices vertices are counted.
#[test]
fn modes() {
    let check = |mode: usize, expected: &[[u32; 3]]| {
        let mut data = Data::default();
        let corners: Vec<f32> = (0..6).flat_map(|i| [i as f32, (i * i) as f32, 0.0]).collect();
        let p = data.floats("VEC3", &corners);
        let primitive = format!(r#""attributes": {{"POSITION": {p}}}, "mode": {mode}"#);
        let document = document(data.file(&one_primitive(&primitive)));
        assert_eq!(mesh_of(&document, &document.shapes[0]).triangles, expected, "mode {mode}");
    };
    check(4, &[[0, 1, 2], [3, 4, 5]]);
    check(5, &[[0, 1, 2], [1, 3, 2], [2, 3, 4], [3, 5, 4]]);
    check(6, &[[1, 2, 0], [2, 3, 0], [3, 4, 0], [4, 5, 0]]);
}

/// Points and lines have no surface: they are left out with a warning.
#[test]
fn points_and_lines() {
    for mode in 0..4 {
        let mut data = Data::default();
        let p = data.floats("VEC3", &TRIANGLE);
        let primitive = format!(r#""attributes": {{"POSITION": {p}}}, "mode": {mode}"#);
        let document = warned(data.file(&one_primitive(&primitive)), "/meshes/0/primitives/0: ");
        assert!(document.shapes.is_empty());
    }
}

/// Integers are divided by their largest value where they are normalised, elements may lie apart, and sparse ones replace
/// others, of zeros too.
#[test]
fn accessors() {
    let mut data = Data::default();
    // Positions of 16-bit integers, 8 bytes apart.
    let corners: [[i16; 4]; 3] = [[0, 0, 0, 9], [32767, 0, 0, 9], [0, -32768, 0, 9]];
    let bytes: Vec<u8> = corners.iter().flatten().flat_map(|value| value.to_le_bytes()).collect();
    let view = data.view(&bytes, r#", "byteStride": 8"#);
    let p = data.accessor(&format!(
        r#""bufferView": {view}, "componentType": 5122, "normalized": true, "count": 3, "type": "VEC3""#
    ));
    // Coordinates that are zero but for one.
    let (numbers, values) = (data.view(&[1], ""), data.view(&[255, 51], ""));
    let t = data.accessor(&format!(
        r#""componentType": 5121, "normalized": true, "count": 3, "type": "VEC2", "sparse": {{"count": 1,
        "indices": {{"bufferView": {numbers}, "componentType": 5121}}, "values": {{"bufferView": {values}}}}}"#
    ));
    let primitive = format!(r#""attributes": {{"POSITION": {p}, "TEXCOORD_0": {t}}}"#);
    let document = document(data.file(&one_primitive(&primitive)));
    let mesh = mesh_of(&document, &document.shapes[0]);
    let expected = [(0.0, 0.0), (1.0, 0.0), (0.0, -1.0)];
    assert_eq!(mesh.positions, expected.map(|(x, y)| Point3::new(x, y, 0.0)));
    assert_eq!(mesh.uvs, [(0.0, 1.0), (1.0, 1.0 - 0.2), (0.0, 1.0)].map(|(u, v)| Point2::new(u, v)));
}

/// Vertices that a primitive does not use are not copied into its mesh.
#[test]
fn shared_vertices() {
    let mut data = Data::default();
    let corners: Vec<f32> = (0..300).map(|i| (i % 7) as f32).collect();
    let p = data.floats("VEC3", &corners);
    let i = data.indices(&[99, 50, 98]);
    let primitive = format!(r#""attributes": {{"POSITION": {p}}}, "indices": {i}"#);
    let document = document(data.file(&one_primitive(&primitive)));
    let mesh = mesh_of(&document, &document.shapes[0]);
    assert_eq!((mesh.positions.len(), &mesh.triangles[..]), (3, &[[0, 1, 2]][..]));
    let vertex = |v: usize| Point3::new(corners[3 * v], corners[3 * v + 1], corners[3 * v + 2]);
    assert_eq!(mesh.positions, [vertex(99), vertex(50), vertex(98)]);
}

/// Buffers may stand in the text.
#[test]
fn data_uris() {
    // 0, 0, 0, 1, 0, 0, 0, 1, 0 as floats.
    let content = "AAAAAAAAAAAAAAAAAACAPwAAAAAAAAAAAAAAAAAAgD8AAAAA";
    let json = format!(
        r#"{{"asset": {{"version": "2.0"}}, "buffers": [{{"byteLength": 36,
        "uri": "data:application/octet-stream;base64,{content}"}}],
        "bufferViews": [{{"buffer": 0, "byteLength": 36}}],
        "accessors": [{{"bufferView": 0, "componentType": 5126, "count": 3, "type": "VEC3"}}], {}}}"#,
        one_primitive(r#""attributes": {"POSITION": 0}"#)
    );
    let document = document(json.into_bytes());
    let mesh = mesh_of(&document, &document.shapes[0]);
    let corners = [(0.0, 0.0), (1.0, 0.0), (0.0, 1.0)];
    assert_eq!(mesh.positions, corners.map(|(x, y)| Point3::new(x, y, 0.0)));
}
