//! The lines of an OBJ file (Wavefront, "Object Files", appendix B1 of the Advanced Visualizer manual): vertices, faces
//! and what material and smoothing group they have.

use std::collections::HashMap;

use etendue_math::{Normal3, Point2, Point3};
use etendue_scene::diagnostics::FileId;
use etendue_scene::{Diagnostics, Span};

/// Problems that are reported one by one; what follows is not read.
const MAX_PROBLEMS: usize = 20;

/// No index of a corner.
pub(super) const NONE: u32 = u32::MAX;

/// A corner of a face by its indices from 0; [`NONE`] for what it lacks.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Corner {
    pub(super) position: u32,
    pub(super) uv: u32,
    pub(super) normal: u32,
}

/// A polygon.
#[derive(Clone, Copy, Debug)]
pub(super) struct Face {
    /// Its first corner in [`ObjFile::corners`]; the next face's first is its end.
    pub(super) first: u32,
    /// Index into [`ObjFile::materials`].
    pub(super) material: u32,
    /// Smoothing group; 0 for none.
    pub(super) group: u32,
}

/// A name with its place.
#[derive(Clone, Debug)]
pub(super) struct Name {
    pub(super) text: String,
    pub(super) span: Span,
}

/// What a file holds.
#[derive(Debug, Default)]
pub(super) struct ObjFile {
    pub(super) positions: Vec<Point3>,
    pub(super) uvs: Vec<Point2>,
    pub(super) normals: Vec<Normal3>,
    pub(super) corners: Vec<Corner>,
    pub(super) faces: Vec<Face>,
    /// Names of materials in the order of their first use; the first, empty, is that of faces before any `usemtl`.
    pub(super) materials: Vec<Name>,
    /// True if the file says what is smooth.
    pub(super) has_smoothing: bool,
    /// What `mtllib` names.
    pub(super) libraries: Vec<Name>,
}

impl ObjFile {
    /// The corners of a face.
    pub(super) fn corners_of(&self, face: usize) -> &[Corner] {
        let end = self.faces.get(face + 1).map_or(self.corners.len(), |next| next.first as usize);
        &self.corners[self.faces[face].first as usize..end]
    }
}

/// Reads the lines; problems have places in `file`.
pub(super) fn parse(text: &str, file: FileId, diagnostics: &mut Diagnostics) -> ObjFile {
    let none = Name { text: String::new(), span: Span { file, start: 0, end: 0 } };
    let obj = ObjFile { materials: vec![none], ..ObjFile::default() };
    let mut parser = Parser {
        obj,
        diagnostics,
        line: Line { file, start: 0, text: "" },
        material: 0,
        group: 0,
        n_problems: 0,
        known_materials: HashMap::from([(String::new(), 0)]),
        skipped: Vec::new(),
    };
    let mut start = 0;
    for text in text.split_inclusive('\n') {
        parser.line = Line { file, start, text };
        parser.read_line();
        start += text.len();
        if parser.n_problems >= MAX_PROBLEMS {
            break;
        }
    }
    parser.obj
}

/// The line that is read.
#[derive(Clone, Copy)]
struct Line<'t> {
    file: FileId,
    start: usize,
    text: &'t str,
}

impl Line<'_> {
    fn span(&self) -> Span {
        let end = self.start + self.text.trim_end().len();
        Span { file: self.file, start: self.start as u32, end: end as u32 }
    }
}

struct Parser<'d, 't> {
    obj: ObjFile,
    diagnostics: &'d mut Diagnostics,
    line: Line<'t>,
    material: u32,
    group: u32,
    n_problems: usize,
    /// Indices of materials by their names.
    known_materials: HashMap<String, u32>,
    /// Keywords that were reported as skipped.
    skipped: Vec<&'t str>,
}

