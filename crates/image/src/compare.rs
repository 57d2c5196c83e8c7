//! How far a test image is from its reference.
//!
//! With a for the test value and b for the reference value, over all channels of all pixels that are finite in both:
//!
//! ```text
//! MSE    mean (a - b)^2                 RMSE   sqrt(MSE)          PSNR   10 log10(peak^2 / MSE)
//! relMSE mean (a - b)^2 / (b^2 + 0.01)  MAPE   mean |a - b| / (|b| + 0.01)
//! SMAPE  mean |a - b| / (|a| + |b| + 0.01)
//! ```
//!
//! Papers on rendering also state relMSE without the 0.1 % of the pixels that are worst, since a few fireflies decide the mean.
//! LDR-FLIP (see [`flip`]) adds what an observer would see when flipping between the two, HDR-FLIP (see [`hdr_flip`]) the same over
//! all exposures, SSIM how alike they are around each pixel, and the [z-test](ZTest) whether noise explains the difference. A pixel with a NaN or an
//! infinity is masked and counted, never averaged: one of them would drown every other number.

mod difference;
pub mod flip;
pub mod hdr_flip;
mod ssim;
mod views;
mod z_test;

use std::fmt;

pub use crate::box_downsample;
use crate::{Image, srgb_encode};
pub use difference::{DifferenceKind, DifferenceMap};
pub(crate) use difference::{HEAT_RAMP, ramp_color};
pub(crate) use flip::convolve;
pub use views::{side_by_side, split};
pub use z_test::{BEYOND, VARIANCE, ZTest};

/// Keeps relative errors of dark pixels finite; the usual choice in papers on rendering.
const RELATIVE_OFFSET: f64 = 0.01;
/// Share of the pixels, the worst, that the trimmed relMSE leaves out; the usual choice in papers on rendering.
const TRIMMED_SHARE: f64 = 0.001;

/// What a comparison leaves open.
#[derive(Copy, Clone, Debug, PartialEq)]
pub struct Settings {
    /// Clips both images to these bounds before anything is measured.
    pub clamp: Option<[f32; 2]>,
    /// Signal peak of PSNR, in the unit of the pixels.
    pub peak: f32,
    /// Pixels per degree of visual angle of the FLIP observer.
    pub pixels_per_degree: f32,
    /// Exposure given to both images before FLIP clips them to [0, 1], in stops.
    pub flip_exposure_ev: f32,
}

impl Default for Settings {
    fn default() -> Self {
        Self { clamp: None, peak: 1.0, pixels_per_degree: flip::PIXELS_PER_DEGREE, flip_exposure_ev: 0.0 }
    }
}

/// Why two images cannot be compared.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum CompareError {
    /// Widths or heights differ.
    SizesDiffer {
        /// Width and height of the test image.
        test: [usize; 2],
        /// Width and height of the reference.
        reference: [usize; 2],
    },
    /// One of them has neither `R G B` nor `Y`.
    NoColor,
    /// There is no pixel.
    Empty,
}

impl fmt::Display for CompareError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            CompareError::SizesDiffer { test: [w, h], reference: [rw, rh] } => {
                write!(f, "the sizes differ: {w} x {h} against {rw} x {rh}")
            }
            CompareError::NoColor => {
                write!(f, "an image without the channels R, G, B or Y cannot be compared")
            }
            CompareError::Empty => write!(f, "images without pixels cannot be compared"),
        }
    }
}

impl std::error::Error for CompareError {}

/// All numbers of a comparison; NaN where every pixel is masked.
#[derive(Clone, Debug, PartialEq)]
pub struct Comparison {
    /// Pixels in either image.
    pub n_pixels: usize,
    /// Pixels left out because a value is not finite in at least one image.
    pub n_masked: usize,
    /// Pixels of the test image that are not finite.
    pub n_non_finite_test: usize,
    /// Pixels of the reference that are not finite.
    pub n_non_finite_reference: usize,
    /// Mean squared error.
    pub mse: f64,
    /// Root of the mean squared error.
    pub rmse: f64,
    /// Relative mean squared error.
    pub relmse: f64,
    /// The same without the worst 0.1 % of the pixels.
    pub relmse_trimmed: f64,
    /// Mean absolute error relative to the reference; 0.1 is ten per cent.
    pub mape: f64,
    /// Mean absolute error relative to both, in [0, 1].
    pub smape: f64,
    /// Peak signal-to-noise ratio in decibels, infinite for equal images.
    pub psnr_db: f64,
    /// Mean structural similarity of what a display shows, 1 for equal images.
    pub ssim: f64,
    /// Mean of FLIP's error map, in [0, 1].
    pub flip: f64,
    /// Mean of each channel of the test image.
    pub mean_test: [f64; 3],
    /// Mean of each channel of the reference.
    pub mean_reference: [f64; 3],
    /// Mean of the test image over mean of the reference, all channels together.
    pub mean_ratio: f64,
    /// The same channel by channel.
    pub channel_ratio: [f64; 3],
}

