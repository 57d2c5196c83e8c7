//! Thermal radiation of a black body.
//!
//! Planck's law: L_λ = 2 h c² / (λ⁵ (exp(h c / (λ k T)) − 1)); a black body radiates equally in all directions, so its
//! exitance is π L_λ. Wien: λ_peak T = 2.8978 · 10⁻³ m K. Stefan and Boltzmann: ∫ M_λ dλ = σ T⁴.

use crate::radiometry::{LIGHT_SPEED, PLANCK};

/// Boltzmann constant k, in J/K (exact by definition of the kelvin).
pub const BOLTZMANN: f64 = 1.380_649e-23;
/// Stefan-Boltzmann constant σ, in W m⁻² K⁻⁴.
pub const STEFAN_BOLTZMANN: f64 = 5.670_374_419e-8;
/// Wien's displacement constant, in m K.
pub const WIEN: f64 = 2.897_771_955e-3;
/// First radiation constant of exitance, 2π h c², in W m².
pub const C1: f64 = 2.0 * std::f64::consts::PI * PLANCK * LIGHT_SPEED * LIGHT_SPEED;
/// Second radiation constant, h c / k, in m K.
pub const C2: f64 = PLANCK * LIGHT_SPEED / BOLTZMANN;

/// h c / (λ k T) at the peak of Planck's law over wavelength.
const PEAK_ARGUMENT: f64 = 4.965_114_231_744_276;

/// Spectral exitance of a black body in W m⁻² nm⁻¹ at a wavelength in nm and a temperature in kelvin; 0 if either is
/// not positive.
#[must_use]
pub fn exitance(nm: f64, kelvin: f64) -> f64 {
    if nm <= 0.0 || kelvin <= 0.0 {
        return 0.0;
    }
    let lambda = nm * 1e-9;
    let per_metre = C1 / (lambda.powi(5) * (C2 / (lambda * kelvin)).exp_m1());
    per_metre * 1e-9
}

/// Spectral radiance of a black body in W m⁻² sr⁻¹ nm⁻¹ at a wavelength in nm and a temperature in kelvin.
#[must_use]
pub fn radiance(nm: f32, kelvin: f32) -> f32 {
    (exitance(f64::from(nm), f64::from(kelvin)) / std::f64::consts::PI) as f32
}

/// Radiance of a black body relative to its peak: 1 at [`wien_peak_nm`].
#[inline]
#[must_use]
pub fn normalized(nm: f32, kelvin: f32) -> f32 {
    let x = (C2 * 1e9) as f32 / (nm * kelvin);
    let y = x * (1.0 / PEAK_ARGUMENT as f32);
    let y2 = y * y;
    y2 * y2 * y * (peak_exp_m1() / x.exp_m1())
}

/// Wavelength in nm at which a black body of this temperature (kelvin) radiates most per nm.
#[inline]
#[must_use]
pub fn wien_peak_nm(kelvin: f32) -> f32 {
    (WIEN * 1e9) as f32 / kelvin
}

/// Exitance of a black body over all wavelengths in W m⁻².
#[must_use]
pub fn total_exitance(kelvin: f64) -> f64 {
    STEFAN_BOLTZMANN * kelvin.powi(4)
}

/// exp(x) − 1 at [`PEAK_ARGUMENT`].
#[inline]
const fn peak_exp_m1() -> f32 {
    // x = 5 (1 − exp(−x)) at the peak, so exp(x) − 1 = x / (5 − x).
    (PEAK_ARGUMENT / (5.0 - PEAK_ARGUMENT)) as f32
}
