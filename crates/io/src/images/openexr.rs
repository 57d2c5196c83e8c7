//! OpenEXR through the `exr` crate.
//!
//! Layers are read in either form: parts with names of their own, or dotted channel names in one part. They are
//! written as dotted names in one part, which every viewer knows. Attribute texts are UTF-8. The picture is the data
//! window; where parts have different data windows they are placed into the display window on zeros.
//! Blocks are decompressed on the calling thread: a panic in a pool's thread would end the process.

use std::io::{Seek, SeekFrom, Write};

use etendue_image::{Channel, Chromaticities, Image, TexelData, Texels};
use exr::image::write::WritableImage;
use exr::image::{AnyChannel, AnyChannels, FlatImage, FlatSamples, Layer};
use exr::math::Vec2;
use exr::meta::MetaData;
use exr::meta::attribute::{self, AttributeValue, LineOrder, Text, TextBytes};
use exr::meta::header::{ImageAttributes, LayerAttributes, standard_names};
use exr::prelude::{Blocks, Compression, Encoding, ReadChannels, ReadLayers};

use super::{ImageErrorCause, Opened, Outcome, check_size};

/// Metadata key for primaries and white other than Rec. 709: eight numbers, x and y of red, green, blue, white.
const CHROMATICITIES_KEY: &str = "chromaticities";
/// Put before metadata keys that the format reserves for attributes of another type.
const RESERVED_PREFIX: &str = "meta.";

/// Every channel of every layer as floats.
pub(super) fn read_image(file: &mut Opened) -> Outcome<Image> {
    let exr = read(file)?;
    let window = Window::of_layers(&exr);
    let mut image = Image::new(window.width, window.height);
    image.metadata = read_metadata(&exr);
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

/// Text and number attributes of the file and of its first layer.
fn read_metadata(exr: &FlatImage) -> std::collections::BTreeMap<String, String> {
    let mut metadata = std::collections::BTreeMap::new();
    let mut add = |key: String, value: String| {
        metadata.insert(key.strip_prefix(RESERVED_PREFIX).unwrap_or(&key).to_owned(), value)
    };
    let layer = exr.layer_data.first().map(|layer| &layer.attributes);
    let other = layer.into_iter().flat_map(|layer| &layer.other).chain(&exr.attributes.other);
    for (key, value) in other {
        let value = match value {
            AttributeValue::Text(text) => utf8(text),
            AttributeValue::F32(number) => number.to_string(),
            AttributeValue::F64(number) => number.to_string(),
            AttributeValue::I32(number) => number.to_string(),
            _ => continue,
        };
        add(utf8(key), value);
    }
    if let Some(layer) = layer {
        let known = [
            ("owner", &layer.owner),
            ("comments", &layer.comments),
            ("capDate", &layer.capture_date),
            ("software", &layer.software_name),
        ];
        for (key, text) in known {
            text.iter().for_each(|text| drop(add(key.to_owned(), utf8(text))));
        }
    }
    if let Some(found) = exr.attributes.chromaticities.map(chromaticities_from_exr)
        && found != Chromaticities::REC709
    {
        let numbers = [found.red, found.green, found.blue, found.white].concat();
        add(CHROMATICITIES_KEY.to_owned(), numbers.iter().map(f32::to_string).collect::<Vec<_>>().join(" "));
    }
    metadata
}

/// Writes every channel as float, compressed by ZIP in blocks of 16 rows, with the metadata as text attributes.
pub(super) fn write(out: &mut (impl Write + Seek), image: &Image) -> Outcome<()> {
    let size = Vec2(image.width, image.height);
    let channel = |channel: &Channel| {
        let valid = !channel.name.is_empty() && channel.name.len() < 256 && !channel.name.contains('\0');
        if !valid {
            return Err(ImageErrorCause::Malformed(format!(
                "`{}` cannot be the name of a channel",
                channel.name
            )));
        }
        Ok(AnyChannel::new(text(&channel.name), FlatSamples::F32(channel.values.clone())))
    };
    let channels = AnyChannels::sort(image.channels.iter().map(channel).collect::<Outcome<_>>()?);
    let encoding = Encoding {
        compression: Compression::ZIP16,
        blocks: Blocks::ScanLines,
        line_order: LineOrder::Increasing,
    };
    let layer = Layer::new(size, LayerAttributes::default(), encoding, channels);
    let mut exr = exr::image::Image::new(ImageAttributes::with_size(size), layer);
    let primaries = image.metadata.get(CHROMATICITIES_KEY).and_then(|text| parse_chromaticities(text));
    exr.attributes.chromaticities = Some(chromaticities_to_exr(primaries.unwrap_or(Chromaticities::REC709)));
    for (key, value) in &image.metadata {
        set_attribute(&mut exr.layer_data.attributes, key, value);
    }
    Ok(exr.write().to_buffered(out)?)
}

/// Stores one metadata entry where the format has its place for it.
fn set_attribute(attributes: &mut LayerAttributes, key: &str, value: &str) {
    match key {
        "owner" => attributes.owner = Some(text(value)),
        "comments" => attributes.comments = Some(text(value)),
        "capDate" => attributes.capture_date = Some(text(value)),
        "software" => attributes.software_name = Some(text(value)),
        _ => {
            if key == CHROMATICITIES_KEY && parse_chromaticities(value).is_some() {
                return;
            }
            let is_reserved = standard_names::ALL.contains(&key.as_bytes()) || key.is_empty();
            let key = if is_reserved { format!("{RESERVED_PREFIX}{key}") } else { key.to_owned() };
            attributes.other.insert(text(&key), AttributeValue::Text(text(value)));
        }
    }
}

fn parse_chromaticities(text: &str) -> Option<Chromaticities> {
    let numbers: Option<Vec<f32>> = text.split_whitespace().map(|word| word.parse().ok()).collect();
    match numbers?.as_slice() {
        &[rx, ry, gx, gy, bx, by, wx, wy] => {
            Some(Chromaticities { red: [rx, ry], green: [gx, gy], blue: [bx, by], white: [wx, wy] })
        }
        _ => None,
    }
}

fn chromaticities_from_exr(found: attribute::Chromaticities) -> Chromaticities {
    let pair = |Vec2(x, y): Vec2<f32>| [x, y];
    Chromaticities {
        red: pair(found.red),
        green: pair(found.green),
        blue: pair(found.blue),
        white: pair(found.white),
    }
}

fn chromaticities_to_exr(own: Chromaticities) -> attribute::Chromaticities {
    let pair = |[x, y]: [f32; 2]| Vec2(x, y);
    attribute::Chromaticities {
        red: pair(own.red),
        green: pair(own.green),
        blue: pair(own.blue),
        white: pair(own.white),
    }
}

/// Bytes of a text as they are.
fn text(text: &str) -> Text {
    Text::from_bytes_unchecked(TextBytes::from_slice(text.as_bytes()))
}

fn utf8(text: &Text) -> String {
    String::from_utf8_lossy(text.as_slice()).into_owned()
}
