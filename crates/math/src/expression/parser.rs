//! From text to nodes, by precedence (Pratt 1973, "Top down operator precedence").

use super::error::ExpressionError;
use super::functions::{FUNCTIONS, Function, Meaning};
use super::nodes::{Binary, NodeId, Nodes, Unary};
use super::{CONSTANTS, Expression};

type Result<T> = std::result::Result<T, ExpressionError>;

/// Deepest nesting of brackets, signs and powers.
const MAX_DEPTH: usize = 128;

/// How tightly a sign binds its operand: less than `^`, more than `*`.
const SIGN: u8 = 6;

/// Operators, their precedence and what they mean. Longer ones come first.
const OPERATORS: &[(&str, u8, Operator)] = &[
    ("||", 1, Operator::Plain(Binary::Or)),
    ("&&", 2, Operator::Plain(Binary::And)),
    ("<=", 3, Operator::Plain(Binary::LessOrEqual)),
    (">=", 3, Operator::Turned(Binary::LessOrEqual)),
    ("==", 3, Operator::Plain(Binary::Equal)),
    ("!=", 3, Operator::Not(Binary::Equal)),
    ("<", 3, Operator::Plain(Binary::Less)),
    (">", 3, Operator::Turned(Binary::Less)),
    ("+", 4, Operator::Plain(Binary::Add)),
    ("-", 4, Operator::Plain(Binary::Sub)),
    ("*", 5, Operator::Plain(Binary::Mul)),
    ("/", 5, Operator::Plain(Binary::Div)),
    ("^", 7, Operator::Power),
];

#[derive(Clone, Copy)]
enum Operator {
    Plain(Binary),
    /// With its operands exchanged.
    Turned(Binary),
    Not(Binary),
    Power,
}

struct Parser<'a> {
    text: &'a str,
    position: usize,
    depth: usize,
    nodes: Nodes,
    variables: &'a [&'a str],
    parameter: &'a mut dyn FnMut(&str) -> Option<f64>,
}

/// Reads a formula; gives its nodes and which of them is its value.
pub(super) fn parse(
    text: &str,
    variables: &[&str],
    parameter: &mut dyn FnMut(&str) -> Option<f64>,
) -> Result<(Nodes, NodeId)> {
    if text.len() > Expression::MAX_LENGTH {
        let message = format!("the formula has {} bytes, more than {}", text.len(), Expression::MAX_LENGTH);
        return Err(ExpressionError::new(text, 0, message));
    }
    let mut parser = Parser { text, position: 0, depth: 0, nodes: Nodes::default(), variables, parameter };
    let root = parser.expression(0)?;
    parser.skip_space();
    if parser.position < text.len() {
        return Err(parser.unexpected("an operator or the end of the formula"));
    }
    Ok((parser.nodes, root))
}

