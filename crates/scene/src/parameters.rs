//! Typed access to the parameters of an entity.
//!
//! A builder asks for each parameter it knows, by name and type; [`Parameters::finish`] then warns of those that
//! nobody asked for, with the nearest known name. What a builder may ask for is also written down as a table of
//! [`ParameterSpec`]s, from which the documentation is made.

use std::collections::HashMap;

use etendue_math::{Normal3, Point2, Point3, Vector2, Vector3};
use etendue_spectrum::{ColorSpace, Spectrum, SpectrumTables};

use crate::assets::Assets;
use crate::diagnostics::{Diagnostics, Span, nearest_name};
use crate::document::{Entity, Parameter, Value};
use crate::texture::{FloatTexture, SpectrumTexture};

/// What documentation says of a parameter.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct ParameterSpec {
    /// Name in scene files.
    pub name: &'static str,
    /// Type in scene files: `float`, `spectrum texture`, ...
    pub kind: &'static str,
    /// Default as one would write it; empty if there is none.
    pub default: &'static str,
    /// Unit; empty for pure numbers.
    pub unit: &'static str,
    /// One line.
    pub doc: &'static str,
}

/// Shorthand for tables of parameters.
pub(crate) const fn spec(
    name: &'static str,
    kind: &'static str,
    default: &'static str,
    unit: &'static str,
    doc: &'static str,
) -> ParameterSpec {
    ParameterSpec { name, kind, default, unit, doc }
}

/// How an RGB value becomes a spectrum.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum SpectrumRole {
    /// A reflectance in [0, 1].
    Albedo,
    /// A positive quantity without bound, such as an index of refraction or a coefficient.
    Unbounded,
    /// Light: the colour multiplies the white of its colour space.
    Illuminant,
}

impl SpectrumRole {
    /// All roles.
    pub const ALL: [Self; 3] = [Self::Albedo, Self::Unbounded, Self::Illuminant];
}

/// What entities are built from, and where spectra, textures and problems go.
#[derive(Debug)]
pub struct BuildContext<'a> {
    /// Files that the document names, already read.
    pub assets: &'a Assets,
    /// Where tabulated spectra go.
    pub spectra: SpectrumTables,
    /// Float textures by name.
    pub float_textures: HashMap<String, FloatTexture>,
    /// Spectrum textures by name and role.
    pub spectrum_textures: HashMap<(String, SpectrumRole), SpectrumTexture>,
    /// Problems so far.
    pub diagnostics: Diagnostics,
    /// How deep the textures so far are nested, by name.
    pub(crate) texture_depths: HashMap<String, u32>,
    named_spectra: HashMap<String, Spectrum>,
}

impl<'a> BuildContext<'a> {
    /// A context without textures.
    #[must_use]
    pub fn new(assets: &'a Assets) -> Self {
        Self {
            assets,
            spectra: SpectrumTables::new(),
            float_textures: HashMap::new(),
            spectrum_textures: HashMap::new(),
            diagnostics: Diagnostics::default(),
            texture_depths: HashMap::new(),
            named_spectra: HashMap::new(),
        }
    }

    /// A built-in spectrum, or one that was read from a file; a problem is reported at `span`.
    pub fn named_spectrum(&mut self, name: &str, span: Option<Span>) -> Option<Spectrum> {
        if let Some(spectrum) = self.named_spectra.get(name) {
            return Some(*spectrum);
        }
        let samples = if let Some(samples) = etendue_spectrum::named_spectrum(name) {
            samples.samples
        } else if let Some(samples) = self.assets.spectra.get(name) {
            samples.clone()
        } else if self.assets.failed.contains(name) {
            return None;
        } else if let Some(stand_in) = etendue_spectrum::known_but_missing(name) {
            self.diagnostics.warning(
                span,
                format!("the spectrum \"{name}\" is not built in yet; \"{stand_in}\" stands in for it"),
            );
            etendue_spectrum::named_spectrum(stand_in)?.samples
        } else {
            let error = self.diagnostics.error(span, format!("unknown spectrum \"{name}\""));
            let known = etendue_spectrum::named_spectrum_names();
            if let Some(near) = nearest_name(name, known.iter().map(String::as_str)) {
                error.with_help(format!("did you mean \"{near}\"?"));
            }
            return None;
        };
        let spectrum = self.spectra.add_samples(&samples);
        self.named_spectra.insert(name.to_owned(), spectrum);
        Some(spectrum)
    }

