//! PNG, JPEG, TGA, QOI and Radiance HDR through the `image` crate.

use etendue_image::{TexelData, Texels};
use image::{DynamicImage, ImageDecoder, ImageFormat, ImageReader, Limits};

use super::{ImageErrorCause, MAX_BYTES, Opened, Outcome};

/// Formats that this module reads.
pub(super) const READABLE: [ImageFormat; 5] =
    [ImageFormat::Png, ImageFormat::Jpeg, ImageFormat::Tga, ImageFormat::Qoi, ImageFormat::Hdr];

/// Reads the pixels in the width of the file; palettes and bits become bytes.
pub(super) fn read(file: &mut Opened, format: ImageFormat) -> Outcome<Texels> {
    let (n_bytes, mut reader) = (file.n_bytes, ImageReader::with_format(&mut file.reader, format));
    let mut limits = Limits::default();
    limits.max_alloc = Some(MAX_BYTES);
    reader.limits(limits);
    let decoder = reader.into_decoder()?;
    let (width, height) = decoder.dimensions();
    let bytes_per_pixel = u64::from(decoder.color_type().bytes_per_pixel());
    super::check_size(n_bytes, [width.into(), height.into()], bytes_per_pixel)?;
    let decoded = DynamicImage::from_decoder(decoder)?;
    let (n_channels, data) = match decoded {
        DynamicImage::ImageLuma8(pixels) => (1, TexelData::U8(pixels.into_raw())),
        DynamicImage::ImageLumaA8(pixels) => (2, TexelData::U8(pixels.into_raw())),
        DynamicImage::ImageRgb8(pixels) => (3, TexelData::U8(pixels.into_raw())),
        DynamicImage::ImageRgba8(pixels) => (4, TexelData::U8(pixels.into_raw())),
        DynamicImage::ImageLuma16(pixels) => (1, TexelData::U16(pixels.into_raw())),
        DynamicImage::ImageLumaA16(pixels) => (2, TexelData::U16(pixels.into_raw())),
        DynamicImage::ImageRgb16(pixels) => (3, TexelData::U16(pixels.into_raw())),
        DynamicImage::ImageRgba16(pixels) => (4, TexelData::U16(pixels.into_raw())),
        DynamicImage::ImageRgb32F(pixels) => (3, TexelData::F32(pixels.into_raw())),
        DynamicImage::ImageRgba32F(pixels) => (4, TexelData::F32(pixels.into_raw())),
        other => return Err(ImageErrorCause::Unsupported(format!("pixels of type {:?}", other.color()))),
    };
    // The 8-bit mantissas of Radiance files fit halves unless very bright or dark.
    Ok(Texels::new(width as usize, height as usize, n_channels, data).compact())
}
