//! The tables of one study, as plain text, the same for report and terminal: rates, checks, and the
//! errors of each level, each with the rate from the previous level.

use crate::run::{FailedCase, Finished};
use crate::study::outcome::{Check, LevelErrors, NamedRate, Outcome, Table};
use crate::text::lists::{distinct, grouped};
use crate::text::named::NamedNumber;
use crate::text::number::{
    RATE_PLACES, decimals, error_text, interval_places, interval_text, plain_text, rate_text,
};
use convergence_judge::verdict::{RateVerdict, Verdict};

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

/// Cases without a result, those with the same reason together.
fn failures(cases: &[FailedCase]) -> Table {
    let reasons = cases.iter().map(|case| (&case.reason, &*case.label));
    let rows = grouped(reasons).into_iter();
    let rows = rows.map(|(reason, labels)| vec![labels.join("; "), reason.clone()]);
    Table::new("Cases without a result", ["case", "reason"], rows)
}

/// Most errors in a table: as many fit on a terminal, each with its rate.
const MOST: usize = 4;

/// As many tables as needed to cut none: a row for each level, and for each error its rates if it
/// was judged.
fn errors(outcome: &Outcome) -> Vec<Table> {
    let levels = outcome.levels.iter();
    let names = distinct(levels.flat_map(|level| level.errors.iter().map(|error| &error.name)));
    let columns = names.into_iter().map(|name| TableColumn::of(outcome, name));
    let columns: Vec<TableColumn> = columns.collect();
    let mut tables = vec![];
    for alike in columns.chunk_by(TableColumn::is_on_levels_of) {
        for few in alike.chunks(MOST) {
            let title = match tables.is_empty() {
                true => "Errors",
                false => "Errors, continued",
            };
            tables.push(table_of_errors(title, outcome, few));
        }
    }
    tables
}

fn table_of_errors(title: &str, outcome: &Outcome, errors: &[TableColumn]) -> Table {
    let levels = outcome.levels.iter();
    let names = levels.flat_map(|level| level.parameters.iter().map(|known| known.name.clone()));
    let parameters = distinct(names);
    let mut rows = vec![];
    for (k, level) in outcome.levels.iter().enumerate() {
        let parameters = parameters.iter().map(|name| level.parameter(name));
        let mut row: Vec<String> = parameters
            .map(|value| value.map_or_else(|| "-".to_owned(), plain_text))
            .collect();
        let cells = errors.iter().map(|column| column.cells[k].clone());
        // The level has all of these errors, or none.
        if let Some(cells) = cells.collect::<Option<Vec<_>>>() {
            row.extend(cells.into_iter().flatten());
            rows.push(row);
        }
    }
    let heads = errors.iter().flat_map(|column| column.head.clone());
    Table::new(title, parameters.into_iter().chain(heads), rows)
}

/// The errors of one name on their levels, each with the rate from the previous level if these
/// were judged.
struct TableColumn {
    /// Name, and the word above the rates, if there are any.
    head: Vec<String>,
    /// For each level: nothing, or as many cells as heads.
    cells: Vec<Option<Vec<String>>>,
}

impl TableColumn {
    fn of(outcome: &Outcome, name: &str) -> Self {
        let levels = &outcome.levels;
        let has_error = |level: &&LevelErrors| NamedNumber::find(&level.errors, name).is_some();
        let pairs = levels.iter().filter(has_error).count().saturating_sub(1);
        // Rates that were judged on other levels stand in no row.
        let rates = outcome.rate(name).map(|rate| &rate.pairwise);
        let rates = rates.filter(|rates| rates.len() == pairs);
        let mut head = vec![name.to_owned()];
        head.extend(rates.map(|_| "rate".to_owned()));
        // The coarsest level has no rate.
        let mut next = rates.map(|rates| [f64::NAN].into_iter().chain(rates.iter().copied()));
        let cells = levels.iter().map(|level| {
            let error = NamedNumber::find(&level.errors, name)?;
            let has_result = !level.without.iter().any(|known| known == name);
            let mut cells = vec![match has_result {
                true => error_text(error),
                false => "-".to_owned(),
            }];
            cells.extend(next.as_mut().and_then(Iterator::next).map(rate_cell));
            Some(cells)
        });
        Self {
            cells: cells.collect(),
            head,
        }
    }

    fn is_on_levels_of(&self, other: &Self) -> bool {
        let mut levels = self.cells.iter().zip(&other.cells);
        levels.all(|(own, other)| own.is_some() == other.is_some())
    }
}

/// A rate between neighbouring levels; a dash if there is none.
fn rate_cell(rate: f64) -> String {
    rate_text(Some(rate).filter(|rate| !rate.is_nan()))
}
