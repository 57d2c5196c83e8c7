//! `scene`: generated scenes.

use crate::support::Folder;

/// Demands that a generated scene loads, and that there is nothing to say about it; returns what `info` tells.
#[track_caller]
fn loads(folder: &Folder, file: &str) -> serde_json::Value {
    let run = folder.run(&format!("info {file} --json")).expect(0);
    assert_eq!(run.stderr, "", "{file}");
    let json = run.json();
    assert!(json["lights"].as_array().is_some_and(|lights| !lights.is_empty()), "{file}: {json}");
    json
}

/// Scenes among the files of a folder, but for what they include.
fn scenes(folder: &Folder, inside: &str) -> Vec<String> {
    let entries = std::fs::read_dir(folder.path(inside)).expect("the folder was made");
    let names = entries.map(|entry| entry.expect("an entry").file_name().to_string_lossy().into_owned());
    let is_scene = |name: &String| name.ends_with(".pbrt") && !name.ends_with("-points.pbrt");
    names.filter(is_scene).map(|name| format!("{inside}/{name}")).collect()
}

/// A name gives its files, in a folder that is made if need be; it loads, it renders, and it comes out the same again, also into a
/// folder that is there.
#[test]
fn a_scene_is_written() {
    let folder = Folder::new();
    let run = folder.run("scene ring -o deep/folder").expect(0).says("ring.pbrt");
    assert_eq!(run.stdout, "");
    loads(&folder, "deep/folder/ring.pbrt");
    let first = folder.read("deep/folder/ring.pbrt");
    folder.run("render deep/folder/ring.pbrt -q --resolution 16x16 --spp 1 -o ring.exr").expect(0);
    folder.write("deep/folder/mine.txt", "stays");
    folder.run("scene ring -o deep/folder").expect(0);
    assert_eq!(folder.read("deep/folder/ring.pbrt"), first);
    assert_eq!(folder.read("deep/folder/mine.txt"), b"stays");
}

/// Parameters change the scene: smaller water has fewer triangles, bodies of points as many points as asked for.
#[test]
fn parameters_change_a_scene() {
    let folder = Folder::new();
    folder.run("scene water-box -o . --param cells=10").expect(0);
    let few = loads(&folder, "water-box.pbrt")["geometry"]["triangles"].as_u64();
    folder.run("scene water-box -o . --param cells=20").expect(0);
    let more = loads(&folder, "water-box.pbrt")["geometry"]["triangles"].as_u64();
    // Two for each cell, and the same room.
    assert_eq!(more.zip(few).map(|(more, few)| more - few), Some(2 * (400 - 100)));
    folder.run("scene bunnies -o . --param points=600").expect(0);
    assert_eq!(loads(&folder, "bunnies.pbrt")["geometry"]["points"], 1200);
}

/// What cannot be made is refused with what could be, before anything is written.
#[test]
fn refused_scenes() {
    for (arguments, text) in [
        ("scene rings -o out", "did you mean \"ring\"?"),
        ("scene xyzzy -o out", "xyzzy"),
        ("scene ring -o out --param distanse=3", "did you mean distance?"),
        ("scene ring -o out --param distance=far", "distance"),
        ("scene ring -o out --param distance=1e9", "distance"),
        ("scene ring -o out --param distance=NaN", "distance"),
        ("scene ring -o out --param distance", "distance"),
        ("scene water-box -o out --param cells=2.5", "cells"),
        ("scene -o out", "<NAME>"),
        ("scene ring --all -o out", "--all"),
    ] {
        let folder = Folder::new();
        folder.run(arguments).expect(2).says(text);
        assert!(folder.files().is_empty(), "{arguments} writes {:?}", folder.files());
    }
    let folder = Folder::new();
    folder.write("file", "");
    folder.run("scene ring -o file").expect(1).says("cannot make the folder file");
}

/// Every scene with its defaults is written and loads: 140 MB, half a minute.
#[test]
fn all_scenes_load() {
    if std::env::var_os("ETENDUE_SLOW").is_none_or(|value| value != "1") {
        return;
    }
    let folder = Folder::new();
    folder.run("scene --all -o all").expect(0);
    let scenes = scenes(&folder, "all");
    assert!(scenes.len() >= 35, "{scenes:?}");
    scenes.iter().for_each(|scene| drop(loads(&folder, scene)));
}
