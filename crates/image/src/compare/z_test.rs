//! Do two noisy pictures show the same? Asked of pictures that tell the variance of each pixel's mean.
//!
//! With luminances a and b of variances v_a and v_b, `z = (a - b) / sqrt(v_a + v_b)` follows the standard normal distribution if both
//! estimate the same value from many samples: its root mean square is 1, and 0.27 % of the pixels lie beyond 3. Few samples give
//! heavier tails, since variances are estimates too. The sum over all pixels shows a bias that no single pixel does:
//! `z_mean = sum (a - b) / sqrt(sum (v_a + v_b))`.
//!
//! A plane of variances without a positive one is no estimate, as after one sample per pixel, and nothing is tested. Beside others a variance
//! of 0 says that all samples were equal: such a pixel is tested by the variance of the other picture, for left out it would be chosen
//! by its value (a pixel that no light has reached yet), and bias `z_mean`.

use super::CompareError;
use crate::Image;

/// The channel with the variance of the luminance of each pixel's mean.
pub const VARIANCE: &str = "variance.Y";
/// Metadata key for the luminances of red, green and blue.
const LUMINANCE: &str = "etendue.luminance";
/// Deviations of a pixel beyond this many standard errors are counted.
pub const BEYOND: f64 = 3.0;

/// What the test found.
#[derive(Clone, Debug, PartialEq)]
pub struct ZTest {
    /// Pixels with a variance in either picture, those that are tested; none where one picture has variances of 0 alone.
    pub n_tested: usize,
    /// Pixels that differ but are not tested, since there is no variance.
    pub n_untested: usize,
    /// Root mean square of z; 1 is expected. NaN, as all that follow, where no pixel is tested.
    pub rms: f64,
    /// Share of the pixels beyond [`BEYOND`]; 0.0027 is expected.
    pub share_beyond: f64,
    /// z of the mean of the picture.
    pub z_mean: f64,
    /// Probability of a `z_mean` as far from 0 or farther.
    pub p_mean: f64,
    /// z of every pixel, 0 where there is no variance or a value is not finite.
    pub z: Vec<f32>,
}

impl ZTest {
    /// Tests two pictures; `None` if one does not tell its variance.
    ///
    /// # Errors
    /// When the sizes differ or an image has no colour.
    pub fn new(test: &Image, reference: &Image) -> Result<Option<ZTest>, CompareError> {
        if [test.width, test.height] != [reference.width, reference.height] {
            let [test, reference] = [test, reference].map(|image| [image.width, image.height]);
            return Err(CompareError::SizesDiffer { test, reference });
        }
        let (Some(va), Some(vb)) = (test.channel(VARIANCE), reference.channel(VARIANCE)) else {
            return Ok(None);
        };
        let (Some(a), Some(b)) = (luminances(test), luminances(reference)) else {
            return Err(CompareError::NoColor);
        };
        let is_estimate = |v: &f32| *v > 0.0 && v.is_finite();
        let have_estimates = [va, vb].iter().all(|plane| plane.values.iter().any(is_estimate));
        let [rms, share_beyond, z_mean, p_mean] = [f64::NAN; 4];
        let mut result =
            ZTest { n_tested: 0, n_untested: 0, rms, share_beyond, z_mean, p_mean, z: Vec::new() };
        let (mut squares, mut n_beyond, mut difference, mut variance) = (0.0, 0usize, 0.0, 0.0);
        for ((a, b), (va, vb)) in a.into_iter().zip(b).zip(va.values.iter().zip(&vb.values)) {
            let v = f64::from(*va) + f64::from(*vb);
            let z = (a - b) / v.sqrt();
            let is_tested = have_estimates && v > 0.0 && v.is_finite() && z.is_finite();
            result.z.push(if is_tested { z as f32 } else { 0.0 });
            if is_tested {
                result.n_tested += 1;
                squares += z * z;
                n_beyond += usize::from(z.abs() > BEYOND);
                difference += a - b;
                variance += v;
            } else if a.is_finite() && b.is_finite() && a != b {
                result.n_untested += 1;
            }
        }
        if result.n_tested > 0 {
            result.rms = (squares / result.n_tested as f64).sqrt();
            result.share_beyond = n_beyond as f64 / result.n_tested as f64;
            result.z_mean = difference / variance.sqrt();
            result.p_mean = two_sided(result.z_mean);
        }
        Ok(Some(result))
    }
}

/// Luminances by the weights that the picture states, else by those of Rec. 709.
fn luminances(image: &Image) -> Option<Vec<f64>> {
    let stated = image.metadata.get(LUMINANCE).and_then(|text| {
        let numbers: Option<Vec<f64>> = text.split_whitespace().map(|number| number.parse().ok()).collect();
        <[f64; 3]>::try_from(numbers?).ok()
    });
    let weights = stated.unwrap_or([0.2126, 0.7152, 0.0722]);
    let weigh =
        |pixel: [f32; 3]| pixel.iter().zip(weights).map(|(value, weight)| f64::from(*value) * weight).sum();
    Some(image.rgb_pixels()?.into_iter().map(weigh).collect())
}

/// Probability that a standard normal number is as far from 0 as z: `erfc(|z| / sqrt 2)` by Abramowitz and Stegun 1964, 7.1.26,
/// with an error below 1.5e-7.
fn two_sided(z: f64) -> f64 {
    let x = z.abs() / f64::sqrt(2.0);
    let t = 1.0 / (1.0 + 0.327_591_1 * x);
    let polynomial = t
        * (0.254_829_592
            + t * (-0.284_496_736 + t * (1.421_413_741 + t * (-1.453_152_027 + t * 1.061_405_429))));
    (polynomial * (-x * x).exp()).clamp(0.0, 1.0)
}
