//! Error against the number of samples (SPEC EXP-1, EXP-2, MC-4).
//!
//! The error of the mean of N independent samples falls as `sigma / sqrt(N)`: a line of slope -1/2 in a log-log plot,
//! whatever the integrand. Better distributions of light samples shift the line down and keep the slope. Samples that
//! know of each other, stratified or quasi-random, make it steeper: up to `N^(-3/4)` where the integrand jumps along a
//! curve in two dimensions, up to `N^(-3/2)` where it is smooth (Mitchell 1996, "Consequences of Stratified Sampling
//! in Graphics"; Owen 1997, "Scrambled net variance for integrals of smooth functions"), and back towards -1/2 as the
//! dimension grows.
//!
//! The error is the root of the mean square over pixels, channels and several independent scrambles, against the mean
//! of many long Sobol renders, see [`crate::reference`].

use std::fmt::Write;

use rayon::prelude::*;

use crate::estimator::{Estimator, LightChoice, SamplerChoice};
use crate::fit::PowerLaw;
use crate::plot::{Corner, Mark, Panel, Series, draw};
use crate::reference::{Reference, ReferenceSettings, trial_seed};
use crate::scenes::StudyScene;

/// Settings of the study.
#[derive(Clone, Debug)]
pub struct ConvergenceSettings {
    /// What is measured.
    pub experiments: Vec<Experiment>,
    /// Independent runs of each estimator, at least 2.
    pub n_scrambles: u32,
    /// What errors are measured against.
    pub reference: ReferenceSettings,
    /// Determines all random numbers.
    pub seed: u64,
}

/// One scene with what is compared on it: a panel of the figure.
#[derive(Clone, Debug)]
pub struct Experiment {
    /// The scene.
    pub scene: StudyScene,
    /// Estimators, each with its ascending numbers of samples per pixel.
    pub estimators: Vec<(Estimator, Vec<u32>)>,
}

impl ConvergenceSettings {
    /// The study as the documentation shows it.
    #[must_use]
    pub fn full(seed: u64) -> Self {
        let experiments =
            vec![Experiment::soft_shadow([32, 24], 256), Experiment::standard_box([32, 32], 256, 1000)];
        Self {
            experiments,
            n_scrambles: 16,
            reference: ReferenceSettings { n_scrambles: 16, n_samples: 1024 },
            seed,
        }
    }

    /// A rough version that takes a tenth of the time.
    #[must_use]
    pub fn quick(seed: u64) -> Self {
        let experiments =
            vec![Experiment::soft_shadow([16, 12], 128), Experiment::standard_box([16, 16], 128, 100)];
        Self {
            experiments,
            n_scrambles: 8,
            reference: ReferenceSettings { n_scrambles: 8, n_samples: 1024 },
            seed,
        }
    }
}

impl Experiment {
    /// All samplers on the soft shadow, and lights found by chance to compare with: importance sampling shifts the
    /// line, and better samples tilt it.
    #[must_use]
    pub fn soft_shadow(resolution: [u32; 2], max_samples: u32) -> Self {
        let scene = StudyScene::soft_shadow().with_resolution(resolution);
        let counts = powers_of_two(max_samples);
        let by_chance = Estimator { sampler: SamplerChoice::Independent, lights: LightChoice::Scattering };
        let by_sampling = |sampler| Estimator { sampler, lights: LightChoice::Lights };
        let estimators = SamplerChoice::ALL.map(by_sampling).into_iter().chain([by_chance]);
        Self { scene, estimators: estimators.map(|e| (e, counts.clone())).collect() }
    }

    /// All samplers on the standard box; independent samples in powers of ten up to `max_independent`.
    #[must_use]
    pub fn standard_box(resolution: [u32; 2], max_samples: u32, max_independent: u32) -> Self {
        let scene = StudyScene::standard_box().with_resolution(resolution);
        let counts = |sampler| match sampler {
            SamplerChoice::Independent => {
                (0..).map(|k| 10_u32.pow(k)).take_while(|n| *n <= max_independent).collect()
            }
            _ => powers_of_two(max_samples),
        };
        let estimators = SamplerChoice::ALL.map(|s| (Estimator::of_sampler(s), counts(s)));
        Self { scene, estimators: estimators.into() }
    }
}