/// Measures everything.
///
/// # Errors
/// When the sizes differ, an image has no colour, or there is no pixel.
pub fn compare(test: &Image, reference: &Image, settings: &Settings) -> Result<Comparison, CompareError> {
    let pair = Pair::new(test, reference, settings.clamp)?;
    let (mean_test, mean_reference) = (pair.mean_test(), pair.mean_reference());
    let (sum_test, sum_reference): (f64, f64) = (mean_test.iter().sum(), mean_reference.iter().sum());
    Ok(Comparison {
        n_pixels: pair.n_pixels(),
        n_masked: pair.n_masked(),
        n_non_finite_test: count_non_finite(test),
        n_non_finite_reference: count_non_finite(reference),
        mse: pair.mse(),
        rmse: pair.rmse(),
        relmse: pair.relmse(),
        relmse_trimmed: pair.relmse_trimmed(),
        mape: pair.mape(),
        smape: pair.smape(),
        psnr_db: pair.psnr_db(settings.peak),
        ssim: pair.ssim(settings.flip_exposure_ev),
        flip: pair.mean_of_map(&pair.flip_map(settings.pixels_per_degree, settings.flip_exposure_ev)),
        mean_test,
        mean_reference,
        mean_ratio: ratio(sum_test, sum_reference),
        channel_ratio: std::array::from_fn(|c| ratio(mean_test[c], mean_reference[c])),
    })
}

/// Two images of one size, ready to be measured one metric at a time.
#[derive(Clone, Debug)]
pub struct Pair {
    width: usize,
    height: usize,
    test: Vec<[f32; 3]>,
    reference: Vec<[f32; 3]>,
    is_counted: Vec<bool>,
}

impl Pair {
    /// Pairs the colours of two images, clipped to `clamp` if given. Masked pixels become black in both.
    ///
    /// # Errors
    /// When the sizes differ, an image has no colour, or there is no pixel.
    pub fn new(test: &Image, reference: &Image, clamp: Option<[f32; 2]>) -> Result<Pair, CompareError> {
        let (width, height) = (test.width, test.height);
        if [width, height] != [reference.width, reference.height] {
            let reference = [reference.width, reference.height];
            return Err(CompareError::SizesDiffer { test: [width, height], reference });
        }
        let (Some(mut test), Some(mut reference)) = (test.rgb_pixels(), reference.rgb_pixels()) else {
            return Err(CompareError::NoColor);
        };
        if test.is_empty() {
            return Err(CompareError::Empty);
        }
        let is_counted: Vec<bool> =
            test.iter().zip(&reference).map(|(a, b)| is_finite(a) && is_finite(b)).collect();
        for pixels in [&mut test, &mut reference] {
            for (pixel, &is_counted) in pixels.iter_mut().zip(&is_counted) {
                *pixel = match clamp {
                    _ if !is_counted => [0.0; 3],
                    Some([low, high]) => pixel.map(|value| value.max(low).min(high)),
                    None => *pixel,
                };
            }
        }
        Ok(Pair { width, height, test, reference, is_counted })
    }

    /// Pixels in either image.
    pub fn n_pixels(&self) -> usize {
        self.test.len()
    }

    /// Pixels that are not finite in at least one image.
    pub fn n_masked(&self) -> usize {
        self.is_counted.iter().filter(|&&is_counted| !is_counted).count()
    }

    /// Mean squared error.
    pub fn mse(&self) -> f64 {
        self.mean(|a, b| (a - b) * (a - b))
    }

    /// Root of the mean squared error.
    pub fn rmse(&self) -> f64 {
        self.mse().sqrt()
    }

    /// Relative mean squared error.
    pub fn relmse(&self) -> f64 {
        self.mean(relative_squared)
    }

    /// Relative mean squared error without the 0.1 % of the pixels (rounded down) where it is largest.
    pub fn relmse_trimmed(&self) -> f64 {
        let pixels = self.test.iter().zip(&self.reference).zip(&self.is_counted);
        let counted = pixels.filter(|&(_, &is_counted)| is_counted).map(|(pair, _)| pair);
        let error = |a: &[f32; 3], b: &[f32; 3]| {
            (0..3).map(|c| relative_squared(a[c].into(), b[c].into())).sum::<f64>() / 3.0
        };
        let mut errors: Vec<f64> = counted.map(|(a, b)| error(a, b)).collect();
        errors.sort_by(f64::total_cmp);
        errors.truncate(errors.len() - (errors.len() as f64 * TRIMMED_SHARE) as usize);
        errors.iter().sum::<f64>() / errors.len() as f64
    }

    /// Mean absolute error relative to the reference.
    pub fn mape(&self) -> f64 {
        self.mean(|a, b| (a - b).abs() / (b.abs() + RELATIVE_OFFSET))
    }

    /// Mean absolute error relative to both.
    pub fn smape(&self) -> f64 {
        self.mean(|a, b| (a - b).abs() / (a.abs() + b.abs() + RELATIVE_OFFSET))
    }

    /// Peak signal-to-noise ratio in decibels, infinite for equal images.
    pub fn psnr_db(&self, peak: f32) -> f64 {
        10.0 * (f64::from(peak).powi(2) / self.mse()).log10()
    }

