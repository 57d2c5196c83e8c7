use std::path::Path;

use etendue_math::Point3;
use etendue_scene::document::{Document, EmbeddedFile, Entity};
use etendue_scene::{Diagnostics, LoadedMesh};

use super::polygon::triangulate;
use super::{read_obj_bytes, read_obj_mesh};

fn read(text: &str) -> LoadedMesh {
    read_obj_mesh(text.as_bytes()).expect("a good file").0
}

/// Indices count from 1, or back from the last vertex; corners that agree in all indices share a vertex.
#[test]
fn indices() {
    let text = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nf 1 2 3\nf -4 -2 -1 # back\n";
    let mesh = read(text);
    assert_eq!(mesh.positions.len(), 4);
    assert_eq!(mesh.triangles, [[0, 1, 2], [0, 2, 3]]);
    let seams = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 1 1 0\nvt 0 0\nvt 1\nf 1/1 2/1 3/1\nf 3/2 2/1 4/1\n";
    let mesh = read(seams);
    assert_eq!((mesh.positions.len(), mesh.uvs.len()), (5, 5));
    assert_eq!(mesh.triangles, [[0, 1, 2], [3, 1, 4]]);
}

fn area(corners: &[Point3], triangles: &[[usize; 3]]) -> f64 {
    let one = |t: &[usize; 3]| {
        let [a, b, c] = t.map(|i| corners[i]);
        f64::from((b - a).cross(c - a).z) / 2.0
    };
    // A triangle that is turned round would be subtracted.
    triangles.iter().map(one).map(f64::abs).sum()
}

/// A polygon's triangles cover it once: their areas add up to its own, in any plane and orientation.
#[test]
fn polygons() {
    let check = |outline: &[[f32; 2]], expected: f64| {
        let corners: Vec<Point3> = outline.iter().map(|[x, y]| Point3::new(*x, *y, 1.0)).collect();
        for corners in [corners.clone(), corners.iter().rev().copied().collect()] {
            let triangles = triangulate(&corners);
            assert_eq!(triangles.len(), corners.len() - 2);
            let found = area(&corners, &triangles);
            assert!((found - expected).abs() < 1e-5 * expected, "{found} for {expected}");
        }
    };
    check(&[[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]], 1.0);
    // An arrow head, whose fan from the first corner would stick out.
    check(&[[0.0, 0.0], [2.0, 1.0], [0.0, 2.0], [1.0, 1.0]], 1.0);
    // A U and a star.
    check(
        &[[0.0, 0.0], [3.0, 0.0], [3.0, 3.0], [2.0, 3.0], [2.0, 1.0], [1.0, 1.0], [1.0, 3.0], [0.0, 3.0]],
        7.0,
    );
    let star: Vec<[f32; 2]> = (0..10)
        .map(|i| {
            let (r, a) = (if i % 2 == 0 { 2.0 } else { 1.0 }, i as f32 * std::f32::consts::TAU / 10.0);
            [r * a.cos(), r * a.sin()]
        })
        .collect();
    check(&star, 10.0 * 0.5 * 2.0 * (std::f64::consts::TAU / 10.0).sin());
    // Collinear corners, and points in one place.
    check(&[[0.0, 0.0], [1.0, 0.0], [2.0, 0.0], [2.0, 1.0], [0.0, 1.0]], 2.0);
    assert_eq!(triangulate(&[Point3::default(); 6]).len(), 4);
}

/// Faces without normals are flat, or smooth within their group.
#[test]
fn smoothing() {
    let roof = "v 0 0 0\nv 1 0 1\nv 1 1 1\nv 0 1 0\nv 2 0 0\nv 2 1 0\n";
    let faces = "f 1 2 3 4\nf 2 5 6 3\n";
    assert!(read(&format!("{roof}{faces}")).normals.is_empty());
    let smooth = read(&format!("{roof}s 1\n{faces}"));
    assert_eq!(smooth.positions.len(), 6);
    // The ridge looks up, the eaves along their own slopes.
    assert!(smooth.normals[1].z > 0.999, "{:?}", smooth.normals);
    assert!((smooth.normals[0].x + 0.5_f32.sqrt()).abs() < 1e-5);
    let apart = read(&format!("{roof}s 1\nf 1 2 3 4\ns 2\nf 2 5 6 3\n"));
    assert_eq!(apart.positions.len(), 8);
    let mixed = read(&format!("{roof}s off\nf 1 2 3 4\nvn 0 0 1\nf 2//1 5//1 6//1 3//1\n"));
    assert_eq!(mixed.normals.len(), 8);
}

