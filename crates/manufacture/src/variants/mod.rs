//! Variants of a solution: each switches off what one part of a program can get wrong. If the order
//! of a program comes back, that part is where it was lost.
//!
//! | variant | switches off |
//! | --- | --- |
//! | constant in a coordinate, in time | what acts along it |
//! | flat at faces, at the first time | the data there: the solution vanishes there with its derivatives up to one more than the largest order claimed |
//! | a parameter zero | its term |
//! | a field constant | what acts on it |

mod described;
mod design;
mod switch;

use std::collections::BTreeMap;
use std::path::Path;

use serde::Serialize;

use crate::derive::{Part, Role};
use crate::emit::{self, Alternative, EmittedFile, Language};
use crate::model::{Model, TensorRows};
use crate::problem::{InputError, Problem, Variation};
use crate::sample::Sampler;
use crate::{Finding, Sampling, check};

pub use described::{DescribedVariant, Description};
use design::{BoxSide, Design, MIDDLE, designs, sides};
pub use switch::Switch;

/// A variant that is right by the check of the file.
#[derive(Debug)]
pub struct Variant {
    /// What it switches off.
    pub switch: Switch,
    /// The size of its solution.
    pub size: f64,
    model: Model,
}

/// A variant that cannot be used.
#[derive(Debug, Clone, PartialEq, Eq, Serialize)]
pub struct LeftOutVariant {
    /// What it would switch off.
    #[serde(flatten)]
    pub switch: Switch,
    /// Why not.
    pub why: String,
}

/// The variants of a file.
#[derive(Debug)]
pub struct Variants<'m> {
    base: &'m Model,
    /// The size of the solution of the file: the root mean square of its fields over the domain.
    pub size: f64,
    /// Those that can be used.
    pub usable: Vec<Variant>,
    /// The others.
    pub left_out: Vec<LeftOutVariant>,
}

impl Variants<'_> {
    /// All parts of the file: those of variants that can be used, and of those that cannot.
    pub fn switches(&self) -> impl Iterator<Item = &Switch> {
        let usable = self.usable.iter().map(|variant| &variant.switch);
        usable.chain(self.left_out.iter().map(|entry| &entry.switch))
    }

    /// The data of a side, by their names in the file: `flux`.
    pub fn data_at(&self, side: &str) -> Vec<&str> {
        design::data_at(&self.base.problem, side)
    }

    /// The files of a language, whose functions are those of the variant that the environment
    /// variable `MANUFACTURE_VARIANT` names; it is read once, and without it they are those of the
    /// file. In Fortran a program calls `choose_variant` first. In Python the module says what each
    /// variant switches off, too.
    pub fn emit(&self, language: Language) -> Vec<EmittedFile> {
        let mut files = emit::emit(self.base, &self.alternatives(), language);
        if language == Language::Python {
            files[0].text += &self.description().literal();
        }
        files
    }

    /// Builds and runs the files of a language in a folder, which is for temporary files, and
    /// compares the values of the file's solution and of each variant.
    ///
    /// # Errors
    /// A folder that cannot be written to.
    pub fn check_emitted(
        &self,
        language: Language,
        folder: &Path,
        sampling: &Sampling,
    ) -> Result<Vec<Finding>, InputError> {
        let alternatives = self.alternatives();
        check::emitted::emitted(self.base, &alternatives, language, folder, sampling)
    }

    /// Builds and runs the files of a language that are in a folder already, and compares their
    /// values.
    ///
    /// # Errors
    /// A folder that cannot be written to.
    pub fn check_built(
        &self,
        language: Language,
        folder: &Path,
        sampling: &Sampling,
    ) -> Result<Vec<Finding>, InputError> {
        let alternatives = self.alternatives();
        check::emitted::run(self.base, &alternatives, language, folder, sampling)
    }

    fn alternatives(&self) -> Vec<Alternative<'_>> {
        let usable = self.usable.iter();
        usable
            .map(|variant| Alternative {
                name: variant.switch.variant(),
                model: &variant.model,
            })
            .collect()
    }
}

