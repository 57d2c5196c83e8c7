//! Materials: what a surface is made of, before a point on it is known.
//!
//! A material holds textures; [`Materials::bsdf`] evaluates them at a point, perturbs the shading frame and returns a
//! [`Bsdf`]. Names, parameters and defaults are those of pbrt-v4. A material is plain data: its textures, its normal map
//! and the parts of a mixture are ids.

mod context;
mod materials;

mod bump;
mod coat;
mod facet_options;
mod index;
mod limits;
mod metal;
mod normal_map;
mod perturbation;
mod roughness;
mod sharp;
mod spec;
mod uniform;

pub mod classic;
mod coated_conductor;
mod coated_diffuse;
mod conductor;
mod dielectric;
mod diffuse;
mod diffuse_transmission;
mod hair;
mod measured;
mod mix;
mod principled;
mod principled_extensions;
mod tabulated;
mod thin_dielectric;

#[cfg(test)]
mod tests;

use std::collections::HashMap;

use etendue_spectrum::{Spectrum, Wavelengths};

pub use classic::{ClassicMaterial, ClassicModel};
pub use coat::Coat;
pub use coated_conductor::CoatedConductorMaterial;
pub use coated_diffuse::CoatedDiffuseMaterial;
pub use conductor::ConductorMaterial;
pub use context::MaterialContext;
pub use dielectric::DielectricMaterial;
pub use diffuse::DiffuseMaterial;
pub use diffuse_transmission::DiffuseTransmissionMaterial;
pub use facet_options::FacetOptions;
pub use hair::{HairColor, HairMaterial};
pub use index::RefractiveIndex;
pub use materials::{MaterialId, Materials};
pub use measured::MeasuredMaterial;
pub use metal::Metal;
pub use mix::MixMaterial;
pub use normal_map::{NormalMap, NormalMapId};
pub use perturbation::Perturbation;
pub use principled::PrincipledMaterial;
pub use principled_extensions::{ExtensionsId, PrincipledExtensions};
pub use roughness::{Roughness, RoughnessScale};
pub use tabulated::TabulatedMaterial;
pub use thin_dielectric::ThinDielectricMaterial;

use crate::bsdf::{Bsdf, BsdfKind};
use crate::parameters::{ParameterSpec, Parameters};
use crate::texture::{SpectrumTexture, Textures};

/// The kinds of material.
///
/// To add one: write a file with a plain struct, `PARAMETERS`, `build` and `bsdf` as in `diffuse.rs`, add a variant here,
/// follow the compiler through the matches below, and add it to [`MATERIALS`].
#[derive(Clone, Copy, Debug, PartialEq)]
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
    /// Metal or a coated base, as in glTF.
    Principled(PrincipledMaterial),
    /// A model of the literature.
    Classic(ClassicMaterial),
    /// What a table says.
    Tabulated(TabulatedMaterial),
    /// Hair and fur.
    Hair(HairMaterial),
    /// What an instrument saw.
    Measured(MeasuredMaterial),
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
        name: "principled",
        doc: "The metallic-roughness material of glTF 2.0 and its extensions, with all bounces.",
        parameters: PrincipledMaterial::PARAMETERS,
    },
    classic::MATERIALS[0],
    classic::MATERIALS[1],
    classic::MATERIALS[2],
    classic::MATERIALS[3],
    classic::MATERIALS[4],
    classic::MATERIALS[5],
    classic::MATERIALS[6],
    classic::MATERIALS[7],
    classic::MATERIALS[8],
    classic::MATERIALS[9],
    classic::MATERIALS[10],
    MaterialSpec {
        name: "tabulated",
        doc: "Any isotropic reflection, by a table in a file.",
        parameters: TabulatedMaterial::PARAMETERS,
    },
    MaterialSpec {
        name: "hair",
        doc: "Hair and fur: fibres along u, which v goes across.",
        parameters: HairMaterial::PARAMETERS,
    },
    MaterialSpec {
        name: "measured",
        doc: "Measured reflection, by a file of RGL's layout.",
        parameters: MeasuredMaterial::PARAMETERS,
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
    fn build(
        p: &mut Parameters<'_, '_>,
        materials: &mut Materials,
        named: &HashMap<String, MaterialId>,
    ) -> Option<Self> {
        Some(match p.entity().type_name.as_str() {
            "diffuse" => Self::Diffuse(DiffuseMaterial::build(p, materials)),
            "coateddiffuse" => Self::CoatedDiffuse(CoatedDiffuseMaterial::build(p, materials)),
            "conductor" => Self::Conductor(ConductorMaterial::build(p, materials)),
            "coatedconductor" => Self::CoatedConductor(CoatedConductorMaterial::build(p, materials)),
            "dielectric" => Self::Dielectric(DielectricMaterial::build(p, materials)),
            "thindielectric" => Self::ThinDielectric(ThinDielectricMaterial::build(p, materials)),
            "diffusetransmission" => {
                Self::DiffuseTransmission(DiffuseTransmissionMaterial::build(p, materials))
            }
            "principled" => Self::Principled(PrincipledMaterial::build(p, materials)),
            "tabulated" => Self::Tabulated(TabulatedMaterial::build(p, materials)?),
            "hair" => Self::Hair(HairMaterial::build(p, materials)),
            "measured" => Self::Measured(MeasuredMaterial::build(p, materials)?),
            "mix" => Self::Mix(MixMaterial::build(p, named)?),
            "interface" | "none" | "" => Self::Interface,
            other => {
                if let Some(material) = ClassicMaterial::build(p, materials) {
                    return Some(Self::Classic(material));
                }
                let span = p.span();
                let known = MATERIALS.iter().map(|material| material.name);
                p.diagnostics().unknown_name(span, "material", other, known);
                return None;
            }
        })
    }

    /// How the material, which is no mixture, scatters light at a point whose shading frame is perturbed already.
    #[inline]
    fn bsdf(&self, textures: &Textures, ctx: &MaterialContext, lambda: &mut Wavelengths) -> Option<Bsdf> {
        let kind = match self {
            Self::Diffuse(material) => material.bsdf(textures, ctx, lambda),
            Self::CoatedDiffuse(material) => material.bsdf(textures, ctx, lambda),
            Self::Conductor(material) => material.bsdf(textures, ctx, lambda),
            Self::CoatedConductor(material) => material.bsdf(textures, ctx, lambda),
            Self::Dielectric(material) => material.bsdf(textures, ctx, lambda),
            Self::ThinDielectric(material) => material.bsdf(textures, lambda),
            Self::DiffuseTransmission(material) => material.bsdf(textures, ctx, lambda),
            Self::Principled(material) => material.bsdf(textures, ctx, lambda),
            Self::Classic(material) => BsdfKind::Classic(material.bsdf(textures, ctx, lambda)),
            Self::Tabulated(material) => material.bsdf(lambda),
            Self::Hair(material) => material.bsdf(textures, ctx, lambda),
            Self::Measured(material) => material.bsdf(lambda),
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
            Self::Principled(material) => Some(&material.perturbation),
            Self::Classic(material) => Some(&material.perturbation),
            Self::Tabulated(material) => Some(&material.perturbation),
            Self::Hair(material) => Some(&material.perturbation),
            Self::Measured(material) => Some(&material.perturbation),
            Self::Mix(_) | Self::Interface => None,
        }
    }
}
