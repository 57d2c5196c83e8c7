//! Which materials may make caustics: what projection maps aim at (SPEC EMI-10, PM-4).

use super::classic::ClassicModel;
use super::{Material, MaterialId, Materials, Roughness, RoughnessScale};
use crate::bsdf::microfacet::Microfacets;
use crate::texture::FloatTexture;

impl Materials {
    /// False if the material certainly has no mirror, no smooth boundary and no gloss of a microfacet width below
    /// `sharp_alpha`.
    #[must_use]
    pub fn may_be_sharp(&self, id: MaterialId, sharp_alpha: f32) -> bool {
        match self.get(id) {
            Material::Diffuse(_) | Material::DiffuseTransmission(_) | Material::Interface => false,
            Material::Conductor(material) => material.roughness.may_be_below(sharp_alpha),
            Material::Dielectric(material) => material.roughness.may_be_below(sharp_alpha),
            Material::Mix(mix) => mix.materials.iter().any(|part| self.may_be_sharp(*part, sharp_alpha)),
            Material::Classic(material) => !matches!(material.model, ClassicModel::OrenNayar(_)),
            // What the base scatters leaves as widely as from it or through a coat that is as wide.
            Material::CoatedDiffuse(material) => material.coat.roughness.may_be_below(sharp_alpha),
            Material::CoatedConductor(_)
            | Material::ThinDielectric(_)
            | Material::Principled(_)
            | Material::Tabulated(_)
            | Material::Hair(_)
            | Material::Measured(_) => true,
        }
    }
}

impl Roughness {
    /// False if the mean width of the facets is certainly not below `alpha`. Mirrors have none.
    fn may_be_below(&self, alpha: f32) -> bool {
        let (FloatTexture::Constant(u), FloatTexture::Constant(v)) = (self.u, self.v) else { return true };
        let facets = match self.scale {
            RoughnessScale::Perceptual => {
                Microfacets::new(Microfacets::alpha_from_roughness(u), Microfacets::alpha_from_roughness(v))
            }
            RoughnessScale::Alpha => Microfacets::new(u.max(0.0), v.max(0.0)),
        };
        facets.is_smooth() || facets.mean_alpha() < alpha
    }
}
