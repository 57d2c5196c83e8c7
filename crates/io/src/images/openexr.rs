//! OpenEXR through the `exr` crate.
//!
//! Layers are read in either form: parts with names of their own, or dotted channel names in one part. They are
//! written as dotted names in one part, which every viewer knows. Attribute texts are UTF-8. The picture is the data
//! window; where parts have different data windows they are placed into the display window on zeros. Attributes of other types
//! than text that pictures of renderers have (`attributes`) are texts of numbers in memory.
//! Blocks are decompressed on the calling thread: a panic in a pool's thread would end the process.

mod attributes;
mod info;
mod write;

use std::io::{Seek, SeekFrom};

use etendue_image::{Channel, Image, TexelData, Texels};
use exr::image::{AnyChannel, AnyChannels, FlatImage, FlatSamples, Layer};
use exr::meta::MetaData;
use exr::meta::attribute::Text;
use exr::prelude::{ReadChannels, ReadLayers};

use super::{ImageErrorCause, Opened, Outcome, check_size};
use attributes::{chromaticities_from_exr, read_metadata};

pub(super) use attributes::{CHROMATICITIES_KEY, WHITE_LUMINANCE_KEY};
pub(super) use info::read_info;
pub use info::{ExrChannel, ExrInfo, ExrPart};
pub(super) use write::write;
pub use write::{ExrBlocks, ExrNumbers, ExrSettings};

/// Every channel of every layer as floats.
pub(super) fn read_image(file: &mut Opened) -> Outcome<Image> {
    let exr = read(file)?;
    let window = Window::of_layers(&exr);
    // Only the data windows were held against limits so far. Small parts of a large picture are no suspicious claim.
    let n_channels: usize = exr.layer_data.iter().map(|layer| layer.channel_data.list.len()).sum();
    let bytes_per_pixel = (n_channels * size_of::<f32>()) as u64;
    check_size(u64::MAX, [window.width as u64, window.height as u64], bytes_per_pixel)?;
    let mut image = Image::new(window.width, window.height);
    image.metadata = read_metadata(&exr, window.is_data_window);
    let n_layers = exr.layer_data.len();
    for layer in &exr.layer_data {
        let layer_name = layer.attributes.layer_name.as_ref().filter(|_| n_layers > 1).map(utf8);
        for channel in &layer.channel_data.list {
            let name = channel_name(layer_name.as_deref(), &utf8(&channel.name), &image);
            let values = window.place(layer, &name, &channel.sample_data)?;
            image.channels.push(Channel { name, values });
        }
    }
    // Files keep channels in alphabetical order; the picture itself comes first here, and red before green.
    image.channels.sort_by_cached_key(|channel| sort_key(&channel.name));
    Ok(image)
}

/// The channels of a colour or of a gray picture, in the width of the file.
pub(super) fn read_texels(file: &mut Opened) -> Outcome<Texels> {
    let exr = read(file)?;
    let (layer, channels) = exr
        .layer_data
        .iter()
        .find_map(|layer| Some((layer, picture_channels(layer)?)))
        .ok_or_else(|| ImageErrorCause::NoColor { channels: all_names(&exr) })?;
    let n_texels = layer.size.area();
    if let Some(channel) = channels.iter().find(|channel| channel.sample_data.len() != n_texels) {
        return Err(subsampled(&utf8(&channel.name)));
    }
    let all_half = channels.iter().all(|channel| matches!(channel.sample_data, FlatSamples::F16(_)));
    let data = if all_half {
        let half = |channel: &&AnyChannel<FlatSamples>, index: usize| match &channel.sample_data {
            FlatSamples::F16(values) => values[index].to_bits(),
            _ => 0,
        };
        TexelData::F16((0..n_texels).flat_map(|index| channels.iter().map(move |c| half(c, index))).collect())
    } else {
        let value = |channel: &&AnyChannel<FlatSamples>, index| {
            channel.sample_data.value_by_flat_index(index).to_f32()
        };
        TexelData::F32(
            (0..n_texels).flat_map(|index| channels.iter().map(move |c| value(c, index))).collect(),
        )
    };
    let mut texels = Texels::new(layer.size.width(), layer.size.height(), channels.len(), data);
    texels.color_space = exr.attributes.chromaticities.map(chromaticities_from_exr);
    Ok(texels)
}