impl Parser<'_> {
    fn rest(&self) -> &str {
        &self.text[self.position..]
    }

    fn skip_space(&mut self) {
        self.position = self.text.len() - self.rest().trim_start().len();
    }

    /// Steps over a token, if it is next.
    fn takes(&mut self, token: &str) -> bool {
        self.skip_space();
        let found = self.rest().starts_with(token);
        self.position += if found { token.len() } else { 0 };
        found
    }

    fn error(&self, at: usize, message: impl Into<String>) -> ExpressionError {
        ExpressionError::new(self.text, at, message)
    }

    fn unexpected(&self, expected: &str) -> ExpressionError {
        let found = self.rest().chars().next().map_or("the end".to_owned(), |c| format!("{c:?}"));
        self.error(self.position, format!("expected {expected}, found {found}"))
    }

    /// An expression of operators that bind at least so tightly.
    fn expression(&mut self, least: u8) -> Result<NodeId> {
        self.depth += 1;
        if self.depth > MAX_DEPTH {
            let message = format!("the formula is nested more than {MAX_DEPTH} deep");
            return Err(self.error(self.position, message));
        }
        let mut left = self.operand()?;
        loop {
            self.skip_space();
            let next = OPERATORS.iter().find(|(token, ..)| self.rest().starts_with(token));
            let Some((token, precedence, operator)) = next.filter(|(_, precedence, _)| *precedence >= least)
            else {
                break;
            };
            self.position += token.len();
            // Powers bind to the right, all else to the left.
            let is_power = matches!(operator, Operator::Power);
            let right = self.expression(if is_power { *precedence } else { precedence + 1 })?;
            left = self.apply(*operator, left, right);
            self.check_size()?;
        }
        self.depth -= 1;
        Ok(left)
    }

    fn check_size(&self) -> Result<()> {
        if self.nodes.as_slice().len() <= Nodes::MAX {
            return Ok(());
        }
        Err(self.error(self.position, format!("the formula has more than {} steps", Nodes::MAX)))
    }

    fn apply(&mut self, operator: Operator, left: NodeId, right: NodeId) -> NodeId {
        match operator {
            Operator::Plain(f) => self.nodes.binary(f, left, right),
            Operator::Turned(f) => self.nodes.binary(f, right, left),
            Operator::Not(f) => {
                let equal = self.nodes.binary(f, left, right);
                self.nodes.unary(Unary::Not, equal)
            }
            Operator::Power => self.nodes.power(left, right),
        }
    }

    /// A number, a name, a call, brackets, or one of these with a sign.
    fn operand(&mut self) -> Result<NodeId> {
        if self.takes("-") {
            let operand = self.expression(SIGN)?;
            return Ok(self.nodes.unary(Unary::Neg, operand));
        }
        if self.takes("+") {
            return self.expression(SIGN);
        }
        if self.takes("!") {
            let operand = self.expression(SIGN)?;
            return Ok(self.nodes.unary(Unary::Not, operand));
        }
        if self.takes("(") {
            let inner = self.expression(0)?;
            if !self.takes(")") {
                return Err(self.unexpected("\")\""));
            }
            return Ok(inner);
        }
        match self.rest().chars().next() {
            Some(c) if c.is_ascii_digit() || c == '.' => self.number(),
            Some(c) if c.is_alphabetic() || c == '_' => self.name(),
            _ => Err(self.unexpected("a number, a name or \"(\"")),
        }
    }

    fn number(&mut self) -> Result<NodeId> {
        let start = self.position;
        let bytes = self.text.as_bytes();
        let is_digit = |at: usize| bytes.get(at).is_some_and(|b| b.is_ascii_digit() || *b == b'.');
        while is_digit(self.position) {
            self.position += 1;
        }
        // An exponent, unless it is the constant e that follows without a sign or digit.
        let sign = usize::from(matches!(bytes.get(self.position + 1), Some(b'+' | b'-')));
        let has_digit = bytes.get(self.position + 1 + sign).is_some_and(u8::is_ascii_digit);
        if matches!(bytes.get(self.position), Some(b'e' | b'E')) && has_digit {
            self.position += 1 + sign;
            while bytes.get(self.position).is_some_and(u8::is_ascii_digit) {
                self.position += 1;
            }
        }
        let text = &self.text[start..self.position];
        match text.parse::<f64>() {
            Ok(value) if value.is_finite() => Ok(self.nodes.constant(value)),
            _ => Err(self.error(start, format!("\"{text}\" is not a number"))),
        }
    }

    fn name(&mut self) -> Result<NodeId> {
        let start = self.position;
        let rest = self.rest();
        let length = rest.find(|c: char| !c.is_alphanumeric() && c != '_').unwrap_or(rest.len());
        self.position += length;
        let name = &self.text[start..self.position];
        if self.takes("(") {
            return self.call(start, name.to_owned());
        }
        if let Some(index) = self.variables.iter().position(|variable| *variable == name) {
            return Ok(self.nodes.variable(index as u8));
        }
        let constant = || CONSTANTS.iter().find(|(known, _)| *known == name).map(|(_, value)| *value);
        if let Some(value) = (self.parameter)(name).or_else(constant) {
            return Ok(self.nodes.constant(value));
        }
        let is_function = FUNCTIONS.iter().any(|f| f.name == name);
        if is_function {
            return Err(self.error(start, format!("the function \"{name}\" needs arguments in brackets")));
        }
        let known = self.variables.iter().copied().chain(CONSTANTS.iter().map(|(name, _)| *name));
        Err(self.unknown(start, "name", name, known))
    }

    fn unknown<'n>(
        &self,
        at: usize,
        kind: &str,
        name: &str,
        known: impl Iterator<Item = &'n str>,
    ) -> ExpressionError {
        // Names may be as long as the text.
        let short: String = name.chars().take(40).collect();
        let mut error = self.error(at, format!("unknown {kind} \"{short}\""));
        error.unknown = Some(short);
        error.known = known.map(str::to_owned).collect();
        error
    }

    fn call(&mut self, start: usize, name: String) -> Result<NodeId> {
        let Some(function) = FUNCTIONS.iter().find(|f| f.name == name) else {
            return Err(self.unknown(start, "function", &name, FUNCTIONS.iter().map(|f| f.name)));
        };
        let mut arguments = Vec::new();
        if !self.takes(")") {
            loop {
                arguments.push(self.expression(0)?);
                if self.takes(")") {
                    break;
                }
                if !self.takes(",") {
                    return Err(self.unexpected("\",\" or \")\""));
                }
            }
        }
        if arguments.len() < function.least || arguments.len() > function.most {
            return Err(self.error(start, wrong_count(function, arguments.len())));
        }
        self.check_size()?;
        Ok(match function.meaning {
            Meaning::Unary(f) => self.nodes.unary(f, arguments[0]),
            Meaning::Binary(f) => self.nodes.binary(f, arguments[0], arguments[1]),
            Meaning::Chain(f) => {
                let nodes = &mut self.nodes;
                arguments[1..].iter().fold(arguments[0], |a, b| nodes.binary(f, a, *b))
            }
            Meaning::Composed(build) => build(&mut self.nodes, &arguments),
        })
    }
}

fn wrong_count(function: &Function, found: usize) -> String {
    let Function { name, least, most, .. } = function;
    let expected = if least == most { least.to_string() } else { format!("{least} to {most}") };
    format!("\"{name}\" takes {expected} arguments, not {found}")
}
