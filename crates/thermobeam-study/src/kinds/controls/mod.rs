//! Planted faults: solver or sources are wrong on purpose, and a convergence study must fail.
//!
//! A check that cannot fail proves nothing. The study file asks its question by one of three
//! tables:
//!
//! | table | question |
//! | --- | --- |
//! | `[controls]` | does some study fail for each coefficient with a given relative error, and for each defect of the sources? |
//! | `[any-order]` | the same for studies of kind any-order: does each fail for every coefficient and defect named? |
//! | `[sensitivity]` | what is the smallest relative error of each coefficient for which a study fails? |
//!
//! For `[controls]` each coefficient of the solver in turn is perturbed by a relative amount, while
//! the sources keep the exact one; each [`Defect`] in turn is planted in the sources. Sources and
//! solver share no function, so it stands for the same mistake in the solver. Without a fault every
//! study must pass, since otherwise its failures would prove nothing.
//!
//! ```toml
//! [controls]
//! relative = 1e-4
//! studies = ["theorem-3.4-space.toml"]    # files beside this one
//! elements = [64, 128, 256]               # optional: levels in place of the studies' own
//! ```

pub mod any_order;
pub mod sensitivity;

use super::convergence::design::verdicts;
use super::convergence::{Convergence, Defect, Prepared};
use super::prelude::*;
use crate::kinds::settings;

/// The row of the table of kinds.
pub const ROW: KindRow = KindRow {
    name: "detects",
    read,
    why: "A check that cannot fail proves nothing. Each coefficient of the solver in turn is put off a little from that of the \
          sources, and each defect in turn is planted in the sources. A study that guards a coefficient detects an error in it \
          from some size on; bisection finds that size.",
    judged: "Every fault must make at least one of the studies fail; without a fault, all of them must pass. Of every \
             coefficient some study must detect a relative error as small as the file says.",
    failure: "A fault that no study detects: errors of this size in this place would go unnoticed, because a study has lost \
              levels or its tolerance has grown.",
    settings: settings::of_controls,
};

/// Reads a study of planted faults, or of the smallest detected faults, depending on the table in
/// the file.
fn read(header: Header, root: &Section<'_>, folder: &Path) -> Result<Box<dyn Study>, InputError> {
    let allowed = "one of the tables [controls], [any-order] and [sensitivity]";
    match only_table(root, ["controls", "any-order", "sensitivity"], allowed)? {
        "controls" => reader::<Controls>(header, root, folder),
        "any-order" => reader::<any_order::AnyOrderControls>(header, root, folder),
        _ => reader::<sensitivity::Sensitivity>(header, root, folder),
    }
}

/// The fault of a run.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Fault {
    /// Nothing.
    None,
    /// A coefficient of the solver.
    Coefficient(&'static str),
    /// The sources.
    Defect(Defect),
}

impl Fault {
    fn all() -> Vec<Self> {
        let defects = Defect::ALL.map(|(defect, _)| Fault::Defect(defect));
        [Fault::None]
            .into_iter()
            .chain(Coefficients::names().map(Fault::Coefficient))
            .chain(defects)
            .collect()
    }

    fn name(self) -> &'static str {
        match self {
            Fault::None => "none",
            Fault::Coefficient(key) => key,
            Fault::Defect(defect) => defect.name(),
        }
    }

    /// The solver's coefficients and the defect of the sources; `None` if the study lacks what is
    /// wrong, or it is zero.
    ///
    /// * `relative`: relative error of a coefficient.
    fn plant(self, theory: Coefficients, relative: f64) -> Option<(Coefficients, Option<Defect>)> {
        match self {
            Fault::None => Some((theory, None)),
            Fault::Defect(defect) => defect
                .applies(&theory.beam, theory.obstacles.as_ref())
                .then_some((theory, Some(defect))),
            Fault::Coefficient(key) => Some((theory.off(key, relative)?, None)),
        }
    }
}

/// In words, what a relative error is.
const RELATIVE: &str = "a number between 0 and 1";

fn relative(field: &Field<'_>) -> Result<f64, InputError> {
    field.number_where(RELATIVE, |r| r > 0.0 && r < 1.0)
}

