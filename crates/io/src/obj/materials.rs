//! From materials of a library to ours.
//!
//! | what is written | becomes |
//! |---|---|
//! | `Pr` or `Pm`, or pictures of them | `principled` |
//! | `illum` 4, 6, 7 or 9 (glass) | `dielectric` of index `Ni`, rough by `Ns` |
//! | `illum` 3 or 5, or `Ks` without `Kd` | `conductor` of reflectance `Ks`, rough by `Ns` |
//! | `Ks` above 0 (and `illum` not 0 or 1) | `principled`, rough by `Ns` |
//! | else | `diffuse` |
//!
//! The exponent n of Blinn and Phong has facets of alpha = sqrt(2 / (n + 2)) (Walter et al. 2007, "Microfacet Models for
//! Refraction through Rough Surfaces", section 5.4); `principled` is told its square root.

use etendue_math::Transform;
use etendue_scene::document::{
    Document, Entity, MaterialEntity, Parameter, TextureEntity, TextureValue, Value,
};
use etendue_scene::{Diagnostics, Span};

use super::mtl::{Map, Mtl};

/// What a material of a library gives to shapes.
#[derive(Clone, Debug, Default)]
pub(super) struct Converted {
    /// Value of `alpha`, if not all rays meet the shapes.
    pub(super) alpha: Option<Value>,
    /// The emission of the shapes.
    pub(super) light: Option<Entity>,
}

/// Adds materials to a document.
pub(super) struct Converter<'d> {
    pub(super) document: &'d mut Document,
    pub(super) diagnostics: &'d mut Diagnostics,
    /// Folder of the library, relative to that of the scene; empty or with a slash at its end.
    pub(super) folder: String,
    /// Largest extent of all shapes in metres, by which heights of bumps are meant.
    pub(super) extent: f32,
}

