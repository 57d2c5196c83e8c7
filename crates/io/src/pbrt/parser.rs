//! Statements of pbrt's grammar: a directive with its arguments, read by a predictive parser that never looks back.
//!
//! A statement with an error is skipped up to the next directive, so that one run reports all errors of a file.

use etendue_math::{Point3, Transform, Vector3};
use etendue_scene::Span;
use etendue_scene::diagnostics::{FileId, nearest_name};
use etendue_scene::document::{Entity, Parameter, TextureValue, Value};

use super::builder::{Builder, Text};
use super::directives::{Place, current_names, help_for_old, place_of};
use super::files::Files;
use super::lexer::{Lexer, Token, TokenKind, parse_float, parse_integer, unescape};
use super::state::{ActiveTransforms, BlockKind};

/// The error is in the diagnostics; the parser goes on at the next directive.
#[derive(Debug)]
pub(super) struct Reported;

/// What a part of a statement yields.
pub(super) type Parsed<T> = Result<T, Reported>;

/// Errors after which the rest of the input is not worth reading.
const MAX_PROBLEMS: usize = 200;

/// Reads one file into the builder.
#[derive(Debug)]
pub(super) struct Parser<'a, 'b> {
    pub(super) lexer: Lexer<'a>,
    pub(super) file: FileId,
    pub(super) builder: &'b mut Builder,
    pub(super) files: &'b mut Files,
}

/// Reads all statements of a text.
pub(super) fn parse(text: &str, file: FileId, builder: &mut Builder, files: &mut Files) {
    let mut parser = Parser { lexer: Lexer::new(text), file, builder, files };
    while let Some(token) = parser.lexer.next() {
        if parser.gives_up(token) {
            return;
        }
        if parser.statement(token).is_err() {
            parser.recover();
        }
    }
}