/// The studies that a section names, with the section's own levels if it has any.
fn named_studies(
    section: &Section<'_>,
    folder: &Path,
) -> Result<Vec<Described<Convergence>>, InputError> {
    let file = |item: &Field<'_>| Described::<Convergence>::read(item.file(folder)?);
    let allowed = "a list of at least one study file beside this one";
    let mut studies = section.list("studies", allowed, file, |list| !list.is_empty())?;
    if section.get("elements").is_some() {
        let levels = section.list(
            "elements",
            "a list of numbers of elements",
            tables::elements,
            |_| true,
        )?;
        if !levels.is_empty() {
            studies
                .iter_mut()
                .for_each(|spec| spec.kind.refine.elements.clone_from(&levels));
        }
    }
    Ok(studies)
}

/// The verdict of each study under each fault, and the rule that judges the matrix.
struct Matrix<'s> {
    /// Ids of the studies.
    ids: Vec<&'s str>,
    /// Whether every study must notice each fault; otherwise one is enough.
    every: bool,
    /// That of completion, that of all studies without a fault, then one for each fault.
    checks: Vec<Check>,
    /// For each planted fault whether it was detected.
    detected: Vec<bool>,
    /// For each pair of a study and a fault why it was not judged.
    left_out: Vec<Option<&'static str>>,
    rows: Vec<Vec<String>>,
}

impl<'s> Matrix<'s> {
    fn new<K>(studies: &'s [Described<K>], every: bool, completion: Check) -> Self {
        let ids = studies
            .iter()
            .map(|study| study.header.id.as_str())
            .collect();
        Self {
            ids,
            every,
            checks: vec![completion],
            detected: vec![],
            left_out: vec![],
            rows: vec![],
        }
    }

    /// Adds a fault: the verdict of each study, if it has one, and its cell of the table.
    fn add(&mut self, fault: Fault, verdicts: &[Option<Verdict>], cells: Vec<String>) {
        self.rows
            .push([vec![fault.name().to_owned()], cells].concat());
        let all = verdicts.len();
        // Where every study must notice the fault, each of them has the term.
        let reason = if self.every {
            NO_RESULT
        } else {
            "the study lacks the term"
        };
        let left_out = verdicts
            .iter()
            .map(|verdict| verdict.is_none().then_some(reason));
        self.left_out.extend(left_out);
        if fault == Fault::None {
            let fail = self
                .ids
                .iter()
                .zip(verdicts)
                .filter(|(_, verdict)| **verdict != Some(Verdict::Pass));
            let others: Vec<&str> = fail.map(|(id, _)| *id).collect();
            let not = if others.is_empty() {
                String::new()
            } else {
                format!("; not {}", others.join(", "))
            };
            let evidence = format!("{} of {all} pass{not}", all - others.len());
            let honest = Check::that(
                others.is_empty(),
                "without a fault every study passes",
                evidence,
            );
            self.checks.push(Check {
                other_studies: others.iter().map(|id| (*id).to_owned()).collect(),
                ..honest.about(Subject::of("no fault"))
            });
            return;
        }
        let failed = verdicts
            .iter()
            .filter(|verdict| **verdict == Some(Verdict::Fail))
            .count();
        let (holds, by) = if self.every {
            (failed == all, " by every study")
        } else {
            (failed > 0, "")
        };
        let evidence = format!("{failed} of {all} studies notice it");
        self.detected.push(holds);
        let claim = format!("{} is detected{by}", fault.name());
        let detected = Check::that(holds, claim, evidence);
        self.checks.push(detected.about(Subject::of(fault.name())));
    }

    /// * `faults`, `more`: what was detected, and the rest of the summary; `first`: the head of the
    ///   faults' column.
    fn outcome(self, faults: &str, more: &str, title: &str, first: &str) -> Outcome {
        let detected = self.detected.iter().filter(|detected| **detected).count();
        let headline = format!("{detected} of {} {faults} detected", self.detected.len());
        let summary = format!("{headline}, {more}");
        let tables = vec![Table::new(
            title,
            [first].into_iter().chain(self.ids),
            self.rows,
        )];
        Outcome {
            headline,
            tables,
            coverage: vec![Coverage::of("pairs of a study and a fault", self.left_out)],
            ..Outcome::new(summary, vec![], self.checks)
        }
    }
}

/// A study of planted faults.
pub struct Controls {
    relative: f64,
    studies: Vec<Described<Convergence>>,
}

