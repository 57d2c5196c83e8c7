use std::fs;
use std::io::{self, Write};
use std::path::{Path, PathBuf};

use etendue_image::tonemap::{Dither, Quantization};
use etendue_image::{Chromaticities, Encoding, Image, TexelData, Texels};
use exr::prelude::{
    AnyChannel, AnyChannels, Blocks, Compression, FlatSamples, Layer, LayerAttributes, LineOrder,
    WritableImage,
};
use half::f16;
use image::{DynamicImage, ImageFormat};

use super::{
    ImageError, ImageErrorCause as Cause, read_image, read_texels, write_atomically, write_image, write_png,
    write_ppm, write_ppm_ascii,
};

/// A folder of its own for one test.
struct Folder(tempfile::TempDir);

impl Folder {
    fn new() -> Folder {
        Folder(tempfile::tempdir().expect("a temporary folder"))
    }

    fn path(&self, name: &str) -> PathBuf {
        self.0.path().join(name)
    }

    fn put(&self, name: &str, bytes: &[u8]) -> PathBuf {
        let path = self.path(name);
        fs::write(&path, bytes).expect("a writable folder");
        path
    }

    fn names(&self) -> Vec<String> {
        let entries = fs::read_dir(self.0.path())
            .expect("the folder")
            .map(|entry| entry.expect("an entry").file_name());
        let mut names: Vec<String> = entries.map(|name| name.to_string_lossy().into_owned()).collect();
        names.sort();
        names
    }
}

/// Floats that a careless format would change: denormal, huge, negative, negative zero.
fn awkward_pixels(width: usize, height: usize) -> Image {
    let special = [1e-40, 3.0e38, -2.5, -0.0, 1.0 / 3.0, f32::INFINITY, 65504.0, 1e-8];
    Image::from_fn(width, height, |x, y| [special[(x + 3 * y) % 8], x as f32 / 7.0, y as f32 * 1.1])
}

/// Byte-valued pixels in linear light, exact for 8-bit formats.
fn byte_pixels(width: usize, height: usize) -> Image {
    Image::from_fn(width, height, |x, y| {
        [x * 37 % 256, y * 51 % 256, (x * y + 128) % 256]
            .map(|byte| Encoding::Srgb.decode(byte as f32 / 255.0))
    })
}

fn bits(image: &Image) -> Vec<(String, Vec<u32>)> {
    let plane = |channel: &etendue_image::Channel| {
        (channel.name.clone(), channel.values.iter().map(|value| value.to_bits()).collect())
    };
    image.channels.iter().map(plane).collect()
}

#[track_caller]
fn fails<T: std::fmt::Debug>(
    result: Result<T, ImageError>,
    path: &Path,
    matches: impl Fn(&Cause) -> bool,
) -> String {
    let error = result.expect_err("this must fail");
    assert_eq!(error.path, path);
    assert!(matches(&error.cause), "{:?}", error.cause);
    let message = error.to_string();
    assert!(message.starts_with(&path.display().to_string()), "{message}");
    message
}

/// Encoded bytes of a picture by the `image` crate.
fn encoded(picture: &DynamicImage, format: ImageFormat) -> Vec<u8> {
    let mut bytes = io::Cursor::new(Vec::new());
    picture.write_to(&mut bytes, format).expect("a format that can be written");
    bytes.into_inner()
}

fn rgb8(width: u32, height: u32) -> DynamicImage {
    DynamicImage::ImageRgb8(image::RgbImage::from_fn(width, height, |x, y| {
        image::Rgb([(x * 31 % 256) as u8, (y * 17 % 256) as u8, ((x + y) * 5 % 256) as u8])
    }))
}

// Radiance that was written is the radiance that is read, bit by bit, in formats of floats.

#[test]
fn exr_round_trip_is_exact() {
    let folder = Folder::new();
    let mut image = awkward_pixels(37, 19);
    image.set_channel("A", vec![0.5; 37 * 19]);
    image.set_rgb("direct", &vec![[1.5, 2.5, 3.5]; 37 * 19]);
    image.set_channel("variance.Y", (0..37 * 19).map(|i| i as f32).collect());
    image.metadata.insert("integrator".to_owned(), "path, depth ≤ 5".to_owned());
    image.metadata.insert("comments".to_owned(), "glass and water".to_owned());
    image.metadata.insert("compression".to_owned(), "a reserved name".to_owned());
    let path = folder.path("image.exr");
    write_image(&path, &image).expect("a writable image");
    let back = read_image(&path).expect("a readable image");
    assert_eq!(bits(&back), bits(&image));
    assert_eq!(back.metadata, image.metadata);
    assert_eq!(folder.names(), ["image.exr"]);
}

