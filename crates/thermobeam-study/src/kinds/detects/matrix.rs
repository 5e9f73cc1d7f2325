//! Every study under every fault: runs, verdicts, and the rule that judges them.

use crate::kinds::orders::{
    ErrorSource, Orders,
    planted::{
        fault::Fault,
        plantable::{Plantable, verdict},
    },
};
use crate::kinds::prelude::*;
use convergence_study::{
    Coverage,
    internal::study::{Described, coverage::NO_RESULT, header::SettingWords},
};

/// Relative change of an error that the baseline tolerates.
const TOLERANCE: f64 = 1e-3;

/// Which studies must notice a fault.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Needed {
    /// At least one: a study may lack the term that is wrong.
    One,
    /// All of them. Then the errors under each fault are guarded too.
    Every,
}

/// A study of planted faults.
///
/// * `S`: the source of the errors of the studies that must notice them.
pub struct Detects<S> {
    /// Relative error of a coefficient.
    pub(super) relative: f64,
    pub(super) studies: Vec<Described<Orders<S>>>,
    /// No fault at all comes first.
    pub(super) faults: Vec<Fault>,
    pub(super) needed: Needed,
}

/// A run of a study, for every fault.
#[derive(Debug, Clone, PartialEq)]
pub struct RunOf<D> {
    /// Index of the study.
    pub study: usize,
    /// What it runs.
    pub data: D,
}

/// The result of a run with each fault that can be planted.
pub type UnderFaults<F> = Vec<(Fault, Result<F, CaseFailure>)>;

/// The runs of a study of planted faults.
type RanOf<S> = Ran<RunOf<<S as ErrorSource>::Data>, UnderFaults<<S as ErrorSource>::Found>>;

/// Why a study is not judged under a fault.
const LACKS_THE_TERM: &str = "the study lacks the term";

/// What a study says under a fault.
struct FaultVerdict {
    verdict: Verdict,
    /// The first error of its finest run; NaN if it broke down.
    error: f64,
}

/// All studies under a fault.
struct FaultRow {
    fault: Fault,
    /// One for each study, or why there is none.
    judged: Vec<Result<FaultVerdict, &'static str>>,
}

impl<S: Plantable> Kind for Detects<S> {
    type Data = RunOf<S::Data>;
    type Found = UnderFaults<S::Found>;

    fn settings(&self, header: &Header, subject: &Subject) -> Vec<SettingWords> {
        super::exercise(&self.studies, subject).settings(header, subject)
    }

    fn cases(&self) -> Vec<Case<RunOf<S::Data>>> {
        let faults = self.faults.len() as f64;
        let mut cases = vec![];
        for (study, described) in self.studies.iter().enumerate() {
            for Case { label, cost, data } in described.kind.cases() {
                let label = format!("{}, {label}", described.header.id);
                cases.push(Case::new(label, cost * faults, RunOf { study, data }));
            }
        }
        cases
    }

    fn run(
        &self,
        RunOf { study, data }: &RunOf<S::Data>,
    ) -> Result<UnderFaults<S::Found>, CaseFailure> {
        let study = &self.studies[*study].kind.0;
        let mut shared = study.share(data)?;
        let mut results = vec![];
        for &fault in &self.faults {
            let Some(planted) = fault.plant(study.theory(), self.relative) else {
                continue;
            };
            let result = S::run_planted(&mut shared, data, planted);
            // A fault that breaks a run down is detected; only the run without a fault must finish.
            if let (Fault::None, Err(failure)) = (fault, &result) {
                return Err(failure.clone());
            }
            results.push((fault, result));
        }
        Ok(results)
    }

