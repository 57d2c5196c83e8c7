use std::path::Path;

use super::{Format, format_of_content, format_of_name, read_scene};

/// Names tell the format, in any case and compressed too.
#[test]
fn names() {
    let check = |name: &str, expected| assert_eq!(format_of_name(Path::new(name)), expected, "{name}");
    check("a/b.pbrt", Some(Format::Pbrt));
    check("b.PBRT.gz", Some(Format::Pbrt));
    check("b.glb", Some(Format::Gltf));
    check("b.Gltf", Some(Format::Gltf));
    check("b.xml", Some(Format::Mitsuba));
    check("b.obj", Some(Format::Obj));
    check("b.ply.gz", Some(Format::Ply));
    check("b.gz", None);
    check("pbrt", None);
}

/// Where the name says nothing, the content does; what is no scene is refused with a list of what would be.
#[test]
fn contents() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let path = folder.path().join("scene");
    let check = |content: &[u8], expected| {
        std::fs::write(&path, content).expect("writable");
        assert_eq!(format_of_content(&path).ok(), expected, "{}", String::from_utf8_lossy(content));
    };
    check(b"# a scene\nCamera \"perspective\"\nWorldBegin\n", Some(Format::Pbrt));
    check(b"glTF\x02\0\0\0", Some(Format::Gltf));
    check(b" \n{ \"asset\": {} }", Some(Format::Gltf));
    check(b"ply\nformat ascii 1.0\n", Some(Format::Ply));
    check(b"\xef\xbb\xbf<?xml version=\"1.0\"?><scene/>", Some(Format::Mitsuba));
    check(b"o x\nv 0 0 0\nf 1 1 1\n", Some(Format::Obj));
    check(b"Dear Sir or Madam,\n", None);
    let (_, diagnostics) = read_scene(&path);
    assert!(diagnostics.list()[0].message.contains(".glb"), "{:?}", diagnostics.list());
}

/// A file that is not there is said to be missing, whatever its name promises.
#[test]
fn missing_files() {
    for name in ["no-such.pbrt", "no-such"] {
        let (_, diagnostics) = read_scene(Path::new(name));
        assert!(diagnostics.list()[0].message.contains("there is no file"), "{:?}", diagnostics.list());
    }
}
