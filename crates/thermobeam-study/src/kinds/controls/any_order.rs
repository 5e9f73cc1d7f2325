//! Faults in the solver of any order: every study named must fail for every coefficient that is off.
//!
//! The loads are derived with the study's own coefficients, the solver works with one of them changed. The verdict is that of
//! the study itself, on the errors of its own runs.
//!
//! ```toml
//! [any-order]
//! relative = 1e-4
//! studies = ["any-order-coefficients.toml"]    # of kind any-order, beside this file
//! coefficients = ["zeta", "a"]                 # names of [beam] and [obstacles]; none may be zero in a study
//! ```

use std::path::Path;

use convergence_study::input::{InputError, Section};
use convergence_study::judge::verdict::Verdict;
use convergence_study::study::levels::completion;
use convergence_study::study::{Case, CaseFailure, Check, FromFile, Header, Kind, Outcome, Quantity, Ran, Table};
use convergence_study::text::number::max_or_nan;

use super::fault::{coefficients, perturbed};
use super::without_a_fault;
use crate::kinds::any_order::{AnyOrder, Errors, Resolution};
use crate::kinds::tables::Control;

/// Relative change of an error that the baseline tolerates.
const TOLERANCE: f64 = 1e-3;

/// A study of coefficients that are off.
pub struct AnyOrderControls {
    header: Header,
    relative: f64,
    studies: Vec<AnyOrder>,
    coefficients: Vec<&'static str>,
}

/// One study under one fault.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Faulty {
    /// The study, by its place in the list.
    pub study: usize,
    /// The coefficient that is off; `None` for the honest solver.
    pub coefficient: Option<&'static str>,
}

/// What the study says.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Judged {
    /// Its verdict.
    pub verdict: Verdict,
    /// The error in the fields of its last run, the finest; NaN where it broke down.
    pub error: f64,
}

impl FromFile for AnyOrderControls {
    fn from_document(header: Header, root: &Section<'_>, folder: &Path) -> Result<Self, InputError> {
        root.allow(&["study", "any-order"])?;
        let section = root.require("any-order", "a table with relative, studies and coefficients")?.section()?;
        section.allow(&["relative", "studies", "coefficients"])?;
        let allowed = "a number between 0 and 1";
        let relative = section.require("relative", allowed)?.number_where(allowed, |r| r > 0.0 && r < 1.0)?;
        let allowed = "a list of at least one study file of kind any-order beside this one";
        let field = section.require("studies", allowed)?;
        let files = field.items(allowed)?;
        let studies = files.iter().map(|file| AnyOrder::read(file.file(folder)?)).collect::<Result<Vec<_>, _>>()?;
        if studies.is_empty() {
            return Err(field.refuse_as_written(allowed));
        }
        let names: Vec<(&str, &'static str)> = coefficients().map(|name| (name, name)).collect();
        let allowed = "a list of at least one coefficient";
        let field = section.require("coefficients", allowed)?;
        let items = field.items(allowed)?;
        let listed = items.iter().map(|item| item.choice(&names)).collect::<Result<Vec<_>, _>>()?;
        if listed.is_empty() {
            return Err(field.refuse_as_written(allowed));
        }
        for study in &studies {
            let (beam, obstacles) = study.coefficients();
            if let Some(absent) = listed.iter().find(|key| perturbed(beam, obstacles, key, relative).is_none()) {
                let found = format!("{absent}, which {} does not have or has zero", study.header().id);
                return Err(field.refuse(found, "coefficients that every study has"));
            }
        }
        Ok(Self { header, relative, studies, coefficients: listed })
    }
}

impl AnyOrderControls {
    /// The study with the solver's coefficient off.
    fn planted(&self, Faulty { study, coefficient }: Faulty) -> Option<AnyOrder> {
        let study = &self.studies[study];
        let Some(key) = coefficient else { return Some(study.with_control(None)) };
        let (beam, obstacles) = study.coefficients();
        let (beam, obstacles) = perturbed(beam, obstacles, key, self.relative)?;
        Some(study.with_control(Some(Control { beam, obstacles, changed: vec![key] })))
    }
}

impl Kind for AnyOrderControls {
    type Data = Faulty;
    type Found = Judged;

