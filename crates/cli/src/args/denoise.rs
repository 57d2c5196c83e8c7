//! Arguments of `denoise`.

use std::path::PathBuf;

use clap::{Args, ValueEnum};

/// Arguments of `denoise`.
#[derive(Args, Debug)]
pub(crate) struct DenoiseArguments {
    /// Render as .exr, best by `render --features`
    pub(crate) image: PathBuf,
    /// Output; may repeat
    #[arg(short, long = "output", value_name = "OUT", required = true)]
    pub(crate) outputs: Vec<PathBuf>,
    /// Spread the excess of fireflies over their neighbours first; the mean of the picture stays
    #[arg(long)]
    pub(crate) fireflies: bool,
    /// Spread fireflies, and leave all else as it is
    #[arg(long, conflicts_with = "with")]
    pub(crate) fireflies_only: bool,
    /// What denoises
    #[arg(long, value_enum, default_value = "native")]
    pub(crate) with: DenoiserArgument,
    /// Number of threads [default: all cores]; it does not change the image
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u64).range(1..1024), allow_negative_numbers = true)]
    pub(crate) threads: Option<u64>,
    /// Print errors alone
    #[arg(short, long)]
    pub(crate) quiet: bool,
}

/// What denoises.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub(crate) enum DenoiserArgument {
    /// Regression on features, in this program
    Native,
    /// Open Image Denoise, where its program oidnDenoise is installed
    Oidn,
}
