//! The radiance of the sky over the upper hemisphere, as a table over elevation, angle from the sun's azimuth and
//! wavelength.
//!
//! Along each direction from sea level the light that the air scatters towards the eye is added up: once scattered
//! sunlight with its full phase functions through spherical air, and the source of all further orders from
//! [`orders`](super::orders).

use std::f64::consts::{FRAC_PI_2, PI};

use etendue_spectrum::{LAMBDA_MAX_NM, LAMBDA_MIN_NM, atmosphere, photometry};
use rayon::prelude::*;

use super::air::{Amounts, Optics, RayPoint, distance_to_top, phase};
use super::orders::{AzimuthSource, Basis, Scattered};

/// Elevations in the table, dense at the horizon: 90 degrees times the square of row / (rows - 1).
pub(super) const N_ROWS: usize = 40;
/// Angles from the sun's azimuth, from 0 to 180 degrees.
pub(super) const N_COLUMNS: usize = 41;
/// Wavelengths of the table: the lines of the sun's spectrum lie closer than what the air does to it varies.
pub(super) const N_FINE: usize = 48;
pub(super) const FINE_STEP_NM: f32 = (LAMBDA_MAX_NM - LAMBDA_MIN_NM) / (N_FINE - 1) as f32;
/// Wavelengths for which scattering is computed.
const N_COARSE: usize = 24;
const COARSE_STEP_NM: f64 = (LAMBDA_MAX_NM - LAMBDA_MIN_NM) as f64 / (N_COARSE - 1) as f64;
/// Points along a direction.
const N_STEPS: usize = 40;

/// What the air is like, and where the sun stands.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Atmosphere {
    /// Haze: 1 for none, 2 to 3 for a clear day, 10 for a hazy one.
    pub(crate) turbidity: f64,
    /// Ozone in Dobson units.
    pub(crate) ozone_du: f64,
    /// Share of light that the ground reflects.
    pub(crate) ground_albedo: f64,
    /// Elevation of the sun in radians.
    pub(crate) elevation: f64,
}

impl Atmosphere {
    /// Irradiance in W/(m^2 nm) of a plane at sea level that faces the sun, by the sun's disc alone.
    pub(crate) fn sunlight(&self, nm: f64) -> f64 {
        self.transmittance(nm) * atmosphere::solar_irradiance(nm)
    }

    /// Share of sunlight that gets to sea level unscattered.
    fn transmittance(&self, nm: f64) -> f64 {
        Amounts::to_space(0.0, self.elevation.sin().max(0.0))
            .map_or(0.0, |amounts| (-Optics::new(nm, self.turbidity, self.ozone_du).depth(amounts)).exp())
    }
}

/// The table.
#[derive(Clone, Debug)]
pub(super) struct Dome {
    /// Radiance in internal units by row, column and wavelength.
    pub(super) values: Vec<f32>,
}

/// Elevation of a row in radians.
pub(super) fn elevation(row: usize) -> f64 {
    FRAC_PI_2 * (row as f64 / (N_ROWS - 1) as f64).powi(2)
}

impl Dome {
    pub(super) fn new(air: &Atmosphere) -> Self {
        let basis = Basis::new(air.elevation.sin());
        let wavelengths: Vec<(Optics, Scattered)> = (0..N_COARSE)
            .into_par_iter()
            .map(|i| {
                let nm = f64::from(LAMBDA_MIN_NM) + i as f64 * COARSE_STEP_NM;
                let optics = Optics::new(nm, air.turbidity, air.ozone_du);
                (optics, Scattered::new(&basis, &optics, air.ground_albedo))
            })
            .collect();
        let columns: Vec<Vec<[f64; N_COARSE]>> = (0..N_COLUMNS)
            .into_par_iter()
            .map(|column| {
                let azimuth = PI * column as f64 / (N_COLUMNS - 1) as f64;
                column_radiance(air, &basis, &wavelengths, azimuth)
            })
            .collect();
        Self { values: refine(&columns) }
    }
}

