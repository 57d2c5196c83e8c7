//! What each directive means.

use etendue_math::Transform;
use etendue_scene::document::{MaterialReference, TextureValue, Value};

use super::{check_point, problems, read, read_world, value};

/// Where the transform of the one shape takes a point.
#[track_caller]
fn check_transform(directives: &str, from: [f32; 3], to: [f32; 3]) {
    let document = read_world(&format!("{directives} Shape \"sphere\""));
    check_point(document.shapes[0].world_from_object.start, from, to);
}

/// Each transform applies to the object before those written earlier.
#[test]
fn transforms_concatenate_on_the_right() {
    check_transform("Translate 1 2 3", [1.0, 1.0, 1.0], [2.0, 3.0, 4.0]);
    check_transform("Scale 2 3 -4", [1.0, 1.0, 1.0], [2.0, 3.0, -4.0]);
    check_transform("Rotate 90 0 0 1", [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]);
    check_transform("Translate 1 0 0 Scale 2 2 2", [1.0, 0.0, 0.0], [3.0, 0.0, 0.0]);
    check_transform("Scale 2 2 2 Translate 1 0 0", [1.0, 0.0, 0.0], [4.0, 0.0, 0.0]);
    check_transform("Translate 1 0 0 Identity", [1.0, 0.0, 0.0], [1.0, 0.0, 0.0]);
    // The viewer at (0, 0, 5) who looks at the origin sees it 5 ahead.
    check_transform("LookAt 0 0 5  0 0 0  0 1 0", [0.0, 0.0, 0.0], [0.0, 0.0, 5.0]);
}

/// The 16 numbers are columns: the last four are the translation.
#[test]
fn matrices_are_written_by_columns() {
    let m = "[ 0 1 0 0  -1 0 0 0  0 0 1 0  5 6 7 1 ]";
    check_transform(&format!("Translate 9 9 9 Transform {m}"), [1.0, 0.0, 0.0], [5.0, 7.0, 7.0]);
    check_transform(&format!("Translate 1 0 0 ConcatTransform {m}"), [1.0, 0.0, 0.0], [6.0, 7.0, 7.0]);
}

/// The camera keeps the inverse of the current transform, also as the coordinate system "camera".
#[test]
fn camera_stands_where_it_looks_from() {
    let document = read(
        "LookAt 1 2 3  1 2 0  0 1 0 Camera \"perspective\" \"float fov\" 40
         WorldBegin CoordSysTransform \"camera\" Shape \"sphere\"
         CoordSysTransform \"world\" Shape \"sphere\"",
    );
    let camera = document.camera.expect("there is a camera");
    assert_eq!(camera.entity.type_name, "perspective");
    check_point(camera.world_from_camera.start, [0.0, 0.0, 0.0], [1.0, 2.0, 3.0]);
    check_point(camera.world_from_camera.start, [0.0, 0.0, 1.0], [1.0, 2.0, 2.0]);
    assert_eq!(document.shapes[0].world_from_object, camera.world_from_camera);
    assert_eq!(document.shapes[1].world_from_object.start, Transform::IDENTITY);
}

/// The world begins with the identity; attributes other than transforms stay.
#[test]
fn world_begin_resets_transforms() {
    let document = read(
        "Translate 1 2 3 ActiveTransform EndTime MediumInterface \"\" \"fog\"
         WorldBegin Translate 1 0 0 Shape \"sphere\"",
    );
    let shape = &document.shapes[0];
    assert!(!shape.world_from_object.is_animated());
    check_point(shape.world_from_object.start, [0.0, 0.0, 0.0], [1.0, 0.0, 0.0]);
    assert_eq!((shape.outside_medium.as_str(), shape.has_medium_interface), ("fog", true));
}

