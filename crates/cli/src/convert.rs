//! `etendue convert`: any readable scene as a pbrt-v4 scene.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

use etendue::image::{Encoding, Image, Texels};
use etendue::io::images::write_atomically;
use etendue::io::{read_scene, write_image, write_pbrt, write_ply};
use etendue::scene::document::{Document, EmbeddedFile, Entity, Parameter, Value};

use crate::args::ConvertArguments;
use crate::failure::{Failure, Result};
use crate::report;

/// Reads the scene and writes it with all meshes and pictures that no file holds.
pub(crate) fn run(arguments: &ConvertArguments) -> Result<()> {
    let ConvertArguments { scene, output, quiet } = arguments;
    check_paths(scene, output)?;
    let (mut document, diagnostics) = read_scene(scene);
    report::diagnostics(&diagnostics, &document.sources, *quiet);
    if diagnostics.has_errors() {
        return Err(Failure::Scene);
    }
    write_out_tangents(&mut document);
    let files = Files::of(&mut document, output);
    files.write(output)?;
    let text = write_pbrt(&document);
    write_bytes(output, text.as_bytes())
}

fn check_paths(scene: &Path, output: &Path) -> Result<()> {
    let is_pbrt = output.extension().is_some_and(|extension| extension.eq_ignore_ascii_case("pbrt"));
    if !is_pbrt {
        return Err(Failure::Usage(format!(
            "the output is a pbrt scene: write NAME.pbrt, not '{}'",
            output.display()
        )));
    }
    let same = match (scene.canonicalize(), output.canonicalize()) {
        (Ok(scene), Ok(output)) => scene == output,
        _ => scene == output,
    };
    if same {
        return Err(Failure::Usage("the output would overwrite the input; choose another name".to_owned()));
    }
    Ok(())
}

/// Meshes with tangents become `trianglemesh`es in the scene itself, since PLY files have none.
fn write_out_tangents(document: &mut Document) {
    let embedded = &document.embedded;
    let mut written: Vec<String> = Vec::new();
    let shapes = document.objects.iter_mut().flat_map(|object| &mut object.shapes);
    for shape in shapes.chain(&mut document.shapes) {
        let entity = &mut shape.entity;
        let name = entity.parameters.iter().find(|p| p.name == "filename").map(|p| &p.value);
        let Some(Value::Strings(names)) = name else { continue };
        let Some(EmbeddedFile::Mesh(mesh)) = names.first().and_then(|name| embedded.get(name)) else {
            continue;
        };
        if entity.type_name != "plymesh" || mesh.tangents.is_empty() || !mesh.quads.is_empty() {
            continue;
        }
        let indices = mesh.triangles.iter().flatten().map(|vertex| *vertex as i32).collect();
        let arrays = [
            ("P", Value::Points3(mesh.positions.clone())),
            ("indices", Value::Integers(indices)),
            ("N", Value::Normals3(mesh.normals.clone())),
            ("S", Value::Vectors3(mesh.tangents.clone())),
            ("uv", Value::Points2(mesh.uvs.clone())),
            ("faceIndices", Value::Integers(mesh.face_indices.clone())),
        ];
        written.extend(names.first().cloned());
        entity.type_name = "trianglemesh".to_owned();
        entity.parameters.retain(|p| p.name != "filename");
        let given = arrays.into_iter().filter(|(_, value)| !is_empty(value));
        entity.parameters.extend(given.map(|(name, value)| Parameter::new(name, value)));
    }
    document.embedded.retain(|name, _| !written.contains(name));
}

/// True for a list without values.
fn is_empty(value: &Value) -> bool {
    match value {
        Value::Points3(list) => list.is_empty(),
        Value::Normals3(list) => list.is_empty(),
        Value::Vectors3(list) => list.is_empty(),
        Value::Points2(list) => list.is_empty(),
        Value::Integers(list) => list.is_empty(),
        _ => false,
    }
}

/// What is to be written beside the scene.
struct Files {
    /// Content by the name relative to the folder of the output.
    contents: BTreeMap<String, EmbeddedFile>,
}

impl Files {
    /// Gives all file names of the document the meaning that they have for the output: embedded ones get a name in a folder
    /// of its own, others become relative to the output, or absolute.
    fn of(document: &mut Document, output: &Path) -> Self {
        let stem =
            output.file_stem().map_or_else(|| "scene".to_owned(), |stem| stem.to_string_lossy().into_owned());
        let embedded = std::mem::take(&mut document.embedded);
        let mut names = BTreeMap::new();
        let mut contents = BTreeMap::new();
        for (index, (name, file)) in embedded.into_iter().enumerate() {
            let extension = match &file {
                EmbeddedFile::Mesh(_) => "ply",
                EmbeddedFile::Image(texels) if texels.is_encoded() => "png",
                EmbeddedFile::Image(_) => "exr",
                EmbeddedFile::Bytes(bytes) => extension_of(bytes),
            };
            let folder = if extension == "ply" { "meshes" } else { "textures" };
            let new = format!("{stem}-{folder}/{}-{index}.{extension}", plain(&name));
            names.insert(name, new.clone());
            contents.insert(new, file);
        }
        let from = document.base_directory.clone();
        let to = output.parent().map(Path::to_owned).unwrap_or_default();
        let rename = |name: &mut String| match names.get(name.as_str()) {
            Some(new) => name.clone_from(new),
            None => {
                if let Some(moved) = moved(&from, &to, name) {
                    *name = moved;
                }
            }
        };
        each_file_name(document, rename);
        Self { contents }
    }

