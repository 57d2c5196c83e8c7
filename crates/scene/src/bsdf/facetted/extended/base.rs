//! What lies under coat and sheen: metal, a diffuse base under a glossy surface, and glass, each to its share.
//!
//! All three have the same facets. Metal reflects Schlick's fit of the base colour; the others reflect
//! `w (f0 + (1 - f0)(1 - wo·h)⁵)` with `f0 = min(((n - 1)/(n + 1))² c, 1)`, where w and c are weight and colour of
//! `KHR_materials_specular`. What is not reflected, wavelength by wavelength, goes into the diffuse base or through the
//! glass, tinted by the base colour.
//!
//! Glass is thin, two parallel faces without thickness whose facets blur what is seen as those of a mirror would, mirrored
//! by the surface (`KHR_materials_transmission`), or the boundary of a solid, which refracts (`KHR_materials_volume`; Walter
//! et al. 2007). Facets too narrow to see make Dirac lobes of it. Light that bounces several times among facets is
//! added for all but rough solid glass; from thin glass it leaves to both sides.

use std::f32::consts::FRAC_1_PI;

use etendue_math::{Point2, Vector3, lerp, safe_sqrt, sqr, warp};
use etendue_spectrum::Sampled;

use super::super::compensated::{alpha_along, mean_energy};
use super::super::energy::{EnergyTable, N_PARTS};
use super::super::principled::{later_bounces, mean_of_schlick};
use super::super::{AnyFacets, FacetShape};
use super::ThinFilm;
use crate::bsdf::TransportMode;
use crate::bsdf::dielectric::{facet_jacobian, radiance_scale};
use crate::bsdf::fresnel::{reflect, refract, schlick_weight};
use crate::bsdf::local::same_hemisphere;
use crate::bsdf::microfacet::Microfacets;

/// Facets this narrow cannot be told from a mirror.
pub(super) const LEAST_ALPHA: f32 = 2.0 * Microfacets::SMOOTH_BELOW;
/// Solids of a smaller index do not bend light: half vectors would be lost in rounding.
const LEAST_BENDING_INDEX: f32 = 1.02;

/// The base in the shading frame, seen from above. Functions with an index `below` take that of the other side relative to
/// this one: 1 over the index for views from inside a solid.
#[derive(Clone, Copy, Debug)]
pub(super) struct Base {
    /// Albedo, reflectance of metal and tint of glass.
    pub(super) color: Sampled,
    /// Reflectance of what is not metal, along the normal.
    pub(super) f0: Sampled,
    /// Weight of that reflection.
    pub(super) specular: f32,
    /// Share of metal.
    pub(super) metal: f32,
    /// Share of glass in what is not metal.
    pub(super) transmission: f32,
    /// Index of a solid, 1 where light is not bent.
    pub(super) eta: f32,
    /// True if the glass fills what is below.
    pub(super) is_solid: bool,
    pub(super) facets: Microfacets,
    /// The facets whose albedo is in the tables: those before widening.
    pub(super) tabulated: AnyFacets,
    /// `E_avg` of those.
    pub(super) mean_energy: f32,
    pub(super) film: ThinFilm,
    pub(super) lambda_nm: [f32; 4],
}

impl Base {
    /// The index of a solid that bends light; 1 for all others.
    pub(super) fn bending_index(eta: f32, is_solid: bool) -> f32 {
        if is_solid && eta >= LEAST_BENDING_INDEX { eta } else { 1.0 }
    }

    pub(super) fn glass(&self) -> f32 {
        (1.0 - self.metal) * self.transmission
    }

    pub(super) fn plastic(&self) -> f32 {
        (1.0 - self.metal) * (1.0 - self.transmission)
    }

    fn is_sharp(&self) -> bool {
        let (x, y) = self.facets.alpha();
        x.max(y) <= LEAST_ALPHA
    }

    /// True if glass reflects as a mirror.
    pub(super) fn has_mirror(&self) -> bool {
        self.glass() > 0.0 && self.is_sharp()
    }

