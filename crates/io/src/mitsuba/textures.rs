//! Textures. Rows of Mitsuba's pictures are counted from the top and ours from the bottom, so that v goes the other way:
//! the v of all shapes is turned round (`v = 1 - theirs`), and so are the transforms of textures.

use etendue_math::Transform;
use etendue_scene::document::{Entity, TextureEntity, TextureValue, Value};

use super::element::Element;
use super::reader::{Reader, entity, parameter};
use super::values::{self, SpectrumValue};

const KNOWN: &[&str] = &[
    "bitmap",
    "checkerboard",
    "mesh_attribute",
    "vertexcolors",
    "scale",
    "rgb",
    "srgb",
    "srgb_d65",
    "uniform",
    "d65",
    "regular",
    "irregular",
    "blackbody",
];
const MISSING: &[&str] = &["gridtexture", "wireframe", "curvature", "volume", "rawconstant", "sunsky"];

/// Factor and shift of u and v before a picture is looked up.
#[derive(Clone, Copy, Debug)]
struct UvTransform {
    scale: [f32; 2],
    shift: [f32; 2],
}

impl<'e> Reader<'e> {
    /// A texture of numbers or spectra as a value; a constant if it is one.
    pub(super) fn texture(&mut self, texture: &'e Element, kind: TextureValue) -> Option<Value> {
        let key = (texture.number, kind == TextureValue::Float);
        if let Some(known) = self.textures.get(&key) {
            return known.clone();
        }
        let value = self.guarded(texture, |reader| reader.convert_texture(texture, kind));
        self.finish(texture);
        self.textures.insert(key, value.clone());
        value
    }

    fn convert_texture(&mut self, texture: &'e Element, kind: TextureValue) -> Option<Value> {
        let entity = match texture.plugin() {
            "bitmap" => self.bitmap(texture)?,
            "checkerboard" => self.checkerboard(texture, kind),
            "mesh_attribute" | "vertexcolors" => self.mesh_attribute(texture),
            "scale" => return self.scale_texture(texture, kind),
            "rgb" | "srgb" | "srgb_d65" | "uniform" | "d65" | "regular" | "irregular" | "blackbody" => {
                return self.constant(texture, kind);
            }
            _ => {
                self.unknown_plugin(texture, MISSING, KNOWN, "the constant 0.5 stands in for it");
                return Some(constant(0.5, kind));
            }
        };
        Some(self.define(Self::name_of(texture), kind, entity))
    }

    fn define(&mut self, name: String, kind: TextureValue, entity: Entity) -> Value {
        let world_from_texture = Transform::IDENTITY;
        self.document.textures.push(TextureEntity {
            name: name.clone(),
            value: kind,
            world_from_texture,
            entity,
        });
        Value::Texture(name)
    }

    /// A value times a number.
    pub(super) fn scaled_texture(
        &mut self,
        name: String,
        value: Value,
        scale: f32,
        plugin: &'e Element,
    ) -> Value {
        if scale == 1.0 {
            return value;
        }
        let scaled = entity("scale", plugin).with("tex", value).with("scale", Value::Floats(vec![scale]));
        self.define(name, TextureValue::Float, scaled)
    }

    fn bitmap(&mut self, texture: &'e Element) -> Option<Entity> {
        let mut map = entity("imagemap", texture);
        let Some((file, span)) = self.string(texture, "filename") else {
            self.diagnostics.error(texture.plugin_span(), "a `bitmap` needs a `filename`");
            return None;
        };
        let file = self.files.resolved(file);
        map.parameters.push(parameter("filename", Value::Strings(vec![file]), span));
        let gamma = self.float(texture, "gamma", -1.0);
        if self.boolean(texture, "raw", false) || gamma == 1.0 {
            map = map.with("encoding", Value::Strings(vec!["linear".to_owned()]));
        } else if gamma > 0.0 {
            map = map.with("encoding", Value::Strings(vec![format!("gamma {gamma}")]));
        }
        if let Some((filter, span)) = self.string(texture, "filter_type") {
            let ours = match filter {
                "nearest" => "point",
                "ewa" => "EWA",
                "trilinear" => "trilinear",
                _ => "bilinear",
            };
            map.parameters.push(parameter("filter", Value::Strings(vec![ours.to_owned()]), span));
        }
        for name in ["wrap_mode", "wrap_mode_u", "wrap_mode_v"] {
            let Some((wrap, span)) = self.string(texture, name) else { continue };
            let ours = match wrap {
                "clamp" => "clamp",
                "zero" => "black",
                "repeat" => "repeat",
                _ => {
                    let message =
                        format!("`{wrap}` is not available beyond the borders; `repeat` stands in for it");
                    self.diagnostics.warning(span, message);
                    "repeat"
                }
            };
            map.parameters.retain(|p| p.name != "wrap");
            map.parameters.push(parameter("wrap", Value::Strings(vec![ours.to_owned()]), span));
        }
        self.accept(texture, &["max_anisotropy", "cache", "channel", "format", "accel"]);
        let UvTransform { scale: [su, sv], shift: [tu, tv] } = self.uv_transform(texture);
        // Their row is sv (1 - v) + tv from the top, ours 1 minus that from the bottom.
        Some(with_mapping(map, [su, sv], [tu, 1.0 - sv - tv]))
    }

