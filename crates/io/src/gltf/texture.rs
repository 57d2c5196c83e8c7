//! Textures of materials as `imagemap` textures of the document.

use std::sync::Arc;

use etendue_math::Transform;
use etendue_scene::document::{EmbeddedFile, Entity, TextureEntity, TextureValue, Value};

use super::Reader;
use super::container::{data_uri, file_of_uri};
use crate::json::Json;

/// What of a picture is wanted, and what becomes of it.
#[derive(Clone, Copy, Debug)]
pub(super) enum Use {
    /// Colours in sRGB times factors.
    Color([f32; 3]),
    /// Vectors.
    Vectors,
    /// A channel of linear numbers, times a factor.
    Channel(&'static str, f32),
    /// The same, as 1 minus the value.
    Inverted(&'static str, f32),
    /// The same, cut to 0 below and 1 from the second number on.
    Cut(&'static str, f32, f32),
}

/// Where a texture lies on the surface: `KHR_texture_transform`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Placement {
    offset: [f32; 2],
    rotation_rad: f32,
    scale: [f32; 2],
}

impl Placement {
    const NONE: Self = Self { offset: [0.0; 2], rotation_rad: 0.0, scale: [1.0; 2] };

    /// Parameters of the mapping `uv`.
    ///
    /// With v running down, as in glTF, `u' = c s_u u + s s_v v + o_u` and `v' = -s s_u u + c s_v v + o_v`, where c and s
    /// are cosine and sine of the rotation. Here v runs up: `v = 1 - w`.
    fn parameters(&self, entity: Entity) -> Entity {
        if *self == Self::NONE {
            return entity;
        }
        let (sin, cos) = self.rotation_rad.sin_cos();
        let ([su, sv], [du, dv]) = (self.scale, self.offset);
        let float = |value: f32| Value::Floats(vec![value]);
        entity
            .with("uscale", float(su))
            .with("vscale", float(sv))
            .with("uvrotation", float(self.rotation_rad.to_degrees()))
            .with("udelta", float(du + sin * sv))
            .with("vdelta", float(1.0 - dv - cos * sv))
    }
}

impl<'a> Reader<'a> {
    /// The set of texture coordinates that a texture info asks for.
    pub(super) fn texcoord(&self, info: &Json) -> usize {
        let transform = self.file.extension(info, "KHR_texture_transform");
        let set = transform.and_then(|transform| self.file.size_opt(transform, "texCoord"));
        set.unwrap_or_else(|| self.file.size(info, "texCoord", 0))
    }

    pub(super) fn placement(&self, info: &Json) -> Placement {
        let Some(transform) = self.file.extension(info, "KHR_texture_transform") else {
            return Placement::NONE;
        };
        Placement {
            offset: self.file.floats(transform, "offset").unwrap_or([0.0; 2]),
            rotation_rad: self.file.float(transform, "rotation", 0.0),
            scale: self.file.floats(transform, "scale").unwrap_or([1.0; 2]),
        }
    }

    /// True if the texture lies elsewhere than its coordinates say.
    pub(super) fn is_placed(&self, info: &Json) -> bool {
        self.placement(info) != Placement::NONE
    }

    /// The name of the picture's file that a texture info leads to.
    pub(super) fn picture(&mut self, info: &'a Json) -> Option<String> {
        self.file.required(info, "index")?;
        let (_, texture) = self.file.reference(info, "index", "textures")?;
        let (index, image) = match self.file.reference(texture, "source", "images") {
            Some(found) => found,
            None => {
                let other =
                    ["KHR_texture_basisu", "EXT_texture_webp", "EXT_texture_avif", "MSFT_texture_dds"];
                let name = other.into_iter().find(|name| self.file.extension(texture, name).is_some());
                let why = name.unwrap_or("no \"source\"");
                self.file.warning(texture, format!("the texture has no picture that can be read ({why})"));
                return None;
            }
        };
        if let Some(known) = &self.pictures[index] {
            return known.clone();
        }
        let name = self.read_picture(index, image);
        self.pictures[index] = Some(name.clone());
        name
    }

    fn read_picture(&mut self, index: usize, image: &'a Json) -> Option<String> {
        let part = format!("images/{index}");
        let bytes: Arc<[u8]> = match self.file.string(image, "uri") {
            Some(uri) => match data_uri(uri) {
                Some(content) => content.map_err(|why| self.file.error(image, why)).ok()?.into(),
                None => return file_of_uri(uri).map_err(|why| self.file.error(image, why)).ok(),
            },
            None => {
                self.file.required(image, "bufferView")?;
                let bytes = self.buffers.view(&self.file, image, "bufferView")?.bytes;
                // Many pictures may claim the same bytes.
                self.charge(image, bytes.len())?;
                bytes.into()
            }
        };
        Some(self.document.embed(&part, EmbeddedFile::Bytes(bytes)))
    }

    /// Adds a texture of that name to the document; `None` if there is no picture, which is reported.
    pub(super) fn texture(&mut self, name: String, info: &'a Json, how: Use) -> Option<String> {
        let picture = self.picture(info)?;
        let float = |value: f32| Value::Floats(vec![value]);
        let text = |value: &str| Value::Strings(vec![value.to_owned()]);
        let mut entity = Entity::new("imagemap").with("filename", text(&picture));
        if let Some((_, texture)) = self.file.reference(info, "index", "textures") {
            entity = self.sampler(texture, entity);
        }
        entity = self.placement(info).parameters(entity);
        let (value, encoding) = match how {
            Use::Color(_) => (TextureValue::Spectrum, "sRGB"),
            Use::Vectors => (TextureValue::Spectrum, "linear"),
            _ => (TextureValue::Float, "linear"),
        };
        entity = entity.with("encoding", text(encoding));
        entity = match how {
            Use::Color([1.0, 1.0, 1.0]) | Use::Vectors => entity,
            Use::Color(factor) => entity.with("tint", Value::Rgb(vec![factor])),
            Use::Channel(channel, scale) => entity.with("channel", text(channel)).with("scale", float(scale)),
            Use::Inverted(channel, scale) => {
                let entity = entity.with("channel", text(channel)).with("scale", float(scale));
                entity.with("invert", Value::Bools(vec![true]))
            }
            Use::Cut(channel, scale, cutoff) => {
                let entity = entity.with("channel", text(channel)).with("scale", float(scale));
                entity.with("cutoff", float(cutoff))
            }
        };
        let entity = super::located(entity, info);
        self.document.textures.push(TextureEntity {
            name: name.clone(),
            value,
            world_from_texture: Transform::IDENTITY,
            entity,
        });
        Some(name)
    }

    /// Filter and borders.
    fn sampler(&self, texture: &'a Json, entity: Entity) -> Entity {
        const NEAREST: usize = 9728;
        let Some((_, sampler)) = self.file.reference(texture, "sampler", "samplers") else { return entity };
        let wrap = |name: &str| match self.file.size(sampler, name, 10497) {
            33071 => "clamp",
            33648 => "mirror",
            10497 => "repeat",
            other => {
                self.file.warning(sampler, format!("\"{name}\" cannot be {other}; the picture repeats"));
                "repeat"
            }
        };
        let text = |value: &str| Value::Strings(vec![value.to_owned()]);
        let (s, t) = (wrap("wrapS"), wrap("wrapT"));
        let mut entity = entity;
        if (s, t) != ("repeat", "repeat") {
            entity = entity.with("wrap", text(s)).with("wrapv", text(t));
        }
        if self.file.size(sampler, "magFilter", 0) == NEAREST {
            entity = entity.with("filter", text("point"));
        }
        entity
    }
}
