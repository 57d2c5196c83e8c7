//! Scenes in glTF 2.0 (Khronos 2021, "glTF 2.0 Specification"), as text with buffers beside it or as GLB.
//!
//! The reader makes a [`Document`]: meshes and embedded pictures travel in it ([`Document::embed`]), nodes become shapes
//! or, where several show the same mesh, instances of an object. Its own reader of JSON knows where each value stands, so
//! that problems have a line, a column and the pointer to the value (RFC 6901); the crate `gltf` knows neither, and leaves
//! most extensions of materials to the caller.
//!
//! Simplified: scenes stand still (animations are not played, skins and morphs are as the file leaves them), all surfaces
//! are seen from both sides, occlusion textures are not used, since light is traced. What of a file cannot be shown is a
//! warning. Nothing in a file is trusted: see [`accessors`] and [`Reader::charge`].

mod accessors;
mod buffers;
mod container;
mod draco;
mod file;
mod light;
mod material;
mod matrix;
mod mesh;
mod node;
mod texture;

#[cfg(test)]
mod tests;

use std::cell::{Cell, RefCell};
use std::collections::HashMap;
use std::path::Path;

use etendue_scene::diagnostics::FileId;
use etendue_scene::document::Entity;
use etendue_scene::{Diagnostics, Document, Span};

use crate::file::{decompressed, read_given_file};
use crate::json::{Json, JsonError, Kind};
use crate::stage::{Ground, Up, set_stage};
use buffers::Buffers;
use container::Container;
use file::{File, span};
use material::Surface;

/// Extensions that are understood, or that change nothing which is shown.
const EXTENSIONS: [&str; 25] = [
    "EXT_mesh_gpu_instancing",
    "KHR_draco_mesh_compression",
    "KHR_lights_punctual",
    "KHR_materials_anisotropy",
    "KHR_materials_clearcoat",
    "KHR_materials_diffuse_transmission",
    "KHR_materials_dispersion",
    "KHR_materials_emissive_strength",
    "KHR_materials_ior",
    "KHR_materials_iridescence",
    "KHR_materials_pbrSpecularGlossiness",
    "KHR_materials_sheen",
    "KHR_materials_specular",
    "KHR_materials_transmission",
    "KHR_materials_unlit",
    "KHR_materials_variants",
    "KHR_materials_volume",
    "KHR_mesh_quantization",
    "KHR_texture_basisu",
    "KHR_texture_transform",
    "EXT_texture_webp",
    "KHR_xmp",
    "KHR_xmp_json_ld",
    "MSFT_texture_dds",
    "EXT_texture_avif",
];

/// Extensions that say more about what cannot be read where they are used, which may be nowhere.
const REPORTED_WHERE_USED: [&str; 2] = ["EXT_meshopt_compression", "KHR_meshopt_compression"];

/// Vertices and triangles that a file may have beyond one for each of its bytes: more can only come from using the same
/// data over and over.
const FREE_ELEMENTS: u64 = 1 << 24;

/// What an instance, or a further shape of the same mesh, counts as: it takes memory like so many vertices and triangles.
const PER_INSTANCE: usize = 32;

/// Reads a glTF or GLB file; files that it names are read too, but for pictures, which are left to
/// [`load_assets`](crate::load_assets). What the file lacks of camera and lights comes from [`set_stage`].
///
/// The document is as complete as the errors in the diagnostics allow.
#[must_use]
pub fn read_gltf(path: &Path) -> (Document, Diagnostics) {
    let bytes = match read_given_file(path) {
        Ok(bytes) => bytes,
        Err(error) => return failed(error.to_string()),
    };
    let base = path.parent().unwrap_or(Path::new(""));
    let (mut document, mut diagnostics) = read_gltf_bytes(&path.display().to_string(), bytes, base);
    if !diagnostics.has_errors() {
        let is_bare = document.camera.is_none() && document.lights.is_empty();
        let ground = if is_bare { Ground::Disk } else { Ground::None };
        set_stage(&mut document, Up::Y, ground, &mut diagnostics);
    }
    (document, diagnostics)
}

fn failed(message: String) -> (Document, Diagnostics) {
    let mut diagnostics = Diagnostics::default();
    diagnostics.error(None, message);
    (Document::default(), diagnostics)
}

