//! What is wrong in a run on purpose, and what a study says of it.

use std::path::Path;

use convergence_study::input::{InputError, Section};
use convergence_study::judge::verdict::{Level, Verdict, judge};
use thermobeam::parameters::{Beam, Obstacles};

use crate::error::design::{Defect, Disagreement};
use crate::exact::norm::Norms;
use crate::kinds::convergence::Convergence;
use crate::scene::tables;
use convergence_study::study::FromFile;

/// Errors in the order of [`Norm::ALL`](crate::kinds::tables::Norm::ALL).
pub(super) type Errors = Norms;

/// What a run that broke down has measured: NaN, on which every study fails.
pub(super) const BROKEN: Errors = Norms::NAN;

/// What is wrong in a run.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Fault {
    /// Nothing.
    None,
    /// A coefficient of the solver.
    Coefficient(&'static str),
    /// The sources.
    Defect(Defect),
}

/// The names of all coefficients, those of the obstacles last.
pub(super) fn coefficients() -> impl Iterator<Item = &'static str> + Clone {
    tables::BEAM_KEYS.iter().chain(&tables::OBSTACLE_KEYS).copied()
}

impl Fault {
    pub(super) fn all() -> Vec<Self> {
        let defects = Defect::ALL.map(Fault::Defect);
        [Fault::None].into_iter().chain(coefficients().map(Fault::Coefficient)).chain(defects).collect()
    }

    pub(super) fn name(self) -> &'static str {
        match self {
            Fault::None => "none",
            Fault::Coefficient(key) => key,
            Fault::Defect(defect) => defect.name(),
        }
    }

    /// What solver and sources disagree in; `None` where the study does not have the coefficient, or has it zero.
    ///
    /// * `relative`: relative error of a coefficient.
    pub(super) fn plant(self, spec: &Convergence, relative: f64) -> Option<Disagreement> {
        let honest = Disagreement { beam: spec.beam, obstacles: spec.obstacles, defect: None };
        match self {
            Fault::None => Some(honest),
            Fault::Defect(defect) => Some(Disagreement { defect: Some(defect), ..honest }),
            Fault::Coefficient(key) => {
                let (beam, obstacles) = perturbed(spec.beam, spec.obstacles, key, relative)?;
                Some(Disagreement { beam, obstacles, defect: None })
            }
        }
    }
}

/// The coefficients with one of them off by a relative amount; `None` where it is not there, or zero.
pub(super) fn perturbed(
    mut beam: Beam,
    mut obstacles: Option<Obstacles>,
    key: &'static str,
    relative: f64,
) -> Option<(Beam, Option<Obstacles>)> {
    let of_obstacles = obstacles.as_mut().and_then(|obstacles| tables::obstacle_coefficient(obstacles, key));
    let coefficient = tables::beam_coefficient(&mut beam, key).or(of_obstacles)?;
    if *coefficient == 0.0 {
        return None;
    }
    *coefficient *= 1.0 + relative;
    Some((beam, obstacles))
}

/// The studies that a section names, with its own levels where it gives them.
pub(super) fn named_studies(section: &Section<'_>, folder: &Path) -> Result<Vec<Convergence>, InputError> {
    let allowed = "a list of at least one study file beside this one";
    let field = section.require("studies", allowed)?;
    let files = field.items(allowed)?;
    if files.is_empty() {
        return Err(field.refuse_as_written(allowed));
    }
    let levels = section.get("elements").map(|field| field.items("a list of numbers of elements")).transpose()?;
    let levels = levels.unwrap_or_default().iter().map(tables::elements).collect::<Result<Vec<_>, _>>()?;
    let mut studies = vec![];
    for file in files {
        let mut spec = Convergence::read(file.file(folder)?)?;
        if !levels.is_empty() {
            spec.refine.elements.clone_from(&levels);
        }
        studies.push(spec);
    }
    Ok(studies)
}

/// The verdicts of a study on the errors of its levels, one for each norm that it judges.
///
/// * `levels`: elements, steps and errors of each level, coarse to fine.
pub(super) fn verdicts<'a>(
    spec: &'a Convergence,
    levels: &'a [((usize, usize), Errors)],
) -> impl Iterator<Item = Verdict> + 'a {
    spec.expect.iter().map(move |expectation| {
        let level = |((elements, steps), errors): &((usize, usize), Errors)| Level {
            step: spec.step(*elements, *steps),
            error: errors[expectation.norm],
        };
        judge(&levels.iter().map(level).collect::<Vec<_>>(), expectation.order, expectation.tolerance).verdict
    })
}
