//! Fireflies: rare samples of great weight, which stand out of their surroundings as single bright pixels. They are light that
//! belongs into the picture, found in the wrong place: what a firefly has too much goes to its neighbourhood, so that the sum
//! of all pixels stays.

use crate::{Image, luminance};

/// How many pixels around may be as bright as a firefly: fireflies come in pairs.
const N_COMPANIONS: usize = 2;

/// Pixels to each side that a firefly is held against.
const SURROUNDINGS: usize = 2;

/// A firefly has more than this times the luminance of its surroundings, and is left with that.
const FACTOR: f32 = 3.0;

/// The least surroundings, as a share of the picture's mean luminance.
const FLOOR: f64 = 0.02;

/// Least standard error of a firefly's luminance, as a share of it: one sample that outweighs all others has 1, a small lamp
/// that a quarter of 16 samples see 0.43.
const LEAST_ERROR: f32 = 0.5;

/// Pixels to each side that share the excess, and the standard deviation of the Gaussian by which they do.
const REACH: usize = 6;
const SIGMA: f32 = 2.5;

/// A picture without fireflies.
#[derive(Clone, Debug)]
pub struct Spread {
    /// The picture.
    pub image: Image,
    /// Pixels whose excess went to their neighbours.
    pub n_fireflies: usize,
}

/// Spreads the excess of fireflies by a Gaussian of 2.5 pixels times the luminance of the pixels that gain, so that dark
/// things beside bright ones stay dark. Colour and its halves change, and keep their sums up to rounding; the variance of
/// fireflies becomes that of what they keep.
///
/// Where the variance of pixels is known (`variance.Y`, not 0 everywhere), bright pixels that are sure stay as they are: small lamps, stars.
/// Pixels that are not finite stay, and count as black.
#[must_use]
pub fn spread_fireflies(image: &Image) -> Spread {
    let Some(pixels) = image.rgb_pixels() else {
        return Spread { image: image.clone(), n_fireflies: 0 };
    };
    let mut field = Field::new(image.width, &pixels);
    let variance = image.channel("variance.Y").map(|channel| &channel.values[..]);
    // After a single sample per pixel it tells nothing.
    let fireflies = field.find(variance.filter(|values| values.iter().any(|v| *v != 0.0)));
    for firefly in &fireflies {
        field.luminance[firefly.pixel] *= firefly.kept;
    }
    let mut result = image.clone();
    for firefly in &fireflies {
        let shares = field.shares(firefly.pixel);
        for (channel, original) in result.channels.iter_mut().zip(&image.channels) {
            let value = original.values[firefly.pixel];
            if is_variance(&channel.name) {
                channel.values[firefly.pixel] = value * firefly.kept * firefly.kept;
            } else if is_color(&channel.name) && value.is_finite() {
                let excess = (1.0 - firefly.kept) * value;
                channel.values[firefly.pixel] -= excess;
                shares.iter().for_each(|(pixel, share)| channel.values[*pixel] += share * excess);
            }
        }
    }
    Spread { image: result, n_fireflies: fireflies.len() }
}

fn is_color(name: &str) -> bool {
    let (layer, component) = name.rsplit_once('.').unwrap_or(("", name));
    matches!(layer, "" | "halfA" | "halfB") && matches!(component, "R" | "G" | "B" | "Y")
}

fn is_variance(name: &str) -> bool {
    matches!(name, "variance.R" | "variance.G" | "variance.B" | "variance.Y")
}

/// A pixel that is too bright.
#[derive(Clone, Copy, Debug)]
struct Firefly {
    pixel: usize,
    /// Share of its light that it keeps.
    kept: f32,
}

/// Luminance, 0 where it is negative or not finite.
struct Field {
    width: usize,
    luminance: Vec<f32>,
}

impl Field {
    fn new(width: usize, pixels: &[[f32; 3]]) -> Self {
        let finite = |y: f32| if y.is_finite() { y.max(0.0) } else { 0.0 };
        Self { width, luminance: pixels.iter().map(|pixel| finite(luminance(*pixel))).collect() }
    }

    fn find(&self, variance: Option<&[f32]>) -> Vec<Firefly> {
        let sum: f64 = self.luminance.iter().map(|y| f64::from(*y)).sum();
        let floor = (FLOOR * sum / self.luminance.len().max(1) as f64) as f32;
        let is_unsure = |pixel: usize| {
            let least = LEAST_ERROR * self.luminance[pixel];
            // Not a number is no certainty.
            variance.is_none_or(|variance| variance[pixel].is_nan() || variance[pixel] >= least * least)
        };
        let firefly = |pixel: usize| {
            let limit = FACTOR * self.surroundings(pixel)?.max(floor);
            let kept = limit / self.luminance[pixel];
            (kept < 1.0 && is_unsure(pixel)).then_some(Firefly { pixel, kept })
        };
        (0..self.luminance.len()).filter_map(firefly).collect()
    }

    /// The luminance that all but a few pixels around do not exceed; none where there are no more than those few.
    fn surroundings(&self, pixel: usize) -> Option<f32> {
        let mut brightest = [f32::NEG_INFINITY; N_COMPANIONS + 1];
        for other in self.window(pixel, SURROUNDINGS) {
            let mut y = self.luminance[other];
            for kept in &mut brightest {
                if y > *kept {
                    std::mem::swap(&mut y, kept);
                }
            }
        }
        Some(brightest[N_COMPANIONS]).filter(|y| y.is_finite())
    }

    /// What share of an excess its neighbours get; together 1.
    fn shares(&self, pixel: usize) -> Vec<(usize, f32)> {
        let place = |pixel: usize| [(pixel % self.width) as f32, (pixel / self.width) as f32];
        let [x, y] = place(pixel);
        let gaussian = |other: usize| {
            let [x_other, y_other] = place(other);
            (-0.5 * ((x - x_other).powi(2) + (y - y_other).powi(2)) / (SIGMA * SIGMA)).exp()
        };
        let others = || self.window(pixel, REACH);
        let mut shares: Vec<(usize, f32)> =
            others().map(|other| (other, gaussian(other) * self.luminance[other])).collect();
        let mut sum: f32 = shares.iter().map(|(_, share)| share).sum();
        if !(sum > 0.0 && sum.is_finite()) {
            shares = others().map(|other| (other, gaussian(other))).collect();
            sum = shares.iter().map(|(_, share)| share).sum();
        }
        shares.iter_mut().for_each(|(_, share)| *share /= sum);
        shares
    }

    /// Pixels of a square around one, without it.
    fn window(&self, pixel: usize, reach: usize) -> impl Iterator<Item = usize> {
        let (width, height) = (self.width, self.luminance.len() / self.width);
        let (x, y) = (pixel % width, pixel / width);
        let columns = x.saturating_sub(reach)..(x + reach + 1).min(width);
        let rows = y.saturating_sub(reach)..(y + reach + 1).min(height);
        rows.flat_map(move |y| columns.clone().map(move |x| y * width + x))
            .filter(move |other| *other != pixel)
    }
}
