//! Damaged and hostile files: each is an error at its place.

use super::*;

/// A sound file to be damaged: positions, indices, a node, a material with a texture that lies in no file.
fn sound() -> String {
    r#"{"asset": {"version": "2.0"}, "buffers": [{"byteLength": 42}],
"bufferViews": [{"buffer": 0, "byteLength": 36}, {"buffer": 0, "byteOffset": 36, "byteLength": 6}],
"accessors": [{"bufferView": 0, "componentType": 5126, "count": 3, "type": "VEC3"},
{"bufferView": 1, "componentType": 5123, "count": 3, "type": "SCALAR"}],
"meshes": [{"primitives": [{"attributes": {"POSITION": 0}, "indices": 1}]}],
"nodes": [{"mesh": 0, "children": [1]}, {}], "scenes": [{"nodes": [0]}], "scene": 0}"#
        .to_owned()
}

fn binary() -> Vec<u8> {
    let positions = TRIANGLE.iter().flat_map(|value| value.to_le_bytes());
    positions.chain([0, 0, 1, 0, 2, 0]).collect()
}

/// The first error of the sound file with `from` replaced by `to` starts so.
#[track_caller]
fn check(from: &str, to: &str, message: &str) {
    let sound = sound();
    assert!(sound.contains(from), "{from}");
    let (document, diagnostics) = read(glb(&sound.replacen(from, to, 1), &binary()));
    let errors: Vec<_> = diagnostics.list().iter().filter(|d| d.severity == Severity::Error).collect();
    let first = errors.first().unwrap_or_else(|| panic!("{to}: there is no error"));
    assert!(first.message.starts_with(message), "{to}: {:?}", messages(&diagnostics));
    let place = document.sources.locate(first.span.expect("a place"));
    assert_eq!(place.file, "test.glb");
}

/// The file that the others are made of is sound.
#[test]
fn the_original() {
    let (document, diagnostics) = read(glb(&sound(), &binary()));
    assert!(diagnostics.list().is_empty(), "{:?}", messages(&diagnostics));
    assert_eq!(document.shapes.len(), 1);
}

/// Values of wrong types, wrong numbers, and indices into nothing.
#[test]
fn values() {
    check("\"mesh\": 0", "\"mesh\": 1", "/nodes/0/mesh: 1 is no index into \"meshes\", which has 1 items");
    check("\"mesh\": 0", "\"mesh\": -1", "/nodes/0/mesh: a whole number from 0 is expected");
    check("\"mesh\": 0", "\"mesh\": \"a\"", "/nodes/0/mesh: a whole number is expected, not a string");
    check("\"mesh\": 0", "\"mesh\": 0.5", "/nodes/0/mesh: a whole number");
    check("\"scene\": 0", "\"scene\": 3", "/scene: there is no scene 3");
    check("\"nodes\": [0]", "\"nodes\": [7]", "/scenes/0/nodes/0: 7 is no index");
    check(
        "\"nodes\": [{",
        "\"nodes\": [{\"translation\": [1, 2], ",
        "/nodes/0/translation: 3 numbers are expected",
    );
    check(
        "\"nodes\": [{",
        "\"nodes\": [{\"scale\": [1e99, 1, 1], ",
        "/nodes/0/scale/0: the number is too large",
    );
    check("\"version\": \"2.0\"", "\"version\": \"1.0\"", "/asset: the file is of version 1.0");
    check("\"asset\"", "\"assets\"", "\"asset\" is missing");
    check(
        "\"scene\": 0",
        "\"scene\": 0, \"extensionsRequired\": [\"EXT_unheard_of\"]",
        "/extensionsRequired/0: the file requires the extension EXT_unheard_of",
    );
}

