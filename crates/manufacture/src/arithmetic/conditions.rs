//! What operations need of their arguments to have a value.

use super::graph::Graph;
use super::interval::Interval;
use super::node::{Node, NodeId, operate};
use super::signs::Signs;
use crate::language::names::Function;
use crate::language::tree::Binary;

/// What an operation needs of its argument to have a value, or derivatives.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub(crate) enum Need {
    NonZero,
    Positive,
    NonNegative,
    /// From -1 to 1.
    Unit,
    /// No pole of the tangent.
    Tangent,
    /// A comparison with one result. Its argument is the choice.
    OneSide,
}

impl Need {
    /// Whether all numbers of the interval have it.
    pub(crate) fn holds(self, argument: Interval) -> bool {
        match self {
            Need::NonZero | Need::OneSide => !argument.contains_zero(),
            Need::Positive => argument.lo > 0.0,
            Need::NonNegative => argument.lo >= 0.0,
            Need::Unit => argument.lo >= -1.0 && argument.hi <= 1.0,
            Need::Tangent => !argument.has_pole_of_tan(),
        }
    }

    /// Whether all numbers with one of these signs have it.
    pub(super) fn holds_for(self, signs: Signs) -> bool {
        match self {
            Need::NonZero => !signs.zero,
            Need::Positive => !signs.zero && !signs.negative,
            Need::NonNegative => !signs.negative,
            Need::Unit | Need::Tangent | Need::OneSide => false,
        }
    }

    /// Whether no number of the interval has it, and not for being zero.
    pub(crate) fn is_violated(self, argument: Interval) -> bool {
        match self {
            Need::NonZero | Need::Tangent | Need::OneSide => false,
            Need::Positive | Need::NonNegative => argument.hi < 0.0,
            Need::Unit => argument.hi < -1.0 || argument.lo > 1.0,
        }
    }
}

/// An operation, and what it needs.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct Condition {
    pub(crate) operation: NodeId,
    pub(crate) argument: NodeId,
    pub(crate) need: Need,
    /// Of a quotient.
    pub(crate) numerator: Option<NodeId>,
}

/// What a function needs of its argument.
pub(super) fn needs_of(function: Function) -> Option<Need> {
    match function {
        Function::Ln | Function::Log10 => Some(Need::Positive),
        Function::Sqrt => Some(Need::NonNegative),
        Function::Asin | Function::Acos => Some(Need::Unit),
        Function::Tan => Some(Need::Tangent),
        _ => None,
    }
}

/// What a node needs of its operands.
pub(super) fn conditions_of(graph: &Graph, id: NodeId) -> Vec<Condition> {
    let condition = |argument: NodeId, need: Need| Condition {
        operation: id,
        argument,
        need,
        numerator: None,
    };
    match *graph.node(id) {
        Node::Binary(Binary::Divide, [above, below]) => {
            let mut conditions = vec![];
            for argument in factors(graph, below) {
                conditions.push(Condition {
                    numerator: Some(above),
                    ..condition(argument, Need::NonZero)
                });
            }
            conditions
        }
        Node::Binary(Binary::Power, [base, exponent]) => match value(graph, exponent) {
            Some(power) if power.fract() == 0.0 && power >= 0.0 => vec![],
            Some(power) if power.fract() == 0.0 => {
                let factors = factors(graph, base).into_iter();
                factors
                    .map(|argument| condition(argument, Need::NonZero))
                    .collect()
            }
            Some(power) if power > 0.0 => vec![condition(base, Need::NonNegative)],
            _ => vec![condition(base, Need::Positive)],
        },
        Node::Call(function, argument) => {
            let need = needs_of(function).into_iter();
            need.map(|need| condition(argument, need)).collect()
        }
        Node::Choose(..) => vec![condition(id, Need::OneSide)],
        _ => vec![],
    }
}

/// The value of an exponent: of a number, a parameter, or sums and products of these.
fn value(graph: &Graph, id: NodeId) -> Option<f64> {
    match *graph.node(id) {
        Node::Parameter(index) => Some(graph.parameters[index]),
        Node::Negate(inner) => value(graph, inner).map(|value| -value),
        Node::Binary(operator, [left, right]) => {
            Some(operate(operator, value(graph, left)?, value(graph, right)?))
        }
        _ => graph.constant(id),
    }
}

/// The parts of a divisor that are zero where it is zero.
fn factors(graph: &Graph, id: NodeId) -> Vec<NodeId> {
    match *graph.node(id) {
        Node::Negate(inner) | Node::Call(Function::Sqrt, inner) => factors(graph, inner),
        Node::Call(Function::Exp | Function::Cosh, _) => vec![],
        Node::Call(Function::Sinh | Function::Tanh | Function::Atan | Function::Asin, argument) => {
            factors(graph, argument)
        }
        Node::Binary(Binary::Multiply, [left, right]) => {
            let mut both = factors(graph, left);
            both.extend(factors(graph, right));
            both
        }
        Node::Binary(Binary::Divide, [above, _]) => factors(graph, above),
        Node::Binary(Binary::Power, [base, exponent]) => match value(graph, exponent) {
            // Where a negative power has a value it is not zero.
            Some(power) if power < 0.0 => vec![],
            Some(_) => factors(graph, base),
            None => vec![id],
        },
        _ => match graph.constant(id) {
            Some(number) if number != 0.0 => vec![],
            _ => vec![id],
        },
    }
}
