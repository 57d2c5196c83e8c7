//! Ways to find the light, against the size of the lamp (SPEC EXP-16, PT-8).
//!
//! A square lamp of constant power grows in the ceiling of a room until it fills it. Paths that run into lamps by chance
//! find one in proportion to the solid angle that it covers, so that the variance goes as 1 / area: the error as
//! 1 / side. Next event estimation samples the lamp, and finds a small one as well as a large one; but where a surface
//! is shiny and the lamp is large, most points of the lamp are out of the lobe, and chance does better. Both together,
//! weighed by the power heuristic (Veach and Guibas 1995, "Optimally Combining Sampling Techniques for Monte Carlo
//! Rendering"), should follow the better of the two at every size.
//!
//! The error is the root of the mean of `(x - r)^2 / (r^2 + e^2)` over pixels and channels, e a tenth of the mean of the
//! picture, with independent samples. At equal cost it is the error once a pixel has had as many rays, of both kinds,
//! as the other estimators.

use std::fmt::Write;
use std::sync::atomic::{AtomicU64, Ordering};

use etendue_scene::Film;
use etendue_transport::{Flow, Integrator, Observer, RayCounts, Stop, render};
use rayon::prelude::*;

use crate::estimator::{Estimator, LightChoice, SamplerChoice};
use crate::plot::{Corner, Mark, Panel, Part, Series, draw_rows};
use crate::reference::{Reference, ReferenceSettings, trial_seed};
use crate::scenes::StudyScene;

/// Settings of the study.
#[derive(Clone, Debug)]
pub struct LightSizeSettings {
    /// Lengths of a side of the lamp; the ceiling's is 1.
    pub sides: Vec<f64>,
    /// Pixels across and down, before the ceiling is cut off.
    pub resolution: [u32; 2],
    /// Samples per pixel of each run.
    pub n_samples: u32,
    /// Independent runs of each estimator, at least 2.
    pub n_scrambles: u32,
    /// What errors are measured against.
    pub reference: ReferenceSettings,
    /// Determines all random numbers.
    pub seed: u64,
}

impl LightSizeSettings {
    /// The study as the documentation shows it.
    #[must_use]
    pub fn full(seed: u64) -> Self {
        Self {
            sides: (0..=6).rev().map(|k| 0.5_f64.powi(k)).collect(),
            resolution: [32, 32],
            n_samples: 64,
            n_scrambles: 16,
            reference: ReferenceSettings { n_scrambles: 8, n_samples: 1024 },
            seed,
        }
    }

    /// A rough version that takes a tenth of the time.
    #[must_use]
    pub fn quick(seed: u64) -> Self {
        Self {
            resolution: [16, 16],
            n_scrambles: 8,
            reference: ReferenceSettings { n_scrambles: 4, n_samples: 512 },
            ..Self::full(seed)
        }
    }
}

/// What the things in the room are made of.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Room {
    /// Everything is matte.
    Matte,
    /// Floor and balls are polished metal, of roughness 0.03.
    Metal,
}

impl Room {
    /// Both.
    pub const ALL: [Self; 2] = [Self::Matte, Self::Metal];

    /// Name for tables and figures.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Matte => "matte",
            Self::Metal => "metal",
        }
    }

    /// The room with a lamp of this side. The picture ends below the ceiling, so that no pixel sees the lamp itself.
    #[must_use]
    pub fn scene(self, side: f64, resolution: [u32; 2]) -> StudyScene {
        let things = match self {
            Self::Matte => r#"Material "diffuse" "rgb reflectance" [ 0.7 0.7 0.7 ]"#,
            Self::Metal => {
                r#"Material "conductor" "rgb reflectance" [ 0.7 0.7 0.7 ]
                   "float roughness" 0.03 "bool remaproughness" false"#
            }
        };
        let h = 0.5 * side;
        let text = format!(
            r#"
            Integrator "path" "integer maxdepth" 5
            PixelFilter "box"
            Film "rgb" "float cropwindow" [ 0 1 0.25 1 ]
            LookAt 0 0.5 1.9   0 0.5 0   0 1 0
            Camera "perspective" "float fov" 39
            WorldBegin
            Material "diffuse" "rgb reflectance" [ 0.7 0.7 0.7 ]
            Shape "bilinearmesh" "point3 P" [ -0.5 1 -0.5  0.5 1 -0.5  -0.5 1 0.5  0.5 1 0.5 ]
            Shape "bilinearmesh" "point3 P" [ -0.5 0 -0.5  0.5 0 -0.5  -0.5 1 -0.5  0.5 1 -0.5 ]
            Material "diffuse" "rgb reflectance" [ 0.6 0.1 0.1 ]
            Shape "bilinearmesh" "point3 P" [ -0.5 0 0.5  -0.5 0 -0.5  -0.5 1 0.5  -0.5 1 -0.5 ]
            Material "diffuse" "rgb reflectance" [ 0.1 0.5 0.1 ]
            Shape "bilinearmesh" "point3 P" [ 0.5 0 -0.5  0.5 0 0.5  0.5 1 -0.5  0.5 1 0.5 ]
            {things}
            Shape "bilinearmesh" "point3 P" [ -0.5 0 0.5  0.5 0 0.5  -0.5 0 -0.5  0.5 0 -0.5 ]
            AttributeBegin Translate -0.22 0.2 -0.15 Shape "sphere" "float radius" 0.2 AttributeEnd
            AttributeBegin Translate 0.24 0.15 0.15 Shape "sphere" "float radius" 0.15 AttributeEnd
            Material "diffuse" "rgb reflectance" [ 0 0 0 ]
            AreaLightSource "diffuse" "float power" 100
            Shape "bilinearmesh" "point3 P" [ -{h} 0.999 -{h}  {h} 0.999 -{h}  -{h} 0.999 {h}  {h} 0.999 {h} ]
            "#
        );
        StudyScene::of_text(&format!("{} room", self.name()), &text).with_resolution(resolution)
    }
}

