//! Denoising: a clean picture from a noisy one, its variance and features of what it shows.
//!
//! The method is first-order regression with feature guidance (Bitterli, Rousselle, Moon, Iglesias-Guitián, Adler, Mitchell,
//! Jarosz and Novák 2016, "Nonlinearly Weighted First-Order Regression for Denoising Monte Carlo Renderings",
//! doi:10.1111/cgf.12954), with weights by non-local means (Rousselle, Knaus and Zwicker 2012, doi:10.1145/2366145.2366214):
//!
//! 1. Features (albedo, shading normal, depth) lose their own noise by non-local means.
//! 2. Each half of the samples is fitted by linear functions of the features in windows of pixels, with weights that come from
//!    the *other* half, so that the noise of a pixel does not choose its own weight ([`regression`]), at two bandwidths.
//! 3. The squared error of each result is estimated by the other half, smoothed, and decides pixel by pixel between the
//!    bandwidths.
//! 4. The mean of the two halves is the result, but for light that was lost, which every neighbourhood gets back ([`energy`]).
//!
//! Simplified: the paper chooses the bandwidth for each half, filters its maps of choices by non-local means and can run twice.
//!
//! Everything depends on the picture alone: no random numbers, and sums in an order that threads do not change.

mod energy;
mod fireflies;
mod input;
mod prefilter;
mod regression;
#[cfg(test)]
mod tests;
mod weights;

use std::fmt;

use rayon::prelude::*;

use crate::Image;
use crate::plane::Plane;

pub use fireflies::{Spread, spread_fireflies};
use input::Input;
use regression::Subject;
use weights::{Guide, Reach};

/// How far and how strongly the denoiser filters.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Settings {
    /// Pixels to each side of a pixel that it may learn from.
    pub window: usize,
    /// Pixels to each side that make the patches by which pixels are compared.
    pub patch: usize,
    /// The two bandwidths of the weights: more is smoother.
    pub bandwidths: [f32; 2],
}

impl Default for Settings {
    fn default() -> Self {
        Self { window: 9, patch: 3, bandwidths: [0.5, 1.0] }
    }
}

/// Why a picture cannot be denoised.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum DenoiseError {
    /// It has no pixels.
    Empty,
    /// It has neither `R G B` nor `Y`.
    NoColor,
    /// It has neither variances nor halves.
    NoVariance,
}

impl fmt::Display for DenoiseError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Empty => write!(f, "there are no pixels"),
            Self::NoColor => write!(f, "there are no channels R, G, B or Y"),
            Self::NoVariance => write!(
                f,
                "nothing tells how noisy its pixels are: there are no channels variance.Y, variance.R or halfA.R"
            ),
        }
    }
}

impl std::error::Error for DenoiseError {}

/// A picture without noise, and what it was made of.
#[derive(Clone, Debug)]
pub struct Denoised {
    /// The picture. Channels that tell of its noise are gone: they are true no more.
    pub image: Image,
    /// Names of the features that guided.
    pub features: Vec<&'static str>,
    /// Names of the features that were not there.
    pub missing_features: Vec<&'static str>,
    /// Whether there were two halves of the samples.
    pub has_halves: bool,
    /// Whether all variances are 0, as after a single sample per pixel: nothing was filtered then.
    pub is_noiseless: bool,
    /// Pixels that were not finite; they are guessed from their neighbours.
    pub n_repaired: usize,
}

/// Denoises the colour of a picture. Other channels stay as they are.
///
/// # Errors
/// Without pixels, colour, or knowledge of the noise.
pub fn denoise(image: &Image, settings: &Settings) -> Result<Denoised, DenoiseError> {
    let input = Input::of(image)?;
    let features = prefilter::features(&input);
    let reach = Reach { window: settings.window, patch: settings.patch };
    let filtered = |half: usize| {
        let guide = Guide::new(&input.halves[1 - half], &input.variance, reach);
        let colors = input.colors(half);
        let subject = Subject {
            size: input.size,
            colors: &colors,
            features: &features.values,
            noise: &features.variances,
        };
        regression::filter(subject, &guide, reach, settings.bandwidths)
    };
    // One picture is filtered once.
    let results = if input.is_dual { vec![filtered(0), filtered(1)] } else { vec![filtered(0)] };
    let mut pixels = select(&input, &results);
    energy::give_back(&input, &mut pixels);
    let name = |(index, _): &(usize, _)| input::FEATURES[*index].0;
    let found: Vec<&str> = input.features.iter().map(name).collect();
    let all = input::FEATURES.iter().map(|(name, _)| *name);
    Ok(Denoised {
        image: with_clean_color(image, &pixels),
        missing_features: all.filter(|name| !found.contains(name)).collect(),
        features: found,
        has_halves: input.is_dual,
        is_noiseless: input.variance.iter().all(|plane| plane.values.iter().all(|v| *v == 0.0)),
        n_repaired: input.valid.values.iter().filter(|valid| **valid == 0.0).count(),
    })
}

/// How far estimates of errors, and choices by them, are smoothed, in pixels.
const SELECTION_SIGMA: f32 = 2.0;

/// Chooses between the bandwidths by the estimated squared error of each (Bitterli et al. 2016, section 5.3): where a half F is
/// filtered and the other half B is noisy, `(F - B)^2 - variance of B` is the squared error of F in expectation.
fn select(input: &Input, results: &[[Vec<[f32; 3]>; 2]]) -> Vec<[f32; 3]> {
    let [width, height] = input.size;
    let error = |bandwidth: usize| {
        let error = |i: usize| {
            let of_half = |half: usize, c: usize| {
                let other = &input.halves[1 - half][c].values;
                (results[half][bandwidth][i][c] - other[i]).powi(2) - input.variance[c].values[i]
            };
            (0..results.len()).map(|half| (0..3).map(|c| of_half(half, c)).sum::<f32>()).sum()
        };
        Plane::new(width, height, (0..width * height).into_par_iter().map(error).collect())
            .blurred(SELECTION_SIGMA)
    };
    let [narrow, wide] = [error(0), error(1)];
    let is_wide = narrow.values.iter().zip(&wide.values).map(|(a, b)| f32::from(u8::from(b < a))).collect();
    let share = Plane::new(width, height, is_wide).blurred(SELECTION_SIGMA);
    let pixel = |i: usize| {
        let share = if input.is_dual { share.values[i] } else { 1.0 };
        [0, 1, 2].map(|c| {
            let of = |half: &[Vec<[f32; 3]>; 2]| half[0][i][c] * (1.0 - share) + half[1][i][c] * share;
            results.iter().map(of).sum::<f32>() / results.len() as f32
        })
    };
    (0..width * height).map(pixel).collect()
}

/// The picture with another colour, without the channels that told of the noise of the old one.
///
/// # Panics
/// When there is not one colour for each pixel.
#[must_use]
pub fn with_clean_color(image: &Image, pixels: &[[f32; 3]]) -> Image {
    let is_stale = |name: &str| {
        let layer = name.split_once('.').map_or("", |(layer, _)| layer);
        ["halfA", "halfB", "sums"].contains(&layer)
            || ["R", "G", "B", "Y"].iter().any(|c| name == format!("variance.{c}"))
    };
    let mut result = image.clone();
    result.channels.retain(|channel| !is_stale(&channel.name));
    if image.channel("R").is_some() {
        result.set_rgb("", pixels);
    } else {
        result.set_channel("Y", pixels.iter().map(|pixel| pixel[0]).collect());
    }
    result
}
