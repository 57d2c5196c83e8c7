//! Radiance from exposures.

use rayon::prelude::*;

use super::ExposureError;
use super::response::{N_LEVELS, Response, hat, level};

/// A picture and how long it was exposed.
#[derive(Clone, Copy, Debug)]
pub struct Exposure<'a> {
    /// Encoded values in [0, 1], row-major.
    pub pixels: &'a [[f32; 3]],
    /// Time in seconds, times whatever else scales the light, such as the gain.
    pub seconds: f32,
}

/// Demands two exposures at least, of one size and positive times, and a value that is not clipped.
pub(super) fn check(exposures: &[Exposure<'_>]) -> Result<(), ExposureError> {
    let Some((first, others)) = exposures.split_first() else { return Err(ExposureError::TooFew) };
    if others.is_empty() {
        return Err(ExposureError::TooFew);
    }
    for (index, exposure) in exposures.iter().enumerate() {
        if exposure.pixels.len() != first.pixels.len() {
            return Err(ExposureError::Size(index));
        }
        if !(exposure.seconds > 0.0 && exposure.seconds.is_finite()) {
            return Err(ExposureError::Time(index));
        }
    }
    let is_exposed = |value: &f32| (1..N_LEVELS - 1).contains(&level(*value));
    if exposures.iter().any(|exposure| exposure.pixels.iter().flatten().any(is_exposed)) {
        Ok(())
    } else {
        Err(ExposureError::Clipped)
    }
}

/// Linear values in proportion to radiance: per channel the mean of what the exposures say, weighted by a hat over their levels
/// (Debevec and Malik (6)). Where all exposures are clipped, the shortest speaks for what is white, the longest for what is
/// black.
///
/// # Errors
/// If there are fewer than two exposures, of different sizes, with times that are not positive, or if all pixels are black or white.
pub fn merge(exposures: &[Exposure<'_>], response: &Response) -> Result<Vec<[f32; 3]>, ExposureError> {
    check(exposures)?;
    let n = exposures[0].pixels.len();
    Ok((0..n).into_par_iter().map(|i| [0, 1, 2].map(|c| value(exposures, response, i, c))).collect())
}

fn value(exposures: &[Exposure<'_>], response: &Response, pixel: usize, channel: usize) -> f32 {
    let (mut sum, mut weights) = (0.0, 0.0);
    // Of clipped ones: the least of what white, and the most of what black allows.
    let (mut white, mut black) = (f32::NEG_INFINITY, f32::INFINITY);
    for exposure in exposures {
        let z = level(exposure.pixels[pixel][channel]);
        let ln = response.ln_exposure(channel, z) - exposure.seconds.ln();
        match z {
            0 => black = black.min(ln),
            255 => white = white.max(ln),
            _ => {
                sum += hat(z) * ln;
                weights += hat(z);
            }
        }
    }
    let ln = match (weights > 0.0, white.is_finite()) {
        (true, _) => sum / weights,
        (false, true) => white,
        (false, false) => return if black < -60.0 { 0.0 } else { black.exp() },
    };
    ln.exp()
}
