//! Files, includes and imports.

use std::fs;
use std::io::Write;
use std::path::Path;

use etendue_scene::Document;
use etendue_scene::document::MaterialReference;
use flate2::Compression;
use flate2::write::GzEncoder;
use tempfile::TempDir;

use super::super::{read_pbrt, read_pbrt_bytes};
use super::{check_point, listed};

/// A folder with files of those names and contents.
fn folder(files: &[(&str, &[u8])]) -> TempDir {
    let folder = TempDir::new().expect("there is room for temporary files");
    for (name, content) in files {
        let path = folder.path().join(name);
        fs::create_dir_all(path.parent().expect("files have folders")).expect("the folder can be made");
        fs::write(path, content).expect("the file can be written");
    }
    folder
}

/// The document and the problems of `main.pbrt`.
fn read_main(folder: &TempDir) -> (Document, Vec<String>) {
    let (document, diagnostics) = read_pbrt(&folder.path().join("main.pbrt"));
    let problems = listed(&document, &diagnostics);
    (document, problems)
}

fn gzip(bytes: &[u8]) -> Vec<u8> {
    let mut encoder = GzEncoder::new(Vec::new(), Compression::default());
    encoder.write_all(bytes).expect("memory takes all bytes");
    encoder.finish().expect("memory takes all bytes")
}

/// An included file is part of the text; its names are relative to the main file's folder.
#[test]
fn include_shares_the_state() {
    let folder = folder(&[
        ("main.pbrt", b"WorldBegin\nInclude \"sub/a.pbrt\"\nShape \"sphere\""),
        ("sub/a.pbrt", b"Translate 1 0 0\nInclude \"sub/b.pbrt\"\nAttributeEnd"),
        ("sub/b.pbrt", b"Material \"conductor\" AttributeBegin Translate 5 5 5"),
    ]);
    let (document, problems) = read_main(&folder);
    assert!(problems.is_empty(), "{problems:?}");
    check_point(document.shapes[0].world_from_object.start, [0.0; 3], [1.0, 0.0, 0.0]);
    assert_eq!(document.shapes[0].material, MaterialReference::Index(1));
    assert_eq!(document.sources.files().len(), 3);
    assert_eq!(document.base_directory, folder.path());
}

/// Imported definitions and shapes stay, but no attribute does.
#[test]
fn import_restores_the_state() {
    let folder = folder(&[
        (
            "main.pbrt",
            b"WorldBegin Translate 1 0 0\nImport \"a.pbrt\"\nShape \"disk\" CoordSysTransform \"there\"",
        ),
        (
            "a.pbrt",
            b"Translate 1 0 0 Material \"conductor\" MakeNamedMaterial \"m\" \"string type\" \"diffuse\"
              CoordinateSystem \"there\" Shape \"sphere\" AttributeBegin",
        ),
    ]);
    let (document, problems) = read_main(&folder);
    let expected = [
        "2:55: error: this `AttributeBegin` has no `AttributeEnd`",
        "3:32: warning: there is no coordinate system `there`: the transform stays",
    ];
    assert_eq!(problems, expected);
    check_point(document.shapes[0].world_from_object.start, [0.0; 3], [2.0, 0.0, 0.0]);
    check_point(document.shapes[1].world_from_object.start, [0.0; 3], [1.0, 0.0, 0.0]);
    assert_eq!(document.shapes[1].material, MaterialReference::Index(0));
    assert_eq!(document.materials.len(), 3);
}

/// Imports inside of an object definition add to it, but cannot end it.
#[test]
fn import_inside_an_object() {
    let folder = folder(&[
        (
            "main.pbrt",
            b"WorldBegin ObjectBegin \"o\" Import \"a.pbrt\" Shape \"disk\" ObjectEnd Shape \"cone\"",
        ),
        ("a.pbrt", b"Shape \"sphere\" ObjectEnd"),
    ]);
    let (document, problems) = read_main(&folder);
    assert_eq!(problems, ["1:16: error: `ObjectEnd` without a matching `ObjectBegin`"]);
    assert_eq!((document.objects[0].shapes.len(), document.shapes.len()), (2, 1));
}

/// Blocks that an imported file opens and closes leave the object of the importing file open.
#[test]
fn blocks_of_an_import_inside_an_object() {
    let folder = folder(&[
        (
            "main.pbrt",
            b"WorldBegin ObjectBegin \"o\" Import \"a.pbrt\" Shape \"disk\" ObjectEnd Shape \"cone\"",
        ),
        ("a.pbrt", b"AttributeBegin Shape \"sphere\" AttributeEnd Shape \"cylinder\""),
    ]);
    let (document, problems) = read_main(&folder);
    assert!(problems.is_empty(), "{problems:?}");
    assert_eq!((document.objects[0].shapes.len(), document.shapes.len()), (3, 1));
}

