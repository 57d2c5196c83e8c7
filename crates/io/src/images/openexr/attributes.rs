//! Attributes of OpenEXR files as metadata, and back.
//!
//! | key | attribute | text |
//! |---|---|---|
//! | `chromaticities` | the same, unless Rec. 709 | x and y of red, green, blue and white |
//! | `worldToCamera`, `worldToNDC` | the same | 16 numbers by rows, for row vectors: a point is `(x y z 1) M` |
//! | `whiteLuminance` | the same | cd/m^2 of the colour (1, 1, 1) |
//! | `dataWindow` | position of the data window, unless 0 0 | x and y |
//! | `displayWindow` | the same, unless it is the data window | x, y, width, height |
//! | `owner` `comments` `capDate` `software` | the same | |
//! | any other | a text of that name | |

use std::collections::BTreeMap;
use std::str::FromStr;

use etendue_image::Chromaticities;
use exr::image::FlatImage;
use exr::math::Vec2;
use exr::meta::attribute::{self, AttributeValue, IntegerBounds, Matrix4x4, Text, TextBytes};
use exr::meta::header::{ImageAttributes, LayerAttributes, standard_names};

use super::utf8;

pub(in super::super) const CHROMATICITIES_KEY: &str = "chromaticities";
const WORLD_TO_CAMERA_KEY: &str = "worldToCamera";
const WORLD_TO_NDC_KEY: &str = "worldToNDC";
pub(in super::super) const WHITE_LUMINANCE_KEY: &str = "whiteLuminance";
const DATA_WINDOW_KEY: &str = "dataWindow";
const DISPLAY_WINDOW_KEY: &str = "displayWindow";
/// Put before metadata keys that the format reserves for attributes of another type.
const RESERVED_PREFIX: &str = "meta.";

/// Text and number attributes of the file and of its first layer.
pub(super) fn read_metadata(exr: &FlatImage, has_data_window: bool) -> BTreeMap<String, String> {
    let mut metadata = BTreeMap::new();
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
        add(CHROMATICITIES_KEY.to_owned(), join(&numbers));
    }
    if let Some(layer) = layer {
        let matrices = [
            (WORLD_TO_CAMERA_KEY, &layer.world_to_camera),
            (WORLD_TO_NDC_KEY, &layer.world_to_normalized_device),
        ];
        for (key, matrix) in matrices {
            matrix.iter().for_each(|matrix| drop(add(key.to_owned(), join(matrix))));
        }
        layer.white_luminance.iter().for_each(|l| drop(add(WHITE_LUMINANCE_KEY.to_owned(), l.to_string())));
    }
    let display = exr.attributes.display_window;
    if let Some(layer) = exr.layer_data.first().filter(|_| has_data_window) {
        let position = layer.attributes.layer_position;
        if position != Vec2(0, 0) {
            add(DATA_WINDOW_KEY.to_owned(), join(&[position.0, position.1]));
        }
        if (display.position, display.size) != (position, layer.size) {
            let (Vec2(x, y), Vec2(width, height)) = (display.position, display.size);
            add(DISPLAY_WINDOW_KEY.to_owned(), format!("{x} {y} {width} {height}"));
        }
    }
    metadata
}

/// Stores the metadata where the format has its places for them.
pub(super) fn set_attributes(
    metadata: &BTreeMap<String, String>,
    size: Vec2<usize>,
    image: &mut ImageAttributes,
    layer: &mut LayerAttributes,
) {
    let primaries = metadata.get(CHROMATICITIES_KEY).and_then(|text| parse_chromaticities(text));
    image.chromaticities = Some(chromaticities_to_exr(primaries.unwrap_or(Chromaticities::REC709)));
    if let Some([x, y]) = metadata.get(DATA_WINDOW_KEY).and_then(|text| numbers(text)) {
        layer.layer_position = Vec2(x, y);
        image.display_window = IntegerBounds::new(Vec2(x, y), size);
    }
    if let Some([x, y, width, height]) =
        metadata.get(DISPLAY_WINDOW_KEY).and_then(|text| numbers::<i32, 4>(text))
        && width > 0
        && height > 0
    {
        image.display_window = IntegerBounds::new(Vec2(x, y), Vec2(width as usize, height as usize));
    }
    for (key, value) in metadata {
        set_attribute(layer, key, value);
    }
}

/// Stores one metadata entry where the format has its place for it.
fn set_attribute(attributes: &mut LayerAttributes, key: &str, value: &str) {
    let is_window = match key {
        "owner" => return attributes.owner = Some(text(value)),
        "comments" => return attributes.comments = Some(text(value)),
        "capDate" => return attributes.capture_date = Some(text(value)),
        "software" => return attributes.software_name = Some(text(value)),
        WORLD_TO_CAMERA_KEY if set_matrix(&mut attributes.world_to_camera, value) => return,
        WORLD_TO_NDC_KEY if set_matrix(&mut attributes.world_to_normalized_device, value) => return,
        WHITE_LUMINANCE_KEY => match numbers(value) {
            Some([luminance]) => return attributes.white_luminance = Some(luminance),
            None => false,
        },
        CHROMATICITIES_KEY => parse_chromaticities(value).is_some(),
        DATA_WINDOW_KEY => numbers::<i32, 2>(value).is_some(),
        DISPLAY_WINDOW_KEY => numbers::<i32, 4>(value).is_some(),
        _ => false,
    };
    if is_window {
        return;
    }
    let is_reserved = standard_names::ALL.contains(&key.as_bytes()) || key.is_empty();
    let key = if is_reserved { format!("{RESERVED_PREFIX}{key}") } else { key.to_owned() };
    attributes.other.insert(text(&key), AttributeValue::Text(text(value)));
}

/// Sets a matrix if the text is one.
fn set_matrix(place: &mut Option<Matrix4x4>, text: &str) -> bool {
    *place = numbers(text);
    place.is_some()
}

/// Exactly N numbers.
fn numbers<T: FromStr, const N: usize>(text: &str) -> Option<[T; N]> {
    let numbers: Option<Vec<T>> = text.split_whitespace().map(|word| word.parse().ok()).collect();
    numbers?.try_into().ok()
}

fn join<T: ToString>(numbers: &[T]) -> String {
    numbers.iter().map(T::to_string).collect::<Vec<_>>().join(" ")
}

fn parse_chromaticities(text: &str) -> Option<Chromaticities> {
    let [rx, ry, gx, gy, bx, by, wx, wy] = numbers(text)?;
    Some(Chromaticities { red: [rx, ry], green: [gx, gy], blue: [bx, by], white: [wx, wy] })
}

pub(super) fn chromaticities_from_exr(found: attribute::Chromaticities) -> Chromaticities {
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
pub(super) fn text(text: &str) -> Text {
    Text::from_bytes_unchecked(TextBytes::from_slice(text.as_bytes()))
}
