use std::path::Path;

use etendue_io::{load_assets, read_pbrt};
use etendue_scene::Scene;

use super::{Files, GENERATORS, Generator};

/// Parameters that make scenes small, where their size has one.
const SMALL: &[(&str, &[(&str, &str)])] = &[];

fn small(generator: &'static Generator) -> Files {
    let changes =
        SMALL.iter().find(|(name, _)| *name == generator.name).map_or(&[][..], |(_, changes)| changes);
    generator.generate(changes.iter().copied()).unwrap_or_else(|error| panic!("{error}"))
}

/// All scenes that show surfaces, in the order of the specification.
#[test]
fn every_scene_of_the_specification_has_a_generator() {
    let mut ids: Vec<&str> = GENERATORS.iter().map(|g| g.id).collect();
    ids.dedup();
    let numbers = (1..=21).chain([28, 31, 32]).chain(36..=40);
    let expected: Vec<String> = numbers.map(|n| format!("SCENE-{n}")).collect();
    assert_eq!(ids, expected);
}

/// Parameters are as they say: defaults are values, and others are refused.
#[test]
fn parameters_have_domains() {
    for generator in GENERATORS {
        for knob in generator.parameters {
            let default = [(knob.spec.name, knob.spec.default)];
            assert!(super::Settings::new(generator, default).is_ok(), "{}: {default:?}", generator.name);
            assert!(super::Settings::new(generator, [(knob.spec.name, "1e999x")]).is_err());
        }
        assert!(super::Settings::new(generator, [("no-such-parameter", "1")]).is_err());
    }
    let near = Generator::find("boks").map(|g| g.name).expect_err("a slip");
    assert!(near.0.contains("did you mean \"box\"?"), "{near}");
}

/// Each file of a scene reads and builds without complaint, and is the same each time.
#[test]
fn scenes_build_without_complaint() {
    let folder = std::env::temp_dir().join(format!("etendue-generate-{}", std::process::id()));
    for generator in GENERATORS {
        let files = small(generator);
        assert_eq!(files, small(generator), "{} changes", generator.name);
        assert_eq!(files.0[0].name, format!("{}.pbrt", generator.name));
        std::fs::create_dir_all(&folder).expect("a folder for temporary files");
        for file in &files.0 {
            std::fs::write(folder.join(&file.name), &file.bytes).expect("a temporary file");
        }
        for file in files.0.iter().filter(|file| file.name.ends_with(".pbrt")) {
            check(&folder.join(&file.name));
        }
        std::fs::remove_dir_all(&folder).expect("the temporary files are ours");
    }
}

#[track_caller]
fn check(path: &Path) {
    let (document, mut diagnostics) = read_pbrt(path);
    let (assets, problems) = load_assets(&document);
    diagnostics.append(problems);
    let (scene, problems) = Scene::build(&document, assets);
    diagnostics.append(problems);
    assert!(diagnostics.list().is_empty(), "{}: {:?}", path.display(), diagnostics.list());
    let scene = scene.expect("a scene without problems is built");
    assert!(!scene.lights.is_empty(), "{} is dark", path.display());
    let film = document.film.as_ref().expect("a film");
    let named = path.with_extension("exr");
    let named = named.file_name().and_then(|name| name.to_str()).expect("an ASCII name");
    assert!(format!("{film:?}").contains(named), "{} writes another picture", path.display());
}
