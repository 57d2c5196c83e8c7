//! Meshes, pictures and spectra that are missing or damaged: the message names the file and the place that names it.

use etendue::image::Image;
use etendue::io::images::write_image;

use crate::support::{Folder, WORLD_LINE, scene};

/// Renders a scene with one line after `WorldBegin` that names a bad file.
#[track_caller]
fn refuse(folder: &Folder, world: &str, column: usize, says: &[&str]) {
    folder.write("scene.pbrt", scene("", world));
    let before = folder.files();
    let place = format!("scene.pbrt:{WORLD_LINE}:{column}: error: ");
    let mut run = folder.run("render scene.pbrt -o out.exr").expect(2).says(&place).says("\n1 error\n");
    for text in says {
        run = run.says(text);
    }
    assert_eq!(folder.files(), before);
}

const MESH: &str = "Shape \"plymesh\" \"string filename\" \"a.ply\"";

/// Header of a mesh of three vertices and one face.
fn header(format: &str) -> String {
    format!(
        "ply\nformat {format} 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\n\
         element face 1\nproperty list uchar int vertex_indices\nend_header\n"
    )
}

/// The mesh in binary, with these corners and this first coordinate.
fn binary(corners: [i32; 3], x: f32) -> Vec<u8> {
    let mut bytes = header("binary_little_endian").into_bytes();
    for value in [x, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0, 0.0_f32] {
        bytes.extend_from_slice(&value.to_le_bytes());
    }
    bytes.push(3);
    for corner in corners {
        bytes.extend_from_slice(&corner.to_le_bytes());
    }
    bytes
}

/// Files that are not there.
#[test]
fn missing_files() {
    let folder = Folder::new();
    for (world, what) in [
        (MESH, "a \"plymesh\" needs"),
        ("LightSource \"infinite\" \"string filename\" \"a.ply\"", "light needs"),
        ("Texture \"t\" \"float\" \"imagemap\" \"string filename\" \"a.ply\"", "an image texture needs"),
    ] {
        let column = world.find("\"string filename").expect("a parameter") + 1;
        refuse(&folder, &world.replace("a.ply", ""), column, &[what, "\"filename\""]);
    }
    let relative = "names of files are relative to the folder of the scene file";
    refuse(&folder, MESH, 17, &["a.ply", relative]);
    refuse(
        &folder,
        "Texture \"t\" \"spectrum\" \"imagemap\" \"string filename\" \"a.png\"",
        35,
        &["a.png", relative],
    );
    refuse(&folder, "LightSource \"infinite\" \"string filename\" \"a.exr\"", 24, &["a.exr", relative]);
    refuse(&folder, "Material \"diffuse\" \"string normalmap\" \"a.png\"", 20, &["a.png", relative]);
    refuse(&folder, "Material \"conductor\" \"spectrum eta\" \"a.spd\"", 22, &["a.spd", relative]);
}

/// Meshes as text that are cut short or hold nonsense.
#[test]
fn ascii_meshes() {
    let folder = Folder::new();
    let good = header("ascii") + "0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n";
    folder.write("a.ply", &good);
    folder.write("scene.pbrt", scene("", MESH));
    folder.run("render scene.pbrt -o good.exr").expect(0);

    folder.write("a.ply", &good[..good.len() - 12]);
    refuse(&folder, MESH, 17, &["a.ply", "ends at"]);
    folder.write("a.ply", &good[..60]);
    refuse(&folder, MESH, 17, &["a.ply", "header"]);
    folder.write("a.ply", good.replace("1 0 0", "1 nan 0"));
    refuse(&folder, MESH, 17, &["a.ply", "vertex 1"]);
    folder.write("a.ply", good.replace("1 0 0", "1 one 0"));
    refuse(&folder, MESH, 17, &["a.ply", "`one` is not a number"]);
    folder.write("a.ply", good.replace("3 0 1 2", "3 0 1 9"));
    refuse(&folder, MESH, 17, &["a.ply", "face 0 refers to vertex 9, but there are 3 vertices"]);
    folder.write("a.ply", good.replace("3 0 1 2", "3 0 1 -2"));
    refuse(&folder, MESH, 17, &["a.ply", "face 0 refers to vertex -2"]);
    folder.write("a.ply", "");
    refuse(&folder, MESH, 17, &["a.ply", "does not begin with `ply`"]);
}

