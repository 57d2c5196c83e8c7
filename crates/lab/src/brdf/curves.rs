//! Curves of a BSDF: its lobe in the plane of incidence, albedo against angle, and samples against their density.

use std::f64::consts::{PI, TAU};

use etendue_math::{Frame, Point2, Rng, Vector3, hash64};
use etendue_scene::bsdf::laws::{albedo, direction};
use etendue_scene::bsdf::{BsdfKind, Lobes, TransportMode};
use rayon::prelude::*;

use super::subject::LAMBDA_NM;

/// A named curve.
#[derive(Clone, Debug, PartialEq)]
pub struct Curve {
    /// What it shows.
    pub name: String,
    /// Angle in degrees and value.
    pub points: Vec<[f64; 2]>,
}

/// Polar angles of incidence, in degrees, for which the lobe is drawn.
pub const INCIDENCE_DEG: [f32; 6] = [0.0, 15.0, 30.0, 45.0, 60.0, 75.0];

/// The lobe in the plane of incidence: light arrives from the left.
#[derive(Clone, Debug, PartialEq)]
pub struct Lobe {
    /// Polar angle of incidence in degrees.
    pub incidence_deg: f32,
    /// Polar angle in degrees, positive to the right of the normal, beyond 90 below the surface; and the mean of
    /// `f |cos|` over wavelengths, in 1/sr.
    pub points: Vec<[f64; 2]>,
    /// Dirac lobes: angle and share of the flux.
    pub spikes: Vec<[f64; 2]>,
}

/// The direction at a polar angle, in the plane y = 0.
fn in_plane(angle_deg: f64) -> Vector3 {
    direction(angle_deg.abs() as f32, if angle_deg < 0.0 { PI as f32 } else { 0.0 })
}

/// The lobe for each angle of [`INCIDENCE_DEG`].
#[must_use]
pub fn lobes(kind: &BsdfKind) -> Vec<Lobe> {
    INCIDENCE_DEG.into_par_iter().map(|incidence_deg| lobe(kind, incidence_deg)).collect()
}

fn lobe(kind: &BsdfKind, incidence_deg: f32) -> Lobe {
    let steps_per_degree = if kind.is_stochastic() { 1 } else { 4 };
    let wo = in_plane(-f64::from(incidence_deg));
    let end = if kind.lobes().is_transmissive() { 180 } else { 90 } * steps_per_degree;
    let points = (-end..=end).map(|i| {
        let angle = f64::from(i) / f64::from(steps_per_degree);
        [angle, f_cos(kind, wo, in_plane(angle), 2048)]
    });
    let spikes = [Lobes::SPECULAR_REFLECT, Lobes::SPECULAR_TRANSMIT].into_iter().filter_map(|lobe| {
        let sample = kind.sample(wo, 0.5, Point2::new(0.5, 0.5), TransportMode::Importance, lobe)?;
        let angle = f64::from(sample.wi.x.atan2(sample.wi.z)).to_degrees();
        Some([angle, f64::from(sample.weight.average() * sample.pmf)])
    });
    Lobe { incidence_deg, points: points.collect(), spikes: spikes.collect() }
}

/// `f |cos|` in 1/sr, the mean over wavelengths; where `eval` is an estimate, the mean of `n`, whose directions differ by
/// less than a quarter of a degree.
fn f_cos(kind: &BsdfKind, wo: Vector3, wi: Vector3, n: usize) -> f64 {
    let of = |wo, wi: Vector3| {
        f64::from(kind.eval(wo, wi, TransportMode::Radiance, Lobes::ALL).average() * wi.z.abs())
    };
    if !kind.is_stochastic() {
        return of(wo, wi);
    }
    let mut rng = Rng::new(hash64(&[u64::from(wi.x.to_bits()), u64::from(wi.z.to_bits())]), 0);
    let mut near = |w: Vector3| {
        let mut offset = || (rng.next_f32() - 0.5) * 0.004;
        (w + Vector3::new(offset(), offset(), offset())).normalized()
    };
    (0..n).map(|_| of(near(wo), near(wi))).sum::<f64>() / n as f64
}

/// Angle of incidence of the lobe in space and of the histograms, in degrees.
pub const SHOWN_INCIDENCE_DEG: f32 = 45.0;

