//! Judged rates: as guarded numbers, as a table, and in a sentence.

use crate::judge::verdict::{RateVerdict, Verdict};
use crate::study::outcome::{Quantity, Table};
use crate::study::subject::{Sort, Subject};
use crate::text::number::{
    RATE_PLACES, WIDEST_INTERVAL, decimals, interval_places, interval_text, rate_text,
};

/// Relative change of an observed rate that the baseline tolerates.
pub const RATE_TOLERANCE: f64 = 1e-4;

/// Rates that were judged, each with the name of its error.
pub type Rates = [(String, RateVerdict)];

/// The observed rates, as numbers that the baseline guards.
///
/// * `subject`: what the rate of that name is about.
pub fn rate_quantities(
    rates: &Rates,
    subject: impl Fn(&str) -> Subject,
) -> impl Iterator<Item = Quantity> {
    rates.iter().filter_map(move |(name, rate)| {
        let guarded = Quantity::new(format!("rate {name}"), rate.fitted?, RATE_TOLERANCE);
        Some(guarded.about(subject(name)).of_sort(Sort::Rate))
    })
}

/// Order, rate, interval and verdict of each error, in a separate table: for rates that decide
/// nothing.
pub fn rate_table(title: &str, rates: &Rates) -> Table {
    let head = [
        "error of",
        "order",
        "pairwise rates",
        "rate",
        "95 % interval",
        "verdict",
        "because",
    ];
    Table::new(
        title,
        head,
        rates.iter().map(|(name, rate)| row(name, rate)),
    )
}

/// The row of a rate.
fn row(name: &str, rate: &RateVerdict) -> Vec<String> {
    let pairwise: Vec<String> = rate
        .pairwise
        .iter()
        .map(|rate| format!("{rate:.3}"))
        .collect();
    let interval = rate.interval.map_or_else(
        || "-".to_owned(),
        |interval| interval_text(interval, RATE_PLACES),
    );
    vec![
        name.to_owned(),
        rate.order.to_string(),
        pairwise.join(" "),
        rate_cell(rate),
        interval,
        rate.verdict.to_string(),
        rate.kind.text().to_owned(),
    ]
}

/// The rate with the digits that its interval justifies, in a table that also shows the interval.
fn rate_cell(rate: &RateVerdict) -> String {
    match (rate.fitted, rate.interval) {
        (Some(_), Some([low, high])) if high - low > WIDEST_INTERVAL => "no rate".to_owned(),
        (Some(fitted), Some(interval)) => decimals(fitted, interval_places(interval, RATE_PLACES)),
        (fitted, _) => rate_text(fitted),
    }
}

/// Rates and orders in a sentence: of all errors if all pass, otherwise of the others, each with
/// its reason.
pub fn summary(rates: &Rates) -> String {
    let passes = rates.iter().all(|(_, rate)| rate.verdict == Verdict::Pass);
    let mut parts = vec![];
    for (name, rate) in rates {
        let rate_and_order = rate.beside_order(RATE_PLACES);
        if passes {
            parts.push(format!("{name} {rate_and_order}"));
        } else if rate.verdict != Verdict::Pass {
            parts.push(format!("{name} {rate_and_order}: {}", rate.reason));
        }
    }
    parts.join("; ")
}
