//! Damaged scenes: whatever the bytes, reading ends, without panic, and places lie inside of the text.

use std::path::Path;

use super::super::{read_pbrt_bytes, read_pbrt_str, write_pbrt};
use super::listed;
use super::round_trip::shared_scenes;
use crate::test_support::Random;

const SCENE: &str = r#"Option "seed" 3 ColorSpace "srgb" LookAt 1 2 3 0 0 0 0 1 0 Camera "perspective" "float fov" [ 40 ]
Film "rgb" "string filename" "a.exr" # comment
WorldBegin Attribute "shape" "rgb c" [1 2 3] AttributeBegin Translate 1 2 3 Rotate 30 0 0 1 Scale 1 2 3
ActiveTransform EndTime ConcatTransform [ 1 0 0 0 0 1 0 0 0 0 1 0 0 0 0 1 ] ActiveTransform All
CoordinateSystem "a" CoordSysTransform "a" MakeNamedMedium "m" "string type" "cloud" MediumInterface "m" ""
Texture "t" "spectrum" "constant" "spectrum value" [400 1 500 2] Material "diffuse" "texture reflectance" "t"
MakeNamedMaterial "n" "string type" [ "glass" ] "bool b" true NamedMaterial "n" AreaLightSource "diffuse"
Shape "trianglemesh" "point3 P" [0 0 0 1.5 0 0 0 1e-3 -.5] "integer indices" [ 0 1 2 ] AttributeEnd
ObjectBegin "o" ReverseOrientation Shape "sphere" "float radius" .5 ObjectEnd ObjectInstance "o"
LightSource "infinite" "blackbody L" [ 6500 ] "string s" "a\\b\"c" Include "nothing" TransformBegin TransformEnd
"#;

/// Changes a few places: bytes, pieces that are cut out, copied, or exchanged for words of the grammar.
fn damage(bytes: &mut Vec<u8>, random: &mut Random) {
    const WORDS: [&str; 16] = [
        "[",
        "]",
        "\"",
        "#",
        "\\",
        "\n",
        " ",
        "Shape",
        "WorldBegin",
        "AttributeEnd",
        "ObjectEnd",
        "\"float x\"",
        "1e99",
        "\u{fc}",
        "\u{feff}",
        "ObjectBegin",
    ];
    for _ in 0..=random.below(4) {
        let at = random.below(bytes.len());
        let length = random.below(40).min(bytes.len() - at);
        match random.below(5) {
            0 if at < bytes.len() => bytes[at] = random.next() as u8,
            1 => drop(bytes.drain(at..at + length)),
            2 => {
                let copy = bytes[at..at + length].to_vec();
                let to = random.below(bytes.len());
                bytes.splice(to..to, copy);
            }
            3 => drop(bytes.splice(at..at, WORDS[random.below(WORDS.len())].bytes())),
            _ => bytes.truncate(bytes.len() - random.below(bytes.len() / 4)),
        }
    }
}

fn check_damaged(scene: &[u8], n: usize, seed: u64) {
    let mut random = Random(seed);
    for _ in 0..n {
        let mut bytes = scene.to_vec();
        damage(&mut bytes, &mut random);
        let (document, diagnostics) = read_pbrt_bytes("fuzz", bytes, Path::new("/nonexistent"));
        for span in diagnostics.list().iter().filter_map(|problem| problem.span) {
            let length = document.sources.file(span.file).text.len();
            assert!(span.start <= span.end);
            assert!((span.start as usize) <= length, "{span:?} in {length} bytes");
            assert!(document.sources.locate(span).line >= 1);
        }
        // Whatever was read can be printed and read again; only names that were defined twice still are.
        let (again, diagnostics) = read_pbrt_str("again", &write_pbrt(&document), Path::new(""));
        let problems = listed(&again, &diagnostics);
        assert!(
            problems.iter().all(|problem| problem.ends_with("is defined twice")),
            "{problems:#?}\n{}",
            write_pbrt(&document)
        );
    }
}

/// Thousands of damaged scenes are read without panic.
#[test]
fn damaged_scenes_do_not_panic() {
    check_damaged(SCENE.as_bytes(), 5_000, 1);
    for (i, path) in shared_scenes().iter().enumerate() {
        let bytes = std::fs::read(path).expect("the scene can be read");
        check_damaged(&bytes[..bytes.len().min(20_000)], 100, 2 + i as u64);
    }
}

/// Random bytes and random words are read without panic.
#[test]
fn noise_does_not_panic() {
    let mut random = Random(3);
    for _ in 0..500 {
        let bytes: Vec<u8> = (0..random.below(300)).map(|_| random.next() as u8).collect();
        drop(read_pbrt_bytes("fuzz", bytes, Path::new("")));
        let words: Vec<&str> = SCENE.split_ascii_whitespace().collect();
        let text: Vec<&str> = (0..random.below(300)).map(|_| words[random.below(words.len())]).collect();
        drop(read_pbrt_bytes("fuzz", text.join(" ").into_bytes(), Path::new("/nonexistent")));
    }
}
