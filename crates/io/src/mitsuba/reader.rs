//! What all kinds of plugins share: properties by name, references, values that may be textures.

use std::collections::HashMap;

use etendue_math::{AnimatedTransform, Transform};
use etendue_scene::diagnostics::nearest_name;
use etendue_scene::document::{Document, Entity, Parameter, TextureValue, Value};
use etendue_scene::{Diagnostics, Span};

use super::element::Element;
use super::files::Files;
use super::materials::Surface;
use super::meshes::MeshRequest;
use super::values::{self, SpectrumValue};

/// Flat spectra of version 3 are in W/(m^2 sr nm) and give Y = 1 where they are 1. Ours would give
/// Y = 683.002 lm/W times the integral of the observer's curve, 106.857 nm.
pub(super) const FROM_RADIOMETRIC: f32 = (1.0 / (683.002 * 106.856_895)) as f32;

/// Levels of plugins inside of each other, with those that references lead to.
const MAX_DEPTH: usize = 64;

/// References to nothing, and to parameters without value, that get a suggestion.
pub(super) const MAX_SUGGESTED: usize = 20;

/// Turns elements into a document.
#[derive(Debug)]
pub(super) struct Reader<'e> {
    pub(super) files: Files,
    pub(super) diagnostics: Diagnostics,
    pub(super) document: Document,
    /// Elements by their `id`.
    pub(super) ids: HashMap<&'e str, &'e Element>,
    /// What was made of a BSDF.
    pub(super) surfaces: HashMap<usize, Surface>,
    /// BSDFs that are materials of the document.
    pub(super) materials: std::collections::HashSet<usize>,
    /// What was made of a texture, by the kind of its values.
    pub(super) textures: HashMap<(usize, bool), Option<Value>>,
    /// Meshes to be read at the end, with their names in the document.
    pub(super) meshes: Vec<(String, MeshRequest)>,
    /// Versions before 2 mean other defaults.
    pub(super) is_legacy: bool,
    /// References to nothing so far.
    n_unknown_ids: usize,
    /// Elements of the shapes that merges led to so far.
    pub(super) n_merged: usize,
    /// Plugins that are being read.
    open: Vec<usize>,
    /// Names that were asked of a plugin.
    asked: HashMap<usize, Vec<&'static str>>,
}

impl<'e> Reader<'e> {
    pub(super) fn new(mut files: Files, root: &'e Element) -> Self {
        let diagnostics = std::mem::take(&mut files.diagnostics);
        let version = root.text("version");
        let major = version.split('.').next().and_then(|major| major.parse::<u32>().ok());
        let mut reader = Self {
            document: Document { sources: std::mem::take(&mut files.sources), ..Document::default() },
            files,
            diagnostics,
            ids: HashMap::new(),
            surfaces: HashMap::new(),
            materials: std::collections::HashSet::new(),
            textures: HashMap::new(),
            meshes: Vec::new(),
            is_legacy: major.is_some_and(|major| major < 2),
            n_unknown_ids: 0,
            n_merged: 0,
            open: Vec::new(),
            asked: HashMap::new(),
        };
        reader.collect_ids(root);
        reader
    }

    fn collect_ids(&mut self, element: &'e Element) {
        for child in &element.children {
            let id = child.text("id");
            if child.tag != "ref" && !id.is_empty() && self.ids.insert(id, child).is_some() {
                self.diagnostics.error(child.span, format!("the id `{id}` is given twice"));
            }
            self.collect_ids(child);
        }
    }

    /// Runs `read` unless the plugin is being read already, or too many are.
    pub(super) fn guarded<T>(
        &mut self,
        plugin: &'e Element,
        read: impl FnOnce(&mut Self) -> Option<T>,
    ) -> Option<T> {
        if self.open.contains(&plugin.number) || self.open.len() >= MAX_DEPTH {
            let message = format!("`{}` refers to itself, or is nested too deep", plugin.plugin());
            self.diagnostics.error(plugin.plugin_span(), message);
            return None;
        }
        self.open.push(plugin.number);
        let result = read(self);
        self.open.pop();
        result
    }

