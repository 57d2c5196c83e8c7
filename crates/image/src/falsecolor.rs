//! Maps of luminance or illuminance in false colours, with a scale, a legend and contour lines, for lighting reports.
//!
//! A value takes its place between the ends of a scale, linear or logarithmic, and a colour of a palette there. Contours run where
//! the value crosses a tick of the legend, so that a reader without eyes for colour can follow them too. Pixels without a number
//! (NaN) and values that a logarithm does not take are grey.

mod font;

use crate::compare::{convolve, ramp_color};
use crate::{Image, srgb_decode};

/// How values are spread over the colours.
#[derive(Copy, Clone, Debug, PartialEq, Eq)]
pub enum Spread {
    /// Evenly.
    Linear,
    /// By their logarithms.
    Logarithmic,
}

/// From values to places between 0 and 1.
#[derive(Copy, Clone, Debug, PartialEq)]
pub struct Scale {
    spread: Spread,
    low: f64,
    high: f64,
}

/// Decades below the highest value that a logarithmic scale shows where nobody says how many.
const DECADES: f64 = 3.0;
/// Share of the values that a scale found for them may leave above its end: highlights would squeeze all else.
const ABOVE: f64 = 0.005;
/// Where that end is more than so many times the median, the scale is logarithmic.
const WIDE: f64 = 20.0;

impl Scale {
    /// From `low` to `high`; `None` unless both are finite, `low < high`, and for logarithms `low > 0`.
    #[must_use]
    pub fn new(spread: Spread, low: f64, high: f64) -> Option<Scale> {
        let extent = match spread {
            Spread::Linear => high - low,
            Spread::Logarithmic => high / low - 1.0,
        };
        let is_valid = low.is_finite() && high.is_finite() && extent > 0.0 && extent.is_normal();
        (is_valid && (spread == Spread::Linear || low > 0.0)).then_some(Scale { spread, low, high })
    }

    /// One that fits the values: up to a round number that all but 0.5 % of them stay below, from 0 or from three decades below.
    /// Logarithmic, unless told, where the values have a wide range.
    #[must_use]
    pub fn fitting(values: &[f32], spread: Option<Spread>) -> Scale {
        let mut sorted: Vec<f32> = values.iter().copied().filter(|v| v.is_finite() && *v > 0.0).collect();
        sorted.sort_by(f32::total_cmp);
        let at =
            |share: f64| sorted.get((share * sorted.len() as f64) as usize).copied().map_or(1.0, f64::from);
        let (end, median) = (at(1.0 - ABOVE), at(0.5));
        let high = round_up(end);
        match spread.unwrap_or(if end > WIDE * median { Spread::Logarithmic } else { Spread::Linear }) {
            Spread::Linear => Scale { spread: Spread::Linear, low: 0.0, high },
            Spread::Logarithmic => {
                Scale { spread: Spread::Logarithmic, low: high / 10f64.powf(DECADES), high }
            }
        }
    }

    /// Lower and upper end.
    #[must_use]
    pub const fn ends(&self) -> [f64; 2] {
        [self.low, self.high]
    }

    /// How it spreads values.
    #[must_use]
    pub const fn spread(&self) -> Spread {
        self.spread
    }

    /// Place of a value, 0 and 1 at the ends, beyond them outside; `None` for what has no place.
    #[must_use]
    pub fn place(&self, value: f64) -> Option<f64> {
        let place = match self.spread {
            Spread::Linear => (value - self.low) / (self.high - self.low),
            Spread::Logarithmic => (value / self.low).ln() / (self.high / self.low).ln(),
        };
        // A logarithm takes 0 to below everything, which is a place too.
        (!place.is_nan()).then_some(place)
    }

    /// Round values between the ends, ascending: multiples of 1, 2 or 5 times a power of ten, some five to ten of them, or the 1, 2
    /// and 5 of each decade (of long scales the powers of ten alone).
    #[must_use]
    pub fn ticks(&self) -> Vec<f64> {
        match self.spread {
            Spread::Linear => {
                let step = round_up((self.high - self.low) / 10.0);
                let first = (self.low / step - 1e-9).ceil() as i64;
                let last = (self.high / step + 1e-9).floor() as i64;
                (first..=last).map(|k| k as f64 * step).collect()
            }
            Spread::Logarithmic => {
                let decades = (self.high / self.low).log10();
                let digits: &[f64] = if decades > 4.0 { &[1.0] } else { &[1.0, 2.0, 5.0] };
                let first = self.low.log10().floor() as i32;
                let last = self.high.log10().ceil() as i32;
                let values = (first..=last).flat_map(|e| digits.iter().map(move |d| d * 10f64.powi(e)));
                let slack = 1.0 + 1e-9;
                values.filter(|v| *v >= self.low / slack && *v <= self.high * slack).collect()
            }
        }
    }
}

/// The least of 1, 2 and 5 times a power of ten that is not below a positive value.
fn round_up(value: f64) -> f64 {
    let decade = 10f64.powf(value.log10().floor());
    let found = [1.0, 2.0, 5.0].into_iter().map(|digit| digit * decade).find(|v| *v >= value * (1.0 - 1e-9));
    found.unwrap_or(10.0 * decade)
}