impl Converter<'_> {
    /// Adds a material under its name.
    pub(super) fn add(&mut self, mtl: &Mtl) -> Converted {
        let mut material = self.material(mtl);
        material.span = Some(mtl.span);
        self.relief(mtl, &mut material);
        self.document.materials.push(MaterialEntity { name: Some(mtl.name.clone()), entity: material });
        Converted { alpha: self.alpha(mtl), light: self.light(mtl) }
    }

    fn material(&mut self, mtl: &Mtl) -> Entity {
        let illum = mtl.number("illum").map_or(2, |(illum, _)| illum as i32);
        let has = |keyword: &str| mtl.number(keyword).is_some() || mtl.map(&keyword.to_lowercase()).is_some();
        if has("Pr") || has("Pm") {
            return self.principled(mtl);
        }
        let peak = |color: super::mtl::Placed<[f32; 3]>| color.map_or(0.0, |(c, _)| c[0].max(c[1]).max(c[2]));
        let is_glossy = peak(mtl.ks) > 0.0;
        let is_metal =
            is_glossy && (matches!(illum, 3 | 5) || peak(mtl.kd) < 0.02) && mtl.map("kd").is_none();
        match illum {
            4 | 6 | 7 | 9 => self.dielectric(mtl),
            _ if is_metal => self.conductor(mtl),
            0 | 1 => self.diffuse(mtl),
            _ if is_glossy => self.principled(mtl),
            _ => self.diffuse(mtl),
        }
    }

    fn diffuse(&mut self, mtl: &Mtl) -> Entity {
        let mut material = Entity::new("diffuse");
        self.base_color(mtl, &mut material, "reflectance", 0.5);
        material
    }

    fn principled(&mut self, mtl: &Mtl) -> Entity {
        let mut material = Entity::new("principled");
        self.base_color(mtl, &mut material, "basecolor", 0.8);
        let numbers =
            [("Pm", "metallic"), ("Pc", "clearcoat"), ("Pcr", "clearcoatroughness"), ("aniso", "anisotropy")];
        for (theirs, ours) in numbers {
            if let Some((value, span)) = mtl.number(theirs) {
                material.parameters.push(placed(ours, Value::Floats(vec![value.clamp(0.0, 1.0)]), span));
            }
        }
        if let Some((sheen, span)) = mtl.number("Ps").filter(|(sheen, _)| *sheen > 0.0) {
            material.parameters.push(placed("sheencolor", Value::Rgb(vec![[sheen.min(1.0); 3]]), span));
        }
        if let Some((roughness, span)) = mtl.number("Pr") {
            material.parameters.push(placed(
                "roughness",
                Value::Floats(vec![roughness.clamp(0.0, 1.0)]),
                span,
            ));
        } else if let Some((alpha, span)) = alpha_of_exponent(mtl) {
            material.parameters.push(placed("roughness", Value::Floats(vec![alpha.sqrt()]), span));
        }
        for (keyword, ours) in [("pr", "roughness"), ("pm", "metallic")] {
            if let Some(map) = mtl.map(keyword) {
                let texture = self.picture(mtl, map, keyword, TextureValue::Float, 1.0);
                material.parameters.retain(|p| p.name != ours);
                material.parameters.push(placed(ours, texture, map.span));
            }
        }
        material
    }

    fn dielectric(&mut self, mtl: &Mtl) -> Entity {
        let mut material = Entity::new("dielectric");
        if let Some((index, span)) = mtl.number("Ni").filter(|(index, _)| *index > 0.0) {
            material.parameters.push(placed("eta", Value::Floats(vec![index]), span));
        }
        self.roughness(mtl, &mut material);
        material
    }

    fn conductor(&mut self, mtl: &Mtl) -> Entity {
        let mut material = Entity::new("conductor");
        let (ks, span) = mtl.ks.unwrap_or(([0.9; 3], mtl.span));
        // A reflectance of 1 needs an infinite index.
        let reflectance = ks.map(|c| c.clamp(0.0, 0.999));
        material.parameters.push(placed("reflectance", Value::Rgb(vec![reflectance]), span));
        self.roughness(mtl, &mut material);
        material
    }

    /// The alpha of facets; highlights of more than 1000 are mirrors.
    fn roughness(&mut self, mtl: &Mtl, material: &mut Entity) {
        let Some((alpha, span)) = alpha_of_exponent(mtl) else { return };
        let is_mirror = mtl.number("Ns").is_some_and(|(n, _)| n >= 1000.0);
        let alpha = if is_mirror { 0.0 } else { alpha };
        material.parameters.push(placed("roughness", Value::Floats(vec![alpha]), span));
        material.parameters.push(placed("remaproughness", Value::Bools(vec![false]), span));
    }

    /// `Kd`, or its picture, which it multiplies.
    fn base_color(&mut self, mtl: &Mtl, material: &mut Entity, name: &str, default: f32) {
        let (kd, span) = mtl.kd.unwrap_or(([default; 3], mtl.span));
        let kd = kd.map(|c| c.clamp(0.0, 1.0));
        let Some(map) = mtl.map("kd") else {
            material.parameters.push(placed(name, Value::Rgb(vec![kd]), span));
            return;
        };
        // Black with a picture is what some exporters write for white.
        let largest = if mtl.kd.is_none() || kd == [0.0; 3] { 1.0 } else { kd[0].max(kd[1]).max(kd[2]) };
        if kd.iter().any(|c| *c != kd[0]) {
            let message = "a picture is not tinted here: its factor is the largest component of `Kd`";
            self.diagnostics.warning(span, message);
        }
        let texture = self.picture(mtl, map, "kd", TextureValue::Spectrum, largest);
        material.parameters.push(placed(name, texture, map.span));
    }

    /// Normal maps and bumps; one of them counts.
    fn relief(&mut self, mtl: &Mtl, material: &mut Entity) {
        if let Some(map) = mtl.map("norm") {
            let file = Value::Strings(vec![self.file(map)]);
            material.parameters.push(placed("normalmap", file, map.span));
        } else if let Some(map) = mtl.map("bump") {
            // Heights are meant for the size of the body: white is a hundredth of it.
            let texture = self.picture(mtl, map, "bump", TextureValue::Float, 0.01 * self.extent * map.bump);
            material.parameters.push(placed("displacement", texture, map.span));
        }
        for keyword in ["disp", "decal", "ks", "ns"] {
            if let Some(map) = mtl.map(keyword) {
                let message = format!("pictures of `{keyword}` are not used here");
                self.diagnostics.warning(map.span, message);
            }
        }
    }

    /// Opacity, but for glass, which says how it transmits.
    fn alpha(&mut self, mtl: &Mtl) -> Option<Value> {
        if let Some(map) = mtl.map("d") {
            return Some(self.picture(mtl, map, "d", TextureValue::Float, 1.0));
        }
        let is_glass = mtl.number("illum").is_some_and(|(illum, _)| matches!(illum as i32, 4 | 6 | 7 | 9));
        let (opacity, _) = mtl.number("d").filter(|(d, _)| *d < 1.0 && !is_glass)?;
        Some(Value::Floats(vec![opacity.max(0.0)]))
    }

    fn light(&mut self, mtl: &Mtl) -> Option<Entity> {
        let mut light = Entity { span: Some(mtl.span), ..Entity::new("diffuse") };
        if let Some(map) = mtl.map("ke") {
            let file = Value::Strings(vec![self.file(map)]);
            light.parameters.push(placed("filename", file, map.span));
            return Some(light);
        }
        let (ke, span) = mtl.ke.filter(|(ke, _)| ke.iter().any(|c| *c > 0.0))?;
        light.parameters.push(placed("L", Value::Rgb(vec![ke.map(|c| c.max(0.0))]), span));
        Some(light)
    }

    fn file(&self, map: &Map) -> String {
        format!("{}{}", self.folder, map.file)
    }

    /// A texture of a picture, times a factor.
    fn picture(&mut self, mtl: &Mtl, map: &Map, keyword: &str, kind: TextureValue, factor: f32) -> Value {
        let mut image = Entity { span: Some(map.span), ..Entity::new("imagemap") };
        image.parameters.push(placed("filename", Value::Strings(vec![self.file(map)]), map.span));
        if kind == TextureValue::Float {
            image = image.with("encoding", Value::Strings(vec!["linear".to_owned()]));
        }
        if map.is_clamped {
            image = image.with("wrap", Value::Strings(vec!["clamp".to_owned()]));
        }
        let numbers = [
            ("uscale", map.scale[0], 1.0),
            ("vscale", map.scale[1], 1.0),
            ("udelta", map.offset[0], 0.0),
            ("vdelta", map.offset[1], 0.0),
            ("scale", factor, 1.0),
        ];
        for (name, value, _) in numbers.into_iter().filter(|(_, value, default)| value != default) {
            image = image.with(name, Value::Floats(vec![value]));
        }
        let name = format!("{} {keyword}", mtl.name);
        let world_from_texture = Transform::IDENTITY;
        let texture = TextureEntity { name: name.clone(), value: kind, world_from_texture, entity: image };
        self.document.textures.push(texture);
        Value::Texture(name)
    }
}

/// Alpha of facets as wide as the highlight of `Ns`.
fn alpha_of_exponent(mtl: &Mtl) -> Option<(f32, Span)> {
    mtl.number("Ns").map(|(n, span)| ((2.0 / (n.max(0.0) + 2.0)).sqrt(), span))
}

fn placed(name: &str, value: Value, span: Span) -> Parameter {
    Parameter { span: Some(span), ..Parameter::new(name, value) }
}
