//! `etendue compare`.

use etendue::image::Image;
use etendue::image::compare::{CompareError, DifferenceKind, Pair, Settings, compare};
use etendue::io::images::{read_image, write_image};
use serde_json::json;

use crate::args::{CompareArguments, MapArgument};
use crate::failure::{Failure, Result};
use crate::list::print;

/// Runs the command.
pub(crate) fn run(arguments: &CompareArguments) -> Result<()> {
    let open = |path| read_image(path).map_err(|error| Failure::Usage(error.to_string()));
    let (image, mut reference) = (open(&arguments.image)?, open(&arguments.reference)?);
    scale(&mut reference, arguments.scale_reference);
    let clamp = arguments.clamp.map(|max| [0.0, max]);
    let settings = Settings { clamp, flip_exposure_ev: arguments.exposure, ..Settings::default() };
    let refuse = |error: CompareError| Failure::Usage(error.to_string());
    let result = compare(&image, &reference, &settings).map_err(refuse)?;
    if let Some(path) = &arguments.output {
        let kind = match arguments.map {
            MapArgument::Flip => DifferenceKind::Flip { pixels_per_degree: settings.pixels_per_degree },
            MapArgument::Absolute => DifferenceKind::Absolute,
            MapArgument::Relative => DifferenceKind::RelativeSquared,
        };
        let map = Pair::new(&image, &reference, clamp).map_err(refuse)?.difference(kind);
        let full_scale = if arguments.map == MapArgument::Absolute { map.max() } else { 1.0 };
        write_image(path, &map.to_false_colors(full_scale))
            .map_err(|error| Failure::Running(error.to_string()))?;
    }
    let rows = [
        ("mse", result.mse),
        ("rmse", result.rmse),
        ("relmse", result.relmse),
        ("mape", result.mape),
        ("smape", result.smape),
        ("psnr", result.psnr_db),
        ("flip", result.flip),
        ("mean_ratio", result.mean_ratio),
    ];
    if arguments.json {
        let mut object = json!({
            "pixels": result.n_pixels,
            "masked": result.n_masked,
            "mean": result.mean_test,
            "mean_reference": result.mean_reference,
            "channel_ratio": result.channel_ratio,
        });
        for (name, value) in rows {
            object[name] = json!(value);
        }
        print(&object.to_string());
        return Ok(());
    }
    for (name, value) in rows {
        print(&format!("{name:<12}{value:.6}"));
    }
    let three = |v: [f64; 3]| v.map(|x| format!("{x:.6}")).join(" ");
    print(&format!("mean        {}", three(result.mean_test)));
    print(&format!("reference   {}", three(result.mean_reference)));
    print(&format!("ratio       {}", three(result.channel_ratio)));
    if result.n_masked > 0 {
        print(&format!("masked      {} of {} pixels are not finite", result.n_masked, result.n_pixels));
    }
    Ok(())
}

fn scale(image: &mut Image, factor: f32) {
    if factor != 1.0 {
        for channel in &mut image.channels {
            channel.values.iter_mut().for_each(|v| *v *= factor);
        }
    }
}
