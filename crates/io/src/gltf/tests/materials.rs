//! Materials become `principled` with the parameters of its page.

use etendue_image::TexelData;
use etendue_scene::Scene;
use etendue_scene::document::TextureValue;

use super::*;
use crate::assets::load_assets;

/// A picture of 2 x 1 texels as PPM: red over green and blue.
const PICTURE: &[u8] = b"P6 2 1 255\n\xff\x80\x40\x20\xc0\xff";

/// A file with a triangle of that material and an embedded picture as textures 0 and 1, the latter with a sampler.
fn with_material(material: &str) -> Vec<u8> {
    let mut data = Data::default();
    let (p, t) = (data.floats("VEC3", &TRIANGLE), data.floats("VEC2", &[0.0; 6]));
    let view = data.view(PICTURE, "");
    data.file(&format!(
        r#""nodes": [{{"mesh": 0}}], "materials": [{{{material}}}], "images": [{{"bufferView": {view}}}],
        "textures": [{{"source": 0}}, {{"source": 0, "sampler": 0}}],
        "samplers": [{{"wrapS": 33071, "wrapT": 33648, "magFilter": 9728}}],
        "meshes": [{{"primitives": [{{"attributes": {{"POSITION": {p}, "TEXCOORD_0": {t}}}, "material": 0}}]}}]"#
    ))
}

/// Name and text of a parameter or of the texture that it names.
fn texts(entity: &Entity) -> Vec<String> {
    let text =
        |p: &etendue_scene::document::Parameter| format!("{} {}", p.name, crate::pbrt::value_text(&p.value));
    entity.parameters.iter().map(text).collect()
}

/// The parameters of a material; the document builds into a scene without complaint.
#[track_caller]
fn check(material: &str, expected: &[&str]) -> Document {
    let made = document(with_material(material));
    assert_eq!(texts(&made.materials[1].entity), expected);
    let (assets, problems) = load_assets(&made);
    assert!(problems.list().is_empty(), "{:?}", messages(&problems));
    let (scene, problems) = Scene::build(&made, assets);
    let complaints: Vec<_> =
        messages(&problems).into_iter().filter(|message| !message.contains("no lights")).collect();
    assert!(scene.is_some() && complaints.is_empty(), "{complaints:?}");
    made
}

/// Factors alone, with their defaults.
#[test]
fn factors() {
    check("", &["basecolor 1 1 1", "metallic 1", "roughness 1"]);
    check(
        r#""pbrMetallicRoughness": {"baseColorFactor": [0.5, 0.25, 0, 1], "metallicFactor": 0, "roughnessFactor": 0.3}"#,
        &["basecolor 0.5 0.25 0", "metallic 0", "roughness 0.3"],
    );
}

/// Metal is in blue, roughness in green; colours are sRGB times the factor, and samplers say what lies beyond the borders.
#[test]
fn textures() {
    let made = check(
        r#""pbrMetallicRoughness": {"baseColorFactor": [0.5, 1, 1, 1], "baseColorTexture": {"index": 0},
        "metallicFactor": 0.5, "metallicRoughnessTexture": {"index": 1}}"#,
        &[
            "basecolor \"materials/0/basecolor\"",
            "metallic \"materials/0/metallic\"",
            "roughness \"materials/0/roughness\"",
        ],
    );
    let [color, metal, rough] = &made.textures[..] else { panic!("three textures") };
    assert_eq!((color.value, metal.value), (TextureValue::Spectrum, TextureValue::Float));
    let picture = "filename \"test.glb/images/0\"";
    assert_eq!(texts(&color.entity), [picture, "encoding \"sRGB\"", "tint 0.5 1 1"]);
    let sampler = ["wrap \"clamp\"", "wrapv \"mirror\"", "filter \"point\"", "encoding \"linear\""];
    let with = |channel, scale| [&[picture][..], &sampler, &[channel, scale]].concat();
    assert_eq!(texts(&metal.entity), with("channel \"b\"", "scale 0.5"));
    assert_eq!(texts(&rough.entity), with("channel \"g\"", "scale 1"));
    let texels = &load_assets(&made).0.images["test.glb/images/0"];
    assert_eq!(texels.data(), &TexelData::U8(vec![255, 128, 64, 32, 192, 255]));
}

