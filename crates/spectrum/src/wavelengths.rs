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

use crate::{LAMBDA_MAX_NM, LAMBDA_MIN_NM, N_LAMBDA, Sampled};

/// The wavelengths of a path, in nm, and the density of each, per nm.
#[derive(Copy, Clone, Debug, PartialEq)]
pub struct Wavelengths {
    lambda_nm: [f32; N_LAMBDA],
    pdf: [f32; N_LAMBDA],
}

impl Wavelengths {
    /// Wavelengths for a random number in [0, 1), denser where the eye sees more.
    #[inline]
    #[must_use]
    pub fn sample_visible(u: f32) -> Self {
        let lambda_nm = rotated(u).map(sample_visible_nm);
        Self { lambda_nm, pdf: lambda_nm.map(visible_pdf) }
    }

    /// Wavelengths for a random number in [0, 1), equally dense everywhere.
    #[inline]
    #[must_use]
    pub fn sample_uniform(u: f32) -> Self {
        let span = LAMBDA_MAX_NM - LAMBDA_MIN_NM;
        Self {
            lambda_nm: rotated(u).map(|v| (LAMBDA_MIN_NM + v * span).min(LAMBDA_MAX_NM)),
            pdf: [1.0 / span; N_LAMBDA],
        }
    }

    /// One uniformly distributed wavelength in all places, the naive way: the others carry nothing.
    #[inline]
    #[must_use]
    pub fn sample_single(u: f32) -> Self {
        let span = LAMBDA_MAX_NM - LAMBDA_MIN_NM;
        let lambda = (LAMBDA_MIN_NM + u * span).min(LAMBDA_MAX_NM);
        let mut wavelengths = Self { lambda_nm: [lambda; N_LAMBDA], pdf: [1.0 / span; N_LAMBDA] };
        wavelengths.terminate_secondary();
        wavelengths
    }

    /// Given wavelengths in nm, with their densities per nm.
    #[inline]
    #[must_use]
    pub const fn from_parts(lambda_nm: [f32; N_LAMBDA], pdf: [f32; N_LAMBDA]) -> Self {
        Self { lambda_nm, pdf }
    }

    /// The wavelengths, in nm.
    #[inline]
    #[must_use]
    pub const fn lambda_nm(&self) -> [f32; N_LAMBDA] {
        self.lambda_nm
    }

    /// The densities, per nm; 0 for a wavelength that carries nothing any more.
    #[inline]
    #[must_use]
    pub const fn pdf(&self) -> Sampled {
        Sampled::from_array(self.pdf)
    }

    /// Drops all wavelengths but the first, because the path now depends on the first alone (dispersion).
    ///
    /// The density of the first is divided by their number, since means still divide by it. Does nothing when
    /// already done.
    #[inline]
    pub fn terminate_secondary(&mut self) {
        if self.secondary_terminated() {
            return;
        }
        let pdf = self.pdf[0] / N_LAMBDA as f32;
        self.pdf = [0.0; N_LAMBDA];
        self.pdf[0] = pdf;
    }

    /// Whether only the first wavelength still carries light.
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

/// The wavelength in nm at which the distribution of visible wavelengths reaches `u`.
#[inline]
fn sample_visible_nm(u: f32) -> f32 {
    let lambda = 538.0 - 138.888_889 * (0.856_910_62 - 1.827_501_97 * u).atanh();
    lambda.clamp(LAMBDA_MIN_NM, LAMBDA_MAX_NM)
}

/// Density per nm of [`sample_visible_nm`].
#[inline]
fn visible_pdf(lambda_nm: f32) -> f32 {
    let cosh = (0.0072 * (lambda_nm - 538.0)).cosh();
    0.003_939_804_2 / (cosh * cosh)
}