    /// The spectrum of a parameter; a problem is reported and gives `None`.
    pub fn spectrum_of(&mut self, parameter: &Parameter, role: SpectrumRole) -> Option<Spectrum> {
        match &parameter.value {
            Value::Rgb(values) => {
                let rgb = *values.first()?;
                let space = ColorSpace::get(parameter.color_space);
                if rgb.iter().any(|c| *c < 0.0 || !c.is_finite()) {
                    self.diagnostics.error(
                        parameter.span,
                        format!("\"{}\" has a negative or non-finite colour", parameter.name),
                    );
                    return None;
                }
                Some(match role {
                    SpectrumRole::Albedo => {
                        if rgb.iter().any(|c| *c > 1.0) {
                            self.diagnostics.warning(
                                parameter.span,
                                format!(
                                    "\"{}\" is a reflectance above 1; it is clamped to 1",
                                    parameter.name
                                ),
                            );
                        }
                        space.rgb_albedo(rgb)
                    }
                    SpectrumRole::Unbounded => space.rgb_unbounded(rgb),
                    SpectrumRole::Illuminant => space.rgb_illuminant(&mut self.spectra, rgb),
                })
            }
            Value::Blackbody(kelvin) => Some(Spectrum::blackbody(*kelvin.first()?)),
            Value::SpectrumNames(names) => {
                let name = names.first()?.clone();
                self.named_spectrum(&name, parameter.span)
            }
            Value::SpectrumSamples(samples) => Some(self.spectra.add_samples(samples)),
            Value::Floats(values) => Some(Spectrum::Constant(*values.first()?)),
            other => {
                self.diagnostics.error(
                    parameter.span,
                    format!("\"{}\" must be a spectrum, not a {}", parameter.name, other.type_name()),
                );
                None
            }
        }
    }
}

/// The parameters of one entity while it is built.
#[derive(Debug)]
pub struct Parameters<'a, 'c> {
    entity: &'a Entity,
    /// Shared state of the build.
    pub context: &'a mut BuildContext<'c>,
    used: Vec<bool>,
    asked: Vec<&'static str>,
}