/// Radiance for a sun of irradiance 1 in the directions of one azimuth, by row and wavelength.
fn column_radiance(
    air: &Atmosphere,
    basis: &Basis,
    wavelengths: &[(Optics, Scattered)],
    azimuth: f64,
) -> Vec<[f64; N_COARSE]> {
    let sources: Vec<AzimuthSource> =
        wavelengths.iter().map(|(_, scattered)| scattered.at_azimuth(azimuth)).collect();
    let radiance = |row: usize| {
        let (sin_sun, cos_sun) = air.elevation.sin_cos();
        let (sine, cosine) = elevation(row).sin_cos();
        let between = (sine * sin_sun + cosine * cos_sun * azimuth.cos()).clamp(-1.0, 1.0);
        let steps = steps_along(sine, sin_sun, between);
        std::array::from_fn(|i| add_up(&steps, &wavelengths[i].0, &sources[i], basis, phase(between)))
    };
    (0..N_ROWS).map(radiance).collect()
}

/// A piece of a ray from the ground.
struct Step {
    point: RayPoint,
    /// The air in it and before it.
    amounts: Amounts,
    before: Amounts,
    /// The air between it and the sun; `None` in the shadow of the earth.
    to_sun: Option<Amounts>,
}

/// The pieces of a ray from sea level with that cosine to the vertical, where `between` is the cosine of the angle between
/// it and the sun.
fn steps_along(cosine: f64, sun_cosine: f64, between: f64) -> Vec<Step> {
    let end = distance_to_top(cosine);
    let mut before = Amounts::default();
    (0..N_STEPS)
        .map(|i| {
            // Short pieces where the air is dense.
            let x = (i as f64 + 0.5) / N_STEPS as f64;
            let length = end * 2.0 * x / N_STEPS as f64;
            let point = RayPoint::at(end * x * x, cosine, sun_cosine, between);
            let amounts = Amounts::default().plus(Amounts::at(point.height_km), length);
            let step =
                Step { point, amounts, before, to_sun: Amounts::to_space(point.height_km, point.sun_cosine) };
            before = before.plus(amounts, 1.0);
            step
        })
        .collect()
}

/// Radiance at the start of a ray.
fn add_up(steps: &[Step], optics: &Optics, source: &AzimuthSource, basis: &Basis, phase: [f64; 2]) -> f64 {
    steps
        .iter()
        .map(|step| {
            let depth = optics.depth(step.amounts);
            let [molecules, haze] = optics.scattering(step.amounts);
            let sunlight = step.to_sun.map_or(0.0, |amounts| (-optics.depth(amounts)).exp());
            let once = (molecules * phase[0] + haze * phase[1]) * sunlight;
            let more = depth * source.at(basis, step.point.height_km, step.point.cosine);
            // The mean of what gets out of the piece.
            let out = if depth > 1e-6 { -(-depth).exp_m1() / depth } else { 1.0 };
            (-optics.depth(step.before)).exp() * out * (once + more)
        })
        .sum()
}

/// The table of radiance in internal units: the smooth spectrum of the air times that of the sun.
fn refine(columns: &[Vec<[f64; N_COARSE]>]) -> Vec<f32> {
    let mut values = Vec::with_capacity(N_ROWS * N_COLUMNS * N_FINE);
    let zenith: [f64; N_COARSE] =
        std::array::from_fn(|i| columns.iter().map(|c| c[N_ROWS - 1][i]).sum::<f64>() / N_COLUMNS as f64);
    for row in 0..N_ROWS {
        for column in columns {
            // All azimuths meet in the zenith.
            let coarse = if row == N_ROWS - 1 { &zenith } else { &column[row] };
            values.extend((0..N_FINE).map(|i| {
                let nm = f64::from(LAMBDA_MIN_NM + i as f32 * FINE_STEP_NM);
                let at = ((nm - f64::from(LAMBDA_MIN_NM)) / COARSE_STEP_NM).min((N_COARSE - 1) as f64);
                let k = (at as usize).min(N_COARSE - 2);
                let smooth = coarse[k] + (coarse[k + 1] - coarse[k]) * (at - k as f64);
                (f64::from(photometry::K_M) * smooth * atmosphere::solar_irradiance(nm)) as f32
            }));
        }
    }
    values
}
