//! Parameters that are set at run time: their values in the file are defaults, and those that
//! depend on one that is set follow.

use std::collections::HashMap;

use serde::Serialize;

use super::lower::Body;
use super::module::{Writer, declared};
use crate::model::Model;

#[derive(Serialize)]
pub(super) struct ModuleParameter {
    /// In the module.
    name: String,
    /// In the file.
    plain: String,
    value: String,
    /// The value by its bits, and in digits without a suffix.
    bits: String,
    digits: String,
    /// What follows.
    steps: Vec<Step>,
}

/// A parameter that gets the value of its expression.
#[derive(Serialize)]
struct Step {
    name: String,
    body: Body,
    /// The variant in which it is zero.
    zero_in: Option<usize>,
}

/// The names of all constants of the steps.
pub(super) fn set_by(parameters: &[ModuleParameter]) -> Vec<String> {
    let steps = parameters.iter().flat_map(|parameter| &parameter.steps);
    declared(steps.map(|step| &step.body))
}

pub(super) fn parameters(writer: &mut Writer<'_>) -> Vec<ModuleParameter> {
    let model = writer.models[0];
    let mut parameters = vec![];
    for (index, parameter) in model.problem.parameters.iter().enumerate() {
        let mut steps = vec![];
        let mut constants = HashMap::new();
        for follower in model.problem.followers(index) {
            let expression =
                |model: &Model| model.problem.parameters[follower].expression.text.clone();
            let of_file = expression(model);
            let mut models = writer.models.iter();
            steps.push(Step {
                name: writer.parameters[follower].clone(),
                zero_in: models.position(|model| expression(model) != of_file),
                body: writer.body(0, &[model.parameters[follower]], "", None, &mut constants),
            });
        }
        let value = model.graph.parameters[index];
        parameters.push(ModuleParameter {
            name: writer.parameters[index].clone(),
            plain: parameter.name.clone(),
            value: writer.language.number(value),
            bits: format!("{:#x}", value.to_bits()),
            digits: format!("{value:?}"),
            steps,
        });
    }
    parameters
}
