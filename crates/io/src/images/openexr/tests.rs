use std::fs;
use std::path::PathBuf;

use etendue_image::Image;

use crate::images::{
    ExrBlocks, ExrNumbers, ExrSettings, ImageErrorCause as Cause, read_exr_info, read_image, write_exr,
};

fn bits(image: &Image) -> Vec<(String, Vec<u32>)> {
    let channel =
        |c: &etendue_image::Channel| (c.name.clone(), c.values.iter().map(|v| v.to_bits()).collect());
    image.channels.iter().map(channel).collect()
}

/// A picture as a renderer makes it, with values that a careless format would change.
fn render(width: usize, height: usize) -> Image {
    let special = [1e-40, 3.0e38, -2.5, -0.0, 1.0 / 3.0, f32::INFINITY, f32::NAN, 1e-8];
    let mut image =
        Image::from_fn(width, height, |x, y| [special[(x + 3 * y) % 8], x as f32 / 7.0, y as f32]);
    let plane = |scale: f32| (0..width * height).map(|i| i as f32 * scale).collect::<Vec<f32>>();
    for name in ["direct.R", "direct.G", "direct.B", "variance.Y", "depth.Z", "P.X", "N.X"] {
        image.set_channel(name, plane(1.1));
    }
    let metadata = [
        ("software", "etendue 0.1.0"),
        ("etendue.seed", "7"),
        ("worldToCamera", "1 0 0 0 0 1 0 0 0 0 1 0 0.5 -2 3 1"),
        ("worldToNDC", "2 0 0 0 0 2 0 0 0 0 1 1 0 0 -0.01 0"),
        ("whiteLuminance", "100"),
        ("dataWindow", "5 -2"),
        ("displayWindow", "0 0 640 480"),
        ("chromaticities", "0.708 0.292 0.17 0.797 0.131 0.046 0.3127 0.329"),
    ];
    image.metadata = metadata.iter().map(|(k, v)| ((*k).to_owned(), (*v).to_owned())).collect();
    image
}

fn folder() -> (tempfile::TempDir, PathBuf) {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let path = folder.path().join("a.exr");
    (folder, path)
}

/// Rows and tiles keep every bit of every channel, and all attributes; sizes that no block divides too.
#[test]
fn rows_and_tiles_keep_all_bits() {
    let (_folder, path) = folder();
    for blocks in [ExrBlocks::Rows, ExrBlocks::Tiles] {
        for (width, height) in [(1, 1), (64, 64), (130, 67)] {
            let image = render(width, height);
            write_exr(&path, &image, ExrSettings { blocks, ..ExrSettings::default() }).expect("written");
            let read = read_image(&path).expect("read");
            assert_eq!((read.width, read.height), (width, height));
            let (mut before, mut after) = (bits(&image), bits(&read));
            before.sort();
            after.sort();
            assert!(before == after, "{blocks:?} {width} x {height}");
            assert_eq!(read.metadata, image.metadata);
        }
    }
}

/// Half precision rounds colours by at most 2^-11 and saturates; what needs all bits keeps them. A second trip changes nothing.
#[test]
fn half_precision() {
    let (_folder, path) = folder();
    let settings = ExrSettings { numbers: ExrNumbers::Half, ..ExrSettings::default() };
    let mut image = render(33, 9);
    write_exr(&path, &image, settings).expect("written");
    let read = read_image(&path).expect("read");
    for name in ["variance.Y", "depth.Z", "P.X"] {
        assert_eq!(read.channel(name), image.channel(name), "{name}");
    }
    for name in ["G", "direct.R", "N.X"] {
        let pairs =
            read.channel(name).expect("there").values.iter().zip(&image.channel(name).expect("there").values);
        assert!(pairs.clone().all(|(a, b)| (a - b).abs() <= b.abs() / 2048.0), "{name}");
        assert!(pairs.clone().any(|(a, b)| a != b), "{name} is rounded");
    }
    let red = &read.channel("R").expect("there").values;
    assert_eq!([red[1], red[2], red[5]], [65504.0, -2.5, f32::INFINITY]);
    assert!(red[6].is_nan() && red[0] == 0.0 && red[3].to_bits() == (-0.0f32).to_bits());
    image = read;
    write_exr(&path, &image, settings).expect("written");
    assert_eq!(bits(&read_image(&path).expect("read")), bits(&image));
}

