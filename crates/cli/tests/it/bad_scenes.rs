//! Scenes that cannot be rendered: every problem is told with its place and the way to mend it, the exit code is 2,
//! nothing crashes, and no file appears.

use crate::support::{Folder, WORLD_LINE, scene, unlit_scene};

/// Renders a scene that is wrong; each text must be said.
#[track_caller]
fn refuse(text: &str, says: &[&str]) {
    let folder = Folder::with_scene(text);
    let mut run = folder.run("render scene.pbrt -o out.exr").expect(2);
    for text in says {
        run = run.says(text);
    }
    assert_eq!(run.stdout, "");
    assert_eq!(folder.files(), ["scene.pbrt"]);
}

/// The same for something after `WorldBegin`; `place` is `line:column`, lines counted from 1 in `world`.
#[track_caller]
fn refuse_world(world: &str, (line, column): (usize, usize), says: &[&str]) {
    let place = format!("scene.pbrt:{}:{column}: error: ", WORLD_LINE + line - 1);
    let mut all = vec![place.as_str()];
    all.extend(says);
    refuse(&scene("", world), &all);
}

/// The same for something before `WorldBegin`, which is line 4.
#[track_caller]
fn refuse_option(options: &str, column: usize, says: &[&str]) {
    let place = format!("scene.pbrt:4:{column}: error: ");
    let mut all = vec![place.as_str()];
    all.extend(says);
    refuse(&scene(options, "Shape \"sphere\""), &all);
}

/// A message has the form of compilers' messages, with the line and the place underlined.
#[test]
fn message_in_full() {
    let folder = Folder::with_scene(&scene("", "Shape \"shpere\" \"float radius\" 2"));
    let run = folder.run("render scene.pbrt -o out.exr").expect(2);
    let expected = "\
scene.pbrt:7:7: error: unknown shape \"shpere\"
  7 | Shape \"shpere\" \"float radius\" 2
    |       ^^^^^^^^
  help: did you mean \"sphere\"?
1 error
";
    assert_eq!(run.stderr, expected);
}

/// Names that mean nothing come with the nearest one that does.
#[test]
fn unknown_names() {
    refuse_world(
        "Material \"difuse\"",
        (1, 10),
        &["unknown material \"difuse\"", "did you mean \"diffuse\"?"],
    );
    refuse_world("Shape \"cylindre\"", (1, 7), &["unknown shape", "did you mean \"cylinder\"?"]);
    refuse_world("LightSource \"distnat\"", (1, 13), &["unknown light", "did you mean \"distant\"?"]);
    refuse_world(
        "AreaLightSource \"difuse\"\nShape \"sphere\"",
        (1, 17),
        &["unknown area light", "did you mean \"diffuse\"?"],
    );
    refuse_world(
        "Texture \"t\" \"spectrum\" \"imgemap\" \"string filename\" \"a.png\"",
        (1, 24),
        &["\"imgemap\"", "did you mean \"imagemap\"?"],
    );
    refuse_world("Texture \"t\" \"color\" \"constant\"", (1, 13), &["spectrum"]);
    refuse_option("Integrator \"pth\"", 12, &["unknown integrator", "did you mean \"path\"?"]);
    refuse_option("Camera \"perspectiv\"", 8, &["unknown camera", "did you mean \"perspective\"?"]);
    refuse_option("Film \"rbg\"", 6, &["unknown film", "did you mean \"rgb\"?"]);
    refuse_option("Film \"rgb\" \"string sensor\" \"canon_eos_5\"", 12, &["unknown sensor", "canon_eos_5"]);
    refuse_option("Sampler \"soboll\"", 9, &["unknown sampler", "sobol\"?"]);
    refuse_option("PixelFilter \"gausian\"", 13, &["unknown pixel filter", "did you mean \"gaussian\"?"]);
    refuse_option("Accelerator \"bhv\"", 13, &["unknown accelerator", "did you mean \"bvh\"?"]);
    refuse_option("ColorSpace \"srbg\"", 12, &["srgb", "rec2020"]);
    refuse_option("Integrator \"path\" \"string lightsampler\" \"bhv\"", 19, &["did you mean \"bvh\"?"]);
    refuse_world(
        "Material \"conductor\" \"spectrum eta\" \"metal-Cuu-eta\"",
        (1, 22),
        &["unknown spectrum", "did you mean \"metal-Cu-eta\"?"],
    );
}