/// Reads the file after its headers were found plausible.
fn read(file: &mut Opened) -> Outcome<FlatImage> {
    let headers = MetaData::read_from_buffered(&mut file.reader, false)?.headers;
    let mut total_bytes = 0u64;
    for header in &headers {
        let size = [header.layer_size.width() as u64, header.layer_size.height() as u64];
        let bytes_per_pixel: u64 =
            header.channels.list.iter().map(|channel| channel.sample_type.bytes_per_sample() as u64).sum();
        check_size(file.n_bytes, size, bytes_per_pixel)?;
        total_bytes = total_bytes.saturating_add(size[0] * size[1] * bytes_per_pixel);
    }
    check_size(file.n_bytes, [1, 1], total_bytes)?;
    file.reader.seek(SeekFrom::Start(0))?;
    let reader =
        exr::image::read::read().no_deep_data().largest_resolution_level().all_channels().all_layers();
    Ok(reader.all_attributes().non_parallel().from_buffered(&mut file.reader)?)
}

/// Where the picture lies in the coordinates of the file.
#[derive(Copy, Clone, Debug)]
struct Window {
    /// True if it is the data window of all layers.
    is_data_window: bool,
    origin: [i64; 2],
    width: usize,
    height: usize,
}

impl Window {
    fn of_layers(exr: &FlatImage) -> Window {
        let bounds = |layer: &Layer<_>| (layer.attributes.layer_position, layer.size);
        let first = exr.layer_data.first().map(bounds);
        let all_equal = exr.layer_data.iter().all(|layer| Some(bounds(layer)) == first);
        let display = (exr.attributes.display_window.position, exr.attributes.display_window.size);
        let (position, size) = first.filter(|_| all_equal).unwrap_or(display);
        Window {
            is_data_window: all_equal,
            origin: [position.x().into(), position.y().into()],
            width: size.width(),
            height: size.height(),
        }
    }

    /// The samples of a layer on the window, zero where the layer has none.
    fn place(
        &self,
        layer: &Layer<AnyChannels<FlatSamples>>,
        name: &str,
        samples: &FlatSamples,
    ) -> Outcome<Vec<f32>> {
        if samples.len() != layer.size.area() {
            return Err(subsampled(name));
        }
        let position = layer.attributes.layer_position;
        let offset = [i64::from(position.x()) - self.origin[0], i64::from(position.y()) - self.origin[1]];
        if offset == [0, 0] && [layer.size.width(), layer.size.height()] == [self.width, self.height] {
            return Ok(samples.values_as_f32().collect());
        }
        let mut plane = vec![0.0; self.width * self.height];
        for (index, value) in samples.values_as_f32().enumerate() {
            let x = (index % layer.size.width()) as i64 + offset[0];
            let y = (index / layer.size.width()) as i64 + offset[1];
            if (0..self.width as i64).contains(&x) && (0..self.height as i64).contains(&y) {
                plane[y as usize * self.width + x as usize] = value;
            }
        }
        Ok(plane)
    }
}

/// The channels of a layer that make a picture, interleaving order.
fn picture_channels(layer: &Layer<AnyChannels<FlatSamples>>) -> Option<Vec<&AnyChannel<FlatSamples>>> {
    let list = &layer.channel_data.list;
    let find = |name: &str| list.iter().find(|channel| channel.name.as_slice() == name.as_bytes());
    let mut channels = match ["R", "G", "B"].map(find) {
        [Some(r), Some(g), Some(b)] => vec![r, g, b],
        _ => match (find("Y"), list.as_slice()) {
            (Some(y), _) => vec![y],
            (None, [only]) => return Some(vec![only]),
            _ => return None,
        },
    };
    channels.extend(find("A"));
    Some(channels)
}

/// Name of a channel in the image, made unique where a file uses one twice.
fn channel_name(layer: Option<&str>, channel: &str, image: &Image) -> String {
    let mut name = match layer {
        Some(layer) if !layer.is_empty() && !channel.starts_with(&format!("{layer}.")) => {
            format!("{layer}.{channel}")
        }
        _ => channel.to_owned(),
    };
    while image.channel(&name).is_some() {
        name.push('_');
    }
    name
}

/// Picture before layers, then by layer, then colours in their order.
fn sort_key(name: &str) -> (String, usize, String) {
    let (layer, channel) = name.rsplit_once('.').unwrap_or(("", name));
    let rank = ["R", "G", "B", "A", "X", "Y", "Z"].iter().position(|known| *known == channel).unwrap_or(7);
    (layer.to_owned(), rank, channel.to_owned())
}

fn all_names(exr: &FlatImage) -> Vec<String> {
    exr.layer_data.iter().flat_map(|layer| layer.channel_data.list.iter().map(|c| utf8(&c.name))).collect()
}

fn subsampled(name: &str) -> ImageErrorCause {
    ImageErrorCause::Unsupported(format!("channel `{name}` has fewer samples than the picture has pixels"))
}

fn utf8(text: &Text) -> String {
    String::from_utf8_lossy(text.as_slice()).into_owned()
}

#[cfg(test)]
mod tests;
