//! Sun and sky of a clear day (SPEC EMI-12): light of the sun that the air lets through, and that which it scatters.
//!
//! ```text
//!   L(w) = integral over the ray exp(-tau(s)) (sigma_s(s) p(w, sun) E_sun exp(-tau_sun(s)) + J(s, w)) ds,
//! ```
//!
//! with molecules, haze and ozone around a round earth ([`air`]), the source J of light scattered before ([`orders`]), and
//! measured data of the sun and the air ([`etendue_spectrum::atmosphere`]). The table of the sky ([`dome`]) is made when the
//! scene is built. Left out are clouds, polarisation, refraction of light on its way, and the height of the place.
//!
//! The upper hemisphere is sampled by cells of equal solid angle in proportion to brightness, the ground below, which has
//! the same radiance everywhere, uniformly.

mod air;
mod dome;
mod orders;
mod position;
mod settings;
mod sun;

use std::f32::consts::{FRAC_PI_2, PI, TAU};

use etendue_geometry::Reference;
use etendue_math::{Bounds2, Frame, Normal3, PiecewiseConstant2, Point2, Ray, Vector3};
use etendue_spectrum::{Bands, LAMBDA_MIN_NM, Sampled, Spectrum, SpectrumTables, Wavelengths, photometry};

use super::context::infinite_sample;
use super::{EmittedRay, LightBounds, LightContext, LightPower, LightSample};
use dome::{Dome, FINE_STEP_NM, N_COLUMNS, N_FINE, N_ROWS, elevation};

pub(super) use settings::SkySettings;

pub use position::{Date, Place, SunPosition};
pub use sun::SunLight;

#[cfg(test)]
mod tests;

/// Index of a sky in [`LightTables`](super::LightTables).
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct SkyLightId(pub u32);

/// Cells of the density over height (sine of the elevation) and azimuth.
const N_CELLS: (usize, usize) = (64, 128);

/// The sky without the sun's disc, and the ground.
#[derive(Clone, Debug)]
pub struct SkyLight {
    /// Of the world; z is up, x the sun's side.
    frame: Frame,
    /// Radiance by row, column and wavelength.
    values: Vec<f32>,
    /// The same in bands.
    bands: Vec<[f32; 3]>,
    /// Radiance of the ground.
    ground: Spectrum,
    /// Probability of a direction to the ground.
    ground_share: f32,
    /// Over azimuth / 2 pi and height.
    distribution: PiecewiseConstant2,
    /// Irradiance on the ground.
    horizontal: LightPower,
    /// Integral of the radiance of sky and ground over all directions.
    total: LightPower,
}

/// A place between four entries of the table: their indices and weights.
type Corners = [(usize, f32); 4];

fn corners(height: f32, azimuth: f32) -> Corners {
    let row = (height.clamp(0.0, 1.0).asin() / FRAC_PI_2).sqrt() * (N_ROWS - 1) as f32;
    let column = (azimuth.abs() / PI).min(1.0) * (N_COLUMNS - 1) as f32;
    let (i, j) = ((row as usize).min(N_ROWS - 2), (column as usize).min(N_COLUMNS - 2));
    let (s, t) = ((row - i as f32).clamp(0.0, 1.0), (column - j as f32).clamp(0.0, 1.0));
    let first = i * N_COLUMNS + j;
    [
        (first, (1.0 - s) * (1.0 - t)),
        (first + 1, (1.0 - s) * t),
        (first + N_COLUMNS, s * (1.0 - t)),
        (first + N_COLUMNS + 1, s * t),
    ]
}

