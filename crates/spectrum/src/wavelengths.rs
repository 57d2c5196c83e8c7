//! Choice of the wavelengths that a path carries.
//!
//! Hero wavelength sampling: one random number chooses the first wavelength, the others follow at equal steps of the
//! random number, wrapped around (Wilkie, Nawaz, Droske, Weidlich and Hanika 2014, "Hero Wavelength Spectral
//! Sampling", doi:10.1111/cgf.12419). Each wavelength is by itself distributed with the stated density, so a mean of
//! four quotients value / density estimates an integral over wavelength.
//!
//! The density of [`Wavelengths::sample_visible`] follows roughly the sum of the colour-matching functions,
//! p(λ) = 0.0039398042 / cosh²(0.0072 (λ − 538)) per nm on 360–830 nm (Radziszewski, Boryczko and Alda 2009,
//! "An improved technique for full spectral rendering"; constants refitted as in Pharr, Jakob and Humphreys, PBRT 4).
//!
//! A path may carry the three bands of [`Bands`] instead. They are rotated as wavelengths are: a random band comes first,
//! and it is the one that stays where dispersion parts them, which gives each band its own index of refraction without
//! bias. The fourth place holds the mean of the three, so that maxima and means over the places are sound; it has
//! density 0.

use etendue_math::approx::ln;

use crate::{Bands, LAMBDA_MAX_NM, LAMBDA_MIN_NM, N_LAMBDA, Sampled};

/// Number of bands.
const N_BANDS: usize = 3;
/// Wavelengths in nm of the hues of the primaries of sRGB: red, green and blue.
const DOMINANT_NM: [f32; N_BANDS] = [611.4, 549.1, 464.2];

/// The wavelengths of a path, in nm, and the density of each, per nm; or its bands.
#[derive(Copy, Clone, Debug, PartialEq)]
pub struct Wavelengths {
    lambda_nm: [f32; N_LAMBDA],
    pdf: [f32; N_LAMBDA],
    /// The band in the first place, if the path carries bands.
    first_band: Option<Band>,
}

/// One of three bands.
#[derive(Copy, Clone, Debug, PartialEq, Eq)]
enum Band {
    Red,
    Green,
    Blue,
}

impl Band {
    const ALL: [Self; N_BANDS] = [Self::Red, Self::Green, Self::Blue];

    /// Values of red, green and blue, with those of this band first, in cyclic order.
    #[inline]
    const fn rotate(self, [r, g, b]: [f32; N_BANDS]) -> [f32; N_BANDS] {
        match self {
            Self::Red => [r, g, b],
            Self::Green => [g, b, r],
            Self::Blue => [b, r, g],
        }
    }

    /// Reverses [`Self::rotate`].
    #[inline]
    const fn rotate_back(self, [x, y, z]: [f32; N_BANDS]) -> [f32; N_BANDS] {
        match self {
            Self::Red => [x, y, z],
            Self::Green => [z, x, y],
            Self::Blue => [y, z, x],
        }
    }
}

impl Wavelengths {
    /// Wavelengths for a random number in [0, 1), denser where the eye sees more.
    #[inline]
    #[must_use]
    pub fn sample_visible(u: f32) -> Self {
        let tanh = rotated(u).map(|u| 0.856_910_62 - 1.827_501_97 * u);
        // The inverse of the distribution, with artanh(t) = ln((1 + t) / (1 - t)) / 2.
        // Loops become instructions on four numbers, which `map` does not.
        let (mut lambda_nm, mut pdf) = ([0.0; N_LAMBDA], [0.0; N_LAMBDA]);
        for i in 0..N_LAMBDA {
            lambda_nm[i] = 538.0 - 0.5 * 138.888_889 * ln((1.0 + tanh[i]) / (1.0 - tanh[i]));
        }
        for i in 0..N_LAMBDA {
            lambda_nm[i] = lambda_nm[i].clamp(LAMBDA_MIN_NM, LAMBDA_MAX_NM);
            // 1 / cosh^2 = 1 - tanh^2.
            pdf[i] = 0.003_939_804_2 * (1.0 - tanh[i] * tanh[i]);
        }
        Self { lambda_nm, pdf, first_band: None }
    }

