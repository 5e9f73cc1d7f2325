//! What of the file the solution does not reach: coordinates that a field does not have, branches
//! that are never taken, and names that nothing uses.

use std::collections::{BTreeMap, HashSet};

use super::{Finding, Sampled, finding};
use crate::arithmetic::tape::{Tape, nodes_by};
use crate::arithmetic::{Graph, Node, NodeId};
use crate::derive::Role;
use crate::language::tree::{Tree, TreeKind};
use crate::model::Model;
use crate::problem::{Datum, Expression, Problem, Surface, TensorValue};

/// * `parts`: with their points.
pub(super) fn unreached(model: &Model, parts: &[Sampled<'_>]) -> Vec<Finding> {
    let mut findings = unused(&model.problem);
    // A field that is constant leaves no trace in expressions, unless it is kept.
    if let Ok(kept) = model.keeping_fields() {
        findings.extend(coordinates(model, &kept));
        findings.extend(branches(&kept, parts));
    }
    findings
}

/// The nodes that some are made of, without those of which fields are made.
fn outside_fields(graph: &Graph, roots: &[NodeId]) -> Vec<NodeId> {
    nodes_by(roots, |id| match graph.node(id) {
        Node::Field(..) => &[],
        node => node.operands(),
    })
}

/// One finding for each field and variable: the equations differentiate the field by it, and the
/// solution is constant along it.
fn coordinates(model: &Model, kept: &Model) -> Vec<Finding> {
    let mut derivatives = vec![];
    for source in kept.of_role(Role::Source) {
        for id in outside_fields(&kept.graph, &source.tensor.parts) {
            if let Node::Field(_, derivative) = kept.graph.node(id) {
                derivatives.push(derivative);
            }
        }
    }
    let names: Vec<&str> = model.problem.exact_fields().collect();
    let mut findings = vec![];
    for field in model.of_role(Role::Exact) {
        for (axis, variable) in model.problem.variables().into_iter().enumerate() {
            let mut parts = field.tensor.parts.iter();
            let varies = parts.any(|part| model.graph.depends_on(*part, axis));
            let is_differentiated = derivatives.iter().any(|derivative| {
                names[usize::from(derivative.field)] == field.name && derivative.times[axis] > 0
            });
            if !varies && is_differentiated {
                let text = format!(
                    "does not depend on {variable}, by which the equations differentiate it: a mistake in \
                     what acts along {variable} would not be noticed"
                );
                findings.push(finding("coordinate-unseen", &field.place.key, text, None));
            }
        }
    }
    findings
}

/// A comparison of expressions in fields, and the sides of it on which the points are.
struct Switch<'m> {
    key: &'m str,
    is_below: bool,
    is_above: bool,
}

/// One finding for each quantity with a switch that fields decide, and of which no point sees one
/// side.
fn branches(kept: &Model, parts: &[Sampled<'_>]) -> Vec<Finding> {
    let graph = &kept.graph;
    let mut switches: BTreeMap<[NodeId; 2], Switch<'_>> = BTreeMap::new();
    for Sampled { part, points, .. } in parts {
        let quantities = kept.part(*part).iter();
        for quantity in
            quantities.filter(|q| matches!(q.role, Role::Source | Role::Datum | Role::Initial))
        {
            for id in outside_fields(graph, &quantity.tensor.parts) {
                let Node::Choose(_, [left, right, ..]) = *graph.node(id) else {
                    continue;
                };
                let mut compared = outside_fields(graph, &[left, right]).into_iter();
                if !compared.any(|id| matches!(graph.node(id), Node::Field(..))) {
                    continue;
                }
                let switch = switches.entry([left, right]).or_insert(Switch {
                    key: &quantity.place.key,
                    is_below: false,
                    is_above: false,
                });
                let tape = Tape::new(graph, &[left, right]);
                for point in points {
                    let roots = tape.at(point).roots;
                    switch.is_below |= roots[0].value < roots[1].value;
                    switch.is_above |= roots[0].value > roots[1].value;
                }
            }
        }
    }
    let mut keys: Vec<&str> = vec![];
    for Switch {
        key,
        is_below,
        is_above,
    } in switches.into_values()
    {
        let is_seen = is_below && is_above;
        if !is_seen && !keys.contains(&key) {
            keys.push(key);
        }
    }
    let text = "what a switch of abs, min, max, where or heaviside compares is on one side at all points: a \
                mistake in the other branch, or no switch, would not be noticed";
    let findings = keys.into_iter();
    let findings = findings.map(|key| finding("branch-unseen", key, text.to_owned(), None));
    findings.collect()
}

/// Parameters, laws and fields that neither the equations, the data and the requirements have nor
/// what these are made of.
fn unused(problem: &Problem) -> Vec<Finding> {
    let mut open = of_test(problem);
    let mut used: HashSet<&str> = HashSet::new();
    while let Some(expression) = open.pop() {
        let mut trees = vec![&expression.tree];
        while let Some(tree) = trees.pop() {
            trees.extend(tree.children());
            let Some(name) = name_of(tree).filter(|name| used.insert(name)) else {
                continue;
            };
            if let Some(definition) = problem.definitions.get(name) {
                open.extend(definition.value.parts());
            }
            let mut parameters = problem.parameters.iter();
            let parameter = parameters.find(|parameter| parameter.name == name);
            open.extend(parameter.map(|parameter| &parameter.expression));
        }
    }
    let parameters = problem.parameters.iter();
    let parameters = parameters.map(|parameter| (&parameter.name, &parameter.expression.place.key));
    let definitions = problem.definitions.iter();
    let definitions = definitions.map(|(name, definition)| (name, &definition.value.place().key));
    let unused = parameters.chain(definitions);
    let unused = unused.filter(|(name, _)| !used.contains(name.as_str()));
    let text = "no equation and no datum needs it: whether a program has it right is not tested";
    let findings = unused.map(|(_, key)| finding("unused", key, text.to_owned(), None));
    findings.collect()
}

fn name_of(tree: &Tree) -> Option<&str> {
    match &tree.kind {
        TreeKind::Name(name) => Some(name),
        _ => None,
    }
}

/// The expressions of all equations, data and requirements, and of the domain.
fn of_test(problem: &Problem) -> Vec<&Expression> {
    let equations = problem.equations.iter();
    let terms = equations.flat_map(|equation| &equation.terms);
    let mut expressions: Vec<&Expression> = terms.map(|term| &term.expression).collect();
    let faces = problem.faces.iter();
    for Datum {
        value, condition, ..
    } in faces.flat_map(|face| &face.data).chain(&problem.initial)
    {
        let values = condition.iter().chain([value]);
        expressions.extend(values.flat_map(TensorValue::parts));
    }
    for face in &problem.faces {
        if let Surface::Level(level) = &face.surface {
            expressions.push(level);
        }
    }
    expressions.extend(problem.positive.iter().chain(&problem.zero));
    expressions.extend(&problem.ends);
    expressions
}
