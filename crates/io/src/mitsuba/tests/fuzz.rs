//! Damaged scenes: whatever the bytes, reading ends, without panic, and places lie inside of the text.

use std::path::Path;

use super::super::read_mitsuba_bytes;
use crate::pbrt::{read_pbrt_str, write_pbrt};
use crate::test_support::Random;

const SCENE: &str = r##"<scene version="3.0.0"><default name="n" value="4"/><integrator type="path">
<integer name="max_depth" value="$n"/></integrator><sensor type="thinlens"><float name="fov" value="45"/>
<transform name="to_world"><lookat origin="0,0,-5" target="0,0,0" up="0,1,0"/><rotate x="1" angle="3"/></transform>
<film type="hdrfilm"><integer name="width" value="64"/><integer name="height" value="48"/><rfilter type="gaussian"/></film>
<sampler type="stratified"><integer name="sample_count" value="$n"/></sampler></sensor>
<texture type="checkerboard" id="t"><rgb name="color0" value=".2"/><transform name="to_uv"><scale x="3" y="2"/></transform></texture>
<bsdf type="blendbsdf" id="b"><ref name="weight" id="t"/><bsdf type="roughconductor"><string name="material" value="Ag"/></bsdf>
<bsdf type="mask"><float name="opacity" value="0.5"/><bsdf type="principled"><float name="metallic" value="1"/></bsdf></bsdf></bsdf>
<bsdf type="mixturebsdf"><string name="weights" value=".3,.7"/><bsdf type="coating"><bsdf type="diffuse"/></bsdf><ref id="b"/></bsdf>
<shape type="sphere"><point name="center" x="1"/><ref id="b"/><emitter type="area"><spectrum name="radiance" value="400:1, 700:2"/></emitter></shape>
<shape type="shapegroup" id="g"><shape type="cube"/><shape type="cylinder"><point name="p1" value="0,1,1"/></shape></shape>
<shape type="instance"><ref id="g"/><animation name="to_world"><transform time="0"/><transform time="1"><translate x="1"/></transform></animation></shape>
<medium type="homogeneous" id="m"><rgb name="sigma_t" value="1"/><rgb name="albedo" value=".5 .4 .3"/><phase type="hg"><float name="g" value=".2"/></phase></medium>
<shape type="rectangle"><ref name="interior" id="m"/></shape><emitter type="spot"><float name="cutoff_angle" value="30"/></emitter>
<emitter type="directional"><vector name="direction" value="0 -1 0"/></emitter><emitter type="sunsky"/></scene>"##;

const WORDS: [&str; 20] = [
    "<",
    ">",
    "/>",
    "\"",
    "&amp;",
    "&a;",
    "<!--",
    "$n",
    "1e99",
    "nan",
    "-",
    "<ref id=\"b\"/>",
    "</bsdf>",
    "<bsdf type=\"mask\">",
    "value=\"\"",
    "\u{fc}",
    "#ffffff",
    "0",
    ",",
    "<scene>",
];

/// Changes a few places: bytes, pieces that are cut out, copied, or exchanged for words of the grammar.
fn damage(bytes: &mut Vec<u8>, random: &mut Random) {
    for _ in 0..=random.below(3) {
        let at = random.below(bytes.len());
        let length = random.below(60).min(bytes.len() - at);
        match random.below(6) {
            0 if at < bytes.len() => bytes[at] = random.next() as u8,
            1 => drop(bytes.drain(at..at + length)),
            2 => {
                let copy = bytes[at..at + length].to_vec();
                let to = random.below(bytes.len());
                bytes.splice(to..to, copy);
            }
            3 => drop(bytes.splice(at..at, WORDS[random.below(WORDS.len())].bytes())),
            // Values that still are XML reach deeper.
            _ => {
                let quotes: Vec<usize> = (0..bytes.len()).filter(|i| bytes[*i] == b'"').collect();
                let first = random.below(quotes.len().saturating_sub(1));
                if let (Some(a), Some(b)) = (quotes.get(first), quotes.get(first + 1)) {
                    let word = ["", "0", "-1", "1e30", "x", "$n", "1 2 3", "b", "400:1"][random.below(9)];
                    bytes.splice(a + 1..*b, word.bytes());
                }
            }
        }
    }
}

/// Thousands of damaged scenes are read without panic, and what is left of them can be printed and read again.
#[test]
fn damaged_scenes_do_not_panic() {
    let mut random = Random(1);
    for _ in 0..3000 {
        let mut bytes = SCENE.as_bytes().to_vec();
        damage(&mut bytes, &mut random);
        let (document, diagnostics) = read_mitsuba_bytes("fuzz.xml", bytes, Path::new("/nonexistent"));
        for span in diagnostics.list().iter().filter_map(|problem| problem.span) {
            let length = document.sources.file(span.file).text.len();
            assert!(span.start <= span.end && (span.start as usize) <= length, "{span:?} in {length} bytes");
            assert!(document.sources.locate(span).line >= 1);
        }
        drop(read_pbrt_str("again", &write_pbrt(&document), Path::new("")));
    }
}

/// The scene itself has no problems but the stand-in that it asks for.
#[test]
fn scene_is_good() {
    let (_, diagnostics) = read_mitsuba_bytes("fuzz.xml", SCENE.as_bytes().to_vec(), Path::new(""));
    assert!(!diagnostics.has_errors(), "{:#?}", diagnostics.list());
}
