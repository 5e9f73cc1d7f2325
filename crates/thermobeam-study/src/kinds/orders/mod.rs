//! Orders of convergence: a source measures errors on levels of refinement, and how they are
//! judged, drawn and guarded is the same for all sources.
//!
//! A [`Source`] says what it runs and which errors over which levels its claims are about.
//! [`Orders`] makes a kind of study of it. A new source is a file here and a row in
//! [`KINDS`](super::KINDS).

pub mod any_order;
pub mod frequencies;
pub mod manufactured;
mod one_step;
pub mod self_convergence;
pub mod vibration;

use std::ops::{Deref, DerefMut};

use convergence_study::study::LevelErrors;
use convergence_study::study::grid::Grid;
use convergence_study::study::levels::{Rates, rate_table};
use convergence_study::study::until_decided::{self, Next};

use super::prelude::*;

/// Where the errors of a study come from.
pub trait Source: Send + Sync + Sized + 'static {
    /// The row of the table of kinds.
    const ROW: KindRow;

    /// The input of a run.
    type Data: Clone + Send + Sync;
    /// What a run measures.
    type Found: Send;

    /// Reads the source from the document of its study.
    ///
    /// * `folder`: the folder of the file; names of other files are relative to it.
    ///
    /// # Errors
    /// [`InputError`] with file, line, field, the value found and the values allowed.
    fn read(root: &Section<'_>, folder: &Path) -> Result<Self, InputError>;

    /// The runs, coarse to fine.
    fn cases(&self) -> Vec<Case<Self::Data>>;

    /// One run.
    ///
    /// # Errors
    /// [`CaseFailure`] if it does not reach its end.
    fn run(&self, data: &Self::Data) -> Result<Self::Found, CaseFailure>;

    /// Names of the numbers of a run that are NaN or infinite.
    fn not_finite(&self, found: &Self::Found) -> Vec<String>;

    /// The errors that are judged by their rates, with the claims about them.
    fn series(&self, runs: &Runs<Self>) -> Vec<Series>;

    /// Checks beside the rates.
    ///
    /// * `series`: those of the same runs.
    fn checks(&self, _runs: &Runs<Self>, _series: &[Series]) -> Vec<Check> {
        vec![]
    }

    /// What the study shows beside errors and rates.
    ///
    /// * `judged`: errors, rates and checks; `series`: those of the same runs.
    fn shown(&self, _runs: &Runs<Self>, _series: &[Series], _judged: &Outcome) -> Shown {
        Shown::default()
    }

    /// The next finer run, for a study that adds levels until its rates are decided.
    fn finer(&self, _runs: &Runs<Self>) -> Option<Finer<Self::Data>> {
        None
    }

    /// As [`Kind::details`].
    fn details(&self) -> Vec<(String, String)> {
        vec![]
    }

    /// As [`Kind::untested`].
    fn untested(&self) -> Vec<Untested> {
        vec![]
    }
}

/// The results of a source.
pub type Runs<S> = [Ran<<S as Source>::Data, <S as Source>::Found>];

/// Errors over levels that are judged together.
pub struct Series {
    /// The errors, and the claims about them.
    pub levels: Levels,
    /// Whether the orders are claims; otherwise the rates are shown and decide nothing.
    pub is_claimed: bool,
    /// Their figure; `None` if the source draws them itself.
    pub figure: Option<Drawn>,
    /// The same errors on a grid of mesh widths and time steps: rates and figures are then those of
    /// the grid.
    pub grid: Option<Grid>,
}

/// A figure of errors over levels; the arguments of [`Levels::figure`].
pub struct Drawn {
    /// The last part of the name of its file.
    pub file: String,
    /// What has these errors, for the title.
    pub subject: Option<String>,
    /// The content, as a sentence.
    pub caption: String,
}

/// What a source shows beside errors and rates.
#[derive(Default)]
pub struct Shown {
    /// Tables.
    pub tables: Vec<Table>,
    /// Figures.
    pub figures: Vec<Figure>,
    /// Guarded numbers.
    pub quantities: Vec<Quantity>,
    /// The summary of a study without rates.
    pub summary: String,
}

/// The next level of a study that adds levels.
pub struct Finer<D> {
    /// The run.
    pub case: Case<D>,
    /// Its cost, in the unit of the budget.
    pub cost: f64,
    /// The cost of all levels so far.
    pub spent: f64,
    /// The budget of the study.
    pub budget: f64,
    /// The unit of costs and budget, in words.
    pub unit: &'static str,
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

impl<S: Source> FromFile for Orders<S> {
    fn from_document(
        header: &Header,
        root: &Section<'_>,
        folder: &Path,
    ) -> Result<Self, InputError> {
        // Studies of other kinds name files of a source.
        if header.kind != S::ROW.name {
            let study = root.require("study", "a table")?.section()?;
            let found = format!("\"{}\"", header.kind);
            return Err(study.refuse(
                "kind",
                found,
                format!("\"{}\" for this reader", S::ROW.name),
            ));
        }
        S::read(root, folder).map(Self)
    }
}

impl<S: Source> Kind for Orders<S> {
    type Data = S::Data;
    type Found = S::Found;

