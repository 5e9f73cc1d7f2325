//! Parameters that nothing of the test shows: with another value all sources and data are the same.

use std::iter;

use super::{Finding, Sampled, finding, is_same};
use crate::derive::{Part, Role};
use crate::model::Model;
use crate::problem::{ParameterValue, Problem, mentions};

/// Points of each part at which values are compared.
const POINTS: usize = 50;

/// A factor that no law of scaling hides.
const CHANGE: f64 = 1.3;

/// One finding for each parameter that an equation or a datum names, and that changes no source and
/// no datum.
pub(super) fn unseen(model: &Model, parts: &[Sampled<'_>]) -> Vec<Finding> {
    // Without values inside nothing is known.
    if parts.iter().all(|part| part.part != Part::Interior) {
        return vec![];
    }
    let problem = &model.problem;
    let parameters = problem.parameters.iter().enumerate();
    let unseen = parameters.filter(|(index, _)| {
        let value = match model.graph.parameters[*index] {
            0.0 => 1.0,
            value => CHANGE * value,
        };
        let changed = ParameterValue {
            parameter: *index,
            value,
        };
        let values = problem.parameter_values(&[changed]);
        is_in_test(problem, *index)
            && values
                .is_ok_and(|values| parts.iter().all(|part| is_unchanged(model, part, &values)))
    });
    let findings = unseen.map(|(_, parameter)| {
        let text = "no source and no datum changes with it: a program with another value, or without \
                    what it stands for, would pass";
        let key = format!("parameters.{}", parameter.name);
        finding("parameter-unseen", &key, text.to_owned(), None)
    });
    findings.collect()
}

/// Whether an equation, or a datum that is given, has a parameter, or what depends on it.
fn is_in_test(problem: &Problem, parameter: usize) -> bool {
    let places = iter::once(parameter).chain(problem.followers(parameter));
    let names: Vec<&str> = places
        .map(|place| problem.parameters[place].name.as_str())
        .collect();
    let definitions = problem.depending(|part| names.iter().any(|name| mentions(&part.tree, name)));
    let faces = problem.faces.iter().flat_map(|face| &face.data);
    // A value that must hold is the same whatever its factors are.
    let data = faces.chain(&problem.initial);
    let data = data.filter(|datum| datum.condition.is_none());
    let data = data.flat_map(|datum| datum.value.parts());
    let equations = problem.equations.iter();
    let terms = equations.flat_map(|equation| &equation.terms);
    let mut expressions = terms.map(|term| &term.expression).chain(data);
    expressions.any(|expression| {
        let mut names = names.iter().copied().chain(definitions.iter().copied());
        names.any(|name| mentions(&expression.tree, name))
    })
}

/// Whether sources and data are the same with other parameters.
fn is_unchanged(model: &Model, part: &Sampled<'_>, parameters: &[f64]) -> bool {
    let rows = model.rows(part.quantities);
    let mut points = part.points.iter().zip(&part.values).take(POINTS);
    points.all(|(point, before)| {
        let after = rows.with(point, parameters).tensors;
        let quantities = part.quantities.iter().zip(before.iter().zip(&after));
        let mut shown = quantities.filter(|(quantity, _)| {
            matches!(quantity.role, Role::Source | Role::Datum | Role::Initial)
        });
        shown.all(|(_, (before, after))| before.iter().zip(after).all(|(a, b)| is_same(a, b)))
    })
}