/// Colours from low to high.
#[derive(Copy, Clone, Debug, PartialEq, Eq)]
pub enum Palette {
    /// Black, violet, red, orange, pale yellow: lightness rises evenly.
    Heat,
    /// Violet, blue, green, yellow, red, as lighting reports have it.
    Spectrum,
    /// Black to white.
    Gray,
}

impl Palette {
    const fn ramp(self) -> &'static [[f32; 3]] {
        match self {
            Self::Heat => &crate::compare::HEAT_RAMP,
            Self::Spectrum => &[
                [0.22, 0.02, 0.35],
                [0.10, 0.20, 0.80],
                [0.05, 0.65, 0.75],
                [0.20, 0.75, 0.20],
                [0.95, 0.90, 0.10],
                [0.95, 0.50, 0.05],
                [0.80, 0.05, 0.05],
            ],
            Self::Gray => &[[0.0; 3], [1.0; 3]],
        }
    }
}

/// How a map is drawn.
#[derive(Clone, Debug, PartialEq)]
pub struct FalseColors {
    /// From values to places.
    pub scale: Scale,
    /// From places to colours.
    pub palette: Palette,
    /// Draws lines where values cross ticks.
    pub contours: bool,
    /// Written above the legend; `None` for no legend.
    pub unit: Option<String>,
}

/// Colour of pixels without a value, as sRGB.
const NO_VALUE: f32 = 0.5;
/// Smallest height of a picture with a legend, so that its text has room.
const LEAST_HEIGHT: usize = 96;
/// Heights of a picture per pixel of its letters.
const HEIGHT_PER_DOT: usize = 320;

impl FalseColors {
    /// The map of `width` values in a row, in linear light, with its legend at the right.
    ///
    /// # Panics
    /// When there are no values, or not whole rows of them.
    #[must_use]
    pub fn draw(&self, values: &[f32], width: usize) -> Image {
        assert!(
            width > 0 && !values.is_empty() && values.len().is_multiple_of(width),
            "whole rows of values"
        );
        let height = values.len() / width;
        let mut pixels: Vec<[f32; 3]> = values.iter().map(|value| self.color(f64::from(*value))).collect();
        if self.contours {
            self.draw_contours(values, width, &mut pixels);
        }
        let map = Image::rgb(width, height, pixels);
        match &self.unit {
            Some(unit) => self.with_legend(&map, unit),
            None => map,
        }
    }

    /// Linear light for a value.
    #[must_use]
    pub fn color(&self, value: f64) -> [f32; 3] {
        match self.scale.place(value) {
            Some(place) => ramp_color(self.palette.ramp(), place as f32),
            None => [srgb_decode(NO_VALUE); 3],
        }
    }

    /// Darkens or lightens the pixels whose right or lower neighbour lies beyond a tick. Values are averaged before, so that lines
    /// do not follow the noise.
    fn draw_contours(&self, values: &[f32], width: usize, pixels: &mut [[f32; 3]]) {
        let ticks = self.scale.ticks();
        let values = smooth(values, width);
        let band = |index: usize| {
            let value = f64::from(values[index]);
            value.is_finite().then(|| ticks.partition_point(|tick| *tick <= value))
        };
        for (index, pixel) in pixels.iter_mut().enumerate() {
            let right = (index % width + 1 < width).then_some(index + 1);
            let below = Some(index + width).filter(|i| *i < values.len());
            let own = band(index);
            let is_line = [right, below].into_iter().flatten().any(|other| {
                let other = band(other);
                own.is_some() && other.is_some() && own != other
            });
            if is_line {
                *pixel = contrasting(*pixel);
            }
        }
    }

    /// The map with a bar of all colours, its ticks and the unit at the right.
    fn with_legend(&self, map: &Image, unit: &str) -> Image {
        let height = map.height.max(LEAST_HEIGHT);
        let dot = (height / HEIGHT_PER_DOT).max(1);
        let labels: Vec<(f64, String)> = self.scale.ticks().into_iter().map(|v| (v, label(v))).collect();
        let n_letters =
            labels.iter().map(|(_, text)| text.chars().count()).chain([unit.chars().count()]).max();
        let letters = n_letters.unwrap_or(0) * font::ADVANCE * dot;
        let (margin, bar) = (6 * dot, 14 * dot);
        let width = map.width + letters + bar + 4 * margin;
        let mut canvas = Canvas { width, pixels: vec![[1.0; 3]; width * height] };
        canvas.paste(map);
        let left = map.width + margin;
        canvas.text(unit, [left, margin], dot);
        let (top, bottom) = (margin + 2 * font::HEIGHT * dot, height - margin - font::HEIGHT * dot / 2);
        let [low, high] = self.scale.ends();
        for y in top..bottom {
            let place = (bottom - 1 - y) as f64 / (bottom - 1 - top) as f64;
            let value = match self.scale.spread() {
                Spread::Linear => low + place * (high - low),
                Spread::Logarithmic => low * (high / low).powf(place),
            };
            let color = self.color(value);
            (left..left + bar).for_each(|x| canvas.set([x, y], color));
        }
        let mut last = usize::MAX;
        for (value, text) in labels {
            let place = self.scale.place(value).unwrap_or(0.0).clamp(0.0, 1.0);
            let y = bottom - 1 - (place * (bottom - 1 - top) as f64).round() as usize;
            (left + bar - 2 * dot..left + bar + 2 * dot).for_each(|x| canvas.set([x, y], [0.0; 3]));
            // Labels that would run into the one below are left out.
            if last == usize::MAX || last - y > (font::HEIGHT + 1) * dot {
                canvas.text(&text, [left + bar + margin, y.saturating_sub(font::HEIGHT * dot / 2)], dot);
                last = y;
            }
        }
        Image::rgb(width, height, canvas.pixels)
    }
}

