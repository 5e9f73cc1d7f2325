//! What a test with this solution would not notice, apart from terms and symmetries.

use super::{Finding, Sampled, Violation, finding, is_zero, unseen, violations};
use std::collections::HashMap;
use std::ops::Range;

use crate::arithmetic::tape::nodes_below;
use crate::arithmetic::{Node, NodeId};
use crate::derive::{Part, Role};
use crate::language::tree::Binary;
use crate::model::Model;
use crate::problem::{InputError, Surface};
use crate::sample::Sampler;

pub(super) fn interior(model: &Model, sampled: &Sampled<'_>) -> Vec<Finding> {
    let mut findings = unseen::edits(model, sampled);
    for (index, quantity) in sampled.quantities.iter().enumerate() {
        let key = &quantity.place.key;
        match quantity.role {
            Role::Source if sampled.over(index).all(|entry| is_zero(entry.1)) => {
                let text = "the source is zero: only boundary and initial data drive the test";
                findings.push(finding("source-zero", key, text.to_owned(), None));
            }
            Role::Exact => {
                let coordinates = model.problem.coordinates.len();
                if let Some(degree) = polynomial(model, 0..coordinates, &quantity.tensor.parts) {
                    let text = format!(
                        "a polynomial of degree {degree} in space: elements of that degree reproduce it, the error is round-off"
                    );
                    findings.push(finding("polynomial", key, text, Some(degree)));
                }
                let time = coordinates..model.problem.intervals.len();
                let degree = polynomial(model, time, &quantity.tensor.parts);
                if let Some(degree) = degree.filter(|degree| *degree > 0.0) {
                    let text = format!(
                        "a polynomial of degree {degree} in time: steps of that order reproduce it, the error in time is round-off"
                    );
                    findings.push(finding("polynomial", key, text, Some(degree)));
                }
            }
            _ => (),
        }
    }
    findings
}

/// The degree in some variables, if all components are polynomials as they are written.
fn polynomial(model: &Model, variables: Range<usize>, parts: &[NodeId]) -> Option<f64> {
    let mut degrees: HashMap<NodeId, Option<f64>> = HashMap::new();
    for id in nodes_below(&model.graph, parts) {
        let degree = degree(model, variables.clone(), id, &degrees);
        degrees.insert(id, degree);
    }
    let parts = parts.iter().map(|part| degrees[part]);
    parts.reduce(|a, b| Some(a?.max(b?))).flatten()
}

/// The degree of a node by those of its operands.
fn degree(
    model: &Model,
    mut variables: Range<usize>,
    id: NodeId,
    degrees: &HashMap<NodeId, Option<f64>>,
) -> Option<f64> {
    let graph = &model.graph;
    if !variables.any(|variable| graph.depends_on(id, variable)) {
        return Some(0.0);
    }
    let of = |id: &NodeId| degrees[id];
    match graph.node(id) {
        Node::Variable(_) => Some(1.0),
        Node::Negate(operand) => of(operand),
        Node::Binary(operator, [left, right]) => match operator {
            Binary::Add | Binary::Subtract => Some(of(left)?.max(of(right)?)),
            Binary::Multiply => Some(of(left)? + of(right)?),
            Binary::Divide => (of(right)? == 0.0).then_some(of(left)?),
            Binary::Power => {
                let exponent = graph.constant(*right)?;
                let is_whole = exponent.fract() == 0.0 && exponent >= 0.0;
                is_whole.then_some(of(left)? * exponent)
            }
        },
        _ => None,
    }
}

/// Data that are zero on their face.
pub(super) fn data(sampled: &Sampled<'_>) -> Vec<Finding> {
    let mut findings = vec![];
    for (index, quantity) in sampled.quantities.iter().enumerate() {
        let is_datum = quantity.role == Role::Datum;
        // A value that must be zero says so in the file.
        let has_condition = index > 0 && sampled.quantities[index - 1].role == Role::Condition;
        if is_datum && !has_condition && sampled.over(index).all(|entry| is_zero(entry.1)) {
            let text = "zero on its face: a term that is lost there would not be noticed";
            findings.push(finding(
                "data-zero",
                &quantity.place.key,
                text.to_owned(),
                None,
            ));
        }
    }
    findings
}

/// Faces on which a switch lies, of the first quantity that has one: there the values are those of
/// one branch.
pub(super) fn switches(model: &Model, sampler: &mut Sampler<'_>) -> Vec<Finding> {
    const POINTS: usize = 20;
    let names = model.problem.variables();
    let mut faces = vec![];
    for (axis, interval) in model.problem.intervals.iter().enumerate() {
        for end in interval {
            let mut sides = model.problem.intervals.clone();
            sides[axis] = [*end; 2];
            let face = format!("{} = {end}", names[axis]);
            faces.push((face, sampler.within(&sides, POINTS)));
        }
    }
    for (index, face) in model.problem.faces.iter().enumerate() {
        if let Surface::Level(_) = face.surface {
            let points = sampler.everywhere(Part::Face(index), POINTS);
            faces.push((face.name.clone(), points));
        }
    }
    let quantities = model.part(Part::Interior).iter();
    let quantities = quantities.filter(|q| matches!(q.role, Role::Exact | Role::Source));
    let quantities: Vec<_> = quantities
        .map(|q| (q, sampler.switches(Part::Interior, model.rows([q]))))
        .collect();
    let mut findings = vec![];
    for (face, points) in faces {
        let mut quantities = quantities.iter();
        let first = quantities.find(|(_, switches)| switches.have_one_below(&points));
        if let Some((quantity, _)) = first {
            let text = format!(
                "a switch of abs, min, max, where or heaviside lies on the face {face}: the values \
                 there are those of one branch, and so are those of a solver with points on it"
            );
            findings.push(finding("switch-on-face", &quantity.place.key, text, None));
        }
    }
    findings
}

fn has_initial(model: &Model, name: &str) -> bool {
    let mut initial = model.problem.initial.iter();
    initial.any(|datum| datum.name == name)
}

/// Values required on a face that contradict the initial data at the first time.
pub(super) fn initial_mismatch(
    model: &Model,
    sampler: &mut Sampler<'_>,
) -> Result<Vec<Finding>, InputError> {
    let Some(first) = model.problem.first_time() else {
        return Ok(vec![]);
    };
    let mut findings = vec![];
    for (index, face) in model.problem.faces.iter().enumerate() {
        let mut conditions = face.data.iter().filter(|datum| datum.condition.is_some());
        if !conditions.any(|datum| has_initial(model, &datum.name)) {
            continue;
        }
        let mut points = sampler.points(Part::Face(index), 100)?;
        for point in &mut points {
            if let Some(time) = point.last_mut() {
                *time = first;
            }
        }
        let sampled = Sampled::new(model, Part::Face(index), points);
        for Violation { quantity, .. } in violations(&sampled) {
            if has_initial(model, &quantity.name) {
                let text = format!(
                    "at the first time its `is` contradicts initial.{}",
                    quantity.name
                );
                findings.push(finding("initial-mismatch", &quantity.place.key, text, None));
            }
        }
    }
    Ok(findings)
}
