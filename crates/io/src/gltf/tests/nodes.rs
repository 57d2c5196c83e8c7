//! The hierarchy, what bends meshes, cameras and lights.

use std::f32::consts::PI;

use etendue_math::{Point3, Vector3};

use super::*;

/// A file with a triangle as mesh 0 and those nodes.
fn nodes(nodes: &str, more: &str) -> Vec<u8> {
    let mut data = Data::default();
    let p = data.floats("VEC3", &TRIANGLE);
    data.file(&format!(
        r#""nodes": [{nodes}], "meshes": [{{"primitives": [{{"attributes": {{"POSITION": {p}}}}}]}}]{more}"#
    ))
}

#[track_caller]
fn assert_near(a: Point3, b: Point3) {
    assert!((a - b).length() < 1e-6, "{a:?} is not {b:?}");
}

/// A node scales, then rotates, then moves; its children are placed in it.
#[test]
fn transforms() {
    let half = (0.5_f32).sqrt();
    let bytes = nodes(
        &format!(
            r#"{{"translation": [1, 2, 3], "rotation": [0, 0, {half}, {half}], "scale": [2, 2, 2],
            "children": [1]}},
            {{"mesh": 0, "matrix": [1, 0, 0, 0,  0, 1, 0, 0,  0, 0, 1, 0,  5, 0, 0, 1]}}"#
        ),
        r#", "scenes": [{"nodes": [0]}], "scene": 0"#,
    );
    let document = document(bytes);
    let transform = document.shapes[0].world_from_object.start;
    // x becomes y, twice as long; the child is 5 along x.
    assert_near(transform.point(Point3::ORIGIN), Point3::new(1.0, 12.0, 3.0));
    assert_near(transform.point(Point3::new(1.0, 0.0, 0.0)), Point3::new(1.0, 14.0, 3.0));
    assert_near(transform.point(Point3::new(0.0, 1.0, 0.0)), Point3::new(-1.0, 12.0, 3.0));
}

/// A mesh that several nodes show becomes one object with instances; nodes outside of the scene show nothing.
#[test]
fn instances() {
    let bytes = nodes(
        r#"{"mesh": 0}, {"mesh": 0, "translation": [1, 0, 0]}, {"mesh": 0, "translation": [2, 0, 0]}"#,
        r#", "scenes": [{"nodes": [1, 2]}]"#,
    );
    let document = document(bytes);
    assert!(document.shapes.is_empty());
    assert_eq!(document.objects.len(), 1);
    assert_eq!(document.objects[0].name, "meshes/0");
    let place = |i: usize| document.instances[i].world_from_instance.start.point(Point3::ORIGIN);
    assert_eq!(document.instances.len(), 2);
    assert_near(place(0), Point3::new(1.0, 0.0, 0.0));
    assert_near(place(1), Point3::new(2.0, 0.0, 0.0));
}

/// `EXT_mesh_gpu_instancing` repeats a mesh within its node.
#[test]
fn instances_of_a_node() {
    let mut data = Data::default();
    let p = data.floats("VEC3", &TRIANGLE);
    let t = data.floats("VEC3", &[0.0, 0.0, 1.0, 0.0, 0.0, 2.0]);
    let document = document(data.file(&format!(
        r#""extensionsUsed": ["EXT_mesh_gpu_instancing"], "nodes": [{{"mesh": 0, "translation": [7, 0, 0],
        "extensions": {{"EXT_mesh_gpu_instancing": {{"attributes": {{"TRANSLATION": {t}}}}}}}}}],
        "meshes": [{{"primitives": [{{"attributes": {{"POSITION": {p}}}}}]}}]"#
    )));
    let places: Vec<Point3> =
        document.instances.iter().map(|i| i.world_from_instance.start.point(Point3::ORIGIN)).collect();
    assert_eq!(places, [Point3::new(7.0, 0.0, 1.0), Point3::new(7.0, 0.0, 2.0)]);
}

