//! Quantities of light as energy.
//!
//! | Symbol | Quantity | Unit | Relation |
//! | --- | --- | --- | --- |
//! | e | energy of a photon | J | h c / λ |
//! | Q_λ | spectral radiant energy | J nm⁻¹ (J m⁻¹) | n_λ h c / λ |
//! | Q | radiant energy | J | ∫ Q_λ dλ |
//! | Φ | radiant flux, power | W | dQ / dt |
//! | I | radiant intensity | W sr⁻¹ | dΦ / dω |
//! | E | irradiance, arriving | W m⁻² | dΦ / dA |
//! | M | exitance, leaving by emission | W m⁻² | dΦ / dA |
//! | B | radiosity, leaving by emission and reflection | W m⁻² | dΦ / dA |
//! | L | radiance | W m⁻² sr⁻¹ | d²Φ / (cos θ dA dω) |
//! | L_λ | spectral radiance | W m⁻² sr⁻¹ nm⁻¹ | dL / dλ |
//!
//! The renderer's spectra are per nm. Functions here are the conversions between the rows, in double precision, as used
//! by tests and reports.

use std::f64::consts::PI;

/// Planck's constant h in J s (exact by definition of the kilogram).
pub const PLANCK: f64 = 6.626_070_15e-34;
/// Speed of light in vacuum in m/s (exact by definition of the metre).
pub const LIGHT_SPEED: f64 = 299_792_458.0;

/// Energy in J of one photon of a wavelength in nm: h c / λ.
#[must_use]
pub fn photon_energy(nm: f64) -> f64 {
    PLANCK * LIGHT_SPEED / (nm * 1e-9)
}

/// Spectral radiant energy in J/nm of a number of photons per nm at a wavelength in nm.
#[must_use]
pub fn spectral_radiant_energy(photons_per_nm: f64, nm: f64) -> f64 {
    photons_per_nm * photon_energy(nm)
}

/// Photons per nm of a spectral radiant energy in J/nm at a wavelength in nm.
#[must_use]
pub fn photons_per_nm(spectral_energy: f64, nm: f64) -> f64 {
    spectral_energy / photon_energy(nm)
}

/// Radiant energy in J of a line spectrum, given as `[wavelength in nm, number of photons]`.
#[must_use]
pub fn radiant_energy_of_lines(lines: &[[f64; 2]]) -> f64 {
    lines.iter().map(|[nm, n]| n * photon_energy(*nm)).sum()
}

/// Radiant energy in J of photons with a density per nm, by the trapezoidal rule between two wavelengths in nm.
#[must_use]
pub fn radiant_energy(photons_per_nm: impl Fn(f64) -> f64, from_nm: f64, to_nm: f64) -> f64 {
    integrate(|nm| spectral_radiant_energy(photons_per_nm(nm), nm), from_nm, to_nm)
}

/// Mean radiant flux in W of an energy in J emitted over a time in s.
#[must_use]
pub fn radiant_flux(energy: f64, time_s: f64) -> f64 {
    energy / time_s
}

/// Mean irradiance, exitance or radiosity in W/m² of a flux in W through an area in m².
#[must_use]
pub fn flux_density(flux: f64, area_m2: f64) -> f64 {
    flux / area_m2
}

/// Radiant intensity in W/sr of a point that radiates a flux in W equally in all directions.
#[must_use]
pub fn isotropic_intensity(flux: f64) -> f64 {
    flux / (4.0 * PI)
}

/// Radiance in W m⁻² sr⁻¹ of a flux in W through a small area in m² into a small solid angle in sr, at an angle to the
/// normal with the given cosine.
#[must_use]
pub fn radiance(flux: f64, cos_theta: f64, area_m2: f64, solid_angle_sr: f64) -> f64 {
    flux / (cos_theta * area_m2 * solid_angle_sr)
}

/// Flux in W of a surface that emits the same radiance (W m⁻² sr⁻¹) in all directions of one side: π A L.
#[must_use]
pub fn diffuse_flux(radiance: f64, area_m2: f64) -> f64 {
    PI * area_m2 * radiance
}

/// Integral of a function of wavelength by the trapezoidal rule with steps of at most 0.1 nm.
pub(crate) fn integrate(f: impl Fn(f64) -> f64, from_nm: f64, to_nm: f64) -> f64 {
    let n = ((to_nm - from_nm) / 0.1).ceil().max(1.0) as usize;
    let step = (to_nm - from_nm) / n as f64;
    let inner: f64 = (1..n).map(|i| f(from_nm + i as f64 * step)).sum();
    step * (0.5 * (f(from_nm) + f(to_nm)) + inner)
}
