use std::io::Write;
use std::time::Instant;

use etendue_math::{Normal3, Point2, Point3};
use flate2::Compression;
use flate2::write::GzEncoder;

use etendue_scene::LoadedMesh;

use super::{PlyError, PlyMesh, read_ply, write_ply};

/// The number types of a binary file.
enum Order {
    Little,
    Big,
}

fn header(format: &str, rest: &str) -> Vec<u8> {
    format!("ply\nformat {format} 1.0\ncomment made by hand\n{rest}end_header\n").into_bytes()
}

#[track_caller]
fn mesh(bytes: &[u8]) -> PlyMesh {
    match read_ply(bytes) {
        Ok(mesh) => mesh,
        Err(error) => panic!("{error}"),
    }
}

#[track_caller]
fn check_error(bytes: &[u8], expected: &str) {
    match read_ply(bytes) {
        Ok(_) => panic!("the file is read, instead of: {expected}"),
        Err(error) => assert_eq!(error.to_string(), expected),
    }
}

const XYZ: &str = "property float x\nproperty float y\nproperty float z\n";
const FACES: &str = "property list uchar int vertex_indices\n";

fn ascii(n_vertices: usize, n_faces: usize, data: &str) -> Vec<u8> {
    let elements = format!("element vertex {n_vertices}\n{XYZ}element face {n_faces}\n{FACES}");
    [header("ascii", &elements), data.as_bytes().to_vec()].concat()
}

/// Triangles stay; quadrilaterals become patches, whose corners run row by row.
#[test]
fn ascii_triangles_and_quads() {
    let PlyMesh { mesh, warnings } = mesh(&ascii(4, 2, "0 0 0\n1 0 0\n1 1 0\n0 1 1e-1\n3 0 1 2\n4 0 1 2 3"));
    assert_eq!(mesh.positions[3], Point3::new(0.0, 1.0, 0.1));
    assert_eq!(mesh.triangles, [[0, 1, 2]]);
    assert_eq!(mesh.quads, [[0, 1, 3, 2]]);
    assert!(
        warnings.is_empty() && mesh.normals.is_empty() && mesh.uvs.is_empty() && mesh.face_indices.is_empty()
    );
}

/// Larger polygons are cut into fans; lines and points are no faces.
#[test]
fn polygons() {
    let vertices = "0 0 0 1 0 0 2 1 0 1 2 0 0 1 0\n";
    let ply = mesh(&ascii(5, 3, &format!("{vertices}5 0 1 2 3 4\n2 0 1\n0\n")));
    assert_eq!(ply.mesh.triangles, [[0, 1, 2], [0, 2, 3], [0, 3, 4]]);
    assert_eq!(ply.warnings.len(), 2);
    assert!(ply.warnings[0].starts_with("1 polygons of more than four corners"), "{:?}", ply.warnings);
    assert!(ply.warnings[1].starts_with("2 faces of less than three corners"), "{:?}", ply.warnings);
}

/// All number types and both byte orders, normals, coordinates and face indices, among others that are skipped.
#[test]
fn binary_with_all_types() {
    for order in [Order::Little, Order::Big] {
        let format = match order {
            Order::Little => "binary_little_endian",
            Order::Big => "binary_big_endian",
        };
        let elements = "obj_info x\nelement camera 2\nproperty list ushort double a\nproperty char b\n\
            element vertex 3\nproperty double x\nproperty float y\nproperty short z\nproperty uchar red\n\
            property float32 nx\nproperty int8 ny\nproperty float64 nz\nproperty float s\nproperty ushort t\n\
            element empty 1000000000000\n\
            element face 1\nproperty uint face_indices\nproperty list int uint16 vertex_index\n\
            property list uint8 float32 texcoord\n";
        let mut data = header(format, elements);
        let mut push = |little: &[u8]| match order {
            Order::Little => data.extend(little),
            Order::Big => data.extend(little.iter().rev()),
        };
        for n in [2_u16, 0] {
            push(&n.to_le_bytes());
            for _ in 0..n {
                push(&1.5_f64.to_le_bytes());
            }
            push(&[7]);
        }
        for i in 0..3_i16 {
            push(&(f64::from(i) + 0.5).to_le_bytes());
            push(&(-f32::from(i)).to_le_bytes());
            push(&(i - 1).to_le_bytes());
            push(&[255]);
            push(&0.25_f32.to_le_bytes());
            push(&(-1_i8).to_le_bytes());
            push(&1.0_f64.to_le_bytes());
            push(&0.75_f32.to_le_bytes());
            push(&(i as u16).to_le_bytes());
        }
        push(&42_u32.to_le_bytes());
        push(&3_i32.to_le_bytes());
        for i in [2_u16, 1, 0] {
            push(&i.to_le_bytes());
        }
        push(&[1]);
        push(&0.5_f32.to_le_bytes());
        let PlyMesh { mesh, warnings } = mesh(&data);
        assert!(warnings.is_empty());
        assert_eq!(mesh.positions, [0.0, 1.0, 2.0].map(|i| Point3::new(i + 0.5, -i, i - 1.0)));
        assert_eq!(mesh.normals, [Normal3::new(0.25, -1.0, 1.0); 3]);
        assert_eq!(mesh.uvs[2], Point2::new(0.75, 2.0));
        assert_eq!(mesh.triangles, [[2, 1, 0]]);
        assert_eq!(mesh.face_indices, [42]);
    }
}