/// Errors lie in the file that has them.
#[test]
fn errors_name_their_file() {
    let folder =
        folder(&[("main.pbrt", b"WorldBegin\nInclude \"a.pbrt\"\nFoooo"), ("a.pbrt", b"\n\n  Barrr")]);
    let (document, diagnostics) = read_pbrt(&folder.path().join("main.pbrt"));
    let files: Vec<_> = diagnostics
        .list()
        .iter()
        .map(|problem| document.sources.locate(problem.span.expect("errors have places")).to_string())
        .collect();
    let path = |name: &str| folder.path().join(name).display().to_string();
    assert_eq!(files, [path("a.pbrt") + ":3:3", path("main.pbrt") + ":3:1"]);
}

/// A file that includes itself would never end.
#[test]
fn recursive_includes() {
    let folder = folder(&[
        ("main.pbrt", b"WorldBegin\nInclude \"a.pbrt\"\nShape \"sphere\""),
        ("a.pbrt", b"Include \"b.pbrt\""),
        ("b.pbrt", b"Include \"./a.pbrt\" Import \"main.pbrt\""),
    ]);
    let (document, problems) = read_main(&folder);
    let expected = [
        "1:9: error: the file includes itself: a.pbrt → b.pbrt → ./a.pbrt",
        "1:27: error: the file includes itself: main.pbrt → a.pbrt → b.pbrt → main.pbrt",
    ];
    assert_eq!(problems, expected);
    assert_eq!(document.shapes.len(), 1);
}

/// The same file may be included again after it has ended.
#[test]
fn repeated_includes() {
    let folder = folder(&[
        ("main.pbrt", b"WorldBegin Include \"a.pbrt\" Include \"a.pbrt\""),
        ("a.pbrt", b"Shape \"sphere\""),
    ]);
    let (document, problems) = read_main(&folder);
    assert!(problems.is_empty(), "{problems:?}");
    assert_eq!(document.shapes.len(), 2);
}

/// Compressed files are read by their content, whatever their name.
#[test]
fn gzip_files() {
    let include = gzip(b"Shape \"sphere\"");
    let main = gzip(b"WorldBegin Include \"a.pbrt.gz\" Include \"b.pbrt\"");
    let folder = folder(&[("main.pbrt", &main), ("a.pbrt.gz", &include), ("b.pbrt", &include)]);
    let (document, problems) = read_main(&folder);
    assert!(problems.is_empty(), "{problems:?}");
    assert_eq!(document.shapes.len(), 2);
    assert_eq!(document.sources.files()[1].text, "Shape \"sphere\"");

    fs::write(folder.path().join("a.pbrt.gz"), &include[..20]).expect("the file can be written");
    let (_, problems) = read_main(&folder);
    assert!(problems.len() == 1 && problems[0].contains("cannot decompress"), "{problems:?}");
}

/// Files that cannot be read are errors where they are named.
#[test]
fn unreadable_files() {
    let folder =
        folder(&[("main.pbrt", b"WorldBegin Include \"none.pbrt\"\nInclude \"sub\""), ("sub/x", b"")]);
    let (_, problems) = read_main(&folder);
    let path = |name: &str| folder.path().join(name).display().to_string();
    let expected = [
        format!("1:20: error: there is no file `{}`", path("none.pbrt")),
        format!("2:9: error: `{}` is a folder, not a file", path("sub")),
    ];
    assert_eq!(problems, expected);
    for name in ["nothing.pbrt", "sub", ""] {
        let (document, diagnostics) = read_pbrt(&folder.path().join(name));
        assert_eq!(listed(&document, &diagnostics).len(), 1, "{name}");
    }
    assert!(read_pbrt(Path::new("/")).1.has_errors());
}

/// Bytes that are no text are errors with a place, and the rest is still read.
#[test]
fn bytes_that_are_no_text() {
    let (document, diagnostics) =
        read_pbrt_bytes("t", b"WorldBegin\n# caf\xe9\nShape \"sphere\" Foooo".to_vec(), Path::new(""));
    let problems = listed(&document, &diagnostics);
    assert_eq!(
        problems,
        ["2:6: error: this byte is not part of UTF-8 text", "3:16: error: unknown directive `Foooo`"]
    );
    assert_eq!(document.shapes.len(), 1);

    let (document, diagnostics) = read_pbrt_bytes("t", b"\xff\xfeW\0o\0".to_vec(), Path::new(""));
    let problems = listed(&document, &diagnostics);
    assert_eq!(problems[0], "1:1: error: the file is encoded in UTF-16: save it as UTF-8");
}
