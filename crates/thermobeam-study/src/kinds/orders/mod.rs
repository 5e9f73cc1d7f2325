//! Orders of convergence: a source measures errors on levels of refinement, and how they are
//! judged, drawn and guarded is the same for all sources.
//!
//! A [`ErrorSource`] says what it runs and which errors over which levels its claims are about.
//! [`Orders`] makes a kind of study of it. A new source is a file here and a row in
//! [`KINDS`](super::KINDS).

pub mod any_order;
pub mod frequencies;
pub mod manufactured;
mod one_step;
pub(crate) mod planted;
pub mod self_convergence;
pub mod vibration;

use std::ops::{Deref, DerefMut};

use convergence_study::{Budget, Grid, LevelErrors, Levels, Prose, Untested, variants::Variants};

use serde::de::DeserializeOwned;

use super::{prelude::*, tables::control};
use crate::scene::Coefficients;

/// Where the errors of a study come from.
pub trait ErrorSource: Send + Sync + Sized + 'static {
    /// The row of the table of kinds.
    const ROW: KindRow;

    /// The tables of its files beside `[study]`.
    type File: DeserializeOwned + JsonSchema;
    /// The input of a run.
    type Data: Clone + Send + Sync;
    /// What a run measures.
    type Found: Send;

    /// The source that a file describes, as in [`FromFile`].
    ///
    /// # Errors
    /// Values that do not go together.
    fn from_file(file: Self::File, folder: &Path) -> Result<Self, Refusal>;

    /// As [`FromFile::named_files`].
    fn named_files(_file: &Self::File) -> Vec<&str> {
        vec![]
    }

    /// The runs, coarse to fine.
    fn cases(&self) -> Vec<Case<Self::Data>>;

    /// One run.
    ///
    /// # Errors
    /// [`CaseFailure`] if it does not reach its end.
    fn run(&self, data: &Self::Data) -> Result<Self::Found, CaseFailure>;

    /// The errors that are judged by their rates, and what is checked and shown beside them.
    fn measured(&self, runs: &Runs<Self>) -> SourceResult;

    /// The next finer run, for a study that adds levels until its rates are decided.
    fn finer(&self, _runs: &Runs<Self>) -> Option<Finer<Self::Data>> {
        None
    }

    /// As [`Kind::untested`].
    fn untested(&self) -> Vec<Untested> {
        vec![]
    }

    /// The coefficients of theory and solver, where a file may let them differ.
    fn coefficients(&self) -> Option<[Coefficients; 2]> {
        None
    }

    /// As [`Kind::variants`].
    fn variants(&self) -> Option<Variants> {
        None
    }

    /// As [`Kind::with_variant`].
    fn with_variant(&self, _variant: &str) -> Option<Self> {
        None
    }
}

/// The results of a source.
pub type Runs<S> = [Ran<<S as ErrorSource>::Data, <S as ErrorSource>::Found>];

/// What the runs of a source say.
#[derive(Default)]
pub struct SourceResult {
    /// Errors that are judged by their rates.
    pub series: Vec<Series>,
    /// Numbers beside the errors and their rates.
    pub sheets: Vec<Sheet>,
    /// Tables beside that of the rates.
    pub tables: Vec<Table>,
    /// Figures beside those of the series.
    pub figures: Vec<Figure>,
    /// The summary of a study without rates.
    pub summary: String,
}

impl SourceResult {
    /// The errors that are NaN or infinite, of a claim or not: each of them fails.
    fn broken(&self) -> Sheet {
        let mut broken = vec![];
        for Series { levels, .. } in &self.series {
            for column in &levels.columns {
                for (level, error) in levels.refinements.iter().zip(&column.errors) {
                    if let Some(error) = error.filter(|error| !error.is_finite()) {
                        broken.push(measured(&level.label, &column.name, error));
                    }
                }
            }
        }
        Sheet::untabled(broken)
    }
}

