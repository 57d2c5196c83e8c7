//! A rough transparent interface with the light that bounces several times among its facets.
//!
//! Of the flux from a direction on side a, facets without loss reflect or refract `E_a` at once; `M_a = 1 - E_a` meets
//! further facets. It leaves later and about evenly on both sides, as for metal (see
//! [`CompensatedConductor`](super::CompensatedConductor)): with the means `m = 2 ∫ M cos d cos`, for light carriers
//! `f_ms = (1 - t_a) M_a(wo) M_a(wi) / (pi m_a)` on the side of `wo` and `t_a M_a(wo) M_b(wi) / (pi m_b)` through the
//! surface, whose integrals are `M_a(wo)`: nothing is lost, from either side. (Kulla and Conty 2017, "Revisiting
//! Physically Based Shading at Imageworks", scale by a share of transmission as well.)
//!
//! Ways and their reverse agree, up to the squared index, if `t_a n_a² m_a = t_b n_b² m_b`. Even light passes a smooth
//! interface with `(1 - F_a) n_a² = (1 - F_b) n_b²`, F the mean of Fresnel's factor. Here
//! `t_a = (1 - F_a) m_b / max(m_a, m_b)`, which is as close to that as reciprocity lets it be. How later bounces are
//! split between the sides is thus a guess; their sum is not.

use std::f32::consts::FRAC_1_PI;

use etendue_math::{ONE_MINUS_EPSILON, Point2, Vector3, sqr, warp};
use etendue_spectrum::Sampled;

use super::compensated::{alpha_along, mean_energy, mean_over_cosines};
use super::energy::InterfaceEnergy;
use super::{AnyFacets, Facets};
use crate::bsdf::dielectric::radiance_scale;
use crate::bsdf::local::same_hemisphere;
use crate::bsdf::{BsdfSample, Dielectric, Lobes, TransportMode};

/// A rough boundary between transparent media in the shading frame.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CompensatedDielectric {
    dielectric: Dielectric<AnyFacets>,
    above: Side,
    below: Side,
}

/// Later bounces seen from one side.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
struct Side {
    /// `m`: the mean share of light that bounces again.
    lost: f32,
    /// `t`: what of it leaves on the other side.
    transmitted: f32,
}

impl CompensatedDielectric {
    /// Of an interface with one bounce.
    #[must_use]
    pub fn new(dielectric: Dielectric<AnyFacets>) -> Self {
        let mut model = Self { dielectric, above: Side::default(), below: Side::default() };
        if !dielectric.lobes().is_glossy() {
            return model;
        }
        let (facets, eta) = (dielectric.microfacets, dielectric.eta);
        let [above, below] = [eta, 1.0 / eta].map(|eta| {
            let energy = InterfaceEnergy::of(facets, eta);
            1.0 - mean_energy(facets, |alpha| energy.mean(alpha), |cos, alpha| energy.albedo(cos, alpha))
        });
        let larger = above.max(below);
        if larger < 1e-5 {
            return model;
        }
        // The mean of Fresnel's factor from the thinner side, and what follows for the other.
        let thin_to_dense = eta.max(1.0 / eta);
        let passed = 1.0 - mean_over_cosines(|cos| Sampled::splat(facets.reflectance(cos, thin_to_dense)))[0];
        let passed_back = passed / sqr(thin_to_dense);
        let [from_above, from_below] = if eta > 1.0 { [passed, passed_back] } else { [passed_back, passed] };
        model.above = Side { lost: above, transmitted: from_above * below / larger };
        model.below = Side { lost: below, transmitted: from_below * above / larger };
        model
    }

    /// The facets.
    #[must_use]
    pub const fn facets(&self) -> AnyFacets {
        self.dielectric.microfacets
    }

    /// Index below (-z) relative to that above (+z).
    #[must_use]
    pub const fn eta(&self) -> f32 {
        self.dielectric.eta
    }

    /// The lobes present.
    #[must_use]
    pub fn lobes(&self) -> Lobes {
        self.dielectric.lobes()
    }

    /// With rougher facets where they are nearly smooth.
    #[must_use]
    pub(super) fn regularized(self) -> Self {
        let microfacets = self.facets().regularized();
        Self::new(Dielectric { microfacets, ..self.dielectric })
    }

    fn side(&self, w: Vector3) -> Side {
        if w.z > 0.0 { self.above } else { self.below }
    }

