//! From what is kept of light as XYZ back to the wavelengths of a path: photon maps keep the XYZ of photons.
//!
//! Many spectra have one XYZ. [`lift`] takes a smooth one, never negative, whose XYZ by [`spectrum_to_xyz`](crate::spectrum_to_xyz)
//! is the given one:
//! - for a colour well inside the gamut of sRGB that of an RGB light, D65 times a smooth reflectance ([`uplift_srgb`]; the
//!   table behind it is exact to about 0.2 % of the largest component);
//! - for others D65 plus two bands of neighbouring wavelengths (Gaussian curves), as wide as still reach the colour, so that they
//!   are met by as many wavelengths of paths as possible. This is exact but for colours within a few nanometres of the spectrum's edge,
//!   which no light has: those keep their Y and lose saturation.
//!
//! A sum of lights is lifted as the sum, once, since many narrow bands make more noise than the spectrum of their sum.

use std::sync::OnceLock;

use crate::cie::{CIE_Y_INTEGRAL, color_matching, integrate_1nm};
use crate::matrix::{Matrix3, solve, transpose};
use crate::tables::{dense_lookup, weighted_rows};
use crate::{
    Bands, ColorSpace, ColorSpaceName, N_LAMBDA, Sampled, SigmoidPolynomial, Wavelengths, Xyz, uplift_srgb,
};

/// Standard deviations of the bands in nm, wide ones first.
const WIDTHS_NM: [f32; 5] = [50.0, 25.0, 12.0, 6.0, 3.0];

/// Wavelengths of the bands in nm. Beyond these colours change little, and back.
const FIRST_NM: u32 = 405;
const LAST_NM: u32 = 690;

/// Least component of a linear sRGB, as a share of the greatest, for which the smooth reflectance is used: nearer to the
/// edge of the gamut the table does not reach the colour.
const INSIDE: f32 = 0.02;

/// The XYZ of what has these values at the wavelengths of a path (or in its bands), in the mean over paths: by
/// [`crate::spectrum_to_xyz`].
#[inline]
#[must_use]
pub fn flux_to_xyz(flux: Sampled, wavelengths: &Wavelengths) -> Xyz {
    if let Some(rgb) = wavelengths.estimate_bands(flux) {
        return ColorSpace::get(ColorSpaceName::Srgb).to_xyz(rgb);
    }
    let weights = flux.safe_div(wavelengths.pdf() * (N_LAMBDA as f32 * CIE_Y_INTEGRAL));
    let [x, y, z, _] = weighted_rows(&color_matching().rows, weights, wavelengths);
    Xyz { x, y, z }
}

/// Values at the wavelengths of a path of a light with this XYZ, not negative. What of it is negative or not finite counts as 0.
#[must_use]
pub fn lift(xyz: Xyz, wavelengths: &Wavelengths) -> Sampled {
    Lifted::new(xyz).sample(wavelengths)
}

/// A light with a given XYZ, for those who ask for it at the wavelengths of many paths.
#[derive(Clone, Copy, Debug)]
pub struct Lifted {
    xyz: Xyz,
    form: Form,
}

#[derive(Clone, Copy, Debug)]
enum Form {
    Black,
    /// D65 times a reflectance and a factor.
    Smooth(SigmoidPolynomial, f32),
    Bands(BandSum),
}

impl Lifted {
    /// What of the XYZ is negative or not finite counts as 0.
    #[must_use]
    pub fn new(xyz: Xyz) -> Self {
        let xyz = Xyz::from(xyz.to_array().map(|v| if v > 0.0 && v.is_finite() { v } else { 0.0 }));
        Self { xyz, form: Form::of(xyz) }
    }

    /// Values at the wavelengths of a path, not negative.
    #[inline]
    #[must_use]
    pub fn sample(&self, wavelengths: &Wavelengths) -> Sampled {
        if wavelengths.is_bands() {
            let rgb = ColorSpace::get(ColorSpaceName::Srgb).to_rgb(self.xyz);
            return wavelengths.of_bands(Bands::from_rgb(rgb));
        }
        match &self.form {
            Form::Black => Sampled::ZERO,
            Form::Smooth(reflectance, factor) => {
                reflectance.sample(wavelengths) * white(wavelengths) * *factor
            }
            Form::Bands(sum) => sum.sample(wavelengths),
        }
    }
}

impl Form {
    fn of(xyz: Xyz) -> Self {
        let rgb = ColorSpace::get(ColorSpaceName::Srgb).to_rgb(xyz);
        let largest = rgb[0].max(rgb[1]).max(rgb[2]);
        if largest.is_nan() || largest <= 0.0 {
            return Self::Black;
        }
        if rgb.iter().all(|v| *v >= INSIDE * largest) {
            let scale = 2.0 * largest;
            return Self::Smooth(uplift_srgb(rgb.map(|v| v / scale)), scale);
        }
        Self::Bands(BandSum::of(xyz))
    }
}

