//! The tables of a file, as structs that serde reads. Their comments are the words of messages,
//! schemas and pages.

use std::collections::BTreeMap;

use schemars::JsonSchema;
use serde::Deserialize;

use super::entries::{Components, DatumForm, Entry, FaceTable, LeftSide, Located};
use super::entries::{Order, Resolutions};
use super::{Norm, System};

/// Entries by names that the user chooses, in alphabetical order: no result depends on their order
/// in the file.
pub(super) type Named<T> = BTreeMap<String, Located<T>>;

/// A file: its fields are its tables.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, expecting = "a table")]
pub struct ProblemFile {
    /// what the file is about
    pub(super) manufacture: Located<HeadTable>,
    /// the interval of each coordinate and of time, as two numbers or expressions of parameters
    pub(super) domain: Located<Named<Vec<Located<Entry>>>>,
    /// numbers, or expressions of other parameters
    #[serde(default)]
    pub(super) parameters: Named<Entry>,
    /// the chosen solution: a text is a scalar, a list a vector, a list of lists a tensor
    #[schemars(with = "BTreeMap<String, Components>")]
    pub(super) exact: Named<Entry>,
    /// laws and abbreviations: scalars, vectors or tensors
    #[serde(default)]
    #[schemars(with = "BTreeMap<String, Components>")]
    pub(super) define: Named<Entry>,
    /// the left side of each equation, whose value is the source: a text is cut into terms at its +
    /// and -, a table has terms by name
    #[schemars(with = "BTreeMap<String, LeftSide>")]
    pub(super) equations: Located<Named<Entry>>,
    /// the data on each face: `x_min`, `x_max`, ..., or any name with `face` or `level`
    #[serde(default)]
    #[schemars(with = "BTreeMap<String, FaceTable>")]
    pub(super) boundary: Named<Entry>,
    /// the values at the first time
    #[serde(default)]
    #[schemars(with = "Option<BTreeMap<String, DatumForm>>")]
    pub(super) initial: Option<Located<Named<Entry>>>,
    /// what must hold at all points of the domain
    #[serde(default)]
    pub(super) require: RequireTable,
    /// the norms of the error of each field
    #[serde(default)]
    pub(super) norms: Named<Vec<Norm>>,
    /// what the variants of `--variants` may change beside the solution
    pub(super) variants: Option<VariantsTable>,
    /// a study of the solver, which is written beside the files of a language
    pub(super) study: Option<StudyTable>,
}

/// `[manufacture]`.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, expecting = "a table")]
pub(super) struct HeadTable {
    /// an identifier: everything that is written begins with it
    pub(super) name: Located<String>,
    /// the names of one to three coordinates
    pub(super) coordinates: Located<Vec<Located<String>>>,
    /// the name of time; without it the problem is stationary
    pub(super) time: Option<Located<String>>,
    /// the coordinate system: polar is (r, theta), axisymmetric (r, z), cylindrical (r, theta, z)
    #[serde(default)]
    pub(super) system: System,
}

/// `[require]`.
#[derive(Debug, Default, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, expecting = "a table")]
pub(super) struct RequireTable {
    /// expressions that must be positive
    #[serde(default)]
    pub(super) positive: Vec<Located<Entry>>,
    /// expressions that must be zero
    #[serde(default)]
    pub(super) zero: Vec<Located<Entry>>,
}

/// `[variants]`.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, expecting = "a table")]
pub(super) struct VariantsTable {
    /// parameters that the program takes from the emitted module, each of which a variant sets to
    /// zero
    pub(super) parameters: Vec<Located<String>>,
}

/// `[study]`.
#[derive(Debug, Clone, PartialEq, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, expecting = "a table")]
pub(crate) struct StudyTable {
    /// the solver and its arguments; `{n}` stands for the resolution
    pub(crate) command: Vec<String>,
    /// the resolutions of the study
    pub(crate) n: Resolutions,
    /// the order of each error, by names such as "T L2"
    pub(crate) order: BTreeMap<String, Order>,
}
