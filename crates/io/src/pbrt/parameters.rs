//! Parameter lists: `"type name" value` or `"type name" [ values ]`.

use etendue_math::{Normal3, Point2, Point3, Vector2, Vector3};
use etendue_scene::diagnostics::nearest_name;
use etendue_scene::document::{Parameter, Value};

use super::lexer::{Token, TokenKind, parse_float, parse_integer};
use super::parser::{Parsed, Parser, Reported};

/// The declared types.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Type {
    Integer,
    Float,
    Point2,
    Vector2,
    Point3,
    Vector3,
    Normal3,
    Bool,
    String,
    Rgb,
    Blackbody,
    Spectrum,
    Texture,
}

const TYPE_NAMES: [(&str, Type); 16] = [
    ("integer", Type::Integer),
    ("float", Type::Float),
    ("point2", Type::Point2),
    ("vector2", Type::Vector2),
    ("point3", Type::Point3),
    ("point", Type::Point3),
    ("vector3", Type::Vector3),
    ("vector", Type::Vector3),
    ("normal3", Type::Normal3),
    ("normal", Type::Normal3),
    ("bool", Type::Bool),
    ("string", Type::String),
    ("rgb", Type::Rgb),
    ("blackbody", Type::Blackbody),
    ("spectrum", Type::Spectrum),
    ("texture", Type::Texture),
];

fn type_of(name: &str) -> Option<Type> {
    TYPE_NAMES.iter().find(|(known, _)| *known == name).map(|(_, declared)| *declared)
}

/// What the values of a list must be.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Item {
    Float,
    Integer,
    Bool,
    String,
}

impl Item {
    const fn name(self) -> &'static str {
        match self {
            Self::Float => "number",
            Self::Integer => "integer",
            Self::Bool => "`true` or `false`",
            Self::String => "string in quotes",
        }
    }
}

/// The values of one list; one of them is in use.
#[derive(Debug, Default)]
struct Items {
    floats: Vec<f32>,
    integers: Vec<i32>,
    bools: Vec<bool>,
    strings: Vec<String>,
}

impl Items {
    const fn is_empty(&self) -> bool {
        self.floats.is_empty() && self.integers.is_empty() && self.bools.is_empty() && self.strings.is_empty()
    }
}

impl Parser<'_, '_> {
    /// All parameters that follow, and whether any is missing: those with errors are reported and left out.
    pub(super) fn parameters(&mut self) -> (Vec<Parameter>, bool) {
        let mut parameters: Vec<Parameter> = Vec::new();
        let mut is_incomplete = false;
        while let Some(token) = self.lexer.next() {
            if !matches!(token.kind, TokenKind::Text | TokenKind::UnterminatedText) {
                self.lexer.unread(token);
                break;
            }
            let Ok(parameter) = self.parameter(token) else {
                is_incomplete = true;
                continue;
            };
            let Some(index) = parameters.iter().position(|old| old.name == parameter.name) else {
                parameters.push(parameter);
                continue;
            };
            let (old, new) = (parameters[index].value.type_name(), parameter.value.type_name());
            if old == new {
                let message = format!("the parameter `{}` is given twice", parameter.name);
                self.builder.diagnostics.error(parameter.span, message);
            } else {
                let name = &parameter.name;
                let message = format!("`{name}` is given as {old} and as {new}: the last one counts");
                self.builder.diagnostics.warning(parameter.span, message);
                parameters[index] = parameter;
            }
        }
        (parameters, is_incomplete)
    }

    /// The parameter with that declaration.
    pub(super) fn parameter(&mut self, declaration: Token) -> Parsed<Parameter> {
        let declared = self.declaration(declaration);
        let Ok((declared, name)) = declared else {
            self.skip_value();
            return Err(Reported);
        };
        let items = self.items(declaration, declared)?;
        let value = self.value(declaration, declared, &name, items)?;
        let color_space = self.builder.state.color_space;
        let span = Some(self.span(declaration));
        Ok(Parameter { name, value, span, color_space, may_be_unused: false })
    }

