//! What errors are measured against: the mean of many long renders.
//!
//! It has an error too, which is measured by the spread of the renders and subtracted:
//! `E (x - r)^2 = E (x - mu)^2 + Var r`.

use etendue_image::Image;
use etendue_math::hash64;
use rayon::prelude::*;

use crate::estimator::{Estimator, SamplerChoice};
use crate::scenes::StudyScene;

/// Kinds of seeds, so that a reference shares no random numbers with what it judges.
#[derive(Clone, Copy, Debug)]
enum Purpose {
    Trial,
    Reference,
}

/// The seed of an independent run that a reference of the same seed may judge.
pub(crate) fn trial_seed(seed: u64, run: u32) -> u64 {
    hash64(&[seed, Purpose::Trial as u64, u64::from(run)])
}

/// How long it is rendered.
#[derive(Clone, Copy, Debug)]
pub struct ReferenceSettings {
    /// Independent runs, at least 2.
    pub n_scrambles: u32,
    /// Samples per pixel of each.
    pub n_samples: u32,
}

/// What is taken for the truth.
pub(crate) struct Reference {
    /// All channels of all pixels.
    values: Vec<f64>,
    /// Variance of each.
    variances: Vec<f64>,
}

/// Relative errors are not counted below this share of the mean.
const DARK_SHARE: f64 = 0.1;

impl Reference {
    /// Renders with the scene's own method and Sobol points.
    pub(crate) fn render(scene: &StudyScene, settings: ReferenceSettings, seed: u64) -> Self {
        let estimator = Estimator::of_sampler(SamplerChoice::Sobol);
        let images: Vec<Image> = (0..settings.n_scrambles)
            .into_par_iter()
            .map(|k| {
                let seed = hash64(&[seed, Purpose::Reference as u64, u64::from(k)]);
                estimator.images(scene, seed, &[settings.n_samples]).remove(0)
            })
            .collect();
        Self::of_images(&images)
    }

    /// The mean of independent renders of the same expectation, at least two.
    pub(crate) fn of_images(images: &[Image]) -> Self {
        let runs: Vec<Vec<f64>> = images.iter().map(colors).collect();
        let n = runs.len() as f64;
        let indices = 0..runs[0].len();
        let values: Vec<f64> = indices.map(|i| runs.iter().map(|run| run[i]).sum::<f64>() / n).collect();
        let variance = |(i, value): (usize, &f64)| {
            runs.iter().map(|run| (run[i] - value).powi(2)).sum::<f64>() / (n * (n - 1.0))
        };
        let variances = values.iter().enumerate().map(variance).collect();
        Self { values, variances }
    }

    /// Mean over pixels and channels.
    pub(crate) fn mean(&self) -> f64 {
        mean(self.values.iter().copied())
    }

    /// Mean over pixels and channels of a picture, to compare with [`Self::mean`].
    pub(crate) fn mean_of(&self, image: &Image) -> f64 {
        mean(colors(image).into_iter())
    }

    /// Standard error: root mean square over pixels and channels.
    pub(crate) fn error(&self) -> f64 {
        mean(self.variances.iter().copied()).sqrt()
    }

    /// Mean square error of an image that is independent of the reference.
    pub(crate) fn square_error(&self, image: &Image) -> f64 {
        mean(self.square_errors(image).map(|(error, _)| error))
    }

    /// The same, each value's relative to its own square.
    pub(crate) fn relative_square_error(&self, image: &Image) -> f64 {
        let dark = (DARK_SHARE * self.mean()).powi(2);
        mean(self.square_errors(image).map(|(error, value)| error / (value * value + dark)))
    }

    /// Square error and true value of each channel of each pixel.
    fn square_errors(&self, image: &Image) -> impl ExactSizeIterator<Item = (f64, f64)> {
        let truths = self.values.iter().zip(&self.variances);
        let errors = colors(image).into_iter().zip(truths);
        errors.map(|(x, (value, variance))| ((x - value).powi(2) - variance, *value))
    }
}

fn colors(image: &Image) -> Vec<f64> {
    let pixels = image.rgb_pixels().expect("a developed film has colour");
    pixels.into_iter().flatten().map(f64::from).collect()
}

fn mean(values: impl ExactSizeIterator<Item = f64>) -> f64 {
    let n = values.len() as f64;
    values.sum::<f64>() / n
}
