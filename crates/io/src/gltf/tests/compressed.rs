//! Meshes that Draco compresses.

use draco_core::{
    DataType, EncoderBuffer, EncoderOptions, FaceIndex, GeometryAttributeType, Mesh, MeshEncoder,
    PointAttribute,
};

use super::*;

/// Vertices on a side of a grid.
const SIDE: usize = 9;

fn attribute(kind: GeometryAttributeType, n: usize, values: &[f32]) -> PointAttribute {
    let mut attribute = PointAttribute::new();
    attribute.init(kind, n as u8, DataType::Float32, false, values.len() / n);
    attribute.buffer_mut().update_f32s_le(0, values);
    attribute
}

/// A curved grid as Draco data, with its positions and the numbers of its attributes.
fn grid() -> (Vec<u8>, Vec<Point3>) {
    let vertex = |i: usize| {
        let (x, y) = ((i % SIDE) as f32, (i / SIDE) as f32);
        Point3::new(x, y, (0.5 * x).sin() + (0.3 * y).cos())
    };
    let vertices: Vec<Point3> = (0..SIDE * SIDE).map(vertex).collect();
    let positions: Vec<f32> = vertices.iter().flat_map(|p| [p.x, p.y, p.z]).collect();
    let uvs: Vec<f32> = vertices.iter().flat_map(|p| [p.x / SIDE as f32, p.y / SIDE as f32]).collect();
    let mut mesh = Mesh::new();
    mesh.set_num_points(SIDE * SIDE);
    mesh.add_attribute(attribute(GeometryAttributeType::Position, 3, &positions));
    mesh.add_attribute(attribute(GeometryAttributeType::TexCoord, 2, &uvs));
    mesh.set_num_faces(2 * (SIDE - 1) * (SIDE - 1));
    for face in 0..(SIDE - 1) * (SIDE - 1) {
        let a = (face % (SIDE - 1) + face / (SIDE - 1) * SIDE) as u32;
        let (b, c, d) = (a + 1, a + SIDE as u32, a + SIDE as u32 + 1);
        mesh.set_face(FaceIndex(2 * face as u32), [a.into(), b.into(), c.into()]);
        mesh.set_face(FaceIndex(2 * face as u32 + 1), [c.into(), b.into(), d.into()]);
    }
    let mut options = EncoderOptions::new();
    options.set_attribute_int(0, "quantization_bits", 14);
    options.set_attribute_int(1, "quantization_bits", 12);
    let (mut encoder, mut buffer) = (MeshEncoder::new(), EncoderBuffer::new());
    encoder.set_mesh(mesh);
    encoder.encode(&options, &mut buffer).expect("the mesh is sound");
    (buffer.data().to_vec(), vertices)
}

fn file(data: &[u8]) -> Vec<u8> {
    let mut file = Data::default();
    let view = file.view(data, "");
    let n = SIDE * SIDE;
    let p = file.accessor(&format!(r#""componentType": 5126, "count": {n}, "type": "VEC3""#));
    let t = file.accessor(&format!(r#""componentType": 5126, "count": {n}, "type": "VEC2""#));
    file.file(&format!(
        r#""extensionsRequired": ["KHR_draco_mesh_compression"], {}"#,
        one_primitive(&format!(
            r#""attributes": {{"POSITION": {p}, "TEXCOORD_0": {t}}}, "extensions": {{"KHR_draco_mesh_compression":
            {{"bufferView": {view}, "attributes": {{"POSITION": 0, "TEXCOORD_0": 1}}}}}}"#
        ))
    ))
}

/// Every vertex comes back within half a step of 14 bits, with its texture coordinates and all triangles.
#[test]
fn a_grid() {
    let (data, vertices) = grid();
    let document = document(file(&data));
    let mesh = mesh_of(&document, &document.shapes[0]);
    assert_eq!(mesh.triangles.len(), 2 * (SIDE - 1) * (SIDE - 1));
    assert_eq!(mesh.positions.len(), vertices.len());
    let step = (SIDE - 1) as f32 / 16384.0;
    for (p, uv) in mesh.positions.iter().zip(&mesh.uvs) {
        assert!(vertices.iter().any(|v| (*v - *p).abs().max_element() <= 0.5001 * step + 1e-6), "{p:?}");
        let expected = Point2::new(p.x / SIDE as f32, 1.0 - p.y / SIDE as f32);
        assert!((uv.x - expected.x).abs() < 1e-3 && (uv.y - expected.y).abs() < 1e-3, "{uv:?} {expected:?}");
    }
}

/// Damaged data are an error or another mesh, and never a panic.
#[test]
fn damaged_data() {
    let (data, _) = grid();
    let (_, diagnostics) = read(file(&data[..data.len() / 2]));
    let place = "/meshes/0/primitives/0/extensions/KHR_draco_mesh_compression: ";
    assert!(messages(&diagnostics)[0].starts_with(place), "{:?}", messages(&diagnostics));
    for at in 0..data.len() {
        for change in [1, 0x80, 0xff] {
            let mut damaged = data.clone();
            damaged[at] ^= change;
            read(file(&damaged));
        }
    }
}