/// Headers tell windows, blocks and types.
#[test]
fn headers() {
    let (_folder, path) = folder();
    let settings = ExrSettings { numbers: ExrNumbers::Half, blocks: ExrBlocks::Tiles };
    write_exr(&path, &render(130, 67), settings).expect("written");
    let info = read_exr_info(&path).expect("read").expect("OpenEXR");
    let [part] = &info.parts[..] else { panic!("{info:?}") };
    assert_eq!(part.data_window, [5, -2, 130, 67]);
    assert_eq!(part.display_window, [0, 0, 640, 480]);
    assert_eq!(part.blocks, "tiles of 64 x 64");
    let kind = |name: &str| part.channels.iter().find(|c| c.name == name).map(|c| (c.kind, c.sampling));
    assert_eq!(kind("R"), Some(("half", [1, 1])));
    assert_eq!(kind("variance.Y"), Some(("float", [1, 1])));
    let png = path.with_extension("png");
    crate::images::write_image(&png, &render(4, 4)).expect("written");
    assert_eq!(read_exr_info(&png).expect("read"), None);
}

/// Metadata that the format has a place for, but that are not of its type, are kept as text.
#[test]
fn malformed_metadata_is_kept() {
    let (_folder, path) = folder();
    let mut image = render(2, 2);
    let odd = [
        ("worldToCamera", "1 2 3"),
        ("whiteLuminance", "bright"),
        ("dataWindow", "here"),
        ("displayWindow", "0 0 -5 5"),
        ("screenWindowWidth", "wide"),
    ];
    image.metadata = odd.iter().map(|(k, v)| ((*k).to_owned(), (*v).to_owned())).collect();
    write_exr(&path, &image, ExrSettings::default()).expect("written");
    let mut read = read_image(&path).expect("read").metadata;
    // A window of no size is dropped.
    assert_eq!(read.remove("displayWindow"), None);
    image.metadata.remove("displayWindow");
    assert_eq!(read, image.metadata);
}

/// Files cut anywhere are errors, never panics, and a header that declares 60000 x 60000 pixels takes no memory.
#[test]
fn broken_files() {
    let (_folder, path) = folder();
    write_exr(&path, &render(40, 40), ExrSettings::default()).expect("written");
    let whole = fs::read(&path).expect("read");
    for length in (0..whole.len()).step_by(whole.len() / 61) {
        fs::write(&path, &whole[..length]).expect("written");
        assert!(read_image(&path).is_err(), "{length} of {}", whole.len());
    }
    // The data window: four numbers after the name and the type of its attribute.
    let name = b"dataWindow\0box2i\0";
    let at = whole.windows(name.len()).position(|w| w == name).expect("there") + name.len() + 4;
    let mut huge = whole.clone();
    for (i, value) in [0i32, 0, 59_999, 59_999].into_iter().enumerate() {
        huge[at + 4 * i..at + 4 * i + 4].copy_from_slice(&value.to_le_bytes());
    }
    fs::write(&path, &huge).expect("written");
    let error = read_image(&path).expect_err("too large for the file");
    assert!(
        matches!(error.cause, Cause::Malformed(_) | Cause::TooLarge { .. } | Cause::Truncated(_)),
        "{error}"
    );
    // Channels of a type that there is not.
    let name = b"B\0";
    let at = whole.windows(2).position(|w| w == name).expect("there") + 2;
    let mut odd = whole.clone();
    odd[at] = 9;
    fs::write(&path, &odd).expect("written");
    assert!(read_image(&path).is_err());
    assert!(read_exr_info(&path).is_err());
}

/// Flipped bits give an error or a picture, never a panic or a long wait.
#[test]
fn flipped_bits() {
    let (_folder, path) = folder();
    write_exr(&path, &render(20, 20), ExrSettings::default()).expect("written");
    let whole = fs::read(&path).expect("read");
    let mut state = 0x2545_f491_4f6c_dd1d_u64;
    for _ in 0..300 {
        let mut broken = whole.clone();
        for _ in 0..3 {
            state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            let bit = (state >> 33) as usize % (8 * broken.len());
            broken[bit / 8] ^= 1 << (bit % 8);
        }
        fs::write(&path, &broken).expect("written");
        let _ = read_image(&path);
        let _ = read_exr_info(&path);
    }
}

/// Attributes come in one order, though the format asks for none.
#[test]
fn equal_pictures_are_equal_files() {
    let (_folder, path) = folder();
    let image = render(9, 5);
    let bytes: Vec<Vec<u8>> = (0..8)
        .map(|_| {
            write_exr(&path, &image, ExrSettings::default()).expect("written");
            fs::read(&path).expect("read")
        })
        .collect();
    assert!(bytes.iter().all(|other| *other == bytes[0]));
    assert_eq!(read_image(&path).expect("a picture").metadata, image.metadata);
}