/// Accessors that reach beyond their buffers, or claim more than there is.
#[test]
fn accessors() {
    check(
        "\"count\": 3",
        "\"count\": 4",
        "/accessors/0: 4 elements of 12 bytes, 12 apart from byte 0, are beyond",
    );
    check("\"count\": 3", "\"count\": 4000000000", "/accessors/0: 4000000000 elements of 12 bytes");
    check("\"count\": 3", "\"count\": 9000000000000000", "/accessors/0/count: a whole number");
    check("\"count\": 3", "\"count\": 3, \"byteOffset\": 9007199254740991", "/accessors/0/byteOffset");
    check(
        "\"bufferView\": 0, ",
        "\"byteOffset\": 0, \"count\": 90000000, ",
        "/accessors/0: 90000000 elements without",
    );
    check("5126", "5124", "/accessors/0/componentType: no component type");
    check("VEC3", "VEC5", "/accessors/0: \"VEC5\" is no type");
    check(
        "VEC3",
        "VEC2",
        "/meshes/0/primitives/0/attributes/POSITION: \"POSITION\" cannot have elements of 2",
    );
    check("5123", "5126", "/accessors/1: 3 elements of 4 bytes");
    check("5123", "5120", "/meshes/0/primitives/0/indices: indices are unsigned");
    check(
        "\"byteLength\": 36}",
        "\"byteLength\": 36, \"byteStride\": 4}",
        "/accessors/0: elements of 12 bytes overlap",
    );
    check("\"byteOffset\": 36", "\"byteOffset\": 14", "/meshes/0/primitives/0/indices: index");
    check("\"byteOffset\": 36", "\"byteOffset\": 44", "/bufferViews/1: bytes 44 to 44 + 6 are beyond");
    check("\"byteLength\": 42", "\"byteLength\": 4200", "/buffers/0: the buffer should have 4200 bytes");
    check(
        "\"byteLength\": 42",
        "\"byteLength\": 42, \"uri\": \"no.bin\"",
        "/buffers/0/uri: there is no file",
    );
    check(
        "\"byteLength\": 42",
        "\"byteLength\": 42, \"uri\": \"http://a/b\"",
        "/buffers/0/uri: the URI has the scheme",
    );
    check("\"byteLength\": 42", "\"uri\": \"data:;base64,A*\"", "/buffers/0/uri: `*` is no letter of base64");
    check("\"indices\": 1", "\"indices\": 1, \"mode\": 7", "/meshes/0/primitives/0: 7 is no mode");
    check(
        "\"type\": \"VEC3\"",
        "\"type\": \"VEC3\", \"sparse\": {\"count\": 4000000000, \"indices\": {\"bufferView\": 0, \
         \"componentType\": 5121}, \"values\": {\"bufferView\": 0}}",
        "/accessors/0/sparse/indices: 4000000000 elements",
    );
}

/// Nodes that contain themselves, or have two parents.
#[test]
fn cycles() {
    check("{}]", "{\"children\": [0]}]", "/nodes/0: the node is among its own ancestors");
    check("{}]", "{\"children\": [1]}]", "/nodes/1/children/0: node 1 is a child of two nodes");
}

/// Positions that are no numbers.
#[test]
fn nan() {
    let mut data = Data::default();
    let mut corners = TRIANGLE;
    corners[4] = f32::NAN;
    let p = data.floats("VEC3", &corners);
    let (_, diagnostics) = read(data.file(&one_primitive(&format!(r#""attributes": {{"POSITION": {p}}}"#))));
    assert_eq!(messages(&diagnostics), ["/meshes/0/primitives/0: the position of vertex 1 is not finite"]);
}

/// Broken text has a line and a column; broken containers say what is wrong with them.
#[test]
fn containers() {
    let (document, diagnostics) = read(b"{\n \"asset\": {,}}".to_vec());
    let span = diagnostics.list()[0].span.expect("a place");
    assert_eq!(document.sources.locate(span).to_string(), "test.glb:2:12");
    let whole = glb(&sound(), &binary());
    let check = |bytes: Vec<u8>, part: &str| {
        let (_, diagnostics) = read(bytes);
        assert!(messages(&diagnostics)[0].contains(part), "{:?}", messages(&diagnostics));
    };
    check(whole[..whole.len() - 1].to_vec(), "but there are");
    check(whole[..10].to_vec(), "ends within the word at byte 8");
    let with = |at: usize, byte: u8| {
        let mut bytes = whole.clone();
        bytes[at] = byte;
        bytes
    };
    check(with(4, 1), "version 1");
    check(with(15, 0xff), "the chunk at byte 12");
    check(with(16, b'X'), "no JSON chunk");
    check(with(40, 0xff), "UTF-8");
    check(Vec::new(), "broken JSON: the text ends");
    check(b"[]".to_vec(), "a glTF file holds an object");
}

/// A few letters that use the same data over and over cannot fill the memory.
#[test]
fn repetition() {
    let n = 999_999;
    let primitive = r#"{"attributes": {"POSITION": 0}}"#;
    let json = format!(
        r#"{{"asset": {{"version": "2.0"}}, "accessors": [{{"componentType": 5126, "count": {n}, "type": "VEC3"}}],
        "meshes": [{{"primitives": [{}]}}], "nodes": [{{"mesh": 0}}]}}"#,
        [primitive; 100].join(",")
    );
    let (_, diagnostics) = read(json.into_bytes());
    assert!(messages(&diagnostics)[0].contains("too often"), "{:?}", messages(&diagnostics));
}

/// What is compressed by other means is refused by name.
#[test]
fn compression() {
    check(
        "\"byteLength\": 36",
        "\"byteLength\": 36, \"extensions\": {\"EXT_meshopt_compression\": {}}",
        "/bufferViews/0: the view is compressed by meshopt",
    );
}

/// Instances take more memory than vertices, and count as such.
#[test]
fn instances() {
    let json = r#"{"asset": {"version": "2.0"}, "accessors": [{"componentType": 5126, "count": 3, "type": "VEC3"},
        {"componentType": 5126, "count": 1000000, "type": "VEC3"}],
        "meshes": [{"primitives": [{"attributes": {"POSITION": 0}}]}],
        "nodes": [{"mesh": 0, "extensions": {"EXT_mesh_gpu_instancing": {"attributes": {"TRANSLATION": 1}}}}]}"#;
    let (_, diagnostics) = read(json.as_bytes().to_vec());
    assert!(messages(&diagnostics)[0].contains("too often"), "{:?}", messages(&diagnostics));
}

