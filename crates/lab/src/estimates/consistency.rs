//! The estimate converges (SPEC EXP-8, EST-4): with `N` photons and the `floor(N^a)` nearest of them its error falls for each
//! `a` between 0 and 1.
//!
//! Chance makes a relative error of `1 / sqrt(k)`. Blur makes one of the curvature of the light times the square of the radius,
//! that is of `k / N`. With `k = sqrt(N)` chance rules: `N^(-1/4)`. With `k = N^(2/3)` both fall alike, as `N^(-1/3)`, which is the best
//! there is for such weights. With a fixed `k` the error stays.

use std::f32::consts::TAU;

use etendue_math::{Point3, Rng, hash64};
use etendue_transport::photon::estimate::{DensityEstimate, Filter};
use rayon::prelude::*;

use super::CurveStudy;
use super::field::{Field, Searchable, UP, place};
use crate::fit::PowerLaw;
use crate::plot::{Corner, Mark, Panel, Series};

/// Settings of the study.
#[derive(Clone, Debug, PartialEq)]
pub struct ConsistencySettings {
    /// Numbers of photons.
    pub counts: Vec<usize>,
    /// Estimates at each number.
    pub n_estimates: usize,
    /// Determines all random numbers.
    pub seed: u64,
}

impl ConsistencySettings {
    /// As the documentation shows it: up to ten million photons.
    #[must_use]
    pub fn full(seed: u64) -> Self {
        Self {
            counts: vec![1000, 3000, 10_000, 30_000, 100_000, 300_000, 1_000_000, 3_000_000, 10_000_000],
            n_estimates: 4000,
            seed,
        }
    }

    /// A rough version.
    #[must_use]
    pub fn quick(seed: u64) -> Self {
        Self { counts: vec![1000, 10_000, 100_000], n_estimates: 1000, seed }
    }
}

/// Irradiance over its mean at a place of the unit square.
fn light([x, y]: [f32; 2]) -> f32 {
    1.0 + 0.5 * (TAU * x).sin() * (TAU * y).sin()
}

fn photons(n: usize, rng: &mut Rng) -> Field {
    let mut field = Field::default();
    while field.p.len() < n {
        let at = place(rng, [[0.0, 1.0]; 2]);
        if rng.next_f32() * 1.5 < light(at) {
            field.add(Point3::new(at[0], at[1], 0.0), UP);
        }
    }
    field
}

/// How many photons are asked for, and how they are weighed.
struct Way {
    name: &'static str,
    k: fn(usize) -> usize,
    filter: Filter,
}

const WAYS: [Way; 5] = [
    Way { name: "k = 50", k: |_| 50, filter: Filter::Constant },
    Way { name: "k = √N", k: |n| n.isqrt(), filter: Filter::Constant },
    Way { name: "k = √N, cone", k: |n| n.isqrt(), filter: Filter::CONE },
    Way { name: "k = √N, Gaussian", k: |n| n.isqrt(), filter: Filter::GAUSSIAN },
    Way {
        name: "k = N^(2/3)/4",
        k: |n| ((n as f64).powf(2.0 / 3.0) / 4.0) as usize,
        filter: Filter::Constant,
    },
];

/// Runs the study.
#[must_use]
pub fn consistency(settings: &ConsistencySettings) -> CurveStudy {
    let mut curves = WAYS.map(|way| (way, Vec::new()));
    for &n in &settings.counts {
        // Few photons: estimates of one field are alike, so that more fields are needed.
        let n_fields = (300_000 / n).clamp(1, 50);
        let errors: Vec<[f64; WAYS.len()]> = (0..n_fields)
            .into_par_iter()
            .map(|index| {
                let seed = hash64(&[settings.seed, n as u64, index as u64]);
                let field = Searchable::new(photons(n, &mut Rng::new(seed, 0)));
                square_errors(&field, n, settings.n_estimates / n_fields, &mut Rng::new(seed, 1))
            })
            .collect();
        for (index, (_, points)) in curves.iter_mut().enumerate() {
            let mean = errors.iter().map(|e| e[index]).sum::<f64>() / n_fields as f64;
            points.push([n as f64, mean.sqrt()]);
        }
    }
    let mut summary = String::new();
    let series = curves.into_iter().map(|(way, points)| {
        let slope = PowerLaw::fit(&points).map_or(0.0, |law| law.slope);
        let last = points.last().map_or(0.0, |p| p[1]);
        summary += &format!("{}: error {last:.4} at the end, slope {slope:.3}\n", way.name);
        Series {
            name: format!("{}: slope {slope:.2}", way.name).replace(": slope -", ": slope −"),
            points,
            mark: Mark::LineAndDots,
        }
    });
    let mut series: Vec<Series> = series.collect();
    let law = |n: &usize| [*n as f64, (*n as f64).powf(-0.25)];
    series.push(Series {
        name: "N^(−1/4): chance".to_owned(),
        points: settings.counts.iter().map(law).collect(),
        mark: Mark::Dashes,
    });
    let panel = Panel {
        title: "the estimate is consistent".to_owned(),
        x_label: "photons N".to_owned(),
        y_label: "relative error (RMS)".to_owned(),
        legend: Corner::LowerLeft,
        series,
        ..Panel::default()
    };
    CurveStudy { panels: vec![panel], summary }
}

fn square_errors(field: &Searchable, n: usize, n_estimates: usize, rng: &mut Rng) -> [f64; WAYS.len()] {
    let mut sums = [0.0; WAYS.len()];
    for _ in 0..n_estimates {
        // Away from the borders, beyond which there is no light.
        let at = place(rng, [[0.3, 0.7]; 2]);
        let truth = f64::from(light(at)) * n as f64;
        for (sum, way) in sums.iter_mut().zip(&WAYS) {
            let estimate = DensityEstimate { filter: way.filter, ..DensityEstimate::default() };
            let found = field.density(&estimate, (Point3::new(at[0], at[1], 0.0), UP), (way.k)(n));
            *sum += (found / truth - 1.0).powi(2);
        }
    }
    sums.map(|sum| sum / n_estimates as f64)
}
