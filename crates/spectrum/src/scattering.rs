//! Scattering by what is small beside the wavelength, such as the molecules of air: the coefficient falls with its fourth
//! power, so that the sky is blue and a low sun red (Rayleigh 1871, "On the Scattering of Light by Small Particles"; SPEC
//! SPD-5).
//!
//! The named spectrum `rayleigh` is [`rayleigh`], for coefficients in scene files.

use std::f64::consts::PI;

/// Wavelength in nm at which [`rayleigh`] is 1.
pub const RAYLEIGH_REFERENCE_NM: f32 = 550.0;

/// A coefficient of scattering relative to that at 550 nm, at a wavelength in nm: `(550 / nm)⁴`.
#[inline]
#[must_use]
pub fn rayleigh(nm: f32) -> f32 {
    let ratio = RAYLEIGH_REFERENCE_NM / nm;
    (ratio * ratio) * (ratio * ratio)
}

/// Molecules per m³ of dry air at 15 °C and 101325 Pa.
const AIR_DENSITY: f64 = 2.546_899e25;
/// How far molecules of air are from round: the King factor `(6 + 3 d) / (6 - 7 d)` with the depolarisation d = 0.0279
/// (Young 1981, "On the Rayleigh-Scattering Optical Depth of the Atmosphere").
const KING: f64 = (6.0 + 3.0 * 0.0279) / (6.0 - 7.0 * 0.0279);

/// The index of refraction of dry air at 15 °C and 101325 Pa at a wavelength in nm, from 230 to 1690 nm (Peck and Reeder
/// 1972, "Dispersion of Air").
#[must_use]
pub fn air_index(nm: f64) -> f64 {
    // Wavenumber in 1/um, squared.
    let k2 = (1000.0 / nm).powi(2);
    1.0 + 1e-8 * (8060.51 + 2_480_990.0 / (132.274 - k2) + 17_455.7 / (39.329_57 - k2))
}

/// Scattering coefficient in 1/m of clean air at sea level, at a wavelength in nm: `8 π³ (n² - 1)² / (3 N λ⁴)` times the King
/// factor, where N is the number of molecules in a volume. It falls a little faster than the fourth power, since the index
/// falls too.
#[must_use]
pub fn air(nm: f64) -> f64 {
    let lambda = nm * 1e-9;
    let n2 = air_index(nm).powi(2);
    8.0 * PI.powi(3) * (n2 - 1.0).powi(2) / (3.0 * AIR_DENSITY * lambda.powi(4)) * KING
}
