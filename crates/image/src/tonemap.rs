//! From radiance to a display: tone mapping and display encoding (SPEC TONE-1 to TONE-8, TONE-11, TONE-12).
//!
//! The world has luminances from starlight to the sun, a display some two or three powers of ten. An operator changes the
//! luminance `L` of a pixel (Rec. 709 weights) to `L_d` and scales its RGB by `L_d / L`, which keeps the hue; a saturated pixel
//! may then leave [0, 1] in one channel, and [`to_u8`] clips it. Display curves map channels instead, so that bright colours
//! turn white. **Global** operators map equal pixels alike and are quick; **local** ones look at the surroundings of a pixel,
//! and keep texture that a global curve would flatten.
//!
//! ```text
//! exponential  L_d = 1 - exp(-L / L_mean)
//! logarithmic  L_d = 0.01 D / log10(L_max + 1) * ln(L + 1) / ln(2 + 8 (L / L_max)^(ln b / ln 0.5))
//! Reinhard     L_s = key L / L_avg,   L_avg = exp(mean(log(delta + L))),   L_d = L_s / (1 + L_s)
//! with white   L_d = L_s (1 + L_s / L_w^2) / (1 + L_s)
//! ```
//!
//! The exponential curve is the cumulative distribution of an exponential law of mean `L_mean`, so luminances of
//! that law come out uniform. The photographic operator is that of Reinhard, Stark, Shirley, Ferwerda 2002,
//! "Photographic Tone Reproduction for Digital Images"; `delta` keeps black pixels finite. The logarithmic one is that of Drago,
//! Myszkowski, Annen and Chiba 2003, "Adaptive Logarithmic Mapping For Displaying High Contrast Scenes", of luminances over
//! the log-average. Statistics skip pixels that are not finite.
//!
//! # To add an operator
//! A variant of [`Operator`] with a struct of its parameters, a file in `tonemap/`, an arm in [`apply`], its name in
//! [`OPERATORS`], a line in the tables of `tests.rs`.

mod bilateral;
mod display;
mod global;
mod gradient;
mod histogram;
mod local;
mod named;
mod poisson;
mod quantize;

use rayon::prelude::*;

use crate::plane::Plane;
use crate::{Image, luminance};

pub use bilateral::Bilateral;
pub use display::DisplayCurve;
pub use gradient::Gradient;
pub use histogram::HistogramAdjustment;
pub use local::ReinhardLocal;
pub use named::{OPERATORS, OperatorSpec};
pub use quantize::{Dither, Quantization, to_u8};

use self::global::Curve;

/// A tone mapping operator.
#[derive(Copy, Clone, Debug, PartialEq, Default)]
pub enum Operator {
    /// Clips every channel to [0, 1].
    #[default]
    Clamp,
    /// Divides by the largest channel value of the image, then clips negative values.
    DivideByMaximum,
    /// `1 - exp(-L / L_mean)` with the arithmetic mean luminance.
    Exponential,
    /// The adaptive logarithm of Drago et al. 2003.
    Logarithmic(Logarithmic),
    /// The photographic operator of Reinhard et al. 2002.
    Reinhard(Reinhard),
    /// A curve of a film or display.
    Display(DisplayCurve),
    /// Histogram adjustment of Larson et al. 1997.
    Histogram(HistogramAdjustment),
    /// The photographic operator with dodging and burning.
    ReinhardLocal(ReinhardLocal),
    /// Compression of the base of a bilateral filter, Durand and Dorsey 2002.
    Bilateral(Bilateral),
    /// Compression of gradients, Fattal et al. 2002.
    Gradient(Gradient),
}

/// Parameters of the photographic operator.
#[derive(Copy, Clone, Debug, PartialEq)]
pub struct Reinhard {
    /// Scaled luminance given to the log-average pixel, called a in the paper; 0.18 is middle gray.
    pub key: f32,
    /// Added to luminances before the logarithm so that black pixels stay finite, in units of luminance.
    pub delta: f32,
    /// Smallest scaled luminance shown as white, called `L_white` in the paper; `None` is infinity.
    pub white: Option<f32>,
}

impl Default for Reinhard {
    fn default() -> Self {
        Self { key: 0.18, delta: 1e-5, white: None }
    }
}

/// Parameters of the adaptive logarithm.
#[derive(Copy, Clone, Debug, PartialEq)]
pub struct Logarithmic {
    /// b in the paper, in (0, 1): less is brighter in the middle tones.
    pub bias: f32,
    /// Largest luminance of the display in cd/m^2, D in the formula; 100 shows the largest luminance as white.
    pub display: f32,
}

impl Default for Logarithmic {
    fn default() -> Self {
        Self { bias: 0.85, display: 100.0 }
    }
}

/// Applies exposure (a factor of 2^`exposure_ev`) and an operator to the picture of an image. The result has
/// channels `R`, `G`, `B` in linear light, `A` unchanged where there is one, and the metadata; other layers are left
/// out. NaN becomes black and infinity white. Only clamping, display curves and the division by the maximum of a part of a
/// picture notice the exposure: the others adapt.
pub fn apply(image: &Image, operator: Operator, exposure_ev: f32) -> Image {
    let mut mapped = Image::new(image.width, image.height);
    mapped.metadata = image.metadata.clone();
    let Some(mut pixels) = image.rgb_pixels() else { return mapped };
    let exposure = exposure_ev.exp2();
    pixels.par_iter_mut().for_each(|pixel| *pixel = pixel.map(|value| value * exposure));
    if let Some(curve) = Curve::of_pixels(operator, &pixels) {
        pixels.par_iter_mut().for_each(|pixel| *pixel = curve.map(*pixel));
    } else {
        map_by_surroundings(operator, image.width, &mut pixels);
    }
    mapped.set_rgb("", &pixels);
    if let Some(alpha) = image.channel("A") {
        mapped.set_channel("A", alpha.values.clone());
    }
    mapped
}