/// A getter for single values and arrays of one variant of [`Value`].
macro_rules! getter {
    ($(#[$doc:meta])* $one:ident, $many:ident, $variant:ident, $type:ty) => {
        $(#[$doc])*
        pub fn $many(&mut self, name: &'static str) -> Option<&'a [$type]> {
            let parameter = self.find(name)?;
            if let Value::$variant(values) = &parameter.value {
                return Some(values);
            }
            self.mismatch(parameter, stringify!($one));
            None
        }

        /// The only value of that parameter, or `None`; other counts and types are reported.
        pub fn $one(&mut self, name: &'static str) -> Option<$type> {
            let values = self.$many(name)?;
            self.expect_one(name, values.len());
            values.first().cloned()
        }
    };
}

impl<'a, 'c> Parameters<'a, 'c> {
    /// Starts reading `entity`.
    pub fn new(entity: &'a Entity, context: &'a mut BuildContext<'c>) -> Self {
        Self { entity, context, used: vec![false; entity.parameters.len()], asked: Vec::new() }
    }

    /// The entity.
    #[must_use]
    pub const fn entity(&self) -> &'a Entity {
        self.entity
    }

    /// Place of the entity's type name.
    #[must_use]
    pub const fn span(&self) -> Option<Span> {
        self.entity.span
    }

    /// Problems so far, to add to.
    pub const fn diagnostics(&mut self) -> &mut Diagnostics {
        &mut self.context.diagnostics
    }

    /// Place of a parameter, or of the entity if it is not given.
    #[must_use]
    pub fn span_of(&self, name: &str) -> Option<Span> {
        self.entity.parameters.iter().find(|p| p.name == name).and_then(|p| p.span).or(self.entity.span)
    }

    /// The parameter of that name, marked as known and used.
    pub fn find(&mut self, name: &'static str) -> Option<&'a Parameter> {
        if !self.asked.contains(&name) {
            self.asked.push(name);
        }
        let index = self.entity.parameters.iter().position(|p| p.name == name)?;
        self.used[index] = true;
        Some(&self.entity.parameters[index])
    }

    /// True if the parameter is given; marks it as known, but not as used.
    pub fn has(&mut self, name: &'static str) -> bool {
        if !self.asked.contains(&name) {
            self.asked.push(name);
        }
        self.entity.parameters.iter().any(|p| p.name == name)
    }

    /// The number that a formula calls by this name, marked as used.
    pub(crate) fn named_number(&mut self, name: &str) -> Option<f32> {
        let index = self.entity.parameters.iter().position(|p| p.name == name)?;
        let number = match &self.entity.parameters[index].value {
            Value::Floats(values) if values.len() == 1 => values[0],
            Value::Integers(values) if values.len() == 1 => values[0] as f32,
            _ => return None,
        };
        self.used[index] = true;
        Some(number)
    }

    /// The names of all parameters that are single numbers.
    pub(crate) fn number_names(&self) -> Vec<String> {
        let is_number = |value: &Value| matches!(value, Value::Floats(_) | Value::Integers(_));
        let numbers = self.entity.parameters.iter().filter(|p| is_number(&p.value));
        numbers.map(|p| p.name.clone()).collect()
    }

    /// Accepts a parameter without using it.
    pub fn ignore(&mut self, name: &'static str) {
        let _ = self.find(name);
    }

    /// Accepts all parameters: after a type name that is not known, their names say nothing.
    pub fn accept_all(&mut self) {
        self.used.fill(true);
    }

    /// Reports that the entity cannot be built without the parameter `name`, nor with an empty one, unless it is there
    /// and what is wrong with it has been reported already.
    pub fn missing(&mut self, name: &'static str, message: impl Into<String>) {
        let given = self.find(name).map(|parameter| &parameter.value);
        let is_empty_name =
            matches!(given, Some(Value::Strings(names)) if names.iter().all(String::is_empty));
        if is_empty_name || given.is_none() && !self.entity.is_incomplete {
            let span = self.span_of(name);
            self.context.diagnostics.error(span, message);
        }
        self.accept_all();
    }

    fn mismatch(&mut self, parameter: &Parameter, wanted: &str) {
        let wanted = wanted.trim_end_matches("_value").trim_end_matches("_opt");
        self.context.diagnostics.error(
            parameter.span,
            format!("\"{}\" must be of type {wanted}, not {}", parameter.name, parameter.value.type_name()),
        );
    }

    fn expect_one(&mut self, name: &'static str, n_values: usize) {
        if n_values != 1 {
            let span = self.span_of(name);
            self.context.diagnostics.error(span, format!("\"{name}\" takes one value, not {n_values}"));
        }
    }

    getter!(
        /// Floats of that name.
        float_opt, floats, Floats, f32
    );
    getter!(
        /// Integers of that name.
        integer_opt, integers, Integers, i32
    );
    getter!(
        /// Booleans of that name.
        bool_opt, bools, Bools, bool
    );
    getter!(
        /// Strings of that name.
        string_opt, strings, Strings, String
    );
    getter!(
        /// Points in the plane.
        point2_opt, points2, Points2, Point2
    );
    getter!(
        /// Vectors in the plane.
        vector2_opt, vectors2, Vectors2, Vector2
    );
    getter!(
        /// Points in space.
        point3_opt, points3, Points3, Point3
    );
    getter!(
        /// Vectors in space.
        vector3_opt, vectors3, Vectors3, Vector3
    );
    getter!(
        /// Normals.
        normal3_opt, normals3, Normals3, Normal3
    );

    /// A float with a default.
    pub fn float(&mut self, name: &'static str, default: f32) -> f32 {
        self.float_opt(name).unwrap_or(default)
    }

    /// A float between `least` and `most`, with a default; a number beyond is reported and clamped, NaN gives way to the default.
    pub fn float_within(&mut self, name: &'static str, default: f32, [least, most]: [f32; 2]) -> f32 {
        let value = self.float(name, default);
        if (least..=most).contains(&value) {
            return value;
        }
        let taken = if value.is_nan() { default } else { value.clamp(least, most) };
        let message =
            format!("\"{name}\" must be between {least} and {most}, but is {value}; {taken} is taken");
        let span = self.span_of(name);
        self.context.diagnostics.warning(span, message);
        taken
    }

    /// An integer with a default.
    pub fn integer(&mut self, name: &'static str, default: i32) -> i32 {
        self.integer_opt(name).unwrap_or(default)
    }

    /// A number of things with a default; negative ones are reported.
    pub fn count(&mut self, name: &'static str, default: u32) -> u32 {
        let Some(value) = self.integer_opt(name) else { return default };
        u32::try_from(value).unwrap_or_else(|_| {
            let span = self.span_of(name);
            self.context.diagnostics.error(span, format!("\"{name}\" must not be negative, but is {value}"));
            default
        })
    }

    /// A number of things between `least` and `most`, with a default; a number beyond is reported and clamped.
    pub fn count_within(&mut self, name: &'static str, default: u32, least: u32, most: u32) -> u32 {
        let value = self.count(name, default);
        let clamped = value.clamp(least, most);
        if clamped != value {
            let message =
                format!("\"{name}\" must be between {least} and {most}, but is {value}; {clamped} is taken");
            let span = self.span_of(name);
            self.context.diagnostics.warning(span, message);
        }
        clamped
    }

    /// A boolean with a default.
    pub fn bool(&mut self, name: &'static str, default: bool) -> bool {
        self.bool_opt(name).unwrap_or(default)
    }

    /// A string with a default.
    pub fn string(&mut self, name: &'static str, default: &str) -> String {
        self.string_opt(name).unwrap_or_else(|| default.to_owned())
    }

    /// A point in space with a default.
    pub fn point3(&mut self, name: &'static str, default: Point3) -> Point3 {
        self.point3_opt(name).unwrap_or(default)
    }

    /// A vector in space with a default.
    pub fn vector3(&mut self, name: &'static str, default: Vector3) -> Vector3 {
        self.vector3_opt(name).unwrap_or(default)
    }

    /// One of a fixed set of words; anything else is reported and gives the default.
    pub fn choice<T: Copy>(&mut self, name: &'static str, default: &str, choices: &[(&str, T)]) -> T {
        let pick = |word: &str| choices.iter().find(|(key, _)| *key == word).map(|(_, value)| *value);
        let word = self.string(name, default);
        if let Some(value) = pick(&word) {
            return value;
        }
        let span = self.span_of(name);
        let known = choices.iter().map(|(key, _)| *key);
        self.context.diagnostics.unknown_name(span, name, &word, known);
        pick(default).expect("the default is one of the choices")
    }

    /// A spectrum, or `None` if not given or wrong (which is reported).
    pub fn spectrum(&mut self, name: &'static str, role: SpectrumRole) -> Option<Spectrum> {
        let parameter = self.find(name)?;
        self.context.spectrum_of(parameter, role)
    }

    /// The RGB value of a parameter, if it was given as one.
    pub fn rgb(&mut self, name: &'static str) -> Option<[f32; 3]> {
        match &self.find(name)?.value {
            Value::Rgb(values) => values.first().copied(),
            _ => None,
        }
    }

    /// A number that may be textured, or `None` if not given.
    pub fn float_texture_opt(&mut self, name: &'static str) -> Option<FloatTexture> {
        let parameter = self.find(name)?;
        match &parameter.value {
            Value::Texture(texture) => {
                if let Some(found) = self.context.float_textures.get(texture) {
                    return Some(*found);
                }
                self.unknown_texture(parameter, texture, "float");
                None
            }
            Value::Floats(values) => {
                self.expect_one(name, values.len());
                values.first().map(|value| FloatTexture::Constant(*value))
            }
            Value::Integers(values) => values.first().map(|value| FloatTexture::Constant(*value as f32)),
            _ => {
                self.mismatch(parameter, "float or texture");
                None
            }
        }
    }

    /// A number that may be textured, with a default.
    pub fn float_texture(&mut self, name: &'static str, default: f32) -> FloatTexture {
        self.float_texture_opt(name).unwrap_or(FloatTexture::Constant(default))
    }

    /// A spectrum that may be textured, or `None` if not given.
    pub fn spectrum_texture_opt(
        &mut self,
        name: &'static str,
        role: SpectrumRole,
    ) -> Option<SpectrumTexture> {
        let parameter = self.find(name)?;
        let Value::Texture(texture) = &parameter.value else {
            return self.context.spectrum_of(parameter, role).map(SpectrumTexture::Constant);
        };
        if let Some(found) = self.context.spectrum_textures.get(&(texture.clone(), role)) {
            return Some(*found);
        }
        self.unknown_texture(parameter, texture, "spectrum");
        None
    }

    /// A spectrum that may be textured, with a default.
    pub fn spectrum_texture(
        &mut self,
        name: &'static str,
        default: Spectrum,
        role: SpectrumRole,
    ) -> SpectrumTexture {
        self.spectrum_texture_opt(name, role).unwrap_or(SpectrumTexture::Constant(default))
    }

    fn unknown_texture(&mut self, parameter: &Parameter, texture: &str, kind: &str) {
        let floats = &self.context.float_textures;
        let spectra = &self.context.spectrum_textures;
        let near = if kind == "float" {
            nearest_name(texture, floats.keys().map(String::as_str)).map(str::to_owned)
        } else {
            nearest_name(texture, spectra.keys().map(|(name, _)| name.as_str())).map(str::to_owned)
        };
        let is_of_other_kind = match kind {
            "float" => spectra.keys().any(|(name, _)| name == texture),
            _ => floats.contains_key(texture),
        };
        let error = self.context.diagnostics.error(
            parameter.span,
            format!("no {kind} texture named \"{texture}\" is defined before its use"),
        );
        if is_of_other_kind {
            let other = if kind == "float" { "spectrum" } else { "float" };
            error.with_help(format!("\"{texture}\" is a {other} texture; here a {kind} texture is needed"));
        } else if let Some(near) = near {
            error.with_help(format!("did you mean \"{near}\"?"));
        }
    }

    /// Warns of parameters that nobody asked for.
    pub fn finish(self) {
        for (parameter, used) in self.entity.parameters.iter().zip(&self.used) {
            if *used || parameter.may_be_unused || self.asked.contains(&parameter.name.as_str()) {
                continue;
            }
            let warning = self.context.diagnostics.warning(
                parameter.span,
                format!(
                    "\"{}\" does not know the parameter \"{}\"; it is ignored",
                    self.entity.type_name, parameter.name
                ),
            );
            if let Some(near) = nearest_name(&parameter.name, self.asked.iter().copied()) {
                warning.with_help(format!("did you mean \"{near}\"?"));
            }
        }
    }
}
