//! The auxiliary channels of the `gbuffer` film: what the first surface is like.

use crate::support::{Setup, channel, expect_near, lit, render_passes};

/// A tilted floor under an orthographic camera, so that depth and position are linear over the picture.
fn buffers(space: &str) -> etendue_image::Image {
    let film = format!("\"gbuffer\" \"string coordinatesystem\" \"{space}\"");
    let world = format!(
        "LightSource \"infinite\" {} Material \"diffuse\" \"rgb reflectance\" [0.8 0.4 0.2]
        Shape \"bilinearmesh\" \"point3 P\" [-9 -9 -4.5  9 -9 4.5  -9 9 -4.5  9 9 4.5]",
        lit("L", 1.0)
    );
    let camera = "LookAt 1 2 10  1 2 0  0 1 0 Camera \"orthographic\" \"float screenwindow\" [-1 1 -1 1]";
    let setup = Setup { size: [8, 8], film: &film, camera, world: &world, ..Setup::default() };
    render_passes(&setup.scene("features"), 0..256).develop()
}

/// World space: the floor z = x / 2, seen around (1, 2), with the normal (-1, 0, 2) / sqrt 5.
#[test]
fn features_in_world_space() {
    let image = buffers("world");
    let [p, n, ns] =
        ["P", "N", "Ns"].map(|name| ["X", "Y", "Z"].map(|c| channel(&image, &format!("{name}.{c}"))));
    let depth = channel(&image, "depth.Z");
    for index in 0..64 {
        let (column, row) = ((index % 8) as f64, (index / 8) as f64);
        // The camera's x axis points to -x of the world here.
        let (x, y) = (1.0 - ((column + 0.5) / 4.0 - 1.0), 2.0 - ((row + 0.5) / 4.0 - 1.0));
        assert!((p[0][index] - x).abs() < 0.02 && (p[1][index] - y).abs() < 0.02, "pixel {index}");
        expect_near("z", p[2][index], 0.5 * p[0][index], 1e-4);
        expect_near("depth", depth[index], 10.0 - p[2][index], 1e-5);
        for n in [&n, &ns] {
            let slope = 1.0 / 5.0_f64.sqrt();
            for (c, expected) in [-slope, 0.0, 2.0 * slope].into_iter().enumerate() {
                assert!((n[c][index] - expected).abs() < 1e-5, "normal of pixel {index}");
            }
        }
        assert!((channel(&image, "u")[index] - (p[0][index] + 9.0) / 18.0).abs() < 1e-4);
        assert!((channel(&image, "v")[index] - (p[1][index] + 9.0) / 18.0).abs() < 1e-4);
    }
}

/// Camera space: +z ahead, +y up, +x to the right of the picture.
#[test]
fn features_in_camera_space() {
    let (camera, world) = (buffers("camera"), buffers("world"));
    let values = |image: &etendue_image::Image, name: &str| channel(image, name);
    for index in 0..64 {
        let at = |image: &etendue_image::Image, name: &str| values(image, name)[index];
        assert!((at(&camera, "P.X") - (1.0 - at(&world, "P.X"))).abs() < 1e-5);
        assert!((at(&camera, "P.Y") - (at(&world, "P.Y") - 2.0)).abs() < 1e-5);
        expect_near("z", at(&camera, "P.Z"), 10.0 - at(&world, "P.Z"), 1e-5);
        expect_near("depth", at(&camera, "depth.Z"), at(&camera, "P.Z"), 1e-6);
        assert!((at(&camera, "N.X") + at(&world, "N.X")).abs() < 1e-5);
        assert!((at(&camera, "N.Z") + at(&world, "N.Z")).abs() < 1e-5);
    }
}

/// The albedo of a colour is that colour: reflectance under the white of the output.
#[test]
fn albedo_is_the_colour() {
    let image = buffers("camera");
    for (c, expected) in [("R", 0.8), ("G", 0.4), ("B", 0.2)] {
        let values = channel(&image, &format!("Albedo.{c}"));
        let mean = values.iter().sum::<f64>() / values.len() as f64;
        expect_near(c, mean, expected, 0.02);
    }
}