/// Morph targets move vertices by their weights, those of the node before those of the mesh.
#[test]
fn morph_targets() {
    let check = |node_weights: &str, expected: f32| {
        let mut data = Data::default();
        let p = data.floats("VEC3", &TRIANGLE);
        let up = data.floats("VEC3", &[0.0, 0.0, 1.0].repeat(3));
        let aside = data.floats("VEC3", &[9.0, 0.0, 0.0].repeat(3));
        let document = document(data.file(&format!(
            r#""nodes": [{{"mesh": 0{node_weights}}}], "meshes": [{{"weights": [0.5, 0], "primitives": [
            {{"attributes": {{"POSITION": {p}}}, "targets": [{{"POSITION": {up}}}, {{"POSITION": {aside}}}]}}]}}]"#
        )));
        let mesh = mesh_of(&document, &document.shapes[0]);
        assert_eq!(mesh.positions[1], Point3::new(1.0, 0.0, expected));
    };
    check("", 0.5);
    check(r#", "weights": [0.25, 0]"#, 0.25);
}

/// Joints move the vertices that hang on them, wherever the node of the mesh is; two joints share a vertex by weight.
#[test]
fn skins_at_rest() {
    let mut data = Data::default();
    let p = data.floats("VEC3", &TRIANGLE);
    let n = data.floats("VEC3", &[0.0, 0.0, 1.0].repeat(3));
    let view = data.view(&[0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0], "");
    let joints =
        data.accessor(&format!(r#""bufferView": {view}, "componentType": 5121, "count": 3, "type": "VEC4""#));
    let weights = data.floats("VEC4", &[1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.5, 0.5, 0.0, 0.0]);
    // The second joint stood at z = -1 when the mesh was bound.
    let identity = |z: f32| [1.0, 0.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, z, 1.0];
    let bind = data.floats("MAT4", &[identity(0.0), identity(1.0)].concat());
    let document = document(data.file(&format!(
        r#""nodes": [{{"mesh": 0, "skin": 0, "translation": [100, 0, 0]}},
        {{"translation": [0, 0, 4], "children": [2]}}, {{"translation": [0, 0, 2]}}],
        "skins": [{{"joints": [1, 2], "inverseBindMatrices": {bind}}}],
        "meshes": [{{"primitives": [{{"attributes": {{"POSITION": {p}, "NORMAL": {n}, "JOINTS_0": {joints},
        "WEIGHTS_0": {weights}}}}}]}}]"#
    )));
    let shape = &document.shapes[0];
    assert!(shape.world_from_object.start.is_identity());
    let mesh = mesh_of(&document, shape);
    assert_near(mesh.positions[0], Point3::new(0.0, 0.0, 4.0));
    assert_near(mesh.positions[1], Point3::new(1.0, 0.0, 7.0));
    assert_near(mesh.positions[2], Point3::new(0.0, 1.0, 5.5));
    assert!(mesh.normals.iter().all(|n| (n.as_vector() - Vector3::new(0.0, 0.0, 1.0)).length() < 1e-6));
}

/// Cameras look along -z of their node; the angle of a tall picture spans its width.
#[test]
fn cameras() {
    let camera = |lens: &str| {
        let camera = format!(r#", "cameras": [{{{lens}}}], "scenes": [{{"nodes": [0, 1]}}]"#);
        document(nodes(r#"{"camera": 0, "translation": [1, 2, 3]}, {"mesh": 0}"#, &camera))
    };
    let check = |document: &Document, fov_deg: f32, size: [i32; 2]| {
        let camera = document.camera.as_ref().expect("there is a camera");
        let Some(Value::Floats(fov)) = value(&camera.entity, "fov") else { panic!("{:?}", camera.entity) };
        assert!((fov[0] - fov_deg).abs() < 1e-4, "{fov:?} is not {fov_deg}");
        let film = document.film.as_ref().expect("there is a film");
        assert_eq!(value(film, "xresolution"), Some(&Value::Integers(vec![size[0]])));
        assert_eq!(value(film, "yresolution"), Some(&Value::Integers(vec![size[1]])));
    };
    let wide =
        camera(r#""type": "perspective", "perspective": {"yfov": 1, "aspectRatio": 1.7777778, "znear": 1}"#);
    check(&wide, 180.0 / PI, [1280, 720]);
    let tall =
        camera(r#""type": "perspective", "perspective": {"yfov": 1, "aspectRatio": 0.5625, "znear": 1}"#);
    check(&tall, (2.0 * (0.5_f32.tan() * 0.5625).atan()).to_degrees(), [720, 1280]);
    let transform = wide.camera.as_ref().expect("there is a camera").world_from_camera.start;
    assert_near(transform.point(Point3::new(0.0, 0.0, 1.0)), Point3::new(1.0, 2.0, 2.0));
    assert_near(transform.point(Point3::new(1.0, 0.0, 0.0)), Point3::new(2.0, 2.0, 3.0));
    assert_near(transform.point(Point3::new(0.0, 1.0, 0.0)), Point3::new(1.0, 3.0, 3.0));
    let flat =
        camera(r#""type": "orthographic", "orthographic": {"xmag": 2, "ymag": 1, "znear": 0, "zfar": 9}"#);
    let camera = flat.camera.as_ref().expect("there is a camera");
    assert_eq!(value(&camera.entity, "screenwindow"), Some(&Value::Floats(vec![-2.0, 2.0, -1.0, 1.0])));
}

/// Punctual lights keep candela and lux, and shine along -z of their node.
#[test]
fn lights() {
    let light = |light: &str| {
        let extensions = format!(
            r#", "scenes": [{{"nodes": [0, 1]}}],
            "extensionsUsed": ["KHR_lights_punctual"], "extensions": {{"KHR_lights_punctual": {{"lights": [{{{light}}}]}}}}"#
        );
        let node = r#"{"mesh": 0}, {"extensions": {"KHR_lights_punctual": {"light": 0}}, "translation": [0, 5, 0],
            "scale": [3, 3, 3]}"#;
        document(nodes(node, &extensions)).lights.remove(0)
    };
    let point = light(r#""type": "point", "color": [1, 0.5, 0.25], "intensity": 80"#);
    assert_eq!(point.entity.type_name, "point");
    assert_eq!(value(&point.entity, "I"), Some(&Value::Rgb(vec![[1.0, 0.5, 0.25]])));
    assert_eq!(value(&point.entity, "scale"), Some(&Value::Floats(vec![80.0])));
    assert_near(point.world_from_light.start.point(Point3::ORIGIN), Point3::new(0.0, 5.0, 0.0));
    let sun = light(r#""type": "directional", "intensity": 1e5"#);
    assert_eq!(sun.entity.type_name, "distant");
    assert_eq!(value(&sun.entity, "to"), Some(&Value::Points3(vec![Point3::new(0.0, 0.0, -1.0)])));
    let spot = light(r#""type": "spot", "spot": {"outerConeAngle": 0.5, "innerConeAngle": 0.25}"#);
    assert_eq!(value(&spot.entity, "coneangle"), Some(&Value::Floats(vec![0.5_f32.to_degrees()])));
    assert_eq!(value(&spot.entity, "conedeltaangle"), Some(&Value::Floats(vec![0.25_f32.to_degrees()])));
}

/// The hierarchy may be as deep as it likes.
#[test]
fn deep_hierarchies() {
    const N: usize = 100_000;
    let chain: Vec<String> =
        (1..N).map(|child| format!(r#"{{"children": [{child}], "translation": [1, 0, 0]}}"#)).collect();
    let document =
        document(nodes(&(chain.join(",") + r#", {"mesh": 0}"#), r#", "scenes": [{"nodes": [0]}]"#));
    let place = document.shapes[0].world_from_object.start.point(Point3::ORIGIN);
    assert_eq!(place, Point3::new((N - 1) as f32, 0.0, 0.0));
}
