//! Dodging and burning: the local photographic operator (Reinhard, Stark, Shirley and Ferwerda 2002, "Photographic Tone
//! Reproduction for Digital Images", section 3.2; SPEC TONE-6).
//!
//! Each pixel is compared with the mean over the largest surrounding that has no strong contrast:
//!
//! ```text
//! V_i(s)  = blur of L_s by a Gaussian of scale s,  centre V_1 and surround V_2 of 1.6 times the size
//! c(s)    = |V_1 - V_2| / (2^phi a / s^2 + V_1),   the largest of it within the surround
//! s_m     = the largest s up to which c(s) < epsilon
//! L_d     = L_s / (1 + V_1(s_m)),   V_1 = L_s where the smallest surrounding has contrast already
//! ```
//!
//! The paper asks for the contrast of the pixel alone. But `V_1 - V_2` is near a second derivative: it changes its sign at an edge, so
//! pixels at the edge see little of it at any scale, take means over both sides and get halos (up to 18 % of a step of half a decade).
//! A few pixels away it is largest, hence the look around: it tells edges from texture. With `phi` 1 and `epsilon` 0.12 edges of half a
//! decade and more keep below 3 %, and texture of a ratio of 1.3 stays as it is.

use crate::plane::Plane;

/// Parameters of the local photographic operator.
#[derive(Copy, Clone, Debug, PartialEq)]
pub struct ReinhardLocal {
    /// Scaled luminance given to the log-average pixel, a in the paper.
    pub key: f32,
    /// Sharpness phi: how much of contrast small surroundings may have, where the picture is not bright. 8 in the paper.
    pub sharpness: f32,
    /// Contrast epsilon that ends a surrounding; 0.05 in the paper.
    pub threshold: f32,
    /// How many sizes of surroundings are tried, each 1.6 times the last, from one pixel on.
    pub n_scales: u32,
}

impl Default for ReinhardLocal {
    fn default() -> Self {
        Self { key: 0.18, sharpness: 1.0, threshold: 0.12, n_scales: 8 }
    }
}

/// Size of the surround over that of the centre, and of a scale over the one before.
const RATIO: f32 = 1.6;
/// Standard deviation of a centre over its scale: `alpha_1 / sqrt(2)` with `alpha_1 = 1 / (2 sqrt(2))`.
const CENTER_SIGMA: f32 = 0.25;
/// How far to look for contrast, in standard deviations of the surround. It is largest at 0.78 of them from an edge. A pixel on the other
/// side that just does not see that has 2.5 % of its centre beyond the edge.
const REACH: f32 = 2.0;

impl ReinhardLocal {
    /// Displayed luminance of each pixel, of luminances scaled so that the log-average pixel has the key.
    pub(super) fn map(&self, scaled: &Plane) -> Plane {
        // No surrounding at all: the pixel itself.
        let mut adapted = scaled.clone();
        let mut center = scaled.blurred(CENTER_SIGMA);
        let mut is_open = vec![true; scaled.values.len()];
        let mut scale = 1.0;
        for _ in 0..self.n_scales {
            let sigma = CENTER_SIGMA * RATIO * scale;
            let surround = scaled.blurred(sigma);
            let floor = self.sharpness.exp2() * self.key / (scale * scale);
            let contrast = center.zip(&surround, |v1, v2| (v1 - v2).abs() / (floor + v1));
            let contrast = contrast.largest_around((REACH * sigma).ceil() as usize);
            for (i, open) in is_open.iter_mut().enumerate() {
                *open &= contrast.values[i] < self.threshold;
                if *open {
                    adapted.values[i] = center.values[i];
                }
            }
            // The surround of a scale is the centre of the next.
            center = surround;
            scale *= RATIO;
        }
        let shown = scaled.values.iter().zip(&adapted.values).map(|(l, v)| l / (1.0 + v));
        Plane::new(scaled.width, scaled.height, shown.collect())
    }
}