/// The lobe in space: meridians about the mirror direction, and about the refracted one where light passes, as points
/// of the direction times `f |cos|` in 1/sr. Points lie close to each other near these directions.
#[must_use]
pub fn meridians(kind: &BsdfKind) -> Vec<Vec<[f64; 3]>> {
    if !kind.lobes().has_non_specular() {
        return Vec::new();
    }
    const N_MERIDIANS: usize = 36;
    const N_STEPS: usize = 60;
    let wo = in_plane(-f64::from(SHOWN_INCIDENCE_DEG));
    let mirror = Vector3::new(-wo.x, -wo.y, wo.z);
    let through = kind.sample(wo, 0.999, Point2::new(0.0, 0.0), TransportMode::Radiance, Lobes::TRANSMIT);
    let axes = [Some(mirror), through.map(|sample| sample.wi)].into_iter().flatten();
    let lines: Vec<(Frame, f64, usize)> = axes
        .flat_map(|axis| {
            let side = f64::from(axis.z.signum());
            (0..N_MERIDIANS).map(move |m| (Frame::from_z(axis), side, m))
        })
        .collect();
    let line = |(frame, side, m): &(Frame, f64, usize)| {
        let azimuth = TAU * *m as f64 / N_MERIDIANS as f64;
        let directions = (0..=N_STEPS).map(|i| {
            let share = i as f64 / N_STEPS as f64;
            frame.to_world(direction((180.0 * share * share) as f32, azimuth as f32))
        });
        let on_side = directions.take_while(|wi| f64::from(wi.z) * side > 0.0);
        on_side
            .map(|wi| {
                let f = f_cos(kind, wo, wi, 256);
                [wi.x, wi.y, wi.z].map(|x| f64::from(x) * f)
            })
            .collect()
    };
    lines.par_iter().map(line).collect()
}

/// Share of the flux that leaves against the polar angle of incidence: by wavelength, and what is reflected and
/// transmitted where both happen.
#[must_use]
pub fn albedo_curves(kind: &BsdfKind) -> Vec<Curve> {
    let angles: Vec<f64> = (0..=29).map(|i| f64::from(i) * 3.0).chain([88.0, 89.0, 89.5]).collect();
    let values = |lobes: Lobes| -> Vec<[f64; 4]> {
        let at =
            |angle: &f64| albedo(kind, in_plane(-angle), TransportMode::Importance, lobes).map(|e| e.value);
        angles.par_iter().map(at).collect()
    };
    let curve = |name: String, value: &dyn Fn(usize) -> f64| Curve {
        name,
        points: angles.iter().enumerate().map(|(i, angle)| [*angle, value(i)]).collect(),
    };
    let all = values(Lobes::ALL);
    let is_grey = all.iter().all(|v| v.iter().all(|x| (x - v[0]).abs() < 1e-6));
    let mut curves: Vec<Curve> = if is_grey {
        vec![curve("all wavelengths".to_owned(), &|i| all[i][0])]
    } else {
        let name = |k: usize| format!("{} nm", LAMBDA_NM[k]);
        (0..4).map(|k| curve(name(k), &|i| all[i][k])).collect()
    };
    let lobes = kind.lobes();
    if lobes.is_reflective() && lobes.is_transmissive() {
        for (name, part) in [("reflected, mean", Lobes::REFLECT), ("transmitted, mean", Lobes::TRANSMIT)] {
            let share = shares(kind, &angles, part);
            curves.push(curve(name.to_owned(), &|i| share[i]));
        }
    }
    curves
}

/// Share of the flux that goes to one side, as samples of all lobes have it, mean over wavelengths.
fn shares(kind: &BsdfKind, angles: &[f64], part: Lobes) -> Vec<f64> {
    const N: usize = 8192;
    let share = |angle: &f64| {
        let mut rng = Rng::new(hash64(&[5]), 0);
        let weight = |_| {
            let (u_component, u) = (rng.next_f32(), rng.next_point2());
            let sample = kind.sample(in_plane(-angle), u_component, u, TransportMode::Importance, Lobes::ALL);
            sample.filter(|s| part.contains(s.lobe)).map_or(0.0, |s| f64::from(s.weight.average()))
        };
        (0..N).map(weight).sum::<f64>() / N as f64
    };
    angles.par_iter().map(share).collect()
}

