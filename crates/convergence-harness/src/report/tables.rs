//! The tables of one study, as plain text, the same for report and terminal: rates, checks, and the
//! errors of each level, each with the rate from the previous level.

use crate::judge::verdict::{RateVerdict, Verdict};
use crate::run::{FailedCase, Finished};
use crate::study::outcome::{Check, LevelErrors, Outcome, Table};
use crate::text::lists::distinct;
use crate::text::number::{
    RATE_PLACES, committed_rate, decimals, error_text, interval_places, interval_text, plain_text,
};

/// Title of the table of checks.
pub(super) const CHECKS: &str = "Checks";

/// Rates, checks, errors, the study's own tables, and the cases without a result; none of them is
/// empty.
///
/// * `judged`: whether to leave out errors whose rate was not judged.
pub fn tables(
    Finished {
        outcome,
        failed_cases,
        ..
    }: &Finished,
    judged: bool,
) -> Vec<Table> {
    let common = [rates(outcome), checks(&outcome.checks)]
        .into_iter()
        .chain(errors(outcome, judged));
    let own = outcome.tables.iter().cloned();
    let all = common.chain(own).chain([failures(failed_cases)]);
    all.filter(|table| !table.head.is_empty() && !table.rows.is_empty())
        .collect()
}

fn rates(outcome: &Outcome) -> Table {
    let row = |(norm, rate): &(String, RateVerdict)| {
        let places = rate.interval.map_or(RATE_PLACES - 1, |interval| {
            interval_places(interval, RATE_PLACES)
        });
        let number =
            |rate: Option<f64>| rate.map_or_else(|| "-".to_owned(), |rate| decimals(rate, places));
        vec![
            norm.clone(),
            rate.claim(),
            number(rate.fitted.or_else(|| rate.finest_rate())),
            rate.interval.map_or_else(
                || "-".to_owned(),
                |interval| interval_text(interval, RATE_PLACES),
            ),
            number(rate.extrapolated),
            levels(rate),
            rate.verdict.name().to_owned(),
            // The numbers of a reason are in the other columns, which are all that a pass needs.
            if rate.verdict == Verdict::Pass {
                String::new()
            } else {
                rate.kind.text().to_owned()
            },
        ]
    };
    let head = [
        "error in",
        "order claimed",
        "rate",
        "95 % interval",
        "extrapolated",
        "levels used",
        "verdict",
        "reason",
    ];
    let mut rates = Table::new("Rates", head, outcome.rates.iter().map(row));
    if outcome
        .rates
        .iter()
        .all(|(_, rate)| rate.verdict == Verdict::Pass)
    {
        rates.head.pop();
        rates.rows.iter_mut().for_each(|row| drop(row.pop()));
    }
    rates
}

/// The levels that the rate was fitted to, counted from the coarsest; without a fit, those of the
/// finest pair.
fn levels(rate: &RateVerdict) -> String {
    let all = if rate.pairwise.is_empty() {
        0
    } else {
        rate.pairwise.len() + 1
    };
    match (rate.used.is_empty(), rate.finest_rate()) {
        (false, _) => format!("{}-{} of {all}", rate.used.start + 1, rate.used.end),
        (true, Some(_)) => "finest pair".to_owned(),
        (true, None) => "-".to_owned(),
    }
}

fn checks(checks: &[Check]) -> Table {
    let row = |check: &Check| {
        vec![
            check.statement(),
            check.verdict.name().to_owned(),
            check.evidence.clone(),
        ]
    };
    Table::new(
        CHECKS,
        ["claim", "verdict", "evidence"],
        checks.iter().map(row),
    )
}

fn failures(failed: &[FailedCase]) -> Table {
    const TITLE: &str = "Cases without a result";
    const HEAD: [&str; 2] = ["case", "reason"];
    if let [first, others @ ..] = failed
        && !others.is_empty()
        && others.iter().all(|other| other.reason == first.reason)
    {
        let all = format!("all {} without a result", failed.len());
        return Table::new(TITLE, HEAD, [vec![all, first.reason.clone()]]);
    }
    let row = |failed: &FailedCase| vec![failed.label.clone(), failed.reason.clone()];
    Table::new(TITLE, HEAD, failed.iter().map(row))
}

/// Widest table in characters, with three for the gap between columns: this fits on the page, and
/// nearly in Markdown.
const WIDEST: usize = 120;

/// A parameter of the levels; or the errors of one name on their levels, with the rate from the
/// previous level.
struct Column {
    /// Name, and the word above the rates, if there are any.
    head: Vec<String>,
    /// For each level: nothing, or as many cells as heads.
    cells: Vec<Option<Vec<String>>>,
}

/// An error at a level.
#[derive(Clone, Copy, PartialEq)]
enum Cell {
    /// The level does not have the error.
    NotMeasured,
    /// It should have it, but its case gave no result.
    NoResult,
    /// The error, which may be NaN.
    Error(f64),
}

