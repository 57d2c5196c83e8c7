//! In what pattern photons leave the lights (SPEC OPT-10, OPT-11; Jensen 2001, section 11.4; Keller 1996, "Quasi-Monte Carlo Methods in
//! Computer Graphics: The Global Illumination Problem").
//!
//! Random photons clump: of N in a region on average, the number varies by sqrt(N). Even ones do less, but a regular grid shows
//! in caustics, so that both even patterns are randomised.

use etendue_math::SamplerKind;

/// A pattern of photons.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum PhotonPattern {
    /// Independent.
    Random,
    /// One photon at random in each cell of a grid: of the directions, of the places, of each pair of numbers on the way. The
    /// side of a grid has as many cells as stated; when all are used a new one starts.
    Stratified {
        /// Cells along a side, at least 1.
        side: u32,
    },
    /// The middles of such cells: even, but regular, which shows in caustics. For comparison.
    Grid {
        /// Cells along a side, at least 1.
        side: u32,
    },
    /// Scrambled Sobol points over the number of the photon, so that directions, and the first scattering with them, are even for
    /// any number of photons.
    #[default]
    Qmc,
}

/// Cells along the side of a grid for any number of photons: rounds of 16384.
const SIDE: u32 = 128;

impl PhotonPattern {
    /// Names in scene files.
    pub const NAMES: [(&'static str, Self); 4] = [
        ("random", Self::Random),
        ("stratified", Self::Stratified { side: SIDE }),
        ("qmc", Self::Qmc),
        ("grid", Self::Grid { side: SIDE }),
    ];

    /// The pattern, fitted to a number of photons that is known before.
    #[must_use]
    pub fn planned(self, n_photons: u64) -> Self {
        let side = n_photons.isqrt().clamp(1, 1 << 15) as u32;
        match self {
            Self::Stratified { .. } => Self::Stratified { side },
            Self::Grid { .. } => Self::Grid { side },
            Self::Random | Self::Qmc => self,
        }
    }

    /// Who deals the numbers of photons.
    #[must_use]
    pub const fn sampler_kind(self) -> SamplerKind {
        match self {
            Self::Random => SamplerKind::Independent,
            Self::Stratified { side } => SamplerKind::Stratified { x: side, y: side, jitter: true },
            Self::Grid { side } => SamplerKind::Stratified { x: side, y: side, jitter: false },
            Self::Qmc => SamplerKind::Sobol,
        }
    }
}
