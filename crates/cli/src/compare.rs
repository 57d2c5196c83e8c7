//! `etendue compare`.

use std::path::PathBuf;

use etendue::image::compare::{CompareError, Comparison, DifferenceKind, Pair, Settings, compare};
use etendue::image::{Image, box_downsample};
use etendue::io::images::{read_image, write_image};
use serde_json::json;

use crate::args::{CompareArguments, MapArgument};
use crate::failure::{Failure, Result};
use crate::list::print;
use crate::outputs;

/// Runs the command.
pub(crate) fn run(arguments: &CompareArguments) -> Result<()> {
    let maps = arguments.output.as_slice();
    outputs::check_images(maps)?;
    let open = |path| read_image(path).map_err(|error| Failure::Usage(error.to_string()));
    let (mut image, mut reference) = (open(&arguments.image)?, open(&arguments.reference)?);
    scale(&mut reference, arguments.scale_reference);
    let clamp = arguments.clamp.map(|max| [0.0, max]);
    if arguments.box_filter {
        equalize_sizes(&mut image, &mut reference, arguments.clamp);
    }
    let settings = Settings { clamp, flip_exposure_ev: arguments.exposure, ..Settings::default() };
    let (name, reference_name) = (arguments.image.display(), arguments.reference.display());
    let refuse = |error: CompareError| Failure::Usage(format!("{name} and {reference_name}: {error}"));
    let result = compare(&image, &reference, &settings).map_err(refuse)?;
    if !maps.is_empty() {
        let pair = Pair::new(&image, &reference, clamp).map_err(refuse)?;
        write_map(maps, &pair, arguments.map, &settings)?;
    }
    if arguments.json {
        print_json(&result)
    } else {
        print_lines(&result)
    }
    Ok(())
}

/// Box-filters the larger image to the size of the smaller, if it is a whole multiple. Values are clamped before they
/// are averaged, since one overexposed pixel would outweigh its neighbours.
fn equalize_sizes(image: &mut Image, reference: &mut Image, clamp: Option<f32>) {
    let (small, large) = if image.width < reference.width { (image, reference) } else { (reference, image) };
    let factor = large.width / small.width.max(1);
    if factor > 1 && large.width == factor * small.width && large.height == factor * small.height {
        if let Some(max) = clamp {
            let values = large.channels.iter_mut().flat_map(|channel| &mut channel.values);
            values.for_each(|v| *v = v.clamp(0.0, max));
        }
        *large = box_downsample(large, factor);
    }
}

fn write_map(paths: &[PathBuf], pair: &Pair, map: MapArgument, settings: &Settings) -> Result<()> {
    let kind = match map {
        MapArgument::Flip => DifferenceKind::Flip { pixels_per_degree: settings.pixels_per_degree },
        MapArgument::Absolute => DifferenceKind::Absolute,
        MapArgument::Relative => DifferenceKind::RelativeSquared,
    };
    let map = pair.difference(kind);
    let full_scale = if kind == DifferenceKind::Absolute { map.max() } else { 1.0 };
    let picture = map.to_false_colors(full_scale);
    outputs::write_all(paths, |path| write_image(path, &picture))
}

/// The numbers of a comparison with their names, which are stable.
fn rows(result: &Comparison) -> [(&'static str, f64); 8] {
    [
        ("mse", result.mse),
        ("rmse", result.rmse),
        ("relmse", result.relmse),
        ("mape", result.mape),
        ("smape", result.smape),
        ("psnr", result.psnr_db),
        ("flip", result.flip),
        ("mean_ratio", result.mean_ratio),
    ]
}

fn print_json(result: &Comparison) {
    let mut object = json!({
        "pixels": result.n_pixels,
        "masked": result.n_masked,
        "mean": result.mean_test,
        "mean_reference": result.mean_reference,
        "channel_ratio": result.channel_ratio,
    });
    for (name, value) in rows(result) {
        object[name] = json!(value);
    }
    print(&object.to_string());
}

fn print_lines(result: &Comparison) {
    for (name, value) in rows(result) {
        print(&format!("{name:<12}{value:.6}"));
    }
    let three = |v: [f64; 3]| v.map(|x| format!("{x:.6}")).join(" ");
    print(&format!("mean        {}", three(result.mean_test)));
    print(&format!("reference   {}", three(result.mean_reference)));
    print(&format!("ratio       {}", three(result.channel_ratio)));
    if result.n_masked > 0 {
        print(&format!("masked      {} of {} pixels are not finite", result.n_masked, result.n_pixels));
    }
}

fn scale(image: &mut Image, factor: f32) {
    if factor != 1.0 {
        for channel in &mut image.channels {
            channel.values.iter_mut().for_each(|v| *v *= factor);
        }
    }
}