/// The estimators under study.
pub const WAYS: [LightChoice; 3] = [LightChoice::Both, LightChoice::Lights, LightChoice::Scattering];

/// Result of the study.
#[derive(Clone, Debug)]
pub struct LightSize {
    /// Samples per pixel that errors are told for.
    pub n_samples: u32,
    /// One for each room and way, in the order of [`Room::ALL`] and [`WAYS`].
    pub curves: Vec<SizeCurve>,
}

/// One way to find the light.
#[derive(Clone, Debug)]
pub struct SizeCurve {
    /// The room.
    pub room: Room,
    /// The way.
    pub way: LightChoice,
    /// One for each side of the lamp.
    pub points: Vec<SizePoint>,
}

/// What it does with one lamp.
#[derive(Clone, Copy, Debug)]
pub struct SizePoint {
    /// Length of a side of the lamp.
    pub side: f64,
    /// Relative error.
    pub error: f64,
    /// Standard error of that.
    pub uncertainty: f64,
    /// Rays of a sample that look for the nearest hit.
    pub rays: f64,
    /// Rays of a sample that ask for visibility.
    pub shadow_rays: f64,
}

/// Rays of a pixel at equal cost.
const EQUAL_RAYS: f64 = 512.0;

impl SizePoint {
    /// The error once a pixel has had 512 rays: independent samples divide it by the root of their number.
    #[must_use]
    pub fn error_at_equal_rays(&self, n_samples: u32) -> f64 {
        self.error * (f64::from(n_samples) * (self.rays + self.shadow_rays) / EQUAL_RAYS).sqrt()
    }
}

/// Runs the study. `progress` hears of each lamp before it is measured.
pub fn light_size(settings: &LightSizeSettings, progress: &mut dyn FnMut(&str)) -> LightSize {
    let mut curves = Vec::new();
    for room in Room::ALL {
        let mut of_room = WAYS.map(|way| SizeCurve { room, way, points: Vec::new() });
        for side in &settings.sides {
            progress(&format!("{} room, lamp of side {side}", room.name()));
            let scene = room.scene(*side, settings.resolution);
            let reference = Reference::render(&scene, settings.reference, settings.seed);
            for curve in &mut of_room {
                curve.points.push(measure(&scene, curve.way, *side, &reference, settings));
            }
        }
        curves.extend(of_room);
    }
    LightSize { n_samples: settings.n_samples, curves }
}

fn measure(
    scene: &StudyScene,
    lights: LightChoice,
    side: f64,
    reference: &Reference,
    settings: &LightSizeSettings,
) -> SizePoint {
    let estimator = Estimator { sampler: SamplerChoice::Independent, lights };
    let square_errors: Vec<f64> = (0..settings.n_scrambles)
        .into_par_iter()
        .map(|k| {
            let images = estimator.images(scene, trial_seed(settings.seed, k), &[settings.n_samples]);
            reference.relative_square_error(&images[0])
        })
        .collect();
    let n = square_errors.len() as f64;
    let mean = square_errors.iter().sum::<f64>() / n;
    let variance = square_errors.iter().map(|e| (e - mean).powi(2)).sum::<f64>() / (n * (n - 1.0));
    let error = mean.max(0.0).sqrt();
    let [rays, shadow_rays] = rays_of_a_sample(&estimator, scene, settings);
    // The derivative of the root.
    SizePoint { side, error, uncertainty: 0.5 * variance.sqrt() / error, rays, shadow_rays }
}

fn rays_of_a_sample(estimator: &Estimator, scene: &StudyScene, settings: &LightSizeSettings) -> [f64; 2] {
    let mut scene = scene.build();
    scene.sampler.seed = trial_seed(settings.seed, 0);
    let mut film = Film::new(scene.film.clone(), Vec::new());
    let counter = Counter::default();
    let stop = Stop { passes: 0..u64::from(settings.n_samples), error: None };
    render(&scene, estimator.integrator(&scene).as_mut(), &mut film, &stop, &counter);
    let count = |counter: &AtomicU64| counter.load(Ordering::Relaxed) as f64;
    [&counter.closest, &counter.shadow].map(|rays| count(rays) / count(&counter.samples))
}