impl SkyLight {
    /// The sky over a place where `frame` has z up and the sun on the side of x, `scale` times as bright. The ground below
    /// the horizon is seen if `has_ground`, otherwise it is black.
    pub(super) fn new(
        frame: Frame,
        air: &dome::Atmosphere,
        scale: f32,
        has_ground: bool,
        spectra: &mut SpectrumTables,
    ) -> Self {
        let mut values = Dome::new(air).values;
        values.iter_mut().for_each(|value| *value *= scale);
        let bands =
            values.chunks_exact(N_FINE).map(|entry| Bands::of_light(|nm| fine(entry, nm)).rgb()).collect();
        let horizontal = integrate(&values, |height| height);
        let direct = |nm: f32| {
            photometry::K_M * scale * (air.sunlight(f64::from(nm)) * air.elevation.sin().max(0.0)) as f32
        };
        let albedo = if has_ground { air.ground_albedo as f32 } else { 0.0 };
        let ground = spectra.add_dense(|nm| albedo / PI * (direct(nm) + fine(&horizontal, nm)));
        let ground = Spectrum::table(ground, spectra).as_light(spectra);
        let of = |values: &[f32], spectra: &mut SpectrumTables| {
            let table = spectra.add_dense(|nm| fine(values, nm));
            LightPower::of(&Spectrum::table(table, spectra), spectra)
        };
        let below = LightPower::of(&ground, spectra) * f64::from(TAU);
        let above = of(&integrate(&values, |_| 1.0), spectra);
        let weights = cell_weights(&values);
        let total = below + above;
        Self {
            frame,
            bands,
            ground,
            ground_share: if total.weight > 0.0 { (below.weight / total.weight) as f32 } else { 0.0 },
            distribution: PiecewiseConstant2::new(
                &weights,
                N_CELLS.1,
                N_CELLS.0,
                Bounds2::new(Point2::splat(0.0), Point2::splat(1.0)),
            ),
            horizontal: of(&horizontal, spectra),
            values,
            total,
        }
    }

    /// Irradiance of an unobstructed horizontal plane, without the sun's disc, as a flux per square metre.
    #[must_use]
    pub const fn horizontal_irradiance(&self) -> LightPower {
        self.horizontal
    }

    fn radiance(&self, context: &LightContext, local: Vector3, lambda: &Wavelengths) -> Sampled {
        if local.z <= 0.0 {
            return self.ground.sample(context.spectra, lambda);
        }
        let corners = corners(local.z, local.y.atan2(local.x));
        if lambda.is_bands() {
            let mean = |c: usize| corners.iter().map(|(entry, weight)| weight * self.bands[*entry][c]).sum();
            return lambda.of_bands(Bands::from_rgb(std::array::from_fn(mean)));
        }
        Sampled::from_array(lambda.lambda_nm().map(|nm| {
            let (i, t) = fine_place(nm);
            let at = |entry: usize| {
                let pair = &self.values[entry * N_FINE + i..][..2];
                pair[0] + (pair[1] - pair[0]) * t
            };
            corners.iter().map(|(entry, weight)| weight * at(*entry)).sum()
        }))
    }

    pub(super) fn le(&self, context: &LightContext, direction: Vector3, lambda: &Wavelengths) -> Sampled {
        self.radiance(context, self.frame.to_local(direction), lambda)
    }

    /// A direction of the frame with its density per steradian.
    fn sample_direction(&self, u: Point2) -> (Vector3, f32) {
        let from_z = |z: f32, turn: f32| {
            let (sine, (y, x)) = ((1.0 - z * z).max(0.0).sqrt(), (TAU * turn).sin_cos());
            Vector3::new(sine * x, sine * y, z)
        };
        if u.y < self.ground_share {
            return (from_z(-u.y / self.ground_share, u.x), self.ground_share / TAU);
        }
        let u_sky =
            ((u.y - self.ground_share) / (1.0 - self.ground_share)).clamp(0.0, 1.0 - f32::EPSILON / 2.0);
        let (place, pdf) = self.distribution.sample(Point2::new(u.x, u_sky));
        (from_z(place.y.max(f32::MIN_POSITIVE), place.x), (1.0 - self.ground_share) * pdf / TAU)
    }

    fn pdf_direction(&self, w: Vector3) -> f32 {
        let local = self.frame.to_local(w);
        if local.z <= 0.0 {
            return self.ground_share / TAU;
        }
        let turn = (local.y.atan2(local.x) / TAU).rem_euclid(1.0);
        let place = Point2::new(turn.min(1.0 - f32::EPSILON / 2.0), local.z.min(1.0));
        (1.0 - self.ground_share) * self.distribution.pdf(place) / TAU
    }