    /// Mean of each channel of the test image.
    pub fn mean_test(&self) -> [f64; 3] {
        std::array::from_fn(|channel| self.mean_of_map(self.test.iter().map(|pixel| &pixel[channel])))
    }

    /// Mean of each channel of the reference.
    pub fn mean_reference(&self) -> [f64; 3] {
        std::array::from_fn(|channel| self.mean_of_map(self.reference.iter().map(|pixel| &pixel[channel])))
    }

    /// Mean structural similarity of both images as a display shows them: exposed, clipped to [0, 1] and encoded as sRGB. Masked
    /// pixels are black in both where they are neighbours, and not in the mean.
    pub fn ssim(&self, exposure_ev: f32) -> f64 {
        let (test, reference) = (shown(&self.test, exposure_ev), shown(&self.reference, exposure_ev));
        let plane = |pixels: &[[f32; 3]], c: usize| -> Vec<f32> {
            pixels.iter().map(|pixel| srgb_encode(pixel[c])).collect()
        };
        let channel = |c| ssim::mean(&plane(&test, c), &plane(&reference, c), &self.is_counted, self.width);
        (channel(0) + channel(1) + channel(2)) / 3.0
    }

    /// FLIP's error of every pixel, 0 where masked; both images are exposed and clipped to [0, 1] first.
    pub fn flip_map(&self, pixels_per_degree: f32, exposure_ev: f32) -> Vec<f32> {
        let (test, reference) = (shown(&self.test, exposure_ev), shown(&self.reference, exposure_ev));
        self.masked(flip::error_map(&test, &reference, [self.width, self.height], pixels_per_degree))
    }

    /// HDR-FLIP's error of every pixel, 0 where masked; NaN where the reference is black, of which no exposure shows anything.
    pub fn hdr_flip_map(&self, pixels_per_degree: f32) -> Vec<f32> {
        let size = [self.width, self.height];
        self.masked(hdr_flip::error_map(&self.test, &self.reference, size, pixels_per_degree))
    }

    /// A map with 0 where pixels are masked.
    fn masked(&self, mut map: Vec<f32>) -> Vec<f32> {
        for (value, &is_counted) in map.iter_mut().zip(&self.is_counted) {
            *value = if is_counted { *value } else { 0.0 };
        }
        map
    }

    /// A picture of where the images differ.
    pub fn difference(&self, kind: DifferenceKind) -> DifferenceMap {
        let values = match kind {
            DifferenceKind::Flip { pixels_per_degree, exposure_ev } => {
                self.flip_map(pixels_per_degree, exposure_ev)
            }
            DifferenceKind::HdrFlip { pixels_per_degree } => self.hdr_flip_map(pixels_per_degree),
            _ => self.test.iter().zip(&self.reference).map(|(&a, &b)| kind.of_pixel(a, b)).collect(),
        };
        DifferenceMap { width: self.width, height: self.height, kind, values }
    }

    /// Mean of one value per pixel over the pixels that count.
    pub fn mean_of_map<'a>(&self, map: impl IntoIterator<Item = &'a f32>) -> f64 {
        let counted = map.into_iter().zip(&self.is_counted).filter(|&(_, &is_counted)| is_counted);
        let sum: f64 = counted.map(|(&value, _)| f64::from(value)).sum();
        sum / (self.n_pixels() - self.n_masked()) as f64
    }

    /// Mean of an error over the channels of the pixels that count.
    fn mean(&self, error: impl Fn(f64, f64) -> f64) -> f64 {
        let pixels = self.test.iter().zip(&self.reference).zip(&self.is_counted);
        let mut sum = 0.0;
        for ((test, reference), _) in pixels.filter(|&(_, &is_counted)| is_counted) {
            sum += (0..3).map(|c| error(f64::from(test[c]), f64::from(reference[c]))).sum::<f64>();
        }
        sum / (3 * (self.n_pixels() - self.n_masked())) as f64
    }
}

/// Error of a value relative to the reference, squared.
fn relative_squared(a: f64, b: f64) -> f64 {
    (a - b) * (a - b) / (b * b + RELATIVE_OFFSET)
}

/// Pixels at an exposure, clipped to [0, 1].
fn shown(pixels: &[[f32; 3]], exposure_ev: f32) -> Vec<[f32; 3]> {
    let exposure = exposure_ev.exp2();
    pixels.iter().map(|pixel| pixel.map(|value| (value * exposure).clamp(0.0, 1.0))).collect()
}

/// A ratio of means; 1 for two zeros.
fn ratio(test: f64, reference: f64) -> f64 {
    if test == reference { 1.0 } else { test / reference }
}

fn is_finite(pixel: &[f32; 3]) -> bool {
    pixel.iter().all(|value| value.is_finite())
}

fn count_non_finite(image: &Image) -> usize {
    image.rgb_pixels().map_or(0, |pixels| pixels.iter().filter(|pixel| !is_finite(pixel)).count())
}

#[cfg(test)]
mod tests;
