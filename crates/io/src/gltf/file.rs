//! The JSON of a glTF file as readers see it: typed access that reports what is wrong with its place.

use std::cell::{Cell, RefCell};

use etendue_scene::diagnostics::{FileId, Span};
use etendue_scene::{Diagnostics, Severity};

use crate::json::{Json, Kind};

/// Problems of one severity after which further ones are only counted.
const MAX_PROBLEMS: usize = 50;

/// The JSON with the problems found in it.
#[derive(Debug)]
pub(super) struct File<'a> {
    pub(super) root: &'a Json,
    problems: RefCell<Diagnostics>,
    /// Errors and warnings so far, with those left out.
    counts: [Cell<usize>; 2],
}

/// The place of a value.
pub(super) fn span(value: &Json) -> Span {
    Span { file: FileId(0), start: value.start, end: value.end }
}

impl<'a> File<'a> {
    pub(super) fn new(root: &'a Json) -> Self {
        Self { root, problems: RefCell::default(), counts: [Cell::new(0), Cell::new(0)] }
    }

    pub(super) fn into_problems(self) -> Diagnostics {
        let mut problems = self.problems.into_inner();
        let left_out = self.counts.map(|count| count.get().saturating_sub(MAX_PROBLEMS));
        if left_out != [0, 0] {
            let [errors, warnings] = left_out;
            problems.warning(None, format!("{errors} more errors and {warnings} more warnings are left out"));
        }
        problems
    }

    fn report(&self, severity: Severity, at: &Json, message: &str, help: Option<&str>) {
        let count = &self.counts[usize::from(severity == Severity::Warning)];
        count.set(count.get() + 1);
        if count.get() > MAX_PROBLEMS {
            return;
        }
        let pointer = self.root.pointer(at.start);
        let message = if pointer.is_empty() { message.to_owned() } else { format!("{pointer}: {message}") };
        let mut problems = self.problems.borrow_mut();
        let problem = match severity {
            Severity::Error => problems.error(span(at), message),
            Severity::Warning => problems.warning(span(at), message),
        };
        problem.help = help.map(str::to_owned);
    }

    /// Reports an error at a value, with the pointer to it.
    pub(super) fn error(&self, at: &Json, message: impl AsRef<str>) {
        self.report(Severity::Error, at, message.as_ref(), None);
    }

    pub(super) fn error_with_help(&self, at: &Json, message: impl AsRef<str>, help: &str) {
        self.report(Severity::Error, at, message.as_ref(), Some(help));
    }

    /// Reports a warning at a value, with the pointer to it.
    pub(super) fn warning(&self, at: &Json, message: impl AsRef<str>) {
        self.report(Severity::Warning, at, message.as_ref(), None);
    }

    fn wrong_type(&self, at: &Json, expected: &str) {
        self.error(at, format!("{expected} is expected, not {}", at.kind.name()));
    }

    /// The items of an array member; none if there is no such member.
    pub(super) fn array<'j>(&self, object: &'j Json, name: &str) -> &'j [Json] {
        match object.get(name) {
            Some(Json { kind: Kind::Array(items), .. }) => items,
            Some(other) => {
                self.wrong_type(other, "an array");
                &[]
            }
            None => &[],
        }
    }

    /// An object member.
    pub(super) fn object<'j>(&self, object: &'j Json, name: &str) -> Option<&'j Json> {
        let value = object.get(name)?;
        if matches!(value.kind, Kind::Object(_)) {
            return Some(value);
        }
        self.wrong_type(value, "an object");
        None
    }

    pub(super) fn string<'j>(&self, object: &'j Json, name: &str) -> Option<&'j str> {
        match object.get(name)? {
            Json { kind: Kind::String(text), .. } => Some(text),
            other => {
                self.wrong_type(other, "a string");
                None
            }
        }
    }

    pub(super) fn bool(&self, object: &Json, name: &str) -> bool {
        match object.get(name) {
            Some(Json { kind: Kind::Bool(truth), .. }) => *truth,
            Some(other) => {
                self.wrong_type(other, "true or false");
                false
            }
            None => false,
        }
    }

    /// A value as a number that single precision can hold.
    pub(super) fn as_float(&self, value: &Json) -> Option<f32> {
        let Kind::Number(number) = value.kind else {
            self.wrong_type(value, "a number");
            return None;
        };
        if (number as f32).is_finite() {
            return Some(number as f32);
        }
        self.error(value, "the number is too large");
        None
    }

    pub(super) fn float_opt(&self, object: &Json, name: &str) -> Option<f32> {
        self.as_float(object.get(name)?)
    }

    pub(super) fn float(&self, object: &Json, name: &str, default: f32) -> f32 {
        self.float_opt(object, name).unwrap_or(default)
    }

    /// An array of N numbers.
    pub(super) fn floats<const N: usize>(&self, object: &Json, name: &str) -> Option<[f32; N]> {
        let value = object.get(name)?;
        let Kind::Array(items) = &value.kind else {
            self.wrong_type(value, &format!("an array of {N} numbers"));
            return None;
        };
        if items.len() != N {
            self.error(value, format!("{N} numbers are expected, not {}", items.len()));
            return None;
        }
        let mut numbers = [0.0; N];
        for (number, item) in numbers.iter_mut().zip(items) {
            *number = self.as_float(item)?;
        }
        Some(numbers)
    }

    /// A value as a count or an index.
    pub(super) fn as_size(&self, value: &Json) -> Option<usize> {
        match value.kind {
            Kind::Number(n) if n >= 0.0 && n.fract() == 0.0 && n < 9e15 => usize::try_from(n as u64).ok(),
            Kind::Number(_) => {
                self.error(value, "a whole number from 0 is expected");
                None
            }
            _ => {
                self.wrong_type(value, "a whole number");
                None
            }
        }
    }

    pub(super) fn size_opt(&self, object: &Json, name: &str) -> Option<usize> {
        self.as_size(object.get(name)?)
    }

    pub(super) fn size(&self, object: &Json, name: &str, default: usize) -> usize {
        self.size_opt(object, name).unwrap_or(default)
    }

    /// A member that must be there.
    pub(super) fn required<'j>(&self, object: &'j Json, name: &str) -> Option<&'j Json> {
        let value = object.get(name);
        if value.is_none() {
            self.error(object, format!("\"{name}\" is missing"));
        }
        value
    }

    /// Item `index` of the top-level array `list`, where `at` says so.
    pub(super) fn item(&self, at: &Json, list: &str, index: usize) -> Option<&'a Json> {
        let items = self.root.get(list).map_or(&[][..], Json::items);
        let item = items.get(index);
        if item.is_none() {
            let n = items.len();
            self.error(at, format!("{index} is no index into \"{list}\", which has {n} items"));
        }
        item
    }

    /// The member `name` as an index into the top-level array `list`, with the item.
    pub(super) fn reference(&self, object: &Json, name: &str, list: &str) -> Option<(usize, &'a Json)> {
        let at = object.get(name)?;
        let index = self.as_size(at)?;
        Some((index, self.item(at, list, index)?))
    }

    /// What an extension says of an object.
    pub(super) fn extension<'j>(&self, object: &'j Json, name: &str) -> Option<&'j Json> {
        self.object(self.object(object, "extensions")?, name)
    }
}
