//! What a test with this solution would not notice, apart from terms and symmetries.

use std::collections::HashMap;
use std::ops::Range;

use super::{Finding, Sampled, Violation, finding, is_zero, unseen, violations};
use crate::arithmetic::tape::nodes_below;
use crate::arithmetic::{Node, NodeId};
use crate::derive::{DerivedQuantity, Part, Role, components};
use crate::language::tree::Binary;
use crate::model::Model;
use crate::problem::{InputError, Surface, System};
use crate::sample::Sampler;

pub(super) fn interior(model: &Model, sampled: &Sampled<'_>) -> Vec<Finding> {
    let mut findings = unseen::edits(model, sampled);
    let coordinates = model.problem.coordinates.len();
    for (index, quantity) in sampled.quantities.iter().enumerate() {
        match quantity.role {
            Role::Source => findings.extend(zero(model, sampled, index)),
            Role::Exact => {
                findings.extend(polynomial(model, 0..coordinates, quantity));
                let time = coordinates..model.problem.intervals.len();
                findings.extend(polynomial(model, time, quantity));
            }
            _ => (),
        }
    }
    findings
}

/// A source or a datum that is zero at all points, or has components that are.
fn zero(model: &Model, sampled: &Sampled<'_>, index: usize) -> Option<Finding> {
    let quantity = &sampled.quantities[index];
    let [code, subject, hidden] = match quantity.role {
        Role::Source => [
            "source-zero",
            "the source",
            "only boundary and initial data drive the test",
        ],
        Role::Initial => [
            "data-zero",
            "the initial value",
            "a program that does not set it would not be noticed",
        ],
        _ => [
            "data-zero",
            "the datum",
            "a term that is lost there would not be noticed",
        ],
    };
    let mut zeros = named_components(model, quantity);
    zeros.retain(|(place, _)| {
        let mut values = sampled.over(index);
        values.all(|(_, values)| is_zero(&values[*place..=*place]))
    });
    let is_whole = zeros.len() == quantity.tensor.parts.len();
    zeros.retain(|(place, _)| is_whole || !is_swirl(model, quantity, *place));
    if zeros.is_empty() {
        return None;
    }
    let names: Vec<String> = zeros.into_iter().map(|entry| entry.1).collect();
    let within = match is_whole {
        true => String::new(),
        false => format!(" in {}", names.join(", ")),
    };
    let text = format!("{subject} is zero{within}: {hidden}");
    Some(finding(code, &quantity.place.key, text, None))
}

/// The components of a quantity, each with its place.
fn named_components(model: &Model, quantity: &DerivedQuantity<NodeId>) -> Vec<(usize, String)> {
    let names = components(&model.problem, &quantity.name, &quantity.tensor.shape);
    names.into_iter().enumerate().collect()
}

/// Whether a component is that around the axis, which vectors have although nothing may turn.
fn is_swirl(model: &Model, quantity: &DerivedQuantity<NodeId>, component: usize) -> bool {
    let is_vector = quantity.tensor.shape.len() == 1;
    is_vector && model.problem.system == System::Axisymmetric && component == 1
}

/// A field that is a polynomial in some variables, or has components that are.
fn polynomial(
    model: &Model,
    variables: Range<usize>,
    quantity: &DerivedQuantity<NodeId>,
) -> Option<Finding> {
    let is_space = variables.start == 0;
    let [kind, reproduces] = match is_space {
        true => ["space", "elements of that degree reproduce it, the error"],
        false => [
            "time",
            "steps of that order reproduce it, the error in time",
        ],
    };
    let mut degrees = vec![];
    for (place, name) in named_components(model, quantity) {
        let degree = degree_of(model, variables.clone(), quantity.tensor.parts[place]);
        degrees.extend(degree.map(|degree| (place, name, degree)));
    }
    let is_whole = degrees.len() == quantity.tensor.parts.len();
    degrees.retain(|(place, _, degree)| match degree {
        // What is constant in time is not stepped.
        0.0 => is_space && (is_whole || !is_swirl(model, quantity, *place)),
        _ => true,
    });
    let degree = degrees.iter().map(|entry| entry.2).reduce(f64::max)?;
    let names: Vec<&str> = degrees.iter().map(|entry| entry.1.as_str()).collect();
    let (within, is) = match is_whole {
        true => (String::new(), "is"),
        false => (format!("in {} ", names.join(", ")), "may be"),
    };
    let text =
        format!("{within}a polynomial of degree {degree} in {kind}: {reproduces} {is} round-off");
    let key = &quantity.place.key;
    Some(finding("polynomial", key, text, Some(degree)))
}

/// The degree in some variables of a component that is a polynomial as it is written.
fn degree_of(model: &Model, variables: Range<usize>, part: NodeId) -> Option<f64> {
    let mut degrees: HashMap<NodeId, Option<f64>> = HashMap::new();
    for id in nodes_below(&model.graph, &[part]) {
        let degree = degree(model, variables.clone(), id, &degrees);
        degrees.insert(id, degree);
    }
    degrees[&part]
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

/// Data that are zero on their face, or at the first time.
pub(super) fn data(model: &Model, sampled: &Sampled<'_>) -> Vec<Finding> {
    let mut findings = vec![];
    for (index, quantity) in sampled.quantities.iter().enumerate() {
        let is_datum = matches!(quantity.role, Role::Datum | Role::Initial);
        // A value that must be zero says so in the file.
        let before = index
            .checked_sub(1)
            .map(|before| sampled.quantities[before].role);
        let is_held = matches!(before, Some(Role::Condition | Role::InitialCondition));
        if is_datum && !is_held {
            findings.extend(zero(model, sampled, index));
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