/// How often samples fall into a range of angles, against what their density says.
#[derive(Clone, Debug, PartialEq)]
pub struct Histogram {
    /// `polar angle` or `azimuth`.
    pub angle: &'static str,
    /// Share of all samples per degree.
    pub samples: Curve,
    /// The same by the density.
    pub pdf: Curve,
}

/// Samples against density over polar angle and azimuth; empty if there are Dirac lobes alone.
#[must_use]
pub fn histograms(kind: &BsdfKind) -> Vec<Histogram> {
    if !kind.lobes().has_non_specular() {
        return Vec::new();
    }
    let wo = direction(SHOWN_INCIDENCE_DEG, PI as f32);
    let end = if kind.lobes().is_transmissive() { 180.0 } else { 90.0 };
    let mut counted = [Bins::new(0.0, end), Bins::new(-180.0, 180.0)];
    let mut expected = counted.clone();
    const N_SAMPLES: usize = 400_000;
    let mut rng = Rng::new(hash64(&[6]), 0);
    for _ in 0..N_SAMPLES {
        let (u_component, u) = (rng.next_f32(), rng.next_point2());
        let sample = kind.sample(wo, u_component, u, TransportMode::Radiance, Lobes::ALL);
        let Some(sample) = sample.filter(|sample| !sample.is_specular()) else { continue };
        let polar = f64::from(sample.wi.z).clamp(-1.0, 1.0).acos().to_degrees();
        let azimuth = f64::from(sample.wi.y).atan2(f64::from(sample.wi.x)).to_degrees();
        counted[0].add(polar, 1.0 / N_SAMPLES as f64);
        counted[1].add(azimuth, 1.0 / N_SAMPLES as f64);
    }
    add_density(kind, wo, &mut expected);
    let [polar, azimuth] = counted.map(|bins| bins.curve("samples"));
    let name = if kind.is_stochastic() { "pdf, a likeness" } else { "pdf" };
    let [polar_pdf, azimuth_pdf] = expected.map(|bins| bins.curve(name));
    vec![
        Histogram { angle: "polar angle", samples: polar, pdf: polar_pdf },
        Histogram { angle: "azimuth", samples: azimuth, pdf: azimuth_pdf },
    ]
}

/// Integrates the density over bins of polar angle and of azimuth, by the midpoint rule.
fn add_density(kind: &BsdfKind, wo: Vector3, bins: &mut [Bins; 2]) {
    const N_POLAR: usize = 720;
    const N_AZIMUTH: usize = 720;
    let step = [bins[0].end.to_radians() / N_POLAR as f64, TAU / N_AZIMUTH as f64];
    for i in 0..N_POLAR {
        let polar = (i as f64 + 0.5) * step[0];
        for k in 0..N_AZIMUTH {
            let azimuth = (k as f64 + 0.5) * step[1] - PI;
            let wi = direction(polar.to_degrees() as f32, azimuth as f32);
            let mass = f64::from(kind.pdf(wo, wi, Lobes::ALL)) * polar.sin() * step[0] * step[1];
            bins[0].add(polar.to_degrees(), mass);
            bins[1].add(azimuth.to_degrees(), mass);
        }
    }
}

/// Mass over equal ranges of an angle in degrees.
#[derive(Clone)]
struct Bins {
    start: f64,
    end: f64,
    mass: Vec<f64>,
}

impl Bins {
    const N: usize = 90;

    fn new(start: f64, end: f64) -> Self {
        Self { start, end, mass: vec![0.0; Self::N] }
    }

    fn width(&self) -> f64 {
        (self.end - self.start) / Self::N as f64
    }

    fn add(&mut self, angle: f64, mass: f64) {
        let index = (angle - self.start) / self.width();
        self.mass[(index.max(0.0) as usize).min(Self::N - 1)] += mass;
    }

    fn curve(&self, name: &str) -> Curve {
        let width = self.width();
        let point = |(i, mass): (usize, &f64)| [self.start + (i as f64 + 0.5) * width, mass / width];
        Curve { name: name.to_owned(), points: self.mass.iter().enumerate().map(point).collect() }
    }
}
