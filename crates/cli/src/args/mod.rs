//! The command line as typed; a file for each command, or for some that are alike.

mod brdf;
mod compare;
mod denoise;
mod exposures;
mod falsecolor;
mod image;
mod merge;
mod photons;
mod render;
mod scene;
mod study;
mod tonemap;
mod values;

use clap::{Parser, Subcommand};

pub(crate) use brdf::BrdfArguments;
pub(crate) use compare::{CompareArguments, MapArgument};
pub(crate) use denoise::{DenoiseArguments, DenoiserArgument};
pub(crate) use exposures::{FuseArguments, HdrArguments, ResponseArgument};
pub(crate) use falsecolor::{
    FalsecolorArguments, PaletteArgument, ProbeArguments, QuantityArgument, SpreadArgument,
};
pub(crate) use image::{ExrArguments, ImageArguments, ImageCommand, ImageConvertArguments};
pub(crate) use merge::MergeArguments;
pub(crate) use photons::{PhotonKindArgument, PhotonMapArgument, PhotonsArguments};
pub(crate) use render::{RenderArguments, WavelengthArgument};
pub(crate) use scene::{ConvertArguments, InfoArguments, ListArguments, ListKind, SceneArguments};
pub(crate) use study::{BenchArguments, StudyArguments, StudyName};
pub(crate) use tonemap::{EncodingArgument, Exposure, PreviewArgument, TonemapArguments};

/// Physically based rendering: spectral, reproducible, honest about its error.
#[derive(Debug, Parser)]
#[command(name = "etendue", version, about)]
pub(crate) struct Arguments {
    /// What to do.
    #[command(subcommand)]
    pub(crate) command: Command,
}

/// What to do.
#[derive(Debug, Subcommand)]
pub(crate) enum Command {
    /// Render a scene
    Render(Box<RenderArguments>),
    /// Tell what a scene holds
    Info(InfoArguments),
    /// Show what scene files may name: parameters, units, defaults
    List(ListArguments),
    /// Measure how two images differ
    Compare(CompareArguments),
    /// Write a scene of any format as a pbrt-v4 scene
    Convert(ConvertArguments),
    /// Add renders that were split over passes, or that are independent
    Merge(MergeArguments),
    /// Turn radiance into a picture for a display
    Tonemap(TonemapArguments),
    /// Look into a picture file, or write it in another format
    Image(ImageArguments),
    /// Draw a map of luminance or illuminance in false colours, with legend and contour lines
    Falsecolor(FalsecolorArguments),
    /// Measure illuminance and luminance at points of a scene or on a grid
    Probe(ProbeArguments),
    /// Make a picture with linear radiance of photographs by several exposures
    Hdr(HdrArguments),
    /// Blend photographs by several exposures into one picture, without radiance
    Fuse(FuseArguments),
    /// Remove noise from a render, guided by what `render --features` records
    Denoise(DenoiseArguments),
    /// Run an experiment with the renderer: a table and a figure
    Study(StudyArguments),
    /// Look at how a material scatters light: curves, a lit ball, and how well it keeps the laws
    Brdf(BrdfArguments),
    /// Tell how fast this machine is: rays, paths, look-ups and more per second
    Bench(BenchArguments),
    /// Write a scene of the notebook with its meshes; `list scenes` shows all
    Scene(SceneArguments),
    /// Look at the photons of a scene: a picture of them, a file of points, where those at a point come from
    Photons(PhotonsArguments),
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The command line is put together without contradictions.
    #[test]
    fn arguments_are_consistent() {
        use clap::CommandFactory;
        Arguments::command().debug_assert();
    }
}
