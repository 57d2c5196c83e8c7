//! Dodging and burning: the local photographic operator (Reinhard, Stark, Shirley and Ferwerda 2002, "Photographic Tone
//! Reproduction for Digital Images", section 3.2; SPEC TONE-6).
//!
//! Each pixel is compared with the mean over the largest surrounding that has no strong contrast:
//!
//! ```text
//! V_i(s)  = blur of L_s by a Gaussian of scale s,  centre V_1 and surround V_2 of 1.6 times the size
//! s_m     = the largest s up to which |V_1 - V_2| / (2^phi a / s^2 + V_1) < epsilon
//! L_d     = L_s / (1 + V_1(s_m))
//! ```

use crate::plane::Plane;

/// Parameters of the local photographic operator.
#[derive(Copy, Clone, Debug, PartialEq)]
pub struct ReinhardLocal {
    /// Scaled luminance given to the log-average pixel, a in the paper.
    pub key: f32,
    /// Sharpness phi: how little contrast ends a small surrounding. The paper has 8, which leaves halos of up to 13 % of a step
    /// in the logarithm; less leaves less of them, and less of texture where the picture is bright.
    pub sharpness: f32,
    /// Contrast epsilon that ends a surrounding.
    pub threshold: f32,
    /// How many sizes of surroundings are tried, each 1.6 times the last, from one pixel on.
    pub n_scales: u32,
}

impl Default for ReinhardLocal {
    fn default() -> Self {
        Self { key: 0.18, sharpness: 4.75, threshold: 0.05, n_scales: 8 }
    }
}

/// Size of the surround over that of the centre, and of a scale over the one before.
const RATIO: f32 = 1.6;
/// Standard deviation of a centre over its scale: `alpha_1 / sqrt(2)` with `alpha_1 = 1 / (2 sqrt(2))`.
const CENTER_SIGMA: f32 = 0.25;

impl ReinhardLocal {
    /// Displayed luminance of each pixel, of luminances scaled so that the log-average pixel has the key.
    pub(super) fn map(&self, scaled: &Plane) -> Plane {
        let mut adapted = scaled.blurred(CENTER_SIGMA);
        let mut center = adapted.clone();
        let mut is_open = vec![true; scaled.values.len()];
        let mut scale = 1.0;
        for _ in 0..self.n_scales {
            let surround = scaled.blurred(CENTER_SIGMA * RATIO * scale);
            let floor = self.sharpness.exp2() * self.key / (scale * scale);
            for (i, open) in is_open.iter_mut().enumerate().filter(|(_, open)| **open) {
                let (v1, v2) = (center.values[i], surround.values[i]);
                if (v1 - v2).abs() / (floor + v1) < self.threshold {
                    adapted.values[i] = v1;
                } else {
                    *open = false;
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
