//! The part of a file that an operation of the graph comes from.

use super::margin::Margin;
use crate::against::site::{self, Span};
use crate::arithmetic::{Graph, NodeId};
use crate::derive::{Elaborator, Part};
use crate::language::names::Callee;
use crate::language::tree::{Binary, Tree, TreeKind};
use crate::model::Model;
use crate::problem::{Expression, InputError, Problem};

/// What an operation is applied to.
pub(super) struct Spot<'p> {
    pub(super) within: &'p Expression,
    pub(super) argument: &'p Tree,
}

impl Spot<'_> {
    pub(super) fn error(&self, problem: &str) -> InputError {
        let Expression { place, text, .. } = self.within;
        place.error_at(text, Span::of(self.argument).start, problem)
    }
}

/// The first place in the file, definitions before equations, whose value has an operation.
///
/// The file is derived anew: equal expressions are one node, so that a part of a text is known by
/// its node.
pub(super) fn find<'m>(model: &'m Model, margin: &Margin) -> Option<Spot<'m>> {
    let problem = &model.problem;
    let graph = Graph::new(problem.intervals.clone(), model.graph.parameters.clone());
    let mut elaborator = Elaborator::new(problem, graph);
    for part in Part::all(problem) {
        elaborator.part(part).ok()?;
    }
    for node in [margin.operations[0], margin.argument] {
        for within in expressions(problem) {
            if let Some(argument) = inside(&mut elaborator, &within.tree, within, node) {
                return Some(Spot { within, argument });
            }
        }
    }
    None
}

/// All expressions, definitions first.
fn expressions(problem: &Problem) -> impl Iterator<Item = &Expression> {
    let definitions = problem.definitions.values();
    let terms = problem
        .equations
        .iter()
        .flat_map(|equation| &equation.terms);
    let data = problem.faces.iter().flat_map(|face| &face.data);
    definitions
        .flat_map(|definition| site::parts(&definition.value))
        .chain(terms.map(|term| &term.expression))
        .chain(data.flat_map(|datum| site::parts(&datum.value)))
}

/// The argument of the innermost operation of a tree whose value, or whose argument, is the node.
fn inside<'t>(
    elaborator: &mut Elaborator<'_, Graph>,
    tree: &'t Tree,
    within: &Expression,
    node: NodeId,
) -> Option<&'t Tree> {
    for child in tree.children() {
        if let Some(argument) = inside(elaborator, child, within, node) {
            return Some(argument);
        }
    }
    let argument = match &tree.kind {
        TreeKind::Binary(Binary::Divide, operands) => &operands[1],
        TreeKind::Binary(Binary::Power, operands) => &operands[0],
        TreeKind::Call(Callee::Function(_) | Callee::Operator(_), parts) => parts.first()?,
        _ => return None,
    };
    let has_node = [tree, argument].into_iter().any(|tree| {
        let value = elaborator.tree(tree, within);
        value.is_ok_and(|value| value.parts.contains(&node))
    });
    has_node.then_some(match &argument.kind {
        TreeKind::Bracket(inner) => inner,
        _ => argument,
    })
}