/// A texture that is moved, turned and scaled shows at (u, v) what the extension says, with v running up here.
#[test]
fn placed_textures() {
    let (offset, rotation, scale) = ([0.3_f32, -0.2], 0.7_f32, [2.0_f32, 0.5]);
    let info = format!(
        r#"{{"index": 0, "extensions": {{"KHR_texture_transform":
        {{"offset": {offset:?}, "rotation": {rotation}, "scale": {scale:?}}}}}}}"#
    );
    let made = document(with_material(&format!(r#""pbrMetallicRoughness": {{"baseColorTexture": {info}}}"#)));
    let number = |name| match value(&made.textures[0].entity, name) {
        Some(Value::Floats(values)) => values[0],
        other => panic!("{name}: {other:?}"),
    };
    let (sin, cos) = number("uvrotation").to_radians().sin_cos();
    for (u, v) in [(0.0, 0.0), (1.0, 0.0), (0.0, 1.0), (0.3, 0.8)] {
        // What the mapping `uv` does with the coordinates of the mesh.
        let (x, y) = (number("uscale") * u, number("vscale") * (1.0 - v));
        let st = [x * cos - y * sin + number("udelta"), x * sin + y * cos + number("vdelta")];
        // What KHR_texture_transform says, with v running down.
        let (x, y) = (scale[0] * u, scale[1] * v);
        let (sin, cos) = rotation.sin_cos();
        let expected = [x * cos + y * sin + offset[0], -x * sin + y * cos + offset[1]];
        assert!((st[0] - expected[0]).abs() < 1e-5, "{st:?} {expected:?}");
        assert!((st[1] - (1.0 - expected[1])).abs() < 1e-5, "{st:?} {expected:?}");
    }
}

/// Alpha belongs to shapes: ignored where opaque, cut to 0 and 1 by a mask, a share of rays where it blends.
#[test]
fn alpha() {
    let check = |material: &str, expected: Option<Value>| {
        let made = document(with_material(material));
        assert_eq!(value(&made.shapes[0].entity, "alpha"), expected.as_ref(), "{material}");
    };
    let base = r#""pbrMetallicRoughness": {"baseColorFactor": [1, 1, 1, 0.4]}"#;
    check(base, None);
    check(&format!(r#""alphaMode": "BLEND", {base}"#), Some(Value::Floats(vec![0.4])));
    check(&format!(r#""alphaMode": "MASK", {base}"#), Some(Value::Floats(vec![0.0])));
    check(&format!(r#""alphaMode": "MASK", "alphaCutoff": 0.4, {base}"#), None);
    let textured = r#""alphaMode": "MASK", "pbrMetallicRoughness": {"baseColorTexture": {"index": 0}}"#;
    check(textured, Some(Value::Texture("materials/0/alpha".to_owned())));
}

/// Emission is an area light of the shape, in cd/m².
#[test]
fn emission() {
    let light = |material: &str| {
        let made = document(with_material(material));
        made.shapes[0].area_light.map(|index| texts(&made.area_lights[index]))
    };
    assert_eq!(light(r#""emissiveFactor": [0, 0, 0]"#), None);
    let strong = r#""emissiveFactor": [1, 0.5, 0], "extensions": {"KHR_materials_emissive_strength":
        {"emissiveStrength": 20}}, "doubleSided": true"#;
    assert_eq!(light(strong).expect("a light"), ["L 1 0.5 0", "scale 20", "twosided true"]);
    let textured = r#""emissiveFactor": [2, 2, 2], "emissiveTexture": {"index": 0}"#;
    assert_eq!(light(textured).expect("a light"), ["filename \"test.glb/images/0\"", "scale 2"]);
    let unlit = r#""extensions": {"KHR_materials_unlit": {}}, "pbrMetallicRoughness":
        {"baseColorFactor": [0.5, 0.5, 0.5, 1]}"#;
    assert_eq!(light(unlit).expect("a light"), ["L 0.5 0.5 0.5", "scale 1"]);
}

/// Extensions of materials have parameters of their own.
#[test]
fn extensions() {
    let base = ["basecolor 1 1 1", "metallic 1", "roughness 1"];
    let check = |extensions: &str, expected: &[&str]| {
        check(&format!(r#""extensions": {{{extensions}}}"#), &[&base[..], expected].concat())
    };
    check(
        r#""KHR_materials_clearcoat": {"clearcoatFactor": 0.5, "clearcoatRoughnessFactor": 0.25,
        "clearcoatNormalTexture": {"index": 0, "scale": 0.5}}"#,
        &[
            "clearcoat 0.5",
            "clearcoatroughness 0.25",
            "clearcoatnormaltexture \"materials/0/clearcoatnormaltexture\"",
            "clearcoatnormalscale 0.5",
        ],
    );
    check(
        r#""KHR_materials_sheen": {"sheenColorFactor": [0.5, 0, 0], "sheenRoughnessFactor": 0.5}"#,
        &["sheencolor 0.5 0 0", "sheenroughness 0.5"],
    );
    check(
        r#""KHR_materials_iridescence": {"iridescenceFactor": 1, "iridescenceIor": 1.5,
        "iridescenceThicknessMaximum": 500}"#,
        &["iridescence 1", "iridescenceior 1.5", "iridescencethickness 500"],
    );
    check(
        r#""KHR_materials_iridescence": {"iridescenceFactor": 1, "iridescenceThicknessTexture": {"index": 0}}"#,
        &[
            "iridescence 1",
            "iridescenceior 1.3",
            "iridescencethickness \"materials/0/iridescencethickness mixed\"",
        ],
    );
    check(
        r#""KHR_materials_transmission": {"transmissionFactor": 1}, "KHR_materials_volume": {"thicknessFactor": 0.5,
        "attenuationColor": [0.5, 1, 1], "attenuationDistance": 2}, "KHR_materials_ior": {"ior": 1.25},
        "KHR_materials_dispersion": {"dispersion": 0.5}"#,
        &[
            "transmission 1",
            "thickness 0.5",
            "attenuationcolor 0.5 1 1",
            "attenuationdistance 2",
            "dispersion 0.5",
            "ior 1.25",
        ],
    );
    check(
        r#""KHR_materials_specular": {"specularFactor": 0.5, "specularColorTexture": {"index": 0}}"#,
        &["specular 0.5", "specularcolor \"materials/0/specularcolor\""],
    );
    check(
        r#""KHR_materials_anisotropy": {"anisotropyStrength": 0.5, "anisotropyRotation": 0}"#,
        &["anisotropy 0.5", "anisotropyrotation 0"],
    );
}

/// The older model of specular and glossiness: its specular colour is the reflectance along the normal.
#[test]
fn specular_glossiness() {
    check(
        r#""extensions": {"KHR_materials_pbrSpecularGlossiness": {"diffuseFactor": [0.5, 0.5, 0.5, 1],
        "specularFactor": [0.04, 0.08, 0.04], "glossinessFactor": 0.75}}"#,
        &["basecolor 0.5 0.5 0.5", "metallic 0", "specularcolor 1 2 1", "roughness 0.25"],
    );
}

/// Colours of vertices multiply the base colour where there is no texture; white ones change nothing.
#[test]
fn vertex_colors() {
    let with = |colors: &[f32]| {
        let mut data = Data::default();
        let (p, c) = (data.floats("VEC3", &TRIANGLE), data.floats("VEC3", colors));
        document(data.file(&format!(
            r#""nodes": [{{"mesh": 0}}], "materials": [{{"pbrMetallicRoughness": {{"baseColorFactor": [0.5, 1, 1, 1]}}}}],
            "meshes": [{{"primitives": [{{"attributes": {{"POSITION": {p}, "COLOR_0": {c}}}, "material": 0}}]}}]"#
        )))
    };
    let plain = with(&[1.0; 9]);
    assert!(mesh_of(&plain, &plain.shapes[0]).attributes.is_empty());
    let made = with(&[1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.25]);
    let attribute = &mesh_of(&made, &made.shapes[0]).attributes[0];
    assert_eq!(attribute.values, [0.5, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.25]);
    assert_eq!(texts(&made.textures[0].entity), ["name \"vertex_color\""]);
    assert_eq!(attribute.name, "vertex_color");
    assert_eq!(texts(&made.materials[1].entity)[0], "basecolor \"materials/0 with colors/basecolor\"");
    let (scene, problems) = Scene::build(&made, load_assets(&made).0);
    assert!(scene.is_some(), "{:?}", messages(&problems));
}

/// A surface without light is a source, whose colour cannot vary over vertices: that is told.
#[test]
fn vertex_colors_of_unlit_surfaces() {
    let mut data = Data::default();
    let (p, c) = (data.floats("VEC3", &TRIANGLE), data.floats("VEC3", &[0.5; 9]));
    let (_, diagnostics) = read(data.file(&format!(
        r#""nodes": [{{"mesh": 0}}], "materials": [{{"extensions": {{"KHR_materials_unlit": {{}}}}}}],
        "meshes": [{{"primitives": [{{"attributes": {{"POSITION": {p}, "COLOR_0": {c}}}, "material": 0}}]}}]"#
    )));
    assert!(messages(&diagnostics)[0].contains("COLOR_0"), "{:?}", messages(&diagnostics));
}
