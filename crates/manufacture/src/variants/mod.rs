//! Variants of a solution: each switches off what one part of a program can get wrong. If the order
//! of a program comes back, that part is where it was lost.
//!
//! | variant | switches off |
//! | --- | --- |
//! | constant in a coordinate, in time | what acts along it |
//! | flat at faces, at the first time | the data there: the solution vanishes there with its derivatives up to one more than the largest order claimed |
//! | a parameter zero | its term |
//! | a field constant | what acts on it |

mod design;
mod switch;

use std::collections::BTreeMap;

use serde::Serialize;

use crate::derive::{Part, Role};
use crate::emit::Alternative;
use crate::model::Model;
use crate::problem::{InputError, Problem};
use crate::sample::Sampler;
use crate::{Finding, Sampling, check};

use design::{Design, End, MIDDLE, designs, sides};
pub use switch::Switch;

/// A variant that is right by the check of the file.
#[derive(Debug, Serialize)]
pub struct Variant {
    /// Its name, the value of `MANUFACTURE_VARIANT`.
    pub name: String,
    /// What it switches off.
    pub switches_off: Switch,
    /// The size of its solution.
    pub size: f64,
    #[serde(skip)]
    model: Model,
}

/// A variant that cannot be used.
#[derive(Debug, Clone, PartialEq, Eq, Serialize)]
pub struct LeftOutVariant {
    /// Its name.
    pub name: String,
    /// What it would switch off.
    pub switches_off: Switch,
    /// Why not.
    pub why: String,
}

/// The variants of a file, which JSON and literals of Python can have.
#[derive(Debug, Serialize)]
pub struct Variants {
    /// The size of the solution of the file: the root mean square of its fields over the domain.
    pub size: f64,
    /// Those that can be used.
    pub usable: Vec<Variant>,
    /// The others.
    pub left_out: Vec<LeftOutVariant>,
    /// The names of the data at each side: `flux`.
    pub data: BTreeMap<String, Vec<String>>,
}

impl Variants {
    /// The literal `VARIANTS` of a module in Python, which JSON without null and booleans is.
    pub(crate) fn literal(&self) -> String {
        let literal = serde_json::to_string_pretty(self).unwrap_or_default();
        format!(
            "\n# For `study(..., variants=module)` of the package convergence_study.\nVARIANTS = {literal}\n"
        )
    }

    fn left_out(&mut self, switches_off: Switch, why: String) {
        self.left_out.push(LeftOutVariant {
            name: switches_off.variant(),
            switches_off,
            why,
        });
    }

    pub(crate) fn alternatives(&self) -> Vec<Alternative<'_>> {
        let usable = self.usable.iter();
        usable
            .map(|variant| Alternative {
                name: variant.name.clone(),
                model: &variant.model,
            })
            .collect()
    }
}

/// All variants of a model, checked.
pub(crate) fn variants(model: &Model, sampling: &Sampling) -> Result<Variants, InputError> {
    // What is wrong with the file is no reason against a variant.
    let base = Base {
        squares: squares(model, sampling)?,
        model,
        sampling,
    };
    let problem = &model.problem;
    for part in Part::all(problem) {
        Sampler::new(model, sampling.seed).points(part, 1)?;
    }
    let data = sides(problem)
        .into_iter()
        .map(|side| (side.name, side.data));
    let mut variants = Variants {
        size: root(&base.squares),
        usable: vec![],
        left_out: vec![],
        data: data.collect(),
    };
    let level = design::on_a_level(problem);
    if let Some(level) = level {
        // Nothing is flat there, so no variant is flat at all faces.
        variants.left_out(
            Switch::AllFaces,
            format!("the face {level} lies on a level"),
        );
    }
    for design in designs(problem) {
        if level.is_some() && design.switch == Switch::AllFaces {
            continue;
        }
        match base.usable(&design) {
            Ok(variant) => variants.usable.push(variant),
            Err(why) => variants.left_out(design.switch, why),
        }
    }
    Ok(variants)
}

/// The root mean square of all fields, from their mean squares.
fn root(squares: &[f64]) -> f64 {
    squares.iter().sum::<f64>().sqrt()
}

/// The mean square of each field over points of the domain.
fn squares(model: &Model, sampling: &Sampling) -> Result<Vec<f64>, InputError> {
    let points = Sampler::new(model, sampling.seed).points(Part::Interior, sampling.points)?;
    let squares = model.of_role(Role::Exact).map(|field| {
        let rows = model.rows([field]);
        let values = points
            .iter()
            .flat_map(|point| rows.at(point).tensors.remove(0));
        let sum: f64 = values.map(|part| part.value.powi(2)).sum();
        sum / points.len() as f64
    });
    Ok(squares.collect())
}