/// Helpers for tokens and messages.
impl<'a> Parser<'a, '_> {
    pub(super) const fn span(&self, token: Token) -> Span {
        Span { file: self.file, start: token.start as u32, end: token.end as u32 }
    }

    /// Reports an error at a token.
    pub(super) fn fail<T>(&mut self, token: Token, message: impl Into<String>) -> Parsed<T> {
        self.builder.diagnostics.error(self.span(token), message);
        Err(Reported)
    }

    /// Reports an error at a token and how to mend it.
    pub(super) fn fail_with_help<T>(
        &mut self,
        token: Token,
        message: impl Into<String>,
        help: impl Into<String>,
    ) -> Parsed<T> {
        self.builder.diagnostics.error(self.span(token), message).with_help(help);
        Err(Reported)
    }

    fn gives_up(&mut self, token: Token) -> bool {
        if self.files.stopped {
            return true;
        }
        if self.builder.diagnostics.list().len() < MAX_PROBLEMS {
            return false;
        }
        self.files.stopped = true;
        self.builder.diagnostics.error(self.span(token), "too many problems: the rest is not read");
        true
    }

    /// True if the token is a word that is a directive.
    pub(super) fn is_directive(&self, token: Token) -> bool {
        token.kind == TokenKind::Word && place_of(self.lexer.text(token)).is_some()
    }

    /// Skips to the next word that is a directive or, outside of brackets, looks like a misspelt one.
    fn recover(&mut self) {
        let mut depth = 0_usize;
        while let Some(token) = self.lexer.next() {
            match token.kind {
                TokenKind::Open => depth += 1,
                TokenKind::Close => depth = depth.saturating_sub(1),
                TokenKind::Word => {
                    let word = self.lexer.text(token).as_bytes();
                    let looks_like_one = depth == 0
                        && word.len() >= 4
                        && word[0].is_ascii_uppercase()
                        && word[1].is_ascii_lowercase();
                    if looks_like_one || self.is_directive(token) {
                        self.lexer.unread(token);
                        return;
                    }
                }
                TokenKind::Text | TokenKind::UnterminatedText => {}
            }
        }
    }

    /// What to call a token in a message.
    pub(super) fn describe(&self, token: Option<Token>) -> String {
        let Some(token) = token else { return "the end of the file".to_owned() };
        let text = self.lexer.text(token);
        let shown: String = text.chars().take(40).collect();
        if shown.len() < text.len() { format!("`{shown}…`") } else { format!("`{shown}`") }
    }

    /// The next token, to be an argument of `directive`; directives are left where they are.
    fn argument(&mut self, directive: Token, what: &str) -> Parsed<Token> {
        let next = self.lexer.next();
        match next {
            Some(token) if !self.is_directive(token) => return Ok(token),
            Some(token) => self.lexer.unread(token),
            None => {}
        }
        let message =
            format!("`{}` needs {what}, but {} follows", self.lexer.text(directive), self.describe(next));
        self.fail(directive, message)
    }

    /// The content of a quoted token.
    pub(super) fn content(&mut self, token: Token) -> Parsed<Text> {
        if token.kind == TokenKind::UnterminatedText {
            return self.fail(token, "this string has no closing quote");
        }
        match unescape(self.lexer.text(token)) {
            Ok(content) => Ok(Text { content: content.into_owned(), span: self.span(token) }),
            Err(character) => {
                self.fail(token, format!("`\\{}` is no escape sequence", character.escape_default()))
            }
        }
    }

    fn text(&mut self, directive: Token, what: &str) -> Parsed<Text> {
        let token = self.argument(directive, what)?;
        match token.kind {
            TokenKind::Text | TokenKind::UnterminatedText => self.content(token),
            _ => {
                let message = format!(
                    "`{}` needs {what} in quotes, not {}",
                    self.lexer.text(directive),
                    self.describe(Some(token))
                );
                self.lexer.unread(token);
                self.fail(token, message)
            }
        }
    }

    fn numbers<const N: usize>(&mut self, directive: Token) -> Parsed<[f32; N]> {
        let mut numbers = [0.0; N];
        for number in &mut numbers {
            let token = self.argument(directive, &format!("{N} numbers"))?;
            let value =
                (token.kind == TokenKind::Word).then(|| parse_float(self.lexer.text(token))).flatten();
            let Some(value) = value else {
                let found = self.describe(Some(token));
                let message = format!("`{}` needs {N} numbers: {found} is none", self.lexer.text(directive));
                self.lexer.unread(token);
                return self.fail(token, message);
            };
            *number = value;
        }
        Ok(numbers)
    }

    /// `[ 16 numbers ]`, columns of a matrix one after another.
    fn matrix(&mut self, directive: Token) -> Parsed<Transform> {
        self.bracket(directive, TokenKind::Open, "`[` before its 16 numbers")?;
        let m = self.numbers::<16>(directive)?;
        self.bracket(directive, TokenKind::Close, "`]` after its 16 numbers")?;
        let rows = std::array::from_fn(|row| std::array::from_fn(|column| m[4 * column + row]));
        self.invertible(directive, Transform::from_rows(rows))
    }

    fn bracket(&mut self, directive: Token, kind: TokenKind, what: &str) -> Parsed<()> {
        let token = self.argument(directive, what)?;
        if token.kind == kind {
            return Ok(());
        }
        let message =
            format!("`{}` needs {what}, not {}", self.lexer.text(directive), self.describe(Some(token)));
        self.lexer.unread(token);
        self.fail(token, message)
    }

    fn invertible(&mut self, directive: Token, transform: Option<Transform>) -> Parsed<Transform> {
        match transform {
            Some(transform) => Ok(transform),
            None => {
                let message =
                    format!("the transform of this `{}` has no inverse", self.lexer.text(directive));
                self.fail(directive, message)
            }
        }
    }

    /// A type name with parameters.
    fn entity(&mut self, directive: Token, what: &str) -> Parsed<Entity> {
        let name = self.text(directive, what)?;
        let (parameters, is_incomplete) = self.parameters();
        Ok(Entity { type_name: name.content, span: Some(name.span), parameters, is_incomplete })
    }
}

