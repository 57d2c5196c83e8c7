//! The functions that a formula may call, and what they are made of.

use super::nodes::{Binary, NodeId, Nodes, Unary};

/// A function as written in formulas.
#[derive(Clone, Copy, Debug)]
pub struct Function {
    /// Name.
    pub name: &'static str,
    /// Fewest arguments.
    pub least: usize,
    /// Most arguments.
    pub most: usize,
    /// What it gives.
    pub doc: &'static str,
    pub(super) meaning: Meaning,
}

/// How a call becomes nodes.
#[derive(Clone, Copy, Debug)]
pub(super) enum Meaning {
    Unary(Unary),
    Binary(Binary),
    /// The same for any number of arguments, from the left.
    Chain(Binary),
    Composed(fn(&mut Nodes, &[NodeId]) -> NodeId),
}

const fn unary(name: &'static str, unary: Unary, doc: &'static str) -> Function {
    Function { name, least: 1, most: 1, doc, meaning: Meaning::Unary(unary) }
}

const fn composed(
    name: &'static str,
    (least, most): (usize, usize),
    build: fn(&mut Nodes, &[NodeId]) -> NodeId,
    doc: &'static str,
) -> Function {
    Function { name, least, most, doc, meaning: Meaning::Composed(build) }
}

const MANY: usize = 16;

/// All functions. Angles are in radians.
pub const FUNCTIONS: &[Function] = &[
    unary("abs", Unary::Abs, "absolute value"),
    unary("sign", Unary::Sign, "-1, 0 or 1"),
    unary("sqrt", Unary::Sqrt, "square root"),
    unary("exp", Unary::Exp, "e to that power"),
    unary("log", Unary::Log, "natural logarithm"),
    unary("sin", Unary::Sin, "sine"),
    unary("cos", Unary::Cos, "cosine"),
    unary("tan", Unary::Tan, "tangent"),
    unary("asin", Unary::Asin, "arc sine"),
    unary("acos", Unary::Acos, "arc cosine"),
    unary("atan", Unary::Atan, "arc tangent"),
    unary("sinh", Unary::Sinh, "hyperbolic sine"),
    unary("cosh", Unary::Cosh, "hyperbolic cosine"),
    unary("tanh", Unary::Tanh, "hyperbolic tangent"),
    unary("floor", Unary::Floor, "greatest integer that is not greater"),
    Function {
        name: "atan2",
        least: 2,
        most: 2,
        doc: "angle of the point (second, first argument)",
        meaning: Meaning::Binary(Binary::Atan2),
    },
    Function {
        name: "min",
        least: 1,
        most: MANY,
        doc: "least of all arguments",
        meaning: Meaning::Chain(Binary::Min),
    },
    Function {
        name: "max",
        least: 1,
        most: MANY,
        doc: "greatest of all arguments",
        meaning: Meaning::Chain(Binary::Max),
    },
    composed("pow", (2, 2), |nodes, a| nodes.power(a[0], a[1]), "first to the power of the second"),
    composed("mod", (2, 2), modulo, "remainder with the sign of the second"),
    composed("clamp", (3, 3), |nodes, a| clamp(nodes, a[0], a[1], a[2]), "first, within second and third"),
    composed("mix", (3, 3), mix, "from first to second as the third goes from 0 to 1"),
    composed(
        "smoothstep",
        (3, 3),
        smoothstep,
        "a smooth step from 0 to 1 as the third goes from first to second",
    ),
    composed("length", (1, MANY), length, "square root of the sum of squares"),
    composed(
        "if",
        (3, 3),
        |nodes, a| nodes.select(a[0], a[1], a[2]),
        "second where first is not 0, else third",
    ),
];

/// a - b floor(a / b).
fn modulo(nodes: &mut Nodes, a: &[NodeId]) -> NodeId {
    let ratio = nodes.binary(Binary::Div, a[0], a[1]);
    let whole = nodes.unary(Unary::Floor, ratio);
    let part = nodes.binary(Binary::Mul, a[1], whole);
    nodes.binary(Binary::Sub, a[0], part)
}

fn clamp(nodes: &mut Nodes, x: NodeId, low: NodeId, high: NodeId) -> NodeId {
    let x = nodes.binary(Binary::Max, x, low);
    nodes.binary(Binary::Min, x, high)
}

/// a + (b - a) t.
fn mix(nodes: &mut Nodes, a: &[NodeId]) -> NodeId {
    let span = nodes.binary(Binary::Sub, a[1], a[0]);
    let part = nodes.binary(Binary::Mul, span, a[2]);
    nodes.binary(Binary::Add, a[0], part)
}

/// t² (3 - 2 t) with t the share of the way from a to b, clamped.
fn smoothstep(nodes: &mut Nodes, a: &[NodeId]) -> NodeId {
    let way = nodes.binary(Binary::Sub, a[2], a[0]);
    let span = nodes.binary(Binary::Sub, a[1], a[0]);
    let share = nodes.binary(Binary::Div, way, span);
    let [zero, one, two, three] = [0.0, 1.0, 2.0, 3.0].map(|value| nodes.constant(value));
    let t = clamp(nodes, share, zero, one);
    let double = nodes.binary(Binary::Mul, two, t);
    let rest = nodes.binary(Binary::Sub, three, double);
    let square = nodes.binary(Binary::Mul, t, t);
    nodes.binary(Binary::Mul, square, rest)
}

fn length(nodes: &mut Nodes, a: &[NodeId]) -> NodeId {
    let mut sum = nodes.binary(Binary::Mul, a[0], a[0]);
    for &x in &a[1..] {
        let square = nodes.binary(Binary::Mul, x, x);
        sum = nodes.binary(Binary::Add, sum, square);
    }
    nodes.unary(Unary::Sqrt, sum)
}
