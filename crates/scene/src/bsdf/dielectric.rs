//! A transparent interface such as glass or water, smooth or rough: it reflects and refracts.
//!
//! Facets reflect by Fresnel's equations and refract by Snell's law. The facet that turns `wo` into `wi` has the
//! generalised half vector `wm ~ wo + eta wi`, where `eta` is the index on the side of `wi` relative to that of `wo`:
//! `f_r = D F G / (4 |cos_o| |cos_i|)`,
//! `f_t = D (1 - F) G |wi·wm| |wo·wm| / (|cos_o| |cos_i| (wi·wm + wo·wm / eta)²)`, divided by `eta²` for radiance
//! (Walter et al. 2007, "Microfacet Models for Refraction through Rough Surfaces"; SPEC FRES-8).
//! Reflection is chosen with the probability F of the sampled facet. See [`super::microfacet`] for what is lost.

use etendue_math::{Point2, Vector3, sqr};
use etendue_spectrum::Sampled;

use super::facetted::Facets;
use super::fresnel::{reflect, refract};
use super::local::{mirror, same_hemisphere};
use super::microfacet::Microfacets;
use super::{BsdfSample, Lobes, TransportMode};

/// A smooth or rough boundary between transparent media, in the shading frame.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Dielectric<F = Microfacets> {
    /// Roughness.
    pub microfacets: F,
    /// Index below (-z) relative to that above (+z), for all wavelengths of the path.
    pub eta: f32,
}

/// What rough reflection or refraction from `wo` to `wi` depends on.
struct Facet {
    wm: Vector3,
    /// Index on the side of `wi` relative to that of `wo`.
    eta: f32,
    lobe: Lobes,
}

impl<F: Facets> Dielectric<F> {
    /// The lobes present. Equal indices pass light straight on, whatever the roughness.
    #[inline]
    #[must_use]
    pub fn lobes(&self) -> Lobes {
        if self.eta == 1.0 {
            Lobes::SPECULAR_TRANSMIT
        } else if self.microfacets.is_smooth() {
            Lobes::SPECULAR
        } else {
            Lobes::GLOSSY
        }
    }

    #[inline]
    fn is_smooth(&self) -> bool {
        self.eta == 1.0 || self.microfacets.is_smooth()
    }

    /// f in 1/sr, without the cosine.
    #[inline]
    #[must_use]
    pub fn eval(&self, wo: Vector3, wi: Vector3, mode: TransportMode, lobes: Lobes) -> Sampled {
        let Some(Facet { wm, eta, lobe }) = self.facet(wo, wi, lobes) else { return Sampled::ZERO };
        let f = self.microfacets.reflectance(wo.dot(wm), self.eta);
        let d_g = self.microfacets.d(wm) * self.microfacets.g_over_cosines(wo, wi);
        let value = if lobe == Lobes::GLOSSY_REFLECT {
            0.25 * d_g * f
        } else {
            let scale = radiance_scale(eta, mode);
            d_g * (1.0 - f) * scale * wo.dot(wm).abs() * facet_jacobian(wo, wi, wm, eta)
        };
        Sampled::splat(value)
    }

    /// Reflection or refraction by `u_component`, at a facet visible from `wo`.
    #[inline]
    #[must_use]
    pub fn sample(
        &self,
        wo: Vector3,
        u_component: f32,
        u: Point2,
        mode: TransportMode,
        lobes: Lobes,
    ) -> Option<BsdfSample> {
        if self.is_smooth() {
            self.sample_smooth(wo, u_component, mode, lobes)
        } else {
            self.sample_rough(wo, u_component, u, mode, lobes)
        }
    }

    /// Density of [`Self::sample`] in 1/sr.
    #[inline]
    #[must_use]
    pub fn pdf(&self, wo: Vector3, wi: Vector3, lobes: Lobes) -> f32 {
        let Some(Facet { wm, eta, lobe }) = self.facet(wo, wi, lobes) else { return 0.0 };
        let f = self.microfacets.reflectance(wo.dot(wm), self.eta);
        let (p_reflect, p_transmit) = probabilities(f, Lobes::GLOSSY_REFLECT, Lobes::GLOSSY_TRANSMIT, lobes);
        let pdf_m = self.microfacets.visible_normal_pdf(wo, wm);
        if lobe == Lobes::GLOSSY_REFLECT {
            p_reflect * pdf_m / (4.0 * wo.dot(wm).abs())
        } else {
            p_transmit * pdf_m * facet_jacobian(wo, wi, wm, eta)
        }
    }