/// D65 with Y = 1.
fn white(wavelengths: &Wavelengths) -> Sampled {
    let illuminant = &ColorSpace::get(ColorSpaceName::Srgb).illuminant;
    Sampled::from_array(wavelengths.lambda_nm().map(|nm| dense_lookup(illuminant, nm)))
}

/// White and two bands of the same width.
#[derive(Clone, Copy, Debug)]
struct BandSum {
    white: f32,
    width_nm: f32,
    /// Factor and wavelength in nm.
    bands: [(f32, f32); 2],
}

impl BandSum {
    /// With this XYZ, of the widest bands that reach it.
    fn of(xyz: Xyz) -> Self {
        let rings = rings();
        let mut sums = rings.iter().map(|ring| ring.sum(xyz));
        let widest = sums.clone().find(|sum| sum.white >= 0.0);
        widest.or_else(|| sums.next_back().map(|sum| sum.without_white(xyz.y))).unwrap_or(Self {
            white: xyz.y,
            width_nm: WIDTHS_NM[0],
            bands: [(0.0, 550.0); 2],
        })
    }

    fn sample(&self, wavelengths: &Wavelengths) -> Sampled {
        let of_bands = wavelengths.lambda_nm().map(|nm| {
            self.bands.iter().map(|(factor, centre)| factor * band(nm, *centre, self.width_nm)).sum()
        });
        white(wavelengths) * self.white + Sampled::from_array(of_bands)
    }

    /// The same hue of that luminance without white: for colours that even narrow bands do not reach.
    fn without_white(mut self, luminance: f32) -> Self {
        let y = |(factor, centre): &(f32, f32)| factor * xyz_of_band(*centre, self.width_nm).y;
        let scale = luminance / self.bands.iter().map(y).sum::<f32>();
        self.white = 0.0;
        for band in &mut self.bands {
            band.0 = if scale.is_finite() { band.0 * scale } else { 0.0 };
        }
        self
    }
}

/// A Gaussian curve of height 1.
fn band(nm: f32, centre_nm: f32, width_nm: f32) -> f32 {
    let t = (nm - centre_nm) / width_nm;
    (-0.5 * t * t).exp()
}

fn xyz_of_band(centre_nm: f32, width_nm: f32) -> Xyz {
    Xyz::from(integrate_1nm(|nm| band(nm, centre_nm, width_nm)).map(|v| v / CIE_Y_INTEGRAL))
}

/// Bands of a width, in order of their hue around white.
#[derive(Debug)]
struct Ring {
    width_nm: f32,
    bands: Vec<RingBand>,
}

#[derive(Clone, Copy, Debug)]
struct RingBand {
    hue: f32,
    centre_nm: f32,
    xyz: Xyz,
}

fn rings() -> &'static [Ring] {
    static RINGS: OnceLock<Vec<Ring>> = OnceLock::new();
    RINGS.get_or_init(|| WIDTHS_NM.iter().map(|width| Ring::new(*width)).collect())
}

/// The angle of a chromaticity around that of white.
fn hue(xyz: Xyz) -> f32 {
    let [x, y] = xyz.chromaticity();
    let [white_x, white_y] = ColorSpace::get(ColorSpaceName::Srgb).white_xy;
    (y - white_y).atan2(x - white_x)
}

impl Ring {
    fn new(width_nm: f32) -> Self {
        let band = |nm: u32| {
            let xyz = xyz_of_band(nm as f32, width_nm);
            RingBand { hue: hue(xyz), centre_nm: nm as f32, xyz }
        };
        let mut bands: Vec<RingBand> = (FIRST_NM..=LAST_NM).step_by(3).map(band).collect();
        bands.sort_by(|a, b| a.hue.total_cmp(&b.hue));
        Self { width_nm, bands }
    }

    /// White and the two bands between whose hues the colour lies; between the ends of the spectrum lie the purples. The share of
    /// white is negative where the colour is out of reach.
    fn sum(&self, xyz: Xyz) -> BandSum {
        let n = self.bands.len();
        let hue = hue(xyz);
        let next = self.bands.partition_point(|band| band.hue <= hue) % n;
        let [a, b] = [self.bands[(next + n - 1) % n], self.bands[next]];
        let white = ColorSpace::get(ColorSpaceName::Srgb).to_xyz([1.0; 3]);
        let columns: Matrix3 = [white, a.xyz, b.xyz].map(|c| c.to_array().map(f64::from));
        let shares = solve(&transpose(&columns), xyz.to_array().map(f64::from)).unwrap_or([-1.0; 3]);
        let [white, of_a, of_b] = shares.map(|share| share as f32);
        BandSum {
            white,
            width_nm: self.width_nm,
            bands: [(of_a.max(0.0), a.centre_nm), (of_b.max(0.0), b.centre_nm)],
        }
    }
}