fn powers_of_two(max: u32) -> Vec<u32> {
    (0..=max.ilog2()).map(|k| 1 << k).collect()
}

/// Result of the study.
#[derive(Clone, Debug)]
pub struct Convergence {
    /// The curves of each experiment.
    pub panels: Vec<ConvergencePanel>,
}

/// The curves on one scene.
#[derive(Clone, Debug)]
pub struct ConvergencePanel {
    /// Name of the scene.
    pub scene: String,
    /// Mean of the reference over pixels and channels.
    pub mean: f64,
    /// Standard error of the reference: root mean square over pixels and channels.
    pub reference_error: f64,
    /// One for each estimator.
    pub curves: Vec<ErrorCurve>,
}

/// The error of one estimator.
#[derive(Clone, Debug)]
pub struct ErrorCurve {
    /// Name of the estimator.
    pub estimator: String,
    /// Samples per pixel.
    pub counts: Vec<u32>,
    /// Mean square error of each scramble at each count, less that of the reference.
    pub square_errors: Vec<Vec<f64>>,
}

/// Fits begin here: with fewer samples the strata are coarser than the features of the integrand.
const FIRST_FITTED_COUNT: u32 = 4;

impl ErrorCurve {
    /// Number of samples and root mean square error; points that the reference is too coarse for are left out.
    #[must_use]
    pub fn points(&self) -> Vec<[f64; 2]> {
        self.points_without(None)
    }

    /// The power law of the error, from 4 samples on.
    #[must_use]
    pub fn law(&self) -> Option<PowerLaw> {
        Self::law_of(&self.points())
    }

    /// Standard error of the slope, by leaving out one scramble at a time (the jackknife).
    #[must_use]
    pub fn slope_error(&self) -> f64 {
        let n = self.square_errors.len();
        let slopes: Vec<f64> = (0..n)
            .filter_map(|left_out| Self::law_of(&self.points_without(Some(left_out))))
            .map(|law| law.slope)
            .collect();
        let n = slopes.len() as f64;
        let mean = slopes.iter().sum::<f64>() / n;
        ((n - 1.0) / n * slopes.iter().map(|s| (s - mean).powi(2)).sum::<f64>()).sqrt()
    }

    fn law_of(points: &[[f64; 2]]) -> Option<PowerLaw> {
        let fitted: Vec<[f64; 2]> =
            points.iter().copied().filter(|[n, _]| *n >= f64::from(FIRST_FITTED_COUNT)).collect();
        PowerLaw::fit(&fitted)
    }

    fn points_without(&self, left_out: Option<usize>) -> Vec<[f64; 2]> {
        let kept: Vec<&Vec<f64>> = (0..self.square_errors.len())
            .filter(|k| Some(*k) != left_out)
            .map(|k| &self.square_errors[k])
            .collect();
        let mean = |index: usize| kept.iter().map(|e| e[index]).sum::<f64>() / kept.len() as f64;
        let points = self.counts.iter().enumerate().map(|(index, n)| [f64::from(*n), mean(index).sqrt()]);
        points.filter(|[_, error]| *error > 0.0).collect()
    }

    /// The estimator with its slope, for legends.
    #[must_use]
    pub fn label(&self) -> String {
        match self.law() {
            Some(law) => format!("{}: slope {:.2}", self.estimator, law.slope).replace('-', "−"),
            None => self.estimator.clone(),
        }
    }
}

/// Runs the study. `progress` hears of each estimator before it starts.
pub fn convergence(settings: &ConvergenceSettings, progress: &mut dyn FnMut(&str)) -> Convergence {
    let panels = settings.experiments.iter().map(|e| measure(e, settings, progress)).collect();
    Convergence { panels }
}

