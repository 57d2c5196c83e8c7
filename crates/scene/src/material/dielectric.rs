//! Glass, water, diamond: a boundary between transparent media, smooth or rough.

use etendue_spectrum::Wavelengths;

use super::index::RefractiveIndex;
use super::limits;
use super::roughness::{Roughness, RoughnessNames};
use super::{FacetOptions, MaterialContext, Materials, Perturbation, spec};
use crate::bsdf::facetted::CompensatedDielectric;
use crate::bsdf::{BsdfKind, Dielectric, Facetted};
use crate::medium::{Absorption, Interface};
use crate::parameters::{ParameterSpec, Parameters, SpectrumRole};
use crate::texture::Textures;

/// Parameters of `dielectric`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct DielectricMaterial {
    /// Index inside, where the normal does not point.
    pub eta: RefractiveIndex,
    /// Index outside.
    pub eta_outside: RefractiveIndex,
    /// What absorbs on both sides.
    pub interface: Interface,
    /// Roughness.
    pub roughness: Roughness,
    /// Its facets.
    pub facets: FacetOptions,
    /// With the light that bounces several times among them.
    pub bounces: bool,
    /// Relief.
    pub perturbation: Perturbation,
}

impl DielectricMaterial {
    /// What scene files may say.
    pub const PARAMETERS: &'static [ParameterSpec] = &[
        spec::ETA,
        spec::ETA_EXTERIOR,
        spec::ABSORPTION,
        spec::ABSORPTION_EXTERIOR,
        spec::ROUGHNESS,
        spec::U_ROUGHNESS,
        spec::V_ROUGHNESS,
        spec::REMAP_ROUGHNESS,
        FacetOptions::DISTRIBUTION,
        FacetOptions::FRESNEL,
        FacetOptions::MULTIPLE_SCATTERING,
        spec::DISPLACEMENT,
        spec::NORMAL_MAP,
    ];

    pub(super) fn build(p: &mut Parameters<'_, '_>, materials: &mut Materials) -> Self {
        let mut medium = |name| {
            let absorption = p.spectrum(name, SpectrumRole::Unbounded)?;
            if limits::least(p, &absorption) < 0.0 {
                let span = p.span_of(name);
                p.diagnostics()
                    .warning(span, "light does not grow on its way: negative absorption is taken as 0");
            }
            Some(materials.add_medium(Absorption::Coefficient(absorption)))
        };
        let interface = Interface { inside: medium("absorption"), outside: medium("absorption_exterior") };
        Self {
            eta: RefractiveIndex::build(p, "eta", RefractiveIndex::GLASS),
            eta_outside: RefractiveIndex::build(p, "eta_exterior", RefractiveIndex::VACUUM),
            interface,
            roughness: Roughness::build(p, &RoughnessNames::PLAIN),
            facets: FacetOptions::build(p),
            bounces: p.bool("multiplescattering", false),
            perturbation: Perturbation::build(p, materials),
        }
    }

    #[inline]
    pub(super) fn bsdf(
        &self,
        textures: &Textures,
        ctx: &MaterialContext,
        lambda: &mut Wavelengths,
    ) -> BsdfKind {
        let eta = self.eta.of_hero(textures, lambda) / self.eta_outside.of_hero(textures, lambda);
        let microfacets = self.roughness.microfacets(textures, &ctx.texture);
        if self.facets.are_plain() && !self.bounces {
            return BsdfKind::Dielectric(Dielectric { microfacets, eta });
        }
        let dielectric = Dielectric { microfacets: self.facets.of(microfacets), eta };
        BsdfKind::Facetted(if self.bounces {
            Facetted::CompensatedDielectric(CompensatedDielectric::new(dielectric))
        } else {
            Facetted::Dielectric(dielectric)
        })
    }
}