    fn judge(&self, ran: &[RanOf<S>]) -> Outcome {
        let rows: Vec<FaultRow> = self
            .faults
            .iter()
            .map(|&fault| self.row(fault, ran))
            .collect();
        let mut checks = vec![completion_check(ran, not_finite_without_a_fault::<S>)];
        checks.extend(rows.iter().map(|row| self.check(row)));
        let detected = rows.iter().filter(|row| self.is_detected(row)).count();
        let planted = rows.iter().filter(|row| row.fault != Fault::None).count();
        let headline = format!("{detected} of {planted} planted faults detected");
        let ids = self.studies.iter().map(|study| study.header.id.as_str());
        let head = ["fault"].into_iter().chain(ids);
        let table = Table::new(self.title(), head, rows.iter().map(|row| self.cells(row)));
        let pairs = rows.iter().flat_map(|row| &row.judged);
        let left_out = pairs.map(|judged| judged.as_ref().err().copied());
        Outcome {
            headline: headline.clone().into(),
            tables: vec![table],
            quantities: rows.iter().flat_map(|row| self.guarded(row)).collect(),
            coverage: vec![Coverage::of("pairs of a study and a fault", left_out)],
            ..Outcome::new(
                format!("{headline}, {}", self.details_of(&rows)),
                vec![],
                checks,
            )
        }
    }
}

impl<S: Plantable> Detects<S> {
    fn row(&self, fault: Fault, ran: &[RanOf<S>]) -> FaultRow {
        let studies = 0..self.studies.len();
        FaultRow {
            fault,
            judged: studies
                .map(|study| self.judged(study, fault, ran))
                .collect(),
        }
    }

    /// The verdict of one study under one fault, or why there is none.
    fn judged(
        &self,
        study: usize,
        fault: Fault,
        ran: &[RanOf<S>],
    ) -> Result<FaultVerdict, &'static str> {
        let source = &self.studies[study].kind.0;
        fault
            .plant(source.theory(), self.relative)
            .ok_or(LACKS_THE_TERM)?;
        let mut runs = vec![];
        for ran in ran.iter().filter(|ran| ran.case.data.study == study) {
            // A case without any result is no detection.
            if ran.found.is_err() {
                return Err(NO_RESULT);
            }
            runs.push(with_fault::<S>(ran, fault));
        }
        let Some(finest) = runs.last() else {
            return Err(NO_RESULT);
        };
        let errors = finest.ok().map(S::errors);
        let first = errors.and_then(|errors| errors.first().map(|(_, error)| *error));
        Ok(FaultVerdict {
            verdict: verdict(source, &runs),
            error: first.unwrap_or(f64::NAN),
        })
    }

    /// Whether enough studies fail; a run without a fault is none.
    fn is_detected(&self, row: &FaultRow) -> bool {
        let failed = row.count(Verdict::Fail);
        row.fault != Fault::None
            && match self.needed {
                Needed::One => failed > 0,
                Needed::Every => failed == self.studies.len(),
            }
    }

    /// Without a fault every study passes; with one, enough of them fail.
    fn check(&self, row: &FaultRow) -> Check {
        let all = self.studies.len();
        if row.fault != Fault::None {
            let by = match self.needed {
                Needed::One => "",
                Needed::Every => " by every study",
            };
            let evidence = format!("{} of {all} studies notice it", row.count(Verdict::Fail));
            let claim = format!("{} is detected{by}", row.fault.name());
            return Check::that(self.is_detected(row), claim, evidence)
                .about(Subject::of(row.fault.name()));
        }
        let pairs = self.studies.iter().zip(&row.judged);
        let others: Vec<String> = pairs
            .filter(|(_, judged)| !judged.as_ref().is_ok_and(|judged| judged.verdict.is_pass()))
            .map(|(study, _)| study.header.id.clone())
            .collect();
        let not = if others.is_empty() {
            String::new()
        } else {
            format!("; not {}", others.join(", "))
        };
        let evidence = format!("{} of {all} pass{not}", row.count(Verdict::Pass));
        let honest = Check::that(
            others.is_empty(),
            "without a fault every study passes",
            evidence,
        );
        Check {
            other_studies: others,
            ..honest.about(Subject::of("no fault"))
        }
    }

    fn title(&self) -> &'static str {
        match self.needed {
            Needed::One => {
                "Verdict of each study under each fault: `fail` detects it; n/a: term absent"
            }
            Needed::Every => {
                "Verdict of each study under each fault, and the error of its finest run"
            }
        }
    }

    /// A row of the table.
    fn cells(&self, row: &FaultRow) -> Vec<String> {
        let mut cells = vec![row.fault.name().to_owned()];
        for judged in &row.judged {
            cells.push(match (judged, self.needed) {
                (Err(reason), _) if *reason == NO_RESULT => "missing".to_owned(),
                (Err(_), _) => "n/a".to_owned(),
                (Ok(FaultVerdict { verdict, .. }), Needed::One) => verdict.name().to_owned(),
                (Ok(FaultVerdict { verdict, error }), Needed::Every) => {
                    format!("{verdict} ({error:.1e})")
                }
            });
        }
        cells
    }

    /// The errors under a fault that every study must notice.
    fn guarded(&self, row: &FaultRow) -> Vec<Quantity> {
        let mut quantities = vec![];
        if self.needed == Needed::One || row.fault == Fault::None {
            return quantities;
        }
        for (study, judged) in self.studies.iter().zip(&row.judged) {
            let error = judged.as_ref().map_or(f64::NAN, |judged| judged.error);
            if error.is_finite() {
                let id = &study.header.id;
                let guarded = Quantity::new(guarded_name(row.fault, id), error, TOLERANCE);
                let subject = Subject::of(format!("error with {}", row.fault.name())).in_case(id);
                quantities.push(guarded.about(subject));
            }
        }
        quantities
    }

    /// The rest of the summary.
    fn details_of(&self, rows: &[FaultRow]) -> String {
        let off = format!("coefficients being off by {:e}", self.relative);
        if self.needed == Needed::One {
            return off;
        }
        let honest = rows.iter().filter(|row| row.fault == Fault::None);
        let errors = honest.flat_map(|row| row.judged.iter().flatten());
        let largest = errors.map(|judged| judged.error).fold(0.0, max_or_nan);
        format!("{off}; error without a fault {largest:.1e}")
    }
}

