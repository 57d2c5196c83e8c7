//! RGB colour spaces.
//!
//! A space is given by the chromaticities of its primaries and by an illuminant, the spectrum of its white. The matrix to
//! XYZ has the primaries as columns, scaled so that RGB (1, 1, 1) is the white with Y = 1. RGB values of lights and
//! reflectances become spectra by the method of [`SigmoidPolynomial`].

use std::sync::OnceLock;

use crate::cie::{CIE_Y_INTEGRAL, integrate_1nm};
use crate::matrix::{Matrix3, invert, multiply, solve, transform};
use crate::named::named_spectrum;
use crate::tables::{dense_nm, piecewise_linear};
use crate::uplift::Uplift;
use crate::uplift_table::uplift_srgb;
use crate::xyz::{white_balance_f64, xyz_of};
use crate::{Bands, LAMBDA_MIN_NM, N_DENSE, SigmoidPolynomial, Spectrum, SpectrumTables, Xyz};

/// The RGB colour spaces that scene files may name.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum ColorSpaceName {
    /// sRGB and Rec. 709 primaries, white D65.
    #[default]
    Srgb,
    /// Display P3 primaries, white D65 (`dci-p3` in pbrt).
    DciP3,
    /// ITU-R BT.2020 primaries, white D65.
    Rec2020,
    /// ACES 2065-1 (AP0) primaries, white about D60.
    Aces2065_1,
}

impl ColorSpaceName {
    /// All of them.
    pub const ALL: [Self; 4] = [Self::Srgb, Self::DciP3, Self::Rec2020, Self::Aces2065_1];

    /// The name in scene files.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Srgb => "srgb",
            Self::DciP3 => "dci-p3",
            Self::Rec2020 => "rec2020",
            Self::Aces2065_1 => "aces2065-1",
        }
    }

    /// The colour space of that name in a scene file.
    #[must_use]
    pub fn from_name(name: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|space| space.name() == name)
    }
}

/// An RGB colour space with its white.
#[derive(Debug)]
pub struct ColorSpace {
    /// Which one.
    pub name: ColorSpaceName,
    /// Matrix from XYZ to linear RGB, rows first.
    pub rgb_from_xyz: [[f32; 3]; 3],
    /// Matrix from linear RGB to XYZ, rows first.
    pub xyz_from_rgb: [[f32; 3]; 3],
    /// Chromaticities (x, y) of the red, green and blue primaries.
    pub primaries_xy: [[f32; 2]; 3],
    /// Chromaticity (x, y) of the white.
    pub white_xy: [f32; 2],
    /// Spectrum of the white at 360, 361, ... 830 nm, with Y = 1 by [`crate::spectrum_to_xyz`].
    pub illuminant: Vec<f32>,
    /// Fit of reflectances under the illuminant.
    uplift: Uplift,
    to_srgb: ToSrgb,
}

/// Matrices from linear RGB of a space to that of sRGB.
#[derive(Debug)]
struct ToSrgb {
    /// By colour.
    light: [[f32; 3]; 3],
    /// By appearance: the white of the space becomes the white of sRGB.
    reflectance: [[f32; 3]; 3],
}

