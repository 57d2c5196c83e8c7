//! Photon maps beside path tracing: error and processor time of several methods on one scene (SPEC EXP-4, EXP-5, EXP-7,
//! EXP-12, EXP-15, EXP-39).
//!
//! A *contest* is a scene, or one layer of its picture, and the ways to render it. Each way runs several times with seeds of its own, maps
//! and all, and is compared with a reference that shares no random numbers with it. The error is the root of the mean of
//! `(x - r)^2 / (r^2 + e^2)` over pixels and channels, e a tenth of the picture's mean; the reference's own variance is subtracted. The square of the error of an
//! unbiased way falls as 1 / time, so that one run tells how long it would take to the error of another:
//! `t (error / other)^2`. For biased ways, whose blur stays, that is not asked.
//!
//! Times come from a clock that the caller brings.

mod cases;
mod curves;

#[cfg(test)]
mod tests;

use std::fmt::Write;
use std::time::Duration;

use etendue_image::Image;
use etendue_math::hash64;
use etendue_scene::Film;
use etendue_scene::document::Entity;
use etendue_transport::lpe::PathExpressions;
use etendue_transport::{Stop, Unobserved, method, render};

use crate::plot::{Part, draw_rows};
use crate::reference::Reference;
use crate::scenes::StudyScene;

pub use cases::{caustic, seen_directly, two_passes};
pub use curves::{PhotonCounts, photon_counts};

/// How much is rendered.
#[derive(Clone, Copy, Debug)]
pub struct ContestSettings {
    /// Pixels across; those down are in proportion.
    pub width: u32,
    /// Samples per pixel of path tracing.
    pub n_samples: u32,
    /// Factor of all numbers of photons, of 1 in the documentation.
    pub photons: f64,
    /// Samples per pixel of each run of the reference.
    pub reference_samples: u32,
    /// Runs of each way and of the reference, at least 2.
    pub n_runs: u32,
    /// Determines all random numbers.
    pub seed: u64,
}

impl ContestSettings {
    /// The study as the documentation shows it.
    #[must_use]
    pub const fn full(seed: u64) -> Self {
        Self { width: 96, n_samples: 256, photons: 1.0, reference_samples: 1024, n_runs: 2, seed }
    }

    /// A rough version that takes a tenth of the time.
    #[must_use]
    pub const fn quick(seed: u64) -> Self {
        Self { width: 48, n_samples: 64, photons: 1.0, reference_samples: 256, n_runs: 2, seed }
    }

    fn count(&self, photons: u32) -> u32 {
        ((f64::from(photons) * self.photons) as u32).max(1)
    }
}

/// A way to render: an integrator as scene files name it.
#[derive(Clone, Debug)]
pub struct Way {
    /// Name for tables and figures.
    pub name: String,
    /// What stands after `Integrator` in a scene file.
    pub integrator: String,
    /// Samples per pixel.
    pub n_samples: u32,
    /// The mean of many runs is the truth.
    pub is_unbiased: bool,
}

/// A scene and the ways to render it.
#[derive(Clone, Debug)]
pub struct Contest {
    /// Name for tables and figures.
    pub name: String,
    /// What is rendered.
    pub scene: StudyScene,
    /// Path expression of the part of the light that counts; `None` for all.
    pub paths: Option<&'static str>,
    /// What errors are measured against.
    pub reference: Way,
    /// The contestants. Times and errors of the others are told relative to the first.
    pub ways: Vec<Way>,
}

/// What a way does.
#[derive(Clone, Debug)]
pub struct Outcome {
    /// Name of the contest.
    pub contest: String,
    /// Which way.
    pub way: Way,
    /// Processor seconds of a run.
    pub time_s: f64,
    /// Relative error of a run.
    pub error: f64,
    /// Mean of the picture over that of the reference.
    pub mean: f64,
    /// Photons that its maps hold, and the radius of an estimate in metres where there is one.
    pub photons: Option<[f64; 2]>,
    /// The picture of the last run.
    pub image: Image,
}

