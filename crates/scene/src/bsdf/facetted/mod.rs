//! Rough conductors and dielectrics beyond those which most scenes have: Beckmann's facets beside GGX, Schlick's fit
//! beside Fresnel's equations, and compensation for the light that bounces several times among facets.
//!
//! They sit behind one variant of [`BsdfKind`](super::BsdfKind) and out of line, so that GGX by Fresnel's equations
//! stays as quick as without them. What facets there are is a parameter of [`Conductor`] and [`Dielectric`].

mod beckmann;
mod compensated;
mod compensated_dielectric;
mod energy;
mod extended;
mod facets;
mod principled;

use etendue_math::{Point2, Vector3};
use etendue_spectrum::Sampled;

use super::classic::lobed;
use super::{BsdfSample, Conductor, Dielectric, Lobes, TransportMode};

pub(in crate::bsdf) use extended::configurations;

pub use beckmann::Beckmann;
pub use compensated::CompensatedConductor;
pub use compensated_dielectric::CompensatedDielectric;
pub use extended::{ExtendedPrincipled, PrincipledParameters, ThinFilm};
pub use facets::{AnyFacets, FacetShape, Facets, FresnelForm};
pub use principled::Principled;

/// A surface of facets, in the shading frame.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Facetted {
    /// Metal.
    Conductor(Conductor<AnyFacets>),
    /// Metal, with all bounces.
    CompensatedConductor(CompensatedConductor),
    /// A boundary between transparent media.
    Dielectric(Dielectric<AnyFacets>),
    /// A boundary between transparent media, with all bounces.
    CompensatedDielectric(CompensatedDielectric),
    /// glTF's metal and coated base.
    Principled(Principled),
    /// The same with extensions.
    Extended(ExtendedPrincipled),
}

impl Facetted {
    /// The lobes present.
    #[must_use]
    pub fn lobes(&self) -> Lobes {
        match self {
            Self::Conductor(bsdf) => bsdf.lobes(),
            Self::CompensatedConductor(bsdf) => lobed::lobes(bsdf),
            Self::Dielectric(bsdf) => bsdf.lobes(),
            Self::CompensatedDielectric(bsdf) => bsdf.lobes(),
            Self::Principled(bsdf) => lobed::lobes(bsdf),
            Self::Extended(bsdf) => bsdf.lobes(),
        }
    }

    /// f in 1/sr, without the cosine.
    #[must_use]
    pub fn eval(&self, wo: Vector3, wi: Vector3, mode: TransportMode, lobes: Lobes) -> Sampled {
        match self {
            Self::Conductor(bsdf) => bsdf.eval(wo, wi, lobes),
            Self::CompensatedConductor(bsdf) => lobed::eval(bsdf, wo, wi, mode, lobes),
            Self::Dielectric(bsdf) => bsdf.eval(wo, wi, mode, lobes),
            Self::CompensatedDielectric(bsdf) => bsdf.eval(wo, wi, mode, lobes),
            Self::Principled(bsdf) => lobed::eval(bsdf, wo, wi, mode, lobes),
            Self::Extended(bsdf) => bsdf.eval(wo, wi, mode, lobes),
        }
    }

    /// A direction of one of the lobes.
    #[must_use]
    pub fn sample(
        &self,
        wo: Vector3,
        u_component: f32,
        u: Point2,
        mode: TransportMode,
        lobes: Lobes,
    ) -> Option<BsdfSample> {
        match self {
            Self::Conductor(bsdf) => bsdf.sample(wo, u, lobes),
            Self::CompensatedConductor(bsdf) => lobed::sample(bsdf, wo, u_component, u, mode, lobes),
            Self::Dielectric(bsdf) => bsdf.sample(wo, u_component, u, mode, lobes),
            Self::CompensatedDielectric(bsdf) => bsdf.sample(wo, u_component, u, mode, lobes),
            Self::Principled(bsdf) => lobed::sample(bsdf, wo, u_component, u, mode, lobes),
            Self::Extended(bsdf) => bsdf.sample(wo, u_component, u, mode, lobes),
        }
    }

    /// Density of [`Self::sample`] in 1/sr.
    #[must_use]
    pub fn pdf(&self, wo: Vector3, wi: Vector3, lobes: Lobes) -> f32 {
        match self {
            Self::Conductor(bsdf) => bsdf.pdf(wo, wi, lobes),
            Self::CompensatedConductor(bsdf) => lobed::pdf(bsdf, wo, wi, lobes),
            Self::Dielectric(bsdf) => bsdf.pdf(wo, wi, lobes),
            Self::CompensatedDielectric(bsdf) => bsdf.pdf(wo, wi, lobes),
            Self::Principled(bsdf) => lobed::pdf(bsdf, wo, wi, lobes),
            Self::Extended(bsdf) => bsdf.pdf(wo, wi, lobes),
        }
    }

    /// The same with rougher facets where they are nearly smooth.
    #[must_use]
    pub fn regularized(self) -> Self {
        match self {
            Self::Conductor(bsdf) => {
                Self::Conductor(Conductor { microfacets: bsdf.microfacets.regularized(), ..bsdf })
            }
            Self::CompensatedConductor(bsdf) => Self::CompensatedConductor(bsdf.regularized()),
            Self::Dielectric(bsdf) => {
                Self::Dielectric(Dielectric { microfacets: bsdf.microfacets.regularized(), ..bsdf })
            }
            Self::CompensatedDielectric(bsdf) => Self::CompensatedDielectric(bsdf.regularized()),
            Self::Principled(bsdf) => Self::Principled(bsdf.regularized()),
            Self::Extended(bsdf) => Self::Extended(bsdf.regularized()),
        }
    }

    /// Mean alpha of the facets; 0 if nothing is glossy.
    #[must_use]
    pub fn glossy_roughness(&self) -> f32 {
        if !self.lobes().is_glossy() {
            return 0.0;
        }
        match self {
            Self::Conductor(bsdf) => bsdf.microfacets.mean_alpha(),
            Self::CompensatedConductor(bsdf) => bsdf.facets().mean_alpha(),
            Self::Dielectric(bsdf) => bsdf.microfacets.mean_alpha(),
            Self::CompensatedDielectric(bsdf) => bsdf.facets().mean_alpha(),
            Self::Principled(bsdf) => bsdf.mean_alpha(),
            Self::Extended(bsdf) => bsdf.mean_alpha(),
        }
    }
}
