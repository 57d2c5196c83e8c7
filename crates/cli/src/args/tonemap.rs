//! Arguments of `tonemap`.

use std::path::PathBuf;

use clap::{Args, ValueEnum};
use etendue::image::tonemap::Operator;
use etendue::spectrum::chromaticity_of_temperature;

use super::values::parse_positive;

/// Arguments of `tonemap`.
#[derive(Args, Debug)]
pub(crate) struct TonemapArguments {
    /// Image with linear radiance
    pub(crate) image: PathBuf,
    /// Output; may repeat
    #[arg(short, long = "output", value_name = "OUT", required_unless_present = "preview")]
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
    /// Colours and transfer curve of .png outputs
    #[arg(long, value_enum, default_value = "srgb", conflicts_with = "cmyk")]
    pub(crate) encoding: EncodingArgument,
    /// Luminance in cd/m² that white has with --encoding pq [default: 203]
    #[arg(long, value_name = "CD/M2", value_parser = parse_peak, allow_negative_numbers = true)]
    pub(crate) white_luminance: Option<f32>,
    /// Show the picture in the terminal, if standard output is one that can; or name the protocol
    #[arg(long, value_enum, value_name = "PROTOCOL", num_args = 0..=1, require_equals = true, default_missing_value = "auto")]
    pub(crate) preview: Option<PreviewArgument>,
}

/// Colours and transfer curve.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub(crate) enum EncodingArgument {
    /// sRGB, 8 bits
    Srgb,
    /// Display P3, 8 bits, for what lies outside of sRGB
    P3,
    /// Rec. 2020 with the PQ curve, 16 bits, for displays of high dynamic range
    Pq,
}

/// How a picture is shown in a terminal.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub(crate) enum PreviewArgument {
    /// As the environment tells; nothing where standard output is no terminal
    Auto,
    /// Kitty's graphics protocol
    Kitty,
    /// Inline images of iTerm2
    Iterm,
    /// Sixels
    Sixel,
    /// Half blocks in 24-bit colour
    Blocks,
}

/// How bright a picture is shown.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Exposure {
    /// By so many stops.
    Stops(f32),
    /// By what the picture needs.
    Automatic,
}

fn parse_operator(text: &str) -> Result<Operator, String> {
    let (name, parameters) = text.split_once(':').unwrap_or((text, ""));
    let pairs = parameters.split(',').filter(|pair| !pair.is_empty());
    let pairs = pairs.map(|pair| {
        let (key, value) = pair.split_once('=').ok_or(format!("'{pair}' is not of the form key=value"))?;
        let value: f32 = value.parse().map_err(|_| format!("'{value}' is not a number"))?;
        Ok((key, value))
    });
    let pairs = pairs.collect::<Result<Vec<_>, String>>()?;
    if let Some((key, _)) =
        pairs.iter().enumerate().find_map(|(i, pair)| pairs[..i].iter().find(|other| other.0 == pair.0))
    {
        return Err(format!("{key} is given twice"));
    }
    Operator::named(name, &pairs)
}

fn parse_exposure(text: &str) -> Result<Exposure, String> {
    match text.parse::<f32>() {
        _ if text == "auto" => Ok(Exposure::Automatic),
        Ok(stops) if stops.abs() <= 100.0 => Ok(Exposure::Stops(stops)),
        _ => Err("stops between -100 and 100, or 'auto', are needed".to_owned()),
    }
}

/// PQ ends at 10,000 cd/m².
fn parse_peak(text: &str) -> Result<f32, String> {
    let value = text.parse::<f32>().ok().filter(|value| *value > 0.0 && *value <= 10_000.0);
    value.ok_or_else(|| "a luminance above 0, at most 10000, is needed".to_owned())
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
