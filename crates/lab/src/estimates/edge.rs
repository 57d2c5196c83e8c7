//! Filters at the edge of a caustic (SPEC EXP-9, EST-13): how wide the edge becomes, how noisy the light beside it, and whether light
//! is lost.
//!
//! The light is a step: ten times brighter on one side. Each estimate has the same number of photons per m^2 and the same k; so
//! that filters are compared with what they cost in noise, there is a plain estimate of fewer photons too.

use etendue_math::statistics::Moments;
use etendue_math::{Point3, Rng, hash64};
use etendue_transport::photon::estimate::{DensityEstimate, DifferentialChecking, Filter};
use rayon::prelude::*;

use super::CurveStudy;
use super::field::{Field, Searchable, UP, place};
use crate::plot::{Axes, Corner, Mark, Panel, Series};

/// Settings of the study.
#[derive(Clone, Debug, PartialEq)]
pub struct EdgeSettings {
    /// Independent fields.
    pub n_fields: u64,
    /// Photons of an estimate.
    pub k: usize,
    /// Determines all random numbers.
    pub seed: u64,
}

impl EdgeSettings {
    /// As the documentation shows it.
    #[must_use]
    pub const fn full(seed: u64) -> Self {
        Self { n_fields: 200, k: 100, seed }
    }

    /// A rough version.
    #[must_use]
    pub const fn quick(seed: u64) -> Self {
        Self { n_fields: 20, k: 100, seed }
    }
}

/// Photons per m^2 on the bright side.
const BRIGHT: f32 = 10_000.0;
/// The same on the other side, over that.
const DARK: f32 = 0.1;
/// Places across the edge, in both directions.
const N_STEPS: i32 = 40;
/// Places along the edge in each field.
const N_ALONG: u32 = 8;

/// What is compared.
fn ways(k: usize) -> [(&'static str, usize, DensityEstimate); 7] {
    let with = |filter| DensityEstimate { filter, ..DensityEstimate::default() };
    let checking = |run| DensityEstimate {
        checking: Some(DifferentialChecking { min_photons: 8, run }),
        ..DensityEstimate::default()
    };
    [
        ("none", k, with(Filter::Constant)),
        ("none, 0.6 k", k * 6 / 10, with(Filter::Constant)),
        ("cone 1.1", k, with(Filter::CONE)),
        ("Gaussian", k, with(Filter::GAUSSIAN)),
        ("Gaussian of the book", k, with(Filter::BOOK_GAUSSIAN)),
        ("differential, 10", k, checking(10)),
        ("differential, 20", k, checking(20)),
    ]
}

fn field(rng: &mut Rng) -> Field {
    let mut field = Field::default();
    let mut fill = |x: [f32; 2], density: f32, rng: &mut Rng| {
        for _ in 0..((x[1] - x[0]) * density) as usize {
            let at = place(rng, [x, [-0.5, 0.5]]);
            field.add(Point3::new(at[0], at[1], 0.0), UP);
        }
    };
    fill([-1.0, 0.0], BRIGHT, rng);
    fill([0.0, 1.0], BRIGHT * DARK, rng);
    field
}

/// Runs the study.
#[must_use]
pub fn edge(settings: &EdgeSettings) -> CurveStudy {
    let ways = ways(settings.k);
    // Radius of an estimate where it is bright.
    let radius = (settings.k as f32 / (std::f32::consts::PI * BRIGHT)).sqrt();
    // Beyond four radii on the dark side even its larger discs are clear of the edge.
    let step = 4.0 * radius / N_STEPS as f32;
    let fields: Vec<Vec<Vec<Moments>>> = (0..settings.n_fields)
        .into_par_iter()
        .map(|index| {
            let seed = hash64(&[settings.seed, index]);
            let field = Searchable::new(field(&mut Rng::new(seed, 0)));
            ways.map(|(_, k, estimate)| {
                (-N_STEPS..=N_STEPS).map(|i| across(&field, &estimate, k, i as f32 * step)).collect()
            })
            .into()
        })
        .collect();
    let mut profiles = vec![vec![Moments::default(); 2 * N_STEPS as usize + 1]; ways.len()];
    for field in &fields {
        for (profile, of_field) in profiles.iter_mut().zip(field) {
            profile.iter_mut().zip(of_field).for_each(|(sum, moments)| sum.merge(moments));
        }
    }
    let mut summary = String::from(
        "filter: width of the edge (10 % to 90 %, in radii), noise beside it, light found over light there is\n",
    );
    let mut series = Vec::new();
    for ((name, ..), profile) in ways.iter().zip(&profiles) {
        let place = |i: usize| f64::from((i as i32 - N_STEPS) as f32 * step / radius);
        let points: Vec<[f64; 2]> =
            profile.iter().enumerate().map(|(i, m)| [place(i), m.mean() / f64::from(BRIGHT)]).collect();
        let noise = profile[0].standard_deviation() / profile[0].mean();
        let found = points.iter().map(|p| p[1]).sum::<f64>();
        let truth = f64::from(N_STEPS) * (1.0 + f64::from(DARK)) + 0.5 * (1.0 + f64::from(DARK));
        summary += &format!("{name}: {:.2}, {noise:.3}, {:.3}\n", width(&points), found / truth);
        series.push(Series { name: (*name).to_owned(), points, mark: Mark::Line });
    }
    let panel = Panel {
        title: "edge of a caustic".to_owned(),
        x_label: "distance from the edge / radius".to_owned(),
        y_label: "irradiance".to_owned(),
        axes: Axes::Linear([-4.0, 4.0]),
        y_range: Some([0.0, 1.3]),
        legend: Corner::UpperRight,
        series,
        ..Panel::default()
    };
    CurveStudy { panels: vec![panel], summary }
}

fn across(field: &Searchable, estimate: &DensityEstimate, k: usize, x: f32) -> Moments {
    let along = |i: u32| 0.6 * (f64::from(i) as f32 + 0.5) / N_ALONG as f32 - 0.3;
    (0..N_ALONG).map(|i| field.density(estimate, (Point3::new(x, along(i), 0.0), UP), k)).collect()
}

/// From where 90 % of the step are seen to where it is 10 %.
fn width(points: &[[f64; 2]]) -> f64 {
    let (high, low) = (1.0, f64::from(DARK));
    let crossing = |share: f64| {
        let level = low + share * (high - low);
        let last = points.windows(2).rev().find(|w| w[0][1] >= level && w[1][1] < level);
        last.map_or(f64::NAN, |w| w[0][0] + (w[0][1] - level) / (w[0][1] - w[1][1]) * (w[1][0] - w[0][0]))
    };
    crossing(0.1) - crossing(0.9)
}
