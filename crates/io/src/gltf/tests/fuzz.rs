//! Damaged files: whatever the bytes, reading ends without panic, and places lie inside of the text.

use etendue_scene::Scene;

use super::*;
use crate::assets::load_assets;
use crate::test_support::Random;

/// A file that uses most of what there is, as text and binary chunk.
fn original() -> (String, Vec<u8>) {
    let mut data = Data::default();
    let p = data.floats("VEC3", &TRIANGLE);
    let n = data.floats("VEC3", &[0.0, 0.0, 1.0].repeat(3));
    let t = data.floats("VEC2", &[0.0, 0.0, 1.0, 0.0, 0.0, 1.0]);
    let i = data.indices(&[0, 1, 2, 2, 1, 0]);
    let j = data.floats("VEC4", &[0.0; 12]);
    let weights = data.floats("VEC4", &[1.0, 0.0, 0.0, 0.0].repeat(3));
    let picture = data.view(b"P6 2 1 255\n\xff\x80\x40\x20\xc0\xff", "");
    let sparse = data.view(&[1, 2], "");
    let s = data.accessor(&format!(
        r#""bufferView": 0, "componentType": 5126, "count": 3, "type": "VEC3", "sparse": {{"count": 2,
        "indices": {{"bufferView": {sparse}, "componentType": 5121}}, "values": {{"bufferView": 1}}}}"#
    ));
    let json = format!(
        r#"{{"asset": {{"version": "2.0"}}, "buffers": [{{"byteLength": {}}}], "bufferViews": [{}],
        "accessors": [{}], "scene": 0, "scenes": [{{"nodes": [0, 2, 3, 4]}}],
        "nodes": [{{"mesh": 0, "children": [1]}}, {{"mesh": 0, "translation": [1, 2, 3], "scale": [2, 1, 1]}},
        {{"mesh": 1, "skin": 0, "rotation": [0, 0, 0.6, 0.8]}}, {{"camera": 0}},
        {{"extensions": {{"KHR_lights_punctual": {{"light": 0}}}}, "mesh": 2}}],
        "skins": [{{"joints": [0, 3]}}],
        "cameras": [{{"type": "perspective", "perspective": {{"yfov": 0.8, "aspectRatio": 1.5, "znear": 0.1}}}}],
        "extensionsUsed": ["KHR_lights_punctual", "KHR_texture_transform"], "extensions": {{"KHR_lights_punctual":
        {{"lights": [{{"type": "spot", "intensity": 5, "spot": {{"outerConeAngle": 0.5}}}}]}}}},
        "materials": [{{"alphaMode": "BLEND", "pbrMetallicRoughness": {{"baseColorTexture": {{"index": 0,
        "extensions": {{"KHR_texture_transform": {{"rotation": 1, "offset": [1, 2]}}}}}}}},
        "normalTexture": {{"index": 0, "scale": 2}}, "emissiveFactor": [1, 1, 1],
        "extensions": {{"KHR_materials_clearcoat": {{"clearcoatFactor": 1, "clearcoatTexture": {{"index": 0}}}},
        "KHR_materials_transmission": {{"transmissionFactor": 1}}, "KHR_materials_volume": {{"thicknessFactor": 1}}}}}}],
        "textures": [{{"source": 0, "sampler": 0}}], "images": [{{"bufferView": {picture}}}],
        "samplers": [{{"wrapS": 33071, "wrapT": 33648}}], "meshes": [
        {{"primitives": [{{"attributes": {{"POSITION": {s}, "NORMAL": {n}, "TEXCOORD_0": {t}}}, "indices": {i}}}]}},
        {{"primitives": [{{"attributes": {{"POSITION": {p}, "JOINTS_0": {j}, "WEIGHTS_0": {weights}}}, "mode": 5}}]}},
        {{"weights": [0.5], "primitives": [{{"attributes": {{"POSITION": {p}, "TEXCOORD_0": {t}}}, "material": 0,
        "targets": [{{"POSITION": {n}}}]}}]}}]}}"#,
        data.bytes.len(),
        data.views.join(", "),
        data.accessors.join(", ")
    );
    (json, data.bytes)
}

/// Exchanges numbers and words of the text, or bytes.
fn damage(text: &mut Vec<u8>, random: &mut Random) {
    const WORDS: [&str; 14] = [
        "0",
        "1",
        "2",
        "-1",
        "7",
        "1e9",
        "4294967295",
        "9007199254740991",
        "0.5",
        "null",
        "[]",
        "{}",
        "\"a\"",
        "[0]",
    ];
    for _ in 0..=random.below(3) {
        let at = random.below(text.len());
        if random.below(4) > 0 {
            // The number that is next.
            let Some(start) = (at..text.len()).find(|i| text[*i].is_ascii_digit()) else { continue };
            let end = (start..text.len()).find(|i| !text[*i].is_ascii_digit()).unwrap_or(text.len());
            text.splice(start..end, WORDS[random.below(WORDS.len())].bytes());
            continue;
        }
        let length = random.below(30).min(text.len() - at);
        match random.below(3) {
            0 if at < text.len() => text[at] = random.next() as u8,
            1 => drop(text.drain(at..at + length)),
            _ => {
                let copy = text[at..at + length].to_vec();
                let to = random.below(text.len());
                text.splice(to..to, copy);
            }
        }
    }
}

fn check_damaged(n: usize, seed: u64) {
    let (text, binary) = original();
    let mut random = Random(seed);
    for _ in 0..n {
        let mut text = text.clone().into_bytes();
        damage(&mut text, &mut random);
        let mut bytes = glb(&String::from_utf8_lossy(&text), &binary);
        if random.below(4) == 0 {
            let at = random.below(bytes.len());
            bytes[at] = random.next() as u8;
        }
        let (document, mut diagnostics) = read(bytes);
        let (assets, problems) = load_assets(&document);
        diagnostics.append(problems);
        let (_, problems) = Scene::build(&document, assets);
        diagnostics.append(problems);
        for span in diagnostics.list().iter().filter_map(|problem| problem.span) {
            let length = document.sources.file(span.file).text.len();
            assert!(span.start as usize <= length + 1, "{span:?} in {length} bytes");
            let _ = document.sources.locate(span);
        }
    }
}

/// The file itself is sound.
#[test]
fn the_original() {
    let (text, binary) = original();
    let (document, diagnostics) = read(glb(&text, &binary));
    assert!(!diagnostics.has_errors(), "{:?}", messages(&diagnostics));
    let (assets, problems) = load_assets(&document);
    assert!(problems.list().is_empty(), "{:?}", messages(&problems));
    let (scene, problems) = Scene::build(&document, assets);
    assert!(scene.is_some(), "{:?}", messages(&problems));
}

#[test]
fn damaged_files() {
    check_damaged(3000, 1);
    if std::env::var_os("ETENDUE_SLOW").is_some() {
        check_damaged(300_000, 2);
    }
}