/// A named coordinate system keeps both transforms.
#[test]
fn coordinate_systems() {
    check_transform(
        "Translate 1 0 0 CoordinateSystem \"here\" Identity Scale 2 2 2 CoordSysTransform \"here\"",
        [1.0, 0.0, 0.0],
        [2.0, 0.0, 0.0],
    );
    let found = problems("WorldBegin CoordinateSystem \"here\" CoordSysTransform \"hree\"");
    let expected =
        "1:54: warning: there is no coordinate system `hree`: the transform stays (did you mean `here`?)";
    assert_eq!(found, [expected]);
}

/// Motion is the difference of the start and the end transform, over the given times.
#[test]
fn motion() {
    let document = read(
        "TransformTimes 0.5 2 WorldBegin
         AttributeBegin ActiveTransform EndTime Translate 1 0 0 ActiveTransform StartTime Translate 0 1 0
         ActiveTransform All Scale 2 2 2 Shape \"sphere\" AttributeEnd Shape \"sphere\"",
    );
    let moving = document.shapes[0].world_from_object;
    assert!(moving.is_animated());
    assert_eq!((moving.start_time, moving.end_time), (0.5, 2.0));
    check_point(moving.start, [1.0, 0.0, 0.0], [2.0, 1.0, 0.0]);
    check_point(moving.end, [1.0, 0.0, 0.0], [3.0, 0.0, 0.0]);
    assert!(!document.shapes[1].world_from_object.is_animated());
}

/// Blocks give back every attribute that is set inside.
#[test]
fn attribute_blocks_restore_the_state() {
    for (begin, end) in [("AttributeBegin", "AttributeEnd"), ("ObjectBegin \"o\"", "ObjectEnd")] {
        let document = read_world(&format!(
            "{begin} Translate 1 0 0 ReverseOrientation ColorSpace \"rec2020\" Material \"conductor\"
             MediumInterface \"in\" \"out\" AreaLightSource \"diffuse\" Attribute \"shape\" \"float radius\" 2
             ActiveTransform EndTime {end} Translate 0 0 0 Shape \"sphere\" \"rgb x\" [1 1 1]"
        ));
        let plain = read_world("Shape \"sphere\" \"rgb x\" [1 1 1]");
        let (shape, expected) = (&document.shapes[0], &plain.shapes[0]);
        assert_eq!(shape.world_from_object, expected.world_from_object);
        assert_eq!(shape.reverse_orientation, expected.reverse_orientation);
        assert_eq!(shape.material, expected.material);
        assert_eq!(shape.area_light, expected.area_light);
        assert_eq!(shape.has_medium_interface, expected.has_medium_interface);
        assert_eq!(shape.entity.parameters.len(), 1);
        assert_eq!(shape.entity.parameters[0].color_space, expected.entity.parameters[0].color_space);
    }
}

/// The old transform blocks are attribute blocks, with one warning for all of them.
#[test]
fn transform_blocks_are_deprecated() {
    let text = "WorldBegin\nTransformBegin Material \"conductor\" TransformEnd\nTransformBegin TransformEnd Shape \"s\"";
    let found = problems(text);
    assert_eq!(found.len(), 1);
    assert!(found[0].starts_with("2:1: warning: `TransformBegin` is deprecated"), "{found:?}");
    let (document, _) = super::super::read_pbrt_str("t", text, std::path::Path::new(""));
    assert_eq!(document.shapes[0].material, MaterialReference::Index(0));
}

/// Defaults apply to entities of their kind that do not say otherwise, and the last default counts.
#[test]
fn attribute_defaults() {
    let document = read_world(
        "Attribute \"shape\" \"float radius\" 2 \"float alpha\" .5
         Attribute \"shape\" \"float radius\" 3
         Attribute \"light\" \"float scale\" 4 Attribute \"material\" \"float roughness\" .1
         Attribute \"medium\" \"float g\" .7 Attribute \"texture\" \"float tex\" 8
         Shape \"sphere\" Shape \"sphere\" \"float radius\" 1 LightSource \"point\" AreaLightSource \"diffuse\"
         Shape \"disk\" Material \"coateddiffuse\" MakeNamedMaterial \"m\" \"string type\" \"conductor\"
         MakeNamedMedium \"fog\" \"string type\" \"homogeneous\" Texture \"t\" \"float\" \"constant\"",
    );
    let radius = |i: usize| value(&document.shapes[i].entity, "radius").clone();
    assert_eq!(radius(0), Value::Floats(vec![3.0]));
    assert_eq!(radius(1), Value::Floats(vec![1.0]));
    assert_eq!(document.shapes[1].entity.parameters.len(), 2);
    let one = |entity, name| matches!(value(entity, name), Value::Floats(v) if v.len() == 1);
    assert!(one(&document.lights[0].entity, "scale") && one(&document.area_lights[0], "scale"));
    assert!(
        one(&document.materials[1].entity, "roughness") && one(&document.materials[2].entity, "roughness")
    );
    assert!(one(&document.media[0].entity, "g") && one(&document.textures[0].entity, "tex"));
}

