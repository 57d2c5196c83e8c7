//! Materials: what a surface is made of, before a point on it is known.
//!
//! A material holds textures; [`Materials::bsdf`] evaluates them at a point, perturbs the shading frame and returns a
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
use std::sync::Arc;

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
pub use normal_map::{NormalMap, NormalMapId};
pub use perturbation::Perturbation;
pub use roughness::{Roughness, RoughnessScale};
pub use thin_dielectric::ThinDielectricMaterial;

use crate::bsdf::Bsdf;
use crate::diagnostics::nearest_name;
use crate::parameters::{ParameterSpec, Parameters};
use crate::texture::{SpectrumTexture, TextureContext, Textures};

/// Index of a material in [`Materials`].
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct MaterialId(pub u32);

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
    pub fn new(surface: &SurfacePoint, texture: TextureContext, wo: Vector3) -> Self {
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

/// All materials of a scene, with the normal maps they use.
#[derive(Clone, Debug, Default)]
pub struct Materials {
    materials: Vec<Material>,
    normal_maps: Vec<NormalMap>,
    normal_map_files: HashMap<String, NormalMapId>,
}

impl Materials {
    /// No materials.
    #[must_use]
    pub fn new() -> Self {
        Self::default()
    }

    /// Adds a material. A mixture may only name materials that were added before it.
    pub fn add(&mut self, material: Material) -> MaterialId {
        if let Material::Mix(mix) = material {
            assert!(
                mix.materials.iter().all(|id| (id.0 as usize) < self.materials.len()),
                "mixture of unknown materials"
            );
        }
        self.materials.push(material);
        MaterialId(self.materials.len() as u32 - 1)
    }

    /// Adds pbrt's default material, a grey diffuse one.
    pub fn add_default(&mut self) -> MaterialId {
        self.add(Material::Diffuse(DiffuseMaterial {
            reflectance: SpectrumTexture::Constant(Spectrum::Constant(0.5)),
            perturbation: Perturbation::None,
        }))
    }

    /// Adds a normal map.
    pub fn add_normal_map(&mut self, map: NormalMap) -> NormalMapId {
        self.normal_maps.push(map);
        NormalMapId(self.normal_maps.len() as u32 - 1)
    }

    /// Number of materials.
    #[must_use]
    pub fn len(&self) -> usize {
        self.materials.len()
    }

    /// True if there are no materials.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.materials.is_empty()
    }

    /// A material.
    #[inline]
    #[must_use]
    pub fn get(&self, id: MaterialId) -> &Material {
        &self.materials[id.0 as usize]
    }

    /// True if the surface does not exist for light; a mixture is never.
    #[inline]
    #[must_use]
    pub fn is_interface(&self, id: MaterialId) -> bool {
        matches!(self.get(id), Material::Interface)
    }

    #[inline]
    fn normal_map(&self, id: NormalMapId) -> &NormalMap {
        &self.normal_maps[id.0 as usize]
    }

    fn load_normal_map(&mut self, p: &mut Parameters<'_, '_>, file: &str) -> Option<NormalMapId> {
        if let Some(id) = self.normal_map_files.get(file) {
            return Some(*id);
        }
        // An image that could not be read has been reported by its reader.
        let texels = p.context.assets.images.get(file)?;
        let Some(map) = NormalMap::new(Arc::clone(texels)) else {
            let span = p.span_of("normalmap");
            p.diagnostics().error(span, format!("the normal map \"{file}\" needs three channels"));
            return None;
        };
        let id = self.add_normal_map(map);
        self.normal_map_files.insert(file.to_owned(), id);
        Some(id)
    }

    /// The material at a point, with mixtures decided.
    #[inline]
    #[must_use]
    pub fn resolve(&self, mut id: MaterialId, textures: &Textures, ctx: &MaterialContext) -> &Material {
        // Ends, since a mixture only names materials before it.
        loop {
            match self.get(id) {
                Material::Mix(mix) => id = mix.choose(textures, ctx),
                material => return material,
            }
        }
    }

    /// How the material scatters light at a point; `None` where light passes as if there were no surface. Wavelengths
    /// but the first are given up where refraction depends on them.
    #[must_use]
    pub fn bsdf(
        &self,
        id: MaterialId,
        textures: &Textures,
        ctx: &MaterialContext,
        lambda: &mut Wavelengths,
    ) -> Option<Bsdf> {
        let material = self.resolve(id, textures, ctx);
        let perturbed = material.perturbation().apply(self, textures, ctx);
        let ctx = &perturbed;
        let kind = match material {
            Material::Diffuse(material) => material.bsdf(textures, ctx, lambda),
            Material::CoatedDiffuse(material) => material.bsdf(textures, ctx, lambda),
            Material::Conductor(material) => material.bsdf(textures, ctx, lambda),
            Material::CoatedConductor(material) => material.bsdf(textures, ctx, lambda),
            Material::Dielectric(material) => material.bsdf(textures, ctx, lambda),
            Material::ThinDielectric(material) => material.bsdf(textures, lambda),
            Material::DiffuseTransmission(material) => material.bsdf(textures, ctx, lambda),
            Material::Mix(_) | Material::Interface => return None,
        };
        Some(Bsdf::new(ctx.ns, ctx.ng, ctx.shading_dpdu, kind))
    }
}

impl Material {
    /// What perturbs the shading normal.
    #[must_use]
    pub const fn perturbation(&self) -> Perturbation {
        match self {
            Self::Diffuse(material) => material.perturbation,
            Self::CoatedDiffuse(material) => material.perturbation,
            Self::Conductor(material) => material.perturbation,
            Self::CoatedConductor(material) => material.perturbation,
            Self::Dielectric(material) => material.perturbation,
            Self::ThinDielectric(material) => material.perturbation,
            Self::DiffuseTransmission(material) => material.perturbation,
            Self::Mix(_) | Self::Interface => Perturbation::None,
        }
    }
}

/// Builds the material of an entity and adds it, where `names` are the named materials so far. Problems are reported;
/// `None` means that there is no material because of them.
pub fn build_material(
    mut p: Parameters<'_, '_>,
    materials: &mut Materials,
    names: &HashMap<String, MaterialId>,
) -> Option<MaterialId> {
    let p_ref = &mut p;
    let material = match p_ref.entity().type_name.as_str() {
        "diffuse" => Material::Diffuse(DiffuseMaterial::build(p_ref, materials)),
        "coateddiffuse" => Material::CoatedDiffuse(CoatedDiffuseMaterial::build(p_ref, materials)),
        "conductor" => Material::Conductor(ConductorMaterial::build(p_ref, materials)),
        "coatedconductor" => Material::CoatedConductor(CoatedConductorMaterial::build(p_ref, materials)),
        "dielectric" => Material::Dielectric(DielectricMaterial::build(p_ref, materials)),
        "thindielectric" => Material::ThinDielectric(ThinDielectricMaterial::build(p_ref, materials)),
        "diffusetransmission" => {
            Material::DiffuseTransmission(DiffuseTransmissionMaterial::build(p_ref, materials))
        }
        "mix" => Material::Mix(MixMaterial::build(p_ref, names)?),
        "interface" | "none" | "" => Material::Interface,
        other => {
            report_unknown(p_ref, other);
            return None;
        }
    };
    p.finish();
    Some(materials.add(material))
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
