//! Planted faults: solver or sources are wrong on purpose, and a convergence study must fail.
//!
//! A check that cannot fail proves nothing. The study file asks its question by one of three tables:
//!
//! | table | question |
//! | --- | --- |
//! | `[controls]` | does some study fail for each coefficient with a given relative error, and for each defect of the sources? |
//! | `[any-order]` | the same for studies of kind any-order: does each fail for every coefficient named? |
//! | `[sensitivity]` | what is the smallest relative error of each coefficient for which a study fails? |

pub mod any_order;
pub mod matrix;
pub mod sensitivity;

use convergence_study::study::Study;

use super::convergence::{Convergence, Defect};
use super::prelude::*;
use crate::scene::Coefficients;

/// The row of the table of kinds.
pub const ROW: KindRow = KindRow {
    name: "controls",
    read,
    why: "A check that cannot fail proves nothing. Each coefficient of the solver in turn is put off a little from that of the \
          sources, and each defect in turn is planted in the sources. A study that guards a coefficient detects an error in it \
          from some size on; bisection finds that size.",
    judged: "Every fault must make at least one of the studies fail; without a fault, all of them must pass. Of every \
             coefficient some study must detect a relative error as small as the file says.",
    failure: "A fault that no study detects: errors of this size in this place would go unnoticed, because a study has lost \
              levels or its tolerance has grown.",
};

/// Reads a study of planted faults, or of the smallest detected faults, depending on the table in the file.
fn read(header: Header, root: &Section<'_>, folder: &Path) -> Result<Box<dyn Study>, InputError> {
    let tables = ["controls", "any-order", "sensitivity"];
    root.allow(&[&["study"], &tables[..]].concat())?;
    let allowed = "one of the tables [controls], [any-order] and [sensitivity]";
    match tables.into_iter().filter(|table| root.get(table).is_some()).collect::<Vec<_>>()[..] {
        [] => Err(root.missing("controls", allowed)),
        ["controls"] => reader::<matrix::Controls>(header, root, folder),
        ["any-order"] => reader::<any_order::AnyOrderControls>(header, root, folder),
        [_] => reader::<sensitivity::Sensitivity>(header, root, folder),
        [_, second, ..] => Err(root.refuse(second, "a second table", allowed)),
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
        let defects = Defect::ALL.map(Fault::Defect);
        [Fault::None].into_iter().chain(Coefficients::names().map(Fault::Coefficient)).chain(defects).collect()
    }

    fn name(self) -> &'static str {
        match self {
            Fault::None => "none",
            Fault::Coefficient(key) => key,
            Fault::Defect(defect) => defect.name(),
        }
    }

    /// The solver's coefficients and the defect of the sources; `None` if the study lacks the coefficient or it is zero.
    ///
    /// * `relative`: relative error of a coefficient.
    fn plant(self, study: &Convergence, relative: f64) -> Option<(Coefficients, Option<Defect>)> {
        match self {
            Fault::None => Some((study.theory, None)),
            Fault::Defect(defect) => Some((study.theory, Some(defect))),
            Fault::Coefficient(key) => Some((study.theory.off(key, relative)?, None)),
        }
    }
}

/// In words, what a relative error is.
const RELATIVE: &str = "a number between 0 and 1";

fn relative(field: &Field<'_>) -> Result<f64, InputError> {
    field.number_where(RELATIVE, |r| r > 0.0 && r < 1.0)
}

/// The studies that a section names, with the section's own levels if it has any.
fn named_studies(section: &Section<'_>, folder: &Path) -> Result<Vec<Convergence>, InputError> {
    let file = |item: &Field<'_>| Convergence::read(item.file(folder)?);
    let allowed = "a list of at least one study file beside this one";
    let mut studies = section.list("studies", allowed, file, |list| !list.is_empty())?;
    if section.get("elements").is_some() {
        let levels = section.list("elements", "a list of numbers of elements", tables::elements, |_| true)?;
        studies.iter_mut().filter(|_| !levels.is_empty()).for_each(|spec| spec.refine.elements.clone_from(&levels));
    }
    Ok(studies)
}

/// The verdict of each study under each fault, and the rule that judges the matrix.
struct Matrix<'s> {
    /// Ids of the studies.
    ids: Vec<&'s str>,
    /// Whether every study must notice each fault; otherwise one is enough.
    every: bool,
    checks: Vec<Check>,
    rows: Vec<Vec<String>>,
    faults: usize,
    detected: usize,
}

impl<'s> Matrix<'s> {
    fn new(ids: impl Iterator<Item = &'s Header>, every: bool, completion: Check) -> Self {
        let ids = ids.map(|header| header.id.as_str()).collect();
        Self { ids, every, checks: vec![completion], rows: vec![], faults: 0, detected: 0 }
    }

    /// Adds a fault: the verdict of each study, if it has one, and its cell of the table.
    fn add(&mut self, fault: Fault, verdicts: &[Option<Verdict>], cells: Vec<String>) {
        self.rows.push([vec![fault.name().to_owned()], cells].concat());
        let all = verdicts.len();
        if fault == Fault::None {
            let fail = self.ids.iter().zip(verdicts).filter(|(_, verdict)| **verdict != Some(Verdict::Pass));
            let others: Vec<&str> = fail.map(|(id, _)| *id).collect();
            let not = if others.is_empty() { String::new() } else { format!("; not {}", others.join(", ")) };
            let evidence = format!("{} of {all} pass{not}", all - others.len());
            self.checks.push(Check::that(others.is_empty(), "without a fault every study passes", evidence));
            return;
        }
        let failed = verdicts.iter().filter(|verdict| **verdict == Some(Verdict::Fail)).count();
        let (holds, by) = if self.every { (failed == all, " by every study") } else { (failed > 0, "") };
        let evidence = format!("{failed} of {all} studies notice it");
        self.checks.push(Check::that(holds, format!("{} is detected{by}", fault.name()), evidence));
        self.faults += 1;
        self.detected += usize::from(holds);
    }

    fn table(&mut self, title: &str, first: &str) -> Table {
        Table::new(title, [first].into_iter().chain(self.ids.iter().copied()), std::mem::take(&mut self.rows))
    }
}
