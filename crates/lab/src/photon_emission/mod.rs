//! How photons leave lights, and what becomes of them (SPEC EXP-10, EXP-20).
//!
//! The flux that arrives in each of 32 by 32 cells of a floor is compared with that of many more photons. The error is the root of
//! the mean square over the cells, over the mean of the cells; independent photons divide it by the root of their number.
//!
//! - **Patterns**: random, stratified, on a grid, and by scrambled Sobol points; under a lamp, below a ball of glass, and in a
//!   room where photons have scattered before.
//! - **Absorption**: roulette, weaker photons, or branching, in a room of varnished walls; how the power of photons is
//!   distributed, and the error for the rays that it takes.

mod looks;

use std::fmt::Write;

use etendue_image::Image;
use etendue_math::hash64;
use etendue_scene::Scene;
use etendue_transport::photon::{
    Absorption, EmissionSettings, Onward, PhotonEmitter, PhotonPattern, PhotonWalk, Target, trace_photons,
};

use crate::plot::{Axes, Corner, Mark, Panel, Part, Series, draw_rows};
use crate::scenes::StudyScene;

/// Cells along a side of the floor.
const N_CELLS: usize = 32;

/// Settings of the study.
#[derive(Clone, Debug)]
pub struct EmissionStudySettings {
    /// Photons of each run, as powers of two.
    pub log2_photons: Vec<u32>,
    /// Independent runs of each kind.
    pub n_runs: u64,
    /// Photons of the references, as a power of two.
    pub log2_reference: u32,
    /// Determines all random numbers.
    pub seed: u64,
}

impl EmissionStudySettings {
    /// The study as the documentation shows it.
    #[must_use]
    pub fn full(seed: u64) -> Self {
        Self { log2_photons: vec![10, 12, 14, 16, 18], n_runs: 8, log2_reference: 24, seed }
    }

    /// A rough version that takes a tenth of the time.
    #[must_use]
    pub fn quick(seed: u64) -> Self {
        Self { log2_photons: vec![10, 12, 14, 16], n_runs: 4, log2_reference: 20, seed }
    }
}

/// Where photons fall.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Place {
    /// Straight from a small lamp.
    Direct,
    /// Through a ball of glass alone.
    Caustic,
    /// In a room of matte walls.
    Room,
}

impl Place {
    /// All.
    pub const ALL: [Self; 3] = [Self::Direct, Self::Caustic, Self::Room];

    /// Name for tables and figures.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Direct => "direct",
            Self::Caustic => "caustic",
            Self::Room => "room",
        }
    }

    fn scene(self) -> Scene {
        let wall = "Material \"diffuse\" \"rgb reflectance\" [0.7 0.7 0.7]";
        let things = match self {
            Self::Direct => String::new(),
            Self::Caustic => "AttributeBegin Translate 0 0.55 0 Material \"dielectric\" \"float eta\" 1.5
                Shape \"sphere\" \"float radius\" 0.3 AttributeEnd"
                .to_owned(),
            Self::Room => format!("{wall} ReverseOrientation Shape \"sphere\" \"float radius\" 2"),
        };
        floor_under_a_lamp(wall, &things)
    }
}

fn floor_under_a_lamp(floor: &str, things: &str) -> Scene {
    let text = format!(
        "Camera \"perspective\"
        WorldBegin
        LightSource \"point\" \"point3 from\" [0.13 1.5 0.07] \"float power\" 1000
        {things}
        {floor} Shape \"bilinearmesh\" \"point3 P\" [-1 0 -1  1 0 -1  -1 0 1  1 0 1]"
    );
    StudyScene::of_text("floor", &text).build()
}

/// What one run finds.
struct Found {
    /// Flux in the cells.
    cells: Vec<f64>,
    /// Sum, and sum of squares, of the flux of photons at surfaces that maps are for.
    powers: [f64; 2],
    /// The flux of each.
    lumens: Vec<f32>,
    n_rays: u64,
}

