//! Arguments of `render`.

use std::ops::Range;
use std::path::PathBuf;
use std::time::Duration;

use clap::{Args, ValueEnum};

use super::image::ExrArguments;
use super::tonemap::PreviewArgument;
use super::values::{parse_duration, parse_positive, parse_resolution};

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
    /// Record what `denoise` needs: features of the first surface, variances, two halves of the samples
    #[arg(long)]
    pub(crate) features: bool,
    /// Write a denoised picture too; implies --features
    #[arg(long, value_name = "OUT")]
    pub(crate) denoise: Option<PathBuf>,
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
    /// How .exr outputs are written
    #[command(flatten)]
    pub(crate) exr: ExrArguments,
    /// Show the picture in the terminal at the end, if standard output is one that can; or name the protocol
    #[arg(long, value_enum, value_name = "PROTOCOL", num_args = 0..=1, require_equals = true, default_missing_value = "auto")]
    pub(crate) preview: Option<PreviewArgument>,
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

fn parse_time_limit(text: &str) -> Result<Duration, String> {
    match parse_duration(text)? {
        Duration::ZERO => Err("a time to stop after must be longer than nothing".to_owned()),
        time => Ok(time),
    }
}

fn parse_range(text: &str) -> Result<Range<u64>, String> {
    let malformed = || "passes are given as A..B with A below B, such as 0..8".to_owned();
    let (start, end) = text.split_once("..").ok_or_else(malformed)?;
    let range = start.parse().map_err(|_| malformed())?..end.parse().map_err(|_| malformed())?;
    if range.is_empty() { Err(malformed()) } else { Ok(range) }
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

fn parse_named(text: &str) -> Result<(String, String), String> {
    let (name, expression) =
        text.split_once('=').ok_or("a layer is NAME=EXPRESSION, such as caustic=LS+DE")?;
    Ok((name.to_owned(), expression.to_owned()))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Ranges and crops that mean nothing are refused.
    #[test]
    fn malformed_values() {
        assert_eq!(parse_range("0..8"), Ok(0..8));
        assert!(parse_range("8..8").is_err());
        assert!(parse_range("3").is_err());
        assert!(parse_crop("0,0.5,0.5").is_err());
        assert!(parse_crop("0.5,0.5,0,1").is_err());
        assert!(parse_named("caustic").is_err());
    }
}