#[cfg(test)]
mod tests {
    use etendue_math::Rng;

    use super::*;
    use crate::{LAMBDA_MAX_NM, LAMBDA_MIN_NM};

    /// XYZ of the lifted spectrum, by the sum over whole nanometres.
    fn xyz_of_lifted(xyz: Xyz) -> Xyz {
        let at = |nm: f32| {
            let value = lift(xyz, &Wavelengths::from_parts([nm; N_LAMBDA], [1.0; N_LAMBDA]))[0];
            assert!(value >= 0.0 && value.is_finite(), "{xyz:?} has {value} at {nm} nm");
            value
        };
        Xyz::from(integrate_1nm(at).map(|v| v / CIE_Y_INTEGRAL))
    }

    fn error(a: Xyz, b: Xyz) -> f32 {
        let [a, b] = [a, b].map(Xyz::to_array);
        let largest = b.iter().copied().fold(0.0, f32::max);
        (0..3).map(|i| (a[i] - b[i]).abs()).fold(0.0, f32::max) / largest
    }

    /// Colours of sRGB, of all luminances.
    #[test]
    fn inside_the_gamut() {
        let srgb = ColorSpace::get(ColorSpaceName::Srgb);
        let mut rng = Rng::new(1, 0);
        let mut greatest = 0.0_f32;
        for _ in 0..400 {
            let size = (rng.next_f32() * 20.0 - 10.0).exp2();
            let xyz = srgb.to_xyz([0; 3].map(|_| rng.next_f32().powi(3) * size));
            greatest = greatest.max(error(xyz_of_lifted(xyz), xyz));
        }
        assert!(greatest < 4e-3, "{greatest}");
    }

    /// Sums of a few wavelengths, which are mostly outside the gamut of sRGB.
    #[test]
    fn outside_the_gamut() {
        let mut rng = Rng::new(2, 0);
        let mut greatest = 0.0_f32;
        for i in 0..400 {
            let mut lambda = Wavelengths::sample_visible(rng.next_f32());
            let flux = Sampled::from_array([0; N_LAMBDA].map(|_| rng.next_f32()));
            if i % 4 == 0 {
                lambda = Wavelengths::from_parts([450.0 + rng.next_f32() * 180.0; N_LAMBDA], [1.0; N_LAMBDA]);
            }
            let xyz = flux_to_xyz(flux, &lambda);
            let read = xyz_of_lifted(xyz);
            assert!((read.y - xyz.y).abs() < 4e-3 * xyz.x.max(xyz.y).max(xyz.z), "{xyz:?} {read:?}");
            greatest = greatest.max(error(read, xyz));
        }
        assert!(greatest < 0.05, "{greatest}");
    }

    /// What paths of white light bring to XYZ and back again has, in the mean over paths, the XYZ of white.
    #[test]
    fn there_and_back() {
        let n = 1000;
        let mut sum = [0.0_f64; 3];
        let xyz = Xyz::new(0.3, 0.5, 0.1);
        for i in 0..n {
            let lambda = Wavelengths::sample_visible((i as f32 + 0.5) / n as f32);
            let back = flux_to_xyz(lift(xyz, &lambda), &lambda).to_array();
            (0..3).for_each(|c| sum[c] += f64::from(back[c]) / f64::from(n));
        }
        let mean = Xyz::from(sum.map(|v| v as f32));
        assert!(error(mean, xyz) < 4e-3, "{mean:?}");
    }

    /// Paths that carry bands have their linear sRGB.
    #[test]
    fn bands() {
        let srgb = ColorSpace::get(ColorSpaceName::Srgb);
        let (xyz, lambda) = (srgb.to_xyz([0.2, 0.5, 0.7]), Wavelengths::bands(0.4));
        let back = flux_to_xyz(lift(xyz, &lambda), &lambda);
        assert!(error(back, xyz) < 1e-5, "{back:?}");
    }

    /// Nothing is NaN or negative, whatever comes in.
    #[test]
    fn odd_values() {
        let odd = [0.0, -1.0, 1e-38, 1.0, 1e30, f32::NAN, f32::INFINITY];
        for x in odd {
            for y in odd {
                for z in odd {
                    for nm in [LAMBDA_MIN_NM, 480.0, 555.0, LAMBDA_MAX_NM] {
                        let lambda = Wavelengths::from_parts([nm; N_LAMBDA], [1.0; N_LAMBDA]);
                        let value = lift(Xyz::new(x, y, z), &lambda)[0];
                        assert!(value >= 0.0 && value.is_finite(), "{x} {y} {z} at {nm}: {value}");
                    }
                }
            }
        }
        assert_eq!(lift(Xyz::default(), &Wavelengths::sample_visible(0.3)), Sampled::ZERO);
    }
}
