//! Messages on standard error: located problems with an excerpt, and plain ones.
#![expect(clippy::print_stderr, reason = "this module is the way to standard error")]

use std::io::IsTerminal;

use ariadne::{Color, Config, IndexType, Label, Report, ReportKind, Source};
use etendue::scene::{Diagnostic, Diagnostics, Severity, Sources};

/// Says something that is neither error nor warning.
pub(crate) fn note(message: &str) {
    eprintln!("{message}");
}

/// Says that something failed.
pub(crate) fn error(message: &str) {
    eprintln!("error: {message}");
}

/// Says that something may not be as meant.
pub(crate) fn warning(message: &str) {
    eprintln!("warning: {message}");
}

/// Prints all problems, with `file:line:column`, an excerpt and how to mend them. Quiet leaves warnings out.
pub(crate) fn diagnostics(diagnostics: &Diagnostics, sources: &Sources, quiet: bool) {
    for diagnostic in diagnostics.list() {
        if !quiet || diagnostic.severity == Severity::Error {
            one(diagnostic, sources);
        }
    }
    let n_errors = diagnostics.list().iter().filter(|d| d.severity == Severity::Error).count();
    if n_errors > 0 {
        eprintln!("{n_errors} error{}", if n_errors == 1 { "" } else { "s" });
    }
}

/// Excerpts of files beyond this size would take longer to print than to read.
const MAX_EXCERPT_BYTES: usize = 16 << 20;

fn one(diagnostic: &Diagnostic, sources: &Sources) {
    let (kind, word, color) = match diagnostic.severity {
        Severity::Error => (ReportKind::Error, "error", Color::Red),
        Severity::Warning => (ReportKind::Warning, "warning", Color::Yellow),
    };
    let Some(span) = diagnostic.span else {
        plain(word, None, diagnostic);
        return;
    };
    let file = sources.file(span.file);
    let location = sources.locate(span).to_string();
    if file.text.len() > MAX_EXCERPT_BYTES || file.text.is_empty() {
        plain(word, Some(&location), diagnostic);
        return;
    }
    let range = span.start as usize..(span.end as usize).min(file.text.len()).max(span.start as usize);
    let id = file.name.as_str();
    let colored = std::io::stderr().is_terminal();
    let config = Config::default().with_index_type(IndexType::Byte).with_color(colored);
    let mut report = Report::build(kind, (id, range.clone()))
        .with_config(config)
        .with_message(format!("{} [{location}]", diagnostic.message))
        .with_label(Label::new((id, range)).with_color(color).with_message("here"));
    if let Some(help) = &diagnostic.help {
        report = report.with_help(help);
    }
    // Nothing is left to say if standard error itself is gone.
    let _ = report.finish().eprint((id, Source::from(&file.text)));
}

fn plain(word: &str, location: Option<&str>, diagnostic: &Diagnostic) {
    match location {
        Some(location) => eprintln!("{word}: {location}: {}", diagnostic.message),
        None => eprintln!("{word}: {}", diagnostic.message),
    }
    if let Some(help) = &diagnostic.help {
        eprintln!("  help: {help}");
    }
}
