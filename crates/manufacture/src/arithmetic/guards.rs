//! What the choices above a node say about it: `where(x > 0, sqrt(x), 0)` needs no root of a
//! negative number.
//!
//! The value of a node takes part in a root only at points where each choice on some way to it takes
//! the branch that the way goes through. The branches that all ways have in common are taken
//! wherever the node takes part, and so is the result of their comparisons. These give signs to
//! nodes: left = right + (left - right), where a comparison restricts the sign of the difference.
//! Signs of other nodes follow by the rules of signs, as theorems about real numbers.

use super::enclosure::Over;
use super::interval::Interval;
use super::node::{Node, NodeId};
use crate::language::names::Function;
use crate::language::tree::{Binary, Comparison};

/// A sign is derived through so many operations: the sum over all ways is 2 to this power.
const DEPTH: usize = 6;

/// Branches of choices that take both in a box. Two bits for each choice: its first branch, and its
/// second.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct Branches(u64);

impl Branches {
    /// How many choices have bits; a branch of another choice says nothing.
    pub(super) const MOST: usize = 32;

    pub(super) const NONE: Self = Self(0);

    /// These, and a branch of the choice with this number.
    pub(super) fn with(self, choice: usize, is_first: bool) -> Self {
        if choice >= Self::MOST {
            return self;
        }
        Self(self.0 | 1 << (2 * choice + usize::from(!is_first)))
    }

    /// Those that two ways have in common.
    pub(super) fn common(self, other: Self) -> Self {
        Self(self.0 & other.0)
    }

    pub(super) fn has(self, choice: usize, is_first: bool) -> bool {
        self.0 & Self::NONE.with(choice, is_first).0 != 0
    }
}

/// The signs that a number may have.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct Signs {
    pub(super) negative: bool,
    pub(super) zero: bool,
    pub(super) positive: bool,
}

impl Signs {
    const ANY: Self = Self::of([true; 3]);
    const POSITIVE: Self = Self::of([false, false, true]);
    const NOT_NEGATIVE: Self = Self::of([false, true, true]);
    const NOT_ZERO: Self = Self::of([true, false, true]);

    const fn of([negative, zero, positive]: [bool; 3]) -> Self {
        Self {
            negative,
            zero,
            positive,
        }
    }

    pub(super) fn between(range: Interval) -> Self {
        Self::of([range.lo < 0.0, range.contains_zero(), range.hi > 0.0])
    }

    /// Whether only one sign is left, and that is not zero.
    fn are_one(self) -> bool {
        !self.zero && self.negative != self.positive
    }

    fn opposite(self) -> Self {
        Self::of([self.positive, self.zero, self.negative])
    }

    fn and(self, other: Self) -> Self {
        Self::of([
            self.negative && other.negative,
            self.zero && other.zero,
            self.positive && other.positive,
        ])
    }

    fn or(self, other: Self) -> Self {
        Self::of([
            self.negative || other.negative,
            self.zero || other.zero,
            self.positive || other.positive,
        ])
    }

    fn plus(self, other: Self) -> Self {
        let opposite = (self.negative && other.positive) || (self.positive && other.negative);
        Self::of([
            self.negative || other.negative,
            (self.zero && other.zero) || opposite,
            self.positive || other.positive,
        ])
    }

    fn times(self, other: Self) -> Self {
        Self::of([
            (self.negative && other.positive) || (self.positive && other.negative),
            self.zero || other.zero,
            (self.positive && other.positive) || (self.negative && other.negative),
        ])
    }

    /// Of left - right, where their comparison has this result.
    fn of_difference(comparison: Comparison, holds: bool) -> Self {
        let signs = match comparison {
            Comparison::Less => Self::of([true, false, false]),
            Comparison::LessOrEqual => Self::of([true, true, false]),
            Comparison::Greater => Self::POSITIVE,
            Comparison::GreaterOrEqual => Self::NOT_NEGATIVE,
        };
        if holds {
            signs
        } else {
            Self::of([!signs.negative, !signs.zero, !signs.positive])
        }
    }
}

/// A node, and the signs that it may have.
#[derive(Debug, Clone, Copy)]
struct Known {
    node: NodeId,
    signs: Signs,
}

/// A comparison with a known result.
#[derive(Debug, Clone, Copy)]
struct Compared {
    operands: [NodeId; 2],
    /// Of the first operand minus the second.
    difference: Signs,
}

/// What holds at the points of a box at which some choices take these branches.
#[derive(Debug)]
pub(super) struct Facts<'o, 'e, 'g> {
    over: &'o Over<'e, 'g>,
    compared: Vec<Compared>,
    known: Vec<Known>,
}

impl<'o, 'e, 'g> Facts<'o, 'e, 'g> {
    pub(super) fn new(over: &'o Over<'e, 'g>) -> Self {
        Self {
            over,
            compared: vec![],
            known: vec![],
        }
    }

