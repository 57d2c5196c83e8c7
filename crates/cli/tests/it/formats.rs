//! Scenes of other formats: Mitsuba's, bare meshes, and what `convert` makes of all.

use std::path::{Path, PathBuf};

use etendue::image::Image;
use etendue::io::images::read_image;

use crate::real_scenes::shared_scenes;
use crate::support::{Folder, is_slow, scene};

/// A render of a file elsewhere.
#[track_caller]
fn render(folder: &Folder, path: &Path, arguments: &str) -> Image {
    let path = path.display().to_string();
    let mut all = vec!["render", path.as_str(), "-q", "-o", "out.exr"];
    all.extend(arguments.split_whitespace());
    folder.run_with(&all).expect(0);
    folder.image("out.exr")
}

fn means(image: &Image) -> [f64; 3] {
    let pixels = image.rgb_pixels().expect("colour");
    let sum = pixels
        .iter()
        .fold([0.0; 3], |sum: [f64; 3], pixel| std::array::from_fn(|c| sum[c] + f64::from(pixel[c])));
    sum.map(|s| s / pixels.len() as f64)
}

/// Five small scenes of another project agree with its references of 4096 samples within 1 % in the mean.
#[test]
fn mitsuba_scenes_agree_with_their_references() {
    let Some(scenes) = shared_scenes() else { return };
    let folder = Folder::new();
    let scenes = scenes.join("ignis-mitsuba-tests");
    let cases = [
        ("plane", "plane-d6"),
        ("point", "point"),
        ("emissive-plane", "emissive-plane"),
        ("emissive-plane-scale", "emissive-plane-scale"),
        ("room", "room"),
    ];
    for (name, reference) in cases {
        let image = render(&folder, &scenes.join(format!("{name}.xml")), "--spp 16 --wavelengths bands");
        let path = scenes.join(format!("references/ref-{reference}-4096.exr"));
        let expected = means(&read_image(path).expect("a reference"));
        for (ours, theirs) in means(&image).into_iter().zip(expected) {
            assert!((ours / theirs - 1.0).abs() < 0.01, "{name}: {ours} for {theirs}");
        }
    }
}

/// Colours and weights of a mesh, at vertices and on faces, agree pixel by pixel with Mitsuba's mean and variance: at most
/// 0.25 % of values differ by more than four standard errors.
#[test]
fn mesh_attributes_agree_pixel_by_pixel() {
    let Some(scenes) = shared_scenes() else { return };
    let folder = Folder::new();
    let scenes = scenes.join("mitsuba-tests/mesh_attributes");
    for name in ["1_face", "3_face", "3_vertex"] {
        let path = scenes.join(format!("test_mesh_attributes_{name}_direct.xml"));
        let image = render(&folder, &path, "--spp 256 --wavelengths bands");
        let reference = |suffix: &str| {
            let path = scenes.join(format!("refs/test_mesh_attributes_{name}_ref_rgb{suffix}.exr"));
            read_image(path).expect("a reference")
        };
        check_pixels(name, &image, &reference(""), &reference("_var"));
    }
}

fn check_pixels(name: &str, image: &Image, mean: &Image, variance: &Image) {
    let (ours, theirs) = (image.rgb_pixels().expect("colour"), mean.rgb_pixels().expect("colour"));
    let variances = variance.rgb_pixels().expect("colour");
    assert_eq!(ours.len(), theirs.len(), "{name}");
    let own = &image.channel("variance.Y").expect("renders state their variance").values;
    let mut n_far = 0;
    for (index, pixel) in ours.iter().enumerate() {
        for c in 0..3 {
            let difference = f64::from(pixel[c]) - f64::from(theirs[index][c]);
            // Theirs is that of one sample; the references have thousands, of which 256 is a safe lower bound. A pixel on
            // an edge has few samples on either side, so that measured variances say little below a step of 0.002.
            let deviation =
                (f64::from(variances[index][c]).max(0.0) / 256.0 + f64::from(own[index]) + 4e-6).sqrt();
            n_far += usize::from(difference.abs() > 4.0 * deviation);
        }
    }
    let share = n_far as f64 / (3 * ours.len()) as f64;
    assert!(share <= 0.0025, "{name}: {n_far} values differ, a share of {share}");
    let (a, b) = (means(image), means(mean));
    assert!((0..3).all(|c| (a[c] / b[c] - 1.0).abs() < 0.03), "{name}: {a:?} for {b:?}");
}