impl FaultRow {
    /// The number of studies with this verdict.
    fn count(&self, verdict: Verdict) -> usize {
        let judged = self.judged.iter().flatten();
        judged.filter(|judged| judged.verdict == verdict).count()
    }
}

/// The run of a study with one fault.
fn with_fault<S: Plantable>(ran: &RanOf<S>, fault: Fault) -> Ran<S::Data, S::Found> {
    let Case { label, cost, data } = &ran.case;
    let found = match &ran.found {
        Ok(results) => match results.iter().find(|(planted, _)| *planted == fault) {
            Some((_, result)) => result.clone(),
            None => Err(CaseFailure::new(format!(
                "no run with the fault {}",
                fault.name()
            ))),
        },
        Err(failure) => Err(failure.clone()),
    };
    Ran {
        case: Case::new(label.clone(), *cost, data.data.clone()),
        found,
    }
}

/// Errors without a fault that are not finite; with a fault such an error is a detection.
fn not_finite_without_a_fault<S: Plantable>(results: &UnderFaults<S::Found>) -> Vec<String> {
    let honest = results.iter().find(|(fault, _)| *fault == Fault::None);
    if let Some((_, Ok(found))) = honest {
        let errors = S::errors(found);
        if errors.iter().all(|(_, error)| error.is_finite()) {
            return vec![];
        }
    }
    vec!["an error without a fault".to_owned()]
}

/// The name of the error of a study under a fault.
fn guarded_name(fault: Fault, study: &str) -> String {
    match fault {
        Fault::Defect(defect) => format!("error with {}, {study}", defect.name()),
        fault => format!("error with {} off, {study}", fault.name()),
    }
}
