//! Arguments of `merge`.

use std::path::PathBuf;

use clap::Args;

/// Arguments of `merge`.
#[derive(Args, Debug)]
pub(crate) struct MergeArguments {
    /// EXR files of one scene
    #[arg(required = true, num_args = 2..)]
    pub(crate) images: Vec<PathBuf>,
    /// Output; may repeat
    #[arg(short, long = "output", value_name = "OUT", required = true)]
    pub(crate) outputs: Vec<PathBuf>,
}
