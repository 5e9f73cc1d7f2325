//! Judged rates: as guarded numbers, as a table, and in a sentence.

use super::ErrorColumn;
use crate::study::must::Must;
use crate::study::outcome::{NamedRate, Quantity, Table};
use crate::study::subject::Sort;
use crate::text::number::{
    RATE_PLACES, WIDEST_INTERVAL, decimals, interval_places, interval_text, rate_text,
};
use convergence_judge::verdict::{RateVerdict, Verdict};

/// Relative change of an observed rate that the baseline tolerates.
pub(crate) const RATE_TOLERANCE: f64 = 1e-4;

/// The observed rates with their claims, as numbers that the baseline guards.
///
/// * `columns`: the errors that have these rates, with their claims; a rate of no column has the
///   band that it was judged by.
pub(crate) fn rate_quantities(rates: &[NamedRate], columns: &[ErrorColumn]) -> Vec<Quantity> {
    let mut quantities = vec![];
    for named in rates {
        let Some(fitted) = named.rate.fitted else {
            continue;
        };
        let own = columns.iter().find(|column| column.name == named.name);
        let claim = own.and_then(|column| column.claim.as_ref()).map(Must::from);
        quantities.push(Quantity {
            sort: Sort::Rate,
            ..Quantity::new(format!("rate {}", named.name), fitted, RATE_TOLERANCE)
                .claimed(claim.or(named.rate.claimed.map(Must::from)))
                .about(named.subject.clone())
        });
    }
    quantities
}

impl Table {
    /// Order, rate, interval and verdict of each error: for rates that decide nothing.
    pub fn of_rates(title: &str, rates: &[NamedRate]) -> Self {
        let head = [
            "error of",
            "order",
            "pairwise rates",
            "rate",
            "rate interval",
            "verdict",
            "because",
        ];
        Self::new(title, head, rates.iter().map(row))
    }
}

/// The row of a rate.
fn row(NamedRate { name, rate, .. }: &NamedRate) -> Vec<String> {
    let pairwise: Vec<String> = rate
        .pairwise
        .iter()
        .map(|rate| decimals(*rate, 3))
        .collect();
    let interval = rate.interval.map_or_else(
        || "-".to_owned(),
        |interval| interval_text(interval, RATE_PLACES),
    );
    vec![
        name.clone(),
        rate.order()
            .map_or_else(|| "-".to_owned(), |order| order.to_string()),
        pairwise.join(" "),
        rate_cell(rate),
        interval,
        rate.verdict.to_string(),
        rate.code.text().to_owned(),
    ]
}

/// The rate with the digits that its interval justifies, in a table that also shows the interval.
fn rate_cell(rate: &RateVerdict) -> String {
    match (rate.fitted, rate.interval) {
        (Some(_), Some(interval)) if interval.width() > WIDEST_INTERVAL => "no rate".to_owned(),
        (Some(fitted), Some(interval)) => decimals(fitted, interval_places(interval, RATE_PLACES)),
        (fitted, _) => rate_text(fitted),
    }
}

/// Rates and orders in a sentence: of all errors if all pass, otherwise of the others, each with
/// its reason.
pub(crate) fn summary(rates: &[NamedRate]) -> String {
    let passes = rates.iter().all(|rate| rate.rate.verdict.is_pass());
    let mut parts = vec![];
    for NamedRate { name, rate, .. } in rates {
        let rate_and_order = rate.beside_order(RATE_PLACES);
        if passes {
            parts.push(format!("{name} {rate_and_order}"));
        } else if rate.verdict != Verdict::Pass {
            parts.push(format!("{name} {rate_and_order}: {}", rate.reason));
        }
    }
    parts.join("; ")
}