/// Texture coordinates have four pairs of names.
#[test]
fn names_of_texture_coordinates() {
    for [u, v] in super::UV_NAMES {
        let elements = format!(
            "element vertex 3\n{XYZ}property float {v}\nproperty float {u}\nelement face 1\n\
             property list uchar int vertex_index\n"
        );
        let data = [header("ascii", &elements), b"0 0 0 1 2 1 0 0 3 4 0 1 0 5 6 3 0 1 2".to_vec()].concat();
        assert_eq!(mesh(&data).mesh.uvs[1], Point2::new(4.0, 3.0));
    }
}

/// Face indices follow their faces: those of triangles first, then those of quadrilaterals.
#[test]
fn face_indices_follow_their_faces() {
    let elements = format!("element vertex 5\n{XYZ}element face 3\n{FACES}property int face_indices\n");
    let data = "0 0 0 1 0 0 1 1 0 0 1 0 0 2 0  4 0 1 2 3 10  3 0 1 2 11  5 0 1 2 3 4 12";
    let ply = mesh(&[header("ascii", &elements), data.as_bytes().to_vec()].concat());
    assert_eq!(ply.mesh.face_indices, [11, 12, 12, 12, 10]);
}

/// A compressed mesh is the same mesh; a damaged stream is an error.
#[test]
fn gzip() {
    let plain = ascii(3, 1, "0 0 0 1 0 0 0 1 0 3 0 1 2");
    let mut encoder = GzEncoder::new(Vec::new(), Compression::default());
    encoder.write_all(&plain).expect("memory takes all bytes");
    let compressed = encoder.finish().expect("memory takes all bytes");
    assert_eq!(read_ply(&compressed), read_ply(&plain));
    assert!(matches!(read_ply(&compressed[..compressed.len() / 2]), Err(PlyError::Gzip(_))));
}

/// Lines may end as on Windows, and faces may stand before the vertices.
#[test]
fn order_and_line_ends() {
    let text = format!(
        "ply\nformat ascii 1.0\nelement face 1\n{FACES}element vertex 3\n{XYZ}end_header\n3 0 1 2\n0 0 0\n1 0 0\n0 1 0\n"
    );
    assert_eq!(mesh(text.replace('\n', "\r\n").as_bytes()).mesh.triangles, [[0, 1, 2]]);
    check_error(
        text.replace("3 0 1 2", "3 0 1 3").as_bytes(),
        "face 0 refers to vertex 3, but there are 3 vertices",
    );
}

/// What a header declares is not believed: no memory is taken for what the file cannot hold.
#[test]
fn declared_counts_are_checked() {
    let start = Instant::now();
    for format in ["ascii", "binary_little_endian"] {
        let elements = format!("element vertex 900000000000\n{XYZ}element face 1\n{FACES}");
        let data = [header(format, &elements), b"0 0 0 1 0 0 ".to_vec()].concat();
        let n = if format == "ascii" { 2 } else { 1 };
        let expected = format!("the data ends at vertex {n} of 900000000000 that the header declares");
        check_error(&data, &expected);
    }
    let elements = format!("element vertex 1\n{XYZ}element face 1\nproperty list uint int vertex_indices\n");
    let mut data = header("binary_little_endian", &elements);
    data.extend([0; 12]);
    data.extend(u32::MAX.to_le_bytes());
    check_error(&data, "the data ends at face 0 of 1 that the header declares");
    check_error(
        &ascii(3, 1, "0 0 0 1 0 0 0 1 0 4000000000 0"),
        "the data ends at face 0 of 1 that the header declares",
    );
    assert!(start.elapsed().as_secs_f32() < 1.0);
}

/// Files that end early name the item at which they do.
#[test]
fn truncated_files() {
    let elements = format!("element vertex 3\n{XYZ}element face 2\n{FACES}");
    let mut whole = header("binary_little_endian", &elements);
    let data_start = whole.len();
    for value in [0.0_f32, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0, 0.0] {
        whole.extend(value.to_le_bytes());
    }
    for _ in 0..2 {
        whole.extend([3, 0, 0, 0, 0, 1, 0, 0, 0, 2, 0, 0, 0]);
    }
    assert!(read_ply(&whole).is_ok());
    check_error(&whole[..whole.len() - 1], "the data ends at face 1 of 2 that the header declares");
    check_error(&whole[..data_start + 30], "the data ends at vertex 2 of 3 that the header declares");
    for length in 0..whole.len() {
        assert!(read_ply(&whole[..length]).is_err(), "{length} bytes");
    }
}

