use std::fs;
use std::path::Path;

use etendue_image::Image;
use etendue_scene::Diagnostics;
use etendue_scene::bsdf::measured::{MeasuredBrdf, MeasuredGrid};
use etendue_scene::document::Value;
use tempfile::TempDir;

use super::load_assets;
use crate::images::write_image;
use crate::measured::measured_bytes;
use crate::pbrt::read_pbrt_str;

const TRIANGLE: &str = "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\n\
    property float z\nelement face 1\nproperty list uchar int vertex_indices\nend_header\n\
    0 0 0 1 0 0 0 1 0 3 0 1 2\n";

fn folder() -> TempDir {
    let folder = TempDir::new().expect("there is room for temporary files");
    let write = |name: &str, content: &str| {
        fs::write(folder.path().join(name), content).expect("the file can be written");
    };
    write("a.ply", TRIANGLE);
    write("bad.ply", &TRIANGLE.replace("0 1 2\n", "0 1 7\n"));
    write("fan.ply", &TRIANGLE.replace("3 0 1 2\n", "5 0 1 2 1 0\n"));
    write("a.spd", "400 1\n500 2\n");
    write("bad.spd", "400\n");
    write("a.brdf", "brdf 1\n2 2 1\n1 1 1\n1 1 1\n1 1 1\n1 1 1\n");
    write("bad.brdf", "brdf 1\n2 2 1\n1 1 1\n1 -1 1\n");
    write("bad.bsdf", "tensor_file");
    let wavelengths = vec![500.0];
    let grid = MeasuredGrid { n_phi: 1, n_theta: 2, n_facets: [4, 4], n_spectra: 4, wavelengths };
    let brdf = MeasuredBrdf::of_model(&grid, |_| 1.0, |_, _, _| 0.1).expect("the model is sound");
    fs::write(folder.path().join("a.bsdf"), measured_bytes(&brdf, "even")).expect("the file can be written");
    let image = Image::rgb(2, 1, vec![[0.5; 3]; 2]);
    write_image(folder.path().join("a.pfm"), &image).expect("the image can be written");
    folder
}

fn messages(diagnostics: &Diagnostics) -> Vec<String> {
    diagnostics.list().iter().map(|problem| problem.message.clone()).collect()
}

/// Files are found wherever a parameter names one, and each is read once.
#[test]
fn all_kinds_of_files_are_loaded() {
    let folder = folder();
    let text = r#"Film "rgb" "spectrum response" "a.spd" WorldBegin
        Texture "t" "spectrum" "imagemap" "string filename" "a.pfm"
        Texture "u" "spectrum" "constant" "spectrum value" "./a.spd" "string filename" "ignored.png"
        LightSource "infinite" "string filename" "./a.pfm" LightSource "point" "spectrum I" "stdillum-D65"
        Material "dielectric" "string normalmap" "././a.pfm" "spectrum eta" "glass-BK7"
        Material "tabulated" "string filename" "a.brdf" Material "measured" "string filename" "a.bsdf"
        Shape "plymesh" "string filename" "a.ply" Shape "plymesh" "string filename" [ "a.ply" ]
        Shape "sphere" "string filename" "ignored.ply"
        ObjectBegin "o" Shape "plymesh" "string filename" "./a.ply" ObjectEnd"#;
    let (document, problems) = read_pbrt_str("test", text, folder.path());
    assert!(problems.list().is_empty());
    let (assets, diagnostics) = load_assets(&document);
    assert!(diagnostics.list().is_empty(), "{:?}", messages(&diagnostics));
    let sorted = |mut names: Vec<&String>| {
        names.sort();
        names.into_iter().cloned().collect::<Vec<_>>()
    };
    assert_eq!(sorted(assets.meshes.keys().collect()), ["./a.ply", "a.ply"]);
    assert_eq!(sorted(assets.images.keys().collect()), ["././a.pfm", "./a.pfm", "a.pfm"]);
    assert_eq!(sorted(assets.spectra.keys().collect()), ["./a.spd", "a.spd"]);
    assert_eq!(assets.meshes["a.ply"].triangles, [[0, 1, 2]]);
    assert_eq!((assets.images["a.pfm"].width(), assets.images["a.pfm"].height()), (2, 1));
    assert_eq!(assets.spectra["a.spd"], [[400.0, 1.0], [500.0, 2.0]]);
    assert_eq!(assets.brdfs.keys().collect::<Vec<_>>(), ["a.brdf"]);
    assert_eq!(assets.measured.keys().collect::<Vec<_>>(), ["a.bsdf"]);
}

/// Each file that fails is an error where it is named first; the others are there.
#[test]
fn failures_are_located() {
    let folder = folder();
    let text = "WorldBegin\nShape \"plymesh\" \"string filename\" \"none.ply\"\n\
        Shape \"plymesh\" \"string filename\" \"bad.ply\"\nShape \"plymesh\" \"string filename\" \"fan.ply\"\n\
        Material \"conductor\" \"spectrum k\" \"bad.spd\" \"spectrum eta\" \"none.spd\"\n\
        LightSource \"infinite\" \"string filename\" \"none.pfm\"\n\
        Material \"tabulated\" \"string filename\" \"bad.brdf\"\n\
        Material \"measured\" \"string filename\" \"bad.bsdf\"\n\
        Material \"measured\" \"string filename\" \"none.bsdf\"";
    let (document, _) = read_pbrt_str("test", text, folder.path());
    let (assets, diagnostics) = load_assets(&document);
    let path = |name: &str| folder.path().join(name).display().to_string();
    let found = messages(&diagnostics);
    let expect = [
        (3, format!("`{}`: face 0 refers to vertex 7, but there are 3 vertices", path("bad.ply"))),
        (4, "mesh \"fan.ply\": 1 polygons of more than four corners were cut into triangles".to_owned()),
        (2, format!("there is no file `{}`", path("none.ply"))),
        (6, String::new()),
        (5, format!("`{}`: line 1 should be a wavelength and a value", path("bad.spd"))),
        (5, format!("there is no file `{}`", path("none.spd"))),
        (7, format!("`{}`: line 4 should be red, green and blue", path("bad.brdf"))),
        (8, format!("`{}`: a tensor file begins with `tensor_file`", path("bad.bsdf"))),
        (9, format!("there is no file `{}`", path("none.bsdf"))),
    ];
    assert_eq!(found.len(), expect.len(), "{found:#?}");
    for (problem, (line, message)) in diagnostics.list().iter().zip(expect) {
        let span = problem.span.expect("assets have places");
        assert_eq!(document.sources.locate(span).line, line, "{}", problem.message);
        assert!(problem.message.contains(&message), "{} instead of {message}", problem.message);
    }
    assert_eq!(assets.meshes.len(), 1);
}

/// Names of spectra that are no files are left to the scene builder.
#[test]
fn unknown_spectra_are_no_files() {
    let text = "WorldBegin Material \"conductor\" \"spectrum k\" \"metal-Unobtainium-k\"";
    let (document, _) = read_pbrt_str("test", text, Path::new(""));
    assert!(matches!(&document.materials[1].entity.parameters[0].value, Value::SpectrumNames(_)));
    assert!(load_assets(&document).1.list().is_empty());
}