    /// One period of Mitsuba's board is two of our squares.
    fn checkerboard(&mut self, texture: &'e Element, kind: TextureValue) -> Entity {
        let mut board = entity("checkerboard", texture);
        for (theirs, ours, default) in [("color0", "tex1", 0.4), ("color1", "tex2", 0.2)] {
            let given = match kind {
                TextureValue::Float => self.number_opt(texture, theirs),
                TextureValue::Spectrum => self.color_opt(texture, theirs),
            };
            let (value, span) = given.unwrap_or((constant(default, kind), texture.span));
            board.parameters.push(parameter(ours, value, span));
        }
        let UvTransform { scale: [su, sv], shift: [tu, tv] } = self.uv_transform(texture);
        with_mapping(board, [2.0 * su, -2.0 * sv], [2.0 * tu, 2.0 * (sv + tv)])
    }

    fn mesh_attribute(&mut self, texture: &'e Element) -> Entity {
        let (name, span) = self.string(texture, "name").unwrap_or(("vertex_color", texture.span));
        let mut attribute = entity("meshattribute", texture);
        attribute.parameters.push(parameter("name", Value::Strings(vec![name.to_owned()]), span));
        let scale = self.float(texture, "scale", 1.0);
        attribute.with("scale", Value::Floats(vec![scale]))
    }

    fn scale_texture(&mut self, texture: &'e Element, kind: TextureValue) -> Option<Value> {
        let scale = self.float(texture, "scale", 1.0);
        let inner = self.nested(texture, "texture").first().copied();
        let Some(inner) = inner else {
            self.diagnostics.error(texture.plugin_span(), "a `scale` needs a texture inside");
            return None;
        };
        let value = self.texture(inner, kind)?;
        let scaled = entity("scale", texture).with("tex", value).with("scale", Value::Floats(vec![scale]));
        Some(self.define(Self::name_of(texture), kind, scaled))
    }

    /// A plugin that gives one spectrum.
    fn constant(&mut self, texture: &'e Element, kind: TextureValue) -> Option<Value> {
        let spectrum = self.constant_spectrum(texture)?;
        Some(match (spectrum, kind) {
            (ConstantSpectrum::Rgb(rgb), TextureValue::Float) => {
                Value::Floats(vec![etendue_image::luminance(rgb)])
            }
            (ConstantSpectrum::Rgb(rgb), TextureValue::Spectrum) => Value::Rgb(vec![rgb]),
            (ConstantSpectrum::Spectrum(SpectrumValue::Constant(x)), _) => constant(x, kind),
            (ConstantSpectrum::Spectrum(spectrum), TextureValue::Spectrum) => spectrum.into_value(),
            (ConstantSpectrum::Blackbody(kelvin, _), TextureValue::Spectrum) => {
                Value::Blackbody(vec![kelvin])
            }
            (_, TextureValue::Float) => {
                self.diagnostics.error(texture.plugin_span(), "this should be a number, not a spectrum");
                return None;
            }
        })
    }