/// The box of one author in two formats is one scene.
#[test]
fn cornell_box_is_the_same_in_both_formats() {
    let Some(scenes) = shared_scenes() else { return };
    let folder = Folder::new();
    let scenes = scenes.join("cornell-box");
    let spp = if is_slow() { 256 } else { 64 };
    let arguments =
        format!("--spp {spp} --resolution 64x64 --wavelengths bands --integrator path:maxdepth=4");
    let images =
        ["mitsuba-scene-v3.xml", "scene-v4.pbrt"].map(|name| render(&folder, &scenes.join(name), &arguments));
    let error = |image: &Image| {
        let variance = &image.channel("variance.Y").expect("variance").values;
        variance.iter().map(|v| f64::from(*v)).sum::<f64>().sqrt() / variance.len() as f64
    };
    let y = |image: &Image| {
        let [r, g, b] = means(image);
        0.2126 * r + 0.7152 * g + 0.0722 * b
    };
    let difference = y(&images[0]) - y(&images[1]);
    let deviation = error(&images[0]).hypot(error(&images[1]));
    assert!(difference.abs() < 4.0 * deviation, "{difference} with a standard error of {deviation}");
}

/// Scenes with media load with a warning that names the medium.
#[test]
fn media_are_named() {
    let Some(scenes) = shared_scenes() else { return };
    let folder = Folder::new();
    for (name, medium) in [
        ("mitsuba-tests/participating_media/test_homo_area_light_volpath.xml", "medium1"),
        ("mitsuba-tests/participating_media/test_homo_roughdielectric_spot_volpath.xml", "medium1"),
        ("lajolla-translucent-teapot/vol_cbox_teapot.xml", "medium"),
    ] {
        let path = scenes.join(name).display().to_string();
        let json = folder.run_with(&["info", &path, "--json"]).expect(0).json();
        let warnings = json["warnings"].to_string();
        assert!(warnings.contains("participating media") && warnings.contains(medium), "{warnings}");
    }
}

const CUBE: &str = "v -1 0 -1\nv 1 0 -1\nv 1 0 1\nv -1 0 1\nv -1 2 -1\nv 1 2 -1\nv 1 2 1\nv -1 2 1\n\
    f 1 2 3 4\nf 5 8 7 6\nf 1 5 6 2\nf 2 6 7 3\nf 3 7 8 4\nf 4 8 5 1\n";

/// A bare mesh makes a picture: the body in the middle is darker in its own shadow than the sky is, and nothing is black.
#[test]
fn bare_meshes_render() {
    let folder = Folder::new();
    folder.write("cube.obj", CUBE);
    folder.run("render cube.obj -q --spp 4 --resolution 48x48 -o cube.exr").expect(0);
    let image = folder.image("cube.exr");
    let pixels = image.rgb_pixels().expect("colour");
    assert!(pixels.iter().all(|p| p[1] > 0.01));
    let mean = means(&image)[1];
    assert!((0.2..0.9).contains(&mean), "{mean}");
    folder.write("empty.ply", "ply\nformat ascii 1.0\nelement vertex 0\nproperty float x\nproperty float y\nproperty float z\nelement face 0\nproperty list uchar int vertex_indices\nend_header\n");
    folder.run("render empty.ply -q -o empty.exr").expect(2);
    folder.write("bad.obj", "v 0 0 0\nf 1 2 3\n");
    folder.run("render bad.obj -q -o bad.exr").expect(2).says("bad.obj:2:1");
}