/// Standard deviation of the average before contours are drawn, as a share of the longer side.
const CONTOUR_BLUR: f64 = 0.006;

/// Values averaged over neighbours by a Gaussian, those that are not finite left out; NaN where there is none.
fn smooth(values: &[f32], width: usize) -> Vec<f32> {
    let deviation = CONTOUR_BLUR * width.max(values.len() / width) as f64;
    let radius = (3.0 * deviation).ceil() as i64;
    let weight = |x: i64| (-(x * x) as f64 / (2.0 * deviation * deviation)).exp();
    let window: Vec<f64> = (-radius..=radius).map(weight).collect();
    let blurred = |f: fn(f32) -> f32| {
        let plane: Vec<f32> =
            values.iter().map(|value| if value.is_finite() { f(*value) } else { 0.0 }).collect();
        convolve(&plane, width, &window, &window)
    };
    let (sums, weights) = (blurred(|value| value), blurred(|_| 1.0));
    sums.iter().zip(weights).map(|(sum, weight)| sum / weight).collect()
}

/// Values at `factor` times as many places across and down, interpolated between the middles of pixels: for grids of few fields.
///
/// # Panics
/// When the factor is zero, or there are not whole rows of values.
#[must_use]
pub fn enlarged(values: &[f32], width: usize, factor: usize) -> Vec<f32> {
    assert!(factor > 0 && width > 0 && values.len().is_multiple_of(width), "whole rows of values");
    let height = values.len() / width;
    // The pixel before a place, the one behind it, and how far it is from the first.
    let neighbours = |i: usize, n: usize| {
        let place = ((i as f32 + 0.5) / factor as f32 - 0.5).clamp(0.0, (n - 1) as f32);
        let first = place as usize;
        (first, (first + 1).min(n - 1), place - first as f32)
    };
    let mut large = Vec::with_capacity(values.len() * factor * factor);
    for y in 0..height * factor {
        let (top, bottom, v) = neighbours(y, height);
        for x in 0..width * factor {
            let (left, right, u) = neighbours(x, width);
            let row = |y: usize| (1.0 - u) * values[y * width + left] + u * values[y * width + right];
            large.push((1.0 - v) * row(top) + v * row(bottom));
        }
    }
    large
}

/// A tick in as few letters as it takes.
fn label(value: f64) -> String {
    let magnitude = value.abs();
    if magnitude == 0.0 {
        "0".to_owned()
    } else if (1e-3..1e6).contains(&magnitude) {
        let text = format!("{value:.6}");
        text.trim_end_matches('0').trim_end_matches('.').to_owned()
    } else {
        let text = format!("{value:.5e}");
        let (digits, exponent) = text.split_once('e').unwrap_or((&text, "0"));
        format!("{}e{exponent}", digits.trim_end_matches('0').trim_end_matches('.'))
    }
}

/// Black on what is light, white on what is dark, in linear light.
fn contrasting(color: [f32; 3]) -> [f32; 3] {
    // Middle grey for the eye reflects 18 % of the light.
    if crate::luminance(color) > 0.18 { [0.0; 3] } else { [1.0; 3] }
}

/// A picture to draw on.
struct Canvas {
    width: usize,
    pixels: Vec<[f32; 3]>,
}

impl Canvas {
    fn set(&mut self, [x, y]: [usize; 2], color: [f32; 3]) {
        if x < self.width
            && let Some(pixel) = self.pixels.get_mut(y * self.width + x)
        {
            *pixel = color;
        }
    }

    fn paste(&mut self, map: &Image) {
        for (index, color) in map.rgb_pixels().unwrap_or_default().into_iter().enumerate() {
            self.set([index % map.width, index / map.width], color);
        }
    }

    /// Writes text whose first letter has its upper left corner there, in squares of `dot` pixels.
    fn text(&mut self, text: &str, [left, top]: [usize; 2], dot: usize) {
        for (position, letter) in text.chars().enumerate() {
            for y in 0..font::HEIGHT * dot {
                for x in 0..font::WIDTH * dot {
                    if font::is_ink(letter, x / dot, y / dot) {
                        self.set([left + position * font::ADVANCE * dot + x, top + y], [0.0; 3]);
                    }
                }
            }
        }
    }
}

#[cfg(test)]
mod tests;
