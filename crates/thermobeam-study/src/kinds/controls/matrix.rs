//! The matrix (fault x study): which study detects which fault.
//!
//! Each coefficient of the solver in turn is perturbed by a relative amount, while the sources keep the exact one. Each
//! [`Defect`](crate::kinds::convergence::Defect) in turn is planted in the sources. Without a fault every study must pass, since
//! otherwise its failures would prove nothing.
//!
//! ```toml
//! [controls]
//! relative = 1e-4
//! studies = ["theorem-3.4-space.toml"]    # files beside this one
//! elements = [64, 128, 256]               # optional: levels in place of the studies' own
//! ```

use super::{Fault, Matrix, RELATIVE, named_studies, relative};
use crate::kinds::convergence::design::verdicts;
use crate::kinds::convergence::{Convergence, Prepared};
use crate::kinds::prelude::*;

/// A study of planted faults.
pub struct Controls {
    header: Header,
    relative: f64,
    studies: Vec<Convergence>,
}

/// Index of a study, with the elements and steps of one of its levels, on which every fault is planted.
type LevelOf = (usize, (usize, usize));

impl FromFile for Controls {
    fn from_document(header: Header, root: &Section<'_>, folder: &Path) -> Result<Self, InputError> {
        let section = root.table("controls", &["relative", "studies", "elements"])?;
        let relative = relative(&section.require("relative", RELATIVE)?)?;
        Ok(Self { header, relative, studies: named_studies(&section, folder)? })
    }
}

impl Kind for Controls {
    type Data = LevelOf;
    /// One run for each fault that can be planted, with its errors; NaN if it broke down.
    type Found = Vec<(Fault, Norms)>;

    fn header(&self) -> &Header {
        &self.header
    }

    fn cases(&self) -> Vec<Case<Self::Data>> {
        let faults = Fault::all().len() as f64;
        let case = |study: usize, (n, steps): (usize, usize)| Case {
            label: format!("{}, n = {n}, {steps} steps", self.studies[study].header.id),
            cost: n as f64 * (steps as f64 * faults + 50.0),
            data: (study, (n, steps)),
        };
        let levels = |study: usize| self.studies[study].refine.cases().into_iter().map(move |level| case(study, level));
        (0..self.studies.len()).flat_map(levels).collect()
    }

    fn run(&self, &(study, (elements, steps)): &Self::Data) -> Result<Vec<(Fault, Norms)>, CaseFailure> {
        let spec = &self.studies[study];
        let mut prepared = Prepared::new(spec, elements)?;
        let mut found = vec![];
        for fault in Fault::all() {
            let Some((solver, defect)) = fault.plant(spec, self.relative) else { continue };
            // A fault that breaks a run down is detected; only the run without a fault must finish.
            let errors = match prepared.run(steps, solver, defect) {
                Err(failure) if fault == Fault::None => return Err(failure),
                errors => errors.unwrap_or(Norms::NAN),
            };
            found.push((fault, errors));
        }
        Ok(found)
    }

    fn judge(&self, ran: &[Ran<LevelOf, Vec<(Fault, Norms)>>]) -> Outcome {
        // In a run with a fault, a number that is not finite is a detection.
        let not_finite = |found: &Vec<(Fault, Norms)>| {
            let honest = errors_with(found, Fault::None);
            let finite = honest.is_some_and(|errors| errors.iter().all(|(_, error)| error.is_finite()));
            if finite { vec![] } else { vec!["an error without a fault".to_owned()] }
        };
        let headers = self.studies.iter().map(|spec| &spec.header);
        let mut matrix = Matrix::new(headers, false, completion(ran, not_finite));
        for fault in Fault::all() {
            let verdicts: Vec<_> = (0..self.studies.len()).map(|study| self.verdict(study, fault, ran)).collect();
            let cell = |verdict: &Option<Verdict>| verdict.map_or("n/a", Verdict::name).to_owned();
            matrix.add(fault, &verdicts, verdicts.iter().map(cell).collect());
        }
        let headline = format!("{} of {} planted faults detected", matrix.detected, matrix.faults);
        let summary = format!("{headline}, coefficients being off by {:e}", self.relative);
        let title = "Verdict of each study under each fault: `fail` detects it; n/a: term absent";
        let tables = vec![matrix.table(title, "fault")];
        Outcome { headline, tables, ..Outcome::new(summary, vec![], matrix.checks) }
    }
}

impl Controls {
    /// The verdict of one study under one fault, the worst over its norms; `None` if the fault cannot be planted.
    fn verdict(&self, study: usize, fault: Fault, ran: &[Ran<LevelOf, Vec<(Fault, Norms)>>]) -> Option<Verdict> {
        let spec = &self.studies[study];
        fault.plant(spec, self.relative)?;
        let level = |ran: &Ran<LevelOf, Vec<(Fault, Norms)>>| {
            let errors = ran.ok().and_then(|found| errors_with(found, fault));
            (ran.case.data.1, errors.copied().unwrap_or(Norms::NAN))
        };
        let levels: Vec<_> = ran.iter().filter(|ran| ran.case.data.0 == study).map(level).collect();
        Some(Verdict::worst(verdicts(spec, &levels)))
    }
}

fn errors_with(found: &[(Fault, Norms)], fault: Fault) -> Option<&Norms> {
    found.iter().find(|(planted, _)| *planted == fault).map(|(_, errors)| errors)
}
