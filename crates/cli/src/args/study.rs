//! Arguments of `study` and `bench`.

use std::path::PathBuf;

use clap::{Args, ValueEnum};

/// Arguments of `study`.
#[derive(Args, Debug)]
pub(crate) struct StudyArguments {
    /// Which experiment
    #[arg(value_enum)]
    pub(crate) name: StudyName,
    /// Folder for NAME.csv and NAME.svg
    #[arg(long, value_name = "DIR", default_value = ".")]
    pub(crate) out: PathBuf,
    /// A rough version in a tenth of the time
    #[arg(long)]
    pub(crate) quick: bool,
    /// Random seed
    #[arg(long, value_name = "N", default_value = "0")]
    pub(crate) seed: u64,
}

/// An experiment.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub(crate) enum StudyName {
    /// Error against samples for every sampler
    Convergence,
    /// How the mean of one pixel settles
    Pixel,
    /// What rays and building cost, against the number of triangles; processor times, in one thread
    SceneSize,
    /// Hierarchies, trees, grids and others: building, memory, tests and time; processor times, in one thread
    Accelerators,
    /// Error of the ways to find the light, against the size of the lamp
    LightSize,
    /// Error of the photons' radiance estimate, against their number
    EstimateConsistency,
    /// Filters of the radiance estimate at the edge of a caustic
    EstimateEdge,
    /// Volumes and hulls of the radiance estimate beside walls
    EstimateWalls,
    /// Photons counted by triangle against their radiance estimate, on a handle of small triangles
    EstimateHistogram,
    /// Photons as small lights against their radiance estimate, in a box
    Gathering,
    /// Error of the patterns in which photons leave lights, and of the ways to treat absorption
    PhotonEmission,
    /// The caustic of a glass ball by photons and by paths, for lamps of three sizes; processor times, in one thread
    PhotonCaustic,
    /// The standard box by photons that are seen directly, few and many; processor times, in one thread
    PhotonView,
    /// Photon mapping in two passes beside path tracing; processor times, in one thread
    PhotonPasses,
    /// Error against the number of photons, in a box with flat and with fractal walls; processor times, in one thread
    PhotonCounts,
    /// Trees, grids and lists that find the nearest photons; processor times, in one thread
    Neighbours,
}

/// Arguments of `bench`.
#[derive(Args, Debug)]
pub(crate) struct BenchArguments {
    /// Print one JSON object
    #[arg(long)]
    pub(crate) json: bool,
    /// Number of threads beside one [default: all cores]
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u64).range(1..1024), allow_negative_numbers = true)]
    pub(crate) threads: Option<u64>,
    /// Tiny scenes in a blink: shows that it works, and no speed
    #[arg(long)]
    pub(crate) quick: bool,
}
