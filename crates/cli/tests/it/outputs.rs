//! Files that a render writes.

use std::io::Write;

use etendue::image::srgb_encode;
use flate2::Compression;
use flate2::write::GzEncoder;

use crate::support::{Folder, ROOM, assert_same, mean, scene};

/// Every format comes from one render and shows the same picture, as far as it can.
#[test]
fn formats() {
    let folder = Folder::with_scene(ROOM);
    folder.run("render scene.pbrt -q -o a.exr -o a.png -o a.ppm -o a.pfm -o a.hdr --spp 8").expect(0);
    let exact = folder.image("a.exr").rgb_pixels().expect("colour");
    let largest = exact.iter().flatten().copied().fold(0.0, f32::max);
    for (name, tolerance) in [("a.pfm", 0.0), ("a.hdr", largest / 128.0), ("a.png", 0.02), ("a.ppm", 0.02)] {
        let image = folder.image(name);
        assert_eq!((image.width, image.height), (40, 24), "{name}");
        let shown = image.rgb_pixels().expect("colour");
        let is_clipped = tolerance == 0.02;
        for (a, b) in exact.iter().flatten().zip(shown.iter().flatten()) {
            let a = if is_clipped { a.clamp(0.0, 1.0) } else { *a };
            assert!((a - b).abs() <= tolerance, "{name}: {a} became {b}");
        }
    }
    // The integer formats hold the same bytes, rounded.
    let png = folder.image("a.png").rgb_pixels().expect("colour");
    for (a, b) in exact.iter().flatten().zip(png.iter().flatten()) {
        let byte = |v: f32| srgb_encode(v.clamp(0.0, 1.0)) * 255.0;
        assert!((byte(*a) - byte(*b)).abs() <= 0.501, "{a} became {b}");
    }
    assert_eq!(png, folder.image("a.ppm").rgb_pixels().expect("colour"));
}

/// Extensions may be written in capitals.
#[test]
fn capital_extensions() {
    let folder = Folder::with_scene(ROOM);
    folder.run("render scene.pbrt -q -o A.EXR -o A.PNG --spp 1").expect(0);
    assert_eq!(folder.files(), ["A.EXR", "A.PNG", "scene.pbrt"]);
    assert_eq!(folder.image("A.EXR").width, 40);
}

/// Without `-o`, the film's name in the current folder.
#[test]
fn default_names() {
    let folder = Folder::with_scene(ROOM);
    folder.run("render scene.pbrt -q --spp 1").expect(0);
    assert_eq!(folder.files(), ["room.exr", "scene.pbrt"]);

    std::fs::create_dir(folder.path("scenes")).expect("made");
    folder.write("scenes/b.pbrt", ROOM.replace("room.exr", "somewhere/picture.png"));
    folder.run("render scenes/b.pbrt -q --spp 1").expect(0);
    assert_eq!(folder.files(), ["picture.png", "room.exr", "scene.pbrt", "scenes"]);
    assert_eq!(folder.image("picture.png").width, 40);

    folder.write("c.pbrt", ROOM.replace("room.exr", "picture.jpg"));
    folder.run("render c.pbrt --spp 1").expect(0).says("picture.jpg").says("picture.exr");
    assert_eq!(folder.image("picture.exr").width, 40);

    // pbrt's name where the film gives none.
    let plain = Folder::with_scene(&scene("", ""));
    plain.run("render scene.pbrt -q").expect(0);
    assert_eq!(plain.files(), ["pbrt.exr", "scene.pbrt"]);
}

/// A finished file replaces an older one; a scene that fails leaves it.
#[test]
fn older_files() {
    let folder = Folder::with_scene(ROOM);
    folder.write("a.exr", "older");
    folder.write("bad.pbrt", "Nonsense");
    folder.run("render bad.pbrt -o a.exr").expect(2);
    assert_eq!(folder.read("a.exr"), b"older");
    assert_eq!(folder.render("a", "--spp 1").width, 40);
}

/// A gzipped scene is the same scene.
#[test]
fn gzipped_scenes() {
    let folder = Folder::with_scene(ROOM);
    let mut encoder = GzEncoder::new(Vec::new(), Compression::default());
    encoder.write_all(ROOM.as_bytes()).expect("compressed");
    folder.write("scene.pbrt.gz", encoder.finish().expect("compressed"));
    let plain = folder.render("plain", "--spp 2");
    folder.run("render scene.pbrt.gz -q -o packed.exr --spp 2").expect(0);
    assert_same(&plain, &folder.image("packed.exr"));
    folder.run("info scene.pbrt.gz --json").expect(0).json();
}

