//! Smooth reflectance spectra with three coefficients.
//!
//! s(λ) = σ(c0 λ² + c1 λ + c2) with σ(x) = 1/2 + x / (2 √(1 + x²)): always inside [0, 1], smooth, and it reaches nearly
//! the whole gamut of reflectances (Jakob and Hanika 2019, "A Low-Dimensional Function Space for Efficient Spectral
//! Upsampling", doi:10.1111/cgf.13626).

use crate::{LAMBDA_MAX_NM, LAMBDA_MIN_NM, Sampled, Wavelengths};

/// Argument of the sigmoid beyond which it is 0 or 1 in `f32`; stands for infinity, without its NaNs.
const LARGE: f32 = 1e8;

/// A reflectance spectrum: the sigmoid of a parabola in wavelength (nm).
#[derive(Copy, Clone, Debug, PartialEq)]
pub struct SigmoidPolynomial {
    /// Coefficients of λ², λ and 1, with λ in nm.
    pub coefficients: [f32; 3],
}

impl SigmoidPolynomial {
    /// From the coefficients of λ², λ and 1, with λ in nm.
    #[inline]
    #[must_use]
    pub const fn new(c0: f32, c1: f32, c2: f32) -> Self {
        Self { coefficients: [c0, c1, c2] }
    }

    /// The reflectance `value` at every wavelength, limited to [0, 1].
    #[must_use]
    pub fn constant(value: f32) -> Self {
        let v = f64::from(value.clamp(0.0, 1.0));
        // Inverse of the sigmoid.
        let x = (v - 0.5) / (v * (1.0 - v)).sqrt();
        Self::new(0.0, 0.0, (x as f32).clamp(-LARGE, LARGE))
    }

    /// Reflectance at a wavelength in nm, in [0, 1].
    #[inline]
    #[must_use]
    pub fn at(&self, nm: f32) -> f32 {
        let [c0, c1, c2] = self.coefficients;
        sigmoid((c0 * nm + c1) * nm + c2)
    }

    /// Reflectance at each wavelength of a path, in [0, 1]; for bands at the wavelengths that stand for them.
    #[inline]
    #[must_use]
    pub fn sample(&self, wavelengths: &Wavelengths) -> Sampled {
        Sampled::from_array(wavelengths.lambda_nm().map(|nm| self.at(nm)))
    }

    /// Largest reflectance at any rendered wavelength.
    #[must_use]
    pub fn max_value(&self) -> f32 {
        let [c0, c1, _] = self.coefficients;
        let ends = self.at(LAMBDA_MIN_NM).max(self.at(LAMBDA_MAX_NM));
        let apex = -c1 / (2.0 * c0);
        if (LAMBDA_MIN_NM..=LAMBDA_MAX_NM).contains(&apex) {
            return ends.max(self.at(apex));
        }
        ends
    }

    /// Whether the reflectance does not depend on wavelength.
    #[inline]
    #[must_use]
    pub fn is_constant(&self) -> bool {
        self.coefficients[0] == 0.0 && self.coefficients[1] == 0.0
    }
}

/// Maps the real line onto (0, 1).
#[inline]
fn sigmoid(x: f32) -> f32 {
    0.5 + x / (2.0 * (1.0 + x * x).sqrt())
}
