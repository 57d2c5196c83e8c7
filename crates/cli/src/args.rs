//! The command line as typed.

use std::ops::Range;
use std::path::PathBuf;
use std::time::Duration;

use clap::{Args, Parser, Subcommand, ValueEnum};
use etendue::image::tonemap::Operator;
use etendue::spectrum::chromaticity_of_temperature;

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
    /// Make a picture with linear radiance of photographs by several exposures
    Hdr(HdrArguments),
    /// Blend photographs by several exposures into one picture, without radiance
    Fuse(FuseArguments),
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

/// Arguments of `render`.
#[derive(Args, Debug)]
pub(crate) struct RenderArguments {
    /// Scene file (pbrt-v4, may be gzipped)
    pub(crate) scene: PathBuf,
    /// Output: .exr (all layers and metadata), .png, .ppm, .pfm or .hdr; may repeat [default: the film's name]
    #[arg(short, long = "output", value_name = "OUT")]
    pub(crate) outputs: Vec<PathBuf>,
    /// Integrator in place of the scene's, with parameters
    #[arg(long, value_name = "NAME[:key=value,...]")]
    pub(crate) integrator: Option<String>,
    /// Samples per pixel
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u64).range(1..), allow_negative_numbers = true)]
    pub(crate) spp: Option<u64>,
    /// Stop after this time, such as 30s, 5m or 2h
    #[arg(long, value_name = "TIME", value_parser = parse_time_limit)]
    pub(crate) time: Option<Duration>,
    /// Stop once the relative standard error of the image falls below this
    #[arg(long, value_name = "E", value_parser = parse_positive, allow_negative_numbers = true)]
    pub(crate) error: Option<f64>,
    /// Render passes A up to, not including, B; `merge` adds such parts exactly
    #[arg(long, value_name = "A..B", value_parser = parse_range, conflicts_with = "spp")]
    pub(crate) passes: Option<Range<u64>>,
    /// Random seed
    #[arg(long, value_name = "N", allow_negative_numbers = true)]
    pub(crate) seed: Option<u64>,
    /// Number of threads [default: all cores]; it does not change the image
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u64).range(1..1024), allow_negative_numbers = true)]
    pub(crate) threads: Option<u64>,
    /// Resolution in place of the film's
    #[arg(long, value_name = "WxH", value_parser = parse_resolution, allow_hyphen_values = true)]
    pub(crate) resolution: Option<[i32; 2]>,
    /// Part of the image to render, in shares of its size
    #[arg(long, value_name = "x0,x1,y0,y1", value_parser = parse_crop, allow_hyphen_values = true)]
    pub(crate) crop: Option<[f32; 4]>,
    /// Layer of the paths that an expression selects, such as caustic='LS+DE'; may repeat
    #[arg(long = "lpe", value_name = "NAME=EXPRESSION", value_parser = parse_named)]
    pub(crate) expressions: Vec<(String, String)>,
    /// Layers bounce0, bounce1, ... of light that was scattered that many times, up to N
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u64).range(0..24), allow_negative_numbers = true)]
    pub(crate) bounces: Option<u64>,
    /// Wavelengths of a path
    #[arg(long, value_enum)]
    pub(crate) wavelengths: Option<WavelengthArgument>,
    /// File that keeps the state of the render
    #[arg(long, value_name = "FILE")]
    pub(crate) checkpoint: Option<PathBuf>,
    /// How often the checkpoint is written
    #[arg(long, value_name = "TIME", value_parser = parse_duration, default_value = "60s", requires = "checkpoint")]
    pub(crate) every: Duration,
    /// Go on from the checkpoint, if there is one
    #[arg(long, requires = "checkpoint")]
    pub(crate) resume: bool,
    /// Write statistics as JSON
    #[arg(long, value_name = "FILE")]
    pub(crate) stats: Option<PathBuf>,
    /// Print errors alone
    #[arg(short, long)]
    pub(crate) quiet: bool,
    /// Do not show progress
    #[arg(long)]
    pub(crate) no_progress: bool,
}