/// A name with nothing like it comes with the list of those that are known.
#[test]
fn unlike_names_are_answered_by_the_list() {
    refuse_option(
        "Camera \"telescope\"",
        8,
        &["known are: fisheye, orthographic, perspective, realistic, spherical"],
    );
    refuse_world("LightSource \"chandelier\"", (1, 13), &["known are: ", "goniometric", "point", "spot"]);
}

/// Words that are no directives, and directives in the wrong place.
#[test]
fn directives() {
    refuse_world("Shapee \"sphere\"", (1, 1), &["unknown directive `Shapee`", "did you mean `Shape`?"]);
    refuse_world("Camera \"perspective\"", (1, 1), &["`Camera` must stand before `WorldBegin`"]);
    refuse_world("WorldBegin", (1, 1), &["there is a `WorldBegin` before this one"]);
    refuse_world("WorldEnd", (1, 1), &["pbrt-v4 has no directive `WorldEnd`", "remove `WorldEnd`"]);
    refuse_option("Shape \"sphere\"", 1, &["`Shape` must stand after `WorldBegin`"]);
    refuse_world("Translate 1 2", (1, 1), &["`Translate` needs 3 numbers"]);
    refuse_world("Scale 1 0 1", (1, 1), &["the transform of this `Scale` has no inverse"]);
    refuse_world("Include \"scene.pbrt\"", (1, 9), &["the file includes itself", "scene.pbrt → scene.pbrt"]);
}

/// Blocks that are not closed, or not open.
#[test]
fn blocks() {
    refuse_world("AttributeEnd", (1, 1), &["`AttributeEnd` without a matching `AttributeBegin`"]);
    refuse_world("\nAttributeBegin", (2, 1), &["this `AttributeBegin` has no `AttributeEnd`"]);
    refuse_world("ObjectBegin \"a\"\nShape \"sphere\"", (1, 1), &["this `ObjectBegin` has no `ObjectEnd`"]);
    refuse_world(
        "AttributeBegin\nObjectBegin \"a\"\nAttributeEnd\nObjectEnd",
        (3, 1),
        &["`AttributeEnd` inside of an open `ObjectBegin`"],
    );
}

/// References to what there is not, or not yet.
#[test]
fn references() {
    refuse_world(
        "MakeNamedMaterial \"red\" \"string type\" \"diffuse\"\nNamedMaterial \"rde\"\nShape \"sphere\"",
        (2, 15),
        &["unknown material \"rde\"", "did you mean \"red\"?"],
    );
    refuse_world(
        "ObjectBegin \"tree\"\nShape \"sphere\"\nObjectEnd\nObjectInstance \"tre\"",
        (4, 16),
        &["unknown object \"tre\"", "did you mean \"tree\"?"],
    );
    refuse_world(
        "ObjectBegin \"a\"\nShape \"sphere\"\nObjectInstance \"a\"\nObjectEnd\nObjectInstance \"a\"",
        (3, 16),
        &["`ObjectInstance` inside of an object definition"],
    );
    refuse_world(
        "Texture \"wood\" \"spectrum\" \"constant\"\nMaterial \"diffuse\" \"texture reflectance\" \"wod\"",
        (2, 20),
        &["no spectrum texture named \"wod\"", "did you mean \"wood\"?"],
    );
    refuse_world(
        "Texture \"wood\" \"float\" \"constant\"\nMaterial \"diffuse\" \"texture reflectance\" \"wood\"",
        (2, 20),
        &["\"wood\" is a float texture; here a spectrum texture is needed"],
    );
    refuse_world(
        "MakeNamedMaterial \"a\" \"string type\" \"mix\" \"string materials\" [ \"a\" \"a\" ] \"float amount\" 0.5",
        (1, 19),
        &["the mixture contains itself"],
    );
}

