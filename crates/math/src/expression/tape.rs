//! A formula as a list of steps on few registers.

use super::nodes::{Binary, Node, NodeId, Nodes, Unary};
use super::number::Number;

/// Registers of formulas that are evaluated without asking for memory.
const FEW: usize = 32;

#[derive(Clone, Copy, Debug, PartialEq)]
enum Operation {
    Constant(f64),
    Variable(u8),
    Unary(Unary),
    Binary(Binary),
    Power(i32),
    Select,
}

/// An operation on registers.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Step {
    operation: Operation,
    operands: [u16; 3],
    result: u16,
}

/// Steps whose last one gives the value.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Tape {
    steps: Vec<Step>,
    n_registers: usize,
}

impl Tape {
    /// The steps that `root` needs. A register is free again after the last use of its value.
    pub(super) fn new(nodes: &Nodes, root: NodeId) -> Self {
        let nodes = &nodes.as_slice()[..=root as usize];
        let mut last_use = vec![None; nodes.len()];
        last_use[root as usize] = Some(nodes.len());
        for (index, node) in nodes.iter().enumerate().rev() {
            if last_use[index].is_some() {
                node.operands().for_each(|operand| {
                    last_use[operand as usize].get_or_insert(index);
                });
            }
        }
        let mut tape = Self { steps: Vec::new(), n_registers: 0 };
        let mut registers = vec![0_u16; nodes.len()];
        let mut free = Vec::new();
        for (index, node) in nodes.iter().enumerate() {
            if last_use[index].is_none() {
                continue;
            }
            let mut operands = [0; 3];
            for (slot, operand) in operands.iter_mut().zip(node.operands()) {
                *slot = registers[operand as usize];
                let last = &mut last_use[operand as usize];
                if *last == Some(index) {
                    // At most once, though the operand may stand here twice.
                    *last = None;
                    free.push(*slot);
                }
            }
            let result = free.pop().unwrap_or_else(|| {
                tape.n_registers += 1;
                (tape.n_registers - 1) as u16
            });
            registers[index] = result;
            tape.steps.push(Step { operation: operation(node), operands, result });
        }
        tape
    }

    pub(super) fn n_steps(&self) -> usize {
        self.steps.len()
    }

    pub(super) fn constant(&self) -> Option<f64> {
        match self.steps.last()?.operation {
            Operation::Constant(value) => Some(value),
            _ => None,
        }
    }

    /// The value with these variables.
    pub(super) fn run<T: Number>(&self, variables: &[T; 3]) -> T {
        let zero = T::constant(0.0);
        if self.n_registers <= FEW {
            self.run_in(&mut [zero; FEW], variables)
        } else {
            self.run_in(&mut vec![zero; self.n_registers], variables)
        }
    }

    fn run_in<T: Number>(&self, registers: &mut [T], variables: &[T; 3]) -> T {
        let mut value = T::constant(0.0);
        for step in &self.steps {
            let operand = |i: usize| registers[usize::from(step.operands[i])];
            value = match step.operation {
                Operation::Constant(value) => T::constant(value),
                Operation::Variable(index) => variables[usize::from(index)],
                Operation::Unary(f) => T::unary(f, operand(0)),
                Operation::Binary(f) => T::binary(f, operand(0), operand(1)),
                Operation::Power(n) => operand(0).power(n),
                Operation::Select => T::select(operand(0), operand(1), operand(2)),
            };
            registers[usize::from(step.result)] = value;
        }
        value
    }
}

fn operation(node: &Node) -> Operation {
    match *node {
        Node::Constant(value) => Operation::Constant(value),
        Node::Variable(index) => Operation::Variable(index),
        Node::Unary(f, _) => Operation::Unary(f),
        Node::Binary(f, ..) => Operation::Binary(f),
        Node::Power(_, n) => Operation::Power(n),
        Node::Select(..) => Operation::Select,
    }
}