#[test]
fn pfm_round_trip_is_exact() {
    let folder = Folder::new();
    let path = folder.path("colour.pfm");
    let image = awkward_pixels(5, 4);
    write_image(&path, &image).expect("a writable image");
    assert_eq!(bits(&read_image(&path).expect("a readable image")), bits(&image));
    let gray = Image::gray(3, 2, vec![1.0, -2.0, 3.5, 1e-42, 5.0, 6.0]);
    write_image(&path, &gray).expect("a writable image");
    assert_eq!(read_image(&path).expect("a readable image"), gray);
}

#[test]
fn exr_keeps_float_width() {
    let folder = Folder::new();
    let path = folder.path("texture.exr");
    write_image(&path, &awkward_pixels(4, 4)).expect("a writable image");
    let texels = read_texels(&path).expect("a readable texture");
    assert!(matches!(texels.data(), TexelData::F32(_)));
    assert_eq!((texels.n_channels(), texels.texel(1, 0, 0)), (3, 3.0e38));
    assert_eq!(texels.color_space, Some(Chromaticities::REC709));
}

/// A Radiance file holds 8 bits of mantissa: dyadic values survive, others are rounded to nearest, none is biased.
#[test]
fn hdr_round_trip() {
    let folder = Folder::new();
    let path = folder.path("image.hdr");
    let exact = Image::from_fn(11, 3, |x, y| [x as f32 * 0.25, 2f32.powi(y as i32 * 20 - 20), 0.0]);
    let exact = Image::rgb(
        11,
        3,
        exact.rgb_pixels().expect("colour").into_iter().map(|p| [p[1], p[1] * 0.5, 0.0]).collect(),
    );
    write_image(&path, &exact).expect("a writable image");
    assert_eq!(read_image(&path).expect("a readable image"), exact);
    let ramp = Image::from_fn(256, 4, |x, y| [0.5 + ((x + 256 * y) as f32 + 0.5) / 2048.0; 3]);
    write_image(&path, &ramp).expect("a writable image");
    let back = read_image(&path).expect("a readable image");
    let ratio =
        |i: usize| f64::from(back.channels[0].values[i]) / f64::from(ramp.channels[0].values[i]) - 1.0;
    assert!((0..1024).all(|i| ratio(i).abs() <= 0.5 / 128.0));
    assert!(((0..1024).map(ratio).sum::<f64>() / 1024.0).abs() < 2e-4);
}

/// NaN and negative radiance have no place in a Radiance file.
#[test]
fn hdr_of_impossible_values() {
    let folder = Folder::new();
    let path = folder.path("image.hdr");
    let image = Image::rgb(2, 1, vec![[f32::NAN, -1.0, 1.0], [f32::INFINITY, 1.0, 0.0]]);
    write_image(&path, &image).expect("a writable image");
    let pixels = read_image(&path).expect("a readable image").rgb_pixels().expect("colour");
    assert_eq!(pixels[0], [0.0, 0.0, 1.0]);
    assert!(pixels[1][0] > 1e37 && pixels[1][0].is_finite());
}

/// What is exactly a byte comes back exactly from 8-bit files.
#[test]
fn png_and_ppm_round_trip() {
    let folder = Folder::new();
    let image = byte_pixels(13, 9);
    for name in ["image.png", "image.ppm"] {
        let path = folder.path(name);
        write_image(&path, &image).expect("a writable image");
        assert!(matches!(read_texels(&path).expect("a readable texture").data(), TexelData::U8(_)));
        assert_eq!(read_image(&path).expect("a readable image"), image, "{name}");
    }
    let path = folder.path("text.ppm");
    write_ppm_ascii(&path, &image, Quantization::default()).expect("a writable image");
    assert_eq!(read_image(&path).expect("a readable image"), image);
}

