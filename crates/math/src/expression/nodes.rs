//! A formula as a graph without repetition: equal parts are one node, and parts without variables are computed at once.

use std::collections::HashMap;

use super::number::{Number, Scalar};

/// Index of a node; operands come before what uses them.
pub(super) type NodeId = u32;

/// Functions of one argument.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub(super) enum Unary {
    Neg,
    Abs,
    Sign,
    Sqrt,
    Exp,
    Log,
    Sin,
    Cos,
    Tan,
    Asin,
    Acos,
    Atan,
    Sinh,
    Cosh,
    Tanh,
    Floor,
    Not,
}

/// Functions of two arguments. Comparisons give 1 or 0.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub(super) enum Binary {
    Add,
    Sub,
    Mul,
    Div,
    Min,
    Max,
    Atan2,
    /// With an exponent that is no integer constant; a negative base has no value.
    Pow,
    Less,
    LessOrEqual,
    Equal,
    And,
    Or,
}

/// A step of a formula.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Node {
    Constant(f64),
    Variable(u8),
    Unary(Unary, NodeId),
    Binary(Binary, NodeId, NodeId),
    /// To an integer power.
    Power(NodeId, i32),
    /// The second where the first is not 0, else the third.
    Select(NodeId, NodeId, NodeId),
}

impl Node {
    /// The nodes that it needs.
    pub(super) fn operands(&self) -> impl Iterator<Item = NodeId> + use<> {
        let (operands, n) = match *self {
            Self::Constant(_) | Self::Variable(_) => ([0; 3], 0),
            Self::Unary(_, a) | Self::Power(a, _) => ([a, 0, 0], 1),
            Self::Binary(_, a, b) => ([a, b, 0], 2),
            Self::Select(a, b, c) => ([a, b, c], 3),
        };
        operands.into_iter().take(n)
    }

    /// A key by which equal nodes are found.
    fn key(&self) -> (u8, u64, [NodeId; 3]) {
        match *self {
            Self::Constant(value) => (0, value.to_bits(), [0; 3]),
            Self::Variable(index) => (1, index.into(), [0; 3]),
            Self::Unary(f, a) => (2, f as u64, [a, 0, 0]),
            Self::Binary(f, a, b) => (3, f as u64, [a, b, 0]),
            Self::Power(a, n) => (4, u64::from(n.cast_unsigned()), [a, 0, 0]),
            Self::Select(a, b, c) => (5, 0, [a, b, c]),
        }
    }
}

/// Nodes in the order of their need.
#[derive(Debug, Default)]
pub(super) struct Nodes {
    nodes: Vec<Node>,
    known: HashMap<(u8, u64, [NodeId; 3]), NodeId>,
}

impl Nodes {
    /// More than any formula of people has; what bounds the time to evaluate.
    pub(super) const MAX: usize = 1 << 14;

    pub(super) fn as_slice(&self) -> &[Node] {
        &self.nodes
    }

    fn add(&mut self, node: Node) -> NodeId {
        *self.known.entry(node.key()).or_insert_with(|| {
            self.nodes.push(node);
            (self.nodes.len() - 1) as NodeId
        })
    }

    pub(super) fn constant_of(&self, id: NodeId) -> Option<f64> {
        match self.nodes[id as usize] {
            Node::Constant(value) => Some(value),
            _ => None,
        }
    }

    pub(super) fn constant(&mut self, value: f64) -> NodeId {
        self.add(Node::Constant(value))
    }

    pub(super) fn variable(&mut self, index: u8) -> NodeId {
        self.add(Node::Variable(index))
    }

    pub(super) fn unary(&mut self, f: Unary, a: NodeId) -> NodeId {
        match self.constant_of(a) {
            Some(a) => self.constant(f64::unary(f, a)),
            None => self.add(Node::Unary(f, a)),
        }
    }

    pub(super) fn binary(&mut self, f: Binary, a: NodeId, b: NodeId) -> NodeId {
        match (f, self.constant_of(a), self.constant_of(b)) {
            (_, Some(a), Some(b)) => self.constant(f64::binary(f, a, b)),
            (Binary::Add, Some(0.0), _) => b,
            (Binary::Add | Binary::Sub, _, Some(0.0)) => a,
            (Binary::Mul, Some(1.0), _) => b,
            (Binary::Mul | Binary::Div, _, Some(1.0)) => a,
            // A square is never negative, which the product of two intervals does not tell.
            (Binary::Mul, ..) if a == b => self.integer_power(a, 2),
            (Binary::Min | Binary::Max, ..) if a == b => a,
            // Sums and products do not depend on the order.
            (Binary::Add | Binary::Mul, ..) if b < a => self.add(Node::Binary(f, b, a)),
            _ => self.add(Node::Binary(f, a, b)),
        }
    }

    /// `a` to the power of `b`.
    pub(super) fn power(&mut self, a: NodeId, b: NodeId) -> NodeId {
        match self.constant_of(b) {
            Some(n) if n.fract() == 0.0 && n.abs() <= 1024.0 => self.integer_power(a, n as i32),
            Some(0.5) => self.unary(Unary::Sqrt, a),
            _ => self.binary(Binary::Pow, a, b),
        }
    }

    fn integer_power(&mut self, a: NodeId, n: i32) -> NodeId {
        match (self.constant_of(a), n) {
            (_, 0) => self.constant(1.0),
            (_, 1) => a,
            (Some(a), _) => self.constant(a.power(n)),
            (None, _) => self.add(Node::Power(a, n)),
        }
    }

    pub(super) fn select(&mut self, condition: NodeId, a: NodeId, b: NodeId) -> NodeId {
        match self.constant_of(condition) {
            Some(value) => match Scalar::truth(value) {
                Some(true) => a,
                Some(false) => b,
                None => condition,
            },
            None if a == b => a,
            None => self.add(Node::Select(condition, a, b)),
        }
    }
}
