//! What a file says: names, domain, solution, equations, data.

mod canonical;
mod constant;
mod entries;
mod error;
mod file;
mod reader;
mod sections;
mod variation;

use std::collections::{BTreeMap, HashSet};

use schemars::JsonSchema;
use serde::Deserialize;

use crate::language::tree::Tree;

pub(crate) use constant::constant;
pub use error::InputError;
pub(crate) use error::{LineColumn, Location};
pub use file::ProblemFile;
pub(crate) use file::StudyTable;
pub(crate) use variation::{Bubble, Variation, VariationStep};

/// A text of the file, parsed.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Expression {
    pub(crate) place: Location,
    pub(crate) text: String,
    pub(crate) tree: Tree,
}

/// A scalar, or a vector, or rows of a tensor.
#[derive(Debug, Clone, PartialEq)]
pub(crate) enum TensorValue {
    One(Expression),
    List(Location, Vec<TensorValue>),
}

/// The coordinate systems.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Deserialize, JsonSchema)]
#[serde(rename_all = "lowercase")]
pub(crate) enum System {
    #[default]
    Cartesian,
    Polar,
    Axisymmetric,
    Cylindrical,
}

impl System {
    /// As written in a file.
    pub(crate) fn name(self) -> &'static str {
        match self {
            System::Cartesian => "cartesian",
            System::Polar => "polar",
            System::Axisymmetric => "axisymmetric",
            System::Cylindrical => "cylindrical",
        }
    }
}

/// A number with a name.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Parameter {
    pub(crate) name: String,
    pub(crate) expression: Expression,
}

impl Parameter {
    /// Whether its expression names another.
    pub(crate) fn depends_on(&self, other: &Self) -> bool {
        mentions(&self.expression.tree, &other.name)
    }
}

/// Another value of a parameter, by its place.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct ParameterValue {
    pub(crate) parameter: usize,
    pub(crate) value: f64,
}

/// What a name of `[exact]` or `[define]` stands for.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Definition {
    pub(crate) value: TensorValue,
    pub(crate) is_exact: bool,
}

/// A summand of an equation.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct EquationTerm {
    pub(crate) label: String,
    /// Its place in the file. Terms are added in another order, which does not depend on that of
    /// the keys.
    pub(crate) place: usize,
    pub(crate) is_negative: bool,
    /// The text that the tree belongs to.
    pub(crate) expression: Expression,
}

/// A left side.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Equation {
    pub(crate) name: String,
    pub(crate) place: Location,
    pub(crate) terms: Vec<EquationTerm>,
}

/// Where data are given.
#[derive(Debug, Clone, PartialEq)]
pub(crate) enum Surface {
    /// A side of the box: the coordinate, and whether at its upper end.
    Side { coordinate: usize, is_upper: bool },
    /// Where a function is zero that is negative inside.
    Level(Expression),
}

/// A quantity whose values are given on a face, or must have given values there.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Datum {
    pub(crate) name: String,
    pub(crate) place: Location,
    pub(crate) value: TensorValue,
    pub(crate) condition: Option<TensorValue>,
}

/// A part of the boundary.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Face {
    pub(crate) name: String,
    pub(crate) place: Location,
    pub(crate) surface: Surface,
    pub(crate) data: Vec<Datum>,
}

/// A norm of an error.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Deserialize, JsonSchema)]
pub(crate) enum Norm {
    L1,
    L2,
    Linf,
    H1,
}

impl Norm {
    pub(crate) fn name(self) -> &'static str {
        match self {
            Norm::L1 => "L1",
            Norm::L2 => "L2",
            Norm::Linf => "Linf",
            Norm::H1 => "H1",
        }
    }
}

