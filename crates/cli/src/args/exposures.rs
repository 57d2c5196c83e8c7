//! Arguments of `hdr` and `fuse`.

use std::path::PathBuf;

use clap::{Args, ValueEnum};

/// Arguments of `hdr`.
#[derive(Args, Debug)]
pub(crate) struct HdrArguments {
    /// Photographs of one still scene, from one place
    #[arg(required = true)]
    pub(crate) images: Vec<PathBuf>,
    /// Output; may repeat
    #[arg(short, long = "output", value_name = "OUT", required = true)]
    pub(crate) outputs: Vec<PathBuf>,
    /// Exposure times in seconds, such as 1/30,0.25,2 [default: by the photographs' Exif data, with f-number and ISO]
    #[arg(long, value_name = "T,...", value_delimiter = ',', value_parser = parse_exposure_time, allow_negative_numbers = true)]
    pub(crate) times: Option<Vec<f32>>,
    /// What the camera makes of light
    #[arg(long, value_enum, default_value = "recover")]
    pub(crate) response: ResponseArgument,
    /// Divide by the largest value; a recovered response always does
    #[arg(long)]
    pub(crate) normalize: bool,
}

/// What a camera makes of light.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub(crate) enum ResponseArgument {
    /// Find it from the exposures
    Recover,
    /// The transfer curve of sRGB
    Srgb,
}

/// Arguments of `fuse`.
#[derive(Args, Debug)]
pub(crate) struct FuseArguments {
    /// Photographs of one still scene, from one place
    #[arg(required = true)]
    pub(crate) images: Vec<PathBuf>,
    /// Output; may repeat
    #[arg(short, long = "output", value_name = "OUT", required = true)]
    pub(crate) outputs: Vec<PathBuf>,
    /// How much contrast counts
    #[arg(long, default_value = "1", value_parser = parse_exponent, allow_negative_numbers = true)]
    pub(crate) contrast: f32,
    /// How much colour counts
    #[arg(long, default_value = "1", value_parser = parse_exponent, allow_negative_numbers = true)]
    pub(crate) saturation: f32,
    /// How much being neither dark nor bright counts
    #[arg(long, default_value = "1", value_parser = parse_exponent, allow_negative_numbers = true)]
    pub(crate) exposedness: f32,
}

/// A time in seconds, or a fraction of a second.
fn parse_exposure_time(text: &str) -> Result<f32, String> {
    let (over, under) = text.split_once('/').unwrap_or((text, "1"));
    match (over.parse::<f32>(), under.parse::<f32>()) {
        (Ok(a), Ok(b)) if a / b > 0.0 && (a / b).is_finite() => Ok(a / b),
        _ => Err("a time in seconds such as 0.25 or 1/30 is needed".to_owned()),
    }
}

fn parse_exponent(text: &str) -> Result<f32, String> {
    match text.parse::<f32>() {
        Ok(value) if (0.0..=16.0).contains(&value) => Ok(value),
        _ => Err("a number from 0 to 16 is needed".to_owned()),
    }
}
