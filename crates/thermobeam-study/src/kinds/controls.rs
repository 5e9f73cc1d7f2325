//! Negative controls: the solver, or the sources, are wrong on purpose, and a study must turn to fail.
//!
//! A check that cannot fail proves nothing. Each coefficient of the solver in turn is off from the one that the sources
//! were derived with, by a relative amount; each [`Defect`] in turn is planted in the sources. The matrix (control x
//! study) is printed, and no control may go unseen by all studies. Without a control every study must pass, or its
//! failures would say nothing.
//!
//! ```toml
//! [controls]
//! relative = 1e-4
//! studies = ["theorem-3.4-space.toml"]    # files beside this one
//! elements = [64, 128, 256]               # optional: levels in place of the studies' own
//! ```

use crate::error::design::{Defect, Disagreement, Prepared};
use crate::kinds::convergence::Convergence;
use crate::kinds::tables::{Norm, Norms};
use crate::kinds::untyped::{Case, Measured};
use crate::kinds::{FromFile, Study};
use crate::scene::tables;
use convergence_study::input::{self, InputError, Section};
use convergence_study::judge::verdict::{Level, Verdict, judge};
use convergence_study::study::CaseFailure;
use convergence_study::study::Header;
use convergence_study::study::outcome::{Check, Outcome, Table};
use std::path::Path;
use thermobeam::parameters::{Beam, Obstacles};

/// Name of the kind.
pub const CONTROLS: &str = "controls";

/// A study of this kind.
pub struct Controls {
    header: Header,
    relative: f64,
    studies: Vec<Convergence>,
}

/// What is wrong in a run.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Fault {
    None,
    Coefficient(&'static str),
    Defect(Defect),
}

impl Fault {
    fn all() -> Vec<Self> {
        let coefficients = tables::BEAM_KEYS.iter().chain(&tables::OBSTACLE_KEYS).map(|key| Fault::Coefficient(key));
        [Fault::None].into_iter().chain(coefficients).chain(Defect::ALL.map(Fault::Defect)).collect()
    }

    fn name(self) -> &'static str {
        match self {
            Fault::None => "none",
            Fault::Coefficient(key) => key,
            Fault::Defect(defect) => defect.name(),
        }
    }

    /// The disagreement it makes; `None` where the study does not have the coefficient, or has it zero.
    fn plant(self, spec: &Convergence, relative: f64) -> Option<Disagreement> {
        let (beam, obstacles) = (spec.beam, spec.obstacles);
        match self {
            Fault::None => Some(Disagreement { beam, obstacles, defect: None }),
            Fault::Defect(defect) => Some(Disagreement { beam, obstacles, defect: Some(defect) }),
            Fault::Coefficient(key) => {
                let (beam, obstacles) = perturbed(beam, obstacles, key, relative)?;
                Some(Disagreement { beam, obstacles, defect: None })
            }
        }
    }
}

/// The studies that a section names, with its own levels where it gives them.
pub(crate) fn named_studies(section: &Section<'_>, folder: &Path) -> Result<Vec<Convergence>, InputError> {
    let allowed = "a list of at least one study file beside this one";
    let files = section.require("studies", allowed)?.items(allowed)?;
    let levels = section.get("elements").map(|field| field.items("a list of numbers of elements")).transpose()?;
    let levels = levels.unwrap_or_default().iter().map(tables::elements).collect::<Result<Vec<_>, _>>()?;
    let mut studies = vec![];
    for file in files {
        let mut spec = <Convergence as convergence_study::study::FromFile>::read(file.file(folder)?)?;
        if !levels.is_empty() {
            spec.refine.elements.clone_from(&levels);
        }
        studies.push(spec);
    }
    Ok(studies)
}

