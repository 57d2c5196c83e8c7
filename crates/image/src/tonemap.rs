//! From radiance to a display: global tone mapping and display encoding.
//!
//! An operator changes the luminance `L` of a pixel (Rec. 709 weights) to `L_d` and scales its RGB by `L_d / L`,
//! which keeps the hue. A saturated pixel may then leave [0, 1] in one channel; [`to_u8`] clips it.
//!
//! ```text
//! exponential  L_d = 1 - exp(-L / L_mean)
//! Reinhard     L_s = key L / L_avg,   L_avg = exp(mean(log(delta + L))),   L_d = L_s / (1 + L_s)
//! with white   L_d = L_s (1 + L_s / L_w^2) / (1 + L_s)
//! ```
//!
//! The exponential curve is the cumulative distribution of an exponential law of mean `L_mean`, so luminances of
//! that law come out uniform. The photographic operator is that of Reinhard, Stark, Shirley, Ferwerda 2002,
//! "Photographic Tone Reproduction for Digital Images"; `delta` keeps black pixels finite. The curves are global:
//! equal pixels stay equal. Statistics skip pixels that are not finite.

use crate::{Encoding, Image, luminance};

/// A global tone curve.
#[derive(Copy, Clone, Debug, PartialEq, Default)]
pub enum Operator {
    /// Clips every channel to [0, 1].
    #[default]
    Clamp,
    /// Divides by the largest channel value of the image, then clips negative values.
    DivideByMaximum,
    /// `1 - exp(-L / L_mean)` with the arithmetic mean luminance.
    Exponential,
    /// The photographic operator of Reinhard et al. 2002.
    Reinhard(Reinhard),
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

/// Applies exposure (a factor of 2^`exposure_ev`) and an operator to the picture of an image. The result has
/// channels `R`, `G`, `B` in linear light, `A` unchanged where there is one, and the metadata; other layers are left
/// out. NaN becomes black and infinity white.
pub fn apply(image: &Image, operator: Operator, exposure_ev: f32) -> Image {
    let mut mapped = Image::new(image.width, image.height);
    mapped.metadata = image.metadata.clone();
    let Some(mut pixels) = image.rgb_pixels() else { return mapped };
    let exposure = exposure_ev.exp2();
    for pixel in &mut pixels {
        *pixel = pixel.map(|value| value * exposure);
    }
    let curve = Curve::of_pixels(operator, &pixels);
    for pixel in &mut pixels {
        *pixel = curve.map(*pixel);
    }
    mapped.set_rgb("", &pixels);
    if let Some(alpha) = image.channel("A") {
        mapped.set_channel("A", alpha.values.clone());
    }
    mapped
}

/// Logarithmic average luminance `exp(mean(log(delta + L)))` of the finite pixels; `None` when there are none.
pub fn log_average_luminance(pixels: &[[f32; 3]], delta: f32) -> Option<f64> {
    let log_mean = mean(finite_luminances(pixels).map(|l| (l + f64::from(delta)).ln()))?;
    Some(log_mean.exp())
}

/// Arithmetic mean luminance of the finite pixels; `None` when there are none.
pub fn mean_luminance(pixels: &[[f32; 3]]) -> Option<f64> {
    mean(finite_luminances(pixels))
}

/// An operator with the statistics of its image.
#[derive(Copy, Clone, Debug)]
enum Curve {
    Clamp,
    Scale(f64),
    Exponential { mean: f64 },
    Reinhard { scale: f64, inverse_white_squared: f64 },
}

impl Curve {
    fn of_pixels(operator: Operator, pixels: &[[f32; 3]]) -> Curve {
        match operator {
            Operator::Clamp => Curve::Clamp,
            Operator::DivideByMaximum => {
                let finite = pixels.iter().flatten().copied().filter(|value| value.is_finite());
                Curve::Scale(positive_reciprocal(f64::from(finite.fold(0.0, f32::max))))
            }
            Operator::Exponential => Curve::Exponential { mean: mean_luminance(pixels).unwrap_or(0.0) },
            Operator::Reinhard(Reinhard { key, delta, white }) => {
                let average = log_average_luminance(pixels, delta).unwrap_or(0.0);
                let inverse_white_squared = white.map_or(0.0, |white| f64::from(white).powi(-2));
                Curve::Reinhard {
                    scale: f64::from(key) * positive_reciprocal(average),
                    inverse_white_squared,
                }
            }
        }
    }

    /// One pixel through the curve.
    fn map(self, pixel: [f32; 3]) -> [f32; 3] {
        if pixel.iter().any(|value| value.is_nan()) {
            return [0.0; 3];
        }
        if let Curve::Clamp = self {
            return pixel.map(|value| value.clamp(0.0, 1.0));
        }
        if pixel.contains(&f32::INFINITY) {
            return [1.0; 3];
        }
        let pixel = pixel.map(|value| f64::from(value.max(0.0)));
        let scale = self.scale(luminance_f64(pixel));
        pixel.map(|value| (value * scale) as f32)
    }

