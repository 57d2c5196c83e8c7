//! A material that is what a table says.

use std::collections::HashMap;

use etendue_spectrum::Wavelengths;

use super::{Materials, Perturbation, spec};
use crate::assets::Assets;
use crate::bsdf::BsdfKind;
use crate::bsdf::tabulated::{BrdfTable, TableSampling, Tabulated};
use crate::parameters::{ParameterSpec, Parameters};

/// Parameters of `tabulated`.
#[derive(Clone, Copy, Debug)]
pub struct TabulatedMaterial {
    /// The values.
    pub table: &'static BrdfTable,
    /// How directions are found.
    pub sampling: TableSampling,
    /// Relief.
    pub perturbation: Perturbation,
}

impl PartialEq for TabulatedMaterial {
    fn eq(&self, other: &Self) -> bool {
        std::ptr::eq(self.table, other.table)
            && self.sampling == other.sampling
            && self.perturbation == other.perturbation
    }
}

impl TabulatedMaterial {
    /// What scene files may say.
    pub const PARAMETERS: &'static [ParameterSpec] = &[
        spec::spec("filename", "string", "", "File with the table, see docs/scattering/tabulated.md."),
        spec::spec(
            "sampling",
            "string",
            "cells",
            "Of the glossy lobe: cells of half vectors (cells), or rejection of even directions (rejection).",
        ),
        spec::DISPLACEMENT,
        spec::NORMAL_MAP,
    ];

    pub(super) fn build(p: &mut Parameters<'_, '_>, materials: &mut Materials) -> Option<Self> {
        let span = p.span_of("filename");
        let (filename, grid) = file(p, "tabulated", |assets| &assets.brdfs)?;
        let table = BrdfTable::of(grid);
        if table.albedo_max() > 1.02 {
            let message =
                format!("the table \"{filename}\" reflects {:.2} times what arrives", table.albedo_max());
            p.diagnostics().warning(span, message);
        }
        let sampling = p.choice(
            "sampling",
            "cells",
            &[("cells", TableSampling::Cells), ("rejection", TableSampling::Rejection)],
        );
        Some(Self { table, sampling, perturbation: Perturbation::build(p, materials) })
    }

    pub(super) const fn bsdf(&self, lambda: &Wavelengths) -> BsdfKind {
        BsdfKind::Tabulated(Tabulated { table: self.table, lambda: *lambda, sampling: self.sampling })
    }
}

/// The parameter `filename` and what was read from that file; `None`, with the reason reported, if there is nothing.
pub(super) fn file<'a, T>(
    p: &mut Parameters<'a, '_>,
    material: &str,
    of: impl Fn(&Assets) -> &HashMap<String, T>,
) -> Option<(String, &'a T)> {
    let span = p.span_of("filename");
    let Some(filename) = p.string_opt("filename").filter(|name| !name.is_empty()) else {
        p.missing("filename", format!("a {material} material needs a \"filename\""));
        return None;
    };
    let assets = p.context.assets;
    let content = of(assets).get(&filename);
    if content.is_none() && !assets.failed.contains(&filename) {
        p.diagnostics().error(span, format!("the table \"{filename}\" was not loaded"));
    }
    Some((filename, content?))
}
