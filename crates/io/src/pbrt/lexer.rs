//! Tokens of pbrt's text format, as ranges of bytes.
//!
//! A token is a bracket, a quoted string or a word (a directive, number or Boolean) that ends at blanks, quotes,
//! brackets or comments. Long lists of numbers never become tokens: [`Lexer::floats`] and [`Lexer::integers`] read
//! them straight into their vector.

use std::borrow::Cow;

/// What a token is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum TokenKind {
    /// A directive, number or Boolean.
    Word,
    /// A quoted string; the range includes the quotes.
    Text,
    /// A quoted string that its line or the file ends; the range includes the first quote.
    UnterminatedText,
    /// `[`
    Open,
    /// `]`
    Close,
}

/// A range of bytes with its kind.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Token {
    pub(super) kind: TokenKind,
    pub(super) start: usize,
    pub(super) end: usize,
}

/// Walks over the text of one file.
#[derive(Debug)]
pub(super) struct Lexer<'a> {
    text: &'a str,
    position: usize,
}

/// True for bytes that end a word.
static ENDS_WORD: [bool; 256] = {
    let mut table = [false; 256];
    let ends = b" \t\r\n\"[]#";
    let mut i = 0;
    while i < ends.len() {
        table[ends[i] as usize] = true;
        i += 1;
    }
    table
};

impl<'a> Lexer<'a> {
    pub(super) fn new(text: &'a str) -> Self {
        let position = if text.starts_with('\u{feff}') { '\u{feff}'.len_utf8() } else { 0 };
        Self { text, position }
    }

    /// The bytes of a token.
    pub(super) fn text(&self, token: Token) -> &'a str {
        self.text.get(token.start..token.end).expect("tokens begin and end at characters")
    }

    /// The next token; `None` at the end of the file.
    pub(super) fn next(&mut self) -> Option<Token> {
        self.skip_blanks();
        let start = self.position;
        let first = *self.text.as_bytes().get(start)?;
        let (kind, end) = match first {
            b'"' => self.scan_text(start),
            b'[' => (TokenKind::Open, start + 1),
            b']' => (TokenKind::Close, start + 1),
            _ => (TokenKind::Word, self.word_end(start)),
        };
        self.position = end;
        Some(Token { kind, start, end })
    }

    /// The next token, which stays the next one.
    pub(super) fn peek(&mut self) -> Option<Token> {
        let token = self.next()?;
        self.unread(token);
        Some(token)
    }

    /// Makes `token` the next one again.
    pub(super) const fn unread(&mut self, token: Token) {
        self.position = token.start;
    }

    /// Appends the numbers that follow, up to the first token that is none.
    pub(super) fn floats(&mut self, values: &mut Vec<f32>) {
        while let Some(value) = self.scan_value(parse_float) {
            values.push(value);
        }
    }

    /// Appends the integers that follow, up to the first token that is none.
    pub(super) fn integers(&mut self, values: &mut Vec<i32>) {
        while let Some(value) = self.scan_value(parse_integer) {
            values.push(value);
        }
    }

    #[inline]
    fn scan_value<T>(&mut self, parse: impl Fn(&str) -> Option<T>) -> Option<T> {
        self.skip_blanks();
        let start = self.position;
        let first = *self.text.as_bytes().get(start)?;
        if !matches!(first, b'0'..=b'9' | b'-' | b'.' | b'+') {
            return None;
        }
        let end = self.word_end(start);
        let value = parse(self.text.get(start..end)?)?;
        self.position = end;
        Some(value)
    }

    #[inline]
    fn skip_blanks(&mut self) {
        let bytes = self.text.as_bytes();
        while let Some(&byte) = bytes.get(self.position) {
            match byte {
                b' ' | b'\t' | b'\r' | b'\n' => self.position += 1,
                b'#' => {
                    let rest = &bytes[self.position..];
                    let length = rest.iter().position(|b| matches!(b, b'\n' | b'\r')).unwrap_or(rest.len());
                    self.position += length;
                }
                _ => return,
            }
        }
    }

    #[inline]
    fn word_end(&self, start: usize) -> usize {
        let rest = &self.text.as_bytes()[start..];
        start + rest.iter().position(|b| ENDS_WORD[usize::from(*b)]).unwrap_or(rest.len())
    }

    fn scan_text(&self, start: usize) -> (TokenKind, usize) {
        let bytes = self.text.as_bytes();
        let mut i = start + 1;
        while let Some(&byte) = bytes.get(i) {
            match byte {
                b'"' => return (TokenKind::Text, i + 1),
                b'\n' => return (TokenKind::UnterminatedText, i),
                b'\\' if bytes.get(i + 1).is_some_and(|b| *b != b'\n') => i += 2,
                _ => i += 1,
            }
        }
        (TokenKind::UnterminatedText, bytes.len())
    }
}

