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
    /// Write a false-colour picture of the difference
    #[arg(short, long = "output", value_name = "MAP")]
    pub(crate) output: Option<PathBuf>,
    /// What the picture shows
    #[arg(long, value_enum, default_value = "flip")]
    pub(crate) map: MapArgument,
    /// Clamp both images to this largest value first
    #[arg(long, value_name = "MAX")]
    pub(crate) clamp: Option<f32>,
    /// Average blocks of the larger image where it is a whole multiple of the smaller
    #[arg(long)]
    pub(crate) box_filter: bool,
    /// Multiply the reference by this first
    #[arg(long, value_name = "FACTOR", default_value = "1")]
    pub(crate) scale_reference: f32,
    /// Exposure for FLIP, in stops
    #[arg(long, value_name = "EV", default_value = "0", allow_negative_numbers = true)]
    pub(crate) exposure: f32,
}

/// What a difference picture shows.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub(crate) enum MapArgument {
    /// FLIP error
    Flip,
    /// Absolute difference
    Absolute,
    /// Squared difference relative to the reference
    Relative,
}