fn run(scene: &Scene, emitter: &PhotonEmitter, walk: &PhotonWalk, n: u64, place: Place) -> Found {
    let weights = scene.film.luminance_weights();
    let (stored, rays) =
        trace_photons(scene, emitter, 0..n, walk, |_, vertex, found: &mut Vec<(u32, f32)>| {
            if vertex.is_stored() {
                let rgb = scene.film.output_rgb(vertex.flux, vertex.lambda);
                let lumens: f32 = rgb.iter().zip(weights).map(|(value, weight)| value * weight).sum();
                let p = vertex.surface.point.p;
                let is_counted = match place {
                    Place::Direct => vertex.trail.is_empty(),
                    Place::Caustic => vertex.trail.is_caustic(),
                    Place::Room => true,
                };
                let cell = |t: f32| {
                    (-1.0..1.0)
                        .contains(&t)
                        .then(|| ((0.5 * (t + 1.0) * N_CELLS as f32) as usize).min(N_CELLS - 1))
                };
                let on_floor = is_counted && p.y.abs() < 1e-3;
                let index = cell(p.x)
                    .zip(cell(p.z))
                    .filter(|_| on_floor)
                    .map_or(u32::MAX, |(x, z)| (z * N_CELLS + x) as u32);
                found.push((index, lumens));
            }
            if place == Place::Direct { Onward::Stop } else { Onward::Continue }
        });
    let mut found = Found {
        cells: vec![0.0; N_CELLS * N_CELLS],
        powers: [0.0; 2],
        lumens: stored.iter().map(|(_, lumens)| *lumens).collect(),
        n_rays: rays.closest,
    };
    for (cell, lumens) in stored {
        let lumens = f64::from(lumens);
        found.powers[0] += lumens;
        found.powers[1] += lumens * lumens;
        if let Some(cell) = found.cells.get_mut(cell as usize) {
            *cell += lumens / n as f64;
        }
    }
    found
}

/// Relative error of cells.
fn error(cells: &[f64], reference: &[f64]) -> f64 {
    let n = cells.len() as f64;
    let mean = reference.iter().sum::<f64>() / n;
    let square = cells.iter().zip(reference).map(|(a, b)| (a - b) * (a - b)).sum::<f64>() / n;
    square.sqrt() / mean
}

/// The error of a pattern by the number of photons.
#[derive(Clone, Debug)]
pub struct PatternCurve {
    /// Where they fall.
    pub place: Place,
    /// Name of the pattern.
    pub pattern: &'static str,
    /// Photons, and error.
    pub points: Vec<[f64; 2]>,
}

/// One way to treat absorption.
#[derive(Clone, Debug)]
pub struct AbsorptionRow {
    /// Its name.
    pub name: &'static str,
    /// Photons emitted.
    pub n_emitted: u64,
    /// Rays of an emitted photon.
    pub rays: f64,
    /// Photons that a map would hold, of an emitted one.
    pub stored: f64,
    /// Relative standard deviation of their power.
    pub deviation: f64,
    /// Relative error of the floor.
    pub error: f64,
    /// How power is distributed: power over the mean, and share of photons within half a decade around it.
    pub shares: Vec<[f64; 2]>,
}

impl AbsorptionRow {
    /// The error for a million rays.
    #[must_use]
    pub fn error_per_million_rays(&self) -> f64 {
        self.error * (self.n_emitted as f64 * self.rays / 1e6).sqrt()
    }
}