/// Numbers that make no mesh are errors, with the place.
#[test]
fn bad_numbers() {
    let triangle = "0 0 0 1 0 0 0 1 0 ";
    check_error(&ascii(3, 1, "0 0 0 1 x 0 0 1 0 3 0 1 2"), "vertex 1: `x` is not a number");
    check_error(&ascii(3, 1, "0 0 0 1 0 0 nan 1 0 3 0 1 2"), "vertex 2 has a coordinate that is not finite");
    check_error(&ascii(3, 1, "0 inf 0 1 0 0 0 1 0 3 0 1 2"), "vertex 0 has a coordinate that is not finite");
    let bad = "face 1 refers to vertex 3, but there are 3 vertices";
    check_error(&ascii(3, 2, &format!("{triangle}3 0 1 2 3 0 1 3")), bad);
    let bad = "face 0 refers to vertex -1, but there are 3 vertices";
    check_error(&ascii(3, 1, &format!("{triangle}4 0 1 2 -1")), bad);
}

/// Normals that are no numbers are worse than none.
#[test]
fn bad_normals_are_left_out() {
    let elements = format!(
        "element vertex 3\n{XYZ}property float nx\nproperty float ny\nproperty float nz\nelement face 1\n{FACES}"
    );
    let data = "0 0 0 0 0 1  1 0 0 0 nan 1  0 1 0 0 0 1  3 0 1 2";
    let ply = mesh(&[header("ascii", &elements), data.as_bytes().to_vec()].concat());
    assert!(ply.mesh.normals.is_empty());
    assert_eq!(ply.warnings, ["the normals were left out, as some are not finite"]);
}

/// Headers that break the format say where.
#[test]
fn bad_headers() {
    check_error(b"", "line 1 of the header: the file does not begin with `ply`");
    check_error(b"plyx\n", "line 1 of the header: the file does not begin with `ply`");
    check_error(b"ply\nformat ascii 1.0\n", "line 3 of the header: there is no `end_header`");
    check_error(b"ply\nformat morse 1.0\n", "line 2 of the header: there is no format `morse`");
    check_error(b"ply\nend_header\n", "the file has no line `format`");
    check_error(b"ply\nproperty float x\n", "line 2 of the header: a property stands before all elements");
    check_error(b"ply\nelement vertex many\n", "line 2 of the header: `many` is no number of elements");
    check_error(b"ply\nelement vertex -1\n", "line 2 of the header: `-1` is no number of elements");
    check_error(b"ply\nelement a 1\nproperty half x\n", "line 3 of the header: there is no type `half`");
    check_error(
        b"ply\nelement a 1\nproperty float\n",
        "line 3 of the header: a property has a type and a name",
    );
    let list = b"ply\nelement a 1\nproperty list float int x\n";
    check_error(list, "line 3 of the header: the length of the list `x` must be an integer");
    check_error(b"ply\nsolid\n", "line 2 of the header: `solid` is not part of the format");
    check_error(&header("ascii", &format!("element face 0\n{FACES}")), "the file has no element `vertex`");
    check_error(&header("ascii", &format!("element vertex 0\n{XYZ}")), "the file has no faces");
    let flat = "element vertex 0\nproperty float x\nproperty float y\n";
    check_error(&header("ascii", flat), "the file has no vertex properties x, y and z");
    let faces = format!("element vertex 0\n{XYZ}element face 0\nproperty int vertex_indices\n");
    check_error(&header("ascii", &faces), "the file has no face property `vertex_indices`");
}

/// Damaged files are read without panic.
#[test]
fn damaged_files_do_not_panic() {
    let elements = format!("element vertex 3\n{XYZ}element face 2\n{FACES}");
    let mut binary = header("binary_big_endian", &elements);
    binary.extend([0; 62]);
    let text = ascii(3, 2, "0 0 0 1 0 0 0 1 0 3 0 1 2 3 2 1 0");
    let mut state = 7_u64;
    let mut below = |n: usize| {
        state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1);
        (state >> 33) as usize % n
    };
    for i in 0..20_000 {
        let mut bytes = if i % 2 == 0 { binary.clone() } else { text.clone() };
        for _ in 0..=below(3) {
            let at = below(bytes.len());
            match below(3) {
                0 => bytes[at] = below(256) as u8,
                1 => drop(bytes.remove(at)),
                _ => bytes.insert(at, below(256) as u8),
            }
        }
        drop(read_ply(&bytes));
    }
}

/// What is written reads back, with and without what is optional.
#[test]
fn written_meshes_read_back() {
    let mut written = LoadedMesh {
        positions: (0..5).map(|i| Point3::new(i as f32, 0.1 * i as f32, -1e-7)).collect(),
        triangles: vec![[0, 1, 2], [2, 1, 4]],
        quads: vec![[0, 1, 2, 3]],
        ..LoadedMesh::default()
    };
    assert_eq!(mesh(&write_ply(&written)), PlyMesh { mesh: written.clone(), warnings: Vec::new() });
    written.normals = (0..5).map(|i| Normal3::new(0.0, i as f32, 1.0)).collect();
    written.uvs = (0..5).map(|i| Point2::new(0.5, i as f32)).collect();
    written.face_indices = vec![3, -1, 7];
    assert_eq!(mesh(&write_ply(&written)), PlyMesh { mesh: written, warnings: Vec::new() });
}