/// The first problem is told with its line.
#[test]
fn errors() {
    let check = |text: &str, expected: &str| {
        let why = read_obj_mesh(text.as_bytes()).expect_err(text);
        assert!(why.contains(expected), "'{expected}' is not in '{why}'");
    };
    check("v 0 0 0\nf 1 2 3\n", "line 2: there is no vertex 2: 1 come before this face");
    check("v 0 0 0\nf 0 1 1\n", "line 2: there is no vertex 0");
    check("v 0 0 0\nf 1 1 99999999999999999999\n", "is not an index");
    check("v 0 0 0\nf 1 1 -9223372036854775808\n", "there is no vertex");
    check("v 0 0\n", "line 1: this line should have 3 numbers");
    check("\nv 0 nan 0\n", "line 2: `nan` is not a number");
    check("v 0 0 0\nf 1 1\n", "a face has at least three corners");
    check("v 0 0 0\nf 1/1/1/1 1 1\n", "is no");
    check("", "the file has no faces");
}

fn scene(obj: &str, mtl: &str) -> (Document, Diagnostics) {
    let folder = tempfile::tempdir().expect("a temporary folder");
    std::fs::write(folder.path().join("a.mtl"), mtl).expect("writable");
    read_obj_bytes("a.obj", obj.as_bytes().to_vec(), folder.path())
}

const TRIANGLES: &str = "mtllib a.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nusemtl m\nf 1 2 3\n";

fn text(entity: &Entity) -> String {
    let parameters: Vec<_> = entity.parameters.iter().map(|p| format!("{}={:?}", p.name, p.value)).collect();
    format!("{} {}", entity.type_name, parameters.join(" "))
}

/// Each kind of material becomes ours of the same meaning.
#[test]
fn materials() {
    let check = |mtl: &str, expected: &str| {
        let (document, diagnostics) = scene(TRIANGLES, &format!("newmtl m\n{mtl}"));
        assert!(diagnostics.list().is_empty(), "{:?}", diagnostics.list());
        let material = document.materials.iter().find(|m| m.name.as_deref() == Some("m")).expect("m");
        assert_eq!(text(&material.entity), expected);
    };
    check("Kd 0.1 0.2 0.3\nillum 1", "diffuse reflectance=Rgb([[0.1, 0.2, 0.3]])");
    check(
        "Kd 0.5 0.5 0.5\nKs 0.5 0.5 0.5\nNs 6\nillum 2",
        "principled basecolor=Rgb([[0.5, 0.5, 0.5]]) roughness=Floats([0.70710677])",
    );
    check(
        "Kd 0 0 0\nKs 0.9 0.6 0.3\nNs 2000",
        "conductor reflectance=Rgb([[0.9, 0.6, 0.3]]) \
         roughness=Floats([0.0]) remaproughness=Bools([false])",
    );
    check("Ni 1.4\nillum 7\nd 0.1", "dielectric eta=Floats([1.4])");
    check(
        "Kd 1 0 0\nPr 0.3\nPm 1",
        "principled basecolor=Rgb([[1.0, 0.0, 0.0]]) metallic=Floats([1.0]) roughness=Floats([0.3])",
    );
}

/// Opacity, emission and pictures with their options reach the shapes.
#[test]
fn parts_of_materials() {
    let mtl = "newmtl m\nKd 0.5 0.5 0.5\nKe 1 2 3\nTr 0.25\nmap_Kd -s 2 3 -o 0.5 0 0 -clamp on my pic.png\n";
    let (document, diagnostics) = scene(TRIANGLES, mtl);
    assert!(diagnostics.list().is_empty(), "{:?}", diagnostics.list());
    assert!(text(&document.shapes[0].entity).ends_with("alpha=Floats([0.75])"));
    assert_eq!(text(&document.area_lights[0]), "diffuse L=Rgb([[1.0, 2.0, 3.0]])");
    assert_eq!(
        text(&document.textures[0].entity),
        "imagemap filename=Strings([\"my pic.png\"]) wrap=Strings([\"clamp\"]) uscale=Floats([2.0]) \
         vscale=Floats([3.0]) udelta=Floats([0.5]) scale=Floats([0.5])"
    );
}

/// Faces of one material make one shape; materials and libraries that are missing are told.
#[test]
fn shapes() {
    let obj = "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\nusemtl a\nf 1 2 3\nusemtl b\nf 1 2 3\nusemtl a\nf 3 2 1\n";
    let (document, diagnostics) = scene(obj, "");
    assert!(!diagnostics.has_errors());
    let meshes = document.embedded.values().filter(|file| matches!(file, EmbeddedFile::Mesh(_)));
    assert_eq!(meshes.count(), 3);
    let (_, diagnostics) = scene(TRIANGLES, "newmtl other\n");
    assert!(diagnostics.list()[0].message.contains("no library has the material `m`"));
    let (document, diagnostics) = scene("mtllib no.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n", "");
    assert!(!diagnostics.has_errors() && diagnostics.list()[0].message.contains("there is no file"));
    let span = diagnostics.list()[0].span.expect("a place");
    assert_eq!(document.sources.locate(span).line, 1);
    let (document, diagnostics) = scene(TRIANGLES, "newmtl m\nKd 1 x 1\n");
    let at = document.sources.locate(diagnostics.list()[0].span.expect("a place"));
    assert!(at.file.ends_with("a.mtl") && at.line == 2);
}

