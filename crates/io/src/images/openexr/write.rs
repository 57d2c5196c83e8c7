//! Writing OpenEXR files.

use std::io::{self, Seek, SeekFrom, Write};

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
    let mut recorded = Recorded { out, start: Vec::new(), position: 0 };
    exr.write().to_buffered(&mut recorded)?;
    let Recorded { out, start, .. } = recorded;
    if let Some(header) = sorted_header(&start) {
        out.seek(SeekFrom::Start(0))?;
        out.write_all(&header)?;
        out.seek(SeekFrom::End(0))?;
    }
    Ok(())
}

/// The most bytes of a file among which its header is looked for.
const LARGEST_HEADER: usize = 1 << 20;

/// Keeps the first bytes that are written.
struct Recorded<W> {
    out: W,
    start: Vec<u8>,
    position: u64,
}

impl<W: Write> Write for Recorded<W> {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        let n = self.out.write(bytes)?;
        if self.position == self.start.len() as u64 {
            let room = LARGEST_HEADER.saturating_sub(self.start.len());
            self.start.extend(&bytes[..n.min(room)]);
        }
        self.position += n as u64;
        Ok(n)
    }

    fn flush(&mut self) -> io::Result<()> {
        self.out.flush()
    }
}

impl<W: Seek> Seek for Recorded<W> {
    fn seek(&mut self, place: SeekFrom) -> io::Result<u64> {
        self.position = self.out.seek(place)?;
        Ok(self.position)
    }
}

/// The header of a file of one part with its attributes in order of their names: the `exr` crate writes them in an order that
/// differs from run to run, and equal pictures shall be equal files. `None` if the header is not understood.
fn sorted_header(start: &[u8]) -> Option<Vec<u8>> {
    const MAGIC_AND_VERSION: usize = 8;
    let mut attributes = Vec::new();
    let mut at = MAGIC_AND_VERSION;
    while *start.get(at)? != 0 {
        let end_of_text = |from: usize| Some(from + start.get(from..)?.iter().position(|byte| *byte == 0)?);
        let name = end_of_text(at)?;
        let size_at = end_of_text(name + 1)? + 1;
        let size = u32::from_le_bytes(start.get(size_at..size_at + 4)?.try_into().ok()?) as usize;
        let end = size_at.checked_add(4)?.checked_add(size)?;
        attributes.push((&start[at..name], start.get(at..end)?));
        at = end;
    }
    attributes.sort_unstable();
    let bytes = attributes.iter().flat_map(|(_, bytes)| bytes.iter());
    Some(start[..MAGIC_AND_VERSION].iter().chain(bytes).copied().collect())
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
