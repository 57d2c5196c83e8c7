//! Files of a scene: the main one and those that it includes.

use std::path::{Path, PathBuf};

use etendue_scene::Span;
use etendue_scene::diagnostics::FileId;

use super::builder::Builder;
use super::parser;
use crate::file::{read_file, read_given_file};

/// Levels of `Include` inside of each other.
const MAX_DEPTH: usize = 100;

/// The chain of files that are open, and what concerns all of them.
#[derive(Debug, Default)]
pub(super) struct Files {
    /// Folder that relative names start from: that of the main file.
    pub(super) base_directory: PathBuf,
    /// Name and canonical path of each open file, the main one first.
    chain: Vec<(String, PathBuf)>,
    /// True after so many problems that reading stopped.
    pub(super) stopped: bool,
    /// True if a directive of the world stood before `WorldBegin`.
    pub(super) reported_early_world: bool,
}

impl Files {
    /// Reads a file into the builder; problems get the place `span`, where the file was named.
    pub(super) fn read(&mut self, name: &str, span: Option<Span>, builder: &mut Builder) {
        let path = self.base_directory.join(name);
        let canonical = path.canonicalize().unwrap_or_else(|_| path.clone());
        if let Some(first) = self.chain.iter().position(|(_, open)| *open == canonical) {
            let names: Vec<_> =
                self.chain[first..].iter().map(|(name, _)| name.as_str()).chain([name]).collect();
            let message = format!("the file includes itself: {}", names.join(" → "));
            builder.diagnostics.error(span, message);
            return;
        }
        if self.chain.len() >= MAX_DEPTH {
            builder.diagnostics.error(span, format!("more than {MAX_DEPTH} files include each other"));
            return;
        }
        let bytes = match if span.is_some() { read_file(&path) } else { read_given_file(&path) } {
            Ok(bytes) => bytes,
            Err(error) => {
                builder.diagnostics.error(span, error.to_string());
                return;
            }
        };
        self.chain.push((name.to_owned(), canonical));
        self.read_bytes(&path.display().to_string(), bytes, builder);
        self.chain.pop();
    }

    /// The same for the main file, whose folder becomes the base.
    pub(super) fn read_main(&mut self, path: &Path, builder: &mut Builder) {
        self.base_directory = path.parent().map(Path::to_owned).unwrap_or_default();
        match path.file_name() {
            Some(name) => self.read(&name.to_string_lossy(), None, builder),
            None => {
                builder.diagnostics.error(None, format!("`{}` is a folder, not a file", path.display()));
            }
        }
    }

    /// Checks at the end of the main file that blocks are closed and that there was a world.
    pub(super) fn finish(&self, builder: &mut Builder) {
        builder.report_open_blocks();
        let Some(main) = builder.document.sources.files().first() else { return };
        if !builder.in_world && !self.reported_early_world && !self.stopped {
            let end = main.text.len() as u32;
            let span = Span { file: FileId(0), start: end, end };
            builder.diagnostics.error(span, "the file ends before `WorldBegin`");
        }
    }

    /// Reads the content of a file.
    pub(super) fn read_bytes(&mut self, name: &str, bytes: Vec<u8>, builder: &mut Builder) {
        let file = builder.document.sources.add(name, "");
        let text = match String::from_utf8(bytes) {
            Ok(text) => text,
            Err(error) => {
                let start = error.utf8_error().valid_up_to() as u32;
                let span = Span { file, start, end: start + 1 };
                if matches!(error.as_bytes(), [0xff, 0xfe, ..] | [0xfe, 0xff, ..]) {
                    builder.diagnostics.error(span, "the file is encoded in UTF-16: save it as UTF-8");
                    return;
                }
                builder.diagnostics.error(span, "this byte is not part of UTF-8 text");
                String::from_utf8_lossy(error.as_bytes()).into_owned()
            }
        };
        parser::parse(&text, file, builder, self);
        builder.document.sources.fill(file, text);
    }
}
