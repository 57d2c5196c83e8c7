//! Which facets a rough interface has.

use super::spec;
use crate::bsdf::facetted::{AnyFacets, FacetShape, FresnelForm};
use crate::bsdf::microfacet::Microfacets;
use crate::parameters::{ParameterSpec, Parameters};

/// Facets other than those of GGX by Fresnel's equations.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct FacetOptions {
    /// Distribution of normals.
    pub shape: FacetShape,
    /// Reflectance.
    pub fresnel: FresnelForm,
}

impl FacetOptions {
    pub(super) const DISTRIBUTION: ParameterSpec =
        spec::spec("distribution", "string", "ggx", "Facet normals: ggx, with long tails, or beckmann.");
    pub(super) const FRESNEL: ParameterSpec =
        spec::spec("fresnel", "string", "exact", "Fresnel's equations (exact) or Schlick's fit (schlick).");
    pub(super) const MULTIPLE_SCATTERING: ParameterSpec = spec::spec(
        "multiplescattering",
        "bool",
        "false",
        "Adds the light that bounces several times among facets.",
    );

    pub(super) fn build(p: &mut Parameters<'_, '_>) -> Self {
        let shapes = [("ggx", FacetShape::Ggx), ("beckmann", FacetShape::Beckmann)];
        let forms = [("exact", FresnelForm::Exact), ("schlick", FresnelForm::Schlick)];
        Self {
            shape: p.choice("distribution", "ggx", &shapes),
            fresnel: p.choice("fresnel", "exact", &forms),
        }
    }

    /// True if facets are those of pbrt-v4.
    pub(super) fn are_plain(self) -> bool {
        self.shape == FacetShape::Ggx && self.fresnel == FresnelForm::Exact
    }

    pub(super) const fn of(self, alphas: Microfacets) -> AnyFacets {
        AnyFacets { alphas, shape: self.shape, fresnel: self.fresnel }
    }
}
