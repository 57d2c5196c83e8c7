//! A material that is what an instrument saw.

use etendue_spectrum::Wavelengths;

use super::tabulated::file;
use super::{Materials, Perturbation, spec};
use crate::bsdf::BsdfKind;
use crate::bsdf::measured::{Measured, MeasuredTable};
use crate::parameters::{ParameterSpec, Parameters};

/// Parameters of `measured`.
#[derive(Clone, Copy, Debug)]
pub struct MeasuredMaterial {
    /// The measurement.
    pub table: &'static MeasuredTable,
    /// Relief.
    pub perturbation: Perturbation,
}

impl PartialEq for MeasuredMaterial {
    fn eq(&self, other: &Self) -> bool {
        std::ptr::eq(self.table, other.table) && self.perturbation == other.perturbation
    }
}

impl MeasuredMaterial {
    /// What scene files may say.
    pub const PARAMETERS: &'static [ParameterSpec] = &[
        spec::spec(
            "filename",
            "string",
            "",
            "File of RGL's layout (.bsdf), see docs/scattering/measured.md.",
        ),
        spec::DISPLACEMENT,
        spec::NORMAL_MAP,
    ];

    pub(super) fn build(p: &mut Parameters<'_, '_>, materials: &mut Materials) -> Option<Self> {
        let (_, brdf) = file(p, "measured", |assets| &assets.measured)?;
        Some(Self { table: MeasuredTable::of(brdf), perturbation: Perturbation::build(p, materials) })
    }

    pub(super) const fn bsdf(&self, lambda: &Wavelengths) -> BsdfKind {
        BsdfKind::Measured(Measured { table: self.table, lambda: *lambda })
    }
}