/// Statements.
impl Parser<'_, '_> {
    fn statement(&mut self, directive: Token) -> Parsed<()> {
        let name = match directive.kind {
            TokenKind::Word => self.lexer.text(directive),
            TokenKind::UnterminatedText => return self.fail(directive, "this string has no closing quote"),
            _ => {
                let message =
                    format!("a directive should stand here, not {}", self.describe(Some(directive)));
                return self.fail(directive, message);
            }
        };
        let Some(place) = place_of(name) else { return self.unknown_directive(directive) };
        if let Some(help) = help_for_old(name) {
            return self.fail_with_help(directive, format!("pbrt-v4 has no directive `{name}`"), help);
        }
        self.check_place(directive, place)?;
        match name {
            "Identity" | "Translate" | "Scale" | "Rotate" | "LookAt" | "Transform" | "ConcatTransform"
            | "CoordinateSystem" | "CoordSysTransform" | "TransformTimes" | "ActiveTransform" => {
                self.transform_statement(directive, name)
            }
            "Include" | "Import" => self.file_statement(directive, name),
            "Camera" | "Film" | "Sampler" | "PixelFilter" | "Integrator" | "Accelerator" | "Option"
            | "WorldBegin" => self.option_statement(directive, name),
            "Attribute" | "ColorSpace" | "ReverseOrientation" | "MediumInterface" | "AttributeBegin"
            | "AttributeEnd" | "TransformBegin" | "TransformEnd" | "ObjectBegin" | "ObjectEnd" => {
                self.attribute_statement(directive, name)
            }
            _ => self.world_statement(directive, name),
        }
    }

    fn unknown_directive(&mut self, directive: Token) -> Parsed<()> {
        if !self.lexer.text(directive).starts_with(|c: char| c.is_ascii_alphabetic()) {
            let message = format!("a directive should stand here, not {}", self.describe(Some(directive)));
            return self.fail_with_help(directive, message, "several values of a parameter need brackets");
        }
        let message = format!("unknown directive {}", self.describe(Some(directive)));
        match nearest_name(self.lexer.text(directive), current_names()) {
            Some(nearest) => self.fail_with_help(directive, message, format!("did you mean `{nearest}`?")),
            None => self.fail(directive, message),
        }
    }

    fn check_place(&mut self, directive: Token, place: Place) -> Parsed<()> {
        let name = self.lexer.text(directive);
        if place == Place::Options && self.builder.in_world {
            let message = match name {
                "WorldBegin" => "there is a `WorldBegin` before this one".to_owned(),
                name => format!("`{name}` must stand before `WorldBegin`"),
            };
            return self.fail(directive, message);
        }
        if place == Place::World && !self.builder.in_world {
            // The first one says it all if `WorldBegin` was forgotten.
            if !std::mem::replace(&mut self.files.reported_early_world, true) {
                return self.fail(directive, format!("`{name}` must stand after `WorldBegin`"));
            }
            return Err(Reported);
        }
        Ok(())
    }