/// Wrong types and counts of values.
#[test]
fn types_and_counts() {
    refuse_world("Shape \"sphere\" \"integer radius\" 1", (1, 16), &["must be of type float, not integer"]);
    refuse_world("Shape \"sphere\" \"bool radius\" true", (1, 16), &["must be of type float, not bool"]);
    refuse_world("Shape \"sphere\" \"float radius\" [ 1 2 ]", (1, 16), &["takes one value, not 2"]);
    refuse_world("Shape \"sphere\" \"float radius\" \"big\"", (1, 31), &["`\"big\"` should be a number"]);
    refuse_world("Shape \"sphere\" \"float radius\" [ ]", (1, 16), &["no value"]);
    refuse_world("Shape \"sphere\" \"float radius\"", (1, 16), &["this parameter has no value"]);
    refuse_world("Shape \"sphere\" \"float radius\" -1", (1, 16), &["must be positive"]);
    refuse_world("Shape \"sphere\" \"flot radius\" 1", (1, 16), &["no type `flot`", "did you mean `float`?"]);
    refuse_world("Shape \"sphere\" \"radius\" 1", (1, 16), &["a type and the name of a parameter"]);
    refuse_world(
        "Shape \"sphere\" \"float radius\" 1 2",
        (1, 33),
        &["several values of a parameter need brackets"],
    );
    refuse_world("Material \"diffuse\" \"rgb reflectance\" [ 1 2 ]", (1, 20), &["no multiple of 3"]);
    refuse_world("Material \"diffuse\" \"rgb reflectance\" [ -1 0 0 ]", (1, 20), &["negative"]);
    refuse_world("Shape \"sphere\" \"float radius\" [ 1", (1, 31), &["is not closed"]);
    refuse_world("Shape \"sphere", (1, 7), &["no closing quote"]);
    refuse_option("Sampler \"sobol\" \"float pixelsamples\" 4", 17, &["must be of type integer, not float"]);
    refuse_option("Sampler \"sobol\" \"integer pixelsamples\" 0", 17, &["at least 1"]);
    refuse_option("Camera \"perspective\" \"float fov\" 180", 22, &["between 0 and 180"]);
}

/// Films of no or too many pixels.
#[test]
fn film_sizes() {
    let film = |x: &str, y: &str| {
        format!("Film \"rgb\" \"integer xresolution\" [ {x} ] \"integer yresolution\" [ {y} ]")
    };
    refuse_option(&film("0", "6"), 12, &["a film of 0 x 6 pixels", "both resolutions must be positive"]);
    refuse_option(&film("-8", "6"), 12, &["a film of -8 x 6 pixels"]);
    refuse_option(&film("8", "-6"), 40, &["a film of 8 x -6 pixels"]);
    refuse_option(&film("2000000000", "2000000000"), 49, &["at most 2^30 pixels"]);
    let crop = |values: &str| format!("Film \"rgb\" \"float cropwindow\" [ {values} ]");
    refuse_option(&crop("0.5 0.5 0 1"), 12, &["hold at least one pixel"]);
    refuse_option(&crop("0 1 0"), 12, &["x0 x1 y0 y1"]);
}

/// Vertices and indices written into the scene file.
#[test]
fn meshes() {
    let mesh = |indices: &str, p: &str| {
        format!("Shape \"trianglemesh\" \"integer indices\" [ {indices} ]\n\"point3 P\" [ {p} ]")
    };
    refuse_world(&mesh("0 1 2", "0 0 0 1 nan 0 0 1 0"), (2, 22), &["`nan` should be a number"]);
    refuse_world(&mesh("0 1 2", "0 0 0 1 inf 0 0 1 0"), (2, 22), &["`inf` should be a number"]);
    refuse_world(&mesh("0 1 2", "0 0 0 1 1e40 0 0 1 0"), (2, 22), &["does not fit single precision"]);
    refuse_world(&mesh("0 1 7", "0 0 0 1 0 0 0 1 0"), (1, 22), &["vertex 7, but there are 3 vertices"]);
    refuse_world(&mesh("0 1 -1", "0 0 0 1 0 0 0 1 0"), (1, 22), &["the negative number -1"]);
    refuse_world(&mesh("0 1", "0 0 0 1 0 0 0 1 0"), (1, 22), &["not a multiple of 3"]);
    refuse_world(&mesh("0 1 2.5", "0 0 0 1 0 0 0 1 0"), (1, 46), &["`2.5` should be an integer"]);
    refuse_world(&mesh("0 1 99999999999", "0 0 0 1 0 0 0 1 0"), (1, 46), &["does not fit"]);
    refuse_world("Shape \"trianglemesh\"", (1, 7), &["needs vertex positions \"P\""]);
    refuse_world("Shape \"plymesh\"", (1, 7), &["needs a \"filename\""]);
}

