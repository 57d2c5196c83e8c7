//! Scenes that others made, which lie beside the repository.
#![expect(clippy::print_stdout, reason = "tests that are skipped say so")]

use std::path::PathBuf;

use crate::support::{Folder, is_slow, mean};

const SCENES: [&str; 8] = [
    "cornell-box",
    "veach-mis",
    "veach-bidir",
    "veach-ajar",
    "classroom",
    "bmw-m6",
    "water-caustic",
    "volumetric-caustic",
];

/// The folder of scenes, or nothing where it is not there and not demanded.
pub(crate) fn shared_scenes() -> Option<PathBuf> {
    let root = scene_folder();
    assert!(root.is_dir() || !is_demanded(), "there is no folder {}", root.display());
    root.is_dir().then_some(root)
}

fn scene_folder() -> PathBuf {
    PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("../../../shared/scenes")
}

fn is_demanded() -> bool {
    std::env::var_os("ETENDUE_REQUIRE_SHARED").is_some()
}

/// The scene files, or nothing where they are not there and not demanded.
fn scene_files() -> Vec<(&'static str, PathBuf)> {
    let (root, demanded) = (scene_folder(), is_demanded());
    let find = |name: &'static str| {
        let names = ["scene-v4.pbrt".to_owned(), format!("{name}.pbrt")];
        let found = names.iter().map(|file| root.join(name).join(file)).find(|path| path.is_file());
        assert!(found.is_some() || !demanded, "the scene {name} is missing in {}", root.display());
        found.map(|path| (name, path))
    };
    let found: Vec<_> = SCENES.into_iter().filter_map(find).collect();
    if found.len() < SCENES.len() {
        println!("skipped {} scenes, which are not in {}", SCENES.len() - found.len(), root.display());
    }
    found
}

/// All load without an error, have lights and shapes, and are told apart by what they hold.
#[test]
fn scenes_load() {
    let folder = Folder::new();
    for (name, path) in scene_files() {
        let json = folder.run_with(&["info", &path.display().to_string(), "--json"]).expect(0).json();
        assert!(json["geometry"]["shapes"].as_u64().is_some_and(|n| n > 0), "{name}");
        assert!(json["lights"].as_array().is_some_and(|lights| !lights.is_empty()), "{name}");
        let warnings = json["warnings"].to_string();
        let has_fog = warnings.contains("participating media");
        assert_eq!(has_fog, name == "volumetric-caustic", "{name}: {warnings}");
        assert!(!warnings.contains("does not know the parameter"), "{name}: {warnings}");
    }
}

/// All render, and something is to be seen.
#[test]
fn scenes_render() {
    if !is_slow() {
        return;
    }
    let folder = Folder::new();
    for (name, path) in scene_files() {
        let path = path.display().to_string();
        let output = format!("{name}.exr");
        let arguments = ["render", &path, "--resolution", "32x18", "--spp", "1", "-q", "-o", &output];
        folder.run_with(&arguments).expect(0);
        let image = folder.image(&output);
        assert_eq!((image.width, image.height), (32, 18), "{name}");
        assert!(image.channels.iter().flat_map(|c| &c.values).all(|v| v.is_finite()), "{name}");
        assert!(mean(&image) > 0.0, "{name}");
    }
}

/// A helmet in glTF, with six materials and no camera or light of its own: nothing is left out, and a stage is set.
#[test]
fn the_helmet_loads() {
    let path = scene_folder().join("gltf-flight-helmet/FlightHelmet.gltf");
    assert!(path.is_file() || !is_demanded(), "there is no file {}", path.display());
    if !path.is_file() {
        println!("skipped the helmet, which is not at {}", path.display());
        return;
    }
    let json = Folder::new().run_with(&["info", &path.display().to_string(), "--json"]).expect(0).json();
    assert_eq!(json["warnings"].to_string(), "[]");
    let n_triangles = json["geometry"]["triangles"].as_u64().expect("a number");
    assert!((94_722..94_800).contains(&n_triangles), "{n_triangles}");
    assert!(json["materials"].as_u64().is_some_and(|n| n >= 7), "{}", json["materials"]);
    assert!(json["lights"].as_array().is_some_and(|lights| !lights.is_empty()));
}