    fn transform_statement(&mut self, directive: Token, name: &str) -> Parsed<()> {
        match name {
            "Identity" => self.builder.set_transform(Transform::IDENTITY),
            "Translate" => {
                let [x, y, z] = self.numbers(directive)?;
                self.builder.concatenate(Transform::translate(Vector3::new(x, y, z)));
            }
            "Scale" => {
                let [x, y, z] = self.numbers(directive)?;
                let scale = self.invertible(directive, Transform::scale(x, y, z))?;
                self.builder.concatenate(scale);
            }
            "Rotate" => {
                let [angle_deg, x, y, z] = self.numbers(directive)?;
                let rotation = Transform::rotate(angle_deg.to_radians(), Vector3::new(x, y, z));
                let rotation = self.invertible(directive, rotation)?;
                self.builder.concatenate(rotation);
            }
            "LookAt" => {
                let v: [f32; 9] = self.numbers(directive)?;
                let (eye, target) = (Point3::new(v[0], v[1], v[2]), Point3::new(v[3], v[4], v[5]));
                let look_at = Transform::look_at(eye, target, Vector3::new(v[6], v[7], v[8]));
                let look_at = self.invertible(directive, look_at)?;
                self.builder.concatenate(look_at);
            }
            "Transform" => {
                let transform = self.matrix(directive)?;
                self.builder.set_transform(transform);
            }
            "ConcatTransform" => {
                let transform = self.matrix(directive)?;
                self.builder.concatenate(transform);
            }
            "TransformTimes" => {
                let times = self.numbers(directive)?;
                self.builder.transform_times(times, self.span(directive));
            }
            "CoordinateSystem" => {
                let name = self.text(directive, "a name")?;
                self.builder.coordinate_system(name);
            }
            "CoordSysTransform" => {
                let name = self.text(directive, "a name")?;
                self.builder.use_coordinate_system(&name);
            }
            _ => self.active_transform(directive)?,
        }
        Ok(())
    }

    fn active_transform(&mut self, directive: Token) -> Parsed<()> {
        const NAMES: [&str; 3] = ["StartTime", "EndTime", "All"];
        let token = self.argument(directive, "`StartTime`, `EndTime` or `All`")?;
        let word = self.lexer.text(token);
        let active = match word {
            "StartTime" => ActiveTransforms::Start,
            "EndTime" => ActiveTransforms::End,
            "All" => ActiveTransforms::All,
            _ => {
                let message = format!("`ActiveTransform` has no choice {}", self.describe(Some(token)));
                let help = nearest_name(word, NAMES).map_or_else(
                    || "the choices are: StartTime, EndTime, All".to_owned(),
                    |near| format!("did you mean `{near}`?"),
                );
                return self.fail_with_help(token, message, help);
            }
        };
        self.builder.activate(active);
        Ok(())
    }

    fn file_statement(&mut self, directive: Token, name: &str) -> Parsed<()> {
        let path = self.text(directive, "a file name")?;
        if name == "Include" {
            self.files.read(&path.content, Some(path.span), self.builder);
            return Ok(());
        }
        let before = self.builder.import_begin();
        self.files.read(&path.content, Some(path.span), self.builder);
        self.builder.import_end(before);
        Ok(())
    }

    fn option_statement(&mut self, directive: Token, name: &str) -> Parsed<()> {
        match name {
            "WorldBegin" => self.builder.world_begin(),
            "Option" => {
                let option = self.option(directive)?;
                self.builder.option(option);
            }
            "Camera" => {
                let camera = self.entity(directive, "a type")?;
                self.builder.camera(camera);
            }
            "Film" => {
                let film = self.entity(directive, "a type")?;
                self.builder.film(film);
            }
            _ => {
                let entity = Some(self.entity(directive, "a type")?);
                let document = &mut self.builder.document;
                match name {
                    "Sampler" => document.sampler = entity,
                    "PixelFilter" => document.filter = entity,
                    "Integrator" => document.integrator = entity,
                    _ => document.accelerator = entity,
                }
            }
        }
        Ok(())
    }