/// One slip gives one message: what is missing because of it is not complained of.
#[test]
fn no_consequential_errors() {
    for world in [
        "Shape \"trianglemesh\" \"point3 P\" [ 0 0 0 1 nan 0 0 1 0 ] \"normal N\" [ 0 0 1 0 0 1 0 0 1 ]",
        "Shape \"trianglemesh\" \"float P\" [ 0 0 0 1 0 0 0 1 0 ] \"point2 uv\" [ 0 0 1 0 0 1 ]",
        "LightSource \"pont\"",
        "Material \"conductor\" \"spectrum eta\" \"none.spd\"\nShape \"sphere\"",
        "Texture \"t\" \"spectrum\" \"imagemap\" \"string filename\" \"none.png\"",
        "LightSource \"infinite\" \"string filename\" \"none.exr\"",
        "Camera \"perspective\"",
    ] {
        // Without the lamp, so that its absence would be complained of.
        let text = unlit_scene("", world);
        let folder = Folder::with_scene(&text);
        let run = folder.run("render scene.pbrt -o out.exr").expect(2).says("\n1 error\n");
        assert!(!run.stderr.contains("warning"), "{}", run.stderr);
    }
}

/// All problems are reported together, in the order of the file, whoever finds them.
#[test]
fn several_problems() {
    let world = "Material \"difuse\"\nShape \"shpere\"\nLightSource \"pont\"\n\
        Shape \"plymesh\" \"string filename\" \"none.ply\"\nTranslate 1 2";
    let folder = Folder::with_scene(&scene("Integrator \"pth\"", world));
    let run = folder.run("render scene.pbrt -o out.exr").expect(2).says("\n6 errors\n");
    let lines: Vec<&str> = run.stderr.lines().filter(|line| line.contains(": error: ")).collect();
    let places = ["4:12", "7:10", "8:7", "9:13", "10:17", "11:1"].map(|p| format!("scene.pbrt:{p}: error: "));
    assert_eq!(lines.len(), places.len(), "{}", run.stderr);
    assert!(lines.iter().zip(&places).all(|(line, place)| line.starts_with(place)), "{}", run.stderr);
}

/// A file without a world is no scene, as in pbrt; that goes for empty ones too.
#[test]
fn files_without_a_world() {
    refuse("", &["scene.pbrt:1:1: error: the file ends before `WorldBegin`"]);
    refuse("# nothing\n", &["the file ends before `WorldBegin`"]);
    refuse("Camera \"perspective\"\n", &["scene.pbrt:2:1: error: the file ends before `WorldBegin`"]);
}

