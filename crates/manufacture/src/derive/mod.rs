//! The quantities of a file: exact values, sources, data, in any arithmetic.

mod choices;
mod elaborate;
mod integrals;
mod operators;
mod space;
pub(crate) mod tensor;
mod vary;

use crate::arithmetic::Algebra;
use crate::language::tree::Binary;
use crate::problem::{Datum, Equation, InputError, Location, Problem, Surface};

pub(crate) use elaborate::{AlteredExpression, Elaborator};
pub(crate) use space::Basis;
pub(crate) use tensor::Tensor;

/// What a quantity is for, in the order of what is emitted.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) enum Role {
    Exact,
    Gradient,
    /// A value of [define], which is emitted for its own sake.
    Definition,
    /// A term of an equation.
    Term,
    Source,
    /// All sources together.
    Sources,
    Normal,
    Datum,
    Initial,
    /// The value that the datum of that name must have.
    Condition,
    InitialCondition,
    Positive,
    Zero,
    /// Negative inside the domain.
    Level,
}

/// A quantity of the file.
#[derive(Debug, Clone)]
pub(crate) struct DerivedQuantity<N> {
    pub(crate) role: Role,
    pub(crate) name: String,
    /// Where the file has it.
    pub(crate) place: Location,
    pub(crate) tensor: Tensor<N>,
    /// Of a source: the label and value of each term.
    pub(crate) terms: Vec<(String, Tensor<N>)>,
}

/// The parts of the domain that quantities belong to.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Part {
    Interior,
    /// By its place among the faces.
    Face(usize),
    Initial,
}

impl Part {
    pub(crate) fn all(problem: &Problem) -> Vec<Part> {
        let faces = (0..problem.faces.len()).map(Part::Face);
        let initial = (!problem.initial.is_empty()).then_some(Part::Initial);
        std::iter::once(Part::Interior)
            .chain(faces)
            .chain(initial)
            .collect()
    }
}

/// The names of the components: `T`, `v_x`, `sigma_xy`; numbers if the length is not that of a
/// vector of the space.
pub(crate) fn components(problem: &Problem, name: &str, shape: &[usize]) -> Vec<String> {
    let axes = problem.axes();
    let mut names = vec![String::new()];
    for length in shape {
        let indices: Vec<String> = if *length == axes.len() {
            axes.clone()
        } else {
            (1..=*length).map(|index| index.to_string()).collect()
        };
        names = names
            .iter()
            .flat_map(|before| indices.iter().map(move |index| format!("{before}{index}")))
            .collect();
    }
    if shape.is_empty() {
        return vec![name.to_owned()];
    }
    names
        .iter()
        .map(|indices| format!("{name}_{indices}"))
        .collect()
}