    /// True if glass sends what passes into a single direction.
    pub(super) fn passes_sharply(&self) -> bool {
        self.glass() > 0.0 && (self.is_sharp() || (self.is_solid && self.eta == 1.0))
    }

    /// True if glass spreads what passes.
    pub(super) fn passes_rough(&self) -> bool {
        self.glass() > 0.0 && !self.passes_sharply()
    }

    /// True if anything is glossy.
    pub(super) fn has_gloss(&self) -> bool {
        self.metal > 0.0 || self.specular * (self.plastic() + self.glossy_glass()) > 0.0
    }

    /// Share of glass whose reflection belongs to the glossy lobe.
    fn glossy_glass(&self) -> f32 {
        if self.is_sharp() { 0.0 } else { self.glass() }
    }

    /// What facets of anything but metal reflect, from outside.
    fn outside_reflectance(&self, cos: f32) -> Sampled {
        self.filmed(cos, self.f0) * self.specular
    }

    /// What facets of glass reflect, with the index of the other side relative to this one.
    pub(super) fn glass_reflectance(&self, cos: f32, below: f32) -> Sampled {
        if below >= 1.0 {
            return self.outside_reflectance(cos);
        }
        let sin2 = (1.0 - sqr(cos)) / sqr(below);
        if sin2 >= 1.0 { Sampled::ONE } else { self.outside_reflectance(safe_sqrt(1.0 - sin2)) }
    }

    /// Schlick's fit from the reflectance along the normal, or the film on it.
    fn filmed(&self, cos: f32, f0: Sampled) -> Sampled {
        let bare = f0 + (Sampled::ONE - f0) * schlick_weight(cos);
        if self.film.share == 0.0 {
            return bare;
        }
        bare.lerp(self.film.reflectance(cos, f0, self.lambda_nm), self.film.share)
    }

    /// What all facets of the glossy lobe reflect together.
    pub(super) fn reflectance(&self, cos: f32, below: f32) -> Sampled {
        let mut sum = self.outside_reflectance(cos) * self.plastic();
        if self.metal > 0.0 {
            sum += self.filmed(cos, self.color) * self.metal;
        }
        if self.glossy_glass() > 0.0 {
            sum += self.glass_reflectance(cos, below) * self.glossy_glass();
        }
        sum
    }

    /// How far the facets are from isotropic ones, whose tables serve all.
    fn brushing(&self) -> f32 {
        let (x, y) = self.tabulated.alphas.alpha();
        (x - y).abs()
    }

    /// About the greatest share that facets of glass reflect, without tables and films: for sampling.
    pub(super) fn glass_reflectance_about(&self, cos: f32, below: f32) -> f32 {
        let sin2 = (1.0 - sqr(cos)) / sqr(below);
        if below < 1.0 && sin2 >= 1.0 {
            return 1.0;
        }
        let cos = if below < 1.0 { safe_sqrt(1.0 - sin2) } else { cos };
        let f0 = self.f0.max_value().max(0.2 * self.film.share);
        self.specular * lerp(schlick_weight(cos), f0, 1.0)
    }

    /// The same of all that the glossy lobe reflects.
    pub(super) fn reflectance_about(&self, cos: f32, below: f32) -> f32 {
        let metal = lerp(schlick_weight(cos), self.color.max_value(), 1.0);
        self.metal * metal
            + self.plastic() * self.glass_reflectance_about(cos, 1.0)
            + self.glossy_glass() * self.glass_reflectance_about(cos, below)
    }

    /// About what leaves by the diffuse base or through thin glass, for sampling.
    pub(super) fn passed_about(&self, w: Vector3) -> f32 {
        let (table, alpha) = (Self::table(), alpha_along(self.tabulated, w));
        let (e, b) = table.albedos(w.z, alpha);
        1.0 - self.specular * (self.f0.min_value() * (e - b) + b)
    }