    /// `Option "name" value`, where the name may also be declared with its type.
    fn option(&mut self, directive: Token) -> Parsed<Parameter> {
        let token = self.argument(directive, "a name")?;
        if token.kind == TokenKind::Text && self.lexer.text(token).trim_matches(['"', ' ']).contains(' ') {
            return self.parameter(token);
        }
        self.lexer.unread(token);
        let name = self.text(directive, "a name")?;
        let token = self.argument(directive, "a value")?;
        let value = match (token.kind, self.lexer.text(token)) {
            (TokenKind::Word, "true") => Value::Bools(vec![true]),
            (TokenKind::Word, "false") => Value::Bools(vec![false]),
            (TokenKind::Text | TokenKind::UnterminatedText, _) => {
                Value::Strings(vec![self.content(token)?.content])
            }
            (TokenKind::Word, word) => match (parse_integer(word), parse_float(word)) {
                (Some(integer), _) => Value::Integers(vec![integer]),
                (None, Some(float)) => Value::Floats(vec![float]),
                (None, None) => {
                    let message = format!("{} is no value of an option", self.describe(Some(token)));
                    return self.fail(token, message);
                }
            },
            _ => return self.fail(token, "the value of an option stands without brackets"),
        };
        let color_space = self.builder.state.color_space;
        let span = Some(name.span);
        Ok(Parameter { name: name.content, value, span, color_space, may_be_unused: false })
    }

    fn attribute_statement(&mut self, directive: Token, name: &str) -> Parsed<()> {
        let span = self.span(directive);
        match name {
            "AttributeBegin" => self.builder.attribute_begin(span),
            "TransformBegin" => self.builder.transform_begin(span),
            "AttributeEnd" | "TransformEnd" => self.builder.end(BlockKind::Attribute, name, span),
            "ObjectBegin" => {
                let name = self.text(directive, "a name")?;
                self.builder.object_begin(name, span);
            }
            "ObjectEnd" => self.builder.end(BlockKind::Object, name, span),
            "ReverseOrientation" => self.builder.reverse_orientation(),
            "ColorSpace" => {
                let name = self.text(directive, "a name")?;
                self.builder.color_space(&name);
            }
            "MediumInterface" => {
                let inside = self.text(directive, "the name of a medium")?;
                let second = self.lexer.peek().filter(|t| t.kind == TokenKind::Text);
                let outside = match second {
                    Some(_) => self.text(directive, "the name of a medium")?,
                    None => inside.clone(),
                };
                self.builder.medium_interface(&inside.content, &outside.content);
            }
            _ => {
                let target = self.entity(directive, "a target")?;
                self.builder.attribute(&target);
            }
        }
        Ok(())
    }

    fn world_statement(&mut self, directive: Token, name: &str) -> Parsed<()> {
        match name {
            "NamedMaterial" => {
                let name = self.text(directive, "a name")?;
                self.builder.named_material(name);
            }
            "ObjectInstance" => {
                let name = self.text(directive, "a name")?;
                self.builder.instance(name);
            }
            "Texture" => self.texture(directive)?,
            "MakeNamedMaterial" => {
                let entity = self.entity(directive, "a name")?;
                self.builder.make_named_material(entity);
            }
            "MakeNamedMedium" => {
                let entity = self.entity(directive, "a name")?;
                self.builder.make_named_medium(entity);
            }
            _ => {
                let entity = self.entity(directive, "a type")?;
                match name {
                    "Material" => self.builder.material(entity),
                    "LightSource" => self.builder.light(entity),
                    "AreaLightSource" => self.builder.area_light(entity),
                    _ => self.builder.shape(entity),
                }
            }
        }
        Ok(())
    }

    fn texture(&mut self, directive: Token) -> Parsed<()> {
        let name = self.text(directive, "a name")?;
        let kind = self.text(directive, "\"float\" or \"spectrum\"")?;
        let entity = self.entity(directive, "a type")?;
        let value = match kind.content.as_str() {
            "float" => TextureValue::Float,
            "spectrum" => TextureValue::Spectrum,
            other => {
                let message = format!("textures yield \"float\" or \"spectrum\", not \"{other}\"");
                let problem = self.builder.diagnostics.error(kind.span, message);
                if other == "color" || other == "rgb" {
                    problem.with_help("write \"spectrum\"");
                }
                return Ok(());
            }
        };
        self.builder.texture(name, value, entity);
        Ok(())
    }
}
