//! From files to elements: XML, `<include>`, `<default>` and `$name`, `<path>`.
//!
//! Documents with a type definition are refused, so that no entity can multiply. Depth and number of elements, of
//! inclusions and of characters that parameters stand for are bounded.

use std::cell::Cell;
use std::collections::HashMap;
use std::path::{Path, PathBuf};

use etendue_scene::diagnostics::{FileId, Sources, nearest_name};
use etendue_scene::{Diagnostics, Span};

use super::element::{Attribute, Element, modern_tag, snake_case};
use super::reader::MAX_SUGGESTED;
use crate::file::{read_file, read_given_file};

/// Levels of elements inside of each other.
const MAX_DEPTH: usize = 64;
/// Levels of files that include each other.
const MAX_FILES: usize = 15;
/// Files that a scene may include, one after the other; a file counts each time.
const MAX_INCLUDED: usize = 10_000;
/// Bytes of all of them.
const MAX_INCLUDED_BYTES: usize = 256 << 20;
/// Elements of a scene.
const MAX_ELEMENTS: usize = 10_000_000;
/// Bytes that parameters may stand for in a scene, all uses together.
const MAX_FILLED_IN: usize = 64 << 20;

/// Reads the files of a scene.
#[derive(Debug, Default)]
pub(super) struct Files {
    pub(super) sources: Sources,
    pub(super) diagnostics: Diagnostics,
    /// Folder of the main file.
    pub(super) base_directory: PathBuf,
    /// Folders of `<path>`, relative to that of the main file.
    search: Vec<String>,
    /// Values of `<default>`; the first of a name counts.
    parameters: HashMap<String, String>,
    /// Canonical path of each open file.
    open: Vec<PathBuf>,
    pub(super) n_elements: usize,
    /// Bytes that parameters stood for so far.
    n_filled_in: usize,
    /// Files included so far, and their bytes.
    n_included: usize,
    n_included_bytes: usize,
    /// True once an inclusion was refused for their number.
    is_full: bool,
    /// Parameters without value so far.
    n_unknown: usize,
}

impl Files {
    /// The root of the main file, if it can be read.
    pub(super) fn read_main(&mut self, path: &Path) -> Option<Element> {
        self.base_directory = path.parent().map(Path::to_owned).unwrap_or_default();
        self.read(path, None)
    }

    fn read(&mut self, path: &Path, span: Option<Span>) -> Option<Element> {
        let canonical = path.canonicalize().unwrap_or_else(|_| path.to_owned());
        if self.open.contains(&canonical) {
            let message = format!("the file `{}` includes itself", path.display());
            self.diagnostics.error(span, message);
            return None;
        }
        if self.open.len() >= MAX_FILES {
            self.diagnostics.error(span, format!("more than {MAX_FILES} files include each other"));
            return None;
        }
        let bytes = match if span.is_some() { read_file(path) } else { read_given_file(path) } {
            Ok(bytes) => bytes,
            Err(error) => {
                self.diagnostics.error(span, error.to_string());
                return None;
            }
        };
        if span.is_some() {
            self.n_included_bytes += bytes.len();
        }
        self.open.push(canonical);
        let root = self.read_bytes(&path.display().to_string(), bytes);
        self.open.pop();
        root
    }

    /// The root of a text.
    pub(super) fn read_bytes(&mut self, name: &str, bytes: Vec<u8>) -> Option<Element> {
        let file = self.sources.add(name, "");
        let text = match String::from_utf8(bytes) {
            Ok(text) => text,
            Err(error) => {
                let start = error.utf8_error().valid_up_to() as u32;
                let span = Span { file, start, end: start + 1 };
                self.diagnostics.error(span, "this byte is not part of UTF-8 text");
                self.sources.fill(file, String::from_utf8_lossy(error.as_bytes()));
                return None;
            }
        };
        let options =
            roxmltree::ParsingOptions { nodes_limit: 4 * MAX_ELEMENTS as u32, ..Default::default() };
        let parsed = roxmltree::Document::parse_with_options(&text, options);
        let root = match &parsed {
            Ok(document) => self.element(document.root_element(), file, 0),
            Err(error) => {
                let at = byte_of(&text, error.pos());
                let message = match error {
                    roxmltree::Error::DtdDetected => {
                        "document type definitions and entities are not read".to_owned()
                    }
                    _ => format!("the XML is damaged: {error}"),
                };
                self.diagnostics.error(Span { file, start: at, end: at }, message);
                None
            }
        };
        drop(parsed);
        self.sources.fill(file, text);
        root
    }