    pub(super) fn sample_li(
        &self,
        context: &LightContext,
        _reference: &Reference,
        u: Point2,
        lambda: &Wavelengths,
    ) -> Option<LightSample> {
        let (local, pdf_w) = self.sample_direction(u);
        infinite_sample(self.frame.to_world(local), self.radiance(context, local, lambda), pdf_w)
    }

    pub(super) fn pdf_li(&self, _: &LightContext, _: &Reference, wi: Vector3) -> f32 {
        self.pdf_direction(wi)
    }

    pub(super) fn sample_le(
        &self,
        context: &LightContext,
        u_position: Point2,
        u_direction: Point2,
        lambda: &Wavelengths,
    ) -> Option<EmittedRay> {
        let (local, pdf_w) = self.sample_direction(u_direction);
        let le = self.radiance(context, local, lambda);
        EmittedRay::from_infinity(context.tables, -self.frame.to_world(local), u_position, le, pdf_w)
    }

    pub(super) fn pdf_le(&self, context: &LightContext, ray: &Ray, _: Option<Normal3>) -> (f32, f32) {
        (context.tables.entry_pdf(ray.direction), self.pdf_direction(-ray.direction))
    }

    pub(super) fn power(&self, context: &LightContext) -> LightPower {
        self.total * f64::from(context.tables.scene_sphere.cross_section())
    }

    pub(super) const fn bounds(&self, _: &LightContext) -> Option<LightBounds> {
        None
    }
}

/// Where a wavelength lies in the table.
fn fine_place(nm: f32) -> (usize, f32) {
    let at = ((nm - LAMBDA_MIN_NM) / FINE_STEP_NM).max(0.0);
    let i = (at as usize).min(N_FINE - 2);
    (i, (at - i as f32).min(1.0))
}

/// Value of an entry at a wavelength.
fn fine(entry: &[f32], nm: f32) -> f32 {
    let (i, t) = fine_place(nm);
    entry[i] + (entry[i + 1] - entry[i]) * t
}

/// Integral of the sky's radiance times a function of the height over the upper hemisphere.
fn integrate(values: &[f32], factor: impl Fn(f32) -> f32) -> [f32; N_FINE] {
    let mut sum = [0.0_f64; N_FINE];
    // Trapezia between the entries, exact for what is linear in elevation and azimuth but for the cosine.
    for row in 0..N_ROWS {
        let (below, above) = (elevation(row.saturating_sub(1)), elevation((row + 1).min(N_ROWS - 1)));
        let at = elevation(row);
        let weight = (above - below) / 2.0 * at.cos() * f64::from(factor(at.sin() as f32));
        for column in 0..N_COLUMNS {
            let is_end = column == 0 || column == N_COLUMNS - 1;
            let azimuth = f64::from(TAU) / (N_COLUMNS - 1) as f64 * if is_end { 0.5 } else { 1.0 };
            let entry = &values[(row * N_COLUMNS + column) * N_FINE..][..N_FINE];
            (0..N_FINE).for_each(|i| sum[i] += weight * azimuth * f64::from(entry[i]));
        }
    }
    sum.map(|s| s as f32)
}

/// Mean brightness of the cells of the density, by height and azimuth.
fn cell_weights(values: &[f32]) -> Vec<f32> {
    let brightness: Vec<f32> = values.chunks_exact(N_FINE).map(|entry| entry.iter().sum()).collect();
    let at = |height: f32, turn: f32| -> f32 {
        let azimuth = TAU * if turn > 0.5 { 1.0 - turn } else { turn };
        corners(height, azimuth).iter().map(|(entry, weight)| weight * brightness[*entry]).sum()
    };
    let (rows, columns) = N_CELLS;
    let cell = |i: usize| {
        let places = [0.25, 0.75].map(|t| ((i / columns) as f32 + t) / rows as f32);
        let turns = [0.25, 0.75].map(|t| ((i % columns) as f32 + t) / columns as f32);
        places.iter().flat_map(|height| turns.iter().map(|turn| at(*height, *turn))).sum()
    };
    (0..rows * columns).map(cell).collect()
}
