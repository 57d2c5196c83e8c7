//! PNG for displays that show more than sRGB. The chunk `cICP` of the third edition of PNG names primaries and transfer curve by
//! the code points of ITU-T H.273.

use std::io::Write;

use etendue_image::tonemap::{Dither, Quantization, to_u8};
use etendue_image::{Image, pq_encode};
use png::chunk::ChunkType;

use super::write::{no_color, size_u32};
use super::{ImageErrorCause, Outcome};

/// What a display shows.
#[derive(Copy, Clone, Debug, PartialEq)]
pub enum DisplayPng {
    /// Display P3: the primaries of DCI-P3 with the white D65 and the curve of sRGB, in 8 bits. The image has linear RGB of these
    /// primaries in [0, 1].
    P3(Dither),
    /// Rec. ITU-R BT.2100 PQ in 16 bits. The image has linear RGB of the primaries of Rec. 2020, and its 1 is this luminance in
    /// cd/m^2.
    Pq {
        /// Luminance of white.
        white_luminance: f32,
    },
}

impl DisplayPng {
    /// Primaries, transfer function, matrix coefficients (RGB) and full range. [H.273, tables 2 to 4]
    const fn code_points(self) -> [u8; 4] {
        match self {
            Self::P3(_) => [12, 13, 0, 1],
            Self::Pq { .. } => [9, 16, 0, 1],
        }
    }
}

/// Writes the picture.
pub(super) fn encode(out: &mut impl Write, image: &Image, display: DisplayPng) -> Outcome<()> {
    let [width, height] = size_u32(image)?;
    let (depth, bytes) = match display {
        DisplayPng::P3(dither) => {
            let quantization = Quantization { dither, ..Quantization::default() };
            let pixels = to_u8(image, quantization).ok_or_else(|| no_color(image))?;
            (png::BitDepth::Eight, pixels.into_flattened())
        }
        DisplayPng::Pq { white_luminance } => {
            let pixels = image.rgb_pixels().ok_or_else(|| no_color(image))?;
            let code = |value: f32| (pq_encode(value * white_luminance) * 65535.0).round() as u16;
            let codes = pixels.iter().flatten().flat_map(|value| code(*value).to_be_bytes());
            (png::BitDepth::Sixteen, codes.collect())
        }
    };
    let mut info = png::Info::with_size(width, height);
    info.color_type = png::ColorType::Rgb;
    info.bit_depth = depth;
    if let DisplayPng::P3(_) = display {
        // For readers who do not know the chunk.
        info.source_gamma = Some(png::ScaledFloat::new(1.0 / 2.2));
        info.source_chromaticities = Some(png::SourceChromaticities::new(
            (0.3127, 0.3290),
            (0.680, 0.320),
            (0.265, 0.690),
            (0.150, 0.060),
        ));
    }
    let mut writer = png::Encoder::with_info(out, info).map_err(cause)?.write_header().map_err(cause)?;
    writer.write_chunk(ChunkType(*b"cICP"), &display.code_points()).map_err(cause)?;
    writer.write_image_data(&bytes).map_err(cause)?;
    writer.finish().map_err(cause)
}

fn cause(error: png::EncodingError) -> ImageErrorCause {
    match error {
        png::EncodingError::IoError(error) => error.into(),
        error => ImageErrorCause::Malformed(error.to_string()),
    }
}

#[cfg(test)]
mod tests;
