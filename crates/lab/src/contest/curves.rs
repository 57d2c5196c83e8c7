//! How many photons are enough, and whether more are needed where the scene is complicated (SPEC EXP-15, EXP-39).
//!
//! The box with walls of a fractal surface, and the same box with flat ones, by photon maps of ever more photons; direct light comes by
//! rays. An estimate divides by the area of a disc, and a rough surface has more than that within the radius: where the radius is wider than
//! the roughness, rough walls come out too bright, however many photons there are. The density of photons is that of the
//! estimates where the camera looks: `k / (pi r^2)`.

use std::fmt::Write;
use std::time::Duration;

use super::{Contest, ContestSettings, ContestStudy, Way, contest};
use crate::plot::{Corner, Mark, Panel, Series, draw};
use crate::scenes::StudyScene;

/// Photons of the global map; the caustic map has a quarter of them, as in the book (200,000 and 50,000).
const COUNTS: [u32; 5] = [1000, 5000, 25_000, 100_000, 400_000];
/// Photons of an estimate of directly seen maps.
const K: u32 = 50;

/// Result of the study.
#[derive(Clone, Debug, Default)]
pub struct PhotonCounts {
    /// All measurements.
    pub study: ContestStudy,
}

/// Runs the study; see [`contest`](super::contest).
pub fn photon_counts(
    settings: &ContestSettings,
    levels: u32,
    clock: &dyn Fn() -> Duration,
    progress: &mut dyn FnMut(&str),
) -> PhotonCounts {
    let walls = [("flat walls", "0.0001"), ("fractal walls", "0.1")];
    let contests = walls.map(|(name, height)| Contest {
        name: name.to_owned(),
        scene: StudyScene::generated("fractal-box", &[("levels", &levels.to_string()), ("height", height)])
            .with_resolution([settings.width; 2]),
        paths: None,
        reference: Way {
            name: "path".to_owned(),
            integrator: "\"path\" \"integer maxdepth\" 64".to_owned(),
            n_samples: settings.reference_samples,
            is_unbiased: true,
        },
        ways: METHODS
            .iter()
            .flat_map(|method| COUNTS.map(|n| method.way(settings.count(n), settings)))
            .collect(),
    });
    PhotonCounts { study: contest(&contests, settings, clock, progress) }
}

/// One kind of picture.
struct Method {
    name: &'static str,
    integrator: fn(u32) -> String,
}

const METHODS: [Method; 2] = [
    Method {
        name: "direct by rays, rest by photons",
        integrator: |n| {
            format!(
                "\"photons\" \"string show\" \"shadowrays\" \"integer photons\" {n} \"integer nearest\" {K}"
            )
        },
    },
    Method {
        name: "two passes",
        integrator: |n| {
            format!(
                "\"photonmap\" \"integer globalphotons\" {n} \"integer causticphotons\" {} \"integer globalnearest\" {K} \"integer causticnearest\" {K}",
                (n / 4).max(1)
            )
        },
    },
];

impl Method {
    fn way(&self, n: u32, settings: &ContestSettings) -> Way {
        Way {
            name: format!("{}: {n}", self.name),
            integrator: (self.integrator)(n),
            n_samples: settings.n_samples / 4,
            is_unbiased: false,
        }
    }
}

impl PhotonCounts {
    /// Photons of the global map, photons for each square metre, and error, of a method in one of the boxes.
    #[must_use]
    pub fn points(&self, walls: &str, method: &str) -> Vec<[f64; 3]> {
        let those =
            self.study.outcomes.iter().filter(|o| o.contest == walls && o.way.name.starts_with(method));
        let point = |o: &super::Outcome| {
            let n = o.way.name.rsplit(": ").next().and_then(|n| n.parse().ok()).unwrap_or(f64::NAN);
            let radius = o.photons.map_or(f64::NAN, |[_, radius]| radius);
            [n, f64::from(K) / (std::f64::consts::PI * radius * radius), o.error]
        };
        those.map(point).collect()
    }

    /// All measurements.
    #[must_use]
    pub fn csv(&self) -> String {
        self.study.csv()
    }

    /// The tables of all measurements, and the densities.
    #[must_use]
    pub fn summary(&self) -> String {
        let mut text = self.study.summary();
        for walls in ["flat walls", "fractal walls"] {
            for [n, density, error] in self.points(walls, METHODS[0].name) {
                let _ = writeln!(
                    text,
                    "{walls}: {n} photons, {density:.0} for each m^2 where seen: error {error:.4}"
                );
            }
        }
        text
    }

    /// Error against photons, for both boxes and methods.
    #[must_use]
    pub fn svg(&self) -> String {
        let panel = |method: &Method| {
            let series = ["flat walls", "fractal walls"].map(|walls| Series {
                name: walls.to_owned(),
                points: self.points(walls, method.name).into_iter().map(|[n, _, error]| [n, error]).collect(),
                mark: Mark::LineAndDots,
            });
            Panel {
                title: method.name.to_owned(),
                x_label: "photons of the global map".to_owned(),
                y_label: "relative error".to_owned(),
                legend: Corner::UpperRight,
                series: series.into(),
                ..Panel::default()
            }
        };
        draw(&[panel(&METHODS[0]), panel(&METHODS[1])])
    }
}
