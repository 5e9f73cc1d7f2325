//! Planted faults: solver or sources are wrong on purpose, and studies of orders must fail. A check
//! that cannot fail proves nothing.
//!
//! Each coefficient of the solver in turn is perturbed by a relative amount, while the sources keep
//! the exact one; each [`Defect`] in turn is planted in the sources. Sources and solver share no
//! function, so it stands for the same mistake in the solver. Without a fault every study must
//! pass, since otherwise its failures would prove nothing.
//!
//! The studies are those of the files, with their claims. Of any other study that passes `untested`
//! says by the same means which coefficients it does not test.

use std::path::Path;

use super::prelude::*;
use crate::exact::defect::Defect;
pub use crate::kinds::orders::planted::Plantable;
pub use crate::kinds::orders::planted::fault::{Fault, Planted};
use crate::kinds::orders::{
    Orders, any_order::AnyOrder, manufactured::Convergence, planted::verdict,
};
use convergence_study::{InputError, Kind, Ran, Verdict};

/// What the study says about itself.
pub const ABOUT: About = About {
    id: "negative-controls",
    claim: "An error of 1e-4 in any coefficient, a source at the wrong time level, a dropped boundary load and a mistake in a function are all detected",
    tier: Tier::Quick,
    group: "the harness",
    home: file!(),
};

/// The same for the solver of any order.
pub const ANY_ORDER: About = About {
    id: "any-order-controls",
    claim: "Every coefficient and every term of the solver of any order is checked: an error of 1e-4 in a coefficient is detected, and so is a mistake in a function",
    ..ABOUT
};

/// Relative error of a coefficient.
const RELATIVE: f64 = 1e-4;
/// Relative change of an error that the baseline tolerates.
const GUARDED: f64 = 1e-3;

/// The files of the studies that are put to the test, and their levels.
const FILES: [&str; 4] = [
    "theorem-3.4-space",
    "theta-a-20-space",
    "no-contact-space",
    "midpoint-space",
];
const ELEMENTS: [usize; 4] = [64, 128, 256, 512];
const FILES_OF_ANY_ORDER: [&str; 1] = ["any-order-coefficients"];

/// Studies of orders under each fault.
///
/// * `S`: the source of their errors.
#[derive(Debug, Clone)]
pub struct Faults<S> {
    /// The studies, or why a file of them cannot be read.
    studies: Result<Vec<Described<Orders<S>>>, InputError>,
    /// No fault at all comes first.
    faults: Vec<Fault>,
    /// Whether each study must notice each fault; otherwise one of them, since a study may lack the
    /// term that is wrong.
    by_each: bool,
}

/// The study.
pub fn study() -> Described<Faults<Convergence>> {
    let mut studies = read::<Convergence>(&FILES);
    for study in studies.iter_mut().flatten() {
        study.kind.refine.elements = ELEMENTS.to_vec();
        // It is claimed at the finest level of the study's own file.
        study.kind.constant = None;
    }
    ABOUT.study(Faults {
        studies,
        faults: Fault::all(),
        by_each: false,
    })
}

/// The study of the solver of any order.
pub fn any_order() -> Described<Faults<AnyOrder>> {
    // The exact rotation has no moment at x = 1.
    let is_planted = |fault: &Fault| match fault {
        Fault::Defect(defect) => defect.is_of_the_problem() && *defect != Defect::MomentDropped,
        _ => true,
    };
    ANY_ORDER.study(Faults {
        studies: read(&FILES_OF_ANY_ORDER),
        faults: Fault::all().into_iter().filter(is_planted).collect(),
        by_each: true,
    })
}

/// The studies of these files of the repository.
fn read<S: Plantable>(files: &[&str]) -> Result<Vec<Described<Orders<S>>>, InputError> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../studies");
    let files = files.iter().map(|file| folder.join(format!("{file}.toml")));
    files.map(Described::read).collect()
}

/// A run of a study, for every fault.
#[derive(Debug, Clone, PartialEq)]
pub struct RunOf<D> {
    /// The place of the study.
    pub study: usize,
    /// What it runs; `None` if the studies cannot be read.
    pub data: Option<Case<D>>,
}

/// The result of a run with each fault that can be planted.
pub type UnderFaults<F> = Vec<(Fault, Result<F, CaseFailure>)>;

/// The runs of studies, and their results.
type Shown<'s, S> = [(
    &'s RunOf<<S as crate::kinds::orders::ErrorSource>::Data>,
    &'s UnderFaults<<S as crate::kinds::orders::ErrorSource>::Found>,
)];

/// What a study says under a fault.
struct Judged {
    verdict: Verdict,
    /// The first error of its finest run; `None` if that broke down.
    error: Option<f64>,
}

impl<S: Plantable> Kind for Faults<S> {
    type Data = RunOf<S::Data>;
    type Found = UnderFaults<S::Found>;

    fn cases(&self) -> Vec<Case<RunOf<S::Data>>> {
        let Ok(studies) = &self.studies else {
            let run = RunOf {
                study: 0,
                data: None,
            };
            return vec![Case::new("the files of the studies", 1.0, run)];
        };
        let faults = self.faults.len() as f64;
        let mut runs = vec![];
        for (study, described) in studies.iter().enumerate() {
            for case in described.kind.cases() {
                let label = format!("{}, {}", described.header.id, case.label);
                let cost = case.cost * faults;
                let settings = case.settings.clone();
                let data = Some(case);
                runs.push(Case {
                    settings,
                    ..Case::new(label, cost, RunOf { study, data })
                });
            }
        }
        runs
    }