/// What stands before `WorldBegin` is stored as written; the last of a kind counts.
#[test]
fn options_block() {
    let document = read(
        "Option \"disablepixeljitter\" true Option \"seed\" 3 Option \"Displacement-Edge_Scale\" 1.5
         Option \"msereferenceimage\" \"a.exr\" Option \"integer seed\" 4
         Film \"gbuffer\" Film \"rgb\" \"integer xresolution\" 10
         Sampler \"halton\" \"integer pixelsamples\" 7 PixelFilter \"box\" Integrator \"path\" Accelerator \"kdtree\"
         WorldBegin",
    );
    let options: Vec<_> = document.options.iter().map(|o| (o.name.as_str(), o.value.clone())).collect();
    let expected = [
        ("disablepixeljitter", Value::Bools(vec![true])),
        ("displacementedgescale", Value::Floats(vec![1.5])),
        ("msereferenceimage", Value::Strings(vec!["a.exr".into()])),
        ("seed", Value::Integers(vec![4])),
    ];
    assert_eq!(options, expected);
    let name = |entity: &Option<etendue_scene::document::Entity>| {
        entity.as_ref().map(|e| e.type_name.clone()).unwrap_or_default()
    };
    assert_eq!(name(&document.film), "rgb");
    assert_eq!(name(&document.sampler), "halton");
    assert_eq!(name(&document.filter), "box");
    assert_eq!(name(&document.integrator), "path");
    assert_eq!(name(&document.accelerator), "kdtree");
}

/// Shapes use the material that was current at them, by index or by name.
#[test]
fn materials() {
    let document = read_world(
        "Shape \"a\" Material \"conductor\" \"float roughness\" .1 Shape \"b\"
         MakeNamedMaterial \"glass\" \"float eta\" 1.3 \"string type\" \"dielectric\" Shape \"c\"
         NamedMaterial \"glass\" Shape \"d\" Material \"interface\" Shape \"e\"",
    );
    let used: Vec<_> = document.shapes.iter().map(|shape| shape.material.clone()).collect();
    assert_eq!(used[..3], [0, 1, 1].map(MaterialReference::Index));
    assert!(matches!(&used[3], MaterialReference::Name(name, Some(_)) if name == "glass"));
    assert_eq!(used[4], MaterialReference::Index(3));
    let glass = &document.materials[2];
    assert_eq!((glass.name.as_deref(), glass.entity.type_name.as_str()), (Some("glass"), "dielectric"));
    assert_eq!(glass.entity.parameters.len(), 1);
}

/// The empty material and "none" are old names of the mere boundary between media.
#[test]
fn old_interface_materials() {
    for name in ["", "none"] {
        let text = format!("WorldBegin Material \"{name}\"");
        let found = problems(&text);
        assert!(found.len() == 1 && found[0].contains("warning"), "{found:?}");
        let (document, _) = super::super::read_pbrt_str("t", &text, std::path::Path::new(""));
        assert_eq!(document.materials[1].entity.type_name, "interface");
    }
}

