//! The tables of one study, as plain text: the same ones for report and terminal.

use super::errors;
use crate::judge::verdict::{RateVerdict, Verdict};
use crate::run::{FailedCase, Finished};
use crate::study::outcome::{Check, Outcome, Table};
use crate::text::number::{RATE_PLACES, decimals, interval_places, interval_text};

/// Title of the table of checks.
pub(super) const CHECKS: &str = "Checks";

/// Rates, checks, errors, the study's own tables, and the cases without a result; none of them is empty.
///
/// * `judged`: leave out errors whose rate was not judged.
pub fn tables(Finished { outcome, failed_cases, .. }: &Finished, judged: bool) -> Vec<Table> {
    let common = [rates(outcome), checks(&outcome.checks)].into_iter().chain(errors::tables(outcome, judged));
    let own = outcome.tables.iter().cloned();
    let all = common.chain(own).chain([failures(failed_cases)]);
    all.filter(|table| !table.head.is_empty() && !table.rows.is_empty()).collect()
}

fn table<const N: usize>(title: &str, head: [&str; N], rows: impl Iterator<Item = [String; N]>) -> Table {
    Table { title: title.to_owned(), head: head.map(str::to_owned).to_vec(), rows: rows.map(Vec::from).collect() }
}

fn rates(outcome: &Outcome) -> Table {
    let row = |(norm, rate): &(String, RateVerdict)| {
        let places = rate.interval.map_or(RATE_PLACES - 1, |interval| interval_places(interval, RATE_PLACES));
        let number = |rate: Option<f64>| rate.map_or_else(|| "-".to_owned(), |rate| decimals(rate, places));
        [
            norm.clone(),
            rate.claim(),
            number(rate.fitted.or_else(|| rate.finest_rate())),
            rate.interval.map_or_else(|| "-".to_owned(), |interval| interval_text(interval, RATE_PLACES)),
            number(rate.extrapolated),
            levels(rate),
            rate.verdict.name().to_owned(),
            // The numbers of a reason are in the other columns, and so is all that a pass needs.
            if rate.verdict == Verdict::Pass { String::new() } else { rate.kind.text().to_owned() },
        ]
    };
    let head =
        ["error in", "order claimed", "rate", "95 % interval", "extrapolated", "levels used", "verdict", "reason"];
    let mut rates = table("Rates", head, outcome.rates.iter().map(row));
    if outcome.rates.iter().all(|(_, rate)| rate.verdict == Verdict::Pass) {
        rates.head.pop();
        rates.rows.iter_mut().for_each(|row| drop(row.pop()));
    }
    rates
}

/// The levels that the rate was fitted to, counted from the coarsest; without a fit it is that of the finest pair.
fn levels(rate: &RateVerdict) -> String {
    let all = if rate.pairwise.is_empty() { 0 } else { rate.pairwise.len() + 1 };
    match (rate.used.is_empty(), rate.finest_rate()) {
        (false, _) => format!("{}-{} of {all}", rate.used.start + 1, rate.used.end),
        (true, Some(_)) => "finest pair".to_owned(),
        (true, None) => "-".to_owned(),
    }
}

fn checks(checks: &[Check]) -> Table {
    let row = |check: &Check| [check.claim.clone(), check.verdict.name().to_owned(), check.evidence.clone()];
    table(CHECKS, ["claim", "verdict", "evidence"], checks.iter().map(row))
}

fn failures(failed: &[FailedCase]) -> Table {
    let row = |failed: &FailedCase| [failed.label.clone(), failed.reason.clone()];
    table("Cases without a result", ["case", "reason"], failed.iter().map(row))
}