    /// What an element is: itself, or what a reference names.
    pub(super) fn resolved(&mut self, element: &'e Element) -> Option<&'e Element> {
        if element.tag != "ref" {
            return Some(element);
        }
        let id = element.text("id");
        let found = self.ids.get(id).copied();
        if found.is_none() {
            self.n_unknown_ids += 1;
            // To compare each of many with all that there are takes too long.
            let all = self.n_unknown_ids <= MAX_SUGGESTED;
            let known = self.ids.keys().copied().filter(|_| all).collect::<Vec<_>>();
            let span = element.attribute("id").map_or(element.span, |attribute| attribute.span);
            self.diagnostics.unknown_name(span, "id", id, known);
        }
        found
    }
}

/// Properties by name.
impl<'e> Reader<'e> {
    /// The last child of that name, which counts as read.
    pub(super) fn property(&mut self, plugin: &'e Element, name: &'static str) -> Option<&'e Element> {
        self.asked.entry(plugin.number).or_default().push(name);
        let mut found = None;
        for child in plugin.children.iter().filter(|child| child.name == name) {
            child.used.set(true);
            found = Some(child);
        }
        found
    }

    /// True if there is a child of that name.
    pub(super) fn has(plugin: &Element, name: &str) -> bool {
        plugin.children.iter().any(|child| child.name == name)
    }