/// A display cannot show less than nothing or more than everything.
#[test]
fn integer_formats_clip() {
    let folder = Folder::new();
    let path = folder.path("clip.png");
    write_image(&path, &Image::rgb(1, 1, vec![[-3.0, 70.0, f32::NAN]])).expect("a writable image");
    assert_eq!(*read_texels(&path).expect("a readable texture").data(), TexelData::U8(vec![0, 255, 0]));
    let quantization = Quantization { encoding: Encoding::Linear, dither: Dither::Ordered };
    write_png(&path, &Image::rgb(1, 1, vec![[0.0, 1.0, 0.2]]), quantization).expect("a writable image");
    assert_eq!(*read_texels(&path).expect("a readable texture").data(), TexelData::U8(vec![0, 255, 51]));
}

/// The bytes of a pixmap are fixed by its definition.
#[test]
fn ppm_is_byte_exact() {
    let folder = Folder::new();
    let image = Image::rgb(2, 1, vec![[1.0, 0.0, 0.5], [2.0, -1.0, 0.2]]);
    let linear = Quantization { encoding: Encoding::Linear, dither: Dither::None };
    let path = folder.path("image.ppm");
    write_ppm(&path, &image, linear).expect("a writable image");
    assert_eq!(fs::read(&path).expect("the file"), b"P6\n2 1\n255\n\xff\x00\x80\xff\x00\x33");
    write_ppm_ascii(&path, &image, linear).expect("a writable image");
    assert_eq!(fs::read(&path).expect("the file"), b"P3\n2 1\n255\n255 0 128\n255 0 51\n");
}

/// Comments, other maxima and two-byte values are allowed in a pixmap.
#[test]
fn ppm_variants() {
    let folder = Folder::new();
    let text = folder.put("text.ppm", b"P3 # by hand\n1\t1 # size\n 15\n15 0  5");
    let expected = TexelData::U16(vec![65535, 0, 21845]);
    assert_eq!(*read_texels(text).expect("a readable texture").data(), expected);
    let wide = folder.put("wide.ppm", b"P6 1 1 65535\n\x12\x34\xff\xff\x00\x01");
    assert_eq!(
        *read_texels(wide).expect("a readable texture").data(),
        TexelData::U16(vec![0x1234, 0xffff, 1])
    );
    let above = folder.put("above.ppm", b"P3 1 1 15 16 0 0");
    fails(read_texels(&above), &above, |cause| matches!(cause, Cause::Malformed(_)));
    let short = folder.put("short.ppm", b"P6 9 9 255\n\x00\x00");
    fails(read_texels(&short), &short, |cause| matches!(cause, Cause::Truncated(_)));
}

/// Some programs write the other byte order, and all of them write the bottom row first.
#[test]
fn big_endian_pfm() {
    let folder = Folder::new();
    let mut bytes = b"Pf\n2 2\n1.0\n".to_vec();
    [3.0f32, 4.0, 1.0, 2.0].iter().for_each(|value| bytes.extend(value.to_be_bytes()));
    let path = folder.put("big.pfm", &bytes);
    assert_eq!(read_image(&path).expect("a readable image"), Image::gray(2, 2, vec![1.0, 2.0, 3.0, 4.0]));
    let mut bytes = b"PF 1 1 -2.0\n".to_vec();
    [3.0f32, 4.0, 1.0].iter().for_each(|value| bytes.extend(value.to_le_bytes()));
    let path = folder.put("scaled.pfm", &bytes);
    assert_eq!(read_image(&path).expect("a readable image").rgb_pixels(), Some(vec![[6.0, 8.0, 2.0]]));
}

/// Sixteen bits of a height field matter: each of them is kept.
#[test]
fn wide_png_is_lossless() {
    let folder = Folder::new();
    let values: Vec<u16> = (0..=65535u16).collect();
    let wide = image::ImageBuffer::from_raw(256, 256, values.clone()).expect("256 x 256 values");
    let path = folder.put("wide.png", &encoded(&DynamicImage::ImageLuma16(wide), ImageFormat::Png));
    assert_eq!(
        read_texels(&path).expect("a readable texture"),
        Texels::new(256, 256, 1, TexelData::U16(values))
    );
}

