//! Prints a document in pbrt's format, so that reading it again gives the same document.
//!
//! The text is flat: each shape, light and texture stands in its own attribute block with the transform and the
//! attributes it needs. Materials without a name get one (`material 3`), since pbrt has no other way to return to an
//! earlier material. Numbers are the shortest decimals that read back to the same value. Not written are spans, the
//! folder of the document, and motion at more than one pair of times, which pbrt cannot express.

use std::fmt::Write;

use etendue_math::{AnimatedTransform, Transform};
use etendue_scene::Document;
use etendue_scene::document::{Entity, MaterialReference, Parameter, ShapeEntity, TextureValue, Value};
use etendue_spectrum::ColorSpaceName;

/// Columns after which lists of values continue on the next line.
const LINE_LENGTH: usize = 110;

/// The document as the text of a pbrt file.
#[must_use]
pub fn write_pbrt(document: &Document) -> String {
    let mut writer = Writer {
        document,
        out: String::new(),
        indent: 0,
        color_space: ColorSpaceName::Srgb,
        material_names: material_names(document),
    };
    writer.options();
    writer.line("WorldBegin");
    writer.definitions();
    writer.lights();
    writer.objects();
    writer.out
}

/// A name for each material, its own if it has one; `None` for the default material of pbrt.
fn material_names(document: &Document) -> Vec<Option<String>> {
    let taken = |name: &str| document.materials.iter().any(|m| m.name.as_deref() == Some(name));
    let name_of = |(index, material): (usize, &etendue_scene::document::MaterialEntity)| {
        if material.name.is_some() {
            return material.name.clone();
        }
        let is_default = material.entity.type_name == "diffuse" && material.entity.parameters.is_empty();
        if index == 0 && is_default {
            return None;
        }
        let mut name = format!("material {index}");
        while taken(&name) {
            name.push('\'');
        }
        Some(name)
    };
    document.materials.iter().enumerate().map(name_of).collect()
}

struct Writer<'a> {
    document: &'a Document,
    out: String,
    indent: usize,
    color_space: ColorSpaceName,
    material_names: Vec<Option<String>>,
}

