//! Names that pbrt knows and that are still to come: a warning with the place and the stand-in, and an image.

use crate::support::{Folder, mean, scene};

/// Renders with a stand-in; the warning stands at `line:column`.
#[track_caller]
fn accept(options: &str, world: &str, place: &str, says: &[&str]) {
    let folder = Folder::with_scene(&scene(options, world));
    let mut run = folder.run("render scene.pbrt -o out.exr --no-progress").expect(0);
    run = run.says(&format!("scene.pbrt:{place}: warning: "));
    for text in says {
        run = run.says(text);
    }
    assert_eq!(run.stderr.matches("warning").count(), 1, "{}", run.stderr);
    let image = folder.image("out.exr");
    assert_eq!((image.width, image.height), (8, 6));
}

const SPHERE: &str = "Translate 0 0 3\nShape \"sphere\"";

/// Integrators, with the parameters that pbrt gives them.
#[test]
fn integrators() {
    let path = "\"path\" stands in for it";
    for entity in [
        "\"bdpt\" \"integer maxdepth\" 3 \"bool visualizestrategies\" false \"bool visualizeweights\" false",
        "\"mlt\" \"integer maxdepth\" 3 \"integer bootstrapsamples\" 10 \"integer chains\" 4 \"float sigma\" 0.1",
        "\"function\" \"string function\" \"step\"",
    ] {
        let name = entity.split('"').nth(1).expect("a name");
        accept(&format!("Integrator {entity}"), SPHERE, "4:12", &[&format!("\"{name}\""), path]);
    }
}

/// Other names of methods are no reason to warn.
#[test]
fn aliases_are_silent() {
    for entity in [
        "\"volpath\" \"integer maxdepth\" 3 \"string lightsampler\" \"power\" \"bool regularize\" true",
        "\"simplepath\" \"bool samplebsdf\" true \"bool samplelights\" true",
        "\"randomwalk\"",
        "\"ambientocclusion\" \"bool cossample\" true \"float maxdistance\" 3",
        "\"lightpath\" \"integer maxdepth\" 3",
    ] {
        let folder = Folder::with_scene(&scene(&format!("Integrator {entity}"), SPHERE));
        let run = folder.run("render scene.pbrt -o out.exr --no-progress").expect(0);
        assert!(!run.stderr.contains("warning"), "{}", run.stderr);
    }
}

/// pbrt's `sppm` is ours: nothing stands in for it, and all of its parameters are known.
#[test]
fn progressive_photon_mapping_is_no_stand_in() {
    let entity = "\"sppm\" \"float radius\" 0.1 \"integer photonsperiteration\" 100 \"integer seed\" 3";
    let folder = Folder::with_scene(&scene(&format!("Integrator {entity}"), SPHERE));
    let run = folder.run("render scene.pbrt -o out.exr --no-progress").expect(0);
    assert!(!run.stderr.contains("stands in") && !run.stderr.contains("parameter"), "{}", run.stderr);
}

/// On the command line, stand-ins take any parameters.
#[test]
fn integrator_arguments() {
    let folder = Folder::with_scene(&scene("", SPHERE));
    folder
        .run("render scene.pbrt -o out.exr --integrator mlt:chains=4,maxdepth=3")
        .expect(0)
        .says("warning: the integrator \"mlt\"")
        .says("\"path\" stands in for it");
    assert!(folder.image("out.exr").metadata["etendue.integrator"].starts_with("path"));
}

/// Materials: grey instead.
#[test]
fn materials() {
    let entity = "\"subsurface\" \"rgb mfp\" [ 1 1 1 ] \"float scale\" 2";
    accept("", &format!("Material {entity}\n{SPHERE}"), "7:10", &["grey \"diffuse\" stands in for it"]);
}

/// Textures that other programs store.
#[test]
fn textures() {
    let world = format!(
        "Texture \"t\" \"spectrum\" \"ptex\" \"string filename\" \"none.ptx\"\n\
         Material \"diffuse\" \"texture reflectance\" \"t\"\n{SPHERE}"
    );
    accept("", &world, "7:24", &["the texture \"ptex\"", "constant 0.5"]);
}

/// Sensors.
#[test]
fn options() {
    let film = "Film \"rgb\" \"integer xresolution\" 8 \"integer yresolution\" 6 \"string sensor\" \"canon_eos_5d_mkiv\"";
    accept(film, SPHERE, "4:60", &["\"cie1931\" stands in for it"]);
}

/// Media are empty space, through which lights shine.
#[test]
fn media() {
    let world = "MakeNamedMedium \"fog\" \"string type\" \"homogeneous\" \"rgb sigma_s\" [ 9 9 9 ]\n\
        AttributeBegin\nMediumInterface \"fog\" \"\"\nMaterial \"interface\"\nShape \"sphere\" \"float radius\" 2\n\
        AttributeEnd\nTranslate 0 0 3\nShape \"sphere\"";
    accept("", world, "7:17", &["participating media", "\"fog\"", "empty space"]);
    let folder = Folder::with_scene(&scene("", world));
    assert!(mean(&folder.render("out", "--spp 4")) > 0.0);
}
