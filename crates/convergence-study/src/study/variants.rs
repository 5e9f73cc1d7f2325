//! Variants of a study's solution: each switches off what one part of a solver can get wrong. If
//! the order is there again, this part is where it was lost.

use std::collections::BTreeMap;

use serde::{Deserialize, Serialize};

/// A part of a solver, or several of one sort, as a variant switches it off.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
#[serde(tag = "part", content = "name", rename_all = "snake_case")]
pub enum SolverPart {
    /// All that acts along a coordinate.
    Coordinate(String),
    /// All that acts along time, by its name.
    Time(String),
    /// The data of a face, such as `x_max`.
    Face(String),
    /// Both faces of a coordinate.
    BothFaces(String),
    /// All faces that have data.
    AllFaces,
    /// All faces that have data, but this.
    AllFacesBut(String),
    /// The data at the first time.
    Initial,
    /// All faces that have data, and the data at the first time.
    AllFacesAndInitial,
    /// The term of a parameter.
    Parameter(String),
    /// What acts on a field.
    Field(String),
}

/// A variant that can be run.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Variant {
    /// Its name, such as `flat_x_max`.
    pub name: String,
    /// What it switches off.
    pub switches_off: SolverPart,
    /// The size of its solution, in any unit that is the same for all: errors are compared in
    /// proportion to it.
    pub size: f64,
}

/// A variant that cannot be run, although the solution has the part.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct LeftOutVariant {
    /// Its name.
    pub name: String,
    /// What it would switch off.
    pub switches_off: SolverPart,
    /// Why it cannot be run.
    pub why: String,
}

/// The variants of a solution.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Variants {
    /// The size of the solution itself.
    pub size: f64,
    /// Those that can be run.
    pub usable: Vec<Variant>,
    /// The others: nothing is known of these parts.
    pub left_out: Vec<LeftOutVariant>,
    /// The conditions at each face, by their names.
    pub data: BTreeMap<String, Vec<String>>,
}
