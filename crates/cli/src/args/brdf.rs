//! Arguments of `brdf`.

use std::path::PathBuf;

use clap::Args;

/// Arguments of `brdf`.
#[derive(Args, Debug)]
pub(crate) struct BrdfArguments {
    /// Type of material, as `list materials` shows them
    #[arg(required_unless_present_any = ["scene", "all"], conflicts_with_all = ["scene", "all"])]
    pub(crate) model: Option<String>,
    /// Parameter of the material as in scene files, such as 'float roughness 0.3'; may repeat
    #[arg(long = "param", value_name = "TYPE NAME VALUE", requires = "model", allow_hyphen_values = true)]
    pub(crate) parameters: Vec<String>,
    /// Look at a material of this scene file
    #[arg(long, value_name = "FILE", requires = "material", conflicts_with = "all")]
    pub(crate) scene: Option<PathBuf>,
    /// Name of the material in the scene; of one without a name, its number in the file from 1
    #[arg(long, value_name = "NAME", requires = "scene")]
    pub(crate) material: Option<String>,
    /// Hold every configuration of every model against the laws
    #[arg(long, conflicts_with_all = ["outputs", "samples"])]
    pub(crate) all: bool,
    /// Print JSON
    #[arg(long)]
    pub(crate) json: bool,
    /// Page (.html), picture (.svg, .png) or table (.csv) to write; may repeat
    #[arg(short, long = "output", value_name = "OUT")]
    pub(crate) outputs: Vec<PathBuf>,
    /// Samples per pixel of the lit ball
    #[arg(long, value_name = "N", default_value = "64", value_parser = clap::value_parser!(u32).range(1..=4096), allow_negative_numbers = true)]
    pub(crate) samples: u32,
}