/// A file, read and checked by itself; shapes are checked when it is derived.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Problem {
    pub(crate) file: String,
    pub(crate) name: String,
    pub(crate) name_place: Location,
    pub(crate) coordinates: Vec<String>,
    pub(crate) time: Option<String>,
    pub(crate) system: System,
    /// Of each coordinate, then of time.
    pub(crate) intervals: Vec<[f64; 2]>,
    /// The ends of the intervals, as they are written.
    pub(crate) ends: Vec<Expression>,
    /// Each after those that it depends on.
    pub(crate) parameters: Vec<Parameter>,
    pub(crate) definitions: BTreeMap<String, Definition>,
    pub(crate) equations: Vec<Equation>,
    pub(crate) faces: Vec<Face>,
    pub(crate) initial: Vec<Datum>,
    pub(crate) positive: Vec<Expression>,
    pub(crate) zero: Vec<Expression>,
    pub(crate) norms: Vec<(String, Vec<Norm>)>,
    pub(crate) study: Option<StudyTable>,
    /// The parameters that variants may set to zero.
    pub(crate) switchable: Vec<String>,
    /// Of a variant: what it does to the exact fields.
    pub(crate) variation: Option<Variation>,
}

impl Problem {
    /// The names of `[exact]`.
    pub(crate) fn exact_fields(&self) -> impl Iterator<Item = &str> {
        let exact = self.definitions.iter().filter(|entry| entry.1.is_exact);
        exact.map(|entry| entry.0.as_str())
    }

    /// The definitions with such an expression, and those that name one of them.
    pub(crate) fn depending(&self, is_start: impl Fn(&Expression) -> bool) -> HashSet<&str> {
        let mut found = HashSet::<&str>::new();
        loop {
            let before = found.len();
            for (name, definition) in &self.definitions {
                let depends = |part: &&Expression| {
                    is_start(part) || found.iter().any(|name| mentions(&part.tree, name))
                };
                if definition.value.parts().iter().any(depends) {
                    found.insert(name.as_str());
                }
            }
            if found.len() == before {
                return found;
            }
        }
    }

    /// The names of the components of a vector.
    pub(crate) fn axes(&self) -> Vec<String> {
        let mut axes = self.coordinates.clone();
        if self.system == System::Axisymmetric {
            axes.insert(1, "theta".to_owned());
        }
        axes
    }

    /// The coordinates, then time.
    pub(crate) fn variables(&self) -> Vec<&str> {
        let time = self.time.iter();
        self.coordinates
            .iter()
            .chain(time)
            .map(String::as_str)
            .collect()
    }

    /// The parameters that depend on one, each after those that it depends on.
    pub(crate) fn followers(&self, index: usize) -> Vec<usize> {
        let mut changed = vec![index];
        for (place, parameter) in self.parameters.iter().enumerate().skip(index + 1) {
            let mut others = changed.iter().map(|changed| &self.parameters[*changed]);
            if others.any(|other| parameter.depends_on(other)) {
                changed.push(place);
            }
        }
        changed.split_off(1)
    }

    /// The values of the parameters, with some of them replaced; those that depend on them follow.
    pub(crate) fn parameter_values(
        &self,
        replaced: &[ParameterValue],
    ) -> Result<Vec<f64>, InputError> {
        let mut values: Vec<(&str, f64)> = vec![];
        for (index, Parameter { name, expression }) in self.parameters.iter().enumerate() {
            let setting = replaced.iter().find(|setting| setting.parameter == index);
            let value = match setting {
                Some(setting) => setting.value,
                None => constant(expression, &values)?,
            };
            values.push((name, value));
        }
        Ok(values.into_iter().map(|entry| entry.1).collect())
    }

    /// The interval of time, if there is time.
    pub(crate) fn first_time(&self) -> Option<f64> {
        self.time.as_ref()?;
        self.intervals.last().map(|interval| interval[0])
    }
}

impl TensorValue {
    /// The place of all of it.
    pub(crate) fn place(&self) -> &Location {
        match self {
            TensorValue::One(expression) => &expression.place,
            TensorValue::List(place, _) => place,
        }
    }

    /// Its expressions, row by row.
    pub(crate) fn parts(&self) -> Vec<&Expression> {
        match self {
            TensorValue::One(expression) => vec![expression],
            TensorValue::List(_, values) => values.iter().flat_map(TensorValue::parts).collect(),
        }
    }
}

/// Whether a name occurs in a tree.
pub(crate) fn mentions(tree: &Tree, name: &str) -> bool {
    use crate::language::tree::TreeKind;
    matches!(&tree.kind, TreeKind::Name(known) if known == name)
        || tree.children().iter().any(|child| mentions(child, name))
}