/// The coefficients with one of them off by a relative amount; `None` where it is not there, or zero.
pub(crate) fn perturbed(
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

impl FromFile for Controls {
    fn parse(text: &str, file: &Path) -> Result<Self, InputError> {
        input::parse_beside(text, file, Self::from_document)
    }
}

impl Controls {
    fn from_document(root: &Section<'_>, folder: &Path) -> Result<Self, InputError> {
        root.allow(&["study", "controls"])?;
        let section = root.require("controls", "a table with relative and studies")?.section()?;
        section.allow(&["relative", "studies", "elements"])?;
        let allowed = "a number between 0 and 1";
        let relative = section.require("relative", allowed)?.number_where(allowed, |r| r > 0.0 && r < 1.0)?;
        let studies = named_studies(&section, folder)?;
        Ok(Self { header: Header::from_document(root)?, relative, studies })
    }

    /// Study and level of each case.
    fn levels(&self) -> Vec<(&Convergence, usize, usize)> {
        self.studies
            .iter()
            .flat_map(|spec| spec.refine.cases().into_iter().map(move |(n, steps)| (spec, n, steps)))
            .collect()
    }

    /// The verdict on one study under one fault: the worst over its norms; `None` where the fault cannot be planted.
    fn verdict(&self, spec: &Convergence, fault: Fault, results: &[Result<Measured, CaseFailure>]) -> Option<Verdict> {
        fault.plant(spec, self.relative)?;
        let of_study: Vec<_> =
            self.levels().into_iter().zip(results).filter(|((of, ..), _)| of.header.id == spec.header.id).collect();
        Some(Verdict::worst(spec.expect.iter().map(|expectation| {
            let levels: Vec<Level> = of_study
                .iter()
                .map(|&((_, elements, steps), result)| {
                    let key = key(fault, expectation.norm);
                    Level {
                        step: spec.step(elements, steps),
                        error: result.as_ref().map_or(f64::NAN, |m| m.value(&key)),
                    }
                })
                .collect();
            judge(&levels, expectation.order, expectation.tolerance).verdict
        })))
    }
}

fn key(fault: Fault, norm: Norm) -> String {
    format!("{} | {}", fault.name(), norm.name())
}

impl Study for Controls {
    fn header(&self) -> &Header {
        &self.header
    }

    fn cases(&self) -> Vec<Case> {
        let faults = Fault::all().len() as f64;
        let case = |(spec, n, steps): (&Convergence, usize, usize)| Case {
            label: format!("{}, n = {n}, {steps} steps", spec.header.id),
            cost: n as f64 * (steps as f64 * faults + 50.0),
        };
        self.levels().into_iter().map(case).collect()
    }

    fn run(&self, index: usize) -> Result<Measured, CaseFailure> {
        let (spec, elements, steps) = self.levels()[index];
        let mut prepared = Prepared::new(spec, elements)?;
        let mut measured = Measured::default();
        for fault in Fault::all() {
            let Some(disagreement) = fault.plant(spec, self.relative) else { continue };
            // A wrong run that breaks down has been noticed; only the honest one has to come to its end.
            let errors = match prepared.run(steps, disagreement) {
                Ok(errors) => errors,
                Err(failure) if fault == Fault::None => return Err(failure),
                Err(_) => Norms::NAN,
            };
            for (norm, error) in errors.iter() {
                measured.push(key(fault, norm), error);
            }
        }
        Ok(measured)
    }

    fn conclude(&self, results: &[Result<Measured, CaseFailure>]) -> Outcome {
        let mut checks = vec![];
        let mut rows = vec![];
        for fault in Fault::all() {
            let verdicts: Vec<_> = self.studies.iter().map(|spec| self.verdict(spec, fault, results)).collect();
            let seen = verdicts.iter().filter(|verdict| **verdict == Some(Verdict::Fail)).count();
            if fault == Fault::None {
                let passing = verdicts.iter().all(|verdict| *verdict == Some(Verdict::Pass));
                let passed = verdicts.iter().filter(|verdict| **verdict == Some(Verdict::Pass)).count();
                checks.push(Check::that(
                    passing,
                    "without a fault every study passes",
                    format!("{passed} of {} pass", verdicts.len()),
                ));
            } else {
                let claim = format!("{} is seen", fault.name());
                checks.push(Check::that(seen > 0, claim, format!("{seen} of {} studies fail", verdicts.len())));
            }
            let cell = |verdict: Option<Verdict>| verdict.map_or("not there", Verdict::name).to_owned();
            rows.push([vec![fault.name().to_owned()], verdicts.into_iter().map(cell).collect()].concat());
        }
        // The first check is on the studies without a fault.
        let unseen = checks.iter().skip(1).filter(|check| check.verdict != Verdict::Pass).count();
        let faults = checks.len().saturating_sub(1);
        let headline = format!("{} of {faults} planted faults seen", faults.saturating_sub(unseen));
        let summary = format!("{headline}, coefficients being off by {:e}", self.relative);
        let mut outcome = Outcome { headline, ..Outcome::new(summary, vec![], checks) };
        let mut head = vec!["fault".to_owned()];
        head.extend(self.studies.iter().map(|spec| spec.header.id.clone()));
        outcome.tables.push(Table {
            title: "Verdict of each study under each fault: `fail` is what is wanted, `not there` a term that the study has not".to_owned(),
            head,
            rows,
        });
        outcome
    }
}
