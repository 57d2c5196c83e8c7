use std::io::BufReader;

use etendue_image::tonemap::Dither;
use etendue_image::{Image, pq_encode};

use crate::images::{DisplayPng, read_image, write_display_png};

fn written(image: &Image, display: DisplayPng) -> (Vec<u8>, Image) {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let path = folder.path().join("a.png");
    write_display_png(&path, image, display).expect("written");
    (std::fs::read(&path).expect("read"), read_image(&path).expect("a PNG"))
}

fn code_points(bytes: &[u8]) -> Option<[u8; 4]> {
    let at = bytes.windows(4).position(|w| w == b"cICP")?;
    let data = bytes.windows(4).position(|w| w == b"IDAT")?;
    (at < data).then(|| bytes[at + 4..at + 8].try_into().expect("four bytes"))
}

/// Display P3 has the curve of sRGB in eight bits and tells its primaries, also to readers of the older chunk.
#[test]
fn display_p3() {
    let image = Image::rgb(2, 1, vec![[1.0, 0.0, 0.5], [2.0, f32::NAN, -1.0]]);
    let (bytes, read) = written(&image, DisplayPng::P3(Dither::None));
    assert_eq!(code_points(&bytes), Some([12, 13, 0, 1]));
    assert!(bytes.windows(4).any(|w| w == b"cHRM"));
    let pixels = read.rgb_pixels().expect("colour");
    assert!((pixels[0][2] - 0.5).abs() < 0.005 && pixels[0][0] == 1.0 && pixels[1] == [1.0, 0.0, 0.0]);
    assert!(read.metadata["chromaticities"].starts_with("0.68 0.32 0.265 0.69"));
}

/// PQ has sixteen bits of the luminances that they stand for.
#[test]
fn rec_2100_pq() {
    let image = Image::rgb(3, 1, vec![[1.0, 0.0, 0.1], [1e6, 0.5, 0.5], [f32::NAN, -1.0, 5.0]]);
    let (bytes, read) = written(&image, DisplayPng::Pq { white_luminance: 200.0 });
    let luminances: Vec<f32> =
        read.rgb_pixels().expect("colour").iter().flatten().map(|v| v * 203.0).collect();
    for (read, written) in
        luminances.into_iter().zip([200.0, 0.0, 20.0, 10_000.0, 100.0, 100.0, 0.0, 0.0, 1000.0])
    {
        assert!((read - written).abs() <= 2e-3 * written, "{read} {written}");
    }
    assert_eq!(read.metadata["whiteLuminance"], "203");
    assert!(read.metadata["chromaticities"].starts_with("0.708 0.292 0.17 0.797"));
    assert_eq!(code_points(&bytes), Some([9, 16, 0, 1]));
    let mut reader =
        png::Decoder::new(BufReader::new(std::io::Cursor::new(bytes))).read_info().expect("a PNG");
    let mut data = vec![0; reader.output_buffer_size().expect("a size")];
    let info = reader.next_frame(&mut data).expect("pixels");
    assert_eq!(info.bit_depth, png::BitDepth::Sixteen);
    let codes: Vec<u16> = data.chunks(2).map(|b| u16::from_be_bytes([b[0], b[1]])).collect();
    let code = |luminance: f32| (pq_encode(luminance) * 65535.0).round() as u16;
    assert_eq!(codes, [200.0, 0.0, 20.0, 1e9, 100.0, 100.0, 0.0, 0.0, 1000.0].map(code));
}
