//! Writing OpenEXR files.

use std::io::{Seek, Write};

use etendue_image::{Channel, Image};
use exr::image::write::WritableImage;
use exr::image::{AnyChannel, AnyChannels, FlatSamples, Layer};
use exr::math::Vec2;
use exr::meta::attribute::LineOrder;
use exr::meta::header::{ImageAttributes, LayerAttributes};
use exr::prelude::{Blocks, Compression, Encoding, f16};

use super::super::{ImageErrorCause, Outcome};
use super::attributes::{set_attributes, text};

/// How numbers are stored.
#[derive(Copy, Clone, Debug, PartialEq, Eq, Default)]
pub enum ExrNumbers {
    /// All channels in single precision, exactly as they are.
    #[default]
    Float,
    /// Colour, coverage and normals in half precision: 11 bits, from 6e-8 to 65504. Larger numbers become 65504, infinite ones
    /// stay. Depth, positions, variances and exact sums keep single precision.
    Half,
}

/// How pixels are grouped.
#[derive(Copy, Clone, Debug, PartialEq, Eq, Default)]
pub enum ExrBlocks {
    /// Sixteen rows each.
    #[default]
    Rows,
    /// Squares of 64 by 64 pixels, for programs that read parts of large pictures.
    Tiles,
}

/// What the format leaves open.
#[derive(Copy, Clone, Debug, PartialEq, Eq, Default)]
pub struct ExrSettings {
    /// How numbers are stored.
    pub numbers: ExrNumbers,
    /// How pixels are grouped.
    pub blocks: ExrBlocks,
}

/// Layers that need all bits.
const PRECISE_LAYERS: [&str; 4] = ["P", "depth", "sums", "variance"];
/// Channels without a layer that do.
const PRECISE_CHANNELS: [&str; 2] = ["Z", "depth"];

/// Writes every channel, compressed by ZIP without loss, with the metadata as attributes.
pub(in super::super) fn write(
    out: &mut (impl Write + Seek),
    image: &Image,
    settings: ExrSettings,
) -> Outcome<()> {
    let size = Vec2(image.width, image.height);
    let channel = |channel: &Channel| {
        let valid = !channel.name.is_empty() && channel.name.len() < 256 && !channel.name.contains('\0');
        if !valid {
            return Err(ImageErrorCause::Malformed(format!(
                "`{}` cannot be the name of a channel",
                channel.name
            )));
        }
        Ok(AnyChannel::new(text(&channel.name), samples(channel, settings.numbers)))
    };
    let channels = AnyChannels::sort(image.channels.iter().map(channel).collect::<Outcome<_>>()?);
    let encoding = Encoding {
        compression: Compression::ZIP16,
        blocks: match settings.blocks {
            ExrBlocks::Rows => Blocks::ScanLines,
            ExrBlocks::Tiles => Blocks::Tiles(Vec2(64, 64)),
        },
        line_order: LineOrder::Increasing,
    };
    let layer = Layer::new(size, LayerAttributes::default(), encoding, channels);
    let mut exr = exr::image::Image::new(ImageAttributes::with_size(size), layer);
    set_attributes(&image.metadata, size, &mut exr.attributes, &mut exr.layer_data.attributes);
    Ok(exr.write().to_buffered(out)?)
}

fn samples(channel: &Channel, numbers: ExrNumbers) -> FlatSamples {
    let is_precise = match channel.name.split_once('.') {
        Some((layer, _)) => PRECISE_LAYERS.contains(&layer),
        None => PRECISE_CHANNELS.contains(&channel.name.as_str()),
    };
    if numbers == ExrNumbers::Float || is_precise {
        return FlatSamples::F32(channel.values.clone());
    }
    let largest = f16::MAX.to_f32();
    let half =
        |value: &f32| f16::from_f32(if value.is_finite() { value.clamp(-largest, largest) } else { *value });
    FlatSamples::F16(channel.values.iter().map(half).collect())
}