    fn cases(&self) -> Vec<Case<S::Data>> {
        self.0.cases()
    }

    fn more(&self, runs: &Runs<S>) -> Option<Case<S::Data>> {
        let (next, finer) = self.next(runs, self.0.series(runs).first()?)?;
        (next == Next::Another).then_some(finer.case)
    }

    fn run(&self, data: &S::Data) -> Result<S::Found, CaseFailure> {
        self.0.run(data)
    }

    fn judge(&self, runs: &Runs<S>) -> Outcome {
        let series = self.0.series(runs);
        // Each part can only worsen the verdict, and completion is always one of them.
        let mut outcome = Outcome {
            verdict: Verdict::Pass,
            ..Outcome::new("", vec![], vec![])
        };
        let mut not_claimed = vec![];
        for series in &series {
            let mut part = series.judge();
            add_levels(&mut outcome.levels, std::mem::take(&mut part.levels));
            if series.is_claimed {
                outcome.extend(part);
            } else {
                not_claimed.extend(part.rates);
            }
        }
        let mut checks = vec![completion(runs, |found| self.0.not_finite(found))];
        checks.extend(self.0.checks(runs, &series));
        outcome.extend(Outcome::new("", vec![], checks));
        if !not_claimed.is_empty() {
            let title = "Rates shown, not claimed: not needed for a pass";
            outcome.tables.push(rate_table(title, &not_claimed));
        }
        let shown = self.0.shown(runs, &series, &outcome);
        outcome.tables.extend(shown.tables);
        outcome.figures.extend(shown.figures);
        outcome.quantities.extend(shown.quantities);
        let Some(first) = series.first() else {
            outcome.headline = shown.summary.clone();
            outcome.summary = shown.summary;
            return outcome;
        };
        outcome.summary = summary(&outcome.rates);
        let outcome = outcome.summed_up_by_rates("");
        match self.next(runs, first) {
            Some((next, Finer { budget, unit, .. })) => {
                until_decided::ended(outcome, next, &first.levels, budget, unit)
            }
            None => outcome,
        }
    }

    fn details(&self) -> Vec<(String, String)> {
        self.0.details()
    }

    fn untested(&self) -> Vec<Untested> {
        self.0.untested()
    }
}

impl<S: Source> Orders<S> {
    /// What a study that adds levels does next; `None` if its levels are listed or a run has
    /// failed.
    fn next(&self, runs: &Runs<S>, series: &Series) -> Option<(Next, Finer<S::Data>)> {
        if runs.iter().any(|run| run.found.is_err()) {
            return None;
        }
        let finer = self.0.finer(runs)?;
        let next = until_decided::next(
            &series.levels.judge(),
            series.levels.refinements.len(),
            finer.cost,
            finer.spent,
            finer.budget,
        );
        Some((next, finer))
    }
}

impl Series {
    /// Errors with claims, and their figure.
    pub fn new(levels: Levels, figure: Drawn) -> Self {
        Self {
            levels,
            is_claimed: true,
            figure: Some(figure),
            grid: None,
        }
    }

    /// Errors, rates with their verdicts, guarded numbers and figures.
    fn judge(&self) -> Outcome {
        let levels = &self.levels;
        let outcome = match &self.grid {
            Some(grid) => Outcome {
                figures: grid.figures(|name| self.label(name)),
                ..grid.judge()
            },
            None => {
                let rates = levels.judge();
                let figure = self.figure.as_ref().map(|figure| figure.of(levels, &rates));
                Outcome {
                    figures: figure.into_iter().collect(),
                    ..Outcome::new("", rates, vec![])
                }
            }
        };
        Outcome {
            levels: levels.errors(),
            quantities: levels.quantities(&outcome.rates),
            rate_subjects: levels.subjects.clone(),
            ..outcome
        }
    }

    /// The axis of an error in a figure.
    fn label(&self, name: &str) -> String {
        let mut columns = self.levels.columns.iter();
        let symbol = columns
            .find(|column| column.name == name)
            .and_then(|column| column.symbol.as_deref());
        format!("error, {}", symbol.unwrap_or(name))
    }
}

impl Drawn {
    /// * `file`: the last part of its name; `subject`, `caption`: as in [`Levels::figure`].
    pub fn new(file: &str, subject: Option<&str>, caption: impl Into<String>) -> Self {
        Self {
            file: file.to_owned(),
            subject: subject.map(str::to_owned),
            caption: caption.into(),
        }
    }

    fn of(&self, levels: &Levels, rates: &Rates) -> Figure {
        levels.figure(
            &self.file,
            self.subject.clone(),
            self.caption.clone(),
            rates,
        )
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
