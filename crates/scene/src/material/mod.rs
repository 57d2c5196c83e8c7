//! Materials: what a surface is made of, before a point on it is known.
//!
//! A material holds textures; [`Material::bsdf`] evaluates them at a point, perturbs the shading frame and returns a
//! [`Bsdf`]. Names, parameters and defaults are those of pbrt-v4.

mod bump;
mod coat;
mod index;
mod metal;
mod normal_map;
mod perturbation;
mod roughness;
mod spec;

mod coated_conductor;
mod coated_diffuse;
mod conductor;
mod dielectric;
mod diffuse;
mod diffuse_transmission;
mod mix;
mod thin_dielectric;

#[cfg(test)]
mod tests;

use std::collections::HashMap;

use etendue_geometry::SurfacePoint;
use etendue_math::{Normal3, Vector3};
use etendue_spectrum::{Spectrum, Wavelengths};

pub use coat::Coat;
pub use coated_conductor::CoatedConductorMaterial;
pub use coated_diffuse::CoatedDiffuseMaterial;
pub use conductor::ConductorMaterial;
pub use dielectric::DielectricMaterial;
pub use diffuse::DiffuseMaterial;
pub use diffuse_transmission::DiffuseTransmissionMaterial;
pub use index::RefractiveIndex;
pub use metal::Metal;
pub use mix::MixMaterial;
pub use normal_map::NormalMap;
pub use perturbation::Perturbation;
pub use roughness::{Roughness, RoughnessScale};
pub use thin_dielectric::ThinDielectricMaterial;

use crate::bsdf::Bsdf;
use crate::diagnostics::nearest_name;
use crate::parameters::{ParameterSpec, Parameters};
use crate::texture::{SpectrumTexture, TextureContext, Textures};

/// The kinds of material.
///
/// To add one: write a file with a plain struct, `PARAMETERS`, `build` and `bsdf` as in `diffuse.rs`, add a variant here,
/// follow the compiler through the matches below, and add it to [`MATERIALS`].
#[derive(Clone, Debug, PartialEq)]
pub enum Material {
    /// Matte.
    Diffuse(DiffuseMaterial),
    /// Matte under a clear coat.
    CoatedDiffuse(CoatedDiffuseMaterial),
    /// Metal.
    Conductor(ConductorMaterial),
    /// Metal under a clear coat.
    CoatedConductor(CoatedConductorMaterial),
    /// Glass and water.
    Dielectric(DielectricMaterial),
    /// A pane.
    ThinDielectric(ThinDielectricMaterial),
    /// A sheet that light passes.
    DiffuseTransmission(DiffuseTransmissionMaterial),
    /// One of two others.
    Mix(MixMaterial),
    /// None: the surface only bounds participating media, and light passes it.
    Interface,
}

/// What documentation says of a material.
#[derive(Clone, Copy, Debug)]
pub struct MaterialSpec {
    /// Name in scene files.
    pub name: &'static str,
    /// One line.
    pub doc: &'static str,
    /// Its parameters.
    pub parameters: &'static [ParameterSpec],
}

/// All materials that scene files may name.
pub const MATERIALS: &[MaterialSpec] = &[
    MaterialSpec {
        name: "diffuse",
        doc: "Reflects light evenly into all directions.",
        parameters: DiffuseMaterial::PARAMETERS,
    },
    MaterialSpec {
        name: "coateddiffuse",
        doc: "A diffuse base under a clear coat: plastic, varnished wood.",
        parameters: CoatedDiffuseMaterial::PARAMETERS,
    },
    MaterialSpec {
        name: "conductor",
        doc: "Metal, smooth or rough.",
        parameters: ConductorMaterial::PARAMETERS,
    },
    MaterialSpec {
        name: "coatedconductor",
        doc: "Metal under a clear coat.",
        parameters: CoatedConductorMaterial::PARAMETERS,
    },
    MaterialSpec {
        name: "dielectric",
        doc: "Glass, water: reflects and refracts, smooth or rough.",
        parameters: DielectricMaterial::PARAMETERS,
    },
    MaterialSpec {
        name: "thindielectric",
        doc: "A pane of glass as a single surface.",
        parameters: ThinDielectricMaterial::PARAMETERS,
    },
    MaterialSpec {
        name: "diffusetransmission",
        doc: "A thin sheet that scatters light to both sides.",
        parameters: DiffuseTransmissionMaterial::PARAMETERS,
    },
    MaterialSpec {
        name: "mix",
        doc: "One of two materials at each point, in a given proportion.",
        parameters: MixMaterial::PARAMETERS,
    },
    MaterialSpec {
        name: "interface",
        doc: "An invisible boundary between participating media.",
        parameters: &[],
    },
];

/// The point at which a material is evaluated.
#[derive(Clone, Copy, Debug)]
pub struct MaterialContext {
    /// Where textures are evaluated.
    pub texture: TextureContext,
    /// Unit vector towards the viewer.
    pub wo: Vector3,
    /// Geometric unit normal.
    pub ng: Normal3,
    /// Shading unit normal.
    pub ns: Normal3,
    /// First shading tangent.
    pub shading_dpdu: Vector3,
    /// Second shading tangent.
    pub shading_dpdv: Vector3,
    /// Change of the shading normal with u.
    pub dndu: Vector3,
    /// Change of the shading normal with v.
    pub dndv: Vector3,
}

