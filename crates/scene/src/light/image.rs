//! Pictures in lights: RGB texels lifted to spectra once, when the scene is built.
//!
//! A texel is white light times a smooth spectrum of at most 1 (Jakob and Hanika 2019, "A Low-Dimensional Function
//! Space for Efficient Spectral Upsampling"), times a factor that carries brightness, as pbrt-v4's
//! `RGBIlluminantSpectrum`. Stored are the factor and the three coefficients, 16 bytes, and apart from them, so that a
//! path touches one place in memory, the factor and the colour for paths that carry bands, 12 bytes.

use etendue_math::Point2;
use etendue_spectrum::{
    Bands, ColorSpace, ColorSpaceName, Sampled, SigmoidPolynomial, Spectrum, SpectrumTables, TableId,
    Wavelengths,
};
use rayon::prelude::*;

/// Index of a picture in [`LightTables`](super::LightTables).
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct LightImageId(pub u32);

/// One texel.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Texel {
    scale: f32,
    polynomial: SigmoidPolynomial,
}

/// One texel for paths that carry bands.
#[derive(Clone, Copy, Debug, PartialEq)]
struct BandTexel {
    scale: f32,
    /// The texel over its factor by band, in 32768ths: below 2, since the largest component of the colour is 1/2 and
    /// conversion to the primaries of sRGB makes it less than four times as large.
    bands: [u16; 3],
}

const PACKED_ONE: f32 = 32_768.0;

/// A picture whose texels are spectra of light, rows from the top.
#[derive(Clone, Debug)]
pub struct LightImage {
    width: usize,
    height: usize,
    texels: Vec<Texel>,
    bands: Vec<BandTexel>,
    white: TableId,
    /// Spectrum of the average texel.
    mean: Spectrum,
}

impl LightImage {
    /// Lifts linear RGB pixels of a colour space, rows from the top; negative values count as 0. `white` is the
    /// illuminant of that space.
    ///
    /// # Panics
    /// When there are not `width * height` pixels, or none.
    #[must_use]
    pub fn new(width: usize, height: usize, rgb: &[[f32; 3]], space: ColorSpaceName, white: TableId) -> Self {
        assert!(width > 0 && height > 0, "a picture has at least one texel");
        assert_eq!(rgb.len(), width * height, "one colour per texel");
        let color_space = ColorSpace::get(space);
        let (texels, bands) = rgb
            .par_iter()
            .map(|rgb| {
                let texel = lift(*rgb, color_space);
                (texel, pack(*rgb, texel.scale, color_space))
            })
            .unzip();
        let mean = weighted_mean(rgb.iter().map(|c| (*c, 1.0)), space, white);
        Self { width, height, texels, bands, white, mean }
    }

    /// Texels in a row.
    #[must_use]
    pub const fn width(&self) -> usize {
        self.width
    }

    /// Rows.
    #[must_use]
    pub const fn height(&self) -> usize {
        self.height
    }

    /// The illuminant that colours are relative to.
    #[must_use]
    pub const fn white(&self) -> TableId {
        self.white
    }

    /// Spectrum of the average colour.
    #[must_use]
    pub const fn mean(&self) -> Spectrum {
        self.mean
    }

    /// Value of the texel that holds `uv` in [0, 1]^2, v from the top.
    #[inline]
    #[must_use]
    pub fn nearest(&self, uv: Point2, tables: &SpectrumTables, lambda: &Wavelengths) -> Sampled {
        let cell = |t: f32, n: usize| ((t * n as f32).max(0.0) as usize).min(n - 1);
        self.texel(cell(uv.x, self.width), cell(uv.y, self.height), tables, lambda)
    }

    /// Interpolation between the four texels around `uv`, clamped at the border, v from the top.
    #[must_use]
    pub fn bilinear(&self, uv: Point2, tables: &SpectrumTables, lambda: &Wavelengths) -> Sampled {
        let (x, y) = (uv.x * self.width as f32 - 0.5, uv.y * self.height as f32 - 0.5);
        let (x0, y0) = (x.floor(), y.floor());
        let (dx, dy) = (x - x0, y - y0);
        let at = |x: f32, y: f32| {
            let cell = |t: f32, n: usize| (t.max(0.0) as usize).min(n - 1);
            self.texel(cell(x, self.width), cell(y, self.height), tables, lambda)
        };
        (at(x0, y0) * (1.0 - dx) + at(x0 + 1.0, y0) * dx) * (1.0 - dy)
            + (at(x0, y0 + 1.0) * (1.0 - dx) + at(x0 + 1.0, y0 + 1.0) * dx) * dy
    }

    #[inline]
    fn texel(&self, x: usize, y: usize, tables: &SpectrumTables, lambda: &Wavelengths) -> Sampled {
        let index = y * self.width + x;
        if lambda.is_bands() {
            let texel = &self.bands[index];
            return lambda.of_bands(unpack(texel.bands)) * texel.scale;
        }
        let texel = &self.texels[index];
        if texel.scale == 0.0 {
            return Sampled::ZERO;
        }
        texel.polynomial.sample(lambda) * tables.sample(self.white, lambda) * texel.scale
    }
}

/// Brightness and smooth spectrum of a colour.
fn lift(rgb: [f32; 3], space: &ColorSpace) -> Texel {
    let (scale, polynomial) = space.uplift_unbounded(rgb.map(|c| c.max(0.0)));
    Texel { scale, polynomial }
}

/// A colour over the factor of its texel by band.
fn pack(rgb: [f32; 3], scale: f32, space: &ColorSpace) -> BandTexel {
    if scale == 0.0 {
        return BandTexel { scale, bands: [0; 3] };
    }
    let bands = space.light_bands(rgb.map(|c| c.max(0.0) / scale));
    let bands = bands.rgb().map(|c| (c * PACKED_ONE).round().min(f32::from(u16::MAX)) as u16);
    BandTexel { scale, bands }
}

/// Reverses [`pack`].
#[inline]
fn unpack(packed: [u16; 3]) -> Bands {
    Bands::from_rgb(packed.map(|c| f32::from(c) / PACKED_ONE))
}

/// Mean of colours with weights, negative values as 0.
fn mean_rgb(pixels: impl Iterator<Item = ([f32; 3], f64)>) -> [f32; 3] {
    let mut sum = [0.0_f64; 3];
    let mut total = 0.0;
    for (rgb, weight) in pixels {
        total += weight;
        for c in 0..3 {
            sum[c] += weight * f64::from(rgb[c].max(0.0));
        }
    }
    sum.map(|s| if total > 0.0 { (s / total) as f32 } else { 0.0 })
}

/// Spectrum of the mean of colours with weights.
#[must_use]
pub(super) fn weighted_mean(
    pixels: impl Iterator<Item = ([f32; 3], f64)>,
    space: ColorSpaceName,
    white: TableId,
) -> Spectrum {
    let (rgb, space) = (mean_rgb(pixels), ColorSpace::get(space));
    let Texel { scale, polynomial } = lift(rgb, space);
    let bands = if scale > 0.0 { space.light_bands(rgb.map(|c| c / scale)) } else { Bands::splat(0.0) };
    Spectrum::Illuminant { scale, polynomial, table: white, bands }
}

/// What a texel counts in a sampling distribution: the average of its channels.
#[must_use]
pub(super) fn sampling_weights(rgb: &[[f32; 3]]) -> Vec<f32> {
    rgb.iter().map(|rgb| rgb.iter().map(|c| c.max(0.0)).sum::<f32>() / 3.0).collect()
}
