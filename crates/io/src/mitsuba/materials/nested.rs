//! BSDFs around others: masks, blends, maps and coats.

use etendue_scene::document::{Entity, MaterialEntity, MaterialReference, TextureValue, Value};

use super::Surface;
use crate::mitsuba::element::Element;
use crate::mitsuba::reader::{Reader, entity, parameter};
use crate::mitsuba::values;

impl<'e> Reader<'e> {
    /// The nested BSDF of that index.
    fn inner(&mut self, bsdf: &'e Element) -> Option<&'e Element> {
        let nested = self.nested(bsdf, "bsdf");
        if nested.is_empty() {
            let message = format!("`{}` needs a BSDF inside", bsdf.plugin());
            self.diagnostics.error(bsdf.plugin_span(), message);
        }
        nested.first().copied()
    }

    fn inner_surface(&mut self, bsdf: &'e Element) -> Surface {
        let inner = self.inner(bsdf).and_then(|inner| self.surface(inner));
        inner.unwrap_or_else(|| Surface::new(entity("diffuse", bsdf)))
    }

    pub(super) fn two_sided(&mut self, bsdf: &'e Element) -> Surface {
        if let [_, second, ..] = self.nested(bsdf, "bsdf").as_slice() {
            let message = "both sides have the same material here; the second is ignored";
            self.diagnostics.warning(second.plugin_span(), message);
        }
        self.inner_surface(bsdf)
    }

    pub(super) fn mask(&mut self, bsdf: &'e Element) -> Surface {
        let opacity = self.number_opt(bsdf, "opacity").map_or(Value::Floats(vec![0.5]), |(value, _)| value);
        let inner = self.inner_surface(bsdf);
        if inner.alpha.is_some() {
            self.diagnostics.warning(bsdf.plugin_span(), "a mask inside of a mask is ignored");
        }
        Surface { alpha: Some(opacity), ..inner }
    }

    /// The name of the nested material; masks within blends are reported.
    fn part(&mut self, bsdf: &'e Element) -> String {
        match self.material(bsdf) {
            (MaterialReference::Name(name, _), alpha) => {
                if alpha.is_some() {
                    let message = "a mask inside of a blend is ignored";
                    self.diagnostics.warning(bsdf.plugin_span(), message);
                }
                name
            }
            (MaterialReference::Index(_), _) => String::new(),
        }
    }

    pub(super) fn blend(&mut self, bsdf: &'e Element) -> Entity {
        let weight = self.number_opt(bsdf, "weight");
        let nested = self.nested(bsdf, "bsdf");
        let [first, second] = nested.as_slice() else {
            let message = format!("a blend has two BSDFs, not {}", nested.len());
            self.diagnostics.error(bsdf.plugin_span(), message);
            return entity("diffuse", bsdf);
        };
        let names = vec![self.part(first), self.part(second)];
        let mut material = entity("mix", bsdf).with("materials", Value::Strings(names));
        material.parameters.extend(weight.map(|(value, span)| parameter("amount", value, span)));
        material
    }

    /// Any number of BSDFs by constant weights: blends of two inside of each other.
    pub(super) fn mixture(&mut self, bsdf: &'e Element) -> Entity {
        let mut weights = Vec::new();
        if let Some(property) = self.property(bsdf, "weights") {
            let value = property.attribute("value");
            weights = value.and_then(|v| values::numbers(v, &mut self.diagnostics)).unwrap_or_default();
        }
        let nested = self.nested(bsdf, "bsdf");
        if nested.is_empty() || weights.len() != nested.len() || weights.iter().any(|w| *w < 0.0) {
            let message = "a mixture needs BSDFs and one weight, not negative, for each";
            self.diagnostics.error(bsdf.plugin_span(), message);
            return entity("diffuse", bsdf);
        }
        if weights.iter().sum::<f32>() < 0.999 {
            let message =
                "weights that add up to less than 1 absorb light in Mitsuba; here they are scaled up to 1";
            self.diagnostics.warning(bsdf.plugin_span(), message);
        }
        let mut sum = weights[0];
        let mut name = self.part(nested[0]);
        let mut material = self.surface(nested[0]).map_or(entity("diffuse", bsdf), |surface| surface.entity);
        for (index, (part, weight)) in nested.iter().zip(&weights).enumerate().skip(1) {
            sum += weight;
            let amount = if sum > 0.0 { weight / sum } else { 0.5 };
            let names = vec![name.clone(), self.part(part)];
            material = entity("mix", bsdf)
                .with("materials", Value::Strings(names))
                .with("amount", Value::Floats(vec![amount]));
            if index + 1 < nested.len() {
                name = format!("{} part {index}", Self::name_of(bsdf));
                let material = MaterialEntity { name: Some(name.clone()), entity: material.clone() };
                self.document.materials.push(material);
            }
        }
        material
    }

    pub(super) fn bump_map(&mut self, bsdf: &'e Element) -> Surface {
        let mut surface = self.inner_surface(bsdf);
        let scale = self.float(bsdf, "scale", 1.0);
        let textures = self.nested(bsdf, "texture");
        let Some(texture) = textures.first() else {
            self.diagnostics.error(bsdf.plugin_span(), "a bump map needs a texture inside");
            return surface;
        };
        let Some(height) = self.texture(texture, TextureValue::Float) else { return surface };
        let name = format!("{} height", Self::name_of(bsdf));
        let height = self.scaled_texture(name, height, scale, texture);
        surface.entity.parameters.push(parameter("displacement", height, texture.plugin_span()));
        surface
    }

    pub(super) fn normal_map(&mut self, bsdf: &'e Element) -> Surface {
        let mut surface = self.inner_surface(bsdf);
        let textures = self.nested(bsdf, "texture");
        let Some(texture) = textures.first().copied() else {
            self.diagnostics.error(bsdf.plugin_span(), "a normal map needs a texture inside");
            return surface;
        };
        let Some((file, span)) = self.string(texture, "filename") else {
            let message = "normal maps are pictures here: a `bitmap` with a `filename`";
            self.diagnostics.warning(texture.plugin_span(), message);
            return surface;
        };
        self.accept(texture, &["raw", "filter_type", "wrap_mode", "gamma", "format"]);
        self.ignore(texture, &["to_uv"], "normal maps follow the coordinates of the shape");
        self.finish(texture);
        let file = self.files.resolved(file);
        surface.entity.parameters.push(parameter("normalmap", Value::Strings(vec![file]), span));
        surface
    }

    /// A coat over a diffuse or metallic base.
    pub(super) fn coating(&mut self, bsdf: &'e Element) -> Surface {
        let mut surface = self.inner_surface(bsdf);
        self.ignore(bsdf, &["sigma_a"], "coats are clear here");
        self.accept(bsdf, &["thickness"]);
        self.ignore_factors(bsdf);
        let prefix = match surface.entity.type_name.as_str() {
            "diffuse" => "",
            "conductor" => "interface.",
            other => {
                let message = format!("a coat over `{other}` is not available; it is left out");
                self.diagnostics.warning(bsdf.plugin_span(), message);
                self.relative_index(bsdf, 1.5046);
                self.accept(bsdf, &["alpha", "distribution", "sample_visible"]);
                return surface;
            }
        };
        let material = &mut surface.entity;
        material.type_name = format!("coated{}", material.type_name);
        if prefix.is_empty() {
            material.parameters.retain(|p| p.name != "remaproughness");
        } else {
            material.parameters.retain(|p| !matches!(p.name.as_str(), "remaproughness" | "distribution"));
            for p in &mut material.parameters {
                if matches!(p.name.as_str(), "eta" | "k" | "roughness" | "uroughness" | "vroughness") {
                    p.name = format!("conductor.{}", p.name);
                }
            }
        }
        self.pass_index(bsdf, 1.5046, material, &format!("{prefix}eta"));
        let alpha = if bsdf.plugin() == "roughcoating" { 0.1 } else { 0.0 };
        self.pass_alpha(bsdf, material, prefix, alpha);
        self.accept(bsdf, &["distribution", "sample_visible"]);
        surface
    }
}
