//! The nodes of a graph, and what their operations compute.

use crate::language::names::Function;
use crate::language::tree::{Binary, Relation};

/// A node's place in its graph. Operands come before what is made of them.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub(crate) struct NodeId(pub(crate) u32);

/// An operation on nodes.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub(crate) enum Node {
    /// By its bits, so that equal numbers are one node.
    Number(u64),
    Variable(usize),
    Parameter(usize),
    Negate(NodeId),
    Binary(Binary, [NodeId; 2]),
    Call(Function, NodeId),
    /// The comparison of the first two; where it holds the third, else the fourth.
    Choose(Relation, [NodeId; 4]),
    /// Over the interval of a variable, cut into panels.
    Integral {
        body: NodeId,
        variable: usize,
        panels: usize,
    },
    /// A value that derivatives take for a constant: the search for mistakes makes it.
    Held(NodeId),
    /// A derivative of an exact field, behind which nothing is simplified: solutions that take each
    /// other's place have the same expressions in their fields.
    Field(NodeId, FieldDerivative),
}

/// Which derivative of which field.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub(crate) struct FieldDerivative {
    /// The place among the exact fields.
    pub(crate) field: u16,
    pub(crate) component: u16,
    /// How often by each variable.
    pub(crate) times: [u8; 4],
}

impl Node {
    /// The nodes that its value is made of at the same point.
    pub(crate) fn operands(&self) -> &[NodeId] {
        match self {
            Node::Negate(operand)
            | Node::Call(_, operand)
            | Node::Held(operand)
            | Node::Field(operand, _) => std::slice::from_ref(operand),
            Node::Binary(_, operands) => operands,
            Node::Choose(_, operands) => operands,
            _ => &[],
        }
    }
}

/// All nodes of a graph, as those who evaluate them see them.
#[derive(Debug, Default)]
pub(crate) struct Nodes {
    pub(super) list: Vec<Node>,
    /// The interval of each variable.
    pub(crate) intervals: Vec<[f64; 2]>,
    /// The values of the parameters in the file.
    pub(crate) parameters: Vec<f64>,
}

impl Nodes {
    pub(crate) fn len(&self) -> usize {
        self.list.len()
    }

    pub(crate) fn node(&self, id: NodeId) -> &Node {
        &self.list[id.0 as usize]
    }

    /// Its value, if it is a number.
    pub(crate) fn constant(&self, id: NodeId) -> Option<f64> {
        match self.node(id) {
            Node::Number(bits) => Some(f64::from_bits(*bits)),
            _ => None,
        }
    }
}

/// The value of a binary operation.
pub(crate) fn operate(operator: Binary, left: f64, right: f64) -> f64 {
    match operator {
        Binary::Add => left + right,
        Binary::Subtract => left - right,
        Binary::Multiply => left * right,
        Binary::Divide => left / right,
        Binary::Power => left.powf(right),
    }
}

/// The value of a smooth function.
pub(crate) fn apply(function: Function, x: f64) -> f64 {
    match function {
        Function::Sin => x.sin(),
        Function::Cos => x.cos(),
        Function::Tan => x.tan(),
        Function::Asin => x.asin(),
        Function::Acos => x.acos(),
        Function::Atan => x.atan(),
        Function::Sinh => x.sinh(),
        Function::Cosh => x.cosh(),
        Function::Tanh => x.tanh(),
        Function::Exp => x.exp(),
        Function::Ln => x.ln(),
        Function::Log10 => x.log10(),
        Function::Sqrt => x.sqrt(),
    }
}
