//! The same equations with other fields: what an edit changes for any solution.

use super::is_zero;
use crate::arithmetic::tape::SizedValue;
use crate::derive::Role;
use crate::language::parse;
use crate::model::Model;
use crate::problem::{Expression, TensorValue};

/// A file with general fields for its exact solution, which cannot be made the same by chance;
/// `None` if the equations have no values for such fields.
///
/// A field without divergence at some points remains one: an equation may say so.
pub(super) fn model(of: &Model, points: &[Vec<f64>]) -> Option<Model> {
    let mut problem = of.problem.clone();
    let variables = problem.variables().join(" + 1.7*");
    let components = problem.axes().len();
    let definitions = problem.definitions.iter_mut().enumerate();
    for (number, (name, definition)) in definitions.filter(|entry| entry.1.1.is_exact) {
        let mut fields = Fields {
            variables: variables.clone(),
            number: 10 * number,
        };
        let potential = match is_solenoidal(of, name, points) {
            true => fields.potential(components),
            false => None,
        };
        definition.value = match potential {
            Some(potential) => field(&definition.value, &potential),
            None => fields.value(&definition.value),
        };
    }
    Model::new(problem).ok()
}

/// Whether a vector has no divergence at the points: the trace of its gradient.
fn is_solenoidal(model: &Model, name: &str, points: &[Vec<f64>]) -> bool {
    let mut gradients = model.of_role(Role::Gradient);
    let Some(gradient) = gradients.find(|q| q.name == name) else {
        return false;
    };
    let Some(rows) = gradient.tensor.square() else {
        return false;
    };
    let values = model.rows([gradient]);
    points.iter().all(|point| {
        let parts = values.at(point).tensors.remove(0);
        let diagonal = (0..rows).map(|row| parts[row * (rows + 1)]);
        let trace = diagonal.fold([0.0, 0.0], |[value, size], part| {
            [value + part.value, size + part.size]
        });
        let [value, size] = trace;
        is_zero(&[SizedValue { value, size }])
    })
}

/// Functions of all variables, each another one.
struct Fields {
    /// A sum of all variables.
    variables: String,
    number: usize,
}

impl Fields {
    /// Of no symmetry and no constant ratio to another, between 1 and 2.
    fn function(&mut self) -> String {
        self.number += 1;
        let number = self.number;
        let wave = &self.variables;
        let first = self.variables.split(' ').next().unwrap_or("1");
        format!(
            "1.5 + 0.3*sin(0.{number}1*({wave}) + 0.4*{first}^2 + {number}) + 0.2*cos({wave} + 0.1*({wave})^2 - 1.{number}*{first})"
        )
    }

    /// A field without divergence: the curl of another; `None` in one dimension.
    fn potential(&mut self, components: usize) -> Option<String> {
        match components {
            2 => Some(format!("curl({})", self.function())),
            3 => {
                let parts: Vec<String> = (0..3).map(|_| self.function()).collect();
                Some(format!("curl([{}])", parts.join(", ")))
            }
            _ => None,
        }
    }

    /// Of the same rank and length, where these are written out.
    fn value(&mut self, value: &TensorValue) -> TensorValue {
        match value {
            TensorValue::One(_) => field(value, &self.function()),
            TensorValue::List(place, parts) => {
                let parts = parts.iter().map(|part| self.value(part)).collect();
                TensorValue::List(place.clone(), parts)
            }
        }
    }
}

/// A text in the place of a value.
fn field(value: &TensorValue, text: &str) -> TensorValue {
    match parse(text) {
        Ok(tree) => TensorValue::One(Expression {
            place: value.place().clone(),
            text: text.to_owned(),
            tree,
        }),
        Err(_) => value.clone(),
    }
}