    /// All files appear before the scene that names them.
    fn write(&self, output: &Path) -> Result<()> {
        let folder = output.parent().map(Path::to_owned).unwrap_or_default();
        for (name, content) in &self.contents {
            let path = folder.join(name);
            if let Some(parent) = path.parent() {
                std::fs::create_dir_all(parent).map_err(|error| {
                    Failure::Running(format!("cannot make the folder '{}': {error}", parent.display()))
                })?;
            }
            match content {
                EmbeddedFile::Mesh(mesh) => write_bytes(&path, &write_ply(mesh))?,
                EmbeddedFile::Bytes(bytes) => write_bytes(&path, bytes)?,
                EmbeddedFile::Image(texels) => {
                    write_image(&path, &picture(texels))
                        .map_err(|error| Failure::Running(error.to_string()))?;
                }
            }
        }
        Ok(())
    }
}

/// A picture to be written: linear light stays, and encoded numbers become those that reading them back gives.
fn picture(texels: &Texels) -> Image {
    texels.to_image(if texels.is_encoded() { Encoding::Srgb } else { Encoding::Linear })
}

fn write_bytes(path: &Path, bytes: &[u8]) -> Result<()> {
    write_atomically(path, |file| std::io::Write::write_all(file, bytes)).map_err(|error: std::io::Error| {
        Failure::Running(format!("cannot write '{}': {error}", path.display()))
    })
}

/// The last part of a name with nothing but letters, digits and hyphens.
fn plain(name: &str) -> String {
    let last = name.rsplit('/').next().unwrap_or(name);
    let last = last.rsplit_once('.').map_or(last, |(stem, _)| stem);
    let plain: String =
        last.chars().map(|c| if c.is_ascii_alphanumeric() { c } else { '-' }).take(40).collect();
    let plain = plain.trim_matches('-').to_owned();
    if plain.is_empty() { "file".to_owned() } else { plain }
}

/// The extension that the first bytes of a picture call for.
fn extension_of(bytes: &[u8]) -> &'static str {
    match bytes {
        [0x89, b'P', b'N', b'G', ..] => "png",
        [0xff, 0xd8, ..] => "jpg",
        [0x76, 0x2f, 0x31, 0x01, ..] => "exr",
        [b'#', b'?', ..] => "hdr",
        [b'q', b'o', b'i', b'f', ..] => "qoi",
        [b'p', b'l', b'y', ..] => "ply",
        _ => "bin",
    }
}

/// The name that a file has seen from another folder; `None` if it may stay.
fn moved(from: &Path, to: &Path, name: &str) -> Option<String> {
    let path = Path::new(name);
    if name.is_empty() || path.is_absolute() {
        return None;
    }
    let here =
        |folder: &Path| if folder.as_os_str().is_empty() { PathBuf::from(".") } else { folder.to_owned() };
    let (from, to) = (here(from).canonicalize().ok()?, here(to).canonicalize().ok()?);
    if from == to {
        return None;
    }
    let relative = from.strip_prefix(&to).map_or_else(|_| from.join(path), |inside| inside.join(path));
    Some(relative.to_string_lossy().replace('\\', "/"))
}

/// Calls `rename` with the names of all files in parameters.
fn each_file_name(document: &mut Document, rename: impl Fn(&mut String)) {
    let entity = |entity: &mut Entity| {
        for parameter in &mut entity.parameters {
            match &mut parameter.value {
                Value::Strings(names) if is_file(&parameter.name) => names.iter_mut().for_each(&rename),
                // Names of spectra are files if they look like some.
                Value::SpectrumNames(names) => {
                    names.iter_mut().filter(|name| name.contains(['.', '/'])).for_each(&rename);
                }
                _ => {}
            }
        }
    };
    let shapes = document.objects.iter_mut().flat_map(|object| &mut object.shapes);
    shapes.chain(&mut document.shapes).for_each(|shape| entity(&mut shape.entity));
    document.textures.iter_mut().for_each(|texture| entity(&mut texture.entity));
    document.materials.iter_mut().for_each(|material| entity(&mut material.entity));
    document.lights.iter_mut().for_each(|light| entity(&mut light.entity));
    document.area_lights.iter_mut().for_each(entity);
    document.media.iter_mut().for_each(|medium| entity(&mut medium.entity));
    document.camera.iter_mut().for_each(|camera| entity(&mut camera.entity));
}

/// Parameters that name files to be read.
fn is_file(name: &str) -> bool {
    name.contains("filename")
        || matches!(name, "normalmap" | "clearcoatnormalmap" | "lensfile" | "aperture" | "file")
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Names of parts become names of files, without folders and spaces.
    #[test]
    fn parts_become_files() {
        assert_eq!(plain("scene.xml/meshes/a b.obj (smooth)"), "a-b");
        assert_eq!(plain("scene.glb/../.."), "file");
        assert_eq!(plain("x/é"), "file");
    }
}
