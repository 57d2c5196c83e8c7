//! Histogram adjustment (Larson, Rushmeier and Piatko 1997, "A Visibility Matching Tone Reproduction Operator for High Dynamic
//! Range Scenes"): common luminances get much of the display's range and rare ones little, but nowhere does the display show
//! more contrast than the world.

use crate::plane::Plane;

/// Parameters of histogram adjustment.
#[derive(Copy, Clone, Debug, PartialEq)]
pub struct HistogramAdjustment {
    /// Ratio of the display's white to its black.
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
/// Trimming ends when so small a share of the counts is left above the ceiling.
const TOLERANCE: f32 = 0.025;
/// Rounds of trimming; each removes what is above the ceiling, which lowers the ceiling.
const MAX_ROUNDS: usize = 100;

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
        let mut counts = vec![0.0_f32; N_BINS];
        for value in &glances.values {
            counts[(((value - low) / bin_width) as usize).min(N_BINS - 1)] += 1.0;
        }
        let log_contrast = self.contrast.ln();
        let fits = trim(&mut counts, bin_width / log_contrast);
        let total: f32 = counts.iter().sum();
        let mut cumulative = vec![0.0];
        for (bin, count) in counts.iter().enumerate() {
            let share = if fits || total == 0.0 { 1.0 / N_BINS as f32 } else { count / total };
            cumulative.push(cumulative[bin] + share);
        }
        if fits {
            // The world has less contrast than the display, and is shown as it is.
            let log_contrast = bin_width * N_BINS as f32;
            return AdjustedCurve { low, bin_width, cumulative, log_contrast, black: 0.0 };
        }
        AdjustedCurve { low, bin_width, cumulative, log_contrast, black: (-log_contrast).exp() }
    }
}

/// Cuts counts that would show more contrast than there is: a bin may hold at most the total times its width over the
/// display's range, both in logarithms. True if nothing is left, since all of the world fits the display.
fn trim(counts: &mut [f32], ceiling_share: f32) -> bool {
    let all: f32 = counts.iter().sum();
    for _ in 0..MAX_ROUNDS {
        let total: f32 = counts.iter().sum();
        if total < TOLERANCE * all || ceiling_share * counts.len() as f32 <= 1.0 {
            return true;
        }
        let ceiling = total * ceiling_share;
        let mut trimmed = 0.0;
        for count in counts.iter_mut().filter(|count| **count > ceiling) {
            trimmed += *count - ceiling;
            *count = ceiling;
        }
        if trimmed <= TOLERANCE * all {
            return false;
        }
    }
    false
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