/// Result of the study.
#[derive(Clone, Debug)]
pub struct EmissionStudy {
    /// Patterns in each place.
    pub patterns: Vec<PatternCurve>,
    /// Ways to treat absorption.
    pub absorption: Vec<AbsorptionRow>,
    /// The caustic as each pattern draws it.
    pub pictures: Vec<(&'static str, Image)>,
}

/// Runs the study. `progress` hears of each part before it is measured.
pub fn photon_emission(settings: &EmissionStudySettings, progress: &mut dyn FnMut(&str)) -> EmissionStudy {
    let mut patterns = Vec::new();
    for place in Place::ALL {
        progress(&format!("patterns: {}", place.name()));
        let mut scene = place.scene();
        let target = if place == Place::Caustic { Target::SharpShapes } else { Target::Anything };
        let emitter =
            PhotonEmitter::aimed(&scene, &EmissionSettings { target, ..EmissionSettings::default() });
        let reference = reference(&mut scene, &emitter, place, settings, 10);
        for (name, pattern) in PhotonPattern::NAMES {
            let points = settings.log2_photons.iter().map(|log2| {
                let n = 1_u64 << log2;
                let errors = (0..settings.n_runs).map(|k| {
                    scene.sampler.seed = hash64(&[settings.seed, 1, k]);
                    let walk = walk(&scene, pattern.planned(n), Absorption::Roulette, 10);
                    error(&run(&scene, &emitter, &walk, n, place).cells, &reference).powi(2)
                });
                [n as f64, (errors.sum::<f64>() / settings.n_runs as f64).sqrt()]
            });
            patterns.push(PatternCurve { place, pattern: name, points: points.collect() });
        }
    }
    progress("absorption");
    let absorption = absorption(settings);
    EmissionStudy { patterns, absorption, pictures: looks::caustics(settings.seed) }
}

fn walk(scene: &Scene, pattern: PhotonPattern, absorption: Absorption, max_depth: u32) -> PhotonWalk {
    PhotonWalk { pattern, absorption, max_depth, sampler: scene.sampler, ..PhotonWalk::default() }
}

fn reference(
    scene: &mut Scene,
    emitter: &PhotonEmitter,
    place: Place,
    settings: &EmissionStudySettings,
    max_depth: u32,
) -> Vec<f64> {
    let mut mean = vec![0.0; N_CELLS * N_CELLS];
    // In parts, since what is found is held in memory.
    let (n_parts, n) = (1_u64 << (settings.log2_reference - 18), 1_u64 << 18);
    for part in 0..n_parts {
        scene.sampler.seed = hash64(&[settings.seed, 2, part]);
        let walk = walk(scene, PhotonPattern::Qmc, Absorption::Roulette, max_depth);
        let cells = run(scene, emitter, &walk, n, place).cells;
        mean.iter_mut().zip(cells).for_each(|(mean, cell)| *mean += cell / n_parts as f64);
    }
    mean
}

fn absorption(settings: &EmissionStudySettings) -> Vec<AbsorptionRow> {
    // Walls of a coat that mirrors a part of the light, over a matte base.
    let varnish = "Material \"smoothcoat\" \"rgb reflectance\" [0.6 0.6 0.6]";
    let mut scene = floor_under_a_lamp(
        varnish,
        &format!("{varnish} ReverseOrientation Shape \"sphere\" \"float radius\" 2"),
    );
    let emitter = PhotonEmitter::new(&scene);
    let reference = reference(&mut scene, &emitter, Place::Room, settings, 8);
    let log2 = settings.log2_photons.iter().copied().max().unwrap_or(14).min(16);
    let ways = [(Absorption::Roulette, log2), (Absorption::Scale, log2 - 1), (Absorption::Branch, log2 - 6)];
    let rows = ways.map(|(way, log2)| {
        let n = 1_u64 << log2;
        let (mut square, mut powers, mut lumens, mut n_rays) = (0.0, [0.0; 2], Vec::new(), 0);
        for k in 0..settings.n_runs {
            scene.sampler.seed = hash64(&[settings.seed, 3, k]);
            let walk = walk(&scene, PhotonPattern::Random, way, 8);
            let found = run(&scene, &emitter, &walk, n, Place::Room);
            square += error(&found.cells, &reference).powi(2) / settings.n_runs as f64;
            powers = [powers[0] + found.powers[0], powers[1] + found.powers[1]];
            lumens.extend(found.lumens);
            n_rays += found.n_rays;
        }
        let name = Absorption::NAMES.iter().find(|(_, known)| *known == way).map_or("", |(name, _)| *name);
        let emitted = (n * settings.n_runs) as f64;
        let n_stored = lumens.len();
        let mean = powers[0] / n_stored as f64;
        AbsorptionRow {
            name,
            n_emitted: n,
            rays: n_rays as f64 / emitted,
            stored: n_stored as f64 / emitted,
            deviation: (powers[1] / n_stored as f64 / (mean * mean) - 1.0).max(0.0).sqrt(),
            error: square.sqrt(),
            shares: looks::shares(&lumens, mean),
        }
    });
    rows.into()
}

impl EmissionStudy {
    /// All measurements, in three tables one after the other.
    #[must_use]
    pub fn csv(&self) -> String {
        let mut text = String::from("place,pattern,photons,relative_error\n");
        for PatternCurve { place, pattern, points } in &self.patterns {
            for [n, error] in points {
                let _ = writeln!(text, "{},{pattern},{n},{error:.6e}", place.name());
            }
        }
        text += "absorption,photons,rays_per_photon,stored_per_photon,power_deviation,relative_error,error_per_million_rays\n";
        for row in &self.absorption {
            let AbsorptionRow { name, n_emitted, rays, stored, deviation, error, .. } = row;
            let _ = writeln!(
                text,
                "{name},{n_emitted},{rays:.4},{stored:.4},{deviation:.4},{error:.6e},{:.6e}",
                row.error_per_million_rays()
            );
        }
        text += "absorption,power_over_mean,share_of_photons\n";
        for row in &self.absorption {
            for [power, share] in &row.shares {
                let _ = writeln!(text, "{},{power:.4e},{share:.4e}", row.name);
            }
        }
        text
    }

