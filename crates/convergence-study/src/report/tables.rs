//! The tables of one study, as plain text: the same ones for report and terminal.

use super::distinct;
use crate::judge::verdict::{RateVerdict, Verdict};
use crate::run::{FailedCase, Finished};
use crate::study::outcome::{Check, LevelErrors, Outcome, Table};
use crate::text::number::{committed_rate, error_text, plain_text, rate_text};

/// Rates, checks, errors, the study's own tables, and the cases without a result; none of them is empty.
pub fn tables(Finished { outcome, failed_cases, .. }: &Finished) -> Vec<Table> {
    let common = [rates(outcome), checks(&outcome.checks), errors(&outcome.levels)];
    let own = outcome.tables.iter().cloned();
    let all = common.into_iter().chain(own).chain([failures(failed_cases)]);
    all.filter(|table| !table.head.is_empty() && !table.rows.is_empty()).collect()
}

fn table<const N: usize>(title: &str, head: [&str; N], rows: impl Iterator<Item = [String; N]>) -> Table {
    Table { title: title.to_owned(), head: head.map(str::to_owned).to_vec(), rows: rows.map(Vec::from).collect() }
}

fn rates(outcome: &Outcome) -> Table {
    let decimals = |rate: f64| format!("{:.3}", committed_rate(rate));
    let row = |(norm, rate): &(String, RateVerdict)| {
        let pairwise: Vec<String> = rate.pairwise.iter().map(|rate| decimals(*rate)).collect();
        let interval = rate.interval.map(|[low, high]| format!("{} to {}", decimals(low), decimals(high)));
        [
            norm.clone(),
            format!("{} ± {}", plain_text(rate.order), plain_text(rate.tolerance)),
            rate_text(rate.fitted),
            interval.unwrap_or_else(|| "-".to_owned()),
            rate_text(rate.extrapolated),
            pairwise.join(", "),
            levels(rate),
            rate.verdict.name().to_owned(),
            rate.reason.clone(),
        ]
    };
    let head = [
        "error in",
        "order claimed",
        "rate",
        "95 % interval",
        "extrapolated",
        "from level to level",
        "levels used",
        "verdict",
        "reason",
    ];
    let mut rates = table("Rates", head, outcome.rates.iter().map(row));
    // That a rate agrees is what all other columns say; a reason is worth its room where one does not.
    if outcome.rates.iter().all(|(_, rate)| rate.verdict == Verdict::Pass) {
        rates.head.pop();
        rates.rows.iter_mut().for_each(|row| drop(row.pop()));
    }
    rates
}

/// The levels that the rate was fitted to, counted from the coarsest.
fn levels(rate: &RateVerdict) -> String {
    let all = if rate.pairwise.is_empty() { 0 } else { rate.pairwise.len() + 1 };
    if rate.used.is_empty() { "-".to_owned() } else { format!("{}-{} of {all}", rate.used.start + 1, rate.used.end) }
}

fn checks(checks: &[Check]) -> Table {
    let row = |check: &Check| [check.claim.clone(), check.verdict.name().to_owned(), check.evidence.clone()];
    table("Checks", ["claim", "verdict", "evidence"], checks.iter().map(row))
}

/// One row for each level, one column for each norm.
fn errors(levels: &[LevelErrors]) -> Table {
    let norms = distinct(levels.iter().flat_map(|level| level.errors.iter().map(|(norm, _)| norm)));
    let parameters = distinct(levels.iter().flat_map(|level| level.parameters.iter().map(|(name, _)| name)));
    let row = |level: &LevelErrors| {
        let parameter = |name: &&String| level.parameter(name).map_or_else(|| "-".to_owned(), plain_text);
        let error = |norm: &&String| {
            let found = level.errors.iter().find(|(name, _)| name == *norm);
            found.map_or_else(|| "-".to_owned(), |(_, error)| error_text(*error))
        };
        parameters.iter().map(parameter).chain(norms.iter().map(error)).collect()
    };
    let head = parameters.iter().chain(&norms).map(|name| name.as_str());
    Table {
        title: "Errors".to_owned(),
        head: head.map(str::to_owned).collect(),
        rows: levels.iter().map(row).collect(),
    }
}

fn failures(failed: &[FailedCase]) -> Table {
    let row = |failed: &FailedCase| [failed.label.clone(), failed.reason.clone()];
    table("Cases without a result", ["case", "reason"], failed.iter().map(row))
}