/// Directives before `WorldBegin`, then definitions, lights, shapes.
impl Writer<'_> {
    fn options(&mut self) {
        let document = self.document;
        for option in &document.options {
            let mut line = format!("Option {} ", quoted(&option.name));
            let mut values = values(&option.value);
            line.push_str(&values.next().unwrap_or_default());
            self.line(&line);
        }
        if let Some(film) = &document.film {
            self.set_color_space(document.film_color_space);
            self.entity("Film", &film.type_name, film);
        }
        let entities = [
            ("Sampler", &document.sampler),
            ("PixelFilter", &document.filter),
            ("Integrator", &document.integrator),
            ("Accelerator", &document.accelerator),
        ];
        for (directive, entity) in entities {
            if let Some(entity) = entity {
                self.set_color_space_of(entity);
                self.entity(directive, &entity.type_name, entity);
            }
        }
        if let Some(camera) = &document.camera {
            self.transform_times(&camera.world_from_camera);
            if !camera.medium.is_empty() {
                self.line(&format!("MediumInterface \"\" {}", quoted(&camera.medium)));
            }
            let moving = camera.world_from_camera;
            self.transform(&AnimatedTransform {
                start: moving.start.inverse(),
                end: moving.end.inverse(),
                ..moving
            });
            self.set_color_space_of(&camera.entity);
            self.entity("Camera", &camera.entity.type_name, &camera.entity);
        }
        if let Some(moving) = self.first_motion() {
            self.transform_times(&moving);
        }
        self.set_color_space(ColorSpaceName::Srgb);
    }

    /// The first transform of the world that moves.
    fn first_motion(&self) -> Option<AnimatedTransform> {
        let document = self.document;
        let shapes = document.objects.iter().flat_map(|object| &object.shapes).chain(&document.shapes);
        (shapes.map(|shape| shape.world_from_object))
            .chain(document.lights.iter().map(|light| light.world_from_light))
            .chain(document.media.iter().map(|medium| medium.world_from_medium))
            .chain(document.instances.iter().map(|instance| instance.world_from_instance))
            .find(AnimatedTransform::is_animated)
    }

    fn transform_times(&mut self, transform: &AnimatedTransform) {
        if transform.is_animated() {
            let (start, end) = (number(transform.start_time), number(transform.end_time));
            self.line(&format!("TransformTimes {start} {end}"));
        }
    }

    fn definitions(&mut self) {
        let document = self.document;
        for medium in &document.media {
            self.block("medium", &medium.entity, |writer, own| {
                writer.transform(&medium.world_from_medium);
                writer.typed("MakeNamedMedium", &medium.name, &medium.entity, own);
            });
        }
        for texture in &document.textures {
            self.block("texture", &texture.entity, |writer, own| {
                writer.transform(&AnimatedTransform::constant(texture.world_from_texture));
                let kind = match texture.value {
                    TextureValue::Float => "float",
                    TextureValue::Spectrum => "spectrum",
                };
                writer.line(&format!(
                    "Texture {} \"{kind}\" {}",
                    quoted(&texture.name),
                    quoted(&texture.entity.type_name)
                ));
                writer.parameters(own);
            });
        }
        let names = self.material_names.clone();
        for (material, name) in document.materials.iter().zip(&names) {
            let Some(name) = name else { continue };
            self.block("material", &material.entity, |writer, own| {
                writer.typed("MakeNamedMaterial", name, &material.entity, own);
            });
        }
    }

    fn lights(&mut self) {
        let document = self.document;
        let camera_medium = document.camera.as_ref().map_or("", |camera| camera.medium.as_str());
        for light in &document.lights {
            self.block("light", &light.entity, |writer, own| {
                writer.transform(&light.world_from_light);
                if light.outside_medium != camera_medium {
                    writer.line(&format!("MediumInterface \"\" {}", quoted(&light.outside_medium)));
                }
                writer.line(&format!("LightSource {}", quoted(&light.entity.type_name)));
                writer.parameters(own);
            });
        }
    }

    fn objects(&mut self) {
        let document = self.document;
        for object in &document.objects {
            self.line(&format!("ObjectBegin {}", quoted(&object.name)));
            self.indent += 1;
            for shape in &object.shapes {
                self.shape(shape);
            }
            self.indent -= 1;
            self.line("ObjectEnd");
        }
        for shape in &document.shapes {
            self.shape(shape);
        }
        for instance in &document.instances {
            self.line("AttributeBegin");
            self.indent += 1;
            self.transform(&instance.world_from_instance);
            self.line(&format!("ObjectInstance {}", quoted(&instance.object)));
            self.indent -= 1;
            self.line("AttributeEnd");
        }
    }

    fn shape(&mut self, shape: &ShapeEntity) {
        let document = self.document;
        self.block("shape", &shape.entity, |writer, own| {
            writer.transform(&shape.world_from_object);
            if shape.reverse_orientation {
                writer.line("ReverseOrientation");
            }
            let material = match &shape.material {
                MaterialReference::Name(name, _) => Some(name.clone()),
                MaterialReference::Index(index) => writer.material_names.get(*index).cloned().flatten(),
            };
            if let Some(name) = material {
                writer.line(&format!("NamedMaterial {}", quoted(&name)));
            }
            if shape.has_medium_interface {
                let (inside, outside) = (quoted(&shape.inside_medium), quoted(&shape.outside_medium));
                writer.line(&format!("MediumInterface {inside} {outside}"));
            }
            if let Some(light) = shape.area_light.and_then(|index| document.area_lights.get(index)) {
                let own = writer.defaults("light", light);
                writer.line(&format!("AreaLightSource {}", quoted(&light.type_name)));
                writer.parameters(own);
            }
            writer.set_color_space_of(&shape.entity);
            writer.line(&format!("Shape {}", quoted(&shape.entity.type_name)));
            writer.parameters(own);
        });
    }
}

