//! From the numbers of a scene file to emitted spectra, and from emitted spectra to watts and lumens.
//!
//! A light's spectrum S has a shape and a size. In **photometric** units (pbrt-v4's, the default) the size is set so
//! that the luminance of S, or of the white it is relative to for RGB colours, becomes 1 cd/m^2 times `scale`:
//!
//! ```text
//!   L(lambda) = scale * S(lambda) / integral S_white(lambda) ybar(lambda) dlambda.
//! ```
//!
//! In **radiometric** units S is absolute, in W/(m^2 sr nm) (W/(sr nm) for intensity, W/(m^2 nm) for distant lights),
//! and is multiplied by K_m = 683 lm/W. In both cases the integral of L ybar is photometric: cd/m^2 (cd, lux).
//! Two kinds of spectra have no absolute size of their own: a blackbody then means Planck's law, and an RGB colour
//! means a total over the visible range of 1 W/(m^2 sr) for white.
//!
//! `power` and `illuminance` override the size: lumen and lux, or watts and W/m^2 in radiometric units. The size is
//! found from the light's actual spectrum, so it is exact also for saturated colours (pbrt-v4 uses the white instead,
//! and multiplies by the magnitude of the RGB value); `scale` still multiplies.

use etendue_spectrum::{
    LAMBDA_MIN_NM, N_DENSE, Spectrum, SpectrumTables, blackbody, cie, photometry, spectrum_to_photometric,
};

use crate::parameters::ParameterSpec;

/// Maximum luminous efficacy of radiation in lumen per watt.
const K_M: f64 = photometry::K_M as f64;

/// What the numbers of a light mean.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum LightUnits {
    /// Candela, lumen, lux.
    #[default]
    Photometric,
    /// Watts.
    Radiometric,
}

impl LightUnits {
    /// Names in scene files.
    pub const NAMES: [(&'static str, Self); 2] =
        [("photometric", Self::Photometric), ("radiometric", Self::Radiometric)];

    /// The parameter of every light.
    pub const PARAMETER: ParameterSpec = ParameterSpec {
        name: "units",
        kind: "string",
        default: "photometric",
        unit: "",
        doc: "\"photometric\": 1 is 1 cd/m^2 (cd, lx); \"radiometric\": the spectrum is absolute, per nanometre, and power is in watts",
    };
}

/// Emitted flux in three measures.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct LightPower {
    /// Radiant flux between 360 and 830 nm in watts.
    pub watts: f64,
    /// Luminous flux in lumen.
    pub lumens: f64,
    /// What samplers of lights go by: the mean of the flux weighted by x-bar, y-bar and z-bar, so that saturated blue
    /// and red count, which luminance would neglect.
    pub weight: f64,
}

impl std::ops::Add for LightPower {
    type Output = Self;
    fn add(self, other: Self) -> Self {
        Self {
            watts: self.watts + other.watts,
            lumens: self.lumens + other.lumens,
            weight: self.weight + other.weight,
        }
    }
}

impl std::ops::Mul<f64> for LightPower {
    type Output = Self;
    fn mul(self, factor: f64) -> Self {
        Self { watts: self.watts * factor, lumens: self.lumens * factor, weight: self.weight * factor }
    }
}

impl LightPower {
    /// The measures of a spectrum of internal unit (K_m times watts per nanometre).
    #[must_use]
    pub fn of(spectrum: &Spectrum, tables: &SpectrumTables) -> Self {
        let observer = cie::color_matching();
        let (mut total, mut lumens, mut weight) = (0.0, 0.0, 0.0);
        for i in 0..N_DENSE {
            let value = f64::from(spectrum.at(tables, LAMBDA_MIN_NM + i as f32));
            let [x, y, z] = [observer.x_bar[i], observer.y_bar[i], observer.z_bar[i]].map(f64::from);
            total += value;
            lumens += value * y;
            weight += value * (x + y + z) / 3.0;
        }
        Self { watts: total / K_M, lumens, weight }
    }

    /// Flux in the unit in which `power` is given.
    const fn in_units(&self, units: LightUnits) -> f64 {
        match units {
            LightUnits::Photometric => self.lumens,
            LightUnits::Radiometric => self.watts,
        }
    }
}

/// The emitted spectrum in internal units of a light with the spectrum and `scale` of a scene file.
#[must_use]
pub fn emitted(spectrum: Spectrum, scale: f32, units: LightUnits, tables: &SpectrumTables) -> Spectrum {
    let factor = (unit_factor(spectrum, units, tables) * f64::from(scale)) as f32;
    spectrum.as_light(tables).scaled(factor)
}

/// What turns a spectrum of a scene file into internal units; 0 for one that nobody can see.
#[must_use]
pub fn unit_factor(spectrum: Spectrum, units: LightUnits, tables: &SpectrumTables) -> f64 {
    let reciprocal = |x: f64| if x > 0.0 { 1.0 / x } else { 0.0 };
    match (units, spectrum) {
        (LightUnits::Photometric, _) => reciprocal(f64::from(spectrum_to_photometric(&spectrum, tables))),
        (LightUnits::Radiometric, Spectrum::Blackbody { kelvin, scale, .. }) => {
            let peak = blackbody::radiance(blackbody::wien_peak_nm(kelvin), kelvin);
            K_M * f64::from(peak) * reciprocal(f64::from(scale))
        }
        (LightUnits::Radiometric, Spectrum::Illuminant { table, .. }) => {
            let white = LightPower::of(&Spectrum::table(table, tables), tables);
            reciprocal(white.watts)
        }
        (LightUnits::Radiometric, _) => K_M,
    }
}

/// The factor that gives a light the flux `target` (lumen or watts), where it would have `per_unit` otherwise; 1 if
/// no target is given (not positive) or the light is black.
#[must_use]
pub fn factor_for(target: f32, per_unit: LightPower, units: LightUnits) -> f32 {
    let unscaled = per_unit.in_units(units);
    if target > 0.0 && unscaled > 0.0 { (f64::from(target) / unscaled) as f32 } else { 1.0 }
}
