//! What a render records for the denoiser, and what the denoiser makes of it.

use etendue::image::Image;
use etendue::io::images::write_image;

use crate::support::{Folder, ROOM, assert_same, differing_channels, mean};

fn values<'i>(image: &'i Image, name: &str) -> &'i [f32] {
    &image.channel(name).unwrap_or_else(|| panic!("there is no channel {name}")).values
}

fn sum(values: &[f32]) -> f64 {
    values.iter().map(|v| f64::from(*v)).sum()
}

/// Every method records features, variances and halves, and its picture has the same bits as without.
#[test]
fn every_method_records_features() {
    let folder = Folder::with_scene(ROOM);
    for method in [
        "path",
        "photonmap:globalphotons=2000,causticphotons=2000",
        "sppm:photonsperiteration=500",
        "whitted",
        "ao",
        "light",
        "photons:photons=2000",
    ] {
        let plain = folder.render("plain", &format!("--spp 4 --integrator {method}"));
        let image = folder.render("features", &format!("--spp 4 --features --integrator {method}"));
        let known = differing_channels(&plain, &plain);
        let changed: Vec<String> = differing_channels(&plain, &image)
            .into_iter()
            .filter(|name| plain.channel(name).is_some())
            .collect();
        assert_eq!(changed, known, "{method}");
        for name in ["Albedo.R", "depth.Z", "variance.Albedo.R", "variance.depth.Z", "variance.R"] {
            assert!(sum(values(&image, name)) > 0.0, "{method}: {name} is black");
        }
        assert!(values(&image, "Ns.Y").iter().any(|v| v.abs() > 0.5), "{method}");
        // Four samples of equal weight: the picture is the mean of its halves.
        let halves = values(&image, "halfA.G").iter().zip(values(&image, "halfB.G"));
        for ((a, b), whole) in halves.zip(values(&image, "G")) {
            assert!(
                (0.5 * (a + b) - whole).abs() <= 1e-5 * (a.abs() + b.abs() + 1e-6),
                "{method}: {a} {b} {whole}"
            );
        }
    }
}

/// Features of parts of a render add up to those of the whole.
#[test]
fn features_of_parts_add_up() {
    let folder = Folder::with_scene(ROOM);
    let whole = folder.render("whole", "--features --passes 0..12");
    folder.render("a", "--features --passes 0..5");
    folder.render("b", "--features --passes 5..12");
    folder.run("merge a.exr b.exr -o both.exr").expect(0);
    assert_same(&folder.image("both.exr"), &whole);
}

/// The denoised picture is nearer to the truth and as bright; nothing is denoised that was not asked for, and a render can do
/// both at once.
#[test]
fn renders_are_denoised() {
    let folder = Folder::with_scene(ROOM);
    let truth = folder.render("truth", "--spp 512 --seed 1");
    let noisy = folder.render("noisy", "--spp 8 --features --denoise clean.exr");
    let clean = folder.image("clean.exr");
    let error = |image: &Image| -> f64 {
        let (pixels, truth) = (image.rgb_pixels().expect("colour"), truth.rgb_pixels().expect("colour"));
        let pairs = pixels.iter().flatten().zip(truth.iter().flatten());
        pairs.map(|(a, b)| f64::from(a - b).powi(2) / (f64::from(*b).powi(2) + 0.01)).sum()
    };
    assert!(error(&clean) < error(&noisy) / 2.0, "{} of {}", error(&clean), error(&noisy));
    assert!((mean(&clean) / mean(&noisy) - 1.0).abs() < 0.03, "{} of {}", mean(&clean), mean(&noisy));
    assert!(clean.channel("Albedo.R").is_some() && clean.channel("halfA.R").is_none());
    assert!(clean.metadata["etendue.denoised"].contains("Albedo"));

    folder.run("denoise noisy.exr -o again.exr").expect(0).says("Albedo, Ns, depth");
    folder.run("denoise noisy.exr -o one.exr --threads 1 -q").expect(0);
    assert_same(&folder.image("again.exr"), &clean);
    assert_same(&folder.image("one.exr"), &clean);

    let plain = folder.render("plain", "--spp 8");
    assert_eq!(plain.layers(), ["", "variance"]);
    folder
        .run("denoise plain.exr -o p.png")
        .expect(0)
        .says("Albedo, Ns, depth")
        .says("halfA")
        .says("--features");
}

