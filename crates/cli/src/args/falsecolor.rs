//! Arguments of `falsecolor` and `probe`.

use std::path::PathBuf;

use clap::{Args, ValueEnum};

use super::values::{parse_positive, parse_triple};

/// Arguments of `falsecolor`.
#[derive(Args, Debug)]
pub(crate) struct FalsecolorArguments {
    /// Image with radiance, or with illuminance as `probe` writes it
    pub(crate) image: PathBuf,
    /// Output; may repeat
    #[arg(short, long = "output", value_name = "OUT", required = true)]
    pub(crate) outputs: Vec<PathBuf>,
    /// What is shown [default: what the image holds]
    #[arg(long, value_enum)]
    pub(crate) quantity: Option<QuantityArgument>,
    /// Share of the light that all surfaces reflect, for illuminance from luminance: E = pi L / R
    #[arg(long, value_name = "R", value_parser = parse_reflectance, allow_negative_numbers = true)]
    pub(crate) reflectance: Option<f64>,
    /// Multiply values by this first, such as 1/exposure of other programs' pictures
    #[arg(long, value_name = "FACTOR", default_value = "1", value_parser = parse_positive, allow_negative_numbers = true)]
    pub(crate) multiply: f64,
    /// Ends of the scale [default: up to a round number that 99.5 % of the values stay below]
    #[arg(long, value_name = "MIN,MAX", value_parser = parse_ends, allow_hyphen_values = true)]
    pub(crate) range: Option<[f64; 2]>,
    /// How values are spread over the colours
    #[arg(long, value_enum, default_value = "auto")]
    pub(crate) scale: SpreadArgument,
    /// Colours
    #[arg(long, value_enum, default_value = "spectrum")]
    pub(crate) palette: PaletteArgument,
    /// Leave out contour lines
    #[arg(long)]
    pub(crate) no_contours: bool,
    /// Leave out the legend
    #[arg(long)]
    pub(crate) no_legend: bool,
    /// Print statistics as one JSON object
    #[arg(long)]
    pub(crate) json: bool,
}

/// What a map shows.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub(crate) enum QuantityArgument {
    /// Luminance in cd/m²
    Luminance,
    /// Illuminance in lux
    Illuminance,
}

/// How values are spread over colours.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub(crate) enum SpreadArgument {
    /// Logarithmic where the values have a wide range
    Auto,
    /// Evenly
    Linear,
    /// By logarithm
    Log,
}

/// Colours of a map.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub(crate) enum PaletteArgument {
    /// Violet, blue, green, yellow, red
    Spectrum,
    /// Black, violet, red, orange, pale yellow: lightness rises evenly
    Heat,
    /// Black to white
    Gray,
}

/// Arguments of `probe`.
#[derive(Args, Debug)]
pub(crate) struct ProbeArguments {
    /// Scene file
    pub(crate) scene: PathBuf,
    /// Where to measure, in world space; may repeat; with --grid, the corner of the grid
    #[arg(long, value_name = "X,Y,Z", required = true, value_parser = parse_triple, allow_hyphen_values = true)]
    pub(crate) at: Vec<[f32; 3]>,
    /// The side from which light is measured; one for all points, or one for each
    #[arg(long, value_name = "X,Y,Z", required = true, value_parser = parse_triple, allow_hyphen_values = true)]
    pub(crate) normal: Vec<[f32; 3]>,
    /// Measure in the middle of each of N by M fields of a parallelogram
    #[arg(long, value_name = "NxM", value_parser = parse_grid, requires = "u", requires = "v", allow_hyphen_values = true)]
    pub(crate) grid: Option<[i32; 2]>,
    /// First side of the grid, from its corner; N fields lie along it
    #[arg(long, value_name = "X,Y,Z", value_parser = parse_triple, requires = "grid", allow_hyphen_values = true)]
    pub(crate) u: Option<[f32; 3]>,
    /// Second side of the grid; M fields lie along it
    #[arg(long, value_name = "X,Y,Z", value_parser = parse_triple, requires = "grid", allow_hyphen_values = true)]
    pub(crate) v: Option<[f32; 3]>,
    /// Paths for each point and instrument
    #[arg(long, value_name = "N", default_value = "1024", value_parser = clap::value_parser!(u32).range(16..=1 << 24), allow_negative_numbers = true)]
    pub(crate) samples: u32,
    /// Most scattering events of a path
    #[arg(long, value_name = "N", default_value = "100", value_parser = clap::value_parser!(u32).range(0..=1_000_000), allow_negative_numbers = true)]
    pub(crate) max_depth: u32,
    /// Random seed
    #[arg(long, value_name = "N", default_value = "0", allow_negative_numbers = true)]
    pub(crate) seed: u64,
    /// Table (.csv), or picture of the illuminance of a grid (.exr, .pfm, ...); may repeat [default: a table to standard output]
    #[arg(short, long = "output", value_name = "OUT")]
    pub(crate) outputs: Vec<PathBuf>,
    /// Print one JSON object
    #[arg(long)]
    pub(crate) json: bool,
}

fn parse_reflectance(text: &str) -> Result<f64, String> {
    let value = text.parse::<f64>().ok().filter(|value| *value > 0.0 && *value <= 1.0);
    value.ok_or_else(|| "a number above 0, at most 1, is needed".to_owned())
}

fn parse_ends(text: &str) -> Result<[f64; 2], String> {
    let error = || "two numbers MIN,MAX with MIN below MAX are needed".to_owned();
    let (low, high) = text.split_once(',').ok_or_else(error)?;
    match (low.trim().parse::<f64>(), high.trim().parse::<f64>()) {
        (Ok(low), Ok(high)) if low.is_finite() && high.is_finite() && low < high => Ok([low, high]),
        _ => Err(error()),
    }
}

/// Most fields along a side of a grid: a square of them has a million.
const MOST_FIELDS: i32 = 1000;

fn parse_grid(text: &str) -> Result<[i32; 2], String> {
    let fields = super::values::parse_resolution(text).ok().filter(|n| n.iter().all(|n| *n <= MOST_FIELDS));
    fields.ok_or_else(|| format!("a grid is NxM fields, such as 12x8, at most {MOST_FIELDS} along a side"))
}