impl Cell {
    fn of(level: &LevelErrors, name: &str) -> Self {
        match level.errors.iter().find(|(known, _)| known == name) {
            None => Cell::NotMeasured,
            Some(_) if level.without.iter().any(|known| known == name) => Cell::NoResult,
            Some((_, error)) => Cell::Error(*error),
        }
    }

    fn text(self) -> Option<String> {
        match self {
            Cell::NotMeasured => None,
            Cell::NoResult => Some("-".to_owned()),
            Cell::Error(error) => Some(error_text(error)),
        }
    }
}

/// A rate between neighbouring levels; a dash if there is none.
fn rate_cell(rate: f64) -> String {
    if rate.is_nan() {
        "-".to_owned()
    } else {
        decimals(committed_rate(rate), 3)
    }
}

/// As many tables as needed to cut none: a row for each level, and for each error its rates if it
/// was judged.
///
/// * `judged`: only errors whose rate was judged, unless none was.
fn errors(outcome: &Outcome, judged: bool) -> Vec<Table> {
    let levels = &outcome.levels;
    let mut names = distinct(
        levels
            .iter()
            .flat_map(|level| level.errors.iter().map(|(name, _)| name)),
    );
    let is_judged = |name: &&String| outcome.rates.iter().any(|(known, _)| known == *name);
    if judged && names.iter().any(is_judged) {
        names.retain(is_judged);
    }
    let parameters = distinct(
        levels
            .iter()
            .flat_map(|level| level.parameters.iter().map(|(name, _)| name)),
    );
    let room = WIDEST
        - parameters
            .iter()
            .map(|name| name.chars().count().max(6) + 3)
            .sum::<usize>()
            .min(WIDEST);
    let mut tables: Vec<Vec<Column>> = vec![];
    for name in names {
        let column = Column::of(outcome, name);
        let width = |columns: &[Column]| columns.iter().map(Column::width).sum::<usize>();
        match tables.last_mut() {
            Some(last) if width(last) + column.width() <= room && last[0].rows_like(&column) => {
                last.push(column);
            }
            _ => tables.push(vec![column]),
        }
    }
    let identified: Vec<Column> = parameters
        .into_iter()
        .map(|name| Column::of_parameter(outcome, name))
        .collect();
    let table = |(k, columns): (usize, Vec<Column>)| {
        let columns: Vec<&Column> = identified.iter().chain(&columns).collect();
        // The levels that have these errors.
        let row = |level: usize| {
            columns
                .iter()
                .map(|column| column.cells[level].clone())
                .collect::<Option<Vec<_>>>()
        };
        Table::new(
            if k == 0 {
                "Errors"
            } else {
                "Errors, continued"
            },
            columns.iter().flat_map(|column| column.head.clone()),
            (0..levels.len())
                .filter_map(row)
                .map(|cells| cells.concat()),
        )
    };
    tables.into_iter().enumerate().map(table).collect()
}

impl Column {
    /// What identifies the levels.
    fn of_parameter(outcome: &Outcome, name: &str) -> Self {
        let cell = |level: &LevelErrors| {
            vec![
                level
                    .parameter(name)
                    .map_or_else(|| "-".to_owned(), plain_text),
            ]
        };
        Self {
            head: vec![name.to_owned()],
            cells: outcome.levels.iter().map(cell).map(Some).collect(),
        }
    }

    /// The errors of this name, and their rates if these were judged on the same levels.
    fn of(outcome: &Outcome, name: &str) -> Self {
        let cells: Vec<Cell> = outcome
            .levels
            .iter()
            .map(|level| Cell::of(level, name))
            .collect();
        let measured = cells.iter().filter(|cell| **cell != Cell::NotMeasured);
        let pairs = measured.count().saturating_sub(1);
        let mut rates = outcome.rates.iter();
        let judged = rates.find(|(known, _)| known == name);
        let pairwise = judged
            .map(|(_, rate)| rate.pairwise.as_slice())
            .filter(|pairwise| pairwise.len() == pairs);
        let Some(pairwise) = pairwise else {
            let texts = cells.iter().map(|cell| cell.text().map(|text| vec![text]));
            return Self {
                head: vec![name.to_owned()],
                cells: texts.collect(),
            };
        };
        // The coarsest level has no rate.
        let mut rates = std::iter::once(f64::NAN).chain(pairwise.iter().copied());
        let mut with_rate = |cell: &Cell| Some(vec![cell.text()?, rate_cell(rates.next()?)]);
        Self {
            head: vec![name.to_owned(), "rate".to_owned()],
            cells: cells.iter().map(&mut with_rate).collect(),
        }
    }

    fn width(&self) -> usize {
        let widest = |k: usize| {
            let cells = self.cells.iter().flatten().filter_map(|cells| cells.get(k));
            cells
                .chain(self.head.get(k))
                .map(|cell| cell.chars().count())
                .max()
                .unwrap_or(0)
        };
        (0..self.head.len()).map(|k| widest(k) + 3).sum()
    }

    /// Whether both have errors on the same levels.
    fn rows_like(&self, other: &Self) -> bool {
        self.cells
            .iter()
            .zip(&other.cells)
            .all(|(a, b)| a.is_some() == b.is_some())
    }
}
