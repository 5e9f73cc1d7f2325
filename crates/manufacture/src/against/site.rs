//! The parts of a file that an edit can change: where they are in its trees, and in its text.

use crate::language::tree::{Tree, TreeKind};
use crate::problem::{Expression, Problem, TensorValue};

/// The expression that a part stands in.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) enum Home {
    /// A term of an equation, both by their places.
    Term { equation: usize, term: usize },
    /// A component of a definition, counted row by row.
    Definition { name: String, part: usize },
    /// A component of a datum of a face.
    Datum {
        face: usize,
        datum: usize,
        part: usize,
    },
    /// A parameter, by its place.
    Parameter(usize),
}

impl Home {
    pub(crate) fn expression<'p>(&self, problem: &'p Problem) -> Option<&'p Expression> {
        match self {
            Home::Term { equation, term } => {
                let terms = &problem.equations.get(*equation)?.terms;
                Some(&terms.get(*term)?.expression)
            }
            Home::Definition { name, part } => {
                parts(&problem.definitions.get(name)?.value).nth(*part)
            }
            Home::Datum { face, datum, part } => {
                parts(&problem.faces.get(*face)?.data.get(*datum)?.value).nth(*part)
            }
            Home::Parameter(place) => Some(&problem.parameters.get(*place)?.expression),
        }
    }

    /// Whether it belongs to the solution.
    pub(crate) fn is_exact(&self, problem: &Problem) -> bool {
        match self {
            Home::Definition { name, .. } => problem.definitions[name].is_exact,
            _ => false,
        }
    }

    pub(crate) fn expression_mut<'p>(
        &self,
        problem: &'p mut Problem,
    ) -> Option<&'p mut Expression> {
        match self {
            Home::Term { equation, term } => {
                let terms = &mut problem.equations.get_mut(*equation)?.terms;
                Some(&mut terms.get_mut(*term)?.expression)
            }
            Home::Definition { name, part } => {
                parts_mut(&mut problem.definitions.get_mut(name)?.value)
                    .into_iter()
                    .nth(*part)
            }
            Home::Datum { face, datum, part } => {
                let datum = problem.faces.get_mut(*face)?.data.get_mut(*datum)?;
                parts_mut(&mut datum.value).into_iter().nth(*part)
            }
            Home::Parameter(place) => Some(&mut problem.parameters.get_mut(*place)?.expression),
        }
    }
}

/// The expressions of a value, row by row.
pub(crate) fn parts(value: &TensorValue) -> Box<dyn Iterator<Item = &Expression> + '_> {
    match value {
        TensorValue::One(expression) => Box::new(std::iter::once(expression)),
        TensorValue::List(_, values) => Box::new(values.iter().flat_map(parts)),
    }
}

fn parts_mut(value: &mut TensorValue) -> Vec<&mut Expression> {
    match value {
        TensorValue::One(expression) => vec![expression],
        TensorValue::List(_, values) => values.iter_mut().flat_map(parts_mut).collect(),
    }
}

/// A part of an expression: which child of which child.
pub(crate) type Route = Vec<usize>;

pub(crate) fn at<'t>(tree: &'t Tree, route: &[usize]) -> Option<&'t Tree> {
    match route.split_first() {
        None => Some(tree),
        Some((first, rest)) => at(tree.children().get(*first)?, rest),
    }
}

pub(crate) fn at_mut<'t>(tree: &'t mut Tree, route: &[usize]) -> Option<&'t mut Tree> {
    match route.split_first() {
        None => Some(tree),
        Some((first, rest)) => at_mut(tree.children_mut().into_iter().nth(*first)?, rest),
    }
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
        TreeKind::Index(of, _) => start(of),
        _ => tree.at,
    }
}
