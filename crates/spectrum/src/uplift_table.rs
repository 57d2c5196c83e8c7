//! Table of the reflectances of sRGB colours, for the texels of images.
//!
//! Coordinates are the largest component and the ratios of the other two to it, as in the paper of [`crate::uplift`].

use crate::{ColorSpace, ColorSpaceName, SigmoidPolynomial};

/// The table.
#[derive(Debug)]
pub struct RgbToSpectrum;

/// The reflectance of a linear sRGB colour, limited to [0, 1], from the table.
#[must_use]
pub fn uplift_srgb(rgb: [f32; 3]) -> SigmoidPolynomial {
    ColorSpace::get(ColorSpaceName::Srgb).fit_albedo(rgb)
}