    /// Wavelengths for a random number in [0, 1), equally dense everywhere.
    #[inline]
    #[must_use]
    pub fn sample_uniform(u: f32) -> Self {
        let span = LAMBDA_MAX_NM - LAMBDA_MIN_NM;
        Self {
            lambda_nm: rotated(u).map(|v| (LAMBDA_MIN_NM + v * span).min(LAMBDA_MAX_NM)),
            pdf: [1.0 / span; N_LAMBDA],
            first_band: None,
        }
    }

    /// One uniformly distributed wavelength in all places, the naive way: the others carry nothing.
    #[inline]
    #[must_use]
    pub fn sample_single(u: f32) -> Self {
        let span = LAMBDA_MAX_NM - LAMBDA_MIN_NM;
        let lambda = (LAMBDA_MIN_NM + u * span).min(LAMBDA_MAX_NM);
        let mut wavelengths = Self::from_parts([lambda; N_LAMBDA], [1.0 / span; N_LAMBDA]);
        wavelengths.terminate_secondary();
        wavelengths
    }

    /// Given wavelengths in nm, with their densities per nm.
    #[inline]
    #[must_use]
    pub const fn from_parts(lambda_nm: [f32; N_LAMBDA], pdf: [f32; N_LAMBDA]) -> Self {
        Self { lambda_nm, pdf, first_band: None }
    }

    /// The three bands; the random number in [0, 1) chooses the one that dispersion leaves.
    #[inline]
    #[must_use]
    pub fn bands(u: f32) -> Self {
        let first = Band::ALL[((u * N_BANDS as f32) as usize).min(N_BANDS - 1)];
        let [a, b, c] = first.rotate(DOMINANT_NM);
        Self { lambda_nm: [a, b, c, DOMINANT_NM[1]], pdf: [1.0, 1.0, 1.0, 0.0], first_band: Some(first) }
    }

    /// Whether the path carries bands.
    #[inline]
    #[must_use]
    pub const fn is_bands(&self) -> bool {
        self.first_band.is_some()
    }

    /// Values of the bands in the order of the path; at wavelengths, where bands say nothing, 0.
    #[inline]
    #[must_use]
    pub fn of_bands(&self, bands: Bands) -> Sampled {
        let Some(first) = self.first_band else { return Sampled::ZERO };
        let [a, b, c] = first.rotate(bands.rgb());
        Sampled::from_array([a, b, c, (a + b + c) * (1.0 / 3.0)])
    }

    /// An estimate of red, green and blue from the values of a path that carries bands; `None` if it carries wavelengths.
    #[inline]
    #[must_use]
    pub fn estimate_bands(&self, l: Sampled) -> Option<[f32; 3]> {
        let first = self.first_band?;
        let [a, b, c, _] = l.safe_div(self.pdf()).to_array();
        Some(first.rotate_back([a, b, c]))
    }

    /// The wavelengths, in nm; for bands those of the hues of red, green and blue.
    #[inline]
    #[must_use]
    pub const fn lambda_nm(&self) -> [f32; N_LAMBDA] {
        self.lambda_nm
    }

    /// The densities, per nm; 0 for a wavelength that carries nothing any more. For bands probabilities.
    #[inline]
    #[must_use]
    pub const fn pdf(&self) -> Sampled {
        Sampled::from_array(self.pdf)
    }

    /// Drops all wavelengths or bands but the first, because the path now depends on the first alone (dispersion).
    ///
    /// The density of the first is divided by their number, since means still divide by it. Does nothing when
    /// already done.
    #[inline]
    pub fn terminate_secondary(&mut self) {
        if self.secondary_terminated() {
            return;
        }
        let n = if self.is_bands() { N_BANDS } else { N_LAMBDA };
        let pdf = self.pdf[0] / n as f32;
        self.pdf = [0.0; N_LAMBDA];
        self.pdf[0] = pdf;
    }

    /// Whether only the first wavelength or band still carries light.
    #[inline]
    #[must_use]
    pub fn secondary_terminated(&self) -> bool {
        self.pdf[1..].iter().all(|&p| p == 0.0)
    }
}

/// The random number and its copies at equal steps, wrapped into [0, 1).
#[inline]
fn rotated(u: f32) -> [f32; N_LAMBDA] {
    debug_assert!((0.0..1.0).contains(&u), "random number {u}");
    std::array::from_fn(|i| {
        let v = u + i as f32 / N_LAMBDA as f32;
        if v >= 1.0 { v - 1.0 } else { v }
    })
}
