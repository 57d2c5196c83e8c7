//! How the mean of one pixel settles (SPEC EXP-3).
//!
//! Many estimators of the same pixel run side by side, each with its own random numbers. The running mean of one of
//! them is drawn against the number of samples, with the least and the greatest of all. The mean jumps where a sample
//! brings far more light than the others: a path that meets the lamp through the glass ball. Between jumps it decays
//! towards a value that is too dark. The standard deviation over the estimators is `sigma / sqrt(N)` all the same.

use std::fmt::Write;

use etendue_math::hash64;
use etendue_scene::film::PixelBounds;
use rayon::prelude::*;

use crate::estimator::{Estimator, SamplerChoice};
use crate::plot::{Corner, Mark, Panel, Series, draw};
use crate::scenes::StudyScene;

/// Settings of the study.
#[derive(Clone, Debug)]
pub struct PixelSettings {
    /// The scene.
    pub scene: StudyScene,
    /// The pixel, from the upper left corner of the image.
    pub pixel: [u32; 2],
    /// Estimators side by side.
    pub n_estimators: u32,
    /// Samples of each.
    pub n_samples: u32,
    /// Determines all random numbers.
    pub seed: u64,
}

impl PixelSettings {
    /// The centre pixel of the standard box, as the documentation shows it.
    #[must_use]
    pub fn full(seed: u64) -> Self {
        let scene = StudyScene::standard_box().with_resolution([512, 512]);
        Self { scene, pixel: [256, 256], n_estimators: 1000, n_samples: 4096, seed }
    }

    /// A rough version that takes a tenth of the time.
    #[must_use]
    pub fn quick(seed: u64) -> Self {
        Self { n_estimators: 200, n_samples: 1024, ..Self::full(seed) }
    }
}

/// Result of the study.
#[derive(Clone, Debug)]
pub struct PixelStudy {
    /// Numbers of samples.
    pub counts: Vec<u32>,
    /// Luminance of the pixel after these numbers of samples: one list for each estimator.
    pub running_means: Vec<Vec<f64>>,
}

/// What all estimators say after some number of samples.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Spread {
    /// The least value.
    pub min: f64,
    /// The greatest value.
    pub max: f64,
    /// The mean over the estimators.
    pub mean: f64,
    /// Their standard deviation.
    pub deviation: f64,
}

/// Estimators that share a build of the scene.
const CHUNK_SIZE: u32 = 16;

/// Runs the study.
#[must_use]
pub fn pixel(settings: &PixelSettings) -> PixelStudy {
    let counts = counts_up_to(settings.n_samples);
    let chunks: Vec<u32> = (0..settings.n_estimators).step_by(CHUNK_SIZE as usize).collect();
    let running_means = chunks
        .into_par_iter()
        .flat_map(|first| {
            run_chunk(settings, first..(first + CHUNK_SIZE).min(settings.n_estimators), &counts)
        })
        .collect();
    PixelStudy { counts, running_means }
}

fn run_chunk(settings: &PixelSettings, indices: std::ops::Range<u32>, counts: &[u32]) -> Vec<Vec<f64>> {
    let estimator = Estimator::of_sampler(SamplerChoice::Independent);
    let mut scene = settings.scene.build();
    let [x, y] = settings.pixel;
    scene.film.crop = PixelBounds { min: [x, y], max: [x + 1, y + 1] };
    let weights = scene.film.luminance_weights().map(f64::from);
    let mut integrator = estimator.integrator(&scene);
    let mut run = |index: u32| {
        let seed = hash64(&[settings.seed, u64::from(index)]);
        let images = estimator.run(&mut scene, integrator.as_mut(), seed, counts);
        let luminance = |image: &etendue_image::Image| -> f64 {
            let rgb = image.rgb_pixels().expect("a developed film has colour")[0];
            rgb.iter().zip(weights).map(|(value, weight)| f64::from(*value) * weight).sum()
        };
        images.iter().map(luminance).collect()
    };
    indices.map(&mut run).collect()
}

/// All small numbers, then steps of three per cent, as fine as a figure can show.
fn counts_up_to(max: u32) -> Vec<u32> {
    let next = |n: &u32| (*n < max).then(|| (n + (n * 3 / 100).max(1)).min(max));
    std::iter::successors(Some(1), next).collect()
}