    /// What to see, for people.
    #[must_use]
    pub fn summary(&self) -> String {
        let mut text = String::new();
        for place in Place::ALL {
            let curves = || self.patterns.iter().filter(|curve| curve.place == place);
            let last = |curve: &PatternCurve| curve.points.last().map_or(f64::NAN, |point| point[1]);
            let random = curves().find(|curve| curve.pattern == "random").map_or(f64::NAN, last);
            for curve in curves() {
                let n = curve.points.last().map_or(0.0, |point| point[0]);
                let _ = writeln!(
                    text,
                    "{}, {} photons, {}: error {:.4}, {:.2} of that of random ones",
                    place.name(),
                    n,
                    curve.pattern,
                    last(curve),
                    last(curve) / random
                );
            }
        }
        for row in &self.absorption {
            let _ = writeln!(
                text,
                "{}: {:.1} rays and {:.1} stored photons of each, power varies by {:.2}, error per million rays {:.4}",
                row.name,
                row.rays,
                row.stored,
                row.deviation,
                row.error_per_million_rays()
            );
        }
        text
    }

    /// Error against photons in each place; how power is distributed; caustics of all patterns.
    #[must_use]
    pub fn svg(&self) -> String {
        let parts = Place::ALL.map(|place| {
            let of_place = self.patterns.iter().filter(|curve| curve.place == place);
            let series = of_place.map(|curve| Series {
                name: curve.pattern.to_owned(),
                points: curve.points.clone(),
                mark: Mark::LineAndDots,
            });
            Part::Panel(Panel {
                title: format!("{} light on a floor", place.name()),
                x_label: "photons".to_owned(),
                y_label: "relative error".to_owned(),
                axes: Axes::Logarithmic,
                legend: Corner::LowerLeft,
                series: series.collect(),
                ..Panel::default()
            })
        });
        let powers = Panel {
            title: "power of stored photons, varnished room".to_owned(),
            x_label: "power over the mean".to_owned(),
            y_label: "share of photons in half a decade".to_owned(),
            legend: Corner::UpperLeft,
            series: self.absorption.iter().map(looks::power_curve).collect(),
            ..Panel::default()
        };
        let pictures = self.pictures.iter().map(|(name, image)| {
            Part::Picture(format!("caustic of {} photons: {name}", looks::N_PHOTONS), image.clone())
        });
        let parts: Vec<Part> = parts.into_iter().chain([Part::Panel(powers)]).chain(pictures).collect();
        draw_rows(&parts, 4)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// EXP-20: even patterns are better than random ones, most where nothing lies between lamp and floor; and EXP-10: roulette keeps
    /// powers even, and costs least for its error.
    #[test]
    fn even_photons_err_less_and_roulette_keeps_power() {
        let settings = EmissionStudySettings {
            log2_photons: vec![12, 15],
            n_runs: 3,
            log2_reference: 19,
            ..EmissionStudySettings::quick(1)
        };
        let study = photon_emission(&settings, &mut |_| {});
        let last = |place: Place, pattern: &str| {
            let curve = study.patterns.iter().find(|curve| curve.place == place && curve.pattern == pattern);
            curve.expect("it is measured").points.last().expect("it has points")[1]
        };
        assert!(last(Place::Direct, "qmc") < 0.7 * last(Place::Direct, "random"));
        assert!(last(Place::Caustic, "qmc") < last(Place::Caustic, "random"));
        let [roulette, scale, branch] = [0, 1, 2].map(|i| &study.absorption[i]);
        assert!(roulette.deviation < 0.5 * scale.deviation && roulette.deviation < 0.5 * branch.deviation);
        // Nearly all photons of roulette have the mean power; those that only weaken reach far below it.
        let about_mean = |row: &AbsorptionRow| {
            row.shares
                .iter()
                .filter(|[power, _]| (0.5..2.0).contains(power))
                .map(|[_, share]| share)
                .sum::<f64>()
        };
        assert!(
            about_mean(roulette) > 0.95 && about_mean(scale) < 0.5,
            "{:?} {:?}",
            roulette.shares,
            scale.shares
        );
        let total: f64 = branch.shares.iter().map(|[_, share]| share).sum();
        assert!((total - 1.0).abs() < 1e-9 && branch.shares.len() > scale.shares.len());
        assert_eq!(study.pictures.len(), PhotonPattern::NAMES.len());
        assert!(branch.rays > 100.0, "{} rays of a photon that branches", branch.rays);
        assert!(
            study.csv().lines().count() > 12 && study.svg().contains("</svg>") && !study.summary().is_empty()
        );
    }
}