    fn element(&mut self, node: roxmltree::Node<'_, '_>, file: FileId, depth: usize) -> Option<Element> {
        let range = node.range();
        let start = range.start as u32;
        let tag = modern_tag(node.tag_name().name());
        let span = Span { file, start, end: (range.start + 1 + node.tag_name().name().len()) as u32 };
        self.n_elements += 1;
        if depth > MAX_DEPTH || self.n_elements > MAX_ELEMENTS {
            if depth == MAX_DEPTH + 1 {
                let message = format!("elements are nested in each other more than {MAX_DEPTH} deep");
                self.diagnostics.error(span, message);
            } else if self.n_elements == MAX_ELEMENTS + 1 {
                let message = format!("the scene has more than {MAX_ELEMENTS} elements");
                self.diagnostics.error(span, message);
            }
            return None;
        }
        let mut attributes = Vec::with_capacity(node.attributes().len());
        for attribute in node.attributes() {
            let value = attribute.range_value();
            let span = Span { file, start: value.start as u32, end: value.end as u32 };
            let value = self.filled_in(attribute.value(), span);
            attributes.push(Attribute { name: attribute.name().to_lowercase(), value, span });
        }
        let mut element = Element {
            name: String::new(),
            tag,
            span,
            attributes,
            children: Vec::new(),
            number: self.n_elements,
            used: Cell::new(false),
        };
        element.name = snake_case(element.text("name"));
        for child in node.children() {
            if child.is_text() && !child.text().unwrap_or_default().trim().is_empty() {
                let start = child.range().start as u32;
                let message = "text between elements means nothing; it is ignored";
                self.diagnostics.warning(Span { file, start, end: child.range().end as u32 }, message);
            }
            if child.is_element() {
                self.child(child, file, depth + 1, &mut element.children);
            }
        }
        Some(element)
    }

    /// A child, or what an instruction stands for.
    fn child(&mut self, node: roxmltree::Node<'_, '_>, file: FileId, depth: usize, into: &mut Vec<Element>) {
        let Some(element) = self.element(node, file, depth) else { return };
        match element.tag.as_str() {
            "default" => {
                let (name, value) = (element.text("name").to_owned(), element.text("value").to_owned());
                if name.is_empty() || element.attribute("value").is_none() {
                    self.diagnostics.error(element.span, "`<default>` needs a `name` and a `value`");
                }
                self.parameters.entry(name).or_insert(value);
            }
            "path" => self.search.push(element.text("value").to_owned()),
            "include" => self.include(&element, into),
            _ => into.push(element),
        }
    }

    /// The children of the root of another file.
    fn include(&mut self, element: &Element, into: &mut Vec<Element>) {
        let Some(name) = element.attribute("filename").or_else(|| element.attribute("value")) else {
            self.diagnostics.error(element.span, "`<include>` needs a `filename`");
            return;
        };
        if self.n_included >= MAX_INCLUDED || self.n_included_bytes > MAX_INCLUDED_BYTES {
            if !std::mem::replace(&mut self.is_full, true) {
                let message = format!(
                    "the scene includes more than {MAX_INCLUDED} files or {} MiB; the rest is left out",
                    MAX_INCLUDED_BYTES >> 20
                );
                self.diagnostics.error(name.span, message);
            }
            return;
        }
        self.n_included += 1;
        let path = self.base_directory.join(self.resolved(&name.value));
        let Some(root) = self.read(&path, Some(name.span)) else { return };
        if root.tag == "scene" { into.extend(root.children) } else { into.push(root) }
    }

    /// The name of a file relative to the folder of the main one: as written, or found in a folder of `<path>`.
    pub(super) fn resolved(&self, name: &str) -> String {
        let exists = |name: &str| self.base_directory.join(name).exists();
        if !name.is_empty() && !exists(name) {
            let found = self.search.iter().map(|folder| format!("{folder}/{name}")).find(|name| exists(name));
            if let Some(found) = found {
                return found;
            }
        }
        name.to_owned()
    }

    /// The text with the values of the parameters that it names by `$name`.
    fn filled_in(&mut self, text: &str, span: Span) -> String {
        if !text.contains('$') {
            return text.to_owned();
        }
        let mut out = String::new();
        let mut rest = text;
        while let Some(at) = rest.find('$') {
            out.push_str(&rest[..at]);
            rest = &rest[at + 1..];
            let length = rest.find(|c: char| !c.is_alphanumeric() && c != '_').unwrap_or(rest.len());
            let name = &rest[..length];
            match self.parameters.get(name) {
                Some(value) => {
                    self.n_filled_in += value.len();
                    if self.n_filled_in > MAX_FILLED_IN {
                        self.diagnostics.error(span, "the parameters of the scene stand for too much text");
                        return String::new();
                    }
                    out.push_str(value);
                }
                None => self.unknown_parameter(name, span),
            }
            rest = &rest[length..];
        }
        out + rest
    }

    fn unknown_parameter(&mut self, name: &str, span: Span) {
        self.n_unknown += 1;
        // To compare each of many with all that there are takes too long.
        let all = self.n_unknown <= MAX_SUGGESTED;
        let known = self.parameters.keys().map(String::as_str).filter(|_| all);
        let help = match nearest_name(name, known) {
            Some(near) => format!("did you mean `${near}`?"),
            None => format!("give it a value: <default name=\"{name}\" value=\"...\"/>"),
        };
        self.diagnostics.error(span, format!("there is no parameter `${name}`")).with_help(help);
    }
}

/// The byte of a line and column, which count characters from 1.
fn byte_of(text: &str, position: roxmltree::TextPos) -> u32 {
    let line: usize =
        text.split_inclusive('\n').take(position.row.saturating_sub(1) as usize).map(str::len).sum();
    let column = position.col.saturating_sub(1) as usize;
    let within = text[line..].char_indices().nth(column).map_or(text.len() - line, |(at, _)| at);
    (line + within) as u32
}
