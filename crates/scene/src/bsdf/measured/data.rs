//! A measured BRDF as it lies in files of RGL's layout.

use std::f32::consts::{PI, TAU};
use std::fmt;

use super::Maps;

/// The contents of such a file, unchecked. Maps have x for the angle theta and y for phi of facets, or the two random
/// numbers from which facets follow.
#[derive(Clone, Debug, PartialEq)]
pub struct MeasuredParts {
    /// Azimuths in radians of the direction that the conditions of maps are for, ascending; one or two if the material is
    /// isotropic.
    pub phi_i: Vec<f32>,
    /// Its angles with the normal in radians, ascending. Conditions are in the order of azimuths, then angles.
    pub theta_i: Vec<f32>,
    /// Wavelengths in nm, ascending.
    pub wavelengths: Vec<f32>,
    /// Density of facets, called D in the paper, by their direction.
    pub ndf: Maps,
    /// Projected area of facets by the direction in which they are seen.
    pub sigma: Maps,
    /// Density of visible facets in the unit square, for each condition.
    pub vndf: Maps,
    /// Luminance of `spectra`.
    pub luminance: Maps,
    /// `f cos_i 4 sigma / D`, or just `f cos_i`, by random numbers, for each condition and wavelength.
    pub spectra: Maps,
    /// True if `spectra` are relative to `D / (4 sigma)`.
    pub jacobian: bool,
}

/// Why parts do not make a BRDF.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct MeasuredFault {
    /// The part.
    pub field: &'static str,
    /// What it should be.
    pub why: String,
}

impl fmt::Display for MeasuredFault {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "the field `{}` {}", self.field, self.why)
    }
}

impl std::error::Error for MeasuredFault {}

/// A measured BRDF whose parts fit together.
#[derive(Clone, Debug, PartialEq)]
pub struct MeasuredBrdf {
    parts: MeasuredParts,
    symmetry: Symmetry,
}

/// Which azimuths were measured.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Symmetry {
    /// One: the surface looks the same however it is turned.
    Isotropic,
    /// All.
    None,
    /// A half: the same if it is turned by half.
    Turned,
    /// A quarter: the same if either tangent is reversed.
    Mirrored,
}

impl MeasuredBrdf {
    /// From its parts.
    ///
    /// # Errors
    /// The first part that is empty, unordered, of the wrong size, or holds what is no number or must not be negative.
    pub fn new(parts: MeasuredParts) -> Result<Self, MeasuredFault> {
        ascending("phi_i", &parts.phi_i)?;
        let symmetry = symmetry(&parts.phi_i)?;
        ascending("theta_i", &parts.theta_i)?;
        ascending("wavelengths", &parts.wavelengths)?;
        let n = parts.phi_i.len().saturating_mul(parts.theta_i.len());
        for (field, maps, n) in [
            ("ndf", &parts.ndf, 1),
            ("sigma", &parts.sigma, 1),
            ("vndf", &parts.vndf, n),
            ("luminance", &parts.luminance, n),
            ("spectra", &parts.spectra, n.saturating_mul(parts.wavelengths.len())),
        ] {
            sound(field, maps, n)?;
        }
        for (field, maps) in [("ndf", &parts.ndf), ("sigma", &parts.sigma)] {
            if maps.values.iter().any(|value| *value < 0.0) {
                return Err(MeasuredFault { field, why: "has negative values".to_owned() });
            }
        }
        Ok(Self { parts, symmetry })
    }

    /// What it is made of.
    #[must_use]
    pub const fn parts(&self) -> &MeasuredParts {
        &self.parts
    }

    /// True if it looks the same however it is turned.
    #[must_use]
    pub fn is_isotropic(&self) -> bool {
        self.symmetry == Symmetry::Isotropic
    }

    pub(super) const fn symmetry(&self) -> Symmetry {
        self.symmetry
    }
}

fn ascending(field: &'static str, values: &[f32]) -> Result<(), MeasuredFault> {
    let is_sound =
        values.iter().all(|value| value.is_finite()) && values.windows(2).all(|pair| pair[0] < pair[1]);
    let why = "should be one or more ascending numbers".to_owned();
    if is_sound && !values.is_empty() { Ok(()) } else { Err(MeasuredFault { field, why }) }
}

fn sound(field: &'static str, maps: &Maps, n: usize) -> Result<(), MeasuredFault> {
    let [nx, ny] = maps.size;
    let n_values = n.checked_mul(nx).and_then(|product| product.checked_mul(ny));
    let why = if nx < 2 || ny < 2 {
        format!("should have at least 2 by 2 values, not {ny} by {nx}")
    } else if n_values != Some(maps.values.len()) {
        format!("should have {n} times {ny} by {nx} values, but has {}", maps.values.len())
    } else if maps.values.iter().any(|value| !value.is_finite()) {
        "has values that are no numbers".to_owned()
    } else {
        return Ok(());
    };
    Err(MeasuredFault { field, why })
}

fn symmetry(phi_i: &[f32]) -> Result<Symmetry, MeasuredFault> {
    let &[first, _, .., last] = phi_i else { return Ok(Symmetry::Isotropic) };
    let parts = if (first + PI).abs() < 0.1 { TAU / (last - first) } else { f32::NAN };
    match parts.round() {
        1.0 => Ok(Symmetry::None),
        2.0 => Ok(Symmetry::Turned),
        4.0 => Ok(Symmetry::Mirrored),
        _ => {
            let why = "should go all around, or a half or a quarter, from -180°".to_owned();
            Err(MeasuredFault { field: "phi_i", why })
        }
    }
}