    fn declaration(&mut self, token: Token) -> Parsed<(Type, String)> {
        let text = self.content(token)?;
        let mut words = text.content.split([' ', '\t']).filter(|word| !word.is_empty());
        let (Some(type_name), Some(name)) = (words.next(), words.next()) else {
            let message = format!("\"{}\" should be a type and the name of a parameter", text.content);
            return self.fail_with_help(token, message, "for example \"float radius\"");
        };
        if words.next().is_some() {
            return self.fail(token, format!("\"{}\" has more words than type and name", text.content));
        }
        if let Some(declared) = type_of(type_name) {
            return Ok((declared, name.to_owned()));
        }
        let message = format!("there is no type `{type_name}`");
        let help = match type_name {
            "color" => Some("rgb"),
            "xyz" => Some("rgb"),
            "int" => Some("integer"),
            _ => nearest_name(type_name, TYPE_NAMES.iter().map(|(known, _)| *known)),
        };
        match help {
            Some(near) => self.fail_with_help(token, message, format!("did you mean `{near}`?")),
            None => self.fail(token, message),
        }
    }

    /// Skips the value of a declaration that makes no sense.
    fn skip_value(&mut self) {
        let Some(first) = self.lexer.next() else { return };
        if first.kind != TokenKind::Open {
            if self.is_directive(first) || self.is_declaration(first) {
                self.lexer.unread(first);
            }
            return;
        }
        while let Some(token) = self.lexer.next() {
            if token.kind == TokenKind::Close {
                return;
            }
            if self.is_directive(token) {
                self.lexer.unread(token);
                return;
            }
        }
    }

    /// True for a quoted type and name.
    fn is_declaration(&self, token: Token) -> bool {
        if token.kind != TokenKind::Text {
            return false;
        }
        let mut words = self.lexer.text(token).trim_matches('"').split_ascii_whitespace();
        words.next().is_some_and(|word| type_of(word).is_some()) && words.next().is_some()
    }

    /// The values after a declaration. If one is wrong, the first such is reported and all are read nevertheless.
    fn items(&mut self, declaration: Token, declared: Type) -> Parsed<Items> {
        let mut items = Items::default();
        let first = self.lexer.next();
        let item = self.item_type(declared, first);
        let Some(first) = first.filter(|token| self.may_be_value(*token, item)) else {
            let message = format!("this parameter has no value: {} follows", self.describe(first));
            if let Some(token) = first {
                self.lexer.unread(token);
            }
            return self.fail(declaration, message);
        };
        if first.kind != TokenKind::Open {
            return self.item(first, item, &mut items).map(|()| items);
        }
        let mut result = Ok(());
        loop {
            match item {
                Item::Float => self.lexer.floats(&mut items.floats),
                Item::Integer => self.lexer.integers(&mut items.integers),
                Item::Bool | Item::String => {}
            }
            let next = self.lexer.next();
            match next {
                Some(token) if token.kind == TokenKind::Close => break,
                Some(token) if token.kind != TokenKind::Open && self.may_be_value(token, item) => {
                    if result.is_ok() {
                        result = self.item(token, item, &mut items);
                    }
                }
                _ => {
                    let message = format!("this `[` is not closed before {}", self.describe(next));
                    if let Some(token) = next {
                        self.lexer.unread(token);
                    }
                    return self.fail(first, message);
                }
            }
        }
        result?;
        if items.is_empty() {
            return self.fail(declaration, "this parameter has no values");
        }
        Ok(items)
    }

    /// What the items of a type are; a spectrum is a list of names if the first one is quoted.
    fn item_type(&mut self, declared: Type, first: Option<Token>) -> Item {
        match declared {
            Type::Integer => Item::Integer,
            Type::Bool => Item::Bool,
            Type::String | Type::Texture => Item::String,
            Type::Spectrum => {
                let bracketed = first.filter(|token| token.kind == TokenKind::Open);
                let item = if bracketed.is_some() { self.lexer.peek() } else { first };
                match item.map(|token| token.kind) {
                    Some(TokenKind::Text | TokenKind::UnterminatedText) => Item::String,
                    _ => Item::Float,
                }
            }
            _ => Item::Float,
        }
    }

    /// False for tokens that begin something else, so that the bracket or value before them must be missing.
    fn may_be_value(&self, token: Token, item: Item) -> bool {
        match token.kind {
            TokenKind::Close => false,
            TokenKind::Text => item == Item::String || !self.is_declaration(token),
            _ => !self.is_directive(token),
        }
    }

