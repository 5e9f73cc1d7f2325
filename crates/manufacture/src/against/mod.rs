//! A source, or data of a face, that another program computes: is it the right one, and if not,
//! what is wrong with it?
//!
//! | file | holds |
//! | --- | --- |
//! | `ask.rs`, `right.rs` | the other program's values, and the right ones |
//! | `candidates/`, `site.rs` | all single edits of the file, by their places in its trees and its text |
//! | `bench.rs` | what becomes of a quantity after an edit |
//! | `solve.rs` | the factor of an edit |
//! | `explain.rs`, `whole.rs` | the edit that fits at a few points, then everywhere; what concerns all of a component |
//! | `cause.rs`, `text.rs` | causes with their data, their words, their places and texts |

pub(crate) mod ask;
pub(crate) mod bench;
pub(crate) mod candidates;
pub(crate) mod cause;
mod explain;
mod right;
pub(crate) mod site;
mod solve;
pub(crate) mod text;
mod whole;

pub use cause::Edit;

use serde::Serialize;

use crate::Sampling;
use crate::derive::{Part, Role};
use crate::language::names::unknown;
use crate::model::Model;
use crate::problem::InputError;
use crate::sample::Sampler;

use right::Right;

/// What was found out about a quantity of another program.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Comparison {
    /// The component, such as `v_x`.
    pub quantity: String,
    /// The largest absolute difference from the right value.
    pub difference: f64,
    /// The first cause that explains all points.
    pub cause: &'static str,
    /// The terms, the component or the parameter that the cause is about.
    pub terms: Vec<String>,
    /// A factor for each term, or the number that the cause is about.
    pub factors: Vec<f64>,
    /// The change of the file that gives the values of the other program; none where they are
    /// right or unexplained, and where the cause is about all of them.
    pub edits: Vec<Edit>,
    /// Other terms or edits that fit as well.
    pub alternatives: Vec<String>,
    /// In words.
    pub sentence: String,
}

/// Additional points, to distinguish edits that agree with all values.
const FRESH_POINTS: usize = 4;

/// The points of a comparison, as another program reads them, and the right values there.
pub struct Question<'m> {
    right: Right<'m>,
    /// Points of the same part that the program is not asked about.
    fresh: Vec<Vec<f64>>,
}

impl<'m> Question<'m> {
    /// Points of the domain or, with its name, of a face.
    pub(crate) fn new(
        model: &'m Model,
        face: Option<&str>,
        sampling: &Sampling,
    ) -> Result<Self, InputError> {
        let questions = questions(model, face, sampling)?;
        let fresh = Sampler::new(model, !sampling.seed).points(questions.part, FRESH_POINTS)?;
        Ok(Self {
            right: Right::new(model, questions),
            fresh,
        })
    }

    /// A line of names, then a line for each point.
    pub fn text(&self) -> &str {
        &self.right.text
    }

    /// Compares an answer with the right values, and explains the differences.
    ///
    /// * `command`: whose answer it is, in messages.
    ///
    /// # Errors
    /// An answer that cannot be used, with the line.
    pub fn compare(&self, answer: &str, command: &str) -> Result<Vec<Comparison>, InputError> {
        let right = &self.right;
        let points = right.sampled.points.len();
        let answers = ask::read(answer, command, &right.names(), points, f64::is_finite)?;
        let spreads = right.spreads()?;
        for answer in &answers {
            right.tells(answer, &spreads)?;
        }
        Ok(explain::explain(right, &spreads, &answers, &self.fresh))
    }

    /// The quantities of the file that an answer does not name.
    pub fn left_out(&self, comparisons: &[Comparison]) -> Vec<String> {
        let mut names = self.right.names();
        names.retain(|name| comparisons.iter().all(|one| one.quantity != *name));
        names
    }
}

/// The points of a comparison, and the text that the other program reads about them.
pub(crate) struct Questions {
    pub(crate) part: Part,
    pub(crate) points: Vec<Vec<f64>>,
    pub(crate) text: String,
}

/// Points of the domain or, with its name, of a face: there with the components of the normal.
pub(crate) fn questions(
    model: &Model,
    face: Option<&str>,
    sampling: &Sampling,
) -> Result<Questions, InputError> {
    let problem = &model.problem;
    let mut part = Part::Interior;
    if let Some(name) = face {
        let names = problem.faces.iter().map(|face| face.name.as_str());
        let names: Vec<&str> = names.collect();
        let place = names.iter().position(|known| *known == name);
        part = place
            .map(Part::Face)
            .ok_or_else(|| InputError::whole(&problem.file, unknown("face", name, &names)))?;
    }
    let points = Sampler::new(model, sampling.seed).points(part, sampling.points)?;
    let variables = problem.variables().into_iter();
    let mut names: Vec<String> = variables.map(str::to_owned).collect();
    let mut rows = points.clone();
    let normal = model.part(part).iter().find(|q| q.role == Role::Normal);
    if let Some(normal) = normal {
        names.extend(problem.axes().iter().map(|axis| format!("n_{axis}")));
        let normals = model.rows([normal]);
        for row in &mut rows {
            let normal = normals.at(row).tensors.remove(0);
            row.extend(normal.iter().map(|v| v.value));
        }
    }
    Ok(Questions {
        part,
        text: ask::question(&names, &rows),
        points,
    })
}
