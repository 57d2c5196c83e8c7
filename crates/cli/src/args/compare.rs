//! Arguments of `compare`.

use std::path::PathBuf;

use clap::{Args, ValueEnum};

/// Arguments of `compare`.
#[derive(Args, Debug)]
pub(crate) struct CompareArguments {
    /// Image to judge
    pub(crate) image: PathBuf,
    /// Image to judge it by
    pub(crate) reference: PathBuf,
    /// Print one JSON object
    #[arg(long)]
    pub(crate) json: bool,
    /// Write a picture of the difference; may repeat
    #[arg(short, long = "output", visible_alias = "difference", value_name = "MAP")]
    pub(crate) outputs: Vec<PathBuf>,
    /// What the picture shows
    #[arg(long, value_enum, default_value = "flip")]
    pub(crate) map: MapArgument,
    /// Clamp both images to this largest value first
    #[arg(long, value_name = "MAX", value_parser = parse_largest, allow_negative_numbers = true)]
    pub(crate) clamp: Option<f32>,
    /// Average blocks of the larger image where it is a whole multiple of the smaller
    #[arg(long)]
    pub(crate) box_filter: bool,
    /// Multiply the reference by this first
    #[arg(long, value_name = "FACTOR", default_value = "1", value_parser = parse_largest, allow_negative_numbers = true)]
    pub(crate) scale_reference: f32,
    /// Exposure for FLIP, SSIM and pictures of both, in stops
    #[arg(long, value_name = "EV", default_value = "0", value_parser = parse_stops, allow_negative_numbers = true)]
    pub(crate) exposure: f32,
    /// Pixels per degree of visual angle of FLIP's observer
    #[arg(long, value_name = "N", default_value = "67.02064", value_parser = parse_pixels_per_degree, allow_negative_numbers = true)]
    pub(crate) pixels_per_degree: f32,
}

/// What a difference picture shows.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub(crate) enum MapArgument {
    /// FLIP error
    Flip,
    /// Largest FLIP error over all exposures
    HdrFlip,
    /// Absolute difference of luminance
    Absolute,
    /// Where the image is brighter (red) or darker (blue)
    Signed,
    /// Squared difference relative to the reference
    Relative,
    /// Difference in standard errors, blue and red at 3; both need a variance
    Z,
    /// Image, reference and FLIP error beside each other
    SideBySide,
    /// Left half of the image, right half of the reference
    Split,
}

fn parse_stops(text: &str) -> Result<f32, String> {
    let stops = text.parse::<f32>().ok().filter(|stops| stops.abs() <= 100.0);
    stops.ok_or_else(|| "stops between -100 and 100 are needed".to_owned())
}

/// FLIP's kernels are as wide as a sixth of this many pixels.
fn parse_pixels_per_degree(text: &str) -> Result<f32, String> {
    let number = text.parse::<f32>().ok().filter(|number| (1.0..=1000.0).contains(number));
    number.ok_or_else(|| "a number from 1 to 1000 is needed".to_owned())
}

/// A range from 0 needs an end above it, and a factor leaves something.
fn parse_largest(text: &str) -> Result<f32, String> {
    let number = text.parse::<f32>().ok().filter(|number| *number > 0.0 && number.is_finite());
    number.ok_or_else(|| "a positive number is needed".to_owned())
}

#[cfg(test)]
mod tests {
    use super::*;

    /// What no range ends at is refused before anything is clamped.
    #[test]
    fn largest_values() {
        assert_eq!(parse_largest("2.5"), Ok(2.5));
        for bad in ["-1", "0", "NaN", "x"] {
            assert!(parse_largest(bad).is_err(), "{bad}");
        }
    }
}