/// A file whose variants are made.
struct Base<'m> {
    model: &'m Model,
    sampling: &'m Sampling,
    /// The mean square of each field.
    squares: Vec<f64>,
}

impl Base<'_> {
    /// The variant, or in words why it cannot be used.
    fn usable(&self, design: &Design) -> Result<Variant, String> {
        let mut is_weighed = false;
        let mut unlifted = self.varied(design, is_weighed, BTreeMap::new())?;
        if design.is_flat() && self.vanishes(&self.squares_of(&unlifted)?) {
            is_weighed = true;
            unlifted = self.varied(design, is_weighed, BTreeMap::new())?;
        }
        let lifts = self.lifts(design).into_iter();
        let lifted = lifts.map(|lift| self.varied(design, is_weighed, lift));
        let mut why = String::new();
        for model in std::iter::once(Ok(unlifted)).chain(lifted) {
            let model = model?;
            // A pole is refused as bad input; here it is a reason.
            let findings = match check::failures(&model, self.sampling) {
                Ok(findings) => findings,
                Err(error) => {
                    if why.is_empty() {
                        why = error.problem;
                    }
                    continue;
                }
            };
            let failures: Vec<&Finding> = findings.iter().filter(|finding| finding.fails).collect();
            let Some(first) = failures.first() else {
                return Ok(Variant {
                    name: design.switch.variant(),
                    switches_off: design.switch.clone(),
                    size: root(&self.squares_of(&model)?),
                    model,
                });
            };
            if why.is_empty() {
                why = format!("{}: {}: {}", first.key, first.code, first.text);
            }
            let mends = ["not-positive", "singular", "condition-violated"];
            if !failures.iter().any(|failure| mends.contains(&failure.code)) {
                break;
            }
        }
        Err(why)
    }

    /// The model of a variant, or in words what is wrong with it.
    fn varied(
        &self,
        design: &Design,
        is_weighed: bool,
        lifts: BTreeMap<String, Vec<f64>>,
    ) -> Result<Model, String> {
        let mut problem: Problem = self.model.problem.clone();
        if let Switch::Parameter(name) = &design.switch {
            design::set_to_zero(&mut problem, name);
        } else {
            let mut variation = design.variation(&problem, is_weighed);
            variation.lifts = lifts;
            problem.variation = Some(variation);
        }
        Model::new(problem).map_err(|error| error.to_string())
    }

    fn squares_of(&self, variant: &Model) -> Result<Vec<f64>, String> {
        squares(variant, self.sampling).map_err(|error| error.to_string())
    }

    /// Whether a field is zero in a variant that was not: then all that is done to it is switched
    /// off.
    ///
    /// * `left`: the mean square of each field in the variant.
    fn vanishes(&self, left: &[f64]) -> bool {
        const ZERO: f64 = 1e-20;
        let mut pairs = self.squares.iter().zip(left);
        pairs.any(|(whole, left)| *whole > 0.0 && *left <= ZERO * whole)
    }

    /// What may be added to flat fields, which are near zero somewhere, where this is not allowed:
    /// the value at a side, which the file may prescribe; then a multiple of the value in the
    /// middle.
    fn lifts(&self, design: &Design) -> Vec<BTreeMap<String, Vec<f64>>> {
        let mut lifts = vec![];
        if design.is_flat() {
            for side in sides(&self.model.problem) {
                lifts.push(self.lift(Some(side.end), 1.0));
            }
            for scale in [1.0, 3.0] {
                lifts.push(self.lift(None, scale));
            }
        }
        lifts
    }

    /// The values of the fields near the middle of the domain or of a side, times a number.
    fn lift(&self, end: Option<End>, scale: f64) -> BTreeMap<String, Vec<f64>> {
        let problem = &self.model.problem;
        let intervals = problem.intervals.iter();
        let point = intervals.map(|[low, high]| low + MIDDLE * (high - low));
        let mut point: Vec<f64> = point.collect();
        if let Some(end) = end {
            point[end.variable] = end.at(problem);
        }
        let mut lift = BTreeMap::new();
        for field in self.model.of_role(Role::Exact) {
            let rows = self.model.rows([field]);
            let values = rows.at(&point).tensors.remove(0).into_iter();
            let values = values.map(|part| scale * part.value);
            lift.insert(field.name.clone(), values.collect());
        }
        lift
    }
}

#[cfg(test)]
mod tests;
