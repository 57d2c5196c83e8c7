//! Arguments of `photons`.

use std::path::PathBuf;

use clap::{Args, ValueEnum};

use super::values::{parse_resolution, parse_triple};

/// Arguments of `photons`.
#[derive(Args, Debug)]
pub(crate) struct PhotonsArguments {
    /// Scene file
    pub(crate) scene: PathBuf,
    /// Output: an image shows photons as dots, .ply holds them as points, .photons is a photon map; with --at, .svg and .csv tell where they come from; may repeat
    #[arg(short, long = "output", value_name = "OUT")]
    pub(crate) outputs: Vec<PathBuf>,
    /// Write the map that `photonmap` or `photons` makes of the scene, for their parameters globalmap, causticmap and map
    #[arg(long, value_name = "MAP", value_enum, conflicts_with_all = ["photons", "kind", "seed", "at"])]
    pub(crate) map: Option<PhotonMapArgument>,
    /// Integrator in place of the scene's, with parameters, whose map is meant
    #[arg(long, value_name = "NAME[:key=value,...]", requires = "map")]
    pub(crate) integrator: Option<String>,
    /// Photons that leave the lights
    #[arg(long, value_name = "N", default_value = "100000", value_parser = clap::value_parser!(u64).range(1..=10_000_000), allow_negative_numbers = true)]
    pub(crate) photons: u64,
    /// Which of them are kept
    #[arg(long, value_enum, default_value = "all")]
    pub(crate) kind: PhotonKindArgument,
    /// Keep those nearest to this point alone
    #[arg(long, value_name = "X,Y,Z", value_parser = parse_triple, allow_hyphen_values = true)]
    pub(crate) at: Option<[f32; 3]>,
    /// Keep those that arrive on the side of this normal alone [default: both sides, seen from that of the nearest]
    #[arg(long, value_name = "X,Y,Z", value_parser = parse_triple, allow_hyphen_values = true, requires = "at")]
    pub(crate) normal: Option<[f32; 3]>,
    /// How many to keep at the point
    #[arg(long, value_name = "K", default_value = "50", value_parser = clap::value_parser!(u32).range(1..), requires = "at", allow_negative_numbers = true)]
    pub(crate) nearest: u32,
    /// Radius of a dot in pixels
    #[arg(long, value_name = "PIXELS", default_value = "0.7", value_parser = parse_dot_radius, allow_negative_numbers = true)]
    pub(crate) radius: f32,
    /// Photons around a dot that tell how bright it is; 0: all dots alike
    #[arg(long, value_name = "K", default_value = "50", value_parser = clap::value_parser!(u32).range(0..=100_000), allow_negative_numbers = true)]
    pub(crate) density: u32,
    /// Random seed
    #[arg(long, value_name = "N", default_value = "0", allow_negative_numbers = true)]
    pub(crate) seed: u64,
    /// Number of threads [default: all cores]; it changes no photon
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u64).range(1..1024), allow_negative_numbers = true)]
    pub(crate) threads: Option<u64>,
    /// Resolution in place of the film's
    #[arg(long, value_name = "WxH", value_parser = parse_resolution, allow_hyphen_values = true)]
    pub(crate) resolution: Option<[i32; 2]>,
}

/// Which map.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub(crate) enum PhotonMapArgument {
    /// All photons
    Global,
    /// Those that a surface has scattered: of photons:show=shadowrays
    Scattered,
    /// Those that came through mirrors and glass alone
    Caustic,
}

/// Which photons.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub(crate) enum PhotonKindArgument {
    /// All on surfaces that scatter widely
    All,
    /// Straight from a light
    Direct,
    /// Through mirrors and glass alone
    Caustic,
    /// All others
    Indirect,
}

fn parse_dot_radius(text: &str) -> Result<f32, String> {
    let radius = text.parse::<f32>().ok().filter(|radius| (0.05..=100.0).contains(radius));
    radius.ok_or_else(|| "a radius is a number of pixels from 0.05 to 100".to_owned())
}
