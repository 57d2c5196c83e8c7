//! What an OpenEXR file says of itself, without its pixels.

use exr::meta::BlockDescription;
use exr::meta::MetaData;

use super::super::{Opened, Outcome};
use super::utf8;

/// The headers of a file.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct ExrInfo {
    /// Parts, of which most files have one.
    pub parts: Vec<ExrPart>,
}

/// One part of a file.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct ExrPart {
    /// Name; empty where there is none.
    pub name: String,
    /// x, y, width and height of the pixels that there are.
    pub data_window: [i64; 4],
    /// x, y, width and height of the frame that they belong to.
    pub display_window: [i64; 4],
    /// Name of the compression.
    pub compression: String,
    /// `scan lines`, or the size of the tiles.
    pub blocks: String,
    /// Channels in the order of the file.
    pub channels: Vec<ExrChannel>,
}

/// A channel of a file.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct ExrChannel {
    /// Name.
    pub name: String,
    /// `half`, `float` or `uint`.
    pub kind: &'static str,
    /// Pixels across and down for one sample.
    pub sampling: [usize; 2],
}

/// Reads the headers.
pub(in super::super) fn read_info(file: &mut Opened) -> Outcome<ExrInfo> {
    let headers = MetaData::read_from_buffered(&mut file.reader, false)?.headers;
    let part = |header: &exr::meta::header::Header| {
        let (position, size) = (header.own_attributes.layer_position, header.layer_size);
        let display = header.shared_attributes.display_window;
        let window = |x: i32, y: i32, width: usize, height: usize| {
            [i64::from(x), i64::from(y), width as i64, height as i64]
        };
        ExrPart {
            name: header.own_attributes.layer_name.as_ref().map(utf8).unwrap_or_default(),
            data_window: window(position.0, position.1, size.0, size.1),
            display_window: window(display.position.0, display.position.1, display.size.0, display.size.1),
            compression: header.compression.to_string(),
            blocks: match &header.blocks {
                BlockDescription::ScanLines => "scan lines".to_owned(),
                BlockDescription::Tiles(tiles) => {
                    format!("tiles of {} x {}", tiles.tile_size.0, tiles.tile_size.1)
                }
            },
            channels: header.channels.list.iter().map(channel).collect(),
        }
    };
    Ok(ExrInfo { parts: headers.iter().map(part).collect() })
}

fn channel(channel: &exr::meta::attribute::ChannelDescription) -> ExrChannel {
    use exr::meta::attribute::SampleType;
    ExrChannel {
        name: utf8(&channel.name),
        kind: match channel.sample_type {
            SampleType::F16 => "half",
            SampleType::F32 => "float",
            SampleType::U32 => "uint",
        },
        sampling: [channel.sampling.0, channel.sampling.1],
    }
}