/// Reads the bytes of a glTF or GLB file; `name` stands for it in messages, and other files are sought in `base`.
#[must_use]
pub fn read_gltf_bytes(name: &str, bytes: Vec<u8>, base: &Path) -> (Document, Diagnostics) {
    let content = match decompressed(&bytes) {
        Ok(content) => content.into_owned(),
        Err(why) => return failed(format!("cannot decompress `{name}`: {why}")),
    };
    let Container { json, binary } = match container::split(content) {
        Ok(container) => container,
        Err(why) => return failed(format!("`{name}`: {why}")),
    };
    let text = match String::from_utf8(json) {
        Ok(text) => text.trim_start_matches('\u{feff}').trim_end_matches('\0').to_owned(),
        Err(error) => {
            let at = error.utf8_error().valid_up_to();
            return failed(format!("`{name}`: byte {at} of the JSON is not part of UTF-8 text"));
        }
    };
    let mut document = Document { base_directory: base.to_owned(), ..Document::default() };
    document.sources.add(name, "");
    let (mut document, diagnostics) = match Json::parse(&text) {
        Ok(root) => Reader::read(&root, document, binary),
        Err(JsonError { at, message }) => {
            let mut diagnostics = Diagnostics::default();
            let span = Span { file: FileId(0), start: at, end: at + 1 };
            diagnostics.error(span, format!("broken JSON: {message}"));
            (document, diagnostics)
        }
    };
    document.sources.fill(FileId(0), text);
    (document, diagnostics)
}

/// What a file becomes.
struct Reader<'a> {
    file: File<'a>,
    buffers: Buffers,
    document: Document,
    /// Names of the files of pictures; the inner `None` is a picture that cannot be read.
    pictures: Vec<Option<Option<String>>>,
    /// Each without and with colours of vertices.
    surfaces: Vec<[Option<Surface>; 2]>,
    default_surface: [Option<Surface>; 2],
    /// Whether accessors of colours hold others than white.
    tinted: RefCell<HashMap<usize, bool>>,
    /// Vertices and triangles made so far.
    spent: Cell<u64>,
}

/// The entity with all of its parts placed at a value.
fn located(mut entity: Entity, at: &Json) -> Entity {
    entity.span = Some(span(at));
    for parameter in &mut entity.parameters {
        parameter.span = Some(span(at));
    }
    entity
}

impl<'a> Reader<'a> {
    fn read(root: &'a Json, document: Document, binary: Option<Vec<u8>>) -> (Document, Diagnostics) {
        let file = File::new(root);
        let buffers = Buffers::new(&file, document.base_directory.clone(), binary);
        let count = |list| file.array(root, list).len();
        let (pictures, surfaces) = (vec![None; count("images")], vec![[None, None]; count("materials")]);
        let spent = Cell::new(0);
        let mut reader = Reader {
            file,
            buffers,
            document,
            pictures,
            surfaces,
            default_surface: [None, None],
            tinted: RefCell::default(),
            spent,
        };
        if reader.check_header() {
            reader.read_scene();
        }
        let Reader { file, document, .. } = reader;
        (document, file.into_problems())
    }

    /// Whether this is a glTF 2.0 file that needs nothing which is not there.
    fn check_header(&self) -> bool {
        let (file, root) = (&self.file, self.file.root);
        if !matches!(root.kind, Kind::Object(_)) {
            file.error(root, "a glTF file holds an object");
            return false;
        }
        let Some(asset) = file.required(root, "asset") else { return false };
        let version = file.string(asset, "version").unwrap_or("2.0");
        if !version.starts_with("2.") {
            file.error(asset, format!("the file is of version {version}; only 2.0 can be read"));
            return false;
        }
        let name_of = |value: &'a Json| match &value.kind {
            Kind::String(name) => Some(&**name),
            _ => None,
        };
        let mut complete = true;
        let is_known = |name: &str| EXTENSIONS.contains(&name) || REPORTED_WHERE_USED.contains(&name);
        let required = file.array(root, "extensionsRequired");
        for value in required {
            if let Some(name) = name_of(value).filter(|name| !is_known(name)) {
                file.error(value, format!("the file requires the extension {name}, which is not available"));
                complete = false;
            }
        }
        for value in file.array(root, "extensionsUsed") {
            let is_required = |name: &str| required.iter().any(|value| name_of(value) == Some(name));
            if let Some(name) = name_of(value).filter(|name| !is_known(name) && !is_required(name)) {
                file.warning(value, format!("the extension {name} is not available; the rest is read"));
            }
        }
        if !file.array(root, "animations").is_empty() {
            let at = root.get("animations").unwrap_or(root);
            file.warning(at, "animations are not played; the scene stands still");
        }
        complete
    }

    /// Vertices and triangles that the file may still have.
    fn left(&self) -> u64 {
        (self.buffers.n_bytes() + FREE_ELEMENTS).saturating_sub(self.spent.get())
    }

    /// Takes vertices and triangles from what the file may have; `None` if it has too many, which is an error at `at`.
    /// The bound follows the size of the buffers, so that a small file cannot fill the memory.
    fn charge(&self, at: &Json, n_elements: usize) -> Option<()> {
        let limit = self.buffers.n_bytes() + FREE_ELEMENTS;
        match self.spent.get().checked_add(n_elements as u64).filter(|spent| *spent <= limit) {
            Some(spent) => {
                self.spent.set(spent);
                Some(())
            }
            None => {
                if self.spent.replace(u64::MAX) != u64::MAX {
                    let message = "the file uses the same data too often: there would be too many vertices";
                    self.file.error(at, message);
                }
                None
            }
        }
    }
}