    /// The spectrum of a plugin that gives one.
    pub(super) fn constant_spectrum(&mut self, texture: &'e Element) -> Option<ConstantSpectrum> {
        Some(match texture.plugin() {
            "rgb" | "srgb" | "srgb_d65" => {
                let property = self.property(texture, "color").or_else(|| self.property(texture, "value"))?;
                ConstantSpectrum::Rgb(values::color(property, &mut self.diagnostics)?)
            }
            "d65" => {
                let scale = self.float(texture, "scale", 1.0);
                let color = self.color_opt(texture, "color").map(|(value, _)| value);
                let rgb = match color {
                    Some(Value::Rgb(rgb)) => rgb[0],
                    _ => [1.0; 3],
                };
                ConstantSpectrum::Rgb(rgb.map(|c| c * scale))
            }
            "uniform" => {
                self.accept(texture, &["wavelength_min", "wavelength_max", "lambda_min", "lambda_max"]);
                ConstantSpectrum::Spectrum(SpectrumValue::Constant(self.float(texture, "value", 1.0)))
            }
            "regular" | "irregular" => ConstantSpectrum::Spectrum(self.tabulated_spectrum(texture)?),
            "blackbody" => {
                self.accept(texture, &["wavelength_min", "wavelength_max"]);
                let kelvin = self.float(texture, "temperature", 5000.0);
                ConstantSpectrum::Blackbody(kelvin, self.float(texture, "scale", 1.0))
            }
            _ => return None,
        })
    }

    fn list(&mut self, texture: &'e Element, name: &'static str) -> Vec<f32> {
        let attribute = self.property(texture, name).and_then(|property| property.attribute("value"));
        attribute.and_then(|value| values::numbers(value, &mut self.diagnostics)).unwrap_or_default()
    }

    fn tabulated_spectrum(&mut self, texture: &'e Element) -> Option<SpectrumValue> {
        if let Some((file, _)) = self.string(texture, "filename") {
            return Some(SpectrumValue::File(self.files.resolved(file)));
        }
        let values = self.list(texture, "values");
        let mut lambdas = self.list(texture, "wavelengths");
        if texture.plugin() == "regular" {
            let range = self.triple(texture, "range", [360.0, 830.0, 0.0]);
            let first = self.float(texture, "wavelength_min", range[0]);
            let last = self.float(texture, "wavelength_max", range[1]);
            let step = (last - first) / values.len().saturating_sub(1).max(1) as f32;
            lambdas = (0..values.len()).map(|i| first + step * i as f32).collect();
        }
        let ascends = lambdas.windows(2).all(|pair| pair[0] < pair[1]);
        if values.is_empty() || lambdas.len() != values.len() || !ascends {
            let message = "a spectrum needs ascending `wavelengths` and as many `values`";
            self.diagnostics.error(texture.plugin_span(), message);
            return None;
        }
        Some(SpectrumValue::Samples(lambdas.into_iter().zip(values).map(|(l, v)| [l, v]).collect()))
    }

    /// `to_uv`, or `uscale`, `vscale`, `uoffset` and `voffset` of version 0.6.
    fn uv_transform(&mut self, texture: &'e Element) -> UvTransform {
        let both = self.float(texture, "uvscale", 1.0);
        let scale = [self.float(texture, "uscale", both), self.float(texture, "vscale", both)];
        let shift = [self.float(texture, "uoffset", 0.0), self.float(texture, "voffset", 0.0)];
        let Some(property) = self.property(texture, "to_uv") else { return UvTransform { scale, shift } };
        let transform = values::transform(property, &mut self.diagnostics);
        let m = transform.rows();
        if m[0][1] != 0.0 || m[1][0] != 0.0 {
            let message = "textures are not turned here; what `to_uv` turns is ignored";
            self.diagnostics.warning(property.span, message);
        }
        UvTransform { scale: [m[0][0], m[1][1]], shift: [m[0][3], m[1][3]] }
    }
}

/// What a plugin of one spectrum gives.
#[derive(Clone, Debug)]
pub(super) enum ConstantSpectrum {
    Rgb([f32; 3]),
    Spectrum(SpectrumValue),
    /// Temperature in kelvin and factor.
    Blackbody(f32, f32),
}

/// A constant of that kind.
fn constant(value: f32, kind: TextureValue) -> Value {
    match kind {
        TextureValue::Float => Value::Floats(vec![value]),
        TextureValue::Spectrum => Value::Rgb(vec![[value; 3]]),
    }
}

/// With the parameters of the mapping that are not the default.
fn with_mapping(mut entity: Entity, scale: [f32; 2], shift: [f32; 2]) -> Entity {
    let values = [
        ("uscale", scale[0], 1.0),
        ("vscale", scale[1], 1.0),
        ("udelta", shift[0], 0.0),
        ("vdelta", shift[1], 0.0),
    ];
    for (name, value, default) in values {
        if value != default {
            entity = entity.with(name, Value::Floats(vec![value]));
        }
    }
    entity
}
