//! Messages on standard error: located problems with an excerpt, and plain ones.
//!
//! A located message begins with `file:line:column: error:`, as compilers write it, so that editors find the place;
//! the line itself follows with the place underlined, and then how to mend it.

use std::fmt::Write;
use std::io::IsTerminal;
use std::io::Write as _;

use etendue::scene::{Diagnostic, Diagnostics, Severity, Sources, Span};

#[cfg(test)]
mod tests;

/// Writes to standard error. Where that is gone, nothing is left to say, but a render still goes on.
fn say(text: &str) {
    let _ = std::io::stderr().write_all(text.as_bytes());
}

/// Says something that is neither error nor warning.
pub(crate) fn note(message: &str) {
    say(&format!("{}\n", printable(message)));
}

/// Says that something failed.
pub(crate) fn error(message: &str) {
    say(&format!("{}: {}\n", style().word(Severity::Error), printable(message)));
}

/// Says that something may not be as meant.
pub(crate) fn warning(message: &str) {
    say(&format!("{}: {}\n", style().word(Severity::Warning), printable(message)));
}

/// Says how many pixels of a picture are not finite, if any, and what becomes of them.
pub(crate) fn non_finite<const N: usize>(name: &str, pixels: &[[f32; N]], fate: &str) {
    let n = pixels.iter().filter(|pixel| !pixel.iter().all(|value| value.is_finite())).count();
    if n > 0 {
        let are = if n == 1 { "is" } else { "are" };
        warning(&format!("{name}: {n} of {} pixels {are} not finite; {fate}", pixels.len()));
    }
}

/// More messages than this of one severity help nobody.
const MAX_MESSAGES: usize = 50;

/// Prints all problems in the order of their places, and their number. Quiet leaves warnings out.
pub(crate) fn diagnostics(diagnostics: &Diagnostics, sources: &Sources, quiet: bool) {
    let style = style();
    let mut counts = [0_usize; 2];
    let mut list: Vec<&Diagnostic> = diagnostics.list().iter().collect();
    list.sort_by_key(|d| d.span.map(|span| (span.file.0, span.start)));
    for diagnostic in list {
        if quiet && diagnostic.severity == Severity::Warning {
            continue;
        }
        let count = &mut counts[usize::from(diagnostic.severity == Severity::Warning)];
        *count += 1;
        if *count <= MAX_MESSAGES {
            say(&format(diagnostic, sources, style));
        }
    }
    let [errors, warnings] = counts;
    if errors > 0 || warnings > MAX_MESSAGES {
        say(&format!("{}\n", summary(errors, warnings)));
    }
}

fn summary(errors: usize, warnings: usize) -> String {
    let count = |n: usize, word: &str| match n {
        0 => None,
        1 => Some(format!("1 {word}")),
        n if n > MAX_MESSAGES => Some(format!("{n} {word}s, of which the first {MAX_MESSAGES} are shown")),
        n => Some(format!("{n} {word}s")),
    };
    let counts = [count(errors, "error"), count(warnings, "warning")];
    counts.into_iter().flatten().collect::<Vec<_>>().join(" and ")
}

/// Whether messages are coloured.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Style {
    Plain,
    Colored,
}

/// Colours only for a terminal, and not where <https://no-color.org> says so.
fn style() -> Style {
    let refuses = std::env::var_os("NO_COLOR").is_some_and(|value| !value.is_empty());
    if std::io::stderr().is_terminal() && !refuses { Style::Colored } else { Style::Plain }
}

impl Style {
    fn word(self, severity: Severity) -> &'static str {
        match (severity, self) {
            (Severity::Error, Self::Plain) => "error",
            (Severity::Warning, Self::Plain) => "warning",
            (Severity::Error, Self::Colored) => "\x1b[1;31merror\x1b[0m",
            (Severity::Warning, Self::Colored) => "\x1b[1;33mwarning\x1b[0m",
        }
    }
}

/// One problem as lines of text.
fn format(diagnostic: &Diagnostic, sources: &Sources, style: Style) -> String {
    let word = style.word(diagnostic.severity);
    let message = printable(&diagnostic.message);
    let mut text = String::new();
    // Writing to a string cannot fail.
    let _ = match diagnostic.span {
        Some(span) => writeln!(text, "{}: {word}: {message}", printable(&sources.locate(span).to_string())),
        None => writeln!(text, "{word}: {message}"),
    };
    if let Some(span) = diagnostic.span {
        text.push_str(&excerpt(span, sources));
    }
    if let Some(help) = &diagnostic.help {
        let _ = writeln!(text, "  help: {}", printable(help));
    }
    text
}

/// Characters of a line that are shown, and how many of them before the place.
const EXCERPT_WIDTH: usize = 100;
const EXCERPT_BEFORE: usize = 40;

/// The line with the place underlined; of a long line, the part around the place.
fn excerpt(span: Span, sources: &Sources) -> String {
    let location = sources.locate(span);
    if location.excerpt.trim().is_empty() {
        return String::new();
    }
    let line: Vec<char> = location.excerpt.chars().map(visible).collect();
    let column = (location.column - 1).min(line.len());
    let marked = sources.file(span.file).text.get(span.start as usize..span.end as usize).unwrap_or("");
    let marked = marked.lines().next().unwrap_or("").chars().count().clamp(1, (line.len() - column).max(1));

    let start = if line.len() > EXCERPT_WIDTH { column.saturating_sub(EXCERPT_BEFORE) } else { 0 };
    let end = line.len().min(start + EXCERPT_WIDTH);
    let (before, after) = (if start > 0 { "…" } else { "" }, if end < line.len() { "…" } else { "" });
    let shown: String = line[start..end].iter().collect();
    let number = location.line.to_string();
    let gutter = " ".repeat(number.len());
    let indent = " ".repeat(column - start + before.chars().count());
    let underline = "^".repeat(marked.min(end.max(column + 1) - column));
    format!("  {number} | {before}{shown}{after}\n  {gutter} | {indent}{underline}\n")
}

/// Text from files and arguments, so that no control character reaches a terminal.
fn printable(text: &str) -> String {
    text.chars().map(|c| if c == '\n' { c } else { visible(c) }).collect()
}

/// One cell for a character: tabs become blanks, other control characters a replacement.
fn visible(c: char) -> char {
    match c {
        '\t' => ' ',
        c if c.is_control() => char::REPLACEMENT_CHARACTER,
        c => c,
    }
}
