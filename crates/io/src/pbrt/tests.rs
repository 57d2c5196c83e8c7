//! What the reader makes of texts: see the submodules.

mod directives;
mod errors;
mod files;
mod fuzz;
mod lexer;
mod parameters;
mod round_trip;

use std::path::Path;

use etendue_math::{Point3, Transform};
use etendue_scene::document::{Entity, Value};
use etendue_scene::{Diagnostics, Document, Severity};

use super::read_pbrt_str;

/// Reads a text that must have no problem at all.
#[track_caller]
fn read(text: &str) -> Document {
    let (document, diagnostics) = read_pbrt_str("test.pbrt", text, Path::new(""));
    let problems = listed(&document, &diagnostics);
    assert!(problems.is_empty(), "{problems:#?}");
    document
}

/// The same for directives that stand after `WorldBegin`.
#[track_caller]
fn read_world(text: &str) -> Document {
    read(&format!("WorldBegin\n{text}"))
}

/// All problems as `line:column: severity: message (help)`.
fn problems(text: &str) -> Vec<String> {
    let (document, diagnostics) = read_pbrt_str("test.pbrt", text, Path::new(""));
    listed(&document, &diagnostics)
}

fn listed(document: &Document, diagnostics: &Diagnostics) -> Vec<String> {
    let show = |problem: &etendue_scene::Diagnostic| {
        let severity = if problem.severity == Severity::Error { "error" } else { "warning" };
        let help = problem.help.as_ref().map(|help| format!(" ({help})")).unwrap_or_default();
        let place = problem.span.map_or_else(String::new, |span| {
            let location = document.sources.locate(span);
            format!("{}:{}: ", location.line, location.column)
        });
        format!("{place}{severity}: {}{help}", problem.message)
    };
    diagnostics.list().iter().map(show).collect()
}

/// Checks that there is exactly one problem.
#[track_caller]
fn check_problem(text: &str, expected: &str) {
    assert_eq!(problems(text), [expected], "problems of {text:?}");
}

/// The value of the parameter of that name.
#[track_caller]
fn value<'a>(entity: &'a Entity, name: &str) -> &'a Value {
    &entity.parameters.iter().find(|parameter| parameter.name == name).expect("the parameter is there").value
}

/// Checks where a transform takes a point.
#[track_caller]
fn check_point(transform: Transform, from: [f32; 3], to: [f32; 3]) {
    let p = transform.point(Point3::new(from[0], from[1], from[2]));
    let error = p.distance(Point3::new(to[0], to[1], to[2]));
    assert!(error < 1e-5, "{from:?} goes to {p:?} instead of {to:?}");
}