/// Channels, alpha and rows arrive where they belong from every lossless 8-bit format.
#[test]
fn integer_formats_are_read() {
    let folder = Folder::new();
    let picture = rgb8(20, 10);
    let expected = Texels::new(20, 10, 3, TexelData::U8(picture.as_bytes().to_vec()));
    let rgba = DynamicImage::ImageRgba8(picture.to_rgba8());
    for (format, name) in
        [(ImageFormat::Png, "a.png"), (ImageFormat::Tga, "a.tga"), (ImageFormat::Qoi, "a.qoi")]
    {
        let path = folder.put(name, &encoded(&picture, format));
        assert_eq!(read_texels(&path).expect("a readable texture"), expected, "{name}");
        let path = folder.put(name, &encoded(&rgba, format));
        let texels = read_texels(&path).expect("a readable texture");
        assert_eq!(
            (texels.n_channels(), texels.alpha(3, 3), texels.texel(7, 9, 2)),
            (4, 1.0, 80.0 / 255.0),
            "{name}"
        );
    }
    let path = folder.put("a.jpg", &encoded(&rgb8(16, 16), ImageFormat::Jpeg));
    let texels = read_texels(&path).expect("a readable texture");
    assert_eq!((texels.width(), texels.height(), texels.n_channels()), (16, 16, 3));
    let gray = DynamicImage::ImageLuma8(picture.to_luma8());
    let path = folder.put("gray.png", &encoded(&gray, ImageFormat::Png));
    assert_eq!(read_image(&path).expect("a readable image").channels[0].name, "Y");
}

/// Decoders of JPEG show what is missing in grey, without a word.
#[test]
fn jpegs_without_their_end_are_refused() {
    let folder = Folder::new();
    let whole = encoded(&rgb8(64, 48), ImageFormat::Jpeg);
    let path = folder.put("a.jpg", &whole);
    assert!(read_image(&path).is_ok());
    for quarters in 1..4 {
        let path = folder.put("cut.jpg", &whole[..whole.len() * quarters / 4]);
        let message = fails(read_image(&path), &path, |cause| matches!(cause, Cause::Truncated(_)));
        assert!(message.contains("cut.jpg"), "{message}");
        fails(read_texels(&path), &path, |cause| matches!(cause, Cause::Truncated(_)));
    }
    let with_rest = [&whole, &b"what cameras append"[..]].concat();
    assert!(read_image(folder.put("rest.jpg", &with_rest)).is_ok());
}

/// The contents decide, not the name.
#[test]
fn contents_win_over_extension() {
    let folder = Folder::new();
    let png = encoded(&rgb8(3, 3), ImageFormat::Png);
    assert_eq!(read_texels(folder.put("picture.jpg", &png)).expect("a readable texture").width(), 3);
    assert_eq!(read_texels(folder.put("picture", &png)).expect("a readable texture").width(), 3);
}

/// Half-float textures stay halves, whatever packed them; lossy ways come close.
#[test]
fn exr_compressions() {
    let folder = Folder::new();
    let ways = [
        (Compression::Uncompressed, true),
        (Compression::RLE, true),
        (Compression::ZIP1, true),
        (Compression::ZIP16, true),
        (Compression::PIZ, true),
        (Compression::PXR24, true),
        (Compression::B44, false),
        (Compression::B44A, false),
    ];
    let value = |x: usize, y: usize, c: usize| f16::from_f32(1.0 + (x + 2 * y) as f32 / 64.0 + c as f32);
    for (compression, is_lossless) in ways {
        for blocks in [Blocks::ScanLines, Blocks::Tiles(exr::math::Vec2(16, 8))] {
            let channel = |(c, name): (usize, &str)| {
                let samples = (0..33 * 21).map(|i| value(i % 33, i / 33, c)).collect();
                AnyChannel::new(name, FlatSamples::F16(samples))
            };
            let channels =
                AnyChannels::sort(["R", "G", "B", "A"].into_iter().enumerate().map(channel).collect());
            let encoding = exr::prelude::Encoding { compression, blocks, line_order: LineOrder::Increasing };
            let layer = Layer::new((33, 21), LayerAttributes::named("beauty"), encoding, channels);
            let path = folder.path("half.exr");
            exr::prelude::Image::from_layer(layer).write().to_file(&path).expect("a writable image");
            let texels = read_texels(&path).expect("a readable texture");
            assert!(matches!(texels.data(), TexelData::F16(_)), "{compression:?}");
            assert_eq!(texels.n_channels(), 4);
            let worst = (0..33 * 21 * 4).map(|i| (i % 33, i / 33 % 21, i / 693));
            let error =
                |(x, y, c): (usize, usize, usize)| (texels.texel(x, y, c) - value(x, y, c).to_f32()).abs();
            let worst = worst.map(error).fold(0.0, f32::max);
            assert!(if is_lossless { worst == 0.0 } else { worst < 0.1 }, "{compression:?}: {worst}");
        }
    }
}