/// Sparse data that many accessors share count for each of them.
#[test]
fn sparse_data() {
    let n = 2_000_000_u32;
    let mut bytes: Vec<u8> = (0..n).flat_map(u32::to_le_bytes).collect();
    bytes.resize(bytes.len() + n as usize * 12, 0);
    let accessor = format!(
        r#"{{"componentType": 5126, "count": {n}, "type": "VEC3", "sparse": {{"count": {n},
        "indices": {{"bufferView": 0, "componentType": 5125}}, "values": {{"bufferView": 1}}}}}}"#
    );
    let indices = r#"{"componentType": 5125, "count": 3, "type": "SCALAR"}"#;
    let primitive = r#"{"attributes": {"POSITION": 0}, "indices": 1}"#;
    let json = format!(
        r#"{{"asset": {{"version": "2.0"}}, "buffers": [{{"byteLength": {}}}],
        "bufferViews": [{{"buffer": 0, "byteLength": {}}}, {{"buffer": 0, "byteOffset": {}, "byteLength": {}}}],
        "accessors": [{accessor}, {indices}], "meshes": [{{"primitives": [{}]}}], "nodes": [{{"mesh": 0}}]}}"#,
        bytes.len(),
        4 * n,
        4 * n,
        12 * n,
        [primitive; 40].join(",")
    );
    let (_, diagnostics) = read(glb(&json, &bytes));
    let found = messages(&diagnostics);
    assert!(found.iter().any(|message| message.contains("sparse data too often")), "{found:?}");
}

/// A file that many buffers name is read and counted once.
#[test]
fn shared_files() {
    let folder = tempfile::tempdir().expect("a folder");
    std::fs::write(folder.path().join("a.bin"), vec![0; 1 << 20]).expect("written");
    let buffers: Vec<String> = (0..200).map(|i| format!(r#"{{"uri": "{}a.bin"}}"#, "./".repeat(i))).collect();
    let views: Vec<String> =
        (0..200).map(|i| format!(r#"{{"buffer": {i}, "byteLength": 1048576}}"#)).collect();
    let accessor =
        |i| format!(r#"{{"bufferView": {i}, "componentType": 5126, "count": 87000, "type": "VEC3"}}"#);
    let accessors: Vec<String> = (0..200).map(accessor).collect();
    let primitive = |i| format!(r#"{{"attributes": {{"POSITION": {i}}}}}"#);
    let primitives: Vec<String> = (0..200).map(primitive).collect();
    let json = format!(
        r#"{{"asset": {{"version": "2.0"}}, "buffers": [{}], "bufferViews": [{}], "accessors": [{}],
        "meshes": [{{"primitives": [{}]}}], "nodes": [{{"mesh": 0}}]}}"#,
        buffers.join(","),
        views.join(","),
        accessors.join(","),
        primitives.join(",")
    );
    let (_, diagnostics) = read_gltf_bytes("test.gltf", json.into_bytes(), folder.path());
    assert!(messages(&diagnostics)[0].contains("too often"), "{:?}", messages(&diagnostics));
}
