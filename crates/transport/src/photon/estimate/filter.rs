//! Filters: photons near the middle count more, so that edges of caustics blur less (SPEC EST-8, EST-9).
//!
//! A weight `w(t)` depends on the distance over the radius, `t = d / r`. Sums are divided by the area times the mean of the
//! weight over it, so that a uniform field comes out exactly, whatever the filter. Over a disc, or any area that grows with
//! `t^2`, the mean is `2 ∫ w(t) t dt`.
//!
//! - Cone (Jensen 1996, "Global Illumination using Photon Maps"): `w = 1 - t / k`, mean `1 - 2 / (3 k)`, `k >= 1`.
//! - Gaussian (Pavičić 1990, "Convenient Anti-Aliasing Filters that Minimize Bumpy Sampling"):
//!   `w = 1 - (1 - e^(-b t^2)) / (1 - e^(-beta))`, mean `1 - (1 - (1 - e^-b) / b) / (1 - e^(-beta))`. Pavičić has `b = beta`, and
//!   `w` falls to 0 at the rim. Jensen's book prints `b = beta / 2`, which leaves a step there. Pavičić's factor
//!   `alpha = 0.918` makes his integral over the unit disc 1; Jensen's sum, with the same factor and nothing to divide by, loses
//!   47 % of the light. Here the mean is divided by, and `alpha` cancels.

use etendue_math::approx;

/// How a photon's weight falls with its distance.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub enum Filter {
    /// All photons count alike.
    #[default]
    Constant,
    /// Falls in a straight line.
    Cone {
        /// Distance over radius at which the line meets 0, at least 1.
        k: f32,
    },
    /// A Gaussian that is shifted to end near 0.
    Gaussian {
        /// Decay at the rim, `beta` of the paper; positive.
        beta: f32,
        /// Decay in the exponent: `beta` to end at 0, or half of it as in the book; positive.
        inner: f32,
    },
}

impl Filter {
    /// Jensen's constant of the cone.
    pub const CONE_K: f32 = 1.1;
    /// Pavičić's constant of the Gaussian.
    pub const BETA: f32 = 1.953;
    /// Jensen's cone.
    pub const CONE: Self = Self::Cone { k: Self::CONE_K };
    /// Pavičić's Gaussian.
    pub const GAUSSIAN: Self = Self::Gaussian { beta: Self::BETA, inner: Self::BETA };
    /// The Gaussian as Jensen's book prints it.
    pub const BOOK_GAUSSIAN: Self = Self::Gaussian { beta: Self::BETA, inner: Self::BETA / 2.0 };

    /// Weight at the squared distance over the squared radius, in [0, 1].
    #[inline]
    #[must_use]
    pub fn weight(self, t_squared: f32) -> f32 {
        match self {
            Self::Constant => 1.0,
            Self::Cone { k } => 1.0 - t_squared.sqrt() / k, // [EST-8]
            Self::Gaussian { beta, inner } => {
                1.0 - (1.0 - approx::exp(-inner * t_squared)) / (1.0 - approx::exp(-beta)) // [EST-9]
            }
        }
    }

    /// Mean of the weight over the disc of this squared radius, in terms of the whole one.
    #[inline]
    #[must_use]
    pub fn mean(self, t_squared: f32) -> f32 {
        match self {
            Self::Constant => 1.0,
            Self::Cone { k } => 1.0 - 2.0 / 3.0 * t_squared.sqrt() / k,
            Self::Gaussian { beta, inner } => {
                let b = inner * t_squared;
                // (1 - (1 - e^-b) / b) = b/2 - b^2/6 + ...; the difference would cancel for small b.
                let rise = if b < 0.02 {
                    b * (0.5 - b * (1.0 / 6.0 - b / 24.0))
                } else {
                    1.0 - (1.0 - approx::exp(-b)) / b
                };
                1.0 - rise / (1.0 - approx::exp(-beta))
            }
        }
    }
}
