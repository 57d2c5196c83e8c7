//! Light as a function of wavelength: spectra, colour, photometry and measured data. Knows nothing of geometry.
//!
//! A path of the renderer carries a few wavelengths, [`Wavelengths`], and one value for each, [`Sampled`]. Lights and
//! materials hold a [`Spectrum`], a function of wavelength, which is evaluated at those wavelengths. The [`Sensor`]
//! turns what arrives into the RGB of a [`ColorSpace`].
//!
//! Wavelengths are in nanometres, from [`LAMBDA_MIN_NM`] to [`LAMBDA_MAX_NM`].

/// Shortest wavelength that is rendered, in nm.
pub const LAMBDA_MIN_NM: f32 = 360.0;
/// Longest wavelength that is rendered, in nm.
pub const LAMBDA_MAX_NM: f32 = 830.0;
/// Number of wavelengths that a path carries.
pub const N_LAMBDA: usize = 4;
/// Number of entries of a table with one value per nanometre from [`LAMBDA_MIN_NM`] to [`LAMBDA_MAX_NM`].
pub const N_DENSE: usize = 471;

mod bands;
mod sampled;
mod wavelengths;

mod sigmoid;
mod spectrum;
mod tables;

pub mod atmosphere;
pub mod blackbody;
pub mod cie;
pub mod cmyk;
mod color_space;
mod daylight;
mod lift;
mod matrix;
mod named;
mod primaries;
mod uplift;
mod uplift_table;
mod xyz;

pub mod photometry;
pub mod radiometry;
pub mod scattering;
mod sensor;

#[cfg(test)]
mod tests;

pub use bands::Bands;
pub use color_space::{ColorSpace, ColorSpaceName};
pub use daylight::{chromaticity_of_temperature, daylight};
pub use lift::{Lifted, flux_to_xyz, lift};
pub use named::{CAMERA_SENSORS, NamedSpectrum, known_but_missing, named_spectrum, named_spectrum_names};
pub use primaries::Primaries;
pub use sampled::Sampled;
pub use sensor::{Sensor, SensorSettings};
pub use sigmoid::SigmoidPolynomial;
pub use spectrum::{Spectrum, spectrum_to_photometric, spectrum_to_xyz};
pub use tables::{SpectrumTables, TableId};
pub use uplift_table::{RgbToSpectrum, uplift_srgb};
pub use wavelengths::Wavelengths;
pub use xyz::{Xyz, white_balance};
