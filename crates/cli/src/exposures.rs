//! `etendue hdr` and `etendue fuse`: one picture of several exposures.

use std::path::{Path, PathBuf};

use etendue::image::exposures::{Exposure, Fusion, Response, fuse, merge};
use etendue::image::{Encoding, Image, srgb_decode, srgb_encode};
use etendue::io::images::{exposure_of_photograph, read_image, write_image};

use crate::args::{FuseArguments, HdrArguments, ResponseArgument};
use crate::failure::{Failure, Result};
use crate::{outputs, report};

/// How smooth recovered responses are, as a weight against what the pixels say.
const SMOOTHNESS: f32 = 20.0;

/// Runs `hdr`.
pub(crate) fn hdr(arguments: &HdrArguments) -> Result<()> {
    outputs::check_images(&arguments.outputs)?;
    let times = times(arguments)?;
    let pictures = read_encoded(&arguments.images)?;
    let exposures: Vec<Exposure<'_>> = pictures
        .iter()
        .zip(times)
        .map(|(picture, seconds)| Exposure { pixels: &picture.pixels, seconds })
        .collect();
    let refuse = |error: etendue::image::exposures::ExposureError| Failure::Usage(error.to_string());
    let response = match arguments.response {
        ResponseArgument::Srgb => Response::of_encoding(Encoding::Srgb),
        ResponseArgument::Recover => Response::recover(&exposures, SMOOTHNESS).map_err(refuse)?,
    };
    let mut pixels = merge(&exposures, &response).map_err(refuse)?;
    if arguments.response == ResponseArgument::Recover || arguments.normalize {
        // A recovered response is known up to a factor.
        let largest = pixels.iter().flatten().copied().fold(0.0, f32::max);
        if largest > 0.0 {
            pixels.iter_mut().flatten().for_each(|value| *value /= largest);
        }
    }
    write(&arguments.outputs, &Image::rgb(pictures[0].width, pictures[0].height, pixels))
}

/// Runs `fuse`.
pub(crate) fn fusion(arguments: &FuseArguments) -> Result<()> {
    outputs::check_images(&arguments.outputs)?;
    let pictures = read_encoded(&arguments.images)?;
    let pixels: Vec<&[[f32; 3]]> = pictures.iter().map(|picture| &*picture.pixels).collect();
    let settings = Fusion {
        contrast: arguments.contrast,
        saturation: arguments.saturation,
        exposedness: arguments.exposedness,
    };
    let fused =
        fuse(&pixels, pictures[0].width, settings).map_err(|error| Failure::Usage(error.to_string()))?;
    let linear = fused.into_iter().map(|pixel| pixel.map(srgb_decode)).collect();
    write(&arguments.outputs, &Image::rgb(pictures[0].width, pictures[0].height, linear))
}

fn write(paths: &[PathBuf], image: &Image) -> Result<()> {
    outputs::write_all(paths, |path| write_image(path, image))
}

/// A picture as a camera stores it.
struct Photograph {
    width: usize,
    height: usize,
    pixels: Vec<[f32; 3]>,
}

/// Reads pictures of one size.
fn read_encoded(paths: &[PathBuf]) -> Result<Vec<Photograph>> {
    let pictures: Vec<Photograph> = paths.iter().map(|path| photograph(path)).collect::<Result<_>>()?;
    let size = |picture: &Photograph| [picture.width, picture.height];
    if let Some(index) = pictures.iter().position(|picture| size(picture) != size(&pictures[0])) {
        let [[w, h], [w0, h0]] = [size(&pictures[index]), size(&pictures[0])];
        let message =
            format!("{}: {w} x {h} pixels, where the first picture has {w0} x {h0}", paths[index].display());
        return Err(Failure::Usage(message));
    }
    Ok(pictures)
}

fn photograph(path: &Path) -> Result<Photograph> {
    let image = read_image(path).map_err(|error| Failure::Usage(error.to_string()))?;
    let Some(pixels) = image.rgb_pixels() else {
        return Err(Failure::Usage(format!("{}: there are no channels R, G, B or Y", path.display())));
    };
    report::non_finite(&path.display().to_string(), &pixels, "NaN is taken for black, infinity for white");
    // NaN becomes black: it would spread over the whole picture.
    let encode = |v: f32| if v > 0.0 { srgb_encode(v.min(1.0)) } else { 0.0 };
    let encoded = pixels.into_iter().map(|pixel| pixel.map(encode)).collect();
    Ok(Photograph { width: image.width, height: image.height, pixels: encoded })
}

/// The times as typed, or from the photographs.
fn times(arguments: &HdrArguments) -> Result<Vec<f32>> {
    let n = arguments.images.len();
    if let Some(times) = &arguments.times {
        if times.len() != n {
            return Err(Failure::Usage(format!("--times gives {} times for {n} pictures", times.len())));
        }
        return Ok(times.clone());
    }
    let time = |path: &PathBuf| {
        exposure_of_photograph(path).ok_or_else(|| {
            let message = "its Exif data does not tell the exposure time; give all with --times, such as --times 1/30,1/4";
            Failure::Usage(format!("{}: {message}", path.display()))
        })
    };
    arguments.images.iter().map(time).collect()
}