    fn header(&self) -> &Header {
        &self.header
    }

    fn cases(&self) -> Vec<Case<Faulty>> {
        let faults = || [None].into_iter().chain(self.coefficients.iter().copied().map(Some));
        let case = |study: usize, coefficient: Option<&'static str>| Case {
            label: format!("{}, {}", self.studies[study].header().id, coefficient.unwrap_or("no fault")),
            cost: self.studies[study].cases().iter().map(|case| case.cost).sum(),
            data: Faulty { study, coefficient },
        };
        (0..self.studies.len()).flat_map(|study| faults().map(move |fault| case(study, fault))).collect()
    }

    fn run(&self, faulty: &Faulty) -> Result<Judged, CaseFailure> {
        let study =
            self.planted(*faulty).ok_or_else(|| CaseFailure { reason: "the coefficient is absent".to_owned() })?;
        let run = |case: Case<Resolution>| Ran { found: study.run(&case.data), case };
        let ran: Vec<Ran<Resolution, Errors>> = study.cases().into_iter().map(run).collect();
        if let (None, Some(Err(failure))) =
            (faulty.coefficient, ran.iter().map(|ran| &ran.found).find(|found| found.is_err()))
        {
            return Err(failure.clone());
        }
        let error = ran.last().and_then(Ran::ok).map_or(f64::NAN, |errors| errors.fields);
        Ok(Judged { verdict: study.judge(&ran).verdict, error })
    }

    fn judge(&self, ran: &[Ran<Faulty, Judged>]) -> Outcome {
        // Of a wrong run a number that is not finite is a detection.
        let mut checks = vec![completion(ran, |_| vec![])];
        let of = |study: usize, coefficient: Option<&'static str>| {
            ran.iter().find(|ran| ran.case.data == Faulty { study, coefficient }).and_then(Ran::ok)
        };
        let (mut rows, mut quantities, mut detected, mut honest) = (vec![], vec![], 0, 0.0);
        for coefficient in [None].into_iter().chain(self.coefficients.iter().copied().map(Some)) {
            let wanted = if coefficient.is_none() { Verdict::Pass } else { Verdict::Fail };
            let name = coefficient.unwrap_or("none");
            let mut cells = vec![name.to_owned()];
            let mut right = 0;
            for (number, study) in self.studies.iter().enumerate() {
                let judged = of(number, coefficient);
                right += usize::from(judged.is_some_and(|judged| judged.verdict == wanted));
                let error = judged.map_or(f64::NAN, |judged| judged.error);
                cells.push(judged.map_or("missing".to_owned(), |judged| format!("{} ({error:.1e})", judged.verdict)));
                if coefficient.is_none() {
                    honest = max_or_nan(honest, error);
                } else if error.is_finite() {
                    let name = format!("error with {name} off, {}", study.header().id);
                    quantities.push(Quantity { name, value: error, tolerance: TOLERANCE });
                }
            }
            rows.push(cells);
            let all = self.studies.len();
            checks.push(if coefficient.is_none() {
                let passes = |number: usize| of(number, None).is_some_and(|judged| judged.verdict == wanted);
                let ids = self.studies.iter().map(|study| study.header().id.as_str()).enumerate();
                without_a_fault(ids.map(|(number, id)| (id, passes(number))))
            } else {
                detected += usize::from(right == all);
                let evidence = format!("{right} of {all} studies notice it");
                Check::that(right == all, format!("{name} is detected by every study"), evidence)
            });
        }
        let faults = self.coefficients.len();
        let headline = format!("{detected} of {faults} wrong coefficients detected");
        let summary = format!("{headline}, each off by {:e}; error without a fault {honest:.1e}", self.relative);
        let head = ["coefficient"].into_iter().chain(self.studies.iter().map(|study| study.header().id.as_str()));
        let table = Table {
            title: "Verdict of each study with one coefficient of the solver off, and the error of its finest run"
                .to_owned(),
            head: head.map(str::to_owned).collect(),
            rows,
        };
        Outcome { headline, tables: vec![table], quantities, ..Outcome::new(summary, vec![], checks) }
    }
}