    /// Adds that a choice takes its first branch, or its second.
    pub(super) fn add(&mut self, choice: NodeId, is_first: bool) {
        let Node::Choose(comparison, [left, right, ..]) = *self.over.node(choice) else {
            return;
        };
        let difference = Signs::of_difference(comparison, is_first);
        self.compared.push(Compared {
            operands: [left, right],
            difference,
        });
        let [of_left, of_right] = [left, right].map(|id| Signs::between(self.over.range(id)));
        self.learn(left, of_right.plus(difference));
        self.learn(right, of_left.plus(difference.opposite()));
    }

    /// Adds the signs of a node, and what follows for its operands.
    fn learn(&mut self, node: NodeId, signs: Signs) {
        if signs == Signs::ANY {
            return;
        }
        self.known.push(Known { node, signs });
        let not_zero = Signs {
            zero: signs.zero,
            ..Signs::ANY
        };
        match *self.over.node(node) {
            Node::Negate(operand) => self.learn(operand, signs.opposite()),
            // These are zero where their arguments are, and have their signs.
            Node::Call(function, argument) if keeps_the_sign(function) => {
                self.learn(argument, signs);
            }
            Node::Binary(Binary::Multiply, operands) => {
                for operand in operands {
                    self.learn(operand, not_zero);
                }
            }
            Node::Binary(Binary::Divide, [above, _]) => self.learn(above, not_zero),
            Node::Binary(Binary::Power, [base, exponent]) if self.over.range(exponent).lo > 0.0 => {
                self.learn(base, not_zero);
            }
            Node::Choose(..) => {
                if let Some(operand) = self.over.absolute_of(node) {
                    self.learn(operand, not_zero);
                }
            }
            _ => {}
        }
    }

    /// The signs of a node where the facts hold and it has a value.
    pub(super) fn signs(&self, id: NodeId) -> Signs {
        self.within(id, DEPTH)
    }

    fn within(&self, id: NodeId, depth: usize) -> Signs {
        let mut signs = Signs::between(self.over.range(id));
        for known in self.known.iter().filter(|known| known.node == id) {
            signs = signs.and(known.signs);
        }
        if depth == 0 || signs.are_one() {
            return signs;
        }
        signs.and(self.by_rule(id, depth - 1))
    }

    /// By the operation and the signs of its operands.
    fn by_rule(&self, id: NodeId, depth: usize) -> Signs {
        let of = |id: NodeId| self.within(id, depth);
        match *self.over.node(id) {
            Node::Negate(operand) => of(operand).opposite(),
            Node::Held(operand) => of(operand),
            Node::Binary(Binary::Add, [left, right]) => of(left).plus(of(right)),
            Node::Binary(Binary::Subtract, operands) => {
                let [left, right] = operands;
                let rule = of(left).plus(of(right).opposite());
                rule.and(self.difference(operands))
                    .and(self.difference([right, left]).opposite())
            }
            Node::Binary(Binary::Multiply, [left, right]) => of(left).times(of(right)),
            // A divisor is not zero where the quotient has a value.
            Node::Binary(Binary::Divide, [above, below]) => {
                of(above).times(of(below).and(Signs::NOT_ZERO))
            }
            Node::Binary(Binary::Power, [base, exponent]) => {
                of_power(of(base), self.over.range(exponent))
            }
            Node::Call(Function::Exp | Function::Cosh, _) => Signs::POSITIVE,
            Node::Call(function, argument) if keeps_the_sign(function) => of(argument),
            Node::Choose(_, [.., first, second]) => of(first).or(of(second)),
            _ => Signs::ANY,
        }
    }

    /// What comparisons say about a difference.
    fn difference(&self, operands: [NodeId; 2]) -> Signs {
        let compared = self.compared.iter();
        let same = compared.filter(|compared| compared.operands == operands);
        same.fold(Signs::ANY, |signs, compared| signs.and(compared.difference))
    }
}

/// Whether a function is zero where its argument is, and has its sign.
fn keeps_the_sign(function: Function) -> bool {
    matches!(
        function,
        Function::Sqrt | Function::Sinh | Function::Tanh | Function::Atan | Function::Asin
    )
}

/// Of a power that has a value.
fn of_power(base: Signs, exponent: Interval) -> Signs {
    if !base.negative {
        let zero = base.zero && exponent.hi > 0.0;
        // Zero to the power of zero is one.
        let positive = base.positive || exponent.contains_zero();
        return Signs::of([false, zero, positive]);
    }
    let is_even = exponent.lo == exponent.hi && exponent.lo % 2.0 == 0.0;
    Signs::of([!is_even, base.zero && exponent.hi >= 0.0, true])
}
