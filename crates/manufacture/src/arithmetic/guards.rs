//! What the choices above a node say about it: `where(x > 0, sqrt(x), 0)` needs no root of a
//! negative number.
//!
//! The value of a node takes part in a root only at points where each choice on some way to it
//! takes the branch that the way goes through. The branches that all ways have in common are taken
//! wherever the node takes part, and so is the result of their comparisons. These give signs to
//! nodes: left = right + (left - right), where a comparison restricts the sign of the difference.
//! Signs of other nodes follow by the rules of signs, as theorems about real numbers.

use super::branches::Branches;
use super::conditions::{Condition, Need};
use super::enclosure::Over;
use super::node::{Node, NodeId};
use super::signs::Signs;
use crate::language::names::Function;
use crate::language::tree::Binary;

/// A sign is derived through so many operations: the sum over all ways is 2 to this power.
const DEPTH: usize = 6;

impl Over<'_, '_> {
    /// Of conditions that stand together, the first that may fail in the box.
    pub(crate) fn open(&self, conditions: &[Condition]) -> Option<Condition> {
        let is_open = |condition: &&Condition| match condition.need {
            Need::OneSide => {
                let is_used = self.uses_of(condition.operation).is_some();
                is_used && self.result(self.node(condition.argument)).is_none()
            }
            need => {
                !need.holds(self.range(condition.argument)) && self.may_be_used_without(condition)
            }
        };
        conditions.iter().find(is_open).copied()
    }

    /// Whether an operation may be used in the box where its argument lacks what it needs.
    fn may_be_used_without(&self, condition: &Condition) -> bool {
        let Some(branches) = self.uses_of(condition.operation) else {
            return false;
        };
        if branches == Branches::NONE {
            return true;
        }
        let mut facts = Facts::new(self);
        for (number, choice) in self.comparisons().iter().take(Branches::MOST).enumerate() {
            for is_first in [true, false] {
                if branches.has(number, is_first) {
                    facts.add(*choice, is_first);
                }
            }
        }
        !condition.need.holds_for(facts.signs(condition.argument))
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
                of(base).to_the(self.over.range(exponent))
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