/// Damaged files end in errors, not in panics.
#[test]
fn damaged_files_do_not_panic() {
    let obj =
        format!("{TRIANGLES}vt 0 1\nvn 0 0 1\ns 1\nf 1/1/1 2//1 3/1 -1\nf -3/-1 2 3 1\nusemtl m\ng x\n");
    let mtl = "newmtl m\nKd 1 0 0\nKs 1 1 1\nNs 10\nmap_Kd -s 1 2 3 -bm 2 a.png\nd 0.5\nillum 4\nKe 1 1 1\n";
    let mut state = 1_u64;
    let mut random = |n: usize| {
        state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (state >> 33) as usize % n.max(1)
    };
    for _ in 0..1500 {
        let mut damaged = [obj.clone().into_bytes(), mtl.as_bytes().to_vec()];
        for bytes in &mut damaged {
            for _ in 0..3 {
                let at = random(bytes.len());
                match random(4) {
                    0 => bytes[at] = random(256) as u8,
                    1 => drop(bytes.drain(at..(at + random(9)).min(bytes.len()))),
                    2 => drop(bytes.splice(at..at, b"-9 1e40 / f v".iter().copied())),
                    _ => bytes.truncate(bytes.len() - random(8).min(bytes.len() - 1)),
                }
            }
        }
        let (document, diagnostics) =
            scene(&String::from_utf8_lossy(&damaged[0]), &String::from_utf8_lossy(&damaged[1]));
        for span in diagnostics.list().iter().filter_map(|problem| problem.span) {
            assert!(document.sources.locate(span).line >= 1);
        }
    }
    drop(read_obj_bytes("a.obj", vec![0xff; 100], Path::new("")));
}

/// The time that a position with many texture coordinates takes grows with their number: with its square it would be
/// minutes here. Each pair is one vertex.
#[test]
fn many_vertices_at_one_position() {
    let n = 200_000;
    let mut text = "v 0 0 0\nv 1 0 0\nv 0 1 0\n".to_owned();
    (0..n).for_each(|i| text += &format!("vt {i} 0\n"));
    for _ in 0..2 {
        (1..=n).for_each(|i| text += &format!("f 1/{i} 2/1 3/1\n"));
    }
    let mesh = read(&text);
    assert_eq!((mesh.positions.len(), mesh.triangles.len()), (n + 2, 2 * n));
    assert_eq!(mesh.triangles[n - 1], mesh.triangles[2 * n - 1]);
}

/// `#` within a name belongs to it; after white space it begins a comment.
#[test]
fn names_with_hashes() {
    use super::mtl;
    use super::parse::parse;
    let mut diagnostics = Diagnostics::default();
    let file = etendue_scene::diagnostics::FileId(0);
    let text = "mtllib a#1.mtl # a comment\nusemtl C#sharp\nusemtl b # another\n";
    let obj = parse(text, file, &mut diagnostics);
    assert_eq!(obj.libraries[0].text, "a#1.mtl");
    let names: Vec<&str> = obj.materials.iter().map(|name| name.text.as_str()).collect();
    assert_eq!(names, ["", "C#sharp", "b"]);
    let library = "newmtl C#sharp\nmap_Kd wood#2.png # oak\nKd 1 1 1# white\n";
    let materials = mtl::parse(library, file, &mut diagnostics);
    assert_eq!(materials[0].name, "C#sharp");
    assert_eq!(materials[0].map("kd").expect("a picture").file, "wood#2.png");
    assert!(diagnostics.list().is_empty());
}

/// The problems of a library are reported up to a number; errors end it, warnings do not.
#[test]
fn problems_of_libraries_are_bounded() {
    let count = |line: &str| {
        let mut diagnostics = Diagnostics::default();
        let text = format!("newmtl a\n{}newmtl b\n", line.repeat(1000));
        let materials = super::mtl::parse(&text, etendue_scene::diagnostics::FileId(0), &mut diagnostics);
        (materials.len(), diagnostics.list().len())
    };
    assert_eq!(count("unheard_of 1\n"), (2, 101));
    assert_eq!(count("Ns x\n"), (1, 101));
}
