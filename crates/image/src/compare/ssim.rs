//! Structural similarity: how alike two pictures are in mean, contrast and structure around each pixel.
//!
//! Wang, Bovik, Sheikh and Simoncelli 2004, "Image Quality Assessment: From Error Visibility to Structural Similarity", IEEE Trans.
//! Image Processing 13(4), doi 10.1109/TIP.2003.819861. In a Gaussian window with standard deviation 1.5 pixels and 11 pixels wide,
//!
//! ```text
//! SSIM = (2 m_a m_b + C1) (2 s_ab + C2) / ((m_a^2 + m_b^2 + C1) (s_a^2 + s_b^2 + C2)),   C1 = 0.01^2, C2 = 0.03^2
//! ```
//!
//! of values in [0, 1] as a display gets them. The mean is over the pixels that count and whose window lies in the picture.

use rayon::prelude::*;

use super::flip::convolve;

/// Standard deviation of the window in pixels.
const DEVIATION: f64 = 1.5;
/// Pixels from the centre of the window to its edge.
const RADIUS: usize = 5;
/// Constants that keep the quotients finite, for a range of values of 1.
const C1: f64 = 0.01 * 0.01;
const C2: f64 = 0.03 * 0.03;

/// Mean similarity of two planes of `width` values in a row, NaN where no pixel counts. Where no window lies in the picture, borders
/// are repeated.
pub(super) fn mean(test: &[f32], reference: &[f32], is_counted: &[bool], width: usize) -> f64 {
    let height = test.len() / width;
    let gaussian = |k: usize| {
        let x = k as f64 - RADIUS as f64;
        (-x * x / (2.0 * DEVIATION * DEVIATION)).exp()
    };
    let total: f64 = (0..=2 * RADIUS).map(gaussian).sum();
    let window: Vec<f64> = (0..=2 * RADIUS).map(|k| gaussian(k) / total).collect();
    let blurred = |f: &(dyn Fn(f32, f32) -> f32 + Sync)| {
        let plane: Vec<f32> = test.par_iter().zip(reference).map(|(&a, &b)| f(a, b)).collect();
        convolve(&plane, width, &window, &window)
    };
    let means = [blurred(&|a, _| a), blurred(&|_, b| b)];
    let squares = [blurred(&|a, _| a * a), blurred(&|_, b| b * b), blurred(&|a, b| a * b)];
    let similarity = |index: usize| {
        let [a, b] = [0, 1].map(|i| f64::from(means[i][index]));
        let [aa, bb, ab] = [0, 1, 2].map(|i| f64::from(squares[i][index]));
        let [va, vb, covariance] = [aa - a * a, bb - b * b, ab - a * b];
        (2.0 * a * b + C1) * (2.0 * covariance + C2) / ((a * a + b * b + C1) * (va + vb + C2))
    };
    let margin = if width.min(height) > 2 * RADIUS { RADIUS } else { 0 };
    let rows = margin..height - margin;
    let sums: Vec<(f64, usize)> = rows
        .into_par_iter()
        .map(|y| {
            let pixels = (margin..width - margin).map(|x| y * width + x).filter(|index| is_counted[*index]);
            pixels.fold((0.0, 0), |(sum, n), index| (sum + similarity(index), n + 1))
        })
        .collect();
    let (sum, n) = sums.into_iter().fold((0.0, 0), |(sum, n), row| (sum + row.0, n + row.1));
    sum / n as f64
}
