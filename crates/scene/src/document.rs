//! The untyped description of a scene: entities with a type name, parameters and their place in the source.
//!
//! Every reader of scene files makes a [`Document`], as do tests and generators. It says what was written, with
//! transforms and attributes resolved; what the names mean is decided when the scene is built.

use std::collections::BTreeMap;
use std::path::PathBuf;
use std::sync::Arc;

use etendue_image::Texels;
use etendue_math::{AnimatedTransform, Normal3, Point2, Point3, Transform, Vector2, Vector3};
use etendue_spectrum::ColorSpaceName;

use crate::assets::LoadedMesh;
use crate::diagnostics::{Sources, Span};

/// The value of a parameter, by its declared type.
#[derive(Clone, Debug, PartialEq)]
#[allow(missing_docs, reason = "each variant is the declared type of that name")]
pub enum Value {
    Integers(Vec<i32>),
    Floats(Vec<f32>),
    Points2(Vec<Point2>),
    Vectors2(Vec<Vector2>),
    Points3(Vec<Point3>),
    Vectors3(Vec<Vector3>),
    Normals3(Vec<Normal3>),
    Bools(Vec<bool>),
    Strings(Vec<String>),
    /// Colours in the colour space that was current at the parameter.
    Rgb(Vec<[f32; 3]>),
    /// Temperatures in kelvin.
    Blackbody(Vec<f32>),
    /// Names of built-in spectra, or files in the asset list.
    SpectrumNames(Vec<String>),
    /// Wavelengths in nanometres with their values, ascending.
    SpectrumSamples(Vec<[f32; 2]>),
    /// Name of a texture.
    Texture(String),
}

impl Value {
    /// The declared type as pbrt spells it.
    #[must_use]
    pub const fn type_name(&self) -> &'static str {
        match self {
            Self::Integers(_) => "integer",
            Self::Floats(_) => "float",
            Self::Points2(_) => "point2",
            Self::Vectors2(_) => "vector2",
            Self::Points3(_) => "point3",
            Self::Vectors3(_) => "vector3",
            Self::Normals3(_) => "normal3",
            Self::Bools(_) => "bool",
            Self::Strings(_) => "string",
            Self::Rgb(_) => "rgb",
            Self::Blackbody(_) => "blackbody",
            Self::SpectrumNames(_) | Self::SpectrumSamples(_) => "spectrum",
            Self::Texture(_) => "texture",
        }
    }
}

/// A named value.
#[derive(Clone, Debug)]
pub struct Parameter {
    /// Name as written.
    pub name: String,
    /// Value with its type.
    pub value: Value,
    /// Place of the declaration `"type name"`; `None` for parameters that no file wrote.
    pub span: Option<Span>,
    /// Colour space of `rgb` values.
    pub color_space: ColorSpaceName,
    /// True for a default that `Attribute` gave to all entities of a kind: those that do not know it say nothing.
    pub may_be_unused: bool,
}

impl Parameter {
    /// A parameter that no file wrote, in sRGB.
    #[must_use]
    pub fn new(name: impl Into<String>, value: Value) -> Self {
        Self { name: name.into(), value, span: None, color_space: ColorSpaceName::Srgb, may_be_unused: false }
    }
}

/// A thing of some type with parameters: `Shape "sphere" "float radius" 1`.
#[derive(Clone, Debug, Default)]
pub struct Entity {
    /// `sphere`.
    pub type_name: String,
    /// Place of the type name.
    pub span: Option<Span>,
    /// In the order written.
    pub parameters: Vec<Parameter>,
    /// True if the reader has reported parameters as wrong and left them out.
    pub is_incomplete: bool,
}

impl Entity {
    /// An entity that no file wrote.
    #[must_use]
    pub fn new(type_name: impl Into<String>) -> Self {
        Self { type_name: type_name.into(), span: None, parameters: Vec::new(), is_incomplete: false }
    }

    /// With one more parameter.
    #[must_use]
    pub fn with(mut self, name: &str, value: Value) -> Self {
        self.parameters.push(Parameter::new(name, value));
        self
    }
}

/// How a shape names its material.
#[derive(Clone, Debug, PartialEq)]
pub enum MaterialReference {
    /// Index into [`Document::materials`].
    Index(usize),
    /// Name of a named material, with the place of the name.
    Name(String, Option<Span>),
}

/// A material definition.
#[derive(Clone, Debug)]
pub struct MaterialEntity {
    /// Name, if made by `MakeNamedMaterial`.
    pub name: Option<String>,
    /// Type and parameters; for named materials the type comes from the parameter `type`, which is removed.
    pub entity: Entity,
}

/// What kind of values a texture yields.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum TextureValue {
    /// A number.
    Float,
    /// A spectrum.
    Spectrum,
}

/// A texture definition.
#[derive(Clone, Debug)]
pub struct TextureEntity {
    /// Name.
    pub name: String,
    /// Number or spectrum.
    pub value: TextureValue,
    /// Transform at the definition.
    pub world_from_texture: Transform,
    /// Type and parameters.
    pub entity: Entity,
}

/// A participating medium.
#[derive(Clone, Debug)]
pub struct MediumEntity {
    /// Name.
    pub name: String,
    /// Transform at the definition.
    pub world_from_medium: AnimatedTransform,
    /// Type and parameters.
    pub entity: Entity,
}