impl<A: Algebra> Elaborator<'_, A> {
    /// All quantities of a part.
    pub(crate) fn part(
        &mut self,
        part: Part,
    ) -> Result<Vec<DerivedQuantity<A::Number>>, InputError> {
        match part {
            Part::Interior => self.interior(),
            Part::Face(index) => self.face(index),
            Part::Initial => {
                let initial = &self.problem.initial;
                self.data(initial, [Role::Initial, Role::InitialCondition])
            }
        }
    }

    fn interior(&mut self) -> Result<Vec<DerivedQuantity<A::Number>>, InputError> {
        let mut quantities = vec![];
        let problem = self.problem;
        for (name, definition) in &problem.definitions {
            let tensor = self.definition(name, &definition.value)?;
            if !definition.is_exact {
                continue;
            }
            let place = definition.value.place();
            if !self.space.refuses(&tensor) {
                let gradient = self.space.gradient(&mut self.algebra, &tensor);
                quantities.push(quantity(Role::Gradient, name, place, gradient));
            }
            quantities.push(quantity(Role::Exact, name, place, tensor));
        }
        for equation in &problem.equations {
            quantities.push(self.source(equation)?);
        }
        let required = [
            (Role::Positive, &problem.positive),
            (Role::Zero, &problem.zero),
        ];
        for (role, expressions) in required {
            for expression in expressions {
                let tensor = self.expression(expression)?;
                if role == Role::Positive && tensor.rank() > 0 {
                    let problem = format!("expected a scalar, found {}", tensor.words());
                    return Err(expression.place.error(problem));
                }
                let place = &expression.place;
                quantities.push(quantity(role, &expression.text, place, tensor));
            }
        }
        for face in &problem.faces {
            if let Surface::Level(expression) = &face.surface {
                let tensor = self.expression(expression)?;
                if tensor.rank() > 0 {
                    let problem = format!("expected a scalar, found {}", tensor.words());
                    return Err(expression.place.error(problem));
                }
                quantities.push(quantity(Role::Level, &face.name, &face.place, tensor));
            }
        }
        Ok(quantities)
    }

    /// The source of an equation, with its terms.
    pub(crate) fn source(
        &mut self,
        equation: &Equation,
    ) -> Result<DerivedQuantity<A::Number>, InputError> {
        let mut terms: Vec<(usize, String, Tensor<A::Number>)> = vec![];
        let mut total: Option<Tensor<A::Number>> = None;
        for term in &equation.terms {
            let mut tensor = self.expression(&term.expression)?;
            if term.is_negative {
                let minus = self.algebra.number(-1.0);
                tensor = tensor::scale(&mut self.algebra, Binary::Multiply, &tensor, &minus);
            }
            let sum = match &total {
                None => Ok(tensor.clone()),
                Some(total) if term.is_negative => {
                    // The sign is in the term: the message is about the term as written.
                    self.binary(Binary::Add, total, &tensor)
                        .map_err(|problem| problem.replace(" plus ", " minus "))
                }
                Some(total) => self.binary(Binary::Add, total, &tensor),
            };
            let label = &term.label;
            total = Some(sum.map_err(|problem| {
                let expression = &term.expression;
                let problem = format!("`{label}`: {problem}");
                expression
                    .place
                    .error_at(&expression.text, expression.tree.at, problem)
            })?);
            terms.push((term.place, label.clone(), tensor));
        }
        terms.sort_by_key(|term| term.0);
        let Some(tensor) = total else {
            return Err(equation
                .place
                .error("expected at least one term, found none"));
        };
        if tensor.rank() > 1 {
            let problem = format!("expected a scalar or a vector, found {}", tensor.words());
            return Err(equation.place.error(problem));
        }
        let terms = terms.into_iter().map(|(_, label, tensor)| (label, tensor));
        Ok(DerivedQuantity {
            terms: terms.collect(),
            ..quantity(Role::Source, &equation.name, &equation.place, tensor)
        })
    }

    fn face(&mut self, index: usize) -> Result<Vec<DerivedQuantity<A::Number>>, InputError> {
        let face = &self.problem.faces[index];
        let normal = match &face.surface {
            Surface::Level(expression) => {
                let level = self.expression(expression)?;
                self.space.normal(&mut self.algebra, &level)
            }
            Surface::Side {
                coordinate,
                is_upper,
            } => {
                let axes = self.problem.axes();
                let name = &self.problem.coordinates[*coordinate];
                let sign = if *is_upper { 1.0 } else { -1.0 };
                let mut parts = vec![];
                for axis in axes {
                    let part = if axis == *name { sign } else { 0.0 };
                    parts.push(self.algebra.number(part));
                }
                Tensor::vector(parts)
            }
        };
        let own = quantity(Role::Normal, &face.name, &face.place, normal.clone());
        let mut quantities = vec![own];
        self.normal = Some(normal);
        let data = self.data(&face.data, [Role::Datum, Role::Condition]);
        self.normal = None;
        quantities.extend(data?);
        Ok(quantities)
    }

    fn data(
        &mut self,
        data: &[Datum],
        [role, condition_role]: [Role; 2],
    ) -> Result<Vec<DerivedQuantity<A::Number>>, InputError> {
        let mut quantities = vec![];
        for datum in data {
            let tensor = self.value(&datum.value)?;
            if let Some(condition) = &datum.condition {
                let expected = self.value(condition)?;
                if expected.shape != tensor.shape {
                    let problem = format!(
                        "`of` is {}, `is` is {}; expected equal shapes",
                        tensor.words(),
                        expected.words()
                    );
                    return Err(condition.place().error(problem));
                }
                quantities.push(quantity(
                    condition_role,
                    &datum.name,
                    &datum.place,
                    expected,
                ));
            }
            quantities.push(quantity(role, &datum.name, &datum.place, tensor));
        }
        Ok(quantities)
    }
}

pub(crate) fn quantity<N>(
    role: Role,
    name: &str,
    place: &Location,
    tensor: Tensor<N>,
) -> DerivedQuantity<N> {
    DerivedQuantity {
        role,
        name: name.to_owned(),
        place: place.clone(),
        tensor,
        terms: vec![],
    }
}