/// Parts with names become layers; integers become floats; parts of different size meet in the display window.
#[test]
fn exr_parts() {
    let folder = Folder::new();
    let encoding = exr::prelude::Encoding::FAST_LOSSLESS;
    let part =
        |name: &str, channel: &str, samples: FlatSamples, position: (i32, i32), size: (usize, usize)| {
            let attributes = LayerAttributes::named(name).with_position(position.into());
            let channels = AnyChannels::sort([AnyChannel::new(channel, samples)].into_iter().collect());
            Layer::new(size, attributes, encoding, channels)
        };
    let layers = vec![
        part("id", "object", FlatSamples::U32(vec![1, 2, 3, 70000]), (10, 20), (2, 2)),
        part("depth", "Z", FlatSamples::F32(vec![5.0]), (11, 21), (1, 1)),
    ];
    let display = exr::prelude::IntegerBounds::new((10, 20), (2, 2));
    let attributes = exr::prelude::ImageAttributes::new(display);
    let path = folder.path("parts.exr");
    exr::prelude::Image::from_layers(attributes, layers).write().to_file(&path).expect("a writable image");
    let image = read_image(&path).expect("a readable image");
    assert_eq!((image.width, image.height), (2, 2));
    assert_eq!(image.channel("id.object").map(|c| c.values.clone()), Some(vec![1.0, 2.0, 3.0, 70000.0]));
    assert_eq!(image.channel("depth.Z").map(|c| c.values.clone()), Some(vec![0.0, 0.0, 0.0, 5.0]));
    assert_eq!(read_texels(&path).expect("the only channel of the first part").n_channels(), 1);
}

/// Two small parts in a display window that no memory holds are refused, not placed.
#[test]
fn exr_parts_in_a_huge_window() {
    let folder = Folder::new();
    let part = |name: &str, x: i32| {
        let attributes = LayerAttributes::named(name).with_position((x, 0).into());
        let channel = AnyChannel::new("Z", FlatSamples::F32(vec![5.0]));
        let channels = AnyChannels::sort([channel].into_iter().collect());
        Layer::new((1, 1), attributes, exr::prelude::Encoding::FAST_LOSSLESS, channels)
    };
    let display = exr::prelude::IntegerBounds::new((0, 0), (1 << 20, 1 << 20));
    let attributes = exr::prelude::ImageAttributes::new(display);
    let path = folder.path("huge.exr");
    let image = exr::prelude::Image::from_layers(attributes, vec![part("a", 0), part("b", 7)]);
    image.write().to_file(&path).expect("a writable image");
    fails(read_image(&path), &path, |cause| matches!(cause, Cause::TooLarge { .. }));
}

/// Primaries other than sRGB's travel with a rendered image.
#[test]
fn exr_chromaticities() {
    let folder = Folder::new();
    let path = folder.path("wide.exr");
    let mut image = byte_pixels(2, 2);
    let key = "0.7347 0.2653 0 1 0.0001 -0.077 0.32168 0.33767".to_owned();
    image.metadata.insert("chromaticities".to_owned(), key);
    write_image(&path, &image).expect("a writable image");
    assert_eq!(read_texels(&path).expect("a readable texture").color_space, Some(Chromaticities::ACES2065_1));
    assert_eq!(read_image(&path).expect("a readable image"), image);
}