    fn item(&mut self, token: Token, item: Item, items: &mut Items) -> Parsed<()> {
        let text = self.lexer.text(token);
        let quoted = matches!(token.kind, TokenKind::Text | TokenKind::UnterminatedText);
        match item {
            Item::Float if !quoted => {
                if let Some(value) = parse_float(text) {
                    items.floats.push(value);
                    return Ok(());
                }
                let has_digits = text.contains(|c: char| c.is_ascii_digit());
                if has_digits && text.parse::<f32>().is_ok_and(f32::is_infinite) {
                    let message = format!("{} does not fit single precision", self.describe(Some(token)));
                    return self.fail(token, message);
                }
            }
            Item::Integer if !quoted => {
                if let Some(value) = parse_integer(text) {
                    items.integers.push(value);
                    return Ok(());
                }
                if let Ok(value) = text.parse::<f64>() {
                    return self.bad_integer(token, value);
                }
            }
            Item::Bool => {
                if let Some(value) = match text.trim_matches('"') {
                    "true" => Some(true),
                    "false" => Some(false),
                    _ => None,
                } {
                    if quoted {
                        let message = format!("write {value} without quotes");
                        self.builder.diagnostics.warning(self.span(token), message);
                    }
                    items.bools.push(value);
                    return Ok(());
                }
            }
            Item::String if quoted => {
                items.strings.push(self.content(token)?.content);
                return Ok(());
            }
            _ => {}
        }
        let article = if item == Item::Integer {
            "an "
        } else if item == Item::Bool {
            ""
        } else {
            "a "
        };
        let message = format!("{} should be {article}{}", self.describe(Some(token)), item.name());
        self.fail(token, message)
    }

    fn bad_integer(&mut self, token: Token, value: f64) -> Parsed<()> {
        let shown = self.describe(Some(token));
        if value.fract() == 0.0 && i32::try_from(value as i64).is_ok() {
            let help = format!("write {}", value as i64);
            return self.fail_with_help(token, format!("{shown} should be an integer"), help);
        }
        if value.fract() == 0.0 {
            return self.fail(token, format!("{shown} does not fit an integer of 32 bits"));
        }
        self.fail(token, format!("{shown} should be an integer"))
    }

    /// Groups the items as the type wants them.
    fn value(&mut self, declaration: Token, declared: Type, name: &str, items: Items) -> Parsed<Value> {
        let Items { mut floats, mut integers, bools, strings } = items;
        let group = match declared {
            Type::Point2 | Type::Vector2 => 2,
            Type::Point3 | Type::Vector3 | Type::Normal3 | Type::Rgb => 3,
            Type::Spectrum => 2,
            _ => 1,
        };
        if !floats.len().is_multiple_of(group) {
            let message = format!("`{name}` has {} numbers, which is no multiple of {group}", floats.len());
            return self.fail(declaration, message);
        }
        Ok(match declared {
            Type::Integer => {
                integers.shrink_to_fit();
                Value::Integers(integers)
            }
            Type::Float => {
                floats.shrink_to_fit();
                Value::Floats(floats)
            }
            Type::Point2 => Value::Points2(grouped(&floats, |[x, y]| Point2::new(x, y))),
            Type::Vector2 => Value::Vectors2(grouped(&floats, |[x, y]| Vector2::new(x, y))),
            Type::Point3 => Value::Points3(grouped(&floats, |[x, y, z]| Point3::new(x, y, z))),
            Type::Vector3 => Value::Vectors3(grouped(&floats, |[x, y, z]| Vector3::new(x, y, z))),
            Type::Normal3 => Value::Normals3(grouped(&floats, |[x, y, z]| Normal3::new(x, y, z))),
            Type::Rgb => Value::Rgb(grouped(&floats, |rgb| rgb)),
            Type::Blackbody => Value::Blackbody(floats),
            Type::Bool => Value::Bools(bools),
            Type::String => Value::Strings(strings),
            Type::Texture => self.texture_name(declaration, name, strings)?,
            Type::Spectrum if !strings.is_empty() => Value::SpectrumNames(strings),
            Type::Spectrum => {
                let samples = grouped(&floats, |sample: [f32; 2]| sample);
                if let Some(pair) = samples.windows(2).find(|pair| pair[0][0] >= pair[1][0]) {
                    let message = format!(
                        "the wavelengths of `{name}` must increase, but {} follows {}",
                        pair[1][0], pair[0][0]
                    );
                    return self.fail(declaration, message);
                }
                Value::SpectrumSamples(samples)
            }
        })
    }

    fn texture_name(&mut self, declaration: Token, name: &str, mut strings: Vec<String>) -> Parsed<Value> {
        if strings.len() > 1 {
            return self.fail(declaration, format!("`{name}` must name one texture, not {}", strings.len()));
        }
        Ok(Value::Texture(strings.pop().expect("lists are not empty")))
    }
}

fn grouped<const N: usize, T>(floats: &[f32], make: impl Fn([f32; N]) -> T) -> Vec<T> {
    floats.as_chunks::<N>().0.iter().map(|group| make(*group)).collect()
}