impl ColorSpace {
    /// The colour space of that name; built at its first use.
    #[must_use]
    pub fn get(name: ColorSpaceName) -> &'static Self {
        static SPACES: [OnceLock<ColorSpace>; ColorSpaceName::ALL.len()] =
            [const { OnceLock::new() }; ColorSpaceName::ALL.len()];
        SPACES[name as usize].get_or_init(|| Self::build(name))
    }

    /// Linear RGB of a colour, not limited to the gamut.
    #[inline]
    #[must_use]
    pub fn to_rgb(&self, xyz: Xyz) -> [f32; 3] {
        apply(&self.rgb_from_xyz, xyz.to_array())
    }

    /// Colour of linear RGB.
    #[inline]
    #[must_use]
    pub fn to_xyz(&self, rgb: [f32; 3]) -> Xyz {
        Xyz::from(apply(&self.xyz_from_rgb, rgb))
    }

    /// Luminance Y of linear RGB.
    #[inline]
    #[must_use]
    pub fn luminance(&self, rgb: [f32; 3]) -> f32 {
        let [r, g, b] = self.xyz_from_rgb[1];
        r * rgb[0] + g * rgb[1] + b * rgb[2]
    }

    /// The reflectance that has this linear RGB under the illuminant of the space, by an exact fit.
    ///
    /// Components are limited to [0, 1]. Equal components give a constant. Colours that no reflectance of this form
    /// reaches, near the corners of the RGB cube, give the nearest. Takes tens of microseconds: for single colours.
    #[must_use]
    pub fn fit_albedo(&self, rgb: [f32; 3]) -> SigmoidPolynomial {
        self.uplift.fit(rgb)
    }

    /// As [`Self::fit_albedo`], fast and a little less exact: for the texels of images.
    ///
    /// Colours of a space with white D65 that lie inside the gamut of sRGB go through the table of sRGB; others are
    /// fitted.
    #[inline]
    #[must_use]
    pub fn uplift(&self, rgb: [f32; 3]) -> SigmoidPolynomial {
        match self.name {
            ColorSpaceName::Srgb => uplift_srgb(rgb),
            ColorSpaceName::DciP3 | ColorSpaceName::Rec2020 => {
                let srgb = Self::get(ColorSpaceName::Srgb).to_rgb(self.to_xyz(rgb));
                if srgb.iter().all(|c| (-1e-4..=1.0001).contains(c)) {
                    return uplift_srgb(srgb);
                }
                self.fit_albedo(rgb)
            }
            ColorSpaceName::Aces2065_1 => self.fit_albedo(rgb),
        }
    }

    /// As [`Self::uplift`] for non-negative values without upper limit: a factor, and the shape to multiply with it.
    #[inline]
    #[must_use]
    pub fn uplift_unbounded(&self, rgb: [f32; 3]) -> (f32, SigmoidPolynomial) {
        let (scale, shape) = split_scale(rgb);
        (scale, self.uplift(shape))
    }

    /// Linear RGB of light by band.
    #[inline]
    #[must_use]
    pub fn light_bands(&self, rgb: [f32; 3]) -> Bands {
        Bands::from_rgb(apply(&self.to_srgb.light, rgb))
    }

    /// Linear RGB of a reflectance or another property of matter by band; grey stays grey whatever the white of the
    /// space.
    #[inline]
    #[must_use]
    pub fn reflectance_bands(&self, rgb: [f32; 3]) -> Bands {
        if rgb[0] == rgb[1] && rgb[1] == rgb[2] {
            return Bands::from_rgb(rgb);
        }
        Bands::from_rgb(apply(&self.to_srgb.reflectance, rgb))
    }

    /// [`Self::reflectance_bands`], limited to 1.
    #[inline]
    #[must_use]
    pub fn albedo_bands(&self, rgb: [f32; 3]) -> Bands {
        Bands::from_rgb(self.reflectance_bands(rgb.map(|c| c.clamp(0.0, 1.0))).rgb().map(|c| c.min(1.0)))
    }

    /// The spectrum of a reflectance with this linear RGB, limited to [0, 1].
    #[must_use]
    pub fn rgb_albedo(&self, rgb: [f32; 3]) -> Spectrum {
        Spectrum::Albedo { polynomial: self.fit_albedo(rgb), bands: self.albedo_bands(rgb) }
    }

    /// The spectrum of a non-negative quantity without upper limit with this linear RGB.
    #[must_use]
    pub fn rgb_unbounded(&self, rgb: [f32; 3]) -> Spectrum {
        let (scale, shape) = split_scale(rgb);
        Spectrum::Unbounded {
            scale,
            polynomial: self.fit_albedo(shape),
            bands: self.reflectance_bands(shape),
        }
    }

    /// The spectrum of light with this linear RGB: equal components give a multiple of the illuminant of the space.
    #[must_use]
    pub fn rgb_illuminant(&self, tables: &mut SpectrumTables, rgb: [f32; 3]) -> Spectrum {
        let (scale, shape) = split_scale(rgb);
        Spectrum::Illuminant {
            scale,
            polynomial: self.fit_albedo(shape),
            table: tables.illuminant(self.name),
            bands: self.light_bands(shape),
        }
    }

    /// Derives everything from the primaries and the illuminant.
    fn build(name: ColorSpaceName) -> Self {
        let (primaries, illuminant_name) = definition(name);
        let samples = named_spectrum(illuminant_name)
            .expect("illuminants of the colour spaces are part of the crate")
            .samples;
        let illuminant: Vec<f32> = (0..N_DENSE).map(|i| piecewise_linear(&samples, dense_nm(i))).collect();
        let white = integrate_1nm(|nm| illuminant[(nm - LAMBDA_MIN_NM) as usize])
            .map(|v| f64::from(v / CIE_Y_INTEGRAL));
        let xyz_from_rgb = matrix_to_xyz(&primaries, white).expect("primaries span the space of colours");
        let rgb_from_xyz = invert(&xyz_from_rgb);
        Self {
            name,
            rgb_from_xyz: narrow(&rgb_from_xyz),
            xyz_from_rgb: narrow(&xyz_from_rgb),
            primaries_xy: primaries.map(|xy| xy.map(|v| v as f32)),
            white_xy: Xyz::from(white.map(|v| v as f32)).chromaticity(),
            uplift: Uplift::new(&illuminant, &rgb_from_xyz),
            to_srgb: ToSrgb::new(name, &xyz_from_rgb),
            illuminant,
        }
    }
}