/// A light that is not a shape.
#[derive(Clone, Debug)]
pub struct LightEntity {
    /// Type and parameters.
    pub entity: Entity,
    /// Transform at the definition.
    pub world_from_light: AnimatedTransform,
    /// Name of the medium around it; empty for none.
    pub outside_medium: String,
}

/// A shape with its attributes.
#[derive(Clone, Debug)]
pub struct ShapeEntity {
    /// Type and parameters.
    pub entity: Entity,
    /// Transform at the shape.
    pub world_from_object: AnimatedTransform,
    /// Exchange inside and outside.
    pub reverse_orientation: bool,
    /// Material.
    pub material: MaterialReference,
    /// Index into [`Document::area_lights`].
    pub area_light: Option<usize>,
    /// Name of the medium inside; empty for none.
    pub inside_medium: String,
    /// Name of the medium outside; empty for none.
    pub outside_medium: String,
    /// True if `MediumInterface` was given for this shape.
    pub has_medium_interface: bool,
}

/// Shapes that instances repeat.
#[derive(Clone, Debug)]
pub struct ObjectEntity {
    /// Name.
    pub name: String,
    /// Place of the definition.
    pub span: Option<Span>,
    /// Shapes, in the space of the definition.
    pub shapes: Vec<ShapeEntity>,
}

/// One use of an object.
#[derive(Clone, Debug)]
pub struct InstanceEntity {
    /// Name of the object.
    pub object: String,
    /// Place of the use.
    pub span: Option<Span>,
    /// From the space of the definition (`world_from_object` of its shapes) to the world.
    pub world_from_instance: AnimatedTransform,
}

/// The camera with its transform.
#[derive(Clone, Debug)]
pub struct CameraEntity {
    /// Type and parameters.
    pub entity: Entity,
    /// From camera space (+z ahead, +y up) to the world.
    pub world_from_camera: AnimatedTransform,
    /// Name of the medium around the camera; empty for none.
    pub medium: String,
}

/// A file that a document brings along.
#[derive(Clone, Debug)]
pub enum EmbeddedFile {
    /// The content of a file of any kind, encoded as on disk.
    Bytes(Arc<[u8]>),
    /// A mesh that the reader of the scene has made.
    Mesh(Arc<LoadedMesh>),
    /// A picture that the reader of the scene has made.
    Image(Arc<Texels>),
}

/// A whole scene as written.
#[derive(Clone, Debug)]
pub struct Document {
    /// The files it was read from.
    pub sources: Sources,
    /// Folder that file names in parameters are relative to.
    pub base_directory: PathBuf,
    /// Files that need not be opened, by the name that parameters give them: see [`Document::embed`].
    pub embedded: BTreeMap<String, EmbeddedFile>,
    /// Parameters of `Option` directives.
    pub options: Vec<Parameter>,
    /// The camera; `None` means pbrt's default.
    pub camera: Option<CameraEntity>,
    /// The film.
    pub film: Option<Entity>,
    /// Colour space that was current at `Film`: that of the output.
    pub film_color_space: ColorSpaceName,
    /// The sampler.
    pub sampler: Option<Entity>,
    /// The pixel filter.
    pub filter: Option<Entity>,
    /// The integrator.
    pub integrator: Option<Entity>,
    /// The acceleration structure.
    pub accelerator: Option<Entity>,
    /// Materials; index 0 always exists and is the default diffuse one.
    pub materials: Vec<MaterialEntity>,
    /// Textures in the order defined.
    pub textures: Vec<TextureEntity>,
    /// Media.
    pub media: Vec<MediumEntity>,
    /// Lights that are not shapes.
    pub lights: Vec<LightEntity>,
    /// Area lights that shapes refer to by index.
    pub area_lights: Vec<Entity>,
    /// Shapes outside of object definitions.
    pub shapes: Vec<ShapeEntity>,
    /// Object definitions.
    pub objects: Vec<ObjectEntity>,
    /// Uses of objects.
    pub instances: Vec<InstanceEntity>,
}

impl Default for Document {
    fn default() -> Self {
        Self {
            sources: Sources::default(),
            base_directory: PathBuf::new(),
            embedded: BTreeMap::new(),
            options: Vec::new(),
            camera: None,
            film: None,
            film_color_space: ColorSpaceName::Srgb,
            sampler: None,
            filter: None,
            integrator: None,
            accelerator: None,
            materials: vec![MaterialEntity { name: None, entity: Entity::new("diffuse") }],
            textures: Vec::new(),
            media: Vec::new(),
            lights: Vec::new(),
            area_lights: Vec::new(),
            shapes: Vec::new(),
            objects: Vec::new(),
            instances: Vec::new(),
        }
    }
}

impl Document {
    /// Brings a file along and returns the name for parameters such as `filename`: `SCENE/part`, where `SCENE` is the
    /// file name of the scene. Nothing on disk has such a name, since a file is no folder. A part that is there already
    /// keeps its content.
    pub fn embed(&mut self, part: &str, file: EmbeddedFile) -> String {
        let scene = self.sources.files().first().map_or("scene", |main| main.name.as_str());
        let scene = scene.rsplit(['/', '\\']).next().unwrap_or(scene);
        let name = format!("{scene}/{part}");
        self.embedded.entry(name.clone()).or_insert(file);
        name
    }
}
