//! A function of wavelength in one of a few forms.
//!
//! To add a form: a variant here, a line in each `match`. Variants with many values keep them in [`SpectrumTables`] and
//! hold an id, so that a spectrum is small and is copied freely.

use crate::cie::{self, CIE_Y_INTEGRAL};
use crate::{
    LAMBDA_MAX_NM, LAMBDA_MIN_NM, Sampled, SigmoidPolynomial, SpectrumTables, TableId, Wavelengths, Xyz,
    blackbody,
};

/// A function of wavelength: a reflectance, an index of refraction, a coefficient per metre, or the relative or absolute
/// power of a light, whose unit its owner states.
#[derive(Copy, Clone, Debug, PartialEq)]
pub enum Spectrum {
    /// The same value at every wavelength.
    Constant(f32),
    /// A smooth reflectance in [0, 1] of a given RGB.
    Albedo(SigmoidPolynomial),
    /// A smooth non-negative function of a given RGB: `scale` × polynomial.
    Unbounded {
        /// Factor, about twice the largest component of the RGB.
        scale: f32,
        /// Shape, in [0, 1].
        polynomial: SigmoidPolynomial,
    },
    /// Light of a given RGB: `scale` × polynomial × the illuminant of the colour space.
    Illuminant {
        /// Factor, about twice the largest component of the RGB.
        scale: f32,
        /// Shape, in [0, 1].
        polynomial: SigmoidPolynomial,
        /// The illuminant, white of the colour space.
        table: TableId,
    },
    /// `scale` × a table.
    Table {
        /// One value per nm.
        table: TableId,
        /// Factor.
        scale: f32,
    },
    /// `scale` × the radiance of a black body, which is 1 at its peak, wherever the peak lies.
    Blackbody {
        /// Temperature in kelvin, positive.
        kelvin: f32,
        /// Factor.
        scale: f32,
    },
}

impl Spectrum {
    /// Values at the wavelengths of a path.
    #[inline]
    #[must_use]
    pub fn sample(&self, tables: &SpectrumTables, wavelengths: &Wavelengths) -> Sampled {
        match self {
            Self::Constant(value) => Sampled::splat(*value),
            Self::Albedo(polynomial) => polynomial.sample(wavelengths),
            Self::Unbounded { scale, polynomial } => polynomial.sample(wavelengths) * *scale,
            Self::Illuminant { scale, polynomial, table } => {
                polynomial.sample(wavelengths) * tables.sample(*table, wavelengths) * *scale
            }
            Self::Table { table, scale } => tables.sample(*table, wavelengths) * *scale,
            Self::Blackbody { kelvin, scale } => {
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
            Self::Albedo(polynomial) => polynomial.at(nm),
            Self::Unbounded { scale, polynomial } => scale * polynomial.at(nm),
            Self::Illuminant { scale, polynomial, table } => {
                scale * polynomial.at(nm) * tables.at(*table, nm)
            }
            Self::Table { table, scale } => scale * tables.at(*table, nm),
            Self::Blackbody { kelvin, scale } => scale * blackbody::normalized(nm, *kelvin),
        }
    }

    /// An upper bound of the value over the rendered wavelengths, tight but for `Illuminant`.
    #[must_use]
    pub fn max_value(&self, tables: &SpectrumTables) -> f32 {
        match self {
            Self::Constant(value) => *value,
            Self::Albedo(polynomial) => polynomial.max_value(),
            Self::Unbounded { scale, polynomial } => scale * polynomial.max_value(),
            Self::Illuminant { scale, polynomial, table } => {
                scale * polynomial.max_value() * tables.max_value(*table)
            }
            Self::Table { table, scale } => scale * tables.max_value(*table),
            Self::Blackbody { kelvin, scale } => {
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
            Self::Albedo(polynomial) | Self::Unbounded { polynomial, .. } => polynomial.is_constant(),
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
            Self::Albedo(polynomial) => Self::Unbounded { scale: factor, polynomial },
            Self::Unbounded { scale, polynomial } => Self::Unbounded { scale: scale * factor, polynomial },
            Self::Illuminant { scale, polynomial, table } => {
                Self::Illuminant { scale: scale * factor, polynomial, table }
            }
            Self::Table { table, scale } => Self::Table { table, scale: scale * factor },
            Self::Blackbody { kelvin, scale } => Self::Blackbody { kelvin, scale: scale * factor },
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
    let s = match spectrum {
        Spectrum::Illuminant { table, .. } => Spectrum::Table { table: *table, scale: 1.0 },
        other => *other,
    };
    cie::integrate_1nm(|nm| s.at(tables, nm))[1]
}