/// Pieces of statements.
impl Writer<'_> {
    fn line(&mut self, text: &str) {
        self.out.extend(std::iter::repeat_n("    ", self.indent));
        self.out.push_str(text);
        self.out.push('\n');
    }

    /// An attribute block around an entity; `content` gets the parameters that the entity gives itself.
    fn block<'e>(
        &mut self,
        target: &str,
        entity: &'e Entity,
        content: impl FnOnce(&mut Self, &'e [Parameter]),
    ) {
        let outside = self.color_space;
        self.line("AttributeBegin");
        self.indent += 1;
        let own = self.defaults(target, entity);
        content(self, own);
        self.indent -= 1;
        self.line("AttributeEnd");
        self.color_space = outside;
    }

    /// Writes those parameters that differ in colour space from the first as defaults, and sets the colour space of
    /// the others, which it returns.
    fn defaults<'e>(&mut self, target: &str, entity: &'e Entity) -> &'e [Parameter] {
        let parameters = entity.parameters.as_slice();
        let Some(first) = parameters.first() else { return parameters };
        let n_own =
            parameters.iter().position(|p| p.color_space != first.color_space).unwrap_or(parameters.len());
        let (own, rest) = parameters.split_at(n_own);
        for group in rest.chunk_by(|a, b| a.color_space == b.color_space) {
            self.set_color_space(group[0].color_space);
            self.line(&format!("Attribute \"{target}\""));
            self.parameters(group);
        }
        self.set_color_space(first.color_space);
        own
    }

    fn set_color_space_of(&mut self, entity: &Entity) {
        if let Some(first) = entity.parameters.first() {
            self.set_color_space(first.color_space);
        }
    }

    fn set_color_space(&mut self, color_space: ColorSpaceName) {
        if self.color_space != color_space {
            self.color_space = color_space;
            self.line(&format!("ColorSpace \"{}\"", color_space.name()));
        }
    }

    fn transform(&mut self, transform: &AnimatedTransform) {
        if !transform.is_animated() {
            if !transform.start.is_identity() {
                self.line(&matrix(&transform.start));
            }
            return;
        }
        self.line("ActiveTransform StartTime");
        self.line(&matrix(&transform.start));
        self.line("ActiveTransform EndTime");
        self.line(&matrix(&transform.end));
        self.line("ActiveTransform All");
    }

    fn entity(&mut self, directive: &str, name: &str, entity: &Entity) {
        self.line(&format!("{directive} {}", quoted(name)));
        self.parameters(&entity.parameters);
    }

    /// A named entity whose type is a parameter.
    fn typed(&mut self, directive: &str, name: &str, entity: &Entity, own: &[Parameter]) {
        self.line(&format!("{directive} {}", quoted(name)));
        self.indent += 1;
        self.line(&format!("\"string type\" {}", quoted(&entity.type_name)));
        self.indent -= 1;
        self.indent += 1;
        // An unnamed material may have a stray parameter of that name, which means nothing.
        for parameter in own.iter().filter(|parameter| parameter.name != "type") {
            self.parameter(parameter);
        }
        self.indent -= 1;
    }

    fn parameters(&mut self, parameters: &[Parameter]) {
        self.indent += 1;
        for parameter in parameters {
            self.parameter(parameter);
        }
        self.indent -= 1;
    }

    fn parameter(&mut self, parameter: &Parameter) {
        let type_name = match &parameter.value {
            Value::Normals3(_) => "normal",
            other => other.type_name(),
        };
        self.out.extend(std::iter::repeat_n("    ", self.indent));
        let mut line_start = self.out.len();
        let declaration = quoted(&format!("{type_name} {}", parameter.name));
        let _ = write!(self.out, "{declaration} [");
        for value in values(&parameter.value) {
            if self.out.len() - line_start + value.len() > LINE_LENGTH {
                self.out.push('\n');
                line_start = self.out.len();
                self.out.extend(std::iter::repeat_n("    ", self.indent + 1));
            } else {
                self.out.push(' ');
            }
            self.out.push_str(&value);
        }
        self.out.push_str(" ]\n");
    }
}

/// The values as a scene file has them, without brackets.
#[must_use]
pub fn value_text(value: &Value) -> String {
    values(value).collect::<Vec<_>>().join(" ")
}

/// The values as words.
fn values(value: &Value) -> Box<dyn Iterator<Item = String> + '_> {
    match value {
        Value::Integers(v) => Box::new(v.iter().map(i32::to_string)),
        Value::Floats(v) | Value::Blackbody(v) => Box::new(v.iter().copied().map(number)),
        Value::Points2(v) => Box::new(v.iter().flat_map(|p| [p.x, p.y]).map(number)),
        Value::Vectors2(v) => Box::new(v.iter().flat_map(|p| [p.x, p.y]).map(number)),
        Value::Points3(v) => Box::new(v.iter().flat_map(|p| [p.x, p.y, p.z]).map(number)),
        Value::Vectors3(v) => Box::new(v.iter().flat_map(|p| [p.x, p.y, p.z]).map(number)),
        Value::Normals3(v) => Box::new(v.iter().flat_map(|p| [p.x, p.y, p.z]).map(number)),
        Value::Bools(v) => Box::new(v.iter().map(bool::to_string)),
        Value::Strings(v) | Value::SpectrumNames(v) => Box::new(v.iter().map(|s| quoted(s))),
        Value::Rgb(v) => Box::new(v.iter().flatten().copied().map(number)),
        Value::SpectrumSamples(v) => Box::new(v.iter().flatten().copied().map(number)),
        Value::Texture(name) => Box::new(std::iter::once(quoted(name))),
    }
}

/// The shortest decimal that reads back to the same number.
fn number(value: f32) -> String {
    if value.fract() == 0.0 && value.abs() < 1e9 { format!("{value}") } else { format!("{value:?}") }
}

/// In quotes, with escapes.
fn quoted(text: &str) -> String {
    let mut out = String::with_capacity(text.len() + 2);
    out.push('"');
    for c in text.chars() {
        match c {
            '"' => out.push_str("\\\""),
            '\\' => out.push_str("\\\\"),
            '\n' => out.push_str("\\n"),
            '\r' => out.push_str("\\r"),
            '\t' => out.push_str("\\t"),
            '\u{8}' => out.push_str("\\b"),
            '\u{c}' => out.push_str("\\f"),
            c => out.push(c),
        }
    }
    out.push('"');
    out
}

/// `Transform` with the columns of the matrix one after another.
fn matrix(transform: &Transform) -> String {
    let rows = transform.rows();
    let mut line = "Transform [".to_owned();
    for column in 0..4 {
        for row in rows {
            let _ = write!(line, " {}", number(row[column]));
        }
    }
    line + " ]"
}
