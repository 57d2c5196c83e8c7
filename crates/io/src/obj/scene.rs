//! From an OBJ file and its libraries to a document: a shape for each material.

use std::collections::HashMap;
use std::path::Path;

use etendue_math::{AnimatedTransform, Bounds3, Transform};
use etendue_scene::diagnostics::FileId;
use etendue_scene::document::{
    EmbeddedFile, Entity, MaterialEntity, MaterialReference, Parameter, ShapeEntity, Value,
};
use etendue_scene::{Diagnostics, Document, Span};

use super::materials::{Converted, Converter};
use super::mesh::meshes_by_material;
use super::mtl;
use super::parse::{Name, parse};
use crate::file::{read_file, read_given_file};
use crate::mesh::smooth_but_creases;
use crate::stage::{CREASE_DEGREES, Ground, Up, set_stage};

/// Libraries that a file may name.
const MAX_LIBRARIES: usize = 1000;

/// Reads an OBJ file with its materials as a scene: camera, light and ground are those of [`crate::stage`].
///
/// The document is as complete as the errors in the diagnostics allow.
#[must_use]
pub fn read_obj(path: &Path) -> (Document, Diagnostics) {
    let base_directory = path.parent().map(Path::to_owned).unwrap_or_default();
    match read_given_file(path) {
        Ok(bytes) => read_obj_bytes(&path.display().to_string(), bytes, &base_directory),
        Err(error) => {
            let mut diagnostics = Diagnostics::default();
            diagnostics.error(None, error.to_string());
            (Document { base_directory, ..Document::default() }, diagnostics)
        }
    }
}

/// The same for bytes; `name` stands for the file in messages, and names of files are relative to `base_directory`.
#[must_use]
pub fn read_obj_bytes(name: &str, bytes: Vec<u8>, base_directory: &Path) -> (Document, Diagnostics) {
    let mut document = Document { base_directory: base_directory.to_owned(), ..Document::default() };
    let mut diagnostics = Diagnostics::default();
    let file = document.sources.add(name, "");
    // Names in other encodings do no harm.
    let text = String::from_utf8(bytes)
        .unwrap_or_else(|error| String::from_utf8_lossy(error.as_bytes()).into_owned());
    let obj = parse(&text, file, &mut diagnostics);
    document.sources.fill(file, text);
    let meshes = meshes_by_material(&obj);
    let extent = Bounds3::from_points(obj.positions.iter().copied()).diagonal().max_element();
    let materials = read_libraries(&obj.libraries, extent, &mut document, &mut diagnostics);
    for (index, (name, mut mesh)) in obj.materials.iter().zip(meshes).enumerate() {
        if mesh.triangles.is_empty() {
            continue;
        }
        let known = materials.get(&name.text);
        if known.is_none() && index > 0 && !obj.libraries.is_empty() {
            let message = format!("no library has the material `{}`; it is grey", name.text);
            diagnostics.warning(name.span, message);
        }
        let material = match known {
            Some(_) => MaterialReference::Name(name.text.clone(), Some(name.span)),
            None => grey(&mut document),
        };
        let part = if name.text.is_empty() { "mesh".to_owned() } else { format!("mesh of {}", name.text) };
        if mesh.normals.is_empty() && !obj.has_smoothing {
            smooth_but_creases(&mut mesh, CREASE_DEGREES);
        }
        let file = document.embed(&part, EmbeddedFile::Mesh(mesh.into()));
        add_shape(&mut document, file, name.span, material, known);
    }
    if !diagnostics.has_errors() {
        set_stage(&mut document, Up::Guessed, Ground::Disk, &mut diagnostics);
    }
    (document, diagnostics)
}

/// The material of faces without any.
fn grey(document: &mut Document) -> MaterialReference {
    let entity = bare_material();
    let known = document.materials.iter().position(|m| m.name.as_deref() == Some(BARE));
    let index = known.unwrap_or(document.materials.len());
    if known.is_none() {
        document.materials.push(MaterialEntity { name: Some(BARE.to_owned()), entity });
    }
    MaterialReference::Index(index)
}

/// Name of the material of bare meshes.
const BARE: &str = "bare mesh";

/// Pale and matte, which shows shapes best.
pub(crate) fn bare_material() -> Entity {
    Entity::new("diffuse").with("reflectance", Value::Rgb(vec![[0.6; 3]]))
}

fn add_shape(
    document: &mut Document,
    file: String,
    span: Span,
    material: MaterialReference,
    converted: Option<&Converted>,
) {
    let mut entity = Entity::new("plymesh").with("filename", Value::Strings(vec![file]));
    if let Some(alpha) = converted.and_then(|converted| converted.alpha.clone()) {
        entity.parameters.push(Parameter { span: Some(span), ..Parameter::new("alpha", alpha) });
    }
    let light = converted.and_then(|converted| converted.light.clone());
    let area_light = light.map(|light| {
        document.area_lights.push(light);
        document.area_lights.len() - 1
    });
    document.shapes.push(ShapeEntity {
        entity,
        world_from_object: AnimatedTransform::constant(Transform::IDENTITY),
        reverse_orientation: false,
        material,
        area_light,
        inside_medium: String::new(),
        outside_medium: String::new(),
        has_medium_interface: false,
    });
}

/// Adds the materials of all libraries; the first of a name counts.
fn read_libraries(
    libraries: &[Name],
    extent: f32,
    document: &mut Document,
    diagnostics: &mut Diagnostics,
) -> HashMap<String, Converted> {
    let mut found: HashMap<String, Converted> = HashMap::new();
    let mut read: Vec<String> = Vec::new();
    for library in libraries.iter().take(MAX_LIBRARIES) {
        // One name with spaces, or several names.
        let whole = library.text.trim_matches('"').replace('\\', "/");
        let is_one = document.base_directory.join(&whole).exists() || !whole.contains(' ');
        let names: Vec<String> =
            if is_one { vec![whole] } else { whole.split_whitespace().map(str::to_owned).collect() };
        for name in names {
            if read.contains(&name) || read.len() >= MAX_LIBRARIES {
                continue;
            }
            read.push(name.clone());
            let path = document.base_directory.join(&name);
            let bytes = match read_file(&path) {
                Ok(bytes) => bytes,
                Err(error) => {
                    // A mesh without its materials is still a mesh.
                    diagnostics.warning(library.span, format!("{error}; its materials are grey"));
                    continue;
                }
            };
            let text = String::from_utf8_lossy(&bytes).into_owned();
            let file: FileId = document.sources.add(path.display().to_string(), "");
            let materials = mtl::parse(&text, file, diagnostics);
            document.sources.fill(file, text);
            let folder = name.rsplit_once('/').map_or(String::new(), |(folder, _)| format!("{folder}/"));
            let mut converter = Converter { document, diagnostics, folder, extent };
            for material in &materials {
                if !found.contains_key(&material.name) {
                    let converted = converter.add(material);
                    found.insert(material.name.clone(), converted);
                }
            }
        }
    }
    found
}
