//! A pane of glass modelled as one surface.

use etendue_spectrum::Wavelengths;

use super::index::RefractiveIndex;
use super::{Materials, Perturbation, spec};
use crate::bsdf::{BsdfKind, ThinDielectric};
use crate::parameters::{ParameterSpec, Parameters};
use crate::texture::Textures;

/// Parameters of `thindielectric`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ThinDielectricMaterial {
    /// Index of the pane relative to its surroundings.
    pub eta: RefractiveIndex,
    /// Relief.
    pub perturbation: Perturbation,
}

impl ThinDielectricMaterial {
    /// What scene files may say.
    pub const PARAMETERS: &'static [ParameterSpec] = &[spec::ETA, spec::DISPLACEMENT, spec::NORMAL_MAP];

    pub(super) fn build(p: &mut Parameters<'_, '_>, materials: &mut Materials) -> Self {
        Self {
            eta: RefractiveIndex::build(p, "eta", RefractiveIndex::GLASS),
            perturbation: Perturbation::build(p, materials),
        }
    }

    #[inline]
    pub(super) fn bsdf(&self, textures: &Textures, lambda: &mut Wavelengths) -> BsdfKind {
        BsdfKind::ThinDielectric(ThinDielectric { eta: self.eta.of_hero(textures, lambda) })
    }
}
