//! Trees that no text is parsed to.

use super::super::bench::FACTOR;
use crate::language::names::{self, Callee, Operator};
use crate::language::tree::{Binary, Tree, TreeKind};

pub(crate) fn node(kind: TreeKind) -> Tree {
    Tree {
        kind,
        at: 0,
        end: 0,
    }
}

pub(super) fn name(name: &str) -> Tree {
    node(TreeKind::Name(name.to_owned()))
}

pub(crate) fn number(text: &str, value: f64) -> Tree {
    node(TreeKind::Number(value, text.to_owned()))
}

pub(super) fn binary(operator: Binary, left: &Tree, right: &Tree) -> Tree {
    node(TreeKind::Binary(
        operator,
        Box::new([left.clone(), right.clone()]),
    ))
}

pub(super) fn operator(operator: Operator, parts: &[&Tree]) -> Tree {
    let parts = parts.iter().map(|part| (*part).clone()).collect();
    node(TreeKind::Call(Callee::Operator(operator), parts))
}

pub(super) fn held(tree: &Tree) -> Tree {
    operator(Operator::Altered(names::OperandAlteration::Held), &[tree])
}

/// A part times an unknown factor.
pub(super) fn times_factor(tree: &Tree) -> Tree {
    binary(Binary::Multiply, tree, &name(FACTOR))
}

/// Whether brackets around it change nothing.
pub(super) fn is_chain(tree: &Tree) -> bool {
    matches!(
        tree.kind,
        TreeKind::Binary(Binary::Multiply | Binary::Divide, _)
    )
}

/// The operand of a gradient.
pub(super) fn gradient(tree: &Tree) -> Option<&Tree> {
    match &tree.kind {
        TreeKind::Call(Callee::Operator(Operator::Gradient), parts) => parts.first(),
        _ => None,
    }
}
