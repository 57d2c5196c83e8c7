//! From the linear colours of a picture to spectra (Jakob and Hanika 2019), by what the texture is used for. For paths
//! that carry bands the colours stay what they are.

use etendue_image::{Chromaticities, Texels};
use etendue_spectrum::{Bands, ColorSpace, ColorSpaceName, Sampled, SpectrumTables, TableId, Wavelengths};

use crate::parameters::SpectrumRole;

/// How the colours of a picture become spectra.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Uplift {
    /// What the spectra are used for.
    pub role: SpectrumRole,
    /// Primaries and white of the colours.
    pub color_space: ColorSpaceName,
    /// The white of the colour space.
    illuminant: TableId,
}

/// The known colour space with these chromaticities; sRGB if there is none.
fn color_space_of(chromaticities: Option<&Chromaticities>) -> ColorSpaceName {
    let Some(c) = chromaticities else { return ColorSpaceName::Srgb };
    let near = |a: [f32; 2], b: [f32; 2]| (a[0] - b[0]).abs() < 2e-3 && (a[1] - b[1]).abs() < 2e-3;
    let matches = |name: &ColorSpaceName| {
        let space = ColorSpace::get(*name);
        let [red, green, blue] = space.primaries_xy;
        near(c.red, red) && near(c.green, green) && near(c.blue, blue) && near(c.white, space.white_xy)
    };
    ColorSpaceName::ALL.into_iter().find(matches).unwrap_or_default()
}

impl Uplift {
    /// The way for a picture, by the primaries that its file states.
    pub fn new(role: SpectrumRole, texels: &Texels, tables: &mut SpectrumTables) -> Self {
        Self::in_color_space(role, color_space_of(texels.color_space.as_ref()), tables)
    }

    /// The way for colours of a known space.
    pub fn in_color_space(
        role: SpectrumRole,
        color_space: ColorSpaceName,
        tables: &mut SpectrumTables,
    ) -> Self {
        Self { role, color_space, illuminant: tables.illuminant(color_space) }
    }

    /// The spectrum of a linear, non-negative colour at the wavelengths of a path; reflectances are limited to 1.
    #[must_use]
    pub fn sample(&self, rgb: [f32; 3], tables: &SpectrumTables, lambda: &Wavelengths) -> Sampled {
        if rgb == [0.0; 3] {
            return Sampled::ZERO;
        }
        let space = ColorSpace::get(self.color_space);
        if lambda.is_bands() {
            return lambda.of_bands(self.bands(space, rgb));
        }
        match self.role {
            SpectrumRole::Albedo => space.uplift(rgb.map(|c| c.clamp(0.0, 1.0))).sample(lambda),
            SpectrumRole::Unbounded => {
                let (scale, polynomial) = space.uplift_unbounded(rgb);
                polynomial.sample(lambda) * scale
            }
            SpectrumRole::Illuminant => {
                let (scale, polynomial) = space.uplift_unbounded(rgb);
                polynomial.sample(lambda) * tables.sample(self.illuminant, lambda) * scale
            }
        }
    }

    fn bands(&self, space: &ColorSpace, rgb: [f32; 3]) -> Bands {
        match self.role {
            SpectrumRole::Albedo => space.albedo_bands(rgb),
            SpectrumRole::Unbounded => space.reflectance_bands(rgb),
            SpectrumRole::Illuminant => space.light_bands(rgb),
        }
    }
}
