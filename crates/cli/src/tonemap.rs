//! `etendue tonemap`.

use etendue::image::tonemap::{
    Dither, Operator, Quantization, Reinhard, ReinhardLocal, apply, automatic_exposure,
};
use etendue::image::{Image, srgb_encode};
use etendue::io::images::{DisplayPng, read_image, write_display_png, write_image, write_png, write_ppm};
use etendue::spectrum::cmyk::Cmyk;
use etendue::spectrum::{ColorSpace, ColorSpaceName, Primaries, Xyz, white_balance};

use crate::args::{EncodingArgument, Exposure, TonemapArguments};
use crate::failure::{Failure, Result};
use crate::{falsecolor, metadata, outputs, preview, primaries, report};

/// Runs the command.
pub(crate) fn run(arguments: &TonemapArguments) -> Result<()> {
    outputs::check_images(&arguments.outputs)?;
    if let Some(path) =
        arguments.outputs.iter().find(|path| arguments.cmyk && outputs::extension(path) != "exr")
    {
        return Err(Failure::Usage(format!("{}: inks are written as .exr", path.display())));
    }
    let mut image = read_image(&arguments.image).map_err(|error| Failure::Usage(error.to_string()))?;
    let name = arguments.image.display().to_string();
    let Some(pixels) = image.rgb_pixels() else {
        return Err(Failure::Usage(format!("{name}: there are no channels R, G, B or Y")));
    };
    let space = match arguments.encoding {
        EncodingArgument::Srgb => ColorSpaceName::Srgb,
        EncodingArgument::P3 => ColorSpaceName::DciP3,
        EncodingArgument::Pq => ColorSpaceName::Rec2020,
    };
    if let Some(path) = arguments
        .outputs
        .iter()
        .find(|path| arguments.encoding != EncodingArgument::Srgb && outputs::extension(path) != "png")
    {
        return Err(Failure::Usage(format!(
            "{}: only .png tells of encodings other than sRGB",
            path.display()
        )));
    }
    report::non_finite(&name, &pixels, "NaN is shown black, infinity white");
    leave_light(&mut image, space);
    if let Some(white) = arguments.white_balance {
        balance_white(&mut image, space, white);
    }
    let operator = with_options(arguments);
    let exposure = arguments.exposure.unwrap_or(match operator {
        Operator::Display(_) => Exposure::Automatic,
        _ => Exposure::Stops(0.0),
    });
    warn_of_what_is_unused(arguments, exposure);
    let stops = match exposure {
        Exposure::Stops(stops) => stops,
        Exposure::Automatic => {
            automatic_exposure(&image, arguments.key.map_or(MIDDLE_GREY, |key| key as f32))
        }
    };
    let mapped = match (arguments.encoding, operator) {
        // The file holds what is brighter than white too.
        (EncodingArgument::Pq, Operator::Clamp) => scaled(&image, stops.exp2()),
        _ => apply(&image, operator, stops),
    };
    if let Some(wish) = arguments.preview {
        let mut shown = mapped.clone();
        primaries::convert_from(&mut shown, Primaries::of(space), ColorSpaceName::Srgb);
        preview::show(&shown, wish);
    }
    if arguments.cmyk {
        let inks = inks(&mapped);
        return outputs::write_all(&arguments.outputs, |path| write_image(path, &inks));
    }
    let dither = if arguments.dither { Dither::Ordered } else { Dither::None };
    let quantization = Quantization { dither, ..Quantization::default() };
    let display = match arguments.encoding {
        EncodingArgument::Srgb => None,
        EncodingArgument::P3 => Some(DisplayPng::P3(dither)),
        EncodingArgument::Pq => Some(DisplayPng::Pq {
            white_luminance: arguments.white_luminance.unwrap_or(DisplayPng::PQ_WHITE),
        }),
    };
    outputs::write_all(&arguments.outputs, |path| match (outputs::extension(path).as_str(), display) {
        ("png", Some(display)) => write_display_png(path, &mapped, display),
        ("png", None) => write_png(path, &mapped, quantization),
        ("ppm", _) => write_ppm(path, &mapped, quantization),
        _ => write_image(path, &mapped),
    })
}

