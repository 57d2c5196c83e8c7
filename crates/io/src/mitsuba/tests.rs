use std::io::Write;
use std::path::Path;

use etendue_image::Texels;
use etendue_math::{Point3, Vector3, warp};
use etendue_scene::document::{Document, EmbeddedFile, Entity, Value};
use etendue_scene::{Diagnostics, LoadedMesh};

use super::environment::{equal_area_of_latitude_longitude, y_is_up};
use super::read_mitsuba_bytes;
use super::reader::FROM_RADIOMETRIC;
use super::serialized::read_serialized;

mod fuzz;

/// Problems as `line:column: message`.
fn listed(document: &Document, diagnostics: &Diagnostics) -> Vec<String> {
    let line = |problem: &etendue_scene::Diagnostic| match problem.span {
        Some(span) => {
            let at = document.sources.locate(span);
            let help = problem.help.as_ref().map_or(String::new(), |help| format!(" ({help})"));
            format!("{}:{}: {}{help}", at.line, at.column, problem.message)
        }
        None => problem.message.clone(),
    };
    diagnostics.list().iter().map(line).collect()
}

fn read_all(text: &str) -> (Document, Vec<String>) {
    let (document, diagnostics) = read_mitsuba_bytes("test.xml", text.as_bytes().to_vec(), Path::new(""));
    let problems = listed(&document, &diagnostics);
    (document, problems)
}

/// A scene of version 3 around the text, on one line.
#[track_caller]
fn read(text: &str) -> Document {
    let (document, problems) = read_all(&format!("<scene version=\"3.0.0\">{text}</scene>"));
    assert!(problems.is_empty(), "{problems:#?}");
    document
}

fn entity_text(entity: &Entity) -> String {
    let parameters: Vec<_> = entity.parameters.iter().map(|p| format!("{}={:?}", p.name, p.value)).collect();
    format!("{} {}", entity.type_name, parameters.join(" "))
}

/// Materials, lights, shapes and settings as text.
fn content(document: &Document) -> Vec<String> {
    let entities = [&document.film, &document.sampler, &document.filter, &document.integrator];
    let mut all: Vec<String> = entities.into_iter().flatten().map(entity_text).collect();
    all.extend(
        document.camera.iter().map(|c| format!("{} {:?}", entity_text(&c.entity), c.world_from_camera)),
    );
    all.extend(document.materials.iter().map(|m| format!("{:?} {}", m.name, entity_text(&m.entity))));
    all.extend(document.textures.iter().map(|t| format!("{} {}", t.name, entity_text(&t.entity))));
    all.extend(
        document.lights.iter().map(|l| format!("{} {:?}", entity_text(&l.entity), l.world_from_light)),
    );
    all.extend(document.area_lights.iter().map(entity_text));
    all.extend(
        document.shapes.iter().map(|s| format!("{} {:?}", entity_text(&s.entity), s.world_from_object)),
    );
    all
}

#[track_caller]
fn check_material(text: &str, expected: &str) {
    let document = read(text);
    let last = document.materials.last().expect("a material");
    assert_eq!(entity_text(&last.entity), expected);
}

