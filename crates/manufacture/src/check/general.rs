//! The same equations with other fields: what an edit changes for any solution.

use super::{Sampled, is_same, is_zero};
use crate::against::bench::{Alteration, Bench};
use crate::arithmetic::tape::SizedValue;
use crate::derive::{Part, Role};
use crate::language::parse;
use crate::model::Model;
use crate::problem::{Expression, TensorValue};

/// Points at which the fields are compared.
const POINTS: usize = 20;

/// A file with general fields for its exact solution, which cannot be made the same by chance.
pub(super) struct General {
    /// `None` if the equations have no values for such fields.
    bench: Option<Bench>,
    points: Vec<Vec<f64>>,
}

impl General {
    /// A field without divergence remains one: an equation may say so.
    pub(super) fn of(sampled: &Sampled<'_>, model: &Model) -> Self {
        let points: Vec<Vec<f64>> = sampled.points.iter().take(POINTS).cloned().collect();
        let mut problem = model.problem.clone();
        let names: Vec<String> = problem.definitions.keys().cloned().collect();
        for (number, name) in names.iter().enumerate() {
            let is_solenoidal = is_solenoidal(model, name, &points);
            let variables = problem.variables().join(" + 1.7*");
            let components = problem.axes().len();
            if let Some(definition) = problem.definitions.get_mut(name)
                && definition.is_exact
            {
                let mut fields = Fields {
                    variables,
                    number: 10 * number,
                };
                let potential = is_solenoidal
                    .then(|| fields.potential(components))
                    .flatten();
                definition.value = match potential {
                    Some(potential) => field(&definition.value, &potential),
                    None => fields.value(&definition.value),
                };
            }
        }
        Self {
            bench: Model::new(problem)
                .ok()
                .and_then(|model| Bench::new(&model, Part::Interior)),
            points,
        }
    }

    /// Whether an edit changes a source for these fields. Without values nothing is known, and the
    /// edit counts.
    pub(super) fn sees(&mut self, edit: &Alteration, source: &str) -> bool {
        let Some(bench) = &mut self.bench else {
            return true;
        };
        let mut values = |edit: Option<&Alteration>| {
            bench.altered(edit, source, |altered| {
                altered.at(&self.points, 1.0).collect::<Vec<_>>()
            })
        };
        let (Some(right), Some(edited)) = (values(None), values(Some(edit))) else {
            return true;
        };
        let mut pairs = right.iter().flatten().zip(edited.iter().flatten());
        !pairs.all(|(a, b)| is_same(a, b))
    }
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
