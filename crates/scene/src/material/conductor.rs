//! Metal, smooth or rough.

use etendue_spectrum::Wavelengths;

use super::metal::{Metal, MetalNames};
use super::roughness::{Roughness, RoughnessNames};
use super::{FacetOptions, MaterialContext, Materials, Perturbation, spec};
use crate::bsdf::facetted::CompensatedConductor;
use crate::bsdf::{BsdfKind, Conductor, Facetted};
use crate::parameters::{ParameterSpec, Parameters};
use crate::texture::Textures;

/// Parameters of `conductor`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ConductorMaterial {
    /// Optics.
    pub metal: Metal,
    /// Roughness.
    pub roughness: Roughness,
    /// Its facets.
    pub facets: FacetOptions,
    /// With the light that bounces several times among them.
    pub bounces: bool,
    /// Relief.
    pub perturbation: Perturbation,
}

impl ConductorMaterial {
    /// What scene files may say.
    pub const PARAMETERS: &'static [ParameterSpec] = &[
        spec::METAL_ETA,
        spec::METAL_K,
        spec::METAL_REFLECTANCE,
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
        Self {
            metal: Metal::build(p, &MetalNames { eta: "eta", k: "k" }),
            roughness: Roughness::build(p, &RoughnessNames::PLAIN),
            facets: FacetOptions::build(p),
            bounces: p.bool("multiplescattering", false),
            perturbation: Perturbation::build(p, materials),
        }
    }

    #[inline]
    pub(super) fn bsdf(&self, textures: &Textures, ctx: &MaterialContext, lambda: &Wavelengths) -> BsdfKind {
        let (eta, k) = self.metal.eta_k(textures, ctx, lambda);
        let microfacets = self.roughness.microfacets(textures, &ctx.texture);
        if self.facets.are_plain() && !self.bounces {
            return BsdfKind::Conductor(Conductor { microfacets, eta, k });
        }
        let conductor = Conductor { microfacets: self.facets.of(microfacets), eta, k };
        BsdfKind::Facetted(if self.bounces {
            Facetted::CompensatedConductor(CompensatedConductor::new(conductor))
        } else {
            Facetted::Conductor(conductor)
        })
    }
}