/// An area light makes all shapes after it emit, until the block ends or an empty type turns it off.
#[test]
fn area_lights() {
    let document = read_world(
        "AttributeBegin AreaLightSource \"diffuse\" \"float scale\" 1 AreaLightSource \"diffuse\" \"float scale\" 2
         Shape \"a\" AttributeBegin Shape \"b\" AttributeEnd AreaLightSource \"\" Shape \"c\" AttributeEnd Shape \"d\"",
    );
    let lights: Vec<_> = document.shapes.iter().map(|shape| shape.area_light).collect();
    assert_eq!(lights, [Some(0), Some(0), None, None]);
    assert_eq!(document.area_lights.len(), 1);
    assert_eq!(value(&document.area_lights[0], "scale"), &Value::Floats(vec![2.0]));
}

/// An interface names the media on both sides; one name means both.
#[test]
fn media() {
    let document = read(
        "MediumInterface \"\" \"air\" Camera \"perspective\"
         MakeNamedMedium \"air\" \"string type\" \"homogeneous\" WorldBegin Translate 1 0 0
         MakeNamedMedium \"fog\" \"string type\" \"cloud\" \"float density\" 2
         AttributeBegin MediumInterface \"fog\" \"air\" Shape \"a\" MediumInterface \"fog\" Shape \"b\"
         LightSource \"point\" AttributeEnd Shape \"c\" ReverseOrientation Shape \"d\"",
    );
    assert_eq!(document.camera.as_ref().map(|camera| camera.medium.as_str()), Some("air"));
    let sides: Vec<_> =
        document.shapes.iter().map(|s| (s.inside_medium.as_str(), s.outside_medium.as_str())).collect();
    assert_eq!(sides, [("fog", "air"), ("fog", "fog"), ("", "air"), ("", "air")]);
    assert_eq!(document.lights[0].outside_medium, "fog");
    let fog = &document.media[1];
    assert_eq!((fog.name.as_str(), fog.entity.type_name.as_str()), ("fog", "cloud"));
    check_point(fog.world_from_medium.start, [0.0; 3], [1.0, 0.0, 0.0]);
    assert_eq!(fog.entity.parameters.len(), 1);
    assert!(document.shapes[3].reverse_orientation && !document.shapes[2].reverse_orientation);
}

/// Textures keep the transform of their definition; a name may serve a number and a spectrum.
#[test]
fn textures() {
    let document = read_world(
        "Scale 2 2 2 Texture \"t\" \"float\" \"constant\" \"float value\" 3
         Texture \"t\" \"spectrum\" \"imagemap\" \"string filename\" \"t.png\"",
    );
    let kinds: Vec<_> = document.textures.iter().map(|t| (t.value, t.entity.type_name.as_str())).collect();
    assert_eq!(kinds, [(TextureValue::Float, "constant"), (TextureValue::Spectrum, "imagemap")]);
    check_point(document.textures[0].world_from_texture, [1.0; 3], [2.0; 3]);
}

/// An instance shows each shape through the instance's transform after the shape's own.
#[test]
fn objects_and_instances() {
    let document = read_world(
        "Translate 1 0 0 ObjectBegin \"tree\" Scale 2 2 2 Shape \"sphere\" ObjectEnd
         Shape \"disk\" AttributeBegin Identity Translate 0 5 0 ObjectInstance \"tree\" AttributeEnd",
    );
    assert_eq!((document.shapes.len(), document.objects.len(), document.instances.len()), (1, 1, 1));
    let shape = &document.objects[0].shapes[0];
    let instance = &document.instances[0];
    assert_eq!((document.objects[0].name.as_str(), instance.object.as_str()), ("tree", "tree"));
    let whole = instance.world_from_instance.start * shape.world_from_object.start;
    check_point(whole, [1.0, 0.0, 0.0], [3.0, 5.0, 0.0]);
}

/// Shapes of objects do not emit: the light samplers could not know all copies.
#[test]
fn objects_do_not_emit() {
    let text = "WorldBegin AreaLightSource \"diffuse\" ObjectBegin \"o\"\nShape \"sphere\" ObjectEnd";
    let found = problems(text);
    assert!(found.len() == 1 && found[0].starts_with("2:7: warning: shapes of objects"), "{found:?}");
}
