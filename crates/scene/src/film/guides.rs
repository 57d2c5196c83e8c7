//! What a denoiser asks of a film beyond its colour: features of the first surface, variances of all, and two pictures of half
//! the samples each, whose errors are (nearly) independent (Rousselle, Knaus and Zwicker 2012, "Adaptive Rendering with
//! Non-Local Means Filtering", doi:10.1145/2366145.2366214).
//!
//! All follows from weighted sums: of squares of colours and features, and of the samples of one half. They stand at the end
//! of the record of a sample and of the values of a pixel, where they are found by name.

use std::ops::Range;

use super::tile::{COLOR, EXTRA};
use super::{ExactSum, FilmLayout, N_COLOR};

/// Positions among the values of [`Features`](super::Features) of those that guide: albedo, shading normal and depth.
pub(super) const GUIDES: [usize; 7] = [0, 1, 2, 9, 10, 11, 14];

/// Names of sums start with these where they are of squares, and of the samples of the second half.
const SQUARED: &str = "squared ";
const HALF: &str = "half ";
const HALF_WEIGHT: &str = "half weight";

/// Length of the record: squares of the colour and of the guides, 1 in the second half and 0 in the first, and the colour
/// times that.
pub(super) const N_GUIDES: usize = N_COLOR + GUIDES.len() + 1 + N_COLOR;
const HALF_FLAG: usize = N_COLOR + GUIDES.len();

/// Names of the sums.
pub(super) fn names(feature_names: &[&str]) -> impl Iterator<Item = String> {
    let colors = ["R", "G", "B"];
    let squares: Vec<String> =
        colors.iter().chain(feature_names).map(|name| format!("{SQUARED}{name}")).collect();
    let halves = std::iter::once(HALF_WEIGHT.to_owned()).chain(colors.map(|name| format!("{HALF}{name}")));
    squares.into_iter().chain(halves)
}

/// Whether a pass belongs to the second half of all. Halves differ by four passes at most, are equal at every power of two,
/// and consist of aligned blocks of four, so that the points of a low-discrepancy sequence stay even in both (those of even
/// index alone lie in one half of their range).
pub(super) fn is_in_second_half(pass: u64) -> bool {
    let digit = pass.max(1).ilog2().saturating_sub(1).min(2);
    pass >> digit & 1 == 1
}

/// Places of the squares among the values of a sample beyond its colour.
#[inline]
pub(super) fn squares(layout: &FilmLayout) -> Range<usize> {
    let start = layout.record_len() - EXTRA - layout.n_guides;
    start..start + if layout.n_guides > 0 { HALF_FLAG } else { 0 }
}

/// The variance of a mean over `n` samples of which `n_outliers` have squares too large for a sum. What is known is their number:
/// if they are equal and outweigh all others, the variance is that of a share k / n, `mean² (n - k) / (k (n - 1))`. One sample of
/// that kind makes it the square of the mean, and samples that are all of it make it 0.
pub(super) fn variance_of_outliers(mean: f64, n_outliers: u32, n: f64) -> f64 {
    let k = f64::from(n_outliers).min(n);
    mean * mean * (n - k) / (k * (n - 1.0))
}

/// Completes the record of a sample; the sample's half is that of `guides` already.
pub(super) fn fill(guides: &mut [f32], record: &[f32], layout: &FilmLayout) {
    let color = &record[COLOR..EXTRA];
    let features = layout.guide_places().map(|place| record[EXTRA + place]);
    for (square, value) in guides.iter_mut().zip(color.iter().copied().chain(features)) {
        *square = value * value;
    }
    let half = guides[HALF_FLAG];
    for (target, value) in guides[HALF_FLAG + 1..].iter_mut().zip(color) {
        *target = half * value;
    }
}

/// Notes the half of a sample in its record.
pub(super) fn set_half(guides: &mut [f32], is_second: bool) {
    guides[HALF_FLAG] = f32::from(u8::from(is_second));
}

/// True for sums that are no channels of their own.
pub(super) fn is_guide(name: &str) -> bool {
    name.starts_with(SQUARED) || name.starts_with(HALF)
}

/// How a channel follows from the sums of a pixel.
pub(super) enum GuideChannel {
    /// The variance of the mean of `value`, by the sum of squares at `squared`.
    Variance {
        /// Place of the sum of the values.
        value: usize,
        /// Place of the sum of their squares.
        squared: usize,
    },
    /// The mean over the first half of the samples.
    First(HalfPlaces),
    /// The mean over the second half.
    Second(HalfPlaces),
}

/// Places of the sums of all samples, of the second half, and of the weights of that.
#[derive(Clone, Copy)]
pub(super) struct HalfPlaces {
    value: usize,
    half: usize,
    half_weight: usize,
}

/// Channels `variance.NAME`, `halfA.NAME` and `halfB.NAME` by the names of the sums.
pub(super) fn channels(names: &[String]) -> Vec<(String, GuideChannel)> {
    let place = |wanted: &str| names.iter().position(|name| name == wanted);
    let half_weight = place(HALF_WEIGHT);
    let mut channels = Vec::new();
    for (index, name) in names.iter().enumerate() {
        if let Some(of) = name.strip_prefix(SQUARED)
            && let Some(value) = place(of)
        {
            channels.push((format!("variance.{of}"), GuideChannel::Variance { value, squared: index }));
        } else if let Some(of) = name.strip_prefix(HALF)
            && let (Some(value), Some(half_weight)) = (place(of), half_weight)
        {
            let places = HalfPlaces { value, half: index, half_weight };
            channels.push((format!("halfA.{of}"), GuideChannel::First(places)));
            channels.push((format!("halfB.{of}"), GuideChannel::Second(places)));
        }
    }
    channels
}

impl GuideChannel {
    /// Its value by the sums of a pixel, over `n` passes. The variance is that of equal weights, `(mean of squares - square of
    /// the mean) / (n - 1)`; a half without samples is black.
    pub(super) fn value(&self, weight: f64, sums: &[ExactSum], n: f64) -> f32 {
        let sum = |place: usize| sums[place].value();
        let mean = |sum: f64, weight: f64| if weight == 0.0 { 0.0 } else { sum / weight };
        let value = match *self {
            Self::Variance { .. } if n < 2.0 => 0.0,
            Self::Variance { value, squared } => {
                let m = mean(sum(value), weight);
                let n_saturated = sums[squared].n_saturated();
                if n_saturated > 0 {
                    return variance_of_outliers(m, n_saturated, n) as f32;
                }
                (mean(sum(squared), weight) - m * m).max(0.0) / (n - 1.0)
            }
            Self::First(HalfPlaces { value, half, half_weight }) => {
                mean(sum(value) - sum(half), weight - sum(half_weight))
            }
            Self::Second(HalfPlaces { half, half_weight, .. }) => mean(sum(half), sum(half_weight)),
        };
        value as f32
    }
}