    fn run(
        &self,
        RunOf { study, data }: &RunOf<S::Data>,
    ) -> Result<UnderFaults<S::Found>, CaseFailure> {
        let studies = self.studies.as_ref().map_err(|error| error.clone())?;
        let Some(Case { data, .. }) = data else {
            return Err(CaseFailure::new("no run"));
        };
        let study = &studies[*study].kind.0;
        let planted = self.faults.iter().filter_map(|fault| {
            let planted = fault.plant(study.theory(), RELATIVE)?;
            Some((*fault, planted))
        });
        let (faults, planted): (Vec<Fault>, Vec<Planted>) = planted.unzip();
        let results = faults.into_iter().zip(study.run_planted(data, &planted)?);
        let results: UnderFaults<S::Found> = results.collect();
        // A fault that breaks a run down is detected; only the run without a fault must finish.
        match &results[..] {
            [(Fault::None, Err(failure)), ..] => Err(failure.clone()),
            _ => Ok(results),
        }
    }

    fn judge(&self, ran: &[Ran<RunOf<S::Data>, UnderFaults<S::Found>>]) -> Outcome {
        Outcome::of_complete(self, ran, |shown| {
            let studies = self.studies.as_deref().unwrap_or_default();
            let (mut honest, mut planted) = (vec![], vec![]);
            let mut detected = 0;
            let mut faults = 0;
            for &fault in &self.faults {
                let each = studies.iter().enumerate();
                let each: Vec<(&str, Option<Judged>)> = each
                    .map(|(k, study)| (study.header.id.as_str(), judged(k, study, fault, shown)))
                    .collect();
                if fault == Fault::None {
                    honest = each
                        .iter()
                        .flat_map(|(id, judged)| passes(id, judged))
                        .collect();
                    continue;
                }
                let noticed = self.noticed(fault, &each);
                detected += usize::from(noticed.holds() == Some(true));
                faults += 1;
                planted.extend(each.iter().map(|(id, judged)| self.cell(fault, id, judged)));
                planted.push(noticed);
            }
            let title = format!(
                "Verdict of each study under each fault, coefficients off by {RELATIVE:e}: `fail` detects it; n/a: term absent"
            );
            let sheets = [
                Sheet::new("Without a fault every study passes", "study", honest),
                Sheet::new(title, "fault", planted),
            ];
            let headline = format!("{detected} of {faults} planted faults detected");
            Outcome::of_sheets(sheets, "").headed(headline)
        })
    }
}

impl<S: Plantable> Faults<S> {
    /// The number of studies that notice a fault.
    fn noticed(&self, fault: Fault, each: &[(&str, Option<Judged>)]) -> Measured {
        let fails = |judged: &Judged| judged.verdict == Verdict::Fail;
        let noticing = each
            .iter()
            .filter(|(_, judged)| judged.as_ref().is_some_and(fails));
        let must = match self.by_each {
            true => Must::Count(each.len()),
            false => Must::AtLeast(1.0),
        };
        measured(
            fault.name(),
            "studies that notice it",
            noticing.count() as f64,
        )
        .fixed(0)
        .must_be(must)
    }

    /// The verdict of a study under a fault; its error is guarded where every study must notice.
    fn cell(&self, fault: Fault, id: &str, judged: &Option<Judged>) -> Measured {
        let words = judged
            .as_ref()
            .map_or("n/a", |judged| judged.verdict.name());
        let error = judged.as_ref().and_then(|judged| judged.error);
        let cell = measured(fault.name(), id, error);
        if !self.by_each {
            return cell.words(words);
        }
        let known = match fault {
            Fault::Defect(defect) => format!("error with {}, {id}", defect.name()),
            fault => format!("error with {} off, {id}", fault.name()),
        };
        let error = error.map_or_else(String::new, |error| format!(" ({error:.1e})"));
        cell.words(format!("{words}{error}"))
            .recorded_as(known, GUARDED)
    }
}

/// A study without a fault.
fn passes(id: &str, judged: &Option<Judged>) -> [Measured; 2] {
    let does_pass = |judged: &Judged| judged.verdict.is_pass();
    let fails = !judged.as_ref().is_some_and(does_pass);
    let error = judged.as_ref().and_then(|judged| judged.error);
    [
        none_of(id, "does not pass", usize::from(fails)),
        measured(id, "error of its finest run", error).scientific(1),
    ]
}

/// The verdict of the study at this place under a fault; `None` if it lacks the term.
fn judged<S: Plantable>(
    place: usize,
    study: &Described<Orders<S>>,
    fault: Fault,
    shown: &Shown<'_, S>,
) -> Option<Judged> {
    let source = &study.kind.0;
    fault.plant(source.theory(), RELATIVE)?;
    let own = shown.iter().filter(|(run, _)| run.study == place);
    let runs = own.filter_map(|(run, results)| {
        let result = results.iter().find(|(planted, _)| *planted == fault);
        let missing = || Err(CaseFailure::new(format!("no run with {}", fault.name())));
        Some(Ran {
            case: run.data.clone()?,
            found: result.map_or_else(missing, |(_, result)| result.clone()),
        })
    });
    let runs: Vec<Ran<S::Data, S::Found>> = runs.collect();
    let errors = runs.last()?.ok().map(S::errors);
    let first = errors.and_then(|errors| errors.first().map(|(_, error)| *error));
    Some(Judged {
        verdict: verdict(source, &runs),
        error: first.filter(|error| error.is_finite()),
    })
}
