//! PNG, JPEG, TGA, QOI and Radiance HDR through the `image` crate.

use std::io::{Read, Seek, SeekFrom};

use etendue_image::{TexelData, Texels};
use image::{DynamicImage, ImageDecoder, ImageFormat, ImageReader, Limits};

use super::{ImageErrorCause, MAX_BYTES, Opened, Outcome};

/// Formats that this module reads.
pub(super) const READABLE: [ImageFormat; 5] =
    [ImageFormat::Png, ImageFormat::Jpeg, ImageFormat::Tga, ImageFormat::Qoi, ImageFormat::Hdr];

/// Reads the pixels in the width of the file; palettes and bits become bytes.
pub(super) fn read(file: &mut Opened, format: ImageFormat) -> Outcome<Texels> {
    if format == ImageFormat::Jpeg {
        check_end_of_jpeg(&mut file.reader)?;
    }
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

/// Refuses a JPEG that was cut off: decoders show what is missing in grey. Its markers are followed to that of the end.
fn check_end_of_jpeg(reader: &mut (impl Read + Seek)) -> Outcome<()> {
    const END: u8 = 0xd9;
    let mut bytes = Vec::new();
    reader.read_to_end(&mut bytes)?;
    reader.seek(SeekFrom::Start(0))?;
    let mut at = 0;
    while let Some(next) = bytes.get(at..).and_then(|rest| rest.windows(2).position(|pair| pair[0] == 0xff)) {
        at += next + 1;
        match bytes[at] {
            END => return Ok(()),
            // Filling, a byte of pixels, and markers without a segment.
            0xff => {}
            0x00 | 0x01 | 0xd0..=0xd8 => at += 1,
            _ => {
                let length =
                    bytes.get(at + 1..at + 3).map_or(0, |pair| u16::from_be_bytes([pair[0], pair[1]]));
                at += 1 + usize::from(length);
            }
        }
    }
    Err(ImageErrorCause::Truncated("the marker of its end is missing".to_owned()))
}