/// What automatic exposure gives the log-average luminance.
const MIDDLE_GREY: f32 = 0.18;

/// Options that this operator or encoding has no use for.
fn warn_of_what_is_unused(arguments: &TonemapArguments, exposure: Exposure) {
    let has_key = matches!(arguments.operator, Operator::Reinhard(_) | Operator::ReinhardLocal(_));
    if arguments.key.is_some() && !has_key && exposure != Exposure::Automatic {
        report::warning("--key has no effect: it is for reinhard, reinhard-local and --exposure auto");
    }
    if arguments.white.is_some() && !matches!(arguments.operator, Operator::Reinhard(_)) {
        report::warning("--white has no effect: it is for reinhard");
    }
    if arguments.white_luminance.is_some() && arguments.encoding != EncodingArgument::Pq {
        report::warning("--white-luminance has no effect: it is for --encoding pq");
    }
}

/// The operator, with the parameters that have options of their own.
fn with_options(arguments: &TonemapArguments) -> Operator {
    let mut operator = arguments.operator;
    match &mut operator {
        Operator::Reinhard(Reinhard { key, white, .. }) => {
            *key = arguments.key.map_or(*key, |key| key as f32);
            *white = arguments.white.map(|white| white as f32).or(*white);
        }
        Operator::ReinhardLocal(ReinhardLocal { key, .. }) => {
            *key = arguments.key.map_or(*key, |key| key as f32);
        }
        _ => {}
    }
    operator
}

/// What a picture tells of light, and no longer holds once it is made for a display.
const PHOTOMETRIC: [&str; 3] = [metadata::LUMINANCE, metadata::WHITE_LUMINANCE, falsecolor::UNIT];

/// Takes a picture to the primaries of a space from those that it states, else from those of sRGB.
fn leave_light(image: &mut Image, to: ColorSpaceName) {
    primaries::convert(image, to);
    image.metadata.retain(|key, _| !PHOTOMETRIC.contains(&key.as_str()));
}

fn scaled(image: &Image, factor: f32) -> Image {
    let mut scaled = image.clone();
    primaries::map_pixels(&mut scaled, |rgb| rgb.map(|value| value * factor));
    scaled
}

/// Scales the responses of the eye's cones so that light of this chromaticity becomes white.
fn balance_white(image: &mut Image, space: ColorSpaceName, white: [f32; 2]) {
    let space = ColorSpace::get(space);
    let target = space.to_xyz([1.0; 3]).chromaticity();
    let matrix = white_balance(white, target);
    primaries::map_pixels(image, |rgb| {
        let xyz = space.to_xyz(rgb).to_array();
        space.to_rgb(Xyz::from(matrix.map(|row| row[0] * xyz[0] + row[1] * xyz[1] + row[2] * xyz[2])))
    });
}

/// The inks of a picture, one channel each.
fn inks(picture: &Image) -> Image {
    let pixels = picture.rgb_pixels().unwrap_or_default();
    let inks: Vec<[f32; 4]> =
        pixels.iter().map(|rgb| Cmyk::from_rgb(rgb.map(srgb_encode)).to_array()).collect();
    let mut image = Image::new(picture.width, picture.height);
    for (i, name) in ["C", "M", "Y", "K"].into_iter().enumerate() {
        image.set_channel(name, inks.iter().map(|inks| inks[i]).collect());
    }
    image
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A picture for a display tells no candelas, and no weights of primaries that it left.
    #[test]
    fn light_is_not_told_of_displays() {
        let mut image = Image::rgb(1, 1, vec![[0.5; 3]]);
        for key in PHOTOMETRIC.into_iter().chain([metadata::COLOR_SPACE, "software"]) {
            image.metadata.insert(key.to_owned(), "rec2020".to_owned());
        }
        leave_light(&mut image, ColorSpaceName::Srgb);
        assert_eq!(image.metadata.into_keys().collect::<Vec<_>>(), ["software"]);
    }
}
