//! The tables of one study, as plain text, the same for report and terminal: rates, checks, and the
//! errors of each level, each with the rate from the previous level.

use crate::judge::verdict::{RateVerdict, Verdict};
use crate::run::{FailedCase, Finished};
use crate::study::outcome::{Check, LevelErrors, NamedRate, Outcome, Table};
use crate::text::lists::distinct;
use crate::text::named::NamedNumber;
use crate::text::number::{
    RATE_PLACES, committed_rate, decimals, error_text, interval_places, interval_text, plain_text,
};

/// Title of the table of checks.
const CHECKS: &str = "Checks";

/// Rates, checks, errors, the study's own tables, and the cases without a result; none of them is
/// empty.
pub(crate) fn tables(
    Finished {
        outcome,
        failed_cases,
        ..
    }: &Finished,
) -> Vec<Table> {
    let common = [rates(outcome), checks(&outcome.checks)]
        .into_iter()
        .chain(errors(outcome));
    let own = outcome.tables.iter().cloned();
    let all = common.chain(own).chain([failures(failed_cases)]);
    all.filter(|table| !table.head.is_empty() && !table.rows.is_empty())
        .collect()
}

fn rates(outcome: &Outcome) -> Table {
    let mut head = vec![
        "error in",
        "order claimed",
        "rate",
        "rate interval",
        "extrapolated",
        "levels used",
        "verdict",
        "reason",
    ];
    let rates = &outcome.rates;
    let mut rows: Vec<Vec<String>> = rates.iter().map(rate_row).collect();
    if rates.iter().all(|rate| rate.rate.verdict.is_pass()) {
        head.pop();
        for row in &mut rows {
            row.pop();
        }
    }
    Table::new("Rates", head, rows)
}

/// The row of a rate; the last cell is its reason.
pub(super) fn rate_row(NamedRate { name, rate, .. }: &NamedRate) -> Vec<String> {
    let places = rate.interval.map_or(RATE_PLACES - 1, |interval| {
        interval_places(interval, RATE_PLACES)
    });
    vec![
        name.clone(),
        rate.claim(),
        number_cell(rate.fitted.or_else(|| rate.finest_rate()), places),
        rate.interval.map_or_else(
            || "-".to_owned(),
            |interval| interval_text(interval, RATE_PLACES),
        ),
        number_cell(rate.extrapolated, places),
        levels(rate),
        rate.verdict.name().to_owned(),
        // The numbers of a reason are in the other columns, which are all that a pass needs.
        if rate.verdict == Verdict::Pass {
            String::new()
        } else {
            rate.code.text().to_owned()
        },
    ]
}

/// A number with this many decimals; a dash if there is none.
fn number_cell(number: Option<f64>, places: usize) -> String {
    number.map_or_else(|| "-".to_owned(), |number| decimals(number, places))
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
    let rows = checks.iter().map(|check| {
        vec![
            check.statement(),
            check.verdict.name().to_owned(),
            check.evidence.to_string(),
        ]
    });
    Table::new(CHECKS, ["claim", "verdict", "evidence"], rows)
}

fn failures(cases: &[FailedCase]) -> Table {
    const TITLE: &str = "Cases without a result";
    const HEAD: [&str; 2] = ["case", "reason"];
    if let [first, others @ ..] = cases
        && !others.is_empty()
        && others.iter().all(|other| other.reason == first.reason)
    {
        let all = format!("all {} without a result", cases.len());
        return Table::new(TITLE, HEAD, [vec![all, first.reason.clone()]]);
    }
    let rows = cases
        .iter()
        .map(|case| vec![case.label.clone(), case.reason.clone()]);
    Table::new(TITLE, HEAD, rows)
}

/// Widest table in characters, with three for the gap between columns: this fits on the page, and
/// nearly in Markdown.
const WIDEST: usize = 120;

/// A parameter of the levels; or the errors of one name on their levels, with the rate from the
/// previous level.
struct TableColumn {
    /// Name, and the word above the rates, if there are any.
    head: Vec<String>,
    /// For each level: nothing, or as many cells as heads.
    cells: Vec<Option<Vec<String>>>,
}

/// An error at a level.
#[derive(Clone, Copy, PartialEq)]
enum ErrorCell {
    /// The level does not have the error.
    NotMeasured,
    /// It should have it, but its case gave no result.
    NoResult,
    /// The error, which may be NaN.
    Error(f64),
}

