//! JSON (RFC 8259) whose values know their place in the text, so that what is wrong with one can be shown where it stands.
//!
//! `serde_json` tells line and column of broken syntax alone. Simplified: of equal names in an object the first counts,
//! and numbers are `f64`.

use std::fmt;

#[cfg(test)]
mod tests;

/// Objects and arrays inside of each other.
const MAX_DEPTH: usize = 128;

/// A value with its place.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Json {
    /// First byte in the text.
    pub(crate) start: u32,
    /// One past the last byte.
    pub(crate) end: u32,
    /// What it is.
    pub(crate) kind: Kind,
}

/// A value.
#[derive(Clone, Debug, PartialEq)]
pub(crate) enum Kind {
    Null,
    Bool(bool),
    Number(f64),
    String(Box<str>),
    Array(Vec<Json>),
    Object(Vec<(Box<str>, Json)>),
}

impl Kind {
    /// With an article, for messages.
    pub(crate) const fn name(&self) -> &'static str {
        match self {
            Self::Null => "null",
            Self::Bool(_) => "a truth value",
            Self::Number(_) => "a number",
            Self::String(_) => "a string",
            Self::Array(_) => "an array",
            Self::Object(_) => "an object",
        }
    }
}

/// Why and where a text is not JSON.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct JsonError {
    /// The byte of the text.
    pub(crate) at: u32,
    /// What is wrong.
    pub(crate) message: String,
}

impl fmt::Display for JsonError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.message)
    }
}

impl Json {
    /// Reads a text of at most 4 GiB that holds one value.
    ///
    /// # Errors
    /// At the first byte that cannot be.
    pub(crate) fn parse(text: &str) -> Result<Self, JsonError> {
        let mut parser = Parser { text, at: 0 };
        let value = parser.value(0)?;
        parser.skip_space();
        if parser.at < text.len() {
            return Err(parser.error("the text goes on after its value"));
        }
        Ok(value)
    }

    /// The member of that name; `None` if there is none, it is null, or this is no object.
    pub(crate) fn get(&self, name: &str) -> Option<&Self> {
        let Kind::Object(members) = &self.kind else { return None };
        let value = &members.iter().find(|(known, _)| **known == *name)?.1;
        (value.kind != Kind::Null).then_some(value)
    }

    /// The items of an array; empty for anything else.
    pub(crate) fn items(&self) -> &[Self] {
        match &self.kind {
            Kind::Array(items) => items,
            _ => &[],
        }
    }

    /// The path to the value that starts at that byte (RFC 6901), as far as it can be followed.
    pub(crate) fn pointer(&self, start: u32) -> String {
        let (mut path, mut here) = (String::new(), self);
        while here.start != start {
            let holds = |value: &Self| value.start <= start && start < value.end;
            let next = match &here.kind {
                Kind::Array(items) => {
                    let index = items.partition_point(|item| item.end <= start);
                    items.get(index).filter(|item| holds(item)).map(|item| (index.to_string(), item))
                }
                Kind::Object(members) => {
                    let index = members.partition_point(|(_, value)| value.end <= start);
                    let found = members.get(index).filter(|(_, value)| holds(value));
                    found.map(|(name, value)| (name.replace('~', "~0").replace('/', "~1"), value))
                }
                _ => None,
            };
            let Some((step, value)) = next else { break };
            path.push('/');
            path.push_str(&step);
            here = value;
        }
        path
    }
}

struct Parser<'t> {
    text: &'t str,
    at: usize,
}