/// A picture needs a colour or a gray value; the error lists what there is instead.
#[test]
fn no_color() {
    let folder = Folder::new();
    let mut image = Image::new(1, 1);
    image.set_channel("N.X", vec![1.0]);
    image.set_channel("N.Y", vec![0.0]);
    let exr = folder.path("normals.exr");
    write_image(&exr, &image).expect("EXR takes any channel");
    let message = fails(read_texels(&exr), &exr, |cause| matches!(cause, Cause::NoColor { .. }));
    assert!(message.contains("N.X, N.Y"), "{message}");
    for name in ["normals.png", "normals.pfm", "normals.ppm", "normals.hdr"] {
        let path = folder.path(name);
        fails(write_image(&path, &image), &path, |cause| matches!(cause, Cause::NoColor { .. }));
    }
    assert_eq!(folder.names(), ["normals.exr"]);
}

/// A missing file, a folder, an empty file and an unknown kind each say so.
#[test]
fn what_is_not_a_picture() {
    let folder = Folder::new();
    let missing = folder.path("missing.png");
    fails(read_texels(&missing), &missing, |cause| matches!(cause, Cause::NotFound));
    let inside = folder.path("folder.exr");
    fs::create_dir(&inside).expect("a writable folder");
    fails(read_image(&inside), &inside, |cause| matches!(cause, Cause::IsDirectory));
    let empty = folder.put("empty.png", b"");
    fails(read_texels(&empty), &empty, |cause| matches!(cause, Cause::Truncated(_)));
    let text = folder.put("notes.txt", b"not a picture at all");
    fails(read_texels(&text), &text, |cause| matches!(cause, Cause::UnknownFormat { .. }));
    let wrong = folder.put("wrong.exr", b"not a picture at all");
    let message = fails(read_texels(&wrong), &wrong, |cause| matches!(cause, Cause::WrongSignature { .. }));
    assert!(message.contains("`exr`"), "{message}");
}

/// Every kind of file may be cut short by a full disk.
#[test]
fn truncated_files() {
    let folder = Folder::new();
    let image = awkward_pixels(40, 30);
    for name in ["image.exr", "image.pfm", "image.ppm", "image.hdr", "image.png"] {
        let path = folder.path(name);
        write_image(&path, &image).expect("a writable image");
        let whole = fs::read(&path).expect("the file");
        for length in [whole.len() * 3 / 4, whole.len() / 2, 40] {
            fs::write(&path, &whole[..length]).expect("a writable folder");
            fails(read_texels(&path), &path, |cause| {
                matches!(cause, Cause::Truncated(_) | Cause::Malformed(_) | Cause::Unsupported(_))
            });
            fails(read_image(&path), &path, |_| true);
        }
    }
}

#[test]
fn truncation_is_called_so() {
    let folder = Folder::new();
    for name in ["image.exr", "image.png", "image.pfm"] {
        let path = folder.path(name);
        write_image(&path, &awkward_pixels(64, 64)).expect("a writable image");
        let whole = fs::read(&path).expect("the file");
        fs::write(&path, &whole[..whole.len() - 200]).expect("a writable folder");
        fails(read_texels(&path), &path, |cause| matches!(cause, Cause::Truncated(_)));
    }
}

/// A header may claim any size; no memory is taken for what the file cannot hold.
#[test]
fn lying_headers() {
    let folder = Folder::new();
    let huge = [
        ("a.pfm", &b"PF 2000000000 2000000000 -1\n"[..]),
        ("b.pfm", b"PF 99999999999999999999999 1 -1\n"),
        ("c.pfm", b"PF 30000 30000 -1\n"),
        ("d.ppm", b"P6 30000 30000 255\n"),
        ("e.hdr", b"#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 40000 +X 40000\n"),
        ("f.qoi", b"qoif\x00\x00\x9c\x40\x00\x00\x9c\x40\x03\x00\x00\x00\x00"),
    ];
    for (name, bytes) in huge {
        let path = folder.put(name, bytes);
        fails(read_texels(&path), &path, |cause| {
            matches!(cause, Cause::TooLarge { .. } | Cause::Malformed(_) | Cause::Truncated(_))
        });
    }
    let mut png = encoded(&rgb8(4, 4), ImageFormat::Png);
    png[16..24].copy_from_slice(&[0, 1, 0, 0, 0, 1, 0, 0]);
    let path = folder.put("g.png", &png);
    fails(read_texels(&path), &path, |_| true);
}

