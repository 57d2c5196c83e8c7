//! A PLY file as a scene: its mesh on a stage, in its own colours if it has some.

use std::path::Path;

use etendue_math::{AnimatedTransform, Transform};
use etendue_scene::document::{
    EmbeddedFile, Entity, MaterialEntity, MaterialReference, ShapeEntity, TextureEntity, TextureValue, Value,
};
use etendue_scene::{Diagnostics, Document, LoadedMesh};

use super::read_ply;
use crate::checkpoint::hash_bytes;
use crate::file::read_given_file;
use crate::mesh::{smooth_but_creases, split_quads};
use crate::obj::bare_material;
use crate::stage::{CREASE_DEGREES, Ground, Up, set_stage};

/// Reads a PLY file as a scene: camera, light and ground are those of [`crate::stage`]. A mesh without normals is smooth but for creases.
///
/// The document is as complete as the errors in the diagnostics allow.
#[must_use]
pub fn read_bare_ply(path: &Path) -> (Document, Diagnostics) {
    let base_directory = path.parent().map(Path::to_owned).unwrap_or_default();
    let mut document = Document { base_directory, ..Document::default() };
    let mut diagnostics = Diagnostics::default();
    let read = read_given_file(path).map_err(|error| error.to_string()).and_then(|bytes| {
        read_ply(&bytes)
            .map_err(|error| format!("`{}`: {error}", path.display()))
            .map(|ply| (ply, hash_bytes(&bytes)))
    });
    match read {
        Ok((ply, hash)) => {
            // The mesh is no text; that which stands for it tells one file from another.
            let summary = format!("a mesh with the hash {hash:016x}");
            document.sources.add(path.display().to_string(), summary);
            for warning in ply.warnings {
                diagnostics.warning(None, format!("`{}`: {warning}", path.display()));
            }
            add_mesh(&mut document, ply.mesh);
            set_stage(&mut document, Up::Guessed, Ground::Disk, &mut diagnostics);
        }
        Err(why) => {
            diagnostics.error(None, why);
        }
    }
    (document, diagnostics)
}

fn add_mesh(document: &mut Document, mut mesh: LoadedMesh) {
    split_quads(&mut mesh);
    if mesh.normals.is_empty() {
        smooth_but_creases(&mut mesh, CREASE_DEGREES);
    }
    let color = ["vertex_color", "face_color"]
        .into_iter()
        .find(|name| mesh.attributes.iter().any(|a| a.name == *name));
    let entity = match color {
        Some(name) => {
            let texture = Entity::new("meshattribute").with("name", Value::Strings(vec![name.to_owned()]));
            document.textures.push(TextureEntity {
                name: name.to_owned(),
                value: TextureValue::Spectrum,
                world_from_texture: Transform::IDENTITY,
                entity: texture,
            });
            Entity::new("diffuse").with("reflectance", Value::Texture(name.to_owned()))
        }
        None => bare_material(),
    };
    document.materials.push(MaterialEntity { name: Some("bare mesh".to_owned()), entity });
    let material = MaterialReference::Index(document.materials.len() - 1);
    let file = document.embed("mesh", EmbeddedFile::Mesh(mesh.into()));
    document.shapes.push(ShapeEntity {
        entity: Entity::new("plymesh").with("filename", Value::Strings(vec![file])),
        world_from_object: AnimatedTransform::constant(Transform::IDENTITY),
        reverse_orientation: false,
        material,
        area_light: None,
        inside_medium: String::new(),
        outside_medium: String::new(),
        has_medium_interface: false,
    });
}
