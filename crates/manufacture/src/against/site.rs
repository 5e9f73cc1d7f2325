//! The parts of a file that an edit can change: where they are in its trees, and in its text.

use crate::language::tree::{Tree, TreeKind};

/// A part of an expression: which child of which child.
pub(crate) type Route = Vec<usize>;

pub(crate) fn at<'t>(tree: &'t Tree, route: &[usize]) -> Option<&'t Tree> {
    match route.split_first() {
        None => Some(tree),
        Some((first, rest)) => at(tree.children().get(*first)?, rest),
    }
}

fn at_mut<'t>(tree: &'t mut Tree, route: &[usize]) -> Option<&'t mut Tree> {
    match route.split_first() {
        None => Some(tree),
        Some((first, rest)) => at_mut(tree.children_mut().get_mut(*first)?, rest),
    }
}

/// A tree with another part.
pub(crate) fn replaced(tree: &Tree, route: &[usize], new: Tree) -> Tree {
    let mut whole = tree.clone();
    if let Some(part) = at_mut(&mut whole, route) {
        *part = new;
    }
    whole
}

/// The names in a tree.
pub(crate) fn names<'t>(tree: &'t Tree, found: &mut Vec<&'t str>) {
    if let TreeKind::Name(name) = &tree.kind {
        found.push(name);
    }
    for child in tree.children() {
        names(child, found);
    }
}

/// The bytes of an expression's text that a part of it takes.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct Span {
    pub(crate) start: usize,
    pub(crate) end: usize,
}

impl Span {
    pub(crate) fn of(tree: &Tree) -> Self {
        Self {
            start: start(tree),
            end: tree.end,
        }
    }
}

fn start(tree: &Tree) -> usize {
    match &tree.kind {
        TreeKind::Binary(_, operands) | TreeKind::Compare(_, operands) => start(&operands[0]),
        TreeKind::Index(parts) => start(&parts[0]),
        _ => tree.at,
    }
}