/// Zero pixels are no picture, neither read nor written.
#[test]
fn zero_size() {
    let folder = Folder::new();
    for (name, bytes) in [("a.pfm", &b"PF 0 4 -1\n"[..]), ("b.ppm", b"P6 3 0 255\n")] {
        let path = folder.put(name, bytes);
        fails(read_texels(&path), &path, |cause| matches!(cause, Cause::Empty));
        fs::remove_file(path).expect("the file");
    }
    for name in ["c.exr", "c.png", "c.ppm", "c.pfm", "c.hdr"] {
        let path = folder.path(name);
        fails(write_image(&path, &Image::rgb(0, 3, Vec::new())), &path, |cause| {
            matches!(cause, Cause::Empty)
        });
        fails(write_image(&path, &Image::new(3, 3)), &path, |cause| matches!(cause, Cause::Empty));
    }
    assert!(folder.names().is_empty());
}

/// A failed write leaves the old file as it was and nothing else.
#[test]
fn failed_writes_leave_no_trace() {
    let folder = Folder::new();
    let path = folder.put("old.png", b"old");
    let failure = |out: &mut io::BufWriter<fs::File>| {
        out.write_all(&[0; 100_000])?;
        Err(io::Error::other("the disk is full"))
    };
    assert!(write_atomically(&path, failure).is_err());
    assert_eq!(fs::read(&path).expect("the old file"), b"old");
    let image = byte_pixels(2, 2);
    let unknown = folder.path("image.xyz");
    let message =
        fails(write_image(&unknown, &image), &unknown, |cause| matches!(cause, Cause::UnknownFormat { .. }));
    assert!(message.contains("xyz"), "{message}");
    let nowhere = folder.path("nowhere/image.png");
    fails(write_image(&nowhere, &image), &nowhere, |cause| matches!(cause, Cause::NotFound));
    let occupied = folder.path("folder.png");
    fs::create_dir(&occupied).expect("a writable folder");
    fails(write_image(&occupied, &image), &occupied, |cause| matches!(cause, Cause::IsDirectory));
    let mut unequal = byte_pixels(2, 2);
    unequal.channels[1].values.pop();
    let path = folder.path("unequal.exr");
    fails(write_image(&path, &unequal), &path, |cause| matches!(cause, Cause::Malformed(_)));
    assert_eq!(folder.names(), ["folder.png", "old.png"]);
    write_image(folder.path("old.png"), &image).expect("an old file is replaced");
    assert_eq!(read_image(folder.path("old.png")).expect("a readable image"), image);
}

/// Bytes changed at random may give another picture or an error, but no panic and no endless work.
#[test]
fn damaged_files_do_not_panic() {
    let folder = Folder::new();
    let image = byte_pixels(24, 16);
    let mut samples = Vec::new();
    for name in ["a.exr", "a.pfm", "a.ppm", "a.hdr", "a.png"] {
        let path = folder.path(name);
        write_image(&path, &image).expect("a writable image");
        samples.push((name, fs::read(&path).expect("the file")));
    }
    samples.push(("a.jpg", encoded(&rgb8(24, 16), ImageFormat::Jpeg)));
    samples.push(("a.tga", encoded(&rgb8(24, 16), ImageFormat::Tga)));
    samples.push(("a.qoi", encoded(&rgb8(24, 16), ImageFormat::Qoi)));
    let mut state = 0x853c_49e6_748f_ea9b_u64;
    let mut random = move |below: usize| {
        state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (state >> 33) as usize % below
    };
    for (name, whole) in &samples {
        for round in 0..60 {
            let mut bytes = whole.clone();
            let head = if round % 2 == 0 { bytes.len() } else { bytes.len().min(80) };
            for _ in 0..=random(4) {
                bytes[random(head)] = random(256) as u8;
            }
            if round % 5 == 0 {
                bytes.truncate(random(bytes.len()));
            }
            let path = folder.put(name, &bytes);
            let texels = read_texels(&path).map(|texels| texels.data().len());
            let planes = read_image(&path).map(|image| image.n_pixels());
            assert!(texels.is_ok() || texels.is_err_and(|error| error.path == path));
            assert!(planes.is_ok() || planes.is_err_and(|error| error.path == path));
        }
    }
}
