//! Scenes of Mitsuba 3, 2 and 0.6 (Jakob et al., XML), by names and meanings of the documentation of Mitsuba 3.
//!
//! 1. `files` reads XML, follows `<include>` and fills in `$name`; `element` holds the result in the spelling of version 3.
//! 2. `reader` gives access to properties by name and notes who has read what.
//! 3. `settings`, `shapes`, `meshes`, `materials`, `textures` and `emitters` turn plugins into entities of the document.
//!
//! What Mitsuba knows and we lack is a warning that names the stand-in; what nobody knows is an error. Simplified: one
//! sensor (the first), no text formats of hair, no volumes of grids.

mod element;
mod emitters;
mod environment;
mod files;
mod materials;
mod meshes;
mod reader;
mod serialized;
mod settings;
mod shapes;
#[cfg(test)]
mod tests;
mod textures;
mod values;

use std::path::Path;

use etendue_scene::{Diagnostics, Document};

use element::Element;
use files::Files;
use reader::Reader;

/// Reads a scene file of Mitsuba with all files that it includes, and the meshes that it names.
///
/// The document is as complete as the errors in the diagnostics allow.
#[must_use]
pub fn read_mitsuba(path: &Path) -> (Document, Diagnostics) {
    let mut files = Files::default();
    let root = files.read_main(path);
    finished(files, root)
}

/// Reads a scene from bytes; `name` stands for it in messages, and file names are relative to `base_directory`.
#[must_use]
pub fn read_mitsuba_bytes(name: &str, bytes: Vec<u8>, base_directory: &Path) -> (Document, Diagnostics) {
    let mut files = Files::default();
    files.base_directory = base_directory.to_owned();
    let root = files.read_bytes(name, bytes);
    finished(files, root)
}

fn finished(mut files: Files, root: Option<Element>) -> (Document, Diagnostics) {
    let Some(root) = root else {
        let sources = std::mem::take(&mut files.sources);
        let document = Document { sources, base_directory: files.base_directory, ..Document::default() };
        return (document, files.diagnostics);
    };
    let mut reader = Reader::new(files, &root);
    reader.scene(&root);
    reader.read_meshes();
    let Reader { mut document, diagnostics, files, .. } = reader;
    document.base_directory = files.base_directory;
    (document, diagnostics)
}

impl<'e> Reader<'e> {
    fn scene(&mut self, root: &'e Element) {
        if root.tag != "scene" {
            let message = format!("the root of a scene of Mitsuba is <scene>, not <{}>", root.tag);
            self.diagnostics.error(root.span, message);
            return;
        }
        if root.attribute("version").is_none() {
            let warning =
                self.diagnostics.warning(root.span, "the scene states no version; it is read as of 3");
            warning.with_help("write <scene version=\"3.0.0\">");
        }
        let mut has_sensor = false;
        for child in &root.children {
            match child.tag.as_str() {
                "sensor" if has_sensor => {
                    let message = "only the first sensor is used; this one is ignored";
                    self.diagnostics.warning(child.span, message);
                }
                "sensor" => {
                    has_sensor = true;
                    self.sensor(child);
                }
                "integrator" => self.integrator(child),
                "emitter" => self.emitter(child),
                "shape" => self.shape(child),
                "bsdf" => drop(self.material(child)),
                "medium" => drop(self.medium(child)),
                "texture" | "spectrum" | "phase" | "volume" | "film" | "sampler" | "rfilter" => {}
                "ref" => drop(self.resolved(child)),
                "alias" => {}
                "string" | "float" | "integer" | "boolean" => {}
                other => {
                    let known =
                        ["sensor", "integrator", "emitter", "shape", "bsdf", "medium", "texture", "include"];
                    self.diagnostics.unknown_name(child.span, "element", other, known);
                }
            }
        }
    }
}
