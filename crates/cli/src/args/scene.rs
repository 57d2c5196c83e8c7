//! Arguments of `info`, `list`, `convert` and `scene`.

use std::path::PathBuf;

use clap::{Args, ValueEnum};

/// Arguments of `info`.
#[derive(Args, Debug)]
pub(crate) struct InfoArguments {
    /// Scene file, photon map or picture
    pub(crate) scene: PathBuf,
    /// Print one JSON object
    #[arg(long)]
    pub(crate) json: bool,
}

/// Arguments of `list`.
#[derive(Args, Debug)]
pub(crate) struct ListArguments {
    /// What to list
    #[arg(value_enum)]
    pub(crate) kind: ListKind,
    /// Print one JSON object
    #[arg(long)]
    pub(crate) json: bool,
}

/// What can be listed.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
#[allow(missing_docs, reason = "each is what its name says")]
pub(crate) enum ListKind {
    Integrators,
    Materials,
    Textures,
    Lights,
    Shapes,
    Media,
    Cameras,
    Films,
    Samplers,
    Filters,
    Accelerators,
    Tonemappers,
    Spectra,
    Scenes,
}

/// Arguments of `convert`.
#[derive(Args, Debug)]
pub(crate) struct ConvertArguments {
    /// Scene: .pbrt, .gltf, .glb, .xml (Mitsuba), .obj or .ply
    pub(crate) scene: PathBuf,
    /// Output: NAME.pbrt; meshes and pictures that no file holds go to NAME-meshes and NAME-textures
    pub(crate) output: PathBuf,
    /// Leave out warnings
    #[arg(short, long)]
    pub(crate) quiet: bool,
}

/// Arguments of `scene`.
#[derive(Args, Debug)]
pub(crate) struct SceneArguments {
    /// Name of the scene
    #[arg(required_unless_present = "all", conflicts_with = "all")]
    pub(crate) name: Option<String>,
    /// Write every scene with its defaults
    #[arg(long, conflicts_with = "parameters")]
    pub(crate) all: bool,
    /// Parameter of the scene; may repeat
    #[arg(long = "param", value_name = "NAME=VALUE", value_parser = parse_setting)]
    pub(crate) parameters: Vec<(String, String)>,
    /// Folder to write to
    #[arg(short, long = "output", value_name = "DIR", default_value = ".")]
    pub(crate) out: PathBuf,
}

fn parse_setting(text: &str) -> Result<(String, String), String> {
    let (name, value) = text.split_once('=').ok_or("a parameter is NAME=VALUE, such as seed=2")?;
    Ok((name.trim().to_owned(), value.trim().to_owned()))
}