/// The number that is the whole of `word`, rounded correctly; `None` if it is none or overflows.
#[inline]
pub(super) fn parse_float(word: &str) -> Option<f32> {
    short_decimal(word.as_bytes()).or_else(|| long_decimal(word))
}

/// Numbers of few digits without exponent. Both mantissa and power of ten are exact, so one division rounds once
/// (Clinger 1990, "How to Read Floating Point Numbers Accurately").
#[inline]
fn short_decimal(word: &[u8]) -> Option<f32> {
    const POWERS: [f32; 11] = [1e0, 1e1, 1e2, 1e3, 1e4, 1e5, 1e6, 1e7, 1e8, 1e9, 1e10];
    let (negative, digits) = match word {
        [b'-', rest @ ..] => (true, rest),
        _ => (false, word),
    };
    if digits.is_empty() || digits.len() > 10 {
        return None;
    }
    let (mut mantissa, mut n_digits, mut point) = (0_u32, 0_usize, None);
    for (i, &byte) in digits.iter().enumerate() {
        match byte {
            b'0'..=b'9' => {
                mantissa = mantissa.wrapping_mul(10).wrapping_add(u32::from(byte - b'0'));
                n_digits += 1;
            }
            b'.' if point.is_none() => point = Some(i),
            _ => return None,
        }
    }
    // Nine digits cannot wrap around.
    if n_digits == 0 || n_digits > 9 || mantissa > 1 << 24 {
        return None;
    }
    let n_decimals = point.map_or(0, |i| digits.len() - 1 - i);
    let value = mantissa as f32 / POWERS[n_decimals];
    Some(if negative { -value } else { value })
}

fn long_decimal(word: &str) -> Option<f32> {
    let digits = word.strip_prefix(['-', '+']).unwrap_or(word);
    // Excludes what `parse` also takes: `inf` and `nan`.
    if !digits.starts_with(|c: char| c.is_ascii_digit() || c == '.') {
        return None;
    }
    word.parse::<f32>().ok().filter(|value| value.is_finite())
}

/// The integer that is the whole of `word`; `None` if it is none or does not fit.
#[inline]
pub(super) fn parse_integer(word: &str) -> Option<i32> {
    word.parse().ok()
}

/// The content of a [`TokenKind::Text`] or [`TokenKind::UnterminatedText`], or the escape that does not exist.
pub(super) fn unescape(quoted: &str) -> Result<Cow<'_, str>, char> {
    let inner = quoted.strip_prefix('"').unwrap_or(quoted);
    if !inner.contains('\\') {
        return Ok(Cow::Borrowed(inner.strip_suffix('"').unwrap_or(inner)));
    }
    let mut content = String::with_capacity(inner.len());
    let mut characters = inner.chars();
    while let Some(c) = characters.next() {
        match c {
            '"' => break,
            '\\' => content.push(match characters.next() {
                Some('b') => '\u{8}',
                Some('f') => '\u{c}',
                Some('n') => '\n',
                Some('r') => '\r',
                Some('t') => '\t',
                Some(same @ ('\\' | '\'' | '"')) => same,
                Some(other) => return Err(other),
                None => break,
            }),
            c => content.push(c),
        }
    }
    Ok(Cow::Owned(content))
}