    /// `L_d / L` for a finite luminance.
    fn scale(self, l: f64) -> f64 {
        if l <= 0.0 {
            return 0.0;
        }
        match self {
            Curve::Clamp => 1.0,
            Curve::Scale(scale) => scale,
            Curve::Exponential { mean } if mean > 0.0 => -(-l / mean).exp_m1() / l,
            Curve::Exponential { .. } => 0.0,
            Curve::Reinhard { scale, inverse_white_squared } => {
                let scaled = l * scale;
                let shown = scaled * (1.0 + scaled * inverse_white_squared) / (1.0 + scaled);
                shown.min(1.0) / l
            }
        }
    }
}

/// How linear light becomes bytes.
#[derive(Copy, Clone, Debug, PartialEq, Default)]
pub struct Quantization {
    /// Transfer function, sRGB unless told otherwise.
    pub encoding: Encoding,
    /// What hides the steps between bytes.
    pub dither: Dither,
}

/// Where between two bytes a value is rounded up.
#[derive(Copy, Clone, Debug, PartialEq, Eq, Default)]
pub enum Dither {
    /// At one half: plain rounding.
    #[default]
    None,
    /// At the threshold of an 8 by 8 Bayer matrix.
    Ordered,
    /// At a threshold hashed from the pixel, the channel and this seed.
    Hashed(u64),
}

/// Bytes of the picture of an image: RGB clipped to [0, 1], encoded and rounded, row-major. `None` for an image
/// without colour. NaN becomes 0.
pub fn to_u8(image: &Image, quantization: Quantization) -> Option<Vec<[u8; 3]>> {
    let pixels = image.rgb_pixels()?;
    let quantize = |(index, pixel): (usize, [f32; 3])| {
        let position = [index % image.width, index / image.width];
        std::array::from_fn(|channel| quantize_value(pixel[channel], position, channel, quantization))
    };
    Some(pixels.into_iter().enumerate().map(quantize).collect())
}

/// The byte of one linear value.
fn quantize_value(value: f32, position: [usize; 2], channel: usize, quantization: Quantization) -> u8 {
    if value.is_nan() {
        return 0;
    }
    let stored = quantization.encoding.encode(value.clamp(0.0, 1.0));
    let offset = quantization.dither.offset(position, channel);
    // Casts from float to integer saturate, so the brightest value plus its offset stays 255.
    (stored * 255.0 + offset).floor() as u8
}

impl Dither {
    /// Added before rounding down, inside (0, 1) and away from both ends by more than the rounding of a byte value
    /// that is exact already.
    fn offset(self, [x, y]: [usize; 2], channel: usize) -> f32 {
        match self {
            Dither::None => 0.5,
            Dither::Ordered => (bayer_8x8(x, y) as f32 + 0.5) / 64.0,
            Dither::Hashed(seed) => {
                let position = (x as u64) | ((y as u64) << 28) | ((channel as u64) << 56);
                let hash = mix(mix(seed ^ 0x9e37_79b9_7f4a_7c15).wrapping_add(position));
                0.001 + 0.998 * ((hash >> 40) as f32 / (1u32 << 24) as f32)
            }
        }
    }
}

/// Entry 0..64 of the recursive Bayer matrix: the interleaved bits of x ^ y and y, reversed.
fn bayer_8x8(x: usize, y: usize) -> usize {
    (0..3).fold(0, |entry, bit| {
        let (x, y) = ((x >> bit) & 1, (y >> bit) & 1);
        entry | (((x ^ y) << 1 | y) << (2 * (2 - bit)))
    })
}

/// A bijection of 64-bit words that spreads every input bit over all output bits (Steele et al. 2014, `SplitMix`).
fn mix(mut word: u64) -> u64 {
    word = (word ^ (word >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    word = (word ^ (word >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
    word ^ (word >> 31)
}

/// Non-negative luminances of the finite pixels.
fn finite_luminances(pixels: &[[f32; 3]]) -> impl Iterator<Item = f64> {
    pixels.iter().map(|&pixel| f64::from(luminance(pixel))).filter(|l| l.is_finite()).map(|l| l.max(0.0))
}

fn mean(values: impl Iterator<Item = f64>) -> Option<f64> {
    let (sum, count) = values.fold((0.0, 0u64), |(sum, count), value| (sum + value, count + 1));
    (count > 0).then(|| sum / count as f64)
}

fn positive_reciprocal(value: f64) -> f64 {
    if value > 0.0 { value.recip() } else { 0.0 }
}

fn luminance_f64([r, g, b]: [f64; 3]) -> f64 {
    0.2126 * r + 0.7152 * g + 0.0722 * b
}

#[cfg(test)]
mod tests;
