use std::path::Path;

use etendue_math::{Point3, Vector3};
use etendue_scene::document::Value;
use etendue_scene::{Diagnostics, Document};

use crate::obj::read_obj_bytes;

/// A box of this size with its middle there, as a scene.
fn cuboid(size: [f32; 3], middle: [f32; 3]) -> (Document, Diagnostics) {
    let mut obj = String::new();
    for corner in 0..8 {
        let at = |axis: usize| middle[axis] + size[axis] * (((corner >> axis) & 1) as f32 - 0.5);
        obj += &format!("v {} {} {}\n", at(0), at(1), at(2));
    }
    obj += "f 1 3 4 2\nf 5 6 8 7\nf 1 2 6 5\nf 3 7 8 4\nf 1 5 7 3\nf 2 4 8 6\n";
    read_obj_bytes("box.obj", obj.into_bytes(), Path::new(""))
}

/// Where the corners appear, in tangents relative to the shorter side of the view.
fn seen(document: &Document, size: [f32; 3], middle: [f32; 3]) -> Vec<[f32; 2]> {
    let camera = document.camera.as_ref().expect("a camera");
    let camera_from_world = camera.world_from_camera.start.inverse();
    let half = (super::FOV.to_radians() / 2.0).tan();
    let corner = |i: usize| {
        let at = |axis: usize| middle[axis] + size[axis] * (((i >> axis) & 1) as f32 - 0.5);
        let p = camera_from_world.point(Point3::new(at(0), at(1), at(2)));
        assert!(p.z > 0.0, "before the camera");
        [p.x / p.z / half, p.y / p.z / half]
    };
    (0..8).map(corner).collect()
}

/// Whatever its size and place, a body is seen whole, fills much of the view, and stands between ground and lamp.
#[test]
fn bodies_fill_the_view() {
    let check = |size: [f32; 3], middle: [f32; 3]| {
        let (document, diagnostics) = cuboid(size, middle);
        assert!(diagnostics.list().is_empty(), "{:?}", diagnostics.list());
        let film = document.film.as_ref().expect("a film");
        let side = |name: &str| match film.parameters.iter().find(|p| p.name == name).expect("a size").value {
            Value::Integers(ref n) => n[0] as f32,
            _ => panic!("a size is a number"),
        };
        let (w, h) = (side("xresolution"), side("yresolution"));
        let limits = [(w / h).max(1.0), (h / w).max(1.0)];
        let seen = seen(&document, size, middle);
        let fill = |axis: usize| seen.iter().map(|p| p[axis].abs() / limits[axis]).fold(0.0, f32::max);
        assert!(fill(0) < 1.0 && fill(1) < 1.0, "{size:?}: {} {}", fill(0), fill(1));
        assert!(fill(0).max(fill(1)) > 0.75, "{size:?}: {} {}", fill(0), fill(1));
        // Body, lamp and ground.
        assert_eq!((document.shapes.len(), document.lights.len()), (3, 1));
    };
    check([1.0, 1.0, 1.0], [0.0, 0.0, 0.0]);
    check([1.0, 3.0, 1.0], [0.0, 1.5, 0.0]);
    check([9.0, 1.0, 2.0], [3.0, 0.0, 0.0]);
    check([1e-4, 1e-4, 1e-4], [0.0, 0.0, 0.0]);
    check([1e6, 1e6, 1e6], [1e7, 0.0, -1e7]);
    check([1.0, 1.0, 1.0], [1000.0, -2000.0, 500.0]);
}

/// +y is up, but for what is flat in z, or stands on z = 0.
#[test]
fn up() {
    let up = |size: [f32; 3], middle: [f32; 3]| {
        let (document, _) = cuboid(size, middle);
        let up =
            document.camera.expect("a camera").world_from_camera.start.vector(Vector3::new(0.0, 1.0, 0.0));
        if up.y > up.z { 'y' } else { 'z' }
    };
    assert_eq!(up([1.0, 1.0, 1.0], [0.0; 3]), 'y');
    assert_eq!(up([1.0, 2.0, 1.0], [0.0, 1.0, 0.0]), 'y');
    assert_eq!(up([1.0, 1.0, 2.0], [0.0, 0.0, 1.0]), 'z');
    assert_eq!(up([5.0, 5.0, 1.0], [0.0; 3]), 'z');
    assert_eq!(up([5.0, 1.0, 5.0], [0.0, 0.0, 2.5]), 'y');
}

/// Nothing to look at is an error, not a picture of nothing.
#[test]
fn nothing() {
    for obj in ["", "v 0 0 0\nf 1 1 1\n", "v 1 2 3\n"] {
        let (_, diagnostics) = read_obj_bytes("a.obj", obj.into(), Path::new(""));
        assert!(diagnostics.list().iter().any(|d| d.message.contains("nothing to look at")), "{obj}");
    }
}
