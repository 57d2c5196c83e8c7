//! HDR-FLIP: the largest LDR-FLIP error over all exposures at which something of the reference can be seen.
//!
//! Andersson, Nilsson, Shirley and Akenine-Möller 2021, "Visualizing Errors in Rendered High Dynamic Range Images", Eurographics
//! Short Papers, doi 10.2312/egs.20211015. The first exposure shows the brightest pixel of the reference at 0.85 of the display's
//! white, the last the median; in between they are one stop apart or less. The curve is a fit to ACES (Narkowicz 2015).

use crate::luminance;

use super::flip;

/// Coefficients of the curve `(k0 x^2 + k1 x + k2) / (k3 x^2 + k4 x + k5)`, its exposure of 0.6 included.
const CURVE: [f64; 6] = [0.6 * 0.6 * 2.51, 0.6 * 0.03, 0.0, 0.6 * 0.6 * 2.43, 0.6 * 0.59, 0.14];
/// What the curve makes of the brightest pixel at the first exposure and of the median at the last, called t in the paper.
const SHOWN: f64 = 0.85;

/// Exposures in stops for a reference in linear RGB; those of its finite pixels. None where all is black: nothing can be seen.
#[must_use]
pub fn exposures(reference: &[[f32; 3]]) -> Vec<f64> {
    let mut luminances: Vec<f32> = reference.iter().map(|pixel| luminance(*pixel)).collect();
    if luminances.is_empty() {
        return Vec::new();
    }
    let middle = luminances.len() / 2;
    luminances.sort_by(f32::total_cmp);
    let largest = f64::from(luminances[luminances.len() - 1]);
    if largest <= 0.0 {
        return Vec::new();
    }
    let median = f64::from(luminances[middle].max(f32::EPSILON));
    let shown = inverse_curve(SHOWN);
    let (start, stop) = ((shown / largest).log2(), (shown / median).log2());
    let (start, stop) = (start.min(stop), start.max(stop));
    let n = ((stop - start).ceil() as usize).max(2);
    (0..n).map(|i| start + (stop - start) * i as f64 / (n - 1) as f64).collect()
}

/// Error in [0, 1] of each pixel of two pictures in linear RGB; NaN where there is no exposure.
///
/// # Panics
/// When the lengths are not `width * height` or `pixels_per_degree` is not positive.
#[must_use]
pub fn error_map(
    test: &[[f32; 3]],
    reference: &[[f32; 3]],
    size: [usize; 2],
    pixels_per_degree: f32,
) -> Vec<f32> {
    let exposures = exposures(reference);
    if exposures.is_empty() {
        return vec![f32::NAN; reference.len()];
    }
    let mut largest = vec![0.0f32; reference.len()];
    for stops in exposures {
        let (test, reference) = (shown(test, stops), shown(reference, stops));
        let map = flip::error_map(&test, &reference, size, pixels_per_degree);
        largest.iter_mut().zip(map).for_each(|(largest, error)| *largest = largest.max(error));
    }
    largest
}

/// A picture as the display shows it at an exposure.
fn shown(pixels: &[[f32; 3]], stops: f64) -> Vec<[f32; 3]> {
    let factor = stops.exp2();
    let [k0, k1, k2, k3, k4, k5] = CURVE;
    let curve = |value: f32| {
        // Beyond, the curve is flat in single precision, and squares stay finite.
        let x = (f64::from(value) * factor).clamp(0.0, 1e12);
        ((k0 * x * x + k1 * x + k2) / (k3 * x * x + k4 * x + k5)).clamp(0.0, 1.0) as f32
    };
    pixels.iter().map(|pixel| pixel.map(curve)).collect()
}

/// The value that the curve takes to `y`.
fn inverse_curve(y: f64) -> f64 {
    let [k0, k1, k2, k3, k4, k5] = CURVE;
    let (a, b, c) = (k0 - y * k3, k1 - y * k4, k2 - y * k5);
    let half = -0.5 * b / a;
    half + (half * half - c / a).sqrt()
}
