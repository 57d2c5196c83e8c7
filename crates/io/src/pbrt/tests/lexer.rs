//! Numbers and strings.

use super::super::lexer::{Lexer, TokenKind, parse_float, parse_integer, unescape};

/// The short path for decimals rounds as the standard library does: every spelling gives the nearest number.
#[test]
fn floats_are_rounded_to_nearest() {
    let mut state = 1_u64;
    let mut next = || {
        state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        state >> 33
    };
    for _ in 0..200_000 {
        let digits = (next() % 1_000_000_000) >> (next() % 30);
        let text = match next() % 3 {
            0 => format!("{digits}"),
            1 => format!("-{}.{digits}", next() % 100),
            _ => format!(".{digits}"),
        };
        assert_eq!(parse_float(&text), text.parse().ok(), "{text}");
    }
}

/// A number is all of its word, in decimal, and finite.
#[test]
fn words_that_are_no_numbers() {
    for word in ["", "-", ".", "+", "1.2.3", "1e", "inf", "-inf", "nan", "NaN", "1e39", "0x10", "1,5", "--1"]
    {
        assert_eq!(parse_float(word), None, "{word}");
    }
    let numbers = [("5.", 5.0), (".5", 0.5), ("+2", 2.0), ("-0", 0.0), ("1e-3", 1e-3), ("1E+2", 100.0)];
    for (word, value) in numbers {
        assert_eq!(parse_float(word), Some(value), "{word}");
    }
    assert!(parse_float("-0").is_some_and(f32::is_sign_negative));
    assert_eq!(parse_integer("-2147483648"), Some(i32::MIN));
    assert_eq!(parse_integer("2147483648"), None);
    assert_eq!(parse_integer("3.0"), None);
}

/// Words end at blanks, brackets, quotes and comments.
#[test]
fn tokens() {
    let text = "\u{feff}Shape\t[1 2]#rest [ \"\n\"a \\\" b\"x \"open";
    let mut lexer = Lexer::new(text);
    let mut tokens = Vec::new();
    while let Some(token) = lexer.next() {
        tokens.push((token.kind, lexer.text(token)));
    }
    let expected = [
        (TokenKind::Word, "Shape"),
        (TokenKind::Open, "["),
        (TokenKind::Word, "1"),
        (TokenKind::Word, "2"),
        (TokenKind::Close, "]"),
        (TokenKind::Text, "\"a \\\" b\""),
        (TokenKind::Word, "x"),
        (TokenKind::UnterminatedText, "\"open"),
    ];
    assert_eq!(tokens, expected);
}

/// Strings have the escapes of C.
#[test]
fn escapes() {
    assert_eq!(unescape(r#""a\n\t\r\b\f\\\"\'z""#), Ok("a\n\t\r\u{8}\u{c}\\\"'z".into()));
    assert_eq!(unescape(r#""\q""#), Err('q'));
    assert_eq!(unescape("\"größe\""), Ok("größe".into()));
}