impl<'t> Parser<'_, 't> {
    fn read_line(&mut self) {
        let text: &'t str = self.line.text;
        let content = text.split('#').next().unwrap_or_default();
        let mut words = content.split_ascii_whitespace();
        let Some(keyword) = words.next() else { return };
        let named = || Name { text: name_after(text, keyword).to_owned(), span: self.line.span() };
        match keyword {
            "v" => {
                if let Some([x, y, z]) = self.numbers(words) {
                    self.obj.positions.push(Point3::new(x, y, z));
                }
            }
            "vt" => {
                // The second coordinate may be left out.
                if let Some([u, v]) = self.numbers(words.chain(["0"])) {
                    self.obj.uvs.push(Point2::new(u, v));
                }
            }
            "vn" => {
                if let Some([x, y, z]) = self.numbers(words) {
                    self.obj.normals.push(Normal3::new(x, y, z));
                }
            }
            "f" | "fo" => self.face(words),
            "usemtl" => {
                let name = named();
                self.use_material(name);
            }
            "mtllib" => {
                let name = named();
                self.obj.libraries.push(name);
            }
            "s" => {
                self.obj.has_smoothing = true;
                self.group = words.next().and_then(|word| word.parse().ok()).unwrap_or(0);
            }
            // Names, curves that nothing shows, and settings of programs of old.
            "g" | "o" | "vp" | "l" | "p" | "lod" | "mg" | "bevel" | "c_interp" | "d_interp"
            | "shadow_obj" | "trace_obj" | "maplib" | "usemap" => {}
            other => self.skip(other),
        }
    }

    fn error(&mut self, message: impl Into<String>) {
        self.n_problems += 1;
        let span = self.line.span();
        self.diagnostics.error(span, message);
        if self.n_problems == MAX_PROBLEMS {
            self.diagnostics.error(span, "there are too many problems; the rest of the file is not read");
        }
    }

    /// Free-form surfaces, and what nobody knows.
    fn skip(&mut self, keyword: &'t str) {
        if self.skipped.contains(&keyword) || self.skipped.len() >= MAX_PROBLEMS {
            return;
        }
        self.skipped.push(keyword);
        let shown: String = keyword.chars().take(20).collect();
        let message = format!("`{shown}` is not known; such lines are skipped");
        self.diagnostics.warning(self.line.span(), message);
    }

    fn numbers<'w, const N: usize>(&mut self, mut words: impl Iterator<Item = &'w str>) -> Option<[f32; N]> {
        let mut numbers = [0.0; N];
        for number in &mut numbers {
            let Some(word) = words.next() else {
                self.error(format!("this line should have {N} numbers"));
                return None;
            };
            match word.parse::<f32>() {
                Ok(value) if value.is_finite() => *number = value,
                _ => {
                    self.error(format!("`{word}` is not a number"));
                    return None;
                }
            }
        }
        Some(numbers)
    }

    fn face<'w>(&mut self, words: impl Iterator<Item = &'w str>) {
        let first = self.obj.corners.len();
        for word in words {
            match self.corner(word) {
                Ok(corner) => self.obj.corners.push(corner),
                Err(why) => {
                    self.obj.corners.truncate(first);
                    self.error(why);
                    return;
                }
            }
        }
        if self.obj.corners.len() - first < 3 {
            self.obj.corners.truncate(first);
            self.error("a face has at least three corners");
            return;
        }
        self.obj.faces.push(Face { first: first as u32, material: self.material, group: self.group });
    }

    /// `7`, `7/1`, `7//3` or `7/1/3`.
    fn corner(&self, word: &str) -> Result<Corner, String> {
        let obj = &self.obj;
        let mut parts = word.split('/');
        let mut part = |what: &str, count: usize| match parts.next() {
            None | Some("") => Ok(NONE),
            Some(text) => index(text, what, count),
        };
        let position = part("vertex", obj.positions.len())?;
        let uv = part("texture coordinate", obj.uvs.len())?;
        let normal = part("normal", obj.normals.len())?;
        if position == NONE || parts.next().is_some() {
            return Err(format!("`{word}` is no corner as in `7/1/3`"));
        }
        Ok(Corner { position, uv, normal })
    }

    fn use_material(&mut self, name: Name) {
        let next = self.obj.materials.len() as u32;
        self.material = *self.known_materials.entry(name.text.clone()).or_insert(next);
        if self.material == next {
            self.obj.materials.push(name);
        }
    }
}

/// An index from 0 of one that counts from 1, or from the end if negative.
fn index(text: &str, what: &str, count: usize) -> Result<u32, String> {
    let number: i64 = text.parse().map_err(|_| format!("`{text}` is not an index"))?;
    let found = if number < 0 { number.checked_add(count as i64) } else { number.checked_sub(1) };
    match found.and_then(|index| u32::try_from(index).ok()) {
        Some(index) if (index as usize) < count && index != NONE => Ok(index),
        _ => Err(format!("there is no {what} {number}: {count} come before this face")),
    }
}

/// The name that follows the keyword of a line: in it `#` begins a comment only after white space.
pub(super) fn name_after<'t>(line: &'t str, keyword: &str) -> &'t str {
    let rest = rest_of(line, keyword);
    let comment = rest.match_indices('#').find(|(at, _)| rest[..*at].ends_with([' ', '\t']));
    comment.map_or(rest, |(at, _)| rest[..at].trim_end())
}

/// What follows the keyword, with spaces within.
pub(super) fn rest_of<'t>(content: &'t str, keyword: &str) -> &'t str {
    content.trim_start().strip_prefix(keyword).unwrap_or_default().trim()
}