/// Errors over levels, judged together.
pub struct Series {
    /// The errors, and the claims about them.
    pub levels: Levels,
    /// Whether the orders are claims; otherwise the rates are shown and decide nothing.
    pub is_claimed: bool,
    /// Rates with their verdicts, errors, guarded numbers.
    judged: Outcome,
    picture: Option<Picture>,
}

/// How a series is drawn: planted faults and further levels need its verdict alone.
enum Picture {
    /// Over the levels; the arguments are those of [`Levels::figure`].
    OverLevels {
        file: String,
        subject: Option<String>,
        caption: String,
    },
    /// On a grid of mesh widths and time steps.
    OnGrid(Grid),
}

/// The next level of a study that adds levels.
pub struct Finer<D> {
    /// The run.
    pub case: Case<D>,
    /// What it costs, and what the study may cost.
    pub budget: Budget,
}

/// A study of orders: its source, judged.
#[derive(Debug, Clone, PartialEq)]
pub struct Orders<S>(pub S);

impl<S> Deref for Orders<S> {
    type Target = S;

    fn deref(&self) -> &S {
        &self.0
    }
}

impl<S> DerefMut for Orders<S> {
    fn deref_mut(&mut self) -> &mut S {
        &mut self.0
    }
}

impl<S: ErrorSource> FromFile for Orders<S> {
    type File = S::File;

    fn from_file(file: S::File, header: &Header, folder: &Path) -> Result<Self, Refusal> {
        // A file of another kind may have the same tables.
        if header.kind != S::ROW.name {
            let found = format!("\"{}\"", header.kind);
            let allowed = format!("\"{}\" for this reader", S::ROW.name);
            return Err(Refusal::new("study.kind", found, allowed));
        }
        S::from_file(file, folder).map(Self)
    }

    fn named_files(file: &S::File) -> Vec<&str> {
        S::named_files(file)
    }
}

impl<S: ErrorSource> Kind for Orders<S> {
    type Data = S::Data;
    type Found = S::Found;

    fn cases(&self) -> Vec<Case<S::Data>> {
        self.0.cases()
    }

    fn more(&self, runs: &Runs<S>) -> Option<Case<S::Data>> {
        let finer = self.finer_of_complete(runs)?;
        let measured = self.0.measured(runs);
        let first = measured.series.first()?;
        let Finer { case, budget } = finer;
        budget.allows(&first.levels, first.rates()).then_some(case)
    }

    fn run(&self, data: &S::Data) -> Result<S::Found, CaseFailure> {
        self.0.run(data)
    }

    fn judge(&self, runs: &Runs<S>) -> Outcome {
        let measured = self.0.measured(runs);
        // Every part can only worsen the verdict, and completion is always one of them.
        let mut outcome = Outcome {
            verdict: Verdict::Pass,
            ..Outcome::new("", vec![], vec![])
        };
        let mut not_claimed = vec![];
        for series in &measured.series {
            let mut judged = series.drawn_outcome();
            add_levels(&mut outcome.levels, std::mem::take(&mut judged.levels));
            if series.is_claimed {
                outcome.extend(judged);
            } else {
                not_claimed.extend(judged.rates);
            }
        }
        if !not_claimed.is_empty() {
            let title = "Rates shown, not claimed: not needed for a pass";
            outcome.tables.push(Table::of_rates(title, &not_claimed));
        }
        let broken = measured.broken();
        let completion = Check::completion(runs, |_| vec![]);
        outcome.extend(Outcome {
            tables: measured.tables,
            figures: measured.figures,
            ..Outcome::new("", vec![], vec![completion])
        });
        let mut outcome = outcome.with_sheets(measured.sheets.into_iter().chain([broken]));
        let coefficients = self.0.coefficients();
        let verdict = outcome.verdict;
        if let Some(claim) = coefficients.and_then(|both| control(both, verdict)) {
            outcome = outcome.with_sheets([Sheet::untabled([claim])]);
        }
        let Some(first) = measured.series.first() else {
            let summary = Prose::from(measured.summary);
            outcome.headline.clone_from(&summary);
            outcome.summary = summary;
            return outcome;
        };
        let outcome = outcome.summed_up_by_rates("");
        match self.finer_of_complete(runs) {
            Some(Finer { budget, .. }) => budget.conclude(outcome, &first.levels, first.rates()),
            None => outcome,
        }
    }