/// The exposure in stops that gives the log-average of the lit pixels this luminance; 0 for a black picture.
#[must_use]
pub fn automatic_exposure(image: &Image, key: f32) -> f32 {
    let average = image.rgb_pixels().and_then(|pixels| log_average_luminance(&pixels, 0.0));
    average.map_or(0.0, |average| (f64::from(key) / average).log2() as f32)
}

/// Pixels darker than this share of the log-average count as so bright where logarithms are taken.
const DARKEST: f32 = 1e-4;
/// And brighter ones than so many averages as that.
const BRIGHTEST: f64 = 1e30;

/// Operators that need the whole picture.
fn map_by_surroundings(operator: Operator, width: usize, pixels: &mut [[f32; 3]]) {
    let Some(average) = log_average_luminance(pixels, 0.0).filter(|average| *average > 0.0) else {
        pixels.fill([0.0; 3]);
        return;
    };
    // In units of the average, so that neither very dark nor very bright pictures leave the range of numbers.
    let ceiling = (finite_luminances(pixels).fold(0.0, f64::max) / average).min(BRIGHTEST) as f32;
    let luminances = pixels.iter().map(|&pixel| {
        let l = (f64::from(luminance(pixel)) / average) as f32;
        if l.is_nan() { DARKEST } else { l.clamp(DARKEST, ceiling.max(DARKEST)) }
    });
    let plane = Plane::new(width, pixels.len() / width, luminances.collect());
    let (shown, saturation) = match operator {
        Operator::ReinhardLocal(operator) => (operator.map(&plane.map(|l| l * operator.key)), 1.0),
        Operator::Bilateral(operator) => {
            (operator.map(&plane.map(f32::log10)).map(|shown| 10_f32.powf(shown)), 1.0)
        }
        Operator::Gradient(operator) => {
            let ln = plane.map(f32::ln);
            (shown_range(&operator.map(&ln), &ln), operator.saturation)
        }
        Operator::Histogram(operator) => {
            let ln = plane.map(f32::ln);
            let curve = operator.curve(&ln);
            (ln.map(|l| curve.map(l)), 1.0)
        }
        _ => (plane.clone(), 1.0),
    };
    pixels.par_iter_mut().zip(&plane.values).zip(&shown.values).for_each(|((pixel, l), shown)| {
        let l = (f64::from(*l) * average).max(f64::from(luminance(*pixel)));
        *pixel = recoloured(*pixel, l, *shown, saturation);
    });
}

/// A pixel of luminance `l` shown with another; the ratios of its channels to it are raised to the power `saturation`.
fn recoloured(pixel: [f32; 3], l: f64, shown: f32, saturation: f32) -> [f32; 3] {
    if pixel.iter().any(|value| value.is_nan()) {
        return [0.0; 3];
    }
    if pixel.contains(&f32::INFINITY) {
        return [1.0; 3];
    }
    pixel.map(|value| {
        let ratio = (f64::from(value.max(0.0)) / l) as f32;
        shown * if saturation == 1.0 { ratio } else { ratio.powf(saturation) }
    })
}

/// Contrast of a display as a natural logarithm: 100 to 1.
const DISPLAY_RANGE: f32 = 4.605;

/// Luminances of logarithms that are known up to a constant and, since all gradients may have been weakened alike, a factor: the
/// brightest but 1 % become white, and the range is widened until it is the display's or the world's.
fn shown_range(ln: &Plane, world: &Plane) -> Plane {
    let ([black, white], [world_black, world_white]) = (ends(ln), ends(world));
    let range = white - black;
    let widening =
        if range > 0.0 { (DISPLAY_RANGE.min(world_white - world_black) / range).max(1.0) } else { 1.0 };
    ln.map(|value| ((value - white) * widening).exp().min(1.0))
}

/// The values that 1 % and 99 % of the pixels do not exceed.
fn ends(ln: &Plane) -> [f32; 2] {
    let mut values = ln.values.clone();
    [1, 99].map(|percent| {
        let index = (values.len() - 1) * percent / 100;
        *values.select_nth_unstable_by(index, f32::total_cmp).1
    })
}

/// Logarithmic average luminance `exp(mean(log(delta + L)))` of the finite pixels, without those that are black if `delta` is
/// 0; `None` when there are none.
pub fn log_average_luminance(pixels: &[[f32; 3]], delta: f32) -> Option<f64> {
    let positive = finite_luminances(pixels).map(|l| l + f64::from(delta)).filter(|l| *l > 0.0);
    let log_mean = mean(positive.map(f64::ln))?;
    Some(log_mean.exp())
}

/// Arithmetic mean luminance of the finite pixels; `None` when there are none.
pub fn mean_luminance(pixels: &[[f32; 3]]) -> Option<f64> {
    mean(finite_luminances(pixels))
}

/// Non-negative luminances of the finite pixels.
fn finite_luminances(pixels: &[[f32; 3]]) -> impl Iterator<Item = f64> {
    pixels.iter().map(|&pixel| f64::from(luminance(pixel))).filter(|l| l.is_finite()).map(|l| l.max(0.0))
}

fn mean(values: impl Iterator<Item = f64>) -> Option<f64> {
    let (sum, count) = values.fold((0.0, 0u64), |(sum, count), value| (sum + value, count + 1));
    (count > 0).then(|| sum / count as f64)
}

#[cfg(test)]
mod tests;
