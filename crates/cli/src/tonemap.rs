//! `etendue tonemap`.

use etendue::image::tonemap::{Dither, Operator, Quantization, Reinhard, apply};
use etendue::image::{Image, srgb_encode};
use etendue::io::images::{read_image, write_image, write_png, write_ppm};
use etendue::spectrum::cmyk::Cmyk;

use crate::args::{OperatorArgument, TonemapArguments};
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
    let image = read_image(&arguments.image).map_err(|error| Failure::Usage(error.to_string()))?;
    if image.rgb_pixels().is_none() {
        return Err(Failure::Usage(format!(
            "{}: there are no channels R, G, B or Y",
            arguments.image.display()
        )));
    }
    let operator = match arguments.operator {
        OperatorArgument::Clamp => Operator::Clamp,
        OperatorArgument::Maximum => Operator::DivideByMaximum,
        OperatorArgument::Exponential => Operator::Exponential,
        OperatorArgument::Reinhard => Operator::Reinhard(Reinhard {
            key: arguments.key as f32,
            white: arguments.white.map(|w| w as f32),
            ..Reinhard::default()
        }),
    };
    let mapped = apply(&image, operator, arguments.exposure);
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