/// Bytes that are no text.
#[test]
fn files_that_are_no_text() {
    let folder = Folder::new();
    folder.write("latin1.pbrt", b"WorldBegin\nShape \"sph\xe9re\"\n");
    folder
        .run("render latin1.pbrt -o out.exr")
        .expect(2)
        .says("latin1.pbrt:2:11: error: this byte is not part of UTF-8 text");
    folder.write("wide.pbrt", b"\xff\xfeW\0o\0r\0l\0d\0");
    folder.run("render wide.pbrt -o out.exr").expect(2).says("UTF-16");
    let noise: Vec<u8> = (0..5000_u32).map(|i| (i.wrapping_mul(2_654_435_761) >> 24) as u8).collect();
    folder.write("noise.pbrt", &noise);
    let run = folder.run("render noise.pbrt -o out.exr").expect(2);
    assert!(run.stderr.lines().count() < 300, "{}", run.stderr.lines().count());
    folder.write("cut.pbrt.gz", [0x1f, 0x8b, 8, 0, 0, 0, 0, 0, 0, 3, 1, 2, 3]);
    folder.run("render cut.pbrt.gz -o out.exr").expect(2).says("cannot decompress `cut.pbrt.gz`");
    assert_eq!(folder.files(), ["cut.pbrt.gz", "latin1.pbrt", "noise.pbrt", "wide.pbrt"]);
}

/// Files that are not there or no files.
#[test]
fn missing_scenes() {
    let folder = Folder::new();
    folder.run("render none.pbrt").expect(2).says("error: there is no file `none.pbrt`");
    folder.run("info none.pbrt").expect(2).says("error: there is no file `none.pbrt`");
    folder.run("render .").expect(2).says("error: `.` is a folder, not a file");
    assert!(folder.files().is_empty());
}

/// Places in included files name the included file; a circle of files names all of them.
#[test]
fn included_files() {
    let folder = Folder::with_scene(&scene("", "Include \"inner.pbrt\"\nShape \"shpere\""));
    folder.write("inner.pbrt", "\nMaterial \"difuse\"\n");
    folder
        .run("render scene.pbrt -o out.exr")
        .expect(2)
        .says("inner.pbrt:2:10: error: unknown material")
        .says("scene.pbrt:8:7: error: unknown shape");
    folder.write("inner.pbrt", "Include \"deeper.pbrt\"\n");
    folder.write("deeper.pbrt", "Include \"inner.pbrt\"\n");
    folder
        .run("render scene.pbrt -o out.exr")
        .expect(2)
        .says("deeper.pbrt:1:9: error: the file includes itself: inner.pbrt → deeper.pbrt → inner.pbrt");
    folder.write("inner.pbrt", "Include \"none.pbrt\"\n");
    folder
        .run("render scene.pbrt -o out.exr")
        .expect(2)
        .says("inner.pbrt:1:9: error: there is no file `none.pbrt`");
}

/// Unknown parameters are told, with the nearest known one, and ignored.
#[test]
fn unknown_parameters_are_warnings() {
    let folder = Folder::with_scene(&scene("", "Shape \"sphere\" \"float raduis\" 1"));
    folder
        .run("render scene.pbrt -o out.exr")
        .expect(0)
        .says("scene.pbrt:7:16: warning: \"sphere\" does not know the parameter \"raduis\"; it is ignored")
        .says("help: did you mean \"radius\"?");
    assert!(folder.files().contains(&"out.exr".to_owned()));
}

/// One warning for a lamp that many shapes share.
#[test]
fn warnings_are_not_repeated() {
    let world =
        "AreaLightSource \"diffuse\" \"float powr\" 1\nShape \"sphere\"\nShape \"disk\"\nShape \"cylinder\"";
    let folder = Folder::with_scene(&scene("", world));
    let run = folder.run("render scene.pbrt -o out.exr").expect(0);
    assert_eq!(run.stderr.matches("warning").count(), 1, "{}", run.stderr);
}

/// `Attribute` sets defaults for all entities of a kind, many of which do not know them.
#[test]
fn defaults_of_attributes_may_be_unused() {
    let world = "Attribute \"shape\" \"float radius\" 0.5 \"float zmin\" -0.2\n\
        Attribute \"material\" \"float roughness\" 0.1\n\
        Shape \"sphere\"\nShape \"disk\"\nMaterial \"diffuse\"\n\
        Shape \"trianglemesh\" \"point3 P\" [ 0 0 0 1 0 0 0 1 0 ]";
    let folder = Folder::with_scene(&scene("", world));
    let run = folder.run("render scene.pbrt -o out.exr --no-progress").expect(0);
    assert!(!run.stderr.contains("warning"), "{}", run.stderr);
}