impl PixelStudy {
    /// What the estimators say at `counts[index]`.
    #[must_use]
    pub fn spread(&self, index: usize) -> Spread {
        let values: Vec<f64> = self.running_means.iter().map(|run| run[index]).collect();
        let n = values.len() as f64;
        let mean = values.iter().sum::<f64>() / n;
        let variance = values.iter().map(|v| (v - mean).powi(2)).sum::<f64>() / (n - 1.0);
        Spread {
            min: values.iter().copied().fold(f64::INFINITY, f64::min),
            max: values.iter().copied().fold(f64::NEG_INFINITY, f64::max),
            mean,
            deviation: variance.sqrt(),
        }
    }

    /// The best value there is: the mean of all estimators after all samples.
    #[must_use]
    pub fn best(&self) -> Spread {
        self.spread(self.counts.len() - 1)
    }

    /// The estimator whose running mean is drawn: the one that jumps highest after its first 16 samples, so that the
    /// figure shows a jump.
    #[must_use]
    pub fn shown(&self) -> usize {
        let from = self.counts.iter().position(|n| *n >= 16).unwrap_or(0);
        let jump = |run: &Vec<f64>| run[from..].windows(2).map(|w| w[1] - w[0]).fold(0.0, f64::max);
        let best = self.running_means.iter().enumerate().max_by(|a, b| jump(a.1).total_cmp(&jump(b.1)));
        best.map_or(0, |(index, _)| index)
    }

    /// One row for each number of samples.
    #[must_use]
    pub fn csv(&self) -> String {
        let mut text = String::from("samples,one_estimator,minimum,maximum,mean,standard_deviation\n");
        let shown = &self.running_means[self.shown()];
        for (index, n) in self.counts.iter().enumerate() {
            let Spread { min, max, mean, deviation } = self.spread(index);
            let _ = writeln!(text, "{n},{:.6e},{min:.6e},{max:.6e},{mean:.6e},{deviation:.6e}", shown[index]);
        }
        text
    }

    /// The result in two lines, for people.
    #[must_use]
    pub fn summary(&self) -> String {
        let Spread { min, max, mean, deviation } = self.best();
        let last = self.counts.last().copied().unwrap_or(0);
        format!(
            "luminance {mean:.5} ± {:.5} from {} estimators of {last} samples each\n\
             they lie between {:.2} and {:.2} times that, with a standard deviation of {:.1} %\n",
            deviation / (self.running_means.len() as f64).sqrt(),
            self.running_means.len(),
            min / mean,
            max / mean,
            100.0 * deviation / mean
        )
    }

    /// The running mean of one estimator and the range of all, relative to the best value.
    #[must_use]
    pub fn svg(&self) -> String {
        let best = self.best();
        let truth = best.mean;
        let curve = |value: &dyn Fn(usize) -> f64| -> Vec<[f64; 2]> {
            self.counts.iter().enumerate().map(|(i, n)| [f64::from(*n), value(i) / truth]).collect()
        };
        let shown = &self.running_means[self.shown()];
        let n_estimators = self.running_means.len();
        let series = |name: &str, points, mark| Series { name: name.to_owned(), points, mark };
        let last = f64::from(self.counts.last().copied().unwrap_or(1));
        let sigma = best.deviation * last.sqrt();
        let law = |sign: f64| curve(&|i| truth + sign * sigma / f64::from(self.counts[i]).sqrt());
        let extremes = (0..self.counts.len()).map(|index| self.spread(index));
        let lowest = extremes.clone().map(|s| s.min).filter(|m| *m > 0.0).fold(truth, f64::min);
        let highest = extremes.map(|s| s.max).fold(truth, f64::max);
        let panel = Panel {
            title: format!("centre pixel of the box: {n_estimators} estimators"),
            x_label: "samples".to_owned(),
            y_label: "running mean / true value".to_owned(),
            y_range: Some([lowest / truth / 1.2, highest / truth * 1.2]),
            legend: Corner::UpperRight,
            series: vec![
                series("one estimator", curve(&|i| shown[i]), Mark::Line),
                series("greatest of all", curve(&|i| self.spread(i).max), Mark::Line),
                series("least of all", curve(&|i| self.spread(i).min), Mark::Line),
                series("1 ± σ/√N", law(1.0), Mark::Dashes),
                series("", law(-1.0), Mark::Dashes),
            ],
            ..Panel::default()
        };
        draw(&[panel])
    }
}