/// All variants of a model, checked.
pub(crate) fn variants<'m>(
    base: &'m Model,
    sampling: &Sampling,
) -> Result<Variants<'m>, InputError> {
    let whole = squares(base, sampling)?;
    let mut variants = Variants {
        base,
        size: root(&whole),
        usable: vec![],
        left_out: vec![],
    };
    // What is wrong with the file is no reason against a variant.
    for part in Part::all(&base.problem) {
        Sampler::new(base, sampling.seed).points(part, 1)?;
    }
    let problem = &base.problem;
    if let Some(level) = design::on_a_level(problem) {
        // Nothing is flat there, so no variant is flat at all faces.
        variants.left_out.push(LeftOutVariant {
            switch: Switch::AllFaces,
            why: format!("the face {level} lies on a level"),
        });
    }
    let is_left_out = |switch: &Switch| variants.left_out.iter().any(|one| one.switch == *switch);
    let designs = designs(problem).into_iter();
    let designs: Vec<Design> = designs
        .filter(|design| !is_left_out(&design.switch))
        .collect();
    for design in designs {
        let switch = design.switch.clone();
        match usable(base, design, &whole, sampling) {
            Ok(variant) => variants.usable.push(variant),
            Err(why) => variants.left_out.push(LeftOutVariant { switch, why }),
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
        let rows = TensorRows::new(&model.graph, std::iter::once(&field.tensor));
        let values = points
            .iter()
            .flat_map(|point| rows.at(point).tensors.remove(0));
        let sum: f64 = values.map(|part| part.value.powi(2)).sum();
        sum / points.len() as f64
    });
    Ok(squares.collect())
}

/// Whether a field is zero that was not: then all that is done to it is switched off.
///
/// * `whole`, `left`: its mean square in the file, and in the variant.
fn vanishes(whole: &[f64], left: &[f64]) -> bool {
    const ZERO: f64 = 1e-20;
    let mut pairs = whole.iter().zip(left);
    pairs.any(|(whole, left)| *whole > 0.0 && *left <= ZERO * whole)
}

/// The values of a field at a point.
struct Values {
    field: String,
    values: Vec<f64>,
}

/// Near the middle of the domain, but with this value of a variable.
fn values(base: &Model, held: Option<(usize, f64)>) -> Vec<Values> {
    let intervals = base.problem.intervals.iter();
    let mut point: Vec<f64> = intervals
        .map(|[low, high]| low + MIDDLE * (high - low))
        .collect();
    if let Some((variable, at)) = held {
        point[variable] = at;
    }
    base.of_role(Role::Exact)
        .map(|quantity| {
            let rows = TensorRows::new(&base.graph, std::iter::once(&quantity.tensor)).at(&point);
            Values {
                field: quantity.name.clone(),
                values: rows.tensors[0].iter().map(|part| part.value).collect(),
            }
        })
        .collect()
}

/// What may be added to flat fields, which are near zero somewhere, where this is not allowed: the
/// value at a side, which the file may prescribe; a multiple of the value in the middle.
fn lifts(base: &Model, design: &Design) -> Vec<BTreeMap<String, Vec<f64>>> {
    let mut lifts = vec![];
    if design.is_flat() {
        for BoxSide { coordinate, at, .. } in sides(&base.problem) {
            lifts.push(scaled(values(base, Some((coordinate, at))), 1.0));
        }
        for scale in [1.0, 3.0] {
            lifts.push(scaled(values(base, None), scale));
        }
    }
    lifts
}

/// The values of each field, times a number.
fn scaled(values: Vec<Values>, scale: f64) -> BTreeMap<String, Vec<f64>> {
    let values = values.into_iter();
    values
        .map(|Values { field, values }| {
            let values = values.iter().map(|value| scale * value);
            (field, values.collect())
        })
        .collect()
}

/// The variant, or in words why it cannot be used.
///
/// * `whole`: the mean square of each field of the file.
fn usable(
    base: &Model,
    design: Design,
    whole: &[f64],
    sampling: &Sampling,
) -> Result<Variant, String> {
    let Sampling { seed, points, .. } = *sampling;
    let in_words = |error: InputError| error.to_string();
    let mut design = design;
    let mut unlifted = varied(base, &design, BTreeMap::new())?;
    if design.is_flat() && vanishes(whole, &squares(&unlifted, sampling).map_err(in_words)?) {
        design = design.weighed(&base.problem.intervals);
        unlifted = varied(base, &design, BTreeMap::new())?;
    }
    let lifted = lifts(base, &design).into_iter();
    let lifted = lifted.map(|lifts| varied(base, &design, lifts));
    let mut why = String::new();
    for model in std::iter::once(Ok(unlifted)).chain(lifted) {
        let model = model?;
        // A pole is refused as bad input; here it is a reason.
        let findings = match check::failures(&model, seed, points) {
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
                switch: design.switch.clone(),
                size: root(&squares(&model, sampling).map_err(in_words)?),
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
    base: &Model,
    design: &Design,
    lifts: BTreeMap<String, Vec<f64>>,
) -> Result<Model, String> {
    Model::new(problem(&base.problem, design, lifts)).map_err(|error| error.to_string())
}

/// The problem of a variant.
fn problem(base: &Problem, design: &Design, lifts: BTreeMap<String, Vec<f64>>) -> Problem {
    let mut problem = base.clone();
    if let Switch::Parameter(name) = &design.switch {
        design::set_to_zero(&mut problem, name);
        return problem;
    }
    problem.variation = Some(Variation {
        lifts,
        ..design.variation.clone()
    });
    problem
}

#[cfg(test)]
mod tests;