    fn value_of(&mut self, property: &'e Element) -> Option<&'e super::element::Attribute> {
        let value = property.attribute("value");
        if value.is_none() {
            self.diagnostics.error(property.span, format!("`{}` has no `value`", property.name));
        }
        value
    }

    pub(super) fn float_opt(&mut self, plugin: &'e Element, name: &'static str) -> Option<f32> {
        let property = self.property(plugin, name)?;
        let value = self.value_of(property)?;
        values::number(value, &mut self.diagnostics)
    }

    pub(super) fn float(&mut self, plugin: &'e Element, name: &'static str, default: f32) -> f32 {
        self.float_opt(plugin, name).unwrap_or(default)
    }

    pub(super) fn integer_opt(&mut self, plugin: &'e Element, name: &'static str) -> Option<i32> {
        let property = self.property(plugin, name)?;
        let value = self.value_of(property)?;
        let number = value.value.trim().parse().ok();
        if number.is_none() {
            self.diagnostics.error(value.span, format!("`{}` is not an integer", value.value));
        }
        number
    }

    pub(super) fn integer(&mut self, plugin: &'e Element, name: &'static str, default: i32) -> i32 {
        self.integer_opt(plugin, name).unwrap_or(default)
    }

    pub(super) fn boolean(&mut self, plugin: &'e Element, name: &'static str, default: bool) -> bool {
        let Some(property) = self.property(plugin, name) else { return default };
        let Some(value) = self.value_of(property) else { return default };
        match value.value.trim().to_lowercase().as_str() {
            "true" => true,
            "false" => false,
            _ => {
                self.diagnostics.error(value.span, format!("`{}` is neither true nor false", value.value));
                default
            }
        }
    }

    /// The text of a property with its place.
    pub(super) fn string(&mut self, plugin: &'e Element, name: &'static str) -> Option<(&'e str, Span)> {
        let property = self.property(plugin, name)?;
        let value = self.value_of(property)?;
        Some((value.value.trim(), value.span))
    }

    pub(super) fn triple(&mut self, plugin: &'e Element, name: &'static str, default: [f32; 3]) -> [f32; 3] {
        let Some(property) = self.property(plugin, name) else { return default };
        values::triple(property, 0.0, &mut self.diagnostics).unwrap_or(default)
    }

    /// A transform that may move, the identity if there is none.
    pub(super) fn transform(&mut self, plugin: &'e Element, name: &'static str) -> AnimatedTransform {
        let Some(property) = self.property(plugin, name) else {
            return AnimatedTransform::constant(Transform::IDENTITY);
        };
        if property.tag == "animation" {
            return self.animation(property);
        }
        AnimatedTransform::constant(values::transform(property, &mut self.diagnostics))
    }

    fn animation(&mut self, property: &'e Element) -> AnimatedTransform {
        let mut keys: Vec<(f32, Transform)> = Vec::new();
        for key in &property.children {
            let time = key.attribute("time").map_or(Some(0.0), |t| values::number(t, &mut self.diagnostics));
            keys.push((time.unwrap_or(0.0), values::transform(key, &mut self.diagnostics)));
        }
        keys.sort_by(|a, b| a.0.total_cmp(&b.0));
        if keys.len() > 2 {
            let message = "motion has a first and a last transform here; those between are left out";
            self.diagnostics.warning(property.span, message);
        }
        match (keys.first(), keys.last()) {
            (Some((start_time, start)), Some((end_time, end))) if start_time < end_time => {
                AnimatedTransform { start: *start, end: *end, start_time: *start_time, end_time: *end_time }
            }
            (Some((_, only)), _) => AnimatedTransform::constant(*only),
            _ => AnimatedTransform::constant(Transform::IDENTITY),
        }
    }

    /// Nested plugins of a kind, of any name, with references resolved.
    pub(super) fn nested(&mut self, plugin: &'e Element, tag: &str) -> Vec<&'e Element> {
        let mut found = Vec::new();
        for child in plugin.children.iter().filter(|child| child.is_plugin()) {
            let target =
                if child.tag == "ref" { self.ids.get(child.text("id")).copied() } else { Some(child) };
            if let Some(target) = target.filter(|target| target.tag == tag) {
                child.used.set(true);
                found.push(target);
            }
        }
        found
    }

    /// Warns of what nobody has read.
    pub(super) fn finish(&mut self, plugin: &'e Element) {
        let asked = self.asked.remove(&plugin.number).unwrap_or_default();
        for child in plugin.children.iter().filter(|child| !child.used.get()) {
            // One warning is enough, however often the plugin is used.
            child.used.set(true);
            if child.tag == "ref" && self.resolved(child).is_none() {
                continue;
            }
            let what = if child.name.is_empty() { format!("<{}>", child.tag) } else { child.name.clone() };
            let message = format!("`{}` has no use for `{what}`; it is ignored", described(plugin));
            let warning = self.diagnostics.warning(child.span, message);
            if let Some(near) = nearest_name(&child.name, asked.iter().copied()) {
                warning.with_help(format!("did you mean `{near}`?"));
            }
        }
    }

    /// Takes properties that have no counterpart here, with a warning if they are given.
    pub(super) fn ignore(&mut self, plugin: &'e Element, names: &[&'static str], why: &str) {
        for name in names {
            if let Some(property) = self.property(plugin, name) {
                let message = format!("`{name}` of `{}` is ignored: {why}", plugin.plugin());
                self.diagnostics.warning(property.span, message);
            }
        }
    }

    /// Takes properties that make no difference here.
    pub(super) fn accept(&mut self, plugin: &'e Element, names: &[&'static str]) {
        for name in names {
            self.property(plugin, name);
        }
    }

    /// Reports a type that nothing is made of: known ones are a warning, others an error.
    pub(super) fn unknown_plugin(
        &mut self,
        plugin: &'e Element,
        missing: &[&str],
        known: &[&'static str],
        instead: &str,
    ) {
        for child in &plugin.children {
            child.used.set(true);
        }
        let (kind, span) = (plugin.plugin(), plugin.plugin_span());
        if missing.contains(&kind) {
            let message = format!("the {} `{kind}` is not available; {instead}", plugin.tag);
            self.diagnostics.warning(span, message);
        } else {
            let known = known.iter().copied().chain(missing.iter().copied()).collect::<Vec<_>>();
            self.diagnostics.unknown_name(span, &plugin.tag, kind, known);
        }
    }
}

/// `bsdf diffuse`, for messages.
fn described(plugin: &Element) -> String {
    if plugin.plugin().is_empty() {
        plugin.tag.clone()
    } else {
        format!("{} {}", plugin.tag, plugin.plugin())
    }
}

/// Values that may be textures.
impl<'e> Reader<'e> {
    /// A colour or a texture of colours, if the plugin has it.
    pub(super) fn color_opt(&mut self, plugin: &'e Element, name: &'static str) -> Option<(Value, Span)> {
        let property = self.property(plugin, name)?;
        let value = self.spectrum_value(property)?;
        Some((value, property.span))
    }