impl ErrorCell {
    fn of(level: &LevelErrors, name: &str) -> Self {
        match NamedNumber::find(&level.errors, name) {
            None => ErrorCell::NotMeasured,
            Some(_) if level.without.iter().any(|known| known == name) => ErrorCell::NoResult,
            Some(error) => ErrorCell::Error(error),
        }
    }

    fn text(self) -> Option<String> {
        match self {
            ErrorCell::NotMeasured => None,
            ErrorCell::NoResult => Some("-".to_owned()),
            ErrorCell::Error(error) => Some(error_text(error)),
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
fn errors(outcome: &Outcome) -> Vec<Table> {
    let levels = &outcome.levels;
    let names = distinct(
        levels
            .iter()
            .flat_map(|level| level.errors.iter().map(|error| &error.name)),
    );
    let parameters = distinct(
        levels
            .iter()
            .flat_map(|level| level.parameters.iter().map(|known| &known.name)),
    );
    let room = WIDEST
        - parameters
            .iter()
            .map(|name| name.chars().count().max(6) + 3)
            .sum::<usize>()
            .min(WIDEST);
    let mut groups: Vec<Vec<TableColumn>> = vec![];
    for name in names {
        let column = TableColumn::of(outcome, name);
        if let Some(last) = groups.last_mut()
            && last.iter().map(TableColumn::width).sum::<usize>() + column.width() <= room
            && last[0].rows_like(&column)
        {
            last.push(column);
        } else {
            groups.push(vec![column]);
        }
    }
    let first_columns: Vec<TableColumn> = parameters
        .into_iter()
        .map(|name| TableColumn::of_parameter(outcome, name))
        .collect();
    let mut tables = vec![];
    for group in &groups {
        let title = if tables.is_empty() {
            "Errors"
        } else {
            "Errors, continued"
        };
        let columns: Vec<&TableColumn> = first_columns.iter().chain(group).collect();
        let head = columns.iter().flat_map(|column| column.head.clone());
        let rows = (0..levels.len()).filter_map(|level| row_of_errors(&columns, level));
        tables.push(Table::new(title, head, rows));
    }
    tables
}

/// The cells of a level; `None` if it does not have these errors.
fn row_of_errors(columns: &[&TableColumn], level: usize) -> Option<Vec<String>> {
    let mut row = vec![];
    for column in columns {
        row.extend_from_slice(column.cells[level].as_deref()?);
    }
    Some(row)
}

impl TableColumn {
    /// What identifies the levels.
    fn of_parameter(outcome: &Outcome, name: &str) -> Self {
        let texts = outcome.levels.iter().map(|level| {
            let value = level.parameter(name);
            value.map_or_else(|| "-".to_owned(), plain_text)
        });
        Self {
            head: vec![name.to_owned()],
            cells: texts.map(|text| Some(vec![text])).collect(),
        }
    }

    /// The errors of this name, and their rates if these were judged on the same levels.
    fn of(outcome: &Outcome, name: &str) -> Self {
        let cells: Vec<ErrorCell> = outcome
            .levels
            .iter()
            .map(|level| ErrorCell::of(level, name))
            .collect();
        let measured = cells.iter().filter(|cell| **cell != ErrorCell::NotMeasured);
        let pairs = measured.count().saturating_sub(1);
        let pairwise = outcome
            .rate(name)
            .map(|rate| rate.pairwise.as_slice())
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
        let cells = cells.iter().map(|cell| {
            let error = cell.text()?;
            Some(vec![error, rate_cell(rates.next()?)])
        });
        Self {
            head: vec![name.to_owned(), "rate".to_owned()],
            cells: cells.collect(),
        }
    }

    /// The characters of a row, with the gaps between columns.
    fn width(&self) -> usize {
        let mut width = 0;
        for (k, head) in self.head.iter().enumerate() {
            let cells = self.cells.iter().flatten().filter_map(|cells| cells.get(k));
            let lengths = cells.chain([head]).map(|cell| cell.chars().count());
            width += lengths.max().unwrap_or(0) + 3;
        }
        width
    }

    /// Whether both have errors on the same levels.
    fn rows_like(&self, other: &Self) -> bool {
        self.cells
            .iter()
            .zip(&other.cells)
            .all(|(a, b)| a.is_some() == b.is_some())
    }
}
