//! Index of refraction of a transparent interface.

use etendue_spectrum::{Spectrum, Wavelengths};

use super::limits;
use crate::parameters::{Parameters, SpectrumRole};
use crate::texture::{SpectrumTexture, TextureContext, Textures};

/// The index on one side, or of one side relative to the other, the same all over the surface.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RefractiveIndex(pub Spectrum);

impl RefractiveIndex {
    /// Common glass, without dispersion.
    pub const GLASS: Self = Self(Spectrum::Constant(1.5));

    /// Nothing, and nearly so air.
    pub const VACUUM: Self = Self(Spectrum::Constant(1.0));

    pub(super) fn build(p: &mut Parameters<'_, '_>, name: &'static str, default: Self) -> Self {
        let Some(spectrum) = p.spectrum(name, SpectrumRole::Unbounded) else { return default };
        if limits::has_gap(p, &spectrum) {
            let span = p.span_of(name);
            let place = if spectrum.is_constant() { "" } else { " where it is not" };
            let message = format!(
                "\"{name}\" is an index of refraction, which must be positive; it is taken as 1{place}"
            );
            p.diagnostics().warning(span, message);
        }
        Self(spectrum)
    }

    /// The index at the first wavelength. If the index varies, the other wavelengths would take other ways: they are
    /// given up, and the first counts for all (Wilkie et al. 2014, "Hero Wavelength Spectral Sampling"; SPEC FRES-10).
    #[inline]
    #[must_use]
    pub fn of_hero(&self, textures: &Textures, lambda: &mut Wavelengths) -> f32 {
        let eta = match self.0 {
            Spectrum::Constant(eta) => eta,
            spectrum => {
                lambda.terminate_secondary();
                textures.eval_spectrum(
                    SpectrumTexture::Constant(spectrum),
                    &TextureContext::default(),
                    lambda,
                )[0]
            }
        };
        // A spectrum that ends before this wavelength is 0 there.
        if eta > 0.0 { eta } else { 1.0 }
    }
}
