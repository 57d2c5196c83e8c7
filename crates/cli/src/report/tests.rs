use super::*;

/// A problem at the first place where `mark` stands in `text`.
fn formatted(text: &str, mark: &str) -> String {
    let mut sources = Sources::default();
    let file = sources.add("a.pbrt", text);
    let start = text.find(mark).expect("the mark stands in the text");
    let span = Span { file, start: start as u32, end: (start + mark.len()) as u32 };
    let mut diagnostics = Diagnostics::default();
    diagnostics.error(span, "it is wrong").with_help("make it right");
    format(&diagnostics.list()[0], &sources, Style::Plain)
}

/// The place, the line, an underline as long as the place, and the help.
#[test]
fn located_message() {
    let expected = "\
a.pbrt:2:7: error: it is wrong
  2 | Shape \"spere\" 1
    |       ^^^^^^^
  help: make it right
";
    assert_eq!(formatted("WorldBegin\nShape \"spere\" 1\n", "\"spere\""), expected);
}

/// Columns count characters, and tabs take one column, so that the underline stays below its place.
#[test]
fn underline_follows_characters() {
    let text = formatted("\t\"größe\" é bad", "bad");
    assert!(text.starts_with("a.pbrt:1:12: error:"), "{text}");
    assert!(text.contains("  1 |  \"größe\" é bad\n    |            ^^^\n"), "{text}");
}

/// A mesh on one line does not flood the terminal.
#[test]
fn long_lines_are_cut() {
    let line = format!("{} bad {}", "1 ".repeat(50_000), "2 ".repeat(50_000));
    let text = formatted(&line, "bad");
    assert!(text.lines().all(|line| line.chars().count() < 120), "{text}");
    let (shown, under) = (text.lines().nth(1).expect("excerpt"), text.lines().nth(2).expect("underline"));
    let column = under.chars().position(|c| c == '^').expect("mark");
    assert_eq!(shown.chars().skip(column).take(3).collect::<String>(), "bad");
}

/// A place that spans lines is underlined up to the end of the first.
#[test]
fn place_of_several_lines() {
    let text = formatted("ab \"open\nnext", "\"open\nnext");
    assert!(text.contains("    |    ^^^^^\n"), "{text}");
}

/// The end of a file has a place but no line to show.
#[test]
fn end_of_an_empty_file() {
    let text = formatted("", "");
    assert_eq!(text, "a.pbrt:1:1: error: it is wrong\n  help: make it right\n");
}

/// Escape sequences in a file do not reach the terminal.
#[test]
fn control_characters_are_replaced() {
    assert!(!formatted("\u{1b}[31m bad", "bad").contains('\u{1b}'));
    assert_eq!(printable("a\u{7}b"), "a\u{fffd}b");
}

/// Numbers agree with their nouns.
#[test]
fn summaries() {
    assert_eq!(summary(1, 0), "1 error");
    assert_eq!(summary(2, 1), "2 errors and 1 warning");
    assert_eq!(summary(0, 70), "70 warnings, of which the first 50 are shown");
}
