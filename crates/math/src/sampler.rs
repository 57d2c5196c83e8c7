//! Sample generators: who deals the random numbers of a pixel, and in what pattern.
//!
//! A sample is fixed by seed, pixel and sample index alone, so that passes may be split, merged and run on any number
//! of threads. Within one sample, numbers are dealt dimension by dimension, in the order of the calls.
//!
//! To add a generator: a file in `sampler/` with a small `Clone + Debug` struct that has `new`, `next_1d` and
//! `next_2d`; a variant of [`SamplerKind`] and of `Generator`, and a line in each `match` below.

mod group;
mod halton;
mod independent;
mod sobol;
mod stratified;

use halton::Halton;
use independent::Independent;
use sobol::Sobol;
use stratified::Stratified;

use crate::Point2;
use crate::rng::hash64;

/// Which generator deals the numbers.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum SamplerKind {
    /// Independent pseudo-random numbers.
    Independent,
    /// One number per stratum, the strata in random order in every dimension (SPEC MC-9).
    Stratified {
        /// Strata in x; with those in y they are the strata of one dimension.
        x: u32,
        /// Strata in y.
        y: u32,
        /// Random position within the stratum if true, else its centre, which biases the result.
        jitter: bool,
    },
    /// Halton points with scrambled digits.
    Halton,
    /// Sobol points, Owen-scrambled, even within each segment of a path.
    #[default]
    Sobol,
    /// The same along a curve through all pixels, so that the errors of neighbours cancel. Best with the planned number of
    /// samples and with powers of two.
    ZSobol,
}

/// What determines all numbers of an image.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct SamplerSettings {
    /// The generator.
    pub kind: SamplerKind,
    /// Images of different seeds are independent.
    pub seed: u64,
    /// Samples planned for each pixel; only the numbers of [`SamplerKind::ZSobol`] depend on it.
    pub samples_per_pixel: u32,
}

impl Default for SamplerSettings {
    fn default() -> Self {
        Self { kind: SamplerKind::Sobol, seed: 0, samples_per_pixel: 16 }
    }
}

#[derive(Clone, Debug)]
enum Generator {
    Independent(Independent),
    Stratified(Stratified),
    Halton(Halton),
    Sobol(Sobol),
}

/// Deals the numbers of one sample of one pixel, all in [0, 1).
#[derive(Clone, Debug)]
pub struct Sampler(Generator);

impl Sampler {
    /// The start of sample `sample_index` of a pixel.
    #[inline]
    #[must_use]
    pub fn new(settings: &SamplerSettings, pixel: [u32; 2], sample_index: u64) -> Self {
        let seed = hash64(&[settings.seed, u64::from(pixel[0]) << 32 | u64::from(pixel[1])]);
        Self(match settings.kind {
            SamplerKind::Independent => Generator::Independent(Independent::new(seed, sample_index)),
            SamplerKind::Stratified { x, y, jitter } => {
                Generator::Stratified(Stratified::new(seed, sample_index, [x, y], jitter))
            }
            SamplerKind::Halton => Generator::Halton(Halton::new(seed, sample_index)),
            SamplerKind::Sobol => Generator::Sobol(Sobol::new(seed, sample_index)),
            SamplerKind::ZSobol => Generator::Sobol(Sobol::along_curve(
                settings.seed,
                pixel,
                settings.samples_per_pixel,
                sample_index,
            )),
        })
    }

    /// Says that the numbers up to the next call belong to one vertex of a path: in this order, of those that are wanted,
    /// one and two to choose a light and a point of it, one and two to scatter, one for roulette. Before the first call:
    /// the wavelength, the place in the pixel, time, and lens. Then numbers mean the same in all samples, although paths differ.
    #[inline]
    pub fn start_vertex(&mut self) {
        if let Generator::Sobol(generator) = &mut self.0 {
            generator.start_vertex();
        }
    }

    /// Passes over the numbers that choose a light and a point of it, for a vertex that asks no light.
    #[inline]
    pub fn skip_light(&mut self) {
        self.next_1d();
        self.next_2d();
    }

    /// The next number.
    #[inline]
    pub fn next_1d(&mut self) -> f32 {
        match &mut self.0 {
            Generator::Independent(generator) => generator.next_1d(),
            Generator::Stratified(generator) => generator.next_1d(),
            Generator::Halton(generator) => generator.next_1d(),
            Generator::Sobol(generator) => generator.next_1d(),
        }
    }

    /// The next point of the unit square; evenly spread in both coordinates together.
    #[inline]
    pub fn next_2d(&mut self) -> Point2 {
        match &mut self.0 {
            Generator::Independent(generator) => generator.next_2d(),
            Generator::Stratified(generator) => generator.next_2d(),
            Generator::Halton(generator) => generator.next_2d(),
            Generator::Sobol(generator) => generator.next_2d(),
        }
    }
}

#[cfg(test)]
mod tests;
