//! Mirrors in V-shaped grooves, by Torrance and Sparrow and by Cook and Torrance.

use etendue_spectrum::{Sampled, Wavelengths};

use crate::bsdf::Classic;
use crate::bsdf::classic::{FacetDistribution, FacetFresnel, VGroove};
use crate::bsdf::fresnel::fresnel_conductor;
use crate::material::metal::{Metal, MetalNames};
use crate::material::{MaterialContext, limits, spec};
use crate::parameters::{ParameterSpec, Parameters};
use crate::texture::{FloatTexture, SpectrumTexture, Textures};

/// Parameters of `torrancesparrow` and `cooktorrance`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct VGrooveMaterial {
    /// Diffuse albedo.
    pub kd: SpectrumTexture,
    /// Share of the light that meets facets.
    pub strength: f32,
    /// What facets are made of.
    pub metal: Metal,
    /// Whether Schlick's fit stands for Fresnel's equations.
    pub uses_schlick: bool,
    /// Root mean square angle or slope, times the square root of 2.
    pub roughness: FloatTexture,
    /// Distribution of the facets.
    pub distribution: FacetDistribution,
}

impl VGrooveMaterial {
    /// What scene files may say.
    pub const PARAMETERS: &'static [ParameterSpec] = &[
        ParameterSpec {
            name: "kd",
            kind: "spectrum texture",
            default: "0",
            unit: "",
            doc: "Albedo of the diffuse part, in [0, 1]; at most 1 - strength.",
        },
        ParameterSpec {
            name: "strength",
            kind: "float",
            default: "1",
            unit: "",
            doc: "Share of the light that meets facets, in [0, 1].",
        },
        spec::METAL_ETA,
        spec::METAL_K,
        spec::METAL_REFLECTANCE,
        ParameterSpec {
            name: "fresnel",
            kind: "string",
            default: "exact",
            unit: "",
            doc: "exact: Fresnel's equations. schlick: his fit, from the reflectance along the normal.",
        },
        ParameterSpec {
            name: "roughness",
            kind: "float texture",
            default: "0.2",
            unit: "",
            doc: "Root mean square angle of facets (slope for cooktorrance) times the square root of 2, 0.001 to 1.",
        },
        spec::DISPLACEMENT,
        spec::NORMAL_MAP,
    ];

    pub(super) fn build(p: &mut Parameters<'_, '_>, distribution: FacetDistribution) -> Self {
        let kd = limits::albedo(p, "kd", 0.0);
        let strength = limits::constant_within(p, "strength", 1.0, limits::SHARES);
        limits::sum_of_albedos(p, ["kd", "strength"], [kd, limits::grey(strength)]);
        Self {
            kd,
            strength,
            metal: Metal::build(p, &MetalNames { eta: "eta", k: "k" }),
            uses_schlick: p.choice("fresnel", "exact", &[("exact", false), ("schlick", true)]),
            roughness: limits::float_within(p, "roughness", 0.2, limits::SLOPES),
            distribution,
        }
    }

    pub(super) fn bsdf(&self, textures: &Textures, ctx: &MaterialContext, lambda: &Wavelengths) -> Classic {
        let kd = textures.eval_spectrum(self.kd, &ctx.texture, lambda).clamp(0.0, 1.0);
        let excess = (kd.max_value() + self.strength).max(1.0);
        let (eta, k) = self.metal.eta_k(textures, ctx, lambda);
        let fresnel = if self.uses_schlick {
            FacetFresnel::Schlick(fresnel_conductor(1.0, eta, k).min(Sampled::ONE))
        } else {
            FacetFresnel::Exact { eta, k }
        };
        Classic::VGroove(VGroove {
            kd: kd / excess,
            fresnel,
            strength: self.strength / excess,
            m: limits::clamp(textures.eval_float(self.roughness, &ctx.texture), limits::SLOPES),
            distribution: self.distribution,
        })
    }

    pub(super) const fn is_uniform(&self) -> bool {
        self.kd.constant().is_some() && self.metal.is_constant() && self.roughness.constant().is_some()
    }
}