    #[inline]
    fn sample_smooth(
        &self,
        wo: Vector3,
        u_component: f32,
        mode: TransportMode,
        lobes: Lobes,
    ) -> Option<BsdfSample> {
        // Equal indices reflect nothing, not even what rounding would leave.
        let f = if self.eta == 1.0 { 0.0 } else { self.microfacets.reflectance(wo.z, self.eta) };
        let (p_reflect, p_transmit) =
            probabilities(f, Lobes::SPECULAR_REFLECT, Lobes::SPECULAR_TRANSMIT, lobes);
        if u_component < p_reflect {
            let weight = Sampled::splat(f / p_reflect);
            return Some(BsdfSample::specular(mirror(wo), weight, p_reflect, Lobes::SPECULAR_REFLECT, 1.0));
        }
        if p_transmit == 0.0 {
            return None;
        }
        let refraction = refract(wo, Vector3::new(0.0, 0.0, 1.0), self.eta)?;
        let weight = Sampled::splat((1.0 - f) / p_transmit * radiance_scale(refraction.eta, mode));
        (refraction.wt.z != 0.0).then_some(BsdfSample::specular(
            refraction.wt,
            weight,
            p_transmit,
            Lobes::SPECULAR_TRANSMIT,
            refraction.eta,
        ))
    }

    #[inline]
    fn sample_rough(
        &self,
        wo: Vector3,
        u_component: f32,
        u: Point2,
        mode: TransportMode,
        lobes: Lobes,
    ) -> Option<BsdfSample> {
        let wm = self.microfacets.sample_visible_normal(wo, u);
        let pdf_m = self.microfacets.visible_normal_pdf(wo, wm);
        let f = self.microfacets.reflectance(wo.dot(wm), self.eta);
        let (p_reflect, p_transmit) = probabilities(f, Lobes::GLOSSY_REFLECT, Lobes::GLOSSY_TRANSMIT, lobes);
        let (wi, weight, pdf_w, lobe, eta) = if u_component < p_reflect {
            let wi = reflect(wo, wm);
            if !same_hemisphere(wo, wi) {
                return None;
            }
            let pdf_w = p_reflect * pdf_m / (4.0 * wo.dot(wm).abs());
            (wi, f / p_reflect, pdf_w, Lobes::GLOSSY_REFLECT, 1.0)
        } else {
            if p_transmit == 0.0 {
                return None;
            }
            let refraction = refract(wo, wm, self.eta)?;
            let (wi, eta) = (refraction.wt.try_normalized()?, refraction.eta);
            if !same_hemisphere(-wo, wi) {
                return None;
            }
            let pdf_w = p_transmit * pdf_m * facet_jacobian(wo, wi, wm, eta);
            (wi, (1.0 - f) / p_transmit * radiance_scale(eta, mode), pdf_w, Lobes::GLOSSY_TRANSMIT, eta)
        };
        (pdf_w > 0.0 && pdf_w.is_finite()).then(|| BsdfSample {
            wi,
            weight: Sampled::splat(weight * self.microfacets.g_over_g1(wo, wi)),
            pdf_w,
            pmf: 0.0,
            lobe,
            eta,
            roughness: self.microfacets.mean_alpha(),
        })
    }

    /// The facet that turns `wo` into `wi`; `None` if there is none or its lobe is not wanted.
    #[inline]
    fn facet(&self, wo: Vector3, wi: Vector3, lobes: Lobes) -> Option<Facet> {
        if self.is_smooth() || wo.z == 0.0 || wi.z == 0.0 {
            return None;
        }
        let (eta, lobe) = if same_hemisphere(wo, wi) {
            (1.0, Lobes::GLOSSY_REFLECT)
        } else {
            (if wo.z > 0.0 { self.eta } else { 1.0 / self.eta }, Lobes::GLOSSY_TRANSMIT)
        };
        if !lobes.contains(lobe) {
            return None;
        }
        let wm = (wi * eta + wo).try_normalized()?;
        let wm = if wm.z < 0.0 { -wm } else { wm };
        // A facet seen from its back does not scatter.
        (wm.dot(wi) * wi.z > 0.0 && wm.dot(wo) * wo.z > 0.0).then_some(Facet { wm, eta, lobe })
    }
}

/// Solid angle of facet normals per solid angle of refracted directions [Walter 2007 (17)].
#[inline]
pub(super) fn facet_jacobian(wo: Vector3, wi: Vector3, wm: Vector3, eta: f32) -> f32 {
    wi.dot(wm).abs() / sqr(wi.dot(wm) + wo.dot(wm) / eta)
}

/// The one place where radiance changes by the square of the index ratio; `eta` is the index on the side of `wi`
/// relative to that of `wo` (SPEC FRES-8).
#[inline]
pub(super) fn radiance_scale(eta: f32, mode: TransportMode) -> f32 {
    match mode {
        TransportMode::Radiance => 1.0 / sqr(eta),
        TransportMode::Importance => 1.0,
    }
}

/// Probabilities of reflection and transmission with reflectance `f` among the wanted lobes; both 0 if none is.
#[inline]
fn probabilities(f: f32, reflect: Lobes, transmit: Lobes, lobes: Lobes) -> (f32, f32) {
    match (lobes.contains(reflect) && f > 0.0, lobes.contains(transmit) && f < 1.0) {
        (true, true) => (f, 1.0 - f),
        (true, false) => (1.0, 0.0),
        (false, true) => (0.0, 1.0),
        (false, false) => (0.0, 0.0),
    }
}
