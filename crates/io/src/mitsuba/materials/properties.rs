//! Properties that several BSDFs have: indices of refraction, widths and distributions of facets, factors.

use etendue_scene::Span;
use etendue_scene::document::{Entity, Value};

use crate::mitsuba::element::Element;
use crate::mitsuba::reader::{Reader, parameter};

/// Indices of refraction by the names that Mitsuba gives them, for sodium light.
const INDICES: &[(&str, f32)] = &[
    ("vacuum", 1.0),
    ("helium", 1.000_036),
    ("hydrogen", 1.000_132),
    ("air", 1.000_277),
    ("carbon dioxide", 1.000_45),
    ("water", 1.333),
    ("acetone", 1.36),
    ("ethanol", 1.361),
    ("carbon tetrachloride", 1.461),
    ("glycerol", 1.4729),
    ("benzene", 1.501),
    ("silicone oil", 1.520_45),
    ("bromine", 1.661),
    ("water ice", 1.31),
    ("fused quartz", 1.458),
    ("pyrex", 1.47),
    ("acrylic glass", 1.49),
    ("polypropylene", 1.49),
    ("bk7", 1.5046),
    ("sodium chloride", 1.544),
    ("amber", 1.55),
    ("pet", 1.575),
    ("diamond", 2.419),
];

impl<'e> Reader<'e> {
    /// Index inside relative to that outside.
    pub(super) fn relative_index(&mut self, bsdf: &'e Element, default: f32) -> (f32, Span) {
        let span = bsdf.children.iter().find(|child| child.name == "int_ior").map_or(bsdf.span, |c| c.span);
        let inside = self.index(bsdf, "int_ior", default);
        let outside = self.index(bsdf, "ext_ior", 1.000_277);
        (inside / outside, span)
    }

    fn index(&mut self, bsdf: &'e Element, name: &'static str, default: f32) -> f32 {
        let Some(property) = self.property(bsdf, name) else { return default };
        let Some(value) = property.attribute("value") else { return default };
        let text = value.value.trim();
        let number = match text.parse::<f32>() {
            Ok(number) => Some(number),
            Err(_) => {
                INDICES.iter().find(|(known, _)| *known == text.to_lowercase()).map(|(_, index)| *index)
            }
        };
        match number {
            Some(number) if number > 0.0 && number.is_finite() => number,
            Some(number) => {
                let message = format!("an index of refraction is positive, not {number}");
                self.diagnostics.error(value.span, message);
                default
            }
            None => {
                let known = INDICES.iter().map(|(name, _)| *name);
                self.diagnostics.unknown_name(value.span, "material", text, known);
                default
            }
        }
    }

    pub(super) fn pass_index(&mut self, bsdf: &'e Element, default: f32, material: &mut Entity, name: &str) {
        let (eta, span) = self.relative_index(bsdf, default);
        material.parameters.push(parameter(name, Value::Floats(vec![eta]), span));
    }

    /// `alpha`, or `alpha_u` and `alpha_v`; widths of facets without any remapping.
    pub(super) fn pass_alpha(
        &mut self,
        bsdf: &'e Element,
        material: &mut Entity,
        prefix: &str,
        default: f32,
    ) {
        let name = |ours: &str| format!("{prefix}{ours}");
        let both = self.pass_number(bsdf, "alpha", material, &name("roughness"));
        let u = self.pass_number(bsdf, "alpha_u", material, &name("uroughness"));
        let v = self.pass_number(bsdf, "alpha_v", material, &name("vroughness"));
        if !(both || u && v) {
            material.parameters.push(parameter(&name("roughness"), Value::Floats(vec![default]), bsdf.span));
        }
        material.parameters.push(parameter("remaproughness", Value::Bools(vec![false]), bsdf.span));
    }

    /// The distribution of facets; Mitsuba's default is Beckmann's.
    pub(super) fn pass_distribution(&mut self, bsdf: &'e Element, material: &mut Entity) {
        self.accept(bsdf, &["sample_visible"]);
        let (name, span) = self.string(bsdf, "distribution").unwrap_or(("beckmann", bsdf.span));
        let ours = match name {
            "beckmann" | "ggx" => name,
            "as" | "phong" => {
                let message =
                    format!("the distribution `{name}` is not available; `beckmann` stands in for it");
                self.diagnostics.warning(span, message);
                "beckmann"
            }
            _ => {
                self.diagnostics.unknown_name(span, "distribution", name, ["beckmann", "ggx"]);
                "beckmann"
            }
        };
        material.parameters.push(parameter("distribution", Value::Strings(vec![ours.to_owned()]), span));
    }

    /// Takes factors of the physical reflection, which are 1 for anything real.
    pub(super) fn ignore_factors(&mut self, bsdf: &'e Element) {
        for name in ["specular_reflectance", "specular_transmittance", "specular_sampling_weight"] {
            let Some(property) = self.property(bsdf, name) else { continue };
            let is_white = property.attribute("value").is_some_and(|value| {
                value.value.split([' ', ',']).all(|x| x.is_empty() || x.parse() == Ok(1.0))
            });
            if !is_white && name != "specular_sampling_weight" {
                let message =
                    format!("`{name}` of `{}` is ignored: reflection follows from the index", bsdf.plugin());
                self.diagnostics.warning(property.span, message);
            }
        }
    }
}