/// Counts rays.
#[derive(Debug, Default)]
struct Counter {
    samples: AtomicU64,
    closest: AtomicU64,
    shadow: AtomicU64,
}

impl Observer for Counter {
    fn tile_done(&self, n_samples: u64, rays: RayCounts) -> Flow {
        self.samples.fetch_add(n_samples, Ordering::Relaxed);
        self.closest.fetch_add(rays.closest, Ordering::Relaxed);
        self.shadow.fetch_add(rays.shadow, Ordering::Relaxed);
        Flow::Continue
    }

    fn pass_done(&self, _: u64, _: &Film, _: &dyn Integrator) -> Flow {
        Flow::Continue
    }
}

impl LightSize {
    /// The curve of a way in a room.
    #[must_use]
    pub fn curve(&self, room: Room, way: LightChoice) -> Option<&SizeCurve> {
        self.curves.iter().find(|curve| curve.room == room && curve.way == way)
    }

    /// The side of the lamp from which on chance does better than sampling it, by the given error, on a line between
    /// logarithms; `None` if it never does, or always.
    #[must_use]
    pub fn crossing(&self, room: Room, error: &dyn Fn(&SizePoint) -> f64) -> Option<f64> {
        let [lights, scattering] =
            [LightChoice::Lights, LightChoice::Scattering].map(|way| self.curve(room, way));
        let ratios: Vec<[f64; 2]> = std::iter::zip(&lights?.points, &scattering?.points)
            .map(|(sampled, found)| [sampled.side.ln(), (error(found) / error(sampled)).ln()])
            .collect();
        let [before, after] = ratios.windows(2).find(|pair| pair[0][1] > 0.0 && pair[1][1] <= 0.0)? else {
            return None;
        };
        let share = before[1] / (before[1] - after[1]);
        Some((before[0] + share * (after[0] - before[0])).exp())
    }

    /// All measurements: one row for each room, way and lamp.
    #[must_use]
    pub fn csv(&self) -> String {
        let mut text = String::from(
            "room,lights,side,samples_per_pixel,relative_error,standard_error,rays_per_sample,\
             shadow_rays_per_sample,error_at_equal_rays\n",
        );
        for SizeCurve { room, way, points } in &self.curves {
            for point in points {
                let SizePoint { side, error, uncertainty, rays, shadow_rays } = point;
                let (room, way, n) = (room.name(), way.name(), self.n_samples);
                let _ = write!(text, "{room},{way},{side},{n},{error:.6e},{uncertainty:.2e}");
                let _ = writeln!(text, ",{rays:.4},{shadow_rays:.4},{:.6e}", point.error_at_equal_rays(n));
            }
        }
        text
    }

    /// Where the curves cross, for people.
    #[must_use]
    pub fn summary(&self) -> String {
        let mut text = String::new();
        for room in Room::ALL {
            let equal_samples = self.crossing(room, &|point| point.error);
            let equal_rays = self.crossing(room, &|point| point.error_at_equal_rays(self.n_samples));
            for (what, side) in [("samples", equal_samples), ("rays", equal_rays)] {
                let _ = write!(text, "{} room, at equal {what}: ", room.name());
                let _ = match side {
                    Some(side) => writeln!(text, "chance beats sampling from side {side:.3} on"),
                    None => writeln!(text, "chance and sampling do not cross"),
                };
            }
        }
        text
    }

    /// The errors of each room at equal samples, and below them those at equal rays.
    #[must_use]
    pub fn svg(&self) -> String {
        let n = self.n_samples;
        let at_samples = Room::ALL.map(|room| {
            self.panel(room, &format!("at {n} samples per pixel"), &|point: &SizePoint| point.error)
        });
        let at_rays = Room::ALL.map(|room| {
            let title = format!("at {EQUAL_RAYS} rays per pixel");
            self.panel(room, &title, &|point: &SizePoint| point.error_at_equal_rays(n))
        });
        let parts: Vec<Part> = at_samples.into_iter().chain(at_rays).map(Part::Panel).collect();
        draw_rows(&parts, 2)
    }

    fn panel(&self, room: Room, title: &str, error: &dyn Fn(&SizePoint) -> f64) -> Panel {
        let series = self.curves.iter().filter(|curve| curve.room == room).map(|curve| Series {
            name: curve.way.name().to_owned(),
            points: curve.points.iter().map(|point| [point.side, error(point)]).collect(),
            mark: Mark::LineAndDots,
        });
        Panel {
            title: format!("{} room {title}", room.name()),
            x_label: "side of the lamp / side of the ceiling".to_owned(),
            y_label: "relative error".to_owned(),
            legend: Corner::UpperRight,
            series: series.collect(),
            ..Panel::default()
        }
    }
}