/// Wavelengths of a path.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub(crate) enum WavelengthArgument {
    /// Four wavelengths, rotated copies of a hero
    Hero,
    /// One random wavelength
    Single,
    /// Red, green and blue of linear sRGB in place of wavelengths, as renderers without spectra compute
    Bands,
}

/// Arguments of `photons`.
#[derive(Args, Debug)]
pub(crate) struct PhotonsArguments {
    /// Scene file
    pub(crate) scene: PathBuf,
    /// Output: an image shows photons as dots, .ply holds them as points, .photons is a photon map; with --at, .svg and .csv tell where they come from; may repeat
    #[arg(short, long = "output", value_name = "OUT")]
    pub(crate) outputs: Vec<PathBuf>,
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
    /// Resolution in place of the film's
    #[arg(long, value_name = "WxH", value_parser = parse_resolution, allow_hyphen_values = true)]
    pub(crate) resolution: Option<[i32; 2]>,
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

/// Arguments of `info`.
#[derive(Args, Debug)]
pub(crate) struct InfoArguments {
    /// Scene file
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

/// Arguments of `tonemap`.
#[derive(Args, Debug)]
pub(crate) struct TonemapArguments {
    /// Image with linear radiance
    pub(crate) image: PathBuf,
    /// Output; may repeat
    #[arg(short, long = "output", value_name = "OUT", required = true)]
    pub(crate) outputs: Vec<PathBuf>,
    /// Operator, with its parameters: NAME[:key=value,...]; `etendue list tonemappers` shows them
    #[arg(long, default_value = "clamp", value_parser = parse_operator)]
    pub(crate) operator: Operator,
    /// Exposure in stops before the curve, or `auto`: middle grey for the log-average luminance [default: auto for filmic, aces
    /// and agx, else 0]
    #[arg(long, value_name = "EV|auto", value_parser = parse_exposure, allow_negative_numbers = true)]
    pub(crate) exposure: Option<Exposure>,
    /// Key of the photographic operators: what the log-average luminance becomes
    #[arg(long, value_parser = parse_positive)]
    pub(crate) key: Option<f64>,
    /// Scaled luminance that becomes white, of the global photographic operator [default: infinite]
    #[arg(long, value_parser = parse_positive)]
    pub(crate) white: Option<f64>,
    /// Take this colour of light for white: a colour temperature in kelvin, or a chromaticity x,y
    #[arg(long, value_name = "KELVIN|X,Y", value_parser = parse_white)]
    pub(crate) white_balance: Option<[f32; 2]>,
    /// Hide the steps of 8-bit outputs in noise
    #[arg(long)]
    pub(crate) dither: bool,
    /// Write inks: channels C, M, Y and K of an .exr, of the encoded colour, without a profile
    #[arg(long, conflicts_with = "dither")]
    pub(crate) cmyk: bool,
}

/// Arguments of `hdr`.
#[derive(Args, Debug)]
pub(crate) struct HdrArguments {
    /// Photographs of one still scene, from one place
    #[arg(required = true)]
    pub(crate) images: Vec<PathBuf>,
    /// Output; may repeat
    #[arg(short, long = "output", value_name = "OUT", required = true)]
    pub(crate) outputs: Vec<PathBuf>,
    /// Exposure times in seconds, such as 1/30,0.25,2 [default: by the photographs' Exif data, with f-number and ISO]
    #[arg(long, value_name = "T,...", value_delimiter = ',', value_parser = parse_exposure_time, allow_negative_numbers = true)]
    pub(crate) times: Option<Vec<f32>>,
    /// What the camera makes of light
    #[arg(long, value_enum, default_value = "recover")]
    pub(crate) response: ResponseArgument,
    /// Divide by the largest value; a recovered response always does
    #[arg(long)]
    pub(crate) normalize: bool,
}

/// What a camera makes of light.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub(crate) enum ResponseArgument {
    /// Find it from the exposures
    Recover,
    /// The transfer curve of sRGB
    Srgb,
}

/// Arguments of `fuse`.
#[derive(Args, Debug)]
pub(crate) struct FuseArguments {
    /// Photographs of one still scene, from one place
    #[arg(required = true)]
    pub(crate) images: Vec<PathBuf>,
    /// Output; may repeat
    #[arg(short, long = "output", value_name = "OUT", required = true)]
    pub(crate) outputs: Vec<PathBuf>,
    /// How much contrast counts
    #[arg(long, default_value = "1", value_parser = parse_exponent, allow_negative_numbers = true)]
    pub(crate) contrast: f32,
    /// How much colour counts
    #[arg(long, default_value = "1", value_parser = parse_exponent, allow_negative_numbers = true)]
    pub(crate) saturation: f32,
    /// How much being neither dark nor bright counts
    #[arg(long, default_value = "1", value_parser = parse_exponent, allow_negative_numbers = true)]
    pub(crate) exposedness: f32,
}

/// How bright a picture is shown.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Exposure {
    /// By so many stops.
    Stops(f32),
    /// By what the picture needs.
    Automatic,
}

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
    /// Trees, grids and lists that find the nearest photons; processor times, in one thread
    Neighbours,
}

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

