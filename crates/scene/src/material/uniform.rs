//! Which materials look the same wherever on a surface, and however it is turned about its normal.
//!
//! Their scattering needs neither the size of a pixel nor tangents, which cost more than the scattering itself.

use super::{Coat, Material, Materials, Perturbation, Roughness};
use crate::texture::FloatTexture;

impl Material {
    /// True if nothing varies over the surface and no direction along it matters. The parts of a mixture are among
    /// `materials`.
    pub(super) fn is_uniform(&self, materials: &Materials) -> bool {
        if self.perturbation().is_some_and(|perturbation| *perturbation != Perturbation::None) {
            return false;
        }
        match self {
            Self::Diffuse(material) => material.reflectance.constant().is_some(),
            Self::CoatedDiffuse(material) => {
                material.reflectance.constant().is_some() && material.coat.is_uniform()
            }
            Self::Conductor(material) => material.metal.is_constant() && material.roughness.is_uniform(),
            Self::CoatedConductor(material) => {
                material.metal.is_constant() && material.roughness.is_uniform() && material.coat.is_uniform()
            }
            Self::Dielectric(material) => material.roughness.is_uniform(),
            Self::DiffuseTransmission(material) => {
                material.reflectance.constant().is_some() && material.transmittance.constant().is_some()
            }
            Self::Principled(material) => {
                material.extensions.is_none_or(|id| materials.extensions(id).is_uniform())
                    && material.base_color.constant().is_some()
                    && material.metallic.constant().is_some()
                    && material.roughness.constant().is_some()
            }
            Self::Classic(material) => material.is_uniform(),
            Self::Mix(mix) => {
                mix.amount.constant().is_some()
                    && mix.materials.iter().all(|part| materials.is_uniform(*part))
            }
            Self::Hair(_) => false,
            Self::Measured(material) => material.table.is_isotropic(),
            Self::ThinDielectric(_) | Self::Tabulated(_) | Self::Interface => true,
        }
    }
}

impl Coat {
    fn is_uniform(&self) -> bool {
        self.roughness.is_uniform()
            && self.thickness.constant().is_some()
            && self.g.constant().is_some()
            && self.albedo.constant().is_some()
    }
}

impl Roughness {
    fn is_uniform(&self) -> bool {
        matches!((self.u, self.v), (FloatTexture::Constant(u), FloatTexture::Constant(v)) if u == v)
    }
}
