//! The part of a file that an operation of the graph comes from.

use crate::against::site::{Span, parts};
use crate::arithmetic::conditions::Condition;
use crate::arithmetic::{Graph, NodeId};
use crate::derive::{Elaborator, Part};
use crate::language::names::Callee;
use crate::language::tree::{Binary, Tree, TreeKind};
use crate::model::Model;
use crate::problem::{Expression, InputError, Problem, Surface};

/// A part of an expression: what an operation is applied to.
pub(super) struct Spot<'p> {
    within: &'p Expression,
    argument: &'p Tree,
}

impl Spot<'_> {
    pub(super) fn argument(&self) -> String {
        self.argument.to_string()
    }

    pub(super) fn error(&self, problem: &str) -> InputError {
        let Expression { place, text, .. } = self.within;
        place.error_at(text, Span::of(self.argument, text).start, problem)
    }
}

/// The first place in the file, definitions before equations, whose value has an operation.
///
/// The file is derived anew: equal expressions are one node, so that a part of a text is known by
/// its node.
pub(super) fn find<'m>(model: &'m Model, condition: &Condition) -> Option<Spot<'m>> {
    let problem = &model.problem;
    let graph = Graph::new(problem.intervals.clone(), model.graph.parameters.clone());
    let mut elaborator = Elaborator::new(problem, graph);
    for part in Part::all(problem) {
        elaborator.part(part).ok()?;
    }
    for node in [condition.operation, condition.argument] {
        for within in expressions(problem) {
            if let Some(argument) = inside(&mut elaborator, &within.tree, within, node) {
                return Some(Spot { within, argument });
            }
        }
    }
    None
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
    let mut has = |tree: &Tree| {
        let value = elaborator.tree(tree, within);
        value.is_ok_and(|value| value.parts.contains(&node))
    };
    if !has(tree) && !has(argument) {
        return None;
    }
    match &argument.kind {
        TreeKind::Bracket(inner) => Some(inner),
        _ => Some(argument),
    }
}

fn expressions(problem: &Problem) -> Vec<&Expression> {
    let mut all: Vec<&Expression> = vec![];
    for definition in problem.definitions.values() {
        all.extend(parts(&definition.value));
    }
    for equation in &problem.equations {
        all.extend(equation.terms.iter().map(|term| &term.expression));
    }
    for face in &problem.faces {
        if let Surface::Level(level) = &face.surface {
            all.push(level);
        }
    }
    let faces = problem.faces.iter().flat_map(|face| &face.data);
    for datum in faces.chain(&problem.initial) {
        all.extend(parts(&datum.value));
        all.extend(datum.condition.iter().flat_map(parts));
    }
    all.extend(problem.positive.iter().chain(&problem.zero));
    all
}