/// Result of a study.
#[derive(Clone, Debug, Default)]
pub struct ContestStudy {
    /// One after the other, those of a contest together.
    pub outcomes: Vec<Outcome>,
}

/// Runs contests. `clock` tells the processor time of the thread, in which all is to run; `progress` hears of each way.
pub fn contest(
    contests: &[Contest],
    settings: &ContestSettings,
    clock: &dyn Fn() -> Duration,
    progress: &mut dyn FnMut(&str),
) -> ContestStudy {
    let mut study = ContestStudy::default();
    for contest in contests {
        progress(&format!("{}: reference", contest.name));
        let reference = contest.reference(settings);
        for way in &contest.ways {
            progress(&format!("{}: {}", contest.name, way.name));
            study.outcomes.push(contest.run(way, &reference, settings, clock));
        }
    }
    study
}

impl Contest {
    fn reference(&self, settings: &ContestSettings) -> Reference {
        let seeds = (0..settings.n_runs).map(|k| hash64(&[settings.seed, 1, u64::from(k)]));
        let images: Vec<Image> = seeds.map(|seed| self.render(&self.reference, seed).0).collect();
        Reference::of_images(&images)
    }

    fn run(
        &self,
        way: &Way,
        reference: &Reference,
        settings: &ContestSettings,
        clock: &dyn Fn() -> Duration,
    ) -> Outcome {
        let (mut square, mut mean, mut photons, mut last) = (0.0, 0.0, None, None);
        let start = clock();
        for k in 0..settings.n_runs {
            let (image, held) = self.render(way, hash64(&[settings.seed, 2, u64::from(k)]));
            square += reference.relative_square_error(&image) / f64::from(settings.n_runs);
            mean += reference.mean_of(&image) / f64::from(settings.n_runs);
            (photons, last) = (held, Some(image));
        }
        let time_s = (clock() - start).as_secs_f64() / f64::from(settings.n_runs);
        Outcome {
            contest: self.name.clone(),
            way: way.clone(),
            time_s,
            error: square.max(0.0).sqrt(),
            mean: mean / reference.mean(),
            photons,
            image: last.unwrap_or_default(),
        }
    }

    /// The picture, of the paths that count, and the photons that it took.
    fn render(&self, way: &Way, seed: u64) -> (Image, Option<[f64; 2]>) {
        let mut scene = self.scene.build();
        scene.sampler.seed = seed;
        scene.sampler.samples_per_pixel = way.n_samples;
        let named: Vec<_> =
            self.paths.map(|paths| (LAYER.to_owned(), paths.to_owned())).into_iter().collect();
        let expressions = PathExpressions::new(&named).expect("the expressions of this crate are in order");
        let mut film = Film::new(scene.film.clone(), expressions.names().to_vec());
        let mut integrator =
            method(&entity(&way.integrator), expressions).0.expect("the methods of this crate exist");
        let stop = Stop { passes: 0..u64::from(way.n_samples), error: None };
        render(&scene, integrator.as_mut(), &mut film, &stop, &Unobserved);
        let image = film.develop();
        let image = if self.paths.is_some() { image.layer(LAYER).unwrap_or_default() } else { image };
        let report = integrator.report();
        let value = |name: &str| report.iter().find(|entry| entry.name == name).map(|entry| entry.value);
        let stored = value("photons_stored");
        let radius = value("mean_radius").or_else(|| value("global_mean_radius"));
        (image, stored.map(|n| [n, radius.unwrap_or(f64::NAN)]))
    }
}

/// The layer of the paths that count.
const LAYER: &str = "paths";

/// What a scene file says of its integrator; it has layers only as asked for.
fn entity(text: &str) -> Entity {
    let layers = if text.starts_with("\"photonmap\"") { "\"bool layers\" false" } else { "" };
    StudyScene::of_text("integrator", &format!("Integrator {text} {layers}\nWorldBegin\n")).integrator()
}

