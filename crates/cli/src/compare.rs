//! `etendue compare`.

use std::path::Path;

use etendue::image::compare::{
    BEYOND, CompareError, Comparison, DifferenceKind, DifferenceMap, Pair, Settings, VARIANCE, ZTest,
    compare, side_by_side, split,
};
use etendue::image::{Image, box_downsample};
use etendue::io::images::{read_image, write_image};
use etendue::spectrum::ColorSpaceName;
use serde_json::json;

use crate::args::{CompareArguments, MapArgument};
use crate::failure::{Failure, Result};
use crate::list::print;
use crate::{outputs, primaries};

/// Everything that was measured.
struct Measured {
    comparison: Comparison,
    /// Mean of HDR-FLIP, of pictures with radiance.
    hdr_flip: Option<f64>,
    /// Of pictures with variance.
    z_test: Option<ZTest>,
}

/// Runs the command.
pub(crate) fn run(arguments: &CompareArguments) -> Result<()> {
    outputs::check_images(&arguments.outputs)?;
    let open = |path| read_image(path).map_err(|error| Failure::Usage(error.to_string()));
    let (mut image, mut reference) = (open(&arguments.image)?, open(&arguments.reference)?);
    for image in [&mut image, &mut reference] {
        primaries::convert(image, ColorSpaceName::Srgb);
    }
    scale(&mut reference, arguments.scale_reference);
    if arguments.box_filter {
        equalize_sizes(&mut image, &mut reference, arguments.clamp);
    }
    let settings = Settings {
        clamp: arguments.clamp.map(|max| [0.0, max]),
        flip_exposure_ev: arguments.exposure,
        pixels_per_degree: arguments.pixels_per_degree,
        ..Settings::default()
    };
    let (name, reference_name) = (arguments.image.display(), arguments.reference.display());
    let refuse = |error: CompareError| Failure::Usage(format!("{name} and {reference_name}: {error}"));
    let pair = Pair::new(&image, &reference, settings.clamp).map_err(refuse)?;
    let z_test = ZTest::new(&image, &reference).map_err(refuse)?;
    if !arguments.outputs.is_empty() {
        let picture = picture(arguments.map, [&image, &reference], &pair, z_test.as_ref(), &settings)?;
        outputs::write_all(&arguments.outputs, |path| write_image(path, &picture))?;
    }
    let comparison = compare(&image, &reference, &settings).map_err(refuse)?;
    let has_radiance = [&arguments.image, &arguments.reference].into_iter().all(|path| has_radiance(path));
    let hdr_flip = has_radiance.then(|| pair.mean_of_map(&pair.hdr_flip_map(settings.pixels_per_degree)));
    let measured = Measured { comparison, hdr_flip, z_test };
    if arguments.json {
        print_json(&measured)
    } else {
        print_lines(&measured)
    }
    Ok(())
}

/// True of formats that are not limited to what a display shows.
fn has_radiance(path: &Path) -> bool {
    matches!(outputs::extension(path).as_str(), "exr" | "hdr" | "pic" | "pfm")
}

/// Box-filters the larger image to the size of the smaller, if it is a whole multiple. Values are clamped before they
/// are averaged, since one overexposed pixel would outweigh its neighbours. The variance of a mean of n pixels is a share
/// 1 / n of theirs.
fn equalize_sizes(image: &mut Image, reference: &mut Image, clamp: Option<f32>) {
    let (small, large) = if image.width < reference.width { (image, reference) } else { (reference, image) };
    let factor = large.width / small.width.max(1);
    if factor > 1 && large.width == factor * small.width && large.height == factor * small.height {
        if let Some(max) = clamp {
            let values = large.channels.iter_mut().filter(|channel| channel.name != VARIANCE);
            values.flat_map(|channel| &mut channel.values).for_each(|v| *v = v.clamp(0.0, max));
        }
        *large = box_downsample(large, factor);
        if let Some(variance) = large.channel_mut(VARIANCE) {
            variance.values.iter_mut().for_each(|v| *v /= (factor * factor) as f32);
        }
    }
}