/// Every BSDF becomes the material of the same meaning.
#[test]
fn materials() {
    let check = check_material;
    check(
        r##"<bsdf type="diffuse"><rgb name="reflectance" value="0.1, 0.2 0.3"/></bsdf>"##,
        "diffuse reflectance=Rgb([[0.1, 0.2, 0.3]])",
    );
    check(
        r##"<bsdf type="twosided"><bsdf type="diffuse"><rgb name="reflectance" value="#ffffff"/></bsdf></bsdf>"##,
        "diffuse reflectance=Rgb([[1.0, 1.0, 1.0]])",
    );
    check(
        r#"<bsdf type="dielectric"><string name="int_ior" value="water"/><float name="ext_ior" value="1"/></bsdf>"#,
        "dielectric eta=Floats([1.333])",
    );
    check(
        r#"<bsdf type="roughconductor"><string name="material" value="Au"/><float name="alpha" value="0.2"/>
        <string name="distribution" value="ggx"/></bsdf>"#,
        "conductor roughness=Floats([0.2]) remaproughness=Bools([false]) distribution=Strings([\"ggx\"]) \
         eta=SpectrumNames([\"metal-Au-eta\"]) k=SpectrumNames([\"metal-Au-k\"])",
    );
    check(r#"<bsdf type="conductor"/>"#, "conductor reflectance=Rgb([[1.0, 1.0, 1.0]])");
    check(
        r#"<bsdf type="plastic"><float name="int_ior" value="1.5"/><float name="ext_ior" value="1"/></bsdf>"#,
        "coateddiffuse eta=Floats([1.5])",
    );
    check(
        r#"<bsdf type="blendbsdf"><float name="weight" value="0.25"/><bsdf type="diffuse" id="a"/>
        <bsdf type="diffuse" id="b"/></bsdf>"#,
        "mix materials=Strings([\"a\", \"b\"]) amount=Floats([0.25])",
    );
    check(
        r#"<bsdf type="principled"><float name="specular" value="0.5"/></bsdf>"#,
        "principled basecolor=Rgb([[0.5, 0.5, 0.5]]) ior=Floats([1.5])",
    );
    check(
        r#"<bsdf type="coating"><float name="int_ior" value="1.5"/><float name="ext_ior" value="1"/>
        <bsdf type="conductor"><string name="material" value="Cu"/></bsdf></bsdf>"#,
        "coatedconductor conductor.eta=SpectrumNames([\"metal-Cu-eta\"]) \
         conductor.k=SpectrumNames([\"metal-Cu-k\"]) interface.eta=Floats([1.5]) \
         interface.roughness=Floats([0.0]) remaproughness=Bools([false])",
    );
    check(r#"<bsdf type="null"/>"#, "interface ");
}

/// A mask is the alpha of the shapes, and a bump map the relief of what is inside.
#[test]
fn materials_around_others() {
    let document = read(
        r#"<bsdf type="mask" id="m"><float name="opacity" value="0.3"/><bsdf type="diffuse"/></bsdf>
        <shape type="sphere"><ref id="m"/></shape>
        <bsdf type="bumpmap"><texture type="checkerboard"/><float name="scale" value="2"/><bsdf type="diffuse"/></bsdf>"#,
    );
    let alpha = document.shapes[0].entity.parameters.iter().find(|p| p.name == "alpha").expect("alpha");
    assert_eq!(alpha.value, Value::Floats(vec![0.3]));
    let bumped = document.materials.last().expect("a material");
    assert_eq!(bumped.entity.parameters[0].name, "displacement");
    assert_eq!(document.textures.last().expect("a texture").entity.type_name, "scale");
}

/// Steps of a transform act one after another, and the view of a camera is ours mirrored.
#[test]
fn transforms() {
    let document = read(
        r#"<shape type="cube"><transform name="to_world"><scale value="2"/><rotate z="1" angle="90"/>
        <translate x="10"/></transform></shape>
        <sensor type="perspective"><transform name="to_world">
        <lookat origin="0,0,-5" target="0,0,0" up="0,1,0"/></transform></sensor>"#,
    );
    let moved = document.shapes[0].world_from_object.start.point(Point3::new(1.0, 0.0, 0.0));
    assert!(moved.distance(Point3::new(10.0, 2.0, 0.0)) < 1e-5, "{moved:?}");
    let camera = document.camera.expect("a camera").world_from_camera.start;
    let right = camera.vector(Vector3::new(1.0, 0.0, 0.0));
    // Mitsuba is right-handed: who looks along +z has -x on the right.
    assert!(right.x < -0.99 && camera.vector(Vector3::new(0.0, 0.0, 1.0)).z > 0.99);
    assert_eq!(camera.point(Point3::default()), Point3::new(0.0, 0.0, -5.0));
}

/// Angles of view are converted to those across the shorter side.
#[test]
fn fields_of_view() {
    let fov = |properties: &str, size: [u32; 2]| {
        let [w, h] = size;
        let document = read(&format!(
            r#"<sensor type="perspective">{properties}<film type="hdrfilm">
            <integer name="width" value="{w}"/><integer name="height" value="{h}"/></film></sensor>"#
        ));
        let camera = document.camera.expect("a camera").entity;
        match camera.parameters.iter().find(|p| p.name == "fov").expect("an angle").value {
            Value::Floats(ref fov) => fov[0],
            _ => panic!("an angle is a number"),
        }
    };
    let ninety = r#"<float name="fov" value="90"/>"#;
    assert!((fov(ninety, [200, 200]) - 90.0).abs() < 1e-4);
    // tan(45 deg) / 2 across the shorter side.
    assert!((fov(ninety, [200, 100]) - 2.0 * 0.5_f32.atan().to_degrees()).abs() < 1e-4);
    assert!((fov(ninety, [100, 200]) - 90.0).abs() < 1e-4);
    let smaller = format!(r#"{ninety}<string name="fov_axis" value="smaller"/>"#);
    assert!((fov(&smaller, [200, 100]) - 90.0).abs() < 1e-4);
    // 36 x 24 mm at 50 mm: 27 degrees across the shorter side.
    let lens = r#"<string name="focal_length" value="50mm"/>"#;
    assert!((fov(lens, [300, 200]) - 2.0 * (12.0_f32 / 50.0).atan().to_degrees()).abs() < 1e-3);
}

/// The dialect of 0.6 reads as the same scene.
#[test]
fn older_spelling() {
    let new = read_all(
        r#"<scene version="3.0.0"><integrator type="path"><integer name="max_depth" value="5"/></integrator>
        <sensor type="perspective"><string name="fov_axis" value="smaller"/><float name="fov" value="40"/>
        <transform name="to_world"><lookat origin="1 2 3" target="0 0 0" up="0 1 0"/></transform>
        <sampler type="independent"><integer name="sample_count" value="8"/></sampler></sensor>
        <bsdf type="roughdielectric" id="g"><float name="int_ior" value="1.4"/><float name="alpha" value="0.3"/></bsdf>
        <shape type="sphere"><transform name="to_world"><scale x="2" y="2" z="2"/></transform><ref id="g"/></shape>
        </scene>"#,
    );
    let old = read_all(
        r#"<scene version="0.6.0"><integrator type="path"><integer name="maxDepth" value="5"/></integrator>
        <sensor type="perspective"><string name="fovAxis" value="smaller"/><float name="fov" value="40"/>
        <transform name="toWorld"><lookAt origin="1 2 3" target="0 0 0" up="0 1 0"/></transform>
        <sampler type="independent"><integer name="sampleCount" value="8"/></sampler></sensor>
        <bsdf type="roughdielectric" id="g"><float name="intIOR" value="1.4"/><float name="alpha" value="0.3"/></bsdf>
        <shape type="sphere"><transform name="toWorld"><scale x="2" y="2" z="2"/></transform><ref id="g"/></shape>
        </scene>"#,
    );
    assert_eq!((new.1, &old.1), (Vec::new(), &Vec::new()));
    assert_eq!(content(&new.0), content(&old.0));
    assert!(content(&new.0).iter().any(|line| line.starts_with("path maxdepth=Integers([4])")));
}

/// Parameters are filled in, the first definition counts, and names of materials lead to indices.
#[test]
fn parameters() {
    let document = read(
        r#"<default name="r" value="3"/><default name="r" value="4"/>
        <shape type="sphere"><float name="radius" value="$r.5"/></shape>"#,
    );
    assert!(entity_text(&document.shapes[0].entity).contains("radius=Floats([3.5])"));
}

/// Colours of lights are ours; spectra are absolute and scaled to give the same picture.
#[test]
fn emission() {
    let light = |text: &str| {
        let document = read(&format!(r#"<emitter type="constant">{text}</emitter>"#));
        entity_text(&document.lights[0].entity)
    };
    assert_eq!(light(r#"<rgb name="radiance" value="1, 2, 3"/>"#), "infinite L=Rgb([[1.0, 2.0, 3.0]])");
    let flat = light(r#"<spectrum name="radiance" value="2"/>"#);
    let expected = format!(
        "infinite units=Strings([\"radiometric\"]) L=SpectrumSamples([[360.0, 2.0], [830.0, 2.0]]) \
         scale=Floats([{FROM_RADIOMETRIC:?}])"
    );
    assert_eq!(flat, expected);
    let warm = light(
        r#"<spectrum type="blackbody" name="radiance"><float name="temperature" value="3000"/></spectrum>"#,
    );
    assert!(warm.contains("L=Blackbody([3000.0])"), "{warm}");
}

#[track_caller]
fn check_problem(text: &str, expected: &str) {
    let (_, problems) = read_all(text);
    assert!(
        problems.iter().any(|problem| problem.contains(expected)),
        "'{expected}' is not in {problems:#?}"
    );
}

/// Problems have their place and, where there is one, the remedy.
#[test]
fn problems() {
    let check = |text: &str, expected: &str| {
        check_problem(&format!("<scene version=\"3.0.0\">\n{text}\n</scene>"), expected);
    };
    check(r#"<shape type="spere"/>"#, "2:14: unknown shape \"spere\" (did you mean \"sphere\"?)");
    check(r#"<shape type="hair"/>"#, "2:14: the shape `hair` is not available; it is left out");
    check(r#"<bsdf type="irawan"/>"#, "a grey `diffuse` stands in for it");
    check(r#"<shape type="sphere"><float name="radus" value="1"/></shape>"#, "did you mean `radius`?");
    check(r#"<shape type="sphere"><float name="radius" value="1x"/></shape>"#, "2:50: `1x` is not a number");
    check(r#"<shape type="sphere"><ref id="nothing"/></shape>"#, "unknown id \"nothing\"");
    check(r#"<float name="x" value="$y"/>"#, "there is no parameter `$y`");
    check(r#"<shape type="obj"><string name="filename" value="no.obj"/></shape>"#, "there is no file");
    check(r#"<include filename="no.xml"/>"#, "2:20: there is no file");
    check(
        r#"<shape type="cube"><transform name="to_world"><scale value="0"/></transform></shape>"#,
        "no inverse",
    );
    check(
        r#"<shape type="cube"><transform name="to_world"><matrix value="1 2"/></transform></shape>"#,
        "16 or 9",
    );
    check(r#"<bsdf type="diffuse" id="a"/><bsdf type="diffuse" id="a"/>"#, "the id `a` is given twice");
    check(r#"<medium type="homogeneous" id="m"/><medium type="x" id="n"/>"#, "unknown medium \"x\"");
    check(
        r#"<sensor type="perspective"><film type="hdrfilm"><integer name="width" value="0"/></film></sensor>"#,
        "positive",
    );
    check_problem("<scene version=\"3.0.0\">\n<shape type=\"x\">\n</scene>", "3:1: the XML is damaged");
    check_problem("<cube/>", "the root of a scene of Mitsuba is <scene>");
    check_problem("", "the XML is damaged");
}

/// Bombs are defused: entities, nests, cycles, and parameters that double.
#[test]
fn hostile_scenes() {
    let bomb = "<!DOCTYPE s [<!ENTITY a \"xx\"><!ENTITY b \"&a;&a;\">]><scene version=\"3.0.0\">&b;</scene>";
    check_problem(bomb, "document type definitions and entities are not read");
    let deep = format!(
        "<scene version=\"3.0.0\">{}{}</scene>",
        "<bsdf type=\"mask\">".repeat(10_000),
        "</bsdf>".repeat(10_000)
    );
    check_problem(&deep, "more than 64 deep");
    let cycle = r#"<scene version="3.0.0"><bsdf type="twosided" id="a"><ref id="b"/></bsdf>
        <bsdf type="twosided" id="b"><ref id="a"/></bsdf></scene>"#;
    check_problem(cycle, "refers to itself");
    let mut doubling = "<scene version=\"3.0.0\"><default name=\"x0\" value=\"aaaaaaaaaa\"/>".to_owned();
    for i in 1..40 {
        doubling += &format!("<default name=\"x{i}\" value=\"$x{j}$x{j}\"/>", j = i - 1);
    }
    check_problem(&(doubling + "</scene>"), "stand for too much text");
    // 2^60 ways through the blends, each read once.
    let mut blends = "<scene version=\"3.0.0\"><bsdf type=\"diffuse\" id=\"b0\"/>".to_owned();
    for i in 1..60 {
        let j = i - 1;
        blends +=
            &format!("<bsdf type=\"blendbsdf\" id=\"b{i}\"><ref id=\"b{j}\"/><ref id=\"b{j}\"/></bsdf>");
    }
    let (document, problems) = read_all(&(blends + "</scene>"));
    assert!(problems.is_empty() && document.materials.len() == 61, "{problems:?}");
}

/// Files that include each other are told.
#[test]
fn includes() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let write = |name: &str, text: &str| std::fs::write(folder.path().join(name), text).expect("writable");
    write(
        "a.xml",
        r#"<scene version="3.0.0"><default name="r" value="2"/><include filename="b.xml"/></scene>"#,
    );
    write(
        "b.xml",
        r#"<scene version="3.0.0"><shape type="sphere"><float name="radius" value="$r"/></shape></scene>"#,
    );
    let (document, diagnostics) = super::read_mitsuba(&folder.path().join("a.xml"));
    assert!(diagnostics.list().is_empty(), "{:?}", diagnostics.list());
    assert!(entity_text(&document.shapes[0].entity).contains("radius=Floats([2.0])"));
    write("b.xml", r#"<scene version="3.0.0"><include filename="a.xml"/></scene>"#);
    let (_, diagnostics) = super::read_mitsuba(&folder.path().join("a.xml"));
    assert!(diagnostics.list().iter().any(|d| d.message.contains("includes itself")));
}

/// Meshes get normals where they have none, and v as our textures have it.
#[test]
fn meshes() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let obj = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nvt 0 0.25\nf 1/1 2/1 3/1 4/1\n";
    std::fs::write(folder.path().join("a.obj"), obj).expect("writable");
    let text = r#"<scene version="3.0.0"><shape type="obj"><string name="filename" value="a.obj"/></shape>
        <shape type="obj"><string name="filename" value="a.obj"/><boolean name="face_normals" value="true"/>
        <boolean name="flip_tex_coords" value="false"/></shape></scene>"#;
    let (document, diagnostics) = read_mitsuba_bytes("s.xml", text.as_bytes().to_vec(), folder.path());
    assert!(diagnostics.list().is_empty(), "{:?}", diagnostics.list());
    let meshes: Vec<&LoadedMesh> = document
        .embedded
        .values()
        .map(|file| match file {
            EmbeddedFile::Mesh(mesh) => &**mesh,
            _ => panic!("a mesh"),
        })
        .collect();
    assert_eq!(meshes.len(), 2);
    let facetted = meshes.iter().find(|mesh| mesh.normals.is_empty()).expect("one without normals");
    let smooth = meshes.iter().find(|mesh| !mesh.normals.is_empty()).expect("one with normals");
    assert_eq!((facetted.triangles.len(), smooth.triangles.len()), (2, 2));
    assert!(smooth.normals.iter().all(|n| n.z > 0.999));
    assert_eq!((smooth.uvs[0].y, facetted.uvs[0].y), (0.25, 0.75));
}

/// A serialized file with two meshes, of version 4.
fn serialized() -> Vec<u8> {
    let mut file = Vec::new();
    let mut offsets = Vec::new();
    for scale in [1.0_f32, 2.0] {
        offsets.push(file.len() as u64);
        file.extend(0x041c_u16.to_le_bytes());
        file.extend(4_u16.to_le_bytes());
        let mut body = Vec::new();
        body.extend(0x1000_u32.to_le_bytes());
        body.extend(b"name\0");
        body.extend(3_u64.to_le_bytes());
        body.extend(1_u64.to_le_bytes());
        for p in [[0.0, 0.0, 0.0], [scale, 0.0, 0.0], [0.0, scale, 0.0]] {
            p.iter().for_each(|x: &f32| body.extend(x.to_le_bytes()));
        }
        [0_u32, 1, 2].iter().for_each(|i| body.extend(i.to_le_bytes()));
        let mut zlib = flate2::write::ZlibEncoder::new(&mut file, flate2::Compression::default());
        zlib.write_all(&body).expect("memory");
        zlib.finish().expect("memory");
    }
    offsets.iter().for_each(|offset| file.extend(offset.to_le_bytes()));
    file.extend(2_u32.to_le_bytes());
    file
}

/// Each mesh of a serialized file is found, and damage is told.
#[test]
fn serialized_meshes() {
    let file = serialized();
    assert_eq!(read_serialized(&file, 0).expect("good").positions[1].x, 1.0);
    assert_eq!(read_serialized(&file, 1).expect("good").positions[1].x, 2.0);
    assert!(read_serialized(&file, 2).expect_err("two meshes").contains("2 meshes"));
    for length in 0..file.len() {
        assert!(read_serialized(&file[..length], 0).is_err() || length > file.len() - 8);
    }
}

/// A picture of the surroundings keeps its colours in their directions.
#[test]
fn environments() {
    // Bright where y > 0, and redder towards +x.
    let theirs = Texels::from_fn(64, 32, 3, |x, y, c| match c {
        0 => {
            if x < 32 {
                1.0
            } else {
                0.0
            }
        }
        1 => {
            if y < 16 {
                1.0
            } else {
                0.0
            }
        }
        _ => 0.25,
    });
    let square = equal_area_of_latitude_longitude(&theirs, &y_is_up);
    let n = square.width();
    assert_eq!(n, square.height());
    for y in 0..n {
        for x in 0..n {
            let p = etendue_math::Point2::new((x as f32 + 0.5) / n as f32, (y as f32 + 0.5) / n as f32);
            let w = warp::equal_area_square_to_sphere(p);
            if w.x.abs() < 0.2 || w.y.abs() < 0.2 || w.y.abs() > 0.9 {
                continue;
            }
            let expected = [f32::from(u8::from(w.x > 0.0)), f32::from(u8::from(w.y > 0.0)), 0.25];
            for (c, expected) in expected.into_iter().enumerate() {
                assert!((square.texel(x, y, c) - expected).abs() < 0.02, "{w:?} channel {c}");
            }
        }
    }
}

/// Merges that contain themselves, or each other many times over, are an error and no endless work.
#[test]
fn merges_are_bounded() {
    let (document, problems) = read_all(
        r#"<scene version="3.0.0"><shape type="merge" id="a"><ref id="a"/><shape type="cube"/></shape></scene>"#,
    );
    assert_eq!(document.shapes.len(), 1);
    assert!(problems[0].contains("`merge` refers to itself"), "{problems:?}");
    let mut text = r#"<scene version="3.0.0"><shape type="sphere" id="m0"/>"#.to_owned();
    for i in 1..40 {
        let last = i - 1;
        text += &format!(r#"<shape type="merge" id="m{i}"><ref id="m{last}"/><ref id="m{last}"/></shape>"#);
    }
    let (_, problems) = read_all(&(text + "</scene>"));
    assert_eq!(problems.len(), 1, "{:?}", &problems[..problems.len().min(4)]);
    assert!(problems[0].contains("too many shapes"), "{problems:?}");
}

/// A file may be included often, but not so often that a small scene becomes any size.
#[test]
fn inclusions_are_bounded() {
    let folder = tempfile::tempdir().expect("a folder");
    std::fs::write(folder.path().join("b.xml"), "<scene version=\"3.0.0\"/>").expect("written");
    let many = r#"<include filename="b.xml"/>"#.repeat(10_100);
    let text = format!("<scene version=\"3.0.0\">{many}</scene>");
    let (document, diagnostics) = read_mitsuba_bytes("a.xml", text.into_bytes(), folder.path());
    let problems = listed(&document, &diagnostics);
    assert_eq!(problems.len(), 1);
    assert!(problems[0].contains("includes more than 10000 files"), "{problems:?}");
}

/// Of many parameters without value the first get a suggestion: to find one takes as long as there are parameters.
#[test]
fn suggestions_are_bounded() {
    let (_, problems) = read_all(&format!(
        r#"<scene version="3.0.0"><default name="speed" value="1"/>{}</scene>"#,
        r#"<integrator type="path"><integer name="max_depth" value="$sped"/></integrator>"#.repeat(30)
    ));
    let n = problems.iter().filter(|problem| problem.contains("did you mean `$speed`?")).count();
    assert_eq!(n, 20);
}

/// A few bytes that decompress to many are refused before they fill the memory.
#[test]
fn serialized_bombs() {
    let mut file = [0x041c_u16.to_le_bytes(), 3_u16.to_le_bytes()].concat();
    let mut body = 0x1000_u32.to_le_bytes().to_vec();
    body.extend(3_000_000_u64.to_le_bytes());
    body.extend(0_u64.to_le_bytes());
    body.resize(body.len() + 12 * 3_000_000, 0);
    let mut zlib = flate2::write::ZlibEncoder::new(&mut file, flate2::Compression::best());
    zlib.write_all(&body).expect("memory");
    zlib.finish().expect("memory");
    file.extend([0_u32, 1].iter().flat_map(|word| word.to_le_bytes()));
    let why = read_serialized(&file, 0).expect_err("too large");
    assert!(why.contains("decompresses to more than"), "{why}");
}

/// A coat without gloss has alpha 0.1, of which ours is given by the square root.
#[test]
fn coats_without_gloss() {
    check_material(
        r#"<bsdf type="principled"><float name="clearcoat" value="1"/></bsdf>"#,
        "principled basecolor=Rgb([[0.5, 0.5, 0.5]]) clearcoat=Floats([1.0]) clearcoatroughness=Floats([0.31622776])",
    );
}

/// A sensor without a film has Mitsuba's: 768 x 576 pixels and a Gaussian filter.
#[test]
fn sensors_without_film() {
    let content = content(&read(r#"<sensor type="perspective"/>"#));
    assert_eq!(content[0], "rgb xresolution=Integers([768]) yresolution=Integers([576])");
    assert!(content.iter().any(|line| line.starts_with("gaussian ")), "{content:?}");
}