fn parse_duration(text: &str) -> Result<Duration, String> {
    let number_end = text.find(|c: char| !c.is_ascii_digit() && c != '.').unwrap_or(text.len());
    let (number, unit) = text.split_at(number_end);
    let number: f64 = number.parse().map_err(|_| "a time is a number with a unit, such as 30s".to_owned())?;
    let seconds = match unit {
        "" | "s" => 1.0,
        "ms" => 1e-3,
        "m" | "min" => 60.0,
        "h" => 3600.0,
        _ => return Err(format!("'{unit}' is not a unit of time; use ms, s, m or h")),
    };
    Duration::try_from_secs_f64(number * seconds).map_err(|error| error.to_string())
}

fn parse_time_limit(text: &str) -> Result<Duration, String> {
    match parse_duration(text)? {
        Duration::ZERO => Err("a time to stop after must be longer than nothing".to_owned()),
        time => Ok(time),
    }
}

fn parse_positive(text: &str) -> Result<f64, String> {
    match text.parse::<f64>() {
        Ok(value) if value > 0.0 && value.is_finite() => Ok(value),
        _ => Err("a positive number is needed".to_owned()),
    }
}

/// A time in seconds, or a fraction of a second.
fn parse_exposure_time(text: &str) -> Result<f32, String> {
    let (over, under) = text.split_once('/').unwrap_or((text, "1"));
    match (over.parse::<f32>(), under.parse::<f32>()) {
        (Ok(a), Ok(b)) if a / b > 0.0 && (a / b).is_finite() => Ok(a / b),
        _ => Err("a time in seconds such as 0.25 or 1/30 is needed".to_owned()),
    }
}

fn parse_exponent(text: &str) -> Result<f32, String> {
    match text.parse::<f32>() {
        Ok(value) if (0.0..=16.0).contains(&value) => Ok(value),
        _ => Err("a number from 0 to 16 is needed".to_owned()),
    }
}

fn parse_operator(text: &str) -> Result<Operator, String> {
    let (name, parameters) = text.split_once(':').unwrap_or((text, ""));
    let pairs = parameters.split(',').filter(|pair| !pair.is_empty());
    let pairs = pairs.map(|pair| {
        let (key, value) = pair.split_once('=').ok_or(format!("'{pair}' is not of the form key=value"))?;
        let value: f32 = value.parse().map_err(|_| format!("'{value}' is not a number"))?;
        Ok((key, value))
    });
    Operator::named(name, &pairs.collect::<Result<Vec<_>, String>>()?)
}

fn parse_exposure(text: &str) -> Result<Exposure, String> {
    match text.parse::<f32>() {
        _ if text == "auto" => Ok(Exposure::Automatic),
        Ok(stops) if stops.abs() <= 100.0 => Ok(Exposure::Stops(stops)),
        _ => Err("stops between -100 and 100, or 'auto', are needed".to_owned()),
    }
}

