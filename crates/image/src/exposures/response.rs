//! What a camera makes of light.

use crate::Encoding;

use super::{Exposure, ExposureError};

/// Number of levels of a byte.
pub(super) const N_LEVELS: usize = 256;

/// Logarithm of the exposure (irradiance times time) that gives each level, by channel; known up to a factor.
#[derive(Clone, Debug, PartialEq)]
pub struct Response {
    ln_exposure: [Vec<f32>; 3],
}

/// Pixels that the response is recovered from.
const N_PIXELS: usize = 200;

/// Level whose exposure is 1.
const MIDDLE: usize = 128;

impl Response {
    /// The response of that encoding: exposure is what the encoding decodes to.
    #[must_use]
    pub fn of_encoding(encoding: Encoding) -> Self {
        let decode = |level: usize| {
            let value = (level.max(1)) as f32 / (N_LEVELS - 1) as f32;
            encoding.decode(value).ln()
        };
        let curve: Vec<f32> = (0..N_LEVELS).map(decode).collect();
        Self { ln_exposure: [curve.clone(), curve.clone(), curve] }
    }

    /// Logarithm of the exposure of a level.
    #[must_use]
    pub fn ln_exposure(&self, channel: usize, level: usize) -> f32 {
        self.ln_exposure[channel][level]
    }

    /// The response that explains exposures of a still scene best, smooth to a degree: the least-squares solution of
    /// `g(Z_ij) = ln E_i + ln t_j` over pixels i and exposures j, weighted by a hat over the levels, with
    /// `smoothness` times the second differences of g (Debevec and Malik (3)).
    ///
    /// # Errors
    /// If there are fewer than two exposures, all of one time, or if all pixels are black or white.
    pub fn recover(exposures: &[Exposure<'_>], smoothness: f32) -> Result<Self, ExposureError> {
        super::merge::check(exposures)?;
        let times: Vec<f64> = exposures.iter().map(|exposure| f64::from(exposure.seconds).ln()).collect();
        if times.iter().all(|time| (time - times[0]).abs() < 1e-6) {
            return Err(ExposureError::SameTimes);
        }
        let pixels = chosen_pixels(exposures);
        let channels =
            [0, 1, 2].map(|channel| recover_channel(exposures, &times, &pixels, channel, smoothness));
        Ok(Self { ln_exposure: channels })
    }
}

/// The level of an encoded value.
pub(super) fn level(value: f32) -> usize {
    (value.clamp(0.0, 1.0) * (N_LEVELS - 1) as f32).round() as usize
}

/// Weight of a level: least at both ends, where the camera clips.
pub(super) fn hat(level: usize) -> f32 {
    let n = N_LEVELS - 1;
    (level.min(n - level) as f32 + 1.0) / (n / 2 + 1) as f32
}

/// Pixels spread over all levels of the middle exposure, and over the picture.
fn chosen_pixels(exposures: &[Exposure<'_>]) -> Vec<usize> {
    let middle = exposures[exposures.len() / 2].pixels;
    let mut order: Vec<usize> = (0..middle.len()).collect();
    order.sort_by(|a, b| middle[*a][1].total_cmp(&middle[*b][1]).then(a.cmp(b)));
    let n = N_PIXELS.min(order.len());
    (0..n).map(|i| order[i * (order.len() - 1) / n.max(2).saturating_sub(1).max(1)]).collect()
}

/// Solves the normal equations, whose unknowns are the levels and then the pixels.
fn recover_channel(
    exposures: &[Exposure<'_>],
    times: &[f64],
    pixels: &[usize],
    channel: usize,
    smoothness: f32,
) -> Vec<f32> {
    let n = N_LEVELS + pixels.len();
    let mut normal = vec![0.0_f64; n * n];
    let mut right = vec![0.0_f64; n];
    // One equation: a sum of few unknowns, squared into the matrix.
    let mut add = |terms: &[(usize, f64)], value: f64| {
        for (i, a) in terms {
            for (j, b) in terms {
                normal[i * n + j] += a * b;
            }
            right[*i] += a * value;
        }
    };
    for (i, pixel) in pixels.iter().enumerate() {
        for (exposure, time) in exposures.iter().zip(times) {
            let z = level(exposure.pixels[*pixel][channel]);
            let weight = f64::from(hat(z));
            add(&[(z, weight), (N_LEVELS + i, -weight)], weight * time);
        }
    }
    for z in 1..N_LEVELS - 1 {
        let weight = f64::from(smoothness * hat(z));
        add(&[(z - 1, weight), (z, -2.0 * weight), (z + 1, weight)], 0.0);
    }
    add(&[(MIDDLE, 1.0)], 0.0);
    // Levels that no pixel has, and nothing but smoothness tells, stay near a line.
    for i in 0..n {
        normal[i * n + i] += 1e-9;
    }
    solve_positive(&mut normal, &mut right, n);
    right[..N_LEVELS].iter().map(|value| *value as f32).collect()
}

/// Solves a symmetric positive definite system in place, by Cholesky's factors.
fn solve_positive(a: &mut [f64], b: &mut [f64], n: usize) {
    for j in 0..n {
        let rest = &mut a[j * n..];
        let squares: f64 = rest[..j].iter().map(|v| v * v).sum();
        let diagonal = (rest[j] - squares).max(1e-300).sqrt();
        rest[j] = diagonal;
        let (row_j, below) = rest.split_at_mut(n);
        for row in below.chunks_mut(n) {
            let dot: f64 = row_j[..j].iter().zip(&row[..j]).map(|(x, y)| x * y).sum();
            row[j] = (row[j] - dot) / diagonal;
        }
    }
    for i in 0..n {
        let dot: f64 = (0..i).map(|k| a[i * n + k] * b[k]).sum();
        b[i] = (b[i] - dot) / a[i * n + i];
    }
    for i in (0..n).rev() {
        let dot: f64 = (i + 1..n).map(|k| a[k * n + i] * b[k]).sum();
        b[i] = (b[i] - dot) / a[i * n + i];
    }
}
