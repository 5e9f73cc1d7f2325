//! Trees that no text is parsed to.

use crate::language::names::{Callee, OperandAlteration, Operator};
use crate::language::tree::{Binary, Tree, TreeKind};

pub(crate) fn node(kind: TreeKind) -> Tree {
    Tree {
        kind,
        at: 0,
        end: 0,
    }
}

pub(crate) fn name(name: &str) -> Tree {
    node(TreeKind::Name(name.to_owned()))
}

pub(crate) fn number(text: &str, value: f64) -> Tree {
    node(TreeKind::Number(value, text.to_owned()))
}

/// How tightly an operation holds its parts together.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) enum Binding {
    Sum,
    Product,
    Sign,
    Power,
    Atom,
}

impl Binding {
    fn of(tree: &Tree) -> Self {
        match &tree.kind {
            TreeKind::Binary(Binary::Add | Binary::Subtract, _) => Self::Sum,
            TreeKind::Binary(Binary::Multiply | Binary::Divide, _) => Self::Product,
            TreeKind::Negate(_) => Self::Sign,
            TreeKind::Binary(Binary::Power, _) => Self::Power,
            _ => Self::Atom,
        }
    }
}

/// In brackets unless it binds at least as tightly.
pub(crate) fn bracketed(part: &Tree, least: Binding) -> Tree {
    if Binding::of(part) >= least {
        return part.clone();
    }
    node(TreeKind::Bracket(Box::new(part.clone())))
}

/// A part in the brackets that it needs in its place below a tree.
pub(crate) fn in_place(above: &Tree, place: usize, part: &Tree) -> Tree {
    let least = match (&above.kind, place) {
        (TreeKind::Binary(operator, _), place) => least(*operator, place),
        (TreeKind::Negate(_), _) => Binding::Sign,
        _ => Binding::Sum,
    };
    bracketed(part, least)
}

/// How tightly an operand must bind.
fn least(operator: Binary, place: usize) -> Binding {
    match (operator, place) {
        (Binary::Add | Binary::Subtract, 0) => Binding::Sum,
        (Binary::Add | Binary::Subtract, _) | (Binary::Multiply | Binary::Divide, 0) => {
            Binding::Product
        }
        (Binary::Multiply | Binary::Divide, _) => Binding::Sign,
        (Binary::Power, _) => Binding::Atom,
    }
}

/// An operation, with operands in the brackets that they need.
pub(crate) fn binary(operator: Binary, left: &Tree, right: &Tree) -> Tree {
    let operands = [
        bracketed(left, least(operator, 0)),
        bracketed(right, least(operator, 1)),
    ];
    node(TreeKind::Binary(operator, Box::new(operands)))
}

pub(crate) fn operator(operator: Operator, parts: &[&Tree]) -> Tree {
    let parts = parts.iter().map(|part| (*part).clone()).collect();
    node(TreeKind::Call(Callee::Operator(operator), parts))
}

pub(crate) fn held(tree: &Tree) -> Tree {
    operator(Operator::Altered(OperandAlteration::Held), &[tree])
}

/// A part times an unknown factor.
pub(crate) fn times_factor(tree: &Tree) -> Tree {
    operator(Operator::Altered(OperandAlteration::Scaled), &[tree])
}

/// What is multiplied by the unknown factor.
pub(crate) fn unscaled(tree: &Tree) -> Option<&Tree> {
    match &tree.kind {
        TreeKind::Call(Callee::Operator(Operator::Altered(OperandAlteration::Scaled)), parts) => {
            parts.first()
        }
        _ => None,
    }
}

pub(crate) fn is_sum(tree: &Tree) -> bool {
    Binding::of(tree) == Binding::Sum
}

/// Whether it is a product or a quotient.
pub(crate) fn is_chain(tree: &Tree) -> bool {
    Binding::of(tree) == Binding::Product
}

/// The operand of a gradient.
pub(crate) fn gradient(tree: &Tree) -> Option<&Tree> {
    match &tree.kind {
        TreeKind::Call(Callee::Operator(Operator::Gradient), parts) => parts.first(),
        _ => None,
    }
}