/// A chromaticity from two numbers or a colour temperature.
fn parse_white(text: &str) -> Result<[f32; 2], String> {
    let error =
        || "a colour temperature from 1000 to 40000 kelvin or a chromaticity x,y is needed".to_owned();
    let numbers: Vec<f32> = text.split(',').map(str::parse).collect::<Result<_, _>>().map_err(|_| error())?;
    match numbers[..] {
        [kelvin] if (1000.0..=40_000.0).contains(&kelvin) => Ok(chromaticity_of_temperature(kelvin)),
        [x, y] if x > 0.0 && y > 0.0 && x + y < 1.0 => Ok([x, y]),
        _ => Err(error()),
    }
}

fn parse_range(text: &str) -> Result<Range<u64>, String> {
    let malformed = || "passes are given as A..B with A below B, such as 0..8".to_owned();
    let (start, end) = text.split_once("..").ok_or_else(malformed)?;
    let range = start.parse().map_err(|_| malformed())?..end.parse().map_err(|_| malformed())?;
    if range.is_empty() { Err(malformed()) } else { Ok(range) }
}

fn parse_resolution(text: &str) -> Result<[i32; 2], String> {
    let malformed = || "a resolution is WIDTHxHEIGHT in pixels, such as 640x480".to_owned();
    let (width, height) = text.split_once('x').ok_or_else(malformed)?;
    let resolution = [width.parse().map_err(|_| malformed())?, height.parse().map_err(|_| malformed())?];
    if resolution.iter().any(|r| *r < 1) { Err(malformed()) } else { Ok(resolution) }
}

fn parse_triple(text: &str) -> Result<[f32; 3], String> {
    let numbers: Option<Vec<f32>> =
        text.split(',').map(|number| number.trim().parse().ok().filter(|v: &f32| v.is_finite())).collect();
    numbers
        .and_then(|n| <[f32; 3]>::try_from(n).ok())
        .ok_or_else(|| "write three numbers, such as 0,1.5,-2".to_owned())
}

fn parse_dot_radius(text: &str) -> Result<f32, String> {
    let radius = text.parse::<f32>().ok().filter(|radius| (0.05..=100.0).contains(radius));
    radius.ok_or_else(|| "a radius is a number of pixels from 0.05 to 100".to_owned())
}

fn parse_crop(text: &str) -> Result<[f32; 4], String> {
    let malformed = || "a crop is x0,x1,y0,y1 between 0 and 1".to_owned();
    let numbers: Vec<f32> =
        text.split(',').map(str::parse).collect::<Result<_, _>>().map_err(|_| malformed())?;
    match numbers[..] {
        [x0, x1, y0, y1] if 0.0 <= x0 && x0 < x1 && x1 <= 1.0 && 0.0 <= y0 && y0 < y1 && y1 <= 1.0 => {
            Ok([x0, x1, y0, y1])
        }
        _ => Err(malformed()),
    }
}

fn parse_setting(text: &str) -> Result<(String, String), String> {
    let (name, value) = text.split_once('=').ok_or("a parameter is NAME=VALUE, such as seed=2")?;
    Ok((name.trim().to_owned(), value.trim().to_owned()))
}

fn parse_named(text: &str) -> Result<(String, String), String> {
    let (name, expression) =
        text.split_once('=').ok_or("a layer is NAME=EXPRESSION, such as caustic=LS+DE")?;
    Ok((name.to_owned(), expression.to_owned()))
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

    /// Times are read with their units.
    #[test]
    fn durations() {
        assert_eq!(parse_duration("30s"), Ok(Duration::from_secs(30)));
        assert_eq!(parse_duration("1.5m"), Ok(Duration::from_secs(90)));
        assert_eq!(parse_duration("250ms"), Ok(Duration::from_millis(250)));
        assert!(parse_duration("5 parsecs").is_err());
        assert!(parse_duration("s").is_err());
    }

    /// Ranges, resolutions and crops that mean nothing are refused.
    #[test]
    fn malformed_values() {
        assert_eq!(parse_range("0..8"), Ok(0..8));
        assert!(parse_range("8..8").is_err());
        assert!(parse_range("3").is_err());
        assert_eq!(parse_resolution("64x48"), Ok([64, 48]));
        assert!(parse_resolution("64x0").is_err());
        assert!(parse_crop("0,0.5,0.5").is_err());
        assert!(parse_crop("0.5,0.5,0,1").is_err());
        assert!(parse_named("caustic").is_err());
    }
}