    fn untested(&self) -> Vec<Untested> {
        self.0.untested()
    }

    fn variants(&self) -> Option<Variants> {
        self.0.variants()
    }

    fn with_variant(&self, variant: &str) -> Option<Self> {
        self.0.with_variant(variant).map(Self)
    }
}

impl<S: ErrorSource> Orders<S> {
    /// The next level; `None` also if a run has failed.
    fn finer_of_complete(&self, runs: &Runs<S>) -> Option<Finer<S::Data>> {
        let is_complete = runs.iter().all(|run| run.found.is_ok());
        self.0.finer(runs).filter(|_| is_complete)
    }
}

impl Series {
    /// Judges errors over levels.
    pub fn new(levels: Levels) -> Self {
        let judged = Outcome::new("", levels.judge(), vec![]);
        Self::of(levels, judged)
    }

    /// Judges the same errors on a grid of mesh widths and time steps, which is also how they are
    /// drawn.
    pub fn on_grid(levels: Levels, grid: Grid) -> Self {
        let judged = grid.judge();
        Self {
            picture: Some(Picture::OnGrid(grid)),
            ..Self::of(levels, judged)
        }
    }

    fn of(levels: Levels, judged: Outcome) -> Self {
        Self {
            judged: Outcome {
                levels: levels.errors(),
                quantities: levels.quantities(&judged.rates),
                ..judged
            },
            levels,
            is_claimed: true,
            picture: None,
        }
    }

    /// The same with a figure; the arguments are those of [`Levels::figure`].
    #[must_use]
    pub fn drawn(self, file: &str, subject: Option<&str>, caption: &str) -> Self {
        Self {
            picture: Some(Picture::OverLevels {
                file: file.to_owned(),
                subject: subject.map(str::to_owned),
                caption: caption.to_owned(),
            }),
            ..self
        }
    }

    /// Rates, errors and guarded numbers, with the figures.
    fn drawn_outcome(&self) -> Outcome {
        let mut outcome = self.judged.clone();
        match &self.picture {
            None => {}
            Some(Picture::OverLevels {
                file,
                subject,
                caption,
            }) => outcome.figures.push(self.levels.figure(
                file,
                subject.clone(),
                caption.clone(),
                self.rates(),
            )),
            Some(Picture::OnGrid(grid)) => outcome
                .figures
                .extend(grid.figures(self.rates(), |name| self.axis_of(name))),
        }
        outcome
    }

    /// The axis of an error in the figures of a grid.
    fn axis_of(&self, name: &str) -> String {
        let mut columns = self.levels.columns.iter();
        let column = columns.find(|column| column.name == name);
        let symbol = column.and_then(|column| column.symbol.as_deref());
        format!("error, {}", symbol.unwrap_or(name))
    }

    /// The verdict on all its rates.
    pub fn verdict(&self) -> Verdict {
        self.judged.verdict
    }

    /// The rates of the errors with claims, with their verdicts.
    pub fn rates(&self) -> &[NamedRate] {
        &self.judged.rates
    }
}

/// Adds levels, and errors to those that are known.
fn add_levels(levels: &mut Vec<LevelErrors>, more: Vec<LevelErrors>) {
    for level in more {
        match levels
            .iter_mut()
            .find(|known| known.parameters == level.parameters)
        {
            Some(known) => {
                known.errors.extend(level.errors);
                known.without.extend(level.without);
            }
            None => levels.push(level),
        }
    }
}