    /// `M`: what bounces again of the flux from a direction.
    fn lost(&self, w: Vector3) -> f32 {
        if self.side(w).lost == 0.0 {
            return 0.0;
        }
        let eta = if w.z > 0.0 { self.dielectric.eta } else { 1.0 / self.dielectric.eta };
        let alpha = alpha_along(self.facets(), w);
        1.0 - InterfaceEnergy::of(self.facets(), eta).albedo(w.z.abs(), alpha)
    }

    /// Probability that a later bounce leaves on the other side, among the wanted lobes.
    fn p_transmit(&self, wo: Vector3, lobes: Lobes) -> f32 {
        match (lobes.contains(Lobes::GLOSSY_REFLECT), lobes.contains(Lobes::GLOSSY_TRANSMIT)) {
            (true, true) => self.side(wo).transmitted,
            (_, transmits) => f32::from(u8::from(transmits)),
        }
    }

    /// Probability that a sample stands for later bounces; 0 where no glossy lobe is wanted.
    fn p_later(&self, wo: Vector3, lobes: Lobes) -> f32 {
        if lobes.intersects(Lobes::GLOSSY) { self.lost(wo) } else { 0.0 }
    }

    /// f of later bounces in 1/sr.
    fn later(&self, wo: Vector3, wi: Vector3, mode: TransportMode, lobes: Lobes) -> f32 {
        let (side, other) = (self.side(wo), self.side(wi));
        let reflects = same_hemisphere(wo, wi);
        let lobe = if reflects { Lobes::GLOSSY_REFLECT } else { Lobes::GLOSSY_TRANSMIT };
        if other.lost == 0.0 || !lobes.contains(lobe) {
            return 0.0;
        }
        let share = if reflects {
            1.0 - side.transmitted
        } else {
            side.transmitted * radiance_scale(self.index_towards(wi), mode)
        };
        share * FRAC_1_PI / other.lost * self.lost(wo) * self.lost(wi)
    }

    /// Index on the side of `wi` relative to that of the other.
    fn index_towards(&self, wi: Vector3) -> f32 {
        if wi.z < 0.0 { self.dielectric.eta } else { 1.0 / self.dielectric.eta }
    }

    /// f in 1/sr, without the cosine.
    #[must_use]
    pub fn eval(&self, wo: Vector3, wi: Vector3, mode: TransportMode, lobes: Lobes) -> Sampled {
        self.dielectric.eval(wo, wi, mode, lobes) + Sampled::splat(self.later(wo, wi, mode, lobes))
    }

    /// One bounce with the probability E, else evenly to either side.
    #[must_use]
    pub fn sample(
        &self,
        wo: Vector3,
        u_component: f32,
        u: Point2,
        mode: TransportMode,
        lobes: Lobes,
    ) -> Option<BsdfSample> {
        let p_later = self.p_later(wo, lobes);
        let wi = if u_component < p_later {
            let is_through = u_component < p_later * self.p_transmit(wo, lobes);
            let w = warp::sample_cosine_hemisphere(u);
            if is_through == (wo.z > 0.0) { -w } else { w }
        } else {
            let u_component = ((u_component - p_later) / (1.0 - p_later)).min(ONE_MINUS_EPSILON);
            let sample = self.dielectric.sample(wo, u_component, u, mode, lobes)?;
            if sample.is_specular() {
                return Some(sample);
            }
            sample.wi
        };
        let pdf_w = self.pdf(wo, wi, lobes);
        let weight = self.eval(wo, wi, mode, lobes) * (wi.z.abs() / pdf_w);
        let is_sound = pdf_w > 0.0 && pdf_w.is_finite() && weight.is_finite();
        let reflects = same_hemisphere(wo, wi);
        is_sound.then(|| BsdfSample {
            wi,
            weight,
            pdf_w,
            pmf: 0.0,
            lobe: if reflects { Lobes::GLOSSY_REFLECT } else { Lobes::GLOSSY_TRANSMIT },
            eta: if reflects { 1.0 } else { self.index_towards(wi) },
            roughness: self.facets().mean_alpha(),
        })
    }

    /// Density of [`Self::sample`] in 1/sr.
    #[must_use]
    pub fn pdf(&self, wo: Vector3, wi: Vector3, lobes: Lobes) -> f32 {
        let p_later = self.p_later(wo, lobes);
        let p_transmit = self.p_transmit(wo, lobes);
        let p_side = if same_hemisphere(wo, wi) { 1.0 - p_transmit } else { p_transmit };
        p_later * p_side * FRAC_1_PI * wi.z.abs() + (1.0 - p_later) * self.dielectric.pdf(wo, wi, lobes)
    }
}