fn measure(
    experiment: &Experiment,
    settings: &ConvergenceSettings,
    progress: &mut dyn FnMut(&str),
) -> ConvergencePanel {
    let scene = &experiment.scene;
    progress(&format!("{}: reference", scene.name));
    let reference = Reference::render(scene, settings.reference, settings.seed);
    let curves = experiment.estimators.iter().map(|(estimator, counts)| {
        progress(&format!("{}: {}", scene.name, estimator.name()));
        let square_errors = (0..settings.n_scrambles)
            .into_par_iter()
            .map(|k| {
                let images = estimator.images(scene, trial_seed(settings.seed, k), counts);
                images.iter().map(|image| reference.square_error(image)).collect()
            })
            .collect();
        ErrorCurve { estimator: estimator.name(), counts: counts.clone(), square_errors }
    });
    let curves = curves.collect();
    ConvergencePanel {
        scene: scene.name.clone(),
        mean: reference.mean(),
        reference_error: reference.error(),
        curves,
    }
}

impl Convergence {
    /// All measurements: one row for each scene, estimator and number of samples.
    #[must_use]
    pub fn csv(&self) -> String {
        let mut text =
            String::from("scene,estimator,samples_per_pixel,rmse,relative_rmse,slope,slope_standard_error\n");
        for panel in &self.panels {
            for curve in &panel.curves {
                let slope = curve.law().map_or(f64::NAN, |law| law.slope);
                for [n, error] in curve.points() {
                    let relative = error / panel.mean;
                    let (scene, estimator, slope_error) =
                        (&panel.scene, &curve.estimator, curve.slope_error());
                    let row = format!(
                        "{scene},{estimator},{n},{error:.6e},{relative:.6e},{slope:.4},{slope_error:.4}"
                    );
                    let _ = writeln!(text, "{row}");
                }
            }
        }
        text
    }

    /// The slopes, a line each, for people.
    #[must_use]
    pub fn summary(&self) -> String {
        let mut text = String::new();
        for panel in &self.panels {
            let _ = writeln!(
                text,
                "{}: mean {:.4}, reference known to {:.2} %",
                panel.scene,
                panel.mean,
                100.0 * panel.reference_error / panel.mean
            );
            for curve in &panel.curves {
                let slope = curve.law().map_or(f64::NAN, |law| law.slope);
                let _ =
                    write!(text, "  {:<40} slope {slope:+.3} ± {:.3}", curve.estimator, curve.slope_error());
                if let Some([n, error]) = curve.points().last() {
                    let _ = write!(text, ", error {:.2} % at {n} samples", 100.0 * error / panel.mean);
                }
                text.push('\n');
            }
        }
        text
    }

    /// The log-log plots, one panel for each scene, side by side.
    #[must_use]
    pub fn svg(&self) -> String {
        let panels: Vec<Panel> = self.panels.iter().map(ConvergencePanel::plot).collect();
        draw(&panels)
    }
}

impl ConvergencePanel {
    fn plot(&self) -> Panel {
        let mut series: Vec<Series> = self
            .curves
            .iter()
            .map(|curve| {
                let points = curve.points().iter().map(|[n, error]| [*n, error / self.mean]).collect();
                Series { name: curve.label(), points, mark: Mark::LineAndDots }
            })
            .collect();
        series.extend(self.guide());
        Panel {
            title: format!("{}: error against samples", self.scene),
            x_label: "samples per pixel".to_owned(),
            y_label: "root mean square error / mean".to_owned(),
            y_range: None,
            legend: Corner::LowerLeft,
            series,
            ..Panel::default()
        }
    }

    /// The law of independent samples, above all curves.
    fn guide(&self) -> Option<Series> {
        let first = self.curves.iter().filter_map(|c| Some(c.points().first()?[1])).reduce(f64::max)?;
        let last = self.curves.iter().flat_map(|c| c.counts.last()).max()?;
        let end = f64::from(*last);
        let start = 1.4 * first / self.mean;
        let points = vec![[1.0, start], [end, start / end.sqrt()]];
        Some(Series { name: "slope −1/2".to_owned(), points, mark: Mark::Dashes })
    }
}