/// Binary meshes that are cut short or hold nonsense.
#[test]
fn binary_meshes() {
    let folder = Folder::new();
    let good = binary([0, 1, 2], 0.0);
    folder.write("a.ply", &good);
    folder.write("scene.pbrt", scene("", MESH));
    folder.run("render scene.pbrt -o good.exr").expect(0);

    for length in [good.len() - 1, good.len() - 13, good.len() - 30, header("binary_little_endian").len()] {
        folder.write("a.ply", &good[..length]);
        refuse(&folder, MESH, 17, &["a.ply", "ends at"]);
    }
    folder.write("a.ply", binary([0, 1, 3], 0.0));
    refuse(&folder, MESH, 17, &["a.ply", "face 0 refers to vertex 3, but there are 3 vertices"]);
    folder.write("a.ply", binary([0, 1, -1], 0.0));
    refuse(&folder, MESH, 17, &["a.ply", "face 0 refers to vertex -1"]);
    folder.write("a.ply", binary([0, 1, 2], f32::NAN));
    refuse(&folder, MESH, 17, &["a.ply", "vertex 0 has a coordinate that is not finite"]);
    folder.write("a.ply", binary([0, 1, 2], f32::INFINITY));
    refuse(&folder, MESH, 17, &["a.ply", "vertex 0 has a coordinate that is not finite"]);
}

/// A header that declares more than the file holds takes no memory for it.
#[test]
fn meshes_that_claim_too_much() {
    let folder = Folder::new();
    for format in ["ascii", "binary_little_endian", "binary_big_endian"] {
        for count in ["900000000", "4000000000", "18446744073709551615"] {
            let vertices = format!("element vertex {count}");
            folder.write("a.ply", header(format).replace("element vertex 3", &vertices) + "0 0 0\n");
            refuse(&folder, MESH, 17, &["a.ply", "ends at vertex"]);
        }
        let faces =
            header(format).replace("element face 1", "element face 3000000000") + "0 0 0 0 0 0 0 0 0\n";
        folder.write("a.ply", faces.into_bytes());
        refuse(&folder, MESH, 17, &["a.ply"]);
    }
}

/// Pictures that are cut short, or something else than their name says.
#[test]
fn pictures() {
    let folder = Folder::new();
    let texture = "Texture \"t\" \"spectrum\" \"imagemap\" \"string filename\" \"a.png\"";
    let noise = (0..64 * 64_u32)
        .map(|i| [0, 8, 16].map(|s| (i.wrapping_mul(2_654_435_761) >> s) as f32 % 256.0 / 256.0));
    let image = Image::rgb(64, 64, noise.collect());
    write_image(folder.path("whole.png"), &image).expect("written");
    let good = folder.read("whole.png");
    for length in [good.len() - 40, good.len() / 2, 60, 20] {
        folder.write("a.png", &good[..length]);
        refuse(&folder, texture, 35, &["a.png"]);
    }
    folder.write("a.png", "this is text");
    refuse(&folder, texture, 35, &["a.png", "the contents are not those of a `png` file"]);
    folder.write("a.png", "");
    refuse(&folder, texture, 35, &["a.png", "empty"]);
    std::fs::remove_file(folder.path("a.png")).expect("removed");
    std::fs::create_dir(folder.path("a.png")).expect("made");
    refuse(&folder, texture, 35, &["a.png", "folder"]);

    write_image(folder.path("whole.exr"), &image).expect("written");
    let good = folder.read("whole.exr");
    let light = "LightSource \"infinite\" \"string filename\" \"a.exr\"";
    for length in [good.len() - 1, good.len() / 2, 60] {
        folder.write("a.exr", &good[..length]);
        refuse(&folder, light, 24, &["a.exr"]);
    }
}

/// Pictures whose numbers or shape a light cannot have.
#[test]
fn pictures_of_light() {
    let folder = Folder::new();
    let light = "LightSource \"infinite\" \"string filename\" \"a.pfm\"";
    write_image(folder.path("a.pfm"), &Image::rgb(4, 2, vec![[1.0; 3]; 8])).expect("written");
    refuse(&folder, light, 24, &["must be square", "not 4 x 2", "latitude-longitude"]);
    let mut pixels = vec![[1.0; 3]; 16];
    pixels[5][1] = f32::NAN;
    write_image(folder.path("a.pfm"), &Image::rgb(4, 4, pixels)).expect("written");
    refuse(&folder, light, 24, &["a.pfm", "infinite or undefined values"]);
}

/// Measured spectra that are no tables of numbers.
#[test]
fn spectra() {
    let folder = Folder::new();
    let material = "Material \"conductor\" \"spectrum eta\" \"a.spd\"";
    folder.write("a.spd", "400 1\n500\n");
    refuse(&folder, material, 22, &["a.spd", "line 2"]);
    folder.write("a.spd", "400 1\n500 x\n");
    refuse(&folder, material, 22, &["a.spd", "line 2"]);
    folder.write("a.spd", "400 1\n300 1\n");
    refuse(&folder, material, 22, &["a.spd"]);
    folder.write("a.spd", "");
    refuse(&folder, material, 22, &["a.spd"]);
}
