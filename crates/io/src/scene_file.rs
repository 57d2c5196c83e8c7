//! Scene files of any format, told by the name of the file or, where that says nothing, by its first bytes.

use std::fs::File;
use std::io::Read;
use std::path::Path;

use etendue_scene::{Diagnostics, Document};

use crate::exact::make_transforms_exact;
use crate::file::decompressed;
use crate::gltf::read_gltf;
use crate::mitsuba::read_mitsuba;
use crate::obj::read_obj;
use crate::pbrt::read_pbrt;
use crate::ply::read_bare_ply;

#[cfg(test)]
mod tests;

/// A format of scene files.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Format {
    Pbrt,
    Gltf,
    Mitsuba,
    Obj,
    Ply,
}

/// Extensions without `.gz`, with what they stand for.
const EXTENSIONS: [(&str, Format); 6] = [
    ("pbrt", Format::Pbrt),
    ("gltf", Format::Gltf),
    ("glb", Format::Gltf),
    ("xml", Format::Mitsuba),
    ("obj", Format::Obj),
    ("ply", Format::Ply),
];

/// Bytes that are looked at where the name of a file tells nothing.
const N_SNIFFED: u64 = 64 << 10;

/// Reads a scene of any known format with all that it includes; the files that it names are left to
/// [`load_assets`](crate::load_assets).
///
/// The document is as complete as the errors in the diagnostics allow.
#[must_use]
pub fn read_scene(path: &Path) -> (Document, Diagnostics) {
    let format = match format_of_name(path) {
        Some(format) => format,
        None => match format_of_content(path) {
            Ok(format) => format,
            Err(message) => return failed(&message),
        },
    };
    let (mut document, diagnostics) = match format {
        Format::Pbrt => return read_pbrt(path),
        Format::Gltf => read_gltf(path),
        Format::Mitsuba => read_mitsuba(path),
        Format::Obj => read_obj(path),
        Format::Ply => read_bare_ply(path),
    };
    // So that a scene that is converted to pbrt's format stays the same bit for bit.
    make_transforms_exact(&mut document);
    (document, diagnostics)
}

fn failed(message: &str) -> (Document, Diagnostics) {
    let mut diagnostics = Diagnostics::default();
    diagnostics.error(None, message);
    (Document::default(), diagnostics)
}

fn format_of_name(path: &Path) -> Option<Format> {
    let name = path.file_name()?.to_str()?.to_ascii_lowercase();
    let extension = name.strip_suffix(".gz").unwrap_or(&name).rsplit_once('.')?.1;
    EXTENSIONS.iter().find(|(known, _)| *known == extension).map(|(_, format)| *format)
}

/// The format that the file's first bytes suggest. What cannot be read, or not twice, is left to the reader of pbrt files.
fn format_of_content(path: &Path) -> Result<Format, String> {
    let is_file = path.metadata().is_ok_and(|metadata| metadata.is_file());
    let mut start = Vec::new();
    let opened = File::open(path).and_then(|file| file.take(N_SNIFFED).read_to_end(&mut start));
    if !is_file || opened.is_err() {
        return Ok(Format::Pbrt);
    }
    // The beginning of a compressed stream ends early, which is an error of the stream: pbrt's are the usual ones.
    let Ok(start) = decompressed(&start) else { return Ok(Format::Pbrt) };
    let text = String::from_utf8_lossy(&start);
    let text = text.trim_start_matches('\u{feff}').trim_start();
    let has_line = |keyword: &str| text.lines().any(|line| line.split_whitespace().next() == Some(keyword));
    let pbrt = ["WorldBegin", "Camera", "Film", "Include", "LookAt", "Integrator"];
    match () {
        () if start.starts_with(b"glTF") || text.starts_with('{') => Ok(Format::Gltf),
        () if start.starts_with(b"ply") => Ok(Format::Ply),
        () if text.starts_with('<') => Ok(Format::Mitsuba),
        () if pbrt.into_iter().any(has_line) => Ok(Format::Pbrt),
        () if has_line("v") && has_line("f") => Ok(Format::Obj),
        () => Err(format!(
            "`{}` is no scene that is known here: there are .pbrt (pbrt-v4), .gltf and .glb (glTF 2.0), .xml (Mitsuba), \
             .obj and .ply, all but .glb also with .gz",
            path.display()
        )),
    }
}
