//! A function of wavelength in one of a few forms.
//!
//! Each form also knows its value in the three bands of [`Bands`], for paths that carry bands instead of wavelengths.
//!
//! To add a form: a variant here, a line in each `match`. Variants with many values keep them in [`SpectrumTables`] and
//! hold an id, so that a spectrum is small and is copied freely.

use crate::cie::{self, CIE_Y_INTEGRAL};
use crate::{
    Bands, LAMBDA_MAX_NM, LAMBDA_MIN_NM, Sampled, SigmoidPolynomial, SpectrumTables, TableId, Wavelengths,
    Xyz, blackbody,
};

/// A function of wavelength: a reflectance, an index of refraction, a coefficient per metre, or the relative or absolute
/// power of a light, whose unit its owner states.
#[derive(Copy, Clone, Debug, PartialEq)]
pub enum Spectrum {
    /// The same value at every wavelength.
    Constant(f32),
    /// A smooth reflectance in [0, 1] of a given RGB.
    Albedo {
        /// Reflectance by wavelength.
        polynomial: SigmoidPolynomial,
        /// Reflectance by band.
        bands: Bands,
    },
    /// A smooth non-negative function of a given RGB: `scale` × polynomial.
    Unbounded {
        /// Factor, about twice the largest component of the RGB.
        scale: f32,
        /// Shape, in [0, 1].
        polynomial: SigmoidPolynomial,
        /// The values by band at `scale` 1.
        bands: Bands,
    },
    /// Light of a given RGB: `scale` × polynomial × the illuminant of the colour space.
    Illuminant {
        /// Factor, about twice the largest component of the RGB.
        scale: f32,
        /// Shape, in [0, 1].
        polynomial: SigmoidPolynomial,
        /// The illuminant, white of the colour space.
        table: TableId,
        /// The light by band at `scale` 1.
        bands: Bands,
    },
    /// `scale` × a table.
    Table {
        /// One value per nm.
        table: TableId,
        /// Factor.
        scale: f32,
        /// The values by band at `scale` 1.
        bands: Bands,
    },
    /// `scale` × the radiance of a black body, which is 1 at its peak, wherever the peak lies.
    Blackbody {
        /// Temperature in kelvin, positive.
        kelvin: f32,
        /// Factor.
        scale: f32,
        /// The light by band at `scale` 1.
        bands: Bands,
    },
}

impl Spectrum {
    /// The values of a table, by band those of a reflectance or an index; see [`Self::as_light`].
    #[must_use]
    pub fn table(table: TableId, tables: &SpectrumTables) -> Self {
        Self::Table { table, scale: 1.0, bands: Bands::of_reflectance(|nm| tables.at(table, nm)) }
    }

    /// A black body, 1 at its peak, at a temperature in kelvin.
    #[must_use]
    pub fn blackbody(kelvin: f32) -> Self {
        let bands = Bands::of_light(|nm| blackbody::normalized(nm, kelvin));
        Self::Blackbody { kelvin, scale: 1.0, bands }
    }

    /// The same function of wavelength, by band the colour of light with this spectrum.
    ///
    /// A constant or a table may be a reflectance, whose constant is white, or light, whose constant is that of equal
    /// energy, a little reddish.
    #[must_use]
    pub fn as_light(self, tables: &SpectrumTables) -> Self {
        match self {
            Self::Constant(value) => Self::Unbounded {
                scale: value,
                polynomial: SigmoidPolynomial::constant(1.0),
                bands: Bands::of_light(|_| 1.0),
            },
            Self::Table { table, scale, .. } => {
                Self::Table { table, scale, bands: Bands::of_light(|nm| tables.at(table, nm)) }
            }
            Self::Albedo { polynomial, .. } => {
                Self::Unbounded { scale: 1.0, polynomial, bands: Bands::of_light(|nm| polynomial.at(nm)) }
            }
            Self::Unbounded { scale, polynomial, .. } => {
                Self::Unbounded { scale, polynomial, bands: Bands::of_light(|nm| polynomial.at(nm)) }
            }
            Self::Illuminant { .. } | Self::Blackbody { .. } => self,
        }
    }

    /// Values in the three bands.
    #[must_use]
    pub fn bands(&self) -> Bands {
        match self {
            Self::Constant(value) => Bands::splat(*value),
            Self::Albedo { bands, .. } => *bands,
            Self::Unbounded { scale, bands, .. }
            | Self::Illuminant { scale, bands, .. }
            | Self::Table { scale, bands, .. }
            | Self::Blackbody { scale, bands, .. } => bands.scaled(*scale),
        }
    }

