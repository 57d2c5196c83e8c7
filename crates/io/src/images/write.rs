//! Writing pictures in the format that the extension names.

use std::io::Write;
use std::path::Path;

use etendue_image::Image;
use etendue_image::tonemap::{Quantization, to_u8};
use image::codecs::hdr::HdrEncoder;
use image::codecs::png::PngEncoder;
use image::{ExtendedColorType, ImageEncoder};

use super::{
    DisplayPng, ExrSettings, ImageError, ImageErrorCause, Outcome, display_png, extension, netpbm, openexr,
    pfm, with_path, write_atomically,
};

/// Writes a picture: `exr` (every channel and the metadata), `pfm`, `hdr`, `png` or `ppm`. The integer formats get
/// the channels `R G B` clipped to [0, 1] and encoded as sRGB.
///
/// # Errors
/// When the extension is none of these, the picture has no pixels or no colour, or writing fails; `path` is then
/// as it was before.
pub fn write_image(path: impl AsRef<Path>, image: &Image) -> Result<(), ImageError> {
    let path = path.as_ref();
    with_path(path, || {
        let extension = extension(path);
        match extension.as_str() {
            "exr" => write_whole(path, image, |out| openexr::write(out, image, ExrSettings::default())),
            "pfm" => write_whole(path, image, |out| pfm::write(out, image)),
            "hdr" | "pic" => write_whole(path, image, |out| write_hdr(out, image)),
            "png" => write_whole(path, image, |out| encode_png(out, image, Quantization::default())),
            "ppm" => write_whole(path, image, |out| encode_ppm(out, image, Quantization::default())),
            _ => Err(ImageErrorCause::UnknownFormat { extension: extension.clone() }),
        }
    })
}

/// Writes OpenEXR in a chosen way.
///
/// # Errors
/// As [`write_image`].
pub fn write_exr(path: impl AsRef<Path>, image: &Image, settings: ExrSettings) -> Result<(), ImageError> {
    let path = path.as_ref();
    with_path(path, || write_whole(path, image, |out| openexr::write(out, image, settings)))
}

/// Writes 8-bit PNG with a chosen encoding and dithering.
///
/// # Errors
/// As [`write_image`].
pub fn write_png(
    path: impl AsRef<Path>,
    image: &Image,
    quantization: Quantization,
) -> Result<(), ImageError> {
    let path = path.as_ref();
    with_path(path, || write_whole(path, image, |out| encode_png(out, image, quantization)))
}

/// Writes PNG for a display that shows more than sRGB.
///
/// # Errors
/// As [`write_image`].
pub fn write_display_png(
    path: impl AsRef<Path>,
    image: &Image,
    display: DisplayPng,
) -> Result<(), ImageError> {
    let path = path.as_ref();
    with_path(path, || write_whole(path, image, |out| display_png::encode(out, image, display)))
}

/// An 8-bit PNG in memory, to put into another file. `None` for a picture without pixels or colour.
#[must_use]
pub fn png_bytes(image: &Image) -> Option<Vec<u8>> {
    let mut bytes = Vec::new();
    encode_png(&mut bytes, image, Quantization::default()).ok()?;
    Some(bytes)
}

/// Writes binary PPM (P6) with a chosen encoding and dithering.
///
/// # Errors
/// As [`write_image`].
pub fn write_ppm(
    path: impl AsRef<Path>,
    image: &Image,
    quantization: Quantization,
) -> Result<(), ImageError> {
    let path = path.as_ref();
    with_path(path, || write_whole(path, image, |out| encode_ppm(out, image, quantization)))
}

/// Writes PPM as decimal text (P3) with a chosen encoding and dithering.
///
/// # Errors
/// As [`write_image`].
pub fn write_ppm_ascii(
    path: impl AsRef<Path>,
    image: &Image,
    quantization: Quantization,
) -> Result<(), ImageError> {
    let path = path.as_ref();
    let encode = |out: &mut Out| {
        let pixels = bytes(image, quantization)?;
        Ok(netpbm::write_text(out, [image.width, image.height], &pixels)?)
    };
    with_path(path, || write_whole(path, image, encode))
}

type Out = std::io::BufWriter<std::fs::File>;

fn write_whole(path: &Path, image: &Image, encode: impl FnOnce(&mut Out) -> Outcome<()>) -> Outcome<()> {
    if image.is_empty() {
        return Err(ImageErrorCause::Empty);
    }
    if let Some(channel) = image.channels.iter().find(|channel| channel.values.len() != image.n_pixels()) {
        let lengths = format!("channel `{}` does not hold one value per pixel", channel.name);
        return Err(ImageErrorCause::Malformed(lengths));
    }
    write_atomically(path, encode)
}

fn encode_png(out: &mut impl Write, image: &Image, quantization: Quantization) -> Outcome<()> {
    let pixels = bytes(image, quantization)?;
    let [width, height] = size_u32(image)?;
    Ok(PngEncoder::new(out).write_image(pixels.as_flattened(), width, height, ExtendedColorType::Rgb8)?)
}

fn encode_ppm(out: &mut impl Write, image: &Image, quantization: Quantization) -> Outcome<()> {
    let pixels = bytes(image, quantization)?;
    Ok(netpbm::write_binary(out, [image.width, image.height], &pixels)?)
}

/// Writes Radiance RGBE: three 8-bit mantissas with a common exponent. Negative values and NaN become 0, values
/// beyond 2^126 are clipped.
fn write_hdr(out: &mut impl Write, image: &Image) -> Outcome<()> {
    let [_, _] = size_u32(image)?;
    let pixels = image.rgb_pixels().ok_or_else(|| no_color(image))?;
    let pixels: Vec<image::Rgb<f32>> =
        pixels.into_iter().map(|pixel| image::Rgb(shared_exponent(pixel))).collect();
    Ok(HdrEncoder::new(out).encode(&pixels, image.width, image.height)?)
}

/// Rounds a pixel to what RGBE holds. The encoder truncates, which alone would darken an image by up to 1/256.
fn shared_exponent(pixel: [f32; 3]) -> [f32; 3] {
    let pixel = pixel.map(|value| f64::from(value.clamp(0.0, 2f32.powi(126))));
    // Maximum and not a fold with NaN: clamp keeps NaN, max drops it.
    let largest = pixel.iter().copied().fold(0.0, f64::max);
    if largest < 2f64.powi(-126) {
        return [0.0; 3];
    }
    let step = (largest.log2().floor() - 7.0).exp2();
    pixel.map(|value| if value.is_nan() { 0.0 } else { ((value / step).round() * step) as f32 })
}

fn bytes(image: &Image, quantization: Quantization) -> Outcome<Vec<[u8; 3]>> {
    to_u8(image, quantization).ok_or_else(|| no_color(image))
}

/// The error for a picture that has no colour.
pub(super) fn no_color(image: &Image) -> ImageErrorCause {
    ImageErrorCause::NoColor { channels: image.channels.iter().map(|channel| channel.name.clone()).collect() }
}

/// Width and height as most formats store them.
pub(super) fn size_u32(image: &Image) -> Outcome<[u32; 2]> {
    let too_large = ImageErrorCause::TooLarge { width: image.width as u64, height: image.height as u64 };
    match (u32::try_from(image.width), u32::try_from(image.height)) {
        (Ok(width), Ok(height)) => Ok([width, height]),
        _ => Err(too_large),
    }
}
