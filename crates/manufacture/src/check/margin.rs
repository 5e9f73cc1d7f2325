//! What operations need of their arguments, as numbers that are zero where it is lost.

use crate::arithmetic::tape::{SizedValue, Tape, nodes_below};
use crate::arithmetic::{Graph, Node, NodeId};
use crate::language::names::Function;
use crate::language::tree::Binary;

/// A value so small against its size is zero but for rounding.
pub(crate) const ROUNDING: f64 = 64.0 * f64::EPSILON;

/// What an operation needs of its argument.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Need {
    /// Of a divisor, and of the base of a negative whole power.
    NonZero,
    /// Of the angle of `tan`: its cosine is not zero.
    Tangent,
    /// Of what the file requires to be positive, which no operation needs.
    Required,
    /// Of `ln`, `log10`, of the base of a power that is not whole, and negative or unknown.
    Positive,
    /// Of `sqrt`, of the base of a positive power that is not whole.
    NotNegative,
    /// Of `asin`, `acos`: 1 - |argument| is not negative.
    Unit,
}

/// A node, and the operations that need the same of it.
#[derive(Debug)]
pub(crate) struct Margin {
    pub(crate) argument: NodeId,
    pub(crate) need: Need,
    pub(crate) operations: Vec<NodeId>,
}

impl Margin {
    /// Of an operation that needs something.
    pub(crate) fn of(graph: &Graph, operation: NodeId) -> Option<Self> {
        let (argument, need) = match *graph.node(operation) {
            Node::Binary(Binary::Divide, [_, below]) => match graph.constant(below) {
                Some(number) if number != 0.0 => return None,
                _ => (below_roots(graph, below), Need::NonZero),
            },
            Node::Binary(Binary::Power, [base, exponent]) => match constant(graph, exponent) {
                Some(power) if power.fract() == 0.0 && power >= 0.0 => return None,
                Some(power) if power.fract() == 0.0 => (base, Need::NonZero),
                Some(power) if power > 0.0 => (base, Need::NotNegative),
                _ => (base, Need::Positive),
            },
            Node::Call(function, argument) => match function {
                Function::Ln | Function::Log10 => (argument, Need::Positive),
                Function::Sqrt => (argument, Need::NotNegative),
                Function::Asin | Function::Acos => (argument, Need::Unit),
                Function::Tan => (argument, Need::Tangent),
                _ => return None,
            },
            _ => return None,
        };
        Some(Self {
            argument,
            need,
            operations: vec![operation],
        })
    }

    /// Zero, or negative, where the operations have no value; `None` where none is evaluated.
    ///
    /// * `needed`: of a tape. Operations that are no part of it are evaluated everywhere.
    pub(crate) fn at(&self, needed: &[Option<SizedValue>]) -> Option<SizedValue> {
        let mut operations = self.operations.iter().map(|id| needed.get(id.0 as usize));
        let is_evaluated = self.need == Need::Required
            || operations.any(|value| value.is_none_or(Option::is_some));
        let argument = needed[self.argument.0 as usize].filter(|_| is_evaluated)?;
        let SizedValue { value, size } = argument;
        let at = match self.need {
            Need::Tangent => SizedValue {
                value: value.cos(),
                size: size.max(1.0),
            },
            Need::Unit => SizedValue {
                value: 1.0 - value.abs(),
                size: 1.0 + size,
            },
            _ => argument,
        };
        at.value.is_finite().then_some(at)
    }

    /// Whether the operations have no value.
    ///
    /// * `least`: a margin up to this is zero, as is one that is rounding alone.
    pub(crate) fn is_lost(&self, at: SizedValue, least: f64) -> bool {
        let is_zero = at.value.abs() <= least.max(ROUNDING * at.size);
        match self.need {
            Need::NonZero | Need::Tangent => is_zero,
            Need::Positive => is_zero || at.value < 0.0,
            Need::Required => at.value <= 0.0,
            Need::NotNegative | Need::Unit => at.value < 0.0,
        }
    }

    /// Whether there is no value around, either.
    pub(crate) fn is_outside(&self, at: SizedValue) -> bool {
        let has_one_side = !matches!(self.need, Need::NonZero | Need::Tangent);
        has_one_side && at.value < -ROUNDING * at.size
    }
}

/// What is below square roots and powers less than 1, which are zero with it, but fall to zero so
/// steeply that no point shows it.
fn below_roots(graph: &Graph, of: NodeId) -> NodeId {
    match *graph.node(of) {
        Node::Call(Function::Sqrt, inner) => below_roots(graph, inner),
        Node::Binary(Binary::Power, [base, exponent]) => match constant(graph, exponent) {
            Some(power) if 0.0 < power && power < 1.0 => below_roots(graph, base),
            _ => of,
        },
        _ => of,
    }
}

/// The value of a node that changes with no variable.
fn constant(graph: &Graph, id: NodeId) -> Option<f64> {
    let point: Vec<f64> = graph.intervals.iter().map(|side| side[0]).collect();
    let mut variables = 0..point.len();
    let is_constant = !variables.any(|variable| graph.depends_on(id, variable));
    is_constant.then(|| Tape::new(graph, &[id]).at(&point).roots[0].value)
}

/// The margins below some roots.
pub(crate) fn margins(graph: &Graph, roots: &[NodeId]) -> Vec<Margin> {
    let mut margins: Vec<Margin> = vec![];
    for operation in nodes_below(graph, roots) {
        let Some(margin) = Margin::of(graph, operation) else {
            continue;
        };
        let mut known = margins.iter_mut();
        match known.find(|known| known.argument == margin.argument && known.need == margin.need) {
            Some(known) => known.operations.push(operation),
            None => margins.push(margin),
        }
    }
    margins
}
