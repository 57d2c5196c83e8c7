//! The form in which paths carry the model.

use etendue_math::{Point2, Vector3, lerp, sqr};
use etendue_spectrum::Sampled;

use super::super::{AnyFacets, FacetShape, FresnelForm};
use super::base::{Base, LEAST_ALPHA};
use super::coat::Coat;
use super::layers::Layers;
use super::sheen::Sheen;
use super::{PrincipledParameters, ThinFilm};
use crate::bsdf::microfacet::Microfacets;
use crate::bsdf::{BsdfSample, Lobes, TransportMode};

/// A number in [0, 1] in steps of 1/65535.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
struct Share(u16);

impl Share {
    const STEPS: f32 = 65_535.0;

    fn new(share: f32) -> Self {
        Self((share.clamp(0.0, 1.0) * Self::STEPS + 0.5) as u16)
    }

    fn get(self) -> f32 {
        f32::from(self.0) / Self::STEPS
    }
}

/// Four of them.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
struct Shares([Share; 4]);

impl Shares {
    fn new(shares: Sampled) -> Self {
        Self(shares.to_array().map(Share::new))
    }

    fn get(self) -> Sampled {
        Sampled::from_array(self.0.map(Share::get))
    }
}

/// glTF's material with its extensions, in the shading frame.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ExtendedPrincipled {
    color: Shares,
    f0: Shares,
    sheen_color: Shares,
    metal: Share,
    specular: Share,
    transmission: Share,
    coat_share: Share,
    film_share: Share,
    is_solid: bool,
    /// True if facets are wider than their tables say.
    is_widened: bool,
    eta: f32,
    alphas: [f32; 2],
    mean_energy: f32,
    coat_alpha: Share,
    /// x and y of the coat's normal, halved and raised by one half.
    coat_tilt: [Share; 2],
    sheen_alpha: Share,
    film_ior: f32,
    film_thickness_nm: f32,
    lambda_nm: [f32; 4],
    mean: Shares,
}

impl ExtendedPrincipled {
    /// From what a material says.
    #[must_use]
    pub fn new(p: &PrincipledParameters) -> Self {
        // A mirror would be another lobe; this is as narrow as pictures can tell.
        let alpha_of = |roughness| sqr(roughness).max(LEAST_ALPHA);
        let alpha = alpha_of(p.roughness);
        let alphas = [lerp(sqr(p.anisotropy), alpha, 1.0), alpha];
        let f0 = p.specular_color * sqr((p.ior - 1.0) / (p.ior + 1.0));
        let mut packed = Self {
            color: Shares::new(p.base_color),
            f0: Shares::new(f0),
            sheen_color: Shares::new(p.sheen_color),
            metal: Share::new(p.metallic),
            specular: Share::new(p.specular),
            transmission: Share::new(p.transmission),
            coat_share: Share::new(p.clearcoat),
            film_share: Share::new(p.film.share),
            is_solid: p.is_solid,
            is_widened: false,
            eta: Base::bending_index(p.ior, p.is_solid && p.transmission > 0.0),
            alphas,
            mean_energy: Base::mean_energy(ggx(alphas)),
            coat_alpha: Share::new(alpha_of(p.clearcoat_roughness)),
            coat_tilt: [p.clearcoat_normal.x, p.clearcoat_normal.y].map(|x| Share::new(0.5 * x + 0.5)),
            sheen_alpha: Share::new(Sheen::alpha_of(p.sheen_roughness)),
            film_ior: p.film.ior,
            film_thickness_nm: p.film.thickness_nm,
            lambda_nm: p.lambda_nm,
            mean: Shares::new(Sampled::ONE),
        };
        let layers = packed.unpack();
        if layers.base.plastic() > 0.0 {
            packed.mean = Shares::new(layers.mean_passed());
        }
        packed
    }

    fn unpack(&self) -> Layers {
        let widened = |facets: Microfacets| if self.is_widened { facets.regularized() } else { facets };
        let tabulated = ggx(self.alphas);
        let [x, y] = self.coat_tilt.map(|tilt| 2.0 * tilt.get() - 1.0);
        let base = Base {
            color: self.color.get(),
            f0: self.f0.get(),
            specular: self.specular.get(),
            metal: self.metal.get(),
            transmission: self.transmission.get(),
            eta: self.eta,
            is_solid: self.is_solid,
            facets: widened(tabulated.alphas),
            tabulated,
            mean_energy: self.mean_energy,
            film: ThinFilm {
                share: self.film_share.get(),
                ior: self.film_ior,
                thickness_nm: self.film_thickness_nm,
            },
            lambda_nm: self.lambda_nm,
        };
        let coat = Coat {
            share: self.coat_share.get(),
            facets: widened(Microfacets::new(self.coat_alpha.get(), self.coat_alpha.get())),
            alpha: self.coat_alpha.get(),
            normal: Vector3::new(x, y, (1.0 - sqr(x) - sqr(y)).max(0.0).sqrt()),
        };
        let sheen = Sheen { color: self.sheen_color.get(), alpha: self.sheen_alpha.get() };
        Layers { coat, sheen, base, mean: self.mean.get() }
    }

    /// The lobes present.
    #[must_use]
    pub fn lobes(&self) -> Lobes {
        self.unpack().lobes()
    }

    /// f in 1/sr, without the cosine.
    #[must_use]
    pub fn eval(&self, wo: Vector3, wi: Vector3, mode: TransportMode, lobes: Lobes) -> Sampled {
        self.unpack().eval(wo, wi, mode, lobes)
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
        self.unpack().sample(wo, u_component, u, mode, lobes)
    }

    /// Density of [`Self::sample`] in 1/sr.
    #[must_use]
    pub fn pdf(&self, wo: Vector3, wi: Vector3, lobes: Lobes) -> f32 {
        self.unpack().pdf(wo, wi, lobes)
    }

    /// Share of the surface that is under a clear coat, of index 1.5.
    #[must_use]
    pub fn clearcoat(&self) -> f32 {
        self.coat_share.get()
    }

    /// With rougher facets where they are narrow.
    #[must_use]
    pub(in crate::bsdf) fn regularized(self) -> Self {
        Self { is_widened: true, ..self }
    }

    pub(in crate::bsdf) fn mean_alpha(&self) -> f32 {
        self.unpack().base.facets.mean_alpha()
    }
}

fn ggx([x, y]: [f32; 2]) -> AnyFacets {
    AnyFacets { alphas: Microfacets::new(x, y), shape: FacetShape::Ggx, fresnel: FresnelForm::Exact }
}
