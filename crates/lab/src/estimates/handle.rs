//! Histogram against radiance estimate (SPEC EXP-6, EST-11): the handle of a door, of many small triangles.
//!
//! A histogram counts photons by triangle. A small part of a scene gets few photons, and if it has many triangles most of them
//! get none: black spots all over the handle, while the wall beside it is fine. The radiance estimate does not know of triangles.

use std::f32::consts::{FRAC_PI_2, PI};

use etendue_math::{Point3, Rng, Vector3, hash64};
use etendue_spectrum::Xyz;
use etendue_transport::photon::estimate::DensityEstimate;
use etendue_transport::photon::estimate::histogram::FluxHistogram;

use super::CurveStudy;
use super::field::{Field, Searchable};
use crate::plot::{Axes, Corner, Mark, Panel, Series};

/// Settings of the study.
#[derive(Clone, Debug, PartialEq)]
pub struct HandleSettings {
    /// Triangles of the lit half of the handle.
    pub n_triangles: Vec<usize>,
    /// Photons on the handle.
    pub counts: Vec<usize>,
    /// Photons of an estimate.
    pub k: usize,
    /// Determines all random numbers.
    pub seed: u64,
}

impl HandleSettings {
    /// As the documentation shows it.
    #[must_use]
    pub fn full(seed: u64) -> Self {
        let counts = vec![100, 300, 1000, 3000, 10_000, 30_000, 100_000];
        Self { n_triangles: vec![256, 4096], counts, k: 50, seed }
    }

    /// A rough version.
    #[must_use]
    pub fn quick(seed: u64) -> Self {
        Self { counts: vec![100, 1000, 10_000], ..Self::full(seed) }
    }
}

/// The handle is a cylinder along y, lit from +z.
const RADIUS: f32 = 0.01;
const LENGTH: f32 = 0.12;
/// Rims where estimates lack photons are left out: a quarter of the length, and where light grazes.
const GRAZING: f32 = 0.3;

/// Runs the study.
#[must_use]
pub fn handle(settings: &HandleSettings) -> CurveStudy {
    let mut black = Vec::new();
    let mut errors = Vec::new();
    let mut summary = String::new();
    let mut of_estimate = Vec::new();
    for &n_triangles in &settings.n_triangles {
        let (mut shares, mut of_histogram) = (Vec::new(), Vec::new());
        of_estimate.clear();
        for &n in &settings.counts {
            let [share, histogram, estimate] = compare(n_triangles, n, settings);
            shares.push([n as f64, share]);
            of_histogram.push([n as f64, histogram]);
            of_estimate.push([n as f64, estimate]);
            summary += &format!(
                "{n_triangles} triangles, {n} photons: {:.1} % black; error of the histogram {histogram:.3}, of the estimate {estimate:.3}\n",
                100.0 * share
            );
        }
        let name = format!("histogram, {n_triangles} triangles");
        black.push(Series { name: name.clone(), points: shares, mark: Mark::LineAndDots });
        errors.push(Series { name, points: of_histogram, mark: Mark::LineAndDots });
    }
    errors.push(Series {
        name: format!("estimate, k = {}", settings.k),
        points: of_estimate,
        mark: Mark::LineAndDots,
    });
    let panels = vec![
        Panel {
            title: "black triangles".to_owned(),
            x_label: "photons on the handle".to_owned(),
            y_label: "share of those that are lit".to_owned(),
            axes: Axes::SemiLogarithmic,
            legend: Corner::UpperRight,
            series: black,
            ..Panel::default()
        },
        Panel {
            title: "error of irradiance".to_owned(),
            x_label: "photons on the handle".to_owned(),
            y_label: "relative error (RMS)".to_owned(),
            legend: Corner::LowerLeft,
            series: errors,
            ..Panel::default()
        },
    ];
    CurveStudy { panels, summary }
}

/// Share of lit triangles without photons, and errors of histogram and estimate.
fn compare(n_triangles: usize, n: usize, settings: &HandleSettings) -> [f64; 3] {
    let mut rng = Rng::new(hash64(&[settings.seed, n as u64, n_triangles as u64]), 0);
    // Quadrilaterals of two triangles: as many around as along.
    let side = ((n_triangles / 2) as f32).sqrt().round().max(1.0) as usize;
    let area = f64::from(PI * RADIUS * LENGTH) / (2 * side * side) as f64;
    let mut histogram = FluxHistogram::new(std::iter::repeat_n(area, 2 * side * side));
    let mut field = Field::default();
    for _ in 0..n {
        let x = 2.0 * rng.next_f32() - 1.0;
        let (around, along) = ((x.asin() + FRAC_PI_2) / PI, rng.next_f32());
        let (u, v) = (around * side as f32, along * side as f32);
        let cell = (u as usize).min(side - 1) + side * (v as usize).min(side - 1);
        let is_upper = u.fract() + v.fract() > 1.0;
        histogram.add(2 * cell + usize::from(is_upper), Xyz::new(1.0, 1.0, 1.0));
        let z = (1.0 - x * x).sqrt();
        field.add(Point3::new(RADIUS * x, LENGTH * along, RADIUS * z), Vector3::new(0.0, 0.0, 1.0));
    }
    let field = Searchable::new(field);
    // Photons per m^2 where light is perpendicular.
    let full = n as f64 / f64::from(2.0 * RADIUS * LENGTH);
    let (mut of_histogram, mut of_estimate, mut n_compared) = (0.0, 0.0, 0.0);
    for cell in 0..side * side {
        for is_upper in [0, 1] {
            let third = [1.0 / 3.0, 2.0 / 3.0][is_upper];
            let angle = ((cell % side) as f32 + third) / side as f32 * PI - FRAC_PI_2;
            let along = ((cell / side) as f32 + third) / side as f32;
            let cosine = angle.cos();
            if cosine < GRAZING || (along - 0.5).abs() > 0.25 {
                continue;
            }
            let normal = Vector3::new(angle.sin(), 0.0, cosine);
            let p = Point3::new(RADIUS * normal.x, LENGTH * along, RADIUS * normal.z);
            let truth = full * f64::from(cosine);
            let counted = f64::from(histogram.irradiance(2 * cell + is_upper).y);
            let estimated = field.density(&DensityEstimate::default(), (p, normal), settings.k);
            of_histogram += (counted / truth - 1.0).powi(2);
            of_estimate += (estimated / truth - 1.0).powi(2);
            n_compared += 1.0;
        }
    }
    let black = histogram.n_black() as f64 / histogram.len() as f64;
    [black, (of_histogram / n_compared).sqrt(), (of_estimate / n_compared).sqrt()]
}
