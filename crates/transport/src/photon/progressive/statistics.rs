//! What pixels remember from pass to pass where each has a radius of its own (Hachisuka, Ogaki and Jensen 2008, "Progressive
//! Photon Mapping"; Hachisuka and Jensen 2009, "Stochastic Progressive Photon Mapping"; SPEC PROG-1, PROG-2).
//!
//! After M new photons within the radius R of a pixel that has N,
//!
//! ```text
//!   N' = N + alpha M,   R'^2 = R^2 (N + alpha M) / (N + M),   tau' = (tau + tau_M) R'^2 / R^2,   L = tau' / (n pi R'^2),
//! ```
//!
//! n photons having been emitted in all. There is no need to keep tau: with n photons a pass, `p L_p - (p - 1) L_(p-1)` is
//! `tau_M / (n pi R^2)`, what the photons of the pass alone give with the radius before the update. So the mean of the
//! passes, which is what the film makes, is L.

use std::sync::atomic::{AtomicU32, Ordering};

use etendue_scene::film::PixelBounds;

use crate::integrator::StateError;

/// The radii of all pixels.
#[derive(Debug, Default)]
pub(super) struct PixelStatistics {
    bounds: PixelBounds,
    /// Radii for each pixel.
    n_parts: u32,
    /// Square of the radius over that of the first pass, and N.
    radii: Vec<(f32, f32)>,
    /// M of the pass that runs.
    new: Vec<AtomicU32>,
}

/// Begins saved state.
const MAGIC: &[u8; 8] = b"sppm\0\0\0\x01";

impl PixelStatistics {
    /// Makes room for these pixels, if there is none yet.
    pub(super) fn prepare(&mut self, bounds: PixelBounds, n_parts: u32) {
        let n = bounds.n_pixels() * n_parts as usize;
        if self.radii.len() != n {
            self.radii = vec![(1.0, 0.0); n];
        }
        (self.bounds, self.n_parts) = (bounds, n_parts);
        self.new.clear();
        self.new.resize_with(n, AtomicU32::default);
    }

    fn index(&self, pixel: [u32; 2], part: u32) -> usize {
        self.bounds.index(pixel) * self.n_parts as usize + part as usize
    }

    /// The pixel's radius over that of the first pass.
    pub(super) fn shrink(&self, pixel: [u32; 2], part: u32) -> f32 {
        self.radii[self.index(pixel, part)].0.sqrt()
    }

    /// Counts photons. A pixel is one thread's at a time, and sums of whole numbers know no order.
    pub(super) fn count(&self, pixel: [u32; 2], part: u32, n_photons: u32) {
        self.new[self.index(pixel, part)].fetch_add(n_photons, Ordering::Relaxed);
    }

    /// Shrinks the radii by what the pass has found.
    pub(super) fn update(&mut self, alpha: f32) {
        for ((squared, n), new) in self.radii.iter_mut().zip(&self.new) {
            let m = new.load(Ordering::Relaxed) as f32;
            if m > 0.0 {
                let kept = *n + alpha * m;
                *squared *= kept / (*n + m);
                *n = kept;
            }
        }
    }

    /// State as bytes; none before the first pass.
    pub(super) fn save(&self) -> Vec<u8> {
        if self.radii.is_empty() {
            return Vec::new();
        }
        let numbers = self.radii.iter().flat_map(|(squared, n)| [*squared, *n]);
        MAGIC.iter().copied().chain(numbers.flat_map(f32::to_le_bytes)).collect()
    }

    /// Takes saved state.
    pub(super) fn load(&mut self, state: &[u8]) -> Result<(), StateError> {
        if state.is_empty() {
            return Ok(());
        }
        let (pairs, rest) = state.strip_prefix(MAGIC).ok_or(StateError)?.as_chunks::<8>();
        let number = |bytes: &[u8]| bytes.try_into().map(f32::from_le_bytes).unwrap_or(f32::NAN);
        let pair = |bytes: &[u8; 8]| (number(&bytes[..4]), number(&bytes[4..]));
        let radii: Vec<(f32, f32)> = pairs.iter().map(pair).collect();
        let is_sound =
            |(squared, n): &(f32, f32)| *squared > 0.0 && *squared <= 1.0 && *n >= 0.0 && n.is_finite();
        if !rest.is_empty() || !radii.iter().all(is_sound) {
            return Err(StateError);
        }
        self.radii = radii;
        Ok(())
    }
}
