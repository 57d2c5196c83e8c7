//! N_p: how a rough fibre spreads light about itself.
//!
//! The logistic distribution `exp(-x / s) / (s (1 + exp(-x / s))²)` about where a smooth fibre sends light, cut off at
//! half a turn to both sides (Chiang et al. 2016, section 4.2).

use std::f32::consts::{PI, TAU};

use etendue_math::approx::{exp, ln};
use etendue_math::sqr;

/// A logistic distribution over (-π, π].
#[derive(Clone, Copy, Debug)]
pub(super) struct TrimmedLogistic {
    s: f32,
    /// The part that is cut off at one side.
    cut: f32,
}

impl TrimmedLogistic {
    pub(super) fn new(s: f32) -> Self {
        let tail = exp(-PI / s);
        Self { s, cut: tail / (1.0 + tail) }
    }

    /// Density at an angle, whole turns of which do not matter.
    pub(super) fn density(self, angle: f32) -> f32 {
        let x = angle - TAU * (angle / TAU).round();
        let tail = exp(-x.abs() / self.s);
        tail / (self.s * sqr(1.0 + tail) * (1.0 - 2.0 * self.cut))
    }

    pub(super) fn sample(self, u: f32) -> f32 {
        let below = self.cut + u * (1.0 - 2.0 * self.cut);
        (-self.s * ln(1.0 / below - 1.0)).clamp(-PI, PI)
    }
}
