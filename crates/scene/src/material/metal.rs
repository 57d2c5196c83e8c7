//! The optics of metals, bare or coated.

use etendue_spectrum::{Sampled, Spectrum, Wavelengths};

use super::{MaterialContext, limits};
use crate::parameters::{Parameters, SpectrumRole};
use crate::texture::{SpectrumTexture, Textures};

/// What a metal reflects.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Metal {
    /// By its complex index of refraction.
    Indices {
        /// Real part.
        eta: SpectrumTexture,
        /// Imaginary part, absorption.
        k: SpectrumTexture,
    },
    /// By its reflectance at normal incidence, in [0, 1]: a metal of real index 1 and the absorption that gives it.
    Reflectance(SpectrumTexture),
}

/// Names of the parameters of a metal.
pub(super) struct MetalNames {
    pub(super) eta: &'static str,
    pub(super) k: &'static str,
}

impl Metal {
    pub(super) fn build(p: &mut Parameters<'_, '_>, names: &MetalNames) -> Self {
        let has_index = p.has(names.eta) || p.has(names.k);
        if let Some(reflectance) = limits::albedo_opt(p, "reflectance") {
            if has_index {
                let span = p.span_of("reflectance");
                let message =
                    format!("a metal has either \"reflectance\" or \"{}\" and \"{}\"", names.eta, names.k);
                p.diagnostics().error(span, message);
            }
            return Self::Reflectance(reflectance);
        }
        let eta = Self::index(p, names.eta, "metal-Cu-eta");
        let k = Self::index(p, names.k, "metal-Cu-k");
        Self::Indices { eta, k }
    }

    fn index(p: &mut Parameters<'_, '_>, name: &'static str, copper: &str) -> SpectrumTexture {
        let span = p.span_of(name);
        if let Some(given) = p.spectrum_texture_opt(name, SpectrumRole::Unbounded) {
            // Fresnel's equations have squares alone.
            if given.constant().is_some_and(|spectrum| limits::least(p, &spectrum) < 0.0) {
                let message = format!("\"{name}\" is negative; it is taken as its absolute value");
                p.diagnostics().warning(span, message);
            }
            return given;
        }
        let spectrum = p.context.named_spectrum(copper, span).unwrap_or(Spectrum::Constant(1.0));
        SpectrumTexture::Constant(spectrum)
    }

    /// True if it is the same all over a surface.
    pub(super) const fn is_constant(&self) -> bool {
        match self {
            Self::Indices { eta, k } => eta.constant().is_some() && k.constant().is_some(),
            Self::Reflectance(reflectance) => reflectance.constant().is_some(),
        }
    }

    /// Real and imaginary part of the index in vacuum.
    #[inline]
    pub(super) fn eta_k(
        &self,
        textures: &Textures,
        ctx: &MaterialContext,
        lambda: &Wavelengths,
    ) -> (Sampled, Sampled) {
        match *self {
            Self::Indices { eta, k } => (
                textures.eval_spectrum(eta, &ctx.texture, lambda),
                textures.eval_spectrum(k, &ctx.texture, lambda),
            ),
            Self::Reflectance(reflectance) => {
                // R = k² / (4 + k²) at normal incidence, solved for k. At R = 1 it is infinite.
                let r = textures.eval_spectrum(reflectance, &ctx.texture, lambda).clamp(0.0, 0.9999);
                (Sampled::ONE, r.sqrt() * 2.0 / (Sampled::ONE - r).sqrt())
            }
        }
    }
}