impl ContestStudy {
    /// The first way of each contest, which is what others are compared with.
    fn first<'a>(&'a self, outcome: &'a Outcome) -> &'a Outcome {
        self.outcomes.iter().find(|first| first.contest == outcome.contest).unwrap_or(outcome)
    }

    /// How many times as long an unbiased way takes to the error of the first one.
    #[must_use]
    pub fn time_to_equal_error(&self, outcome: &Outcome) -> Option<f64> {
        let first = self.first(outcome);
        let ratio = outcome.time_s / first.time_s * (outcome.error / first.error).powi(2);
        outcome.way.is_unbiased.then_some(ratio)
    }

    /// All measurements, one row for each way.
    #[must_use]
    pub fn csv(&self) -> String {
        let mut text = String::from(
            "contest,way,integrator,samples_per_pixel,relative_error,mean_over_reference,seconds,time_over_first,\
             time_to_error_of_first,photons,mean_radius_m\n",
        );
        for outcome in &self.outcomes {
            let Outcome { contest, way, time_s, error, mean, photons, .. } = outcome;
            let Way { name, integrator, n_samples, .. } = way;
            let integrator = integrator.replace('"', "'");
            let ratio = time_s / self.first(outcome).time_s;
            let equal = self.time_to_equal_error(outcome).map(|t| format!("{t:.4}")).unwrap_or_default();
            let held = photons.map_or_else(|| ",".to_owned(), |[n, radius]| format!("{n},{radius:.5}"));
            let _ = writeln!(
                text,
                "\"{contest}\",\"{name}\",\"{integrator}\",{n_samples},{error:.6e},{mean:.5},{time_s:.4},{ratio:.4},{equal},{held}"
            );
        }
        text
    }

    /// The table, for people.
    #[must_use]
    pub fn summary(&self) -> String {
        let mut text = String::new();
        let mut contest = "";
        for outcome in &self.outcomes {
            let Outcome { way, time_s, error, mean, photons, .. } = outcome;
            if outcome.contest != contest {
                contest = &outcome.contest;
                let _ = writeln!(
                    text,
                    "{contest}\n  {:<44} {:>8} {:>8} {:>9} {:>7} {:>7} {:>14}",
                    "way", "error", "mean", "seconds", "time", "photons", "to equal error"
                );
            }
            let name = format!("{}, {} spp", way.name, way.n_samples);
            let equal = self.time_to_equal_error(outcome).map(|t| format!("{t:.2}")).unwrap_or_default();
            let held = photons.map(|[n, _]| format!("{n}")).unwrap_or_default();
            let ratio = time_s / self.first(outcome).time_s;
            let _ = writeln!(
                text,
                "  {name:<44} {error:>8.4} {mean:>8.4} {time_s:>9.3} {ratio:>7.2} {held:>7} {equal:>14}"
            );
        }
        text
    }

    /// The pictures, in rows of three.
    #[must_use]
    pub fn svg(&self) -> String {
        let part = |outcome: &Outcome| {
            let Outcome { contest, way, error, .. } = outcome;
            Part::Picture(
                format!("{contest}: {}, error {:.0} %", way.name, 100.0 * error),
                enlarged(&outcome.image),
            )
        };
        draw_rows(&self.outcomes.iter().map(part).collect::<Vec<_>>(), 3)
    }
}

/// Pixels as blocks, so that the picture fills its place.
fn enlarged(image: &Image) -> Image {
    let (width, height) = (image.width.max(1), image.height.max(1));
    let factor = (600 / width).min(460 / height).max(1);
    let pixels = image.rgb_pixels().unwrap_or_default();
    let at = |x: usize, y: usize| pixels.get(x / factor + width * (y / factor)).copied().unwrap_or_default();
    Image::from_fn(width * factor, height * factor, |x, y| at(x, y).map(|v| v.clamp(0.0, 1.0)))
}
