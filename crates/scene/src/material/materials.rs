//! The arena of materials: shapes and mixtures hold ids of materials, materials hold ids of normal maps.

use std::collections::HashMap;

use etendue_spectrum::{Spectrum, Wavelengths};

use super::{
    DiffuseMaterial, ExtensionsId, Material, MaterialContext, NormalMap, NormalMapId, Perturbation,
    PrincipledExtensions, PrincipledMaterial,
};
use crate::bsdf::Bsdf;
use crate::medium::{Absorption, Interface, Media, MediumId};
use crate::parameters::Parameters;
use crate::texture::{SpectrumTexture, Textures};

/// Index of a material in [`Materials`].
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct MaterialId(pub u32);

/// All materials of a scene, with the normal maps they use.
#[derive(Clone, Debug, Default)]
pub struct Materials {
    materials: Vec<Material>,
    /// Which of them look the same all over a surface.
    uniform: Vec<bool>,
    normal_maps: Vec<NormalMap>,
    media: Media,
    extensions: Vec<PrincipledExtensions>,
}

impl Materials {
    /// No materials.
    #[must_use]
    pub fn new() -> Self {
        Self::default()
    }

    /// Adds a material. A mixture may only name materials that were added before it, so that there are no circles.
    pub fn add(&mut self, material: Material) -> MaterialId {
        let id = MaterialId(self.materials.len() as u32);
        if let Material::Mix(mix) = &material {
            assert!(
                mix.materials.iter().all(|part| *part < id),
                "a mixture names a material that is not there"
            );
        }
        self.uniform.push(material.is_uniform(self));
        self.materials.push(material);
        id
    }

    /// Adds the material that an entity describes, where `named` are those with a name so far. Problems are reported;
    /// `None` means that there is no material because of them.
    pub fn build(
        &mut self,
        mut p: Parameters<'_, '_>,
        named: &HashMap<String, MaterialId>,
    ) -> Option<MaterialId> {
        let material = Material::build(&mut p, self, named)?;
        p.finish();
        Some(self.add(material))
    }

    /// Adds a normal map. An image that is there already is not added again.
    pub fn add_normal_map(&mut self, map: NormalMap) -> NormalMapId {
        let found = self.normal_maps.iter().position(|known| known.shares_image_with(&map));
        let index = found.unwrap_or_else(|| {
            self.normal_maps.push(map);
            self.normal_maps.len() - 1
        });
        NormalMapId(index as u32)
    }

    /// Adds a medium by what it absorbs.
    pub fn add_medium(&mut self, absorption: Absorption) -> MediumId {
        self.media.add(absorption)
    }

    /// Adds what glTF's extensions say of a material.
    pub(super) fn add_extensions(&mut self, extensions: PrincipledExtensions) -> ExtensionsId {
        self.extensions.push(extensions);
        ExtensionsId(self.extensions.len() as u32 - 1)
    }

    /// The extensions of that id.
    #[must_use]
    pub fn extensions(&self, id: ExtensionsId) -> &PrincipledExtensions {
        &self.extensions[id.0 as usize]
    }

    /// What the material shows the eye whatever falls on it, if it does; a mixture does not.
    #[inline]
    #[must_use]
    pub fn ambient(&self, id: MaterialId) -> Option<&Spectrum> {
        match self.get(id) {
            Material::Classic(material) => material.ambient.as_ref(),
            _ => None,
        }
    }

    /// True if some material has an ambient term.
    #[must_use]
    pub fn have_ambient(&self) -> bool {
        (0..self.len()).any(|i| self.ambient(MaterialId(i as u32)).is_some())
    }

    /// What transparent surfaces have on their sides.
    #[inline]
    #[must_use]
    pub const fn media(&self) -> &Media {
        &self.media
    }

    /// The media on the two sides of a surface of this material; `None` if the material does not part space.
    #[inline]
    #[must_use]
    pub fn interface(&self, id: MaterialId) -> Option<Interface> {
        match self.get(id) {
            Material::Dielectric(material) => Some(material.interface),
            Material::Principled(material) => self.extensions(material.extensions?).interface,
            _ => None,
        }
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

    /// The material of that id.
    #[inline]
    #[must_use]
    pub fn get(&self, id: MaterialId) -> &Material {
        &self.materials[id.0 as usize]
    }

    /// The normal map of that id.
    #[inline]
    #[must_use]
    pub fn normal_map(&self, id: NormalMapId) -> &NormalMap {
        &self.normal_maps[id.0 as usize]
    }

    /// True if the material needs neither tangents nor the change of texture coordinates over a pixel.
    #[inline]
    #[must_use]
    pub fn is_uniform(&self, id: MaterialId) -> bool {
        self.uniform[id.0 as usize]
    }

    /// The reflectance of a diffuse material that is the same all over a surface: of most surfaces of most scenes.
    #[inline]
    #[must_use]
    pub fn uniform_diffuse(&self, id: MaterialId) -> Option<&Spectrum> {
        match self.get(id) {
            Material::Diffuse(DiffuseMaterial {
                reflectance: SpectrumTexture::Constant(reflectance),
                perturbation: Perturbation::None,
            }) => Some(reflectance),
            _ => None,
        }
    }

    /// True if the surface does not exist for light anywhere. A mixture does not count, even one of interfaces: paths
    /// pass where the interface was chosen, but shadow rays stop, as in pbrt-v4.
    #[inline]
    #[must_use]
    pub fn is_interface(&self, id: MaterialId) -> bool {
        matches!(self.get(id), Material::Interface)
    }

    /// True if the material is one of others at each point, of which some may be interfaces.
    #[inline]
    #[must_use]
    pub fn is_mixture(&self, id: MaterialId) -> bool {
        matches!(self.get(id), Material::Mix(_))
    }

    /// That material, or the part of the mixture that is at the point.
    #[inline]
    #[must_use]
    pub fn resolve(&self, id: MaterialId, textures: &Textures, ctx: &MaterialContext) -> &Material {
        let mut material = self.get(id);
        // Ends, since a mixture names materials before it.
        while let Material::Mix(mix) = material {
            material = self.get(mix.choose(textures, ctx));
        }
        material
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
        let perturbed = material.perturbation()?.apply(self, textures, ctx);
        let shaded = perturbed.as_ref().unwrap_or(ctx);
        if let Material::Principled(PrincipledMaterial { extensions: Some(id), .. }) = material {
            return Some(self.extensions(*id).bsdf(self, textures, [ctx, shaded], lambda));
        }
        material.bsdf(textures, shaded, lambda)
    }
}