impl Parser<'_> {
    fn error(&self, message: impl Into<String>) -> JsonError {
        JsonError { at: self.at as u32, message: message.into() }
    }

    fn peek(&self) -> Option<u8> {
        self.text.as_bytes().get(self.at).copied()
    }

    fn skip_space(&mut self) {
        while let Some(b' ' | b'\t' | b'\r' | b'\n') = self.peek() {
            self.at += 1;
        }
    }

    /// Passes the byte if it comes next.
    fn accept(&mut self, byte: u8) -> bool {
        let found = self.peek() == Some(byte);
        self.at += usize::from(found);
        found
    }

    fn value(&mut self, depth: usize) -> Result<Json, JsonError> {
        if depth > MAX_DEPTH {
            return Err(self.error(format!("more than {MAX_DEPTH} arrays and objects inside of each other")));
        }
        self.skip_space();
        let start = self.at as u32;
        let kind = match self.peek() {
            Some(b'{') => self.object(depth)?,
            Some(b'[') => self.array(depth)?,
            Some(b'"') => Kind::String(self.string()?),
            Some(b'-' | b'0'..=b'9') => Kind::Number(self.number()?),
            Some(_) => self.word()?,
            None => return Err(self.error("the text ends where a value is expected")),
        };
        Ok(Json { start, end: self.at as u32, kind })
    }

    fn word(&mut self) -> Result<Kind, JsonError> {
        for (word, kind) in [("true", Kind::Bool(true)), ("false", Kind::Bool(false)), ("null", Kind::Null)] {
            if self.text.as_bytes()[self.at..].starts_with(word.as_bytes()) {
                self.at += word.len();
                return Ok(kind);
            }
        }
        Err(self.error("a value is expected"))
    }

    fn array(&mut self, depth: usize) -> Result<Kind, JsonError> {
        self.at += 1;
        let mut items = Vec::new();
        self.skip_space();
        if self.accept(b']') {
            return Ok(Kind::Array(items));
        }
        loop {
            items.push(self.value(depth + 1)?);
            self.skip_space();
            if self.accept(b']') {
                items.shrink_to_fit();
                return Ok(Kind::Array(items));
            }
            if !self.accept(b',') {
                return Err(self.error("`,` or `]` is expected"));
            }
        }
    }

    fn object(&mut self, depth: usize) -> Result<Kind, JsonError> {
        self.at += 1;
        let mut members = Vec::new();
        self.skip_space();
        if self.accept(b'}') {
            return Ok(Kind::Object(members));
        }
        loop {
            self.skip_space();
            if self.peek() != Some(b'"') {
                return Err(self.error("a name in quotes is expected"));
            }
            let name = self.string()?;
            self.skip_space();
            if !self.accept(b':') {
                return Err(self.error("`:` is expected"));
            }
            members.push((name, self.value(depth + 1)?));
            self.skip_space();
            if self.accept(b'}') {
                return Ok(Kind::Object(members));
            }
            if !self.accept(b',') {
                return Err(self.error("`,` or `}` is expected"));
            }
        }
    }

    fn digits(&mut self) -> Result<(), JsonError> {
        let start = self.at;
        while let Some(b'0'..=b'9') = self.peek() {
            self.at += 1;
        }
        if self.at == start { Err(self.error("a digit is expected")) } else { Ok(()) }
    }

    fn number(&mut self) -> Result<f64, JsonError> {
        let start = self.at;
        self.accept(b'-');
        if !self.accept(b'0') {
            self.digits()?;
        }
        if self.accept(b'.') {
            self.digits()?;
        }
        if self.accept(b'e') || self.accept(b'E') {
            if !self.accept(b'+') {
                self.accept(b'-');
            }
            self.digits()?;
        }
        self.text[start..self.at].parse().map_err(|_| self.error("a number is expected"))
    }

    /// The text between quotes.
    fn string(&mut self) -> Result<Box<str>, JsonError> {
        let bytes = self.text.as_bytes();
        let opened = self.at;
        self.at += 1;
        let mut content = String::new();
        loop {
            let start = self.at;
            while bytes.get(self.at).is_some_and(|byte| !matches!(byte, b'"' | b'\\' | 0..0x20)) {
                self.at += 1;
            }
            content.push_str(&self.text[start..self.at]);
            match bytes.get(self.at) {
                Some(b'"') => {
                    self.at += 1;
                    return Ok(content.into_boxed_str());
                }
                Some(b'\\') => content.push(self.escape()?),
                Some(_) => return Err(self.error("a control character in a string")),
                None => {
                    return Err(JsonError { at: opened as u32, message: "the string has no end".to_owned() });
                }
            }
        }
    }

    /// The character that a backslash begins.
    fn escape(&mut self) -> Result<char, JsonError> {
        let known = [
            (b'"', '"'),
            (b'\\', '\\'),
            (b'/', '/'),
            (b'b', '\u{8}'),
            (b'f', '\u{c}'),
            (b'n', '\n'),
            (b'r', '\r'),
            (b't', '\t'),
        ];
        self.at += 1;
        let letter = self.peek();
        if let Some((_, meant)) = known.iter().find(|(byte, _)| Some(*byte) == letter) {
            self.at += 1;
            return Ok(*meant);
        }
        if !self.accept(b'u') {
            return Err(self.error("an unknown escape after `\\`"));
        }
        let first = self.hex()?;
        let code = match first {
            // A pair of surrogates stands for one character beyond 16 bits; a lone one for none.
            0xd800..0xdc00 if self.text.as_bytes()[self.at..].starts_with(b"\\u") => {
                self.at += 2;
                let second = self.hex()?;
                0x10000 + ((first - 0xd800) << 10) + (second.wrapping_sub(0xdc00) & 0x3ff)
            }
            code => code,
        };
        Ok(char::from_u32(code).unwrap_or(char::REPLACEMENT_CHARACTER))
    }

    fn hex(&mut self) -> Result<u32, JsonError> {
        let digits = self.text.as_bytes().get(self.at..self.at + 4).and_then(|d| std::str::from_utf8(d).ok());
        let code = digits.filter(|d| d.bytes().all(|b| b.is_ascii_hexdigit()));
        let Some(code) = code.and_then(|d| u32::from_str_radix(d, 16).ok()) else {
            return Err(self.error("four hexadecimal digits are expected"));
        };
        self.at += 4;
        Ok(code)
    }
}
