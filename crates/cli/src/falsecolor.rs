//! `etendue falsecolor`: maps of luminance and illuminance for lighting reports.

use etendue::image::Image;
use etendue::image::falsecolor::{FalseColors, Palette, Scale, Spread, enlarged};
use etendue::io::images::{read_image, write_image};
use serde_json::json;

use crate::args::{FalsecolorArguments, PaletteArgument, QuantityArgument, SpreadArgument};
use crate::failure::{Failure, Result};
use crate::list::print;
use crate::{metadata, outputs, primaries, report};

/// Metadata key for the unit of a picture's values.
pub(crate) const UNIT: &str = "etendue.unit";
/// What `probe` writes there.
pub(crate) const LUX: &str = "lx";

/// Longer side in pixels that maps of fewer are enlarged to, about.
const LEAST_SIDE: usize = 360;

/// Runs the command.
pub(crate) fn run(arguments: &FalsecolorArguments) -> Result<()> {
    outputs::check_images(&arguments.outputs)?;
    let image = read_image(&arguments.image).map_err(|error| Failure::Usage(error.to_string()))?;
    let refuse = |message: &str| Failure::Usage(format!("{}: {message}", arguments.image.display()));
    let mut values = photometric(&image).ok_or_else(|| refuse("there are no channels R, G, B or Y"))?;
    let name = arguments.image.display().to_string();
    report::non_finite(&name, values.as_chunks::<1>().0, "they are left out of the statistics");
    if !values.iter().any(|value| value.is_finite()) {
        return Err(refuse("no pixel is finite"));
    }
    let is_lux = is_lux(&image);
    let default = if is_lux || arguments.reflectance.is_some() {
        QuantityArgument::Illuminance
    } else {
        QuantityArgument::Luminance
    };
    let quantity = arguments.quantity.unwrap_or(default);
    let factor = match (quantity, is_lux, arguments.reflectance) {
        (QuantityArgument::Luminance, false, None) | (QuantityArgument::Illuminance, true, None) => 1.0,
        (QuantityArgument::Illuminance, false, Some(reflectance)) => std::f64::consts::PI / reflectance,
        (QuantityArgument::Illuminance, false, None) => {
            let message = "illuminance follows from luminance where the surfaces' --reflectance is known; or let `etendue probe --grid` measure it";
            return Err(refuse(message));
        }
        (QuantityArgument::Luminance, _, Some(_)) => {
            return Err(refuse("--reflectance is for illuminance from luminance"));
        }
        (_, true, _) => return Err(refuse("this picture holds illuminance, not luminance")),
    } * arguments.multiply;
    values.iter_mut().for_each(|value| *value = (f64::from(*value) * factor) as f32);
    let tells_unit = [UNIT, metadata::WHITE_LUMINANCE].iter().any(|key| image.metadata.contains_key(*key));
    if arguments.multiply == 1.0 && !tells_unit {
        report::warning(&format!(
            "{}: it does not tell the unit of its values, which are taken for cd/m²; see --multiply",
            arguments.image.display()
        ));
    }
    let unit = if quantity == QuantityArgument::Luminance { "cd/m²" } else { "lx" };
    let colors = FalseColors {
        scale: scale(arguments, &values)?,
        palette: match arguments.palette {
            PaletteArgument::Spectrum => Palette::Spectrum,
            PaletteArgument::Heat => Palette::Heat,
            PaletteArgument::Gray => Palette::Gray,
        },
        contours: !arguments.no_contours,
        unit: (!arguments.no_legend).then(|| unit.to_owned()),
    };
    // Grids of few fields become large enough to read.
    let factor = (LEAST_SIDE / image.width.max(image.height)).max(1);
    let picture = colors.draw(&enlarged(&values, image.width, factor), factor * image.width);
    outputs::write_all(&arguments.outputs, |path| write_image(path, &picture))?;
    print_statistics(&values, unit, arguments.json);
    Ok(())
}

/// True of pictures of illuminance.
pub(crate) fn is_lux(image: &Image) -> bool {
    image.metadata.get(UNIT).is_some_and(|unit| unit == LUX)
}

/// Luminance or what else a picture holds, by the weights and the exposure that it states.
fn photometric(image: &Image) -> Option<Vec<f32>> {
    let white = metadata::numbers::<f32, 1>(image, metadata::WHITE_LUMINANCE).map_or(1.0, |[white]| white);
    let is_valid = white > 0.0 && white.is_finite() && !is_lux(image);
    let white = if is_valid { white } else { 1.0 };
    if let (None, Some(y)) = (image.channel("R"), image.channel("Y")) {
        return Some(y.values.iter().map(|y| y * white).collect());
    }
    let weights = primaries::luminance_weights(image);
    let luminance = |p: [f32; 3]| (p[0] * weights[0] + p[1] * weights[1] + p[2] * weights[2]) * white;
    Some(image.rgb_pixels()?.into_iter().map(luminance).collect())
}

fn scale(arguments: &FalsecolorArguments, values: &[f32]) -> Result<Scale> {
    let spread = match arguments.scale {
        SpreadArgument::Auto => None,
        SpreadArgument::Linear => Some(Spread::Linear),
        SpreadArgument::Log => Some(Spread::Logarithmic),
    };
    let Some([low, high]) = arguments.range else { return Ok(Scale::fitting(values, spread)) };
    let refuse = || Failure::Usage("--range: a logarithmic scale starts above 0".to_owned());
    Scale::new(spread.unwrap_or(Spread::Linear), low, high).ok_or_else(refuse)
}

/// What a lighting report states of a field: least, mean and largest value, and the least over the mean (uniformity).
fn print_statistics(values: &[f32], unit: &str, as_json: bool) {
    let finite: Vec<f64> = values.iter().filter(|v| v.is_finite()).map(|v| f64::from(*v)).collect();
    let n_masked = values.len() - finite.len();
    let mean = finite.iter().sum::<f64>() / finite.len() as f64;
    let min = finite.iter().copied().fold(f64::INFINITY, f64::min);
    let max = finite.iter().copied().fold(f64::NEG_INFINITY, f64::max);
    let uniformity = min / mean;
    if as_json {
        let object = json!({
            "unit": unit, "min": min, "mean": mean, "max": max, "uniformity": uniformity, "masked": n_masked,
        });
        print(&object.to_string());
        return;
    }
    for (name, value) in [("min", min), ("mean", mean), ("max", max)] {
        print(&format!("{name:<12}{value:.6} {unit}"));
    }
    print(&format!("min / mean  {uniformity:.6}"));
    if n_masked > 0 {
        print(&format!("masked      {n_masked} of {} pixels are not finite", values.len()));
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Gray pictures have an exposure too; illuminance has none.
    #[test]
    fn exposure_of_gray_pictures() {
        let mut image = Image::gray(2, 1, vec![1.0, 3.0]);
        image.metadata.insert(metadata::WHITE_LUMINANCE.to_owned(), "50".to_owned());
        assert_eq!(photometric(&image), Some(vec![50.0, 150.0]));
        image.metadata.insert(UNIT.to_owned(), LUX.to_owned());
        assert_eq!(photometric(&image), Some(vec![1.0, 3.0]));
    }
}