impl ToSrgb {
    /// Of the space of that name with that matrix from RGB to XYZ.
    fn new(name: ColorSpaceName, xyz_from_rgb: &Matrix3) -> Self {
        if name == ColorSpaceName::Srgb {
            let identity = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
            return Self { light: identity, reflectance: identity };
        }
        let srgb = ColorSpace::get(ColorSpaceName::Srgb);
        let srgb_from_xyz: Matrix3 = srgb.rgb_from_xyz.map(|row| row.map(f64::from));
        let white = Xyz::from(transform(xyz_from_rgb, [1.0; 3]).map(|v| v as f32)).chromaticity();
        let adaptation = white_balance_f64(white.map(f64::from), srgb.white_xy.map(f64::from));
        Self {
            light: narrow(&multiply(&srgb_from_xyz, xyz_from_rgb)),
            reflectance: narrow(&multiply(&srgb_from_xyz, &multiply(&adaptation, xyz_from_rgb))),
        }
    }
}

/// Chromaticities of red, green and blue, and the name of the illuminant.
const fn definition(name: ColorSpaceName) -> ([[f64; 2]; 3], &'static str) {
    match name {
        ColorSpaceName::Srgb => ([[0.64, 0.33], [0.30, 0.60], [0.15, 0.06]], "stdillum-D65"),
        ColorSpaceName::DciP3 => ([[0.68, 0.32], [0.265, 0.690], [0.15, 0.06]], "stdillum-D65"),
        ColorSpaceName::Rec2020 => ([[0.708, 0.292], [0.170, 0.797], [0.131, 0.046]], "stdillum-D65"),
        ColorSpaceName::Aces2065_1 => ([[0.7347, 0.2653], [0.0, 1.0], [0.0001, -0.077]], "illum-acesD60"),
    }
}

/// The matrix from RGB to XYZ whose white has the given XYZ; `None` if the primaries do not span the space of colours.
pub(crate) fn matrix_to_xyz(primaries: &[[f64; 2]; 3], white: [f64; 3]) -> Option<Matrix3> {
    let columns = primaries.map(|xy| xyz_of(xy, 1.0));
    let unscaled = crate::matrix::transpose(&columns);
    let scale = solve(&unscaled, white)?;
    Some(unscaled.map(|row| std::array::from_fn(|c| row[c] * scale[c])))
}

/// Factor and rest in [0, 1/2], where reflectances are smooth, of a non-negative RGB.
#[inline]
fn split_scale(rgb: [f32; 3]) -> (f32, [f32; 3]) {
    let max = rgb[0].max(rgb[1]).max(rgb[2]);
    if max <= 0.0 {
        return (0.0, [0.0; 3]);
    }
    let scale = 2.0 * max;
    (scale, rgb.map(|c| c / scale))
}

/// Matrix times vector.
#[inline]
fn apply(m: &[[f32; 3]; 3], v: [f32; 3]) -> [f32; 3] {
    m.map(|row| row[0] * v[0] + row[1] * v[1] + row[2] * v[2])
}

/// To single precision.
fn narrow(m: &Matrix3) -> [[f32; 3]; 3] {
    m.map(|row| row.map(|v| v as f32))
}
