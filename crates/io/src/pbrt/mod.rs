//! Scene files in the format of pbrt-v4 (Pharr, Jakob and Humphreys 2023, "Physically Based Rendering", appendix C).
//!
//! The reader turns the text into a [`Document`]: names, numbers and transforms as written, attributes resolved.
//! It knows all directives and parameter types, but no type of shape, material or light; the scene builder does.
//! All problems of all files are collected, each with its place.
//!
//! Simplified: a statement ends with its file, while pbrt would go on reading its parameters in the file that
//! includes it. Numbers must fit single precision; pbrt would make them infinite.

mod builder;
mod directives;
mod files;
mod lexer;
mod parameters;
mod parser;
mod state;
mod write;

#[cfg(test)]
mod tests;

use std::path::Path;

use etendue_scene::{Diagnostics, Document};

use builder::Builder;
use files::Files;

pub use write::{value_text, write_pbrt};

/// Reads a scene file, which may be compressed by gzip, with all files that it includes.
///
/// The document is as complete as the errors in the diagnostics allow.
#[must_use]
pub fn read_pbrt(path: &Path) -> (Document, Diagnostics) {
    let (mut files, mut builder) = (Files::default(), Builder::default());
    files.read_main(path, &mut builder);
    finished(files, builder)
}

/// Reads a scene from a text; `name` stands for it in messages, and file names are relative to `base_directory`.
#[must_use]
pub fn read_pbrt_str(name: &str, text: &str, base_directory: &Path) -> (Document, Diagnostics) {
    read_pbrt_bytes(name, text.as_bytes().to_vec(), base_directory)
}

/// The same for bytes that may not be text.
#[must_use]
pub fn read_pbrt_bytes(name: &str, bytes: Vec<u8>, base_directory: &Path) -> (Document, Diagnostics) {
    let (mut files, mut builder) = (Files::default(), Builder::default());
    files.base_directory = base_directory.to_owned();
    match crate::file::decompressed(&bytes) {
        Ok(content) => files.read_bytes(name, content.into_owned(), &mut builder),
        Err(why) => {
            builder.diagnostics.error(None, format!("cannot decompress `{name}`: {why}"));
        }
    }
    finished(files, builder)
}

fn finished(files: Files, mut builder: Builder) -> (Document, Diagnostics) {
    files.finish(&mut builder);
    builder.document.base_directory = files.base_directory;
    (builder.document, builder.diagnostics)
}