/// A file says how it was made.
#[test]
fn metadata() {
    let folder = Folder::with_scene(ROOM);
    let image = folder.render("a", "--spp 3 --seed 7 --integrator path:maxdepth=2");
    let metadata = &image.metadata;
    for (key, value) in [
        ("software", concat!("etendue ", env!("CARGO_PKG_VERSION"))),
        ("etendue.scene", "scene.pbrt"),
        ("etendue.seed", "7"),
        ("etendue.passes", "0..3"),
        ("etendue.spp", "3"),
        ("etendue.integrator", "path:maxdepth=2"),
        ("etendue.resolution", "40 24"),
        ("etendue.pixels", "0 40 0 24"),
        ("etendue.colorspace", "srgb"),
    ] {
        assert_eq!(metadata.get(key).map(String::as_str), Some(value), "{key}");
    }
    assert!(metadata["etendue.unit"].contains("cd/m^2"));
    assert_eq!(metadata["etendue.world_from_camera"].split(' ').count(), 16);
    assert_eq!(metadata["etendue.fingerprint"].len(), 16);
}

/// Layers by path expression are channels, and those of a partition add up to the picture.
#[test]
fn layers() {
    let folder = Folder::with_scene(ROOM);
    let image = folder.render("a", "--spp 4 --lpe direct=L.?E --lpe rest=L..+E");
    let pixels = image.rgb_pixels().expect("colour");
    for (index, channel) in ["R", "G", "B"].iter().enumerate() {
        let layer = |name: &str| &image.channel(&format!("{name}.{channel}")).expect("a channel").values;
        for (pixel, (a, b)) in pixels.iter().zip(layer("direct").iter().zip(layer("rest"))) {
            assert!(
                (pixel[index] - a - b).abs() <= 1e-4 * pixel[index].max(1e-3),
                "{} {a} {b}",
                pixel[index]
            );
        }
    }
}

/// Layers by the number of bounces, up to that of the integrator.
#[test]
fn bounces() {
    let folder = Folder::with_scene(ROOM);
    let image = folder.render("a", "--spp 4 --bounces 4");
    let sum: f64 = (0..=4)
        .map(|k| {
            let layer = |c: &str| &image.channel(&format!("bounce{k}.{c}")).expect("a channel").values;
            ["R", "G", "B"].map(|c| layer(c).iter().map(|v| f64::from(*v)).sum::<f64>()).iter().sum::<f64>()
        })
        .sum();
    let whole = mean(&image) * 3.0 * 40.0 * 24.0;
    assert!((sum - whole).abs() < 1e-5 * whole, "{sum} {whole}");
    assert!(image.channel("bounce5.R").is_none());
}

/// A picture by one wavelength has the same mean, within its noise, and other bits.
#[test]
fn wavelengths() {
    let folder = Folder::with_scene(ROOM);
    let hero = folder.render("hero", "--spp 64");
    let single = folder.render("single", "--spp 64 --wavelengths single");
    let (a, b) = (mean(&hero), mean(&single));
    assert!(a != b && (a - b).abs() < 0.1 * a, "{a} {b}");
}

/// `--resolution` keeps the view; `--crop` takes a part of it.
#[test]
fn resolution_and_crop() {
    let folder = Folder::with_scene(ROOM);
    let image = folder.render("a", "--resolution 20x12 --spp 1");
    assert_eq!((image.width, image.height), (20, 12));
    let part = folder.render("b", "--resolution 20x12 --crop 0.25,0.75,0,0.5 --spp 1");
    assert_eq!((part.width, part.height), (10, 6));
    assert_eq!(part.metadata["etendue.pixels"], "5 15 0 6");
}

/// Success is silent with `--quiet`, and tells of files and speed without.
#[test]
fn quiet() {
    let folder = Folder::with_scene(&scene("Integrator \"bdpt\"", "Shape \"sphere\" \"float raduis\" 2"));
    for arguments in ["-q", "--quiet", "-q --checkpoint c --resume", "-q --stats s.json"] {
        let run = folder.run(&format!("render scene.pbrt -o a.exr {arguments}")).expect(0);
        assert_eq!((run.stdout.as_str(), run.stderr.as_str()), ("", ""), "{arguments}");
    }
    let run = folder.run("render scene.pbrt -o a.exr").expect(0).says("a.exr: 1 sample per pixel in ");
    assert_eq!(run.stdout, "");
    let run = folder.run("render none.pbrt -q").expect(2);
    assert!(run.stderr.contains("none.pbrt"));
}

/// A render does not depend on anybody reading its messages.
#[cfg(target_os = "linux")]
#[test]
fn full_standard_error() {
    let folder = Folder::with_scene(&scene("Integrator \"bdpt\"", "Shape \"sphere\""));
    let full = std::fs::File::options().write(true).open("/dev/full").expect("the device is there");
    let status = folder.command(&["render", "scene.pbrt", "-o", "a.exr"]).stderr(full).status();
    assert_eq!(status.expect("the program runs").code(), Some(0));
    assert_eq!(folder.image("a.exr").width, 8);
    let full = std::fs::File::options().write(true).open("/dev/full").expect("the device is there");
    let status = folder.command(&["render", "none.pbrt"]).stderr(full).status();
    assert_eq!(status.expect("the program runs").code(), Some(2));
}
