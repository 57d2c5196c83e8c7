//! Histogram adjustment (Larson, Rushmeier and Piatko 1997, "A Visibility Matching Tone Reproduction Operator for High Dynamic
//! Range Scenes"): common luminances get much of the display's range and rare ones little, but nowhere does the display show
//! more contrast than the world.
//!
//! The display's range, in logarithms, is shared out among bins of the world's luminances by their counts. A bin of width `w` may have
//! at most `w / ln(contrast)` of it, which is the contrast that it has in the world. The paper cuts counts above that ceiling
//! until the rest is within a tolerance, since each cut lowers the ceiling; here the shares are solved for, and nothing is above.

use crate::plane::Plane;

/// Parameters of histogram adjustment.
#[derive(Copy, Clone, Debug, PartialEq)]
pub struct HistogramAdjustment {
    /// Ratio of the display's white to its black, above 1.
    pub contrast: f32,
    /// Cells across the picture that count as one glance: the paper has one for each degree of view.
    pub glances: u32,
}

impl Default for HistogramAdjustment {
    fn default() -> Self {
        Self { contrast: 100.0, glances: 60 }
    }
}

const N_BINS: usize = 100;
/// What each bin has at least, as a share of all counts: so that range which no luminance may have goes to those between them.
const LEAST: f64 = 1e-6;

/// The curve: cumulative shares of bins of equal width in the logarithm of luminance.
#[derive(Clone, Debug)]
pub(super) struct AdjustedCurve {
    low: f32,
    bin_width: f32,
    /// Share of luminances below each bin's start, and 1 at the end.
    cumulative: Vec<f32>,
    log_contrast: f32,
    /// What the display adds to all that it shows, as a share of white.
    black: f32,
}

impl HistogramAdjustment {
    /// The curve for luminances given by their natural logarithms.
    pub(super) fn curve(&self, ln: &Plane) -> AdjustedCurve {
        let mut glances = ln.clone();
        while glances.width > 2 * self.glances as usize {
            glances = glances.halved();
        }
        let (low, high) = glances.range();
        let bin_width = ((high - low) / N_BINS as f32).max(1e-6);
        let mut counts = vec![LEAST * glances.values.len() as f64; N_BINS];
        for value in &glances.values {
            counts[(((value - low) / bin_width) as usize).min(N_BINS - 1)] += 1.0;
        }
        let world = bin_width * N_BINS as f32;
        let display = self.contrast.ln();
        // Where the world has less contrast than the display it is shown as it is.
        let (log_contrast, black) = if world <= display { (world, 0.0) } else { (display, (-display).exp()) };
        let mut sum = 0.0;
        let sums = shares(&counts, f64::from(bin_width / log_contrast)).into_iter().map(|share| {
            sum += share;
            sum as f32
        });
        let cumulative = [0.0].into_iter().chain(sums).collect();
        AdjustedCurve { low, bin_width, cumulative, log_contrast, black }
    }
}

/// Shares of 1 in proportion to positive counts but for those that would be above the ceiling, which are at it.
fn shares(counts: &[f64], ceiling: f64) -> Vec<f64> {
    let mut sorted = counts.to_vec();
    sorted.sort_by(f64::total_cmp);
    let (mut rest, mut total) = (1.0, counts.iter().sum::<f64>());
    // One is never at the ceiling, since all together have room for more than 1.
    for largest in sorted.iter().skip(1).rev() {
        if largest * rest <= ceiling * total {
            break;
        }
        rest -= ceiling;
        total -= largest;
    }
    counts.iter().map(|count| (count * rest / total).min(ceiling)).collect()
}

impl AdjustedCurve {
    /// Displayed luminance in [0, 1], without what the display adds.
    pub(super) fn map(&self, ln: f32) -> f32 {
        let at = ((ln - self.low) / self.bin_width).clamp(0.0, N_BINS as f32);
        let bin = (at as usize).min(N_BINS - 1);
        let share =
            self.cumulative[bin] + (self.cumulative[bin + 1] - self.cumulative[bin]) * (at - bin as f32);
        (((share - 1.0) * self.log_contrast).exp() - self.black) / (1.0 - self.black)
    }
}
