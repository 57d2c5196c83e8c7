//! The table of a luminaire on a surface that emits (SPEC EMI-8).
//!
//! From afar a flat luminaire of area A with the intensity I at the angle theta to its normal has the radiance
//! L(theta) = I(theta) / (A cos theta). Every point of a shape sends light so around its own normal: I is the mean around the
//! table's axis (downwards for type C, ahead for types A and B), and what the table has behind is left out. Within 3 degrees of
//! the surface L stays what it is there, lest it grow without bound.

use std::f32::consts::PI;
use std::sync::Arc;

use etendue_math::{Frame, PiecewiseConstant1, Point2, Vector3, safe_acos};

use crate::light::Photometry;

/// Index of a table in [`LightTables`](crate::light::LightTables).
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct LuminousProfileId(pub u32);

/// Intervals of equal angles from the normal to the surface: a tenth of a degree each.
const N_ANGLES: usize = 900;
/// Azimuths that mean intensities are taken of.
const N_AZIMUTHS: usize = 72;
/// Cells of the density over sin^2 theta.
const N_CELLS: usize = 1024;
/// The least cosine that intensities are divided by.
const MIN_COSINE: f32 = 0.05;

/// Radiance by the angle to the normal, over that of a matte surface of the same flux.
#[derive(Clone, Debug)]
pub struct LuminousProfile {
    /// What it was made of.
    table: Arc<Photometry>,
    /// pi I / flux at equal angles.
    intensity: Vec<f32>,
    /// In proportion to radiance over x = sin^2 theta; d omega cos theta = dx d phi / 2.
    distribution: PiecewiseConstant1,
    lumens: f64,
}

impl LuminousProfile {
    /// From a table; `None` if it has no light in front.
    #[must_use]
    pub fn new(photometry: &Arc<Photometry>) -> Option<Self> {
        let frame = Frame::from_z(photometry.axis());
        let mean = |theta: f32| {
            let around = (0..N_AZIMUTHS).map(|i| {
                let (sin_phi, cos_phi) = (2.0 * PI * (i as f32 + 0.5) / N_AZIMUTHS as f32).sin_cos();
                let w = Vector3::new(theta.sin() * cos_phi, theta.sin() * sin_phi, theta.cos());
                photometry.intensity(frame.to_world(w))
            });
            around.sum::<f32>() / N_AZIMUTHS as f32
        };
        let candela: Vec<f32> = (0..=N_ANGLES).map(|i| mean(angle(i as f32))).collect();
        let raw = Self {
            table: photometry.clone(),
            intensity: candela,
            distribution: PiecewiseConstant1::new(&[1.0], 0.0, 1.0),
            lumens: 0.0,
        };
        // Midpoints between the angles, where radiance times cosine is nearly linear.
        let n = 4 * N_ANGLES;
        let step = f64::from(angle(N_ANGLES as f32)) / n as f64;
        let flux_at = |i: usize| {
            let theta = (i as f64 + 0.5) * step;
            f64::from(raw.relative(theta.cos() as f32)) * theta.sin() * theta.cos()
        };
        let lumens = 2.0 * std::f64::consts::PI * step * (0..n).map(flux_at).sum::<f64>();
        if !(lumens > 0.0 && lumens.is_finite()) {
            return None;
        }
        let factor = (std::f64::consts::PI / lumens) as f32;
        let scaled = Self { intensity: raw.intensity.iter().map(|i| i * factor).collect(), ..raw };
        let weights: Vec<f32> = (0..N_CELLS).map(|cell| scaled.largest_within(cell)).collect();
        Some(Self { distribution: PiecewiseConstant1::new(&weights, 0.0, 1.0), lumens, ..scaled })
    }

    /// True if it was made of that table.
    #[must_use]
    pub fn is_of(&self, photometry: &Arc<Photometry>) -> bool {
        Arc::ptr_eq(&self.table, photometry)
    }

    /// The largest radiance within a cell: at its ends, and at the angles of the table inside of it.
    fn largest_within(&self, cell: usize) -> f32 {
        let [first, last] = [cell, cell + 1].map(|i| (i as f32 / N_CELLS as f32).sqrt().min(1.0).asin());
        let index = |theta: f32| theta / angle(1.0);
        let inside = (index(first).ceil() as usize..=index(last) as usize).map(|i| angle(i as f32));
        let thetas = [first, 0.5 * (first + last), last].into_iter().chain(inside);
        thetas.map(|theta| self.relative(theta.cos().max(0.0))).fold(0.0, f32::max)
    }

    /// Flux of the table's front in lumen.
    #[must_use]
    pub const fn lumens(&self) -> f64 {
        self.lumens
    }

    /// Radiance over that of a matte surface of the same flux.
    #[must_use]
    pub fn relative(&self, cosine: f32) -> f32 {
        let place = (safe_acos(cosine) / angle(1.0)).clamp(0.0, N_ANGLES as f32);
        let i = (place as usize).min(N_ANGLES - 1);
        let (low, high) = (self.intensity[i], self.intensity[i + 1]);
        (low + (high - low) * (place - i as f32)) / cosine.max(MIN_COSINE)
    }

    /// The largest intensity over that of a matte surface along its normal.
    #[must_use]
    pub fn peak(&self) -> f32 {
        self.intensity.iter().copied().fold(0.0, f32::max)
    }

    /// A direction around +z with density [`pdf_w`](Self::pdf_w).
    #[must_use]
    pub fn sample(&self, u: Point2) -> Vector3 {
        let (x, _, _) = self.distribution.sample(u.x);
        let (sin_phi, cos_phi) = (2.0 * PI * u.y).sin_cos();
        let sine = x.sqrt();
        Vector3::new(sine * cos_phi, sine * sin_phi, (1.0 - x).max(0.0).sqrt())
    }

    /// Density per steradian of [`sample`](Self::sample): in proportion to radiance times cosine, but for what varies within a cell.
    #[must_use]
    pub fn pdf_w(&self, cosine: f32) -> f32 {
        if cosine <= 0.0 { 0.0 } else { self.distribution.pdf(1.0 - cosine * cosine) * cosine / PI }
    }
}

/// Radians of an index among the angles.
fn angle(index: f32) -> f32 {
    index * (0.5 * PI / N_ANGLES as f32)
}