    fn spectrum_value(&mut self, property: &'e Element) -> Option<Value> {
        if property.is_plugin() {
            let texture = self.resolved(property)?;
            return self.texture(texture, TextureValue::Spectrum);
        }
        match property.tag.as_str() {
            "float" => {
                let value = self.value_of(property)?;
                values::number(value, &mut self.diagnostics).map(|x| Value::Rgb(vec![[x; 3]]))
            }
            "rgb" | "srgb" => values::color(property, &mut self.diagnostics).map(|rgb| Value::Rgb(vec![rgb])),
            "spectrum" => self.spectrum_of(property).map(SpectrumValue::into_value),
            other => {
                let message = format!("`{}` should be a colour, not a `{other}`", property.name);
                self.diagnostics.error(property.span, message);
                None
            }
        }
    }

    /// The spectrum of `<spectrum value="..."/>` or `filename`.
    pub(super) fn spectrum_of(&mut self, property: &'e Element) -> Option<SpectrumValue> {
        if let Some(file) = property.attribute("filename") {
            return Some(SpectrumValue::File(self.files.resolved(&file.value)));
        }
        let value = self.value_of(property)?;
        values::spectrum(value, &mut self.diagnostics)
    }

    /// A number or a texture of numbers, if the plugin has it.
    pub(super) fn number_opt(&mut self, plugin: &'e Element, name: &'static str) -> Option<(Value, Span)> {
        let property = self.property(plugin, name)?;
        let value = if property.is_plugin() {
            let texture = self.resolved(property)?;
            self.texture(texture, TextureValue::Float)?
        } else if matches!(property.tag.as_str(), "rgb" | "srgb") {
            let rgb = values::color(property, &mut self.diagnostics)?;
            Value::Floats(vec![etendue_image::luminance(rgb)])
        } else {
            let value = self.value_of(property)?;
            Value::Floats(vec![values::number(value, &mut self.diagnostics)?])
        };
        Some((value, property.span))
    }

    /// Gives `entity` the colour `theirs` under the name `ours`; true if there is one.
    pub(super) fn pass_color(
        &mut self,
        plugin: &'e Element,
        theirs: &'static str,
        entity: &mut Entity,
        ours: &str,
    ) -> bool {
        let color = self.color_opt(plugin, theirs);
        let found = color.is_some();
        entity.parameters.extend(color.map(|(value, span)| parameter(ours, value, span)));
        found
    }

    /// The same for a number.
    pub(super) fn pass_number(
        &mut self,
        plugin: &'e Element,
        theirs: &'static str,
        entity: &mut Entity,
        ours: &str,
    ) -> bool {
        let number = self.number_opt(plugin, theirs);
        let found = number.is_some();
        entity.parameters.extend(number.map(|(value, span)| parameter(ours, value, span)));
        found
    }

    /// A name for something that the document knows by name: its id, or its kind and number.
    pub(super) fn name_of(plugin: &Element) -> String {
        match plugin.text("id") {
            "" => format!("{} {}", plugin.tag, plugin.number),
            id => id.to_owned(),
        }
    }
}

/// A parameter with its place.
pub(super) fn parameter(name: &str, value: Value, span: Span) -> Parameter {
    Parameter { span: Some(span), ..Parameter::new(name, value) }
}

/// An entity with the place of the plugin that it stands for.
pub(super) fn entity(type_name: &str, plugin: &Element) -> Entity {
    Entity { span: Some(plugin.plugin_span()), ..Entity::new(type_name) }
}
