//! `etendue convert`: any readable scene as a pbrt-v4 scene.

use std::collections::{BTreeMap, BTreeSet};
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
    for name in write_out_tangents(&mut document) {
        if !quiet {
            let message = format!("the mesh `{name}` keeps its attributes, but its tangents are left out");
            report::warning(&message);
        }
    }
    let made = make_folder(output)?;
    let result = write(&mut document, output);
    if result.is_err() {
        // Those with something in them stay.
        made.iter().for_each(|folder| drop(std::fs::remove_dir(folder)));
    }
    result
}

fn write(document: &mut Document, output: &Path) -> Result<()> {
    let files = Files::of(document, output)?;
    files.write(output)?;
    let text = write_pbrt(document);
    write_bytes(output, text.as_bytes())
}

/// Makes the folder of the output, so that names of files can be given as seen from it. What was made comes back, inner
/// folders first.
fn make_folder(output: &Path) -> Result<Vec<PathBuf>> {
    let folder = output.parent().unwrap_or(Path::new(""));
    let is_missing = |folder: &&Path| !folder.as_os_str().is_empty() && !folder.exists();
    let missing = folder.ancestors().take_while(is_missing).map(Path::to_owned).collect::<Vec<_>>();
    if !missing.is_empty() {
        make_folders(folder)?;
    }
    Ok(missing)
}

fn make_folders(folder: &Path) -> Result<()> {
    std::fs::create_dir_all(folder)
        .map_err(|error| Failure::Running(format!("cannot make the folder '{}': {error}", folder.display())))
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

/// Meshes with tangents become `trianglemesh`es in the scene itself, since PLY files have none. Only PLY files have colours
/// and other attributes, which matter more: meshes with both come back by name, and lose their tangents.
fn write_out_tangents(document: &mut Document) -> BTreeSet<String> {
    let mut with_both = BTreeSet::new();
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
        if !mesh.attributes.is_empty() {
            with_both.extend(names.first().cloned());
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
    with_both
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
    fn of(document: &mut Document, output: &Path) -> Result<Self> {
        let from = canonical(&document.base_directory)?;
        let to = canonical(output.parent().unwrap_or(Path::new("")))?;
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
        let rename = |name: &mut String| match names.get(name.as_str()) {
            Some(new) => name.clone_from(new),
            None => {
                if let Some(moved) = moved(&from, &to, name) {
                    *name = moved;
                }
            }
        };
        each_file_name(document, rename);
        Ok(Self { contents })
    }

    /// All files appear before the scene that names them.
    fn write(&self, output: &Path) -> Result<()> {
        let folder = output.parent().map(Path::to_owned).unwrap_or_default();
        for (name, content) in &self.contents {
            let path = folder.join(name);
            if let Some(parent) = path.parent() {
                make_folders(parent)?;
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

/// The folder without links and dots.
fn canonical(folder: &Path) -> Result<PathBuf> {
    let here = if folder.as_os_str().is_empty() { Path::new(".") } else { folder };
    here.canonicalize()
        .map_err(|error| Failure::Running(format!("cannot find the folder '{}': {error}", here.display())))
}

/// The name that a file has seen from another folder, both of them canonical; `None` if it may stay.
fn moved(from: &Path, to: &Path, name: &str) -> Option<String> {
    let path = Path::new(name);
    if name.is_empty() || path.is_absolute() {
        return None;
    }
    if from == to {
        return None;
    }
    let relative = from.strip_prefix(to).map_or_else(|_| from.join(path), |inside| inside.join(path));
    Some(relative.to_string_lossy().replace('\\', "/"))
}

/// Calls `rename` with the names of all files in parameters.
fn each_file_name(document: &mut Document, rename: impl Fn(&mut String)) {
    let entity = |entity: &mut Entity| {
        for parameter in &mut entity.parameters {
            match &mut parameter.value {
                // Apertures without a point are shapes that are built in.
                Value::Strings(names) if parameter.name == "aperture" => {
                    names.iter_mut().filter(|name| name.contains('.')).for_each(&rename);
                }
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
    name.contains("filename") || matches!(name, "normalmap" | "clearcoatnormalmap" | "lensfile" | "file")
}

#[cfg(test)]
mod tests {
    use etendue::math::{AnimatedTransform, Point3, Transform, Vector3};
    use etendue::scene::document::{CameraEntity, MaterialReference, ShapeEntity};
    use etendue::scene::{AttributeDomain, LoadedMesh, MeshAttribute};

    use super::*;

    /// Names of built-in apertures stay, and those of files move with the scene.
    #[test]
    fn built_in_apertures_are_no_files() {
        let renamed = |name: &str| {
            let aperture = Value::Strings(vec![name.to_owned()]);
            let camera = CameraEntity {
                entity: Entity::new("realistic").with("aperture", aperture),
                world_from_camera: AnimatedTransform::constant(Transform::IDENTITY),
                medium: String::new(),
            };
            let mut document = Document { camera: Some(camera), ..Document::default() };
            each_file_name(&mut document, |name| name.insert_str(0, "moved/"));
            document.camera.map(|camera| camera.entity.parameters[0].value.clone())
        };
        let strings = |name: &str| Some(Value::Strings(vec![name.to_owned()]));
        assert_eq!(renamed("pentagon"), strings("pentagon"));
        assert_eq!(renamed("blades.png"), strings("moved/blades.png"));
    }

    /// A mesh with colours and tangents keeps the colours, which only its file can hold.
    #[test]
    fn colors_outlive_tangents() {
        let colors = MeshAttribute {
            name: "vertex_color".to_owned(),
            domain: AttributeDomain::Vertex,
            n_components: 3,
            values: vec![0.5; 9],
        };
        let mesh = LoadedMesh {
            positions: vec![Point3::ORIGIN; 3],
            tangents: vec![Vector3::new(1.0, 0.0, 0.0); 3],
            triangles: vec![[0, 1, 2]],
            attributes: vec![colors],
            ..LoadedMesh::default()
        };
        let mut document = Document::default();
        let name = document.embed("mesh", EmbeddedFile::Mesh(mesh.into()));
        document.shapes.push(ShapeEntity {
            entity: Entity::new("plymesh").with("filename", Value::Strings(vec![name.clone()])),
            world_from_object: AnimatedTransform::constant(Transform::IDENTITY),
            reverse_orientation: false,
            material: MaterialReference::Index(0),
            area_light: None,
            inside_medium: String::new(),
            outside_medium: String::new(),
            has_medium_interface: false,
        });
        assert!(write_out_tangents(&mut document).contains(&name));
        assert!(document.embedded.contains_key(&name) && document.shapes[0].entity.type_name == "plymesh");
    }

    /// Names of parts become names of files, without folders and spaces.
    #[test]
    fn parts_become_files() {
        assert_eq!(plain("scene.xml/meshes/a b.obj (smooth)"), "a-b");
        assert_eq!(plain("scene.glb/../.."), "file");
        assert_eq!(plain("x/é"), "file");
    }
}
