//! Arguments of `image`.

use std::path::PathBuf;

use clap::{Args, Subcommand};

/// Arguments of `image`.
#[derive(Args, Debug)]
pub(crate) struct ImageArguments {
    /// What to do.
    #[command(subcommand)]
    pub(crate) command: ImageCommand,
}

/// What to do with a picture file.
#[derive(Debug, Subcommand)]
pub(crate) enum ImageCommand {
    /// Print size, windows, layers, types, metadata and statistics
    Info(ImageInfoArguments),
    /// Write a picture in another format, or one of its layers
    Convert(ImageConvertArguments),
}

/// Arguments of `image info`.
#[derive(Args, Debug)]
pub(crate) struct ImageInfoArguments {
    /// Picture
    pub(crate) image: PathBuf,
    /// Print one JSON object
    #[arg(long)]
    pub(crate) json: bool,
}

/// Arguments of `image convert`.
#[derive(Args, Debug)]
pub(crate) struct ImageConvertArguments {
    /// Picture
    pub(crate) image: PathBuf,
    /// Output; may repeat
    #[arg(short, long = "output", value_name = "OUT", required = true)]
    pub(crate) outputs: Vec<PathBuf>,
    /// Take this layer alone, as the picture
    #[arg(long, value_name = "NAME")]
    pub(crate) layer: Option<String>,
    /// How .exr outputs are written
    #[command(flatten)]
    pub(crate) exr: ExrArguments,
}

/// How .exr outputs are written.
#[derive(Args, Clone, Copy, Debug)]
pub(crate) struct ExrArguments {
    /// Half precision for colours in .exr; depth, positions and variances keep single precision
    #[arg(long)]
    pub(crate) half: bool,
    /// Tiles of 64 x 64 pixels in .exr in place of rows
    #[arg(long)]
    pub(crate) tiles: bool,
}