    /// Values at the wavelengths of a path, or in its bands.
    #[inline]
    #[must_use]
    pub fn sample(&self, tables: &SpectrumTables, wavelengths: &Wavelengths) -> Sampled {
        if wavelengths.is_bands() {
            return wavelengths.of_bands(self.bands());
        }
        match self {
            Self::Constant(value) => Sampled::splat(*value),
            Self::Albedo { polynomial, .. } => polynomial.sample(wavelengths),
            Self::Unbounded { scale, polynomial, .. } => polynomial.sample(wavelengths) * *scale,
            Self::Illuminant { scale, polynomial, table, .. } => {
                polynomial.sample(wavelengths) * tables.sample(*table, wavelengths) * *scale
            }
            Self::Table { table, scale, .. } => tables.sample(*table, wavelengths) * *scale,
            Self::Blackbody { kelvin, scale, .. } => {
                let values = wavelengths.lambda_nm().map(|nm| scale * blackbody::normalized(nm, *kelvin));
                Sampled::from_array(values)
            }
        }
    }

    /// Value at a wavelength in nm; tables are 0 outside the rendered range.
    #[must_use]
    pub fn at(&self, tables: &SpectrumTables, nm: f32) -> f32 {
        match self {
            Self::Constant(value) => *value,
            Self::Albedo { polynomial, .. } => polynomial.at(nm),
            Self::Unbounded { scale, polynomial, .. } => scale * polynomial.at(nm),
            Self::Illuminant { scale, polynomial, table, .. } => {
                scale * polynomial.at(nm) * tables.at(*table, nm)
            }
            Self::Table { table, scale, .. } => scale * tables.at(*table, nm),
            Self::Blackbody { kelvin, scale, .. } => scale * blackbody::normalized(nm, *kelvin),
        }
    }

    /// An upper bound of the value over the rendered wavelengths, tight but for `Illuminant`.
    #[must_use]
    pub fn max_value(&self, tables: &SpectrumTables) -> f32 {
        match self {
            Self::Constant(value) => *value,
            Self::Albedo { polynomial, .. } => polynomial.max_value(),
            Self::Unbounded { scale, polynomial, .. } => scale * polynomial.max_value(),
            Self::Illuminant { scale, polynomial, table, .. } => {
                scale * polynomial.max_value() * tables.max_value(*table)
            }
            Self::Table { table, scale, .. } => scale * tables.max_value(*table),
            Self::Blackbody { kelvin, scale, .. } => {
                let peak = blackbody::wien_peak_nm(*kelvin).clamp(LAMBDA_MIN_NM, LAMBDA_MAX_NM);
                scale * blackbody::normalized(peak, *kelvin)
            }
        }
    }

    /// Whether the value is known not to depend on wavelength, so that refraction does not disperse.
    #[inline]
    #[must_use]
    pub fn is_constant(&self) -> bool {
        match self {
            Self::Constant(_) => true,
            Self::Albedo { polynomial, .. } | Self::Unbounded { polynomial, .. } => polynomial.is_constant(),
            Self::Illuminant { .. } | Self::Table { .. } | Self::Blackbody { .. } => false,
        }
    }

    /// Whether the value is zero everywhere.
    #[must_use]
    pub fn is_black(&self, tables: &SpectrumTables) -> bool {
        self.max_value(tables) == 0.0
    }

    /// The spectrum times a factor, which for an albedo makes an unbounded spectrum.
    #[must_use]
    pub fn scaled(self, factor: f32) -> Self {
        match self {
            Self::Constant(value) => Self::Constant(value * factor),
            Self::Albedo { polynomial, bands } => Self::Unbounded { scale: factor, polynomial, bands },
            Self::Unbounded { scale, polynomial, bands } => {
                Self::Unbounded { scale: scale * factor, polynomial, bands }
            }
            Self::Illuminant { scale, polynomial, table, bands } => {
                Self::Illuminant { scale: scale * factor, polynomial, table, bands }
            }
            Self::Table { table, scale, bands } => Self::Table { table, scale: scale * factor, bands },
            Self::Blackbody { kelvin, scale, bands } => {
                Self::Blackbody { kelvin, scale: scale * factor, bands }
            }
        }
    }
}

/// Tristimulus values of light with this spectrum: ∫ s(λ) x̄(λ) dλ / ∫ ȳ(λ) dλ and so on, so that the constant 1 has
/// Y = 1.
#[must_use]
pub fn spectrum_to_xyz(spectrum: &Spectrum, tables: &SpectrumTables) -> Xyz {
    let [x, y, z] = cie::integrate_1nm(|nm| spectrum.at(tables, nm));
    Xyz { x: x / CIE_Y_INTEGRAL, y: y / CIE_Y_INTEGRAL, z: z / CIE_Y_INTEGRAL }
}

/// ∫ s(λ) ȳ(λ) dλ in nm × unit of s, by which a light is divided so that its luminance is 1.
///
/// For light given as RGB only the illuminant counts, not the RGB: an RGB of 2 is then twice as bright as one of 1.
#[must_use]
pub fn spectrum_to_photometric(spectrum: &Spectrum, tables: &SpectrumTables) -> f32 {
    let at = |nm: f32| match spectrum {
        Spectrum::Illuminant { table, .. } => tables.at(*table, nm),
        other => other.at(tables, nm),
    };
    cie::integrate_1nm(at)[1]
}