impl MaterialContext {
    /// From a point of a surface.
    #[inline]
    #[must_use]
    pub fn new(texture: TextureContext, surface: &SurfacePoint, wo: Vector3) -> Self {
        Self {
            texture,
            wo,
            ng: surface.ng,
            ns: surface.ns,
            shading_dpdu: surface.shading_dpdu,
            shading_dpdv: surface.shading_dpdv,
            dndu: surface.dndu,
            dndv: surface.dndv,
        }
    }

    /// With other shading tangents; their cross product becomes the normal, on the side of the geometric normal.
    /// Tangents that span no plane change nothing.
    fn with_tangents(&self, dpdu: Vector3, dpdv: Vector3) -> Self {
        let Some(ns) = dpdu.cross(dpdv).try_normalized() else { return *self };
        let ns = ns.as_normal().facing(self.ng.as_vector());
        Self { ns, shading_dpdu: dpdu, shading_dpdv: dpdv, ..*self }
    }
}

impl Default for Material {
    /// The material of shapes that name none: grey and diffuse.
    fn default() -> Self {
        Self::Diffuse(DiffuseMaterial {
            reflectance: SpectrumTexture::Constant(Spectrum::Constant(0.5)),
            perturbation: Perturbation::None,
        })
    }
}

impl Material {
    /// Builds the material that an entity describes, where `named` are those with a name defined before. Problems are
    /// reported; `None` means that there is no material because of them.
    pub fn build(mut p: Parameters<'_, '_>, named: &HashMap<String, Self>) -> Option<Self> {
        let q = &mut p;
        let material = match q.entity().type_name.as_str() {
            "diffuse" => Self::Diffuse(DiffuseMaterial::build(q)),
            "coateddiffuse" => Self::CoatedDiffuse(CoatedDiffuseMaterial::build(q)),
            "conductor" => Self::Conductor(ConductorMaterial::build(q)),
            "coatedconductor" => Self::CoatedConductor(CoatedConductorMaterial::build(q)),
            "dielectric" => Self::Dielectric(DielectricMaterial::build(q)),
            "thindielectric" => Self::ThinDielectric(ThinDielectricMaterial::build(q)),
            "diffusetransmission" => Self::DiffuseTransmission(DiffuseTransmissionMaterial::build(q)),
            "mix" => Self::Mix(MixMaterial::build(q, named)?),
            "interface" | "none" | "" => Self::Interface,
            other => {
                report_unknown(q, other);
                return None;
            }
        };
        p.finish();
        Some(material)
    }

    /// True if the surface does not exist for light anywhere.
    #[inline]
    #[must_use]
    pub const fn is_interface(&self) -> bool {
        matches!(self, Self::Interface)
    }

    /// This material, or the part of a mixture that is at the point.
    #[inline]
    #[must_use]
    pub fn resolve(&self, textures: &Textures, ctx: &MaterialContext) -> &Self {
        let mut material = self;
        while let Self::Mix(mix) = material {
            material = mix.choose(textures, ctx);
        }
        material
    }

    /// How the material scatters light at a point; `None` where light passes as if there were no surface. Wavelengths
    /// but the first are given up where refraction depends on them.
    #[must_use]
    pub fn bsdf(&self, textures: &Textures, ctx: &MaterialContext, lambda: &mut Wavelengths) -> Option<Bsdf> {
        let material = self.resolve(textures, ctx);
        let ctx = &material.perturbation()?.apply(textures, ctx);
        let kind = match material {
            Self::Diffuse(material) => material.bsdf(textures, ctx, lambda),
            Self::CoatedDiffuse(material) => material.bsdf(textures, ctx, lambda),
            Self::Conductor(material) => material.bsdf(textures, ctx, lambda),
            Self::CoatedConductor(material) => material.bsdf(textures, ctx, lambda),
            Self::Dielectric(material) => material.bsdf(textures, ctx, lambda),
            Self::ThinDielectric(material) => material.bsdf(textures, lambda),
            Self::DiffuseTransmission(material) => material.bsdf(textures, ctx, lambda),
            Self::Mix(_) | Self::Interface => return None,
        };
        Some(Bsdf::new(ctx.ns, ctx.ng, ctx.shading_dpdu, kind))
    }

    /// What perturbs the shading normal; `None` for materials that have no normal of their own.
    #[must_use]
    pub const fn perturbation(&self) -> Option<&Perturbation> {
        match self {
            Self::Diffuse(material) => Some(&material.perturbation),
            Self::CoatedDiffuse(material) => Some(&material.perturbation),
            Self::Conductor(material) => Some(&material.perturbation),
            Self::CoatedConductor(material) => Some(&material.perturbation),
            Self::Dielectric(material) => Some(&material.perturbation),
            Self::ThinDielectric(material) => Some(&material.perturbation),
            Self::DiffuseTransmission(material) => Some(&material.perturbation),
            Self::Mix(_) | Self::Interface => None,
        }
    }

    /// Number of mixtures inside one another.
    fn depth(&self) -> u64 {
        if let Self::Mix(mix) = self { mix.depth() } else { 0 }
    }
}

fn report_unknown(p: &mut Parameters<'_, '_>, name: &str) {
    let span = p.span();
    let error = p.diagnostics().error(span, format!("unknown material \"{name}\""));
    let known = || MATERIALS.iter().map(|material| material.name);
    error.with_help(match nearest_name(name, known()) {
        Some(near) => format!("did you mean \"{near}\"?"),
        None => format!("known are: {}", known().collect::<Vec<_>>().join(", ")),
    });
}
