//! Faults in the solver of any order: each study named must fail for every perturbed coefficient
//! and for every defect.
//!
//! The loads are derived with the study's own coefficients; the solver uses a changed value of one
//! of them, or a defect is planted in the loads. The study itself gives the verdict, on the errors
//! of its own runs.
//!
//! ```toml
//! [any-order]
//! relative = 1e-4
//! studies = ["any-order-coefficients.toml"]    # of kind any-order, beside this file
//! coefficients = ["zeta", "a"]                 # names of [beam] and [obstacles]; none may be zero in a study
//! defects = ["half of rho in N"]               # optional: mistakes in the loads, in the words of the report
//! ```

use convergence_study::study::run_cases_here;

use super::{Defect, Fault, Matrix, RELATIVE, relative};
use crate::kinds::orders::Orders;
use crate::kinds::orders::any_order::AnyOrder;
use crate::kinds::prelude::*;

/// Relative change of an error that the baseline tolerates.
const TOLERANCE: f64 = 1e-3;

/// A study with perturbed coefficients.
pub struct AnyOrderControls {
    relative: f64,
    studies: Vec<Described<Orders<AnyOrder>>>,
    /// No fault at all, then each coefficient and each defect.
    faults: Vec<Fault>,
}

/// The result of the study.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Judged {
    /// Its verdict.
    pub verdict: Verdict,
    /// The error in the fields of its last run, the finest; NaN if it broke down.
    pub error: f64,
}

impl FromFile for AnyOrderControls {
    fn from_document(_: &Header, root: &Section<'_>, folder: &Path) -> Result<Self, InputError> {
        let section = root.table(
            "any-order",
            &["relative", "studies", "coefficients", "defects"],
        )?;
        let relative = relative(&section.require("relative", RELATIVE)?)?;
        let allowed = "a list of at least one study file of kind any-order beside this one";
        let read = |file: &Field<'_>| Described::<Orders<AnyOrder>>::read(file.file(folder)?);
        let studies = section.list("studies", allowed, read, |list| !list.is_empty())?;
        let names: Vec<(&str, &'static str)> =
            Coefficients::names().map(|name| (name, name)).collect();
        let allowed = "a list of at least one coefficient";
        let listed = section.list(
            "coefficients",
            allowed,
            |item| item.choice(&names),
            |list| !list.is_empty(),
        )?;
        let mut faults = vec![Fault::None];
        faults.extend(listed.into_iter().map(Fault::Coefficient));
        faults.extend(defects(&section)?.into_iter().map(Fault::Defect));
        for study in &studies {
            let is_absent = |fault: &&Fault| fault.plant(study.kind.theory, relative).is_none();
            if let Some(absent) = faults.iter().find(is_absent) {
                let key = if matches!(absent, Fault::Defect(_)) {
                    "defects"
                } else {
                    "coefficients"
                };
                let found = format!(
                    "{}, which {} does not have or has zero",
                    absent.name(),
                    study.header.id
                );
                return Err(section.refuse(key, found, format!("{key} that every study has")));
            }
        }
        Ok(Self {
            relative,
            studies,
            faults,
        })
    }
}

/// The defects that a section names; none without the key.
fn defects(section: &Section<'_>) -> Result<Vec<Defect>, InputError> {
    if section.get("defects").is_none() {
        return Ok(vec![]);
    }
    let of_the_problem = Defect::ALL
        .iter()
        .filter(|(defect, _)| defect.is_of_the_problem());
    let names: Vec<(&str, Defect)> = of_the_problem
        .map(|&(defect, name)| (name, defect))
        .collect();
    section.list(
        "defects",
        "a list of at least one defect",
        |item| item.choice(&names),
        |list| !list.is_empty(),
    )
}

impl Kind for AnyOrderControls {
    /// Index of a study, and its fault.
    type Data = (usize, Fault);
    type Found = Judged;

    fn cases(&self) -> Vec<Case<(usize, Fault)>> {
        let case = |study: usize, fault: Fault| {
            let name = if fault == Fault::None {
                "no fault"
            } else {
                fault.name()
            };
            let cost = self.studies[study]
                .kind
                .cases()
                .iter()
                .map(|case| case.cost)
                .sum();
            Case::new(
                format!("{}, {name}", self.studies[study].header.id),
                cost,
                (study, fault),
            )
        };
        let of_study = |study: usize| self.faults.iter().map(move |&fault| case(study, fault));
        (0..self.studies.len()).flat_map(of_study).collect()
    }

    fn run(&self, &(study, fault): &(usize, Fault)) -> Result<Judged, CaseFailure> {
        let study = &self.studies[study].kind;
        let absent = || CaseFailure::new("what is wrong is absent");
        let mut planted = study.clone();
        (planted.solver, planted.defect) = fault
            .plant(study.theory, self.relative)
            .ok_or_else(absent)?;
        let ran = run_cases_here(&planted);
        // A fault that breaks a run down is detected; only runs without a fault must finish.
        if let (Fault::None, Some(failure)) =
            (fault, ran.iter().find_map(|ran| ran.found.as_ref().err()))
        {
            return Err(failure.clone());
        }
        let error = ran
            .last()
            .and_then(Ran::ok)
            .map_or(f64::NAN, |errors| errors.named[0].1);
        Ok(Judged {
            verdict: planted.judge(&ran).verdict,
            error,
        })
    }

    fn judge(&self, ran: &[Ran<(usize, Fault), Judged>]) -> Outcome {
        // In a run with a fault, a number that is not finite is a detection.
        let completion = completion(ran, |_| vec![]);
        let mut matrix = Matrix::new(&self.studies, true, completion);
        let (mut quantities, mut honest) = (vec![], 0.0);
        for &fault in &self.faults {
            let judged = |study: usize| found(ran, &(study, fault));
            let judged: Vec<Option<&Judged>> = (0..self.studies.len()).map(judged).collect();
            for (study, judged) in self.studies.iter().zip(&judged) {
                let error = judged.map_or(f64::NAN, |judged| judged.error);
                if fault == Fault::None {
                    honest = max_or_nan(honest, error);
                } else if error.is_finite() {
                    let id = &study.header.id;
                    let guarded = Quantity::new(guarded_name(fault, id), error, TOLERANCE);
                    let subject = Subject::of(format!("error with {}", fault.name())).in_case(id);
                    quantities.push(guarded.about(subject));
                }
            }
            let cell = |judged: &Option<&Judged>| match judged {
                Some(Judged { verdict, error }) => format!("{verdict} ({error:.1e})"),
                None => "missing".to_owned(),
            };
            let verdicts: Vec<_> = judged
                .iter()
                .map(|judged| judged.map(|judged| judged.verdict))
                .collect();
            matrix.add(fault, &verdicts, judged.iter().map(cell).collect());
        }
        let more = format!(
            "coefficients being off by {:e}; error without a fault {honest:.1e}",
            self.relative
        );
        let title = "Verdict of each study under each fault, and the error of its finest run";
        Outcome {
            quantities,
            ..matrix.outcome("planted faults", &more, title, "fault")
        }
    }
}

/// The name of the error of a study under a fault.
fn guarded_name(fault: Fault, study: &str) -> String {
    match fault {
        Fault::Defect(defect) => format!("error with {}, {study}", defect.name()),
        fault => format!("error with {} off, {study}", fault.name()),
    }
}