/// Fireflies go, and their energy stays: the mean to five digits.
#[test]
fn fireflies_are_spread() {
    let folder = Folder::new();
    let image =
        Image::from_fn(
            32,
            24,
            |x, y| if (x, y) == (11, 13) { [900.0, 500.0, 10.0] } else { [1.0, 0.5, 0.2] },
        );
    write_image(folder.path("a.exr"), &image).expect("written");
    folder.run("denoise a.exr -o b.exr --fireflies-only").expect(0).says("1 firefly spread");
    let spread = folder.image("b.exr");
    for name in ["R", "G", "B"] {
        let (before, after) = (sum(values(&image, name)), sum(values(&spread, name)));
        assert!((after / before - 1.0).abs() < 1e-5, "{name}: {before} became {after}");
    }
    let largest = values(&spread, "R").iter().copied().fold(0.0, f32::max);
    assert!(largest < 50.0, "{largest}");
}

/// What cannot be denoised is refused with what would help.
#[test]
fn pictures_that_cannot_be_denoised() {
    let folder = Folder::new();
    write_image(folder.path("a.png"), &Image::from_fn(8, 8, |_, _| [0.5; 3])).expect("written");
    let mut mask = Image::new(4, 4);
    mask.set_channel("Z", vec![1.0; 16]);
    write_image(folder.path("z.exr"), &mask).expect("written");
    folder.write("broken.exr", b"\x76\x2f\x31\x01 and no more");
    folder.run("denoise a.png -o b.exr").expect(2).says("a.png").says("--features").says("--fireflies-only");
    folder.run("denoise z.exr -o b.exr").expect(2).says("z.exr").says("R, G, B or Y");
    folder.run("denoise broken.exr -o b.exr").expect(2).says("broken.exr");
    folder.run("denoise none.exr -o b.exr").expect(2).says("none.exr");
    folder.run("denoise a.png -o b.jpg").expect(2).says(".exr");
    folder.run("denoise a.png -o a.png").expect(2).says("a.png");
    assert_eq!(folder.files(), ["a.png", "broken.exr", "z.exr"]);
}

/// Open Image Denoise runs as a program; without it the message tells how to get it.
#[test]
fn open_image_denoise_is_missing() {
    let folder = Folder::with_scene(ROOM);
    folder.render("noisy", "--spp 1");
    let arguments = ["denoise", "noisy.exr", "-o", "b.exr", "--with", "oidn"];
    let output = folder.command(&arguments).env("PATH", folder.path("")).output().expect("it starts");
    let text = String::from_utf8_lossy(&output.stderr).into_owned();
    assert_eq!(output.status.code(), Some(1), "{text}");
    assert!(text.contains("oidnDenoise") && text.contains("PATH"), "{text}");
}

/// A program that stands in for Open Image Denoise gets colour, albedo and normals, and its temporary files go.
#[cfg(unix)]
#[test]
fn open_image_denoise_is_a_program() {
    use std::os::unix::fs::PermissionsExt;

    let folder = Folder::with_scene(ROOM);
    let noisy = folder.render("noisy", "--spp 2 --features");
    std::fs::create_dir_all(folder.path("bin")).expect("made");
    std::fs::create_dir_all(folder.path("tmp")).expect("made");
    let with = |script: &str| {
        folder.write("bin/oidnDenoise", script);
        let executable = std::fs::Permissions::from_mode(0o755);
        std::fs::set_permissions(folder.path("bin/oidnDenoise"), executable).expect("allowed");
        let path = format!("{}:/bin:/usr/bin", folder.path("bin").display());
        let arguments = ["denoise", "noisy.exr", "-o", "b.exr", "--with", "oidn"];
        let mut command = folder.command(&arguments);
        let output = command.env("PATH", path).env("TMPDIR", folder.path("tmp")).output().expect("it starts");
        let left = std::fs::read_dir(folder.path("tmp")).expect("it is there").count();
        assert_eq!(left, 0, "temporary files are left");
        (output.status.code(), String::from_utf8_lossy(&output.stderr).into_owned())
    };
    // $1 --hdr $2 colour $3 --alb $4 albedo $5 --nrm $6 normals $7 -o $8 result: the albedo stands in for the result.
    let (code, text) = with("#!/bin/sh\n[ \"$1$3$5$7\" = --hdr--alb--nrm-o ] && cp \"$4\" \"$8\"\n");
    assert_eq!(code, Some(0), "{text}");
    assert!(text.contains("albedo and normals"), "{text}");
    assert_eq!(values(&folder.image("b.exr"), "R"), values(&noisy, "Albedo.R"));

    let (code, text) = with("#!/bin/sh\necho 'Error: no device' >&2\nexit 3\n");
    assert_eq!(code, Some(1), "{text}");
    assert!(text.contains("no device"), "{text}");
    let (code, text) = with("#!/bin/sh\nexit 0\n");
    assert_eq!(code, Some(1), "{text}");
    assert!(text.contains("left no picture"), "{text}");
}
