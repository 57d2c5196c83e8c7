//! PNG for displays that show more than sRGB. The chunk `cICP` of the third edition of PNG names primaries and transfer curve by
//! the code points of ITU-T H.273.

use std::io::{Seek, SeekFrom, Write};

use etendue_image::tonemap::{Dither, Quantization, to_u8};
use etendue_image::{Encoding, Image, pq_decode, pq_encode};
use image::ImageFormat;
use png::chunk::ChunkType;

use super::openexr::{CHROMATICITIES_KEY, WHITE_LUMINANCE_KEY};
use super::write::{no_color, size_u32};
use super::{ImageErrorCause, Opened, Outcome, raster};

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
    /// Luminance in cd/m^2 that white usually has in PQ, and that the value 1 has in pictures that are read from it. [ITU-R BT.2408]
    pub const PQ_WHITE: f32 = 203.0;

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

/// Code points of transfer functions. [H.273, table 3]
const TRANSFER_LINEAR: u8 = 8;
const TRANSFER_PQ: u8 = 16;

/// Reads a PNG by the code points that it states: linear RGB, with its chromaticities if they are not those of sRGB.
pub(super) fn read(file: &mut Opened) -> Outcome<Image> {
    let stated = code_points(file)?;
    let texels = raster::read(file, ImageFormat::Png)?;
    let Some((primaries, transfer)) = stated else { return Ok(texels.to_image(Encoding::Srgb)) };
    let encoding =
        if [TRANSFER_LINEAR, TRANSFER_PQ].contains(&transfer) { Encoding::Linear } else { Encoding::Srgb };
    let mut image = texels.to_image(encoding);
    if transfer == TRANSFER_PQ {
        for channel in image.channels.iter_mut().filter(|channel| channel.name != "A") {
            channel.values.iter_mut().for_each(|value| *value = pq_decode(*value) / DisplayPng::PQ_WHITE);
        }
        image.metadata.insert(WHITE_LUMINANCE_KEY.to_owned(), DisplayPng::PQ_WHITE.to_string());
    }
    // With the white D65. [H.273, table 2]
    let chromaticities = match primaries {
        9 => Some("0.708 0.292 0.17 0.797 0.131 0.046 0.3127 0.329"),
        12 => Some("0.68 0.32 0.265 0.69 0.15 0.06 0.3127 0.329"),
        _ => None,
    };
    image.metadata.extend(chromaticities.map(|text| (CHROMATICITIES_KEY.to_owned(), text.to_owned())));
    Ok(image)
}

/// Code points of primaries and of the transfer function. What is malformed is left to the decoder of the pixels.
fn code_points(file: &mut Opened) -> Outcome<Option<(u8, u8)>> {
    let mut decoder = png::Decoder::new(&mut file.reader);
    decoder.set_ignore_text_chunk(true);
    decoder.set_ignore_iccp_chunk(true);
    let stated = decoder.read_info().ok().and_then(|reader| reader.info().coding_independent_code_points);
    file.reader.seek(SeekFrom::Start(0))?;
    Ok(stated.map(|points| (points.color_primaries, points.transfer_function)))
}

fn cause(error: png::EncodingError) -> ImageErrorCause {
    match error {
        png::EncodingError::IoError(error) => error.into(),
        error => ImageErrorCause::Malformed(error.to_string()),
    }
}

#[cfg(test)]
mod tests;