    /// `E_avg`.
    pub(super) fn mean_energy(facets: AnyFacets) -> f32 {
        let table = Self::table();
        mean_energy(facets, |alpha| table.mean(alpha), |cos, alpha| table.albedo(cos, alpha))
    }

    fn table() -> &'static EnergyTable {
        EnergyTable::of(FacetShape::Ggx)
    }

    /// `1 - E` of a direction.
    pub(super) fn lost(&self, w: Vector3) -> f32 {
        let lost = 1.0 - Self::table().albedo(w.z, alpha_along(self.tabulated, w));
        // Seen flatly, brushed facets lose up to a fifth less than tables say, which must not make light.
        lost * (1.0 - 0.18 * self.brushing() * safe_sqrt(1.0 - sqr(w.z)))
    }

    /// What all bounces leave to the diffuse base or to thin glass.
    pub(super) fn passed(&self, w: Vector3) -> Sampled {
        let (table, alpha) = (Self::table(), alpha_along(self.tabulated, w));
        let (e, b) = table.albedos(w.z, alpha);
        let mut once = self.f0 * (e - b) + Sampled::splat(b);
        if self.film.share > 0.0 {
            // What the film adds to Schlick's fit varies little enough for a few points.
            let added = |cos| {
                let bare = self.f0 + (Sampled::ONE - self.f0) * schlick_weight(cos);
                self.film.reflectance(cos, self.f0, self.lambda_nm) - bare
            };
            let sum = table.cosines(w.z, alpha).map(added).into_iter().fold(Sampled::ZERO, |sum, a| sum + a);
            once += sum * (e * self.film.share / N_PARTS as f32);
        }
        let reflected = once * self.specular + self.later_outside() * (1.0 - e);
        // Tables err by up to 1.6 % here, which must not make light.
        (Sampled::ONE - reflected).max(Sampled::ZERO) * (1.0 - 0.02 * self.brushing())
    }

    /// `2 ∫ F cos d cos` of a filmed surface: Schlick's fit exactly, films by Gauss's rule of two points.
    fn mean_reflectance(&self, f0: Sampled) -> Sampled {
        const GAUSS_2: [(f32, f32); 2] = [(0.355_051, 0.363_917), (0.844_949, 0.636_083)];
        let bare = f0.map(mean_of_schlick);
        if self.film.share == 0.0 {
            return bare;
        }
        let at = |(cos, weight)| self.film.reflectance(cos, f0, self.lambda_nm) * weight;
        bare.lerp(at(GAUSS_2[0]) + at(GAUSS_2[1]), self.film.share)
    }

    /// Share of white later bounces that what is not metal reflects.
    fn later_outside(&self) -> Sampled {
        (self.mean_reflectance(self.f0) * self.specular).map(|f| later_bounces(f, self.mean_energy))
    }

    /// Share of white later bounces that the glossy lobe reflects.
    fn later(&self) -> Sampled {
        let thin = if self.eta == 1.0 { self.glossy_glass() } else { 0.0 };
        let mut sum = self.later_outside() * (self.plastic() + thin);
        if self.metal > 0.0 {
            sum += self.mean_reflectance(self.color).map(|f| later_bounces(f, self.mean_energy)) * self.metal;
        }
        sum
    }

    /// `(1 - E(wo)) (1 - E(wi)) / (pi (1 - E_avg))`: all later bounces of white facets.
    fn later_lobe(&self, to: Vector3, from: Vector3) -> f32 {
        self.lost(to) * self.lost(from) * (FRAC_1_PI / (1.0 - self.mean_energy).max(1e-6))
    }

    /// One bounce of white facets, in 1/sr.
    fn once(&self, to: Vector3, from: Vector3, h: Vector3) -> f32 {
        // Along the horizon it would be infinite.
        (0.25 * self.facets.d(h) * self.facets.g_over_cosines(to, from)).min(f32::MAX)
    }

    /// f of the glossy lobe in 1/sr.
    pub(super) fn glossy(&self, to: Vector3, from: Vector3, below: f32) -> Sampled {
        let Some(h) = (to + from).try_normalized() else { return Sampled::ZERO };
        self.reflectance(half_cosine(to, from), below) * self.once(to, from, h)
            + self.later() * self.later_lobe(to, from)
    }

    /// f in 1/sr of what rough glass passes, to a direction below.
    pub(super) fn transmitted(&self, wo: Vector3, wi: Vector3, below: f32, mode: TransportMode) -> Sampled {
        let tint = self.color * self.glass();
        if below == 1.0 {
            let image = Vector3::new(wi.x, wi.y, -wi.z);
            let Some(h) = (wo + image).try_normalized() else { return Sampled::ZERO };
            let once =
                (Sampled::ONE - self.outside_reflectance(half_cosine(wo, image))) * self.once(wo, image, h);
            let later = (Sampled::ONE - self.later_outside()) * self.later_lobe(wo, image);
            return tint * (once + later);
        }
        let Some(h) = refracting_facet(wo, wi, below) else { return Sampled::ZERO };
        let passed = Sampled::ONE - self.glass_reflectance(wo.dot(h), below);
        let facets = self.facets.d(h) * self.facets.g_over_cosines(wo, wi) * wo.dot(h);
        let refracted = facets * facet_jacobian(wo, wi, h, below) * radiance_scale(below, mode);
        tint * passed * refracted.min(f32::MAX)
    }

    /// A direction of the glossy lobe: one bounce with the probability E, else evenly.
    pub(super) fn sample_glossy(&self, wo: Vector3, u_choice: f32, u: Point2) -> Vector3 {
        if u_choice < self.lost(wo) {
            return warp::sample_cosine_hemisphere(u);
        }
        reflect(wo, self.facets.sample_visible_normal(wo, u))
    }

    /// Density of [`Self::sample_glossy`] in 1/sr.
    pub(super) fn glossy_pdf(&self, wo: Vector3, wi: Vector3) -> f32 {
        let Some(h) = (wo + wi).try_normalized() else { return 0.0 };
        let lost = self.lost(wo);
        let once = self.facets.visible_normal_pdf(wo, h) / (4.0 * wo.dot(h));
        lost * FRAC_1_PI * wi.z + (1.0 - lost) * once
    }

    /// A direction below that rough glass passes light to.
    pub(super) fn sample_transmitted(
        &self,
        wo: Vector3,
        below: f32,
        u_choice: f32,
        u: Point2,
    ) -> Option<Vector3> {
        if below == 1.0 {
            let image = self.sample_glossy(wo, u_choice, u);
            return Some(Vector3::new(image.x, image.y, -image.z));
        }
        refract(wo, self.facets.sample_visible_normal(wo, u), below)?.wt.try_normalized()
    }

    /// Density of [`Self::sample_transmitted`] in 1/sr.
    pub(super) fn transmitted_pdf(&self, wo: Vector3, wi: Vector3, below: f32) -> f32 {
        if below == 1.0 {
            return self.glossy_pdf(wo, Vector3::new(wi.x, wi.y, -wi.z));
        }
        let Some(h) = refracting_facet(wo, wi, below) else { return 0.0 };
        self.facets.visible_normal_pdf(wo, h) * facet_jacobian(wo, wi, h, below)
    }
}

/// Cosine between a direction and the half vector, to the last bit the same for both: films are sensitive.
fn half_cosine(a: Vector3, b: Vector3) -> f32 {
    (0.5 * (a + b).length()).min(1.0)
}

/// The facet that refracts `wo` above to `wi` below; `None` if only its back would.
fn refracting_facet(wo: Vector3, wi: Vector3, below: f32) -> Option<Vector3> {
    let h = (wi * below + wo).try_normalized()?;
    let h = if h.z < 0.0 { -h } else { h };
    (!same_hemisphere(wo, wi) && wo.dot(h) > 0.0 && wi.dot(h) < 0.0).then_some(h)
}
