//! Glass and metals.

use etendue_scene::Span;
use etendue_scene::document::{Entity, Value};

use crate::mitsuba::element::Element;
use crate::mitsuba::reader::{Reader, entity, parameter};

/// Metals that both know, by Mitsuba's name and ours.
const METALS: &[(&str, &str)] = &[
    ("Ag", "Ag"),
    ("Al", "Al"),
    ("Au", "Au"),
    ("Cr", "Cr"),
    ("Cu", "Cu"),
    ("Cu_palik", "Cu"),
    ("CuZn", "CuZn"),
    ("MgO", "MgO"),
    ("Ni_palik", "Ni"),
    ("TiO2", "TiO2"),
    ("W", "W"),
];
/// Materials of conductors that Mitsuba knows and we do not measure.
const MISSING_METALS: &[&str] = &[
    "a-C",
    "AlAs",
    "AlAs_palik",
    "AlSb",
    "AlSb_palik",
    "Be",
    "CsI",
    "Cu2O",
    "CuO",
    "d-C",
    "Hg",
    "HgTe",
    "Ir",
    "K",
    "Li",
    "Mo",
    "Na_palik",
    "Nb",
    "Rh",
    "Se",
    "SiC",
    "SnTe",
    "Ta",
    "Te",
    "Te_palik",
    "ThF4",
    "TiC",
    "TiN",
    "V_palik",
    "VC",
    "VN",
];

impl<'e> Reader<'e> {
    pub(super) fn dielectric(&mut self, bsdf: &'e Element) -> Entity {
        let mut material = entity("dielectric", bsdf);
        self.pass_index(bsdf, 1.5046, &mut material, "eta");
        if bsdf.plugin() == "roughdielectric" {
            self.pass_alpha(bsdf, &mut material, "", 0.1);
            self.pass_distribution(bsdf, &mut material);
        }
        self.ignore_factors(bsdf);
        material
    }

    pub(super) fn thin_dielectric(&mut self, bsdf: &'e Element) -> Entity {
        let mut material = entity("thindielectric", bsdf);
        self.pass_index(bsdf, 1.5046, &mut material, "eta");
        self.ignore_factors(bsdf);
        material
    }

    pub(super) fn conductor(&mut self, bsdf: &'e Element) -> Entity {
        let mut material = entity("conductor", bsdf);
        if bsdf.plugin() == "roughconductor" {
            self.pass_alpha(bsdf, &mut material, "", 0.1);
            self.pass_distribution(bsdf, &mut material);
        }
        let eta = self.pass_color(bsdf, "eta", &mut material, "eta");
        let k = self.pass_color(bsdf, "k", &mut material, "k");
        let (name, span) = self.string(bsdf, "material").unwrap_or(("none", bsdf.span));
        // Without any, version 3 means a mirror and those before it copper.
        let is_mirror = name == "none" && (!self.is_legacy || Self::has(bsdf, "material"));
        if eta && k {
            // Given by numbers.
        } else if is_mirror {
            if !self.pass_color(bsdf, "specular_reflectance", &mut material, "reflectance") {
                material.parameters.push(parameter("reflectance", Value::Rgb(vec![[1.0; 3]]), span));
            }
        } else {
            self.pass_metal(if name == "none" { "Cu" } else { name }, span, &mut material);
        }
        self.ignore(bsdf, &["ext_eta"], "the metal is taken to be in air");
        self.ignore_factors(bsdf);
        material
    }

    fn pass_metal(&mut self, name: &str, span: Span, material: &mut Entity) {
        let known =
            METALS.iter().find(|(theirs, _)| theirs.eq_ignore_ascii_case(name)).map(|(_, ours)| *ours);
        let ours = known.unwrap_or_else(|| {
            if MISSING_METALS.contains(&name) {
                let message = format!("the material `{name}` is not available; chromium stands in for it");
                self.diagnostics.warning(span, message);
            } else {
                let names = METALS.iter().map(|(name, _)| *name).chain(MISSING_METALS.iter().copied());
                self.diagnostics.unknown_name(span, "material", name, names);
            }
            "Cr"
        });
        for part in ["eta", "k"] {
            let value = Value::SpectrumNames(vec![format!("metal-{ours}-{part}")]);
            material.parameters.push(parameter(part, value, span));
        }
    }
}
