//! Studies of runs: a list of runs of beams, and a list of checks on what they show.
//!
//! A kind of this sort is a type with [`Runs`]. It declares the numbers of a run once, as
//! [`Measured`]s: these give completion, table and guarded numbers. It judges by the checks of
//! [`checks`]. [`RunStudy`] does for all of them what does not depend on the kind.

pub mod cases;
pub mod checks;
pub mod energy;
pub mod scenes;
pub(crate) mod side_by_side;
pub(crate) mod watch;

use super::prelude::*;
use convergence_study::left_out;
use serde::de::DeserializeOwned;

/// A list of runs, and what is claimed of them.
pub trait Runs: Sized + Send + Sync {
    /// The tables of its files beside `[study]`.
    type File: DeserializeOwned + JsonSchema;
    /// What distinguishes a run from the others.
    type Run: Clone + PartialEq + Send + Sync;
    /// What a run shows.
    type Shown: Send;

    /// The study that a file describes, as in [`FromFile`].
    ///
    /// # Errors
    /// Values that do not go together.
    fn from_file(file: Self::File, folder: &Path) -> Result<Self, Refusal>;

    /// The runs, in the order in which they are judged.
    fn runs(&self) -> Vec<Case<Self::Run>>;

    /// One run: the same result on every thread, at every time.
    ///
    /// # Errors
    /// Why there is no result, with step, time and numbers.
    fn run(&self, run: &Self::Run) -> Result<Self::Shown, CaseFailure>;

    /// The numbers of a result, without a case: none may be NaN or infinite. A number that the run
    /// lacks has no value.
    fn numbers(&self, run: &Self::Run, shown: &Self::Shown) -> Vec<Measured>;

    /// The title of a table with a row for each run and its numbers, whose guarded numbers count,
    /// and the head of its first column; `None` if the rows of all tables combine runs.
    fn table(&self) -> Option<[&str; 2]> {
        None
    }

    /// The checks, and what else the results show. A study with a run that has no result is not
    /// asked: the check of completion fails, and nothing else is judged.
    fn judge(&self, results: &Results<'_, Self>) -> Findings;
}

/// What a study of runs found, except that its cases complete.
#[derive(Debug, Default)]
pub struct Findings {
    /// The result in a sentence.
    pub summary: String,
    /// The numbers to read first.
    pub headline: String,
    /// Everything judged that is not a rate.
    pub checks: Vec<Check>,
    /// Tables beside that of the runs.
    pub tables: Vec<Table>,
    /// Figures.
    pub figures: Vec<Figure>,
    /// Of items other than cases: how many were judged, and why not the others.
    pub left_out: Vec<String>,
    /// Guarded numbers beside those of the runs.
    pub quantities: Vec<Quantity>,
}

impl Findings {
    /// Those of a study in which runs have no result.
    fn of_incomplete(lacking: usize, all: usize) -> Self {
        let have = if lacking == 1 { "has" } else { "have" };
        Self {
            summary: format!(
                "{lacking} of {} {have} no result, so nothing else is judged",
                counted(all, "run")
            ),
            ..Self::default()
        }
    }
}

/// The results of a study, in the order of its cases: every run has one.
#[derive(Debug)]
pub struct Results<'r, R: Runs> {
    shown: Vec<(&'r R::Run, &'r R::Shown)>,
}

impl<'r, R: Runs> Results<'r, R> {
    /// Every run, with what it shows.
    pub fn all(&self) -> impl Iterator<Item = (&'r R::Run, &'r R::Shown)> {
        self.shown.iter().copied()
    }

    /// The runs that judge something.
    ///
    /// * `items`: what that is, in the plural.
    /// * `reason`: why a run does not; `None` if it does.
    pub fn left_out(
        &self,
        items: &str,
        reason: impl Fn(&R::Run, &R::Shown) -> Option<&'static str>,
    ) -> Option<String> {
        left_out(items, self.all().map(|(run, shown)| reason(run, shown)))
    }
}

/// The study of these runs.
#[derive(Debug, Clone, PartialEq)]
pub struct RunStudy<R>(pub R);

impl<R: Runs> FromFile for RunStudy<R> {
    type File = R::File;

    fn from_file(file: R::File, _: &Header, folder: &Path) -> Result<Self, Refusal> {
        R::from_file(file, folder).map(Self)
    }
}

impl<R: Runs> Kind for RunStudy<R> {
    type Data = R::Run;
    type Found = R::Shown;

    fn cases(&self) -> Vec<Case<R::Run>> {
        self.0.runs()
    }

    fn run(&self, run: &R::Run) -> Result<R::Shown, CaseFailure> {
        self.0.run(run)
    }

    fn judge(&self, ran: &[Ran<R::Run, R::Shown>]) -> Outcome {
        let numbers = self.numbers(ran);
        let lacking = numbers.iter().filter(|ran| ran.ok().is_none()).count();
        let Findings {
            summary,
            headline,
            checks,
            tables,
            figures,
            left_out,
            quantities,
        } = if lacking > 0 || numbers.is_empty() {
            Findings::of_incomplete(lacking, numbers.len())
        } else {
            let shown = ran
                .iter()
                .filter_map(|ran| Some((&ran.case.data, ran.ok()?)));
            self.0.judge(&Results {
                shown: shown.collect(),
            })
        };
        let complete = Check::completion(&numbers, |numbers| Measured::not_finite(numbers));
        let checks = [vec![complete], checks].concat();
        let own = self.sheet(numbers);
        let own_quantities = own.as_ref().map_or(vec![], Sheet::quantities);
        let own_table = own.as_ref().and_then(Sheet::table).into_iter();
        Outcome {
            left_out,
            tables: own_table.chain(tables).collect(),
            figures,
            quantities: [own_quantities, quantities].concat(),
            headline: headline.into(),
            ..Outcome::new(summary, vec![], checks)
        }
    }
}

impl<R: Runs> RunStudy<R> {
    /// The numbers of each run of the study in place of its result, or why there is none.
    fn numbers(&self, ran: &[Ran<R::Run, R::Shown>]) -> Vec<Ran<(), Vec<Measured>>> {
        let mut numbers = vec![];
        for case in self.0.runs() {
            let data = &case.data;
            let found = match ran.iter().find(|ran| ran.case.data == *data) {
                Some(ran) => ran.found.as_ref().map_err(CaseFailure::clone),
                None => Err(CaseFailure::new("it was not run")),
            };
            let found = found.map(|shown| self.0.numbers(data, shown));
            let case = Case::new(case.label, case.cost, ());
            numbers.push(Ran { case, found });
        }
        numbers
    }

    /// The numbers of the runs, if the study shows them.
    fn sheet(&self, numbers: Vec<Ran<(), Vec<Measured>>>) -> Option<Sheet> {
        let [title, first] = self.0.table()?;
        let of_run = |ran: Ran<(), Vec<Measured>>| {
            let case = ran.case.label;
            let numbers = ran.found.unwrap_or_default().into_iter();
            numbers.map(move |mut one| {
                one.case.clone_from(&case);
                one
            })
        };
        Some(Sheet::new(
            title,
            first,
            numbers.into_iter().flat_map(of_run),
        ))
    }
}