/// The picture that was asked for.
fn picture(
    map: MapArgument,
    [image, reference]: [&Image; 2],
    pair: &Pair,
    z_test: Option<&ZTest>,
    settings: &Settings,
) -> Result<Image> {
    let &Settings { pixels_per_degree, flip_exposure_ev: exposure_ev, .. } = settings;
    let flip = DifferenceKind::Flip { pixels_per_degree, exposure_ev };
    let no_color = || Failure::Usage("the images have no colour to show".to_owned());
    let colored = |kind, full_scale: fn(&DifferenceMap) -> f32| {
        let map = pair.difference(kind);
        let full_scale = full_scale(&map);
        map.to_false_colors(if full_scale > 0.0 { full_scale } else { 1.0 })
    };
    Ok(match map {
        MapArgument::Flip => colored(flip, |_| 1.0),
        MapArgument::HdrFlip => colored(DifferenceKind::HdrFlip { pixels_per_degree }, |_| 1.0),
        MapArgument::Absolute => colored(DifferenceKind::Absolute, DifferenceMap::max),
        MapArgument::Signed => colored(DifferenceKind::Signed, DifferenceMap::max),
        MapArgument::Relative => colored(DifferenceKind::RelativeSquared, |_| 1.0),
        MapArgument::Z => {
            let missing = || Failure::Usage(format!("a map of z needs a channel {VARIANCE} in both images"));
            let values = z_test.ok_or_else(missing)?.z.clone();
            let kind = DifferenceKind::Signed;
            DifferenceMap { width: image.width, height: image.height, kind, values }
                .to_false_colors(BEYOND as f32)
        }
        MapArgument::SideBySide => {
            let (image, reference) = (exposed(image, exposure_ev), exposed(reference, exposure_ev));
            side_by_side(&[&image, &reference, &colored(flip, |_| 1.0)]).ok_or_else(no_color)?
        }
        MapArgument::Split => {
            split(&exposed(image, exposure_ev), &exposed(reference, exposure_ev)).ok_or_else(no_color)?
        }
    })
}

/// The colour of an image, brighter by so many stops.
fn exposed(image: &Image, stops: f32) -> Image {
    let mut image = Image::rgb(image.width, image.height, image.rgb_pixels().unwrap_or_default());
    scale(&mut image, stops.exp2());
    image
}

/// The numbers of a comparison with their names, which are stable.
fn rows(measured: &Measured) -> Vec<(&'static str, f64)> {
    let result = &measured.comparison;
    let mut rows = vec![
        ("mse", result.mse),
        ("rmse", result.rmse),
        ("relmse", result.relmse),
        ("relmse_trimmed", result.relmse_trimmed),
        ("mape", result.mape),
        ("smape", result.smape),
        ("psnr", result.psnr_db),
        ("ssim", result.ssim),
        ("flip", result.flip),
    ];
    rows.extend(measured.hdr_flip.map(|value| ("hdr_flip", value)));
    rows.push(("mean_ratio", result.mean_ratio));
    if let Some(test) = &measured.z_test {
        rows.extend([
            ("z_rms", test.rms),
            ("z_beyond_3", test.share_beyond),
            ("z_mean", test.z_mean),
            ("p_mean", test.p_mean),
        ]);
    }
    rows
}

fn print_json(measured: &Measured) {
    let result = &measured.comparison;
    let mut object = json!({
        "pixels": result.n_pixels,
        "masked": result.n_masked,
        "mean": result.mean_test,
        "mean_reference": result.mean_reference,
        "channel_ratio": result.channel_ratio,
    });
    if let Some(test) = &measured.z_test {
        object["z_pixels"] = json!(test.n_tested);
        object["z_untested"] = json!(test.n_untested);
    }
    for (name, value) in rows(measured) {
        object[name] = json!(value);
    }
    print(&object.to_string());
}

fn print_lines(measured: &Measured) {
    let result = &measured.comparison;
    for (name, value) in rows(measured) {
        print(&format!("{name:<16}{value:.6}"));
    }
    let three = |v: [f64; 3]| v.map(|x| format!("{x:.6}")).join(" ");
    print(&format!("mean            {}", three(result.mean_test)));
    print(&format!("reference       {}", three(result.mean_reference)));
    print(&format!("ratio           {}", three(result.channel_ratio)));
    if let Some(test) = measured.z_test.as_ref().filter(|test| test.n_untested > 0) {
        print(&format!(
            "z_untested      {} of {} pixels differ but have no variance",
            test.n_untested, result.n_pixels
        ));
    }
    if result.n_masked > 0 {
        let (n_test, n_reference) = (result.n_non_finite_test, result.n_non_finite_reference);
        print(&format!(
            "masked          {} of {} pixels are not finite ({n_test} of the image, {n_reference} of the reference)",
            result.n_masked, result.n_pixels
        ));
    }
}

/// Multiplies all values; variances by the square.
fn scale(image: &mut Image, factor: f32) {
    if factor != 1.0 {
        for channel in &mut image.channels {
            let factor = if channel.name == VARIANCE { factor * factor } else { factor };
            channel.values.iter_mut().for_each(|v| *v *= factor);
        }
    }
}
