//! Quantities of light as seen by the eye.
//!
//! A photometric quantity is K_m ∫ X_λ(λ) V(λ) dλ of the radiometric one: flux in W gives lumen, intensity candela,
//! irradiance lux, radiance cd/m². V(λ) is the luminous efficiency of CIE 1924, which is ȳ(λ) of the CIE 1931 observer.
//!
//! The renderer divides lights by ∫ s ȳ dλ ([`crate::spectrum_to_photometric`]), so that its film is in cd/m² without
//! K_m. Lights in absolute watts must be multiplied by [`K_M`] instead; this is the only place where it is defined.

use crate::cie::{self, y_bar};
use crate::{Spectrum, SpectrumTables};

/// Luminous efficacy K_m in lm/W: lumens per watt at 555 nm.
pub const K_M: f32 = 683.0;

/// Luminous efficiency V(λ) at a wavelength in nm: 1 at 555 nm, 0 outside the rendered range.
#[must_use]
pub fn luminous_efficiency(nm: f32) -> f32 {
    y_bar(nm)
}

/// Luminous flux in lm of monochromatic light: a flux in W at a wavelength in nm.
#[must_use]
pub fn luminous_flux_of_line(flux_w: f32, nm: f32) -> f32 {
    K_M * flux_w * luminous_efficiency(nm)
}

/// Luminous flux in lm of a spectral flux in W/nm. Likewise illuminance in lx of W m⁻² nm⁻¹, luminous intensity in cd of
/// W sr⁻¹ nm⁻¹, luminance in cd/m² of W m⁻² sr⁻¹ nm⁻¹.
#[must_use]
pub fn luminous_flux(spectral_flux: &Spectrum, tables: &SpectrumTables) -> f32 {
    K_M * cie::integrate_1nm(|nm| spectral_flux.at(tables, nm))[1]
}

/// Luminous efficacy in lm/W of light: luminous flux over the flux within 360–830 nm.
#[must_use]
pub fn luminous_efficacy(spectrum: &Spectrum, tables: &SpectrumTables) -> f32 {
    let flux: f64 = (360..=830).map(|nm| f64::from(spectrum.at(tables, nm as f32))).sum();
    if flux == 0.0 {
        return 0.0;
    }
    luminous_flux(spectrum, tables) / flux as f32
}

/// Mean illuminance or luminous exitance in lx of a luminous flux in lm on an area in m².
#[must_use]
pub fn illuminance(luminous_flux_lm: f32, area_m2: f32) -> f32 {
    luminous_flux_lm / area_m2
}

/// Luminous intensity in cd of a point that radiates a luminous flux in lm equally in all directions.
#[must_use]
pub fn isotropic_luminous_intensity(luminous_flux_lm: f32) -> f32 {
    luminous_flux_lm / (4.0 * std::f32::consts::PI)
}
