//! Light as a function of wavelength: spectra, colour, photometry and measured data. Knows nothing of geometry.

mod color_space;

pub use color_space::ColorSpaceName;
