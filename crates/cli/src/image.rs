//! `etendue image`: what a picture file holds, and the same in another format.

use std::path::{Path, PathBuf};

use etendue::image::{Channel, Image};
use etendue::io::images::{ExrInfo, ExrPart, read_exr_info, read_image};
use serde_json::{Value, json};

use crate::args::{ImageArguments, ImageCommand, ImageConvertArguments};
use crate::failure::{Failure, Result};
use crate::falsecolor::{self, UNIT};
use crate::info::print_lines;
use crate::list::print;
use crate::metadata::{CHROMATICITIES, COLOR_SPACE, LUMINANCE, WHITE_LUMINANCE};
use crate::{outputs, report};

/// Extensions of pictures that are read.
const READABLE: [&str; 9] = ["exr", "hdr", "pic", "pfm", "png", "ppm", "jpg", "jpeg", "qoi"];

/// Runs the command.
pub(crate) fn run(arguments: &ImageArguments) -> Result<()> {
    match &arguments.command {
        ImageCommand::Info(arguments) => info(&arguments.image, arguments.json),
        ImageCommand::Convert(arguments) => convert(arguments),
    }
}

/// True if the name is that of a picture.
pub(crate) fn is_picture(path: &Path) -> bool {
    READABLE.contains(&outputs::extension(path).as_str())
}

/// Prints what a picture holds.
pub(crate) fn info(path: &Path, as_json: bool) -> Result<()> {
    let usage = |error: etendue::io::images::ImageError| Failure::Usage(error.to_string());
    let headers = read_exr_info(path).map_err(usage)?;
    let image = read_image(path).map_err(usage)?;
    let mut description = json!({
        "size": [image.width, image.height],
        "layers": image.layers(),
        "channels": image.channels.iter().map(statistics).collect::<Vec<Value>>(),
        "metadata": image.metadata,
    });
    if let Some(headers) = &headers {
        description["parts"] = parts(headers);
    }
    let n_not_a_number = count(&image, |v| v.is_nan());
    let n_infinite = count(&image, |v| v.is_infinite());
    if n_not_a_number + n_infinite > 0 {
        report::warning(&format!(
            "{}: {n_not_a_number} values are NaN, {n_infinite} are infinite",
            path.display()
        ));
    }
    if as_json {
        print(&description.to_string());
    } else {
        let channels = description.as_object_mut().and_then(|object| object.remove("channels"));
        print_lines("", &description);
        for channel in channels.iter().filter_map(Value::as_array).flatten() {
            print_channel(channel);
        }
    }
    Ok(())
}

/// One line for people.
fn print_channel(channel: &Value) {
    let number = |key: &str| channel[key].as_f64().map_or("-".to_owned(), |value| format!("{value:.6}"));
    let [min, mean, max] = ["min", "mean", "max"].map(number);
    let (name, nan, infinite) =
        (channel["name"].as_str().unwrap_or_default(), &channel["nan"], &channel["infinite"]);
    print(&format!("channel {name}: min {min}, mean {mean}, max {max}, {nan} NaN, {infinite} infinite"));
}

fn count(image: &Image, is: impl Fn(&f32) -> bool) -> usize {
    image.channels.iter().map(|channel| channel.values.iter().filter(|v| is(v)).count()).sum()
}

/// Least, largest and mean value of those that are finite, and how many are not.
fn statistics(channel: &Channel) -> Value {
    let finite = || channel.values.iter().filter(|v| v.is_finite()).map(|v| f64::from(*v));
    let n_finite = finite().count();
    let n_not_a_number = channel.values.iter().filter(|v| v.is_nan()).count();
    let mut value = json!({ "name": channel.name, "nan": n_not_a_number });
    value["infinite"] = json!(channel.values.len() - n_finite - n_not_a_number);
    if n_finite > 0 {
        value["min"] = json!(finite().fold(f64::INFINITY, f64::min));
        value["max"] = json!(finite().fold(f64::NEG_INFINITY, f64::max));
        value["mean"] = json!(finite().sum::<f64>() / n_finite as f64);
    }
    value
}

/// Parts of an OpenEXR file with windows, compression and the types of their channels.
fn parts(headers: &ExrInfo) -> Value {
    let part = |part: &ExrPart| {
        let types: Vec<String> = part
            .channels
            .iter()
            .map(|channel| match channel.sampling {
                [1, 1] => format!("{}: {}", channel.name, channel.kind),
                [x, y] => format!("{}: {} for {x} x {y} pixels", channel.name, channel.kind),
            })
            .collect();
        json!({
            "name": part.name,
            "data_window": part.data_window,
            "display_window": part.display_window,
            "compression": part.compression,
            "blocks": part.blocks,
            "types": types,
        })
    };
    headers.parts.iter().map(part).collect()
}

fn convert(arguments: &ImageConvertArguments) -> Result<()> {
    outputs::check_images(&arguments.outputs)?;
    outputs::check_distinct(std::iter::once(&arguments.image).chain(&arguments.outputs))?;
    let mut image = read_image(&arguments.image).map_err(|error| Failure::Usage(error.to_string()))?;
    if let Some(name) = &arguments.layer {
        image = image.layer(name).ok_or_else(|| {
            let layers: Vec<&str> = image.layers().into_iter().filter(|layer| !layer.is_empty()).collect();
            let there = if layers.is_empty() { "no layers".to_owned() } else { layers.join(", ") };
            Failure::Usage(format!("{}: no layer {name}; there are {there}", arguments.image.display()))
        })?;
        if !is_light(name) {
            for key in [UNIT, WHITE_LUMINANCE, LUMINANCE, COLOR_SPACE, CHROMATICITIES] {
                image.metadata.remove(key);
            }
        } else if name != "direct" && falsecolor::is_lux(&image) {
            // Of the layers of a probe's grid only one is illuminance as the grid is.
            image.metadata.remove(UNIT);
        }
    }
    if let Some(pixels) = image.rgb_pixels() {
        let holds_all = |path: &PathBuf| matches!(outputs::extension(path).as_str(), "exr" | "pfm");
        if !arguments.outputs.iter().all(holds_all) {
            let name = arguments.image.display().to_string();
            report::non_finite(&name, &pixels, "NaN is written black, infinity as the largest value");
        }
    } else if let Some(path) = arguments.outputs.iter().find(|path| outputs::extension(path) != "exr") {
        let what = arguments.layer.as_ref().map_or_else(String::new, |layer| format!(" of layer {layer}"));
        return Err(Failure::Usage(format!(
            "{}: the channels{what} are no colour, which only .exr can hold",
            path.display()
        )));
    }
    let settings = outputs::exr_settings(arguments.exr, &arguments.outputs);
    if arguments.exr.half {
        warn_of_overflow(&image);
    }
    outputs::write_all(&arguments.outputs, |path| outputs::write_with(path, &image, settings))
}

/// False of layers of features and of statistics, whose values are no radiance.
fn is_light(layer: &str) -> bool {
    let root = layer.split('.').next().unwrap_or(layer);
    !["Albedo", "N", "Ns", "P", "depth", "sums", "variance"].contains(&root)
}

/// Half precision ends at 65504.
fn warn_of_overflow(image: &Image) {
    let n = count(image, |v| v.is_finite() && v.abs() > 65504.0);
    if n > 0 {
        report::warning(&format!(
            "{n} values above 65504 do not fit half precision and are cut off where it is used"
        ));
    }
}