/// A level of a study, with and without faults.
type RanOnLevel = Ran<<Controls as Kind>::Data, <Controls as Kind>::Found>;

impl FromFile for Controls {
    fn from_document(_: &Header, root: &Section<'_>, folder: &Path) -> Result<Self, InputError> {
        let section = root.table("controls", &["relative", "studies", "elements"])?;
        let relative = relative(&section.require("relative", RELATIVE)?)?;
        Ok(Self {
            relative,
            studies: named_studies(&section, folder)?,
        })
    }
}

impl Kind for Controls {
    /// Index of a study, with the elements and steps of one of its levels, on which every fault is
    /// planted.
    type Data = (usize, (usize, usize));
    /// One run for each fault that can be planted, with its errors; NaN if it broke down.
    type Found = Vec<(Fault, Norms)>;

    fn cases(&self) -> Vec<Case<Self::Data>> {
        let faults = Fault::all().len() as f64;
        let case = |study: usize, (n, steps): (usize, usize)| {
            let label = format!("{}, n = {n}, {steps} steps", self.studies[study].header.id);
            Case::new(
                label,
                n as f64 * (steps as f64 * faults + 50.0),
                (study, (n, steps)),
            )
        };
        let levels = |study: usize| {
            self.studies[study]
                .kind
                .refine
                .cases()
                .into_iter()
                .map(move |n| case(study, n))
        };
        (0..self.studies.len()).flat_map(levels).collect()
    }

    fn run(
        &self,
        &(study, (elements, steps)): &Self::Data,
    ) -> Result<Vec<(Fault, Norms)>, CaseFailure> {
        let spec = &self.studies[study].kind;
        let mut prepared = Prepared::new(spec, elements)?;
        let mut found = vec![];
        for fault in Fault::all() {
            let Some((solver, defect)) = fault.plant(spec.theory, self.relative) else {
                continue;
            };
            // A fault that breaks a run down is detected; only the run without a fault must finish.
            let errors = match prepared.run(steps, solver, defect) {
                Err(failure) if fault == Fault::None => return Err(failure),
                errors => errors.unwrap_or(Norms::NAN),
            };
            found.push((fault, errors));
        }
        Ok(found)
    }

    fn judge(&self, ran: &[RanOnLevel]) -> Outcome {
        // In a run with a fault, a number that is not finite is a detection.
        let not_finite = |found: &Vec<(Fault, Norms)>| {
            let honest = errors_with(found, Fault::None);
            let finite =
                honest.is_some_and(|errors| errors.iter().all(|(_, error)| error.is_finite()));
            if finite {
                vec![]
            } else {
                vec!["an error without a fault".to_owned()]
            }
        };
        let mut matrix = Matrix::new(&self.studies, false, completion(ran, not_finite));
        for fault in Fault::all() {
            let verdicts: Vec<_> = (0..self.studies.len())
                .map(|study| self.verdict(study, fault, ran))
                .collect();
            let cell = |verdict: &Option<Verdict>| verdict.map_or("n/a", Verdict::name).to_owned();
            matrix.add(fault, &verdicts, verdicts.iter().map(cell).collect());
        }
        let more = format!("coefficients being off by {:e}", self.relative);
        let title = "Verdict of each study under each fault: `fail` detects it; n/a: term absent";
        matrix.outcome("planted faults", &more, title, "fault")
    }
}

impl Controls {
    /// The verdict of one study under one fault, the worst over its norms; `None` if the fault
    /// cannot be planted.
    fn verdict(&self, study: usize, fault: Fault, ran: &[RanOnLevel]) -> Option<Verdict> {
        let spec = &self.studies[study].kind;
        fault.plant(spec.theory, self.relative)?;
        let level = |ran: &RanOnLevel| {
            let errors = ran.ok().and_then(|found| errors_with(found, fault));
            (ran.case.data.1, errors.copied().unwrap_or(Norms::NAN))
        };
        let levels: Vec<_> = ran
            .iter()
            .filter(|ran| ran.case.data.0 == study)
            .map(level)
            .collect();
        Some(Verdict::worst(verdicts(spec, &levels)))
    }
}

fn errors_with(found: &[(Fault, Norms)], fault: Fault) -> Option<&Norms> {
    found
        .iter()
        .find(|(planted, _)| *planted == fault)
        .map(|(_, errors)| errors)
}
