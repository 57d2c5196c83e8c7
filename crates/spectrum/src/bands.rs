//! Three bands in place of wavelengths: the red, green and blue of linear sRGB (SPEC SPD-4).
//!
//! Renderers without spectra compute with RGB: in each of three bands every quantity is a constant, and light of one band
//! stays in it. This is no approximation of the spectral result but another model, which multiplies colours where nature
//! multiplies spectra. It serves to compare the two, and to check against pictures that such renderers made.
//!
//! A spectrum s becomes the linear sRGB
//! - of a surface of that reflectance under D65, ∫ s D65 (r̄, ḡ, b̄) dλ / ∫ D65 (r̄, ḡ, b̄) dλ, so that a constant stays
//!   what it is: reflectances, indices of refraction, extinctions;
//! - of its XYZ by [`crate::spectrum_to_xyz`], so that D65 of luminance 1 is (1, 1, 1): light.
//!
//! Colours that were given as RGB keep it, converted to the primaries of sRGB. What lies outside the gamut loses its
//! negative components, reflectances what is above 1.

use std::sync::OnceLock;

use crate::cie::{CIE_Y_INTEGRAL, color_matching, integrate_1nm};
use crate::matrix::{Matrix3, transform};
use crate::tables::dense_nm;
use crate::{ColorSpace, ColorSpaceName, N_DENSE, Xyz};

/// Values of a quantity in the bands red, green and blue, not negative.
#[derive(Copy, Clone, Debug, PartialEq)]
pub struct Bands {
    rgb: [f32; 3],
}

impl Bands {
    /// Given linear sRGB; negative components become 0.
    #[inline]
    #[must_use]
    pub fn from_rgb(rgb: [f32; 3]) -> Self {
        Self { rgb: rgb.map(|c| c.max(0.0)) }
    }

    /// The same value in every band.
    #[inline]
    #[must_use]
    pub const fn splat(value: f32) -> Self {
        Self { rgb: [value; 3] }
    }

    /// Of a reflectance or an index, a non-negative function of the wavelength in nm; limited to the range of its values,
    /// which weights below 0 would leave for saturated colours.
    #[must_use]
    pub fn of_reflectance(at: impl Fn(f32) -> f32) -> Self {
        let mut sum = [0.0; 3];
        let (mut min, mut max) = (f32::INFINITY, 0.0_f32);
        for (i, weight) in reflectance_weights().iter().enumerate() {
            let value = at(dense_nm(i));
            (min, max) = (min.min(value), max.max(value));
            for c in 0..3 {
                sum[c] += weight[c] * f64::from(value);
            }
        }
        Self::from_rgb(sum.map(|s| (s as f32).max(min).min(max)))
    }

    /// Of light, a function of the wavelength in nm.
    #[must_use]
    pub fn of_light(at: impl Fn(f32) -> f32) -> Self {
        let xyz = Xyz::from(integrate_1nm(at).map(|v| v / CIE_Y_INTEGRAL));
        Self::from_rgb(ColorSpace::get(ColorSpaceName::Srgb).to_rgb(xyz))
    }

    /// Linear sRGB.
    #[inline]
    #[must_use]
    pub const fn rgb(self) -> [f32; 3] {
        self.rgb
    }

    /// The values times a factor.
    #[inline]
    #[must_use]
    pub fn scaled(self, factor: f32) -> Self {
        Self { rgb: self.rgb.map(|c| c * factor) }
    }
}

/// Share of each nm of a reflectance in its linear sRGB under D65; each component adds up to 1.
fn reflectance_weights() -> &'static [[f64; 3]] {
    static WEIGHTS: OnceLock<Vec<[f64; 3]>> = OnceLock::new();
    WEIGHTS.get_or_init(|| {
        let space = ColorSpace::get(ColorSpaceName::Srgb);
        let rgb_from_xyz: Matrix3 = space.rgb_from_xyz.map(|row| row.map(f64::from));
        let observer = color_matching();
        let mut weights: Vec<[f64; 3]> = (0..N_DENSE)
            .map(|i| {
                let bars = [observer.x_bar[i], observer.y_bar[i], observer.z_bar[i]];
                transform(&rgb_from_xyz, bars.map(|bar| f64::from(bar) * f64::from(space.illuminant[i])))
            })
            .collect();
        let white: [f64; 3] = std::array::from_fn(|c| weights.iter().map(|w| w[c]).sum());
        for weight in &mut weights {
            *weight = std::array::from_fn(|c| weight[c] / white[c]);
        }
        weights
    })
}
