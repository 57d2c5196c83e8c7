//! The dielectric coat of `coateddiffuse` and `coatedconductor`, with the medium below it.

use etendue_spectrum::Wavelengths;

use super::index::RefractiveIndex;
use super::roughness::{Roughness, RoughnessNames};
use super::{MaterialContext, limits};
use crate::bsdf::{Base, BsdfKind, Dielectric, Layered};
use crate::parameters::Parameters;
use crate::texture::{FloatTexture, SpectrumTexture, Textures};

/// A coat and the medium between it and the base.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Coat {
    /// Index of coat and medium.
    pub eta: RefractiveIndex,
    /// Roughness of the coat.
    pub roughness: Roughness,
    /// Optical depth of the medium.
    pub thickness: FloatTexture,
    /// Mean cosine of scattering in the medium.
    pub g: FloatTexture,
    /// Albedo of the medium.
    pub albedo: SpectrumTexture,
    /// Largest number of events of a walk.
    pub max_depth: u16,
    /// Walks per evaluation.
    pub n_samples: u16,
}

impl Coat {
    pub(super) fn build(p: &mut Parameters<'_, '_>, eta: &'static str, roughness: &RoughnessNames) -> Self {
        Self {
            eta: RefractiveIndex::build(p, eta, RefractiveIndex::GLASS),
            roughness: Roughness::build(p, roughness),
            thickness: limits::float_within(p, "thickness", 0.01, [0.0, 1e6]),
            g: limits::float_within(p, "g", 0.0, [-0.999, 0.999]),
            albedo: limits::albedo(p, "albedo", 0.0),
            max_depth: Self::count(p, "maxdepth", 10),
            n_samples: Self::count(p, "nsamples", 1),
        }
    }

    fn count(p: &mut Parameters<'_, '_>, name: &'static str, default: u16) -> u16 {
        let value = p.integer(name, i32::from(default));
        u16::try_from(value).ok().filter(|count| *count > 0).unwrap_or_else(|| {
            let span = p.span_of(name);
            p.diagnostics().error(span, format!("\"{name}\" must be between 1 and {}", u16::MAX));
            default
        })
    }

    /// The coat over a base, where `eta` is [`Self::eta`] at the first wavelength.
    #[inline]
    pub(super) fn over(
        &self,
        base: Base,
        eta: f32,
        textures: &Textures,
        ctx: &MaterialContext,
        lambda: &Wavelengths,
    ) -> BsdfKind {
        BsdfKind::Layered(Layered {
            coat: Dielectric { microfacets: self.roughness.microfacets(textures, &ctx.texture), eta },
            base,
            thickness: textures.eval_float(self.thickness, &ctx.texture).max(f32::MIN_POSITIVE),
            g: textures.eval_float(self.g, &ctx.texture).clamp(-0.999, 0.999),
            albedo: textures.eval_spectrum(self.albedo, &ctx.texture, lambda).clamp(0.0, 1.0),
            max_depth: self.max_depth,
            n_samples: self.n_samples,
        })
    }
}
