//! `etendue tonemap`.

use etendue::image::tonemap::{
    Dither, Operator, Quantization, Reinhard, ReinhardLocal, apply, automatic_exposure,
};
use etendue::image::{Image, srgb_encode};
use etendue::io::images::{read_image, write_image, write_png, write_ppm};
use etendue::spectrum::cmyk::Cmyk;
use etendue::spectrum::{ColorSpace, ColorSpaceName, Xyz, white_balance};

use crate::args::{Exposure, TonemapArguments};
use crate::failure::{Failure, Result};
use crate::outputs;

/// Runs the command.
pub(crate) fn run(arguments: &TonemapArguments) -> Result<()> {
    outputs::check_images(&arguments.outputs)?;
    if let Some(path) =
        arguments.outputs.iter().find(|path| arguments.cmyk && outputs::extension(path) != "exr")
    {
        return Err(Failure::Usage(format!("{}: inks are written as .exr", path.display())));
    }
    let mut image = read_image(&arguments.image).map_err(|error| Failure::Usage(error.to_string()))?;
    if image.rgb_pixels().is_none() {
        return Err(Failure::Usage(format!(
            "{}: there are no channels R, G, B or Y",
            arguments.image.display()
        )));
    }
    if let Some(white) = arguments.white_balance {
        balance_white(&mut image, white);
    }
    let operator = with_options(arguments);
    let exposure = arguments.exposure.unwrap_or(match operator {
        Operator::Display(_) => Exposure::Automatic,
        _ => Exposure::Stops(0.0),
    });
    let stops = match exposure {
        Exposure::Stops(stops) => stops,
        Exposure::Automatic => {
            automatic_exposure(&image, arguments.key.map_or(MIDDLE_GREY, |key| key as f32))
        }
    };
    let mapped = apply(&image, operator, stops);
    if arguments.cmyk {
        let inks = inks(&mapped);
        return outputs::write_all(&arguments.outputs, |path| write_image(path, &inks));
    }
    let dither = if arguments.dither { Dither::Ordered } else { Dither::None };
    let quantization = Quantization { dither, ..Quantization::default() };
    outputs::write_all(&arguments.outputs, |path| match outputs::extension(path).as_str() {
        "png" => write_png(path, &mapped, quantization),
        "ppm" => write_ppm(path, &mapped, quantization),
        _ => write_image(path, &mapped),
    })
}

/// What automatic exposure gives the log-average luminance.
const MIDDLE_GREY: f32 = 0.18;

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

/// Scales the responses of the eye's cones so that light of this chromaticity becomes white.
fn balance_white(image: &mut Image, white: [f32; 2]) {
    let space = ColorSpace::get(ColorSpaceName::Srgb);
    let target = space.to_xyz([1.0; 3]).chromaticity();
    let matrix = white_balance(white, target);
    let pixels = image.rgb_pixels().unwrap_or_default().into_iter().map(|rgb| {
        let xyz = space.to_xyz(rgb).to_array();
        space.to_rgb(Xyz::from(matrix.map(|row| row[0] * xyz[0] + row[1] * xyz[1] + row[2] * xyz[2])))
    });
    let pixels: Vec<[f32; 3]> = pixels.collect();
    image.set_rgb("", &pixels);
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
