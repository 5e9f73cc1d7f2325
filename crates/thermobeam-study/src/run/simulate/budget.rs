//! The error budget of a run, as an addition to its JSON object.

use crate::predict::estimate::{Budget, Estimate, Source};
use serde::Serialize;

/// Added to the object only where it was asked for.
#[derive(Debug, Serialize)]
pub(super) struct ErrorBudget {
    /// Where most of the error comes from, over all quantities.
    dominant: Option<&'static str>,
    advice: String,
    quantities: Vec<Quantity>,
}

#[derive(Debug, Serialize)]
struct Quantity {
    name: &'static str,
    value: f64,
    space: f64,
    time: f64,
    iteration: f64,
    round_off: f64,
    total: f64,
}

/// The budget in the form in which it is printed.
pub(super) fn object(budget: &Budget) -> ErrorBudget {
    let quantity = |estimate: &Estimate| Quantity {
        name: estimate.name,
        value: estimate.value,
        space: estimate.error(Source::Space),
        time: estimate.error(Source::Time),
        iteration: estimate.error(Source::Iteration),
        round_off: estimate.error(Source::RoundOff),
        total: estimate.total(),
    };
    ErrorBudget {
        dominant: budget.dominant().map(Source::name),
        advice: budget.advice(),
        quantities: budget.estimates.iter().map(quantity).collect(),
    }
}