/// A scene that was converted renders the same bits, whatever it was before.
#[test]
fn converted_scenes_render_the_same_bits() {
    let folder = Folder::new();
    folder.write("scene.pbrt", scene("", "Material \"conductor\" Shape \"sphere\" \"float radius\" 0.5"));
    folder.write("cube.obj", CUBE);
    folder.write("scene.xml", MITSUBA);
    for input in ["scene.pbrt", "cube.obj", "scene.xml"] {
        let stem = input.replace('.', "-");
        folder.run(&format!("convert {input} {stem}.pbrt")).expect(0);
        let arguments = "-q --spp 2 --resolution 24x18";
        folder.run(&format!("render {input} {arguments} -o a.pfm")).expect(0);
        folder.run(&format!("render {stem}.pbrt {arguments} -o b.pfm")).expect(0);
        assert!(folder.read("a.pfm") == folder.read("b.pfm"), "{input}");
    }
    assert!(folder.path("cube-obj-meshes").is_dir() && folder.path("scene-xml-meshes").is_dir());
}

const MITSUBA: &str = r#"<scene version="3.0.0"><sensor type="perspective"><transform name="to_world">
    <lookat origin="3,4,5" target="0,1,0" up="0,1,0"/></transform></sensor><emitter type="constant"/>
    <shape type="obj"><string name="filename" value="cube.obj"/><bsdf type="mask"><float name="opacity" value="0.5"/>
    <bsdf type="plastic"/></bsdf></shape>
    <shape type="rectangle"><transform name="to_world"><rotate x="1" angle="-90"/><scale value="9"/></transform>
    <bsdf type="diffuse"><texture type="checkerboard" name="reflectance"/></bsdf></shape></scene>"#;

/// What would be lost is refused: the input, and outputs of other formats; a bad scene leaves no files.
#[test]
fn conversions_that_are_refused() {
    let folder = Folder::new();
    folder.write("scene.pbrt", scene("", "Shape \"sphere\""));
    folder.run("convert scene.pbrt scene.pbrt").expect(2).says("overwrite");
    folder.run("convert scene.pbrt ./scene.pbrt").expect(2).says("overwrite");
    folder.run("convert scene.pbrt scene.xml").expect(2).says(".pbrt");
    folder.run("convert nothing.xml out.pbrt").expect(2);
    folder.write("bad.xml", "<scene version=\"3.0.0\"><shape type=\"nothing\"/></scene>");
    folder.run("convert bad.xml out.pbrt").expect(2).says("bad.xml:1:");
    assert_eq!(folder.files(), ["bad.xml", "scene.pbrt"]);
}

/// Files that a scene names are found from where the converted one lies.
#[test]
fn conversion_into_another_folder() {
    let folder = Folder::new();
    let path = |name: &str| -> PathBuf { folder.path(name) };
    std::fs::create_dir(path("in")).expect("a folder");
    std::fs::create_dir(path("out")).expect("a folder");
    folder.write("in/cube.obj", CUBE);
    folder.run("convert in/cube.obj in/cube.pbrt").expect(0);
    folder.run("convert in/cube.pbrt out/again.pbrt").expect(0);
    folder.run("convert in/cube.pbrt below.pbrt").expect(0);
    // A folder that is not there yet is made before names are given as seen from it.
    folder.run("convert in/cube.pbrt new/folder/again.pbrt").expect(0);
    let bits = |name: &str| {
        folder.run(&format!("render {name} -q --spp 1 --resolution 16x16 -o x.pfm")).expect(0);
        folder.read("x.pfm")
    };
    let expected = bits("in/cube.pbrt");
    assert!(bits("out/again.pbrt") == expected && bits("below.pbrt") == expected);
    assert!(bits("new/folder/again.pbrt") == expected);
}
