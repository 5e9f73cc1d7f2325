//! The matrix (fault x study): which study detects which fault.
//!
//! Each coefficient of the solver in turn is off from the one that the sources were derived with, by a relative amount; each
//! [`Defect`](crate::error::design::Defect) in turn is planted in the sources. Without a fault every study must pass, or its
//! failures would say nothing.
//!
//! ```toml
//! [controls]
//! relative = 1e-4
//! studies = ["theorem-3.4-space.toml"]    # files beside this one
//! elements = [64, 128, 256]               # optional: levels in place of the studies' own
//! ```

mod judge;

use std::path::Path;

use convergence_study::input::{InputError, Section};
use convergence_study::study::{Case, CaseFailure, FromFile, Header, Kind, Outcome, Ran};

use super::fault::{BROKEN, Errors, Fault, named_studies};
use crate::error::design::Prepared;
use crate::kinds::convergence::Convergence;

/// A study of planted faults.
pub struct Controls {
    header: Header,
    relative: f64,
    studies: Vec<Convergence>,
}

/// One level of one study, on which every fault is planted.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct LevelOf {
    /// The study, by its place in the list.
    pub study: usize,
    /// Elements of the level.
    pub elements: usize,
    /// Time steps of the level.
    pub steps: usize,
}

/// The errors of one run.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Planted {
    /// What was wrong.
    pub fault: Fault,
    /// Errors in the order of [`Norm::ALL`](crate::kinds::tables::Norm::ALL); NaN where the run broke down.
    pub errors: Errors,
}

impl FromFile for Controls {
    fn from_document(header: Header, root: &Section<'_>, folder: &Path) -> Result<Self, InputError> {
        root.allow(&["study", "controls"])?;
        let section = root.require("controls", "a table with relative and studies")?.section()?;
        section.allow(&["relative", "studies", "elements"])?;
        let allowed = "a number between 0 and 1";
        let relative = section.require("relative", allowed)?.number_where(allowed, |r| r > 0.0 && r < 1.0)?;
        Ok(Self { header, relative, studies: named_studies(&section, folder)? })
    }
}

impl Kind for Controls {
    type Data = LevelOf;
    /// One run for each fault that can be planted.
    type Found = Vec<Planted>;

    fn header(&self) -> &Header {
        &self.header
    }

    fn cases(&self) -> Vec<Case<LevelOf>> {
        let faults = Fault::all().len() as f64;
        let case = |study: usize, (n, steps): (usize, usize)| Case {
            label: format!("{}, n = {n}, {steps} steps", self.studies[study].header.id),
            cost: n as f64 * (steps as f64 * faults + 50.0),
            data: LevelOf { study, elements: n, steps },
        };
        let of_study = |(study, spec): (usize, &Convergence)| {
            spec.refine.cases().into_iter().map(move |level| (study, level)).collect::<Vec<_>>()
        };
        self.studies.iter().enumerate().flat_map(of_study).map(|(study, level)| case(study, level)).collect()
    }

    fn run(&self, level: &LevelOf) -> Result<Vec<Planted>, CaseFailure> {
        let spec = &self.studies[level.study];
        let mut prepared = Prepared::new(spec, level.elements)?;
        let mut found = vec![];
        for fault in Fault::all() {
            let Some(disagreement) = fault.plant(spec, self.relative) else { continue };
            // A fault that breaks a run down is detected; only the honest run has to end.
            let errors: Errors = match prepared.run(level.steps, disagreement) {
                Ok(errors) => errors,
                Err(failure) if fault == Fault::None => return Err(failure),
                Err(_) => BROKEN,
            };
            found.push(Planted { fault, errors });
        }
        Ok(found)
    }

    fn judge(&self, ran: &[Ran<LevelOf, Vec<Planted>>]) -> Outcome {
        judge::judge(self, ran)
    }
}
