//! `info` and `list`.

use crate::support::{Folder, ROOM, scene};

/// What can be listed.
const KINDS: [&str; 14] = [
    "integrators",
    "materials",
    "textures",
    "lights",
    "shapes",
    "media",
    "cameras",
    "films",
    "samplers",
    "filters",
    "accelerators",
    "tonemappers",
    "spectra",
    "scenes",
];

/// Every list is there, for people and as JSON, with the same names.
#[test]
fn lists() {
    let folder = Folder::new();
    for kind in KINDS {
        let text = folder.run(&format!("list {kind}")).expect(0);
        assert_eq!(text.stderr, "", "{kind}");
        assert!(!text.stdout.trim().is_empty(), "{kind}");
        let json = folder.run(&format!("list {kind} --json")).expect(0).json();
        let items = json["items"].as_array().expect("a list");
        assert_eq!(items.is_empty(), kind == "media", "{kind}");
        for item in items {
            let name = item["name"].as_str().expect("a name");
            assert!(text.stdout.lines().any(|line| line.starts_with(name)), "{name}");
            for parameter in item["parameters"].as_array().expect("parameters") {
                assert!(parameter["doc"].as_str().is_some_and(|doc| !doc.is_empty()), "{parameter}");
            }
        }
    }
    assert!(folder.run("list media").expect(0).stdout.contains("none yet"));
    folder.run("list furniture").expect(2).says("furniture").says("materials");
}

/// Known names are in their lists, with parameters.
#[test]
fn lists_hold_what_scenes_name() {
    let folder = Folder::new();
    for (kind, name, parameter) in [
        ("integrators", "path", "maxdepth"),
        ("materials", "conductor", "roughness"),
        ("textures", "imagemap", "filename"),
        ("lights", "spot", "coneangle"),
        ("shapes", "sphere", "radius"),
        ("cameras", "perspective", "fov"),
        ("films", "rgb", "xresolution"),
        ("samplers", "stratified", "xsamples"),
        ("filters", "gaussian", "sigma"),
        ("accelerators", "kdtree", "emptybonus"),
    ] {
        let json = folder.run(&format!("list {kind} --json")).expect(0).json();
        let items = json["items"].as_array().expect("a list");
        let item = items.iter().find(|item| item["name"] == name).unwrap_or_else(|| panic!("{kind}: {name}"));
        let parameters = item["parameters"].as_array().expect("parameters");
        assert!(parameters.iter().any(|p| p["name"] == parameter), "{kind}: {name}: {parameter}");
    }
}

/// What a scene holds.
#[test]
fn info() {
    let folder = Folder::with_scene(ROOM);
    let run = folder.run("info scene.pbrt --json").expect(0);
    assert_eq!(run.stderr, "");
    let json = run.json();
    assert_eq!(json["geometry"]["quadrics"], 3);
    assert_eq!(json["geometry"]["patches"], 1);
    assert_eq!(json["film"]["resolution"], serde_json::json!([40, 24]));
    assert_eq!(json["integrator"], "path");
    assert_eq!(json["sampler"]["samples_per_pixel"], 4);
    assert_eq!(json["lights"][0]["kind"], "area");
    assert!(json["lights"][0]["flux_lm"].as_f64().is_some_and(|flux| flux > 0.0));
    assert_eq!(json["bounds"]["min"][0], -3.0);
    assert_eq!(json["warnings"], serde_json::json!([]));
    let text = folder.run("info scene.pbrt").expect(0).stdout;
    for line in ["integrator: \"path\"", "geometry.patches: 1", "film.resolution: [40,24]"] {
        assert!(text.lines().any(|l| l == line), "{line} in\n{text}");
    }
    assert_eq!(folder.files(), ["scene.pbrt"]);
}

/// Warnings come on standard error for people, and in the object for programs.
#[test]
fn info_with_warnings() {
    let folder = Folder::with_scene(&scene("", "Shape \"sphere\" \"float raduis\" 1"));
    let run = folder.run("info scene.pbrt --json").expect(0);
    assert_eq!(run.stderr, "");
    let warnings = run.json()["warnings"].clone();
    assert_eq!(warnings[0]["place"], "scene.pbrt:7:16");
    let run = folder.run("info scene.pbrt").expect(0).says("scene.pbrt:7:16: warning: ");
    assert!(!run.stdout.contains("raduis"), "{}", run.stdout);
    folder.write("scene.pbrt", scene("", "Shape \"shpere\""));
    let run = folder.run("info scene.pbrt --json").expect(2).says("unknown shape");
    assert_eq!(run.stdout, "");
}

/// An empty world has no bounds, which JSON cannot state as infinities.
#[test]
fn info_of_nothing() {
    let folder = Folder::with_scene("WorldBegin\n");
    let json = folder.run("info scene.pbrt --json").expect(0).json();
    assert_eq!(json["geometry"]["shapes"], 0);
    assert_eq!(json["bounds"]["size_m"], serde_json::json!([0.0, 0.0, 0.0]));
    assert_eq!(json["lights"], serde_json::json!([]));
}
