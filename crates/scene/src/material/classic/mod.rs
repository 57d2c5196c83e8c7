//! Materials of the models in [`crate::bsdf::classic`].

mod lobe_colors;

mod blinn_phong;
mod phong;

use etendue_spectrum::Wavelengths;

pub use blinn_phong::BlinnPhongMaterial;
pub use lobe_colors::LobeColors;
pub use phong::PhongMaterial;

use super::{MaterialContext, MaterialSpec, Materials, Perturbation};
use crate::bsdf::Classic;
use crate::parameters::Parameters;
use crate::texture::Textures;

/// A model of the literature and its relief.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ClassicMaterial {
    /// Which model, with its parameters.
    pub model: ClassicModel,
    /// Relief.
    pub perturbation: Perturbation,
}

/// The models. To add one: write a file as `phong.rs`, add a variant here, in `each!` and in `build`, and a
/// line in [`CLASSIC_MATERIALS`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum ClassicModel {
    /// Phong's highlight.
    Phong(PhongMaterial),
    /// Blinn's highlight.
    BlinnPhong(BlinnPhongMaterial),
}

/// One expression for each model.
macro_rules! each {
    ($self:expr, $model:ident => $body:expr) => {
        match $self {
            ClassicModel::Phong($model) => $body,
            ClassicModel::BlinnPhong($model) => $body,
        }
    };
}

/// Their part of [`super::MATERIALS`].
pub(super) const PHONG: MaterialSpec = MaterialSpec {
    name: "phong",
    doc: "Diffuse with a highlight around the mirror direction (Phong 1975, Lewis 1993).",
    parameters: PhongMaterial::PARAMETERS,
};
pub(super) const BLINN_PHONG: MaterialSpec = MaterialSpec {
    name: "blinnphong",
    doc: "Diffuse with a highlight of the half vector (Blinn 1977).",
    parameters: BlinnPhongMaterial::PARAMETERS,
};

impl ClassicMaterial {
    /// The material of that name; `None` if it is none of these.
    pub(super) fn build(p: &mut Parameters<'_, '_>, materials: &mut Materials) -> Option<Self> {
        let model = match p.entity().type_name.as_str() {
            "phong" => ClassicModel::Phong(PhongMaterial::build(p)),
            "blinnphong" => ClassicModel::BlinnPhong(BlinnPhongMaterial::build(p)),
            _ => return None,
        };
        Some(Self { model, perturbation: Perturbation::build(p, materials) })
    }

    /// How it scatters at a point.
    pub(super) fn bsdf(&self, textures: &Textures, ctx: &MaterialContext, lambda: &Wavelengths) -> Classic {
        each!(&self.model, model => model.bsdf(textures, ctx, lambda))
    }

    /// True if nothing varies over the surface and no direction along it matters.
    pub(super) const fn is_uniform(&self) -> bool {
        each!(&self.model, model => model.is_uniform())
    }
}
